//! Surfaces and the judge for the tests of this crate.

use crate::sweep::Swept;
use hexfill_check::{Judged, Level, judge};
use hexfill_mesh::generate::torus;
use hexfill_mesh::{Context, QuadSurface};

/// A torus of `n` quads round the axis and `m` round the tube, facing outward.
pub(crate) fn torus_at(n: u32, m: u32) -> (QuadSurface, Vec<[f64; 3]>) {
    let turn = std::f64::consts::TAU;
    let mut points = Vec::new();
    for j in 0..n {
        for i in 0..m {
            let (tube, axis) = (turn * f64::from(i) / f64::from(m), turn * f64::from(j) / f64::from(n));
            let d = 3.0 + tube.cos();
            points.push([d * axis.cos(), d * axis.sin(), tube.sin()]);
        }
    }
    let surface = torus(m, n, 0).unwrap();
    let quads: Vec<[u32; 4]> = surface.quads().iter().map(|q| q.map(|v| v.0)).collect();
    let inside = crate::inside::winding_number(&quads, &points, [3.0, 0.0, 0.0]);
    (if inside > 0.0 { surface } else { surface.inverted() }, points)
}

/// The vertices and faces of an OBJ file.
pub(crate) fn read_obj(text: &str) -> (QuadSurface, Vec<[f64; 3]>) {
    let (mut points, mut faces) = (Vec::new(), Vec::new());
    for line in text.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words.first() {
            Some(&"v") => points.push([1, 2, 3].map(|k| words[k].parse::<f64>().unwrap())),
            Some(&"f") => {
                let index = |w: &&str| w.split('/').next().unwrap().parse::<u32>().unwrap() - 1;
                faces.push(words[1..].iter().map(index).collect::<Vec<u32>>());
            }
            _ => {}
        }
    }
    (QuadSurface::try_from_polygons(points.len(), &faces).unwrap(), points)
}

/// Judges a complete filling with levels 1 to 3 and its Euler characteristic, half that of its boundary; the number of hexes.
pub(crate) fn judged(surface: &QuadSurface, swept: &Swept) -> usize {
    assert_eq!(swept.front.len(), 0, "complete");
    let quads: Vec<[u32; 4]> = surface.quads().iter().map(|q| q.map(|v| v.0)).collect();
    let input = Judged::connectivity(swept.n_vertices as usize, &swept.hexes).with_surface(&quads);
    let options = hexfill_check::Options::default().up_to(Level::L3);
    let report = judge(&input, &options, &Context::default());
    assert!(report.passed(Level::L3), "{:?}", report.failures);
    let mesh = hexfill_mesh::HexMesh::try_new(swept.n_vertices as usize, &swept.hexes).unwrap();
    assert_eq!(2 * hexfill_mesh::euler_characteristic(&mesh), surface.euler_characteristic());
    swept.hexes.len()
}
