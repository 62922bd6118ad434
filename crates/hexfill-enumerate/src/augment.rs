//! Canonical augmentation (B. McKay, "Isomorph-free exhaustive generation", 1998): every class is made once, without
//! remembering the others.
//!
//! Each complex chooses, by a rule that isomorphisms respect, one orbit of cubes among those it could have been made
//! by adding last. A child is accepted if the cube just added lies in that orbit; two accepted children of one
//! parent are isomorphic only by an automorphism of the parent, so a small set settles siblings.
//!
//! * Rule `strict` is hereditary: any cube that does not disconnect may be the last one. The chosen cube has the fewest
//!   glued facets (the extension makes no others), then the greatest cheap invariant, then the lowest position in the
//!   canonical labelling. Most children are settled before a labelling is needed.
//! * Rule `weill` is not: a cube could have been last only if the rest is itself a class of the level before, which a set of
//!   hashes of that level answers. So its memory is one level less than that of the level engine.
//!
//! Source: McKay 1998; the order of the cubes and the cheap invariants are ours.

use crate::canonical::{Code, Labelling, canonical, cube_invariants, search};
use crate::complex::Complex;
use crate::error::EnumerateError;
use crate::hashset::{HashKey, OpenSet};
use crate::params::{Params, Rule};
use crate::tally::Counter;
use crate::targets::{Found, Wanted};
use crate::weill::could_be_last;
use hexfill_mesh::Context;
use rustc_hash::FxHashSet;

/// The hashes of a level, to ask whether a complex is in it.
pub(crate) type Members = OpenSet<u128>;

/// The set of the hashes of some codes.
pub(crate) fn members(codes: &[Code]) -> Members {
    let mut out = OpenSet::new();
    for code in codes {
        out.insert(u128::of(code.hash128()));
    }
    out
}

/// A child's verdict: its labelling if it is accepted, and the number of cubes that could have been last.
pub(crate) struct Accepted {
    pub(crate) labelling: Labelling,
    pub(crate) removable: u32,
}

/// Whether rule `strict` accepts a child whose last cube is glued by `glued` facets, the fewest among its removable cubes.
fn accept_strict(child: &Complex, glued: u8) -> Option<Accepted> {
    let new = child.n_cubes() - 1;
    let non_cut = child.non_cut();
    let mut rivals = 0u16;
    for a in 0..=new {
        rivals |= u16::from(non_cut >> a & 1 == 1 && child.n_glued(a) == glued) << a;
    }
    let invariants = cube_invariants(child);
    let mut ties = 0u16;
    for a in 0..=new {
        if rivals >> a & 1 == 1 {
            // The child chooses a greater cube for its last one and is made from there: settled without a labelling.
            if invariants[a] > invariants[new] {
                return None;
            }
            ties |= u16::from(invariants[a] == invariants[new]) << a;
        }
    }
    // Ties by the canonical labelling, which cannot tell cubes of one orbit apart: the child is accepted from any of
    // them.
    let labelling = search(child, &invariants);
    is_first(&labelling, ties, new).then_some(Accepted { labelling, removable: rivals.count_ones() })
}

/// Whether rule `weill` accepts a child, the level before being `before`.
fn accept_weill(child: &Complex, before: &Members) -> Option<Accepted> {
    let new = child.n_cubes() - 1;
    let non_cut = child.non_cut();
    let invariants = cube_invariants(child);
    let candidate = |a: usize| non_cut >> a & 1 == 1 && could_be_last(child, a);
    let known = |a: usize| before.contains(u128::of(canonical(&child.removed(a)).code.hash128()));
    let mut removable = 1;
    let mut ties = 1u16 << new;
    let mut lesser = 0u16;
    for a in 0..new {
        if invariants[a] < invariants[new] {
            lesser |= u16::from(candidate(a)) << a;
        } else if candidate(a) && known(a) {
            if invariants[a] > invariants[new] {
                return None;
            }
            ties |= 1 << a;
            removable += 1;
        }
    }
    let labelling = search(child, &invariants);
    if !is_first(&labelling, ties, new) {
        return None;
    }
    // For the mass formula only: the others that could have been last.
    removable += (0..new).filter(|&a| lesser >> a & 1 == 1 && known(a)).count() as u32;
    Some(Accepted { labelling, removable })
}

/// Whether the cube `new` is in the orbit of the tied cube that comes first in the canonical labelling.
fn is_first(labelling: &Labelling, ties: u16, new: usize) -> bool {
    let own = labelling.first_position[new];
    (0..new).all(|a| ties >> a & 1 == 0 || labelling.first_position[a] >= own)
}

/// One walk over a part of the tree of canonical augmentations.
pub(crate) struct Walk<'a> {
    pub(crate) params: &'a Params,
    /// For rule `weill`: the level before the last.
    pub(crate) before: Option<&'a Members>,
    pub(crate) wanted: Wanted<'a>,
    pub(crate) counter: Counter,
    pub(crate) found: Found,
    siblings: FxHashSet<u128>,
}

impl<'a> Walk<'a> {
    pub(crate) fn new(params: &'a Params, before: Option<&'a Members>, wanted: Wanted<'a>) -> Self {
        Self {
            params,
            before,
            wanted,
            counter: Counter::new(params.nonorientable),
            found: Found::default(),
            siblings: FxHashSet::default(),
        }
    }

    fn accept(&self, child: &Complex, glued: u8) -> Option<Accepted> {
        match (self.params.rule, self.before) {
            (Rule::Weill, Some(before)) => accept_weill(child, before),
            // Rule weill without a level before it exists for one cube only, which has no parent.
            _ => accept_strict(child, glued),
        }
    }

    /// The accepted children of a node, with the orders of their groups.
    pub(crate) fn children(&mut self, parent: &Complex, automorphisms: u16) -> Vec<(Complex, u16)> {
        let mut out = Vec::new();
        let mut siblings = std::mem::take(&mut self.siblings);
        siblings.clear();
        self.params.extend(parent, true, |child, glued| {
            if let Some(accepted) = self.accept(child, glued)
                // Two accepted children of one parent are isomorphic only by an automorphism of the parent: one
                // without symmetry needs no memory of its children.
                && (automorphisms == 1 || siblings.insert(accepted.labelling.code.hash128()))
            {
                out.push((*child, accepted.labelling.automorphisms));
            }
        });
        self.siblings = siblings;
        out
    }

    /// Counts the accepted children of a node of the level before the last.
    pub(crate) fn count_children(&mut self, parent: &Complex, automorphisms: u16) {
        let mut siblings = std::mem::take(&mut self.siblings);
        siblings.clear();
        self.counter.parent();
        self.params.extend(parent, true, |child, glued| {
            self.counter.raw(glued, automorphisms);
            if child.is_closed() {
                self.counter.raw_closed();
            }
            let Some(Accepted { labelling, removable }) = self.accept(child, glued) else { return };
            let hash = labelling.code.hash128();
            if automorphisms > 1 && !siblings.insert(hash) {
                return;
            }
            let (boundary, shape) = self.counter.class(child, &labelling, hash);
            self.counter.removable(removable, labelling.automorphisms);
            self.found.look(&self.wanted, &mut self.counter, &boundary, &shape, labelling.code);
        });
        self.siblings = siblings;
    }

    /// Walks below a node down to the last level.
    pub(crate) fn descend(
        &mut self,
        parent: &Complex,
        automorphisms: u16,
        ctx: &Context<'_>,
    ) -> Result<(), EnumerateError> {
        if parent.n_cubes() + 1 == self.params.cubes {
            if let Some(reason) = ctx.stop() {
                return Err(EnumerateError::Stopped { reason });
            }
            self.count_children(parent, automorphisms);
            return Ok(());
        }
        for (child, automorphisms) in self.children(parent, automorphisms) {
            self.descend(&child, automorphisms, ctx)?;
        }
        Ok(())
    }
}
