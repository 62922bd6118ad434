//! [`without_sheets`]: what can go again, as long as the rest has valid positions.
//!
//! Source: Borden et al. 2002 (a sheet taken out); trying it on positions and keeping what stays valid is ours.

use crate::laid_mesh::LaidMesh;
use crate::open_mesh::Part;
use crate::step::Step;
use hexfill_embed::untangle_near;
use hexfill_geometry::Vector;
use hexfill_mesh::Context;
use hexfill_search::{Collapse, WithoutSheet, single_sheet_collapses};
use rayon::prelude::*;

/// Sheets tried at once; the first of them that can go goes.
const TOGETHER: usize = 4;
/// Rings of vertices and iterations on all, to find positions without a sheet;
const EFFORT: (usize, usize) = (2, 300);
/// in meshes of more hexes than this no iterations on all, which take a second each time, and more rings.
const LARGE: usize = 800;
const LARGE_EFFORT: (usize, usize) = (3, 0);

/// The mesh without closed sheets that its positions can do without, at most `trials` tried, largest first. A pillow that gave room to a hex is often not
/// needed any more once the hexes behind it are laid.
pub(crate) fn without_sheets(
    mut laid: LaidMesh,
    n_surface: usize,
    trials: u32,
    part: Part,
    ctx: &Context<'_>,
) -> LaidMesh {
    let mut tried = 0;
    'next: loop {
        let mut all = single_sheet_collapses(&laid.mesh, Collapse::All);
        if part == Part::Piece {
            all.retain(|fewer| keeps_pillow(fewer, &laid));
        }
        for some in all.chunks(TOGETHER) {
            if tried >= trials || ctx.stop().is_some() {
                return laid;
            }
            tried += some.len() as u32;
            let found: Vec<Option<LaidMesh>> = some.par_iter().map(|one| placed(one, &laid, n_surface, ctx)).collect();
            if let Some(fewer) = found.into_iter().flatten().next() {
                laid = fewer;
                continue 'next;
            }
        }
        return laid;
    }
}

/// Whether all hexes of the pillow under the surface are left.
fn keeps_pillow(fewer: &WithoutSheet, laid: &LaidMesh) -> bool {
    let n = |steps: &mut dyn Iterator<Item = Step>| steps.filter(|s| *s == Step::Pillow).count();
    n(&mut fewer.hexes.iter().map(|h| laid.steps[h.index()])) == n(&mut laid.steps.iter().copied())
}

/// The mesh at valid positions near those it had; `None` if none are found.
fn placed(fewer: &WithoutSheet, before: &LaidMesh, n_surface: usize, ctx: &Context<'_>) -> Option<LaidMesh> {
    let start: Vec<Vector> = fewer.origin.iter().map(|v| before.points[v.index()]).collect();
    debug_assert!((0..n_surface).all(|v| fewer.origin[v].index() == v));
    let quiet = Context { progress: None, ..*ctx };
    let (rings, whole) = if fewer.mesh.n_hexes() > LARGE { LARGE_EFFORT } else { EFFORT };
    let (points, bad) = untangle_near(&fewer.mesh, &start, rings, whole, &quiet).ok()?;
    (bad.len() <= before.invalid).then(|| LaidMesh {
        mesh: fewer.mesh.clone(),
        points,
        steps: fewer.hexes.iter().map(|h| before.steps[h.index()]).collect(),
        invalid: bad.len(),
        pillows: before.pillows,
    })
}
