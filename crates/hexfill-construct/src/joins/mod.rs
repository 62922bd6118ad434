//! Step 7: two components with odd numbers of quads are joined by a chain of hexes.
//!
//! A buffer cube needs an odd number of heavy sides, so a component with an odd number of quads leaves one cube over
//! whose boundary is odd; it is left open. Two such cubes of one solid are joined by hexes of the core, each sharing a
//! quad with the next (Erickson 2014 pairs odd components in the same way). The two cubes and the chain together are one
//! ball with an even number of quads, 1 + 1 - 2 + 4 per hex modulo 2, and a small sphere is filled by the construction itself:
//! the driver does that, here are the balls and what becomes of their fillings.
//! Why this stays proper: the boundary of the ball consists of quads of a complex that is proper, so it is a proper
//! surface (checked, as is that it is one sphere), and in a mesh made by the construction a hex meets the boundary in a face
//! of one quad only.
//!
//! Source: Erickson 2014 (odd components are paired); the ball that is filled again is ours.

mod chain;
pub(crate) mod no_chain;

use crate::cells::library::CellLibrary;
use crate::core::complex::sorted;
use crate::core::cone::BallCore;
use crate::core::corridors::Corridor;
use crate::error::ConstructError;
use crate::hexes::Hexes;
use crate::ids::PointId;
use crate::layer::Layer;
use crate::options::ConstructOptions;
use crate::report::Construction;
use chain::{ball, chain};
use hexfill_geometry::Vector;
use hexfill_mesh::cube::FACETS;
use hexfill_mesh::{Context, IdVec, QuadSurface};
use no_chain::NoChain;
use std::collections::{BTreeMap, BTreeSet};

/// Two open cubes and their chain, to be filled.
pub(crate) struct Ball {
    /// Its boundary, which is proper.
    pub(crate) surface: QuadSurface,
    /// Positions of its vertices, if known.
    pub(crate) points: Option<Vec<Vector>>,
    /// Vertex of the mesh for each of its vertices; further vertices of a filling are new.
    points_of: Vec<PointId>,
    /// Indices of the core hexes that are replaced, ascending.
    removed: Vec<usize>,
}

/// How balls are filled: with the same cells and as few hexes as possible.
pub(crate) fn ball_options(library: &CellLibrary) -> ConstructOptions {
    ConstructOptions { library: Some(library.clone()), ball_core: BallCore::Fewest, ..ConstructOptions::default() }
}

/// Finds a chain among the core hexes of a corridor's tets. `start` are positions of all vertices, if known.
///
/// # Errors
/// [`ConstructError::OddJoin`]; [`ConstructError::Stopped`].
pub(crate) fn ball_of(
    corridor: &Corridor,
    layer: &Layer<'_>,
    made: &Hexes,
    start: Option<&IdVec<PointId, Vector>>,
    ctx: &Context<'_>,
) -> Result<Ball, ConstructError> {
    let hexes = made.hexes.as_slice();
    let cubes = corridor.quads.map(|q| {
        let quads = layer.pattern(q).boundary().into_iter();
        quads.map(|quad| quad.map(|r| layer.point(q, r))).collect::<Vec<_>>()
    });
    let near: BTreeSet<PointId> = cubes.iter().flatten().flatten().copied().collect();
    // Ordered maps: which of several chains is taken must not hang on a hash.
    let mut hexes_at: BTreeMap<[PointId; 4], Vec<usize>> = BTreeMap::new();
    for h in corridor.tets.iter().flat_map(|&t| made.hexes_of(t)) {
        for f in FACETS {
            hexes_at.entry(sorted(f.map(|k| hexes[h][k]))).or_default().push(h);
        }
    }
    let at = |quad: &[PointId; 4]| hexes_at.get(&sorted(*quad)).and_then(|h| h.first().copied());
    let goals: BTreeSet<usize> = cubes[1].iter().filter_map(at).collect();
    let starts: BTreeSet<usize> = cubes[0].iter().filter_map(at).collect();
    let mut reason = NoChain::NoHexes;
    // A chain that touches itself or the cubes away from its ends is no ball; another pair of ends gives another
    // chain.
    for (&first, &last) in starts.iter().flat_map(|s| goals.iter().map(move |g| (s, g))) {
        if let Some(stop) = ctx.stop() {
            return Err(ConstructError::Stopped(stop));
        }
        let Some(mut chain) = chain(first, last, hexes, &hexes_at, &near) else { continue };
        match ball(&cubes, &chain, hexes) {
            Ok((surface, points_of)) => {
                chain.sort_unstable();
                let points = start.map(|start| points_of.iter().map(|&p| start[p]).collect());
                return Ok(Ball { surface, points, points_of, removed: chain });
            }
            Err(e) => reason = e,
        }
    }
    Err(ConstructError::OddJoin { components: corridor.components, reason })
}

/// Puts the fillings in the place of the chains, and renumbers points so that no inner one is without a hex.
///
/// # Errors
/// [`ConstructError::TooLarge`].
pub(crate) fn replace(
    fillings: &[(Ball, Construction)],
    n_surface: usize,
    made: &mut Hexes,
    mut start: Option<&mut IdVec<PointId, Vector>>,
) -> Result<(), ConstructError> {
    if fillings.is_empty() {
        return Ok(());
    }
    let mut n_points = made.core.end.index();
    let mut removed = vec![false; made.hexes.len()];
    let mut added: Vec<[PointId; 8]> = Vec::new();
    for (ball, filling) in fillings {
        ball.removed.iter().for_each(|&h| removed[h] = true);
        let n_old = ball.points_of.len();
        let first = n_points;
        n_points += filling.mesh.n_vertices() - n_old;
        if n_points > u32::MAX as usize {
            return Err(ConstructError::TooLarge { what: "vertices", given: n_points, limit: u32::MAX as usize });
        }
        // The filling keeps the ids of its surface, which come first (the invariant of all fillings), so gluing is
        // renumbering.
        let place = |v: usize| if v < n_old { ball.points_of[v] } else { PointId::new(first + v - n_old) };
        added.extend(filling.mesh.hexes().iter().map(|h| h.map(|v| place(v.index()))));
        if let Some(start) = &mut start {
            match &filling.start {
                Some(inner) => start.extend(inner[n_old..].iter().copied()),
                None => start.resize(n_points, [0.0; 3]),
            }
        }
    }
    let mut kept = removed.iter();
    made.hexes.retain(|_| kept.next().is_some_and(|r| !r));
    made.hexes.extend(added);
    made.close_gaps(n_surface, n_points, start);
    Ok(())
}

impl Ball {
    /// Hexes of the core that it takes the place of.
    pub(crate) fn n_removed(&self) -> usize {
        self.removed.len()
    }
}
