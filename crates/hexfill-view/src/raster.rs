//! A small software rasteriser: triangles into a depth buffer, several samples a pixel.
//!
//! Only `+ - * /` and square roots are used, which IEEE 754 fixes to the last bit, so a picture has the same bytes
//! on every machine. Depth grows away from the eye; the nearest sample wins, the first drawn on a tie.
//!
//! Source: textbook knowledge: half-plane functions and a depth buffer; that its bytes are fixed is ours.

use crate::colour::Rgb;

/// A corner on the screen: x to the right and y down in samples, depth, and brightness (1 is the plain colour).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Corner {
    /// Samples from the left.
    pub x: f64,
    /// Samples from the top.
    pub y: f64,
    /// Depth.
    pub depth: f64,
    /// Factor on the colour.
    pub light: f64,
}

/// A picture being drawn.
pub(crate) struct Canvas {
    width: usize,
    height: usize,
    depth: Vec<f32>,
    colour: Vec<Rgb>,
}

impl Canvas {
    /// An empty picture of `width` by `height` samples; `background` gives the colour of a row.
    pub(crate) fn new(width: usize, height: usize, background: impl Fn(usize) -> Rgb) -> Self {
        let mut colour = Vec::with_capacity(width * height);
        for y in 0..height {
            colour.resize((y + 1) * width, background(y));
        }
        Self { width, height, depth: vec![f32::INFINITY; width * height], colour }
    }

    /// Draws the quad `corners` (in cyclic order, possibly warped) as four triangles round its centre, with a
    /// line of half width `edge` samples and colour `edge_colour` along its four sides.
    pub(crate) fn quad(&mut self, corners: [Corner; 4], colour: Rgb, edge: f64, edge_colour: Rgb) {
        let mean = |f: fn(&Corner) -> f64| corners.iter().map(f).sum::<f64>() / 4.0;
        let centre = Corner { x: mean(|c| c.x), y: mean(|c| c.y), depth: mean(|c| c.depth), light: mean(|c| c.light) };
        for i in 0..4 {
            self.triangle(corners[i], corners[(i + 1) % 4], centre, colour, edge, edge_colour);
        }
    }

    /// Draws a triangle; the line is along `a b`.
    fn triangle(&mut self, a: Corner, b: Corner, c: Corner, colour: Rgb, edge: f64, edge_colour: Rgb) {
        let area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        if area == 0.0 {
            return;
        }
        let base = ((b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y)).sqrt();
        // Distance of `c` from the line through `a b`: the weight of `c` times this is the distance of a sample.
        let rise = if base > 0.0 { area.abs() / base } else { 0.0 };
        let span = |lo: f64, hi: f64, n: usize| {
            (lo.ceil().max(0.0) as usize, (hi.floor().min(n as f64 - 1.0) + 1.0).max(0.0) as usize)
        };
        let (x0, x1) = span(a.x.min(b.x).min(c.x) - 0.5, a.x.max(b.x).max(c.x) - 0.5, self.width);
        let (y0, y1) = span(a.y.min(b.y).min(c.y) - 0.5, a.y.max(b.y).max(c.y) - 0.5, self.height);
        // Barycentric weights along a row: weight + x * slope. The tolerance closes cracks between neighbours.
        let slopes = [(b.y - c.y) / area, (c.y - a.y) / area, (a.y - b.y) / area];
        const TOLERANCE: f64 = 1e-9;
        let bytes = colour.map(f64::from);
        for y in y0..y1 {
            let py = y as f64 + 0.5;
            let at_zero = |p: Corner, q: Corner| (p.x * (q.y - py) - (p.y - py) * q.x) / area;
            let starts = [at_zero(b, c), at_zero(c, a), at_zero(a, b)];
            // The part of the row inside, a sample wider than needed on either side; the weights decide.
            let (mut low, mut high) = (x0 as f64, x1 as f64);
            for (start, slope) in starts.into_iter().zip(slopes) {
                if slope > 0.0 {
                    low = low.max(-start / slope - 1.5);
                } else if slope < 0.0 {
                    high = high.min(-start / slope + 1.5);
                }
            }
            for x in low as usize..(high.max(0.0) as usize).min(x1) {
                let px = x as f64 + 0.5;
                let [wa, wb, wc] = [0, 1, 2].map(|k| starts[k] + px * slopes[k]);
                if wa < -TOLERANCE || wb < -TOLERANCE || wc < -TOLERANCE {
                    continue;
                }
                let depth = (wa * a.depth + wb * b.depth + wc * c.depth) as f32;
                let i = y * self.width + x;
                if depth >= self.depth[i] {
                    continue;
                }
                self.depth[i] = depth;
                self.colour[i] = if wc * rise < edge {
                    edge_colour
                } else {
                    let light = wa * a.light + wb * b.light + wc * c.light;
                    bytes.map(|s| (s * light + 0.5) as u8)
                };
            }
        }
    }

    /// Draws a line of half width `half` samples where nothing was drawn yet; it hides nothing.
    pub(crate) fn backdrop_line(&mut self, a: Corner, b: Corner, half: f64, colour: Rgb) {
        let (dx, dy) = (b.x - a.x, b.y - a.y);
        let length = (dx * dx + dy * dy).sqrt();
        if length == 0.0 {
            return;
        }
        let (sx, sy) = (-dy / length * half, dx / length * half);
        let at = |p: Corner, sign: f64| Corner { x: p.x + sign * sx, y: p.y + sign * sy, depth: 1e30, light: 1.0 };
        let (p, q, r, s) = (at(a, 1.0), at(b, 1.0), at(b, -1.0), at(a, -1.0));
        self.triangle(p, q, r, colour, 0.0, colour);
        self.triangle(p, r, s, colour, 0.0, colour);
    }

    /// The mean of each block of `factor` by `factor` samples, as rows of red green blue bytes.
    pub(crate) fn reduced(&self, factor: usize) -> Vec<u8> {
        let (width, height) = (self.width / factor, self.height / factor);
        let n = (factor * factor) as u32;
        let mut bytes = Vec::with_capacity(3 * width * height);
        for y in 0..height {
            for x in 0..width {
                let mut sum = [n / 2; 3];
                for row in 0..factor {
                    let start = (y * factor + row) * self.width + x * factor;
                    for sample in &self.colour[start..start + factor] {
                        for (s, c) in sum.iter_mut().zip(sample) {
                            *s += u32::from(*c);
                        }
                    }
                }
                bytes.extend(sum.map(|s| (s / n) as u8));
            }
        }
        bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(x: f64, size: f64, depth: f64) -> [Corner; 4] {
        [(0.0, 0.0), (size, 0.0), (size, size), (0.0, size)].map(|(dx, dy)| Corner {
            x: x + dx,
            y: x + dy,
            depth,
            light: 1.0,
        })
    }

    #[test]
    fn the_nearer_quad_wins_whatever_the_order() {
        for flip in [false, true] {
            let mut canvas = Canvas::new(8, 8, |_| [0; 3]);
            let mut quads = [(square(1.0, 6.0, 2.0), [200, 0, 0]), (square(3.0, 2.0, 1.0), [0, 200, 0])];
            if flip {
                quads.reverse();
            }
            for (corners, colour) in quads {
                canvas.quad(corners, colour, 0.0, [0; 3]);
            }
            let count = |c: Rgb| canvas.colour.iter().filter(|&&s| s == c).count();
            assert_eq!((count([200, 0, 0]), count([0, 200, 0]), count([0; 3])), (32, 4, 28));
        }
    }

    #[test]
    fn sides_have_lines_and_samples_are_averaged() {
        let mut canvas = Canvas::new(8, 8, |_| [0; 3]);
        canvas.quad(square(0.0, 8.0, 1.0), [100; 3], 1.0, [10; 3]);
        assert_eq!(canvas.colour.iter().filter(|&&s| s == [10; 3]).count(), 28);
        let small = canvas.reduced(2);
        assert_eq!(small.len(), 3 * 16);
        // A corner block has three line samples and one plain one: (30 + 100) / 4, rounded.
        assert_eq!((small[0], small[3 * 5]), (33, 100));
    }

    #[test]
    fn what_lies_outside_is_clipped() {
        let mut canvas = Canvas::new(4, 4, |_| [7; 3]);
        canvas.quad(square(-100.0, 50.0, 1.0), [1; 3], 0.0, [0; 3]);
        assert!(canvas.colour.iter().all(|&s| s == [7; 3]));
        canvas.quad(square(-100.0, 500.0, 1.0), [1; 3], 0.0, [0; 3]);
        assert!(canvas.colour.iter().all(|&s| s == [1; 3]));
    }
}
