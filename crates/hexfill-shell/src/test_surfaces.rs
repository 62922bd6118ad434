//! Surfaces and the judge for the tests of this crate.

use crate::sweep::Swept;
use hexfill_check::{Judged, Level, judge};
use hexfill_mesh::generate::{torus, voxel_surface};
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

/// The boundary of the filled cells of a grid, and how many hexes of the grid lie round each edge.
pub(crate) fn voxels(size: [usize; 3], filled: impl Fn([usize; 3]) -> bool) -> Option<(QuadSurface, Angles)> {
    use hexfill_mesh::cube::{FACETS, POSITIONS};
    let inside = |p: [i64; 3]| (0..3).all(|k| (0..size[k] as i64).contains(&p[k])) && filled(p.map(|x| x as usize));
    let mut ids = std::collections::BTreeMap::new();
    let mut around = std::collections::BTreeMap::new();
    for z in 0..size[2] as i64 {
        for y in 0..size[1] as i64 {
            for x in (0..size[0] as i64).filter(|&x| inside([x, y, z])) {
                let corner = |k: usize| [0, 1, 2].map(|c| [x, y, z][c] + i64::from(POSITIONS[k][c]));
                for (f, facet) in FACETS.iter().enumerate() {
                    let mut beside = [x, y, z];
                    beside[f / 2] += if f % 2 == 0 { -1 } else { 1 };
                    for &k in facet.iter().filter(|_| !inside(beside)) {
                        let next = ids.len() as u32;
                        ids.entry(corner(k)).or_insert(next);
                    }
                }
                for [i, j] in hexfill_mesh::cube::EDGES {
                    let (a, b) = (corner(i), corner(j));
                    *around.entry((a.min(b), a.max(b))).or_insert(0.0f32) += 1.0;
                }
            }
        }
    }
    let surface = voxel_surface(size, filled).ok()?;
    let angles = around.into_iter().filter_map(|((a, b), n)| {
        let (a, b) = (*ids.get(&a)?, *ids.get(&b)?);
        Some(((a.min(b), a.max(b)), n))
    });
    Some((surface, angles.collect()))
}

/// Angles / 90 degrees of edges.
pub(crate) type Angles = std::collections::BTreeMap<(u32, u32), f32>;

/// The boundary of the filled cells of a grid with the positions of its vertices.
pub(crate) fn voxel_points(
    size: [usize; 3],
    filled: impl Fn([usize; 3]) -> bool,
) -> Option<(QuadSurface, Vec<[f64; 3]>)> {
    use hexfill_mesh::cube::{FACETS, POSITIONS};
    let inside = |p: [i64; 3]| (0..3).all(|k| (0..size[k] as i64).contains(&p[k])) && filled(p.map(|x| x as usize));
    // Vertices in the order of `voxel_surface`: by first use, cells with x fastest.
    let mut seen = std::collections::BTreeSet::new();
    let mut points = Vec::new();
    for i in 0..size[0] * size[1] * size[2] {
        let cell = [i % size[0], i / size[0] % size[1], i / size[0] / size[1]].map(|x| x as i64);
        for (f, facet) in FACETS.iter().enumerate().filter(|_| inside(cell)) {
            let mut beside = cell;
            beside[f / 2] += if f % 2 == 0 { -1 } else { 1 };
            for &k in facet.iter().filter(|_| !inside(beside)) {
                let p = [0, 1, 2].map(|c| cell[c] + i64::from(POSITIONS[k][c]));
                if seen.insert(p) {
                    points.push(p.map(|x| x as f64));
                }
            }
        }
    }
    Some((voxel_surface(size, filled).ok()?, points))
}
