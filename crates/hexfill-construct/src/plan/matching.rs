//! Which sides are heavy. Every quad needs an odd number of heavy sides, best three.
//!
//! The *light* sides form a set with an odd number at every quad as well: a perfect matching of the dual graph
//! (one light side each) where possible. The dual graph is 4-regular and, for a sphere, 4-edge-connected, so a
//! perfect matching exists (Tutte); here a greedy matching (smallest residual degree first, Karp and Sipser 1981)
//! is improved by short augmenting paths, and the few quads that are left are paired along a spanning tree: such a
//! path adds 0 or 2 to the light sides of the quads it passes (a T-join). All steps take linear time, because the
//! search for one augmenting path visits a bounded number of quads. Why a matching: Erickson 2014, section 3 (parity of the
//! buffer cubes).

use crate::error::ConstructError;
use hexfill_mesh::{Context, Dart, QuadId, QuadSurface};

/// The light sides, an odd number at each quad (but for those left open).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LightSides {
    /// Per dart: whether its edge is light (equal for twins).
    pub light: Vec<bool>,
    /// Number of quads the matching left over, paired by tree paths.
    pub n_unmatched: usize,
    /// Number of quads with three light sides.
    pub n_triple: usize,
    /// Per quad: whether its cube is left open; only such a quad has an even number of light sides.
    pub open: Vec<bool>,
}

/// Quads visited in the search for one augmenting path.
const SEARCH_LIMIT: usize = 4000;

/// Chooses the light sides. Linear time. `left_open` are quads that get an even number of them: one in each
/// component with an odd number of quads. `variant` orders choices that are equally good here: each gives another matching,
/// as small, but with other cells meeting at a vertex.
///
/// # Errors
/// [`ConstructError::OddComponent`] if a component has an odd number of quads and none is left open;
/// [`ConstructError::Stopped`].
pub fn light_sides(
    surface: &QuadSurface,
    left_open: &[QuadId],
    variant: u64,
    ctx: &Context<'_>,
) -> Result<LightSides, ConstructError> {
    let mut open = vec![false; surface.n_quads()];
    left_open.iter().for_each(|q| open[q.index()] = true);
    let mut size = vec![0usize; surface.n_components()];
    for (q, open) in open.iter().enumerate() {
        size[surface.component(QuadId::new(q))] += 1 + usize::from(*open);
    }
    if let Some(component) = size.iter().position(|s| s % 2 == 1) {
        return Err(ConstructError::OddComponent { component, given: size[component] });
    }
    let mut mate = greedy(surface, variant);
    augment(surface, &mut mate, ctx)?;
    let mut light = vec![false; 4 * surface.n_quads()];
    for &d in mate.iter().filter(|d| d.is_some()) {
        light[d.index()] = true;
    }
    let n_unmatched = mate.iter().filter(|d| d.is_none()).count();
    let mut odd: Vec<bool> = mate.iter().zip(&open).map(|(&d, &open)| d.is_none() != open).collect();
    if odd.contains(&true) {
        tree_join(surface, &mut odd, &mut light);
    }
    let n_triple = light.chunks(4).filter(|l| l.iter().filter(|&&x| x).count() == 3).count();
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

/// Per quad: its dart across which it is matched, or none.
fn greedy(surface: &QuadSurface, variant: u64) -> Vec<Dart> {
    let n = surface.n_quads();
    let mut order: Vec<u32> = (0..n as u32).collect();
    order.sort_by_key(|&q| scramble(variant, q as usize));
    let mut mate = vec![Dart::NONE; n];
    let mut residual = vec![4u8; n];
    let mut ready: Vec<u32> = Vec::new();
    let mut next = 0usize;
    loop {
        let q = match ready.pop() {
            Some(q) => q as usize,
            None if next < n => {
                next += 1;
                order[next - 1] as usize
            }
            None => return mate,
        };
        if mate[q].is_some() {
            continue;
        }
        let free = (0..4).map(|k| Dart::new(QuadId::new(q), k)).filter(|&d| {
            let other = surface.twin(d).quad().index();
            other != q && mate[other].is_none()
        });
        let Some(d) = free.min_by_key(|&d| {
            (residual[surface.twin(d).quad().index()], scramble(variant, d.index().min(surface.twin(d).index())))
        }) else {
            continue;
        };
        let other = surface.twin(d).quad().index();
        mate[q] = d;
        mate[other] = surface.twin(d);
        for gone in [q, other] {
            for k in 0..4 {
                let r = surface.twin(Dart::new(QuadId::new(gone), k)).quad().index();
                residual[r] = residual[r].saturating_sub(1);
                if mate[r].is_none() && residual[r] == 1 {
                    ready.push(r as u32);
                }
            }
        }
    }
}

/// Alternating breadth-first search from each free quad. Every quad is entered once, so a path found is simple;
/// odd cycles may hide a path, which costs optimality and never correctness.
fn augment(surface: &QuadSurface, mate: &mut [Dart], ctx: &Context<'_>) -> Result<(), ConstructError> {
    let n = mate.len();
    let mut stamp = vec![u32::MAX; n];
    // Per quad reached by an unmatched edge: the dart (of the even quad before it) that reached it.
    let mut from = vec![Dart::NONE; n];
    let mut queue: Vec<usize> = Vec::new();
    for root in 0..n {
        if mate[root].is_some() {
            continue;
        }
        if let Some(reason) = ctx.stop() {
            return Err(ConstructError::Stopped(reason));
        }
        queue.clear();
        queue.push(root);
        stamp[root] = root as u32;
        let mut at = 0;
        let mut end = None;
        'search: while at < queue.len() && queue.len() < SEARCH_LIMIT {
            let q = queue[at];
            at += 1;
            for k in 0..4 {
                let d = Dart::new(QuadId::new(q), k);
                let other = surface.twin(d).quad().index();
                if stamp[other] == root as u32 {
                    continue;
                }
                stamp[other] = root as u32;
                from[other] = d;
                if mate[other].is_none() {
                    end = Some(other);
                    break 'search;
                }
                let even = surface.twin(mate[other]).quad().index();
                stamp[even] = root as u32;
                queue.push(even);
            }
        }
        while let Some(odd) = end {
            let d = from[odd];
            let even = d.quad().index();
            let before = mate[even];
            mate[even] = d;
            mate[odd] = surface.twin(d);
            end = (even != root).then(|| surface.twin(before).quad().index());
        }
    }
    Ok(())
}

/// Toggles the tree edges below which an odd number of marked quads lies.
fn tree_join(surface: &QuadSurface, odd: &mut [bool], light: &mut [bool]) {
    let n = odd.len();
    let mut seen = vec![false; n];
    let mut order: Vec<(usize, Dart)> = Vec::with_capacity(n);
    for root in 0..n {
        if seen[root] {
            continue;
        }
        seen[root] = true;
        let mut at = order.len();
        order.push((root, Dart::NONE));
        while at < order.len() {
            let (q, _) = order[at];
            at += 1;
            for k in 0..4 {
                let d = Dart::new(QuadId::new(q), k);
                let other = surface.twin(d).quad().index();
                if !seen[other] {
                    seen[other] = true;
                    order.push((other, surface.twin(d)));
                }
            }
        }
    }
    for &(q, up) in order.iter().rev() {
        if odd[q] && up.is_some() {
            let across = surface.twin(up);
            light[up.index()] ^= true;
            light[across.index()] ^= true;
            odd[q] = false;
            odd[across.quad().index()] ^= true;
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
            assert_eq!(l.light[d.index()], l.light[surface.twin(d).index()]);
        }
        assert!(l.light.chunks(4).all(|c| c.iter().filter(|&&x| x).count() % 2 == 1));
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
        let mut odd = vec![false; 30];
        odd[3] = true;
        odd[29] = true;
        let wanted = odd.clone();
        let mut light = vec![false; 120];
        tree_join(&s, &mut odd, &mut light);
        for q in 0..30 {
            assert_eq!(light[4 * q..4 * q + 4].iter().filter(|&&x| x).count() % 2 == 1, wanted[q]);
        }
    }

    #[test]
    fn an_odd_component_is_refused_or_left_open_at_one_quad() {
        let s = torus(3, 5, 0).unwrap();
        let l = light_sides(&s, &[QuadId(7)], 0, &Context::default()).unwrap();
        for (q, c) in l.light.chunks(4).enumerate() {
            assert_eq!(c.iter().filter(|&&x| x).count() % 2 == 0, q == 7);
        }

        assert!(matches!(
            light_sides(&torus(3, 5, 0).unwrap(), &[], 0, &Context::default()),
            Err(ConstructError::OddComponent { component: 0, given: 15 })
        ));
    }
}
