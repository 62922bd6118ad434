//! Coordinates for a filling, and what the judge says of them cell by cell. Never more is said than was shown.
//!
//! Source: ours.

pub(crate) mod embed_mesh;
pub(crate) mod placed;
pub(crate) mod report;
pub(crate) mod ways;

use crate::fill::filled::Filled;
use crate::problem::Problem;
use hexfill_embed::{EmbedError, EmbedReport, Options, embed, tutte_start};
use hexfill_mesh::Context;
use placed::Placed;
use ways::placements;

/// Places a filling at the [positions](Problem::positions) of its problem: with `options` it is embedded, without them it gets start
/// positions only (its own, or Tutte's). Every hex is judged. `None` if the surface has no positions.
///
/// Positions of the surface that cannot be used (all in one spot, say) cost the geometry, never the mesh: interior vertices then lie on a
/// boundary vertex, and [`Placed::refused`] says why.
///
/// A mesh without start positions that embeds better another way comes back turned on its surface, an isomorphic mesh; which is why the
/// filling is taken and returned.
///
/// ```
/// use hexfill::{Context, EmbedOptions, FillOptions, Problem, fill, place};
///
/// let (geode, ctx) = (Problem::named("geode")?, Context::default());
/// let mut result = fill(&geode, &FillOptions::default(), &ctx)?;
/// let placed = place(result.meshes.remove(0), &geode, Some(&EmbedOptions::default()), &ctx);
/// assert!(placed.is_some_and(|(_, placed)| placed.is_certified()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn place(
    filled: Filled,
    problem: &Problem,
    options: Option<&Options>,
    ctx: &Context<'_>,
) -> Option<(Filled, Placed)> {
    let boundary = problem.positions()?;
    Some(place_at(filled, problem, &boundary, options, ctx))
}

/// [`place`] at these positions of the surface.
pub(crate) fn place_at(
    filled: Filled,
    problem: &Problem,
    boundary: &[[f64; 3]],
    options: Option<&Options>,
    ctx: &Context<'_>,
) -> (Filled, Placed) {
    match options {
        Some(options) if filled.start.is_none() => {
            place_best(std::slice::from_ref(&filled), problem, boundary, options, ctx)
                .expect("one mesh is given, so one is best")
        }
        _ => {
            let placed = place_as_it_is(&filled, boundary, options, ctx);
            (filled, placed)
        }
    }
}

/// Start positions alone: the construction's, or Tutte's. Nothing is judged.
pub(crate) fn start_positions(filled: &Filled, boundary: &[[f64; 3]], ctx: &Context<'_>) -> Placed {
    let (points, _, refused) = positions_or_none(filled, boundary, None, ctx);
    Placed { points, cells: Vec::new(), embedding: None, refused, ways: 1 }
}

/// Most ways to lie on the surface that are embedded, a mesh.
const MOST_WAYS: usize = 6;

/// Embeds fillings of one surface, each in all the ways it lies on it, and returns the best: most hexes certified, then the
/// largest worst scaled Jacobian. Those with larger star bounds come first, and none is tried whose bound is no
/// better than what was reached. `None` if there are no fillings.
pub(crate) fn place_best(
    meshes: &[Filled],
    problem: &Problem,
    boundary: &[[f64; 3]],
    options: &Options,
    ctx: &Context<'_>,
) -> Option<(Filled, Placed)> {
    let mut all: Vec<(f64, usize, Filled)> = Vec::new();
    for filled in meshes {
        if filled.start.is_some() {
            all.push((f64::INFINITY, 1, filled.clone()));
            continue;
        }
        let ways = placements(&filled.mesh, &problem.surface, boundary);
        let n = ways.len();
        // The ways with the best bounds; a bound below what is certified already ends the search.
        all.extend(ways.into_iter().take(MOST_WAYS).map(|way| {
            let turned = Filled { mesh: way.mesh, start: None, ..filled.clone() };
            (way.upper_bound, n, turned)
        }));
    }
    // Stable: first come, first served among equals.
    all.sort_by(|a, b| b.0.total_cmp(&a.0));
    let n_tried = all.len() as u64;
    let mut best: Option<(Filled, Placed)> = None;
    for (number, (upper_bound, ways, turned)) in all.into_iter().enumerate() {
        // Upper bounds hold up to rounding.
        if let Some((_, b)) = &best
            && (b.is_certified() && b.worst() + 1e-9 >= upper_bound || ctx.stop().is_some())
        {
            break;
        }
        ctx.report("placements", number as u64, Some(n_tried), || match &best {
            Some((_, b)) => format!("best scaled Jacobian {:.4}", b.worst()),
            None => String::new(),
        });
        let placed = Placed { ways, ..place_as_it_is(&turned, boundary, Some(options), ctx) };
        if best.as_ref().is_none_or(|(_, b)| placed.rank() > b.rank()) {
            best = Some((turned, placed));
        }
    }
    best
}

/// [`place`] without turning.
pub(crate) fn place_as_it_is(
    filled: &Filled,
    boundary: &[[f64; 3]],
    options: Option<&Options>,
    ctx: &Context<'_>,
) -> Placed {
    let (points, embedding, refused) = positions_or_none(filled, boundary, options, ctx);
    let placed = Placed::judged(&filled.mesh, boundary, points, embedding, filled.start.as_deref());
    Placed { refused, ..placed }
}

/// [`positions`]; where there are none, interior vertices at a boundary vertex and the reason.
fn positions_or_none(
    filled: &Filled,
    boundary: &[[f64; 3]],
    options: Option<&Options>,
    ctx: &Context<'_>,
) -> (Vec<[f64; 3]>, Option<EmbedReport>, Option<EmbedError>) {
    match positions(filled, boundary, options, ctx) {
        Ok((mut points, embedding)) => {
            // The surface's points come back bit for bit, those that no quad uses included.
            points[..boundary.len()].copy_from_slice(boundary);
            (points, embedding, None)
        }
        Err(why) => {
            let anywhere = boundary.first().copied().unwrap_or_default();
            let mut points = boundary.to_vec();
            points.resize(filled.mesh.n_vertices(), anywhere);
            (points, None, Some(why))
        }
    }
}

/// An embedding that is told to stop at once still smooths and judges meshes of so few hexes in a moment.
const QUICK: usize = 10_000;

/// Positions by the embedding, or to start from.
fn positions(
    filled: &Filled,
    boundary: &[[f64; 3]],
    options: Option<&Options>,
    ctx: &Context<'_>,
) -> Result<(Vec<[f64; 3]>, Option<EmbedReport>), EmbedError> {
    // Out of time, a large mesh stays as it is.
    let is_late = ctx.stop().is_some() && filled.start.is_some() && filled.mesh.n_hexes() > QUICK;
    Ok(match options.filter(|_| !is_late) {
        Some(options) => {
            let made = embed(&filled.mesh, boundary, filled.start.as_deref(), options, ctx)?;
            (made.points, Some(made.report))
        }
        None => match &filled.start {
            Some(start) => (start.clone(), None),
            None => (tutte_start(&filled.mesh, boundary)?, None),
        },
    })
}
