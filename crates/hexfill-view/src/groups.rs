//! [`Groups`]: the parts of a boundary that have tags, to be told apart by colour.
//!
//! Source: ours.

use hexfill_mesh::{Facet, HexId, HexMesh};
use rustc_hash::FxHashMap;

/// Groups of quads of a mesh, such as boundary conditions or the walls between regions.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Groups {
    /// Name of each group.
    pub(crate) names: Vec<String>,
    /// Facets of hexes that lie in a group (`6 * hex + side`, rising) and the number of that group.
    pub(crate) facets: Vec<(u32, u32)>,
    /// Whether the mesh is shown in their colours at first.
    pub(crate) first: bool,
}

impl Groups {
    /// The groups of some quads of `mesh`, in the order of their tags; `tags` has one number a quad, 0 for none, and `name` says what a tag is called.
    /// Quads that are facets of no hex are passed over; those between two hexes are facets of both. `None` if no quad has a tag.
    ///
    /// `first`: pages open in these colours, and pictures are drawn in them.
    pub fn new(
        mesh: &HexMesh,
        quads: &[[u32; 4]],
        tags: &[i64],
        name: impl Fn(i64) -> String,
        first: bool,
    ) -> Option<Self> {
        let sorted = |mut quad: [u32; 4]| {
            quad.sort_unstable();
            quad
        };
        let tagged = quads.iter().zip(tags).filter(|(_, tag)| **tag != 0);
        let tag_of: FxHashMap<[u32; 4], i64> = tagged.map(|(quad, tag)| (sorted(*quad), *tag)).collect();
        let mut facets: Vec<(u32, i64)> = Vec::new();
        for h in 0..mesh.n_hexes() as u32 {
            for side in 0..6 {
                let quad = mesh.facet_vertices(Facet::new(HexId(h), side)).map(|v| v.0);
                facets.extend(tag_of.get(&sorted(quad)).map(|tag| (6 * h + side as u32, *tag)));
            }
        }
        let mut known: Vec<i64> = facets.iter().map(|(_, tag)| *tag).collect();
        known.sort_unstable();
        known.dedup();
        let number = |tag: i64| known.binary_search(&tag).expect("a tag of a facet") as u32;
        let facets = facets.into_iter().map(|(facet, tag)| (facet, number(tag))).collect();
        (!known.is_empty()).then(|| Self { names: known.iter().map(|&tag| name(tag)).collect(), facets, first })
    }

    /// The group of a facet.
    pub(crate) fn of(&self, facet: u32) -> Option<u32> {
        self.facets.binary_search_by_key(&facet, |f| f.0).ok().map(|i| self.facets[i].1)
    }
}
