//! Small meshes for the tests of this crate.

use hexfill_geometry::Vector;
use hexfill_mesh::HexMesh;

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
