//! The core of a ball, without geometry: one apex, all triangles coned (Eppstein 1999).
//!
//! [`BallCore::Centred`] cones from a new vertex inside: two tets a quad, the right start for coordinates.
//! [`BallCore::Fewest`] first cuts off each white vertex of three quads by one tet (its three black neighbours become
//! a triangle), which saves one tet each, then cones from the black vertex with most triangles, which saves those.
//! Why this stays simplicial, for a proper (3-connected) bipartite sphere: two black vertices are joined by at
//! most one diagonal, because no two quads share both ends of one; so the black triangles cut off are triangles of
//! a simple planar graph, and the cone over a simplicial disk from the vertex whose star is the rest is simplicial.
//! A white vertex of more than three quads is not cut off: 2 d - 4 tets instead of d.
//!
//! Source: Eppstein 1999 (a sphere coned to one point); cutting white vertices off first is ours.

use super::complex::TetComplex;
use super::maker::{Core, InteriorTets};
use super::request::TetRequest;
use crate::error::ConstructError;
use crate::plan::colouring::Colouring;
use hexfill_geometry::centroid;
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
pub struct ConeTets<'a> {
    /// The surface.
    pub surface: &'a QuadSurface,
    /// Its colours.
    pub colouring: &'a Colouring,
    /// How.
    pub core: BallCore,
}

impl InteriorTets for ConeTets<'_> {
    fn core(&self) -> Core {
        Core::Cone
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
    let apex = VertexId::new(request.n_vertices);
    let tets = request.triangles.iter().map(|&[a, b, c]| [apex, a, b, c]).collect();
    let mut complex = TetComplex::from_simplices(request.n_vertices + 1, tets);
    complex.points = request.points.map(|points| {
        let mut points = points.to_vec();
        points.push(centroid(request.triangles.iter().map(|t| t.map(|v| points[v.index()]))));
        points
    });
    complex
}

impl ConeTets<'_> {
    fn fewest(&self, request: &TetRequest<'_>) -> TetComplex {
        let surface = self.surface;
        let is_white = |v: VertexId| self.colouring.white[v];
        let cut_off = |v: VertexId| is_white(v) && surface.degree(v) == 3 && surface.n_quads() > 4;
        let mut tets: Vec<[VertexId; 4]> = Vec::new();
        let mut triangles: Vec<[VertexId; 3]> =
            request.triangles.iter().copied().filter(|t| !t.iter().any(|&v| cut_off(v))).collect();
        for d in surface.dart_of_vertices().into_iter().flatten() {
            let v = surface.origin(d);
            if cut_off(v) {
                // Neighbours come clockwise; outward is counter-clockwise.
                let mut ring: Vec<VertexId> = surface.round_vertex(d).map(|e| surface.target(e)).collect();
                ring.reverse();
                if let &[a, b, c] = ring.as_slice() {
                    triangles.push([a, b, c]);
                    tets.push([a, b, c, v]);
                }
            }
        }
        let mut count = vec![0u32; request.n_vertices];
        for &v in triangles.iter().flatten() {
            count[v.index()] += u32::from(!is_white(v));
        }
        // A black apex: every triangle round it needs no tet.
        let apex = VertexId::new((0..count.len()).rev().max_by_key(|&v| count[v]).unwrap_or(0));
        tets.extend(triangles.iter().filter(|t| !t.contains(&apex)).map(|&[a, b, c]| [apex, a, b, c]));
        TetComplex::from_simplices(request.n_vertices, tets)
    }
}
