//! Small meshes for the tests of this crate.

use crate::problem::Problem;
use crate::vector::Vector;
use hexfill_mesh::{HexMesh, Random};

/// The cube cut into n x n x n hexes; vertex (i, j, k) has id `i + (n + 1) (j + (n + 1) k)`.
pub(crate) fn grid(n: usize) -> HexMesh {
    let at = |i: usize, j: usize, k: usize| (i + (n + 1) * (j + (n + 1) * k)) as u32;
    let mut hexes = Vec::new();
    for k in 0..n {
        for j in 0..n {
            for i in 0..n {
                hexes.push(
                    hexfill_mesh::cube::POSITIONS.map(|p| at(i + p[0] as usize, j + p[1] as usize, k + p[2] as usize)),
                );
            }
        }
    }
    HexMesh::try_new((n + 1).pow(3), &hexes).expect("a grid is a mesh")
}

/// The positions of its vertices, unit cells apart.
pub(crate) fn grid_points(n: usize) -> Vec<Vector> {
    let side = n + 1;
    (0..side.pow(3)).map(|v| [v % side, v / side % side, v / side / side].map(|x| x as f64)).collect()
}

/// Checks a barrier, given per hex its value and gradient, on the grid of eight: the gradient matches differences, and with the middle vertex far
/// outside it is infinite. It gets the problem, the inner points watched in each hex, the hex and all positions.
pub(crate) fn check_barrier(hex: impl Fn(&Problem, &[Vec<Vector>], usize, &[Vector]) -> (f64, [Vector; 8])) {
    let mesh = grid(2);
    let problem = Problem::new(27, mesh.hexes_raw(), &mesh.boundary_vertices());
    let inner = vec![vec![[0.5, 0.25, 0.5]]; 8];
    let mut random = Random::of_task(51, 0);
    let mut points = grid_points(2);
    points[13] = std::array::from_fn(|k| points[13][k] + 0.4 * random.signed());
    let total = |points: &[Vector]| (0..8).map(|h| hex(&problem, &inner, h, points).0).sum::<f64>();
    let mut gradient = vec![0.0; 3];
    let rows: Vec<_> = (0..8).map(|h| hex(&problem, &inner, h, &points)).collect();
    problem.sum_at_variables(&rows, &mut gradient);
    for k in 0..3 {
        let (mut high, mut low) = (points.clone(), points.clone());
        high[13][k] += 1e-6;
        low[13][k] -= 1e-6;
        let slope = (total(&high) - total(&low)) / 2e-6;
        assert!((slope - gradient[k]).abs() < 1e-5 * (1.0 + slope.abs()), "{slope} {}", gradient[k]);
    }
    points[13] = [5.0, 0.0, 0.0];
    assert_eq!(total(&points), f64::INFINITY);
}
