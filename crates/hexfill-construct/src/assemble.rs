//! Step 8: assembly. Cells and core become one hex mesh by looking up the ids of their points.

use crate::cell::CellLibrary;
use crate::error::ConstructError;
use crate::layer::Layer;
use crate::pattern::Pattern;
use hexfill_mesh::{Context, QuadId};
use std::collections::BTreeMap;

/// Cells by pattern: how many, and hexes in one.
pub type CellCount = BTreeMap<Pattern, (usize, usize)>;

/// Quads between two looks at the context.
const BATCH: usize = 1 << 14;

/// Counts the cells and their inner points.
///
/// # Errors
/// [`ConstructError::NoCell`].
pub fn count_cells(
    layer: &Layer<'_>,
    library: &CellLibrary,
    n_quads: usize,
) -> Result<(CellCount, usize), ConstructError> {
    let mut count = CellCount::new();
    let mut inner = 0;
    for q in (0..n_quads).filter(|&q| !layer.is_open(QuadId::new(q))) {
        let pattern = layer.pattern(QuadId::new(q));
        let cell = library.find(&pattern).ok_or(ConstructError::NoCell { pattern })?;
        inner += cell.n_interior;
        let name = library.cells()[cell.cell].pattern;
        count.entry(name).or_insert((0, cell.hexes.len())).0 += 1;
    }
    Ok((count, inner))
}

/// Appends the hexes of the buffer cells; their inner points are numbered from `first` on, cell by cell.
///
/// # Errors
/// [`ConstructError::Stopped`], [`ConstructError::NoCell`].
pub fn place_cells(
    layer: &Layer<'_>,
    library: &CellLibrary,
    n_quads: usize,
    first: u32,
    hexes: &mut Vec<[u32; 8]>,
    ctx: &Context<'_>,
) -> Result<(), ConstructError> {
    let mut next = first;
    let mut ids = Vec::new();
    for q in 0..n_quads {
        if q % BATCH == 0 {
            if let Some(reason) = ctx.stop() {
                return Err(ConstructError::Stopped(reason));
            }
            ctx.report("cells", q as u64, Some(n_quads as u64), String::new);
        }
        let quad = QuadId::new(q);
        if layer.is_open(quad) {
            continue;
        }
        let pattern = layer.pattern(quad);
        let cell = library.find(&pattern).ok_or(ConstructError::NoCell { pattern })?;
        ids.clear();
        ids.extend(cell.boundary.iter().map(|&r| layer.point(quad, r)));
        ids.extend((0..cell.n_interior as u32).map(|i| next + i));
        next += cell.n_interior as u32;
        hexes.extend(cell.hexes.iter().map(|h| h.map(|i| ids[usize::from(i)])));
    }
    Ok(())
}
