//! The buffer layer as hexes: cells and their points are looked up by role.
//!
//! Source: ours.

use crate::cells::library::CellLibrary;
use crate::cells::pattern::Pattern;
use crate::error::ConstructError;
use crate::ids::PointId;
use crate::layer::Layer;
use hexfill_mesh::{Context, QuadId};
use std::collections::BTreeMap;

/// Cells by pattern: how many, and hexes in one.
pub(crate) type CellCount = BTreeMap<Pattern, (usize, usize)>;

/// Quads between two looks at the context.
const BATCH: usize = 1 << 14;

/// Counts the cells and their inner points.
///
/// # Errors
/// [`ConstructError::NoCell`].
pub(super) fn count_cells(layer: &Layer<'_>, library: &CellLibrary) -> Result<(CellCount, usize), ConstructError> {
    let mut count = CellCount::new();
    let mut inner = 0;
    for q in (0..layer.n_quads()).map(QuadId::new).filter(|&q| !layer.is_open(q)) {
        let pattern = layer.pattern(q);
        let cell = library.find(&pattern).ok_or(ConstructError::NoCell { pattern })?;
        inner += cell.n_interior;
        let name = library.cells()[cell.cell].pattern;
        count.entry(name).or_insert((0, cell.hexes.len())).0 += 1;
    }
    Ok((count, inner))
}

/// Appends the hexes of the buffer cells; their inner points are numbered from the layer's end on, cell by cell.
///
/// # Errors
/// [`ConstructError::Stopped`], [`ConstructError::NoCell`].
pub(super) fn place_cells(
    layer: &Layer<'_>,
    library: &CellLibrary,
    hexes: &mut Vec<[PointId; 8]>,
    ctx: &Context<'_>,
) -> Result<(), ConstructError> {
    let n_quads = layer.n_quads();
    let mut next = layer.end();
    let mut points = Vec::new();
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
        points.clear();
        points.extend(cell.boundary.iter().map(|&r| layer.point(quad, r)));
        points.extend((0..cell.n_interior as u32).map(|i| next.plus(i)));
        next = next.plus(cell.n_interior as u32);
        hexes.extend(cell.hexes.iter().map(|h| h.map(|i| points[usize::from(i)])));
    }
    Ok(())
}
