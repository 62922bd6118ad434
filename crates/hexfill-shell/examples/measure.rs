//! Measures sweeps: `cargo run --release -p hexfill-shell --example measure -- SURFACE.obj|box:N|refined:N ... [pillows=K] [seed=S]`.

use hexfill_check::{Judged, Level, judge};
use hexfill_geometry::{Vector, cross, dot, norm, sub, unit};
use hexfill_mesh::generate::{octagonal_spindle, random_sphere, refined, schneiders_pyramid, voxel_surface};
use hexfill_mesh::{Context, QuadSurface, chords};
use hexfill_shell::{SweepOptions, sweep};
use std::collections::HashMap;

fn read(path: &str) -> (QuadSurface, Vec<Vector>) {
    let data = hexfill_io::read_path(path.as_ref(), None).expect("a readable surface");
    (data.quad_surface().expect("a closed quad surface"), data.points)
}

/// Angle / 90 degrees inside at each edge, from the normals of its quads.
fn angles(surface: &QuadSurface, points: &[Vector]) -> HashMap<(u32, u32), f32> {
    let normal = |q: hexfill_mesh::QuadId| {
        let [a, b, c, d] = surface.quad(q).map(|v| points[v.index()]);
        unit(cross(sub(c, a), sub(d, b))).expect("a quad spans a plane")
    };
    let angle = |d: hexfill_mesh::Dart| {
        let (n, m) = (normal(d.quad()), normal(surface.twin(d).quad()));
        let (a, b) = (surface.origin(d), surface.target(d));
        let along = sub(points[b.index()], points[a.index()]);
        let sine = dot(cross(n, m), along) / norm(along);
        let inside = std::f64::consts::PI - sine.atan2(dot(n, m));
        ((a.0.min(b.0), a.0.max(b.0)), (inside / std::f64::consts::FRAC_PI_2) as f32)
    };
    surface.darts().map(angle).collect()
}

fn main() {
    let mut options = SweepOptions::default();
    let (mut want, mut seed) = (false, 0);
    for argument in std::env::args().skip(1) {
        let number = |text: &str| text.parse::<usize>().unwrap();
        let (surface, points) = match argument.split_once([':', '=']) {
            Some(("pillows", k)) => {
                options = options.with_pillows(k.parse().unwrap());
                continue;
            }
            Some(("want", k)) => {
                want = k == "1";
                continue;
            }
            Some(("atlas", _)) => {
                options = options.with_atlas(hexfill_search::Atlas::embedded());
                continue;
            }
            Some(("stir", k)) => {
                options = options.with_stir(k.parse().unwrap());
                continue;
            }
            Some(("restarts", k)) => {
                options = options.with_restarts(k.parse().unwrap());
                continue;
            }
            Some(("seed", k)) => {
                seed = k.parse().unwrap();
                options = options.with_seed(seed);
                continue;
            }
            Some(("box", n)) => (voxel_surface([number(n); 3], |_| true).unwrap(), Vec::new()),
            Some(("random", n)) => (random_sphere(number(n), seed).unwrap(), Vec::new()),
            Some(("pyramid", n)) => (refined(&schneiders_pyramid(), number(n) as u32).unwrap(), Vec::new()),
            Some(("spindle", n)) => (refined(&octagonal_spindle(), number(n) as u32).unwrap(), Vec::new()),
            _ => read(&argument),
        };
        let crossings: usize = chords(&surface).iter().map(|c| c.self_crossings.len()).sum();
        let angles = if want && !points.is_empty() { angles(&surface, &points) } else { Default::default() };
        let edge_want = |a: u32, b: u32| angles.get(&(a.min(b), a.max(b))).copied().unwrap_or(2.0);
        let options = if want { options.with_edge_want(&edge_want) } else { options };
        let start = std::time::Instant::now();
        let swept = sweep(&surface, Some(&points), &options, &Context::default());
        let time = start.elapsed().as_secs_f64();
        let mut verdict = "open";
        if swept.front.is_empty() {
            let quads: Vec<[u32; 4]> = surface.quads_raw();
            let input = Judged::connectivity(swept.n_vertices as usize, &swept.hexes).with_surface(&quads);
            let options = hexfill_check::Options::default().with_up_to(Level::L3);
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
