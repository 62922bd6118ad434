//! [`doctor`]: everything about a surface before the work, and [`cure`]: the smallest changes that make it one to fill.

use crate::describe::describe_surface;
use crate::limits::LimitsInfo;
use crate::problem::Problem;
use hexfill_doctor::{Finding, Findings, MendOptions, Severity, Soup, crossings, examine, mend};
use hexfill_io::{MeshData, OtherFace, closing_tolerance, weld};
use hexfill_mesh::QuadId;
use serde::Serialize;

/// All that is known of a surface before it is filled.
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct Diagnosis {
    /// What points and faces tell, and what the theorems say, each with its remedy.
    #[serde(flatten)]
    pub findings: Findings,
    /// What was recognised and repaired in reading.
    pub notes: Vec<String>,
    /// Whether a hex mesh exists, and why; absent if the faces are no closed surface of quads.
    pub existence: Option<Existence>,
    /// What the positions allow any mesh to reach; absent without positions and without a closed surface.
    pub limits: Option<LimitsInfo>,
    /// Whether `fill` takes the surface as it is.
    pub can_be_filled: bool,
}

/// Whether a hex mesh exists.
#[derive(Clone, Debug, Serialize)]
pub struct Existence {
    /// "exists", "none" or "unknown".
    pub hex_mesh: &'static str,
    /// The theorem, or what stands in the way.
    pub because: String,
}

/// Looks at everything a file says of a surface. Never fails: what cannot be filled is what it is for.
pub fn doctor(name: &str, data: &MeshData) -> Diagnosis {
    let mut findings = examine(&soup(data));
    if let Some(open) = findings.findings.iter_mut().find(|f| f.kind == "open-edges") {
        open.remedy = match closing_tolerance(data) {
            Some(tolerance) => format!("--weld {tolerance} closes it"),
            None => "no welding closes it: close the holes".to_owned(),
        };
    }
    let (mut notes, mut existence, mut limits) = (data.notes.clone(), None, None);
    if let Ok(problem) = Problem::from_data(name, data) {
        notes.clone_from(&problem.notes);
        let info = describe_surface(&problem.surface, problem.points.as_deref());
        if info.hex_mesh == "none" && findings.worst() != Some(Severity::Fatal) {
            findings.findings.push(Finding {
                kind: "no-hex-mesh",
                severity: Severity::Fatal,
                count: 1,
                first: Vec::new(),
                text: format!("no hex mesh exists: {}", info.because),
                remedy: "--refine cuts every quad into four, which makes all cycles even".to_owned(),
            });
        }
        existence = Some(Existence { hex_mesh: info.hex_mesh, because: info.because });
        limits = info.limits;
    }
    let can_be_filled = existence.is_some() && findings.worst() != Some(Severity::Fatal);
    Diagnosis { findings, notes, existence, limits, can_be_filled }
}

/// The pairs of quads that cross each other or touch where they should not, ascending: a mesh of the surface overlaps itself there. Empty without
/// positions.
pub fn crossing_quads(problem: &Problem) -> Vec<[QuadId; 2]> {
    let pairs = crossings(&soup(&problem.data()), usize::MAX);
    pairs.into_iter().map(|pair| pair.map(QuadId)).collect()
}

/// What may be changed.
#[derive(Clone, Copy, Debug, Default)]
#[non_exhaustive]
pub struct CureOptions {
    /// Cut every face into quads.
    pub refine: bool,
}

impl CureOptions {
    /// With every face cut into quads, or not.
    pub fn with_refine(mut self, refine: bool) -> Self {
        self.refine = refine;
        self
    }
}

/// A surface after the smallest changes.
#[derive(Clone, Debug)]
pub struct Cure {
    /// The surface. Points keep their order (their ids, if none were merged), new ones follow; faces keep the tags and data of the faces they come from.
    pub data: MeshData,
    /// What was done, in words.
    pub done: Vec<String>,
}

/// Seams are welded unasked where they are at most so wide, relative to the size of the surface: rounding of an exporter.
const SEAM: f64 = 1e-6;

/// Welds what only rounding keeps open, and says so.
fn weld_seams(data: &mut MeshData) -> Option<String> {
    let tolerance = closing_tolerance(data)?;
    let extent = |k: usize| {
        let all = || data.points.iter().map(|p| p[k]);
        all().fold(f64::MIN, f64::max) - all().fold(f64::MAX, f64::min)
    };
    let size = (0..3).map(extent).fold(0.0, f64::max);
    let mut welded = data.clone();
    let weld = (tolerance <= SEAM * size).then(|| weld(&mut welded, tolerance)).filter(|w| w.collapsed == 0)?;
    *data = welded;
    Some(format!("{} points merged with others at most {tolerance} apart", weld.merged))
}

/// Mends what has one smallest remedy: seams are welded that only rounding keeps open, flat and repeated faces go, triangles are merged in pairs, an odd number of quads becomes even, quads are turned to
/// agree and to face outward.
pub fn cure(name: &str, data: &MeshData, options: &CureOptions) -> Cure {
    let mut data = data.clone();
    let mut done: Vec<String> = weld_seams(&mut data).into_iter().collect();
    let mended = mend(&soup(&data), &MendOptions { refine: options.refine });
    done.extend(mended.done);
    let mut cured = with_faces(&data, &mended.soup, &mended.origin);
    if let Ok(problem) = Problem::from_data(name, &cured) {
        let quads: Vec<[u32; 4]> = problem.surface.quads().iter().map(|q| q.map(|v| v.0)).collect();
        let turned = quads.iter().zip(&cured.quads).filter(|(a, b)| a != b).count();
        if turned > 0 {
            done.push(format!("{turned} quads turned outward"));
            cured.quads = quads;
        }
    }
    Cure { data: cured, done }
}

fn soup(data: &MeshData) -> Soup {
    let points = if data.has_coordinates { data.points.clone() } else { Vec::new() };
    Soup { points, faces: data.faces().map(<[u32]>::to_vec).collect() }
}

/// Other faces, each with the tag and the data of the face it comes from; cells go.
fn with_faces(data: &MeshData, soup: &Soup, origin: &[u32]) -> MeshData {
    let mut quad_of: Vec<Option<usize>> = vec![None; data.face_count()];
    let others: Vec<usize> = data.other_faces.iter().map(|face| face.position).collect();
    let free = (0..data.face_count()).filter(|f| others.binary_search(f).is_err());
    free.enumerate().for_each(|(quad, f)| quad_of[f] = Some(quad));
    let tag_of = |f: u32| match quad_of[f as usize] {
        Some(quad) => data.quad_tags.as_ref().map_or(0, |tags| tags[quad]),
        None => data.other_faces.iter().find(|face| face.position == f as usize).map_or(0, |face| face.tag),
    };
    let mut cured =
        MeshData { points: soup.points.clone(), has_coordinates: data.has_coordinates, ..MeshData::default() };
    let (mut tags, mut from) = (Vec::new(), Vec::new());
    for (position, (face, &f)) in soup.faces.iter().zip(origin).enumerate() {
        if let Ok(quad) = <[u32; 4]>::try_from(face.as_slice()) {
            cured.quads.push(quad);
            tags.push(tag_of(f));
            from.push(quad_of[f as usize]);
        } else {
            cured.other_faces.push(OtherFace { position, vertices: face.clone(), tag: tag_of(f) });
        }
    }
    cured.quad_tags = tags.iter().any(|&t| t != 0).then_some(tags);
    cured.point_tags = data.point_tags.clone().map(|mut tags| {
        tags.resize(soup.n_points(), 0);
        tags
    });
    let longer = |values: &Vec<f64>| {
        let mut values = values.clone();
        values.resize(soup.n_points(), f64::NAN);
        values
    };
    cured.point_data = data.point_data.iter().map(|(name, values)| (name.clone(), longer(values))).collect();
    let of_quads = |values: &Vec<f64>| from.iter().map(|q| q.map_or(f64::NAN, |q| values[q])).collect();
    cured.quad_data = data.quad_data.iter().map(|(name, values)| (name.clone(), of_quads(values))).collect();
    cured.tag_names.clone_from(&data.tag_names);
    cured
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cured_surface_can_be_filled_and_keeps_its_tags() {
        let mut sick = Problem::load(":schneiders-pyramid", None).unwrap().data();
        sick.quad_tags = Some((1..=16).collect());
        sick.quad_data = vec![("heat".to_owned(), (1..=16).map(f64::from).collect())];
        // One quad becomes two triangles; the last comes twice, and all face inward.
        let [a, b, c, d] = sick.quads.remove(3);
        sick.quad_tags.as_mut().unwrap().remove(3);
        sick.quad_data[0].1.remove(3);
        sick.other_faces = vec![
            OtherFace { position: 3, vertices: vec![a, b, c], tag: 40 },
            OtherFace { position: 4, vertices: vec![a, c, d], tag: 41 },
        ];
        let last = *sick.quads.last().unwrap();
        sick.quads.push(last);
        sick.quad_tags.as_mut().unwrap().push(16);
        sick.quad_data[0].1.push(16.0);
        sick.quads.iter_mut().for_each(|quad| quad.reverse());
        sick.other_faces.iter_mut().for_each(|face| face.vertices.reverse());
        let before = doctor("sick", &sick);
        assert!(!before.can_be_filled && before.existence.is_none());
        let cured = cure("sick", &sick, &CureOptions::default());
        assert_eq!(cured.done.len(), 3, "{:?}", cured.done);
        let after = doctor("cured", &cured.data);
        assert!(after.can_be_filled, "{:?}", after.findings);
        let tags = cured.data.quad_tags.clone().unwrap();
        assert_eq!(tags, [1, 2, 3, 40, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16]);
        assert!(cured.data.quad_data[0].1[3].is_nan() && cured.data.quad_data[0].1[4] == 5.0);
        // What is cured is not sick.
        let again = cure("cured", &cured.data, &CureOptions::default());
        assert!(again.done.is_empty() && again.data.quads == cured.data.quads);
    }
}
