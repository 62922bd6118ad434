//! [`FillOptions`] and what they choose between.

use hexfill_construct::CellChoice;
use hexfill_search::{Atlas, FillOptions as InwardOptions, GrowOptions, SimplifyOptions};
use hexfill_shell::{BoundaryLayers, ShellOptions};
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// How to fill.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
#[non_exhaustive]
pub enum Strategy {
    /// Atlas, shelling, inward flips; what they do not fill is constructed. With coordinates the best mesh is taken, see
    /// [`Prefer`].
    #[default]
    Auto,
    /// Shelling only: the surface swept inward by its own dual curves.
    Shell,
    /// Atlas, inward flips, then growth towards the surface until it is reached or time is up.
    Atlas,
    /// Construction only.
    Construct,
}

/// Where the tetrahedra of an interior that is not a ball come from.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub enum InteriorFrom {
    /// Handlebodies cut along disks, which positions tell.
    #[default]
    BuiltIn,
    /// A tetrahedral mesh of the inside of the surface.
    Tets(Arc<hexfill_construct::GivenTets>),
    /// An installed program called as a process.
    Tetgen(hexfill_construct::TetgenTets),
}

/// What to look for, where, and how long. Made from the defaults:
///
/// ```
/// use hexfill::{Effort, FillOptions, Strategy};
/// let options = FillOptions::default().with_strategy(Strategy::Shell).with_effort(Effort::Fast);
/// ```
///
/// | option | default |
/// |---|---|
/// | strategy | [`Strategy::Auto`] |
/// | effort | [`Effort::Normal`] |
/// | prefer | [`Prefer::Balance`] |
/// | max hexes | none |
/// | count | 1 mesh |
/// | layers | none |
/// | interior | [`InteriorFrom::BuiltIn`] |
/// | cells | [`CellChoice::Embeddable`] |
/// | simplify | no |
/// | atlas | the embedded one |
/// | improve | no |
/// | growth | cap 24, width 1, no log |
/// | inward cavities, beam | 1,000,000 and 1,000 |
#[derive(Clone, Debug)]
pub struct FillOptions {
    pub(crate) strategy: Strategy,
    pub(crate) max_hexes: u32,
    pub(crate) count: usize,
    pub(crate) improve: bool,
    pub(crate) atlas: Option<Arc<Atlas>>,
    pub(crate) growth_log: Option<PathBuf>,
    pub(crate) growth: GrowOptions,
    pub(crate) inward_cavities: u64,
    pub(crate) beam: usize,
    pub(crate) interior: InteriorFrom,
    pub(crate) cells: CellChoice,
    pub(crate) simplify: Option<SimplifyOptions>,
    pub(crate) shell: ShellOptions,
    pub(crate) effort: Effort,
    pub(crate) prefer: Prefer,
    pub(crate) layers: Option<BoundaryLayers>,
}

impl Default for FillOptions {
    fn default() -> Self {
        Self {
            strategy: Strategy::Auto,
            max_hexes: u32::MAX,
            count: 1,
            improve: false,
            atlas: None,
            growth_log: None,
            growth: GrowOptions::default(),
            inward_cavities: 1_000_000,
            beam: InwardOptions::default().beam(),
            interior: InteriorFrom::BuiltIn,
            cells: CellChoice::Embeddable,
            simplify: None,
            shell: ShellOptions::default(),
            effort: Effort::default(),
            prefer: Prefer::default(),
            layers: None,
        }
    }
}

impl FillOptions {
    /// How to fill.
    #[must_use]
    pub fn with_strategy(self, strategy: Strategy) -> Self {
        Self { strategy, ..self }
    }

    /// How long to look for a better mesh, where there are coordinates.
    #[must_use]
    pub fn with_effort(self, effort: Effort) -> Self {
        Self { effort, ..self }
    }

    /// What to prefer among certified meshes.
    #[must_use]
    pub fn with_prefer(self, prefer: Prefer) -> Self {
        Self { prefer, ..self }
    }

    /// Most hexes a mesh may have; larger ones are not returned.
    #[must_use]
    pub fn with_max_hexes(self, max_hexes: u32) -> Self {
        Self { max_hexes, ..self }
    }

    /// How many non-isomorphic meshes to look for; at least 1.
    #[must_use]
    pub fn with_count(self, count: usize) -> Self {
        Self { count: count.max(1), ..self }
    }

    /// Boundary layers under the whole surface, cut once the mesh has positions; heights are in the unit of the surface. Only for
    /// [`fill_placed`](crate::fill_placed()): a mesh whose surface layer cannot be cut is refused with [`FillError::NotForStrategy`](crate::FillError::NotForStrategy).
    #[must_use]
    pub fn with_layers(self, layers: BoundaryLayers) -> Self {
        Self { layers: Some(layers), ..self }
    }

    /// Where the construction gets the tetrahedra of an interior that is not a ball.
    #[must_use]
    pub fn with_interior(self, interior: InteriorFrom) -> Self {
        Self { interior, ..self }
    }

    /// Which cells the construction uses where it has a choice: the ones with the fewest hexes do not embed.
    #[must_use]
    pub fn with_cells(self, cells: CellChoice) -> Self {
        Self { cells, ..self }
    }

    /// Make a construction smaller ([`crate::simplify`]). With a deadline this takes at most half of the time that is left, nine tenths with
    /// [`CellChoice::Fewest`] (nothing is embedded then). A mesh made smaller is harder to embed.
    #[must_use]
    pub fn with_simplify(self, simplify: SimplifyOptions) -> Self {
        Self { simplify: Some(simplify), ..self }
    }

    /// The atlas to use in place of the embedded one.
    #[must_use]
    pub fn with_atlas(self, atlas: Arc<Atlas>) -> Self {
        Self { atlas: Some(atlas), ..self }
    }

    /// Look on for smaller meshes until the context stops the search.
    #[must_use]
    pub fn with_improve(self, improve: bool) -> Self {
        Self { improve, ..self }
    }

    /// How an atlas is grown towards the surface ([`Strategy::Atlas`]).
    #[must_use]
    pub fn with_growth(self, growth: GrowOptions) -> Self {
        Self { growth, ..self }
    }

    /// Where that growth keeps its log, so that an interrupted run can go on.
    #[must_use]
    pub fn with_growth_log(self, path: impl Into<PathBuf>) -> Self {
        Self { growth_log: Some(path.into()), ..self }
    }

    /// How many cavities inward flips may look at before the next strategy has its turn (no clock: the same result every time).
    #[must_use]
    pub fn with_inward_cavities(self, inward_cavities: u64) -> Self {
        Self { inward_cavities, ..self }
    }

    /// How many of them are kept on each level; at least 1. More find more of the meshes that [`with_count`](Self::with_count) asks for.
    #[must_use]
    pub fn with_beam(self, beam: usize) -> Self {
        Self { beam: beam.max(1), ..self }
    }

    /// The log of the growth.
    pub fn growth_log(&self) -> Option<&Path> {
        self.growth_log.as_deref()
    }

    /// How to fill.
    pub fn strategy(&self) -> Strategy {
        self.strategy
    }
}

/// How much work goes into a better mesh where several are possible and the surface has coordinates.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
#[non_exhaustive]
pub enum Effort {
    /// The first mesh with a certificate; a fraction of the time.
    Fast,
    /// Until a mesh is good: certified, with a worst scaled Jacobian of at least 0.2.
    #[default]
    Normal,
    /// More candidates of every engine though one is good already, and each raised as far as it goes; many times the time.
    Best,
}

/// What to prefer among certified meshes whose worst scaled Jacobian is at least 0.2.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Prefer {
    /// Fewest hexes divided by the cube of the worst scaled Jacobian: twice the hexes must bring 26 % more quality.
    #[default]
    Balance,
    /// Fewest hexes; inside, three sheets become one wherever they lie on each other ([`hexfill_shell::Coarsening`]).
    Hexes,
    /// Largest worst scaled Jacobian.
    Quality,
}
