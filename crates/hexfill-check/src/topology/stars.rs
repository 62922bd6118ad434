//! The star of every vertex: which hexes it is a corner of, by counting sort.
//!
//! Two passes over the hexes and one array of `8 * hexes` codes; no hash map. Every range of vertices is filled by one
//! thread that scans all hexes in order, so the arrays do not depend on the number of threads.
//!
//! Source: ours; counting sort.

use rayon::prelude::*;

/// For every vertex the codes `8 * hex + corner` of the hexes round it, ascending.
pub(crate) struct Stars {
    /// `offsets[v]..offsets[v + 1]` is the range of `v` in `codes`.
    offsets: Vec<u32>,
    codes: Vec<u32>,
}

/// Fewer hexes than this are sorted by the caller alone.
const SMALL: usize = 1 << 15;

/// Most hexes that can be judged: a code `8 * hex + corner` is a `u32`.
pub(crate) const MAX_HEXES: usize = (u32::MAX / 8) as usize;

impl Stars {
    /// The stars of vertices `0..n`; every index in `hexes` is below `n`, at most [`MAX_HEXES`] hexes.
    pub(crate) fn new(n: usize, hexes: &[[u32; 8]]) -> Self {
        let ranges = if hexes.len() < SMALL { 1 } else { rayon::current_num_threads().clamp(1, 8) };
        let step = n.div_ceil(ranges).max(1);
        let mut offsets = vec![0u32; n + 1];
        let count = |(r, counts): (usize, &mut [u32])| {
            let low = (r * step) as u32;
            for hex in hexes {
                for &v in hex {
                    // One comparison for both ends of the range: below `low` the difference wraps to a huge number.
                    if let Some(count) = counts.get_mut(v.wrapping_sub(low) as usize) {
                        *count += 1;
                    }
                }
            }
        };
        if ranges == 1 {
            count((0, &mut offsets[1..]));
        } else {
            offsets[1..].par_chunks_mut(step).enumerate().for_each(count);
        }
        // Starts from numbers, the counting sort's second step; the third fills every range from its own start.
        let mut sum = 0;
        for o in &mut offsets[1..] {
            sum += *o;
            *o = sum;
        }
        let mut codes = vec![0u32; 8 * hexes.len()];
        // Cut `codes` at the offsets of the range ends so that each thread owns its part.
        let mut parts = Vec::with_capacity(ranges);
        let mut rest = codes.as_mut_slice();
        for low in (0..n).step_by(step) {
            let high = (low + step).min(n);
            let (part, tail) = rest.split_at_mut((offsets[high] - offsets[low]) as usize);
            parts.push((low, high, part));
            rest = tail;
        }
        let fill = |(low, high, part): (usize, usize, &mut [u32])| {
            let base = offsets[low];
            let mut next: Vec<u32> = offsets[low..high].iter().map(|&o| o - base).collect();
            for (h, hex) in hexes.iter().enumerate() {
                for (corner, &v) in hex.iter().enumerate() {
                    if let Some(slot) = next.get_mut(v.wrapping_sub(low as u32) as usize) {
                        part[*slot as usize] = (8 * h + corner) as u32;
                        *slot += 1;
                    }
                }
            }
        };
        if ranges == 1 {
            parts.into_iter().for_each(fill);
        } else {
            parts.into_par_iter().for_each(fill);
        }
        Self { offsets, codes }
    }

    /// Number of vertices.
    pub(crate) fn len(&self) -> usize {
        self.offsets.len() - 1
    }

    /// Codes `8 * hex + corner` round vertex `v`, ascending.
    pub(crate) fn of(&self, v: u32) -> &[u32] {
        &self.codes[self.offsets[v as usize] as usize..self.offsets[v as usize + 1] as usize]
    }
}
