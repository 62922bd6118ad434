//! How few hexes can finish a state: Euler's formula and counts of the hexes round edges and vertices.
//!
//! Let K hexes, n vertices, m edges be still to come, and C = V - E + Q - H - 1 - F/2 of what is there, F open quads. A ball has Euler
//! characteristic 1 and every hex six facets, so m = n + 2K + C. Three lower bounds:
//! * every new edge is in at least three hexes: 12 K >= w + 3 m, where w sums over the open edges how many hexes must still come round
//!   each: one if a single hex can cover the two open quads there (pair table), else two;
//! * every new vertex has at least four edges, and an old vertex gets at least `a` new ones: 2 m >= 4 n + sum of a;
//! * n >= 0.
//!
//! The link of an open vertex is to be closed by a disk of triangles, one a hex, whose rim has one side for each open quad there. Only a
//! triangle that *is* the disk has single hexes at neighbouring open edges; else those edges are ears, no two of them neighbours. A disk
//! without an inner vertex has two ears or is that triangle. That bounds the number of single edges from above, and `a` from below.
//!
//! Source: ours; Euler's formula.

use crate::state::State;

/// Most new vertices that can come with at most `left` hexes; `None` if the state cannot be finished with so few.
pub(crate) fn most_new_vertices(state: &State, left: i32) -> Option<i32> {
    let c = euler_rest(state);
    let fans = Fans::of(state);
    let ones = fans.most_singles / 2;
    let wedges = 2 * fans.regular_edges - ones + fans.irregular_darts / 2;
    // 2 m >= 4 n + a with m = n + 2 K + C, solved for n.
    let by_vertices = (2 * (2 * left + c) - fans.new_edges).div_euclid(2);
    // 12 K >= w + 3 m with the same m, solved for n.
    let by_edges = (6 * left - 3 * c - wedges).div_euclid(3);
    let most = by_vertices.min(by_edges);
    (most >= 0).then_some(most)
}

/// C of the module page.
pub(crate) fn euler_rest(state: &State) -> i32 {
    let c = state.counts;
    c.vertices - c.edges + c.quads - c.hexes - 1 - c.open / 2
}

/// Sums over the fans of open quads round the vertices of the front.
#[derive(Default)]
struct Fans {
    /// Edges with two open quads.
    regular_edges: i32,
    /// Darts of edges with more.
    irregular_darts: i32,
    /// Twice the most edges at which one hex can cover both open quads.
    most_singles: i32,
    /// Fewest new edges that old vertices get.
    new_edges: i32,
}

/// A bit for each dart.
struct Darts([u64; 64]);

impl Darts {
    fn has(&self, d: u16) -> bool {
        self.0[usize::from(d) / 64] >> (d % 64) & 1 == 1
    }

    fn add(&mut self, d: u16) {
        self.0[usize::from(d) / 64] |= 1 << (d % 64);
    }
}

impl Fans {
    fn of(state: &State) -> Self {
        let mut fans = Self::default();
        let mut single = Darts([0; 64]);
        for q in state.open_quads() {
            let quad = state.quad(q);
            for k in 0..4u16 {
                let (d, u, v) = (4 * q + k, quad[usize::from(k)], quad[usize::from((k + 1) % 4)]);
                if state.open_at_edge(u, v) != 2 {
                    fans.irregular_darts += 1;
                    continue;
                }
                let t = state.twin(d);
                if d < t {
                    fans.regular_edges += 1;
                    if one_hex_can_cover(state, d, t) {
                        single.add(d);
                        single.add(t);
                    }
                }
            }
        }
        // A vertex may have several fans while hexes round it are missing: each is a rim of its own.
        let mut seen = Darts([0; 64]);
        for q in state.open_quads() {
            for d in 4 * q..4 * q + 4 {
                if !seen.has(d) {
                    fans.round(state, d, &single, &mut seen);
                }
            }
        }
        fans
    }

    /// The fan of open quads whose darts leave a vertex, from dart `first` on.
    fn round(&mut self, state: &State, first: u16, single: &Darts, seen: &mut Darts) {
        let vertex = state.quad(first / 4)[usize::from(first % 4)];
        // Length, singles in all, and the largest set of singles no two of which are neighbours.
        // Round a circle, so the run of singles at the beginning is joined with the one at the end: kept apart until
        // the round is done.
        let (mut length, mut singles, mut apart) = (0, 0, 0);
        let (mut run, mut first_run, mut regular) = (0, None, true);
        let mut d = first;
        loop {
            seen.add(d);
            length += 1;
            let end = state.quad(d / 4)[usize::from((d + 1) % 4)];
            regular &= state.open_at_edge(vertex, end) == 2;
            if single.has(d) {
                singles += 1;
                run += 1;
            } else if first_run.is_none() {
                first_run = Some(run);
                run = 0;
            } else {
                apart += (run + 1) / 2;
                run = 0;
            }
            let back = 4 * (d / 4) + (d + 3) % 4;
            d = state.twin(back);
            if d == first {
                break;
            }
        }
        apart += match first_run {
            None => length / 2,
            Some(before) => (before + run + 1) / 2,
        };
        let corners = state.corners(usize::from(vertex));
        if !regular || length != corners || state.link_defect(usize::from(vertex)) != -1 {
            self.most_singles += singles;
        } else if length == 3 {
            self.most_singles += if singles == 3 { 3 } else { 0 };
            self.new_edges += i32::from(singles < 3);
        } else {
            self.most_singles += apart;
            self.new_edges += i32::from(apart < 2);
        }
    }
}

/// Whether the pair table lets one hex cover the two open quads of an edge, `d` and `t` being their darts there.
fn one_hex_can_cover(state: &State, d: u16, t: u16) -> bool {
    let corner = |dart: u16, k: u16| state.quad(dart / 4)[usize::from((dart + k) % 4)];
    // Quads u v x y and v u p q: in the hex, y and p are neighbours of u, x and q of v.
    let (u, v, x, y) = (corner(d, 0), corner(d, 1), corner(d, 2), corner(d, 3));
    let (p, q) = (corner(t, 2), corner(t, 3));
    state.body_row(y) >> q & 1 == 1
        && state.body_row(x) >> p & 1 == 1
        && !state.blocks_facet(y, p, u)
        && !state.blocks_facet(x, q, v)
}
