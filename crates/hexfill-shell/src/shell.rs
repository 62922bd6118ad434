//! The engine: meshes of a surface by layers, by flips, and by flips where layers get no further.
//!
//! Source: ours: which engine, in which order, and what is kept.

use crate::angles::wanted_hexes;
use crate::between::between;
use crate::blocks::blocks;
use crate::compress::{Coarse, compress, uncompressed};
use crate::develop::develop;
use crate::deviation::{Deviation, deviation};
use crate::front::Front;
use crate::lift::{CoarseMesh, lift};
use crate::polycube::polycube;
use crate::section::columns;
use crate::shell_options::ShellOptions;
use crate::solve::{Sweep, solve};
use crate::stage::Stage;
use crate::stir::stir_front;
use crate::sweep::sweep_front;
use crate::sweep_options::SweepOptions;
use crate::void::Void;
use hexfill_geometry::{det, sub};
use hexfill_mesh::cube::CORNER_NEIGHBOURS;
use hexfill_mesh::{Context, HexMesh, QuadSurface};
use hexfill_search::Atlas;
use rayon::prelude::*;
use std::sync::Arc;

/// A complete mesh.
#[derive(Clone, Debug)]
pub struct Shelled {
    /// The mesh; the surface's vertices keep their ids, interior vertices follow.
    pub mesh: HexMesh,
    /// A first guess at all positions, if those of the surface were given; the surface's own come first, bit for bit.
    pub points: Option<Vec<[f64; 3]>>,
    /// Whether these are no guess: every corner is positive.
    pub is_placed: bool,
    /// How far its edges are from the hexes they want: 0 is perfect.
    pub cost: f32,
    /// Pillows under the surface.
    pub pillows: u32,
    /// Where its hexes come from, and how many.
    pub stages: Vec<(Stage, usize)>,
    /// The smaller mesh it was lifted from, if chords were compressed and positions are known.
    pub coarse: Option<CoarseMesh>,
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
/// Surfaces of more quads are not swept by flips without compression too, and get no pillow over what needs no sweep.
const MOST_FINE: usize = 20_000;

/// Sweeps a surface inward. `points`: one position per vertex of the surface, outward orientation; without them every edge is
/// taken for flat.
///
/// # Example
/// A box of 1 by 1 by 2 unit cells: one chord runs round its middle twice, in parallel, and is compressed to one cube.
/// ```
/// use hexfill_mesh::{Context, QuadSurface};
/// use hexfill_shell::{ShellOptions, shell};
///
/// let quads = [
///     [0, 3, 2, 1], [8, 9, 10, 11],
///     [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7],
///     [4, 5, 9, 8], [5, 6, 10, 9], [6, 7, 11, 10], [7, 4, 8, 11],
/// ];
/// let points: Vec<[f64; 3]> = [0, 1, 2]
///     .into_iter()
///     .flat_map(|z| [[0, 0, z], [1, 0, z], [1, 1, z], [0, 1, z]])
///     .map(|p| p.map(f64::from))
///     .collect();
/// let surface = QuadSurface::try_new(12, &quads)?;
/// let made = shell(&surface, Some(&points), &ShellOptions::default(), &Context::default());
/// assert_eq!(made.coarse_quads, 6);
/// assert_eq!(made.meshes[0].mesh.n_hexes(), 2);
/// assert!(made.meshes[0].cost < 1e-3); // every edge has the hexes its angle wants
/// # Ok::<(), hexfill_mesh::SurfaceError>(())
/// ```
pub fn shell(
    surface: &QuadSurface,
    points: Option<&[[f64; 3]]>,
    options: &ShellOptions,
    ctx: &Context<'_>,
) -> Shelling {
    let wanted = wanted_hexes(surface, points);
    let (coarse, fine) = (Arc::new(compress(surface, &wanted)), Arc::new(uncompressed(surface, &wanted)));
    let shared = points.map(Arc::from);
    let shelling = Shelling { coarse_quads: coarse.surface.n_quads(), left: usize::MAX, ..Shelling::default() };
    let mut keeper = Keeper { surface, points, shared, coarse: &coarse, fine: &fine, options, shelling };
    if options.is_direct {
        keeper.fill_directly(&wanted, ctx);
    }
    for &pillows in &options.pillows {
        if !options.is_swept || keeper.shelling.is_perfect() || ctx.stop().is_some() {
            break;
        }
        if surface.n_components() > 1 {
            keeper.sweep_several(pillows, ctx);
        } else {
            keeper.sweep_one(pillows, ctx);
        }
    }
    keeper.shelling
}

impl Shelling {
    /// Whether a mesh gives every edge the hexes its angle wants: nothing is better then.
    fn is_perfect(&self) -> bool {
        self.meshes.iter().any(|m| m.cost < PERFECT)
    }
}

/// The surface in both sizes, and the meshes that are worth keeping.
struct Keeper<'a> {
    surface: &'a QuadSurface,
    points: Option<&'a [[f64; 3]]>,
    /// The same, for meshes to keep.
    shared: Option<Arc<[[f64; 3]]>>,
    coarse: &'a Arc<Coarse>,
    fine: &'a Arc<Coarse>,
    options: &'a ShellOptions,
    shelling: Shelling,
}

impl Keeper<'_> {
    /// The meshes that need no sweep: the cells of a grid, columns over a section, columns between two components.
    fn fill_directly(&mut self, wanted: &[f32], ctx: &Context<'_>) {
        let surface = self.surface;
        // A box is one cube, however many quads it has: cutting that one takes less than finding all its cells.
        if self.coarse.surface.n_quads() == 6 {
            return;
        }
        let cells = develop(surface, wanted, self.points).and_then(|d| polycube(surface, &d));
        let mut upright: Vec<Glued> = cells.into_iter().map(|hexes| Glued::at_once(Stage::Grid, hexes)).collect();
        if upright.is_empty() {
            upright.extend(columns(surface, wanted, self.points, ctx).into_iter().map(|made| Glued {
                start: self.points.and_then(|points| made.spread(points)),
                ..Glued::at_once(Stage::Columns, made.hexes)
            }));
        }
        if let Some(points) = self.points.filter(|_| upright.is_empty()) {
            upright.extend(blocks(surface, points, ctx).map(|hexes| Glued::at_once(Stage::Columns, hexes)));
        }
        // What is rounded or leans finds its right angles behind a pillow.
        let is_fine = surface.n_quads() <= MOST_FINE && self.options.pillows.contains(&1);
        let behind: Vec<Glued> = upright.iter().filter(|_| is_fine).map(|made| pillowed(surface, made)).collect();
        let is_bare = self.options.pillows.contains(&0);
        if is_bare {
            self.keep_direct(upright, ctx);
        }
        if self.shelling.is_perfect() || ctx.stop().is_some() {
            return;
        }
        self.keep(self.fine, 1, behind, ctx);
        if !is_bare {
            return;
        }
        let given = self.points.filter(|_| surface.n_components() > 1 && surface.n_quads() <= MOST_FINE);
        let between = given.and_then(|points| between(surface, points));
        self.keep_direct(between.map(|hexes| Glued::at_once(Stage::Columns, hexes)), ctx);
    }

    fn keep_direct(&mut self, meshes: impl IntoIterator<Item = Glued>, ctx: &Context<'_>) {
        if self.keep(self.fine, 0, meshes.into_iter().collect(), ctx) > 0 {
            self.shelling.left = 0;
        }
    }

    /// Sweeps a surface of one component: compressed, and as it is where handles are cut or compression left nothing that closes.
    fn sweep_one(&mut self, pillows: u32, ctx: &Context<'_>) {
        let meshes = Start::new(self.coarse, pillows).complete(self.options, &mut self.shelling.left, ctx);
        let found = self.keep(self.coarse, pillows, meshes, ctx);
        if self.surface.n_quads() > MOST_FINE || ctx.stop().is_some() {
            return;
        }
        let is_compressed = self.coarse.surface.n_quads() < self.surface.n_quads();
        match self.points {
            Some(given) if self.surface.genus() > 0 => self.sweep_cut_open(given, pillows, ctx),
            _ if found == 0 && is_compressed => {
                let start = Start::new(self.fine, pillows);
                let meshes = start.by_flips(self.options, &[], &mut self.shelling.left, ctx);
                self.keep(self.fine, pillows, meshes, ctx);
            }
            _ => (),
        }
    }

    /// Sweeps between the components of a surface once bridges join them.
    fn sweep_several(&mut self, pillows: u32, ctx: &Context<'_>) {
        let Some(given) = self.points.filter(|_| self.surface.n_quads() <= MOST_FINE && ctx.stop().is_none()) else {
            return;
        };
        self.sweep_cut_open(given, pillows, ctx);
    }

    /// Sweeps the surface with its components joined and its handles cut. Bridges and plugs join chords of all multiplicities, so they
    /// need the surface as it is.
    fn sweep_cut_open(&mut self, given: &[[f64; 3]], pillows: u32, ctx: &Context<'_>) {
        if let Some(start) = Start::new(self.fine, pillows).cut_open(given, self.surface, pillows) {
            let meshes = start.complete(self.options, &mut self.shelling.left, ctx);
            self.keep(self.fine, pillows, meshes, ctx);
        }
    }

    /// Lifts those meshes of `coarse` that no other beats in both cost and hexes, and keeps them; returns how many.
    fn keep(&mut self, coarse: &Arc<Coarse>, pillows: u32, meshes: Vec<Glued>, ctx: &Context<'_>) -> usize {
        let before = self.shelling.meshes.len();
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
        let wanted = n.min(self.options.candidates);
        for i in (0..wanted).map(|i| if wanted == 1 { 0 } else { i * (n - 1) / (wanted - 1) }) {
            let (d, glued) = &measured[i];
            let lifted = self.lifted(coarse, glued, d.cost, pillows, ctx);
            self.shelling.meshes.extend(lifted);
        }
        self.shelling.meshes.len() - before
    }

    /// The mesh of the surface that a coarse mesh becomes; `None` if it does not lift.
    fn lifted(
        &self,
        coarse: &Arc<Coarse>,
        glued: &Glued,
        cost: f32,
        pillows: u32,
        ctx: &Context<'_>,
    ) -> Option<Shelled> {
        let lifted = lift(coarse, self.surface.n_vertices() as u32, self.points, &glued.hexes, ctx).ok()?;
        let mesh = HexMesh::try_new(lifted.n_vertices as usize, &lifted.hexes).ok()?;
        let mut before = 0;
        let mut stages = Vec::new();
        for &(stage, n) in &glued.stages {
            let after = lifted.before[n];
            if after > before {
                stages.push((stage, after - before));
            }
            before = after;
        }
        let is_compressed = glued.hexes.len() < mesh.n_hexes();
        let points = self.shared.as_ref().filter(|_| is_compressed);
        let coarse = points.and_then(|points| CoarseMesh::new(coarse, points, &glued.hexes));
        // Lifting names inner vertices anew.
        let start = glued.start.as_ref().filter(|_| !is_compressed).map(|start| {
            let mut at = vec![[0.0; 3]; mesh.n_vertices()];
            let corners = lifted.hexes.iter().flatten().zip(glued.hexes.iter().flatten());
            corners.for_each(|(&new, &old)| at[new as usize] = start[old as usize]);
            at
        });
        let placed = start.filter(|at| is_valid(&lifted.hexes, at));
        let is_placed = placed.is_some();
        Some(Shelled { mesh, points: placed.or(lifted.points), is_placed, cost, pillows, stages, coarse })
    }
}

type Hexes = Vec<[u32; 8]>;

/// Coarse hexes in the order they were glued, and how many there were after each stage.
struct Glued {
    hexes: Hexes,
    stages: Vec<(Stage, usize)>,
    /// Positions of all vertices, where the engine knows some that may be valid.
    start: Option<Vec<[f64; 3]>>,
}

impl Glued {
    fn at_once(stage: Stage, hexes: Hexes) -> Self {
        Self { stages: vec![(stage, hexes.len())], hexes, start: None }
    }
}

/// Whether the determinant is positive at every corner.
fn is_valid(hexes: &[[u32; 8]], points: &[[f64; 3]]) -> bool {
    hexes.iter().all(|hex| {
        let at = hex.map(|v| points[v as usize]);
        (0..8).all(|k| {
            let [x, y, z] = CORNER_NEIGHBOURS[k].map(|i| sub(at[i], at[k]));
            det(x, y, z) > 0.0
        })
    })
}

/// A mesh inside a copy of the surface, with a hex between each quad and its copy.
fn pillowed(surface: &QuadSurface, made: &Glued) -> Glued {
    let n = surface.n_vertices() as u32;
    let first = made.hexes.iter().flatten().max().map_or(0, |v| v + 1).max(n);
    let copy = |v: u32| if v < n { first + v } else { v };
    let pillow = surface.quads_raw().into_iter().map(|q: [u32; 4]| {
        let [a, b, c, d] = q;
        [copy(a), copy(b), copy(c), copy(d), a, b, c, d]
    });
    let hexes: Hexes = pillow.chain(made.hexes.iter().map(|h| h.map(copy))).collect();
    let behind = made.stages.iter().map(|&(stage, n)| (stage, surface.n_quads() + n));
    Glued { stages: std::iter::once((Stage::Pillows, surface.n_quads())).chain(behind).collect(), hexes, start: None }
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
        Self { coarse, n_pillows, void, quads: coarse.surface.quads_raw() }
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
        let (mut meshes, partial) = self.by_layers(options, ctx);
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

    /// Complete coarse meshes by layers, and the sweeps that got stuck.
    fn by_layers(&self, options: &ShellOptions, ctx: &Context<'_>) -> (Vec<Glued>, Vec<Sweep>) {
        let n = self.void.quads.len() as u64;
        let restarts = (RESTART_WORK / (n * n).max(1)).clamp(MIN_RESTARTS.min(options.restarts), options.restarts);
        let sweeps = solve(&self.void, restarts, ctx);
        let (complete, partial): (Vec<_>, Vec<_>) = sweeps.into_iter().partition(Sweep::is_complete);
        let glued = |s: Sweep| {
            let n = s.void.hexes.len();
            self.glued(s.void.hexes, n, n)
        };
        (complete.into_iter().map(glued).collect(), partial)
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
        fronts.retain(|(_, front)| is_sphere(front) && front.n_quads() <= options.largest_residual);
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
            (Stage::Pillows, self.n_pillows),
            (Stage::Plugs, self.void.hexes.len()),
            (Stage::Layers, after_layers),
            (Stage::Flips, after_flips),
            (Stage::Residual, hexes.len()),
        ];
        Glued { hexes, stages, start: None }
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
    [front.closed(ctx), stirred.closed(ctx)].into_iter().flatten().map(|state| state.hexes().to_vec()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compress::compress;
    use crate::test_surfaces::boundary_of;

    /// A round shaft with an O-grid section, four quads in the core and `rings` rings of eight, the outermost of which ends `low` layers up: its surface, and
    /// the number of hexes of its sweep.
    fn stepped_shaft(rings: u32, low: u32, high: u32) -> (QuadSurface, Vec<[f64; 3]>, usize) {
        let per_level = 9 + 8 * rings;
        let mut points = Vec::new();
        for z in 0..=high {
            let core = (0..9).map(|i| [f64::from(i % 3) - 1.0, f64::from(i / 3) - 1.0].map(|x| 0.6 * x));
            let ring = (0..8 * rings).map(|i| {
                let turn = std::f64::consts::TAU * f64::from(i % 8 + 5) / 8.0;
                [turn.cos(), turn.sin()].map(|x| f64::from(2 + i / 8) * x)
            });
            points.extend(core.chain(ring).map(|[x, y]| [x, y, f64::from(z)]));
        }
        // Round the core from its first corner on, where the rings begin as well.
        let round =
            |ring: u32, i: u32| if ring == 0 { [0, 1, 2, 5, 8, 7, 6, 3][i as usize % 8] } else { 1 + 8 * ring + i % 8 };
        let core = [[0, 1, 4, 3], [1, 2, 5, 4], [3, 4, 7, 6], [4, 5, 8, 7]].map(|q| (0, q));
        let outside = (0..rings).flat_map(|r| {
            (0..8).map(move |i| (r + 1, [round(r, i), round(r + 1, i), round(r + 1, i + 1), round(r, i + 1)]))
        });
        let section: Vec<(u32, [u32; 4])> = core.into_iter().chain(outside).collect();
        let mut hexes = Vec::new();
        for z in 0..high {
            for (_, q) in section.iter().filter(|(ring, _)| z < low || *ring < rings) {
                let at = |i: usize| q[i % 4] + per_level * (z + i as u32 / 4);
                hexes.push(std::array::from_fn(at));
            }
        }
        let (surface, points) = boundary_of(&points, &hexes);
        (surface, points, hexes.len())
    }

    #[test]
    fn rings_that_end_in_two_places_are_columns() {
        for (rings, low, high) in [(2, 2, 4), (3, 1, 3)] {
            let (surface, points, known) = stepped_shaft(rings, low, high);
            let wanted = wanted_hexes(&surface, Some(&points));
            let coarse = compress(&surface, &wanted);
            // The rings of the wide end are one chord of the compressed surface, which no mesh of that surface has.
            assert!(coarse.length.contains(&rings), "{:?}", coarse.length);
            let made = shell(&surface, Some(&points), &ShellOptions::default(), &Context::default());
            let best = made.meshes.iter().min_by(|a, b| a.cost.total_cmp(&b.cost)).unwrap();
            assert_eq!((best.mesh.n_hexes(), best.pillows), (known, 0));
        }
    }
}
