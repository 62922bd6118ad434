//! Tets inside a surface that are edited.
//!
//! Every edit replaces the star of one vertex. The star is a polyhedron; if its new tets are all positively oriented and
//! have its boundary, they tile it, so nothing else has to be looked at. Orientation is exact.
//!
//! Source: ours.

use super::conform::Inside;
use super::conform::TriangleId;
use super::mesh::orient;
use crate::core::complex::TET_EDGES;
use crate::ids::{FaceId, TetId};
use hexfill_geometry::{Vector, cross, dot, norm, sub};
use hexfill_mesh::{IdVec, VertexId};

/// Least quality that the removal of an inner point may leave, unless it was worse before: the hexes of such a tet have scaled
/// Jacobians of about as much. With 0.01 a ball has 47.0 hexes a quad, with 0.1 49.8.
pub(super) const FLOOR_INSIDE: f64 = 0.05;

/// Tets with, per vertex, those that have it.
pub(crate) struct Solid {
    pub(super) points: IdVec<VertexId, Vector>,
    /// A removed tet has none first.
    pub(super) tets: IdVec<TetId, [VertexId; 4]>,
    pub(super) tets_at: IdVec<VertexId, Vec<TetId>>,
    /// The boundary, outward, with the triangle of the surface; a removed face has none first.
    pub(super) faces: IdVec<FaceId, ([VertexId; 3], TriangleId)>,
    pub(super) faces_at: IdVec<VertexId, Vec<FaceId>>,
    /// Per triangle of the surface its unit outward normal.
    pub(super) normals: IdVec<TriangleId, Vector>,
    /// Number of vertices of the surface.
    pub(super) n_surface: usize,
}

/// Of length 1, or zero.
pub(super) fn unit_or_zero(v: Vector) -> Vector {
    let length = norm(v);
    if length > 0.0 { v.map(|x| x / length) } else { v }
}

/// Six times the volume over the cube of the root mean square of the edges: 0.7 at best. Its sign is exact.
fn quality(p: [Vector; 4]) -> f64 {
    let volume = orient(p);
    let square: f64 = TET_EDGES
        .iter()
        .map(|&[i, j]| {
            let d = sub(p[i], p[j]);
            dot(d, d)
        })
        .sum::<f64>()
        / 6.0;
    let q = volume / (square * square.sqrt());
    // A volume that underflows in the quotient keeps its sign.
    if volume > 0.0 { q.max(f64::MIN_POSITIVE) } else { q.min(0.0) }
}

impl Solid {
    /// What was found inside a surface with these triangles.
    pub(super) fn new(inside: Inside, triangles: &IdVec<TriangleId, [VertexId; 3]>, n_surface: usize) -> Self {
        let Inside { points, tets, boundary } = inside;
        let faces: IdVec<FaceId, _> = boundary.into();
        let mut tets_at = IdVec::filled(Vec::new(), points.len());
        for (t, tet) in tets.enumerate() {
            tet.iter().for_each(|&v| Vec::push(&mut tets_at[v], t));
        }
        let mut faces_at = IdVec::filled(Vec::new(), points.len());
        for (f, (face, _)) in faces.enumerate() {
            face.iter().for_each(|&v| Vec::push(&mut faces_at[v], f));
        }
        let normal = |t: &[VertexId; 3]| {
            let [a, b, c] = t.map(|v| points[v]);
            unit_or_zero(cross(sub(b, a), sub(c, a)))
        };
        let normals = triangles.iter().map(normal).collect();
        Self { points, tets, tets_at, faces, faces_at, normals, n_surface }
    }

    pub(super) fn at(&self, v: VertexId) -> Vector {
        self.points[v]
    }

    pub(super) fn quality(&self, tet: [VertexId; 4]) -> f64 {
        quality(tet.map(|v| self.at(v)))
    }

    /// Least quality of tets, of which `v` is taken to be at `p`, if it is more than `bound`. Most places fail on the same tet, so
    /// the one that fails goes first.
    pub(super) fn least_above(&self, bound: f64, tets: &mut [[VertexId; 4]], v: VertexId, p: Vector) -> Option<f64> {
        let mut least = f64::INFINITY;
        for k in 0..tets.len() {
            least = least.min(quality(tets[k].map(|w| if w == v { p } else { self.at(w) })));
            if least <= bound {
                tets.swap(0, k);
                return None;
            }
        }
        Some(least)
    }

    /// Least quality of a star after drawing `v` onto `u`, if it is more than `bound`.
    pub(super) fn least_drawn(&self, bound: f64, v: VertexId, u: VertexId) -> Option<f64> {
        let mut least = f64::INFINITY;
        for &t in &self.tets_at[v] {
            let tet = self.tets[t];
            if !tet.contains(&u) {
                least = least.min(self.quality(tet.map(|w| if w == v { u } else { w })));
                if least <= bound {
                    return None;
                }
            }
        }
        Some(least)
    }

    pub(super) fn star(&self, v: VertexId) -> Vec<[VertexId; 4]> {
        self.tets_at[v].iter().map(|&t| self.tets[t]).collect()
    }

    pub(super) fn replace_tets(&mut self, v: VertexId, new: &[[VertexId; 4]]) {
        for t in std::mem::take(&mut self.tets_at[v]) {
            let tet = std::mem::replace(&mut self.tets[t], [VertexId::NONE; 4]);
            for w in tet.into_iter().filter(|&w| w != v) {
                self.tets_at[w].retain(|&u| u != t);
            }
        }
        for tet in new {
            let t = self.tets.push(*tet);
            tet.iter().for_each(|&w| self.tets_at[w].push(t));
        }
    }

    pub(super) fn replace_faces(&mut self, v: VertexId, new: &[([VertexId; 3], TriangleId)]) {
        for f in std::mem::take(&mut self.faces_at[v]) {
            let (face, _) = std::mem::replace(&mut self.faces[f], ([VertexId::NONE; 3], TriangleId::NONE));
            for w in face.into_iter().filter(|&w| w != v) {
                self.faces_at[w].retain(|&u| u != f);
            }
        }
        for face in new {
            let f = self.faces.push(*face);
            face.0.iter().for_each(|&w| self.faces_at[w].push(f));
        }
    }

    /// The tets of a star after drawing `v` onto `u`.
    pub(super) fn drawn(&self, v: VertexId, u: VertexId) -> Vec<[VertexId; 4]> {
        let others = self.tets_at[v].iter().map(|&t| self.tets[t]).filter(|t| !t.contains(&u));
        others.map(|t| t.map(|w| if w == v { u } else { w })).collect()
    }

    pub(super) fn least_now(&self, v: VertexId) -> f64 {
        let tets = self.tets_at[v].iter().map(|&t| self.quality(self.tets[t]));
        tets.fold(f64::INFINITY, f64::min)
    }

    /// The neighbours of a vertex, ascending.
    pub(super) fn neighbours(&self, v: VertexId) -> Vec<VertexId> {
        let mut all: Vec<VertexId> = self.star(v).into_iter().flatten().filter(|&w| w != v).collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    /// Raises the least quality of tets, which is `q`, by moving `v` from a place, with steps of at most a given length.
    pub(super) fn climb(
        &self,
        tets: &mut [[VertexId; 4]],
        v: VertexId,
        (mut q, mut p, mut step): (f64, Vector, f64),
    ) -> Vector {
        const DIRECTIONS: [Vector; 7] = [
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
            [0.6, 0.6, 0.6],
            [0.6, -0.6, 0.6],
            [-0.6, 0.6, 0.6],
            [-0.6, -0.6, 0.6],
        ];
        for _ in 0..8 {
            step /= 2.0;
            for _ in 0..3 {
                let from = p;
                for d in DIRECTIONS {
                    for sign in [1.0, -1.0] {
                        let to = std::array::from_fn(|c| from[c] + sign * step * d[c]);
                        if let Some(here) = self.least_above(q, tets, v, to) {
                            (q, p) = (here, to);
                        }
                    }
                }
                if p == from {
                    break;
                }
            }
        }
        p
    }

    pub(super) fn smooth(&mut self, v: VertexId) {
        let mut tets = self.star(v);
        let reach =
            tets.iter().flatten().map(|&w| sub(self.at(w), self.at(v))).map(|d| dot(d, d)).fold(0.0, f64::max).sqrt();
        let p = self.at(v);
        self.points[v] = self.climb(&mut tets, v, (self.least_now(v), p, reach));
    }

    /// The tets, their points (the surface's first, then those still in use), and the least quality.
    pub(super) fn finish(self) -> (Vec<Vector>, Vec<[VertexId; 4]>, f64) {
        let mut number: IdVec<VertexId, VertexId> = self.points.ids().collect();
        let mut points = self.points.as_slice()[..self.n_surface].to_vec();
        for v in self.points.ids().skip(self.n_surface) {
            if !self.tets_at[v].is_empty() {
                number[v] = VertexId::new(points.len());
                points.push(self.points[v]);
            }
        }
        let mut least = f64::INFINITY;
        let mut tets = Vec::new();
        for tet in self.tets.iter().filter(|t| t[0].is_some()) {
            least = least.min(self.quality(*tet));
            tets.push(tet.map(|v| number[v]));
        }
        (points, tets, least)
    }
}
