//! The solver: layers and closings one after the other, cheapest first, from many noisy starts.
//!
//! One sweep takes the legal move of least cost until the void is closed or no move is legal. Restarts multiply every cost
//! by a random factor; what comes out is ranked by (cost, hexes after lifting, number of the restart), so the result does
//! not depend on the number of threads.
//!
//! Source: ours on top of Müller-Hannemann 2001, who takes the cycles in one order; noise and restarts are ours.

use crate::dart::{next, prev};
use crate::layer::{Move, Places, Ring, consider, make, rings};
use crate::void::Void;
use hexfill_mesh::{Context, Random};
use rayon::prelude::*;
use rustc_hash::FxHashSet;

/// A sweep by layers, complete or not.
#[derive(Clone, Debug)]
pub(crate) struct Sweep {
    /// What is left: no front if it is complete.
    pub void: Void,
    /// Sum of the costs of its moves.
    pub cost: f32,
    /// Hexes its moves took, after lifting.
    pub fine_hexes: u64,
    restart: u64,
}

impl Sweep {
    /// Whether nothing is left to fill.
    pub(crate) fn is_complete(&self) -> bool {
        self.void.quads.is_empty()
    }

    fn rank(&self) -> (usize, f32, u64, u64) {
        (self.void.quads.len(), self.cost, self.fine_hexes, self.restart)
    }
}

/// How much costs vary from restart to restart.
const NOISE: f32 = 1.0;
/// What a fine hex costs besides, in turn: where creases do not decide, smaller sides go first.
const PER_HEX: [f32; 4] = [0.0, 0.02, 0.1, 0.5];
/// Sets of two rings are looked at only among so many rings.
const MOST_PAIRED: usize = 64;
/// Edges that want fewer hexes than this bound the patches that may be a side.
const CREASE: f32 = 1.5;

/// The sweeps of all restarts from a void, best first; of the complete ones those that no other beats in both cost and hexes.
pub(crate) fn solve(start: &Void, restarts: u64, ctx: &Context<'_>) -> Vec<Sweep> {
    let mut sweeps: Vec<Sweep> =
        (0..restarts).into_par_iter().filter_map(|restart| sweep(start, restart, ctx)).collect();
    sweeps.sort_by(|a, b| {
        let ((qa, ca, ha, ra), (qb, cb, hb, rb)) = (a.rank(), b.rank());
        qa.cmp(&qb).then(ca.total_cmp(&cb)).then(ha.cmp(&hb)).then(ra.cmp(&rb))
    });
    // Of the complete ones only those that no other beats in both cost and hexes: costs ascend, hexes must fall.
    let mut fewest = u64::MAX;
    sweeps.retain(|s| {
        let keep = !s.is_complete() || s.fine_hexes < fewest;
        fewest = fewest.min(s.fine_hexes);
        keep
    });
    sweeps
}

/// One sweep; `None` if it was stopped.
fn sweep(start: &Void, restart: u64, ctx: &Context<'_>) -> Option<Sweep> {
    // A restart depends on its number alone, so any number of threads draws the same.
    let mut random = Random::new(ctx.seed.wrapping_mul(0x1_0001).wrapping_add(restart));
    let per_hex = PER_HEX[(restart % PER_HEX.len() as u64) as usize];
    let mut sweep = Sweep { void: start.clone(), cost: 0.0, fine_hexes: 0, restart };
    let mut places = Places::default();
    while !sweep.is_complete() {
        if ctx.stop().is_some() {
            return None;
        }
        let mut moves = moves(&sweep.void, &mut places);
        // The plain sweep breaks ties by order; noise makes the order of equals random as well.
        let mut order: Vec<(f32, u32)> = (0..moves.len() as u32)
            .map(|i| {
                let the = &moves[i as usize];
                let noise = if restart == 0 { 0.0 } else { NOISE * random.unit() as f32 };
                ((the.cost + per_hex * the.fine_hexes as f32 + 1e-3 * noise) * (1.0 + noise), i)
            })
            .collect();
        order.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        // Legality is asked in order of cost and only until a move is made: the only way to ask is to glue and to
        // take back.
        let Some(&(_, chosen)) = order.iter().find(|(_, i)| make(&mut sweep.void, &moves[*i as usize])) else { break };
        let chosen = moves.swap_remove(chosen as usize);
        sweep.cost += chosen.cost;
        sweep.fine_hexes += chosen.fine_hexes;
    }
    Some(sweep)
}

/// All moves that may be possible now, in a fixed order.
fn moves(void: &Void, places: &mut Places) -> Vec<Move> {
    let rings = rings(void);
    let mut found: Vec<Move> = Vec::new();
    let mut separates = vec![false; rings.len()];
    for (i, ring) in rings.iter().enumerate() {
        let moves = consider(void, places, vec![ring.clone()]);
        separates[i] = !moves.is_empty();
        found.extend(moves);
    }
    let mut seen = FxHashSet::default();
    for set in patch_sets(void, &rings) {
        if set.len() > 1 && seen.insert(set.clone()) {
            found.extend(consider(void, places, set.iter().map(|&r| rings[r].clone()).collect()));
        }
    }
    // Two rings that do not separate alone may separate together, as the inner and outer equator of a torus do; all
    // pairs are looked at, so only while they are few.
    if rings.len() <= MOST_PAIRED && !separates.iter().all(|&s| s) {
        for i in 0..rings.len() {
            for j in i + 1..rings.len() {
                let same_height = void.length[rings[i][0] as usize] == void.length[rings[j][0] as usize];
                if !separates[i] && !separates[j] && i / 2 != j / 2 && same_height && seen.insert(vec![i, j]) {
                    found.extend(consider(void, places, vec![rings[i].clone(), rings[j].clone()]));
                }
            }
        }
    }
    found
}

/// The rings round each patch of the front between creases, if its whole boundary is of rings of one multiplicity.
fn patch_sets(void: &Void, rings: &[Ring]) -> Vec<Vec<usize>> {
    let mut ring_of = vec![usize::MAX; void.n_darts() as usize];
    for (i, ring) in rings.iter().enumerate() {
        ring.iter().for_each(|&d| ring_of[d as usize] = i);
    }
    let mut seen = vec![false; void.quads.len()];
    let mut sets = Vec::new();
    for seed in 0..void.quads.len() as u32 {
        if seen[seed as usize] {
            continue;
        }
        seen[seed as usize] = true;
        let mut work = vec![seed];
        let mut set = Some(Vec::new());
        while let Some(q) = work.pop() {
            for d in 4 * q..4 * q + 4 {
                let t = void.twin[d as usize];
                if void.wanted[d as usize] >= CREASE {
                    if !std::mem::replace(&mut seen[(t >> 2) as usize], true) {
                        work.push(t >> 2);
                    }
                    continue;
                }
                debug_assert_eq!(next(prev(t)), t);
                // Across a crease the patch ends. Where the quad beyond belongs to a ring that runs along the crease,
                // that ring can take the patch up as its side; if any part of the boundary has none, the patch is not
                // a candidate.
                let ring = ring_of[prev(t) as usize];
                match &mut set {
                    Some(set) if ring != usize::MAX => set.push(ring),
                    _ => set = None,
                }
            }
        }
        let Some(mut set) = set else { continue };
        set.sort_unstable();
        set.dedup();
        let height = |r: &usize| void.length[rings[*r][0] as usize];
        if !set.is_empty() && set.iter().all(|r| height(r) == height(&set[0])) {
            sets.push(set);
        }
    }
    sets
}
