//! New points in the middles of edges and faces, as cuts of faces want them.
//!
//! Source: ours.

use crate::soup::Soup;
use std::collections::BTreeMap;

/// A surface whose faces are being cut: the old points, and new ones behind them.
pub(crate) struct Cutter<'a> {
    old: &'a Soup,
    /// Its points so far; the caller adds the faces.
    pub(crate) new: Soup,
    next: u32,
    /// By its ends in ascending order: the point in the middle of an edge.
    middles: BTreeMap<[u32; 2], u32>,
}

impl<'a> Cutter<'a> {
    pub(crate) fn new(old: &'a Soup) -> Self {
        let new = Soup { points: old.points.clone(), faces: Vec::new() };
        Self { old, new, next: old.n_points() as u32, middles: BTreeMap::new() }
    }

    /// A new point in the middle of others.
    pub(crate) fn middle(&mut self, around: &[u32]) -> u32 {
        if !self.old.points.is_empty() {
            let share = 1.0 / around.len() as f64;
            let mean = |k: usize| around.iter().map(|&v| share * self.old.points[v as usize][k]).sum();
            self.new.points.push([mean(0), mean(1), mean(2)]);
        }
        self.next += 1;
        self.next - 1
    }

    /// The point in the middle of an edge, the same from both sides.
    pub(crate) fn middle_of_edge(&mut self, a: u32, b: u32) -> u32 {
        let ends = [a.min(b), a.max(b)];
        if let Some(&known) = self.middles.get(&ends) {
            return known;
        }
        let middle = self.middle(&ends);
        self.middles.insert(ends, middle);
        middle
    }

    /// The point in the middle of an edge, if it has one.
    pub(crate) fn known_middle(&self, a: u32, b: u32) -> Option<u32> {
        self.middles.get(&[a.min(b), a.max(b)]).copied()
    }
}
