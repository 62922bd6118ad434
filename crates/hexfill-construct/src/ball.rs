//! The core of a ball, without geometry: one apex, all triangles coned.
//!
//! [`BallCore::Centred`] cones from a new vertex inside: two tets a quad, the right start for coordinates.
//! [`BallCore::Fewest`] first cuts off each white vertex of three quads by one tet (its three black neighbours become
//! a triangle), which saves one tet each, then cones from the black vertex with most triangles, which saves those.
//! Why this stays simplicial, for a proper (3-connected) bipartite sphere: two black vertices are joined by at
//! most one diagonal, because no two quads share both ends of one; so the black triangles cut off are triangles of
//! a simple planar graph, and the cone over a simplicial disk from the vertex whose star is the rest is simplicial.
//! A white vertex of more than three quads is not cut off: 2 d - 4 tets instead of d.

use crate::tets::{InteriorTets, TetComplex, TetRequest};
use crate::{ConstructError, colouring::Colouring};
use hexfill_mesh::{Context, QuadSurface, VertexId};

/// How the core of a ball is made.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum BallCore {
    /// [`Centred`](Self::Centred) if positions are given, else [`Fewest`](Self::Fewest).
    #[default]
    Auto,
    /// A cone from one new vertex.
    Centred,
    /// As few tetrahedra as cutting off white vertices and a black apex give.
    Fewest,
}

/// Tetrahedra of a ball.
#[derive(Clone, Copy, Debug)]
pub struct BallTets<'a> {
    /// The surface.
    pub surface: &'a QuadSurface,
    /// Its colours.
    pub colouring: &'a Colouring,
    /// How.
    pub core: BallCore,
}

impl InteriorTets for BallTets<'_> {
    fn name(&self) -> &'static str {
        "ball"
    }

    fn fill(&self, request: &TetRequest<'_>, _ctx: &Context<'_>) -> Result<TetComplex, ConstructError> {
        // Cutting off needs a diagonal graph on the blacks only: bipartite surfaces.
        let fewest = match self.core {
            BallCore::Auto => request.points.is_none(),
            BallCore::Centred => false,
            BallCore::Fewest => true,
        };
        if fewest && self.colouring.n_cut_edges == 0 { Ok(self.fewest(request)) } else { Ok(centred(request)) }
    }
}

fn centred(request: &TetRequest<'_>) -> TetComplex {
    let apex = request.n_vertices as u32;
    let tets = request.triangles.iter().map(|&[a, b, c]| [apex, a, b, c]).collect();
    let mut complex = TetComplex::from_simplices(request.n_vertices + 1, tets);
    complex.points = request.points.map(|points| {
        let mut points = points.to_vec();
        points.push(centroid(&points, request.triangles));
        points
    });
    complex
}

/// The area-weighted centroid of the triangles.
pub(crate) fn centroid(points: &[[f64; 3]], triangles: &[[u32; 3]]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    let mut weight = 0.0;
    for t in triangles {
        let [a, b, c] = t.map(|v| points[v as usize]);
        let u: [f64; 3] = std::array::from_fn(|k| b[k] - a[k]);
        let v: [f64; 3] = std::array::from_fn(|k| c[k] - a[k]);
        let n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
        let area = (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]).sqrt();
        weight += area;
        for k in 0..3 {
            sum[k] += area * (a[k] + b[k] + c[k]) / 3.0;
        }
    }
    if weight > 0.0 { sum.map(|s| s / weight) } else { points[triangles[0][0] as usize] }
}

impl BallTets<'_> {
    fn fewest(&self, request: &TetRequest<'_>) -> TetComplex {
        let surface = self.surface;
        let cut_off =
            |v: u32| self.colouring.white[v as usize] && surface.degree(VertexId(v)) == 3 && surface.n_quads() > 4;
        let mut tets: Vec<[u32; 4]> = Vec::new();
        let mut triangles: Vec<[u32; 3]> =
            request.triangles.iter().copied().filter(|t| !t.iter().any(|&v| cut_off(v))).collect();
        let first = surface.dart_of_vertices();
        for (v, dart) in first.iter().enumerate() {
            let Some(d) = *dart else { continue };
            if cut_off(v as u32) {
                // Neighbours come clockwise; outward is counter-clockwise.
                let mut ring: Vec<u32> = surface.round_vertex(d).map(|e| surface.target(e).0).collect();
                ring.reverse();
                if let &[a, b, c] = ring.as_slice() {
                    triangles.push([a, b, c]);
                    tets.push([a, b, c, v as u32]);
                }
            }
        }
        let mut count = vec![0u32; request.n_vertices];
        for v in triangles.iter().flatten() {
            count[*v as usize] += u32::from(!self.colouring.white[*v as usize]);
        }
        let apex = (0..count.len()).rev().max_by_key(|&v| count[v]).unwrap_or(0) as u32;
        tets.extend(triangles.iter().filter(|t| !t.contains(&apex)).map(|&[a, b, c]| [apex, a, b, c]));
        TetComplex::from_simplices(request.n_vertices, tets)
    }
}
