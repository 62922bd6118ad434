//! Measures sweeps: `cargo run --release -p hexfill-shell --example measure -- SURFACE.obj|box:N|refined:N ... [pillows=K] [seed=S]`.

use hexfill_check::{Judged, Level, judge};
use hexfill_mesh::generate::{octagonal_spindle, random_sphere, refined, schneiders_pyramid, voxel_surface};
use hexfill_mesh::{Context, QuadSurface, chords};
use hexfill_shell::{SweepOptions, sweep};
use std::collections::HashMap;

fn read_obj(text: &str) -> (QuadSurface, Vec<[f64; 3]>) {
    let (mut points, mut faces) = (Vec::new(), Vec::new());
    for line in text.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words.first() {
            Some(&"v") => points.push([1, 2, 3].map(|k| words[k].parse::<f64>().unwrap())),
            Some(&"f") => {
                let index = |w: &&str| w.split('/').next().unwrap().parse::<u32>().unwrap() - 1;
                faces.push(words[1..].iter().map(index).collect::<Vec<u32>>());
            }
            _ => {}
        }
    }
    (QuadSurface::try_from_polygons(points.len(), &faces).unwrap(), points)
}

/// Angle / 90 degrees inside at each edge, from the normals of its quads.
fn angles(surface: &QuadSurface, points: &[[f64; 3]]) -> HashMap<(u32, u32), f32> {
    let sub = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|c| a[c] - b[c]);
    let cross =
        |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|c| a[(c + 1) % 3] * b[(c + 2) % 3] - a[(c + 2) % 3] * b[(c + 1) % 3]);
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let normal = |q: hexfill_mesh::QuadId| {
        let [a, b, c, d] = surface.quad(q).map(|v| points[v.index()]);
        let n = cross(sub(c, a), sub(d, b));
        let length = dot(n, n).sqrt();
        n.map(|x| x / length)
    };
    let angle = |d: hexfill_mesh::Dart| {
        let (n, m) = (normal(d.quad()), normal(surface.twin(d).quad()));
        let (a, b) = (surface.origin(d), surface.target(d));
        let along = sub(points[b.index()], points[a.index()]);
        let sine = dot(cross(n, m), along) / dot(along, along).sqrt();
        let inside = std::f64::consts::PI - sine.atan2(dot(n, m));
        ((a.0.min(b.0), a.0.max(b.0)), (inside / std::f64::consts::FRAC_PI_2) as f32)
    };
    surface.darts().map(angle).collect()
}

fn main() {
    let mut options = SweepOptions::default();
    let mut want = false;
    for argument in std::env::args().skip(1) {
        let number = |text: &str| text.parse::<usize>().unwrap();
        let (surface, points) = match argument.split_once([':', '=']) {
            Some(("pillows", k)) => {
                options.pillows = k.parse().unwrap();
                continue;
            }
            Some(("want", k)) => {
                want = k == "1";
                continue;
            }
            Some(("atlas", _)) => {
                options.atlas = Some(hexfill_search::Atlas::embedded());
                continue;
            }
            Some(("stir", k)) => {
                options.stir = k.parse().unwrap();
                continue;
            }
            Some(("restarts", k)) => {
                options.restarts = k.parse().unwrap();
                continue;
            }
            Some(("seed", k)) => {
                options.seed = k.parse().unwrap();
                continue;
            }
            Some(("box", n)) => (voxel_surface([number(n); 3], |_| true).unwrap(), Vec::new()),
            Some(("random", n)) => (random_sphere(number(n), options.seed).unwrap(), Vec::new()),
            Some(("pyramid", n)) => (refined(&schneiders_pyramid(), number(n) as u32).unwrap(), Vec::new()),
            Some(("spindle", n)) => (refined(&octagonal_spindle(), number(n) as u32).unwrap(), Vec::new()),
            _ => read_obj(&std::fs::read_to_string(&argument).unwrap()),
        };
        let crossings: usize = chords(&surface).iter().map(|c| c.self_crossings.len()).sum();
        let angles = if want && !points.is_empty() { angles(&surface, &points) } else { Default::default() };
        let edge_want = |a: u32, b: u32| angles.get(&(a.min(b), a.max(b))).copied().unwrap_or(2.0);
        let options = SweepOptions { edge_want: if want { Some(&edge_want) } else { None }, ..options };
        let start = std::time::Instant::now();
        let swept = sweep(&surface, Some(&points), &options, &Context::default());
        let time = start.elapsed().as_secs_f64();
        let mut verdict = "open";
        if swept.front.is_empty() {
            let quads: Vec<[u32; 4]> = surface.quads().iter().map(|q| q.map(|v| v.0)).collect();
            let input = Judged::connectivity(swept.n_vertices as usize, &swept.hexes).with_surface(&quads);
            let options = hexfill_check::Options::default().up_to(Level::L3);
            verdict =
                if judge(&input, &options, &Context::default()).passed(Level::L3) { "proper" } else { "IMPROPER" };
        }
        if !swept.front.is_empty() {
            let describe = |front: &[[u32; 4]], n: u32| {
                let s = QuadSurface::try_new(n as usize, front).unwrap();
                let all: Vec<(usize, usize)> =
                    chords(&s).iter().map(|c| (c.length(), c.self_crossings.len())).collect();
                println!("  {} quads left, chords (length, self-crossings) {all:?}", front.len());
            };
            describe(&swept.front, swept.n_vertices);
        }
        println!(
            "{argument}: {} quads, genus {}, {crossings} self-crossings: {} hexes, {} quads left, {time:.2} s, {verdict}",
            surface.n_quads(),
            surface.genus(),
            swept.hexes.len(),
            swept.front.len()
        );
    }
}
