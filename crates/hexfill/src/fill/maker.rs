//! [`Maker`]: which engine, or which step of one, made a hex.
//!
//! Source: ours.

use hexfill_lay::Step;
use hexfill_mesh::{HexId, HexMesh};
use hexfill_shell::Stage;
use serde::{Serialize, Serializer};
use std::fmt;

/// Which engine, or which step of one, made a hex. Numbers are those of the cell field `engine` in files; they stay.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
#[non_exhaustive]
#[repr(u8)]
pub enum Maker {
    /// The file had it.
    Given = 0,
    /// The best known mesh of a surface of the catalogue.
    Catalogue = 1,
    /// Glued inward before the atlas took over.
    InwardFlips = 2,
    /// Looked up in the atlas.
    Atlas = 3,
    /// Reached by growing an atlas towards the surface.
    Growth = 4,
    /// Constructed.
    Construction = 5,
    /// In the place of constructed hexes.
    Simplification = 6,
    /// Shelling: a step without a number of its own.
    Shelling = 7,
    /// Shelling: a cell of the grid into which the surface unrolls.
    Grid = 8,
    /// Shelling: a column between mirror images.
    Columns = 9,
    /// The layer of one hex under every quad.
    Pillows = 10,
    /// Shelling: cuts a handle, or joins a cavity to the outside.
    Plugs = 11,
    /// Shelling: swept in whole layers.
    Layers = 12,
    /// Shelling: swept by flips of the dual curves.
    Flips = 13,
    /// Shelling: fills what the sweep left.
    Residual = 14,
    /// A second inner edge at a poor surface vertex.
    SplitStars = 15,
    /// A pillow between stages of the shelling, or in the void where hexes are laid.
    PillowsBetween = 16,
    /// A boundary layer.
    BoundaryLayers = 17,
    /// Laid at valid positions, one by one.
    Laying = 18,
    /// Between three sheets and the one that goes on inside.
    Coarsening = 19,
}

impl Maker {
    /// All, each at its number.
    pub const ALL: [Self; 20] = [
        Self::Given,
        Self::Catalogue,
        Self::InwardFlips,
        Self::Atlas,
        Self::Growth,
        Self::Construction,
        Self::Simplification,
        Self::Shelling,
        Self::Grid,
        Self::Columns,
        Self::Pillows,
        Self::Plugs,
        Self::Layers,
        Self::Flips,
        Self::Residual,
        Self::SplitStars,
        Self::PillowsBetween,
        Self::BoundaryLayers,
        Self::Laying,
        Self::Coarsening,
    ];

    /// Its number in the cell field `engine`.
    pub fn number(self) -> u8 {
        self as u8
    }

    /// In words, as reports say it.
    pub fn words(self) -> &'static str {
        match self {
            Self::Given => "given",
            Self::Catalogue => "the catalogue",
            Self::InwardFlips => "inward flips",
            Self::Atlas => "atlas look-up",
            Self::Growth => "growth towards the surface",
            Self::Construction => "construction",
            Self::Simplification => "simplification",
            Self::Shelling => "shelling",
            Self::Grid => "grid",
            Self::Columns => "columns",
            Self::Pillows => "pillows",
            Self::Plugs => "plugs",
            Self::Layers => "layers",
            Self::Flips => "flips",
            Self::Residual => "residual",
            Self::SplitStars => "split stars",
            Self::PillowsBetween => "pillows between",
            Self::BoundaryLayers => "boundary layers",
            Self::Laying => "laying",
            Self::Coarsening => "coarsening",
        }
    }

    /// A stage of the shelling.
    pub(crate) fn of_stage(stage: Stage) -> Self {
        match stage {
            Stage::Grid => Self::Grid,
            Stage::Columns => Self::Columns,
            Stage::Pillows => Self::Pillows,
            Stage::Plugs => Self::Plugs,
            Stage::Layers => Self::Layers,
            Stage::Flips => Self::Flips,
            Stage::Residual => Self::Residual,
        }
    }

    /// A step of laying.
    pub(crate) fn of_laying(step: Step) -> Self {
        match step {
            Step::Pillow => Self::Pillows,
            Step::Plug => Self::Plugs,
            Step::Sweep => Self::Flips,
            Step::Between => Self::PillowsBetween,
            Step::Laid => Self::Laying,
        }
    }
}

impl fmt::Display for Maker {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.words())
    }
}

impl Serialize for Maker {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.words())
    }
}

/// How many hexes each made, by number; those that made none left out.
pub(crate) fn shares(makers: &[Maker]) -> Vec<(Maker, usize)> {
    let mut counts = [0; Maker::ALL.len()];
    makers.iter().for_each(|maker| counts[*maker as usize] += 1);
    Maker::ALL.into_iter().zip(counts).filter(|(_, n)| *n > 0).collect()
}

/// Per hex: in which layer under the surface it lies. 1 for hexes with a facet on the boundary, 2 for their neighbours across facets, and so on; 0 for what
/// reaches no boundary.
pub(crate) fn layers(mesh: &HexMesh) -> Vec<u32> {
    let mut layer = vec![0; mesh.n_hexes()];
    let mut reached: Vec<HexId> = Vec::with_capacity(mesh.n_hexes());
    for facet in mesh.boundary_facets() {
        let hex = facet.hex();
        if std::mem::replace(&mut layer[hex.index()], 1) == 0 {
            reached.push(hex);
        }
    }
    let mut next = 0;
    while let Some(&hex) = reached.get(next) {
        next += 1;
        for side in 0..6 {
            let Some(beyond) = mesh.neighbour(hexfill_mesh::Facet::new(hex, side)) else { continue };
            let there = beyond.hex();
            if layer[there.index()] == 0 {
                layer[there.index()] = layer[hex.index()] + 1;
                reached.push(there);
            }
        }
    }
    layer
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_is_its_place_and_every_word_is_one() {
        for (i, maker) in Maker::ALL.into_iter().enumerate() {
            assert_eq!(usize::from(maker.number()), i);
            assert_eq!(Maker::ALL.iter().filter(|m| m.words() == maker.words()).count(), 1);
        }
        use Stage::{Columns, Flips, Grid, Layers, Pillows, Plugs, Residual};
        for stage in [Grid, Columns, Pillows, Plugs, Layers, Flips, Residual] {
            assert_eq!(format!("{:?}", Maker::of_stage(stage)), format!("{stage:?}"));
        }
    }

    #[test]
    fn layers_of_a_box_are_its_shells() {
        let at = |x: u32, y: u32, z: u32| x + 6 * (y + 6 * z);
        let cell = |c: u32| [c % 5, c / 5 % 5, c / 25];
        let hexes: Vec<[u32; 8]> = (0..125)
            .map(|c| {
                let [x, y, z] = cell(c);
                let ring = [(0, 0), (1, 0), (1, 1), (0, 1)];
                std::array::from_fn(|k| at(x + ring[k % 4].0, y + ring[k % 4].1, z + k as u32 / 4))
            })
            .collect();
        let mesh = HexMesh::try_new(216, &hexes).unwrap();
        for (c, layer) in (0..).zip(layers(&mesh)) {
            assert_eq!(layer, cell(c).into_iter().map(|x| x.min(4 - x)).min().unwrap() + 1);
        }
    }
}
