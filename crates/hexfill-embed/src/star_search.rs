//! The best a vertex star can do when several of its edges are free: branch and bound over directions.
//!
//! Unknown are the unit directions of the free edges at one vertex. Every corner is the determinant of three directions, linear in
//! each of them. A node of the search gives every free direction a piece of the sphere with a centre `c` and a chord radius `r`. With
//! `u = c + d` a determinant is its value at the centres, plus a part linear in the `d`, plus `p . (d_j x d_k)` for each pair of free
//! directions in it, plus the determinant of three `d`. For any weights `w >= 0` with sum 1 the least corner is at most the weighted sum, hence at most
//!
//! `sum w value + sum_j (max g_j . u - g_j . c_j) + sum_jk |p_jk| r_j r_k + sum_jkl |q_jkl| r_j r_k r_l`
//!
//! with `g`, `p`, `q` the weighted coefficients; the maximum over a spherical cap has a closed form. This holds whatever the weights are; good ones
//! are the multipliers of a small linear program. The error is of second order in the radii, so the search converges fast, and the largest bound of the open nodes is
//! an upper bound of the star whenever one stops (up to rounding of some 1e-14). Pieces are spherical triangles, halved at their longest side.

use crate::program::Program;
use crate::vector::{Vector, add, add_scaled, cross, det, dot, midpoint, norm, scale, sub, unit};
use hexfill_geometry::Ray;
use hexfill_mesh::Random;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Corners as triples of rays, right-handed.
#[derive(Clone, Debug)]
pub(crate) struct Directions {
    corners: Vec<[Ray; 3]>,
    n_free: usize,
    /// The pairs and triples of free rays that occur in corners, ascending.
    pairs: Vec<[usize; 2]>,
    triples: Vec<[usize; 3]>,
}

/// What is known of a star: no placement is better than `bound`, one reaches `attained`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Interval {
    pub(crate) attained: f64,
    pub(crate) bound: f64,
}

/// The gap at which a star counts as settled.
pub(crate) const SETTLED: f64 = 1e-6;

impl Directions {
    /// The corners of a star with this many free rays.
    pub(crate) fn new(corners: Vec<[Ray; 3]>, n_free: usize) -> Self {
        let (mut pairs, mut triples) = (Vec::new(), Vec::new());
        for corner in &corners {
            let mut free: Vec<usize> =
                corner.iter().filter_map(|ray| if let Ray::Free(j) = *ray { Some(j) } else { None }).collect();
            free.sort_unstable();
            match free[..] {
                [a, b] => pairs.push([a, b]),
                [a, b, c] => {
                    pairs.extend([[a, b], [a, c], [b, c]]);
                    triples.push([a, b, c]);
                }
                _ => {}
            }
        }
        pairs.sort_unstable();
        pairs.dedup();
        triples.sort_unstable();
        triples.dedup();
        Self { corners, n_free, pairs, triples }
    }

    fn columns(&self, corner: usize, u: &[Vector]) -> [Vector; 3] {
        self.corners[corner].map(|ray| match ray {
            Ray::Fixed(d) => d,
            Ray::Free(j) => u[j],
        })
    }

    /// The worst corner at the directions `u`.
    pub(crate) fn worst(&self, u: &[Vector]) -> f64 {
        (0..self.corners.len())
            .map(|i| {
                let [a, b, c] = self.columns(i, u);
                det(a, b, c)
            })
            .fold(f64::INFINITY, f64::min)
    }

    /// Climbs from `hint` and some other directions until `enough` is reached or nothing gets better. Returns the best.
    pub(crate) fn climb(&self, hint: &[Vector], enough: f64) -> (f64, Vec<Vector>) {
        let mut random = Random::of_task(17, self.corners.len() as u64);
        let mut best = (f64::NEG_INFINITY, hint.to_vec());
        for attempt in 0..6 {
            let mut u = match attempt {
                0 => hint.to_vec(),
                1 => self.relaxed(),
                _ => (0..self.n_free)
                    .map(|_| unit([random.signed(), random.signed(), random.signed()]).unwrap_or([1.0, 0.0, 0.0]))
                    .collect(),
            };
            let mut value = self.worst(&u);
            let mut radius: f64 = 0.5;
            for _ in 0..60 {
                if value >= enough || radius < 1e-8 {
                    break;
                }
                let cells: Vec<Piece> = u.iter().map(|&centre| Piece::around(centre, radius)).collect();
                let Some(step) = self.program(&cells, false) else { break };
                let reached = self.worst(&step.directions);
                if reached > value {
                    if reached - value < 1e-9 {
                        radius *= 0.1;
                    }
                    (value, u) = (reached, step.directions);
                    radius = (1.5 * radius).min(0.7);
                } else {
                    radius *= 0.3;
                }
            }
            if value > best.0 {
                best = (value, u);
            }
            if best.0 >= enough {
                break;
            }
        }
        best
    }

    /// Every free direction at the mean of the directions it shares corners with.
    fn relaxed(&self) -> Vec<Vector> {
        let mut u = vec![[0.0; 3]; self.n_free];
        for _ in 0..20 {
            let mut sums = vec![[0.0; 3]; self.n_free];
            for corner in 0..self.corners.len() {
                let columns = self.columns(corner, &u);
                for (k, ray) in self.corners[corner].iter().enumerate() {
                    if let Ray::Free(j) = *ray {
                        sums[j] = add(sums[j], add(columns[(k + 1) % 3], columns[(k + 2) % 3]));
                    }
                }
            }
            u = sums.into_iter().map(|s| unit(s).unwrap_or([0.0; 3])).collect();
        }
        u.into_iter().map(|d| unit(d).unwrap_or([0.0, 0.0, 1.0])).collect()
    }

    /// Branch and bound from a known value, over at most `nodes` nodes, or until no placement can be better than `enough`
    /// or one is.
    pub(crate) fn search(&self, known: f64, enough: f64, nodes: usize) -> Interval {
        let mut attained = known;
        let mut heap = BinaryHeap::new();
        let mut made = 0;
        let mut consider = |pieces: Vec<Piece>, limit: f64, attained: &mut f64, heap: &mut BinaryHeap<Node>| {
            let Some(relaxed) = self.relax(&pieces) else {
                heap.push(Node { bound: limit, split: 0, pieces, number: made });
                made += 1;
                return;
            };
            *attained = attained.max(relaxed.attained);
            let bound = relaxed.bound.min(limit);
            heap.push(Node { bound, split: relaxed.split, pieces, number: made });
            made += 1;
        };
        consider(vec![Piece::whole(); self.n_free], 1.0, &mut attained, &mut heap);
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
        let bound = heap.peek().map_or(attained, |top| top.bound).max(attained);
        Interval { attained, bound }
    }

    /// The terms of second and third order of a corner, each with the index of its pair or triple.
    fn higher(&self, corner: usize, centres: &[Vector]) -> Higher {
        let rays = self.corners[corner];
        let columns = self.columns(corner, centres);
        let mut pairs = Vec::new();
        let mut free = Vec::with_capacity(3);
        for k in 0..3 {
            if let Ray::Free(j) = rays[k] {
                free.push(j);
                if let Ray::Free(l) = rays[(k + 1) % 3] {
                    let sign = if j < l { 1.0 } else { -1.0 };
                    pairs.push((self.pair(j.min(l), j.max(l)), scale(sign, columns[(k + 2) % 3])));
                }
            }
        }
        let triple = (free.len() == 3).then(|| {
            let [a, b, c] = [free[0], free[1], free[2]];
            // Even permutations of an ascending triple have one descent, cyclically.
            let descents = usize::from(a > b) + usize::from(b > c) + usize::from(c > a);
            let mut sorted = [a, b, c];
            sorted.sort_unstable();
            let at = self.triples.binary_search(&sorted).expect("listed");
            (at, if descents == 1 { 1.0 } else { -1.0 })
        });
        (pairs, triple)
    }

    fn pair(&self, j: usize, k: usize) -> usize {
        self.pairs.binary_search(&[j, k]).expect("listed")
    }

    /// An upper bound over a node, a value attained in it, and the direction to split.
    fn relax(&self, pieces: &[Piece]) -> Option<Relaxed> {
        let step = self.program(pieces, true)?;
        let total: f64 = step.weights.iter().sum();
        if !(total > 0.0 && total.is_finite()) {
            return None;
        }
        let centres: Vec<Vector> = pieces.iter().map(|p| p.centre).collect();
        let mut bound = 0.0;
        let mut gradient = vec![[0.0; 3]; self.n_free];
        let mut second = vec![[0.0; 3]; self.pairs.len()];
        let mut third = vec![0.0; self.triples.len()];
        for (i, weight) in step.weights.iter().enumerate() {
            let w = weight / total;
            let columns = self.columns(i, &centres);
            bound += w * det(columns[0], columns[1], columns[2]);
            for (k, ray) in self.corners[i].iter().enumerate() {
                if let Ray::Free(j) = *ray {
                    gradient[j] = add_scaled(gradient[j], w, cross(columns[(k + 1) % 3], columns[(k + 2) % 3]));
                }
            }
            let (pairs, triple) = self.higher(i, &centres);
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
        for (&[j, k], c) in self.pairs.iter().zip(&second) {
            let term = norm(*c) * pieces[j].radius * pieces[k].radius;
            bound += term;
            blame[j] += term * pieces[j].radius;
            blame[k] += term * pieces[k].radius;
        }
        for (triple, c) in self.triples.iter().zip(&third) {
            let term = c.abs() * triple.iter().map(|&j| pieces[j].radius).product::<f64>();
            bound += term;
            for &j in triple {
                blame[j] += term * pieces[j].radius;
            }
        }
        let mut split = 0;
        for j in 1..self.n_free {
            if blame[j] > blame[split] {
                split = j;
            }
        }
        // Rounding: sums of some ten terms of size one.
        Some(Relaxed { bound: bound + 1e-14, attained: self.worst(&step.directions), split })
    }

    /// Maximises t with `t <= value + gradient . d (+ terms of higher order)` for every corner, `d` within the pieces (as boxes
    /// round the caps). The products `d_j x d_k` are variables of their own, as large as the radii allow.
    fn program(&self, pieces: &[Piece], higher: bool) -> Option<Step> {
        let first_pair = 3 * self.n_free;
        let first_triple = first_pair + if higher { 3 * self.pairs.len() } else { 0 };
        let t = first_triple + if higher { self.triples.len() } else { 0 };
        let mut cost = vec![0.0; t + 1];
        cost[t] = -1.0;
        let mut program = Program::new(cost);
        let frames: Vec<[Vector; 3]> = pieces.iter().map(Piece::frame).collect();
        let centres: Vec<Vector> = pieces.iter().map(|p| p.centre).collect();
        for i in 0..self.corners.len() {
            let columns = self.columns(i, &centres);
            let mut row = Vec::with_capacity(20);
            for (k, ray) in self.corners[i].iter().enumerate() {
                if let Ray::Free(j) = *ray {
                    let g = cross(columns[(k + 1) % 3], columns[(k + 2) % 3]);
                    row.extend((0..3).map(|x| (3 * j + x, -dot(g, frames[j][x]))).filter(|&(_, v)| v != 0.0));
                }
            }
            if higher {
                let (pairs, triple) = self.higher(i, &centres);
                for (at, c) in pairs {
                    row.extend((0..3).map(|x| (first_pair + 3 * at + x, -c[x])).filter(|&(_, v)| v != 0.0));
                }
                row.extend(triple.map(|(at, sign)| (first_triple + at, -sign)));
            }
            row.push((t, 1.0));
            program.row(row, det(columns[0], columns[1], columns[2]));
        }
        let n_rows = program.n_rows();
        for (j, piece) in pieces.iter().enumerate() {
            let inward = if piece.is_whole() { piece.radius } else { 0.5 * piece.radius * piece.radius };
            for (x, (low, high)) in [
                (piece.radius, piece.radius),
                (piece.radius, piece.radius),
                (inward, if piece.is_whole() { inward } else { 0.0 }),
            ]
            .into_iter()
            .enumerate()
            {
                program.row([(3 * j + x, 1.0)], high);
                program.row([(3 * j + x, -1.0)], low);
            }
        }
        if higher {
            for (n, &[j, k]) in self.pairs.iter().enumerate() {
                let most = pieces[j].radius * pieces[k].radius;
                for x in 0..3 {
                    program.row([(first_pair + 3 * n + x, 1.0)], most);
                    program.row([(first_pair + 3 * n + x, -1.0)], most);
                }
            }
            for (n, triple) in self.triples.iter().enumerate() {
                let most = triple.iter().map(|&j| pieces[j].radius).product();
                program.row([(first_triple + n, 1.0)], most);
                program.row([(first_triple + n, -1.0)], most);
            }
        }
        let solution = program.solve()?;
        let directions = (0..self.n_free)
            .map(|j| {
                let mut u = pieces[j].centre;
                for x in 0..3 {
                    u = add_scaled(u, solution.point[3 * j + x], frames[j][x]);
                }
                unit(u).unwrap_or([0.0, 0.0, 1.0])
            })
            .collect();
        let weights = solution.multipliers[..n_rows].iter().map(|m| m.max(0.0)).collect();
        Some(Step { directions, weights })
    }
}

/// Terms of second order by pair, and of third by triple, of one corner.
type Higher = (Vec<(usize, Vector)>, Option<(usize, f64)>);

struct Step {
    directions: Vec<Vector>,
    weights: Vec<f64>,
}

struct Relaxed {
    bound: f64,
    attained: f64,
    split: usize,
}

/// A piece of the sphere: all of it, or a spherical triangle inside a cap.
#[derive(Clone, Copy, Debug)]
struct Piece {
    /// A unit vector, or the origin for the whole sphere.
    centre: Vector,
    /// No point of the piece is farther from the centre.
    radius: f64,
    triangle: [Vector; 3],
}

impl Piece {
    fn whole() -> Self {
        Self { centre: [0.0; 3], radius: 1.0, triangle: [[0.0; 3]; 3] }
    }

    fn is_whole(&self) -> bool {
        self.centre == [0.0; 3]
    }

    /// A cap as a trust region; it is not split.
    fn around(centre: Vector, radius: f64) -> Self {
        Self { centre, radius, triangle: [centre; 3] }
    }

    fn of_triangle(triangle: [Vector; 3]) -> Self {
        let [a, b, c] = triangle;
        let centre = unit(add(a, add(b, c))).expect("triangles of an octahedron do not degenerate");
        let radius = triangle.iter().map(|&p| norm(sub(p, centre))).fold(0.0, f64::max);
        Self { centre, radius: radius * (1.0 + 1e-14), triangle }
    }

    fn split(&self) -> Vec<Self> {
        if self.is_whole() {
            let mut octants = Vec::with_capacity(8);
            for signs in 0..8 {
                let axis = |k: usize| {
                    let mut p = [0.0; 3];
                    p[k] = if signs >> k & 1 == 1 { 1.0 } else { -1.0 };
                    p
                };
                octants.push(Self::of_triangle([axis(0), axis(1), axis(2)]));
            }
            return octants;
        }
        let t = self.triangle;
        let mut longest = 0;
        let length = |k: usize| norm(sub(t[k], t[(k + 1) % 3]));
        for k in 1..3 {
            // Strictly longer by more than rounding, so that equal sides are taken in order.
            if length(k) > length(longest) * (1.0 + 1e-9) {
                longest = k;
            }
        }
        let (a, b, c) = (t[longest], t[(longest + 1) % 3], t[(longest + 2) % 3]);
        let middle = unit(midpoint(a, b)).expect("sides are shorter than half a circle");
        vec![Self::of_triangle([a, middle, c]), Self::of_triangle([middle, b, c])]
    }

    /// Two tangents and the centre; the axes for the whole sphere.
    fn frame(&self) -> [Vector; 3] {
        let c = self.centre;
        let Some(c) = unit(c) else { return [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] };
        let axis = if c[0].abs() < 0.6 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
        let a = unit(cross(c, axis)).expect("not parallel");
        [a, cross(c, a), c]
    }

    /// The maximum of `g . u` over the cap.
    fn most(&self, g: Vector) -> f64 {
        let length = norm(g);
        if self.is_whole() {
            return length;
        }
        // Chord r, angle a: r = 2 sin(a / 2).
        let cos = 1.0 - 0.5 * self.radius * self.radius;
        let along = dot(g, self.centre);
        if along >= length * cos {
            return length;
        }
        let across = norm(sub(g, scale(along, self.centre)));
        along * cos + across * (1.0 - cos * cos).max(0.0).sqrt()
    }
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
            let bound = star.relax(&pieces).unwrap().bound;
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
        let (attained, _) = star.climb(&star.relaxed(), 1.0);
        let found = star.search(attained, 1.0, 4000);
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
        let (attained, _) = star.climb(&star.relaxed(), 1.0);
        let found = star.search(attained, 1.0, 4000);
        assert!(attained.abs() < 1e-9 && found.bound < 1e-3, "{found:?}");
    }
}
