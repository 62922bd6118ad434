//! Step 1: what is decided on the surface alone: that it may have a mesh at all, its colours, and (where coordinates are wanted) its
//! light sides.
//!
//! Source: Erickson 2014, section 4, and its files.

pub(crate) mod colouring;
pub(crate) mod matching;
pub(crate) mod sharp_vertices;

use crate::cells::library::{CellChoice, CellLibrary};
use crate::error::ConstructError;
use crate::options::{ConstructOptions, RouteChoice};
use crate::surface::existence::forbidden;
use colouring::{Colouring, all_black, colouring};
use hexfill_geometry::Vector;
use hexfill_mesh::{Context, QuadSurface};
use matching::{LightSides, light_sides};
use sharp_vertices::relieve;

/// A surface with what was decided about it.
pub(crate) struct Plan<'a> {
    pub(crate) surface: &'a QuadSurface,
    pub(crate) points: Option<&'a [Vector]>,
    pub(crate) options: &'a ConstructOptions,
    pub(crate) library: &'a CellLibrary,
    pub(crate) colours: Colouring,
    /// Light sides that suit the positions.
    pub(crate) sides: Option<LightSides>,
}

/// Looks at the surface and decides.
///
/// # Errors
/// A surface that has no proper hex mesh, whatever its inside; one position a vertex is missing; told to stop.
pub(crate) fn plan<'a>(
    surface: &'a QuadSurface,
    points: Option<&'a [Vector]>,
    options: &'a ConstructOptions,
    ctx: &Context<'_>,
) -> Result<Plan<'a>, ConstructError> {
    // The theorems that need no inside come first: a refusal costs linear time and names its reason.
    if let Some(no) = forbidden(surface) {
        return Err(ConstructError::NoMesh(no));
    }
    if let Some(given) = points.map(<[_]>::len).filter(|&n| n != surface.n_vertices()) {
        return Err(ConstructError::Points { given, needed: surface.n_vertices() });
    }
    stage("colouring", ctx)?;
    let library = match &options.library {
        Some(library) => library,
        None => CellLibrary::built_in(options.cells),
    };
    let colours = colours(surface, options.route, options.swaps_colours());
    let mut plan = Plan { surface, points, options, library, colours, sides: None };
    plan.suit_positions(ctx);
    Ok(plan)
}

/// The next step begins, unless told to stop.
pub(crate) fn stage(name: &'static str, ctx: &Context<'_>) -> Result<(), ConstructError> {
    if let Some(reason) = ctx.stop() {
        return Err(ConstructError::Stopped(reason));
    }
    ctx.report(name, 0, None, String::new);
    Ok(())
}

/// The colours of a route.
pub(crate) fn colours(surface: &QuadSurface, route: RouteChoice, swap: bool) -> Colouring {
    match route {
        RouteChoice::Auto => colouring(surface, swap),
        RouteChoice::Erickson => all_black(surface),
    }
}

impl Plan<'_> {
    /// Chooses light sides, and the colours with them, that keep sharp vertices free of hexes.
    fn suit_positions(&mut self, ctx: &Context<'_>) {
        let Some((here, sides)) = self.relieved(&self.colours, ctx) else { return };
        self.sides = Some(sides);
        // Tetrahedra from elsewhere were made for the diagonals of one colouring.
        if self.options.tets.is_some() {
            return;
        }
        let swap = self.options.swaps_colours();
        let other = colouring(self.surface, !swap);
        // Variants with swapped colours are to differ from the others, so they take the worse of the two.
        if let Some((there, sides)) = self.relieved(&other, ctx)
            && (there < here) != swap
        {
            (self.colours, self.sides) = (other, Some(sides));
        }
    }

    /// The light sides that suit the positions for these colours, and what is left of the strain.
    fn relieved(&self, colours: &Colouring, ctx: &Context<'_>) -> Option<(f64, LightSides)> {
        let options = self.options;
        let points = self.points?;
        if options.cells != CellChoice::Embeddable || options.route != RouteChoice::Auto {
            return None;
        }
        let mut sides = light_sides(self.surface, &[], options.matching(), ctx).ok()?;
        let strain = relieve(self.surface, points, &colours.white, &mut sides, self.library)?;
        Some((strain, sides))
    }
}
