//! Valences of the vertices and edges of a hex mesh, degrees of a surface, and counts of cells.
//!
//! In a regular grid an interior edge is in 4 hexes and a boundary edge in 2 (on a flat side); the others are *singular* and form the mesh's singular
//! graph. Histograms are ordered maps, so that they print the same everywhere.
//!
//! Source: ours.

use crate::components::{facet_components, n_vertex_components};
use crate::cube::EDGES;
use crate::hexmesh::HexMesh;
use crate::ids::{Edge, VertexId};
use crate::surface::QuadSurface;
use std::collections::BTreeMap;

/// An edge of a mesh and what is round it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct EdgeValence {
    /// The edge.
    pub edge: Edge,
    /// Number of hexes round it.
    pub hexes: u32,
    /// Whether it lies on a boundary quad.
    pub boundary: bool,
}

impl EdgeValence {
    /// Whether the valence is not that of a regular grid: 4 inside, 2 on the boundary.
    pub fn is_singular(&self) -> bool {
        self.hexes != if self.boundary { 2 } else { 4 }
    }
}

/// Per vertex: number of hexes at it (0: unused).
pub fn vertex_valences(mesh: &HexMesh) -> Vec<u32> {
    let mut valence = vec![0; mesh.n_vertices()];
    for v in mesh.hexes().iter().flatten() {
        valence[v.index()] += 1;
    }
    valence
}

/// All edges with their valences, ascending. Time as a sort of 12 edges a hex.
pub fn edge_valences(mesh: &HexMesh) -> Vec<EdgeValence> {
    // Each edge once for each hex, and once more, marked, for each boundary quad.
    let mut items: Vec<(Edge, bool)> = Vec::with_capacity(12 * mesh.n_hexes());
    for hex in mesh.hexes() {
        items.extend(EDGES.map(|[i, j]| (Edge::new(hex[i], hex[j]), false)));
    }
    for quad in mesh.boundary_quads() {
        items.extend((0..4).map(|i| (Edge::new(quad[i], quad[(i + 1) % 4]), true)));
    }
    items.sort_unstable();
    items
        .chunk_by(|a, b| a.0 == b.0)
        .map(|run| {
            let hexes = run.iter().filter(|item| !item.1).count() as u32;
            EdgeValence { edge: run[0].0, hexes, boundary: run.len() > hexes as usize }
        })
        .collect()
}

/// The singular edges (see [`EdgeValence::is_singular`]) inside the mesh, ascending.
pub fn interior_singular_edges(mesh: &HexMesh) -> Vec<EdgeValence> {
    edge_valences(mesh).into_iter().filter(|e| !e.boundary && e.is_singular()).collect()
}

/// Numbers about a hex mesh. Histograms count cells by valence.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
#[non_exhaustive]
pub struct MeshStatistics {
    /// Hexes.
    pub hexes: usize,
    /// Vertices that some hex uses.
    pub vertices: usize,
    /// Of these, vertices on no boundary quad.
    pub interior_vertices: usize,
    /// Edges.
    pub edges: usize,
    /// Of these, edges on no boundary quad.
    pub interior_edges: usize,
    /// Quads, interior ones counted once.
    pub quads: usize,
    /// Of these, quads in one hex only.
    pub boundary_quads: usize,
    /// V - E + Q - H.
    pub euler_characteristic: i64,
    /// Parts connected through quads.
    pub facet_components: usize,
    /// Parts connected through vertices.
    pub vertex_components: usize,
    /// Interior edges by number of hexes.
    pub interior_edge_valences: BTreeMap<u32, usize>,
    /// Boundary edges by number of hexes.
    pub boundary_edge_valences: BTreeMap<u32, usize>,
    /// Interior vertices by number of hexes.
    pub interior_vertex_valences: BTreeMap<u32, usize>,
    /// Boundary vertices by number of hexes.
    pub boundary_vertex_valences: BTreeMap<u32, usize>,
}

impl MeshStatistics {
    /// Number of interior edges whose valence is not 4.
    pub fn interior_singular_edges(&self) -> usize {
        self.interior_edges - self.interior_edge_valences.get(&4).copied().unwrap_or(0)
    }
}

/// Counts, Euler characteristic and valence histograms of a mesh. Near linear time.
pub fn mesh_statistics(mesh: &HexMesh) -> MeshStatistics {
    let mut s = MeshStatistics { hexes: mesh.n_hexes(), ..Default::default() };
    let on_boundary = mesh.boundary_vertices();
    for (v, n) in vertex_valences(mesh).into_iter().enumerate().filter(|(_, n)| *n > 0) {
        let histogram = if on_boundary[v] { &mut s.boundary_vertex_valences } else { &mut s.interior_vertex_valences };
        *histogram.entry(n).or_insert(0) += 1;
    }
    for e in edge_valences(mesh) {
        let histogram = if e.boundary { &mut s.boundary_edge_valences } else { &mut s.interior_edge_valences };
        *histogram.entry(e.hexes).or_insert(0) += 1;
    }
    let sum = |histogram: &BTreeMap<u32, usize>| histogram.values().sum::<usize>();
    s.interior_vertices = sum(&s.interior_vertex_valences);
    s.vertices = s.interior_vertices + sum(&s.boundary_vertex_valences);
    s.interior_edges = sum(&s.interior_edge_valences);
    s.edges = s.interior_edges + sum(&s.boundary_edge_valences);
    s.boundary_quads = mesh.boundary_facets().count();
    s.quads = (6 * s.hexes + s.boundary_quads) / 2;
    s.euler_characteristic = s.vertices as i64 - s.edges as i64 + s.quads as i64 - s.hexes as i64;
    s.facet_components = facet_components(mesh).len();
    s.vertex_components = n_vertex_components(mesh);
    s
}

/// V - E + Q - H of a mesh, unused vertices not counted.
pub fn euler_characteristic(mesh: &HexMesh) -> i64 {
    let vertices = mesh.used_vertices().iter().filter(|used| **used).count();
    let quads = (6 * mesh.n_hexes() + mesh.boundary_facets().count()) / 2;
    vertices as i64 - mesh.edges().len() as i64 + quads as i64 - mesh.n_hexes() as i64
}

/// Number of vertices of a surface by degree, unused vertices not counted.
pub fn degree_histogram(surface: &QuadSurface) -> BTreeMap<u32, usize> {
    let mut histogram = BTreeMap::new();
    for v in 0..surface.n_vertices() as u32 {
        let degree = surface.degree(VertexId(v));
        if degree > 0 {
            *histogram.entry(degree).or_insert(0) += 1;
        }
    }
    histogram
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::{all_spheres, cube_surface, grid, grid_mesh_of};

    #[test]
    fn a_block_is_regular_inside() {
        let s = mesh_statistics(&grid(3, 4, 5).unwrap());
        assert_eq!((s.vertices, s.interior_vertices, s.hexes), (120, 24, 60));
        assert_eq!(s.interior_edge_valences, BTreeMap::from([(4, s.interior_edges)]));
        assert_eq!(s.interior_singular_edges(), 0);
        assert_eq!(s.boundary_vertex_valences[&1], 8);
        // The twelve sides of the block have edges in one hex.
        assert_eq!(s.boundary_edge_valences[&1], 4 * (3 + 4 + 5));
        assert_eq!((s.euler_characteristic, s.facet_components, s.vertex_components), (1, 1, 1));
    }

    #[test]
    fn euler_characteristic_of_known_shapes() {
        assert_eq!(euler_characteristic(&grid(2, 2, 2).unwrap()), 1);
        let ring = grid_mesh_of([3, 3, 1], |[x, y, _]| (x, y) != (1, 1)).unwrap();
        assert_eq!(euler_characteristic(&ring), 0);
        let shell = grid_mesh_of([3, 3, 3], |p| p != [1, 1, 1]).unwrap();
        assert_eq!(euler_characteristic(&shell), 2);
        for mesh in [ring, shell] {
            let s = mesh_statistics(&mesh);
            assert_eq!(s.euler_characteristic, euler_characteristic(&mesh));
            assert_eq!(s.edges, mesh.edges().len());
        }
    }

    #[test]
    fn a_pillowed_cube_has_singular_edges() {
        // A cube in a cube: the inner one's edges are in three hexes.
        let hexes: Vec<[u32; 8]> = std::iter::once([8, 9, 10, 11, 12, 13, 14, 15])
            .chain(crate::cube::FACETS.map(|f| {
                let [a, b, c, d] = f.map(|v| v as u32);
                [a + 8, b + 8, c + 8, d + 8, a, b, c, d]
            }))
            .collect();
        let mesh = HexMesh::try_new(16, &hexes).unwrap();
        let singular = interior_singular_edges(&mesh);
        assert_eq!(singular.len(), 12 + 8);
        assert!(singular.iter().all(|e| e.hexes == 3));
        assert_eq!(mesh_statistics(&mesh).interior_singular_edges(), 20);
    }

    #[test]
    fn degrees_sum_to_four_a_quad() {
        assert_eq!(degree_histogram(&cube_surface()), BTreeMap::from([(3, 8)]));
        for s in all_spheres(12) {
            let h = degree_histogram(&s);
            assert_eq!(h.iter().map(|(d, n)| *d as usize * n).sum::<usize>(), 48);
            // Sum of (4 - degree) is 8 on a sphere, so there are at least eight vertices of degree 3.
            assert!(h[&3] >= 8);
        }
    }
}
