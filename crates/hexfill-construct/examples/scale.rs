//! Time and memory of the construction: `scale [k ...]` fills the cube with `6 k^2` quads and a torus of the same size.

use hexfill_check::{Judged, Level, judge};
use hexfill_construct::{ConstructOptions, construct};
use hexfill_mesh::generate::{cube_surface, refined, torus};
use hexfill_mesh::{Context, QuadSurface};
use std::time::Instant;

fn peak_gib() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|l| l.starts_with("VmHWM")).unwrap_or_default();
    let kib: f64 = line.split_whitespace().nth(1).and_then(|w| w.parse().ok()).unwrap_or(0.0);
    kib / (1 << 20) as f64
}

fn run(name: &str, surface: &QuadSurface, points: Option<&[[f64; 3]]>) {
    let start = Instant::now();
    let made = match construct(surface, points, &ConstructOptions::default(), &Context::default()) {
        Ok(made) => made,
        Err(e) => return println!("{name} {}: {e}", surface.n_quads()),
    };
    let construct_time = start.elapsed();
    let hexes: Vec<[u32; 8]> = made.mesh.hexes().iter().map(|h| h.map(|v| v.0)).collect();
    let quads: Vec<[u32; 4]> = surface.quads_raw();
    let n_vertices = made.mesh.n_vertices();
    let (n, per_quad, unmatched) = (hexes.len(), made.report.hexes_per_quad(), made.report.n_unmatched);
    drop(made);
    let before_check = peak_gib();
    let start = Instant::now();
    let options = hexfill_check::Options::default().with_up_to(Level::L3).with_betti(false);
    let report = judge(&Judged::connectivity(n_vertices, &hexes).with_surface(&quads), &options, &Context::default());
    println!(
        "{name} | {} quads | {n} hexes | {per_quad:.2} a quad | {unmatched} unmatched | construct {:.1} s, {before_check:.2} GiB | \
         check {:.1} s, {:.2} GiB | passed {}",
        surface.n_quads(),
        construct_time.as_secs_f64(),
        start.elapsed().as_secs_f64(),
        peak_gib(),
        report.passed(Level::L3),
    );
}

fn main() {
    let sizes: Vec<u32> = std::env::args().skip(1).filter_map(|a| a.parse().ok()).collect();
    for k in if sizes.is_empty() { vec![41, 129] } else { sizes } {
        let Ok(sphere) = refined(&cube_surface(), k) else { continue };
        run("sphere", &sphere, None);
        // About 6 k^2 quads, an odd number of steps round the axis: not bipartite.
        let (tube, axis) = (2 * k, 3 * k - (3 * k) % 2 + 1);
        let Ok(t) = torus(tube, axis, 0) else { continue };
        let turn = std::f64::consts::TAU;
        let points: Vec<[f64; 3]> = (0..axis)
            .flat_map(|j| {
                (0..tube).map(move |i| (turn * f64::from(i) / f64::from(tube), turn * f64::from(j) / f64::from(axis)))
            })
            .map(|(a, b)| [(3.0 + a.cos()) * b.cos(), (3.0 + a.cos()) * b.sin(), a.sin()])
            .collect();
        run("torus ", &t.inverted(), Some(&points));
    }
}
