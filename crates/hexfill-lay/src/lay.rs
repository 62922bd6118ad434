//! [`lay`]: the verb.

use crate::fewer::without_sheets;
use crate::laid_mesh::LaidMesh;
use crate::laying::{Laying, Underway};
use hexfill_geometry::{Vector, norm, sub};
use hexfill_mesh::{Context, HexMesh, QuadSurface};
use rayon::prelude::*;

/// How far to go. Counts bound the work, not a clock.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct LayOptions {
    /// Meshes begun at once, each from another plan.
    pub attempts: u64,
    /// Times that many are begun, until one of them ends.
    pub batches: u64,
    /// Most hexes a quad while laying.
    pub most: f64,
    /// Sheets whose loss is tried at most, for each mesh.
    pub sheets: u32,
}

impl Default for LayOptions {
    fn default() -> Self {
        Self { attempts: 4, batches: 2, most: 12.0, sheets: 60 }
    }
}

/// For surfaces of more quads half as many meshes are begun at once, in more batches, and half as many sheets are tried.
const LARGE: usize = 150;
/// Meshes from which sheets are taken.
const KEPT: usize = 2;
/// Plans for one mesh: a jam that pillows do not clear asks for another.
const PLANS: u64 = 12;

/// Lays meshes for a sphere of quads whose vertices are at `points` (outward orientation), fewest hexes first; none if no attempt came to its end.
/// The same for any number of threads.
pub fn lay(surface: &QuadSurface, points: &[Vector], options: &LayOptions, ctx: &Context<'_>) -> Vec<LaidMesh> {
    if !surface.is_sphere() {
        return Vec::new();
    }
    let frame = Frame::of(points);
    let within: Vec<Vector> = points.iter().map(|&p| frame.enter(p)).collect();
    let Some(start) = Laying::begin(surface, &within, ctx) else { return Vec::new() };
    let most = (options.most * surface.n_quads() as f64) as usize;
    // Each hex is laid with all others looked at, so time grows with the square of the quads.
    let share = if surface.n_quads() > LARGE { 2 } else { 1 };
    let (attempts, sheets) = (options.attempts.div_ceil(share), options.sheets.div_ceil(share as u32));
    for batch in 0..options.batches * share {
        let mut made: Vec<LaidMesh> = (0..attempts)
            .into_par_iter()
            .filter_map(|i| {
                let quiet = if i == 0 { *ctx } else { Context { progress: None, ..*ctx } };
                let laying = to_the_end(start.clone(), ctx.seed + batch * attempts + i, most, &quiet)?;
                let mesh = HexMesh::try_new(laying.points.len(), &laying.hexes).ok()?;
                Some(LaidMesh { mesh, points: laying.points, invalid: laying.forgiven.len(), pillows: laying.pillows })
            })
            .collect();
        if !made.is_empty() || ctx.stop().is_some() {
            // Stable: among equals the first attempt.
            made.sort_by_key(|laid| laid.mesh.n_hexes());
            made.truncate(KEPT);
            let mut fewer: Vec<LaidMesh> =
                made.into_par_iter().map(|laid| without_sheets(laid, surface.n_vertices(), sheets, ctx)).collect();
            fewer.sort_by_key(|laid| laid.mesh.n_hexes());
            for laid in &mut fewer {
                laid.points.iter_mut().for_each(|p| *p = frame.leave(*p));
                laid.points[..points.len()].copy_from_slice(points);
            }
            return fewer;
        }
    }
    Vec::new()
}

/// Where the work is done: the mean of the surface's vertices at the origin, the farthest at distance 1.
struct Frame {
    centre: Vector,
    size: f64,
}

impl Frame {
    fn of(points: &[Vector]) -> Self {
        let share = 1.0 / points.len().max(1) as f64;
        let centre = std::array::from_fn(|axis| points.iter().map(|p| share * p[axis]).sum());
        let size = points.iter().map(|&p| norm(sub(p, centre))).fold(0.0, f64::max).max(f64::MIN_POSITIVE);
        Self { centre, size }
    }

    fn enter(&self, p: Vector) -> Vector {
        sub(p, self.centre).map(|x| x / self.size)
    }

    fn leave(&self, p: Vector) -> Vector {
        std::array::from_fn(|axis| self.size.mul_add(p[axis], self.centre[axis]))
    }
}

/// Lays hexes until nothing is open. `None` if it jams, has more than `most` hexes, or is told to stop.
fn to_the_end(mut laying: Laying, seed: u64, most: usize, ctx: &Context<'_>) -> Option<Laying> {
    let mut plans = 0;
    let mut underway = next_plan(&laying, seed, &mut plans, ctx)?;
    // Pillows since the last hex; a new plan begins right behind one.
    let mut jams = 0;
    while !laying.front.is_empty() {
        if ctx.stop().is_some() || laying.hexes.len() > most {
            return None;
        }
        ctx.report("laying", laying.hexes.len() as u64, None, || {
            format!("{} hexes laid, {} quads open", laying.hexes.len(), laying.front.len())
        });
        // Hexes that make the front grow only once a pillow has not helped.
        if !underway.is_over() && laying.lay_one(&mut underway, jams > 0, ctx) {
            jams = 0;
            continue;
        }
        if jams == 0 || jams == 1 && !underway.is_over() {
            laying.pillow(&mut underway, ctx);
            jams += 1;
        }
        if underway.is_over() || jams >= 2 {
            underway = next_plan(&laying, seed, &mut plans, ctx)?;
            jams = 1;
        }
    }
    Some(laying)
}

/// The next plan for a front behind a pillow; `None` after too many.
fn next_plan(laying: &Laying, seed: u64, plans: &mut u64, ctx: &Context<'_>) -> Option<Underway> {
    (*plans..PLANS).find_map(|number| {
        *plans = number + 1;
        laying.planned(if number == 0 { seed } else { 100 * seed + number }, ctx)
    })
}
