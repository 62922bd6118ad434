//! [`FillError`]: why a surface has no hex mesh, or none was made.

use crate::fill::filled::Route;
use hexfill_construct::{ConstructError, Existence, forbidden};
use hexfill_mesh::QuadSurface;
use hexfill_search::AtlasError;

/// Why a surface has no hex mesh, or none was made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FillError {
    /// A theorem forbids every mesh.
    #[error("no hex mesh exists: {0}")]
    NoMesh(Existence),
    /// The strategy asked for cannot take this surface.
    #[error("{what}; {remedy}")]
    NotForStrategy {
        /// What about the surface.
        what: String,
        /// What to do.
        remedy: &'static str,
    },
    /// The construction refused.
    #[error(transparent)]
    Construct(ConstructError),
    /// The atlas or the log of the growth cannot be used.
    #[error(transparent)]
    Atlas(#[from] AtlasError),
    /// A mesh was made that the judge refused: a defect of this program.
    #[error("internal error: the mesh made by {route:?} fails {rules}; please report this surface")]
    Refused {
        /// How it was made.
        route: Route,
        /// The rules it breaks.
        rules: String,
    },
}

impl From<ConstructError> for FillError {
    fn from(error: ConstructError) -> Self {
        match error {
            ConstructError::NoMesh(existence) => Self::NoMesh(existence),
            other => Self::Construct(other),
        }
    }
}

/// Refuses surfaces whose quads alone forbid every proper hex mesh, naming the reason. Odd cycles that bound inside are left to
/// [`crate::existence()`] and the construction.
///
/// ```
/// use hexfill::{Existence, FillError, check_fillable, mesh::QuadSurface};
/// // A torus of 3 x 5 quads: an odd number.
/// let at = |i: u32, j: u32| (i % 3) * 5 + j % 5;
/// let quads: Vec<[u32; 4]> = (0..15)
///     .map(|v| (v / 5, v % 5))
///     .map(|(i, j)| [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)])
///     .collect();
/// let torus = QuadSurface::try_new(15, &quads)?;
/// assert!(matches!(check_fillable(&torus), Err(FillError::NoMesh(Existence::OddQuads { given: 15 }))));
/// # Ok::<(), hexfill::mesh::SurfaceError>(())
/// ```
///
/// # Errors
/// [`FillError::NoMesh`].
pub fn check_fillable(surface: &QuadSurface) -> Result<(), FillError> {
    forbidden(surface).map_or(Ok(()), |no| Err(FillError::NoMesh(no)))
}
