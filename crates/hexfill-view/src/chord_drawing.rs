//! The chords of a surface drawn in the plane, as SVG: each a smooth closed curve of its own colour, two crossing in every quad.
//!
//! Components that are spheres are laid flat (`circle_packing.rs`) side by side; their vertex of highest degree is the outside.
//! Same surface, same bytes: positions are rounded to a tenth of a unit.
//!
//! Source: ours.

use crate::circle_packing::{Flat, lay_flat};
use hexfill_mesh::{Chord, Dart, QuadId, QuadSurface, chords};
use std::fmt::Write as _;

/// Components with more quads are not drawn: nothing could be told apart.
pub const MOST_QUADS: usize = 1_000;

/// Side of the square that one component is drawn into.
const PANEL: f64 = 560.0;
const MARGIN: f64 = 24.0;
/// Height of a line of the legend, and how many lines it has at most.
const LINE: f64 = 20.0;
const MOST_LINES: usize = 24;
/// Colours that stay apart on white.
const COLOURS: [&str; 10] =
    ["#c23b22", "#1f6fb4", "#2a8f4a", "#8e44ad", "#d98200", "#0e8c8c", "#a0522d", "#c2378f", "#5a6b00", "#3b3b98"];

/// Why there is no drawing.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum DrawingError {
    /// No component can be drawn; why not, one reason a component (the first ten).
    #[error("no chords are drawn: {}", reasons.join("; "))]
    NothingToDraw {
        /// One sentence a component.
        reasons: Vec<String>,
    },
}

/// A drawing, and the components that are not in it.
#[derive(Clone, Debug)]
pub struct ChordDrawing {
    /// The SVG document.
    pub svg: String,
    /// What was left out and why, one sentence each.
    pub left_out: Vec<String>,
}

/// Draws the chords of all components that are spheres of at most [`MOST_QUADS`] quads. Chords are numbered as by [`chords`]: `c0`, `c1`, ...
/// A ring marks each quad in which a chord crosses itself.
///
/// # Errors
/// [`DrawingError`] if there is no such component.
///
/// # Example
/// ```
/// use hexfill_mesh::QuadSurface;
/// use hexfill_view::chord_drawing;
///
/// let quads = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];
/// let drawing = chord_drawing(&QuadSurface::try_new(8, &quads)?, "a cube")?;
/// assert!(drawing.svg.starts_with("<svg") && drawing.left_out.is_empty());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn chord_drawing(surface: &QuadSurface, title: &str) -> Result<ChordDrawing, DrawingError> {
    let (panels, left_out) = panels(surface);
    if panels.is_empty() {
        return Err(DrawingError::NothingToDraw { reasons: left_out.into_iter().take(10).collect() });
    }
    let lines = panels.iter().map(|p| p.chords.len().min(MOST_LINES)).max().unwrap_or(0);
    let (width, height) = (PANEL * panels.len() as f64, PANEL + 30.0 + LINE * (lines as f64 + 1.0));
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" \
         font-family=\"sans-serif\" font-size=\"13\">\n<title>{}</title>\n<rect width=\"{width}\" height=\"{height}\" fill=\"#fff\"/>\n",
        crate::page::escape(title)
    );
    for (i, panel) in panels.iter().enumerate() {
        let _ = writeln!(svg, "<g transform=\"translate({} 0)\">", PANEL * i as f64);
        panel.draw(&mut svg);
        panel.legend(&mut svg, if panels.len() > 1 || !left_out.is_empty() { Some(panel.component) } else { None });
        svg.push_str("</g>\n");
    }
    svg.push_str("</svg>\n");
    Ok(ChordDrawing { svg, left_out })
}

/// The drawing of one sphere without legend and numbers, `size` units wide and high, for pages of many; nothing for other surfaces.
pub fn chord_thumbnail(surface: &QuadSurface, size: f64) -> Option<String> {
    let (panels, _) = if surface.is_sphere() { panels(surface) } else { Default::default() };
    let panel = panels.first()?;
    let mut svg = format!("<svg viewBox=\"0 0 {PANEL} {PANEL}\" width=\"{size}\" height=\"{size}\" role=\"img\">\n");
    panel.surface_lines(&mut svg);
    panel.curves(&mut svg, 6.0);
    svg.push_str("</svg>");
    Some(svg)
}

fn panels(surface: &QuadSurface) -> (Vec<Panel>, Vec<String>) {
    let parts = match surface.n_components() {
        1 => vec![(surface.clone(), (0..surface.n_quads()).map(QuadId::new).collect())],
        _ => surface.split_components().into_iter().map(|(part, _, quads)| (part, quads)).collect::<Vec<_>>(),
    };
    let first_darts: Vec<Dart> = chords(surface).iter().map(|c| c.crossings[0]).collect();
    let (mut panels, mut left_out) = (Vec::new(), Vec::new());
    for (c, (part, quads)) in parts.iter().enumerate() {
        let name = if parts.len() > 1 { format!("component {c}") } else { "the surface".to_owned() };
        if part.genus() > 0 {
            left_out.push(format!("{name} has genus {}; only a sphere lies flat", part.genus()));
        } else if part.n_quads() > MOST_QUADS {
            left_out.push(format!("{name} has {} quads; at most {MOST_QUADS} are drawn", part.n_quads()));
        } else {
            // Quads keep their order and their corners, so a chord of the part begins where it did.
            let number = |chord: &Chord| {
                let d = chord.crossings[0];
                let whole = Dart(4 * quads[d.quad().index()].0 + d.side() as u32);
                first_darts.binary_search(&whole).expect("a chord of the part is one of the whole")
            };
            match Panel::new(part, c, number) {
                Some(panel) => panels.push(panel),
                None => left_out.push(format!("{name} has parts too thin to be seen beside the rest")),
            }
        }
    }
    (panels, left_out)
}

/// One component, laid flat and fitted into the panel.
struct Panel {
    surface: QuadSurface,
    component: usize,
    chords: Vec<Chord>,
    /// Their numbers among those of all components.
    numbers: Vec<usize>,
    flat: Flat,
}

impl Panel {
    fn new(surface: &QuadSurface, component: usize, number: impl Fn(&Chord) -> usize) -> Option<Self> {
        let chords = chords(surface);
        let mut panel = Self {
            surface: surface.clone(),
            component,
            numbers: chords.iter().map(number).collect(),
            chords,
            flat: lay_flat(surface)?,
        };
        panel.fit();
        Some(panel)
    }

    /// Moves and scales everything so that the curves fill the square; y goes down from here on.
    fn fit(&mut self) {
        let (mut low, mut high) = ([f64::MAX; 2], [f64::MIN; 2]);
        for [p, a, b, q] in self.chords.iter().flat_map(|c| self.arcs(c)) {
            // A Bezier curve stays among the points (p + 3 a) / 4 and so on only nearly; the margin has room for the rest.
            for x in [p, mix(p, a, 0.75), mix(q, b, 0.75), q] {
                (0..2).for_each(|k| (low[k], high[k]) = (low[k].min(x[k]), high[k].max(x[k])));
            }
        }
        let scale = (PANEL - 2.0 * MARGIN) / (high[0] - low[0]).max(high[1] - low[1]);
        let to = |p: [f64; 2]| {
            [
                PANEL / 2.0 + scale * (p[0] - (low[0] + high[0]) / 2.0),
                PANEL / 2.0 - scale * (p[1] - (low[1] + high[1]) / 2.0),
            ]
        };
        let flat = &mut self.flat;
        flat.quads
            .iter_mut()
            .chain(&mut flat.edges)
            .chain(flat.vertices.iter_mut().flatten())
            .for_each(|p| *p = to(*p));
    }

    /// The Bezier arcs of a chord: from the midpoint of an edge to the crossing, from there to the next midpoint, ...
    fn arcs(&self, chord: &Chord) -> Vec<[[f64; 2]; 4]> {
        let points: Vec<[f64; 2]> = chord
            .crossings
            .iter()
            .flat_map(|d| [self.flat.edges[d.index()], self.flat.quads[d.quad().index()]])
            .collect();
        let n = points.len();
        let tangent = |i: usize| unit(minus(points[(i + 1) % n], points[(i + n - 1) % n]));
        (0..n)
            .map(|i| {
                let (p, q) = (points[i], points[(i + 1) % n]);
                let reach = norm(minus(q, p)) / 2.6;
                let (s, t) = (tangent(i), tangent((i + 1) % n));
                [p, [p[0] + reach * s[0], p[1] + reach * s[1]], [q[0] - reach * t[0], q[1] - reach * t[1]], q]
            })
            .collect()
    }

    fn colour(&self, chord: usize) -> String {
        let i = self.numbers[chord];
        COLOURS.get(i).map_or_else(|| format!("hsl({} 65% 40%)", (i * 137) % 360), |&c| c.to_owned())
    }

    fn draw(&self, svg: &mut String) {
        self.surface_lines(svg);
        self.curves(svg, (40.0 / (self.surface.n_quads() as f64).sqrt()).clamp(1.4, 3.0));
        for (i, chord) in self.chords.iter().enumerate() {
            let colour = self.colour(i);
            for q in &chord.self_crossings {
                let [x, y] = self.flat.quads[q.index()];
                let _ =
                    writeln!(svg, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"6\" fill=\"none\" stroke=\"{colour}\"/>");
            }
        }
        for (i, chord) in self.chords.iter().enumerate().take(MOST_LINES) {
            // Where there is most room.
            let room = |d: &Dart| norm(minus(self.flat.edges[d.index()], self.flat.quads[d.quad().index()]));
            let Some(d) = chord.crossings.iter().max_by(|a, b| room(a).total_cmp(&room(b))) else { continue };
            let [x, y] = self.flat.edges[d.index()];
            let _ = writeln!(
                svg,
                "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"10\" fill=\"#fff\" stroke=\"{0}\"/><text x=\"{x:.1}\" y=\"{1:.1}\" fill=\"{0}\" \
                 text-anchor=\"middle\" font-size=\"11\">c{2}</text>",
                self.colour(i),
                y + 4.0,
                self.numbers[i]
            );
        }
    }

    /// The edges of the surface, faint; those to the outer vertex end in the open.
    fn surface_lines(&self, svg: &mut String) {
        let surface = &self.surface;
        svg.push_str("<path fill=\"none\" stroke=\"#c3cad2\" stroke-width=\"1\" d=\"");
        for d in surface.darts().filter(|d| d.index() < surface.twin(*d).index()) {
            let [x, y] = self.flat.edges[d.index()];
            let ends = [surface.origin(d), surface.target(d)].map(|v| self.flat.vertices[v.index()]);
            for [a, b] in ends.into_iter().flatten() {
                let _ = write!(svg, "M{a:.1} {b:.1}L{x:.1} {y:.1}");
            }
            if let [None, Some(inner)] | [Some(inner), None] = ends {
                let out = unit(minus([x, y], inner));
                let _ = write!(svg, "M{x:.1} {y:.1}l{:.1} {:.1}", 14.0 * out[0], 14.0 * out[1]);
            }
        }
        svg.push_str("\"/>\n");
        for [x, y] in self.flat.vertices.iter().flatten() {
            let _ = writeln!(svg, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"2.5\" fill=\"#8a93a0\"/>");
        }
    }

    fn curves(&self, svg: &mut String, stroke: f64) {
        for (i, chord) in self.chords.iter().enumerate() {
            let arcs = self.arcs(chord);
            let [x, y] = arcs[0][0];
            let _ = write!(
                svg,
                "<path fill=\"none\" stroke=\"{}\" stroke-width=\"{stroke}\" d=\"M{x:.1} {y:.1}",
                self.colour(i)
            );
            for [_, a, b, q] in arcs {
                let _ = write!(svg, "C{:.1} {:.1} {:.1} {:.1} {:.1} {:.1}", a[0], a[1], b[0], b[1], q[0], q[1]);
            }
            svg.push_str("Z\"/>\n");
        }
    }

    fn legend(&self, svg: &mut String, component: Option<usize>) {
        let name = component.map_or_else(String::new, |c| format!("component {c}: "));
        let mut y = PANEL + 16.0;
        let _ = writeln!(
            svg,
            "<text x=\"{MARGIN}\" y=\"{y}\" font-weight=\"bold\">{name}{}, {}</text>",
            count(self.surface.n_quads(), "quad"),
            count(self.chords.len(), "chord")
        );
        for (i, chord) in self.chords.iter().enumerate().take(MOST_LINES) {
            y += LINE;
            let crossings = match chord.self_crossings.len() {
                0 => String::new(),
                k => format!(", {} ({} passages)", count(k, "self-crossing"), chord.crossings.len()),
            };
            let left = match self.chords.len() {
                n if i + 1 == MOST_LINES && n > MOST_LINES => format!("; {} more chords", n - MOST_LINES),
                _ => String::new(),
            };
            let _ = writeln!(
                svg,
                "<path stroke=\"{}\" stroke-width=\"3\" d=\"M{MARGIN} {1:.1}h26\"/><text x=\"{2}\" y=\"{y}\">c{3}: {4}{crossings}{left}</text>",
                self.colour(i),
                y - 4.5,
                MARGIN + 34.0,
                self.numbers[i],
                count(chord.length(), "quad")
            );
        }
    }
}

fn count(n: usize, one: &str) -> String {
    format!("{n} {one}{}", if n == 1 { "" } else { "s" })
}

fn mix(a: [f64; 2], b: [f64; 2], t: f64) -> [f64; 2] {
    [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])]
}

fn minus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

fn norm(a: [f64; 2]) -> f64 {
    a[0].hypot(a[1])
}

fn unit(a: [f64; 2]) -> [f64; 2] {
    let length = norm(a).max(f64::MIN_POSITIVE);
    [a[0] / length, a[1] / length]
}

#[cfg(test)]
mod tests {
    use super::*;
    use hexfill_mesh::generate::{all_spheres, cube_surface, torus};

    /// The chords among the paths of a drawing.
    fn curves(svg: &str) -> Vec<&str> {
        let found = svg.lines().filter(|l| l.starts_with("<path") && l.contains("d=\"M") && l.ends_with("Z\"/>"));
        found.collect()
    }

    #[test]
    fn every_chord_is_one_closed_curve_and_every_self_crossing_a_ring() {
        for surface in (6..=12).flat_map(all_spheres) {
            let drawing = chord_drawing(&surface, "a < b").unwrap();
            let all = chords(&surface);
            let drawn = curves(&drawing.svg);
            assert_eq!(drawn.len(), all.len());
            for (chord, curve) in all.iter().zip(drawn) {
                assert_eq!(curve.matches('C').count(), 2 * chord.crossings.len());
            }
            let crossings: usize = all.iter().map(|c| c.self_crossings.len()).sum();
            assert_eq!(drawing.svg.matches("r=\"6\"").count(), crossings);
            assert!(drawing.left_out.is_empty() && !drawing.svg.contains("NaN"));
            assert!(drawing.svg.contains("<title>a &lt; b</title>") && drawing.svg.contains(">c0: "));
            assert_eq!(drawing.svg, chord_drawing(&surface, "a < b").unwrap().svg);
        }
    }

    #[test]
    fn components_that_are_no_spheres_are_left_out_with_the_reason() {
        let both = |a: &QuadSurface, b: &QuadSurface| {
            let moved = b.quads().iter().map(|q| q.map(|v| v.0 + a.n_vertices() as u32));
            let quads: Vec<[u32; 4]> = a.quads().iter().map(|q| q.map(|v| v.0)).chain(moved).collect();
            QuadSurface::try_new(a.n_vertices() + b.n_vertices(), &quads).unwrap()
        };
        let (cube, ring) = (cube_surface(), torus(4, 5, 0).unwrap());
        let error = chord_drawing(&ring, "").unwrap_err().to_string();
        assert_eq!(error, "no chords are drawn: the surface has genus 1; only a sphere lies flat");
        let drawing = chord_drawing(&both(&ring, &cube), "").unwrap();
        assert_eq!(drawing.left_out, ["component 0 has genus 1; only a sphere lies flat"]);
        // The numbers are those of the whole surface: the ring has c0 to c8.
        assert!(drawing.svg.contains("component 1: 6 quads, 3 chords") && drawing.svg.contains(">c9: 4 quads<"));
        assert_eq!(curves(&chord_drawing(&both(&cube, &cube), "").unwrap().svg).len(), 6);
        assert!(chord_thumbnail(&ring, 90.0).is_none() && chord_thumbnail(&cube, 90.0).is_some());
    }
}
