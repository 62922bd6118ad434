//! [`Quadratic`]: cells of second order, beside those of a mesh (see `quadratic.rs`).
//!
//! Source: ours.

/// The faces and hexes of a mesh with the nodes of their edges, in the orders of VTK_QUADRATIC_QUAD and VTK_QUADRATIC_HEXAHEDRON:
/// corners as in `quads` and `hexes`, then middles in the order of `QUAD_EDGES` and `HEX_EDGES` (`orders.rs`).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Quadratic {
    pub(crate) quads: Vec<[u32; 8]>,
    pub(crate) hexes: Vec<[u32; 20]>,
}

impl Quadratic {
    /// The faces alone.
    pub(crate) fn without_hexes(self) -> Self {
        Self { hexes: Vec::new(), ..self }
    }

    pub(crate) fn nodes_mut(&mut self) -> impl Iterator<Item = &mut u32> {
        self.quads.iter_mut().flatten().chain(self.hexes.iter_mut().flatten())
    }

    /// Whether these are the cells of a mesh of such quads and hexes alone, on so many points.
    pub(crate) fn fits(&self, of_quads: &[[u32; 4]], of_hexes: &[[u32; 8]], n_points: usize) -> bool {
        let exist = |nodes: &[u32]| nodes.iter().all(|&v| (v as usize) < n_points);
        let quads = self.quads.len() == of_quads.len()
            && self.quads.iter().zip(of_quads).all(|(nodes, quad)| nodes[..4] == quad[..] && exist(nodes));
        let hexes = self.hexes.len() == of_hexes.len()
            && self.hexes.iter().zip(of_hexes).all(|(nodes, hex)| nodes[..8] == hex[..] && exist(nodes));
        quads && hexes
    }
}
