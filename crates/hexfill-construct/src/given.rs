//! Tetrahedra from elsewhere: given by the caller, or made by an installed `tetgen` that is called as a process.
//!
//! Both must fill exactly the triangles of [`crate::core_triangles`]; the boundary is compared with the request by
//! the construction. `tetgen` (H. Si; AGPL) is never linked: it gets a `.poly` file and answers with `.node` and `.ele`;
//! its option `-Y` keeps the boundary free of new points.

use crate::error::ConstructError;
use crate::tets::{InteriorTets, TetComplex, TetRequest};
use hexfill_mesh::Context;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// A tetrahedral mesh given by the caller: the vertices of the surface first, with the same ids.
#[derive(Clone, Debug, Default)]
pub struct GivenTets {
    /// Number of vertices.
    pub n_vertices: usize,
    /// The tets, in any orientation if positions are given, else positively oriented.
    pub tets: Vec<[u32; 4]>,
    /// Positions of all vertices, if known.
    pub points: Option<Vec<[f64; 3]>>,
}

impl InteriorTets for GivenTets {
    fn name(&self) -> &'static str {
        "given"
    }

    fn fill(&self, _request: &TetRequest<'_>, _ctx: &Context<'_>) -> Result<TetComplex, ConstructError> {
        let err = |reason: String| Err(ConstructError::TetBoundary { reason });
        for (t, tet) in self.tets.iter().enumerate() {
            if let Some(v) = tet.iter().find(|&&v| v as usize >= self.n_vertices) {
                return err(format!("tetrahedron {t} uses vertex index {v} of {}", self.n_vertices));
            }
            if (0..4).any(|i| tet[..i].contains(&tet[i])) {
                return err(format!("tetrahedron {t} uses a vertex twice"));
            }
        }
        let mut tets = self.tets.clone();
        if let Some(points) = &self.points {
            if points.len() != self.n_vertices {
                return err(format!("{} positions given for {} vertices", points.len(), self.n_vertices));
            }
            for tet in &mut tets {
                if volume(tet.map(|v| points[v as usize])) < 0.0 {
                    tet.swap(2, 3);
                }
            }
        }
        let mut complex = TetComplex::from_simplices(self.n_vertices, tets);
        complex.points.clone_from(&self.points);
        Ok(complex)
    }
}

/// Six times the signed volume.
fn volume([a, b, c, d]: [[f64; 3]; 4]) -> f64 {
    let [u, v, w] = [b, c, d].map(|p| [p[0] - a[0], p[1] - a[1], p[2] - a[2]]);
    u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0]) + u[2] * (v[0] * w[1] - v[1] * w[0])
}

/// Tetrahedra by an installed `tetgen`.
#[derive(Clone, Debug)]
pub struct TetgenTets {
    /// The program: a path, or a name that the system finds.
    pub program: PathBuf,
}

impl Default for TetgenTets {
    fn default() -> Self {
        Self { program: "tetgen".into() }
    }
}

impl InteriorTets for TetgenTets {
    fn name(&self) -> &'static str {
        "tetgen"
    }

    fn fill(&self, request: &TetRequest<'_>, ctx: &Context<'_>) -> Result<TetComplex, ConstructError> {
        let needed = |reason: String| ConstructError::InteriorNeeded { genus: 0, components: 1, reason };
        let points = request.points.ok_or_else(|| needed("tetgen needs positions".into()))?;
        let folder = std::env::temp_dir().join(format!("hexfill-tetgen-{}", std::process::id()));
        std::fs::create_dir_all(&folder).map_err(|e| needed(format!("{}: {e}", folder.display())))?;
        let result = self.run(&folder, points, request.triangles);
        // The folder is ours; what cannot be removed does no harm.
        let _ = std::fs::remove_dir_all(&folder);
        let (points, tets) = result.map_err(needed)?;
        GivenTets { n_vertices: points.len(), tets, points: Some(points) }.fill(request, ctx)
    }
}

type Mesh = (Vec<[f64; 3]>, Vec<[u32; 4]>);

impl TetgenTets {
    fn run(&self, folder: &Path, points: &[[f64; 3]], triangles: &[[u32; 3]]) -> Result<Mesh, String> {
        let poly = folder.join("core.poly");
        std::fs::write(&poly, poly_text(points, triangles)).map_err(|e| format!("{}: {e}", poly.display()))?;
        let output = Command::new(&self.program)
            .args(["-pYQ", "core.poly"])
            .current_dir(folder)
            .stdin(Stdio::null())
            .output()
            .map_err(|e| format!("{}: {e}; install tetgen or give tetrahedra", self.program.display()))?;
        if !output.status.success() {
            let words = String::from_utf8_lossy(&output.stdout);
            return Err(format!("{} failed: {}", self.program.display(), words.trim()));
        }
        let read = |name: &str| {
            let path = folder.join(name);
            std::fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))
        };
        let points = rows(&read("core.1.node")?, 4)?.into_iter().map(|r| [r[1], r[2], r[3]]).collect();
        let tets =
            rows(&read("core.1.ele")?, 5)?.into_iter().map(|r| [r[1], r[2], r[3], r[4]].map(|x| x as u32)).collect();
        Ok((points, tets))
    }
}

/// A surface as a `.poly` file with 0-based indices; positions in the shortest form that reads back to the same bits.
fn poly_text(points: &[[f64; 3]], triangles: &[[u32; 3]]) -> String {
    let mut text = format!("{} 3 0 0\n", points.len());
    for (i, p) in points.iter().enumerate() {
        let _ = writeln!(text, "{i} {} {} {}", p[0], p[1], p[2]);
    }
    let _ = writeln!(text, "{} 0", triangles.len());
    for t in triangles {
        let _ = writeln!(text, "1\n3 {} {} {}", t[0], t[1], t[2]);
    }
    text.push_str("0\n0\n");
    text
}

/// The rows of a `.node` or `.ele` file after its header, at least `columns` numbers each.
fn rows(text: &str, columns: usize) -> Result<Vec<Vec<f64>>, String> {
    let lines = text.lines().map(|l| l.split('#').next().unwrap_or("").trim()).filter(|l| !l.is_empty());
    let mut numbers = lines.map(|l| {
        l.split_whitespace().map(|w| w.parse::<f64>().map_err(|e| format!("`{w}`: {e}"))).collect::<Result<Vec<_>, _>>()
    });
    let header = numbers.next().ok_or("an empty file")??;
    let wanted = header.first().copied().unwrap_or(0.0) as usize;
    let rows: Vec<Vec<f64>> = numbers.take(wanted).collect::<Result<_, _>>()?;
    if rows.len() < wanted || rows.iter().any(|r| r.len() < columns) {
        return Err(format!("{} rows of {columns} numbers expected", wanted));
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tetgen_files_are_written_and_read() {
        let text = poly_text(&[[0.0, 0.1, 1e-300]], &[[0, 0, 0]]);
        assert!(text.starts_with("1 3 0 0\n0 0 0.1 "));
        let read = rows("2 3 0 0 # header\n0 0.5 1 2\n# note\n1 3 4 5\n", 4).unwrap();
        assert_eq!(read, [[0.0, 0.5, 1.0, 2.0], [1.0, 3.0, 4.0, 5.0]]);
        assert!(rows("3 4 0\n0 1 2 3 4\n", 5).is_err());
    }

    #[test]
    fn a_missing_program_is_named() {
        let tets = TetgenTets { program: "no-such-tetgen".into() };
        let triangles = [[0, 1, 2]];
        let points = [[0.0; 3]; 3];
        let request = TetRequest { n_vertices: 3, triangles: &triangles, points: Some(&points) };
        match tets.fill(&request, &Context::default()) {
            Err(ConstructError::InteriorNeeded { reason, .. }) => assert!(reason.contains("no-such-tetgen")),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn bad_tetrahedra_are_refused() {
        let request = TetRequest { n_vertices: 4, triangles: &[], points: None };
        let fill =
            |tets: Vec<[u32; 4]>| GivenTets { n_vertices: 4, tets, points: None }.fill(&request, &Context::default());
        assert!(matches!(fill(vec![[0, 1, 2, 4]]), Err(ConstructError::TetBoundary { .. })));
        assert!(matches!(fill(vec![[0, 1, 2, 2]]), Err(ConstructError::TetBoundary { .. })));
        assert_eq!(fill(vec![[0, 1, 2, 3]]).unwrap().n_faces, 4);
    }
}
