//! Coordinates for small meshes to their optimum, and for noisy grids. `cargo bench -p hexfill-embed`; compare side by side, absolute
//! times depend on the machine. `--example jittered` does the same for up to 10^6 hexes.

use criterion::{Criterion, criterion_group, criterion_main};
use hexfill_embed::{Objective, Options, embed};
use hexfill_mesh::generate::grid;
use hexfill_mesh::{Context, HexMesh, Random};

#[derive(serde::Deserialize)]
struct Stored {
    hexes: Vec<[u32; 8]>,
    boundary_points: Vec<[f64; 3]>,
}

/// A mesh of `tests/data`, with the points of its boundary.
fn stored(text: &str) -> (HexMesh, Vec<[f64; 3]>) {
    let Stored { hexes, boundary_points } = serde_json::from_str(text).expect("a stored mesh");
    let n = hexes.iter().flatten().max().map_or(0, |&v| v as usize + 1);
    (HexMesh::try_new(n, &hexes).expect("a stored mesh"), boundary_points)
}

/// `n`^3 unit cubes whose vertices moved by up to `inner` along each axis, on the boundary by up to `outer`.
fn jittered(n: usize, inner: f64, outer: f64) -> (HexMesh, Vec<[f64; 3]>) {
    let (mut random, side) = (Random::of_task(7, 0), n + 1);
    let points = (0..side.pow(3)).map(|v| {
        let place = [v % side, v / side % side, v / side / side];
        let amount = if place.iter().all(|&x| x > 0 && x < n) { inner } else { outer };
        place.map(|x| x as f64 + amount * random.signed())
    });
    let points = points.collect();
    (grid(n, n, n).expect("a block of cubes"), points)
}

fn embedding(c: &mut Criterion) {
    let mut group = c.benchmark_group("embed");
    group.sample_size(10);
    let best = Options::default();
    for (name, text) in [
        ("pyramid, 36 hexes, to its bound", include_str!("../tests/data/pyramid_36.json")),
        ("spindle, 40 hexes", include_str!("../tests/data/spindle_40.json")),
    ] {
        let (mesh, boundary) = stored(text);
        group.bench_function(name, |b| b.iter(|| embed(&mesh, &boundary, None, &best, &Context::default())));
    }
    let (mesh, points) = jittered(12, 0.4, 0.2);
    group.bench_function("1,728 noisy hexes, raised", |b| {
        b.iter(|| embed(&mesh, &points, Some(&points), &best, &Context::default()));
    });
    let (mesh, points) = jittered(30, 0.6, 0.1);
    let valid = Options::new(Objective::UntangleOnly);
    group.bench_function("27,000 noisy hexes, untangled", |b| {
        b.iter(|| embed(&mesh, &points, Some(&points), &valid, &Context::default()));
    });
    group.finish();
}

criterion_group!(benches, embedding);
criterion_main!(benches);
