//! A certified interval for the least scaled Jacobian over a whole hex.
//!
//! SJ = det J / (|J1| |J2| |J3|). On a box with Bernstein coefficients B of det J and N of the product of norms (see
//! [`norm_products`]), `SJ >= min B/N` wherever that is not negative; values at corners of boxes bound the minimum from
//! above. The box with the smallest lower bound is halved until the interval is short. Rounding goes outward.
//!
//! Source: ours, on the coefficients of Johnen, Weill, Remacle 2017.

use super::bernstein::{CORNERS, Cell, ERROR, Frame, Lengths, UNIT, Vector, halve, norm_products};
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Lower and upper bound of the least scaled Jacobian of a hex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Interval {
    pub(crate) lower: f64,
    pub(crate) upper: f64,
}

/// When to stop halving.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Effort {
    /// A lower bound of this is enough.
    pub(crate) enough: f64,
    /// An interval of this length is enough.
    pub(crate) width: f64,
    /// Boxes at most.
    pub(crate) boxes: usize,
}

struct Part {
    lower: f64,
    frame: Frame,
    b: [f64; 27],
    error: f64,
    cell: Cell,
}

/// A part by its place in a list, as parts are large; the heap gives the smallest lower bound first, then the oldest.
struct Entry {
    lower: f64,
    part: usize,
}

impl PartialEq for Entry {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Entry {}

impl PartialOrd for Entry {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Entry {
    fn cmp(&self, other: &Self) -> Ordering {
        other.lower.total_cmp(&self.lower).then(other.part.cmp(&self.part))
    }
}

/// Largest components for which nothing is scaled.
const UNSCALED: std::ops::RangeInclusive<f64> = 1e-60..=1e60;

/// The edge vectors of the hex scaled by a power of two to unit size, so that nothing overflows or underflows, and whether that
/// was needed. Scaling is exact but for numbers that vanish beside the size of the hex; the slack of the norms and the error of
/// the coefficients cover those.
#[inline]
pub(crate) fn normal_frame(p: &[Vector; 8]) -> (Frame, bool) {
    let size = p.iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
    // Twice: first the coordinates, so that their differences are finite, then the edges, so that products of three
    // are.
    let far = size > 0.0 && !UNSCALED.contains(&size);
    let q = if far { scaled(p, -exponent(size)) } else { *p };
    let frame = Frame::new(&q);
    let longest = frame.sizes().into_iter().fold(0.0, f64::max);
    if longest == 0.0 || UNSCALED.contains(&longest) {
        return (frame, far);
    }
    // Far smaller than its distance from the origin cannot be below 1e-60 relative; so the hex is near the origin.
    (Frame::new(&scaled(&q, -exponent(longest))), true)
}

/// The hex times 2^by, in two steps that neither overflow nor underflow.
fn scaled(p: &[Vector; 8], by: i32) -> [Vector; 8] {
    let half = by / 2;
    p.map(|v| v.map(|x| x * 2f64.powi(half) * 2f64.powi(by - half)))
}

fn exponent(x: f64) -> i32 {
    // frexp for positive finite numbers, subnormals included.
    let field = (x.to_bits() >> 52 & 0x7ff) as i32;
    if field == 0 { exponent(x * 2f64.powi(64)) - 64 } else { field - 1023 }
}

fn part(frame: Frame, lengths: &Lengths, b: [f64; 27], error: f64, cell: Cell, slack: f64, upper: &mut f64) -> Part {
    let n = norm_products(lengths, slack);
    let mut lower = f64::INFINITY;
    for i in 0..27 {
        let certain = b[i] - error;
        // N bounds the product of norms from above, which helps a positive B only; SJ >= -1 always holds.
        let ratio = if certain > 0.0 { certain / n[i] * (1.0 - 4.0 * UNIT) } else { -1.0 };
        lower = lower.min(ratio);
    }
    for (i, &c) in CORNERS.iter().enumerate() {
        let (x, y, z) = (i & 1, i >> 1 & 1, i >> 2);
        let norms = [lengths[0][y + 2 * z], lengths[1][x + 2 * z], lengths[2][x + 2 * y]];
        // Rounded up: divide a positive value by less than the norms, a negative one by more.
        let value = b[c] + error;
        let away = if value > 0.0 { -slack } else { slack };
        let product = norms.iter().fold(1.0, |p, n| p * (n + away));
        // Beside an edge as short as its own rounding nothing is known of the corner; it bounds nothing.
        if norms.iter().all(|&n| n > 2.0 * slack) {
            let ratio = value / product;
            *upper = upper.min((ratio + ratio.abs() * 32.0 * UNIT).clamp(-1.0, 1.0));
        }
    }
    Part { lower, frame, b, error, cell }
}

/// A hex before any halving: what is known of its least scaled Jacobian, and what halving starts from.
pub(crate) struct Whole {
    pub(crate) upper: f64,
    slack: f64,
    part: Part,
}

impl Whole {
    /// `lengths` and `b` are those of `frame`, which is a [`normal_frame`]. `None` for a hex without size: nothing is known.
    #[inline]
    pub(crate) fn new(frame: Frame, lengths: &Lengths, b: [f64; 27]) -> Option<Self> {
        let size = frame.safe_size()?;
        let longest = frame.sizes().into_iter().fold(0.0, f64::max);
        // Rounding of the edge vectors themselves; grows with the depth, at most 100 halvings.
        let slack = 1e-14 * longest;
        let mut upper = 1.0;
        let part = part(frame, lengths, b, ERROR * size, Cell::WHOLE, slack, &mut upper);
        Some(Self { upper, slack, part })
    }

    pub(crate) fn lower(&self) -> f64 {
        self.part.lower.min(self.upper)
    }

    /// Whether no halving is needed.
    pub(crate) fn suffices(&self, effort: Effort) -> bool {
        self.part.lower >= effort.enough || self.upper - self.part.lower <= effort.width
    }

    /// Halves until the effort is met.
    fn refine(self, effort: Effort) -> Interval {
        let Self { mut upper, slack, part: whole } = self;
        let most = whole.b.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        // The bound of `halve`: means do not increase errors, so a box d halvings deep is off by d of these and what
        // there was.
        let step = 4.0 * UNIT * most * 1.01;
        let mut parts = vec![whole];
        let mut heap = BinaryHeap::from([Entry { lower: parts[0].lower, part: 0 }]);
        let mut visited = 1;
        while let Some(&Entry { lower, part: worst }) = heap.peek() {
            // The heap's top has the least bound of all boxes, so it is that of the whole hex.
            let done = lower >= effort.enough || upper - lower <= effort.width || upper <= 0.0;
            if done || visited >= effort.boxes || parts[worst].cell.depth >= 100 {
                return Interval { lower: lower.min(upper), upper };
            }
            // The box with the least bound is halved, as no other can raise the bound of the whole.
            heap.pop();
            let Part { frame, b, error, cell, .. } = &parts[worst];
            let axis = cell.axis();
            let error = error + step;
            let [low, high] = halve(b, axis);
            let [low_frame, high_frame] = frame.halves(axis);
            let [low_cell, high_cell] = cell.halves();
            // One half takes the place of the whole.
            let fresh = parts.len();
            parts[worst] = part(low_frame, &low_frame.lengths(), low, error, low_cell, slack, &mut upper);
            parts.push(part(high_frame, &high_frame.lengths(), high, error, high_cell, slack, &mut upper));
            heap.extend([worst, fresh].map(|part| Entry { lower: parts[part].lower, part }));
            visited += 2;
        }
        Interval { lower: -1.0, upper }
    }
}

/// The least scaled Jacobian of a hex over all of it. All coordinates are finite. For a hex that is not valid the lower bound
/// is -1.
pub(crate) fn least(p: &[Vector; 8], effort: Effort) -> Interval {
    let (frame, _) = normal_frame(p);
    match Whole::new(frame, &frame.lengths(), frame.coefficients()) {
        None => Interval { lower: -1.0, upper: 1.0 },
        Some(whole) if whole.suffices(effort) => Interval { lower: whole.lower(), upper: whole.upper },
        Some(whole) => whole.refine(effort),
    }
}
