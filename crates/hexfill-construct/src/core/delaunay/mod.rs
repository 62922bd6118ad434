//! Tetrahedra with positions, made here: every one positively oriented, the boundary exactly the triangles asked for.
//!
//! 1. The Delaunay tetrahedralisation of the surface's vertices (`mesh.rs`).
//! 2. Points are added to edges and triangles of the surface until it is a union of faces (`conform.rs`).
//! 3. Points are added inside where tets are needles (`grade.rs`).
//! 4. What lies inside is kept (`solid.rs`); every point added to the boundary is taken off it again (`boundary.rs`), and inner
//!    points are removed as long as all tets stay positive (`removal.rs`), with flips against flat tets (`flips.rs`).
//!
//! All decisions about orientation are exact (adaptive predicates, Shewchuk 1997), and no random choice is made. A
//! surface that meets itself is refused: its triangles cannot all be faces, so step 2 runs out of points or step 3
//! finds sides that contradict each other.
//!
//! Source: the papers of each step, named on its page; the order and the exactness throughout are ours.

mod boundary;
mod conform;
mod flips;
mod grade;
mod mesh;
mod removal;
mod solid;

use super::complex::TetComplex;
use super::maker::{Core, InteriorTets};
use super::request::TetRequest;
use super::used::Used;
use crate::error::ConstructError;
use crate::missing::MissingInterior;
use conform::{Conforming, Failure, TriangleId};
use hexfill_geometry::{cross, dot, norm, sub};
use hexfill_mesh::{Context, IdVec, QuadId, VertexId};
use solid::Solid;

/// Tetrahedra of the interior by conforming Delaunay refinement. See the module page.
///
/// Time about linear in the number of points for surfaces met in practice; thin and acute places take more points.
#[derive(Clone, Copy, Debug)]
pub struct DelaunayTets {
    /// How many points may be added, as a multiple of the number of triangles.
    pub points_per_triangle: usize,
}

impl Default for DelaunayTets {
    fn default() -> Self {
        Self { points_per_triangle: 20 }
    }
}

impl InteriorTets for DelaunayTets {
    fn core(&self) -> Core {
        Core::Delaunay
    }

    fn fill(&self, request: &TetRequest<'_>, ctx: &Context<'_>) -> Result<TetComplex, ConstructError> {
        let Some(points) = request.points else {
            return Err(request.interior_needed(MissingInterior::NoPositionsForDelaunay));
        };
        let made = self.run(request, points, ctx).map_err(|failure| match failure {
            Failure::Reason(reason) => request.interior_needed(reason),
            Failure::Stopped(reason) => ConstructError::Stopped(reason),
        })?;
        // Whatever went before: this decides.
        made.match_boundary(request)?;
        Ok(made)
    }
}

/// Surfaces of more triangles get no points for the shape of the tets alone, which take minutes (a million hexes and more).
pub(crate) const GRADED_TRIANGLES: usize = 40_000;

impl DelaunayTets {
    fn run(&self, request: &TetRequest<'_>, points: &[[f64; 3]], ctx: &Context<'_>) -> Result<TetComplex, Failure> {
        if request.triangles.is_empty() || points.len() != request.n_vertices {
            return Err(MissingInterior::PositionsCount.into());
        }
        let used = Used::of(request);
        let own = used.points(points);
        if let Some(v) = own.iter().position(|p| p.iter().any(|x| !x.is_finite() || x.abs() > 1e60)) {
            return Err(MissingInterior::PositionNotFinite { vertex: used.vertices[v] }.into());
        }
        // Refused here with the name of the quad: later it would show as points that run out.
        let flat = |t: &[VertexId; 3]| {
            let [a, b, c] = t.map(|v| points[v.index()]);
            let sides = [sub(b, a), sub(c, b), sub(a, c)];
            let longest = sides.iter().map(|&s| dot(s, s)).fold(0.0, f64::max);
            norm(cross(sides[0], sides[1])) <= 1e-12 * longest
        };
        if let Some(t) = request.triangles.iter().position(flat) {
            return Err(MissingInterior::NoArea { quad: QuadId::new(t / 2) }.into());
        }
        let triangles: IdVec<TriangleId, [VertexId; 3]> = used.triangles.clone().into();
        let budget = self.points_per_triangle.saturating_mul(triangles.len());
        let mut conforming = Conforming::new(&own, &triangles, budget)?;
        conforming.refine(ctx)?;
        // Points inside make better tets and take time that grows faster than the surface; beyond this size a tet
        // with a long edge is the lesser evil.
        if triangles.len() <= GRADED_TRIANGLES {
            conforming.grade(ctx)?;
        }
        // From here on no tet is a Delaunay tet any more. What is kept is that all are positive and that the boundary
        // is a refinement of the one asked for.
        let mut solid = Solid::new(conforming.inside()?, &triangles, own.len());
        if let Err(given) = solid.clear_boundary(ctx).map_err(Failure::Stopped)? {
            return Err(MissingInterior::PointsOnBoundary { given }.into());
        }
        solid.remove_points(ctx).map_err(Failure::Stopped)?;
        let (found, tets, least) = solid.finish();
        ctx.report("tetrahedra", tets.len() as u64, None, || {
            format!("{} inner points, least quality {least:.2e}", found.len() - own.len())
        });
        // Back to the surface's own numbers; new points follow them, as everywhere.
        let tets = tets.into_iter().map(|t| t.map(|v| used.back(v))).collect();
        let mut all = points.to_vec();
        all.extend(&found[own.len()..]);
        let mut complex = TetComplex::from_simplices(all.len(), tets);
        complex.points = Some(all);
        Ok(complex)
    }
}
