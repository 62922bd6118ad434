//! Components with odd numbers of quads: two of one solid are joined by a chain of hexes.
//!
//! A buffer cube needs an odd number of heavy sides, so a component with an odd number of quads leaves one cube over
//! whose boundary is odd; it is left open. Two such cubes of one solid are joined by hexes of the core, each sharing a
//! quad with the next (Erickson 2014 pairs odd components in the same way). The two cubes and the chain together are one
//! ball with an even number of quads, 1 + 1 - 2 + 4 per hex modulo 2, and a small sphere is filled by the construction itself.
//! Why this stays proper: the boundary of the ball consists of quads of a complex that is proper, so it is a proper
//! surface (checked, as is that it is one sphere), and in a mesh made by the construction a hex meets the boundary in a face
//! of one quad only.

use crate::cell::CellLibrary;
use crate::construct::{Options, construct};
use crate::error::ConstructError;
use crate::layer::Layer;
use crate::tets::{TetComplex, find};
use crate::{BallCore, Construction};
use hexfill_mesh::cube::FACETS;
use hexfill_mesh::{Context, QuadId, QuadSurface, improper_pairs};
use std::collections::{BTreeMap, BTreeSet, BinaryHeap, VecDeque};

const NONE: u32 = u32::MAX;

/// Two odd components to be joined: the cubes left open, and tets that lead from the one to the other.
#[derive(Clone, Debug)]
pub(crate) struct Join {
    pub components: [usize; 2],
    pub quads: [QuadId; 2],
    pub tets: Vec<u32>,
}

/// Pairs the odd components of each solid. None if no component is odd; linear time per pair.
///
/// # Errors
/// [`ConstructError::OddComponent`] if a solid has an odd number of quads in all; [`ConstructError::OddJoin`].
pub(crate) fn joins(
    surface: &QuadSurface,
    complex: &TetComplex,
    boundary: &[u32],
) -> Result<Vec<Join>, ConstructError> {
    let mut size = vec![0usize; surface.n_components()];
    for q in 0..surface.n_quads() {
        size[surface.component(QuadId::new(q))] += 1;
    }
    if size.iter().all(|s| s.is_multiple_of(2)) {
        return Ok(Vec::new());
    }
    let mut tets_of = vec![[NONE; 2]; complex.n_faces];
    for (t, faces) in complex.tet_faces.iter().enumerate() {
        for &f in faces {
            let slot = usize::from(tets_of[f as usize][0] != NONE);
            tets_of[f as usize][slot] = t as u32;
        }
    }
    let mut root: Vec<u32> = (0..complex.tets.len() as u32).collect();
    for &[a, b] in tets_of.iter().filter(|t| t[1] != NONE) {
        let (a, b) = (find(&mut root, a), find(&mut root, b));
        root[a.max(b) as usize] = a.min(b);
    }
    let mut solids: BTreeMap<u32, BTreeSet<usize>> = BTreeMap::new();
    for (t, &f) in boundary.iter().enumerate() {
        let tet = find(&mut root, tets_of[f as usize][0]);
        solids.entry(tet).or_default().insert(surface.component(QuadId::new(t / 2)));
    }
    // Per tet: a triangle of the boundary on it.
    let mut triangle = vec![NONE; complex.tets.len()];
    for (t, &f) in boundary.iter().enumerate().rev() {
        triangle[tets_of[f as usize][0] as usize] = t as u32;
    }
    let component_at = |t: usize| (triangle[t] != NONE).then(|| surface.component(QuadId(triangle[t] / 2)));
    let mut taken = vec![false; complex.tets.len()];
    let mut joins = Vec::new();
    for components in solids.into_values() {
        let given: usize = components.iter().map(|&c| size[c]).sum();
        let first = components.first().copied().unwrap_or(0);
        if !given.is_multiple_of(2) {
            return Err(ConstructError::OddComponent { component: first, given });
        }
        let mut odd: BTreeSet<usize> = components.into_iter().filter(|&c| !size[c].is_multiple_of(2)).collect();
        while let Some(a) = odd.pop_first() {
            let mut from = vec![NONE; complex.tets.len()];
            let mut queue: VecDeque<usize> =
                (0..from.len()).filter(|&t| !taken[t] && component_at(t) == Some(a)).collect();
            queue.iter().for_each(|&t| from[t] = t as u32);
            let mut end = None;
            while let Some(t) = queue.pop_front() {
                if component_at(t).is_some_and(|c| odd.contains(&c)) {
                    end = Some(t);
                    break;
                }
                for &f in &complex.tet_faces[t] {
                    for &o in tets_of[f as usize].iter().filter(|&&o| o != NONE) {
                        if from[o as usize] == NONE && !taken[o as usize] {
                            from[o as usize] = t as u32;
                            queue.push_back(o as usize);
                        }
                    }
                }
            }
            let Some(end) = end else {
                let b = odd.first().copied().unwrap_or(a);
                return Err(ConstructError::OddJoin {
                    components: [a, b],
                    reason: "earlier chains bar the way".into(),
                });
            };
            let mut tets = vec![end as u32];
            while let Some(&t) = tets.last() {
                taken[t as usize] = true;
                if from[t as usize] == t {
                    break;
                }
                tets.push(from[t as usize]);
            }
            tets.reverse();
            let b = component_at(end).unwrap_or(a);
            odd.remove(&b);
            let at = |t: u32| QuadId(triangle[t as usize] / 2);
            joins.push(Join { components: [a, b], quads: [at(tets[0]), at(end as u32)], tets });
        }
    }
    Ok(joins)
}

/// The two open cubes and their chain, filled.
pub(crate) struct Joined {
    /// Indices of the core hexes that are replaced, ascending.
    pub removed: Vec<usize>,
    /// Vertex of the mesh for each vertex of the ball's boundary; its further vertices are new.
    pub ids: Vec<u32>,
    /// The filling.
    pub filling: Construction,
}

/// Finds a chain among the core hexes of the join's tets and fills the ball. `first_hex[t]` is the index in `hexes` of the first hex of
/// tet `t` (one more entry than tets); `start` are positions of all vertices, if known.
///
/// # Errors
/// [`ConstructError::OddJoin`]; [`ConstructError::Stopped`].
pub(crate) fn fill_join(
    join: &Join,
    layer: &Layer<'_>,
    library: &CellLibrary,
    hexes: &[[u32; 8]],
    first_hex: &[usize],
    start: Option<&[[f64; 3]]>,
    ctx: &Context<'_>,
) -> Result<Joined, ConstructError> {
    let cubes = join.quads.map(|q| {
        let quads = layer.pattern(q).boundary().into_iter();
        quads.map(|quad| quad.map(|r| layer.point(q, r))).collect::<Vec<_>>()
    });
    let near: BTreeSet<u32> = cubes.iter().flatten().flatten().copied().collect();
    let around: Vec<usize> = join.tets.iter().flat_map(|&t| first_hex[t as usize]..first_hex[t as usize + 1]).collect();
    let mut hexes_at: BTreeMap<[u32; 4], Vec<usize>> = BTreeMap::new();
    for &h in &around {
        for f in FACETS {
            hexes_at.entry(sorted(f.map(|k| hexes[h][k]))).or_default().push(h);
        }
    }
    let at = |quad: &[u32; 4]| hexes_at.get(&sorted(*quad)).and_then(|h| h.first().copied());
    let goals: BTreeSet<usize> = cubes[1].iter().filter_map(at).collect();
    let starts: BTreeSet<usize> = cubes[0].iter().filter_map(at).collect();
    let mut reason = "no hexes of the core lie between them".to_owned();
    for &first in &starts {
        for &last in &goals {
            if let Some(stop) = ctx.stop() {
                return Err(ConstructError::Stopped(stop));
            }
            let Some(chain) = chain(first, last, hexes, &hexes_at, &near) else { continue };
            match ball(&cubes, &chain, hexes) {
                Ok((surface, ids)) => {
                    let points: Option<Vec<[f64; 3]>> = start.map(|p| ids.iter().map(|&v| p[v as usize]).collect());
                    let options =
                        Options { library: Some(library.clone()), ball_core: BallCore::Fewest, ..Options::default() };
                    let quiet = Context { progress: None, ..*ctx };
                    let filling = construct(&surface, points.as_deref(), &options, &quiet)?;
                    let mut removed = chain;
                    removed.sort_unstable();
                    return Ok(Joined { removed, ids, filling });
                }
                Err(e) => reason = e,
            }
        }
    }
    Err(ConstructError::OddJoin { components: join.components, reason })
}

fn sorted(mut q: [u32; 4]) -> [u32; 4] {
    q.sort_unstable();
    q
}

/// A short chain of hexes from `first` to `last`, one quad after another, that keeps away from the vertices `near` between its ends.
fn chain(
    first: usize,
    last: usize,
    hexes: &[[u32; 8]],
    hexes_at: &BTreeMap<[u32; 4], Vec<usize>>,
    near: &BTreeSet<u32>,
) -> Option<Vec<usize>> {
    let cost = |h: usize| {
        if h == first || h == last { 1 } else { 1 + 4 * hexes[h].iter().filter(|v| near.contains(v)).count() }
    };
    let mut best: BTreeMap<usize, (usize, usize)> = BTreeMap::from([(first, (0, first))]);
    let mut heap = BinaryHeap::from([(std::cmp::Reverse(0), first)]);
    while let Some((std::cmp::Reverse(length), h)) = heap.pop() {
        if h == last {
            break;
        }
        if best.get(&h).is_some_and(|b| b.0 < length) {
            continue;
        }
        for f in FACETS {
            for &o in hexes_at.get(&sorted(f.map(|k| hexes[h][k]))).into_iter().flatten().filter(|&&o| o != h) {
                let through = length + cost(o);
                if best.get(&o).is_none_or(|b| through < b.0) {
                    best.insert(o, (through, h));
                    heap.push((std::cmp::Reverse(through), o));
                }
            }
        }
    }
    let mut chain = vec![last];
    while let Some(&h) = chain.last() {
        let before = best.get(&h)?.1;
        if before == h {
            break;
        }
        chain.push(before);
    }
    chain.reverse();
    Some(chain)
}

/// The boundary of two cubes and a chain as a surface of its own, with the vertex of the mesh for each of its vertices.
///
/// # Errors
/// What it is instead of a proper sphere.
fn ball(cubes: &[Vec<[u32; 4]>; 2], chain: &[usize], hexes: &[[u32; 8]]) -> Result<(QuadSurface, Vec<u32>), String> {
    let mut open: BTreeMap<[u32; 4], [u32; 4]> = BTreeMap::new();
    let chained = chain.iter().flat_map(|&h| FACETS.map(|f| f.map(|k| hexes[h][k])));
    for quad in cubes.iter().flatten().copied().chain(chained) {
        if open.remove(&sorted(quad)).is_none() {
            open.insert(sorted(quad), quad);
        }
    }
    let mut ids: Vec<u32> = open.values().flatten().copied().collect();
    ids.sort_unstable();
    ids.dedup();
    let local: Vec<[u32; 4]> = open.values().map(|q| q.map(|v| ids.partition_point(|&x| x < v) as u32)).collect();
    let surface = QuadSurface::try_new(ids.len(), &local).map_err(|e| e.to_string())?;
    if !surface.is_sphere() || !surface.n_quads().is_multiple_of(2) || !surface.reversed().is_empty() {
        return Err("the chains found touch themselves".into());
    }
    if !improper_pairs(&surface).is_empty() {
        return Err("the chains found have quads that share too much".into());
    }
    Ok((surface, ids))
}
