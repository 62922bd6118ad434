//! [`Laying`]: the hexes laid so far, their positions, and the front of what is open.
//!
//! Source: ours; why room can be made: Barnette 1970, and the pillows of Mitchell, Tautges 1995.

use crate::open_mesh::OpenMesh;
use crate::plan::Plan;
use crate::step::Step;
use crate::void_front::{NOT_YET, VoidFront, advanced};
use hexfill_embed::OpenEffort;
use hexfill_geometry::Vector;
use hexfill_mesh::cube::CORNER_NEIGHBOURS;
use hexfill_mesh::{Context, QuadSurface};
use rustc_hash::FxHashMap;

/// A new vertex begins at the mean of its neighbours, moved by this share towards the apex.
const INWARD: f64 = 0.15;
/// Shares of the way to the apex by which a pillow's inner side lies further in, the first valid one is taken.
const HEIGHTS: [f64; 3] = [0.3, 0.15, 0.5];
/// Rounds of rounding a pillow, each kept only if it stays valid.
const ROUNDINGS: usize = 8;
/// A hex goes first where it covers at least so many quads: then the front does not grow.
const MANY: u32 = 3;
/// Hexes that are tried with more of their surroundings free.
const TRIED_WIDER: usize = 6;
/// After so many hexes all is rounded; where more hexes than these lie round the void, only so many rings round those laid since.
const ROUNDED: usize = 4;
const ALL_ROUNDED: usize = 600;
const ROUNDED_RINGS: usize = 2;

/// How long the untangler tries: a hex with one ring of free vertices, with more, rounding a pillow, rounding everything.
const ONE_RING: OpenEffort = effort(20, 60, 0);
const MORE_RINGS: OpenEffort = effort(60, 60, 0);
const JUDGE: OpenEffort = effort(0, 0, 0);
const ROUND_PILLOW: OpenEffort = effort(1, 15, 0);
const ROUND_ALL: OpenEffort = effort(3, 60, 2);

const fn effort(rounds: usize, iterations: usize, extra: usize) -> OpenEffort {
    OpenEffort { rounds, iterations, extra }
}

/// What is laid so far. Invariant between calls: every hex that is not forgiven is valid in floating point, and so is every pyramid over the front.
#[derive(Clone, Debug)]
pub(crate) struct Laying {
    pub(crate) open: OpenMesh,
    pub(crate) pillows: u32,
    /// Hexes of the plan since all was rounded.
    since: usize,
}

/// A plan on its way: which vertices and hexes of it are laid.
#[derive(Clone, Debug)]
pub(crate) struct Underway {
    plan: Plan,
    /// Per vertex of the plan: its id among those laid, or [`NOT_YET`].
    pub(crate) ids: Vec<u32>,
    /// Hexes of the plan still to lay, in its order.
    rest: Vec<u32>,
}

impl Underway {
    /// Whether all its hexes are laid.
    pub(crate) fn is_over(&self) -> bool {
        self.rest.is_empty()
    }
}

impl Laying {
    /// Nothing laid yet.
    pub(crate) fn new(open: OpenMesh) -> Self {
        Self { open, pillows: 0, since: 0 }
    }

    /// A plan for the void as it is; `None` if its front is no proper sphere, or no hex was found.
    pub(crate) fn planned(&self, number: u64, ctx: &Context<'_>) -> Option<Underway> {
        let (surface, vertices) = QuadSurface::on_own_vertices(self.open.front.clone()).ok()?;
        let plan = surface.is_sphere().then(|| Plan::new(&surface, number, ctx)).flatten()?;
        let mut ids: Vec<u32> = vertices.into_iter().map(|v| v.0).collect();
        ids.resize(plan.n_vertices, NOT_YET);
        Some(Underway { rest: (0..plan.hexes.len() as u32).collect(), plan, ids })
    }

    /// Lays one hex of the plan where it is valid: those that cover many quads first and, if `any`, others in the order of the plan. False if none was.
    pub(crate) fn lay_one(&mut self, underway: &mut Underway, any: bool, ctx: &Context<'_>) -> bool {
        let candidates = self.candidates(underway, any);
        let wider = || candidates.iter().take(TRIED_WIDER);
        // All of them cheaply first; only where none finds room is more of the surroundings set free, which costs
        // several times as much.
        let tries = candidates.iter().map(|c| (c, 1)).chain(wider().map(|c| (c, 2))).chain(wider().map(|c| (c, 3)));
        for (&(hex, covered), rings) in tries {
            if ctx.stop().is_some() {
                return false;
            }
            // A copy and no undo: a patch is small beside the untangling that follows.
            let mut trial = self.clone();
            let mut ids = underway.ids.clone();
            trial.add(&underway.plan.hexes[hex as usize], covered, &mut ids);
            if trial.finds_room(rings, ctx) {
                *self = trial;
                underway.ids = ids;
                underway.rest.retain(|&h| h != hex);
                self.round_now_and_then(ctx);
                return true;
            }
        }
        false
    }

    /// The hexes of the plan that could be laid now, with the facets that lie on the front.
    fn candidates(&self, underway: &Underway, any: bool) -> Vec<(u32, u8)> {
        let sets = VoidFront::new(&self.open.front);
        let laid = |h: u32| underway.plan.hexes[h as usize].map(|v| underway.ids[v as usize]);
        let legal = underway.rest.iter().filter_map(|&h| sets.covered_by(&laid(h)).map(|covered| (h, covered)));
        let (mut many, few): (Vec<_>, Vec<_>) = legal.partition(|(_, covered)| covered.count_ones() >= MANY);
        // Stable: in the order of the plan among equals.
        many.sort_by_key(|(_, covered)| std::cmp::Reverse(covered.count_ones()));
        // Hexes that cover one or two quads make the front longer. They are laid when nothing else is left, and one
        // at a time.
        if any || many.is_empty() {
            many.extend(few.first());
        }
        many
    }

    /// Adds a hex of a plan, its new vertices near those it has.
    fn add(&mut self, hex: &[u32; 8], covered: u8, ids: &mut [u32]) {
        let mut laid = hex.map(|v| ids[v as usize]);
        for corner in 0..8 {
            if laid[corner] != NOT_YET {
                continue;
            }
            let at = |k: usize| (laid[k] != NOT_YET).then(|| self.open.points[laid[k] as usize]);
            let mut near: Vec<Vector> = CORNER_NEIGHBOURS[corner].iter().filter_map(|&k| at(k)).collect();
            // All three neighbours are new as well; they come later in this loop.
            if near.is_empty() {
                near = (0..8).filter_map(at).collect();
            }
            let n = near.len() as f64;
            let mean: Vector = std::array::from_fn(|axis| near.iter().map(|p| p[axis]).sum::<f64>() / n);
            laid[corner] = self.open.points.len() as u32;
            ids[hex[corner] as usize] = laid[corner];
            self.open.points.push(towards(mean, self.open.apex, INWARD));
        }
        self.open.front = advanced(&self.open.front, &laid, covered);
        self.open.hexes.push(laid);
        self.open.steps.push(Step::Laid);
    }

    /// Untangles round the last hex, with so many rings free. Whether that made everything valid.
    fn finds_room(&mut self, rings: usize, ctx: &Context<'_>) -> bool {
        let free = self.near_last(1, rings);
        let effort = if rings == 1 { ONE_RING } else { MORE_RINGS };
        self.untangle(&free, effort, ctx) == [0, 0]
    }

    /// Puts a pillow behind the front and follows it with the plan. It is valid, as the pyramids are, unless a cell with positive corners is
    /// not: then the pillow with fewest such cells is taken, and later hexes mend it.
    pub(crate) fn pillow(&mut self, ids: &mut [u32], ctx: &Context<'_>) {
        let mut best: Option<([usize; 2], Self, FxHashMap<u32, u32>)> = None;
        // Valid in theory at any height, since the front is star-shaped seen from the apex; in floating point and
        // with cells judged as a whole some heights are better.
        for height in HEIGHTS {
            let mut trial = self.clone();
            let copies = trial.put_pillow(height);
            let free = trial.open.inner();
            let bad = trial.untangle(&free, JUDGE, ctx);
            if best.as_ref().is_none_or(|(least, ..)| bad < *least) {
                best = Some((bad, trial, copies));
            }
            if bad == [0, 0] {
                break;
            }
        }
        let Some((bad, pillowed, copies)) = best else { return };
        *self = pillowed;
        let free = self.open.inner();
        for _ in 0..ROUNDINGS {
            let before = self.open.points.clone();
            if self.untangle(&free, ROUND_PILLOW, ctx) > bad {
                self.open.points = before;
                break;
            }
        }
        for id in ids {
            *id = copies.get(id).copied().unwrap_or(*id);
        }
    }

    /// One hex behind every quad of the front, its inner side by a share of the way further in. Returns the copies of the vertices.
    fn put_pillow(&mut self, height: f64) -> FxHashMap<u32, u32> {
        let mut copies: FxHashMap<u32, u32> = FxHashMap::default();
        for quad in &mut self.open.front {
            let outer = *quad;
            *quad = outer.map(|v| {
                *copies.entry(v).or_insert_with(|| {
                    self.open.points.push(towards(self.open.points[v as usize], self.open.apex, height));
                    self.open.points.len() as u32 - 1
                })
            });
            let [a, b, c, d] = *quad;
            self.open.hexes.push([a, b, c, d, outer[0], outer[1], outer[2], outer[3]]);
            self.open.steps.push(Step::Between);
        }
        self.pillows += 1;
        self.since = 0;
        copies
    }

    /// Rounds what is laid after some hexes, unless that makes a cell bad.
    fn round_now_and_then(&mut self, ctx: &Context<'_>) {
        self.since += 1;
        if !self.since.is_multiple_of(ROUNDED) || self.open.front.is_empty() {
            return;
        }
        let before = self.open.points.clone();
        let is_large = self.open.hexes.len() > ALL_ROUNDED;
        let free = if is_large { self.near_last(ROUNDED, ROUNDED_RINGS) } else { self.open.inner() };
        if self.untangle(&free, ROUND_ALL, ctx) != [0, 0] {
            self.open.points = before;
        }
    }

    fn untangle(&mut self, free: &[bool], effort: OpenEffort, ctx: &Context<'_>) -> [usize; 2] {
        self.open.untangle(free, effort, &Context { progress: None, ..*ctx })
    }

    /// The vertices within so many rings of cells round the last `count` hexes, but for those of the surface.
    fn near_last(&self, count: usize, rings: usize) -> Vec<bool> {
        let mut near = vec![false; self.open.points.len()];
        self.open.hexes.iter().rev().take(count).flatten().for_each(|&v| near[v as usize] = true);
        for _ in 0..rings {
            let before = near.clone();
            // The front's quads are cells too: the pyramids over them have to stay valid.
            let cells = self
                .open
                .hexes
                .iter()
                .map(<[u32; 8]>::as_slice)
                .chain(self.open.front.iter().map(<[u32; 4]>::as_slice));
            for cell in cells.filter(|cell| cell.iter().any(|&v| before[v as usize])) {
                cell.iter().for_each(|&v| near[v as usize] = true);
            }
        }
        near[..self.open.n_fixed].fill(false);
        near
    }
}

/// The point by this share of the way from `p` to `q`.
fn towards(p: Vector, q: Vector, share: f64) -> Vector {
    std::array::from_fn(|axis| p[axis] + share * (q[axis] - p[axis]))
}
