//! [`Problem`]: hexes with their free and fixed vertices, and the incidence the solvers walk.
//!
//! Invariant: `slot[v]` is the variable of a free vertex and [`FIXED`] otherwise; `corners` lists, for each
//! variable, the places `8 * hex + corner` where its vertex occurs, ascending. Sums over a vertex are taken in
//! that order, whatever the number of threads, so results are the same to the last bit.
//!
//! Source: ours.

use super::symmetric_variables::{Orbit, Symmetry};
use crate::solvers::long_vectors::{PARALLEL, fill};
use hexfill_geometry::{Vector, norm, sub};
use hexfill_mesh::cube::CORNER_NEIGHBOURS;
use rayon::prelude::*;

/// Marks a fixed vertex.
pub(crate) const FIXED: u32 = u32::MAX;

/// Hexes and variables. See the module page.
#[derive(Clone, Debug)]
pub(crate) struct Problem {
    pub(crate) hexes: Vec<[u32; 8]>,
    pub(crate) n_vertices: usize,
    /// Per vertex: its variable, or [`FIXED`].
    pub(crate) slot: Vec<u32>,
    /// Per variable: its vertex.
    pub(crate) free: Vec<u32>,
    corner_start: Vec<u32>,
    corners: Vec<u32>,
    /// If set, the variables are those of the symmetric positions.
    pub(crate) symmetry: Option<Symmetry>,
    /// Cells from this one on are pyramids over what is still open: a bottom facet and, four times, the apex.
    pub(crate) first_pyramid: usize,
}

impl Problem {
    /// The problem in which the vertices marked in `fixed`, and those no hex uses, do not move.
    pub(crate) fn new(n_vertices: usize, hexes: Vec<[u32; 8]>, fixed: &[bool]) -> Self {
        let mut used = vec![false; n_vertices];
        for &v in hexes.iter().flatten() {
            used[v as usize] = true;
        }
        let free: Vec<u32> = (0..n_vertices as u32).filter(|&v| used[v as usize] && !fixed[v as usize]).collect();
        let mut slot = vec![FIXED; n_vertices];
        for (s, &v) in free.iter().enumerate() {
            slot[v as usize] = s as u32;
        }
        let mut corner_start = vec![0u32; free.len() + 1];
        let slots = || hexes.iter().flatten().map(|&v| slot[v as usize]);
        for s in slots().filter(|&s| s != FIXED) {
            corner_start[s as usize + 1] += 1;
        }
        for s in 0..free.len() {
            corner_start[s + 1] += corner_start[s];
        }
        let mut cursor = corner_start.clone();
        let mut corners = vec![0u32; corner_start[free.len()] as usize];
        for (place, s) in slots().enumerate().filter(|&(_, s)| s != FIXED) {
            corners[cursor[s as usize] as usize] = place as u32;
            cursor[s as usize] += 1;
        }
        let first_pyramid = hexes.len();
        Self { hexes, n_vertices, slot, free, corner_start, corners, symmetry: None, first_pyramid }
    }

    /// Whether a cell is a pyramid over what is open.
    #[inline]
    pub(crate) fn is_pyramid(&self, cell: usize) -> bool {
        cell >= self.first_pyramid
    }

    /// The corners of a hex.
    #[inline]
    pub(crate) fn corners_of(&self, hex: usize, points: &[Vector]) -> [Vector; 8] {
        self.hexes[hex].map(|v| points[v as usize])
    }

    /// The shortest edge at any corner that the variable `s` has.
    pub(crate) fn shortest_edge_at(&self, s: usize, points: &[Vector]) -> f64 {
        let mut shortest = f64::INFINITY;
        for &place in self.places(s) {
            let hex = &self.hexes[place as usize / 8];
            let corner = place as usize % 8;
            for n in CORNER_NEIGHBOURS[corner] {
                shortest = shortest.min(norm(sub(points[hex[n] as usize], points[hex[corner] as usize])));
            }
        }
        shortest
    }

    /// The places `8 * hex + corner` of a variable's vertex, ascending.
    #[inline]
    pub(crate) fn places(&self, variable: usize) -> &[u32] {
        &self.corners[self.corner_start[variable] as usize..self.corner_start[variable + 1] as usize]
    }

    /// How many numbers the variables are.
    pub(crate) fn n_variables(&self) -> usize {
        self.symmetry.as_ref().map_or(3 * self.free.len(), |s| s.n_variables)
    }

    /// Writes variables (three numbers a free vertex, or those of the symmetric positions) into `points`.
    pub(crate) fn scatter(&self, x: &[f64], points: &mut [Vector]) {
        if let Some(symmetry) = &self.symmetry {
            return symmetry.scatter(&self.free, x, points);
        }
        for (x, &v) in x.chunks_exact(3).zip(&self.free) {
            points[v as usize].copy_from_slice(x);
        }
    }

    /// The variables of `points`.
    pub(crate) fn gather(&self, points: &[Vector]) -> Vec<f64> {
        if let Some(symmetry) = &self.symmetry {
            return symmetry.gather(&self.free, points);
        }
        self.free.iter().flat_map(|&v| points[v as usize]).collect()
    }

    /// One number a free vertex, as one a variable.
    pub(crate) fn by_variable(&self, by_slot: impl Fn(usize) -> f64) -> Vec<f64> {
        match &self.symmetry {
            None => (0..self.free.len()).flat_map(|s| [by_slot(s); 3]).collect(),
            Some(symmetry) => {
                let one = |o: &Orbit| {
                    let least = Symmetry::slots(o).map(&by_slot).fold(f64::INFINITY, f64::min);
                    vec![least; o.n_variables()]
                };
                symmetry.orbits.iter().flat_map(one).collect()
            }
        }
    }

    /// `out[h] = f(h)` for all hexes.
    pub(crate) fn map_hexes<T: Send>(&self, out: &mut [T], f: impl Fn(usize) -> T + Sync) {
        fill(out, f);
    }

    /// `f(first, block)` for blocks of hexes in turn, spread over threads where there are many.
    pub(crate) fn map_blocks<T: Send>(&self, out: &mut [T], f: impl Fn(usize, &mut [T]) + Sync) {
        const BLOCK: usize = 256;
        if out.len() >= PARALLEL {
            out.par_chunks_mut(BLOCK).enumerate().for_each(|(n, block)| f(BLOCK * n, block));
        } else {
            f(0, out);
        }
    }

    /// Sums the gradients in `per_hex` by variable into `out`.
    pub(crate) fn sum_at_variables(&self, per_hex: &[(f64, [Vector; 8])], out: &mut [f64]) {
        if let Some(symmetry) = &self.symmetry {
            let mut at_slots = vec![0.0; 3 * self.free.len()];
            self.sum_at_slots(per_hex, &mut at_slots);
            return symmetry.pull_back(&at_slots, out);
        }
        self.sum_at_slots(per_hex, out);
    }

    fn sum_at_slots(&self, per_hex: &[(f64, [Vector; 8])], out: &mut [f64]) {
        let one = |s: usize, out: &mut [f64]| {
            let mut sum = [0.0; 3];
            for &place in self.places(s) {
                let row = per_hex[place as usize / 8].1[place as usize % 8];
                for k in 0..3 {
                    sum[k] += row[k];
                }
            }
            out.copy_from_slice(&sum);
        };
        if self.free.len() >= PARALLEL {
            out.par_chunks_exact_mut(3).with_min_len(512).enumerate().for_each(|(s, out)| one(s, out));
        } else {
            out.chunks_exact_mut(3).enumerate().for_each(|(s, out)| one(s, out));
        }
    }
}
