//! Betti numbers over GF(2) by discrete Morse reduction (Forman 1998; Benedetti and Lutz 2014), in linear time but for a
//! small matrix at the end.
//!
//! 1. The dual graph with one node more for the outside: a spanning forest of it pairs every hex but one in each closed part
//!    with a quad. What is left is a 2-complex K with the same H1 (3-cells were taken out through free quads, and removing
//!    an open 3-cell does not change H1).
//! 2. K is collapsed through free edges. Where no edge is free, a quad is taken out and noted as critical.
//! 3. What is left is a graph; the edges outside a spanning forest are critical.
//! 4. The boundary of each critical quad is pushed down along the collapses to the critical edges. With r the rank of that
//!    matrix: b1 = c1 - r, b2 = c2 - r, b3 = number of closed parts, b0 = number of trees.
//!
//! If one vertex is the only critical cell, the mesh collapses to a point; a manifold that does is a ball (Whitehead).
//!
//! Source: Forman 1998 (discrete Morse theory), Benedetti and Lutz 2014 (that simple choices of what to collapse nearly always do); Whitehead 1939 (a manifold that
//! collapses is a ball).

use super::cells::{CHUNK, Edges, quads_of_task};
use super::star::corner_table;
use super::stars::Stars;
use crate::parallel::{piece, tasks};
use hexfill_mesh::Context;

/// Tasks listed between two steps of the sequential union-find.
const BATCH: usize = 64;
/// Most edge visits the matrix may cost before the answer is "not computed".
const MATRIX_WORK: u64 = 5_000_000_000;

/// What the reduction found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Homology {
    pub(crate) betti: [u64; 4],
    /// Critical cells by dimension.
    pub(crate) critical: [u64; 4],
}

/// Sequential union-find.
struct Forest(Vec<u32>);

impl Forest {
    fn new(n: usize) -> Self {
        Self((0..n as u32).collect())
    }

    fn root(&mut self, mut i: u32) -> u32 {
        while self.0[i as usize] != i {
            let up = self.0[self.0[i as usize] as usize];
            self.0[i as usize] = up;
            i = up;
        }
        i
    }

    fn join(&mut self, a: u32, b: u32) -> bool {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b) as usize] = a.min(b);
        a != b
    }
}

/// State of a quad of K: the side through which it was collapsed (0..4), or one of these.
const CRITICAL: u8 = 4;
const PRESENT: u8 = 5;

/// The homology of a mesh in which every quad is in at most two hexes; `closed` is its number of parts without boundary.
/// `None` if it was stopped or the matrix is too large.
pub(crate) fn homology(hexes: &[[u32; 8]], stars: &Stars, closed: u64, ctx: &Context<'_>) -> Option<Homology> {
    let edges = Edges::new(hexes, stars)?;
    let quads = spine(hexes, stars, &edges, ctx)?;
    let mut collapse = Collapse::new(&quads, edges.len());
    collapse.run(&quads, ctx)?;
    // The graph that is left.
    let mut forest = Forest::new(stars.len());
    let mut critical_edges = Vec::new();
    let mut vertices = (0..stars.len() as u32).filter(|&v| !stars.of(v).is_empty()).count() as u64;
    for (e, a, b) in edges.iter() {
        if !collapse.gone[e as usize] {
            if forest.join(a, b) {
                vertices -= 1;
            } else {
                critical_edges.push(e);
            }
        }
    }
    let critical = [vertices, critical_edges.len() as u64, collapse.critical.len() as u64, closed];
    let rank = collapse.rank(&quads, &critical_edges, ctx)?;
    Some(Homology { betti: [critical[0], critical[1] - rank, critical[2] - rank, closed], critical })
}

/// The quads outside a spanning forest of the dual graph, each as its four edges.
fn spine(hexes: &[[u32; 8]], stars: &Stars, edges: &Edges, ctx: &Context<'_>) -> Option<Vec<[u32; 4]>> {
    let table = corner_table();
    let n_tasks = stars.len().div_ceil(CHUNK);
    let outside = hexes.len() as u32;
    let mut dual = Forest::new(hexes.len() + 1);
    let mut kept = Vec::new();
    for first in (0..n_tasks).step_by(BATCH) {
        if ctx.stop().is_some() {
            return None;
        }
        let last = (first + BATCH).min(n_tasks);
        // Listed in parallel, joined in order: which quads are in the forest must not depend on threads.
        let lists = tasks(last - first, |i| quads_of_task(first + i, hexes, stars, &table));
        let left: Vec<[u32; 4]> = lists
            .into_iter()
            .flatten()
            .filter(|quad| {
                let [one, two] = quad.hexes;
                // A quad of the forest is the free face through which one of its hexes is collapsed; the other quads
                // stay.
                !dual.join(one.unwrap_or(outside), two.unwrap_or(outside))
            })
            .map(|quad| quad.cycle)
            .collect();
        let indexed = tasks(left.len().div_ceil(CHUNK), |i| {
            let sides =
                |&[a, b, c, d]: &[u32; 4]| [edges.index(a, b), edges.index(b, c), edges.index(c, d), edges.index(d, a)];
            piece(&left, CHUNK, i).iter().map(sides).collect::<Vec<_>>()
        });
        indexed.into_iter().for_each(|part| kept.extend(part));
    }
    Some(kept)
}

struct Collapse {
    /// Quads of K still present at each edge.
    count: Vec<u32>,
    /// Exclusive or of their indices: with one left, its index.
    mix: Vec<u32>,
    /// Edges collapsed away.
    gone: Vec<bool>,
    state: Vec<u8>,
    /// Quads in the order of their collapse.
    order: Vec<u32>,
    critical: Vec<u32>,
}

impl Collapse {
    fn new(quads: &[[u32; 4]], n_edges: usize) -> Self {
        let mut count = vec![0u32; n_edges];
        let mut mix = vec![0u32; n_edges];
        for (q, quad) in quads.iter().enumerate() {
            for &e in quad {
                count[e as usize] += 1;
                // No list of quads an edge: a free edge has one quad left, and then the exclusive or of those there
                // were is its index.
                mix[e as usize] ^= q as u32;
            }
        }
        let state = vec![PRESENT; quads.len()];
        Self { count, mix, gone: vec![false; n_edges], state, order: Vec::new(), critical: Vec::new() }
    }

    fn run(&mut self, quads: &[[u32; 4]], ctx: &Context<'_>) -> Option<()> {
        let mut free: Vec<u32> = (0..self.count.len() as u32).filter(|&e| self.count[e as usize] == 1).collect();
        let mut cursor = 0;
        loop {
            while let Some(e) = free.pop() {
                if self.count[e as usize] != 1 {
                    continue;
                }
                let q = self.mix[e as usize];
                let side = quads[q as usize].iter().position(|&f| f == e)?;
                self.state[q as usize] = side as u8;
                self.gone[e as usize] = true;
                self.order.push(q);
                self.take_out(q, quads, &mut free);
            }
            while cursor < quads.len() && self.state[cursor] != PRESENT {
                cursor += 1;
            }
            if cursor == quads.len() {
                return Some(());
            }
            if ctx.stop().is_some() {
                return None;
            }
            // Which quad is taken is free: the Betti numbers do not depend on it, only the size of the matrix does.
            self.state[cursor] = CRITICAL;
            self.critical.push(cursor as u32);
            self.take_out(cursor as u32, quads, &mut free);
        }
    }

    fn take_out(&mut self, q: u32, quads: &[[u32; 4]], free: &mut Vec<u32>) {
        for &e in &quads[q as usize] {
            self.count[e as usize] -= 1;
            self.mix[e as usize] ^= q;
            if self.count[e as usize] == 1 {
                free.push(e);
            }
        }
    }

    /// The rank over GF(2) of critical quads -> critical edges, 64 edges at a time.
    fn rank(&self, quads: &[[u32; 4]], critical_edges: &[u32], ctx: &Context<'_>) -> Option<u64> {
        if self.critical.is_empty() || critical_edges.is_empty() {
            return Some(0);
        }
        let words = critical_edges.len().div_ceil(64);
        // Known before the work: "not computed" is an answer, hours are none.
        if words as u64 * (4 * self.order.len() + self.gone.len()) as u64 > MATRIX_WORK
            || words * self.critical.len() * self.critical.len() > MATRIX_WORK as usize
        {
            return None;
        }
        let mut rows = vec![vec![0u64; words]; self.critical.len()];
        let mut image = vec![0u64; self.gone.len()];
        for (word, columns) in critical_edges.chunks(64).enumerate() {
            if ctx.stop().is_some() {
                return None;
            }
            // What each edge amounts to in critical ones, 64 of them at once as bits of one word.
            image.fill(0);
            for (bit, &e) in columns.iter().enumerate() {
                image[e as usize] = 1 << bit;
            }
            // An edge is homotopic to the other three of the quad it was collapsed with; those were there longer.
            for &q in self.order.iter().rev() {
                let quad = &quads[q as usize];
                let e = quad[self.state[q as usize] as usize] as usize;
                // Its own entry is on the right side as well: zero first, or it would be added to itself.
                image[e] = 0;
                image[e] = quad.iter().fold(0, |sum, &f| sum ^ image[f as usize]);
            }
            for (row, &q) in rows.iter_mut().zip(&self.critical) {
                row[word] = quads[q as usize].iter().fold(0, |sum, &f| sum ^ image[f as usize]);
            }
        }
        Some(rank(rows))
    }
}

/// The rank over GF(2) of rows of bits.
fn rank(mut rows: Vec<Vec<u64>>) -> u64 {
    let mut rank = 0;
    let words = rows.first().map_or(0, Vec::len);
    for bit in 0..64 * words {
        let (word, mask) = (bit / 64, 1u64 << (bit % 64));
        let Some(pivot) = (rank..rows.len()).find(|&r| rows[r][word] & mask != 0) else { continue };
        rows.swap(rank, pivot);
        let (head, tail) = rows.split_at_mut(rank + 1);
        let pivot = &head[rank];
        for row in tail.iter_mut().filter(|row| row[word] & mask != 0) {
            row.iter_mut().zip(pivot).for_each(|(a, b)| *a ^= b);
        }
        rank += 1;
    }
    rank as u64
}
