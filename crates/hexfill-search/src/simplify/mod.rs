//! `simplify`: fewer hexes, the same boundary.
//!
//! Closed sheets and columns of hexes are pressed flat (`collapse.rs`: `sheet_collapse.rs`, `column_collapse.rs`; what is allowed:
//! `quotient.rs`). Balls of hexes grow in the mesh (`region.rs`); the boundary of each is looked up in an atlas, and a filling that has fewer
//! hexes and fits between the hexes outside takes the ball's place (`offer.rs`, `live.rs`). This is the search of Verhetsel,
//! Pellerin and Remacle ("A 44-element mesh of Schneiders' pyramid", 2018; SIGGRAPH 2019), which brought 88 hexes down to 66
//! and 44. To leave local minima, fillings of the same size are taken too, and by chance fillings of a few hexes more; that
//! chance falls to nothing in the course of the work (simulated annealing).
//!
//! Invariants: the boundary quads never change; a proper mesh stays proper and homeomorphic, by construction.
//! Work comes in batches: a batch of regions is grown in a mesh at rest by all threads, each with random numbers of its own,
//! and their offers are then placed in order, those that no longer fit being dropped. So the result is the same for any number
//! of threads, unless the clock ends it.
//!
//! Source: Verhetsel et al. 2018 (abstract: groups of hexes get new interiors with fewer), Kirkpatrick et al. 1983 (annealing).

mod collapse;
#[cfg(test)]
mod collapse_tests;
mod column_collapse;
mod gate;
mod live;
mod offer;
mod quotient;
mod region;
mod sheet_collapse;

use crate::atlas::Atlas;
use crate::cavity::MAX_QUADS;
use crate::grow::{GrowOptions, Growth};
use collapse::collapse_live;
pub use collapse::{Collapse, WithoutSheet, collapse, single_sheet_collapses};
pub use gate::Gate;
use hexfill_mesh::{Context, HexMesh, StopReason, VertexId};
pub(crate) use live::LiveMesh;
use live::NONE;
pub(crate) use offer::sequence;
use offer::{Offer, Search, Worker};
use rayon::prelude::*;
pub(crate) use region::Region;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, OnceLock};
use std::time::{Duration, Instant};

/// How much to do and how.
///
/// | option | default |
/// |---|---|
/// | balls | 100,000 |
/// | quads, hexes of a ball at most | 24, 100 |
/// | heat | 970 |
/// | collapse | everything |
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SimplifyOptions {
    balls: u64,
    max_quads: usize,
    max_hexes: usize,
    heat: u32,
    collapse: Collapse,
    wander: bool,
}

impl Default for SimplifyOptions {
    fn default() -> Self {
        Self { balls: 100_000, max_quads: 24, max_hexes: 100, heat: 970, collapse: Collapse::All, wander: false }
    }
}

impl SimplifyOptions {
    /// How many balls to grow: a bound of the work that does not depend on the clock. The chance of going up falls with the
    /// share of the balls that is done, or of the time if the context has a deadline, whichever is further.
    #[must_use]
    pub fn with_balls(self, balls: u64) -> Self {
        Self { balls, ..self }
    }

    /// Most quads of a ball that is looked up.
    #[must_use]
    pub fn with_max_quads(self, max_quads: usize) -> Self {
        Self { max_quads, ..self }
    }

    /// Most hexes of a ball.
    #[must_use]
    pub fn with_max_hexes(self, max_hexes: usize) -> Self {
        Self { max_hexes, ..self }
    }

    /// The chance, in thousandths (at most 999), that a filling may have one more hex than the ball (then of another one, and so on) when the
    /// work begins. 0: never more hexes, only fewer or as many.
    #[must_use]
    pub fn with_heat(self, heat: u32) -> Self {
        Self { heat: heat.min(999), ..self }
    }

    /// Which closed sheets and columns are [collapsed](collapse()), before the balls, between and after them.
    #[must_use]
    pub fn with_collapse(self, collapse: Collapse) -> Self {
        Self { collapse, ..self }
    }

    /// Return the last of the smallest meshes met and not the first: another one of the same size where none is smaller.
    #[must_use]
    pub(crate) fn wandering(self) -> Self {
        Self { wander: true, ..self }
    }

    /// How many balls to grow.
    pub fn balls(&self) -> u64 {
        self.balls
    }

    /// Which closed sheets and columns are collapsed.
    pub fn collapses(&self) -> Collapse {
        self.collapse
    }
}

/// What was done.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct SimplifyReport {
    /// Hexes of the input.
    pub before: usize,
    /// Hexes of the result.
    pub after: usize,
    /// Sheets collapsed.
    pub sheets: u64,
    /// Columns of hexes collapsed.
    pub columns: u64,
    /// Hexes that went with sheets and columns.
    pub collapsed: usize,
    /// Balls grown.
    pub balls: u64,
    /// Boundaries looked up.
    pub looked_up: u64,
    /// Exchanges for fewer hexes, for as many, for more.
    pub exchanges: [u64; 3],
    /// Exchanges that a [`Gate`] refused.
    pub refused: u64,
    /// Why the work ended.
    pub stop: StopReason,
}

impl SimplifyReport {
    /// Nothing done yet to a mesh of so many hexes.
    pub fn new(hexes: usize) -> Self {
        Self {
            before: hexes,
            after: hexes,
            sheets: 0,
            columns: 0,
            collapsed: 0,
            balls: 0,
            looked_up: 0,
            exchanges: [0; 3],
            refused: 0,
            stop: StopReason::Finished,
        }
    }
}

/// A mesh with the same boundary and no more hexes.
#[derive(Clone, Debug)]
pub struct Simplified {
    /// The mesh. Vertices that were there before keep their order and come first, new ones follow: where the boundary's
    /// vertices came first, they keep their ids. Vertices of no hex are kept.
    pub mesh: HexMesh,
    /// Per vertex of the result: the vertex of the input it was, or `None` for a new one.
    pub origin: Vec<Option<VertexId>>,
    /// What was done.
    pub report: SimplifyReport,
}

/// The atlas that [`simplify`] is best served with: grown here, in a second or two, to 22 hexes with cavities of up to 24 quads.
/// (The embedded atlas names no cavities of more than 20 quads.)
pub fn simplification_atlas() -> &'static Atlas {
    static ATLAS: OnceLock<Atlas> = OnceLock::new();
    ATLAS.get_or_init(|| {
        let mut growth = Growth::new(GrowOptions { cap: 24, width: 1 });
        while growth.level() < 22 && !growth.is_exhausted() {
            growth.grow(&Context::default());
        }
        Atlas::from_growth(&growth)
    })
}

impl Simplified {
    /// Nothing done yet.
    fn unchanged(mesh: &HexMesh) -> Self {
        let origin = (0..mesh.n_vertices() as u32).map(|v| Some(VertexId(v))).collect();
        Self { mesh: mesh.clone(), origin, report: SimplifyReport::new(mesh.n_hexes()) }
    }

    /// What `next` made of this mesh.
    fn then(mut self, next: Self) -> Self {
        self.origin = next.origin.iter().map(|o| o.and_then(|v| self.origin[v.index()])).collect();
        self.mesh = next.mesh;
        let (report, new) = (&mut self.report, next.report);
        report.after = new.after;
        report.sheets += new.sheets;
        report.columns += new.columns;
        report.collapsed += new.collapsed;
        report.balls += new.balls;
        report.looked_up += new.looked_up;
        report.exchanges = [0, 1, 2].map(|i| report.exchanges[i] + new.exchanges[i]);
        report.refused += new.refused;
        report.stop = new.stop;
        self
    }
}

/// Makes a mesh smaller without touching its boundary: [`collapse`](collapse()) if the options say so, then balls, then collapse
/// again. The mesh must be proper (level 2 of the judge), else the result need not be. Never returns more hexes than it was given.
///
/// Time: some tens of microseconds per boundary looked up, whatever the size of the mesh. Memory: about 250 bytes a hex and
/// some 20 bytes a hex for each thread.
pub fn simplify(mesh: &HexMesh, atlas: &Atlas, options: &SimplifyOptions, ctx: &Context<'_>) -> Simplified {
    if options.collapse == Collapse::Nothing {
        return exchange_balls(mesh, atlas, options, None, ctx).0;
    }
    let made = collapse(mesh, options.collapse, ctx);
    let exchanged = exchange_balls(&made.mesh, atlas, options, None, ctx).0;
    let is_other = exchanged.report.after < made.report.after;
    let made = made.then(exchanged);
    if !is_other || made.report.stop != StopReason::Finished {
        return made;
    }
    let last = collapse(&made.mesh, options.collapse, ctx);
    made.then(last)
}

/// [`simplify`] by exchanges for fewer hexes alone, each of which `gate` may refuse: no collapses, no detours. Also returns, per vertex of the result, the id
/// it had for the gate.
pub fn simplify_gated(
    mesh: &HexMesh,
    atlas: &Atlas,
    options: &SimplifyOptions,
    gate: &mut dyn Gate,
    ctx: &Context<'_>,
) -> (Simplified, Vec<u32>) {
    exchange_balls(mesh, atlas, &options.with_collapse(Collapse::Nothing), Some(gate), ctx)
}

/// Thousandths of the work between two collapses.
const COLLAPSE_EVERY: u64 = 50;

/// The balls of [`simplify`], with collapses between them; with a gate, those that save hexes. Also the id in the live mesh of every vertex of the result.
fn exchange_balls(
    mesh: &HexMesh,
    atlas: &Atlas,
    options: &SimplifyOptions,
    mut gate: Option<&mut dyn Gate>,
    ctx: &Context<'_>,
) -> (Simplified, Vec<u32>) {
    let mut live = LiveMesh::new(mesh);
    let mut report = SimplifyReport::new(mesh.n_hexes());
    let mut workers: Vec<Worker<'_>> = (0..rayon::current_num_threads()).map(|_| Worker::new(atlas)).collect();
    let clock = Clock { balls: options.balls, started: Instant::now(), deadline: ctx.deadline };
    let mut best = Snapshot::of(&live);
    let (is_boundary, mut collapsed_at) = (mesh.boundary_vertices(), 0);
    while report.balls < options.balls && live.n_hexes() > 1 {
        if let Some(stop) = ctx.stop() {
            report.stop = stop;
            break;
        }
        // Offers of one batch are made on the same mesh and those that touch a ball exchanged before are lost: so a
        // batch is small beside the mesh.
        let size = (live.n_hexes() as u64 / 16).clamp(4, 1024).min(options.balls - report.balls);
        let done = clock.done(report.balls);
        if done / COLLAPSE_EVERY > collapsed_at {
            collapsed_at = done / COLLAPSE_EVERY;
            collapse_live(&mut live, &is_boundary, options.collapse, &mut report, ctx);
        }
        // A gate is asked about every exchange, so none is wasted on going up or sideways.
        let search = search_of(options, if gate.is_some() { 0 } else { done });
        let seen = live.exchanges();
        for offer in offers(&live, &mut workers, report.balls, size, &search, ctx) {
            // Blocked pairs far from the ball may have changed too, through vertices they share: hence the second
            // question.
            if live.are_untouched_since(&offer.removed, seen) && still_fits(&live, &offer, seen) {
                make(&mut live, &offer, &mut gate, &mut report);
            }
        }
        report.balls += size;
        // A copy costs time in proportion to the mesh: of large meshes only clear progress is kept.
        let is_smaller = live.n_hexes() + live.n_hex_slots() / 4096 < best.hexes.len();
        if is_smaller || options.wander && live.n_hexes() == best.hexes.len() && live.exchanges() > seen {
            best = Snapshot::of(&live);
        }
        let total = (options.balls < u64::MAX).then_some(options.balls);
        ctx.report("simplify", report.balls, total, || {
            format!("now {} hexes, fewest {}, at first {}", live.n_hexes(), best.hexes.len(), mesh.n_hexes())
        });
    }
    report.looked_up = workers.iter().map(|w| w.looked_up).sum();
    if live.n_hexes() < best.hexes.len() {
        best = Snapshot::of(&live);
    }
    if best.hexes.len() + usize::from(!options.wander) > mesh.n_hexes() {
        let ids = (0..mesh.n_vertices() as u32).collect();
        return (Simplified { report, ..Simplified::unchanged(mesh) }, ids);
    }
    let Settled { mesh, origin, ids } = best.settled(mesh);
    report.after = mesh.n_hexes();
    (Simplified { mesh, origin, report }, ids)
}

/// Makes an exchange, unless the gate refuses it.
fn make(live: &mut LiveMesh, offer: &Offer, gate: &mut Option<&mut dyn Gate>, report: &mut SimplifyReport) {
    if let Some(gate) = gate {
        let removed: Vec<[u32; 8]> = offer.removed.iter().map(|&h| *live.hex(h)).collect();
        if !gate.admits(&removed, &offer.added, offer.first_new) {
            report.refused += 1;
            return;
        }
    }
    let kind = if offer.gain > 0 { 0 } else { 1 + usize::from(offer.gain < 0) };
    report.exchanges[kind] += 1;
    let ids = live.exchange(&offer.removed, &offer.added, offer.first_new);
    if let Some(gate) = gate {
        let made: Vec<[u32; 8]> = ids.iter().map(|&h| *live.hex(h)).collect();
        gate.made(&made);
    }
}

/// The mesh as it stood when it was smallest.
struct Snapshot {
    hexes: Vec<[u32; 8]>,
    /// Per vertex id: whether it came with an exchange.
    is_new: Vec<bool>,
}

impl Snapshot {
    fn of(live: &LiveMesh) -> Self {
        Self {
            hexes: live.alive().map(|h| *live.hex(h)).collect(),
            is_new: (0..live.n_vertex_slots() as u32).map(|v| live.is_new(v)).collect(),
        }
    }

    /// As a mesh with vertices numbered anew: the old ones in their order, then the new ones in theirs.
    fn settled(&self, input: &HexMesh) -> Settled {
        let used_before = input.used_vertices();
        let mut used = vec![false; self.is_new.len()];
        for &v in self.hexes.iter().flatten() {
            used[v as usize] = true;
        }
        let mut number = vec![NONE; used.len()];
        let (mut origin, mut ids) = (Vec::new(), Vec::new());
        for v in 0..input.n_vertices() {
            // Vertices that no hex used stay, as the ids of a surface must not shift; slots that a new vertex took
            // over from an old one count as new.
            if !used_before[v] || used[v] && !self.is_new[v] {
                number[v] = origin.len() as u32;
                origin.push(Some(VertexId(v as u32)));
                ids.push(v as u32);
            }
        }
        for v in 0..used.len() {
            if used[v] && self.is_new[v] {
                number[v] = origin.len() as u32;
                origin.push(None);
                ids.push(v as u32);
            }
        }
        let hexes: Vec<[u32; 8]> = self.hexes.iter().map(|h| h.map(|v| number[v as usize])).collect();
        let mesh = HexMesh::try_new(origin.len(), &hexes).expect("facets stay glued in pairs");
        Settled { mesh, origin, ids }
    }
}

/// A mesh taken out of a live one.
struct Settled {
    mesh: HexMesh,
    /// Per vertex: the vertex of the input it was, or `None` for a new one.
    origin: Vec<Option<VertexId>>,
    /// Per vertex: its id in the live mesh.
    ids: Vec<u32>,
}

/// How far the work is.
struct Clock {
    balls: u64,
    started: Instant,
    deadline: Option<Instant>,
}

impl Clock {
    /// In thousandths.
    fn done(&self, balls: u64) -> u64 {
        let by_balls = (u128::from(balls) * 1000 / u128::from(self.balls.max(1))) as u64;
        let by_time = self.deadline.map_or(0, |end| {
            let whole = end.saturating_duration_since(self.started).max(Duration::from_millis(1));
            (self.started.elapsed().as_millis() * 1000 / whole.as_millis().max(1)) as u64
        });
        by_balls.max(by_time).min(1000)
    }
}

/// The first fifth goes down only; then heat falls evenly and is gone for the last tenth.
fn search_of(options: &SimplifyOptions, done: u64) -> Search {
    let heat = if done < 200 { 0 } else { u64::from(options.heat.min(999)) * 900u64.saturating_sub(done) / 700 };
    let max_quads = options.max_quads.min(MAX_QUADS - 6);
    Search {
        max_quads,
        grow_quads: max_quads + 6,
        max_hexes: options.max_hexes.max(2),
        sideways: done >= 200,
        heat: heat as u32,
    }
}

/// Grows `size` regions in the mesh as it is; the offers in the order of their seeds.
fn offers(
    live: &LiveMesh,
    workers: &mut [Worker<'_>],
    first: u64,
    size: u64,
    search: &Search,
    ctx: &Context<'_>,
) -> Vec<Offer> {
    let (next, found) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    let work = |worker: &mut Worker<'_>| {
        while ctx.stop().is_none() {
            let i = next.fetch_add(1, Ordering::Relaxed);
            if i as u64 >= size {
                return;
            }
            // Numbered by the ball and not by the thread, so that it draws the same numbers whoever grows it.
            let mut random = sequence(ctx.seed, first + i as u64);
            let mut seed = NONE;
            while seed == NONE || !live.is_alive(seed) {
                seed = random.below(live.n_hex_slots()) as u32;
            }
            if let Some(offer) = worker.offer(live, seed, search, &mut random) {
                found.lock().unwrap_or_else(std::sync::PoisonError::into_inner).push((i, offer));
            }
        }
    };
    workers.par_iter_mut().with_max_len(1).for_each(work);
    let mut found = found.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    found.sort_unstable_by_key(|(i, _)| *i);
    found.into_iter().map(|(_, offer)| offer).collect()
}

/// Whether no hex outside has come to use a pair that the offer uses inside.
fn still_fits(live: &LiveMesh, offer: &Offer, seen: u32) -> bool {
    live.exchanges() == seen
        || offer.pairs.iter().all(|&[a, b]| {
            let (a, b) = if live.degree(a) <= live.degree(b) { (a, b) } else { (b, a) };
            live.hexes_at(a).all(|h| !live.hex(h).contains(&b) || offer.removed.contains(&h))
        })
}
