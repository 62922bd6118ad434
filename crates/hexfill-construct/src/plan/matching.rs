//! Which sides are heavy: every quad needs an odd number of heavy sides, best three.
//!
//! The *light* sides form a set with an odd number at every quad as well: a perfect matching of the dual graph
//! (one light side each) where possible. The dual graph is 4-regular and, for a sphere, 4-edge-connected, so a
//! perfect matching exists (Tutte); here a greedy matching (smallest residual degree first, Karp and Sipser 1981)
//! is improved by short augmenting paths, and the few quads that are left are paired along a spanning tree: such a
//! path adds 0 or 2 to the light sides of the quads it passes (a T-join). All steps take linear time, because the
//! search for one augmenting path visits a bounded number of quads. Why a matching: see the page
//! `construction` of the book, step 3.
//!
//! Source: Tutte 1947 (a perfect matching exists), Karp and Sipser 1981 (the greedy start), Edmonds and Johnson 1973 (T-joins); their use for cells is
//! ours.

use crate::error::ConstructError;
use crate::surface::existence::Existence;
use hexfill_mesh::{Context, Dart, IdVec, QuadId, QuadSurface};

/// The light sides, an odd number at each quad (but for those left open).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LightSides {
    /// Per dart: whether its edge is light (equal for twins).
    pub light: IdVec<Dart, bool>,
    /// Number of quads the matching left over, paired by tree paths.
    pub n_unmatched: usize,
    /// Number of quads with three light sides.
    pub n_triple: usize,
    /// Per quad: whether its cube is left open; only such a quad has an even number of light sides.
    pub open: IdVec<QuadId, bool>,
}

/// Quads visited in the search for one augmenting path.
const SEARCH_LIMIT: usize = 4000;

/// Chooses the light sides. Linear time. `left_open` are quads that get an even number of them: one in each
/// component with an odd number of quads. `variant` orders choices that are equally good here: each gives another matching,
/// as small, but with other cells meeting at a vertex.
///
/// # Errors
/// [`ConstructError::NoMesh`] if a component has an odd number of quads and none is left open;
/// [`ConstructError::Stopped`].
pub fn light_sides(
    surface: &QuadSurface,
    left_open: &[QuadId],
    variant: u64,
    ctx: &Context<'_>,
) -> Result<LightSides, ConstructError> {
    let mut open = IdVec::filled(false, surface.n_quads());
    left_open.iter().for_each(|&q| open[q] = true);
    let mut size = vec![0usize; surface.n_components()];
    for (q, open) in open.enumerate() {
        size[surface.component(q)] += 1 + usize::from(*open);
    }
    if let Some(component) = size.iter().position(|s| s % 2 == 1) {
        return Err(ConstructError::NoMesh(Existence::OddSolid {
            components: vec![component],
            given: size[component],
        }));
    }
    let mut mate = greedy(surface, variant);
    augment(surface, &mut mate, ctx)?;
    let mut light = IdVec::filled(false, 4 * surface.n_quads());
    for &d in mate.iter().filter(|d| d.is_some()) {
        light[d] = true;
    }
    let n_unmatched = mate.iter().filter(|d| d.is_none()).count();
    // A quad the matching left over has no light side, an open one may have one: these are the places where the
    // parity is wrong, an even number in each component.
    let mut odd: IdVec<QuadId, bool> = mate.iter().zip(&open).map(|(&d, &open)| d.is_none() != open).collect();
    if odd.as_slice().contains(&true) {
        tree_join(surface, &mut odd, &mut light);
    }
    let n_triple = light.as_slice().chunks(4).filter(|l| l.iter().filter(|&&x| x).count() == 3).count();
    Ok(LightSides { light, n_unmatched, n_triple, open })
}

/// A fixed scramble of `x` for this variant (the finaliser of SplitMix64); none for variant 0.
fn scramble(variant: u64, x: usize) -> u64 {
    if variant == 0 {
        return 0;
    }
    let mut z = (x as u64).wrapping_add(variant.wrapping_mul(0x9E37_79B9_7F4A_7C15));
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

/// The quads across the sides of a quad, with the darts there.
fn around(surface: &QuadSurface, q: QuadId) -> impl Iterator<Item = (Dart, QuadId)> + '_ {
    (0..4).map(move |k| Dart::new(q, k)).map(|d| (d, surface.twin(d).quad()))
}

/// Per quad: its dart across which it is matched, or none. Smallest residual degree first.
fn greedy(surface: &QuadSurface, variant: u64) -> IdVec<QuadId, Dart> {
    let n = surface.n_quads();
    let mut mate = IdVec::filled(Dart::NONE, n);
    let mut order: Vec<QuadId> = mate.ids().collect();
    order.sort_by_key(|q| scramble(variant, q.index()));
    let mut rest = order.into_iter();
    let mut residual: IdVec<QuadId, u8> = IdVec::filled(4, n);
    // Quads with one neighbour left: matching it with that loses nothing (Karp and Sipser).
    let mut ready: Vec<QuadId> = Vec::new();
    while let Some(q) = ready.pop().or_else(|| rest.next()) {
        if mate[q].is_some() {
            continue;
        }
        let free = around(surface, q).filter(|&(_, other)| other != q && mate[other].is_none());
        let rank =
            |&(d, other): &(Dart, QuadId)| (residual[other], scramble(variant, d.index().min(surface.twin(d).index())));
        let Some((d, other)) = free.min_by_key(rank) else { continue };
        mate[q] = d;
        mate[other] = surface.twin(d);
        for gone in [q, other] {
            for (_, r) in around(surface, gone) {
                residual[r] = u8::saturating_sub(residual[r], 1);
                if mate[r].is_none() && residual[r] == 1 {
                    ready.push(r);
                }
            }
        }
    }
    mate
}

/// Alternating breadth-first search from each free quad. Every quad is entered once, so a path found is simple;
/// odd cycles may hide a path, which costs optimality and never correctness.
fn augment(surface: &QuadSurface, mate: &mut IdVec<QuadId, Dart>, ctx: &Context<'_>) -> Result<(), ConstructError> {
    let n = mate.len();
    // Per quad: the last root whose search met it.
    let mut stamp = IdVec::filled(QuadId::NONE, n);
    // Per quad reached by an unmatched edge: the dart (of the even quad before it) that reached it.
    let mut from: IdVec<QuadId, Dart> = IdVec::filled(Dart::NONE, n);
    let mut queue: Vec<QuadId> = Vec::new();
    for root in mate.ids() {
        if mate[root].is_some() {
            continue;
        }
        if let Some(reason) = ctx.stop() {
            return Err(ConstructError::Stopped(reason));
        }
        queue.clear();
        queue.push(root);
        stamp[root] = root;
        let mut at = 0;
        let mut end = None;
        // No blossoms are shrunk: a general maximum matching took a minute for 100,000 quads, and what this search
        // misses costs a few cells with three light sides.
        'search: while at < queue.len() && queue.len() < SEARCH_LIMIT {
            let q = queue[at];
            at += 1;
            for (d, other) in around(surface, q) {
                if stamp[other] == root {
                    continue;
                }
                stamp[other] = root;
                from[other] = d;
                if mate[other].is_none() {
                    end = Some(other);
                    break 'search;
                }
                let even = surface.twin(mate[other]).quad();
                stamp[even] = root;
                queue.push(even);
            }
        }
        while let Some(odd) = end {
            let d = from[odd];
            let even = d.quad();
            let before = mate[even];
            mate[even] = d;
            mate[odd] = surface.twin(d);
            end = (even != root).then(|| surface.twin(before).quad());
        }
    }
    Ok(())
}

/// Toggles the tree edges below which an odd number of marked quads lies: the T-join of a spanning forest.
fn tree_join(surface: &QuadSurface, odd: &mut IdVec<QuadId, bool>, light: &mut IdVec<Dart, bool>) {
    let mut seen = IdVec::filled(false, odd.len());
    let mut order: Vec<(QuadId, Dart)> = Vec::with_capacity(odd.len());
    for root in odd.ids() {
        if seen[root] {
            continue;
        }
        seen[root] = true;
        let mut at = order.len();
        order.push((root, Dart::NONE));
        while at < order.len() {
            let (q, _) = order[at];
            at += 1;
            for (d, other) in around(surface, q) {
                if !seen[other] {
                    seen[other] = true;
                    order.push((other, surface.twin(d)));
                }
            }
        }
    }
    // From the leaves: when a quad is reached everything below it is settled, and an edge of the tree is toggled iff
    // an odd number of odd quads hangs on it. The root comes out even because each component has an even number.
    for &(q, up) in order.iter().rev() {
        if odd[q] && up.is_some() {
            let across = surface.twin(up);
            light[up] ^= true;
            light[across] ^= true;
            odd[q] = false;
            odd[across.quad()] ^= true;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hexfill_mesh::generate::{random_sphere, torus};

    fn check(surface: &QuadSurface) -> LightSides {
        let l = light_sides(surface, &[], 0, &Context::default()).unwrap();
        for d in surface.darts() {
            assert_eq!(l.light[d], l.light[surface.twin(d)]);
        }
        assert!(l.light.as_slice().chunks(4).all(|c| c.iter().filter(|&&x| x).count() % 2 == 1));
        l
    }

    #[test]
    fn every_quad_has_an_odd_number_of_light_sides() {
        let (mut quads, mut left) = (0, 0);
        for i in 0..60 {
            let s = random_sphere(20 + 4 * i, i as u64).unwrap();
            left += check(&s).n_unmatched;
            quads += s.n_quads();
        }
        assert!(100 * left <= quads, "{left} of {quads} quads unmatched");
        for (m, n) in [(4, 4), (3, 4), (5, 6), (20, 31)] {
            check(&torus(m, n, 0).unwrap());
        }
    }

    #[test]
    fn the_tree_pairs_any_even_set() {
        let s = torus(6, 5, 0).unwrap();
        let mut odd = IdVec::filled(false, 30);
        odd[QuadId(3)] = true;
        odd[QuadId(29)] = true;
        let wanted = odd.clone();
        let mut light = IdVec::filled(false, 120);
        tree_join(&s, &mut odd, &mut light);
        for (c, wanted) in light.as_slice().chunks(4).zip(wanted) {
            assert_eq!(c.iter().filter(|&&x| x).count() % 2 == 1, wanted);
        }
    }

    #[test]
    fn an_odd_component_is_refused_or_left_open_at_one_quad() {
        let s = torus(3, 5, 0).unwrap();
        let l = light_sides(&s, &[QuadId(7)], 0, &Context::default()).unwrap();
        for (q, c) in l.light.as_slice().chunks(4).enumerate() {
            assert_eq!(c.iter().filter(|&&x| x).count() % 2 == 0, q == 7);
        }

        assert!(matches!(
            light_sides(&torus(3, 5, 0).unwrap(), &[], 0, &Context::default()),
            Err(ConstructError::NoMesh(Existence::OddSolid { given: 15, .. }))
        ));
    }
}
