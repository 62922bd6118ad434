//! Every hex that can cover an open quad: its four far vertices are old ones or new, each pair allowed by the pair table.
//!
//! New vertices are interchangeable, so only the next unused id is tried. Under a symmetry a new vertex comes with its whole orbit, one
//! try for each stabilizer it may have; the other vertices of the orbit are then old ones for the corners still to be chosen.

use crate::state::{Glue, Hex, MAX_VERTICES, State};
use crate::symmetry::{Action, MAX_ORDER};
use hexfill_mesh::cube::{FACETS, POSITIONS};
use std::sync::OnceLock;

/// The corners above the covered quad, in the order they are chosen.
const FAR: [usize; 4] = [4, 7, 6, 5];
const NEAR: [usize; 4] = [0, 3, 2, 1];
const BLANK: u128 = 1 << (MAX_VERTICES - 1);

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

/// Per far corner the diagonals, chosen before, of facets that lack only that corner.
const ACROSS: [&[[usize; 2]]; 4] = [&[], &[[3, 4]], &[[2, 7]], &[[1, 6], [1, 4], [4, 6]]];

/// Per set of corners the smallest face of the cube that holds it.
const HULL: [u8; 256] = {
    let mut table = [0; 256];
    let mut set = 1usize;
    while set < 256 {
        // Coordinates on which all corners of the set agree stay fixed.
        let (mut all, mut any, mut i) = ([1u8; 3], [0u8; 3], 0);
        while i < 8 {
            if set >> i & 1 == 1 {
                let mut axis = 0;
                while axis < 3 {
                    all[axis] &= POSITIONS[i][axis];
                    any[axis] |= POSITIONS[i][axis];
                    axis += 1;
                }
            }
            i += 1;
        }
        i = 0;
        while i < 8 {
            let (mut inside, mut axis) = (true, 0);
            while axis < 3 {
                inside &= POSITIONS[i][axis] >= all[axis] && POSITIONS[i][axis] <= any[axis];
                axis += 1;
            }
            table[set] |= (inside as u8) << i;
            i += 1;
        }
        set += 1;
    }
    table
};

/// Per far corner `i`, `j`, `k` of one facet, `i` and `j` opposite: where the last of the three is chosen at that corner.
fn facet_triples() -> &'static [Vec<[usize; 3]>; 4] {
    static TABLE: OnceLock<[Vec<[usize; 3]>; 4]> = OnceLock::new();
    TABLE.get_or_init(|| {
        std::array::from_fn(|depth| {
            let later = |i: usize| FAR[depth + 1..].contains(&i);
            let mut out = Vec::new();
            for facet in FACETS {
                for (k, corner) in facet.into_iter().enumerate() {
                    let (i, j) = (facet[(k + 1) % 4], facet[(k + 3) % 4]);
                    let triple = [i, j, corner];
                    if triple.contains(&FAR[depth]) && !triple.into_iter().any(later) {
                        out.push(triple);
                    }
                }
            }
            out
        })
    })
}

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
    /// Most new edges less new vertices, of the hex and its images.
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
    /// Number of new edges of the hex so far.
    fresh: i32,
    /// Per far corner chosen and element: the corners chosen whose vertices are also in that image of the hex.
    shared: [[u8; MAX_ORDER]; 5],
    triples: &'static [Vec<[usize; 3]>; 4],
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
        fresh: 0,
        shared: [[0; MAX_ORDER]; 5],
        triples: facet_triples(),
        visit,
    };
    for i in NEAR {
        search.place[usize::from(hex[i])] = i as u8 + 1;
    }
    for g in 1..search.action.order() {
        for i in NEAR {
            let here = search.place[usize::from(search.action.image(g, hex[i]))] > 0;
            search.shared[0][g] |= u8::from(here) << i;
        }
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
        // A ball's mesh is bipartite as its boundary is, so a corner's colour follows from its distance to the quad:
        // half of the vertices are out at once.
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
        // The last id is never used: it stands for a vertex not made yet.
        set &= BLANK | if colour { self.coloured } else { !self.coloured };
        for &[i, j] in ACROSS[depth] {
            set &= self.state.fourth(self.cover.hex[i], self.cover.hex[j]);
        }
        // Elements whose image of the hex must share this corner too.
        let sharing = if depth == 3 { self.restrict_last(&mut set) } else { 0 };
        // What is left of the set goes with every corner chosen so far, pair by pair; whole facets are looked at in
        // `put`.
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
            if set & BLANK == 0 {
                break;
            }
            // An image that must have this corner too has it only if it fixes the new vertex.
            if sharing & !self.action.stabilizer(s) != 0 {
                continue;
            }
            let size = self.action.orbit_size(s);
            let made = (n + size) as i32 - self.state.counts.vertices;
            // More vertices than Euler's formula and the hexes left allow: no completion exists.
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

    /// What symmetry leaves for the last corner: takes the rest out of `set`, and returns the elements that must fix a new vertex there.
    fn restrict_last(&self, set: &mut u128) -> u64 {
        let p = FAR[3];
        let mut sharing = 0;
        for g in 1..self.action.order() {
            let shared = self.shared[3][g];
            let missing = HULL[usize::from(shared)] & !shared;
            let others = missing & !(1 << p);
            if others != 0 {
                // The corner missed must have its image here.
                *set &= 1 << self.action.image(g, self.cover.hex[others.trailing_zeros() as usize]);
            }
            if missing >> p & 1 == 1 {
                sharing |= 1 << g;
                let back = self.action.inverse(g);
                let mut images = !((1u128 << self.n) - 1);
                for o in Self::chosen(2) {
                    images |= 1 << self.action.image(back, self.cover.hex[o]);
                }
                *set &= images | self.action.fixed(g);
            }
        }
        sharing
    }

    /// Puts a vertex at far corner number `depth` and goes on.
    fn put(&mut self, depth: usize, v: u8) -> bool {
        let p = FAR[depth];
        self.cover.hex[p] = v;
        let facets_fit = self.triples[depth].iter().all(|&[i, j, corner]| {
            let [a, b, c] = [i, j, corner].map(|i| self.cover.hex[i]);
            !self.state.blocks_facet(a, b, c)
        });
        if !facets_fit {
            return true;
        }
        self.place[usize::from(v)] = p as u8 + 1;
        let fresh = self.fresh;
        let go_on = !self.agrees(depth) || !self.edges_fit(depth) || self.choose(depth + 1);
        self.fresh = fresh;
        self.place[usize::from(v)] = 0;
        go_on
    }

    /// Corners chosen up to far corner number `depth`.
    fn chosen(depth: usize) -> impl Iterator<Item = usize> {
        NEAR.into_iter().chain(FAR.into_iter().take(depth + 1))
    }

    /// Whether the hex so far and each of its images can share nothing, a vertex, an edge, a facet or all of it, and agree there.
    fn agrees(&mut self, depth: usize) -> bool {
        let (p, order) = (FAR[depth], self.action.order());
        let v = self.cover.hex[p];
        let chosen = Self::chosen(depth).fold(0u8, |set, o| set | 1 << o);
        let (before, after) = self.shared.split_at_mut(depth + 1);
        let shared = &mut after[0];
        shared[..order].copy_from_slice(&before[depth][..order]);
        for g in 1..order {
            let at = usize::from(self.place[usize::from(self.action.image(g, v))]);
            if at == 0 {
                continue;
            }
            shared[g] |= 1 << p;
            shared[self.action.inverse(g)] |= 1 << (at - 1);
            for o in Self::chosen(depth) {
                let other = usize::from(self.place[usize::from(self.action.image(g, self.cover.hex[o]))]);
                if other > 0 && DISTANCE[at - 1][other - 1] != DISTANCE[p][o] {
                    return false;
                }
            }
        }
        // What is missing to a face of the cube can only come with the corners still to be chosen.
        shared[1..order].iter().all(|&set| (HULL[usize::from(set)] & !set & chosen).count_ones() as usize <= 3 - depth)
    }

    /// Counts the new edges at far corner number `depth`. `false` if those of the hex and its images are too many: the edges still to come
    /// outnumber the vertices still to come.
    fn edges_fit(&mut self, depth: usize) -> bool {
        let is_fresh = |s: &Self, p: usize, o: usize| {
            DISTANCE[p][o] == 1 && s.state.body_row(s.cover.hex[p]) >> s.cover.hex[o] & 1 == 1
        };
        let p = FAR[depth];
        self.fresh += Self::chosen(depth).filter(|&o| is_fresh(self, p, o)).count() as i32;
        let most = self.allowance.excess + self.n as i32 - self.state.counts.vertices;
        let order = self.action.order();
        if self.fresh * order as i32 <= most || order == 1 {
            return self.fresh <= most;
        }
        let mut edges = [0u16; 12 * MAX_ORDER];
        let mut n = 0;
        for (d, far) in FAR.into_iter().enumerate().take(depth + 1) {
            for o in Self::chosen(d).filter(|&o| is_fresh(self, far, o)) {
                for g in 0..order {
                    let [x, y] = [far, o].map(|i| self.action.image(g, self.cover.hex[i]));
                    let edge = u16::from(x.min(y)) << 8 | u16::from(x.max(y));
                    if !edges[..n].contains(&edge) {
                        edges[n] = edge;
                        n += 1;
                    }
                }
            }
        }
        n as i32 <= most
    }

    fn finish(&mut self) -> bool {
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
