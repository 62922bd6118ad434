//! What the judge is given: raw arrays, so that bad meshes can be judged too.

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
#[derive(Clone, Copy, PartialEq, Debug)]
#[non_exhaustive]
pub struct Options {
    /// The highest level to judge. Levels 4 and 5 need positions.
    pub up_to: Level,
    /// Which definition of a legal complex level 2 uses.
    pub rules: Rules,
    /// How many parts are allowed.
    pub parts: Parts,
    /// Whether to compute the Betti numbers and whether the mesh is a ball.
    pub betti: bool,
    /// Whether to compute quality numbers (scaled Jacobian and others) where positions are given.
    pub quality: bool,
    /// Whether to test that the boundary does not touch or cross itself, so that the mesh does not overlap. Off by default.
    pub overlap: bool,
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
    /// These options with another highest level.
    #[must_use]
    pub fn up_to(self, up_to: Level) -> Self {
        Self { up_to, ..self }
    }

    /// These options with other rules.
    #[must_use]
    pub fn rules(self, rules: Rules) -> Self {
        Self { rules, ..self }
    }

    /// These options with another number of parts allowed.
    #[must_use]
    pub fn parts(self, parts: Parts) -> Self {
        Self { parts, ..self }
    }

    /// These options with or without Betti numbers.
    #[must_use]
    pub fn betti(self, betti: bool) -> Self {
        Self { betti, ..self }
    }

    /// These options with or without quality numbers.
    #[must_use]
    pub fn quality(self, quality: bool) -> Self {
        Self { quality, ..self }
    }

    /// These options with or without the overlap test.
    #[must_use]
    pub fn overlap(self, overlap: bool) -> Self {
        Self { overlap, ..self }
    }
}
