//! Sheet collapse: all edges dual to a sheet are contracted at once, the hexes of the sheet go.
//!
//! The inverse of a pillow, and of every other way to put a sheet in. The hexes of the sheet become quads, their sides edges, and
//! what lies on either side of the sheet meets. (Borden, Benzley, Shepherd, "Hexahedral sheet extraction", 11th International
//! Meshing Roundtable, 2002; Ledoux, Shepherd, "Topological modifications of hexahedral meshes via sheet operations", 2010.)
//!
//! A sheet with a boundary curve would merge the ends of boundary edges, so only closed sheets can go. A sheet that crosses
//! itself in a hex would press whole quads into points round the cycle of their edges and is refused for that.
//! Collapsing one sheet leaves the others what they are, less the hexes that both pass.
//!
//! Source: Borden et al. 2002; Ledoux, Shepherd 2010.

use crate::simplify::live::LiveMesh;
use crate::simplify::quotient::{Kept, Quotient, edge};
use hexfill_mesh::cube::{EDGES, FACETS};
use hexfill_mesh::{Context, HexMesh, sheets};

/// Collapses closed sheets, those with most hexes first, until none can go; returns how many went.
/// Time: a pass over the sheets costs as much as sorting the hexes at their vertices.
pub(crate) fn collapse_sheets(live: &mut LiveMesh, kept: &Kept<'_>, ctx: &Context<'_>) -> u64 {
    let mut closed = closed_sheets(live);
    let mut gone = 0;
    loop {
        // Stable: sheets with as many hexes in the order of their first ones.
        closed.sort_by_key(|s| std::cmp::Reverse(s.len()));
        let before = gone;
        for sheet in &mut closed {
            if ctx.stop().is_some() {
                return gone;
            }
            sheet.retain(|&(h, _)| live.is_alive(h));
            if sheet.is_empty() {
                continue;
            }
            let quotient = sheet_quotient(live, sheet);
            if let Ok(merges) = quotient.merges(live, kept) {
                live.merge(&quotient.removed, &quotient.facets, &merges);
                sheet.clear();
                gone += 1;
            }
        }
        closed.retain(|s| !s.is_empty());
        if gone == before {
            return gone;
        }
    }
}

/// The closed sheets that do not cross themselves, by their hexes and the direction each is cut across.
pub(crate) fn closed_sheets(live: &LiveMesh) -> Vec<Vec<(u32, u8)>> {
    let slots: Vec<u32> = live.alive().collect();
    let hexes: Vec<[u32; 8]> = slots.iter().map(|&h| *live.hex(h)).collect();
    let mesh = HexMesh::try_new(live.n_vertex_slots(), &hexes).expect("facets stay glued in pairs");
    sheets(&mesh)
        .into_iter()
        .filter(|s| s.boundary.is_empty() && s.self_crossings.is_empty())
        .map(|s| s.crossings.into_iter().map(|(h, direction)| (slots[h.index()], direction)).collect())
        .collect()
}

/// What the collapse of a sheet does. `sheet`: all its hexes with the direction it cuts across, no hex twice.
pub(crate) fn sheet_quotient(live: &LiveMesh, sheet: &[(u32, u8)]) -> Quotient {
    let mut quotient = Quotient::default();
    let mut crossed: Vec<(u32, [[u32; 2]; 2])> = Vec::with_capacity(4 * sheet.len());
    for &(h, direction) in sheet {
        let hex = live.hex(h);
        let direction = usize::from(direction);
        let ends = 6 * h + 2 * direction as u32;
        quotient.removed.push(h);
        quotient.facets.push([ends, ends + 1]);
        let pressed = &EDGES[4 * direction..4 * direction + 4];
        quotient.vertices.extend(pressed.iter().map(|&[i, j]| edge(hex[i], hex[j])));
        for side in (0..6).filter(|side| side / 2 != direction) {
            let f = 6 * h + side as u32;
            let corners = FACETS[side];
            // The pair of opposite sides of the quad that is not pressed to points.
            let is_pressed = |i: usize| pressed.iter().any(|e| e.contains(&corners[i]) && e.contains(&corners[i + 1]));
            let first = usize::from(is_pressed(0));
            let q = live.facet(f);
            let kept = [edge(q[first], q[first + 1]), edge(q[first + 2], q[(first + 3) % 4])];
            crossed.push((f.min(live.neighbour(f)), [kept[0].min(kept[1]), kept[0].max(kept[1])]));
        }
    }
    quotient.vertices.sort_unstable();
    quotient.vertices.dedup();
    crossed.sort_unstable();
    crossed.dedup();
    quotient.edges = crossed.into_iter().map(|(_, kept)| kept).collect();
    quotient
}
