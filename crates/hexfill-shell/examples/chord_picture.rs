//! Draws a surface with its chords, and what is left to fill after 0, 1, 2, ... layers, as SVG:
//! `cargo run -p hexfill-shell --example chord_picture -- SURFACE.obj OUT.svg [LAYERS]`.
//!
//! Parallel projection, quads that face away left out, the others from back to front. Layers are taken as the engine takes
//! them (least difference from the hexes that edges want), but one at a time, with plane positions, and without any check
//! of what is legal: for pictures of simple solids.

use hexfill_geometry::{Vector as Point, cross, dot, norm, sub};
use hexfill_mesh::{Chord, Dart, QuadSurface, chords};
use std::fmt::Write;

/// Size of one panel.
const PANEL: f64 = 300.0;
const COLOURS: [&str; 10] =
    ["#c23b22", "#1f6fb4", "#2a8f4a", "#8e44ad", "#d98200", "#0e8c8c", "#a0522d", "#c2378f", "#5a6b00", "#3b3b98"];

/// The unit vector along `a`, which is not zero.
fn unit(a: Point) -> Point {
    let length = norm(a);
    a.map(|x| x / length)
}

fn read(path: &str) -> (QuadSurface, Vec<Point>) {
    let data = hexfill_io::read_path(path.as_ref(), None).expect("a readable surface");
    (data.quad_surface().expect("a closed quad surface"), data.points)
}

fn normal(surface: &QuadSurface, points: &[Point], d: Dart) -> Point {
    let [a, b, c, e] = surface.quad(d.quad()).map(|v| points[v.index()]);
    unit(cross(sub(c, a), sub(e, b)))
}

/// Hexes wanted round the edge of a dart: its angle inside, in right angles.
fn wanted(surface: &QuadSurface, points: &[Point], d: Dart) -> f64 {
    let (n, m) = (normal(surface, points, d), normal(surface, points, surface.twin(d)));
    let along = unit(sub(points[surface.target(d).index()], points[surface.origin(d).index()]));
    2.0 - dot(cross(n, m), along).atan2(dot(n, m)) / std::f64::consts::FRAC_PI_2
}

/// The quads on one side of a ring, which `rim` (darts of ring quads, on that side) bounds.
fn side(surface: &QuadSurface, ring: &[bool], rim: &[Dart]) -> Vec<bool> {
    let mut seen = vec![false; surface.n_quads()];
    let mut stack: Vec<Dart> = rim.iter().map(|&d| surface.twin(d)).collect();
    while let Some(d) = stack.pop() {
        let q = d.quad().index();
        if !ring[q] && !std::mem::replace(&mut seen[q], true) {
            stack.extend(
                (0..4).map(|_| d).scan(d, |at, _| Some(std::mem::replace(at, at.next()))).map(|e| surface.twin(e)),
            );
        }
    }
    seen
}

/// A layer: the side R of a chord, and for each rim vertex the other end of its rung.
struct Layer {
    ring: Vec<bool>,
    side: Vec<bool>,
    top: Vec<Option<usize>>,
    cost: f64,
}

fn layer(surface: &QuadSurface, points: &[Point], chord: &Chord, left: bool) -> Option<Layer> {
    if !chord.self_crossings.is_empty() {
        return None;
    }
    let mut ring = vec![false; surface.n_quads()];
    chord.quads().for_each(|q| ring[q.index()] = true);
    // The chord enters across d, so the two other sides of the quad are its rims.
    let rim: Vec<Dart> = chord.crossings.iter().map(|d| if left { d.next().opposite() } else { d.next() }).collect();
    let side = side(surface, &ring, &rim);
    let mut top = vec![None; points.len()];
    for d in &chord.crossings {
        let (a, b) = (surface.origin(*d).index(), surface.target(*d).index());
        let (from, to) = if left { (a, b) } else { (b, a) };
        top[from] = Some(to);
    }
    let inside = |d: Dart| side[d.quad().index()];
    if rim.iter().any(|&d| !inside(surface.twin(d))) {
        return None;
    }
    let mut cost = 0.0;
    for d in surface.darts().filter(|&d| inside(d)) {
        let r = wanted(surface, points, d);
        let v = surface.origin(d);
        if inside(surface.twin(d)) {
            cost += (r - 2.0).powi(2) / 2.0;
        } else {
            cost += (r - 1.0).powi(2);
        }
        if top[v.index()].is_none() {
            cost += (f64::from(surface.degree(v)) - 4.0).powi(2) / f64::from(surface.degree(v));
        }
    }
    for d in &chord.crossings {
        let v = if left { surface.origin(*d) } else { surface.target(*d) };
        let n = (0..surface.n_quads()).filter(|&q| side[q] && surface.quads()[q].contains(&v)).count();
        cost += (wanted(surface, points, *d) - n as f64).powi(2);
    }
    for &d in &rim {
        let far = d.opposite();
        cost += (2.0 - wanted(surface, points, far)).max(0.0).powi(2);
    }
    Some(Layer { ring, side, top, cost })
}

/// The front behind the layer that costs least; of equal ones the one with fewest hexes.
fn after_layer(surface: &QuadSurface, points: &[Point]) -> Option<(QuadSurface, Vec<Point>, usize)> {
    let all: Vec<Layer> = chords(surface)
        .iter()
        .flat_map(|c| [false, true].map(|left| layer(surface, points, c, left)))
        .flatten()
        .collect();
    let hexes = |l: &Layer| l.side.iter().filter(|&&s| s).count();
    let best = all.iter().min_by(|a, b| a.cost.total_cmp(&b.cost).then(hexes(a).cmp(&hexes(b))))?;
    let steps: Vec<Point> =
        best.top.iter().enumerate().filter_map(|(v, t)| t.map(|t| sub(points[t], points[v]))).collect();
    let mean = [0, 1, 2].map(|c| steps.iter().map(|s| s[c]).sum::<f64>() / steps.len() as f64);
    let mut points = points.to_vec();
    let mut top = best.top.clone();
    let mut quads = Vec::new();
    for (q, quad) in surface.quads().iter().enumerate().filter(|(q, _)| !best.ring[*q]) {
        quads.push(quad.map(|v| {
            if !best.side[q] {
                return v.0;
            }
            let t = *top[v.index()].get_or_insert_with(|| {
                let p = points[v.index()];
                points.push([0, 1, 2].map(|c| p[c] + mean[c]));
                points.len() - 1
            });
            t as u32
        }));
    }
    let surface = QuadSurface::try_new(points.len(), &quads).ok()?;
    Some((surface, points, hexes(best)))
}

/// From three-dimensional positions to the page, the same for all panels.
struct Projection {
    right: Point,
    up: Point,
    eye: Point,
    scale: f64,
    centre: [f64; 2],
}

impl Projection {
    fn new(points: &[Point]) -> Self {
        let eye = unit([1.0, -1.9, 1.05]);
        let right = unit(cross([0.0, 0.0, 1.0], eye));
        let up = cross(eye, right);
        let (mut low, mut high) = ([f64::MAX; 2], [f64::MIN; 2]);
        for p in points {
            for (k, x) in [dot(*p, right), dot(*p, up)].into_iter().enumerate() {
                (low[k], high[k]) = (low[k].min(x), high[k].max(x));
            }
        }
        let scale = 0.9 * PANEL / (high[0] - low[0]).max(high[1] - low[1]);
        Self { right, up, eye, scale, centre: [0, 1].map(|k| (low[k] + high[k]) / 2.0) }
    }

    /// The point on the page, in the panel of this number.
    fn at(&self, p: Point, panel: usize) -> String {
        let x = PANEL * (panel as f64 + 0.5) + self.scale * (dot(p, self.right) - self.centre[0]);
        let y = PANEL * 0.5 - self.scale * (dot(p, self.up) - self.centre[1]);
        format!("{x:.1},{y:.1}")
    }
}

/// Draws one panel: each quad in a light fill, each chord as a polyline through the midpoints of edges.
fn draw(out: &mut String, surface: &QuadSurface, points: &[Point], to: &Projection, panel: usize) {
    let all = chords(surface);
    let mut colour = vec![[0; 2]; surface.n_quads()];
    for (i, chord) in all.iter().enumerate() {
        chord.crossings.iter().for_each(|d| colour[d.quad().index()][d.side() % 2] = i % COLOURS.len());
    }
    let mut seen: Vec<(f64, Dart)> = surface
        .darts()
        .filter(|d| d.side() == 0 && dot(normal(surface, points, *d), to.eye) > 1e-9)
        .map(|d| (surface.quad(d.quad()).iter().map(|v| dot(points[v.index()], to.eye)).sum(), d))
        .collect();
    seen.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (_, d) in seen {
        let corners = surface.quad(d.quad()).map(|v| points[v.index()]);
        let light = dot(normal(surface, points, d), unit([0.2, -0.6, 1.0])).max(0.0);
        let grey = (206.0 + 44.0 * light) as u8;
        let line: Vec<String> = corners.iter().map(|p| to.at(*p, panel)).collect();
        let _ = writeln!(
            out,
            "<polygon points='{}' fill='rgb({grey},{grey},{})' stroke='#8a93a0' stroke-width='0.7'/>",
            line.join(" "),
            grey.saturating_add(4)
        );
        let middle = |i: usize| [0, 1, 2].map(|c| (corners[i][c] + corners[(i + 1) % 4][c]) / 2.0);
        for i in 0..2 {
            let _ = writeln!(
                out,
                "<polyline points='{} {}' fill='none' stroke='{}' stroke-width='2' stroke-linecap='round'/>",
                to.at(middle(i), panel),
                to.at(middle(i + 2), panel),
                COLOURS[colour[d.quad().index()][i]]
            );
        }
    }
}

fn main() {
    let words: Vec<String> = std::env::args().collect();
    let [_, input, output, layers @ ..] = &words[..] else {
        eprintln!("chord_picture SURFACE.obj OUT.svg [LAYERS]");
        std::process::exit(2);
    };
    let layers: usize = layers.first().map_or(0, |n| n.parse().unwrap());
    let (mut surface, mut points) = read(input);
    let to = Projection::new(&points);
    let mut body = String::new();
    draw(&mut body, &surface, &points, &to, 0);
    let mut panels = 1;
    for _ in 0..layers {
        let Some((rest, moved, hexes)) = after_layer(&surface, &points) else { break };
        println!("a layer of {hexes} hexes: {} quads become {}", surface.n_quads(), rest.n_quads());
        (surface, points) = (rest, moved);
        draw(&mut body, &surface, &points, &to, panels);
        panels += 1;
    }
    let width = PANEL * panels as f64;
    let head = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {width} {PANEL}' width='{width}' height='{PANEL}'>"
    );
    std::fs::write(output, format!("{head}\n{body}</svg>\n")).unwrap();
}
