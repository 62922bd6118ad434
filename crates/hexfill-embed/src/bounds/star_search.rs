//! The best a vertex star can do when several of its edges are free: branch and bound over directions.
//!
//! Unknown are the unit directions of the free edges at one vertex ([`Directions`]). A node of the search gives every free direction a piece of the sphere with a centre `c` and a chord radius `r`. For any weights `w >= 0` with sum 1 the least corner is at most the weighted sum, hence at most
//!
//! `sum w value + sum_j (max g_j . u - g_j . c_j) + sum_jk |p_jk| r_j r_k + sum_jkl |q_jkl| r_j r_k r_l`
//!
//! with `g`, `p`, `q` the weighted coefficients; the maximum over a spherical cap has a closed form. This holds whatever the weights are; good ones
//! are the multipliers of a small linear program. The error is of second order in the radii, so the search converges fast, and the largest bound of the open nodes is
//! an upper bound of the star whenever one stops (up to rounding of some 1e-14).
//!
//! Source: ours; branch and bound with Lagrange multipliers as weights.

use super::sphere_piece::Piece;
use super::star_directions::Directions;
use super::star_program::{Order, solve};
use hexfill_geometry::{Ray, Vector, add_scaled, cross, det, dot, norm};
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// What is known of a star: no placement is better than `bound`, one reaches `attained`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Interval {
    pub(super) attained: f64,
    pub(super) bound: f64,
}

/// The gap at which a star counts as settled.
pub(super) const SETTLED: f64 = 1e-6;

/// Branch and bound from a known value, over at most `nodes` nodes, or until no placement can be better than `enough`
/// or one is.
pub(super) fn search(star: &Directions, known: f64, enough: f64, nodes: usize) -> Interval {
    let mut attained = known;
    let mut heap = BinaryHeap::new();
    let mut made = 0;
    let mut consider = |pieces: Vec<Piece>, limit: f64, attained: &mut f64, heap: &mut BinaryHeap<Node>| {
        // No answer of the linear program is no proof: the node keeps the bound of its parent and stays open.
        let Some(relaxed) = relax(star, &pieces) else {
            heap.push(Node { bound: limit, split: 0, pieces, number: made });
            made += 1;
            return;
        };
        *attained = attained.max(relaxed.attained);
        // What bounds a piece of the sphere bounds its halves.
        let bound = relaxed.bound.min(limit);
        heap.push(Node { bound, split: relaxed.split, pieces, number: made });
        made += 1;
    };
    consider(vec![Piece::whole(); star.n_free], 1.0, &mut attained, &mut heap);
    for _ in 0..nodes {
        let Some(top) = heap.peek() else { break };
        if top.bound <= attained + SETTLED || attained >= enough {
            break;
        }
        let node = heap.pop().expect("peeked");
        for half in node.pieces[node.split].split() {
            let mut pieces = node.pieces.clone();
            pieces[node.split] = half;
            consider(pieces, node.bound, &mut attained, &mut heap);
        }
    }
    // The largest bound of what is still open holds whenever one stops.
    let bound = heap.peek().map_or(attained, |top| top.bound).max(attained);
    Interval { attained, bound }
}

/// An upper bound over a node, a value attained in it, and the direction to split.
fn relax(star: &Directions, pieces: &[Piece]) -> Option<Relaxed> {
    let step = solve(star, pieces, Order::All)?;
    let total: f64 = step.weights.iter().sum();
    if !(total > 0.0 && total.is_finite()) {
        return None;
    }
    let centres: Vec<Vector> = pieces.iter().map(|p| p.centre).collect();
    let mut bound = 0.0;
    let mut gradient = vec![[0.0; 3]; star.n_free];
    let mut second = vec![[0.0; 3]; star.pairs.len()];
    let mut third = vec![0.0; star.triples.len()];
    for (i, weight) in step.weights.iter().enumerate() {
        // Any weights give a bound, so those of a program solved in floating point will do; good ones make it small.
        let w = weight / total;
        let columns = star.columns(i, &centres);
        bound += w * det(columns[0], columns[1], columns[2]);
        for (k, ray) in star.corners[i].iter().enumerate() {
            if let Ray::Free(j) = *ray {
                gradient[j] = add_scaled(gradient[j], w, cross(columns[(k + 1) % 3], columns[(k + 2) % 3]));
            }
        }
        let (pairs, triple) = star.higher(i, &centres);
        for (at, c) in pairs {
            second[at] = add_scaled(second[at], w, c);
        }
        if let Some((at, sign)) = triple {
            third[at] += w * sign;
        }
    }
    // Where nothing is of second order, the size of the piece is what is left.
    let mut blame: Vec<f64> =
        pieces.iter().zip(&gradient).map(|(p, g)| 1e-6 * norm(*g) * p.radius * p.radius).collect();
    for (j, piece) in pieces.iter().enumerate() {
        bound += piece.most(gradient[j]) - dot(gradient[j], piece.centre);
    }
    for (&[j, k], c) in star.pairs.iter().zip(&second) {
        let term = norm(*c) * pieces[j].radius * pieces[k].radius;
        bound += term;
        blame[j] += term * pieces[j].radius;
        blame[k] += term * pieces[k].radius;
    }
    for (triple, c) in star.triples.iter().zip(&third) {
        let term = c.abs() * triple.iter().map(|&j| pieces[j].radius).product::<f64>();
        bound += term;
        for &j in triple {
            blame[j] += term * pieces[j].radius;
        }
    }
    // The piece that the error of the bound owes most to: halving another one would gain little.
    let mut split = 0;
    for j in 1..star.n_free {
        if blame[j] > blame[split] {
            split = j;
        }
    }
    // Rounding: sums of some ten terms of size one.
    Some(Relaxed { bound: bound + 1e-14, attained: star.worst(&step.directions), split })
}

struct Relaxed {
    bound: f64,
    attained: f64,
    split: usize,
}

/// An open node; the heap gives the largest bound first, then the oldest.
struct Node {
    bound: f64,
    split: usize,
    pieces: Vec<Piece>,
    number: usize,
}

impl PartialEq for Node {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Node {}

impl PartialOrd for Node {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Node {
    fn cmp(&self, other: &Self) -> Ordering {
        self.bound.total_cmp(&other.bound).then(other.number.cmp(&self.number))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::star_climb::{climb, relaxed};
    use hexfill_geometry::{add, scale, unit};
    use hexfill_mesh::Random;

    fn sample(star: &Directions, random: &mut Random, n: usize) -> f64 {
        (0..n)
            .map(|_| {
                let u: Vec<Vector> = (0..star.n_free)
                    .map(|_| unit([random.signed(), random.signed(), random.signed()]).unwrap_or([1.0, 0.0, 0.0]))
                    .collect();
                star.worst(&u)
            })
            .fold(f64::NEG_INFINITY, f64::max)
    }

    #[test]
    fn node_bounds_hold_at_random_points_of_the_node() {
        let mut random = Random::of_task(40, 0);
        for _ in 0..60 {
            let mut direction = || unit([random.signed(), random.signed(), random.signed()]).unwrap_or([1.0, 0.0, 0.0]);
            let (a, b, c) = (direction(), direction(), direction());
            let star = Directions::new(
                vec![
                    [Ray::Fixed(a), Ray::Free(0), Ray::Free(1)],
                    [Ray::Fixed(b), Ray::Free(1), Ray::Free(2)],
                    [Ray::Free(0), Ray::Free(1), Ray::Free(2)],
                    [Ray::Fixed(c), Ray::Fixed(a), Ray::Free(2)],
                ],
                3,
            );
            let mut pieces = vec![Piece::whole(); 3];
            for depth in 0..random_depth(&mut random) {
                let halves = pieces[depth % 3].split();
                pieces[depth % 3] = halves[(random.unit() * halves.len() as f64) as usize];
            }
            let bound = relax(&star, &pieces).unwrap().bound;
            for _ in 0..300 {
                let u: Vec<Vector> = pieces
                    .iter()
                    .map(|p| {
                        if p.is_whole() {
                            return unit([random.signed(), random.signed(), random.signed()])
                                .unwrap_or([1.0, 0.0, 0.0]);
                        }
                        let [x, y, z] = [random.unit(), random.unit(), random.unit()];
                        let [a, b, c] = p.triangle;
                        unit(add(scale(x, a), add(scale(y, b), scale(z, c)))).unwrap_or(a)
                    })
                    .collect();
                assert!(star.worst(&u) <= bound + 1e-12, "{} {bound}", star.worst(&u));
            }
        }
    }

    fn random_depth(random: &mut Random) -> usize {
        (random.unit() * 12.0) as usize
    }

    #[test]
    fn a_fan_round_a_free_edge_pair_is_settled() {
        // The corner of a cube with a free edge in each coordinate plane pair: one free direction, twice over.
        let x = [1.0, 0.0, 0.0];
        let (y, z) = ([0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
        // The octant cut in four: an inner triangle is impossible here, so three corners round one free edge and a second
        // free edge inside one of them.
        let star = Directions::new(
            vec![
                [Ray::Fixed(x), Ray::Fixed(y), Ray::Free(0)],
                [Ray::Fixed(y), Ray::Fixed(z), Ray::Free(0)],
                [Ray::Fixed(z), Ray::Fixed(x), Ray::Free(1)],
                [Ray::Fixed(z), Ray::Free(1), Ray::Free(0)],
                [Ray::Free(1), Ray::Fixed(x), Ray::Free(0)],
            ],
            2,
        );
        let (attained, _) = climb(&star, &relaxed(&star), 1.0);
        let found = search(&star, attained, 1.0, 4000);
        assert!(found.bound - found.attained < 0.03, "{found:?}");
        let mut random = Random::of_task(41, 0);
        let sampled = sample(&star, &mut random, 30_000);
        assert!(sampled <= found.bound && found.attained > sampled - 1e-9, "{sampled} {found:?}");
    }

    #[test]
    fn a_star_that_cannot_be_positive_is_known_as_such() {
        // Two free edges, and corners of opposite handedness on the same three rays.
        let x = [1.0, 0.0, 0.0];
        let star = Directions::new(
            vec![
                [Ray::Fixed(x), Ray::Free(0), Ray::Free(1)],
                [Ray::Fixed([0.8, 0.6, 0.0]), Ray::Free(1), Ray::Free(0)],
                [Ray::Fixed([0.8, -0.6, 0.0]), Ray::Free(1), Ray::Free(0)],
            ],
            2,
        );
        let (attained, _) = climb(&star, &relaxed(&star), 1.0);
        let found = search(&star, attained, 1.0, 4000);
        assert!(attained.abs() < 1e-9 && found.bound < 1e-3, "{found:?}");
    }
}
