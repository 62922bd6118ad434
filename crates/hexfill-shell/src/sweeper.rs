//! [`Sweeper`]: lenses in a heap, smallest first, each emptied in one transaction.
//!
//! A lens with k vertices inside is emptied by k - 1 flips of triangles at its arcs, the last of which zips two quads away. All flips of a
//! lens are one transaction: it ends with fewer quads or is taken back, so the sweep ends after at most half as many lenses as there are quads.
//! On spheres whose chords are simple this closes the void (Chang, Erickson, "Untangling planar curves", 2017).
//!
//! The heap holds a lens for each corner. A change of the front can make new ones only at corners whose arcs run through a changed quad:
//! those are found by following the chords back. A lens that changed otherwise is noticed when its turn comes.
//!
//! Where wants are stated (see `zip`), a lens is first emptied by flips that cost next to nothing, and single such flips are made though they empty
//! no lens; only then come all others, smallest lens first, and in it the flip that costs least.
//!
//! Source: Chang, Erickson 2017, who untangle n crossings by O(n^(3/2)) moves (abstract); one transaction a lens and the heap are ours.

use crate::dart::{next, opposite};
use crate::front::{Front, Mark};
use crate::glue::Patch;
use crate::lens::{LensFinder, Stamps};
use crate::sweep_options::SweepOptions;
use hexfill_mesh::{Context, Random, StopReason};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Highest cost of a flip at each level; a lens that cannot be emptied at one level has another chance at the next.
const LEVELS: [f32; 2] = [0.3, f32::INFINITY];

/// A lens in the heap: level, size, noise, corner, and the corner's version when it was looked at.
type Entry = (u8, u32, u32, u32, u32);

/// The state of a sweep.
pub(crate) struct Sweeper<'a> {
    pub(crate) front: &'a mut Front,
    finder: LensFinder,
    heap: BinaryHeap<Reverse<Entry>>,
    /// Per dart: how often its corner was looked at; older entries of the heap are void.
    version: Vec<u32>,
    /// Darts whose corner was looked at in this round.
    looked: Stamps,
    /// Vertices of the lens that is being emptied.
    inside: Stamps,
    /// Lenses up to this size are known.
    limit: u32,
    largest: u32,
    /// Up to this size lenses are looked for before a lens has its chance at a higher level.
    wide: u32,
    /// Flips that empty no lens and may still be made.
    budget: u32,
    /// Slots of quads where one has still to be tried.
    to_try: Vec<u32>,
    is_to_try: Vec<bool>,
    /// Sum of the costs of all flips.
    pub(crate) cost: f64,
    random: Option<Random>,
}

impl<'a> Sweeper<'a> {
    pub(crate) fn new(front: &'a mut Front, options: &SweepOptions<'_>) -> Self {
        let n_darts = 4 * front.n_slots() as usize;
        let n_vertices = front.n_quads() as u32 + 2;
        let n_slots = front.n_slots();
        Self {
            front,
            finder: LensFinder::default(),
            heap: BinaryHeap::new(),
            version: vec![0; n_darts],
            looked: Stamps::default(),
            inside: Stamps::default(),
            limit: 0,
            budget: 8 * n_vertices,
            to_try: (0..n_slots).rev().collect(),
            is_to_try: vec![true; n_slots as usize],
            cost: 0.0,
            wide: options.largest_lens.unwrap_or(u32::MAX).min(n_vertices).min(4 + n_vertices.isqrt()),
            largest: options.largest_lens.unwrap_or(u32::MAX).min(n_vertices),
            random: (options.seed != 0).then(|| Random::new(options.seed)),
        }
    }

    pub(crate) fn run(&mut self, ctx: &Context<'_>) -> Option<StopReason> {
        self.front.commit();
        let total = self.front.n_quads() as u64;
        while self.front.n_quads() > 0 {
            if let Some(reason) = ctx.stop() {
                return Some(reason);
            }
            let level = self.heap.peek().map_or(1, |Reverse(entry)| entry.0);
            if level > 0 && self.front.has_wants() {
                // Larger lenses that cost little come before small ones that cost much, and so do single flips.
                if self.limit < self.wide {
                    self.widen();
                    continue;
                }
                if self.flip_anywhere() {
                    continue;
                }
            }
            let Some(Reverse((level, size, _, corner, version))) = self.heap.pop() else {
                if self.limit >= self.largest {
                    return None;
                }
                self.widen();
                continue;
            };
            let Some(lens) = self.current((level, size, 0, corner, version)) else { continue };
            let mark = self.front.mark();
            let most = if self.front.has_wants() { LEVELS[usize::from(level)] } else { f32::INFINITY };
            // A lens that one level cannot empty is no lost lens: with dearer flips, or after its neighbours changed,
            // it may go.
            if !self.empty(lens, most) {
                if most < f32::INFINITY {
                    self.push(level + 1, size, corner);
                }
            } else {
                self.changed(mark);
                let (left, hexes) = (self.front.n_quads() as u64, self.front.hexes().len());
                ctx.report("shelling", total - left, Some(total), || format!("{left} quads left, {hexes} hexes"));
            }
        }
        None
    }

    /// The inner vertices of an entry's lens. `None` if the entry is void, or the lens has another size now and waits for its turn again.
    fn current(&mut self, (level, size, _, corner, version): Entry) -> Option<Vec<u32>> {
        if self.version[corner as usize] != version || !self.front.is_quad(corner / 4) {
            return None;
        }
        let lens = self.finder.find(self.front, corner, self.limit as usize)?;
        // The heap is never cleaned: an entry that is out of date is recognised here, which costs one look instead of
        // a search through the heap.
        if lens.len() as u32 == size {
            return Some(lens.to_vec());
        }
        let size = lens.len() as u32;
        self.push(level, size, corner);
        None
    }

    /// Looks for lenses at what changed since `mark` and empties them, at any cost. Nothing is made final.
    pub(crate) fn settle(&mut self, mut mark: Mark) {
        self.look_near(mark);
        while let Some(Reverse(entry)) = self.heap.pop() {
            if let Some(lens) = self.current(entry) {
                mark = self.front.mark();
                if self.empty(lens, f32::INFINITY) {
                    self.look_near(mark);
                }
            }
        }
    }

    /// Looks for lenses of up to `limit` vertices only, from now on.
    pub(crate) fn narrow(&mut self, limit: u32) {
        self.limit = limit.min(self.largest);
        self.heap.clear();
    }

    /// Makes one flip that costs next to nothing, wherever it is, while the budget lasts: it is what the wants ask for, though it empties no lens.
    fn flip_anywhere(&mut self) -> bool {
        while let Some(q) = self.to_try.pop().filter(|_| self.budget > 0) {
            self.is_to_try[q as usize] = false;
            // Each corner of the quad, and the two strips through it.
            for i in 0..6 {
                if q >= self.front.n_slots() || !self.front.is_quad(q) {
                    break;
                }
                let mark = self.front.mark();
                let made = if i < 4 {
                    self.front.flip(self.front.origin(4 * q + i))
                } else {
                    self.front.glue_hex(4 * q + i - 4, Patch::Strip)
                };
                match made {
                    Ok(cost) if cost <= LEVELS[0] => {
                        self.budget -= 1;
                        self.cost += f64::from(cost);
                        self.changed(mark);
                        return true;
                    }
                    Ok(_) => self.front.take_back(mark),
                    Err(_) => {}
                }
            }
        }
        false
    }

    /// Looks at what changed since `mark` and makes it final.
    fn changed(&mut self, mark: Mark) {
        self.look_near(mark);
        if self.front.has_wants() {
            self.is_to_try.resize(self.front.n_slots() as usize, false);
            let changed = self.front.changed_slots(mark).into_iter().filter(|&q| self.front.is_quad(q));
            // All quads at their corners: a flip depends on what is wanted at its rim.
            let vertices = changed.flat_map(|q| self.front.quad(q));
            let near = vertices.flat_map(|v| self.front.round_vertex(self.front.dart_of(v)).map(|d| d / 4));
            let mut near: Vec<u32> = near.collect();
            near.sort_unstable();
            near.dedup();
            for q in near {
                if !std::mem::replace(&mut self.is_to_try[q as usize], true) {
                    self.to_try.push(q);
                }
            }
        }
        self.front.commit();
    }

    /// Empties a lens by flips at its arcs, none of which costs more than `most`. The front is unchanged if that does not end with fewer quads.
    fn empty(&mut self, mut lens: Vec<u32>, most: f32) -> bool {
        let n_quads = self.front.n_quads();
        let (mark, cost) = (self.front.mark(), self.cost);
        self.inside.clear(self.front.n_vertices() as usize + lens.len() + 1);
        lens.iter().for_each(|&v| self.inside.set(v, 0));
        while let Some(i) = self.flip_one(&lens, most) {
            // The potential of the whole sweep: quads fall with every transaction that is kept, so it ends.
            if self.front.n_quads() < n_quads {
                return true;
            }
            self.inside.unset(lens.swap_remove(i));
        }
        self.front.take_back(mark);
        self.cost = cost;
        false
    }

    /// Makes the flip of a triangle at an arc of the lens that costs least; its number in the lens.
    fn flip_one(&mut self, lens: &[u32], most: f32) -> Option<usize> {
        if !self.front.has_wants() {
            // Without wants the first triangle that goes is as good as any.
            return (0..lens.len()).find(|&i| self.is_at_arc(lens[i]) && self.front.flip(lens[i]).is_ok());
        }
        let mut best: Option<(f32, usize)> = None;
        for (i, &v) in lens.iter().enumerate() {
            if self.is_at_arc(v) {
                let mark = self.front.mark();
                if let Ok(cost) = self.front.flip(v) {
                    self.front.take_back(mark);
                    if cost <= most && best.is_none_or(|(least, _)| cost < least) {
                        best = Some((cost, i));
                    }
                }
            }
        }
        let (cost, i) = best?;
        self.cost += f64::from(cost);
        self.front.flip(lens[i]).ok().map(|_| i)
    }

    /// Whether a vertex inside the lens has degree 3 and a neighbour outside: its triangle lies at an arc.
    fn is_at_arc(&self, v: u32) -> bool {
        self.front.degree(v) == 3
            && self.front.round_vertex(self.front.dart_of(v)).any(|d| !self.inside.is_set(self.front.target(d)))
    }

    fn push(&mut self, level: u8, size: u32, corner: u32) {
        let noise = self.random.as_mut().map_or(0, |r| r.next_u64() as u32);
        self.heap.push(Reverse((level, size, noise, corner, self.version[corner as usize])));
    }

    /// Looks at one corner, once a round.
    fn look(&mut self, corner: u32) {
        if self.looked.is_set(corner) {
            return;
        }
        self.looked.set(corner, 0);
        self.version[corner as usize] += 1;
        if let Some(lens) = self.finder.find(self.front, corner, self.limit as usize) {
            let size = lens.len() as u32;
            self.push(0, size, corner);
        }
    }

    /// Looks for lenses of twice the size.
    fn widen(&mut self) {
        // Doubling: all looks together cost at most twice the last one.
        let most = if self.limit < self.wide { self.wide } else { self.largest };
        self.limit = (2 * self.limit).max(4).min(most);
        self.look_everywhere();
    }

    fn look_everywhere(&mut self) {
        self.looked.clear(self.version.len());
        for q in 0..self.front.n_slots() {
            if self.front.is_quad(q) {
                (4 * q..4 * q + 4).for_each(|d| self.look(d));
            }
        }
    }

    /// Looks at all corners whose arcs meet a quad that changed since `mark`.
    fn look_near(&mut self, mark: Mark) {
        self.version.resize(4 * self.front.n_slots() as usize, 0);
        self.looked.clear(self.version.len());
        for q in self.front.changed_slots(mark) {
            if !self.front.is_quad(q) {
                continue;
            }
            for d in 4 * q..4 * q + 4 {
                self.look(d);
                // Away from q across d; the arcs that come back this way leave each quad across the dart they entered by.
                let mut at = self.front.twin(d);
                for _ in 0..self.limit {
                    if at / 4 == q {
                        break;
                    }
                    self.look(at);
                    self.look(next(at));
                    at = self.front.twin(opposite(at));
                }
            }
        }
    }
}
