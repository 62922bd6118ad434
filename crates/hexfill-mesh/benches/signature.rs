//! Time of canonical signatures, from a cavity of 24 quads to large surfaces.

use criterion::{Criterion, criterion_group, criterion_main};
use hexfill_mesh::generate::{grid, grid_mesh_of, random_sphere, refined, schneiders_pyramid, torus};
use hexfill_mesh::{hex_signature, surface_signature};
use std::hint::black_box;

fn signatures(c: &mut Criterion) {
    let mut group = c.benchmark_group("signature");
    let small = random_sphere(24, 1).expect("24 quads are possible");
    group.bench_function("random sphere, 24 quads", |b| b.iter(|| surface_signature(black_box(&small))));
    let screw = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [1, 1, 1], [0, 1, 1], [0, 1, 2], [0, 0, 2]];
    let seven = grid_mesh_of([2, 2, 3], |p| screw.contains(&p)).expect("small enough");
    group.bench_function("seven hexes without symmetry", |b| b.iter(|| hex_signature(black_box(&seven))));
    group.sample_size(10);
    let block = grid(40, 50, 50).expect("small enough");
    group.bench_function("block, 100000 hexes", |b| b.iter(|| hex_signature(black_box(&block))));
    let large = random_sphere(100_000, 1).expect("100000 quads are possible");
    group.bench_function("random sphere, 100000 quads", |b| b.iter(|| surface_signature(black_box(&large))));
    let fine = refined(&schneiders_pyramid(), 80).expect("small enough");
    group.bench_function("refined pyramid, 102400 quads", |b| b.iter(|| surface_signature(black_box(&fine))));
    let ring = torus(250, 400, 3).expect("small enough");
    group.bench_function("torus, 100000 quads", |b| b.iter(|| surface_signature(black_box(&ring))));
    group.finish();
}

criterion_group!(benches, signatures);
criterion_main!(benches);
