//! Colours, in one place: the page receives them as data, so page and picture agree.
//!
//! The ramps are safe for the common kinds of colour blindness: ColorBrewer's red-yellow-blue for quality (red is
//! bad) and samples of viridis for everything that only grows.
//!
//! Source: ColorBrewer and viridis, as said.

/// A colour, red green blue, 0 to 255 each (sRGB).
pub(crate) type Rgb = [u8; 3];

/// Boundary quads without other colours.
pub(crate) const SURFACE: Rgb = [0xc9, 0xd8, 0xe8];
/// Interior facets laid open by a cut.
pub(crate) const INSIDE: Rgb = [0xf0, 0xcd, 0x8c];
/// Hexes without a value (NaN).
pub(crate) const UNKNOWN: Rgb = [0x9a, 0xa0, 0xa6];
/// Hexes of quality 0 or less.
pub(crate) const FLAGGED: Rgb = [0xd0, 0x00, 0xc8];

/// Colours that stay apart for most eyes (after Okabe and Ito), as `category` of `viewer/src/colour.ts`.
const CATEGORIES: [Rgb; 12] = [
    [230, 130, 0],
    [56, 150, 220],
    [0, 158, 115],
    [213, 80, 20],
    [190, 110, 170],
    [0, 100, 178],
    [220, 200, 40],
    [120, 120, 130],
    [140, 86, 50],
    [90, 190, 190],
    [150, 60, 160],
    [110, 150, 30],
];

/// The colour of group `i`: from the list, then by the golden angle round the circle of hues.
pub(crate) fn category(i: usize) -> Rgb {
    if let Some(colour) = CATEGORIES.get(i) {
        return *colour;
    }
    let hue = (i as f64 * 137.508) % 360.0;
    let light: f64 = [0.5, 0.62, 0.4][i % 3];
    [0.0, 8.0, 4.0].map(|n| {
        let k = (n + hue / 30.0) % 12.0;
        (255.0 * (light - 0.62 * light.min(1.0 - light) * (k - 3.0).min(9.0 - k).clamp(-1.0, 1.0))).round() as u8
    })
}

/// Quality, from bad to good.
pub(crate) const QUALITY: [Rgb; 9] = [
    [0xa5, 0x00, 0x26],
    [0xd7, 0x30, 0x27],
    [0xf4, 0x6d, 0x43],
    [0xfd, 0xae, 0x61],
    [0xfe, 0xe0, 0x90],
    [0xd8, 0xea, 0xf0],
    [0xa6, 0xd0, 0xe4],
    [0x74, 0xad, 0xd1],
    [0x45, 0x75, 0xb4],
];

/// Anything that grows, from small to large.
pub(crate) const GROWTH: [Rgb; 8] = [
    [0x46, 0x1f, 0x75],
    [0x3f, 0x47, 0x88],
    [0x2e, 0x6b, 0x8e],
    [0x21, 0x8f, 0x8b],
    [0x35, 0xb0, 0x78],
    [0x7f, 0xce, 0x55],
    [0xc2, 0xdf, 0x3a],
    [0xfd, 0xe7, 0x25],
];

/// How values become colours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Scale {
    /// Value at the left end of the ramp.
    pub low: f64,
    /// Value at the right end of the ramp.
    pub high: f64,
    /// Whether values of 0 and below are flagged.
    pub flags_nonpositive: bool,
}

impl Scale {
    /// The scale for `values` called `name`: 0 to 1 for a Jacobian, otherwise the range of the finite values.
    pub(crate) fn new(name: &str, values: &[f64]) -> Self {
        if name.to_lowercase().contains("jacobian") {
            return Self { low: 0.0, high: 1.0, flags_nonpositive: true };
        }
        let finite = values.iter().copied().filter(|x| x.is_finite());
        let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
        if low > high {
            return Self { low: 0.0, high: 1.0, flags_nonpositive: false };
        }
        Self { low, high, flags_nonpositive: false }
    }

    /// The ramp that belongs to the scale.
    pub(crate) fn ramp(&self) -> &'static [Rgb] {
        if self.flags_nonpositive { &QUALITY } else { &GROWTH }
    }

    /// The colour of `value`.
    pub(crate) fn colour(&self, value: f64) -> Rgb {
        if value.is_nan() {
            return UNKNOWN;
        }
        if self.flags_nonpositive && value <= 0.0 {
            return FLAGGED;
        }
        let width = self.high - self.low;
        sample(self.ramp(), if width > 0.0 { (value - self.low) / width } else { 0.5 })
    }
}

/// The colour at `t` (clamped to 0 ..= 1) of a ramp.
pub(crate) fn sample(ramp: &[Rgb], t: f64) -> Rgb {
    let last = ramp.len() - 1;
    let at = t.clamp(0.0, 1.0) * last as f64;
    let i = (at as usize).min(last - 1);
    let part = at - i as f64;
    std::array::from_fn(|c| {
        let (a, b) = (f64::from(ramp[i][c]), f64::from(ramp[i + 1][c]));
        (a + part * (b - a)).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_jacobian_has_a_fixed_scale_and_flags() {
        let scale = Scale::new("Scaled Jacobian", &[0.2, 0.4]);
        assert_eq!(scale.colour(0.0), FLAGGED);
        assert_eq!(scale.colour(-3.0), FLAGGED);
        assert_eq!(scale.colour(1.0), QUALITY[8]);
        assert_eq!(scale.colour(f64::NAN), UNKNOWN);
        assert_eq!(scale.colour(0.5), QUALITY[4]);
    }

    #[test]
    fn other_values_span_their_range() {
        let scale = Scale::new("volume", &[3.0, f64::NAN, -1.0, f64::INFINITY]);
        assert_eq!((scale.low, scale.high), (-1.0, 3.0));
        assert_eq!((scale.colour(-1.0), scale.colour(3.0)), (GROWTH[0], GROWTH[7]));
        assert_eq!(scale.colour(f64::INFINITY), GROWTH[7]);
        assert_eq!(Scale::new("x", &[2.0]).colour(2.0), sample(&GROWTH, 0.5));
        assert_eq!(Scale::new("x", &[]).low, 0.0);
    }

    #[test]
    fn categories_are_those_of_the_viewer() {
        let viewer = include_str!("../viewer/src/colour.ts");
        let list = CATEGORIES.map(|[r, g, b]| format!("[{r}, {g}, {b}]"));
        let listed: String =
            viewer.split("const CATEGORIES").nth(1).unwrap().split("];").next().unwrap().split_whitespace().collect();
        assert!(listed.ends_with(&format!("[{},", list.join(",").replace(' ', ""))), "{listed}");
    }
}
