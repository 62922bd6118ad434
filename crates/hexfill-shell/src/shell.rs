//! The engine: candidates for a surface, best first.

use crate::angles::wanted_hexes;
use crate::compress::compress;
use crate::lift::lift;
use crate::solve::solve;
use hexfill_mesh::{Context, HexMesh, QuadSurface};

/// What to try.
#[derive(Clone, Debug)]
pub struct ShellOptions {
    /// Restarts of the solver for each number of pillows.
    pub restarts: u64,
    /// Numbers of pillows to try.
    pub pillows: Vec<u32>,
    /// Candidates wanted.
    pub candidates: usize,
}

impl Default for ShellOptions {
    fn default() -> Self {
        Self { restarts: 64, pillows: vec![0, 1], candidates: 4 }
    }
}

/// A complete mesh.
#[derive(Clone, Debug)]
pub struct Shelled {
    /// The mesh; the surface's vertices keep their ids, interior vertices follow.
    pub mesh: HexMesh,
    /// How far its edges are from the hexes they want: 0 is perfect. Comparable among meshes of one surface and pillows only.
    pub cost: f32,
    /// Pillows under the surface.
    pub pillows: u32,
}

/// What shelling brought.
#[derive(Clone, Debug, Default)]
pub struct Shelling {
    /// Complete meshes, best first for each number of pillows.
    pub meshes: Vec<Shelled>,
    /// Quads of the compressed surface.
    pub coarse_quads: usize,
    /// Fewest coarse quads that a sweep left, where none was complete.
    pub left: usize,
}

/// Sweeps a surface inward. `points`: one position per vertex of the surface, outward orientation.
pub fn shell(
    surface: &QuadSurface,
    points: Option<&[[f64; 3]]>,
    options: &ShellOptions,
    ctx: &Context<'_>,
) -> Shelling {
    let coarse = compress(surface, &wanted_hexes(surface, points));
    let mut shelling = Shelling { coarse_quads: coarse.surface.n_quads(), left: usize::MAX, ..Shelling::default() };
    for &pillows in &options.pillows {
        let mut kept = 0;
        for sweep in solve(&coarse, pillows, options.restarts, ctx) {
            shelling.left = shelling.left.min(sweep.void.quads.len());
            if !sweep.is_complete() || kept >= options.candidates {
                break;
            }
            let Ok((n, hexes)) = lift(&coarse, surface.n_vertices() as u32, &sweep.void.hexes) else { continue };
            let Ok(mesh) = HexMesh::try_new(n as usize, &hexes) else { continue };
            shelling.meshes.push(Shelled { mesh, cost: sweep.cost, pillows });
            kept += 1;
        }
    }
    shelling
}

impl std::fmt::Display for Shelling {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "shelling from {} coarse quads: ", self.coarse_quads)?;
        match self.meshes.len() {
            0 if self.left == usize::MAX => write!(f, "stopped"),
            0 => write!(f, "{} quads left", self.left),
            n => write!(f, "{n} meshes"),
        }
    }
}
