//! Who makes the tetrahedra of the core.
//!
//! Source: ours.

use super::complex::TetComplex;
use super::request::TetRequest;
use crate::error::ConstructError;
use hexfill_mesh::Context;
use std::fmt;

/// Who made the tetrahedra of the core.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Core {
    /// Coned from one point, see [`crate::ConeTets`].
    Cone,
    /// Delaunay tetrahedra between positions, see [`crate::DelaunayTets`].
    Delaunay,
    /// Cut along disks and coned, see [`crate::HandlebodyTets`].
    Handlebody,
    /// Given by the caller, see [`crate::GivenTets`].
    Given,
    /// By an installed `tetgen`, see [`crate::TetgenTets`].
    Tetgen,
}

impl fmt::Display for Core {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Cone => "ball",
            Self::Delaunay => "delaunay",
            Self::Handlebody => "handlebody",
            Self::Given => "given",
            Self::Tetgen => "tetgen",
        })
    }
}

/// Provides tetrahedra inside a triangulated surface.
///
/// The boundary of what is returned must be exactly the triangles asked for (further vertices only inside). It is
/// compared with the request, always.
pub trait InteriorTets: fmt::Debug + Send + Sync {
    /// What the report calls them.
    fn core(&self) -> Core {
        Core::Given
    }

    /// Fills the surface.
    ///
    /// # Errors
    /// [`ConstructError::InteriorNeeded`] or [`ConstructError::TetBoundary`] with the reason.
    fn fill(&self, request: &TetRequest<'_>, ctx: &Context<'_>) -> Result<TetComplex, ConstructError>;
}
