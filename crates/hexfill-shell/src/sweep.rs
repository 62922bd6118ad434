//! Sweep: a surface is filled from its front inward by emptying the smallest lens of the front's dual, again and again.
//!
//! First come whole layers (pillows) if asked for, then the plugs of handles, then the sweep itself (see `sweeper`), then what is done about
//! chords that cross themselves (see `stir`),
//! and at last the atlas. On spheres whose chords are simple the sweep alone closes the void.
//!
//! Source: Folwell, Mitchell 1999 (curves contracted until the void is closed); plugs, stirring and the atlas at the end are ours.

use crate::front::{Front, NONE};
use crate::stir::stir_front;
use crate::sweep_options::SweepOptions;
use crate::sweeper::Sweeper;
use hexfill_geometry::cone;
use hexfill_mesh::{Context, QuadId, QuadSurface, StopReason};

/// Wants count as met when the flips cost less than this in all.
const MET: f64 = 1e-3;
/// What is wanted round the edges behind a pillow: this much of the surface's difference from flat.
const BEHIND_PILLOW: f32 = 0.3;

/// What a sweep made.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Swept {
    /// Number of vertices: those of the surface first, then the new ones.
    pub n_vertices: u32,
    /// The hexes, corners in VTK_HEXAHEDRON order, positively oriented with respect to the outward surface.
    pub hexes: Vec<[u32; 8]>,
    /// How many of the hexes plug handles; they come right after the pillows.
    pub plugs: usize,
    /// The quads still to fill, oriented as the surface (outward of what is left); empty when complete.
    pub front: Vec<[u32; 4]>,
    /// Why the sweep stopped early, if it did.
    pub stopped: Option<StopReason>,
}

/// Fills `surface` from its front inward. Each of its components must bound a ball (or a handlebody) of its own: more than one are swept
/// only if `points` shows that all face outward. Handles are cut by plugs, which
/// need `points`, a position for each vertex of the surface; without them a surface with handles is not filled to the end.
///
/// A surface with quads that meet improperly has no proper filling and comes back as it is: no hexes, all quads left.
///
/// # Example
/// ```
/// use hexfill_mesh::{Context, QuadSurface};
/// use hexfill_shell::{SweepOptions, sweep};
///
/// let quads = [
///     [0, 3, 2, 1], [8, 9, 10, 11],
///     [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7],
///     [4, 5, 9, 8], [5, 6, 10, 9], [6, 7, 11, 10], [7, 4, 8, 11],
/// ];
/// let surface = QuadSurface::try_new(12, &quads)?;
/// let swept = sweep(&surface, None, &SweepOptions::default(), &Context::default());
/// assert!(swept.front.is_empty() && swept.hexes.len() == 2);
/// # Ok::<(), hexfill_mesh::SurfaceError>(())
/// ```
pub fn sweep(
    surface: &QuadSurface,
    points: Option<&[[f64; 3]]>,
    options: &SweepOptions<'_>,
    ctx: &Context<'_>,
) -> Swept {
    let points = points.filter(|p| p.len() == surface.n_vertices());
    let start = (surface.n_components() == 1 || points.is_some_and(|p| all_face_outward(surface, p)))
        .then(|| Front::new(surface));
    let Some(Ok(mut front)) = start else {
        let front = surface.quads_raw();
        return Swept { n_vertices: surface.n_vertices() as u32, hexes: Vec::new(), plugs: 0, front, stopped: None };
    };
    let mut base: Vec<u32> = (0..surface.n_vertices() as u32).collect();
    let mut points: Option<Vec<[f64; 3]>> = points.map(<[_]>::to_vec);
    for _ in 0..options.pillows {
        let (layered, below) = front.pillowed();
        front = layered;
        base.extend(below.iter().map(|&v| base[v as usize]).collect::<Vec<_>>());
        if let Some(points) = &mut points {
            points.extend(below.iter().map(|&v| points[v as usize]).collect::<Vec<_>>());
        }
    }
    let n_pillows = front.hexes().len();
    if let Some(points) = &mut points {
        for handle in 0..surface.genus() {
            let Some(plugged) = ctx.stop().is_none().then(|| front.plug(points)).flatten() else { break };
            front = plugged;
            ctx.report("shelling", handle + 1, Some(surface.genus()), || "handles cut".to_owned());
        }
    }
    let plugs = front.hexes().len() - n_pillows;
    if let Some(want) = options.edge_want {
        front.set_wants(|a, b| {
            let (Some(&c), Some(&d)) = (base.get(a as usize), base.get(b as usize)) else { return 3.0 };
            match options.pillows {
                0 => want(c, d),
                _ => 2.0 + BEHIND_PILLOW * (want(c, d) - 2.0),
            }
        });
    }
    // Attempts differ by their seeds alone. With wants stated a closed front is not enough: the next attempts look
    // for one that costs less.
    let mut best: Option<(Front, f64)> = None;
    let mut stopped = None;
    // The last attempt is one without wants, if no other closed: it may, and then costs nothing worse than a search.
    let attempts = options.restarts.saturating_add(1);
    for attempt in 0..attempts.saturating_add(u32::from(front.has_wants())) {
        let closed = best.as_ref().is_some_and(|(front, _)| front.n_quads() == 0);
        if stopped.is_some() || closed && (attempt == attempts || best.as_ref().is_some_and(|(_, cost)| *cost < MET)) {
            break;
        }
        let mut state = front.clone();
        if attempt == attempts {
            state.clear_wants();
        }
        let seed = options.seed.wrapping_add(u64::from(attempt % attempts));
        let mut sweeper = Sweeper::new(&mut state, &SweepOptions { seed, ..*options });
        stopped = sweeper.run(ctx);
        let cost = sweeper.cost;
        let rank = |front: &Front, cost: f64| (front.n_quads(), cost, front.hexes().len());
        if best.as_ref().is_none_or(|(front, least)| rank(&state, cost) < rank(front, *least)) {
            best = Some((state, cost));
        }
    }
    let mut front = best.map_or(front, |(best, _)| best);
    // The boundary of any hex mesh has an even number of quads.
    if options.stir > 0 && front.n_quads() > 0 && front.n_quads().is_multiple_of(2) && stopped.is_none() {
        stopped = stir_front(&mut front, options.stir, options, ctx);
    }
    if let Some(closed) = options.atlas.filter(|_| front.n_quads() > 0).and_then(|atlas| front.closed_from(atlas)) {
        front = closed;
    }
    Swept { plugs, ..front.finish(stopped) }
}

/// Empties lenses of a front until none can be emptied; `None`, or why it stopped early.
pub fn sweep_front(front: &mut Front, options: &SweepOptions<'_>, ctx: &Context<'_>) -> Option<StopReason> {
    Sweeper::new(front, options).run(ctx)
}

/// Whether every component encloses a positive volume: none is a cavity of another.
fn all_face_outward(surface: &QuadSurface, points: &[[f64; 3]]) -> bool {
    let mut volume = vec![0.0; surface.n_components()];
    for (q, quad) in surface.quads().iter().enumerate() {
        volume[surface.component(QuadId::new(q))] += cone(quad.map(|v| points[v.index()]));
    }
    volume.into_iter().all(|v| v > 0.0)
}

impl Front {
    /// The state after one more whole layer: a hex on every front quad, its other end on a copy of the front. With it, for
    /// each new vertex the one it is a copy of.
    pub fn pillowed(&self) -> (Self, Vec<u32>) {
        let mut below = Vec::new();
        let mut copy = vec![NONE; self.n_vertices() as usize];
        let mut n_vertices = self.n_vertices();
        let (mut hexes, mut quads) = (self.hexes().to_vec(), self.quads());
        for quad in &mut quads {
            let inner = quad.map(|v| {
                let slot = &mut copy[v as usize];
                if *slot == NONE {
                    *slot = n_vertices;
                    n_vertices += 1;
                    below.push(v);
                }
                *slot
            });
            let ([a, b, c, d], [e, f, g, h]) = (inner, *quad);
            hexes.push([a, b, c, d, e, f, g, h]);
            *quad = inner;
        }
        let state = self.with(n_vertices, &hexes, &quads).expect("a copy of a proper front meets nothing else");
        (state, below)
    }

    /// The result, with the vertices numbered without gaps: those of the surface keep their ids.
    pub fn finish(&self, stopped: Option<StopReason>) -> Swept {
        let (mut hexes, mut front) = (self.hexes().to_vec(), self.quads());
        let mut used = vec![false; self.n_vertices() as usize];
        let first_new = self.n_kept();
        used[..first_new as usize].fill(true);
        hexes.iter().flatten().for_each(|&v| used[v as usize] = true);
        let mut n_vertices = 0;
        let name: Vec<u32> = used
            .iter()
            .map(|&used| {
                n_vertices += u32::from(used);
                n_vertices.wrapping_sub(1)
            })
            .collect();
        hexes.iter_mut().flatten().for_each(|v| *v = name[*v as usize]);
        front.iter_mut().flatten().for_each(|v| *v = name[*v as usize]);
        Swept { n_vertices, hexes, plugs: 0, front, stopped }
    }
}
