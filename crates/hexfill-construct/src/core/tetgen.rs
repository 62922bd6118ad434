//! Tetrahedra made by an installed `tetgen` that is called as a process.
//!
//! `tetgen` (H. Si; AGPL) is never linked: it gets a `.poly` file and answers with `.node` and `.ele`. Its option `-Y` keeps
//! the boundary free of new points; where it fails all the same, it is asked again with `-M`, which keeps coplanar triangles
//! apart (tetgen 1.5.0 stops on an assertion of its own on some small tori, on others only with `-M`). It fills everything that the surface encloses, cavities
//! as well; which tets belong to the solid is decided here, by walking inward from the triangles asked for, and so is
//! the orientation of each tet: nothing rests on the signs of small volumes.
//!
//! Source: the tetgen manual, for its files and options; the way back from an answer to tets inside is ours.

use super::complex::{OUTWARD, TetComplex, others, sorted};
use super::fit::fitted;
use super::maker::{Core, InteriorTets};
use super::request::TetRequest;
use super::used::Used;
use crate::error::ConstructError;
use crate::ids::TetId;
use crate::misfit::TetMisfit;
use crate::missing::MissingInterior;
use hexfill_geometry::tet_volume;
use hexfill_mesh::{Context, IdVec, StopReason, VertexId};
use std::fmt::Write as _;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

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

/// What tetgen is asked with, one after the other until it succeeds.
const SWITCHES: [&str; 2] = ["-pYQ", "-pYMQ"];

/// Why there is no answer.
enum Failure {
    Reason(MissingInterior),
    Boundary(TetMisfit),
    Stopped(StopReason),
}

impl From<MissingInterior> for Failure {
    fn from(reason: MissingInterior) -> Self {
        Self::Reason(reason)
    }
}

/// A file or program that the system does not give.
fn unreachable_at(at: impl std::fmt::Display, error: std::io::Error) -> MissingInterior {
    MissingInterior::TetgenIo { at: at.to_string(), error: error.to_string() }
}

/// A folder of our own, removed in the end.
struct Folder(PathBuf);

impl Folder {
    fn new() -> Result<Self, MissingInterior> {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        let name = format!("hexfill-tetgen-{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        let path = std::env::temp_dir().join(name);
        std::fs::create_dir_all(&path).map_err(|e| unreachable_at(path.display(), e))?;
        Ok(Self(path))
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // What cannot be removed does no harm.
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

impl InteriorTets for TetgenTets {
    fn core(&self) -> Core {
        Core::Tetgen
    }

    fn fill(&self, request: &TetRequest<'_>, ctx: &Context<'_>) -> Result<TetComplex, ConstructError> {
        let Some(points) = request.points else {
            return Err(request.interior_needed(MissingInterior::NoPositionsForTetgen));
        };
        self.run(request, points, ctx).map_err(|failure| match failure {
            Failure::Reason(reason) => request.interior_needed(reason),
            Failure::Boundary(reason) => ConstructError::TetBoundary { reason },
            Failure::Stopped(reason) => ConstructError::Stopped(reason),
        })
    }
}

impl TetgenTets {
    fn run(&self, request: &TetRequest<'_>, points: &[[f64; 3]], ctx: &Context<'_>) -> Result<TetComplex, Failure> {
        // Only what the triangles use: tetgen would make a vertex of every other point.
        let own = Used::of(request);
        let mut first = None;
        for switches in SWITCHES {
            match self.ask(switches, request, points, &own, ctx) {
                Err(failure @ (Failure::Reason(_) | Failure::Boundary(_))) => first = first.or(Some(failure)),
                done => return done,
            }
        }
        Err(first.expect("switches are tried"))
    }

    /// One attempt.
    fn ask(
        &self,
        switches: &str,
        request: &TetRequest<'_>,
        points: &[[f64; 3]],
        own: &Used,
        ctx: &Context<'_>,
    ) -> Result<TetComplex, Failure> {
        let folder = Folder::new()?;
        let poly = folder.0.join("core.poly");
        let text = poly_text(&own.points(points), &own.triangles);
        std::fs::write(&poly, text).map_err(|e| unreachable_at(poly.display(), e))?;
        self.call(switches, &folder.0, ctx)?;
        let (found, tets) = read_answer(&folder.0)
            .map_err(|what| MissingInterior::TetgenAnswer { program: self.program.display().to_string(), what })?;
        let n_own = own.vertices.len();
        if found.len() < n_own {
            return Err(Failure::Boundary(TetMisfit::TetgenVertices { given: found.len(), needed: n_own }));
        }
        let tets = tets.into_iter().map(|t| t.map(|v| own.back(v))).collect();
        let mut all = points.to_vec();
        all.extend(&found[n_own..]);
        let tets = inside(request, &all, tets).map_err(Failure::Boundary)?;
        Ok(fitted(request, all.len(), tets, Some(all)))
    }

    /// Runs the program in `folder` until it ends or the context says stop.
    fn call(&self, switches: &str, folder: &Path, ctx: &Context<'_>) -> Result<(), Failure> {
        let program = self.program.display().to_string();
        let file = |name: &str| File::create(folder.join(name)).map_err(|e| unreachable_at(folder.display(), e));
        // Output goes to files: a pipe nobody empties would hang a talkative program.
        let mut child = Command::new(&self.program)
            .args([switches, "core.poly"])
            .current_dir(folder)
            .stdin(Stdio::null())
            .stdout(file("stdout")?)
            .stderr(file("stderr")?)
            .spawn()
            .map_err(|e| MissingInterior::TetgenNotStarted { program: program.clone(), error: e.to_string() })?;
        let mut pause = Duration::from_millis(1);
        let status = loop {
            match child.try_wait() {
                Ok(Some(status)) => break status,
                Ok(None) => {}
                Err(e) => return Err(unreachable_at(program, e).into()),
            }
            if let Some(reason) = ctx.stop() {
                // It may have ended by itself in between.
                let _ = child.kill();
                let _ = child.wait();
                return Err(Failure::Stopped(reason));
            }
            std::thread::sleep(pause);
            pause = (2 * pause).min(Duration::from_millis(50));
        };
        if status.success() {
            return Ok(());
        }
        let words = ["stdout", "stderr"].map(|f| std::fs::read(folder.join(f)).unwrap_or_default());
        let words: Vec<String> = words.iter().map(|w| String::from_utf8_lossy(w).trim().to_owned()).collect();
        let words = words.join(" ");
        let last: String = words.chars().rev().take(600).collect::<Vec<_>>().into_iter().rev().collect();
        let said = last.trim().to_owned();
        Err(MissingInterior::TetgenFailed { program, status: status.to_string(), said }.into())
    }
}

/// The tets on the inner side of the triangles, positively oriented.
fn inside(
    request: &TetRequest<'_>,
    points: &[[f64; 3]],
    mut tets: IdVec<TetId, [VertexId; 4]>,
) -> Result<Vec<[VertexId; 4]>, TetMisfit> {
    // Every face with the tets it belongs to, in order.
    let mut faces: Vec<([VertexId; 3], TetId)> = Vec::with_capacity(4 * tets.len());
    for (t, tet) in tets.enumerate() {
        faces.extend((0..4).map(|i| (sorted(others(i).map(|k| tet[k])), t)));
    }
    faces.sort_unstable();
    // A sorted list instead of a map: faces are asked for a few times each, and the answer keeps the order of the
    // tets.
    let with = |face: [VertexId; 3]| {
        let start = faces.partition_point(|f| f.0 < face);
        faces[start..].iter().take_while(move |f| f.0 == face)
    };
    let mut walls: Vec<[VertexId; 3]> = request.triangles.iter().map(|&t| sorted(t)).collect();
    walls.sort_unstable();
    let missing = request.triangles.iter().filter(|&&t| with(sorted(t)).next().is_none()).count();
    if missing > 0 {
        return Err(TetMisfit::TetgenBoundary { missing, triangles: request.triangles.len() });
    }
    // All tets of tetgen turn the same way, by exact predicates; the sum of their volumes tells which.
    let total: f64 = tets.iter().map(|t| tet_volume(t.map(|v| points[v.index()]))).sum();
    if total < 0.0 {
        tets.iter_mut().for_each(|t| t.swap(2, 3));
    }
    let shows = |tet: &[VertexId; 4], triangle: [VertexId; 3]| {
        OUTWARD.iter().any(|o| {
            let f = o.map(|k| tet[k]);
            (0..3).any(|r| [f[r], f[(r + 1) % 3], f[(r + 2) % 3]] == triangle)
        })
    };
    let mut keep: IdVec<TetId, bool> = IdVec::filled(false, tets.len());
    let mut stack = Vec::new();
    for &triangle in request.triangles {
        match with(sorted(triangle)).map(|f| f.1).find(|&t| shows(&tets[t], triangle)) {
            Some(t) => stack.push(t),
            None => return Err(TetMisfit::TetgenEmptySide { vertices: triangle }),
        }
    }
    // From the wall inward, never through a wall: cavities and the hull's pockets, which tetgen fills as well, are
    // not reached.
    while let Some(t) = stack.pop() {
        if std::mem::replace(&mut keep[t], true) {
            continue;
        }
        for i in 0..4 {
            let face = sorted(others(i).map(|k| tets[t][k]));
            if walls.binary_search(&face).is_err() {
                stack.extend(with(face).map(|f| f.1).filter(|&o| o != t));
            }
        }
    }
    Ok(tets.into_iter().zip(keep).filter(|(_, k)| *k).map(|(t, _)| t).collect())
}

type Answer = (Vec<[f64; 3]>, Vec<[VertexId; 4]>);

/// The vertices and tets that tetgen wrote.
fn read_answer(folder: &Path) -> Result<Answer, String> {
    let read = |name: &str| std::fs::read_to_string(folder.join(name)).map_err(|e| format!("{name}: {e}"));
    let number = |w: &str| w.parse::<f64>().map_err(|e| format!("`{w}`: {e}"));
    let index = |w: &str| w.parse::<u32>().map_err(|e| format!("`{w}`: {e}"));
    let node = read("core.1.node")?;
    let mut points = Vec::new();
    for row in rows(&node, 4).map_err(|e| format!("core.1.node: {e}"))? {
        points.push([number(row[1])?, number(row[2])?, number(row[3])?]);
    }
    let ele = read("core.1.ele")?;
    let mut tets = Vec::new();
    for row in rows(&ele, 5).map_err(|e| format!("core.1.ele: {e}"))? {
        let tet = [index(row[1])?, index(row[2])?, index(row[3])?, index(row[4])?];
        if let Some(v) = tet.iter().find(|&&v| v as usize >= points.len()) {
            return Err(format!("core.1.ele: vertex {v} of {}", points.len()));
        }
        tets.push(tet.map(VertexId));
    }
    Ok((points, tets))
}

/// A surface as a `.poly` file with 0-based indices; positions in the shortest form that reads back to the same bits.
fn poly_text(points: &[[f64; 3]], triangles: &[[VertexId; 3]]) -> String {
    let mut text = format!("{} 3 0 0\n", points.len());
    for (i, p) in points.iter().enumerate() {
        let _ = writeln!(text, "{i} {} {} {}", p[0], p[1], p[2]);
    }
    let _ = writeln!(text, "{} 0", triangles.len());
    for t in triangles {
        let [a, b, c] = t.map(|v| v.0);
        let _ = writeln!(text, "1\n3 {a} {b} {c}");
    }
    text.push_str("0\n0\n");
    text
}

/// The rows of a `.node` or `.ele` file after its header, at least `columns` words each.
fn rows(text: &str, columns: usize) -> Result<Vec<Vec<&str>>, String> {
    let lines = text.lines().map(|l| l.split('#').next().unwrap_or("").trim()).filter(|l| !l.is_empty());
    let mut words = lines.map(|l| l.split_whitespace().collect::<Vec<_>>());
    let header = words.next().ok_or("an empty file")?;
    let wanted: usize = header[0].parse().map_err(|e| format!("`{}`: {e}", header[0]))?;
    let rows: Vec<Vec<&str>> = words.take(wanted).collect();
    if rows.len() < wanted || rows.iter().any(|r| r.len() < columns) {
        return Err(format!("{wanted} rows of {columns} words expected"));
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_written_and_read() {
        let text = poly_text(&[[0.0, 0.1, 1e-300]], &[[VertexId(0); 3]]);
        assert!(text.starts_with("1 3 0 0\n0 0 0.1 "));
        let read = rows("2 3 0 0 # header\n0 0.5 1 2\n# note\n1 3 4 5\n", 4).unwrap();
        assert_eq!(read, [["0", "0.5", "1", "2"], ["1", "3", "4", "5"]]);
        assert!(rows("3 4 0\n0 1 2 3 4\n", 5).is_err());
        assert!(rows("", 5).is_err());
        assert!(rows("many words\n", 5).is_err());
    }
}
