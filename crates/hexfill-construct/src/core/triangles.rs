//! The inner copy of the surface as triangles: what the tetrahedra have to fill.
//!
//! Source: Erickson 2014, section 5 (one diagonal a quad).

use crate::options::RouteChoice;
use crate::plan::colouring::Colouring;
use crate::plan::colours;
use hexfill_mesh::{IdVec, QuadId, QuadSurface, VertexId};

/// The corner of a quad that is corner 0 of its pattern (0 or 1): a black one with a black one opposite.
pub(crate) fn turn_of(surface: &QuadSurface, white: &IdVec<VertexId, bool>, q: QuadId) -> u8 {
    let corners = surface.quad(q);
    u8::from(white[corners[0]] || white[corners[2]])
}

/// The triangles of the inner copy, outward, as vertices of the surface; triangle `2 q + t` is triangle `t` of
/// quad `q`: (corner 0, corner 1, corner 2) or (corner 2, corner 3, corner 0) of its pattern.
pub(crate) fn triangles(surface: &QuadSurface, colouring: &Colouring) -> Vec<[VertexId; 3]> {
    (0..surface.n_quads())
        .flat_map(|q| {
            let q = QuadId::new(q);
            let turn = usize::from(turn_of(surface, &colouring.white, q));
            let corners = surface.quad(q);
            [[0, 1, 2], [2, 3, 0]].map(|t| t.map(|k| corners[(k + turn) % 4]))
        })
        .collect()
}

/// The triangles that tetrahedra of the interior have to fill, outward, as vertices of the surface: two a quad. For
/// making tetrahedra elsewhere (see [`crate::GivenTets`]).
pub fn core_triangles(surface: &QuadSurface, route: RouteChoice) -> Vec<[VertexId; 3]> {
    triangles(surface, &colours(surface, route, false))
}
