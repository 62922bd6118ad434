//! Random voxel solids: of genus 0, grown cell by cell, and with tunnels and cavities, dug into a block.

use crate::solid::Solid;
use hexfill_mesh::QuadSurface;
use hexfill_mesh::Random;
use std::collections::BTreeSet;

const DIRECTIONS: [[i32; 3]; 6] = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]];

type Cells = BTreeSet<[i32; 3]>;

/// The cells at their integer positions.
pub(crate) fn solid(cells: &Cells) -> Solid {
    Solid::voxels(&cells.iter().copied().collect::<Vec<_>>(), &|p| p)
}

/// The boundary, if it is a manifold and the cells hang together by their facets.
fn surface(cells: &Cells) -> Option<QuadSurface> {
    let mut reached = Cells::new();
    let mut todo: Vec<[i32; 3]> = cells.first().copied().into_iter().collect();
    while let Some(cell) = todo.pop() {
        if reached.insert(cell) {
            let near = DIRECTIONS.map(|d| [0, 1, 2].map(|k| cell[k] + d[k]));
            todo.extend(near.into_iter().filter(|c| cells.contains(c)));
        }
    }
    let solid = solid(cells);
    // Cells that touch along an edge or at a vertex only make an edge with four quads or a vertex with two fans.
    QuadSurface::try_new(solid.points.len(), &solid.boundary()).ok().filter(|_| reached.len() == cells.len())
}

/// A random solid of genus 0 with `n` cells: grown from one cell, only spheres on the way.
pub(crate) fn sphere(n: usize, seed: u64) -> Cells {
    let mut random = Random::new(seed);
    let mut cells = Cells::from([[0; 3]]);
    // Not every number can be reached from every shape: a bound on the tries keeps it finite.
    for _ in 0..40 * n {
        if cells.len() == n {
            break;
        }
        let cell = *cells.iter().nth(random.below(cells.len())).expect("the index is below the length");
        let step = DIRECTIONS[random.below(6)];
        let new = [0, 1, 2].map(|k| cell[k] + step[k]);
        if cells.insert(new) && !surface(&cells).is_some_and(|s| s.is_sphere()) {
            cells.remove(&new);
        }
    }
    cells
}

/// A block with straight tunnels (two may cross), cavities of one cell and random dents; manifold all the way, though a tunnel
/// or cavity may be cut open by a dent. Returns the genus and the number of boundary components as well.
pub(crate) fn with_holes(
    size: [i32; 3],
    tunnels: usize,
    cavities: usize,
    dents: usize,
    seed: u64,
) -> (Cells, u64, usize) {
    let mut random = Random::new(seed);
    let [x, y, z] = size;
    let mut cells: Cells = (0..x * y * z).map(|i| [i % x, i / x % y, i / x / y]).collect();
    // Takes out what it can of several offers of a kind.
    let mut dig = |wanted: usize, offer: &mut dyn FnMut(&mut Random, &Cells) -> Cells| {
        let mut dug = 0;
        for _ in 0..40 * wanted {
            let rest: Cells = &cells - &offer(&mut random, &cells);
            if dug < wanted && rest.len() < cells.len() && surface(&rest).is_some() {
                cells = rest;
                dug += 1;
            }
        }
    };
    let inner = |random: &mut Random| size.map(|n| 1 + random.below(n as usize - 2) as i32);
    dig(tunnels, &mut |random, cells| {
        let (through, axis) = (inner(random), random.below(3));
        cells.iter().copied().filter(|c| (0..3).all(|k| k == axis || c[k] == through[k])).collect()
    });
    dig(cavities, &mut |random, _| Cells::from([inner(random)]));
    dig(dents, &mut |random, cells| cells.iter().nth(random.below(cells.len())).copied().into_iter().collect());
    let surface = surface(&cells).expect("every step kept a manifold");
    (cells, surface.genus(), surface.n_components())
}
