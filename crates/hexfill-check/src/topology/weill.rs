//! The rules of Weill's poster ("A tentative to break the pyramid's code", CEA), replayed on the given order of the hexes.
//!
//! From the second hex on each hex N is glued on the complex of those before it:
//! 1. every facet of N with the vertices of an exterior quad is glued to it; at least one is; the same vertices in another
//!    cyclic order, or a facet that is already interior, are not allowed; corners of N outside the glued facets are new;
//! 2. a free facet of N shares at most two vertices with any earlier hex;
//! 3. N shares at most four vertices with any earlier hex;
//! 4. afterwards every boundary edge is in exactly two boundary quads.
//!
//! Gluings of opposite facets must keep orientation; that is judged with level 3 (`non-orientable`).
//!
//! Source: Weill.

use crate::report::{Findings, Offender};
use crate::rule::Rule;
use hexfill_mesh::cube::FACETS;
use rustc_hash::FxHashMap;

/// A quad seen so far: its diagonals (as a set) and how many hexes have it.
struct Seen {
    diagonal: [u32; 2],
    hexes: u32,
}

fn sorted<const K: usize>(mut ids: [u32; K]) -> [u32; K] {
    ids.sort_unstable();
    ids
}

/// The vertices in ascending order and the diagonal through the smallest.
fn key(hex: &[u32; 8], facet: [usize; 4]) -> ([u32; 4], [u32; 2]) {
    let cycle = facet.map(|k| hex[k]);
    let set = sorted(cycle);
    let first = if cycle[0] == set[0] || cycle[2] == set[0] { [cycle[0], cycle[2]] } else { [cycle[1], cycle[3]] };
    (set, sorted(first))
}

/// Replays the hexes (indices in range below `n`, eight distinct vertices each). A hex that breaks a rule is named and glued on
/// all the same.
pub(crate) fn replay(n: usize, hexes: &[[u32; 8]]) -> Findings {
    let mut findings = Findings::default();
    let mut quads: FxHashMap<[u32; 4], Seen> = FxHashMap::default();
    // Boundary quads at each edge.
    let mut edges: FxHashMap<[u32; 2], i32> = FxHashMap::default();
    let mut around: Vec<Vec<u32>> = vec![Vec::new(); n];
    for (h, hex) in hexes.iter().enumerate() {
        let id = h as u32;
        let mut glued = [false; 6];
        for (side, facet) in FACETS.into_iter().enumerate() {
            let (set, diagonal) = key(hex, facet);
            if let Some(seen) = quads.get(&set) {
                glued[side] = true;
                if seen.hexes > 1 || seen.diagonal != diagonal {
                    let cycle = facet.map(|k| hex[k]);
                    let note = if seen.hexes > 1 { "already interior" } else { "in another cyclic order" };
                    findings.add(Rule::WeillQuadNotExterior, || Offender::at(&[id], &cycle).note(note));
                }
            }
        }
        if h > 0 {
            if glued == [false; 6] {
                findings.add(Rule::WeillNotGlued, || Offender::at(&[id], &[]));
            }
            judge_corners(id, hex, &glued, &around, &mut findings);
            judge_earlier(id, hex, hexes, &glued, &around, &mut findings);
        }
        for facet in FACETS {
            let (set, diagonal) = key(hex, facet);
            let seen = quads.entry(set).or_insert(Seen { diagonal, hexes: 0 });
            seen.hexes += 1;
            let change = match seen.hexes {
                1 => 1,
                2 => -1,
                _ => 0,
            };
            for i in 0..4 {
                *edges.entry(sorted([hex[facet[i]], hex[facet[(i + 1) % 4]]])).or_insert(0) += change;
            }
        }
        for edge in hexfill_mesh::cube::EDGES {
            let edge = sorted(edge.map(|k| hex[k]));
            let count = edges.get(&edge).copied().unwrap_or(0);
            if count != 0 && count != 2 {
                findings.add(Rule::WeillBoundaryEdge, || {
                    Offender::at(&[id], &edge).note(format!("in {count} boundary quads after this hex"))
                });
            }
        }
        hex.iter().for_each(|&v| around[v as usize].push(id));
    }
    findings
}

/// Corners outside the glued facets must be new.
fn judge_corners(id: u32, hex: &[u32; 8], glued: &[bool; 6], around: &[Vec<u32>], findings: &mut Findings) {
    for (k, &v) in hex.iter().enumerate() {
        let held = (0..6).any(|side| glued[side] && FACETS[side].contains(&k));
        if let (false, Some(&other)) = (held, around[v as usize].first()) {
            findings.add(Rule::WeillMergesVertex, || Offender::at(&[id, other], &[v]));
        }
    }
}

/// Rules 2 and 3 against every earlier hex that shares a vertex.
fn judge_earlier(
    id: u32,
    hex: &[u32; 8],
    hexes: &[[u32; 8]],
    glued: &[bool; 6],
    around: &[Vec<u32>],
    findings: &mut Findings,
) {
    // A hex occurs as often as it shares vertices, so its run in the sorted list is the number rule 3 asks for.
    let mut earlier: Vec<u32> = hex.iter().flat_map(|&v| around[v as usize].iter().copied()).collect();
    earlier.sort_unstable();
    for same in earlier.chunk_by(|a, b| a == b) {
        let other = &hexes[same[0] as usize];
        if same.len() > 4 {
            let note = format!("{} common vertices", same.len());
            findings.add(Rule::WeillSharesFive, || Offender::at(&[id, same[0]], &[]).note(note));
        }
        for side in (0..6).filter(|&side| !glued[side]) {
            let cycle = FACETS[side].map(|k| hex[k]);
            if cycle.iter().filter(|v| other.contains(v)).count() > 2 {
                findings.add(Rule::WeillFreeFacetTouches, || Offender::at(&[id, same[0]], &cycle));
            }
        }
    }
}
