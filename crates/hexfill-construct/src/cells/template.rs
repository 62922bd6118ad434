//! The template of a cell: where its points lie in the cube.
//!
//! The template lives in `[-1, 1]^3` with the surface at z = -1 and the core above: corner 0 at (-1, -1), 1 at (-1, 1),
//! 2 at (1, 1), 3 at (1, -1). All sides are planar and congruent: a point of a side has coordinates (u, z), u = -1 at
//! the diagonal corner and +1 at the odd corner, so neighbours agree on it. The numbers were found by the example `place_cells` of
//! `hexfill` (book, page `construction`, "Cells").
//!
//! Source: ours (book, page `construction`, "Positions: from topology to geometry").

use super::cell::Cell;
use super::pattern::{Pattern, Role, Side};
use hexfill_geometry::Vector;
use hexfill_mesh::cube::EDGES;

/// Position of corner `k` of the template in the plane.
pub(crate) const CORNERS: [[f64; 2]; 4] = [[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [1.0, -1.0]];

/// Where the template has a boundary point of a pattern's cell.
pub fn template_position(pattern: &Pattern, role: Role) -> Vector {
    let at = |k: u8, z: f64| {
        let [x, y] = CORNERS[usize::from(k)];
        [x, y, z]
    };
    let on_side = |k: u8, u: f64, z: f64| {
        let a = CORNERS[usize::from(Pattern::diagonal_corner(k))];
        let b = CORNERS[usize::from(Pattern::odd_corner(k))];
        let s = (1.0 + u) / 2.0;
        [a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1]), z]
    };
    // Along the line from the centre to the odd corner of a triangle.
    let in_triangle = |t: u8, s: f64| {
        let [x, y] = CORNERS[usize::from(2 * t + 1)];
        [s * x, s * y, 1.0]
    };
    match role {
        Role::Outer(k) => at(k, -1.0),
        Role::Inner(k) => at(k, 1.0),
        Role::Middle(k) => at(k, 0.3241692943093266),
        Role::Edge(k) => on_side(k, 0.3818478484319652, 1.0),
        // A little above the corners: the light black-black side has a quad between them and the corners. Mirror images, because
        // what is the odd corner here may be the diagonal corner of the neighbour.
        Role::EdgeDiagonal(k) => on_side(k, -0.35, 1.38),
        Role::EdgeOdd(k) => on_side(k, 0.35, 1.38),
        Role::X(k) => on_side(k, 0.04649937557664252, -0.04567703642278415),
        Role::Y(k) => on_side(k, 0.25102760006182834, 0.7354842617333364),
        Role::Z(k) => on_side(k, -0.06305424588624131, 0.543869623529535),
        Role::Star(k) if pattern.sides[usize::from(k)] == Side::StarOdd => on_side(k, -0.05, 0.55),
        Role::Star(k) => on_side(k, 0.05, 0.55),
        Role::Diagonal => [0.0, 0.0, 1.0],
        Role::Face(t) => in_triangle(t, 0.4),
        Role::FaceLone(t) => in_triangle(t, 0.5),
        Role::FacePair(t) => in_triangle(t, 0.25),
        Role::Interior(_) => [0.0; 3],
    }
}

/// Positions of all points of a cell in the template: those of its file, else [`template_position`] and, inside, means
/// of the neighbours.
pub fn template(cell: &Cell) -> Vec<Vector> {
    if let Some(positions) = &cell.positions {
        return positions.clone();
    }
    let mut p: Vec<Vector> = cell.points.iter().map(|&r| template_position(&cell.pattern, r)).collect();
    let mut neighbours = vec![Vec::new(); p.len()];
    for hex in &cell.hexes {
        for [i, j] in EDGES {
            let (a, b) = (hex[i], hex[j]);
            for (v, w) in [(a, b), (b, a)] {
                if !neighbours[usize::from(v)].contains(&w) {
                    neighbours[usize::from(v)].push(w);
                }
            }
        }
    }
    // Gauss-Seidel sweeps of the graph Laplacian; the boundary stays (Tutte 1963).
    for _ in 0..200 {
        for v in cell.n_boundary..p.len() {
            let n = neighbours[v].len() as f64;
            p[v] = std::array::from_fn(|c| neighbours[v].iter().map(|&w| p[usize::from(w)][c]).sum::<f64>() / n);
        }
    }
    p
}
