//! [`examine`]: everything about a surface at once, each finding with its remedy.
//!
//! Source: ours.

use crate::crossing::crossings;
use crate::faults::{
    coincident_points, degenerate_faces, is_degenerate, points_not_finite, repeated_faces, slivers_and_reflex,
    unused_points,
};
use crate::parity::{ParityChange, parity_changes};
use crate::soup::Soup;
use crate::triangles::merged_triangles;
use hexfill_mesh::{Edge, QuadId, QuadSurface, SurfaceError, VertexId, improper_pairs};
use serde::Serialize;
use std::collections::BTreeMap;

/// What a finding means for a hex mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Severity {
    /// Fine, but good to know.
    Remark,
    /// A mesh can be made, but no good one, or none with valid coordinates.
    Poor,
    /// No mesh can be made of the surface as it is.
    Fatal,
}

/// One thing found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// Its kind, one word a kind: `open-edges`, `crossing-quads`, ...
    pub kind: &'static str,
    /// What it means.
    pub severity: Severity,
    /// How many there are.
    pub count: usize,
    /// The first of them: `f` faces in the order of the file, `q` quads, `v` points, `v1-v2` edges, all from 0.
    pub first: Vec<String>,
    /// In words.
    pub text: String,
    /// What to do.
    pub remedy: String,
}

/// How many of a kind are named.
const NAMED: usize = 10;
/// So many crossings are looked for.
const MOST_CROSSINGS: usize = 100_000;

impl Finding {
    /// A finding about these; `None` if there are none.
    pub fn of<T: ToString>(
        kind: &'static str,
        severity: Severity,
        all: &[T],
        text: impl Fn(usize) -> String,
        remedy: &str,
    ) -> Option<Self> {
        let first = all.iter().take(NAMED).map(T::to_string).collect();
        let remedy = remedy.to_owned();
        (!all.is_empty()).then(|| Self { kind, severity, count: all.len(), first, text: text(all.len()), remedy })
    }
}

impl std::fmt::Display for Finding {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let word = match self.severity {
            Severity::Remark => "remark",
            Severity::Poor => "poor",
            Severity::Fatal => "fatal",
        };
        write!(f, "{word}: {}", self.text)?;
        if !self.first.is_empty() {
            let more = if self.count > self.first.len() { ", ..." } else { "" };
            write!(f, ": {}{more}", self.first.join(", "))?;
        }
        if self.remedy.is_empty() { Ok(()) } else { write!(f, "; {}", self.remedy) }
    }
}

/// All that was found.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Findings {
    /// Points of the file.
    pub points: usize,
    /// Faces by number of sides.
    pub faces: BTreeMap<usize, usize>,
    /// What was found, in the order it is looked for.
    pub findings: Vec<Finding>,
    /// What was not looked for, since something before must be mended first.
    pub not_examined: Option<String>,
    /// The smallest changes that make an odd number of quads even.
    pub parity_changes: Vec<ParityChange>,
}

impl Findings {
    /// The worst finding; `None`: nothing was found.
    pub fn worst(&self) -> Option<Severity> {
        self.findings.iter().map(|f| f.severity).max()
    }
}

fn s(n: usize) -> &'static str {
    if n == 1 { "" } else { "s" }
}

/// Looks at everything that points and faces tell.
///
/// # Example
/// ```
/// use hexfill_doctor::{Severity, Soup, examine};
///
/// let mut faces: Vec<Vec<u32>> =
///     [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]].map(Vec::from).into();
/// faces.pop();
/// let found = examine(&Soup { points: Vec::new(), faces });
/// let open = found.findings.iter().find(|finding| finding.kind == "open-edges").expect("one quad is missing");
/// assert_eq!((open.count, open.severity), (4, Severity::Fatal));
/// ```
pub fn examine(soup: &Soup) -> Findings {
    let mut all = Findings { points: soup.n_points(), ..Findings::default() };
    for face in &soup.faces {
        *all.faces.entry(face.len()).or_default() += 1;
    }
    let faces = |ids: Vec<u32>| -> Vec<String> { ids.into_iter().map(|f| format!("f{f}")).collect() };
    let vertices = |ids: Vec<u32>| -> Vec<VertexId> { ids.into_iter().map(VertexId).collect() };
    all.findings.extend(not_quads(soup));
    let by_themselves = [
        Finding::of(
            "degenerate-faces",
            Severity::Fatal,
            &faces(degenerate_faces(soup)),
            |n| format!("{n} face{} with a point used twice", s(n)),
            "--fix removes them",
        ),
        Finding::of(
            "repeated-faces",
            Severity::Fatal,
            &faces(repeated_faces(soup)),
            |n| format!("{n} face{} with the same points as an earlier one", s(n)),
            "--fix removes the copies",
        ),
        Finding::of(
            "points-not-finite",
            Severity::Fatal,
            &vertices(points_not_finite(soup)),
            |n| format!("{n} point{} with a coordinate that is no finite number", s(n)),
            "write the file again",
        ),
        Finding::of(
            "coincident-points",
            Severity::Poor,
            &vertices(coincident_points(soup)),
            |n| format!("{n} point{} at the very place of another", s(n)),
            "--weld 0 joins them",
        ),
        Finding::of(
            "unused-points",
            Severity::Remark,
            &vertices(unused_points(soup)),
            |n| format!("{n} point{} that no face uses", s(n)),
            "kept as they are",
        ),
    ];
    all.findings.extend(by_themselves.into_iter().flatten());
    // Findings so far need no surface and are all told; those that follow need one, and where there is none it is
    // said what was not looked at.
    match soup.surface() {
        Ok(surface) => all.look_at_surface(soup, &surface),
        Err(error) => {
            all.findings.extend(edges_and_vertices(soup, &error));
            all.not_examined = Some(
                "parity, pairs of quads that share too much, and limits, which only a closed surface of quads has"
                    .to_owned(),
            );
        }
    }
    all.look_at_shapes(soup);
    all
}

fn not_quads(soup: &Soup) -> Vec<Finding> {
    let n = soup.faces.iter().filter(|face| face.len() == 3).count();
    let larger: Vec<String> =
        soup.faces.iter().enumerate().filter(|(_, face)| face.len() > 4).map(|(f, _)| format!("f{f}")).collect();
    let mut found = Vec::new();
    if n > 0 {
        let (merged, alone) = merged_triangles(soup);
        let remedy = if alone.is_empty() {
            format!("--fix merges them in {} pairs", merged.len())
        } else if merged.is_empty() {
            "--refine cuts every face into quads".to_owned()
        } else {
            format!(
                "{} pairs can be merged, {} stay alone; --refine cuts every face into quads",
                merged.len(),
                alone.len()
            )
        };
        let triangles: Vec<String> =
            soup.faces.iter().enumerate().filter(|(_, face)| face.len() == 3).map(|(f, _)| format!("f{f}")).collect();
        found.extend(Finding::of(
            "triangles",
            Severity::Fatal,
            &triangles,
            |n| format!("{n} triangle{}", s(n)),
            &remedy,
        ));
    }
    found.extend(Finding::of(
        "polygons",
        Severity::Fatal,
        &larger,
        |n| format!("{n} face{} with more than four sides", s(n)),
        "--refine cuts every face into quads",
    ));
    found
}

/// What keeps faces from being a closed surface. The error says what was met first; edges are counted here whatever came before.
fn edges_and_vertices(soup: &Soup, error: &SurfaceError) -> Vec<Finding> {
    let mut uses: BTreeMap<[u32; 2], usize> = BTreeMap::new();
    for face in soup.faces.iter().filter(|face| !is_degenerate(face)) {
        for k in 0..face.len() {
            let (a, b) = (face[k], face[(k + 1) % face.len()]);
            *uses.entry([a.min(b), a.max(b)]).or_default() += 1;
        }
    }
    let with = |is_one: fn(usize) -> bool| -> Vec<Edge> {
        uses.iter().filter(|(_, n)| is_one(**n)).map(|(&[a, b], _)| Edge(VertexId(a), VertexId(b))).collect()
    };
    // Ordered by ids through the map, so that the first ten are always the same ten.
    let (open, many) = (with(|n| n == 1), with(|n| n > 2));
    let mut found: Vec<Finding> = [
        Finding::of(
            "open-edges",
            Severity::Fatal,
            &open,
            |n| format!("the surface is open at {n} edge{}", s(n)),
            "close the holes, or weld the seams (--weld)",
        ),
        Finding::of(
            "non-manifold-edges",
            Severity::Fatal,
            &many,
            |n| format!("{n} edge{} in three or more faces", s(n)),
            "remove inner walls, or split the surface there",
        ),
    ]
    .into_iter()
    .flatten()
    .collect();
    // Where the error names its remedy there is no other.
    let other = match error {
        SurfaceError::Empty => Some(("empty", "see whether it is the right file")),
        SurfaceError::NonManifoldVertices { .. } => Some(("non-manifold-vertices", "")),
        SurfaceError::NotOrientable { .. } => {
            Some(("not-orientable", "see whether a strip is glued the wrong way round"))
        }
        SurfaceError::IndexOutOfRange { .. } => Some(("index-out-of-range", "write the file again")),
        SurfaceError::TooLarge { .. } => Some(("too-large", "")),
        _ => None,
    };
    found.extend(other.map(|(kind, remedy)| Finding {
        kind,
        severity: Severity::Fatal,
        count: 1,
        first: Vec::new(),
        text: error.to_string(),
        remedy: remedy.to_owned(),
    }));
    found
}

impl Findings {
    fn look_at_surface(&mut self, soup: &Soup, surface: &QuadSurface) {
        self.findings.extend(Finding::of(
            "turned-quads",
            Severity::Remark,
            surface.reversed(),
            |n| format!("{n} quad{} turned against the neighbours", s(n)),
            "they are turned back",
        ));
        let n = surface.n_quads();
        if !n.is_multiple_of(2) {
            self.parity_changes =
                if soup.points.is_empty() { Vec::new() } else { parity_changes(surface, &soup.points) };
            let ways: Vec<String> = self.parity_changes.iter().map(ToString::to_string).collect();
            self.findings.push(Finding {
                kind: "odd-quads",
                severity: Severity::Fatal,
                count: n,
                first: Vec::new(),
                text: format!("{n} quads, an odd number: every hex mesh has an even number of boundary quads"),
                remedy: if ways.is_empty() {
                    "--refine cuts every quad into four".to_owned()
                } else {
                    format!("--fix makes the smallest change: {}", ways.join(", or "))
                },
            });
        }
        let pairs = improper_pairs(surface);
        if pairs.count > 0 {
            self.findings.push(Finding {
                kind: "improper-pairs",
                severity: Severity::Fatal,
                count: pairs.count,
                first: pairs.first.iter().map(|p| format!("{}+{}", p.quads[0], p.quads[1])).collect(),
                text: format!(
                    "{} pair{} of quads that share more than a vertex or an edge",
                    pairs.count,
                    s(pairs.count)
                ),
                remedy: "refine the surface there, or everywhere with --refine".to_owned(),
            });
        }
    }

    fn look_at_shapes(&mut self, soup: &Soup) {
        if soup.points.is_empty() {
            return;
        }
        let all_quads = soup.faces.iter().all(|face| face.len() == 4);
        let name = |f: u32| if all_quads { QuadId(f).to_string() } else { format!("f{f}") };
        let pairs: Vec<String> = crossings(soup, MOST_CROSSINGS).iter().map(|p| p.map(name).join("+")).collect();
        let (slivers, reflex) = slivers_and_reflex(soup);
        let named = |all: Vec<u32>| -> Vec<String> { all.into_iter().map(name).collect() };
        let shapes = [
            Finding::of(
                "crossing-faces",
                Severity::Poor,
                &pairs,
                |n| {
                    format!(
                        "{n}{} pair{} of faces cross or touch",
                        if n == MOST_CROSSINGS { " or more" } else { "" },
                        s(n)
                    )
                },
                "a mesh of this surface overlaps itself: cut the solids out of each other first, or move a vertex",
            ),
            Finding::of(
                "slivers",
                Severity::Poor,
                &named(slivers),
                |n| format!("{n} quad{} of next to no area", s(n)),
                "collapse or move them: hexes on them are flat",
            ),
            Finding::of(
                "reflex-quads",
                Severity::Poor,
                &named(reflex),
                |n| format!("{n} quad{} with a straight or reflex corner", s(n)),
                "move a vertex: hexes on such quads are hardly ever valid",
            ),
        ];
        self.findings.extend(shapes.into_iter().flatten());
    }
}
