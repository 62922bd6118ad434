//! Stirring: what the sweep leaves is changed by flips that empty no lens, and swept again.
//!
//! A chord with loops cannot be untangled by pushing triangles and emptying lenses alone. Two things help. A strip covers two opposite sides of one
//! sheet's belt in its hex, so it is a saddle: it *reconnects* two strands of the dual, and a chord that crosses itself may fall into two
//! that do not. And new crossings (2->4) may let two loops cancel. So flips are tried everywhere, alone and in pairs close to each other; each is followed by
//! emptying the lenses it brought, and kept if quads + self-crossings become fewer. Where none helps, some are made at random, and it starts again;
//! after half of the rounds behind a pillow.
//!
//! Source: ours; measured in `record/self-crossing-2026-11-22.md`.

use crate::dart::opposite;
use crate::front::{Front, Mark, NONE};
use crate::glue::Patch;
use crate::sweep_options::SweepOptions;
use crate::sweeper::Sweeper;
use hexfill_mesh::{Context, Random, StopReason};

/// Largest lens looked for after a flip.
const LENS: u32 = 12;
/// Up to this many quads all flips are compared, and pairs of flips are tried; beyond it the first that helps is made.
const SMALL: usize = 120;
/// Random flips made at a time.
const KICKS: usize = 3;

/// Number of quads that one chord passes twice. Linear time. `of` is work space.
fn self_crossings(front: &Front, of: &mut Vec<[u32; 2]>) -> usize {
    of.clear();
    of.resize(front.n_slots() as usize, [NONE; 2]);
    for (n, start) in (0..).zip(front.slots().flat_map(|q| [4 * q, 4 * q + 1])) {
        let mut at = start;
        while of[at as usize / 4][at as usize % 2] == NONE {
            of[at as usize / 4][at as usize % 2] = n;
            at = front.twin(opposite(at));
        }
    }
    of.iter().filter(|[a, b]| a == b && *a != NONE).count()
}

/// A flip: a dart and what is covered; `None`: the three quads round the dart's origin.
type Move = (u32, Option<Patch>);

/// The flips that start at the quads of these slots.
fn moves_at(slots: impl Iterator<Item = u32>) -> Vec<Move> {
    let of = |q: u32| {
        let strips = [0, 1].map(|i| (4 * q + i, Some(Patch::Strip)));
        let others = [0, 1, 2, 3].map(|i| [(4 * q + i, Some(Patch::Pair)), (4 * q + i, None)]);
        strips.into_iter().chain(others.into_iter().flatten())
    };
    slots.flat_map(of).collect()
}

fn make(front: &mut Front, (d, patch): Move) -> bool {
    if !front.is_quad(d / 4) {
        return false;
    }
    match patch {
        // Each pair once.
        Some(Patch::Pair) if front.twin(d) < d => false,
        Some(patch) => front.glue_hex(d, patch).is_ok(),
        None => front.flip(front.origin(d)).is_ok(),
    }
}

/// The quads that changed since `mark`, and their neighbours.
fn near(front: &Front, mark: Mark) -> Vec<u32> {
    let changed = front.changed_slots(mark).into_iter().filter(|&q| front.is_quad(q));
    let mut slots: Vec<u32> =
        changed.flat_map(|q| [q, q, q, q].into_iter().chain((4 * q..4 * q + 4).map(|d| front.twin(d) / 4))).collect();
    slots.sort_unstable();
    slots.dedup();
    slots
}

/// Stirs the front in `rounds` rounds, or until nothing is left or the atlas of the options (if given) closes it; the best state met is kept.
/// `None`, or why it stopped early. An odd number of quads never closes: do not ask.
pub fn stir_front(front: &mut Front, rounds: u32, options: &SweepOptions<'_>, ctx: &Context<'_>) -> Option<StopReason> {
    let mut random = Random::new(options.seed ^ 0x5354_4952);
    let rank = |front: &Front| (front.n_quads(), front.hexes().len());
    // The best state, and the one to go on from.
    let mut best = front.clone();
    let mut from = front.clone();
    for round in 0..rounds {
        if round > 0 && round == rounds / 2 {
            // Behind a pillow nothing is blocked, and all vertices may be merged.
            from = best.pillowed().0;
            *front = from.clone();
        }
        let stopped = descend(front, &mut random, options, ctx);
        *front = front.compact();
        if rank(front) < rank(&best) {
            best = front.clone();
        }
        let (left, hexes) = rank(&best);
        ctx.report("stirring", u64::from(round) + 1, Some(rounds.into()), || {
            format!("{left} quads left, {hexes} hexes")
        });
        if left == 0 || stopped.is_some() {
            *front = best;
            return stopped;
        }
        if let Some(closed) = options.atlas.and_then(|atlas| front.closed_from(atlas)) {
            *front = closed;
            return None;
        }
        // As many quads count as no worse: to walk along a plateau is what leaves a local minimum.
        if front.n_quads() <= from.n_quads() {
            from = front.clone();
        } else {
            *front = from.clone();
        }
        kick(front, &mut random);
    }
    *front = best;
    None
}

/// Makes some flips at random places.
fn kick(front: &mut Front, random: &mut Random) {
    let mut kicks = KICKS;
    for _ in 0..1000 {
        let d = random.below(4 * front.n_slots() as usize) as u32;
        // A new crossing or a saddle: flips that take quads away are the sweep's own.
        let patch = if random.below(2) == 0 { Patch::Pair } else { Patch::Strip };
        kicks -= usize::from(make(front, (d, Some(patch))));
        if kicks == 0 {
            break;
        }
    }
}

/// Sweeps, and makes flips that lower the energy, until there is none.
fn descend(
    front: &mut Front,
    random: &mut Random,
    options: &SweepOptions<'_>,
    ctx: &Context<'_>,
) -> Option<StopReason> {
    loop {
        let stopped = Sweeper::new(front, options).run(ctx);
        if stopped.is_some() || front.n_quads() == 0 {
            return stopped;
        }
        *front = front.compact();
        let mut moves = moves_at(front.slots());
        random.shuffle(&mut moves);
        let small = front.n_quads() <= SMALL;
        let mut search = Search { now: 0, sweeper: Sweeper::new(front, options), chords: Vec::new() };
        search.now = search.energy();
        // Tens of thousands of moves are tried, so each is followed by small lenses alone; the whole sweep comes when
        // one was kept.
        search.sweeper.narrow(LENS);
        let found = match search.one(&moves, small, ctx) {
            Ok(false) if small => search.two(&moves, ctx),
            other => other,
        };
        front.commit();
        match found {
            Err(stopped) => return Some(stopped),
            Ok(false) => return None,
            Ok(true) => {}
        }
    }
}

struct Search<'a> {
    now: usize,
    sweeper: Sweeper<'a>,
    /// Per quad: its two chords, while self-crossings are counted.
    chords: Vec<[u32; 2]>,
}

impl Search<'_> {
    /// What is to become less: how far the front is from closing.
    fn energy(&mut self) -> usize {
        self.sweeper.front.n_quads() + self_crossings(self.sweeper.front, &mut self.chords)
    }

    /// Makes one flip that lowers the energy: the first, or the best.
    fn one(&mut self, moves: &[Move], best: bool, ctx: &Context<'_>) -> Result<bool, StopReason> {
        // Energy counts quads and self-crossings: on spheres whose chords are simple the sweep closes the void, so
        // each self-crossing less is as much worth as a quad less.
        let mut found: Option<((usize, usize), Move)> = None;
        for (i, &m) in moves.iter().enumerate() {
            if i % 64 == 0 {
                ctx.stop().map_or(Ok(()), Err)?;
            }
            let mark = self.sweeper.front.mark();
            if !make(self.sweeper.front, m) {
                continue;
            }
            self.sweeper.settle(mark);
            let rank = (self.energy(), self.sweeper.front.hexes().len());
            if rank.0 < self.now {
                if !best {
                    return Ok(true);
                }
                if found.is_none_or(|(least, _)| rank < least) {
                    found = Some((rank, m));
                }
            }
            // The best so far is taken back as well and made again in the end: to keep it would take a copy of the
            // front.
            self.sweeper.front.take_back(mark);
        }
        let Some((_, m)) = found else { return Ok(false) };
        let mark = self.sweeper.front.mark();
        make(self.sweeper.front, m);
        self.sweeper.settle(mark);
        Ok(true)
    }

    /// Makes the first two flips close to each other that lower the energy.
    fn two(&mut self, moves: &[Move], ctx: &Context<'_>) -> Result<bool, StopReason> {
        for &first in moves {
            ctx.stop().map_or(Ok(()), Err)?;
            let start = self.sweeper.front.mark();
            if !make(self.sweeper.front, first) {
                continue;
            }
            // Only where the first flip changed something: two flips far apart would each have to help alone, and
            // those were tried.
            for second in moves_at(near(self.sweeper.front, start).into_iter()) {
                let mark = self.sweeper.front.mark();
                if !make(self.sweeper.front, second) {
                    continue;
                }
                self.sweeper.settle(start);
                if self.energy() < self.now {
                    return Ok(true);
                }
                self.sweeper.front.take_back(mark);
            }
            self.sweeper.front.take_back(start);
        }
        Ok(false)
    }
}
