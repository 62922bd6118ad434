//! [`embed_mesh`]: new positions for the interior vertices of any hex mesh.
//!
//! Source: ours.

use crate::place::placed::Placed;
use hexfill_embed::{EmbedError, Options, embed};
use hexfill_mesh::{Context, HexMesh};

/// Embeds a mesh: the positions of its boundary vertices are kept bit for bit, the others are looked for. `boundary` has a position for each
/// vertex up to the last one of the boundary, `start` for all, to begin with. Every hex is judged; if the embedding leaves more invalid hexes than the
/// start had, the start comes back.
///
/// ```
/// use hexfill::{Context, EmbedOptions, catalog, embed_mesh, Problem};
///
/// let entry = catalog::find("schneiders-pyramid").expect("in the catalogue");
/// let mesh = entry.best_mesh().expect("it has one").hex_mesh()?;
/// let boundary = Problem::named("schneiders-pyramid")?.positions().expect("it has positions");
/// let placed = embed_mesh(&mesh, &boundary, None, &EmbedOptions::default(), &Context::default())?;
/// assert_eq!(placed.points()[..boundary.len()], boundary[..]);
/// assert_eq!(placed.cells().len(), 36);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`EmbedError`]: positions are missing or cannot be used. Not to find valid ones is no error: [`Placed::is_certified`] says so.
pub fn embed_mesh(
    mesh: &HexMesh,
    boundary: &[[f64; 3]],
    start: Option<&[[f64; 3]]>,
    options: &Options,
    ctx: &Context<'_>,
) -> Result<Placed, EmbedError> {
    let made = embed(mesh, boundary, start, options, ctx)?;
    Ok(Placed::judged(mesh, &[], made.points, Some(made.report), start))
}
