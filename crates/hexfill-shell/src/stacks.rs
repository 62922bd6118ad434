//! Stacks: sheets that lie one on the other over most of their hexes, as the layers of a block do.
//!
//! Source: ours; sheets as layers of hexes: Borden et al. 2002.

use hexfill_mesh::cube::FACETS;
use hexfill_mesh::{Facet, HexId, HexMesh, Sheet};
use rustc_hash::FxHashMap;

/// The sheet of each hex in each direction.
pub(crate) fn sheet_of(mesh: &HexMesh, sheets: &[Sheet]) -> Vec<[u32; 3]> {
    let mut of = vec![[u32::MAX; 3]; mesh.n_hexes()];
    for (s, sheet) in sheets.iter().enumerate() {
        for &(h, direction) in &sheet.crossings {
            of[h.index()][usize::from(direction)] = s as u32;
        }
    }
    of
}

/// The stacks of three sheets and more, each from one end to the other; a ring of sheets is cut before its least one.
pub(crate) fn stacks(mesh: &HexMesh, sheets: &[Sheet], of: &[[u32; 3]]) -> Vec<Vec<u32>> {
    let mut shared: FxHashMap<[u32; 2], usize> = FxHashMap::default();
    for h in (0..mesh.n_hexes()).map(HexId::new) {
        for side in 0..FACETS.len() {
            let Some(across) = mesh.neighbour(Facet::new(h, side)).filter(|across| across.hex() > h) else { continue };
            let (s, t) = (of[h.index()][side / 2], of[across.hex().index()][across.side() / 2]);
            if s != t {
                *shared.entry([s.min(t), s.max(t)]).or_default() += 1;
            }
        }
    }
    let size = |s: u32| sheets[s as usize].crossings.len();
    let mut next: Vec<Vec<u32>> = vec![Vec::new(); sheets.len()];
    for (&[s, t], &n) in &shared {
        // One sheet at most covers more than half of a side, so there are two of these, or one on both sides.
        if 2 * n > size(s).max(size(t)) {
            next[s as usize].push(t);
            next[t as usize].push(s);
        }
    }
    // The map has no order of its own.
    next.iter_mut().for_each(|n| n.sort_unstable());
    let mut is_done: Vec<bool> = next.iter().map(|n| n.len() > 2).collect();
    let mut found = Vec::new();
    let all = || 0..sheets.len() as u32;
    for first in all().filter(|&s| next[s as usize].len() == 1).chain(all()) {
        let mut stack = Vec::new();
        let mut at = Some(first).filter(|&s| !is_done[s as usize]);
        while let Some(s) = at {
            is_done[s as usize] = true;
            stack.push(s);
            at = next[s as usize].iter().copied().find(|&t| !is_done[t as usize]);
        }
        if stack.len() >= 3 {
            found.push(stack);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use hexfill_mesh::generate::grid;
    use hexfill_mesh::sheets;

    #[test]
    fn a_box_is_three_stacks() {
        let mesh = grid(3, 4, 6).unwrap();
        let sheets = sheets(&mesh);
        let of = sheet_of(&mesh, &sheets);
        let mut lengths: Vec<usize> = stacks(&mesh, &sheets, &of).iter().map(Vec::len).collect();
        lengths.sort_unstable();
        assert_eq!(lengths, [3, 4, 6]);
        for stack in stacks(&mesh, &sheets, &of) {
            for pair in stack.windows(2) {
                let touches = |h: &HexId, side: usize| {
                    let across = mesh.neighbour(Facet::new(*h, side));
                    across.is_some_and(|a| of[a.hex().index()][side / 2] == pair[1])
                };
                let first = &sheets[pair[0] as usize].crossings;
                assert!(first.iter().all(|(h, d)| (0..2).any(|e| touches(h, 2 * usize::from(*d) + e))));
            }
        }
    }
}
