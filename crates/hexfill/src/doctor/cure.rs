//! [`cure`]: the smallest changes that make a surface one to fill.
//!
//! Source: ours.

use crate::problem::Problem;
use hexfill_doctor::{MendOptions, Soup, mend};
use hexfill_io::{MeshData, OtherFace, closing_tolerance, weld};

/// What may be changed besides what has one smallest remedy.
///
/// | option | default |
/// |---|---|
/// | [`with_refine`](Self::with_refine) | no: faces stay whole where they can |
#[derive(Clone, Copy, Debug, Default)]
#[non_exhaustive]
pub struct CureOptions {
    pub(crate) refine: bool,
}

impl CureOptions {
    /// Whether every face is cut into quads round its middle, a face of n sides into n.
    #[must_use]
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
    let mended = mend(&soup(&data), &MendOptions::default().with_refine(options.refine));
    done.extend(mended.done);
    let mut cured = with_faces(&data, &mended.soup, &mended.origin);
    if let Ok(problem) = Problem::from_data(name, &cured) {
        let quads = problem.surface.quads_raw();
        let turned = quads.iter().zip(&cured.quads).filter(|(a, b)| a != b).count();
        if turned > 0 {
            done.push(format!("{turned} quads turned outward"));
            cured.quads = quads;
        }
    }
    Cure { data: cured, done }
}

/// The faces of a file as the doctor takes them.
pub(crate) fn soup(data: &MeshData) -> Soup {
    let points = if data.has_coordinates { data.points.clone() } else { Vec::new() };
    Soup { points, faces: data.faces().map(<[u32]>::to_vec).collect() }
}

/// Other faces, each with the tag and the data of the face it comes from; cells go.
fn with_faces(data: &MeshData, soup: &Soup, origin: &[u32]) -> MeshData {
    let old: Vec<(Option<usize>, i64)> = data.numbered_faces().map(|(quad, _, tag)| (quad, tag)).collect();
    let mut cured =
        MeshData { points: soup.points.clone(), has_coordinates: data.has_coordinates, ..MeshData::default() };
    let (mut tags, mut from) = (Vec::new(), Vec::new());
    for (position, (face, &f)) in soup.faces.iter().zip(origin).enumerate() {
        let (quad_before, tag) = old[f as usize];
        if let Ok(quad) = <[u32; 4]>::try_from(face.as_slice()) {
            cured.quads.push(quad);
            tags.push(tag);
            from.push(quad_before);
        } else {
            cured.other_faces.push(OtherFace { position, vertices: face.clone(), tag });
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
    use crate::doctor::doctor;

    #[test]
    fn a_cured_surface_can_be_filled_and_keeps_its_tags() {
        let mut sick = Problem::named("schneiders-pyramid").unwrap().data();
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
