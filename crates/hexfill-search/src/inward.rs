//! Filling a surface that is not in the atlas: glue hexes inward until what is left is.
//!
//! A beam search over cavities. A hex glued inside covers quads of the cavity seen from its other side, so the flips are
//! those of a growing ball on the mirrored surface. The pairs that the glued hexes use become blocked, and the atlas
//! filling of the rest must avoid them: then the whole obeys proper intersection, by the same pair table that makes a
//! single flip legal.
//!
//! Source: Verhetsel et al. 2019, figure 1 (flips from the boundary until the cavity is a known one); the beam and the blocked pairs are ours.

use crate::atlas::Atlas;
use crate::canonical::Canonical;
use crate::cavity::{Cavity, MAX_QUADS};
use crate::flip::{Placement, apply, legal_flips};
use crate::grow::class_hash;
use crate::hole::Hole;
use hexfill_mesh::{Context, HexMesh, QuadSurface, StopReason};
use rayon::prelude::*;
use rustc_hash::FxHashSet;
use xxhash_rust::xxh3::xxh3_128;

/// What to look for.
///
/// | option | default |
/// |---|---|
/// | hexes at most | 4096 |
/// | count | 1 |
/// | beam | 1000 |
/// | cavities at most | 1,000,000 |
/// | improve | no |
#[derive(Clone, Copy, Debug)]
pub struct FillOptions {
    max_hexes: u32,
    count: usize,
    beam: usize,
    max_cavities: u64,
    improve: bool,
}

impl Default for FillOptions {
    fn default() -> Self {
        Self { max_hexes: 4096, count: 1, beam: 1000, max_cavities: 1_000_000, improve: false }
    }
}

impl FillOptions {
    /// Most hexes a filling may have.
    #[must_use]
    pub fn with_max_hexes(self, max_hexes: u32) -> Self {
        Self { max_hexes, ..self }
    }

    /// How many different fillings to look for.
    #[must_use]
    pub fn with_count(self, count: usize) -> Self {
        Self { count, ..self }
    }

    /// How many cavities the beam keeps on each level.
    #[must_use]
    pub fn with_beam(self, beam: usize) -> Self {
        Self { beam, ..self }
    }

    /// How many cavities to look at before giving up: a bound that does not depend on the clock.
    #[must_use]
    pub fn with_max_cavities(self, max_cavities: u64) -> Self {
        Self { max_cavities, ..self }
    }

    /// Look on for smaller fillings after the first until the context stops the search or the beam is empty.
    #[must_use]
    pub fn with_improve(self, improve: bool) -> Self {
        Self { improve, ..self }
    }

    /// How many cavities the beam keeps on each level.
    pub fn beam(&self) -> usize {
        self.beam
    }
}

/// A filling of a small sphere.
#[derive(Clone, Debug)]
pub struct Filling {
    /// The mesh; the surface's vertices keep their ids, interior vertices follow.
    pub mesh: HexMesh,
    /// How many hexes were glued inward before the atlas took over.
    pub glued: u32,
}

/// What a search brought.
#[derive(Clone, Debug)]
pub struct FillOutcome {
    /// Fillings, fewest hexes first; not isomorphic by construction only in their last steps (compare signatures).
    pub fillings: Vec<Filling>,
    /// Cavities looked at.
    pub cavities: u64,
    /// Why the search ended. [`StopReason::Finished`] with no filling means: the beam ran dry, which proves nothing.
    pub stop: StopReason,
}

/// A hex glued on the way, as a chain towards the surface.
struct Glued {
    hex: [u32; 8],
    before: Option<u32>,
}

/// A flip of a hole on the beam: as small as it can be sorted by, since most are dropped. Mesh vertices ascend with those of the
/// cavity, so that the corners of two flips of one hole compare as their hexes do.
struct Child {
    score: u32,
    parent: u32,
    key: u128,
    placement: Placement,
    /// Fewest hexes on record for what is left.
    hint: Option<u32>,
}

/// What a thread works out children with.
struct Workspace {
    canonical: Canonical,
    name: Vec<u8>,
}

/// Fills a sphere of at most [`MAX_QUADS`] quads: the atlas first, then inward flips.
/// `None` if the surface is not such a sphere. The surface must be 3-connected, else nothing proper exists.
///
/// # Example
/// ```
/// use hexfill_mesh::{Context, QuadSurface};
/// use hexfill_search::{Atlas, FillOptions, fill_from_atlas};
///
/// let quads = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];
/// let cube = QuadSurface::try_new(8, &quads)?;
/// let made = fill_from_atlas(&cube, Atlas::embedded(), &FillOptions::default(), &Context::default());
/// let made = made.expect("a sphere of at most 64 quads");
/// assert_eq!(made.fillings[0].mesh.n_hexes(), 1);
/// # Ok::<(), hexfill_mesh::SurfaceError>(())
/// ```
pub fn fill_from_atlas(
    surface: &QuadSurface,
    atlas: &Atlas,
    options: &FillOptions,
    ctx: &Context<'_>,
) -> Option<FillOutcome> {
    fill_avoiding(surface, &[], atlas, options, ctx)
}

/// [`fill_from_atlas`] where some pairs of vertices are joined already by an edge or a diagonal of cells outside the surface, so
/// that the filling must not join them. Pairs on the surface's own quads, and pairs of other vertices, are passed over.
pub fn fill_avoiding(
    surface: &QuadSurface,
    joined: &[[u32; 2]],
    atlas: &Atlas,
    options: &FillOptions,
    ctx: &Context<'_>,
) -> Option<FillOutcome> {
    let (mut cavity, ids) = Cavity::from_surface(surface)?;
    let pairs = cavity.surface_pairs();
    // A pair that is an edge or a diagonal of the surface itself is in the pair table already, with the quad that
    // both sides share: blocking it would forbid that quad.
    for pair in joined {
        if let [Ok(a), Ok(b)] = pair.map(|v| ids.binary_search(&v))
            && a != b
            && pairs[a] >> b & 1 == 0
        {
            cavity.block(a as u8, b as u8);
        }
    }
    let mut search = Search { atlas, options, trail: Vec::new(), found: Vec::new(), seen: FxHashSet::default() };
    let hole = Hole::inside(&cavity, ids, surface.n_vertices() as u32);
    // The surface itself may be in the atlas: no hex is glued then.
    search.close_with_atlas(&hole, 0);
    let mut outcome = FillOutcome { fillings: Vec::new(), cavities: 1, stop: StopReason::Finished };
    let mut beam = vec![hole];
    let mut depth = 0;
    while !search.is_satisfied() && !beam.is_empty() {
        if let Some(stop) = ctx.stop() {
            outcome.stop = stop;
            break;
        }
        depth += 1;
        if depth + 1 > search.most_allowed() || outcome.cavities >= options.max_cavities {
            break;
        }
        let (next, looked_at, stop) = search.step(beam, depth, ctx);
        beam = next;
        outcome.cavities += looked_at;
        ctx.report("inward flips", u64::from(depth), None, || {
            let best = search.best().map_or("none yet".to_owned(), |b| b.to_string());
            let quads = beam.iter().map(|h| h.cavity.n_quads()).min().unwrap_or(0);
            format!("{} cavities, smallest {quads} quads, best filling: {best}", outcome.cavities)
        });
        if let Some(stop) = stop {
            outcome.stop = stop;
            break;
        }
    }
    search.found.sort_by_key(|(mesh, glued)| (mesh.n_hexes(), *glued));
    outcome.fillings = search.found.into_iter().map(|(mesh, glued)| Filling { mesh, glued }).collect();
    Some(outcome)
}

struct Search<'a> {
    atlas: &'a Atlas,
    options: &'a FillOptions,
    trail: Vec<Glued>,
    found: Vec<(HexMesh, u32)>,
    seen: FxHashSet<u128>,
}

impl Search<'_> {
    fn best(&self) -> Option<u32> {
        self.found.iter().map(|(m, _)| m.n_hexes() as u32).min()
    }

    /// The largest filling still worth finding.
    fn most_allowed(&self) -> u32 {
        match self.best() {
            Some(best) if self.options.count == 1 => best - 1,
            _ => self.options.max_hexes,
        }
    }

    fn is_satisfied(&self) -> bool {
        self.found.len() >= self.options.count && !self.options.improve
    }

    /// Tries to fill a hole from the atlas; keeps every fit that is small enough, up to the count asked for.
    fn close_with_atlas(&mut self, hole: &Hole, depth: u32) {
        let sphere = hole.sphere();
        for ball in self.atlas.balls_for(&sphere) {
            if depth + ball.n_hexes() as u32 > self.most_allowed() {
                break;
            }
            for (map, mirrored) in ball.placements(&sphere) {
                let ids: Vec<u32> = map.iter().map(|&v| hole.ids[usize::from(v)]).collect();
                let (mut hexes, fresh) = ball.hexes_in(&ids, mirrored, hole.n_vertices);
                let mut at = hole.last;
                while let Some(i) = at {
                    hexes.push(self.trail[i as usize].hex);
                    at = self.trail[i as usize].before;
                }
                if let Ok(mesh) = HexMesh::try_new((hole.n_vertices + fresh) as usize, &hexes) {
                    self.found.push((mesh, depth));
                }
                if self.is_satisfied() {
                    return;
                }
                // Other placements of the same ball on an unblocked boundary are images under its automorphisms.
                if depth == 0 {
                    break;
                }
            }
        }
    }

    /// One level inward.
    fn step(&mut self, beam: Vec<Hole>, depth: u32, ctx: &Context<'_>) -> (Vec<Hole>, u64, Option<StopReason>) {
        let most = self.most_allowed();
        let workspace = || Workspace { canonical: Canonical::new(), name: Vec::new() };
        let mut children: Vec<Child> = beam
            .par_iter()
            .enumerate()
            .map_init(workspace, |workspace, (parent, hole)| {
                if ctx.stop().is_some() {
                    return Vec::new();
                }
                self.children(hole, parent as u32, depth, most, workspace)
            })
            .flatten_iter()
            .collect();
        if let Some(stop) = ctx.stop() {
            return (Vec::new(), 0, Some(stop));
        }
        let looked_at = children.len() as u64;
        // A set for all depths: the same cavity deeper down costs more hexes, so it is never better.
        children.retain(|c| !self.seen.contains(&c.key));
        children.sort_unstable_by_key(|c| (c.score, c.key, c.parent, c.placement.corners));
        children.dedup_by_key(|c| c.key);
        self.seen.extend(children.iter().map(|c| c.key));
        children.truncate(self.options.beam);
        let mut next = Vec::with_capacity(children.len());
        for child in children {
            let parent = &beam[child.parent as usize];
            let hole = parent.after(&child.placement, self.trail.len() as u32);
            self.trail.push(Glued { hex: parent.hex(&child.placement), before: parent.last });
            // The hint is the fewest hexes of its class, blocked pairs left aside: a lower bound that saves the
            // replay of fillings that are too large.
            if child.hint.is_some_and(|h| depth + h <= self.most_allowed()) {
                self.close_with_atlas(&hole, depth);
                if self.is_satisfied() {
                    return (Vec::new(), looked_at, None);
                }
            }
            next.push(hole);
        }
        (next, looked_at, None)
    }

    fn children(&self, hole: &Hole, parent: u32, depth: u32, most: u32, workspace: &mut Workspace) -> Vec<Child> {
        let Workspace { canonical, name } = workspace;
        let mut children = Vec::new();
        for placement in legal_flips(&hole.cavity, MAX_QUADS) {
            let (cavity, _) = apply(&hole.cavity, &placement);
            canonical.compute(&cavity);
            let hint = self.atlas.hexes_hint(class_hash(canonical.code()));
            if hint.is_some_and(|h| depth + h > most) {
                continue;
            }
            let image = canonical.blocked_image(&cavity).0;
            name.clear();
            name.extend_from_slice(canonical.code());
            for row in &image[..cavity.n_vertices()] {
                name.extend_from_slice(&row.to_le_bytes());
            }
            let score = match hint {
                // Known fillings first, fewest hexes first; then small holes with few blocked pairs.
                Some(h) => h,
                None => 100 + 16 * cavity.n_quads() as u32 + cavity.n_blocked(),
            };
            children.push(Child { score, parent, key: xxh3_128(name), placement, hint });
        }
        children
    }
}
