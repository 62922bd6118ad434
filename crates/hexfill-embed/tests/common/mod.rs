//! Meshes and judging shared by the tests.
#![allow(dead_code)] // each test binary uses its part

use hexfill_check::{Judged, Level, judge};
use hexfill_mesh::{Context, HexMesh};
use serde::Deserialize;

/// A mesh with the coordinates of its boundary.
#[derive(Deserialize)]
pub(crate) struct Sample {
    pub hexes: Vec<[u32; 8]>,
    pub boundary_points: Vec<[f64; 3]>,
}

impl Sample {
    /// Reads `tests/data/NAME.json`.
    pub(crate) fn read(name: &str) -> Self {
        let path = format!("{}/tests/data/{name}.json", env!("CARGO_MANIFEST_DIR"));
        serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
    }

    pub(crate) fn mesh(&self) -> HexMesh {
        let n = self.hexes.iter().flatten().max().map_or(0, |&v| v as usize + 1);
        HexMesh::try_new(n, &self.hexes).unwrap()
    }
}

/// The cube cut into n x n x n hexes, and its points; interior points are moved by up to `noise` cells (fixed pseudo-random).
pub(crate) fn grid(n: usize, noise: f64) -> (HexMesh, Vec<[f64; 3]>) {
    let at = |i: usize, j: usize, k: usize| (i + (n + 1) * (j + (n + 1) * k)) as u32;
    let mut hexes = Vec::new();
    let mut points = Vec::new();
    let mut state = 12345u64;
    let mut random = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 33) as f64 / (1u64 << 30) as f64 - 1.0
    };
    for k in 0..=n {
        for j in 0..=n {
            for i in 0..=n {
                let inner = [i, j, k].iter().all(|&x| x > 0 && x < n);
                points.push([i, j, k].map(|x| (x as f64 + if inner { noise * random() } else { 0.0 }) / n as f64));
                if i < n && j < n && k < n {
                    hexes.push(
                        hexfill_mesh::cube::POSITIONS
                            .map(|p| at(i + p[0] as usize, j + p[1] as usize, k + p[2] as usize)),
                    );
                }
            }
        }
    }
    (HexMesh::try_new(points.len(), &hexes).unwrap(), points)
}

/// A ball: the cube cut into n x n x n hexes behind a pillow of 6 n^2, whose outer vertices lie on the unit sphere; and first points.
pub(crate) fn ball(n: usize) -> (HexMesh, Vec<[f64; 3]>) {
    let (cube, points) = grid(n, 0.0);
    let mut points: Vec<[f64; 3]> = points.iter().map(|p| p.map(|x| x - 0.5)).collect();
    let mut outer = vec![u32::MAX; points.len()];
    for (v, _) in cube.boundary_vertices().iter().enumerate().filter(|(_, on)| **on) {
        let p = points[v];
        let length = p.iter().map(|x| x * x).sum::<f64>().sqrt();
        outer[v] = points.len() as u32;
        points.push(p.map(|x| x / length));
    }
    let mut hexes = cube.hexes_raw();
    for facet in hexes.clone().iter().flat_map(|h| hexfill_mesh::cube::FACETS.map(|f| f.map(|i| h[i]))) {
        // A facet belongs to the boundary if all its vertices have one coordinate at the end of its range.
        let on = |k: usize, end: f64| facet.iter().all(|&v| points[v as usize][k] == end);
        if (0..3).any(|k| on(k, -0.5) || on(k, 0.5)) {
            let [a, b, c, d] = facet;
            hexes.push([a, b, c, d, outer[a as usize], outer[b as usize], outer[c as usize], outer[d as usize]]);
        }
    }
    (HexMesh::try_new(points.len(), &hexes).unwrap(), points)
}

/// Whether the independent judge certifies det J > 0 in every hex, and its certified interval of the worst scaled Jacobian.
pub(crate) fn certified(mesh: &HexMesh, points: &[[f64; 3]]) -> (bool, [f64; 2]) {
    let hexes = mesh.hexes_raw();
    let input = Judged::connectivity(mesh.n_vertices(), &hexes).with_points(points);
    let report = judge(&input, &hexfill_check::Options::default().with_quality(true), &Context::default());
    let interval = report.geometry.as_ref().and_then(|g| g.quality.as_ref()).map(|q| q.certified_scaled_jacobian);
    (report.passed(Level::L5), interval.unwrap_or([-1.0; 2]))
}

/// The boundary vertices of `points` have the bits of `boundary`.
pub(crate) fn assert_boundary_kept(mesh: &HexMesh, boundary: &[[f64; 3]], points: &[[f64; 3]]) {
    for (v, _) in mesh.boundary_vertices().iter().enumerate().filter(|(_, on)| **on) {
        assert_eq!(points[v].map(f64::to_bits), boundary[v].map(f64::to_bits), "vertex {v} moved");
    }
}
