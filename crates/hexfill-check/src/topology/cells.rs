//! Edges and quads as lists, star by star: what the homology needs and no more.
//!
//! Source: ours.

use super::star::corner_table;
use super::stars::Stars;
use crate::parallel::tasks;

/// Vertices listed as one task.
pub(crate) const CHUNK: usize = 1 << 12;

/// Every edge at its smaller end: `ends[offsets[v]..offsets[v + 1]]` are the larger ends at `v`, ascending.
pub(crate) struct Edges {
    offsets: Vec<u32>,
    ends: Vec<u32>,
}

impl Edges {
    /// `None` if there are too many for a `u32`.
    pub(crate) fn new(hexes: &[[u32; 8]], stars: &Stars) -> Option<Self> {
        let table = corner_table();
        let parts: Vec<(Vec<u32>, Vec<u32>)> = tasks(stars.len().div_ceil(CHUNK), |task| {
            let (mut counts, mut ends, mut near) = (Vec::new(), Vec::new(), Vec::new());
            for v in task * CHUNK..((task + 1) * CHUNK).min(stars.len()) {
                near.clear();
                for &code in stars.of(v as u32) {
                    let hex = &hexes[(code >> 3) as usize];
                    let corner = &table[(code & 7) as usize];
                    // An edge is listed at its smaller end, so every edge once and each list is sorted.
                    near.extend(corner[..3].iter().map(|&k| hex[k]).filter(|&w| w > v as u32));
                }
                near.sort_unstable();
                near.dedup();
                counts.push(near.len() as u32);
                ends.extend_from_slice(&near);
            }
            (counts, ends)
        });
        let total: usize = parts.iter().map(|p| p.1.len()).sum();
        if total >= u32::MAX as usize {
            return None;
        }
        let mut offsets = Vec::with_capacity(stars.len() + 1);
        let mut ends = Vec::with_capacity(total);
        let mut sum = 0;
        offsets.push(0);
        for (counts, part) in parts {
            offsets.extend(counts.iter().map(|c| {
                sum += c;
                sum
            }));
            ends.extend(part);
        }
        Some(Self { offsets, ends })
    }

    pub(crate) fn len(&self) -> usize {
        self.ends.len()
    }

    /// The index of edge `{a, b}`, which exists.
    pub(crate) fn index(&self, a: u32, b: u32) -> u32 {
        let (low, high) = (a.min(b), a.max(b));
        let first = self.offsets[low as usize];
        let near = &self.ends[first as usize..self.offsets[low as usize + 1] as usize];
        first + near.partition_point(|&w| w < high) as u32
    }

    /// Every edge: its index and its ends.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (u32, u32, u32)> + '_ {
        (0..self.offsets.len() - 1).flat_map(move |v| {
            (self.offsets[v]..self.offsets[v + 1]).map(move |e| (e, v as u32, self.ends[e as usize]))
        })
    }
}

/// A quad at its smallest vertex: the cycle, its first hex, and the second one if it has two.
#[derive(Clone, Copy)]
pub(crate) struct QuadCell {
    pub(crate) cycle: [u32; 4],
    pub(crate) hexes: [Option<u32>; 2],
}

/// The quads whose smallest vertex is in task `task`, in a fixed order. Every quad is in at most two hexes.
pub(crate) fn quads_of_task(task: usize, hexes: &[[u32; 8]], stars: &Stars, table: &[[usize; 7]; 8]) -> Vec<QuadCell> {
    let mut quads = Vec::new();
    let mut near: Vec<([u32; 3], u32)> = Vec::new();
    for v in task * CHUNK..((task + 1) * CHUNK).min(stars.len()) {
        let v = v as u32;
        near.clear();
        for &code in stars.of(v) {
            let hex = &hexes[(code >> 3) as usize];
            let corner = table[(code & 7) as usize].map(|k| hex[k]);
            for k in 0..3 {
                let (x, y, w) = (corner[(k + 1) % 3], corner[(k + 2) % 3], corner[3 + k]);
                if v < x && v < y && v < w {
                    // By the opposite corner first: that tells a quad at `v` apart in a proper mesh; the other two
                    // make it certain in any.
                    near.push(([w, x.min(y), x.max(y)], code >> 3));
                }
            }
        }
        near.sort_unstable();
        for same in near.chunk_by(|a, b| a.0 == b.0) {
            let [w, x, y] = same[0].0;
            quads.push(QuadCell { cycle: [v, x, w, y], hexes: [Some(same[0].1), same.get(1).map(|s| s.1)] });
        }
    }
    quads
}
