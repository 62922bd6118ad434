//! A cover placed with all its images under the group.
//!
//! Source: ours.

use crate::corners::DISTANCE;
use crate::cover::Cover;
use crate::state::{Glue, Hex, State};
use crate::symmetry::Action;

/// Places a cover and its images under the group. `None` if two of them do not go together; the caller must then undo. Else the number of
/// quads that the first hex made: they come first among the new ones, and every new open quad is an image of one of them.
pub(crate) fn place_orbit(state: &mut State, action: &mut Action, cover: &Cover) -> Option<usize> {
    let colour_of = |state: &State, i: usize| {
        let near = cover.hex[0];
        (state.coloured >> near & 1 == 1) != (DISTANCE[i][0] % 2 == 1)
    };
    for &orbit in cover.new_orbits() {
        let first = state.n();
        let corner = cover.hex.iter().position(|&v| usize::from(v) == first)?;
        let colour = colour_of(state, corner);
        action.extend(first, orbit, |_, other| state.add_vertex(colour != other));
    }
    let (mut made, before) = (0, state.hexes.len());
    for g in 0..action.order() {
        let mut hex = cover.hex.map(|v| action.image(g, v));
        if action.reflects(g) {
            // Seen in a mirror the order of corners turns inside out; bottom and top exchanged turn it back.
            hex = [4, 5, 6, 7, 0, 1, 2, 3].map(|i: usize| hex[i]);
        }
        if let Some(same) = state.hexes[before..].iter().find(|h| set_of(h) == set_of(&hex)) {
            if !same_cube(same, &hex) {
                return None;
            }
            continue;
        }
        let glue: Glue = state.glue(&hex)?;
        if !state.place(&hex, &glue) {
            return None;
        }
        if g == 0 {
            made = 6 - glue.n_glued();
        }
    }
    Some(made)
}

fn set_of(hex: &Hex) -> u128 {
    hex.iter().fold(0, |set, &v| set | 1 << v)
}

/// Whether two hexes with the same vertices are the same cube.
fn same_cube(a: &Hex, b: &Hex) -> bool {
    let at = b.map(|v| a.iter().position(|&w| w == v).unwrap_or(0));
    (0..8).all(|i| (0..i).all(|j| DISTANCE[at[i]][at[j]] == DISTANCE[i][j]))
}
