//! [`Valid`]: exchanges of balls that leave positions at least as good as they were.
//!
//! An exchange is admitted if the vertices it brings can be placed so that, among the hexes it puts in, no more fail the judge's certificate than among
//! those it takes out, and the smallest certified scaled Jacobian is no smaller. No vertex that stays is moved. So the number of hexes that are not certified and the
//! worst certified value of the whole mesh never get worse.
//!
//! Source: ours.

use hexfill_check::{Judged, cell_quality};
use hexfill_embed::{tutte_start, untangle_near};
use hexfill_mesh::{Context, HexMesh};
use hexfill_search::Gate;

/// Iterations on the hexes of an exchange, to find valid positions for what is new.
const ITERATIONS: usize = 60;

/// The gate of the positions. See the module page.
pub(crate) struct Valid {
    /// Per vertex id of the mesh at work.
    points: Vec<[f64; 3]>,
    /// The hexes and positions of the exchange admitted last, new vertices included.
    placed: Vec<[[f64; 3]; 8]>,
}

impl Valid {
    pub(crate) fn new(points: Vec<[f64; 3]>) -> Self {
        Self { points, placed: Vec::new() }
    }

    /// The position of a vertex id.
    pub(crate) fn point(&self, id: u32) -> [f64; 3] {
        self.points[id as usize]
    }
}

/// Hexes in numbers of their own, in order of appearance, and the vertex of each number; vertices from `first_new` on come last.
fn renumbered(hexes: &[[u32; 8]], first_new: u32) -> (Vec<[u32; 8]>, Vec<u32>) {
    let mut ids: Vec<u32> = hexes.iter().flatten().copied().collect();
    ids.sort_unstable();
    ids.dedup();
    debug_assert!(ids.is_sorted_by_key(|&v| v >= first_new));
    let number = |v: u32| ids.binary_search(&v).expect("collected above") as u32;
    (hexes.iter().map(|hex| hex.map(number)).collect(), ids)
}

/// Hexes that are not certified, and the smallest certified value of the others.
fn judged(hexes: &[[u32; 8]], points: &[[f64; 3]]) -> (usize, f64) {
    let cells = cell_quality(&Judged::connectivity(points.len(), hexes).with_points(points));
    let invalid = cells.iter().filter(|cell| cell.is_none_or(|c| !c.valid)).count();
    (invalid, cells.iter().flatten().filter(|c| c.valid).map(|c| c.certified_lower).fold(1.0, f64::min))
}

impl Gate for Valid {
    fn admits(&mut self, removed: &[[u32; 8]], added: &[[u32; 8]], first_new: u32) -> bool {
        let (old, ids) = renumbered(removed, u32::MAX);
        let before: Vec<[f64; 3]> = ids.iter().map(|&v| self.point(v)).collect();
        let (invalid, worst) = judged(&old, &before);
        let (new, ids) = renumbered(added, first_new);
        let Some(points) = positions(&new, &ids, first_new, &self.points) else { return false };
        let (invalid_after, worst_after) = judged(&new, &points);
        if invalid_after > invalid || worst_after < worst {
            return false;
        }
        self.placed = new.iter().map(|hex| hex.map(|v| points[v as usize])).collect();
        true
    }

    fn made(&mut self, added: &[[u32; 8]]) {
        for (hex, placed) in added.iter().zip(&self.placed) {
            for (&v, &point) in hex.iter().zip(placed) {
                if self.points.len() <= v as usize {
                    self.points.resize(v as usize + 1, [0.0; 3]);
                }
                self.points[v as usize] = point;
            }
        }
    }
}

/// Positions for the hexes of an exchange: those of old vertices as they are, new ones at means of their neighbours, then untangled. `None` if there is no start.
fn positions(hexes: &[[u32; 8]], ids: &[u32], first_new: u32, known: &[[f64; 3]]) -> Option<Vec<[f64; 3]>> {
    let n_old = ids.partition_point(|&v| v < first_new);
    let mut points: Vec<[f64; 3]> = ids[..n_old].iter().map(|&v| known[v as usize]).collect();
    if n_old == ids.len() {
        return Some(points);
    }
    points.resize(ids.len(), [0.0; 3]);
    let mesh = HexMesh::try_new(ids.len(), hexes).ok()?;
    let start = tutte_start(&mesh, &points).ok()?;
    untangle_near(&mesh, &start, 0, ITERATIONS, &Context::default()).ok().map(|(points, _)| points)
}
