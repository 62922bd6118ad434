//! Completion: every 3-connected sphere of up to so many quads gets a filling.
//!
//! What a growth did not reach is searched [backward](crate::backward) from. The ways found join what is known, so later
//! searches meet them. Targets are taken in batches that only read what is known: the result does not depend on the
//! number of threads.
//!
//! Source: ours; that every class of a size is there is counted against Brinkmann et al. 2005.

use crate::atlas::{Atlas, short_hash};
use crate::backward::{Breadth, Way, shorter_way};
use crate::canonical::Canonical;
use crate::cavity::Cavity;
use crate::exchange::{Fillings, smaller_filling};
use crate::flip::Flip;
use crate::grow::{ClassHash, class_hash};
use crate::halves::Membranes;
use crate::known::Known;
use crate::narrow_shelling::narrow_shelling;
use hexfill_mesh::{Context, HexMesh, StopReason, generate::all_spheres_up_to};
use rayon::prelude::*;
use rustc_hash::FxHashSet;

/// Targets searched at a time.
const BATCH: usize = 256;

/// Most hexes of a filling that is better than none (the published bound for every sphere of at most 20 quads).
const BETTER_THAN_NONE: u32 = 72;

/// How hard to try, one after the other, while a target has too many hexes or none.
const EFFORTS: [Breadth; 6] = [
    Breadth { depth: 20, beam: 100, first: true },
    Breadth { depth: 40, beam: 300, first: true },
    Breadth { depth: 4, beam: 300, first: false },
    Breadth { depth: 6, beam: 600, first: false },
    Breadth { depth: 12, beam: 3_000, first: false },
    Breadth { depth: 20, beam: 20_000, first: false },
];

/// Balls tried for each large filling in the first round of exchanges.
const FIRST_BALLS: u64 = 2_000;

/// What to complete.
///
/// | option | default |
/// |---|---|
/// | quads, hexes of a class at most | 20, 56 |
/// | efforts | all |
/// | rounds | 3 |
#[derive(Clone, Copy, Debug)]
pub struct CompleteOptions {
    max_quads: usize,
    max_hexes: u32,
    efforts: usize,
    rounds: usize,
}

impl Default for CompleteOptions {
    fn default() -> Self {
        Self { max_quads: 20, max_hexes: 56, efforts: EFFORTS.len(), rounds: 3 }
    }
}

impl CompleteOptions {
    /// Every class of at most this many quads is to have a filling. Their list is practical to 20.
    #[must_use]
    pub fn with_max_quads(self, max_quads: usize) -> Self {
        Self { max_quads, ..self }
    }

    /// A filling with more hexes than this is looked at again with each effort.
    #[must_use]
    pub fn with_max_hexes(self, max_hexes: u32) -> Self {
        Self { max_hexes, ..self }
    }

    /// How many efforts to make, each wider than the one before.
    #[must_use]
    pub fn with_efforts(self, efforts: usize) -> Self {
        Self { efforts, ..self }
    }

    /// How many rounds of exchanging balls to make, each with four times as many as the one before.
    #[must_use]
    pub fn with_rounds(self, rounds: usize) -> Self {
        Self { rounds, ..self }
    }

    /// Every class of at most this many quads is to have a filling.
    pub fn max_quads(&self) -> usize {
        self.max_quads
    }

    /// A filling with more hexes than this is looked at again.
    pub fn max_hexes(&self) -> u32 {
        self.max_hexes
    }
}

/// What a completion brought.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CompleteReport {
    /// Classes of at most [`CompleteOptions::with_max_quads`] quads.
    pub targets: usize,
    /// How many of them the growth had reached.
    pub grown: usize,
    /// How many the atlas to keep had or were given, or with fewer hexes.
    pub kept: usize,
    /// How many were without a filling before the search: found backward, by halves, or by inward flips.
    pub found: usize,
    /// How many of all have more hexes than asked for.
    pub large: usize,
    /// How many have no filling.
    pub missing: usize,
    /// Why the search ended.
    pub stop: StopReason,
}

/// A filling from elsewhere, as an atlas holds it.
#[derive(Clone, Debug)]
pub struct GivenFilling {
    flips: Vec<Flip>,
}

impl GivenFilling {
    /// The filling that a mesh is, a proper ball. `None` if it has more than 255 hexes, or no order of them was found whose parts have boundaries of at most
    /// [`MAX_CAP`](crate::MAX_CAP) quads.
    pub fn of_mesh(mesh: &HexMesh) -> Option<Self> {
        narrow_shelling(mesh).map(|flips| Self { flips })
    }
}

/// Why an atlas cannot be completed: flips that are not legal on their balls, from another version or written by something else.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CompleteError {
    /// In the growth.
    #[error("the growth holds flips that are not legal")]
    Grown,
    /// In the atlas to keep.
    #[error("the atlas to keep holds flips that are not legal")]
    Kept,
    /// In a filling that was given, by its position.
    #[error("filling {0} of those given holds flips that are not legal")]
    Given(usize),
}

/// A class to fill.
struct Target {
    sphere: Cavity,
    class: ClassHash,
}

/// A packed atlas of one filling a class: of all classes of at most `max_quads` quads, as far as they were found or `given`, and of all that
/// `kept` names, which get no more hexes than there.
///
/// # Errors
/// [`CompleteError`] says which of the three holds a flip that is not legal.
pub fn complete(
    grown: &Atlas,
    kept: &Atlas,
    given: &[GivenFilling],
    options: &CompleteOptions,
    ctx: &Context<'_>,
) -> Result<(Atlas, CompleteReport), CompleteError> {
    let mut known = Known::from_atlas(grown).ok_or(CompleteError::Grown)?;
    let targets = targets(options.max_quads);
    let fewest = |known: &Known| targets.iter().map(|t| known.fewest(t.class)).collect::<Vec<Option<u32>>>();
    let before = fewest(&known);
    let old = Known::from_atlas(kept).ok_or(CompleteError::Kept)?;
    known.merge(&old).ok_or(CompleteError::Kept)?;
    // What the old atlas knew counts as known and not as found, and its classes keep at most the hexes they had: an
    // atlas never gets worse.
    for (i, filling) in given.iter().enumerate() {
        known.add_ball(&filling.flips).ok_or(CompleteError::Given(i))?;
    }
    let with_kept = fewest(&known);
    let gained = before.iter().zip(&with_kept).filter(|(before, now)| before != now).count();
    let mut report = CompleteReport {
        targets: targets.len(),
        grown: before.iter().flatten().count(),
        kept: gained,
        found: 0,
        large: 0,
        missing: 0,
        stop: StopReason::Finished,
    };
    let names: FxHashSet<u64> = targets.iter().map(|t| short_hash(t.class)).chain(kept.hashes()).collect();
    for breadth in EFFORTS.iter().take(options.efforts) {
        shorten(&mut known, &targets, breadth, options.max_hexes, ctx);
        if let Some(stop) = ctx.stop() {
            report.stop = stop;
            break;
        }
    }
    for round in 0..options.rounds {
        if report.stop != StopReason::Finished {
            break;
        }
        exchange_round(&mut known, &targets, FIRST_BALLS << (2 * round), options.max_hexes, ctx);
        report.stop = ctx.stop().unwrap_or(StopReason::Finished);
    }
    for (target, before) in targets.iter().zip(&with_kept) {
        let hexes = known.fewest(target.class);
        report.missing += usize::from(hexes.is_none());
        report.found += usize::from(hexes.is_some() && before.is_none());
        report.large += usize::from(hexes.is_some_and(|h| h > options.max_hexes));
    }
    let one_each = |known: &Known| known.to_atlas(|class| names.contains(&short_hash(class))).pruned(1, |_, _| true);
    // A class that got no fewer hexes keeps its filling, so that what is filled with it stays the same.
    let new = Known::from_atlas(&one_each(&known)).expect("what is known are legal flips");
    let mut all = old;
    all.merge(&new).expect("what is known are legal flips");
    Ok((one_each(&all), report))
}

fn targets(max_quads: usize) -> Vec<Target> {
    let mut canonical = Canonical::new();
    let spheres = all_spheres_up_to(max_quads).into_iter().step_by(2).flatten();
    let target = |surface| {
        let sphere = Cavity::from_surface(&surface)?.0;
        canonical.compute(&sphere);
        Some(Target { class: class_hash(canonical.code()), sphere })
    };
    spheres.filter_map(target).collect()
}

/// Searches backward from every target with more than `max_hexes` hexes or without a filling.
fn shorten(known: &mut Known, targets: &[Target], breadth: &Breadth, max_hexes: u32, ctx: &Context<'_>) {
    // A search that ends with its first way is for those that have none.
    let too_many = |hexes: u32| hexes > max_hexes && !breadth.first;
    let wanted: Vec<&Target> = targets.iter().filter(|t| known.fewest(t.class).is_none_or(too_many)).collect();
    let mut found = 0;
    for (i, batch) in wanted.chunks(BATCH).enumerate() {
        ctx.report("atlas completion", (i * BATCH) as u64, Some(wanted.len() as u64), || {
            format!("up to {} hexes back, {found} found or shortened", breadth.depth)
        });
        let search = |target: &&Target| {
            let limit = known.fewest(target.class).unwrap_or(BETTER_THAN_NONE + 1);
            if ctx.stop().is_some() { None } else { shorter_way(&target.sphere, limit, known, breadth, ctx) }
        };
        // A batch is searched in what was known before it and added in order: threads do not see each other's finds,
        // so any number of them finds the same.
        let ways: Vec<Option<Way>> = batch.par_iter().map(search).collect();
        for way in ways.into_iter().flatten() {
            let end = known.add_way(way.start, &way.classes).expect("what meets can be glued outward again");
            debug_assert!(known.hexes(end) <= way.hexes);
            found += 1;
        }
    }
}

/// Exchanges balls in every filling with more than `max_hexes` hexes, and fills what has none.
fn exchange_round(known: &mut Known, targets: &[Target], balls: u64, max_hexes: u32, ctx: &Context<'_>) {
    let atlas = known.to_atlas(|_| true);
    let membranes = Membranes::default();
    let too_many = |t: &&Target| known.fewest(t.class).is_none_or(|hexes| hexes > max_hexes);
    let wanted: Vec<&Target> = targets.iter().filter(too_many).collect();
    let mut found = 0;
    for (i, batch) in wanted.chunks(BATCH).enumerate() {
        ctx.report("atlas exchanges", (i * BATCH) as u64, Some(wanted.len() as u64), || {
            format!("{balls} balls each, {found} found or shortened")
        });
        let from = Fillings { known, atlas: &atlas, membranes: &membranes };
        let search = |target: &&Target| {
            // A filling of any size is better than none: the next round makes it smaller.
            let limit = known.fewest(target.class).unwrap_or(u32::MAX);
            if ctx.stop().is_some() {
                None
            } else {
                smaller_filling(&target.sphere, target.class, limit, &from, balls, ctx)
            }
        };
        let fillings: Vec<Option<Vec<Flip>>> = batch.par_iter().map(search).collect();
        for flips in fillings.into_iter().flatten() {
            known.add_ball(&flips).expect("a shelled ball can be glued again");
            found += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{GrowOptions, Growth};

    #[test]
    fn small_classes_are_completed_and_nothing_kept_gets_worse() {
        let mut growth = Growth::new(GrowOptions { cap: 18, width: 1 }).with_beam(300);
        while growth.level() < 12 {
            growth.grow(&Context::default());
        }
        let grown = Atlas::from_growth(&growth);
        // The classes of 8 to 12 quads are left to the search, as far as they are no steps to others.
        let kept = Atlas::embedded().pruned(1, |quads, _| quads == 14 || quads == 16);
        let options = CompleteOptions { max_quads: 12, max_hexes: 56, efforts: 2, rounds: 1 };
        let run = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| complete(&grown, &kept, &[], &options, &Context::default()).unwrap())
        };
        let (atlas, report) = run(1);
        assert_eq!((report.targets, report.missing), (16, 0), "{report:?}");
        assert_eq!(run(3), (atlas.clone(), report));
        for atlas_before in [&kept, &grown.pruned(1, |quads, _| quads <= 12)] {
            let hashes = atlas_before.hashes();
            let named = (0..atlas_before.n_states() as u32).filter(|&s| hashes[s as usize] != 0);
            for state in named {
                let ball = crate::Ball::replay(atlas_before.flips_to(state)).unwrap();
                let best = atlas.balls_for(&ball.boundary_only()).next().expect("a class that is kept");
                assert!(best.n_hexes() <= ball.n_hexes());
                best.debug_check();
            }
        }
    }
}
