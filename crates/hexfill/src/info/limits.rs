//! The part of a description about positions: vertices, corners and edges of a surface that bound what any mesh of it can reach.
//!
//! Source: ours.

use hexfill_embed::{CornerLimit, EdgeLimit, SideLimit, VertexLimit, surface_limits};
use hexfill_mesh::QuadSurface;
use serde::Serialize;

/// Cells named, at most, of each kind.
const FIRST: usize = 10;

/// A vertex whose best single direction reaches less than this scaled Jacobian is named, and a side whose quad allows less between its ends.
const POOR: f64 = 0.1;

/// Nothing up to this is called a direction that sees a quad: rounding.
const NOTHING: f64 = 1e-9;

/// An edge with a smaller dihedral angle is called sharp (degrees).
const SHARP: f64 = 20.0;

/// An edge with a larger one is a slit: the outside nearly closes up there, or the surface overlaps itself (degrees).
const SLIT: f64 = 345.0;

/// A corner within so many degrees of 0 is called a needle, of 180 nearly flat.
const NEEDLE: f64 = 15.0;

/// Cells of one kind: how many, and the first, worst first.
#[derive(Clone, Debug, Serialize)]
pub struct Named<T> {
    /// How many.
    pub count: usize,
    /// The first ten.
    pub first: Vec<T>,
}

impl<T: Copy> Named<T> {
    fn of(all: &[T], is_one: impl Fn(&T) -> bool) -> Self {
        let found = || all.iter().filter(|one| is_one(one));
        Self { count: found().count(), first: found().take(FIRST).copied().collect() }
    }

    /// "12 sharp edges: v1-v2 (...), ...".
    fn line(&self, one: &str, many: &str, name: impl Fn(&T) -> String) -> Option<String> {
        let names: Vec<String> = self.first.iter().map(name).collect();
        let more = if self.count > FIRST { ", ..." } else { "" };
        let noun = if self.count == 1 { one } else { many };
        (self.count > 0).then(|| format!("{} {noun}: {}{more}", self.count, names.join(", ")))
    }
}

/// What the positions allow.
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct LimitsInfo {
    /// No mesh of this surface has a larger worst scaled Jacobian, by the angles of its quads and edges.
    pub any_mesh: f64,
    /// No mesh with one interior edge at every surface vertex has a larger one.
    pub one_edge: f64,
    /// Vertices at which no single direction sees all quads.
    pub no_direction: Named<VertexLimit>,
    /// Vertices whose best single direction is poor.
    pub poor_direction: Named<VertexLimit>,
    /// Edges with a small dihedral angle.
    pub sharp_edges: Named<EdgeLimit>,
    /// Edges whose outside nearly closes up.
    pub slit_edges: Named<EdgeLimit>,
    /// Sides to which their quad comes near between the corners.
    pub turning_sides: Named<SideLimit>,
    /// Corners of nearly 180 degrees.
    pub flat_corners: Named<CornerLimit>,
    /// Corners of nearly 0 degrees, or at an edge of length 0.
    pub needle_corners: Named<CornerLimit>,
    /// Corners above 180 degrees.
    pub reflex_corners: Named<CornerLimit>,
}

/// The limits of a surface; `None` if it has vertices without positions.
pub(crate) fn describe(surface: &QuadSurface, points: &[[f64; 3]]) -> Option<LimitsInfo> {
    let limits = surface_limits(surface, points)?;
    let by_sides = limits.sides.first().map_or(1.0, |s| s.bound);
    let by_edges = limits.edges.iter().map(|e| e.bound).fold(1.0, f64::min);
    let by_vertices = limits.vertices.first().map_or(1.0, |v| v.bound);
    let any_mesh = by_sides.min(by_edges);
    let is_flat = |c: &CornerLimit| (c.degrees - 180.0).abs() <= NEEDLE && c.degrees <= 180.0;
    let is_needle = |c: &CornerLimit| c.bound == 0.0 && c.degrees < 90.0 || c.degrees < NEEDLE;
    Some(LimitsInfo {
        any_mesh,
        one_edge: any_mesh.min(by_vertices),
        no_direction: Named::of(&limits.vertices, |v| v.bound <= NOTHING),
        poor_direction: Named::of(&limits.vertices, |v| v.bound > NOTHING && v.bound < POOR),
        sharp_edges: Named::of(&limits.edges, |e| e.degrees < SHARP),
        slit_edges: Named::of(&limits.edges, |e| e.most_degrees > SLIT),
        turning_sides: Named::of(&limits.sides, |s| s.bound < POOR && s.at > 0.0 && s.at < 1.0),
        flat_corners: Named::of(&limits.corners, is_flat),
        needle_corners: Named::of(&limits.corners, is_needle),
        reflex_corners: Named::of(&limits.corners, |c| c.degrees > 180.0),
    })
}

impl LimitsInfo {
    /// A few lines for people.
    pub fn lines(&self) -> Vec<String> {
        let vertex = |v: &VertexLimit| format!("{} ({:.3})", v.vertex, v.bound + 0.0);
        let corner = |c: &CornerLimit| format!("{} at {} ({:.1} degrees)", c.vertex, c.quad, c.degrees);
        let edge = |e: &EdgeLimit| format!("{} ({:.1} degrees, {:.2} hexes)", e.edge, e.degrees, e.hexes);
        let kinds = [
            self.no_direction.line(
                "vertex with no single direction that sees all its quads",
                "vertices with no single direction that sees all their quads",
                vertex,
            ),
            self.poor_direction.line(
                "vertex whose best single direction is poor",
                "vertices whose best single direction is poor",
                vertex,
            ),
            self.sharp_edges.line("sharp edge", "sharp edges", edge),
            self.slit_edges.line("edge along a slit", "edges along slits", |e| {
                format!("{} (up to {:.1} degrees)", e.edge, e.most_degrees)
            }),
            self.turning_sides.line(
                "side between whose ends the quad turns along it",
                "sides between whose ends the quad turns along them",
                |s| format!("{} of {} ({:.3})", s.edge, s.quad, s.bound),
            ),
            self.flat_corners.line("nearly flat corner", "nearly flat corners", corner),
            self.needle_corners.line("needle", "needles", corner),
            self.reflex_corners.line("reflex corner", "reflex corners", corner),
        ];
        let head = format!(
            "scaled Jacobian: at most {:.3} in any mesh, {:.3} with one interior edge at every surface vertex",
            self.any_mesh, self.one_edge
        );
        std::iter::once(head).chain(kinds.into_iter().flatten().map(|line| format!("  {line}"))).collect()
    }
}
