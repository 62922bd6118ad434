//! Step 2: the core. The inner copy of the surface is filled with tetrahedra, by one of five makers ([`Core`]).
//!
//! Source: Erickson 2014, section 5: everything else needs nothing of the interior but tetrahedra; the makers name theirs.

pub(crate) mod complex;
pub(crate) mod cone;
pub(crate) mod corridors;
pub(crate) mod delaunay;
mod fit;
pub(crate) mod from_caller;
pub(crate) mod handlebody;
pub(crate) mod inner_copy;
pub(crate) mod maker;
pub(crate) mod request;
mod star_centre;
pub(crate) mod tetgen;
pub(crate) mod triangles;
mod used;

use crate::cells::library::CellChoice;
use crate::error::ConstructError;
use crate::ids::FaceId;
use crate::plan::{Plan, stage};
use complex::TetComplex;
use cone::{BallCore, ConeTets};
use corridors::{Corridor, corridors};
use delaunay::{DelaunayTets, GRADED_TRIANGLES};
use handlebody::HandlebodyTets;
use hexfill_geometry::{Vector, tet_volume};
use hexfill_mesh::{Context, VertexId};
use inner_copy::InnerCopy;
use maker::{Core, InteriorTets};
use request::TetRequest;
use star_centre::star_centre;
use triangles::triangles;

/// Star-shaped surfaces with more quads than this get no cone as core where coordinates are wanted: its tetrahedra would be needles.
/// Measured on ellipsoids: with 96 quads the worst scaled Jacobian is 0.103 (Delaunay tetrahedra: 0.139), with 216 0.044 (0.108),
/// with 384 0.023 (0.127).
const CONE_QUADS: usize = 250;

/// The core of a surface.
pub(crate) struct Inside {
    /// Who made the tetrahedra.
    pub(crate) core: Core,
    pub(crate) complex: TetComplex,
    /// Per triangle of the inner copy (two a quad) its face of the tetrahedra.
    pub(crate) boundary: Vec<FaceId>,
    /// Where the inner copy lies, if the surface has positions.
    pub(crate) inner: Option<InnerCopy>,
    /// Whether some point is known to see the whole surface.
    pub(crate) is_star: bool,
    /// Ways between odd components.
    pub(crate) corridors: Vec<Corridor>,
}

/// Fills the inner copy of the surface with tetrahedra, checks their boundary, and finds ways between odd components.
///
/// # Errors
/// No maker can; the boundary is not the one asked for; odd components cannot be paired; told to stop.
pub(crate) fn core(plan: &Plan<'_>, ctx: &Context<'_>) -> Result<Inside, ConstructError> {
    stage("tetrahedra", ctx)?;
    let triangles = triangles(plan.surface, &plan.colours);
    let request = TetRequest { n_vertices: plan.surface.n_vertices(), triangles: &triangles, points: plan.points };
    let space = Space::new(plan, triangles.len());
    let (core, complex, inner) = match &plan.options.tets {
        Some(maker) => (maker.core(), maker.fill(&request, ctx)?, space.inner_copy(plan)),
        None => built_in(plan, &space, &request, ctx)?,
    };
    // Whoever made the tets, they are not believed: everything after relies on their boundary being the triangles
    // asked for.
    let boundary = complex.match_boundary(&request)?;
    let corridors = corridors(plan.surface, &complex, &boundary)?;
    Ok(Inside { core, complex, boundary, inner, is_star: space.centre.is_some(), corridors })
}

/// What the positions allow, if there are any.
struct Space {
    /// A point that sees the whole surface.
    centre: Option<Vector>,
    /// The same point where the core is to be a cone from it.
    cone: Option<Vector>,
    /// Whether tetrahedra have to be right side out: coordinates are wanted.
    wants_shape: bool,
}

impl Space {
    fn new(plan: &Plan<'_>, n_triangles: usize) -> Self {
        let points = plan.points.filter(|_| plan.surface.is_sphere());
        let centre = points.and_then(|p| star_centre(plan.surface, p));
        let wants_shape = plan.options.cells == CellChoice::Embeddable && plan.points.is_some();
        // A star-shaped ball has tetrahedra that are right side out without any search, but a cone over many quads is all needles.
        // Where Delaunay tetrahedra get no points for their shape, they are needles, too.
        let is_asked_for = plan.options.ball_core != BallCore::Auto;
        let is_coned = plan.surface.n_quads() <= CONE_QUADS || n_triangles > GRADED_TRIANGLES;
        Self { centre, cone: centre.filter(|_| !wants_shape || is_asked_for || is_coned), wants_shape }
    }

    fn inner_copy(&self, plan: &Plan<'_>) -> Option<InnerCopy> {
        let surface = plan.surface;
        plan.points.map(|p| match self.cone {
            Some(centre) => InnerCopy::half_way(surface, p, centre),
            None => InnerCopy::offset(surface, p, self.centre.is_some()),
        })
    }
}

/// Delaunay tetrahedra where coordinates are wanted and no cone will do; else, and where these fail, a cone for a ball and
/// a handlebody cut along disks for anything else.
fn built_in(
    plan: &Plan<'_>,
    space: &Space,
    request: &TetRequest<'_>,
    ctx: &Context<'_>,
) -> Result<(Core, TetComplex, Option<InnerCopy>), ConstructError> {
    let (surface, inner) = (plan.surface, space.inner_copy(plan));
    if space.wants_shape
        && space.cone.is_none()
        && let Some(complex) = delaunay(request, inner.as_ref(), ctx)?
    {
        return Ok((Core::Delaunay, complex, inner));
    }
    if !surface.is_sphere() {
        return Ok((Core::Handlebody, HandlebodyTets.fill(request, ctx)?, inner));
    }
    let cone = ConeTets { surface, colouring: &plan.colours, core: plan.options.ball_core };
    let mut complex = cone.fill(request, ctx)?;
    let (Some(points), Some(centre)) = (plan.points, space.centre) else { return Ok((Core::Cone, complex, inner)) };
    let half_way = InnerCopy::half_way(surface, points, centre);
    move_apex(&mut complex, &half_way, surface.n_vertices(), centre);
    Ok((Core::Cone, complex, Some(half_way)))
}

/// Tetrahedra with positive volumes between the inner copies of the vertices, else between the vertices themselves (the inner
/// copy of a thin solid may meet itself); `None` if neither has any.
fn delaunay(
    request: &TetRequest<'_>,
    inner: Option<&InnerCopy>,
    ctx: &Context<'_>,
) -> Result<Option<TetComplex>, ConstructError> {
    let inner = inner.map(InnerCopy::points);
    for points in [inner.as_deref(), request.points] {
        match DelaunayTets::default().fill(&TetRequest { points, ..*request }, ctx) {
            Err(ConstructError::Stopped(reason)) => return Err(ConstructError::Stopped(reason)),
            // A refusal is no answer about the surface: a cone or a handlebody may do without positions.
            Err(_) => {}
            Ok(complex) => return Ok(Some(complex)),
        }
    }
    Ok(None)
}

/// Puts the apex of a cone over the inner copy of the surface to `centre`, which sees all of it, if it does not lie well already.
fn move_apex(complex: &mut TetComplex, inner: &InnerCopy, apex: usize, centre: Vector) {
    let Some(points) = complex.points.as_mut().filter(|p| p.len() == apex + 1) else { return };
    let at = |v: VertexId| if v.index() < apex { inner.at(v) } else { points[v.index()] };
    if !complex.tets.iter().all(|t| tet_volume(t.map(at)) > 0.0) {
        points[apex] = centre;
    }
}
