//! What the judge is given: raw arrays, so that bad meshes can be judged too.
//!
//! Source: ours.

use crate::rule::{Level, Rules};

/// A mesh to judge. Nothing is assumed of any array.
#[derive(Clone, Copy, Debug)]
pub struct Judged<'a> {
    /// Number of vertex ids, used or not; ids are 0-based.
    pub n_vertices: usize,
    /// The hexes, each 8 vertex ids in VTK_HEXAHEDRON order (see [`hexfill_mesh::cube`]).
    pub hexes: &'a [[u32; 8]],
    /// The prescribed boundary in the same vertex ids; without it the mesh is judged against its own boundary.
    pub surface: Option<&'a [[u32; 4]]>,
    /// One position per vertex id; without it levels 4 and 5 are not judged.
    pub points: Option<&'a [[f64; 3]]>,
    /// Positions of the surface's vertices (ids `0..len`); the first `points` must be these, bit for bit.
    pub surface_points: Option<&'a [[f64; 3]]>,
}

impl<'a> Judged<'a> {
    /// Connectivity alone.
    pub fn connectivity(n_vertices: usize, hexes: &'a [[u32; 8]]) -> Self {
        Self { n_vertices, hexes, surface: None, points: None, surface_points: None }
    }

    /// The same mesh with a prescribed boundary.
    #[must_use]
    pub fn with_surface(self, surface: &'a [[u32; 4]]) -> Self {
        Self { surface: Some(surface), ..self }
    }

    /// The same mesh with positions.
    #[must_use]
    pub fn with_points(self, points: &'a [[f64; 3]]) -> Self {
        Self { points: Some(points), ..self }
    }
}

/// How many parts (connected through quads) a mesh may have.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
#[non_exhaustive]
pub enum Parts {
    /// As many as the surface; one if no surface is given.
    #[default]
    AsSurface,
    /// Exactly one.
    One,
    /// Any number.
    Any,
}

/// What to judge, and by which rules.
///
/// | option | default |
/// |---|---|
/// | [`with_up_to`](Self::with_up_to) | [`Level::L5`]: every level |
/// | [`with_rules`](Self::with_rules) | [`Rules::Strict`] |
/// | [`with_parts`](Self::with_parts) | [`Parts::AsSurface`] |
/// | [`with_betti`](Self::with_betti) | yes |
/// | [`with_quality`](Self::with_quality) | yes, where positions are given |
/// | [`with_overlap`](Self::with_overlap) | no |
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Options {
    pub(crate) up_to: Level,
    pub(crate) rules: Rules,
    pub(crate) parts: Parts,
    pub(crate) betti: bool,
    pub(crate) quality: bool,
    pub(crate) overlap: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            up_to: Level::L5,
            rules: Rules::Strict,
            parts: Parts::AsSurface,
            betti: true,
            quality: true,
            overlap: false,
        }
    }
}

impl Options {
    /// The highest level to judge. Levels 4 and 5 need positions.
    #[must_use]
    pub fn with_up_to(self, up_to: Level) -> Self {
        Self { up_to, ..self }
    }

    /// Which definition of a legal complex level 2 uses.
    #[must_use]
    pub fn with_rules(self, rules: Rules) -> Self {
        Self { rules, ..self }
    }

    /// How many parts, connected through quads, are allowed.
    #[must_use]
    pub fn with_parts(self, parts: Parts) -> Self {
        Self { parts, ..self }
    }

    /// Whether to compute the Betti numbers and whether the mesh is a ball.
    #[must_use]
    pub fn with_betti(self, betti: bool) -> Self {
        Self { betti, ..self }
    }

    /// Whether to compute quality numbers (scaled Jacobian and others) where positions are given.
    #[must_use]
    pub fn with_quality(self, quality: bool) -> Self {
        Self { quality, ..self }
    }

    /// Whether to test that the boundary does not touch or cross itself, so that the mesh does not overlap.
    #[must_use]
    pub fn with_overlap(self, overlap: bool) -> Self {
        Self { overlap, ..self }
    }
}
