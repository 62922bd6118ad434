//! The changes of a front: each is written down with what was there before, so that the latest can be taken back.
//!
//! Source: ours; an undo log.

use super::{Front, NONE};
use crate::pairs::OldPair;
use smallvec::SmallVec;

/// One change, with what was there before.
#[derive(Clone, Copy, Debug)]
pub(super) enum Change {
    Origin(u32, u32),
    Twin(u32, u32),
    Degree(u32, u32),
    DartOf(u32, u32),
    Want(u32, f32),
    Quads(u32),
    Corner(u32, u8, u32),
    /// A hex was pushed.
    Hex,
    /// A vertex was pushed.
    Vertex,
    /// An empty slot was pushed.
    Slot,
    /// The star of a vertex grew; its length before.
    Star(u32, u32),
    Pair(OldPair),
}

/// A place in the journal to go back to.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub struct Mark(usize);

impl Front {
    /// Sets what is wanted round the edge of a dart.
    pub(crate) fn set_want(&mut self, d: u32, want: f32) {
        for d in [d, self.twin(d)] {
            self.journal.push(Change::Want(d, self.want[d as usize]));
            self.want[d as usize] = want;
        }
    }

    /// A place to come back to.
    pub fn mark(&self) -> Mark {
        Mark(self.journal.len())
    }

    /// Makes everything since the start final; older marks lose their meaning.
    pub fn commit(&mut self) {
        self.journal.clear();
    }

    pub(crate) fn set_origin(&mut self, d: u32, v: u32) {
        self.journal.push(Change::Origin(d, self.origin[d as usize]));
        self.origin[d as usize] = v;
    }

    /// Makes two darts twins.
    pub(crate) fn glue(&mut self, a: u32, b: u32) {
        for (d, t) in [(a, b), (b, a)] {
            self.journal.push(Change::Twin(d, self.twin[d as usize]));
            self.twin[d as usize] = t;
        }
    }

    pub(crate) fn set_degree(&mut self, v: u32, degree: u32) {
        self.journal.push(Change::Degree(v, self.degree[v as usize]));
        self.degree[v as usize] = degree;
    }

    pub(crate) fn set_dart_of(&mut self, v: u32, d: u32) {
        self.journal.push(Change::DartOf(v, self.dart_of[v as usize]));
        self.dart_of[v as usize] = d;
    }

    /// Empties the slot of a quad; degrees are the caller's task.
    pub(crate) fn remove_quad(&mut self, slot: u32) {
        self.journal.push(Change::Quads(self.n_quads));
        self.n_quads -= 1;
        for i in 0..4 {
            self.set_origin(4 * slot + i, NONE);
        }
    }

    /// Puts a quad into an empty slot, or a new one; its slot. Twins and degrees are the caller's task.
    pub(crate) fn put_quad(&mut self, slot: Option<u32>, quad: [u32; 4]) -> u32 {
        let slot = slot.unwrap_or_else(|| {
            self.journal.push(Change::Slot);
            self.origin.extend([NONE; 4]);
            self.twin.extend([NONE; 4]);
            if self.has_wants() {
                self.want.extend([0.0; 4]);
            }
            self.n_slots() - 1
        });
        self.journal.push(Change::Quads(self.n_quads));
        self.n_quads += 1;
        for (i, v) in quad.into_iter().enumerate() {
            self.set_origin(4 * slot + i as u32, v);
        }
        slot
    }

    /// A new interior vertex, not yet on the front.
    pub(crate) fn push_vertex(&mut self) -> u32 {
        self.journal.push(Change::Vertex);
        self.degree.push(0);
        self.dart_of.push(NONE);
        self.fixed.push(false);
        self.star.push(SmallVec::new());
        self.surface_neighbours.push(Vec::new());
        self.degree.len() as u32 - 1
    }

    /// Adds a hex to the list and the stars, not yet to the pair table.
    pub(crate) fn push_hex(&mut self, hex: [u32; 8]) -> u32 {
        let h = self.hexes.len() as u32;
        self.journal.push(Change::Hex);
        self.hexes.push(hex);
        for v in hex {
            self.push_star(v, h);
        }
        h
    }

    fn push_star(&mut self, v: u32, h: u32) {
        self.journal.push(Change::Star(v, self.star[v as usize].len() as u32));
        self.star[v as usize].push(h);
    }

    /// Renames vertex `from` to `to` in the hexes. The pair table is not told yet.
    pub(crate) fn rename(&mut self, from: u32, to: u32) {
        for i in 0..self.star[from as usize].len() {
            let h = self.star[from as usize][i];
            for corner in 0..8u8 {
                if self.hexes[h as usize][usize::from(corner)] == from {
                    self.journal.push(Change::Corner(h, corner, from));
                    self.hexes[h as usize][usize::from(corner)] = to;
                }
            }
            self.push_star(to, h);
        }
    }

    /// Puts the pairs of a hex into the table; `false` at a clash.
    pub(crate) fn add_pairs(&mut self, h: u32) -> bool {
        let (pairs, journal) = (&mut self.pairs, &mut self.journal);
        pairs.add_hex(&self.hexes[h as usize], |old| journal.push(Change::Pair(old)))
    }

    /// Tells the pair table that hexes (each with its corners as the table knows them) have others now; `false` at a clash.
    pub(crate) fn update_pairs(&mut self, renamed: &[(u32, [u32; 8])]) -> bool {
        let (pairs, journal, hexes) = (&mut self.pairs, &mut self.journal, &self.hexes);
        for (h, before) in renamed {
            pairs.remove_changed(before, &hexes[*h as usize], |old| journal.push(Change::Pair(old)));
        }
        renamed
            .iter()
            .all(|(h, before)| pairs.add_changed(before, &hexes[*h as usize], |old| journal.push(Change::Pair(old))))
    }

    /// The slots of quads that changed since `mark`, ascending; for those who keep something per quad.
    pub(crate) fn changed_slots(&self, mark: Mark) -> Vec<u32> {
        let mut slots: Vec<u32> = self.journal[mark.0..]
            .iter()
            .filter_map(|c| match *c {
                Change::Origin(d, _) | Change::Twin(d, _) => Some(d / 4),
                _ => None,
            })
            .collect();
        slots.sort_unstable();
        slots.dedup();
        slots
    }

    /// Takes everything since `mark` back, exactly.
    pub fn take_back(&mut self, mark: Mark) {
        while self.journal.len() > mark.0 {
            match self.journal.pop().expect("longer than the mark") {
                Change::Origin(d, v) => self.origin[d as usize] = v,
                Change::Twin(d, t) => self.twin[d as usize] = t,
                Change::Want(d, want) => self.want[d as usize] = want,
                Change::Degree(v, degree) => self.degree[v as usize] = degree,
                Change::DartOf(v, d) => self.dart_of[v as usize] = d,
                Change::Quads(n) => self.n_quads = n,
                Change::Corner(h, corner, v) => self.hexes[h as usize][usize::from(corner)] = v,
                Change::Slot => {
                    let n = self.origin.len() - 4;
                    self.origin.truncate(n);
                    self.twin.truncate(n);
                    self.want.truncate(n);
                }
                Change::Hex => {
                    self.hexes.pop();
                }
                Change::Vertex => {
                    self.degree.pop();
                    self.dart_of.pop();
                    self.fixed.pop();
                    self.star.pop();
                    self.surface_neighbours.pop();
                }
                Change::Star(v, length) => self.star[v as usize].truncate(length as usize),
                Change::Pair(old) => self.pairs.restore(old),
            }
        }
    }
}
