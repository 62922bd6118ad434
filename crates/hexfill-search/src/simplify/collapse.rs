//! [`collapse`]: everything that can be pressed flat.
//!
//! Source: the collapses of its two neighbours, over and over.

use crate::simplify::column_collapse::collapse_columns;
use crate::simplify::live::LiveMesh;
use crate::simplify::quotient::Kept;
use crate::simplify::sheet_collapse::{closed_sheets, collapse_sheets, sheet_quotient};
use crate::simplify::{Settled, Simplified, SimplifyReport, Snapshot};
use hexfill_mesh::{Context, HexId, HexMesh, VertexId};

/// Which sheets and columns may be collapsed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Collapse {
    /// None.
    Nothing,
    /// Those without hexes that have a boundary vertex. Where coordinates exist, they depend above all on how many hexes lie round
    /// the edges and vertices of the boundary; these numbers stay.
    Inside,
    /// All that leave the boundary's quads alone.
    #[default]
    All,
}

/// Collapses closed sheets and closed columns of hexes until none can go, without touching the boundary. The mesh must be proper
/// (level 2 of the judge), else the result need not be.
///
/// Time: some tens of microseconds a hex (2 s for a construction of 51,424 hexes), on one thread.
pub fn collapse(mesh: &HexMesh, which: Collapse, ctx: &Context<'_>) -> Simplified {
    let mut live = LiveMesh::new(mesh);
    let mut report = SimplifyReport::new(mesh.n_hexes());
    collapse_live(&mut live, &mesh.boundary_vertices(), which, &mut report, ctx);
    report.stop = ctx.stop().unwrap_or(report.stop);
    report.after = live.n_hexes();
    if report.collapsed == 0 {
        return Simplified { report, ..Simplified::unchanged(mesh) };
    }
    let Settled { mesh, origin, .. } = Snapshot::of(&live).settled(mesh);
    Simplified { mesh, origin, report }
}

/// A mesh after one sheet is gone.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct WithoutSheet {
    /// The mesh; vertices keep their order. Vertices of no hex are kept.
    pub mesh: HexMesh,
    /// Per vertex of it: the vertex of the input it was.
    pub origin: Vec<VertexId>,
    /// Per hex of it: the hex of the input it was.
    pub hexes: Vec<HexId>,
}

/// The meshes that `mesh` becomes if one of its closed sheets is collapsed, those that lose most hexes first: for callers who choose by what connectivity
/// does not tell. As [`collapse`] otherwise.
pub fn single_sheet_collapses(mesh: &HexMesh, which: Collapse) -> Vec<WithoutSheet> {
    if which == Collapse::Nothing {
        return Vec::new();
    }
    let whole = LiveMesh::new(mesh);
    let mut closed = closed_sheets(&whole);
    closed.sort_by_key(|sheet| std::cmp::Reverse(sheet.len()));
    let is_boundary = mesh.boundary_vertices();
    let kept = Kept { is_boundary: &is_boundary, hexes: which == Collapse::Inside };
    let one = |sheet: Vec<(u32, u8)>| {
        let quotient = sheet_quotient(&whole, &sheet);
        let merges = quotient.merges(&whole, &kept).ok()?;
        let mut live = whole.clone();
        live.merge(&quotient.removed, &quotient.facets, &merges);
        // A hex keeps its number until the mesh is settled.
        let hexes = live.alive().map(HexId).collect();
        let Settled { mesh, origin, .. } = Snapshot::of(&live).settled(mesh);
        // Collapsing merges vertices and makes none.
        let origin = origin.into_iter().collect::<Option<Vec<VertexId>>>()?;
        Some(WithoutSheet { mesh, origin, hexes })
    };
    closed.into_iter().filter_map(one).collect()
}

/// [`collapse`] in place. `is_boundary`: of the vertices of the input; those that came later are inside.
pub(crate) fn collapse_live(
    live: &mut LiveMesh,
    is_boundary: &[bool],
    which: Collapse,
    report: &mut SimplifyReport,
    ctx: &Context<'_>,
) {
    if which == Collapse::Nothing {
        return;
    }
    let before = live.n_hexes();
    let kept = Kept { is_boundary, hexes: which == Collapse::Inside };
    loop {
        report.sheets += collapse_sheets(live, &kept, ctx);
        let columns = collapse_columns(live, &kept, ctx);
        report.columns += columns;
        // Columns that go change the sheets.
        if columns == 0 || ctx.stop().is_some() {
            break;
        }
    }
    report.collapsed += before - live.n_hexes();
}
