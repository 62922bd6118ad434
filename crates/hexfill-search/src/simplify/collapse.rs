//! [`collapse`]: everything that can be pressed flat.

use crate::simplify::column_collapse::collapse_columns;
use crate::simplify::live::LiveMesh;
use crate::simplify::sheet_collapse::collapse_sheets;
use crate::simplify::{Simplified, SimplifyReport, Snapshot};
use hexfill_mesh::{Context, HexMesh};

/// Collapses closed sheets and closed columns of hexes until none can go, without touching the boundary. The mesh must be proper
/// (level 2 of the judge), else the result need not be.
///
/// Time: near linear in the hexes, some microseconds each.
pub fn collapse(mesh: &HexMesh, ctx: &Context<'_>) -> Simplified {
    let mut made = Simplified::unchanged(mesh);
    loop {
        let mut live = LiveMesh::new(&made.mesh);
        let is_boundary = made.mesh.boundary_vertices();
        let mut report = SimplifyReport::new(made.mesh.n_hexes());
        report.sheets = collapse_sheets(&mut live, &made.mesh, &is_boundary, ctx);
        report.columns = collapse_columns(&mut live, &is_boundary, ctx);
        report.after = live.n_hexes();
        report.collapsed = report.before - report.after;
        report.stop = ctx.stop().unwrap_or(report.stop);
        // Columns that go change the sheets.
        let is_last = report.columns == 0 || ctx.stop().is_some();
        if report.collapsed > 0 {
            let (mesh, origin) = Snapshot::of(&live).settled(&made.mesh);
            made = made.then(Simplified { mesh, origin, report });
        } else {
            made.report.stop = report.stop;
        }
        if is_last {
            return made;
        }
    }
}
