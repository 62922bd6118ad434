//! Tetrahedra with positions, made here: every one positively oriented, the boundary exactly the triangles asked for.
//!
//! 1. The Delaunay tetrahedralisation of the surface's vertices (`mesh.rs`).
//! 2. Points are added to edges and triangles of the surface until it is a union of faces (`conform.rs`).
//! 3. Points are added inside where tets are needles (`grade.rs`).
//! 4. What lies inside is kept; every point added to the boundary is taken off it again, and inner points are
//!    removed as long as all tets stay positive (`solid.rs`), with flips against flat tets (`flips.rs`).
//!
//! All decisions about orientation are exact (adaptive predicates, Shewchuk 1997), and no random choice is made. A
//! surface that meets itself is refused: its triangles cannot all be faces, so step 2 runs out of points or step 3
//! finds sides that contradict each other.

mod conform;
mod flips;
mod grade;
mod mesh;
mod solid;

use crate::error::ConstructError;
use crate::tets::{InteriorTets, TetComplex, TetRequest};
use crate::vector::{cross, dot, sub};
use conform::{Conforming, Failure};
use hexfill_mesh::Context;
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

/// What to do instead.
const ADVICE: &str = "give tetrahedra, or install tetgen";

impl InteriorTets for DelaunayTets {
    fn name(&self) -> &'static str {
        "delaunay"
    }

    fn fill(&self, request: &TetRequest<'_>, ctx: &Context<'_>) -> Result<TetComplex, ConstructError> {
        let Some(points) = request.points else {
            return Err(request.interior_needed(format!("Delaunay tetrahedra need positions; {ADVICE}")));
        };
        let made = self.run(request, points, ctx).map_err(|failure| match failure {
            Failure::Reason(reason) => request.interior_needed(format!("{reason}; {ADVICE}")),
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
        // Only what the triangles use.
        let mut number = vec![u32::MAX; request.n_vertices];
        let mut used: Vec<u32> = request.triangles.iter().flatten().copied().collect();
        used.sort_unstable();
        used.dedup();
        if used.is_empty() || points.len() != request.n_vertices {
            return Err("one position a vertex is needed".to_owned().into());
        }
        for (i, &v) in used.iter().enumerate() {
            number[v as usize] = i as u32;
        }
        let own: Vec<[f64; 3]> = used.iter().map(|&v| points[v as usize]).collect();
        if let Some(v) = own.iter().position(|p| p.iter().any(|x| !x.is_finite() || x.abs() > 1e60)) {
            return Err(format!("the position of vertex {} is not a number or too large", used[v]).into());
        }
        let flat = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|v| points[v as usize]);
            let sides = [sub(b, a), sub(c, b), sub(a, c)];
            let longest = sides.iter().map(|&s| dot(s, s)).fold(0.0, f64::max);
            let area = cross(sides[0], sides[1]);
            dot(area, area).sqrt() <= 1e-12 * longest
        };
        if let Some(t) = request.triangles.iter().position(flat) {
            return Err(format!("half of quad {} has no area, so no tetrahedron stands on it", t / 2).into());
        }
        let triangles: Vec<[u32; 3]> = request.triangles.iter().map(|t| t.map(|v| number[v as usize])).collect();
        let budget = self.points_per_triangle.saturating_mul(triangles.len());
        let mut conforming = Conforming::new(&own, &triangles, budget)?;
        conforming.refine(ctx)?;
        if triangles.len() <= GRADED_TRIANGLES {
            conforming.grade(ctx)?;
        }
        let mut solid = Solid::new(conforming.inside()?, &triangles, own.len());
        if let Err(left) = solid.clear_boundary(ctx).map_err(Failure::Stopped)? {
            return Err(format!("{left} points could not be taken off the boundary").into());
        }
        solid.remove_points(ctx).map_err(Failure::Stopped)?;
        let (found, tets, least) = solid.finish();
        ctx.report("tetrahedra", tets.len() as u64, None, || {
            format!("{} inner points, least quality {least:.2e}", found.len() - own.len())
        });
        let n = request.n_vertices as u32;
        let back = |v: u32| used.get(v as usize).copied().unwrap_or(n + v - used.len() as u32);
        let tets = tets.into_iter().map(|t| t.map(back)).collect();
        let mut all = points.to_vec();
        all.extend(&found[own.len()..]);
        let mut complex = TetComplex::from_simplices(all.len(), tets);
        complex.points = Some(all);
        Ok(complex)
    }
}
