//! The engine: meshes of a surface by layers, by flips, and by flips where layers get no further.

use crate::angles::wanted_hexes;
use crate::between::between;
use crate::compress::{Coarse, compress, uncompressed};
use crate::develop::develop;
use crate::deviation::{Deviation, deviation};
use crate::front::Front;
use crate::lift::lift;
use crate::polycube::polycube;
use crate::residual::fill_residual;
use crate::solve::solve;
use crate::stir::stir_front;
use crate::sweep::{SweepOptions, sweep_front};
use crate::void::Void;
use hexfill_mesh::{Context, HexMesh, QuadSurface};
use hexfill_search::Atlas;
use rayon::prelude::*;

/// What to try.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct ShellOptions {
    /// Restarts of the solver by layers, for each number of pillows.
    pub restarts: u64,
    /// Seeds of the sweep by flips, for each number of pillows.
    pub seeds: u64,
    /// Numbers of pillows to try.
    pub pillows: Vec<u32>,
    /// Most meshes returned for each number of pillows.
    pub candidates: usize,
}

impl Default for ShellOptions {
    fn default() -> Self {
        Self { restarts: 64, seeds: 4, pillows: vec![0, 1], candidates: 3 }
    }
}

/// A complete mesh.
#[derive(Clone, Debug)]
pub struct Shelled {
    /// The mesh; the surface's vertices keep their ids, interior vertices follow.
    pub mesh: HexMesh,
    /// A first guess at all positions, if those of the surface were given; the surface's own come first, bit for bit.
    pub points: Option<Vec<[f64; 3]>>,
    /// How far its edges are from the hexes they want: 0 is perfect.
    pub cost: f32,
    /// Pillows under the surface.
    pub pillows: u32,
    /// Where its hexes come from, and how many.
    pub stages: Vec<(&'static str, usize)>,
}

/// What shelling brought.
#[derive(Clone, Debug, Default)]
pub struct Shelling {
    /// Complete meshes: for each number of pillows those that no other beats in both cost and hexes, least cost first.
    pub meshes: Vec<Shelled>,
    /// Quads of the compressed surface.
    pub coarse_quads: usize,
    /// Fewest coarse quads that a sweep left; 0 if one was complete.
    pub left: usize,
}

impl std::fmt::Display for Shelling {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "shelling from {} coarse quads: ", self.coarse_quads)?;
        match (self.meshes.len(), self.left) {
            (0, usize::MAX) => write!(f, "stopped"),
            (0, 0) => write!(f, "nothing that lifts"),
            (0, left) => write!(f, "{left} quads left"),
            (n, _) => write!(f, "{n} meshes"),
        }
    }
}

/// Restarts times the square of the quads: what layers may cost.
const RESTART_WORK: u64 = 4_000_000;
/// Restarts at least, unless fewer are asked for.
const MIN_RESTARTS: u64 = 2;
/// Incomplete sweeps by layers that flips go on from.
const CONTINUED: usize = 4;
/// Residuals that are filled.
const RESIDUALS: usize = 4;
/// Rounds of stirring for one of them.
const STIRRING: u32 = 20;
/// Meshes that cost less give every edge what it wants.
const PERFECT: f32 = 1e-3;
/// Surfaces of more quads are not swept by flips without compression too.
const MOST_FINE: usize = 20_000;

/// Sweeps a surface inward. `points`: one position per vertex of the surface, outward orientation; without them every edge is
/// taken for flat.
pub fn shell(
    surface: &QuadSurface,
    points: Option<&[[f64; 3]]>,
    options: &ShellOptions,
    ctx: &Context<'_>,
) -> Shelling {
    let wanted = wanted_hexes(surface, points);
    let coarse = compress(surface, &wanted);
    let fine = uncompressed(surface, &wanted);
    let is_fine = coarse.surface.n_quads() == surface.n_quads();
    let mut shelling = Shelling { coarse_quads: coarse.surface.n_quads(), left: usize::MAX, ..Shelling::default() };
    let cells = develop(surface, &wanted, points).and_then(|d| polycube(surface, &d));
    for &pillows in &options.pillows {
        if let (0, Some(hexes)) = (pillows, &cells) {
            let grid = vec![Glued::at_once("grid", hexes.clone())];
            keep(&mut shelling.meshes, &fine, surface, points, pillows, grid, options);
            shelling.left = 0;
            if shelling.meshes.iter().any(|m| m.cost < PERFECT) {
                // All edges bend by right angles: nothing is better than the cells of the grid.
                break;
            }
        }
        if surface.n_components() > 1 {
            let Some(given) = points.filter(|_| surface.n_quads() <= MOST_FINE && ctx.stop().is_none()) else {
                continue;
            };
            if let (0, Some(hexes)) = (pillows, between(surface, given)) {
                let columns = vec![Glued::at_once("columns", hexes)];
                keep(&mut shelling.meshes, &fine, surface, points, pillows, columns, options);
                shelling.left = 0;
            }
            // Bridges and plugs join chords of all multiplicities, so they need the surface as it is.
            if let Some(start) = Start::new(&fine, pillows).cut_open(given, surface, pillows) {
                let meshes = start.complete(options, &mut shelling.left, ctx);
                keep(&mut shelling.meshes, &fine, surface, points, pillows, meshes, options);
            }
            continue;
        }
        let start = Start::new(&coarse, pillows);
        let mut meshes = start.complete(options, &mut shelling.left, ctx);
        let found = keep(&mut shelling.meshes, &coarse, surface, points, pillows, std::mem::take(&mut meshes), options);
        if surface.n_quads() > MOST_FINE || ctx.stop().is_some() {
            continue;
        }
        if surface.genus() > 0
            && let Some(given) = points
        {
            // Plugs join chords of all multiplicities, so they need the surface as it is.
            if let Some(start) = Start::new(&fine, pillows).cut_open(given, surface, pillows) {
                let meshes = start.complete(options, &mut shelling.left, ctx);
                keep(&mut shelling.meshes, &fine, surface, points, pillows, meshes, options);
            }
        } else if found == 0 && !is_fine {
            let meshes = Start::new(&fine, pillows).by_flips(options, &[], &mut shelling.left, ctx);
            keep(&mut shelling.meshes, &fine, surface, points, pillows, meshes, options);
        }
    }
    shelling
}

type Hexes = Vec<[u32; 8]>;

/// Coarse hexes in the order they were glued, and how many there were after each stage.
struct Glued {
    hexes: Hexes,
    stages: Vec<(&'static str, usize)>,
}

impl Glued {
    fn at_once(stage: &'static str, hexes: Hexes) -> Self {
        Self { stages: vec![(stage, hexes.len())], hexes }
    }
}

/// Where sweeps start: the surface, perhaps behind pillows and cut by plugs.
struct Start<'a> {
    coarse: &'a Coarse,
    void: Void,
    quads: Vec<[u32; 4]>,
    /// Hexes of the pillows.
    n_pillows: usize,
}

impl<'a> Start<'a> {
    fn new(coarse: &'a Coarse, pillows: u32) -> Self {
        let mut void = Void::new(coarse);
        for _ in 0..pillows {
            void.pillow();
        }
        let n_pillows = void.hexes.len();
        Self { coarse, n_pillows, void, quads: coarse.surface.quads().iter().map(|q| q.map(|v| v.0)).collect() }
    }

    /// This start with all cavities joined to the outside and all handles cut; `None` if one is not. `points` are those of the surface,
    /// which is not compressed.
    fn cut_open(self, points: &[[f64; 3]], surface: &QuadSurface, pillows: u32) -> Option<Self> {
        // Pillows copy the surface vertex by vertex.
        let mut near = points.to_vec();
        let n = points.len();
        let mut origin = vec![u32::MAX; self.void.n_vertices as usize];
        (0..n).for_each(|v| origin[v] = v as u32);
        for hex in &self.void.hexes {
            (0..4).for_each(|i| origin[hex[i] as usize] = origin[hex[i + 4] as usize]);
        }
        near.extend(origin[n..].iter().map(|&v| points[v as usize]));
        let mut front = self.void.to_front(&self.quads)?;
        for _ in 1..surface.n_components() {
            front = front.bridged(&mut near, pillows)?;
        }
        for _ in 0..surface.genus() {
            front = front.plug(&mut near)?;
        }
        Some(Self { void: self.void.after(&front)?, ..self })
    }

    /// Complete coarse meshes, by both engines.
    fn complete(&self, options: &ShellOptions, left: &mut usize, ctx: &Context<'_>) -> Vec<Glued> {
        let n = self.void.quads.len() as u64;
        let restarts = (RESTART_WORK / (n * n)).clamp(MIN_RESTARTS.min(options.restarts), options.restarts);
        let sweeps = solve(&self.void, restarts, ctx);
        let (complete, partial): (Vec<_>, Vec<_>) = sweeps.into_iter().partition(|s| s.is_complete());
        let mut meshes: Vec<Glued> = complete
            .into_iter()
            .map(|s| {
                let n = s.void.hexes.len();
                self.glued(s.void.hexes, n, n)
            })
            .collect();
        if !meshes.is_empty() {
            *left = 0;
        }
        let is_perfect = |m: &Glued| deviation(self.coarse, &m.hexes).is_some_and(|d| d.cost < PERFECT);
        if meshes.iter().any(is_perfect) {
            return meshes;
        }
        let fronts: Vec<Front> =
            partial.into_iter().take(CONTINUED).filter_map(|s| s.void.to_wanting_front(&self.quads)).collect();
        meshes.extend(self.by_flips(options, &fronts, left, ctx));
        meshes
    }

    /// Complete coarse meshes by flips, from the start and from `others`.
    fn by_flips(&self, options: &ShellOptions, others: &[Front], left: &mut usize, ctx: &Context<'_>) -> Vec<Glued> {
        let Some(front) = self.void.to_front(&self.quads) else { return Vec::new() };
        let Some(wanting) = self.void.to_wanting_front(&self.quads) else { return Vec::new() };
        // Every other sweep looks at lenses alone: it ends with fewer hexes.
        let starts: Vec<(&Front, u64)> = (0..options.seeds)
            .map(|seed| (if seed % 2 == 0 { &wanting } else { &front }, seed / 2))
            .chain(others.iter().map(|f| (f, 0)))
            .collect();
        // The fronts with the number of hexes that layers had glued, and that flips had.
        let mut fronts: Vec<(usize, Front)> = starts
            .into_par_iter()
            .enumerate()
            .map(|(i, (front, seed))| {
                let by_layers = front.hexes().len();
                let mut front = front.clone();
                sweep_front(&mut front, &SweepOptions { seed, ..SweepOptions::default() }, &first_speaks(i, ctx));
                (by_layers, front)
            })
            .collect();
        fronts.sort_by_key(|(_, front)| front.n_quads());
        let smallest = fronts.first().map_or(usize::MAX, |(_, front)| front.n_quads());
        if smallest == 0 {
            *left = 0;
            let complete = fronts.into_iter().filter(|(_, front)| front.n_quads() == 0);
            return complete
                .map(|(by_layers, front)| self.glued(front.hexes().to_vec(), by_layers, front.hexes().len()))
                .collect();
        }
        // Nothing closed: the smallest residuals are filled.
        // Handles that are left are no matter of flips.
        fronts.retain(|(_, front)| is_sphere(front));
        fronts.truncate(RESIDUALS);
        let filled: Vec<Glued> = fronts
            .par_iter()
            .enumerate()
            .flat_map_iter(|(i, (by_layers, front))| {
                let filled = close_residual(front, &first_speaks(i, ctx));
                filled.into_iter().map(|hexes| self.glued(hexes, *by_layers, front.hexes().len()))
            })
            .collect();
        *left = if filled.is_empty() { smallest.min(*left) } else { 0 };
        filled
    }

    /// A complete mesh, given how many hexes there were after layers and after flips.
    fn glued(&self, hexes: Hexes, after_layers: usize, after_flips: usize) -> Glued {
        let stages = vec![
            ("pillows", self.n_pillows),
            ("plugs", self.void.hexes.len()),
            ("layers", after_layers),
            ("flips", after_flips),
            ("residual", hexes.len()),
        ];
        Glued { hexes, stages }
    }
}

fn is_sphere(front: &Front) -> bool {
    QuadSurface::try_new(front.n_vertices() as usize, &front.quads()).is_ok_and(|surface| surface.is_sphere())
}

/// Of several that work at once only the first reports progress.
fn first_speaks<'c>(number: usize, ctx: &Context<'c>) -> Context<'c> {
    if number == 0 { *ctx } else { Context { progress: None, ..*ctx } }
}

/// A residual filled as it is, and stirred until it closes.
fn close_residual(front: &Front, ctx: &Context<'_>) -> Vec<Hexes> {
    let mut stirred = front.clone();
    let options = SweepOptions { atlas: Some(Atlas::embedded()), ..SweepOptions::default() };
    stir_front(&mut stirred, STIRRING, &options, ctx);
    [fill_residual(front, ctx), fill_residual(&stirred, ctx)].into_iter().flatten().collect()
}

/// Lifts those that no other beats in both cost and hexes; returns how many.
fn keep(
    kept: &mut Vec<Shelled>,
    coarse: &Coarse,
    surface: &QuadSurface,
    points: Option<&[[f64; 3]]>,
    pillows: u32,
    meshes: Vec<Glued>,
    options: &ShellOptions,
) -> usize {
    let before = kept.len();
    let mut measured: Vec<(Deviation, Glued)> =
        meshes.into_iter().filter_map(|m| deviation(coarse, &m.hexes).map(|d| (d, m))).collect();
    // Stable: first come, first served among equals.
    measured.sort_by(|a, b| a.0.cost.total_cmp(&b.0.cost).then(a.0.fine_hexes.cmp(&b.0.fine_hexes)));
    let mut fewest = u64::MAX;
    measured.retain(|(d, _)| {
        let keep = d.fine_hexes < fewest;
        fewest = fewest.min(d.fine_hexes);
        keep
    });
    // The ends of the front and what lies evenly between them.
    let n = measured.len();
    let wanted = n.min(options.candidates);
    let chosen: Vec<usize> = (0..wanted).map(|i| if wanted == 1 { 0 } else { i * (n - 1) / (wanted - 1) }).collect();
    for i in chosen {
        let (d, glued) = &measured[i];
        let Ok(lifted) = lift(coarse, surface.n_vertices() as u32, points, &glued.hexes) else { continue };
        let Ok(mesh) = HexMesh::try_new(lifted.n_vertices as usize, &lifted.hexes) else { continue };
        let mut before = 0;
        let mut stages = Vec::new();
        for &(stage, n) in &glued.stages {
            let after = lifted.before[n];
            if after > before {
                stages.push((stage, after - before));
            }
            before = after;
        }
        kept.push(Shelled { mesh, points: lifted.points, cost: d.cost, pillows, stages });
    }
    kept.len() - before
}
