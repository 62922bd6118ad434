//! [`lay`]: the verb.
//!
//! Source: ours (book, page `shelling`, "Laying").

use crate::fewer::without_sheets;
use crate::frame::Frame;
use crate::laid_mesh::LaidMesh;
use crate::laying::{Laying, Underway};
use crate::open_mesh::{OpenMesh, Part, swept};
use crate::patch::Patch;
use crate::pieces::Pieces;
use hexfill_embed::untangle_near;
use hexfill_geometry::Vector;
use hexfill_mesh::{Context, HexMesh, QuadSurface};
use rayon::prelude::*;

/// How far to go. Counts bound the work, not a clock.
///
/// | option | default |
/// |---|---|
/// | attempts | 4 at once |
/// | batches of these | 2 |
/// | most hexes | 14 a quad of the void |
/// | sheets | 60 |
#[derive(Clone, Copy, Debug)]
pub struct LayOptions {
    attempts: u64,
    batches: u64,
    most: f64,
    sheets: u32,
}

impl Default for LayOptions {
    fn default() -> Self {
        Self { attempts: 4, batches: 2, most: 14.0, sheets: 60 }
    }
}

impl LayOptions {
    /// Meshes begun at once, each from another plan; on surfaces of fewer than 600 quads round after round, as often as they go into 600, or until five rounds
    /// brought none with fewer hexes.
    #[must_use]
    pub fn with_attempts(self, attempts: u64) -> Self {
        Self { attempts, ..self }
    }

    /// Times all these rounds are begun, until one attempt comes to its end.
    #[must_use]
    pub fn with_batches(self, batches: u64) -> Self {
        Self { batches, ..self }
    }

    /// Most hexes for each quad of the void while laying.
    #[must_use]
    pub fn with_most(self, most: f64) -> Self {
        Self { most, ..self }
    }

    /// Sheets whose loss is tried at most, for each mesh.
    #[must_use]
    pub fn with_sheets(self, sheets: u32) -> Self {
        Self { sheets, ..self }
    }
}

/// On surfaces of fewer quads more meshes are begun, about as many more as it is smaller: what fills a void is a matter of luck, and a small one costs little.
const SMALL: u64 = 600;
/// After so many rounds that brought none with fewer hexes there are no more.
const STALE: u64 = 5;
/// Meshes from which sheets are taken: those with fewest hexes. An attempt that has more is given up.
const KEPT: usize = 6;
/// On surfaces of more quads only the one with fewest invalid hexes, then fewest hexes is given, as embedding another takes too long.
const LARGE: usize = 500;
/// Rings of vertices that are free round what is mended once pieces are joined.
const MENDED_RINGS: usize = 2;
/// Plans for one mesh: a jam that pillows do not clear asks for another.
const PLANS: u64 = 12;
/// Plans in turn that find no hex for a front before it is given up: each stirs for seconds, and where two found none twelve did not either.
const FRUITLESS: u64 = 2;

/// Lays meshes for a surface whose vertices are at `points` (outward orientation), fewest hexes first; none if no sweep of it leaves one void that can be
/// held open, or no attempt came to its end. At most one on surfaces of more than 500 quads, which are cut across their waists first, and each piece laid for
/// itself. The same for any number of threads.
pub fn lay(surface: &QuadSurface, points: &[Vector], options: &LayOptions, ctx: &Context<'_>) -> Vec<LaidMesh> {
    if let Some(laid) = in_pieces(surface, points, options, ctx) {
        return vec![laid];
    }
    let most = if surface.n_quads() > LARGE { 1 } else { KEPT };
    lay_whole(surface, points, options, Part::Whole, most, ctx)
}

/// The mesh of a surface that is cut into pieces; `None` if it is not, or one of them cannot be filled.
fn in_pieces(surface: &QuadSurface, points: &[Vector], options: &LayOptions, ctx: &Context<'_>) -> Option<LaidMesh> {
    let pieces = Pieces::of(surface, points).filter(|pieces| pieces.pieces.len() > 1)?;
    let laid = pieces.pieces.par_iter().map(|(piece, ids)| {
        let meshes = lay_whole(piece, &pieces.points_of(ids), options, Part::Piece, 1, ctx);
        meshes.into_iter().next()
    });
    let mut laid = pieces.joined(surface, laid.collect::<Option<_>>()?)?;
    if laid.invalid > 0 {
        mend(&mut laid, ctx);
    }
    laid.points[..points.len()].copy_from_slice(points);
    Some(laid)
}

/// Untangles what is not valid in the mesh of all pieces: the membranes, which stayed while the pieces were laid, may move now.
fn mend(laid: &mut LaidMesh, ctx: &Context<'_>) {
    let quiet = Context { progress: None, ..*ctx };
    if let Ok((points, bad)) = untangle_near(&laid.mesh, &laid.points, MENDED_RINGS, 0, &quiet)
        && bad.len() < laid.invalid
    {
        (laid.points, laid.invalid) = (points, bad.len());
    }
}

/// [`lay`] without a cut, at most `most` meshes. Of several that are kept the one of fewest hexes comes first, a single one is that with fewest invalid hexes.
fn lay_whole(
    surface: &QuadSurface,
    points: &[Vector],
    options: &LayOptions,
    part: Part,
    most: usize,
    ctx: &Context<'_>,
) -> Vec<LaidMesh> {
    let frame = Frame::of(points);
    let within: Vec<Vector> = points.iter().map(|&p| frame.enter(p)).collect();
    let open = swept(surface, &within, part, ctx);
    if open.is_empty() {
        return Vec::new();
    }
    // A piece is one of many, and hexes saved there are few of all.
    let rounds = if part == Part::Piece { 1 } else { (SMALL / surface.n_quads().max(1) as u64).max(1) };
    let mut voids: Vec<&OpenMesh> = open.iter().collect();
    for batch in 0..options.batches {
        let mut filled: Vec<Filled<'_>> = Vec::new();
        // The round that brought the mesh with fewest hexes.
        let mut best = 0;
        for round in batch * rounds..(batch + 1) * rounds {
            if voids.is_empty() || !filled.is_empty() && round > best + STALE {
                break;
            }
            let fewest = filled.first().map(Filled::n_hexes);
            // As many at once as asked for, and not more: what a round finds bounds the next one, for any number of threads.
            let most = filled.get(KEPT - 1).map_or(usize::MAX, |last| last.n_hexes() - 1);
            let numbers = round * options.attempts..(round + 1) * options.attempts;
            let begun = numbers.into_par_iter().map(|number| {
                // Of several at once one speaks.
                let quiet = if number % options.attempts == 0 { *ctx } else { Context { progress: None, ..*ctx } };
                let open = voids[number as usize % voids.len()];
                (open, Filled::new(open, number, options.most, most, &quiet))
            });
            for (open, result) in begun.collect::<Vec<_>>() {
                match result {
                    Ok(mesh) => filled.push(mesh),
                    // Nor would others find one, after seconds of stirring each.
                    Err(GivenUp::NoPlan) => voids.retain(|other| !std::ptr::eq(*other, open)),
                    Err(GivenUp::OnTheWay) => {}
                }
            }
            // Stable: among equals the first attempt.
            filled.sort_by_key(Filled::n_hexes);
            filled.dedup_by(|a, b| a.is_same(b));
            filled.truncate(KEPT);
            if filled.first().map(Filled::n_hexes) != fewest {
                best = round;
            }
        }
        if filled.is_empty() && ctx.stop().is_none() {
            continue;
        }
        let mut laid: Vec<LaidMesh> =
            filled.into_par_iter().filter_map(|filled| filled.whole(options.sheets, part, ctx)).collect();
        laid.sort_by_key(|laid| laid.mesh.n_hexes());
        if most == 1 {
            // Stable: of those with fewest invalid hexes.
            laid.sort_by_key(|laid| laid.invalid);
        }
        laid.truncate(most);
        for laid in &mut laid {
            laid.points.iter_mut().for_each(|p| *p = frame.leave(*p));
            laid.points[..points.len()].copy_from_slice(points);
        }
        return laid;
    }
    Vec::new()
}

/// A void that is filled, with what lies round it.
struct Filled<'a> {
    open: &'a OpenMesh,
    patch: Patch,
    laid: LaidMesh,
}

impl<'a> Filled<'a> {
    /// Fills the void by the plans of that number, with at most so many hexes for each of its quads, and so many in all.
    fn new(open: &'a OpenMesh, number: u64, a_quad: f64, in_all: usize, ctx: &Context<'_>) -> Result<Self, GivenUp> {
        let patch = Patch::round(open);
        let most = (patch.n_hexes() + (a_quad * open.front.len() as f64) as usize)
            .min(in_all.saturating_add(patch.n_hexes()).saturating_sub(open.hexes.len()));
        let Laying { open: full, pillows, .. } =
            to_the_end(Laying::new(patch.cut_out(open)), ctx.seed + number, most, ctx)?;
        let mesh = HexMesh::try_new(full.points.len(), &full.hexes).map_err(|_| GivenUp::OnTheWay)?;
        // The pillow under the surface is the first.
        let (points, steps, invalid) = (full.points, full.steps, full.forgiven.len());
        let laid = LaidMesh { mesh, points, steps, invalid, pillows: 1 + pillows };
        Ok(Self { open, patch, laid })
    }

    fn n_hexes(&self) -> usize {
        self.open.hexes.len() - self.patch.n_hexes() + self.laid.mesh.n_hexes()
    }

    /// Whether both came out alike: from the same void by the same hexes.
    fn is_same(&self, other: &Self) -> bool {
        std::ptr::eq(self.open, other.open) && self.laid.mesh == other.laid.mesh
    }

    /// The whole mesh, without sheets it can do without near the void.
    fn whole(self, sheets: u32, part: Part, ctx: &Context<'_>) -> Option<LaidMesh> {
        let laid = without_sheets(self.laid, self.patch.n_fixed(), sheets, part, ctx);
        self.patch.put_back(self.open, laid)
    }
}

/// Why an attempt did not come to its end.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum GivenUp {
    /// No plan has a hex for the void as the sweep left it.
    NoPlan,
    /// It jammed, had too many hexes, or was told to stop.
    OnTheWay,
}

/// Lays hexes until nothing is open, but at most `most`.
fn to_the_end(mut laying: Laying, seed: u64, most: usize, ctx: &Context<'_>) -> Result<Laying, GivenUp> {
    if laying.open.front.is_empty() {
        return Ok(laying);
    }
    let mut plans = 0;
    // A plan knows nothing of what is outside: it needs a pillow between.
    laying.pillow(&mut [], ctx);
    let mut underway = next_plan(&laying, seed, &mut plans, ctx).ok_or(GivenUp::NoPlan)?;
    // Pillows since the last hex; a new plan begins right behind one.
    let mut jams = 1;
    while !laying.open.front.is_empty() {
        if ctx.stop().is_some() || laying.open.hexes.len() + fewest(&laying) > most {
            return Err(GivenUp::OnTheWay);
        }
        ctx.report("laying", laying.open.hexes.len() as u64, None, || {
            format!("{} hexes laid, {} quads open", laying.open.hexes.len(), laying.open.front.len())
        });
        // Hexes that make the front grow only once a pillow has not helped.
        if !underway.is_over() && laying.lay_one(&mut underway, jams > 0, ctx) {
            jams = 0;
            continue;
        }
        if jams == 0 || jams == 1 && !underway.is_over() {
            if laying.open.hexes.len() + laying.open.front.len() + fewest(&laying) > most {
                return Err(GivenUp::OnTheWay);
            }
            laying.pillow(&mut underway.ids, ctx);
            jams += 1;
        }
        if underway.is_over() || jams >= 2 {
            underway = next_plan(&laying, seed, &mut plans, ctx).ok_or(GivenUp::OnTheWay)?;
            jams = 1;
        }
    }
    Ok(laying)
}

/// Hexes that what is open takes at the least: put together one by one, they have four quads more each, after the first six.
fn fewest(laying: &Laying) -> usize {
    laying.open.front.len().saturating_sub(2).div_ceil(4)
}

/// The next plan for a front behind a pillow; `None` after too many, or if none is found for this front.
fn next_plan(laying: &Laying, seed: u64, plans: &mut u64, ctx: &Context<'_>) -> Option<Underway> {
    (*plans..PLANS.min(*plans + FRUITLESS)).find_map(|number| {
        *plans = number + 1;
        laying.planned(if number == 0 { seed } else { 100 * seed + number }, ctx)
    })
}
