//! What the tetrahedra have to fill.
//!
//! Source: ours.

use crate::error::ConstructError;
use crate::missing::MissingInterior;
use hexfill_mesh::{Forest, VertexId};

/// What the tetrahedra have to fill: the triangulated inner copy of the surface.
#[derive(Clone, Debug)]
pub struct TetRequest<'a> {
    /// Number of vertex ids (those of the surface).
    pub n_vertices: usize,
    /// The triangles, outward; triangles `2 q` and `2 q + 1` share the diagonal of quad `q`.
    pub triangles: &'a [[VertexId; 3]],
    /// Positions of the vertices, if the surface has any.
    pub points: Option<&'a [[f64; 3]]>,
}

impl TetRequest<'_> {
    /// Per triangle its component, numbered by smallest triangle, and how many there are.
    pub fn components(&self) -> (Vec<usize>, usize) {
        let mut forest: Forest<VertexId> = Forest::new(self.n_vertices);
        for t in self.triangles {
            forest.union(t[0], t[1]);
            forest.union(t[1], t[2]);
        }
        let mut number = vec![usize::MAX; self.n_vertices];
        let mut n = 0;
        let of = |t: &[VertexId; 3]| {
            let slot = &mut number[forest.find(t[0]).index()];
            if *slot == usize::MAX {
                *slot = n;
                n += 1;
            }
            *slot
        };
        let components = self.triangles.iter().map(of).collect();
        (components, n)
    }

    /// Sum of the genera of the components, and how many components there are.
    pub fn shape(&self) -> (u64, usize) {
        let (_, components) = self.components();
        let mut used = vec![false; self.n_vertices];
        self.triangles.iter().flatten().for_each(|v| used[v.index()] = true);
        let vertices = used.iter().filter(|&&u| u).count() as i64;
        // Euler: v - e + f = 2 c - 2 g, and triangles have 2 e = 3 f.
        let euler = vertices - self.triangles.len() as i64 / 2;
        (((2 * components as i64 - euler) / 2).max(0) as u64, components)
    }

    /// The error of a maker that cannot fill this request.
    pub fn interior_needed(&self, reason: MissingInterior) -> ConstructError {
        let (genus, components) = self.shape();
        ConstructError::InteriorNeeded { genus, components, reason }
    }
}
