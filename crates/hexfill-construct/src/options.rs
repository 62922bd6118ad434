//! What a caller may choose.

use crate::cells::library::{CellChoice, CellLibrary};
use crate::core::cone::BallCore;
use crate::core::maker::InteriorTets;
use std::sync::Arc;

/// Which colouring to use.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum RouteChoice {
    /// The bipartition if there is one, else few black-black edges.
    #[default]
    Auto,
    /// Black all over: Erickson's construction, for comparison.
    Erickson,
}

/// Choices for [`construct`](crate::construct).
///
/// | option | default |
/// |---|---|
/// | `route` | the bipartition if there is one, else few black-black edges |
/// | `ball_core` | a new vertex inside if there are positions, else as few tetrahedra as possible |
/// | `tets` | none: built-in tetrahedra |
/// | `cells` | those with the fewest hexes |
/// | `variant` | 0 |
/// | `library` | none: the built-in cells that `cells` names |
#[derive(Clone, Debug, Default)]
pub struct ConstructOptions {
    pub(crate) route: RouteChoice,
    pub(crate) ball_core: BallCore,
    pub(crate) tets: Option<Arc<dyn InteriorTets>>,
    pub(crate) cells: CellChoice,
    pub(crate) variant: u64,
    pub(crate) library: Option<CellLibrary>,
}

impl ConstructOptions {
    /// Which colouring.
    #[must_use]
    pub fn with_route(self, route: RouteChoice) -> Self {
        Self { route, ..self }
    }

    /// How the core of a ball is made.
    #[must_use]
    pub fn with_ball_core(self, ball_core: BallCore) -> Self {
        Self { ball_core, ..self }
    }

    /// Who makes the tetrahedra of the interior; without it a ball is coned, and anything else is cut along disks
    /// that positions tell (see [`crate::HandlebodyTets`]).
    #[must_use]
    pub fn with_tets(self, tets: Arc<dyn InteriorTets>) -> Self {
        Self { tets: Some(tets), ..self }
    }

    /// Which of the built-in cells.
    #[must_use]
    pub fn with_cells(self, cells: CellChoice) -> Self {
        Self { cells, ..self }
    }

    /// Which of the choices that cost the same: an odd number exchanges the colours of a bipartite surface, half of it
    /// orders the matching. 0 is the usual one; another may suit a surface with sharp vertices better.
    #[must_use]
    pub fn with_variant(self, variant: u64) -> Self {
        Self { variant, ..self }
    }

    /// Cells to use instead of the built-in ones.
    #[must_use]
    pub fn with_library(self, library: CellLibrary) -> Self {
        Self { library: Some(library), ..self }
    }

    /// Whether the variant exchanges the colours of a bipartite surface.
    pub(crate) fn swaps_colours(&self) -> bool {
        self.variant % 2 == 1
    }

    /// Which matching the variant wants.
    pub(crate) fn matching(&self) -> u64 {
        self.variant / 2
    }
}
