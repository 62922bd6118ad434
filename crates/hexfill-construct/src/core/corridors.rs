//! Components with odd numbers of quads are paired, and tets found that lead from the one to the other.
//!
//! A solid may have components with odd numbers of quads if their number is even (Erickson 2014 pairs them in the same way).
//! What becomes of a corridor: `joins/mod.rs`.
//!
//! Source: Erickson 2014 (odd components are paired); the search for ways that do not touch is ours.

use super::complex::TetComplex;
use crate::error::ConstructError;
use crate::ids::{FaceId, TetId};
use crate::joins::no_chain::NoChain;
use crate::surface::existence::Existence;
use hexfill_mesh::{Forest, IdVec, QuadId, QuadSurface};
use std::collections::{BTreeMap, BTreeSet, VecDeque};

/// Two odd components to be joined: the cubes left open, and tets that lead from the one to the other.
#[derive(Clone, Debug)]
pub(crate) struct Corridor {
    pub(crate) components: [usize; 2],
    pub(crate) quads: [QuadId; 2],
    pub(crate) tets: Vec<TetId>,
}

/// Pairs the odd components of each solid. None if no component is odd; linear time per pair.
///
/// # Errors
/// [`ConstructError::NoMesh`] if a solid has an odd number of quads in all; [`ConstructError::OddJoin`].
pub(crate) fn corridors(
    surface: &QuadSurface,
    complex: &TetComplex,
    boundary: &[FaceId],
) -> Result<Vec<Corridor>, ConstructError> {
    let mut size = vec![0usize; surface.n_components()];
    for q in 0..surface.n_quads() {
        size[surface.component(QuadId::new(q))] += 1;
    }
    if size.iter().all(|s| s.is_multiple_of(2)) {
        return Ok(Vec::new());
    }
    let mut ways = Ways::new(surface, complex, boundary);
    let mut found = Vec::new();
    for components in ways.solids(boundary) {
        let given: usize = components.iter().map(|&c| size[c]).sum();
        if !given.is_multiple_of(2) {
            return Err(ConstructError::NoMesh(Existence::OddSolid {
                components: components.into_iter().collect(),
                given,
            }));
        }
        let mut odd: BTreeSet<usize> = components.into_iter().filter(|&c| !size[c].is_multiple_of(2)).collect();
        // An even sum of odd components is an even number of them, so they can be paired; nearest first is good
        // enough, as each way costs some hexes a tet.
        while let Some(a) = odd.pop_first() {
            // Corridors do not share tets: their balls are filled one by one and must not overlap.
            let Some(tets) = ways.shortest(a, &odd) else {
                let b = odd.first().copied().unwrap_or(a);
                return Err(ConstructError::OddJoin { components: [a, b], reason: NoChain::Barred });
            };
            let [start, end] = [tets[0], tets[tets.len() - 1]];
            let b = ways.component_at(end).unwrap_or(a);
            odd.remove(&b);
            found.push(Corridor { components: [a, b], quads: [start, end].map(|t| ways.quad[t]), tets });
        }
    }
    Ok(found)
}

/// Ways through the tets from triangle to triangle of the boundary.
struct Ways<'a> {
    surface: &'a QuadSurface,
    complex: &'a TetComplex,
    tets_of: IdVec<FaceId, [TetId; 2]>,
    /// Per tet: the quad of a triangle of the boundary on it, or none.
    quad: IdVec<TetId, QuadId>,
    /// Tets of corridors found before.
    taken: IdVec<TetId, bool>,
}

impl<'a> Ways<'a> {
    fn new(surface: &'a QuadSurface, complex: &'a TetComplex, boundary: &[FaceId]) -> Self {
        let n_tets = complex.tets.len();
        let mut tets_of = IdVec::filled([TetId::NONE; 2], complex.n_faces);
        for (t, faces) in complex.tet_faces.enumerate() {
            for &f in faces {
                let pair: &mut [TetId; 2] = &mut tets_of[f];
                pair[usize::from(pair[0].is_some())] = t;
            }
        }
        let mut quad = IdVec::filled(QuadId::NONE, n_tets);
        // Backwards, so that the lowest triangle of a tet is the one that stays.
        for (triangle, &f) in boundary.iter().enumerate().rev() {
            quad[tets_of[f][0]] = QuadId::new(triangle / 2);
        }
        Self { surface, complex, tets_of, quad, taken: IdVec::filled(false, n_tets) }
    }

    /// The components of each solid, solids by smallest tet.
    fn solids(&self, boundary: &[FaceId]) -> Vec<BTreeSet<usize>> {
        let mut forest: Forest<TetId> = Forest::new(self.complex.tets.len());
        for &[a, b] in self.tets_of.iter().filter(|t| t[1].is_some()) {
            forest.union(a, b);
        }
        let mut solids: BTreeMap<TetId, BTreeSet<usize>> = BTreeMap::new();
        for (triangle, &f) in boundary.iter().enumerate() {
            let solid = forest.find(self.tets_of[f][0]);
            solids.entry(solid).or_default().insert(self.surface.component(QuadId::new(triangle / 2)));
        }
        solids.into_values().collect()
    }

    fn component_at(&self, t: TetId) -> Option<usize> {
        self.quad[t].is_some().then(|| self.surface.component(self.quad[t]))
    }

    /// The shortest way from a component to one of the others, round the ways found before.
    fn shortest(&mut self, a: usize, others: &BTreeSet<usize>) -> Option<Vec<TetId>> {
        let mut from = IdVec::filled(TetId::NONE, self.complex.tets.len());
        let starts = from.ids().filter(|&t| !self.taken[t] && self.component_at(t) == Some(a));
        let mut queue: VecDeque<TetId> = starts.collect();
        queue.iter().for_each(|&t| from[t] = t);
        let end = loop {
            let t = queue.pop_front()?;
            if self.component_at(t).is_some_and(|c| others.contains(&c)) {
                break t;
            }
            for &f in &self.complex.tet_faces[t] {
                for o in self.tets_of[f].into_iter().filter(|o| o.is_some()) {
                    if from[o].is_none() && !self.taken[o] {
                        from[o] = t;
                        queue.push_back(o);
                    }
                }
            }
        };
        let mut tets = vec![end];
        while let Some(&t) = tets.last() {
            self.taken[t] = true;
            if from[t] == t {
                break;
            }
            tets.push(from[t]);
        }
        tets.reverse();
        Some(tets)
    }
}
