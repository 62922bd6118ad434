//! Patches: a few cells and their surroundings as a problem of their own.
//!
//! The free vertices of a patch are those of the cells within some rings of the seeds that are free in the whole; its
//! cells are all cells at a free vertex, so a patch sees everything its vertices can spoil. Patches that share a cell are
//! merged, hence can be solved at the same time and written back in any order with the same result.
//!
//! Source: ours.

use super::free_vertices::{FIXED, Problem};
use hexfill_geometry::Vector;

/// A part of a [`Problem`].
pub(crate) struct Patch {
    /// The part, with vertices renumbered ascending.
    pub(crate) problem: Problem,
    /// Per vertex of the part: the vertex of the whole.
    pub(crate) vertices: Vec<u32>,
}

impl Patch {
    /// The points of the part.
    pub(crate) fn points(&self, whole: &[Vector]) -> Vec<Vector> {
        self.of_vertices(whole)
    }

    /// What belongs to the vertices of the part.
    pub(crate) fn of_vertices<T: Copy>(&self, whole: &[T]) -> Vec<T> {
        self.vertices.iter().map(|&v| whole[v as usize]).collect()
    }

    /// Writes the free points of the part back.
    pub(crate) fn write_back(&self, part: &[Vector], whole: &mut [Vector]) {
        for &v in &self.problem.free {
            whole[self.vertices[v as usize] as usize] = part[v as usize];
        }
    }
}

/// Which hexes each vertex is in.
pub(crate) struct Incidence {
    start: Vec<u32>,
    hexes: Vec<u32>,
}

impl Incidence {
    /// Of the whole problem.
    pub(crate) fn new(problem: &Problem) -> Self {
        let mut start = vec![0u32; problem.n_vertices + 1];
        for &v in problem.hexes.iter().flatten() {
            start[v as usize + 1] += 1;
        }
        for v in 0..problem.n_vertices {
            start[v + 1] += start[v];
        }
        let mut cursor = start.clone();
        let mut hexes = vec![0u32; 8 * problem.hexes.len()];
        for (h, hex) in problem.hexes.iter().enumerate() {
            for &v in hex {
                hexes[cursor[v as usize] as usize] = h as u32;
                cursor[v as usize] += 1;
            }
        }
        Self { start, hexes }
    }

    fn at(&self, v: u32) -> &[u32] {
        &self.hexes[self.start[v as usize] as usize..self.start[v as usize + 1] as usize]
    }
}

/// The patches round `seeds` (hexes), grown by `rings` rings of cells; ordered by smallest hex.
pub(crate) fn patches(problem: &Problem, incidence: &Incidence, seeds: &[usize], rings: usize) -> Vec<Patch> {
    const OUT: u32 = u32::MAX;
    let mut inside = vec![false; problem.hexes.len()];
    let mut grown: Vec<u32> = seeds.iter().map(|&h| h as u32).collect();
    for &h in &grown {
        inside[h as usize] = true;
    }
    let mut front = grown.clone();
    for _ in 0..rings {
        let mut next = Vec::new();
        for &h in &front {
            for &v in &problem.hexes[h as usize] {
                for &other in incidence.at(v) {
                    if !std::mem::replace(&mut inside[other as usize], true) {
                        next.push(other);
                    }
                }
            }
        }
        grown.extend_from_slice(&next);
        front = next;
    }
    // Vertices of the grown cells move; cells that only touch one of them are in the patch too, as they may be
    // spoilt, with their other vertices held.
    let mut free = vec![false; problem.n_vertices];
    for &h in &grown {
        for &v in &problem.hexes[h as usize] {
            free[v as usize] = problem.slot[v as usize] != FIXED;
        }
    }
    // Cells at a free vertex, joined when they share one.
    let mut label = vec![OUT; problem.hexes.len()];
    let mut groups: Vec<Vec<u32>> = Vec::new();
    grown.sort_unstable();
    let mut stack = Vec::new();
    for &seed in &grown {
        if label[seed as usize] != OUT {
            continue;
        }
        let id = groups.len() as u32;
        label[seed as usize] = id;
        stack.push(seed);
        let mut members = Vec::new();
        while let Some(h) = stack.pop() {
            members.push(h);
            for &v in problem.hexes[h as usize].iter().filter(|&&v| free[v as usize]) {
                for &other in incidence.at(v) {
                    if label[other as usize] == OUT {
                        label[other as usize] = id;
                        stack.push(other);
                    }
                }
            }
        }
        members.sort_unstable();
        groups.push(members);
    }
    groups.into_iter().map(|hexes| part(problem, &hexes, &free)).collect()
}

fn part(problem: &Problem, hexes: &[u32], free: &[bool]) -> Patch {
    let mut vertices: Vec<u32> = hexes.iter().flat_map(|&h| problem.hexes[h as usize]).collect();
    vertices.sort_unstable();
    vertices.dedup();
    let local = |v: u32| vertices.binary_search(&v).expect("every vertex was collected") as u32;
    let cells = hexes.iter().map(|&h| problem.hexes[h as usize].map(local)).collect();
    let fixed: Vec<bool> = vertices.iter().map(|&v| !free[v as usize]).collect();
    Patch { problem: Problem::new(vertices.len(), cells, &fixed), vertices }
}
