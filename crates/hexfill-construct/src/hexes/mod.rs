//! Step 5: hexes. Cells and core become one hex mesh by looking up the ids of their points; nothing is glued by hashing.
//! (The splitting of tets: Erickson 2014, figure 8.)
//!
//! Source: Erickson 2014, section 5 and figure 8.

mod cells;
pub(crate) mod tets;

use crate::core::Inside;
use crate::core::complex::TetComplex;
use crate::cut::Sigma;
use crate::error::ConstructError;
use crate::ids::{PointId, TetId};
use crate::layer::Layer;
use crate::plan::{Plan, stage};
use crate::report::Report;
use cells::{count_cells, place_cells};
use hexfill_geometry::Vector;
use hexfill_mesh::{Context, HexMesh, IdVec};
use std::ops::Range;
use tets::{CorePoints, core_points, split_tets};

/// The hexes, and where they come from.
pub(crate) struct Hexes {
    /// Those of the layer, then those of the core, tet by tet.
    pub(crate) hexes: Vec<[PointId; 8]>,
    /// The points of the core, which come last.
    pub(crate) core: CorePoints,
    /// Per tet its first hex, and one entry more.
    first: IdVec<TetId, usize>,
}

/// Makes the hexes of layer and core. The report gets their numbers.
///
/// # Errors
/// [`ConstructError::TooLarge`], [`ConstructError::NoCell`], [`ConstructError::TetBoundary`], [`ConstructError::Stopped`].
pub(crate) fn hexes(
    plan: &Plan<'_>,
    inside: &Inside,
    layer: &Layer<'_>,
    cut: &Sigma,
    ctx: &Context<'_>,
) -> Result<(Hexes, Report), ConstructError> {
    stage("cells", ctx)?;
    let (cells, n_inner) = count_cells(layer, plan.library)?;
    let report = Report::new(plan, inside, layer, cells, n_split(&inside.complex, cut));
    // Known before the first hex is made, because cells and splits are counted from the patterns and Sigma.
    if report.n_hexes() > HexMesh::MAX_HEXES {
        return Err(ConstructError::TooLarge { what: "hexes", given: report.n_hexes(), limit: HexMesh::MAX_HEXES });
    }
    let mut hexes = Vec::with_capacity(report.n_hexes());
    place_cells(layer, plan.library, &mut hexes, ctx)?;
    stage("core", ctx)?;
    let core = core_points(plan, inside, layer, cut, layer.end().index() + n_inner)?;
    let mut first: IdVec<TetId, usize> = IdVec::with_capacity(inside.complex.tets.len() + 1);
    let mut next = hexes.len();
    for edges in &inside.complex.tet_edges {
        first.push(next);
        next += 4 + edges.iter().filter(|&&e| cut[e]).count();
    }
    first.push(next);
    split_tets(&inside.complex, cut, &core, &mut hexes);
    debug_assert!(hexes.len() == report.n_hexes() && hexes.len() == next);
    Ok((Hexes { hexes, core, first }, report))
}

/// How many tets are split into 4, 7 and 8 hexes: by the number of their edges that Sigma cuts, 0, 3 or 4.
fn n_split(complex: &TetComplex, cut: &Sigma) -> [usize; 3] {
    let mut n = [0usize; 3];
    for edges in &complex.tet_edges {
        n[match edges.iter().filter(|&&e| cut[e]).count() {
            0 => 0,
            3 => 1,
            _ => 2,
        }] += 1;
    }
    n
}

impl Hexes {
    /// The hexes of a tet.
    pub(crate) fn hexes_of(&self, t: TetId) -> Range<usize> {
        self.first[t]..self.first[TetId(t.0 + 1)]
    }

    /// Renumbers the inner points that hexes use, in order, of `n_points` in all.
    pub(crate) fn close_gaps(&mut self, n_surface: usize, n_points: usize, start: Option<&mut IdVec<PointId, Vector>>) {
        let mut used: IdVec<PointId, bool> = IdVec::filled(false, n_points);
        self.hexes.iter().flatten().for_each(|&p| used[p] = true);
        used.as_mut_slice()[..n_surface].fill(true);
        let mut number: IdVec<PointId, PointId> = IdVec::filled(PointId::NONE, n_points);
        let mut next = PointId(0);
        for (p, _) in used.enumerate().filter(|(_, used)| **used) {
            number[p] = next;
            next = next.plus(1);
        }
        self.hexes.iter_mut().flatten().for_each(|p| *p = number[*p]);
        self.core.end = next;
        if let Some(start) = start {
            let mut used = used.iter();
            start.retain(|_| used.next().is_some_and(|u| *u));
        }
    }
}
