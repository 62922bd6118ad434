//! The engine on surfaces with known answers. `cargo bench -p hexfill-shell`; compare side by side, absolute times depend
//! on the machine. No coordinates are optimised here: that is the work of `hexfill-embed`.

use criterion::{Criterion, criterion_group, criterion_main};
use hexfill_mesh::generate::{cubed_sphere, grid, torus, voxels};
use hexfill_mesh::{Context, QuadSurface};
use hexfill_shell::{Coarsening, ShellOptions, Shelling, SweepOptions, shell, sweep};
use std::hint::black_box;

type Point = [f64; 3];

/// The surface of a box of `n`^3 unit cubes.
fn box_surface(n: usize) -> (QuadSurface, Vec<Point>) {
    let (surface, points) = voxels([n; 3], |_| true).expect("a box closes");
    (surface, points.into_iter().map(|p| p.map(f64::from)).collect())
}

/// An octahedron whose triangles are cut into `k`^2 triangles, each of them cut into three quads, on the unit sphere.
fn cut_triangulation(k: u32) -> (QuadSurface, Vec<Point>) {
    let k = k as i32;
    let mut points: Vec<Point> = Vec::new();
    let mut ids = std::collections::BTreeMap::new();
    // A point is named by the sum of six corners of one small triangle, with repetition, so that all lie on a finer grid.
    let mut id = |corners: [[i32; 3]; 6]| {
        let sum = [0, 1, 2].map(|c| corners.iter().map(|p| p[c]).sum::<i32>());
        *ids.entry(sum).or_insert_with(|| {
            let length = sum.iter().map(|&x| f64::from(x).powi(2)).sum::<f64>().sqrt();
            points.push(sum.map(|x| f64::from(x) / length));
            points.len() as u32 - 1
        })
    };
    let mut quads = Vec::new();
    for signs in (0..8).map(|s| [0, 1, 2].map(|c| if s >> c & 1 == 0 { 1 } else { -1 })) {
        let at = |i: i32, j: i32| [0, 1, 2].map(|c| signs[c] * [i, j, k - i - j][c]);
        let up =
            (0..k).flat_map(|j| (0..k - j).map(move |i| (i, j))).map(|(i, j)| [at(i, j), at(i + 1, j), at(i, j + 1)]);
        let down = (0..k - 1).flat_map(|j| (0..k - 1 - j).map(move |i| (i, j)));
        let down = down.map(|(i, j)| [at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
        for mut t in up.chain(down) {
            if signs.iter().product::<i32>() < 0 {
                t.reverse();
            }
            for c in 0..3 {
                let [a, b, d] = [t[c], t[(c + 1) % 3], t[(c + 2) % 3]];
                quads.push([id([a; 6]), id([a, a, a, b, b, b]), id([a, a, b, b, d, d]), id([a, a, a, d, d, d])]);
            }
        }
    }
    (QuadSurface::try_new(points.len(), &quads).expect("a cut octahedron closes"), points)
}

/// A torus of `n` quads round the axis and `m` round the tube.
fn round_torus(n: u32, m: u32) -> (QuadSurface, Vec<Point>) {
    let turn = std::f64::consts::TAU;
    let point = |k: u32| {
        let (tube, axis) = (turn * f64::from(k % m) / f64::from(m), turn * f64::from(k / m) / f64::from(n));
        let d = 3.0 + tube.cos();
        [d * axis.cos(), d * axis.sin(), tube.sin()]
    };
    (torus(m, n, 0).expect("a torus closes"), (0..n * m).map(point).collect())
}

/// Outward, as the engine wants it: by the volume under the quads.
fn outward((surface, points): (QuadSurface, Vec<Point>)) -> (QuadSurface, Vec<Point>) {
    let volume = |q: &[hexfill_mesh::VertexId; 4]| {
        let [a, b, c, d] = q.map(|v| points[v.index()]);
        let det = |a: Point, b: Point, c: Point| -> f64 {
            (0..3).map(|i| a[i] * (b[(i + 1) % 3] * c[(i + 2) % 3] - b[(i + 2) % 3] * c[(i + 1) % 3])).sum()
        };
        det(a, b, c) + det(a, c, d)
    };
    let sum: f64 = surface.quads().iter().map(volume).sum();
    (if sum > 0.0 { surface } else { surface.inverted() }, points)
}

fn whole((surface, points): &(QuadSurface, Vec<Point>)) -> Shelling {
    let shelling = shell(black_box(surface), Some(points), &ShellOptions::default(), &Context::default());
    assert!(!shelling.meshes.is_empty(), "{} quads left", shelling.left);
    shelling
}

fn engine(c: &mut Criterion) {
    let mut group = c.benchmark_group("shell");
    group.sample_size(10);
    for (name, given) in [
        ("box 20^3, 2,400 quads", box_surface(20)),
        ("cubed sphere 8^3, 384 quads", cubed_sphere(8).expect("a box closes")),
        ("cut triangulation, 216 quads", outward(cut_triangulation(3))),
        ("torus 12 x 8, plugs", outward(round_torus(12, 8))),
    ] {
        group.bench_function(name, |b| b.iter(|| whole(&given)));
    }
    group.finish();
}

/// One sweep by flips, without compression, restarts and lifting.
fn flips(c: &mut Criterion) {
    let mut group = c.benchmark_group("sweep by flips");
    group.sample_size(10);
    for k in [4, 6] {
        let (surface, points) = outward(cut_triangulation(k));
        let name = format!("cut triangulation, {} quads", surface.n_quads());
        group.bench_function(name, |b| {
            b.iter(|| sweep(black_box(&surface), Some(&points), &SweepOptions::default(), &Context::default()));
        });
    }
    group.finish();
}

/// One round on a block: three stacks of 30 sheets.
fn coarser(c: &mut Criterion) {
    let mesh = grid(30, 30, 30).expect("a grid is a mesh");
    c.bench_function("coarsen 27,000 cubes", |b| {
        b.iter(|| Coarsening::new(black_box(&mesh)).round(&Context::default()))
    });
}

criterion_group!(benches, engine, flips, coarser);
criterion_main!(benches);
