//! Column collapse: a closed column of hexes goes, each of its quads being folded along one diagonal.
//!
//! A column is a line of the dual: hexes that follow each other through opposite quads. Two opposite corners of the quads, all along
//! the column, are merged: every hex becomes two quads that share an edge, every quad of the column two edges. (Daniels, Silva,
//! Shepherd, Cohen, "Quadrilateral mesh simplification", 2008, for quads; Shepherd, Dewey, Woodbury, Benzley, Staten, Owen,
//! "Adaptive mesh coarsening for quadrilateral and hexahedral meshes", 2010.)
//!
//! A column that ends on the boundary would fold the quads it ends with, so only closed ones can go, and only if the quad
//! comes back without a quarter turn. The two sheets that cross along the column are cut there and joined otherwise.
//!
//! Source: Daniels et al. 2008 (quads); Shepherd et al. 2010 (hexes).

use crate::simplify::live::{LiveMesh, NONE};
use crate::simplify::quotient::{Kept, Quotient, edge};
use hexfill_mesh::Context;
use hexfill_mesh::cube::{EDGES, FACETS};

/// A hex of a column and how it is passed.
pub(crate) struct Passed {
    hex: u32,
    direction: usize,
    /// The corners (0..8) of the quad it is entered through, in the order that the column carries along.
    entry: [usize; 4],
}

/// Collapses closed columns, the longest first, until none can go; returns how many went.
/// Time: a pass costs as much as sorting the hexes at the vertices of closed columns.
pub(crate) fn collapse_columns(live: &mut LiveMesh, kept: &Kept<'_>, ctx: &Context<'_>) -> u64 {
    let mut gone = 0;
    loop {
        let before = gone;
        for (_, hex, direction) in closed_columns(live) {
            if ctx.stop().is_some() {
                return gone;
            }
            // Other collapses may have changed it.
            let Some(column) = live.is_alive(hex).then(|| walk(live, hex, direction)).flatten() else { continue };
            for diagonal in [0, 1] {
                let Some(quotient) = column_quotient(live, &column, diagonal) else { continue };
                if let Ok(merges) = quotient.merges(live, kept) {
                    live.merge(&quotient.removed, &quotient.facets, &merges);
                    gone += 1;
                    break;
                }
            }
        }
        if gone == before {
            return gone;
        }
    }
}

/// The closed columns, longest first, each by a hex and a direction of it.
pub(crate) fn closed_columns(live: &LiveMesh) -> Vec<(std::cmp::Reverse<usize>, u32, usize)> {
    let mut seen = vec![false; 3 * live.n_hex_slots()];
    let mut columns = Vec::new();
    for hex in live.alive() {
        for direction in 0..3 {
            if seen[3 * hex as usize + direction] {
                continue;
            }
            // A facet number over 2 is a hex and a direction: the same slot whichever way the column is gone through.
            let mut at = 6 * hex + 2 * direction as u32;
            let start = at;
            let mut n = 0;
            loop {
                seen[(at / 2) as usize] = true;
                n += 1;
                at = live.neighbour(at ^ 1);
                if at == NONE || at == start {
                    break;
                }
            }
            if at == start {
                columns.push((std::cmp::Reverse(n), hex, direction));
            }
        }
    }
    columns.sort_unstable();
    columns
}

/// The column through a hex in a direction, once round; `None` if it ends, passes a hex twice or turns the quad.
pub(crate) fn walk(live: &LiveMesh, hex: u32, direction: usize) -> Option<Vec<Passed>> {
    let start = 6 * hex + 2 * direction as u32;
    let mut column: Vec<Passed> = Vec::new();
    let (mut facet, mut entry) = (start, FACETS[2 * direction]);
    loop {
        let (hex, direction) = (facet / 6, (facet % 6 / 2) as usize);
        column.push(Passed { hex, direction, entry });
        let exit = entry.map(|i| live.hex(hex)[across(i, direction)]);
        facet = live.neighbour(facet ^ 1);
        if facet == NONE {
            return None;
        }
        let next = live.hex(facet / 6);
        for (slot, v) in entry.iter_mut().zip(exit) {
            *slot = next.iter().position(|&w| w == v)?;
        }
        if facet == start {
            break;
        }
    }
    // Once round, the quad may come back turned. By a half turn opposite corners still fall on each other; by a
    // quarter they would be exchanged, and all four would be merged.
    let turned = column[0].entry.iter().position(|&i| i == entry[0])?;
    let mut hexes: Vec<u32> = column.iter().map(|p| p.hex).collect();
    hexes.sort_unstable();
    let passes_once = hexes.windows(2).all(|w| w[0] != w[1]);
    (turned.is_multiple_of(2) && passes_once).then_some(column)
}

/// The corner of a hex beyond the given one in a direction.
fn across(corner: usize, direction: usize) -> usize {
    let along = EDGES[4 * direction..4 * direction + 4].iter().find(|e| e.contains(&corner));
    along.map_or(corner, |&[a, b]| a + b - corner)
}

/// What folding a column does: corner `diagonal` of its quads meets the opposite one.
pub(crate) fn column_quotient(live: &LiveMesh, column: &[Passed], diagonal: usize) -> Option<Quotient> {
    let mut quotient = Quotient::default();
    for &Passed { hex: h, direction, entry } in column {
        let hex = live.hex(h);
        let corners = [0, 1, 2, 3].map(|k| entry[(diagonal + k) % 4]);
        let [a, b, c, d] = corners.map(|i| hex[i]);
        let [a2, c2] = [corners[0], corners[2]].map(|i| hex[across(i, direction)]);
        // The facet along the column at side k of the quad.
        let side = |k: usize| {
            let has = |f: &[usize; 4]| f.contains(&corners[k]) && f.contains(&corners[(k + 1) % 4]);
            (0..6).find(|&s| s / 2 != direction && has(&FACETS[s])).map(|s| 6 * h + s as u32)
        };
        quotient.removed.push(h);
        quotient.vertices.push([a, c]);
        quotient.edges.extend([[edge(a, b), edge(c, b)], [edge(a, d), edge(c, d)], [edge(a, a2), edge(c, c2)]]);
        quotient.facets.extend([[side(0)?, side(1)?], [side(2)?, side(3)?]]);
    }
    Some(quotient)
}
