//! Stirring: what the sweep leaves is changed at random and swept again.
//!
//! A chord with loops cannot be untangled by pushing triangles and emptying lenses alone: two loops cancel only after new crossings were made. So flips
//! that add quads (2->4, 1->5) or move them (strips, corners) are tried at random places; each is followed by emptying the lenses it brought. What
//! came of it is kept or taken back by the rule of Metropolis (1953), for an energy of quads left and a fraction of the hexes spent.

use crate::front::{Front, opposite};
use crate::glue::Patch;
use crate::sweep::SweepOptions;
use crate::sweeper::Sweeper;
use hexfill_mesh::{Context, Random, StopReason};

/// What one hex costs, in quads.
const HEX: f64 = 0.2;
/// What a self-crossing costs, in quads.
const CROSSING: f64 = 1.0;
/// Temperature at the start and at the end, in quads.
const TEMPERATURE: [f64; 2] = [1.2, 0.3];
/// Largest lens looked for after a random flip.
const LENS: u32 = 12;

/// Stirs the front by `trials` random flips, or until nothing is left; the best state met is kept. Why it stopped early, if it did.
pub(crate) fn stir(
    front: &mut Front,
    trials: u32,
    options: &SweepOptions<'_>,
    ctx: &Context<'_>,
) -> Option<StopReason> {
    front.commit();
    let mut random = Random::new(options.seed ^ 0x5354_4952);
    let w: Vec<f64> = std::env::var("W").map(|w| w.split(',').map(|x| x.parse().unwrap()).collect()).unwrap_or(vec![
        HEX,
        CROSSING,
        TEMPERATURE[0],
        TEMPERATURE[1],
    ]);
    let energy = |front: &Front| {
        front.n_quads() as f64 + w[0] * front.hexes().len() as f64 + w[1] * self_crossings(front) as f64
    };
    let mut sweeper = Sweeper::new(front, options);
    sweeper.narrow(LENS);
    let mut now = energy(sweeper.front);
    let mut best = (sweeper.front.n_quads(), sweeper.front.hexes().len(), sweeper.front.mark());
    let mut stopped = None;
    for trial in 0..trials {
        if sweeper.front.n_quads() == 0 {
            break;
        }
        if trial % 64 == 0 {
            stopped = ctx.stop();
            if stopped.is_some() {
                break;
            }
            let (left, hexes) = (sweeper.front.n_quads(), sweeper.front.hexes().len());
            ctx.report("stirring", trial.into(), Some(trials.into()), || format!("{left} quads left, {hexes} hexes"));
        }
        let mark = sweeper.front.mark();
        if !flip_somewhere(sweeper.front, &mut random) {
            continue;
        }
        sweeper.settle(mark);
        let after = energy(sweeper.front);
        let progress = f64::from(trial) / f64::from(trials);
        let temperature = w[2] + progress * (w[3] - w[2]);
        if after > now && random.unit() >= ((now - after) / temperature).exp() {
            sweeper.front.take_back(mark);
            continue;
        }
        now = after;
        let (quads, hexes) = (sweeper.front.n_quads(), sweeper.front.hexes().len());
        if (quads, hexes) < (best.0, best.1) {
            best = (quads, hexes, sweeper.front.mark());
        } else if sweeper.front.mark() < best.2 {
            unreachable!("the journal only grows past accepted flips");
        }
    }
    front.take_back(best.2);
    front.commit();
    stopped
}

/// Number of quads that one chord passes twice. Linear time.
pub(crate) fn self_crossings(front: &Front) -> usize {
    let mut of = vec![[0u32; 2]; front.n_slots() as usize];
    let mut n = 0;
    for start in front.slots().flat_map(|q| [4 * q, 4 * q + 1]) {
        if of[start as usize / 4][start as usize % 2] != 0 {
            continue;
        }
        n += 1;
        let mut at = start;
        while of[at as usize / 4][at as usize % 2] == 0 {
            of[at as usize / 4][at as usize % 2] = n;
            at = front.twin(opposite(at));
        }
    }
    of.into_iter().filter(|[a, b]| a == b && *a != 0).count()
}

/// Reconnects strands of chords that cross themselves by strips, each of which leaves fewer self-crossings, and sweeps after each.
pub(crate) fn reconnect(front: &mut Front, options: &SweepOptions<'_>, ctx: &Context<'_>) -> Option<StopReason> {
    loop {
        let stopped = Sweeper::new(front, options).run(ctx);
        if stopped.is_some() || front.n_quads() == 0 {
            return stopped;
        }
        let mut best = (self_crossings(front), usize::MAX, 0);
        for d in front.slots().flat_map(|q| [4 * q, 4 * q + 1]).collect::<Vec<_>>() {
            let mark = front.mark();
            if front.glue_hex(d, Patch::Strip).is_ok() {
                best = best.min((self_crossings(front), front.n_quads(), d));
                front.take_back(mark);
            }
            if ctx.stop().is_some() {
                return ctx.stop();
            }
        }
        let (crossings, quads, d) = best;
        if std::env::var("DEBUG_SHELL").is_ok() {
            println!("{} quads, {} self-crossings -> {crossings} {quads}", front.n_quads(), self_crossings(front));
        }
        if quads == usize::MAX || front.glue_hex(d, Patch::Strip).is_err() {
            return None;
        }
        front.commit();
    }
}

/// Makes one flip at a random place; whether it was legal.
fn flip_somewhere(front: &mut Front, random: &mut Random) -> bool {
    let d = random.below(4 * front.n_slots() as usize) as u32;
    if !front.is_quad(d / 4) {
        return false;
    }
    match random.below(8) {
        0 => front.glue_hex(d, Patch::Quad).is_ok(),
        1..=3 => front.glue_hex(d, Patch::Pair).is_ok(),
        4..=5 => front.glue_hex(d, Patch::Strip).is_ok(),
        _ => front.flip(front.origin(d)).is_ok(),
    }
}
