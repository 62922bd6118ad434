//! The atlas engine: legality, growth, replay and look-up. `cargo bench -p hexfill-search`; compare side by side, absolute
//! times depend on the machine.

use criterion::{Criterion, criterion_group, criterion_main};
use hexfill_mesh::{Context, QuadSurface};
use hexfill_search::{Atlas, Cavity, FillOptions, GrowOptions, Growth, fill_from_atlas, legal_flips};
use std::hint::black_box;

/// The octagonal spindle: apexes 0 and 1, ring 2..10.
fn spindle() -> QuadSurface {
    let ring = |i: u32| 2 + i % 8;
    let quads: Vec<[u32; 4]> = (0..4)
        .flat_map(|i| {
            let [a, b, c, d] = [2 * i, 2 * i + 1, 2 * i + 2, 2 * i + 3].map(ring);
            [[0, a, b, c], [1, d, c, b]]
        })
        .collect();
    QuadSurface::try_new(10, &quads).expect("the spindle closes")
}

fn atlas(c: &mut Criterion) {
    let mut group = c.benchmark_group("atlas");
    group.sample_size(10);
    group.bench_function("grow to 26 hexes, cap 24", |b| {
        b.iter(|| {
            let mut growth = Growth::new(GrowOptions::default());
            while growth.level() < 26 {
                growth.grow(&Context::default());
            }
            growth.n_states()
        });
    });
    let surface = spindle();
    let (cavity, _) = Cavity::from_surface(&surface).expect("a small sphere");
    let ball = Atlas::embedded().balls_for(&cavity).next().expect("the spindle is in the atlas");
    group.bench_function("legal flips of the spindle's outside", |b| {
        b.iter(|| legal_flips(black_box(&ball.boundary), 24))
    });
    group.bench_function("fill the spindle from the embedded atlas", |b| {
        b.iter(|| fill_from_atlas(&surface, Atlas::embedded(), &FillOptions::default(), &Context::default()));
    });
    // What a program pays at its start: the first look-up touches the pages that it reads.
    group.bench_function("look the spindle up and replay it", |b| {
        b.iter(|| black_box(Atlas::embedded()).balls_for(black_box(&cavity)).next().is_some());
    });
    group.bench_function("read and check the packed atlas, as from a file", |b| {
        b.iter(|| Atlas::read_packed(include_bytes!("../data/default.hxatlas")));
    });
    // More fillings than the atlas has: inward flips look for the others.
    let many = FillOptions::default().with_count(1000).with_max_hexes(60).with_max_cavities(30_000);
    group.bench_function("30,000 cavities of inward flips", |b| {
        b.iter(|| fill_from_atlas(&surface, Atlas::embedded(), &many, &Context::default()));
    });
    group.finish();
}

criterion_group!(benches, atlas);
criterion_main!(benches);
