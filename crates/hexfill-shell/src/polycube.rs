//! Polycubes: the cells of the grid inside a surface that develops are its hexes.
//!
//! Idea: where all edges bend by right angles no sweep is needed, whatever the genus and however many cavities: the surface is unrolled into the
//! grid (`develop`), and the cells inside it are the one mesh that gives every edge the hexes it wants.
//!
//! Invariant: two cells share a facet unless a quad of the surface lies between them, and corners are one vertex iff shared facets join them. So
//! parts of a bent surface that only *touch* in the grid stay apart; a surface whose parts overlap there is refused.
//!
//! Source: ours, after Tarini et al. 2004.

use crate::classes::Classes;
use crate::develop::{Development, Site};
use crate::front::{Front, NONE};
use hexfill_mesh::QuadSurface;
use hexfill_mesh::cube::{FACETS, POSITIONS, corner_at};
use rustc_hash::FxHashMap;

/// More cells than this are not made.
const MOST_CELLS: usize = 4_000_000;

/// The cells with their facets on the surface.
struct Cells {
    /// By (z, y, x), lowest corners.
    sites: Vec<Site>,
    number: FxHashMap<Site, u32>,
    /// Per cell and facet: the quad of the surface on it, or [`NONE`].
    walls: Vec<[u32; 6]>,
}

/// The hexes of a surface that was developed, vertices of the surface first; `None` if it overlaps itself in the grid, or a vertex would have to
/// be at two places.
pub(crate) fn polycube(surface: &QuadSurface, development: &Development) -> Option<Vec<[u32; 8]>> {
    let hexes = Cells::of(surface, development)?.hexes(surface, development)?;
    let n_vertices = hexes.iter().flatten().max().map_or(0, |v| v + 1).max(surface.n_vertices() as u32);
    let quads: Vec<[u32; 4]> = surface.quads_raw();
    Front::try_from_parts(n_vertices, &quads, &hexes, &[]).ok()?;
    Some(hexes)
}

impl Cells {
    fn of(surface: &QuadSurface, development: &Development) -> Option<Self> {
        // Where a line along x goes in (after it went out, if both are at one place) and out.
        let mut crossings: Vec<(i32, i32, i32, bool)> = Vec::new();
        for (q, normal) in development.normal.iter().enumerate() {
            if normal[0] != 0 {
                let [x, y, z] = lowest(surface, development, q);
                crossings.push((z, y, x, normal[0] < 0));
            }
        }
        crossings.sort_unstable();
        let mut sites = Vec::new();
        for pair in crossings.chunks(2) {
            let &[(z, y, from, true), (z2, y2, to, false)] = pair else { return None };
            if (z, y) != (z2, y2) || sites.len() + (to - from) as usize > MOST_CELLS {
                return None;
            }
            sites.extend((from..to).map(|x| [x, y, z]));
        }
        let number: FxHashMap<Site, u32> = (0..).zip(&sites).map(|(i, &s)| (s, i)).collect();
        let mut walls = vec![[NONE; 6]; sites.len()];
        for (q, normal) in development.normal.iter().enumerate() {
            let axis = normal.iter().position(|&x| x != 0)?;
            let mut site = lowest(surface, development, q);
            site[axis] -= i32::from(normal[axis] > 0);
            let wall =
                &mut walls[*number.get(&development.rolled(site))? as usize][2 * axis + usize::from(normal[axis] > 0)];
            if std::mem::replace(wall, q as u32) != NONE {
                return None;
            }
        }
        Some(Self { sites, number, walls })
    }

    /// The cell across a facet that is not on the surface.
    fn beside(&self, development: &Development, cell: usize, facet: usize) -> Option<u32> {
        let mut site = self.sites[cell];
        site[facet / 2] += if facet.is_multiple_of(2) { -1 } else { 1 };
        self.number.get(&development.rolled(site)).copied()
    }

    fn hexes(&self, surface: &QuadSurface, development: &Development) -> Option<Vec<[u32; 8]>> {
        // Cells are joined through facets, never by where they lie: parts that only touch in the grid must not share
        // corners.
        let mut corners = Classes::new(8 * self.sites.len());
        for cell in 0..self.sites.len() {
            for facet in 0..6 {
                if self.walls[cell][facet] != NONE {
                    continue;
                }
                let other = self.beside(development, cell, facet)?;
                // A wall seen from one side only: the surface overlaps itself in the grid.
                if self.walls[other as usize][facet ^ 1] != NONE {
                    return None;
                }
                for k in FACETS[facet] {
                    let mut p = POSITIONS[k];
                    p[facet / 2] ^= 1;
                    corners.join(8 * cell as u32 + k as u32, 8 * other + corner_at(p[0], p[1], p[2]) as u32);
                }
            }
        }
        // Corners on the surface are its vertices: one each.
        let mut name = vec![NONE; 8 * self.sites.len()];
        let mut root_of = vec![NONE; surface.n_vertices()];
        for (cell, walls) in self.walls.iter().enumerate() {
            for &q in walls.iter().filter(|&&q| q != NONE) {
                for v in surface.quads()[q as usize] {
                    let p = development.rolled([0, 1, 2].map(|k| development.at[v.index()][k] - self.sites[cell][k]));
                    if p.iter().any(|&x| x != 0 && x != 1) {
                        return None;
                    }
                    let [x, y, z] = p.map(|x| x as u8);
                    let root = corners.root(8 * cell as u32 + corner_at(x, y, z) as u32);
                    let slot = &mut root_of[v.index()];
                    // One to one, both ways: a corner with two vertices, or a vertex at two corners, means that the
                    // parts touch or overlap.
                    if *slot == NONE && name[root as usize] == NONE {
                        (*slot, name[root as usize]) = (root, v.0);
                    }
                    if *slot != root || name[root as usize] != v.0 {
                        return None;
                    }
                }
            }
        }
        let mut n_vertices = surface.n_vertices() as u32;
        let mut vertex = |corner: u32| {
            let slot = &mut name[corners.root(corner) as usize];
            if *slot == NONE {
                *slot = n_vertices;
                n_vertices += 1;
            }
            *slot
        };
        Some((0..self.sites.len() as u32).map(|c| std::array::from_fn(|k| vertex(8 * c + k as u32))).collect())
    }
}

/// The lowest corner of a quad.
fn lowest(surface: &QuadSurface, development: &Development, q: usize) -> Site {
    let corners = surface.quads()[q].map(|v| development.at[v.index()]);
    let mut lowest = [0, 1, 2].map(|k| corners.iter().map(|c| c[k]).min().expect("four corners"));
    let highest = corners.iter().map(|c| c[2]).max().expect("four corners");
    // Over the seam of a grid that is rolled up, from the end to the beginning.
    if highest - lowest[2] > 1 {
        lowest[2] = highest;
    }
    lowest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::angles::wanted_hexes;
    use crate::develop::develop;
    use crate::sweep::Swept;
    use crate::test_surfaces::{judged, voxel_points};
    use hexfill_mesh::{Random, is_proper};
    use std::collections::BTreeSet;

    /// Fills voxels through their bent copy; the number of hexes.
    fn filled(size: [usize; 3], cells: &BTreeSet<[usize; 3]>, bend: f64) -> Option<usize> {
        let (surface, mut points) = voxel_points(size, |c| cells.contains(&c))?;
        if !is_proper(&surface) {
            return None;
        }
        for p in &mut points {
            let [x, y, z] = *p;
            *p = [x + bend * y * z, 2.0 * y - bend * x * z, z + bend * x];
        }
        let wanted = wanted_hexes(&surface, Some(&points));
        let hexes = polycube(&surface, &develop(&surface, &wanted, Some(&points)).unwrap()).unwrap();
        let n_vertices = hexes.iter().flatten().max().unwrap() + 1;
        let swept = Swept { n_vertices, hexes, plugs: 0, front: Vec::new(), stopped: None };
        Some(judged(&surface, &swept))
    }

    #[test]
    fn plates_with_tunnels_and_boxes_with_cavities() {
        let solid = |size: [usize; 3], empty: fn([usize; 3]) -> bool| {
            let all =
                (0..size[0] * size[1] * size[2]).map(|i| [i % size[0], i / size[0] % size[1], i / size[0] / size[1]]);
            let cells: BTreeSet<[usize; 3]> = all.filter(|&c| !empty(c)).collect();
            for bend in [0.0, 0.03] {
                assert_eq!(filled(size, &cells, bend), Some(cells.len()));
            }
        };
        solid([3, 3, 1], |[x, y, _]| x == 1 && y == 1);
        solid([9, 5, 2], |[x, y, _]| x % 2 == 1 && y % 2 == 1);
        solid([3, 3, 3], |c| c == [1; 3]);
        solid([7, 5, 5], |[x, y, z]| (y, z) == (2, 2) && (x == 1 || (3..6).contains(&x)));
        solid([7, 7, 5], |[x, y, z]| {
            z == 2
                && (1..6).contains(&x)
                && (1..6).contains(&y)
                && (x, y) != (3, 3)
                && !((2..5).contains(&x) && (2..5).contains(&y))
        });
    }

    /// A solid of revolution of `n` hexes round the axis, whose section is the filled cells of a grid (distance from the axis, height), and its hexes.
    fn ring(n: u32, cells: &[[u32; 2]]) -> (QuadSurface, Vec<[f64; 3]>, usize) {
        let width = cells.iter().flatten().max().unwrap() + 2;
        let vertex = |turn: u32, r: u32, z: u32| (turn % n) * width * width + r * width + z;
        let place = |v: u32| {
            let (turn, r, z) = (v / width / width, v / width % width, v % width);
            let angle = std::f64::consts::TAU * f64::from(turn) / f64::from(n);
            [f64::from(r + n) * angle.cos(), f64::from(r + n) * angle.sin(), f64::from(z)]
        };
        let points: Vec<[f64; 3]> = (0..n * width * width).map(place).collect();
        let hex = |turn: u32, &[r, z]: &[u32; 2]| {
            let bottom = [[turn, r], [turn, r + 1], [turn + 1, r + 1], [turn + 1, r]];
            std::array::from_fn(|i| vertex(bottom[i % 4][0], bottom[i % 4][1], z + i as u32 / 4))
        };
        let hexes: Vec<[u32; 8]> = (0..n).flat_map(|turn| cells.iter().map(move |c| hex(turn, c))).collect();
        let (surface, points) = crate::test_surfaces::boundary_of(&points, &hexes);
        (surface, points, hexes.len())
    }

    #[test]
    fn solids_of_revolution_are_rolled_up() {
        let block = |from: [u32; 2], to: [u32; 2]| {
            (from[0]..to[0]).flat_map(move |r| (from[1]..to[1]).map(move |z| [r, z])).collect::<Vec<[u32; 2]>>()
        };
        let [tube, flange, pulley] = [block([0, 0], [2, 5]), block([2, 0], [4, 2]), block([2, 4], [5, 5])];
        let sections = [tube.clone(), [tube.clone(), flange.clone()].concat(), [tube, flange, pulley].concat()];
        for (section, n) in sections.iter().flat_map(|s| [9, 12, 31].map(|n| (s, n))) {
            let (surface, points, known) = ring(n, section);
            // What a ring wants round itself is 2 - 4 / n hexes, and the rest is as in the section.
            let wanted = wanted_hexes(&surface, Some(&points));
            let development = develop(&surface, &wanted, Some(&points)).expect("a period is no fault");
            assert_eq!(development.period, n as i32);
            let hexes = polycube(&surface, &development).expect("the hexes of the solid");
            let n_vertices = hexes.iter().flatten().max().unwrap() + 1;
            let swept = Swept { n_vertices, hexes, plugs: 0, front: Vec::new(), stopped: None };
            assert_eq!(judged(&surface, &swept), known);
        }
    }

    #[test]
    fn random_solids_with_tunnels_and_cavities() {
        let mut tried = 0;
        for seed in 0..300 {
            let mut random = Random::new(seed);
            let size = [3, 3, 4].map(|n| n + random.below(3));
            let mut cells: BTreeSet<[usize; 3]> = (0..size[0] * size[1] * size[2])
                .map(|i| [i % size[0], i / size[0] % size[1], i / size[0] / size[1]])
                .collect();
            for _ in 0..6 {
                cells.remove(&size.map(|n| random.below(n)));
            }
            tried += usize::from(filled(size, &cells, 0.02).is_some_and(|n| {
                assert_eq!(n, cells.len());
                true
            }));
        }
        assert!(tried > 40, "{tried}");
    }
}
