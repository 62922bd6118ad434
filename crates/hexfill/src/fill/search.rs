//! Small spheres: the atlas, inward flips, and growth of an atlas towards the surface.
//!
//! Source: Verhetsel et al. 2019, figure 1, in the order atlas, flips, growth, which is ours.

use crate::fill::attempt::Attempt;
use crate::fill::error::FillError;
use crate::fill::filled::{FillResult, Filled, Route};
use crate::fill::judged::{accept, verify};
use crate::fill::maker::Maker;
use crate::fill::options::{FillOptions, Strategy};
use hexfill_construct::CellChoice;
use hexfill_mesh::{Context, HexMesh, QuadSurface, StopReason};
use hexfill_search::{Atlas, Cavity, FillOptions as InwardOptions, Growth, GrowthLog, MAX_CAP, fill_from_atlas};

/// Atlas, inward flips and, if nothing else may follow, growth.
pub(crate) fn search(
    surface: &QuadSurface,
    options: &FillOptions,
    ctx: &Context<'_>,
    result: &mut FillResult,
) -> Result<(), FillError> {
    let atlas = options.atlas.as_deref().unwrap_or_else(|| suited(surface, options));
    let inward = InwardOptions::default()
        .with_max_hexes(options.max_hexes)
        // Several placements may be isomorphic as meshes: look for more than are asked for.
        .with_count(if options.count == 1 { 1 } else { 8 * options.count })
        .with_improve(options.improve)
        .with_max_cavities(if options.improve { u64::MAX } else { options.inward_cavities })
        .with_beam(options.beam);
    let outcome = fill_from_atlas(surface, atlas, &inward, ctx).expect("the caller checked: a small sphere");
    if outcome.stop != StopReason::Finished {
        result.stop = outcome.stop;
    }
    result.tried.push(Attempt::Atlas { states: atlas.n_states(), cavities: outcome.cavities });
    for filling in outcome.fillings {
        let route = if filling.glued == 0 { Route::Atlas } else { Route::InwardFlips };
        let mut filled = Filled::by(route, filling.mesh);
        // The atlas's ball comes first.
        let ball = filled.mesh.n_hexes() - filling.glued as usize;
        filled.makers[..ball].fill(Maker::Atlas);
        accept(surface, filled, options, result)?;
    }
    if options.strategy == Strategy::Atlas && result.meshes.len() < options.count && ctx.stop().is_none() {
        grow_towards(surface, options, ctx, result)?;
    }
    Ok(())
}

/// The atlas for a surface: the one with the fewest hexes if nothing will be embedded, or to look up what the other does not know.
fn suited(surface: &QuadSurface, options: &FillOptions) -> &'static Atlas {
    let (cavity, _) = Cavity::from_surface(surface).expect("the caller checked: a small sphere");
    let knows = |atlas: &Atlas| atlas.balls_for(&cavity).next().is_some();
    let wants_fewest = options.cells == CellChoice::Fewest && options.count == 1;
    let is_unknown = || options.inward_cavities == 1 && !knows(Atlas::embedded());
    if (wants_fewest || is_unknown()) && knows(Atlas::fewest()) { Atlas::fewest() } else { Atlas::embedded() }
}

/// The smallest filling on record of a small sphere. [`search`] takes one that embeds more often, if there is one; for this surface that may be otherwise.
pub(crate) fn smallest_on_record(
    surface: &QuadSurface,
    options: &FillOptions,
    ctx: &Context<'_>,
) -> Result<Option<Filled>, FillError> {
    let look_up = InwardOptions::default().with_max_hexes(options.max_hexes).with_max_cavities(1);
    let outcome = fill_from_atlas(surface, Atlas::fewest(), &look_up, ctx).expect("the caller checked: a small sphere");
    let Some(filling) = outcome.fillings.into_iter().next() else { return Ok(None) };
    let filled = Filled::by(Route::Atlas, filling.mesh);
    verify(surface, &filled.mesh, filled.route)?;
    Ok(Some(filled))
}

/// Grows an atlas from one cube until the surface is reached.
fn grow_towards(
    surface: &QuadSurface,
    options: &FillOptions,
    ctx: &Context<'_>,
    result: &mut FillResult,
) -> Result<(), FillError> {
    let (cavity, ids) = Cavity::from_surface(surface).expect("the caller checked: a small sphere");
    if surface.n_quads() > MAX_CAP {
        result.tried.push(Attempt::NoGrowth);
        return Ok(());
    }
    let grow_options = options.growth.with_cap(options.growth.cap().max(surface.n_quads()));
    let (mut log, mut growth) = match &options.growth_log {
        Some(path) => {
            let (log, growth) = GrowthLog::open(path, grow_options)?;
            (Some(log), growth)
        }
        None => (None, Growth::new(grow_options)),
    };
    loop {
        // Asked after each level, so the first filling found has the fewest hexes this growth can reach; nothing is
        // blocked outside a whole surface, so the first placement is as good as any.
        for ball in growth.balls_for(&cavity) {
            if ball.n_hexes() as u64 > u64::from(options.max_hexes) {
                continue;
            }
            if let Some((map, mirrored)) = ball.placements(&cavity).into_iter().next() {
                let boundary: Vec<u32> = map.iter().map(|&v| ids[usize::from(v)]).collect();
                let first = surface.n_vertices() as u32;
                let (hexes, fresh) = ball.hexes_in(&boundary, mirrored, first);
                let mesh = HexMesh::try_new((first + fresh) as usize, &hexes).expect("a ball's hexes glue properly");
                accept(surface, Filled::by(Route::Growth, mesh), options, result)?;
            }
        }
        if result.meshes.len() >= options.count || growth.is_exhausted() || growth.level() >= options.max_hexes {
            break;
        }
        let report = growth.grow(ctx);
        if let Some(stop) = report.stopped {
            result.stop = stop;
            break;
        }
        if let Some(log) = &mut log {
            log.append(&growth, &report)?;
        }
    }
    result.tried.push(Attempt::Growth {
        cap: grow_options.cap(),
        width: grow_options.width(),
        hexes: growth.level(),
        classes: growth.n_classes(),
    });
    Ok(())
}
