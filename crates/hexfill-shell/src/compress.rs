//! Compression: chords that run side by side along their whole length become one with a multiplicity.
//!
//! Between two such chords lies a *rail*: a closed curve of edges that goes straight through vertices of degree 4. Taking
//! a rail out joins its two chords. What is left is a coarse surface each of whose quads is a grid of fine ones, so a mesh
//! of the coarse surface lifts to one of the fine ([`crate::lift`]). Rails along a crease stay, since the solver needs
//! their angles, and so does every rail without which the coarse surface would not be proper.
//! On surfaces that are not spheres rails go in pairs: then every loop crosses as many chords as before, mod 2, and what
//! could be filled still can (Erickson 2014).
//!
//! Source: ours; that pairs of chords may go on any surface follows from Erickson 2014, section 4.

use crate::angles::FLAT;
use hexfill_mesh::{Dart, QuadSurface, VertexId, is_proper};

/// How far from flat an edge may be, in right angles, and still be on a rail that is taken out.
const CREASE: f32 = 0.5;

/// A coarse surface and the fine one it stands for.
#[derive(Clone, Debug)]
pub(crate) struct Coarse {
    pub surface: QuadSurface,
    /// Per quad: the fine vertices in it.
    pub grids: Vec<Grid>,
    /// Per dart: hexes wanted round its edge, the mean over its fine edges.
    pub wanted: Vec<f32>,
    /// Per dart: the number of fine edges on it, which is the multiplicity of the chord that crosses it.
    pub length: Vec<u32>,
    /// Fine vertex of each coarse one.
    pub vertices: Vec<VertexId>,
}

/// The fine vertices of a coarse quad, `(width + 1) * (height + 1)` of them, row by row: from corner 0 to corner 1
/// along a row, from corner 0 to corner 3 from row to row.
#[derive(Clone, Debug)]
pub(crate) struct Grid {
    pub width: u32,
    pub height: u32,
    pub vertices: Vec<VertexId>,
}

/// Compresses a surface as far as rails allow; `wanted` is per dart.
pub(crate) fn compress(surface: &QuadSurface, wanted: &[f32]) -> Coarse {
    let rails = Rails::of(surface, wanted);
    let mut taken = vec![false; rails.curves.len()];
    let mut best = None;
    let units = rails.units(surface, !surface.is_sphere());
    take_out(&units, &mut taken, &mut best, &|taken| coarsen(surface, wanted, &rails, taken));
    match best {
        Some(coarse) => coarse,
        None => coarsen(surface, wanted, &rails, &vec![false; rails.curves.len()])
            .unwrap_or_else(|| uncompressed(surface, wanted)),
    }
}

/// The surface itself as a coarse one.
pub(crate) fn uncompressed(surface: &QuadSurface, wanted: &[f32]) -> Coarse {
    let grid = |q: &[VertexId; 4]| Grid { width: 1, height: 1, vertices: vec![q[0], q[1], q[3], q[2]] };
    Coarse {
        surface: surface.clone(),
        grids: surface.quads().iter().map(grid).collect(),
        wanted: wanted.to_vec(),
        length: vec![1; wanted.len()],
        vertices: (0..surface.n_vertices()).map(VertexId::new).collect(),
    }
}

/// Takes out as many units as leave a good surface: all at once, or each half by itself.
fn take_out(
    units: &[Vec<usize>],
    taken: &mut Vec<bool>,
    best: &mut Option<Coarse>,
    coarsen: &dyn Fn(&[bool]) -> Option<Coarse>,
) {
    if units.is_empty() {
        return;
    }
    let set = |taken: &mut Vec<bool>, to: bool| units.iter().flatten().for_each(|&r| taken[r] = to);
    set(taken, true);
    // As a rule all rails go at once. Halving finds the few that may not with a number of attempts that grows with
    // them and the logarithm of all.
    if let Some(coarse) = coarsen(taken) {
        *best = Some(coarse);
        return;
    }
    set(taken, false);
    if units.len() > 1 {
        let (first, second) = units.split_at(units.len() / 2);
        take_out(first, taken, best, coarsen);
        take_out(second, taken, best, coarsen);
    }
}

/// The closed curves of edges that go straight through vertices of degree 4, with no crease on them.
struct Rails {
    /// One dart after the other.
    curves: Vec<Vec<Dart>>,
    /// Per dart: the rail of its edge, or `NONE`.
    of_dart: Vec<u32>,
}

const NONE: u32 = u32::MAX;

/// The dart that goes straight on at the end of `d`, a vertex of degree 4.
fn straight(surface: &QuadSurface, d: Dart) -> Dart {
    surface.twin(d.next()).next()
}

impl Rails {
    fn of(surface: &QuadSurface, wanted: &[f32]) -> Self {
        let mut rails = Self { curves: Vec::new(), of_dart: vec![NONE; wanted.len()] };
        let mut seen = vec![false; wanted.len()];
        for first in surface.darts() {
            if seen[first.index()] {
                continue;
            }
            let mut curve = vec![first];
            let mut d = first;
            let closed = loop {
                // A rail ends at a singular vertex: taking out a part of it would leave a chord that ends inside.
                if surface.degree(surface.target(d)) != 4 {
                    break false;
                }
                d = straight(surface, d);
                if d == first {
                    break true;
                }
                curve.push(d);
            };
            for d in &curve {
                seen[d.index()] = true;
            }
            // A crease is where the solver has to end its layers; without those edges the coarse surface would look
            // flat there.
            let plain = |d: &Dart| (wanted[d.index()] - FLAT).abs() <= CREASE;
            if !closed || !curve.iter().all(plain) {
                continue;
            }
            for d in &curve {
                seen[surface.twin(*d).index()] = true;
                rails.of_dart[d.index()] = rails.curves.len() as u32;
                rails.of_dart[surface.twin(*d).index()] = rails.curves.len() as u32;
            }
            rails.curves.push(curve);
        }
        rails
    }

    /// What may be taken out together: single rails, or with `in_pairs` two that have one chord between them.
    fn units(&self, surface: &QuadSurface, in_pairs: bool) -> Vec<Vec<usize>> {
        if !in_pairs {
            return (0..self.curves.len()).map(|r| vec![r]).collect();
        }
        let mut used = vec![false; self.curves.len()];
        let mut units = Vec::new();
        for r in 0..self.curves.len() {
            if used[r] {
                continue;
            }
            // The rail beyond the chord on the left, if it is one all along.
            let d = self.curves[r][0];
            let beyond = |d: Dart| self.of_dart[d.opposite().index()];
            // Pairs keep for every loop how many chords it crosses modulo 2, the only thing that says whether a
            // surface with handles bounds a hex mesh.
            let left = [d, surface.twin(d)]
                .map(beyond)
                .into_iter()
                .find(|&s| s != NONE && s as usize != r && !used[s as usize]);
            if let Some(s) = left {
                used[r] = true;
                used[s as usize] = true;
                units.push(vec![r, s as usize]);
            }
        }
        units
    }
}

/// The coarse surface without the rails that are taken; `None` if that is not a proper surface.
fn coarsen(surface: &QuadSurface, wanted: &[f32], rails: &Rails, taken: &[bool]) -> Option<Coarse> {
    let mut passed = vec![false; surface.n_vertices()];
    for (curve, _) in rails.curves.iter().zip(taken).filter(|(_, t)| **t) {
        for d in curve {
            passed[surface.origin(*d).index()] = true;
        }
    }
    let is_taken = |d: Dart| {
        let rail = rails.of_dart[d.index()];
        rail != NONE && taken[rail as usize]
    };
    let mut number = vec![NONE; surface.n_vertices()];
    let mut vertices = Vec::new();
    for v in 0..surface.n_vertices() {
        if !passed[v] && surface.degree(VertexId::new(v)) > 0 {
            number[v] = vertices.len() as u32;
            vertices.push(VertexId::new(v));
        }
    }
    let is_corner = |v: VertexId| number[v.index()] != NONE;
    let mut seen = vec![false; 4 * surface.n_quads()];
    let (mut quads, mut grids, mut mean, mut length) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let mut n_fine = 0usize;
    for first in surface.darts() {
        if seen[first.index()] || !is_corner(surface.origin(first)) || is_taken(first) {
            continue;
        }
        let mut corners = [0u32; 4];
        let mut sides = [0u32; 4];
        let mut d = first;
        for side in 0..4 {
            corners[side] = number[surface.origin(d).index()];
            if seen[d.index()] || is_taken(d) {
                return None;
            }
            seen[d.index()] = true;
            let mut sum = wanted[d.index()];
            let mut steps = 1u32;
            while !is_corner(surface.target(d)) {
                d = straight(surface, d);
                sum += wanted[d.index()];
                steps += 1;
            }
            mean.push(sum / steps as f32);
            sides[side] = steps;
            d = d.next();
            length.push(steps);
        }
        if d != first || sides[0] != sides[2] || sides[1] != sides[3] {
            return None;
        }
        n_fine += sides[0] as usize * sides[1] as usize;
        grids.push(grid(surface, first, sides[0], sides[1]));
        quads.push(corners);
    }
    // Every fine quad in a grid, once: a rail that stops inside a coarse quad would leave some over.
    if n_fine != surface.n_quads() || quads.len() < 6 {
        return None;
    }
    let coarse = QuadSurface::try_new(vertices.len(), &quads).ok()?;
    // No theorem keeps it proper: of two chords that run in parallel nearly all along one may be what keeps two quads
    // apart. So it is looked at.
    let same = coarse.n_components() == surface.n_components()
        && coarse.euler_characteristic() == surface.euler_characteristic()
        && coarse.reversed().is_empty();
    (same && is_proper(&coarse)).then_some(Coarse { surface: coarse, grids, wanted: mean, length, vertices })
}

/// The fine vertices of the coarse quad on the left of `first`, which is its first fine dart.
fn grid(surface: &QuadSurface, first: Dart, width: u32, height: u32) -> Grid {
    let mut vertices = Vec::with_capacity((width as usize + 1) * (height as usize + 1));
    let mut row = first;
    for _ in 0..=height {
        let mut d = row;
        for i in 0..width {
            vertices.push(surface.origin(d));
            if i + 1 < width {
                d = straight(surface, d);
            }
        }
        vertices.push(surface.target(d));
        row = surface.twin(row.opposite());
    }
    Grid { width, height, vertices }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::angles::wanted_hexes;
    use hexfill_mesh::generate::{refined, schneiders_pyramid, torus};

    #[test]
    fn a_refined_surface_comes_back() {
        for k in [2, 3, 5] {
            let coarse = schneiders_pyramid();
            let fine = refined(&coarse, k).unwrap();
            let found = compress(&fine, &wanted_hexes(&fine, None));
            assert_eq!(found.surface.n_quads(), coarse.n_quads());
            assert!(found.length.iter().all(|&m| m == k));
            let all: usize = found.grids.iter().map(|g| (g.width * g.height) as usize).sum();
            assert_eq!(all, fine.n_quads());
        }
    }

    #[test]
    fn a_torus_keeps_the_parity_of_its_loops() {
        for (n, m) in [(12, 8), (47, 16), (15, 9)] {
            let fine = torus(n, m, 0).unwrap();
            let found = compress(&fine, &wanted_hexes(&fine, None)).surface;
            assert!(found.n_quads() < 50, "{n} x {m}: {}", found.n_quads());
            assert_eq!(hexfill_mesh::bipartition(&fine).is_ok(), hexfill_mesh::bipartition(&found).is_ok());
        }
    }
}
