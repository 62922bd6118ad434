//! The core as hexes: every tetrahedron becomes 4, 7 or 8 hexes: 4 and one for each edge that Sigma cuts.
//!
//! Points: the vertices, one point an edge (two if cut, one at each end), one a face (two if cut: on the side of
//! its lone vertex and on the side of the other two) and one a tet (two if cut). A corner hex takes all its points on
//! the side of its vertex; a sheet hex joins the two copies round a cut edge. The pattern on a face depends on
//! Sigma alone, so tets fit, and on the boundary it is the pattern of the inner facets (Erickson 2014, figure 8).
//!
//! Source: Erickson 2014, section 5 and figure 8; the tables by local numbers are ours.

use crate::core::Inside;
use crate::core::complex::{OUTWARD, TET_EDGES, TetComplex, others, tet_edge};
use crate::cut::Sigma;
use crate::error::ConstructError;
use crate::ids::{EdgeId, FaceId, PointId, TetId};
use crate::layer::Layer;
use crate::misfit::TetMisfit;
use crate::plan::Plan;
use hexfill_mesh::{IdVec, QuadId, VertexId};

/// Ids of the points of the core.
pub(crate) struct CorePoints {
    pub(crate) vertex: IdVec<VertexId, PointId>,
    /// Per edge: the points at the end with the smaller vertex id and at the other (equal if not cut).
    pub(crate) edge: IdVec<EdgeId, [PointId; 2]>,
    /// Per face: the points on the side of the lone vertex and on the other (equal if not cut).
    pub(crate) face: IdVec<FaceId, [PointId; 2]>,
    /// Per tet: the points on the side of its vertex 0 and on the other (equal if not cut).
    pub(crate) tet: IdVec<TetId, [PointId; 2]>,
    /// First id not used.
    pub(crate) end: PointId,
}

/// Side of each vertex of a tet (vertex 0 is on side `false`), if the cut edges are those of a cut of K4.
#[inline]
fn sides(cut: &Sigma, edges: &[EdgeId; 6]) -> Option<[bool; 4]> {
    let s = |k: usize| cut[edges[k]];
    let side = [false, s(0), s(1), s(2)];
    // Three edges tell the sides. The other three agree with them iff every triangle has 0 or 2 cut edges (Sigma is a
    // cocycle), and then 0, 3 or 4 edges are cut: no other case exists.
    let fits = TET_EDGES.iter().enumerate().all(|(k, &[i, j])| s(k) == (side[i] != side[j]));
    fits.then_some(side)
}

fn misfit<T>(reason: TetMisfit) -> Result<T, ConstructError> {
    Err(ConstructError::TetBoundary { reason })
}

/// Numbers the points of the core: those on the inner facets are the layer's, the others start at `first`.
///
/// # Errors
/// [`ConstructError::TetBoundary`] if `cut` is no cocycle or differs from the layer on the boundary;
/// [`ConstructError::TooLarge`].
pub(super) fn core_points(
    plan: &Plan<'_>,
    inside: &Inside,
    layer: &Layer<'_>,
    cut: &Sigma,
    first: usize,
) -> Result<CorePoints, ConstructError> {
    let complex = &inside.complex;
    let bound = first + complex.n_vertices + 2 * (complex.n_edges + complex.n_faces + complex.tets.len());
    // Of the points before the core alone, if these are too many already.
    let given = if first > u32::MAX as usize { first } else { bound };
    if bound > u32::MAX as usize {
        return Err(ConstructError::TooLarge { what: "vertices", given, limit: u32::MAX as usize });
    }
    let mut points = CorePoints {
        vertex: IdVec::filled(PointId::NONE, complex.n_vertices),
        edge: IdVec::filled([PointId::NONE; 2], complex.n_edges),
        face: IdVec::filled([PointId::NONE; 2], complex.n_faces),
        tet: IdVec::with_capacity(complex.tets.len()),
        end: PointId::new(first),
    };
    points.take_from_layer(inside, layer, cut)?;
    points.number_rest(complex, cut, plan.surface.n_vertices())?;
    Ok(points)
}

impl CorePoints {
    fn take(&mut self, n: u32) -> PointId {
        let first = self.end;
        self.end = first.plus(n);
        first
    }

    /// One point, or one on either side of Sigma.
    fn take_pair(&mut self, is_cut: bool) -> [PointId; 2] {
        let more = u32::from(is_cut);
        let first = self.take(1 + more);
        [first, first.plus(more)]
    }

    /// Points on the inner facets, from the one tet behind each triangle.
    fn take_from_layer(&mut self, inside: &Inside, layer: &Layer<'_>, cut: &Sigma) -> Result<(), ConstructError> {
        let complex = &inside.complex;
        let mut triangle_of = IdVec::filled(None, complex.n_faces);
        for (t, &f) in inside.boundary.iter().enumerate() {
            triangle_of[f] = Some(t);
        }
        for (t, tet) in complex.tets.enumerate() {
            for i in 0..4 {
                let f = complex.tet_faces[t][i];
                let Some(triangle) = triangle_of[f] else { continue };
                let (q, half) = (QuadId::new(triangle / 2), (triangle % 2) as u8);
                self.face[f] = [layer.face_point(q, half, true), layer.face_point(q, half, false)];
                let corners = if half == 0 { [0u8, 1, 2] } else { [2, 3, 0] };
                let local = corners.map(|k| {
                    let v = layer.corner(q, k);
                    self.vertex[v] = layer.inner(v);
                    others(i).into_iter().find(|&j| tet[j] == v)
                });
                let [Some(a), Some(o), Some(b)] = local else {
                    return misfit(TetMisfit::OtherFace { face: f });
                };
                let mut set = |i: usize, j: usize, at_i: PointId, at_j: PointId, is_cut: bool| {
                    let e = complex.tet_edges[t][tet_edge(i, j)];
                    // By vertex id, not by the place in this tet: every tet round the edge reads the pair in the same
                    // order.
                    self.edge[e] = if tet[i] < tet[j] { [at_i, at_j] } else { [at_j, at_i] };
                    cut[e] == is_cut
                };
                let d = layer.diagonal_point(q);
                // The cells above were filled for a diagonal that is not cut; a Sigma that crossed it would split
                // these triangles in another pattern.
                let mut agree = set(a, b, d, d, false);
                for (i, j, side) in [(a, o, 2 * half), (o, b, 2 * half + 1)] {
                    let dart = layer.dart(q, side);
                    let (here, there) = layer.edge_points(dart);
                    agree &= set(i, j, here, there, layer.is_cut(dart));
                }
                if !agree {
                    return misfit(TetMisfit::SigmaAtBoundary { quad: q });
                }
            }
        }
        Ok(())
    }

    /// New points where the layer has none.
    fn number_rest(&mut self, complex: &TetComplex, cut: &Sigma, n_surface: usize) -> Result<(), ConstructError> {
        for v in self.vertex.ids().skip(n_surface) {
            if self.vertex[v].is_none() {
                self.vertex[v] = self.take(1);
            }
        }
        for e in self.edge.ids() {
            if self.edge[e][0].is_none() {
                self.edge[e] = self.take_pair(cut[e]);
            }
        }
        for (t, edges) in complex.tet_edges.enumerate() {
            // What makes the whole fit: a face's pattern is read off Sigma on its own edges, so the two tets at it
            // agree once each of them has sides at all.
            let Some(side) = sides(cut, edges) else {
                return misfit(TetMisfit::SigmaInside { tet: t });
            };
            for (i, &f) in complex.tet_faces[t].iter().enumerate() {
                if self.face[f][0].is_none() {
                    let [a, b, c] = others(i).map(|k| side[k]);
                    self.face[f] = self.take_pair(a != b || b != c);
                }
            }
            let pair = self.take_pair(side.contains(&true));
            self.tet.push(pair);
        }
        Ok(())
    }
}

/// Appends the hexes of all tets. Call [`core_points`] first: it checks what is relied on here.
pub(super) fn split_tets(complex: &TetComplex, cut: &Sigma, points: &CorePoints, hexes: &mut Vec<[PointId; 8]>) {
    for (t, tet) in complex.tets.enumerate() {
        let side = sides(cut, &complex.tet_edges[t]).unwrap_or([false; 4]);
        let v = |i: usize| points.vertex[tet[i]];
        // The point of edge ij at the end i.
        let e = |i: usize, j: usize| {
            let id = complex.tet_edges[t][tet_edge(i, j)];
            points.edge[id][usize::from(tet[i] > tet[j])]
        };
        // The point of the face opposite m on the side of i.
        let f = |m: usize, i: usize| {
            let id = complex.tet_faces[t][m];
            // The lone vertex of a cut face has nobody on its side. On an uncut face all are alike, and both entries
            // are one point.
            let alike = others(m).into_iter().filter(|&k| side[k] == side[i]).count();
            points.face[id][usize::from(alike != 1)]
        };
        let z = |i: usize| points.tet[t][usize::from(side[i])];
        // The four corner hexes are those of a tet that is not cut, drawn apart along Sigma; a sheet hex fills the
        // gap at every cut edge. Hence 4, 7 or 8.
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
