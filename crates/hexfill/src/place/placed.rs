//! [`Placed`]: positions with the judge's verdict on every hex.
//!
//! Source: ours.

use crate::place::report::GeometryReport;
use hexfill_check::{CellQuality, Judged, cell_quality};
use hexfill_embed::{EmbedError, EmbedReport};
use hexfill_io::MeshData;
use hexfill_mesh::HexMesh;

/// Positions of all vertices of a mesh with the judge's verdict on every hex.
///
/// An array of quads is filled, and its worst cells are printed:
///
/// ```
/// use hexfill::{Context, FillOptions, PlaceOptions, Problem, fill_placed, mesh::QuadSurface};
///
/// // Two boxes on each other, the upper lid shifted and turned up on one side.
/// let floors = [[0.0, 0.0], [1.0, 0.4], [2.0, 1.3]]; // height, and shift of the corners
/// let points = floors.iter().flat_map(|&[z, x]| {
///     [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[a, b]| [a + x, b, z + 0.2 * z * b])
/// });
/// let mut quads = vec![[0, 3, 2, 1], [8, 9, 10, 11]];
/// quads.extend((0..8).map(|v| [v, v / 4 * 4 + (v + 1) % 4, v / 4 * 4 + (v + 1) % 4 + 4, v + 4]));
///
/// let problem = Problem::new("two boxes", QuadSurface::try_new(12, &quads)?, points.collect())?;
/// let made = fill_placed(&problem, &FillOptions::default(), &PlaceOptions::default(), &Context::default())?;
/// let (filled, placed) = made.meshes.first().expect("a sphere with an even number of quads");
/// let placed = placed.as_ref().expect("the surface has positions");
/// let mut cells: Vec<_> = placed.cells().iter().enumerate().collect();
/// cells.sort_by(|a, b| a.1.certified_lower.total_cmp(&b.1.certified_lower));
/// for (hex, cell) in cells.iter().take(3) {
///     println!("h{hex} {:?}: {:.3}", filled.mesh().hexes()[*hex], cell.certified_lower);
/// }
/// assert!(placed.is_certified() && placed.worst() == cells[0].1.certified_lower);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Placed {
    pub(crate) points: Vec<[f64; 3]>,
    pub(crate) cells: Vec<CellQuality>,
    pub(crate) embedding: Option<EmbedReport>,
    pub(crate) refused: Option<EmbedError>,
    pub(crate) ways: usize,
}

/// Half of the last digit that is printed of a scaled Jacobian.
const HALF_A_DIGIT: f64 = 0.5e-6;

/// The judge's numbers on every hex. Every vertex id of a `HexMesh` has a position here, so every hex has a quality.
fn judged_cells(mesh: &HexMesh, points: &[[f64; 3]]) -> Vec<CellQuality> {
    let hexes = mesh.hexes_raw();
    let judged = Judged::connectivity(mesh.n_vertices(), &hexes).with_points(points);
    cell_quality(&judged).into_iter().flatten().collect()
}

/// The scaled Jacobian of a hex as a field shows it: certified, or none.
pub(crate) fn shown(cell: &CellQuality) -> f64 {
    if cell.valid { cell.certified_lower } else { cell.corner_scaled_jacobian.min(0.0) }
}

impl Placed {
    /// A mesh at these positions, every hex judged. An embedding that failed must not leave more invalid hexes than it found: those that it
    /// started from are kept then, with the boundary's positions put back.
    pub(crate) fn judged(
        mesh: &HexMesh,
        boundary: &[[f64; 3]],
        mut points: Vec<[f64; 3]>,
        embedding: Option<EmbedReport>,
        start: Option<&[[f64; 3]]>,
    ) -> Self {
        let mut cells = judged_cells(mesh, &points);
        if let (Some(_), Some(start)) = (&embedding, start)
            && !cells.iter().all(|c| c.valid)
        {
            let before = judged_cells(mesh, start);
            let count = |cells: &[CellQuality]| cells.iter().filter(|c| c.valid).count();
            if count(&before) > count(&cells) {
                points.copy_from_slice(start);
                points[..boundary.len()].copy_from_slice(boundary);
                cells = before;
            }
        }
        Self { points, cells, embedding, refused: None, ways: 1 }
    }

    /// Position per vertex, in the unit of the surface; the surface's own come first, bit for bit.
    pub fn points(&self) -> &[[f64; 3]] {
        &self.points
    }

    /// The positions alone.
    pub fn into_points(self) -> Vec<[f64; 3]> {
        self.points
    }

    /// Per hex: its quality and whether det J > 0 was certified on all of it. Empty if nothing was judged.
    pub fn cells(&self) -> &[CellQuality] {
        &self.cells
    }

    /// What the embedding reports; absent if only start positions were asked for, no time was left, or none could be made.
    pub fn embedding(&self) -> Option<&EmbedReport> {
        self.embedding.as_ref()
    }

    /// Why there are no useful positions of the interior: the boundary's own do not span a solid.
    pub fn refused(&self) -> Option<&EmbedError> {
        self.refused.as_ref()
    }

    /// In how many ways the mesh lies on the surface, up to congruence. More than one if the surface has symmetries that its
    /// positions lack; 1 if that was not asked.
    pub fn ways(&self) -> usize {
        self.ways
    }

    /// Judges positions that were changed, if they had been judged before.
    pub(crate) fn judge_again(&mut self, mesh: &HexMesh) {
        if !self.cells.is_empty() {
            self.cells = judged_cells(mesh, &self.points);
        }
    }

    /// Whether det J > 0 is certified on all of every hex.
    pub fn is_certified(&self) -> bool {
        !self.cells.is_empty() && self.cells.iter().all(|c| c.valid)
    }

    /// The least certified scaled Jacobian of any point of any hex, up to 1 (a cube); -1 if a hex is not certified or nothing was judged.
    pub fn worst(&self) -> f64 {
        self.cells.iter().map(|c| c.certified_lower).fold(f64::INFINITY, f64::min)
    }

    /// The scaled Jacobians of the hexes that are certified.
    fn certified(&self) -> impl Iterator<Item = f64> + '_ {
        self.cells.iter().filter(|c| c.valid).map(|c| c.certified_lower.max(0.0))
    }

    fn volume_ratio(&self) -> Option<f64> {
        let volumes = || self.cells.iter().map(|c| c.volume);
        let (least, most) = (volumes().fold(f64::INFINITY, f64::min), volumes().fold(0.0, f64::max));
        // Those of very large coordinates are no numbers, those of very small ones zero.
        (least > 0.0 && least <= most && (most / least).is_finite()).then_some(most / least)
    }

    /// Placements with fewer hexes that are not certified rank higher, then those with a larger worst scaled Jacobian.
    pub(crate) fn rank(&self) -> (std::cmp::Reverse<usize>, f64) {
        (std::cmp::Reverse(self.cells.iter().filter(|c| !c.valid).count()), self.worst())
    }

    /// The numbers.
    pub fn report(&self) -> GeometryReport {
        let judged = !self.cells.is_empty();
        let corner = self.cells.iter().map(|c| c.corner_scaled_jacobian).fold(f64::INFINITY, f64::min);
        GeometryReport {
            certified: self.cells.iter().filter(|c| c.valid).count(),
            hexes: self.cells.len(),
            corner_scaled_jacobian: judged.then_some(corner),
            certified_scaled_jacobian: judged.then(|| self.worst()),
            mean_scaled_jacobian: judged.then(|| self.certified().sum::<f64>() / self.cells.len() as f64),
            histogram: judged.then(|| {
                let mut steps = [0; 10];
                // A bound that is printed as 0.500000 counts as 0.5.
                self.certified().for_each(|x| steps[((10.0 * (x + HALF_A_DIGIT)) as usize).min(9)] += 1);
                steps
            }),
            volume_ratio: self.volume_ratio(),
            edge_ratio: judged.then(|| self.cells.iter().map(|c| c.edge_ratio).fold(1.0, f64::max)),
            embedding: self.embedding.clone(),
            refused: self.refused.as_ref().map(ToString::to_string),
            ways: self.ways,
        }
    }

    /// Scaled Jacobian per hex, for colours: the certified one, or of a hex without certificate the least at its corners, at most 0. Empty if nothing was
    /// judged.
    pub fn scaled_jacobians(&self) -> Vec<f64> {
        self.cells.iter().map(shown).collect()
    }

    /// Gives file data of this mesh two numbers per hex, `certified_positive` (1 or 0) and `scaled_jacobian`. Those of an earlier
    /// judgement are replaced.
    pub fn flag(&self, data: &mut MeshData) {
        let certified = self.cells.iter().map(|c| f64::from(u8::from(c.valid))).collect();
        for (name, values) in [("certified_positive", certified), ("scaled_jacobian", self.scaled_jacobians())] {
            data.hex_data.retain(|(n, _)| n != name);
            data.hex_data.push((name.to_owned(), values));
        }
    }
}
