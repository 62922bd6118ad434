//! The same object under other names: for tests that an answer does not depend on numbering.
//!
//! Source: ours.

use super::Random;
use crate::cube::symmetries;
use crate::hexmesh::HexMesh;
use crate::surface::QuadSurface;

/// The surface with vertices renumbered, quads reordered and each quad's corners rotated; with `mirror`, inside out as well.
/// Returns the new id of each old vertex along.
pub fn shuffled_surface(surface: &QuadSurface, seed: u64, mirror: bool) -> (QuadSurface, Vec<u32>) {
    let mut random = Random::new(seed);
    let new = random.permutation(surface.n_vertices());
    let mut quads: Vec<[u32; 4]> = surface.quads().iter().map(|q| q.map(|v| new[v.index()])).collect();
    for quad in &mut quads {
        if mirror {
            quad.swap(1, 3);
        }
        quad.rotate_left(random.below(4));
    }
    random.shuffle(&mut quads);
    let out = QuadSurface::try_new(surface.n_vertices(), &quads).expect("renumbering keeps a surface a surface");
    (out, new)
}

/// The mesh with vertices renumbered, hexes reordered and each hex in another of its 24 frames.
/// Returns the new id of each old vertex along.
pub fn shuffled_mesh(mesh: &HexMesh, seed: u64) -> (HexMesh, Vec<u32>) {
    let mut random = Random::new(seed);
    let new = random.permutation(mesh.n_vertices());
    let mut hexes: Vec<[u32; 8]> = Vec::with_capacity(mesh.n_hexes());
    for hex in mesh.hexes() {
        let frame = &symmetries()[random.below(24)];
        hexes.push(frame.map(|k| new[hex[k].index()]));
    }
    random.shuffle(&mut hexes);
    let out = HexMesh::try_new(mesh.n_vertices(), &hexes).expect("renumbering keeps a mesh a mesh");
    (out, new)
}

/// The mesh with every hex replaced by its mirror image on the same vertices.
pub fn mirrored_mesh(mesh: &HexMesh) -> HexMesh {
    let hexes: Vec<[u32; 8]> = mesh.hexes().iter().map(|h| symmetries()[24].map(|k| h[k].0)).collect();
    HexMesh::try_new(mesh.n_vertices(), &hexes).expect("reflecting every hex keeps a mesh a mesh")
}
