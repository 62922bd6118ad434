//! Smaller fillings by exchanging balls: what the atlas knows of small balls makes its own large fillings smaller.
//!
//! A filling with too many hexes is put together anew from [two halves](crate::halves), one of them searched backward, where that takes fewer, then [simplified](crate::simplify()), its
//! balls looked up in all that is known, larger cavities and steps included. Then it wanders: exchanges lead to other fillings with as many hexes, and
//! balls of each are [searched backward](crate::refill). What comes out is [shelled anew](crate::narrow_shelling). A class without a filling starts
//! from halves or from one found by [inward flips](crate::fill_from_atlas), however large. Fillings made smaller join what is known, so the next round meets
//! them.
//!
//! Source: Verhetsel et al. 2018 (abstract: groups of hexes get new interiors with fewer); with an atlas, ours.

use crate::atlas::Atlas;
use crate::cavity::Cavity;
use crate::flip::Flip;
use crate::grow::ClassHash;
use crate::halves::{Membranes, smallest_halves};
use crate::inward::{FillOptions, fill_from_atlas};
use crate::known::Known;
use crate::narrow_shelling::narrow_shelling;
use crate::refill::refilled;
use crate::simplify::{Collapse, SimplifyOptions, simplify};
use hexfill_mesh::{Context, HexMesh};

/// Most quads of a ball.
const BALL_QUADS: usize = 26;
/// Balls exchanged in a step of a walk, and balls searched backward.
const STEP_BALLS: u64 = 1_000;
const STEP_REFILLED: usize = 40;
/// Cavities looked at for a first filling.
const CAVITIES: u64 = 300_000;

/// What fillings are made from.
#[derive(Clone, Copy)]
pub(crate) struct Fillings<'a> {
    /// What is known.
    pub(crate) known: &'a Known,
    /// The same, to be looked up, steps included.
    pub(crate) atlas: &'a Atlas,
    pub(crate) membranes: &'a Membranes,
}

/// The flips of a filling of `sphere`, whose class is `class`, with less than `limit` hexes, if `balls` tried balls lead to one.
pub(crate) fn smaller_filling(
    sphere: &Cavity,
    class: ClassHash,
    limit: u32,
    from: &Fillings<'_>,
    balls: u64,
    ctx: &Context<'_>,
) -> Option<Vec<Flip>> {
    let Fillings { known, atlas, membranes } = *from;
    // Each class takes a sequence of its own, and another one each round.
    let ctx = Context { progress: None, seed: ctx.seed ^ class as u64 ^ balls, ..*ctx };
    let halves = smallest_halves(sphere, limit, &[atlas, Atlas::embedded()], membranes, known, &ctx);
    let mesh = match (halves.clone(), known.smallest(class)) {
        (Some(mesh), _) => mesh,
        (None, Some(ball)) => HexMesh::try_new(ball.n_vertices as usize, &ball.hexes).ok()?,
        (None, None) => any_filling(sphere, atlas, &ctx)?,
    };
    let options = SimplifyOptions::default().with_max_quads(BALL_QUADS).with_collapse(Collapse::Nothing);
    let made = simplify(&mesh, atlas, &options.with_balls(balls), &ctx).mesh;
    let made = wandered(made, from, balls, &options.wandering().with_balls(STEP_BALLS), &ctx);
    let exchanged = (made.n_hexes() < limit as usize).then(|| narrow_shelling(&made)).flatten();
    // What exchanges bring may need larger boundaries than an atlas has.
    exchanged.or_else(|| narrow_shelling(&halves?))
}

/// The smallest mesh met on a walk through meshes with as many hexes, on which so many balls are exchanged and a share of them searched backward.
fn wandered(mut mesh: HexMesh, from: &Fillings<'_>, balls: u64, step: &SimplifyOptions, ctx: &Context<'_>) -> HexMesh {
    for i in 0..balls / STEP_BALLS {
        let ctx = Context { seed: ctx.seed ^ i << 40, ..*ctx };
        while let Some(smaller) = refilled(&mesh, STEP_REFILLED, from.known, &ctx) {
            mesh = smaller;
        }
        mesh = simplify(&mesh, from.atlas, step, &ctx).mesh;
    }
    mesh
}

fn any_filling(sphere: &Cavity, atlas: &Atlas, ctx: &Context<'_>) -> Option<HexMesh> {
    let options = FillOptions::default().with_max_cavities(CAVITIES);
    let outcome = fill_from_atlas(&sphere.to_surface(), atlas, &options, ctx)?;
    outcome.fillings.into_iter().next().map(|filling| filling.mesh)
}
