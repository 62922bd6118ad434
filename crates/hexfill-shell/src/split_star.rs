//! Split stars: a second interior edge at surface vertices where a single one cannot be good.
//!
//! The corners at a surface vertex v whose hexes share one interior edge are good only if one direction sees all quads of v. On real
//! surfaces some vertices have none, and no layer of one hex a quad is valid there, whatever lies behind it. Cut the fan of v into two arcs, and
//! *shrink* the hexes on the quads of one arc (the set A, see [`cells`]): the new hexes that fill the gap give v
//! a second interior edge, each arc is seen along its own, and two new corners lie between them at the edges where the arcs meet.
//! Every other surface vertex of A is split as well, so arcs are chosen by what *all* of them can reach, and A may
//! take in further quads where that helps.
//!
//! What a star can reach is computed from the directions of its fixed edges alone ([`hexfill_geometry::climb_star`]), so it says
//! what positions allow, not what they will be.
//! Where the hexes at v do not lie one a quad round one edge (meshes of the construction), all hexes at v may be shrunk first, which puts
//! such a layer there; where stars without any valid placement are left, a layer under the whole surface may help.
//!
//! Invariant: boundary quads and the ids of their vertices never change; new vertices follow the old ones.
//!
//! Source: ours; Reberol et al. 2023 solve the same need by integer programs over the fans of all vertices.

mod choose;
#[cfg(test)]
mod tests;

use crate::cells::{self, Cells};
use choose::{Choice, Chooser};
use hexfill_mesh::{Context, HexMesh, QuadSurface, VertexId};

/// When a layer of hexes goes under the whole surface first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Layer {
    /// Never.
    Never,
    /// If stars are left that no placement makes valid, and fewer are with the layer.
    #[default]
    IfInvalid,
    /// Always: the mesh behind it need not have any edges at surface vertices.
    Always,
}

/// When to split.
///
/// | option | default |
/// |---|---|
/// | below | a scaled Jacobian of 0.1 |
/// | gain | 0.05 |
/// | layer | [`Layer::IfInvalid`] |
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SplitOptions {
    below: f64,
    gain: f64,
    layer: Layer,
}

impl Default for SplitOptions {
    fn default() -> Self {
        Self { below: 0.1, gain: 0.05, layer: Layer::default() }
    }
}

impl SplitOptions {
    /// Vertices whose star can reach less than this scaled Jacobian are split, if that helps.
    #[must_use]
    pub fn with_below(self, below: f64) -> Self {
        Self { below, ..self }
    }

    /// A split must raise its vertex by this much at least; a fifth of it will do where no placement is valid.
    #[must_use]
    pub fn with_gain(self, gain: f64) -> Self {
        Self { gain, ..self }
    }

    /// Whether a layer of hexes goes under the whole surface.
    #[must_use]
    pub fn with_layer(self, layer: Layer) -> Self {
        Self { layer, ..self }
    }

    /// Vertices whose star can reach less than this scaled Jacobian are split.
    pub fn below(&self) -> f64 {
        self.below
    }
}

/// One vertex that was split.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SplitVertex {
    /// The surface vertex.
    pub vertex: VertexId,
    /// The best worst corner its star could reach before (scaled Jacobian, by directions only).
    pub before: f64,
    /// And after.
    pub after: f64,
    /// How many hexes that cost.
    pub hexes: usize,
}

/// A mesh with split stars.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct SplitStars {
    /// The mesh: the same boundary, hexes and vertices added.
    pub mesh: HexMesh,
    /// The vertices split, in the order of the work.
    pub splits: Vec<SplitVertex>,
    /// The vertices whose star still cannot reach [`SplitOptions::below`], ascending, with what it can.
    pub left: Vec<(VertexId, f64)>,
    /// Whether a layer under the whole surface was added.
    pub layered: bool,
}

/// Splits the stars of surface vertices that are too poor, where that helps. See the module page.
///
/// `points[v]` is the position of every vertex v on the boundary, in any unit; other entries are not read. Returns `None` if nothing was changed
/// (none is poor, nothing helps, or the boundary is no closed oriented surface with finite positions). Deterministic, for any
/// number of threads, unless the context cuts it short; then the splits so far are returned.
///
/// The time grows with the number of poor vertices, some 10 to 100 ms each.
pub fn split_stars(
    mesh: &HexMesh,
    points: &[[f64; 3]],
    options: &SplitOptions,
    context: &Context<'_>,
) -> Option<SplitStars> {
    let quads: Vec<[u32; 4]> = mesh.boundary_quads_raw();
    let surface = QuadSurface::try_new(mesh.n_vertices(), &quads).ok().filter(|s| s.reversed().is_empty())?;
    let placed = |v: &VertexId| points.get(v.index()).is_some_and(|p| p.iter().all(|x| x.is_finite()));
    if !surface.quads().iter().flatten().all(placed) {
        return None;
    }
    let chooser = Chooser::new(&surface, points, *options);
    // Asked of the surface and not of the mesh: no layer of one hex a quad serves these, whatever lies behind.
    let poor = chooser.vertices_no_direction_serves();
    let behind_layer = || {
        let mut cells = Cells::new(mesh);
        let all: Vec<u32> = (0..mesh.n_hexes() as u32).collect();
        cells.shrink(&all, &quads);
        let splits = split_all(&chooser, &mut cells, &poor, context);
        (cells, splits)
    };
    let mut layered = options.layer == Layer::Always;
    let (mut cells, mut splits) = if layered {
        behind_layer()
    } else {
        let mut cells = Cells::new(mesh);
        let splits = split_all(&chooser, &mut cells, &poor, context);
        (cells, splits)
    };
    let n_invalid =
        |cells: &Cells| chooser.still_poor(cells, &poor).iter().filter(|left| left.1 <= choose::NOTHING).count();
    if options.layer == Layer::IfInvalid && n_invalid(&cells) > 0 && context.stop().is_none() {
        // From the start again: splits made without the layer are not needed behind it.
        let other = behind_layer();
        if n_invalid(&other.0) < n_invalid(&cells) && context.stop().is_none() {
            ((cells, splits), layered) = (other, true);
        }
    }
    if splits.is_empty() && !layered {
        return None;
    }
    let left = chooser.still_poor(&cells, &poor).into_iter().map(|(v, value)| (VertexId(v), value)).collect();
    Some(SplitStars { mesh: cells.to_mesh().ok()?, splits, left, layered })
}

/// Splits the poor vertices, worst first, until none can be helped.
fn split_all(chooser: &Chooser<'_>, cells: &mut Cells, poor: &[u32], context: &Context<'_>) -> Vec<SplitVertex> {
    const PASSES: usize = 3;
    let mut splits = Vec::new();
    for _ in 0..PASSES {
        let mut open = chooser.still_poor(cells, poor);
        // Worst first, since a split takes room from its neighbours and the worst have least to spare; ties by id, so
        // that the order is fixed.
        open.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
        let before = splits.len();
        for (v, _) in open {
            if context.stop().is_some() {
                return splits;
            }
            // An earlier split may have helped, or harmed within what is allowed.
            let value = chooser.value(cells, v);
            if value >= chooser.options.below {
                continue;
            }
            let n_hexes = cells.n_hexes();
            let helped = match chooser.best_choice(cells, v) {
                Some(choice) => {
                    apply(cells, &choice);
                    true
                }
                None => split_behind_layer(chooser, cells, v),
            };
            if helped {
                let (after, hexes) = (chooser.value(cells, v), cells.n_hexes() - n_hexes);
                splits.push(SplitVertex { vertex: VertexId(v), before: value, after, hexes });
            }
        }
        if splits.len() == before {
            break;
        }
    }
    splits
}

fn apply(cells: &mut Cells, choice: &Choice) {
    cells.shrink(&choice.set, &choice.skin);
}

/// Shrinks all hexes at the vertex, so that there is one on each of its quads, then splits; takes both back if the
/// vertices touched can reach no more than before.
fn split_behind_layer(chooser: &Chooser<'_>, cells: &mut Cells, v: u32) -> bool {
    let set = cells.hexes_at(v).to_vec();
    let skin = cells.skin(&set);
    if !cells::is_sphere(&skin) {
        return false;
    }
    let before = chooser.total_penalty(cells, &skin);
    let undo = cells.shrink(&set, &skin);
    if let Some(choice) = chooser.best_choice(cells, v) {
        let undo_split = cells.shrink(&choice.set, &choice.skin);
        let both: Vec<[u32; 4]> = skin.iter().chain(&choice.skin).copied().collect();
        if chooser.total_penalty(cells, &both) < before && chooser.value(cells, v) >= chooser.options.gain {
            return true;
        }
        cells.undo(&undo_split);
    }
    cells.undo(&undo);
    false
}
