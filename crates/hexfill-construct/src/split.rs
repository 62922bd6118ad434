//! Step 7: every tetrahedron becomes 4, 7 or 8 hexes: 4 and one for each edge that Sigma cuts.
//!
//! Points: the vertices, one point an edge (two if cut, one at each end), one a face (two if cut: on the side of
//! its lone vertex and on the side of the other two) and one a tet (two if cut). A corner hex takes all its points on
//! the side of its vertex; a sheet hex joins the two copies round a cut edge. The pattern on a face depends on
//! Sigma alone, so tets fit, and on the boundary it is the pattern of the inner facets (Erickson 2014, figure 8).

use crate::error::ConstructError;
use crate::layer::Layer;
use crate::tets::{OUTWARD, TET_EDGES, TetComplex, others, tet_edge};
use hexfill_mesh::QuadId;

const NONE: u32 = u32::MAX;

/// Ids of the points of the core.
#[derive(Clone, Debug)]
pub struct CorePoints {
    /// Per vertex.
    pub vertex: Vec<u32>,
    /// Per edge: the points at the end with the smaller vertex id and at the other (equal if not cut).
    pub edge: Vec<[u32; 2]>,
    /// Per face: the points on the side of the lone vertex and on the other (equal if not cut).
    pub face: Vec<[u32; 2]>,
    /// Per tet: the points on the side of its vertex 0 and on the other (equal if not cut).
    pub tet: Vec<[u32; 2]>,
    /// First id not used.
    pub end: u32,
}

/// Side of each vertex of a tet (vertex 0 is on side `false`), if the cut edges are those of a cut of K4.
#[inline]
fn sides(cut: &[bool], edges: &[u32; 6]) -> Option<[bool; 4]> {
    let s = |k: usize| cut[edges[k] as usize];
    let side = [false, s(0), s(1), s(2)];
    let fits = TET_EDGES.iter().enumerate().all(|(k, &[i, j])| s(k) == (side[i] != side[j]));
    fits.then_some(side)
}

/// Numbers the points of the core: those on the inner facets are the layer's, the others start at `first`.
///
/// # Errors
/// [`ConstructError::TetBoundary`] if `cut` is no cocycle or differs from the layer on the boundary;
/// [`ConstructError::TooLarge`].
pub fn core_points(
    complex: &TetComplex,
    cut: &[bool],
    boundary: &[u32],
    layer: &Layer<'_>,
    n_surface_vertices: usize,
    first: u32,
) -> Result<CorePoints, ConstructError> {
    let bound = first as usize + complex.n_vertices + 2 * (complex.n_edges + complex.n_faces + complex.tets.len());
    if bound > u32::MAX as usize {
        return Err(ConstructError::TooLarge { what: "vertices", given: bound, limit: u32::MAX as usize });
    }
    let err = |reason: String| Err(ConstructError::TetBoundary { reason });
    let mut p = CorePoints {
        vertex: vec![NONE; complex.n_vertices],
        edge: vec![[NONE; 2]; complex.n_edges],
        face: vec![[NONE; 2]; complex.n_faces],
        tet: Vec::with_capacity(complex.tets.len()),
        end: first,
    };
    let mut triangle_of = vec![NONE; complex.n_faces];
    for (t, &f) in boundary.iter().enumerate() {
        triangle_of[f as usize] = t as u32;
    }
    // Points on the inner facets, from the one tet behind each triangle.
    for (t, tet) in complex.tets.iter().enumerate() {
        for i in 0..4 {
            let f = complex.tet_faces[t][i] as usize;
            if triangle_of[f] == NONE {
                continue;
            }
            let (q, half) = (QuadId(triangle_of[f] / 2), (triangle_of[f] % 2) as u8);
            p.face[f] = [layer.face_point(q, half, true), layer.face_point(q, half, false)];
            let corners = if half == 0 { [0u8, 1, 2] } else { [2, 3, 0] };
            let local = corners.map(|k| {
                let v = layer.corner(q, k);
                p.vertex[v.index()] = layer.inner(v);
                others(i).into_iter().find(|&j| tet[j] == v.0)
            });
            let [Some(a), Some(o), Some(b)] = local else {
                return err(format!("face {f} has other vertices than its triangle"));
            };
            let mut set = |i: usize, j: usize, at_i: u32, at_j: u32, is_cut: bool| {
                let e = complex.tet_edges[t][tet_edge(i, j)] as usize;
                p.edge[e] = if tet[i] < tet[j] { [at_i, at_j] } else { [at_j, at_i] };
                cut[e] == is_cut
            };
            let d = layer.diagonal_point(q);
            let mut agree = set(a, b, d, d, false);
            for (i, j, side) in [(a, o, 2 * half), (o, b, 2 * half + 1)] {
                let dart = layer.dart(q, side);
                let (here, there) = layer.edge_points(dart);
                agree &= set(i, j, here, there, layer.is_cut(dart));
            }
            if !agree {
                return err(format!("Sigma disagrees with the inner facet of quad {}", q.0));
            }
        }
    }
    let mut take = |n: u32| {
        p.end += n;
        p.end - n
    };
    for (v, point) in p.vertex.iter_mut().enumerate() {
        if *point == NONE && v >= n_surface_vertices {
            *point = take(1);
        }
    }
    for (e, points) in p.edge.iter_mut().enumerate() {
        if points[0] == NONE {
            let a = take(1 + u32::from(cut[e]));
            *points = [a, a + u32::from(cut[e])];
        }
    }
    for t in 0..complex.tets.len() {
        let Some(side) = sides(cut, &complex.tet_edges[t]) else {
            return err(format!("Sigma is no surface in tetrahedron {t}"));
        };
        for i in 0..4 {
            let points = &mut p.face[complex.tet_faces[t][i] as usize];
            if points[0] == NONE {
                let [a, b, c] = others(i).map(|k| side[k]);
                let is_cut = a != b || b != c;
                let first = take(1 + u32::from(is_cut));
                *points = [first, first + u32::from(is_cut)];
            }
        }
        let is_cut = side.contains(&true);
        let first = take(1 + u32::from(is_cut));
        p.tet.push([first, first + u32::from(is_cut)]);
    }
    Ok(p)
}

/// Appends the hexes of all tets. Call [`core_points`] first: it checks what is relied on here.
pub fn split_tets(complex: &TetComplex, cut: &[bool], points: &CorePoints, hexes: &mut Vec<[u32; 8]>) {
    for (t, tet) in complex.tets.iter().enumerate() {
        let side = sides(cut, &complex.tet_edges[t]).unwrap_or([false; 4]);
        let v = |i: usize| points.vertex[tet[i] as usize];
        // The point of edge ij at the end i.
        let e = |i: usize, j: usize| {
            let id = complex.tet_edges[t][tet_edge(i, j)] as usize;
            points.edge[id][usize::from(tet[i] > tet[j])]
        };
        // The point of the face opposite m on the side of i.
        let f = |m: usize, i: usize| {
            let id = complex.tet_faces[t][m] as usize;
            let alike = others(m).into_iter().filter(|&k| side[k] == side[i]).count();
            points.face[id][usize::from(alike != 1)]
        };
        let z = |i: usize| points.tet[t][usize::from(side[i])];
        for (i, &[j, k, l]) in OUTWARD.iter().enumerate() {
            hexes.push([v(i), e(i, j), f(l, i), e(i, k), e(i, l), f(k, i), z(i), f(j, i)]);
        }
        for (n, &[i, j]) in TET_EDGES.iter().enumerate() {
            if side[i] != side[j] {
                // The other two, so that (i, j, k, l) is an even permutation.
                let [k, l] = [[2, 3], [3, 1], [1, 2], [0, 3], [2, 0], [0, 1]][n];
                let half = |s: usize, o: usize| [e(s, o), f(l, s), z(s), f(k, s)];
                let (bottom, top) = (half(i, j), half(j, i));
                hexes.push([bottom[0], bottom[1], bottom[2], bottom[3], top[0], top[1], top[2], top[3]]);
            }
        }
    }
}
