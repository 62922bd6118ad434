//! [`Hole`]: what is left to fill inside a sphere while hexes are glued inward.
//!
//! Source: ours.

use crate::ball::mirror_image;
use crate::cavity::Cavity;
use crate::flip::{Placement, apply};

/// A hole, seen from inside the hexes round it, so that a hex glued inward is a flip.
pub(crate) struct Hole {
    /// Mirrored.
    pub(crate) cavity: Cavity,
    /// Mesh vertex of each vertex.
    pub(crate) ids: Vec<u32>,
    /// Vertices of the mesh so far; new ones follow.
    pub(crate) n_vertices: u32,
    /// The hex that was glued last, by its place in a trail.
    pub(crate) last: Option<u32>,
}

impl Hole {
    /// The inside of a sphere, whose vertices have these numbers among so many.
    pub(crate) fn inside(sphere: &Cavity, ids: Vec<u32>, n_vertices: u32) -> Self {
        Self { cavity: mirror_image(sphere), ids, n_vertices, last: None }
    }

    /// The hole as a sphere to fill.
    pub(crate) fn sphere(&self) -> Cavity {
        mirror_image(&self.cavity)
    }

    /// The hex of a flip in mesh vertices; the vertices it brings are numbered on.
    pub(crate) fn hex(&self, placement: &Placement) -> [u32; 8] {
        placement.corners.map(|c| self.id(c))
    }

    /// What is left after a flip whose hex is `last` of the trail.
    pub(crate) fn after(&self, placement: &Placement, last: u32) -> Self {
        let (cavity, before) = apply(&self.cavity, placement);
        let fresh = placement.corners.iter().filter(|&&c| usize::from(c) >= self.ids.len()).count() as u32;
        Self {
            ids: before[..cavity.n_vertices()].iter().map(|&v| self.id(v)).collect(),
            n_vertices: self.n_vertices + fresh,
            last: Some(last),
            cavity,
        }
    }

    fn id(&self, v: u8) -> u32 {
        let v = usize::from(v);
        self.ids.get(v).copied().unwrap_or_else(|| self.n_vertices + (v - self.ids.len()) as u32)
    }
}
