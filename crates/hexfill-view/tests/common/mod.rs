//! Meshes for tests and the demonstration.
// Each test uses its part of these.
#![allow(dead_code)]

use hexfill_mesh::cube::{CORNER_NEIGHBOURS, FACETS};
use hexfill_mesh::{HexId, HexMesh};

/// Connectivity with positions.
pub(crate) struct Shape {
    pub mesh: HexMesh,
    pub points: Vec<[f64; 3]>,
}

/// `nx` by `ny` by `nz` unit cubes.
pub(crate) fn grid(nx: usize, ny: usize, nz: usize) -> Shape {
    let id = |x: usize, y: usize, z: usize| (x + (nx + 1) * (y + (ny + 1) * z)) as u32;
    let mut points = Vec::new();
    let mut hexes = Vec::new();
    for z in 0..=nz {
        for y in 0..=ny {
            for x in 0..=nx {
                points.push([x as f64, y as f64, z as f64]);
                if x < nx && y < ny && z < nz {
                    hexes.push(
                        hexfill_mesh::cube::POSITIONS
                            .map(|p| id(x + p[0] as usize, y + p[1] as usize, z + p[2] as usize)),
                    );
                }
            }
        }
    }
    Shape { mesh: HexMesh::try_new(points.len(), &hexes).unwrap(), points }
}

/// A ball: a core of `k`^3 cubes in `layers` layers of hexes that bend it round; its core has singular edges of valence 3.
pub(crate) fn ball(k: usize, layers: usize) -> Shape {
    let core = grid(k, k, k);
    let half = k as f64 / 2.0;
    let mut points: Vec<[f64; 3]> = core.points.iter().map(|p| p.map(|c| 0.5 * (c - half) / half)).collect();
    let on_boundary = core.mesh.boundary_vertices();
    let shell: Vec<usize> = (0..core.points.len()).filter(|&v| on_boundary[v]).collect();
    let mut place = vec![0; core.points.len()];
    for (i, &v) in shell.iter().enumerate() {
        place[v] = i;
    }
    let at = |v: usize, layer: usize| {
        (if layer == 0 { v } else { core.points.len() + (layer - 1) * shell.len() + place[v] }) as u32
    };
    for layer in 1..=layers {
        for &v in &shell {
            let p = points[v];
            let length = (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]).sqrt();
            let t = layer as f64 / layers as f64;
            points.push(p.map(|c| c * ((1.0 - t) + t * 1.0 / length)));
        }
    }
    let mut hexes = core.mesh.hexes_raw();
    for quad in core.mesh.boundary_quads() {
        for layer in 0..layers {
            let mut hex = [0; 8];
            for (i, v) in quad.iter().enumerate() {
                hex[i] = at(v.index(), layer);
                hex[i + 4] = at(v.index(), layer + 1);
            }
            hexes.push(hex);
        }
    }
    Shape { mesh: HexMesh::try_new(points.len(), &hexes).unwrap(), points }
}

/// A refinement transition (9 quads to 1) of 13 hexes, from joneuhauser/hex-templates F9-1-H13 (MIT); the positions are made up.
pub(crate) fn refinement() -> Shape {
    let mesh = HexMesh::try_new(32, &REFINEMENT).unwrap();
    let points = made_up_positions(&mesh);
    Shape { mesh, points }
}

const REFINEMENT: [[u32; 8]; 13] = [
    [0, 3, 2, 1, 21, 20, 23, 22],
    [21, 20, 23, 22, 28, 30, 31, 29],
    [1, 0, 21, 22, 27, 26, 28, 29],
    [2, 23, 20, 3, 24, 31, 30, 25],
    [21, 20, 30, 28, 9, 7, 6, 8],
    [22, 29, 31, 23, 18, 14, 13, 17],
    [28, 30, 31, 29, 8, 6, 13, 14],
    [30, 31, 13, 6, 25, 24, 12, 5],
    [28, 8, 14, 29, 26, 10, 15, 27],
    [0, 21, 28, 26, 11, 9, 8, 10],
    [1, 27, 29, 22, 19, 15, 14, 18],
    [3, 25, 30, 20, 4, 5, 6, 7],
    [2, 23, 31, 24, 16, 17, 13, 12],
];

/// Positions for a ball: the boundary drawn flat by Tutte's method round its first quad and wrapped on a sphere, inner
/// vertices in the middle of their neighbours.
pub(crate) fn made_up_positions(mesh: &HexMesh) -> Vec<[f64; 3]> {
    let quads = mesh.boundary_quads();
    let n = mesh.n_vertices();
    let mut around = vec![Vec::new(); n];
    for q in &quads {
        for i in 0..4 {
            around[q[i].index()].push(q[(i + 1) % 4].index());
        }
    }
    let mut p = vec![[0.0; 3]; n];
    let outer = quads[0].map(|v| v.index());
    for (v, at) in outer.into_iter().zip([[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [1.0, -1.0]]) {
        p[v] = [2.2 * at[0], 2.2 * at[1], 0.0];
    }
    let relax = |p: &mut Vec<[f64; 3]>, around: &[Vec<usize>], fixed: &dyn Fn(usize) -> bool| {
        for _ in 0..3000 {
            for v in (0..n).filter(|&v| !fixed(v) && !around[v].is_empty()) {
                p[v] =
                    std::array::from_fn(|c| around[v].iter().map(|&w| p[w][c]).sum::<f64>() / around[v].len() as f64);
            }
        }
    };
    let stretch = |p: &mut [f64; 3]| {
        let s = 1.0 + 0.9 / (0.3 + p[0] * p[0] + p[1] * p[1]).sqrt();
        *p = [p[0] * s, p[1] * s, 0.0];
    };
    relax(&mut p, &around, &|v| outer.contains(&v));
    for v in (0..n).filter(|&v| !around[v].is_empty()) {
        stretch(&mut p[v]);
        let [x, y, _] = p[v];
        let r = 0.25 * (x * x + y * y);
        p[v] = [x / (1.0 + r), y / (1.0 + r), (1.0 - r) / (1.0 + r)];
    }
    let on = mesh.boundary_vertices();
    let mut all = vec![Vec::new(); n];
    for [a, b] in mesh.edges() {
        all[a.index()].push(b.index());
        all[b.index()].push(a.index());
    }
    relax(&mut p, &all, &|v| on[v]);
    p
}

/// Least corner determinant over the lengths of its edges, one a hex.
pub(crate) fn scaled_jacobian(shape: &Shape) -> Vec<f64> {
    let corner = |hex: &[hexfill_mesh::VertexId; 8], i: usize| {
        let o = shape.points[hex[i].index()];
        let e = CORNER_NEIGHBOURS[i].map(|k| {
            let p = shape.points[hex[k].index()];
            let d: [f64; 3] = std::array::from_fn(|c| p[c] - o[c]);
            let length = d.iter().map(|c| c * c).sum::<f64>().sqrt();
            d.map(|c| c / length)
        });
        e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) - e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0])
            + e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0])
    };
    shape.mesh.hexes().iter().map(|h| (0..8).map(|i| corner(h, i)).fold(f64::INFINITY, f64::min)).collect()
}

/// An order in which every hex but the first shares a facet with an earlier one.
pub(crate) fn facet_order(mesh: &HexMesh) -> Vec<HexId> {
    let mut order = vec![HexId(0)];
    let mut seen = vec![false; mesh.n_hexes()];
    seen[0] = true;
    let mut i = 0;
    while i < order.len() {
        for side in 0..FACETS.len() {
            if let Some(g) = mesh.neighbour(hexfill_mesh::Facet::new(order[i], side))
                && !std::mem::replace(&mut seen[g.hex().index()], true)
            {
                order.push(g.hex());
            }
        }
        i += 1;
    }
    order
}
