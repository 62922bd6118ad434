//! [`Filled`]: a verified mesh and how it was found.

use crate::fill::attempt::Attempt;
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

/// A verified mesh.
#[derive(Clone, Debug)]
pub struct Filled {
    pub(crate) mesh: HexMesh,
    pub(crate) route: Route,
    pub(crate) start: Option<Vec<[f64; 3]>>,
    pub(crate) stages: Vec<(&'static str, usize)>,
    /// The smaller mesh that a shelling was lifted from.
    pub(crate) coarse: Option<CoarseMesh>,
}

impl Filled {
    /// A mesh without start positions, made in one step.
    pub(crate) fn by(route: Route, mesh: HexMesh) -> Self {
        Self { mesh, route, start: None, stages: Vec::new(), coarse: None }
    }

    /// This filling after one more step, which added the hexes that `mesh` has more.
    pub(crate) fn changed(&self, step: &'static str, mesh: HexMesh) -> Self {
        let mut stages = self.stages.clone();
        if stages.is_empty() {
            stages.push((self.route.words(), self.mesh.n_hexes()));
        }
        stages.push((step, mesh.n_hexes().saturating_sub(self.mesh.n_hexes())));
        Self { mesh, route: self.route, start: None, stages, coarse: None }
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

    /// What made how many of its hexes, where more than one step did.
    pub fn stages(&self) -> &[(&'static str, usize)] {
        &self.stages
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
