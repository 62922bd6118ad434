//! Coordinates for a filling, and what the judge says of them cell by cell. Never more is said than was shown.

use crate::fill::Filled;
use crate::placement::placements;
use crate::problem::Problem;
use hexfill_check::{CellQuality, Judged, cell_quality};
use hexfill_embed::{EmbedError, EmbedReport, canonical_polyhedron, embed, tutte_start};
use hexfill_io::MeshData;
use hexfill_mesh::Context;
use serde::Serialize;

/// Positions of all vertices of a mesh with the judge's verdict on every hex.
#[derive(Clone, Debug)]
pub struct Placed {
    /// Position per vertex; the surface's own come first, bit for bit.
    pub points: Vec<[f64; 3]>,
    /// Per hex: its quality and whether det J > 0 was certified on all of it. Empty if nothing was judged.
    pub cells: Vec<CellQuality>,
    /// What the embedding reports; absent if only start positions were asked for, no time was left, or none could be made.
    pub embedding: Option<EmbedReport>,
    /// Why there are no useful positions of the interior: the boundary's own do not span a solid.
    pub refused: Option<String>,
    /// In how many ways the mesh lies on the surface, up to congruence. More than one if the surface has symmetries that its
    /// positions lack; 1 if that was not asked.
    pub ways: usize,
}

/// Numbers about the geometry of a mesh, for people and for JSON.
#[derive(Clone, Debug, Serialize)]
pub struct GeometryReport {
    /// Hexes with det J > 0 certified everywhere.
    pub certified: usize,
    /// Hexes judged: all of them, or none where only start positions were asked for.
    pub hexes: usize,
    /// Least scaled Jacobian at the corners of any hex.
    pub corner_scaled_jacobian: Option<f64>,
    /// Certified lower bound of the least scaled Jacobian over whole hexes; -1 if a hex is not certified.
    pub certified_scaled_jacobian: Option<f64>,
    /// Mean of the certified scaled Jacobians; hexes that are not certified count as 0.
    pub mean_scaled_jacobian: Option<f64>,
    /// Hexes by certified scaled Jacobian, in ten steps of 0.1 from 0; hexes that are not certified are in none of them.
    pub histogram: Option<[usize; 10]>,
    /// The largest volume of a hex divided by the smallest; absent if one is not positive.
    pub volume_ratio: Option<f64>,
    /// The largest ratio of the longest to the shortest edge of a hex.
    pub edge_ratio: Option<f64>,
    /// What the embedding reports.
    pub embedding: Option<EmbedReport>,
    /// Why the boundary's positions cannot be used.
    pub refused: Option<String>,
    /// In how many ways the mesh lies on the surface, up to congruence; the best of them was kept.
    pub ways: usize,
}

/// The positions of a problem's vertices: its own, or those of the canonical polyhedron of a sphere without any.
pub fn boundary_points(problem: &Problem) -> Option<Vec<[f64; 3]>> {
    match &problem.points {
        Some(points) => Some(points.clone()),
        None if problem.surface.is_sphere() => canonical_polyhedron(&problem.surface).ok(),
        None => None,
    }
}

/// Start positions alone: the construction's, or Tutte's. Nothing is judged.
pub fn start_positions(filled: &Filled, boundary: &[[f64; 3]], ctx: &Context<'_>) -> Placed {
    let (points, _, refused) = positions_or_none(filled, boundary, None, ctx);
    Placed { points, cells: Vec::new(), embedding: None, refused, ways: 1 }
}

/// Most ways to lie on the surface that are embedded, a mesh.
const MOST_WAYS: usize = 6;

/// Places a filling: with `options` it is embedded, without it gets start positions only (the construction's, or Tutte's).
/// Boundary positions that cannot be used (all in one spot, say) cost the geometry, never the mesh: interior vertices then
/// lie on a boundary vertex, and `refused` says why.
///
/// A mesh without start positions is turned on the surface (its connectivity changes to an isomorphic one) if it embeds
/// better another way.
pub fn place(
    filled: &mut Filled,
    problem: &Problem,
    boundary: &[[f64; 3]],
    options: Option<&hexfill_embed::Options>,
    ctx: &Context<'_>,
) -> Placed {
    match options {
        Some(options) if filled.start.is_none() => {
            let (turned, placed) = place_best(std::slice::from_ref(filled), problem, boundary, options, ctx)
                .expect("one mesh is given, so one is best");
            *filled = turned;
            placed
        }
        _ => place_as_it_is(filled, boundary, options, ctx),
    }
}

/// Embeds fillings of one surface, each in all the ways it lies on it, and returns the best: most hexes certified, then the
/// largest worst scaled Jacobian. Those with larger star bounds come first, and none is tried whose bound is no
/// better than what was reached. `None` if there are no fillings.
pub fn place_best(
    meshes: &[Filled],
    problem: &Problem,
    boundary: &[[f64; 3]],
    options: &hexfill_embed::Options,
    ctx: &Context<'_>,
) -> Option<(Filled, Placed)> {
    let mut all: Vec<(f64, usize, Filled)> = Vec::new();
    for filled in meshes {
        if filled.start.is_some() {
            all.push((f64::INFINITY, 1, filled.clone()));
            continue;
        }
        let ways = placements(&filled.mesh, &problem.surface, boundary);
        let n = ways.len();
        all.extend(ways.into_iter().take(MOST_WAYS).map(|way| {
            let turned = Filled { mesh: way.mesh, start: None, ..filled.clone() };
            (way.upper_bound, n, turned)
        }));
    }
    // Stable: first come, first served among equals.
    all.sort_by(|a, b| b.0.total_cmp(&a.0));
    let n_tried = all.len() as u64;
    let mut best: Option<(Filled, Placed)> = None;
    for (number, (upper_bound, ways, turned)) in all.into_iter().enumerate() {
        // Upper bounds hold up to rounding.
        if let Some((_, b)) = &best
            && (b.is_certified() && b.worst() + 1e-9 >= upper_bound || ctx.stop().is_some())
        {
            break;
        }
        ctx.report("placements", number as u64, Some(n_tried), || match &best {
            Some((_, b)) => format!("best scaled Jacobian {:.4}", b.worst()),
            None => String::new(),
        });
        let placed = Placed { ways, ..place_as_it_is(&turned, boundary, Some(options), ctx) };
        if best.as_ref().is_none_or(|(_, b)| placed.rank() > b.rank()) {
            best = Some((turned, placed));
        }
    }
    best
}

/// [`place`] without turning.
pub(crate) fn place_as_it_is(
    filled: &Filled,
    boundary: &[[f64; 3]],
    options: Option<&hexfill_embed::Options>,
    ctx: &Context<'_>,
) -> Placed {
    let (points, embedding, refused) = positions_or_none(filled, boundary, options, ctx);
    place_from(filled, boundary, points, embedding, refused)
}

/// A filling at these positions, judged.
pub(crate) fn place_points(
    filled: &Filled,
    boundary: &[[f64; 3]],
    points: Vec<[f64; 3]>,
    embedding: Option<EmbedReport>,
) -> Placed {
    place_from(filled, boundary, points, embedding, None)
}

/// [`positions`]; where there are none, interior vertices at a boundary vertex and the reason.
fn positions_or_none(
    filled: &Filled,
    boundary: &[[f64; 3]],
    options: Option<&hexfill_embed::Options>,
    ctx: &Context<'_>,
) -> (Vec<[f64; 3]>, Option<EmbedReport>, Option<String>) {
    match positions(filled, boundary, options, ctx) {
        Ok((mut points, embedding)) => {
            // The surface's points come back bit for bit, those that no quad uses included.
            points[..boundary.len()].copy_from_slice(boundary);
            (points, embedding, None)
        }
        Err(why) => {
            let anywhere = boundary.first().copied().unwrap_or_default();
            let mut points = boundary.to_vec();
            points.resize(filled.mesh.n_vertices(), anywhere);
            (points, None, Some(why.to_string()))
        }
    }
}

/// An embedding that is told to stop at once still smooths and judges meshes of so few hexes in a moment.
const QUICK: usize = 10_000;

/// Positions by the embedding, or to start from.
fn positions(
    filled: &Filled,
    boundary: &[[f64; 3]],
    options: Option<&hexfill_embed::Options>,
    ctx: &Context<'_>,
) -> Result<(Vec<[f64; 3]>, Option<EmbedReport>), EmbedError> {
    // Out of time, a large mesh stays as it is.
    let is_late = ctx.stop().is_some() && filled.start.is_some() && filled.mesh.n_hexes() > QUICK;
    Ok(match options.filter(|_| !is_late) {
        Some(options) => {
            let made = embed(&filled.mesh, boundary, filled.start.as_deref(), options, ctx)?;
            (made.points, Some(made.report))
        }
        None => match &filled.start {
            Some(start) => (start.clone(), None),
            None => (tutte_start(&filled.mesh, boundary)?, None),
        },
    })
}

/// The better of two placements kept, every hex judged, the boundary's positions put back.
fn place_from(
    filled: &Filled,
    boundary: &[[f64; 3]],
    mut points: Vec<[f64; 3]>,
    embedding: Option<EmbedReport>,
    refused: Option<String>,
) -> Placed {
    let mut cells = judged_cells(filled, &points);
    if let (Some(_), Some(start)) = (&embedding, &filled.start)
        && !cells.iter().all(|c| c.valid)
    {
        // An embedding that failed must not leave more invalid cells than it found.
        let before = judged_cells(filled, start);
        let count = |cells: &[CellQuality]| cells.iter().filter(|c| c.valid).count();
        if count(&before) > count(&cells) {
            points.clone_from(start);
            points[..boundary.len()].copy_from_slice(boundary);
            cells = before;
        }
    }
    Placed { points, cells, embedding, refused, ways: 1 }
}

/// The judge's numbers on every hex. Every vertex id of a `HexMesh` has a position here, so every hex has a quality.
fn judged_cells(filled: &Filled, points: &[[f64; 3]]) -> Vec<CellQuality> {
    let hexes = filled.mesh.hexes_raw();
    let judged = Judged::connectivity(filled.mesh.n_vertices(), &hexes).with_points(points);
    cell_quality(&judged).into_iter().flatten().collect()
}

impl Placed {
    /// Judges positions that were changed, if they had been judged before.
    pub(crate) fn judge_again(&mut self, filled: &Filled) {
        if !self.cells.is_empty() {
            self.cells = judged_cells(filled, &self.points);
        }
    }

    /// Whether det J > 0 is certified on all of every hex.
    pub fn is_certified(&self) -> bool {
        !self.cells.is_empty() && self.cells.iter().all(|c| c.valid)
    }

    /// The least certified scaled Jacobian; -1 if a hex is not certified.
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
        (!self.cells.is_empty() && least > 0.0 && (most / least).is_finite()).then_some(most / least)
    }

    /// Placements with fewer hexes that are not certified rank higher, then those with a larger worst scaled Jacobian.
    fn rank(&self) -> (std::cmp::Reverse<usize>, f64) {
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
                self.certified().for_each(|x| steps[((10.0 * x) as usize).min(9)] += 1);
                steps
            }),
            volume_ratio: self.volume_ratio(),
            edge_ratio: judged.then(|| self.cells.iter().map(|c| c.edge_ratio).fold(1.0, f64::max)),
            embedding: self.embedding.clone(),
            refused: self.refused.clone(),
            ways: self.ways,
        }
    }

    /// Certified scaled Jacobian per hex, for colours.
    pub fn scaled_jacobians(&self) -> Vec<f64> {
        self.cells.iter().map(|c| if c.valid { c.certified_lower } else { c.corner_scaled_jacobian.min(0.0) }).collect()
    }

    /// Gives file data two numbers per hex: whether it is certified (1 or 0), and its scaled Jacobian. Those of an earlier
    /// judgement are replaced.
    pub fn flag(&self, data: &mut MeshData) {
        let certified = self.cells.iter().map(|c| f64::from(u8::from(c.valid))).collect();
        for (name, values) in [("certified_positive", certified), ("scaled_jacobian", self.scaled_jacobians())] {
            data.hex_data.retain(|(n, _)| n != name);
            data.hex_data.push((name.to_owned(), values));
        }
    }
}

impl GeometryReport {
    /// A line about all hexes, not only the worst; `None` if nothing was judged.
    pub fn distribution(&self) -> Option<String> {
        let (mean, steps) = (self.mean_scaled_jacobian?, self.histogram?);
        let shown: Vec<String> =
            steps.iter().enumerate().filter(|(_, n)| **n > 0).map(|(i, n)| format!("{n} from 0.{i}")).collect();
        let digits = usize::from(self.volume_ratio.is_some_and(|r| r < 100.0));
        let volumes =
            self.volume_ratio.map_or(String::new(), |r| format!("; volumes differ by a factor of {r:.digits$}"));
        Some(format!("mean {mean:.3}; {}{volumes}", shown.join(", ")))
    }
}

impl std::fmt::Display for GeometryReport {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (Some(certified), Some(corner)) = (self.certified_scaled_jacobian, self.corner_scaled_jacobian) else {
            return match &self.refused {
                Some(why) => write!(f, "no positions were made: {why}"),
                None => write!(f, "start positions, neither embedded nor judged"),
            };
        };
        if self.certified == self.hexes {
            return write!(
                f,
                "det J > 0 certified in {}, scaled Jacobian at least {certified:.6} (corners {corner:.6})",
                if self.hexes == 1 { "the hex".to_owned() } else { format!("all {} hexes", self.hexes) }
            );
        }
        write!(f, "det J > 0 certified in {} of {} hexes only", self.certified, self.hexes)?;
        if let Some(why) = &self.refused {
            return write!(f, "; no positions were made: {why}");
        }
        let Some(e) = &self.embedding else { return write!(f, " (start positions, not embedded)") };
        write!(f, "; {} starts, {} valid", e.starts, e.valid_starts)?;
        let worst: Vec<String> = e.worst_cells.iter().take(5).map(|c| c.hex.to_string()).collect();
        write!(f, ", worst cells {}", worst.join(" "))?;
        if e.is_impossible() {
            let vertex = e.star_bounds.first().map_or(String::new(), |b| format!(" at {}", b.vertex));
            write!(
                f,
                "; with this connectivity and boundary no placement is valid (star bound {:.4}{vertex})",
                e.upper_bound
            )?;
        } else if e.upper_bound <= 1e-12 {
            let vertex = e.star_bounds.first().map_or(String::new(), |b| format!(" at {}", b.vertex));
            write!(f, "; the boundary leaves no room{vertex} (star bound 0 up to rounding)")?;
        }
        Ok(())
    }
}
