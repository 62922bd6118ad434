//! The linear program of a star: all free directions at once, each in a piece of the sphere.
//!
//! It maximises t with `t <= value + gradient . d (+ terms of higher order)` for every corner, `d` within the pieces (as boxes
//! round the caps).
//!
//! Source: Madsen 1975; the bounds on terms of higher order are ours.

use super::sphere_piece::Piece;
use super::star_directions::Directions;
use crate::solvers::interior_point::Program;
use hexfill_geometry::{Ray, Vector, add_scaled, cross, det, dot, unit};

/// What a program led to.
pub(super) struct Step {
    pub(super) directions: Vec<Vector>,
    /// The multipliers of the corners, not negative.
    pub(super) weights: Vec<f64>,
}

/// Whether the products `d_j x d_k` and determinants of three d take part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    /// No: the program of a trust region.
    First,
    /// As variables of their own, as large as the radii allow: a relaxation.
    All,
}

/// The numbers of the variables.
struct Layout {
    first_pair: usize,
    first_triple: usize,
    t: usize,
}

/// Solves the program; `None` if the solver gives up.
pub(super) fn solve(star: &Directions, pieces: &[Piece], order: Order) -> Option<Step> {
    let higher = order == Order::All;
    let first_pair = 3 * star.n_free;
    let first_triple = first_pair + if higher { 3 * star.pairs.len() } else { 0 };
    let t = first_triple + if higher { star.triples.len() } else { 0 };
    let layout = Layout { first_pair, first_triple, t };
    let mut cost = vec![0.0; t + 1];
    cost[t] = -1.0;
    let mut program = Program::new(cost);
    let frames: Vec<[Vector; 3]> = pieces.iter().map(Piece::frame).collect();
    let centres: Vec<Vector> = pieces.iter().map(|p| p.centre).collect();
    for corner in 0..star.corners.len() {
        corner_row(star, corner, &centres, &frames, order, &layout, &mut program);
    }
    let n_rows = program.n_rows();
    for (j, piece) in pieces.iter().enumerate() {
        // A cap lies below its tangent plane, by half of the square of a chord.
        let inward = if piece.is_whole() { piece.radius } else { 0.5 * piece.radius * piece.radius };
        let outward = if piece.is_whole() { inward } else { 0.0 };
        let sides = [(piece.radius, piece.radius), (piece.radius, piece.radius), (inward, outward)];
        for (x, (low, high)) in sides.into_iter().enumerate() {
            program.row([(3 * j + x, 1.0)], high);
            program.row([(3 * j + x, -1.0)], low);
        }
    }
    if higher {
        limit_products(star, pieces, &layout, &mut program);
    }
    let solution = program.solve()?;
    let direction = |j: usize| {
        let point = &solution.point[3 * j..3 * j + 3];
        let u = (0..3).fold(pieces[j].centre, |u, x| add_scaled(u, point[x], frames[j][x]));
        unit(u).unwrap_or([0.0, 0.0, 1.0])
    };
    let directions = (0..star.n_free).map(direction).collect();
    // The multipliers of the corners' rows: as good as any weights for the bound, and small negative ones are the
    // solver's rounding.
    let weights = solution.multipliers[..n_rows].iter().map(|m| m.max(0.0)).collect();
    Some(Step { directions, weights })
}

/// The row of a corner.
fn corner_row(
    star: &Directions,
    corner: usize,
    centres: &[Vector],
    frames: &[[Vector; 3]],
    order: Order,
    layout: &Layout,
    program: &mut Program,
) {
    let columns = star.columns(corner, centres);
    let mut row = Vec::with_capacity(20);
    for (k, ray) in star.corners[corner].iter().enumerate() {
        if let Ray::Free(j) = *ray {
            let g = cross(columns[(k + 1) % 3], columns[(k + 2) % 3]);
            row.extend((0..3).map(|x| (3 * j + x, -dot(g, frames[j][x]))).filter(|&(_, v)| v != 0.0));
        }
    }
    if order == Order::All {
        let (pairs, triple) = star.higher(corner, centres);
        for (at, c) in pairs {
            row.extend((0..3).map(|x| (layout.first_pair + 3 * at + x, -c[x])).filter(|&(_, v)| v != 0.0));
        }
        row.extend(triple.map(|(at, sign)| (layout.first_triple + at, -sign)));
    }
    row.push((layout.t, 1.0));
    program.row(row, det(columns[0], columns[1], columns[2]));
}

/// Products of directions are at most those of the radii.
fn limit_products(star: &Directions, pieces: &[Piece], layout: &Layout, program: &mut Program) {
    for (n, &[j, k]) in star.pairs.iter().enumerate() {
        let most = pieces[j].radius * pieces[k].radius;
        for x in 0..3 {
            program.row([(layout.first_pair + 3 * n + x, 1.0)], most);
            program.row([(layout.first_pair + 3 * n + x, -1.0)], most);
        }
    }
    for (n, triple) in star.triples.iter().enumerate() {
        let most = triple.iter().map(|&j| pieces[j].radius).product();
        program.row([(layout.first_triple + n, 1.0)], most);
        program.row([(layout.first_triple + n, -1.0)], most);
    }
}
