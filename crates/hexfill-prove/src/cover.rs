//! Every hex that can cover an open quad: its four far vertices are old ones or new, each pair allowed by the pair table.
//!
//! New vertices are interchangeable, so only the next unused id is tried. Under a symmetry a new vertex comes with its whole orbit, one
//! try for each stabilizer it may have; the other vertices of the orbit are then old ones for the corners still to be chosen.

use crate::state::{Glue, Hex, MAX_VERTICES, State};
use crate::symmetry::Action;
use hexfill_mesh::cube::{EDGES, POSITIONS};

/// The corners above the covered quad, in the order they are chosen.
const FAR: [usize; 4] = [4, 7, 6, 5];
const NEAR: [usize; 4] = [0, 3, 2, 1];

/// Number of edges between two corners: 1 an edge, 2 a face diagonal, 3 a body diagonal.
pub(crate) const fn distance(i: usize, j: usize) -> u8 {
    let (p, q) = (POSITIONS[i], POSITIONS[j]);
    p[0].abs_diff(q[0]) + p[1].abs_diff(q[1]) + p[2].abs_diff(q[2])
}

const DISTANCE: [[u8; 8]; 8] = {
    let mut table = [[0; 8]; 8];
    let mut i = 0;
    while i < 64 {
        table[i / 8][i % 8] = distance(i / 8, i % 8);
        i += 1;
    }
    table
};

/// A hex that can cover a quad, and the orbits of new vertices it brings (one vertex each without symmetry).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cover {
    pub hex: Hex,
    stabilizers: [u8; 4],
    n_orbits: u8,
}

/// What a cover may bring.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Allowance {
    /// Most new vertices.
    pub new_vertices: i32,
    /// Most new edges less new vertices, for one hex without symmetry.
    pub excess: i32,
}

/// The search for covers of one quad.
struct Search<'a, F> {
    state: &'a State,
    action: &'a mut Action,
    allowance: Allowance,
    cover: Cover,
    /// Place in the hex of each vertex that has one, plus 1.
    place: [u8; MAX_VERTICES],
    n: usize,
    coloured: u128,
    visit: F,
}

/// Calls `visit` for each hex that can cover the open quad, until it says `false`. The action's images of vertices not made yet change.
pub(crate) fn covers<F: FnMut(&Cover) -> bool>(
    state: &State,
    action: &mut Action,
    q: u16,
    allowance: Allowance,
    visit: F,
) {
    let mut hex = [0; 8];
    for (i, v) in NEAR.into_iter().zip(state.quad(q)) {
        hex[i] = v;
    }
    let mut search = Search {
        state,
        action,
        allowance,
        cover: Cover { hex, stabilizers: [0; 4], n_orbits: 0 },
        place: [0; MAX_VERTICES],
        n: state.n(),
        coloured: state.coloured,
        visit,
    };
    for i in NEAR {
        search.place[usize::from(hex[i])] = i as u8 + 1;
    }
    search.choose(0);
}

impl<F: FnMut(&Cover) -> bool> Search<'_, F> {
    /// Chooses far vertex number `depth` and all after it. `false` ends the search.
    fn choose(&mut self, depth: usize) -> bool {
        if depth == 4 {
            return self.finish();
        }
        let p = FAR[depth];
        let near = self.cover.hex[0];
        let colour = (self.coloured >> near & 1 == 1) != (DISTANCE[p][0] % 2 == 1);
        let mut set = self.state.live();
        for o in NEAR.into_iter().chain(FAR[..depth].iter().copied()) {
            let v = self.cover.hex[o];
            set &= match DISTANCE[p][o] {
                1 => self.state.edge_row(v),
                2 => self.state.diagonal_row(v),
                _ => self.state.body_row(v),
            };
        }
        set &= if colour { self.coloured } else { !self.coloured };
        let mut old = set & ((1 << self.n) - 1);
        while old != 0 {
            let v = old.trailing_zeros() as u8;
            old &= old - 1;
            if !self.put(depth, v) {
                return false;
            }
        }
        let (n, coloured) = (self.n, self.coloured);
        for s in 0..self.action.n_stabilizers() {
            let size = self.action.orbit_size(s);
            let made = (n + size) as i32 - self.state.counts.vertices;
            if made > self.allowance.new_vertices || n + size >= MAX_VERTICES {
                continue;
            }
            let mut colours = coloured;
            self.action.extend(n, s, |i, other| {
                let bit = 1 << (n + i);
                colours = if colour != other { colours | bit } else { colours & !bit };
            });
            (self.n, self.coloured) = (n + size, colours);
            let orbit = usize::from(self.cover.n_orbits);
            self.cover.stabilizers[orbit] = s as u8;
            self.cover.n_orbits += 1;
            let go_on = self.put(depth, n as u8);
            self.cover.n_orbits -= 1;
            (self.n, self.coloured) = (n, coloured);
            if !go_on {
                return false;
            }
        }
        true
    }

    /// Puts a vertex at far corner number `depth` and goes on.
    fn put(&mut self, depth: usize, v: u8) -> bool {
        let p = FAR[depth];
        self.cover.hex[p] = v;
        self.place[usize::from(v)] = p as u8 + 1;
        let go_on = !self.agrees(depth) || self.choose(depth + 1);
        self.place[usize::from(v)] = 0;
        go_on
    }

    /// Whether every image of the hex that has two of its vertices so far has them at the same distance.
    fn agrees(&self, depth: usize) -> bool {
        let p = FAR[depth];
        let place = |g: usize, o: usize| usize::from(self.place[usize::from(self.action.image(g, self.cover.hex[o]))]);
        (1..self.action.order()).all(|g| {
            let at = place(g, p);
            at == 0
                || NEAR.into_iter().chain(FAR[..depth].iter().copied()).all(|o| {
                    let other = place(g, o);
                    other == 0 || DISTANCE[at - 1][other - 1] == DISTANCE[p][o]
                })
        })
    }

    fn finish(&mut self) -> bool {
        if self.action.order() == 1 {
            let hex = &self.cover.hex;
            let is_new = |&&[i, j]: &&[usize; 2]| self.state.body_row(hex[i]) >> hex[j] & 1 == 1;
            let edges = EDGES.iter().filter(is_new).count() as i32;
            if edges - i32::from(self.cover.n_orbits) > self.allowance.excess {
                return true;
            }
        }
        self.state.glue(&self.cover.hex).is_none() || (self.visit)(&self.cover)
    }
}

/// Places a cover and its images under the group. `None` if two of them do not go together; the caller must then undo. Else the number of
/// quads that the first hex made: they come first among the new ones, and every new open quad is an image of one of them.
pub(crate) fn place_orbit(state: &mut State, action: &mut Action, cover: &Cover) -> Option<usize> {
    let colour_of = |state: &State, i: usize| {
        let near = cover.hex[0];
        (state.coloured >> near & 1 == 1) != (DISTANCE[i][0] % 2 == 1)
    };
    for &s in &cover.stabilizers[..usize::from(cover.n_orbits)] {
        let first = state.n();
        let corner = cover.hex.iter().position(|&v| usize::from(v) == first)?;
        let colour = colour_of(state, corner);
        action.extend(first, usize::from(s), |_, other| state.add_vertex(colour != other));
    }
    let (mut made, before) = (0, state.hexes.len());
    for g in 0..action.order() {
        let mut hex = cover.hex.map(|v| action.image(g, v));
        if action.reflects(g) {
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
