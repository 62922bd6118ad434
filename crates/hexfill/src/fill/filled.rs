//! [`Filled`]: a verified mesh and how it was found.
//!
//! Source: ours.

use crate::fill::attempt::Attempt;
use crate::fill::maker::{Maker, layers, shares};
use hexfill_io::MeshData;
use hexfill_mesh::{HexMesh, StopReason};
use hexfill_shell::CoarseMesh;
use serde::Serialize;

/// Which way a mesh was found.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Route {
    /// The best known mesh of a surface of the catalogue.
    Catalogue,
    /// Looked up in the atlas.
    Atlas,
    /// Swept inward by the surface's dual curves.
    Shelling,
    /// Laid hex by hex from the surface inward, at valid positions all the way.
    Laying,
    /// Hexes glued inward, the rest from the atlas.
    InwardFlips,
    /// Reached by growing an atlas towards it.
    Growth,
    /// Constructed.
    Construction,
}

impl Route {
    /// What makes all hexes of a mesh that is made in one step.
    fn maker(self) -> Maker {
        match self {
            Self::Catalogue => Maker::Catalogue,
            Self::Atlas => Maker::Atlas,
            Self::Shelling => Maker::Shelling,
            Self::InwardFlips => Maker::InwardFlips,
            Self::Growth => Maker::Growth,
            Self::Construction => Maker::Construction,
            Self::Laying => Maker::Laying,
        }
    }

    /// In words, for reports.
    pub fn words(self) -> &'static str {
        match self {
            Self::Catalogue => "the catalogue",
            Self::Atlas => "atlas look-up",
            Self::Shelling => "shelling",
            Self::Laying => "laying",
            Self::InwardFlips => "inward flips and atlas",
            Self::Growth => "growth towards the surface",
            Self::Construction => "construction",
        }
    }
}

/// The field of cells that says what made them.
pub(crate) const ENGINE: &str = "engine";
/// The field of cells with their layers.
pub(crate) const LAYER: &str = "layer";

/// A verified mesh.
#[derive(Clone, Debug)]
pub struct Filled {
    pub(crate) mesh: HexMesh,
    pub(crate) route: Route,
    pub(crate) start: Option<Vec<[f64; 3]>>,
    /// Whether these are positions to begin with as they are, and no guess to be smoothed first.
    pub(crate) is_placed: bool,
    /// Per hex.
    pub(crate) makers: Vec<Maker>,
    /// The smaller mesh that a shelling was lifted from.
    pub(crate) coarse: Option<CoarseMesh>,
}

impl Filled {
    /// A mesh without start positions, made in one step.
    pub(crate) fn by(route: Route, mesh: HexMesh) -> Self {
        let makers = vec![route.maker(); mesh.n_hexes()];
        Self { mesh, route, start: None, is_placed: false, makers, coarse: None }
    }

    /// This filling after one more step, which put hexes behind those there were.
    pub(crate) fn changed(&self, step: Maker, mesh: HexMesh) -> Self {
        let mut makers = self.makers.clone();
        makers.resize(mesh.n_hexes(), step);
        Self { mesh, route: self.route, start: None, is_placed: false, makers, coarse: None }
    }

    /// This filling after one more step; `origin` has for each hex the one that it was, or `None` for those of this step.
    pub(crate) fn remade(&self, step: Maker, mesh: HexMesh, origin: &[Option<u32>]) -> Self {
        let makers = origin.iter().map(|was| was.map_or(step, |h| self.makers[h as usize])).collect();
        Self { mesh, route: self.route, start: None, is_placed: false, makers, coarse: None }
    }

    /// The mesh; the surface's vertices keep their ids, interior vertices follow.
    pub fn mesh(&self) -> &HexMesh {
        &self.mesh
    }

    /// The mesh alone.
    pub fn into_mesh(self) -> HexMesh {
        self.mesh
    }

    /// How it was found.
    pub fn route(&self) -> Route {
        self.route
    }

    /// Start positions of all vertices, those of the surface first: a construction or a shelling has some, other routes have none.
    pub fn start(&self) -> Option<&[[f64; 3]]> {
        self.start.as_deref()
    }

    /// What made each hex.
    pub fn makers(&self) -> &[Maker] {
        &self.makers
    }

    /// What made how many of its hexes: the counts of [`makers`](Self::makers).
    pub fn stages(&self) -> Vec<(Maker, usize)> {
        shares(&self.makers)
    }

    /// In which layer under the surface each hex lies: 1 for those with a facet on it, 2 for their neighbours across facets, and so on. With boundary layers
    /// the first numbers are theirs.
    pub fn layers(&self) -> Vec<u32> {
        layers(&self.mesh)
    }

    /// Gives file data two numbers per hex: `engine`, the [number](Maker::number) of what made it, and `layer`.
    pub fn flag(&self, data: &mut MeshData) {
        let engines = self.makers.iter().map(|maker| f64::from(maker.number())).collect();
        let layers = self.layers().into_iter().map(f64::from).collect();
        for (name, values) in [(ENGINE, engines), (LAYER, layers)] {
            data.hex_data.retain(|(n, _)| n != name);
            data.hex_data.push((name.to_owned(), values));
        }
    }
}

/// All that a fill brought.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct FillResult {
    /// The meshes, fewest hexes first, pairwise not isomorphic.
    pub meshes: Vec<Filled>,
    /// Why the work ended.
    pub stop: StopReason,
    /// What was tried, in the order of the work.
    pub tried: Vec<Attempt>,
}

impl FillResult {
    /// Nothing yet.
    pub(crate) fn new() -> Self {
        Self { meshes: Vec::new(), stop: StopReason::Finished, tried: Vec::new() }
    }
}
