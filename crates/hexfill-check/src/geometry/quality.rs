//! Quality numbers of hexes: scaled Jacobian at the corners, Verdict's, certified; condition number, edge ratio, volume.
//!
//! Source: Knupp et al. 2006, chapter 7 (sections Edge Ratio, Maximum Aspect Frobenius, Scaled Jacobian); volume and the certified interval are ours.

use super::bernstein::{CORNERS, Frame, Lengths, Vector, cross, dot, norm};
use super::positivity::decide;
use super::scaled::{Effort, Whole, least, normal_frame};
use super::verdict::Positivity;
use super::volume::Sum;
use crate::input::Judged;
use crate::parallel::{piece, tasks};
use hexfill_mesh::Context;
use rayon::prelude::*;
use serde::Serialize;
use std::io::{self, Write};

/// Hexes measured as one task; fixed, so that sums do not depend on the number of threads.
const CHUNK: usize = 1 << 12;
/// Hexes halved as one task.
const FEW: usize = 64;
/// Tasks between two looks at the context.
const BATCH: usize = 64;

/// The numbers of one hex. All ratios are free of units; the cube has 1 everywhere.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CellQuality {
    /// Least scaled Jacobian at the 8 corners: det of the three unit edge vectors there.
    pub corner_scaled_jacobian: f64,
    /// Verdict's and VTK's scaled Jacobian: the corners and the centre.
    pub verdict_scaled_jacobian: f64,
    /// Certified lower bound of the scaled Jacobian over the whole hex; -1 if the hex is not valid.
    pub certified_lower: f64,
    /// Upper bound of the least scaled Jacobian over the whole hex.
    pub certified_upper: f64,
    /// Whether det J > 0 on the whole hex is certain.
    pub valid: bool,
    /// Largest condition number of J at the 8 corners, Frobenius norm divided by 3; infinite where det J <= 0.
    pub condition: f64,
    /// Longest edge by shortest edge.
    pub edge_ratio: f64,
    /// Volume, in the units of the positions cubed.
    pub volume: f64,
}

/// The cheap numbers of a hex.
struct Sampled {
    corner: f64,
    verdict: f64,
    condition: f64,
    edge_ratio: f64,
    volume: f64,
}

/// det J over the product of the lengths of its columns.
fn scaled_jacobian(det: f64, lengths: [f64; 3]) -> f64 {
    let product = lengths[0] * lengths[1] * lengths[2];
    // A collapsed edge: no direction, so no better than flat.
    if product > 0.0 { (det / product).clamp(-1.0, 1.0) } else { 0.0 }
}

/// A hex as all measures need it.
struct Measured {
    frame: Frame,
    lengths: Lengths,
    coefficients: [f64; 27],
    volume: f64,
}

impl Measured {
    fn new(p: &[Vector; 8]) -> Self {
        let (frame, scaled) = normal_frame(p);
        let coefficients = frame.coefficients();
        let own = if scaled { Frame::new(p).coefficients() } else { coefficients };
        Self { frame, lengths: frame.lengths(), coefficients, volume: own.iter().sum::<f64>() / 27.0 }
    }

    fn sample(&self) -> Sampled {
        let (e, lengths) = (&self.frame.e, &self.lengths);
        let squares = e.map(|axis| axis.map(|v| dot(v, v)));
        let (mut corner, mut condition) = (1.0f64, 0.0f64);
        for (i, &at) in CORNERS.iter().enumerate() {
            let (a, b, c) = (i & 1, i >> 1 & 1, i >> 2);
            let [x, y, z] = [b + 2 * c, a + 2 * c, a + 2 * b];
            let det = self.coefficients[at];
            corner = corner.min(scaled_jacobian(det, [lengths[0][x], lengths[1][y], lengths[2][z]]));
            let v = [e[0][x], e[1][y], e[2][z]];
            let crosses = [cross(v[1], v[2]), cross(v[2], v[0]), cross(v[0], v[1])];
            let of_columns = squares[0][x] + squares[1][y] + squares[2][z];
            let of_crosses = crosses.iter().map(|&x| dot(x, x)).sum::<f64>();
            let here = (of_columns * of_crosses).sqrt() / (3.0 * det);
            condition = condition.max(if det > 0.0 { here } else { f64::INFINITY });
        }
        let axes: [Vector; 3] = e.map(|t| std::array::from_fn(|k| t[0][k] + t[1][k] + t[2][k] + t[3][k]));
        let centre = scaled_jacobian(dot(axes[0], cross(axes[1], axes[2])), axes.map(norm));
        let all = lengths.iter().flatten();
        let (short, long) = all.fold((f64::INFINITY, 0.0f64), |(s, l), &n| (s.min(n), l.max(n)));
        Sampled { corner, verdict: corner.min(centre), condition, edge_ratio: long / short, volume: self.volume }
    }

    /// Bounds of the scaled Jacobian over the whole hex; `None` for a hex without size.
    fn whole(&self) -> Option<Whole> {
        Whole::new(self.frame, &self.lengths, self.coefficients)
    }
}

/// A hex and its scaled Jacobian, for the list of the worst.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct WorstCell {
    /// The hex.
    pub hex: u32,
    /// Its least scaled Jacobian at the corners.
    pub corner_scaled_jacobian: f64,
}

/// Quality of a whole mesh.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Quality {
    /// Least scaled Jacobian at corners.
    pub min_corner_scaled_jacobian: f64,
    /// Mean over the hexes of the least scaled Jacobian at corners.
    pub mean_corner_scaled_jacobian: f64,
    /// Least of Verdict's scaled Jacobian (corners and centre).
    pub min_verdict_scaled_jacobian: f64,
    /// Certified interval of the least scaled Jacobian over all points of all hexes.
    pub certified_scaled_jacobian: [f64; 2],
    /// Largest condition number.
    pub max_condition: f64,
    /// Largest edge ratio.
    pub max_edge_ratio: f64,
    /// Sum of the hexes' volumes.
    pub volume: f64,
    /// Volume enclosed by the boundary.
    pub boundary_volume: f64,
    /// Hexes by corner scaled Jacobian: 20 bins from -1 to 1.
    pub histogram: [u64; 20],
    /// The worst hexes by corner scaled Jacobian, at most ten, worst first.
    pub worst: Vec<WorstCell>,
}

fn gather(hex: &[u32; 8], points: &[Vector]) -> [Vector; 8] {
    hex.map(|v| points[v as usize])
}

#[derive(Default)]
struct Sums {
    corner: f64,
    verdict: f64,
    mean: Sum,
    volume: Sum,
    condition: f64,
    edge_ratio: f64,
    histogram: [u64; 20],
    worst: Vec<WorstCell>,
    /// Certified bounds of the least scaled Jacobian, without the doubtful hexes' lower ones.
    certified: [f64; 2],
    doubtful: Vec<Doubtful>,
}

/// A hex whose lower bound is below the least scaled Jacobian sampled so far.
struct Doubtful {
    hex: u32,
    lower: f64,
}

impl Sums {
    fn none() -> Self {
        Self { corner: 1.0, verdict: 1.0, certified: [1.0, 1.0], ..Self::default() }
    }

    fn add(&mut self, hex: &Measured) -> Sampled {
        let s = hex.sample();
        self.corner = self.corner.min(s.corner);
        self.verdict = self.verdict.min(s.verdict);
        self.mean.add(s.corner);
        self.volume.add(s.volume);
        self.condition = self.condition.max(s.condition);
        self.edge_ratio = self.edge_ratio.max(s.edge_ratio);
        self.histogram[((s.corner + 1.0) * 10.0).clamp(0.0, 19.0) as usize] += 1;
        s
    }

    /// Notes the bounds of a hex, or the hex where halving may have to say more.
    fn bound(&mut self, hex: u32, whole: Option<Whole>) {
        let [least, most] = &mut self.certified;
        let Some(whole) = whole else {
            *least = -1.0;
            return;
        };
        *most = most.min(whole.upper);
        if whole.suffices(effort(self.corner)) {
            *least = least.min(whole.lower());
        } else {
            self.doubtful.push(Doubtful { hex, lower: whole.lower() });
        }
    }

    /// Adds the sums of the hexes that follow.
    fn append(&mut self, later: Self) {
        self.corner = self.corner.min(later.corner);
        self.verdict = self.verdict.min(later.verdict);
        self.mean.add(later.mean.value());
        self.volume.add(later.volume.value());
        self.condition = self.condition.max(later.condition);
        self.edge_ratio = self.edge_ratio.max(later.edge_ratio);
        self.histogram.iter_mut().zip(later.histogram).for_each(|(a, b)| *a += b);
        self.worst.extend(later.worst);
        self.worst_first();
        self.certified = [0, 1].map(|i| self.certified[i].min(later.certified[i]));
        self.doubtful.extend(later.doubtful);
    }

    fn worst_first(&mut self) {
        self.worst
            .sort_by(|a, b| a.corner_scaled_jacobian.total_cmp(&b.corner_scaled_jacobian).then(a.hex.cmp(&b.hex)));
        self.worst.truncate(10);
    }
}

/// How closely the worst hex is looked at: one whose lower bound reaches the least sampled value cannot lower the minimum.
fn effort(corner: f64) -> Effort {
    Effort { enough: corner, width: WORST_WIDTH, boxes: 20_000 }
}

fn sums(first: usize, hexes: &[[u32; 8]], points: &[Vector]) -> Sums {
    let mut all = Sums::none();
    let mut bar = f64::INFINITY;
    for (i, hex) in hexes.iter().enumerate() {
        let measured = Measured::new(&gather(hex, points));
        let corner = all.add(&measured).corner;
        all.bound((first + i) as u32, measured.whole());
        if corner < bar {
            all.worst.push(WorstCell { hex: (first + i) as u32, corner_scaled_jacobian: corner });
            if all.worst.len() >= 64 {
                all.worst_first();
                bar = all.worst[9].corner_scaled_jacobian;
            }
        }
    }
    all.worst_first();
    all
}

/// Measures a mesh whose hexes are all in range and whose positions are all finite; `valid` says whether det J > 0 was
/// certified for every hex. `None` if it was stopped.
pub(crate) fn measure(
    hexes: &[[u32; 8]],
    points: &[Vector],
    boundary_volume: f64,
    valid: bool,
    ctx: &Context<'_>,
) -> Option<Quality> {
    let mut total = Sums::none();
    for (b, batch) in hexes.chunks(CHUNK * BATCH).enumerate() {
        if ctx.stop().is_some() {
            return None;
        }
        ctx.report("check quality", (b * CHUNK * BATCH) as u64, Some(hexes.len() as u64), String::new);
        tasks(batch.len().div_ceil(CHUNK), |i| sums((b * BATCH + i) * CHUNK, piece(batch, CHUNK, i), points))
            .into_iter()
            .for_each(|part| total.append(part));
    }
    let [mut lower, mut upper] = total.certified;
    // The corners' least value is an upper bound of the mesh's: a hex whose certified bound is above it cannot be the
    // worst, and need not be looked at closer.
    let effort = effort(total.corner);
    for batch in total.doubtful.chunks(FEW * BATCH) {
        if ctx.stop().is_some() {
            return None;
        }
        let parts = tasks(batch.len().div_ceil(FEW), |i| {
            piece(batch, FEW, i).iter().fold((1.0f64, 1.0f64), |(low, high), cell| {
                if cell.lower >= effort.enough {
                    return (low.min(cell.lower), high);
                }
                let bounds = least(&gather(&hexes[cell.hex as usize], points), effort);
                (low.min(bounds.lower), high.min(bounds.upper))
            })
        });
        // Minima in a fixed order; they are exact, so any order would do.
        for (low, high) in parts {
            lower = lower.min(low);
            upper = upper.min(high);
        }
    }
    if valid {
        // det J > 0 was proved; where the bound could not show that much it is still true.
        lower = lower.max(0.0);
        upper = upper.max(0.0);
    }
    Some(Quality {
        min_corner_scaled_jacobian: total.corner,
        mean_corner_scaled_jacobian: total.mean.value() / hexes.len() as f64,
        min_verdict_scaled_jacobian: total.verdict,
        certified_scaled_jacobian: [lower, upper],
        max_condition: total.condition,
        max_edge_ratio: total.edge_ratio,
        volume: total.volume.value(),
        boundary_volume,
        histogram: total.histogram,
        worst: total.worst,
    })
}

/// Certified intervals are this short,
const WIDTH: f64 = 1e-3;
/// and those of hexes that may be the worst of the mesh this short.
const WORST_WIDTH: f64 = 1e-9;

/// The numbers of every hex, in order, on the current rayon pool. `None` where a hex has an index out of range or a position
/// that is not finite, or no positions were given. Certified intervals of the scaled Jacobian are at most 0.001 long, those of
/// hexes that may be the worst 1e-9, unless that takes more than 2,000 boxes.
///
/// # Example
/// ```
/// use hexfill_check::{Judged, cell_quality};
///
/// let hexes = [[0, 1, 2, 3, 4, 5, 6, 7]];
/// let corners = [[0, 0, 0], [2, 0, 0], [2, 1, 0], [0, 1, 0], [0, 0, 1], [2, 0, 1], [2, 1, 1], [0, 1, 1]];
/// let points = corners.map(|p| p.map(f64::from));
/// let cells = cell_quality(&Judged::connectivity(8, &hexes).with_points(&points));
/// let brick = cells[0].expect("indices in range, positions finite");
/// assert!(brick.valid && brick.certified_lower > 0.999);
/// assert_eq!((brick.volume, brick.edge_ratio), (2.0, 2.0));
/// ```
pub fn cell_quality(input: &Judged<'_>) -> Vec<Option<CellQuality>> {
    let points = input.points.unwrap_or_default();
    let effort = |width: f64| Effort { enough: f64::INFINITY, width, boxes: 2_000 };
    let mut cells: Vec<Option<CellQuality>> = input
        .hexes
        .par_iter()
        .map(|hex| {
            if hex.iter().any(|&v| points.get(v as usize).is_none_or(|p| p.iter().any(|x| !x.is_finite()))) {
                return None;
            }
            let p = gather(hex, points);
            let s = Measured::new(&p).sample();
            let valid = decide(&p) == Positivity::Positive;
            // What is not valid needs no lower bound.
            let bound = least(&p, if valid { effort(WIDTH) } else { Effort { boxes: 1, ..effort(WIDTH) } });
            Some(CellQuality {
                corner_scaled_jacobian: s.corner,
                verdict_scaled_jacobian: s.verdict,
                certified_lower: if valid { bound.lower.max(0.0) } else { -1.0 },
                certified_upper: bound.upper.max(if valid { 0.0 } else { -1.0 }),
                valid,
                condition: s.condition,
                edge_ratio: s.edge_ratio,
                volume: s.volume,
            })
        })
        .collect();
    let worst = cells.iter().flatten().map(|c| c.certified_upper).fold(f64::INFINITY, f64::min);
    cells.par_iter_mut().zip(input.hexes).for_each(|(cell, hex)| {
        if let Some(cell) = cell.as_mut().filter(|c| c.valid && c.certified_lower <= worst) {
            let bound = least(&gather(hex, points), effort(WORST_WIDTH));
            cell.certified_lower = cell.certified_lower.max(bound.lower);
            cell.certified_upper = cell.certified_upper.min(bound.upper.max(0.0));
        }
    });
    cells
}

/// Writes [`cell_quality`] as CSV: a header, then a line a hex; empty fields where there is no number.
///
/// # Errors
/// What the writer says.
pub fn write_cell_csv(cells: &[Option<CellQuality>], out: &mut impl Write) -> io::Result<()> {
    writeln!(
        out,
        "hex,valid,corner_scaled_jacobian,verdict_scaled_jacobian,certified_lower,certified_upper,condition,edge_ratio,volume"
    )?;
    for (h, cell) in cells.iter().enumerate() {
        match cell {
            None => writeln!(out, "{h},,,,,,,,")?,
            Some(c) => writeln!(
                out,
                "{h},{},{},{},{},{},{},{},{}",
                c.valid,
                c.corner_scaled_jacobian,
                c.verdict_scaled_jacobian,
                c.certified_lower,
                c.certified_upper,
                c.condition,
                c.edge_ratio,
                c.volume
            )?,
        }
    }
    Ok(())
}
