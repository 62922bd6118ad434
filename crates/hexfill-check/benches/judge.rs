//! The judge on 27,000 jittered hexes, level by level. `cargo bench -p hexfill-check`; compare side by side, absolute times
//! depend on the machine. `--example judge_scale` does the same for 10^6 hexes, with the memory.

use criterion::{Criterion, criterion_group, criterion_main};
use hexfill_check::{Judged, Level, Options, judge};
use hexfill_mesh::generate::grid;
use hexfill_mesh::{Context, Random};

/// Cubes along an edge of the block.
const N: usize = 30;

fn judging(c: &mut Criterion) {
    let mesh = grid(N, N, N).expect("a block of cubes");
    let hexes = mesh.hexes_raw();
    let (mut random, side) = (Random::of_task(3, 0), N + 1);
    let points: Vec<[f64; 3]> = (0..side.pow(3))
        .map(|v| [v % side, v / side % side, v / side / side].map(|x| x as f64 + 0.15 * random.signed()))
        .collect();
    let input = Judged::connectivity(points.len(), &hexes).with_points(&points);
    let base = Options::default().with_betti(false).with_quality(false);
    let mut group = c.benchmark_group("judge 27,000 hexes");
    group.sample_size(10);
    for (name, options) in [
        ("L1-L3", base.with_up_to(Level::L3)),
        ("L1-L5", base),
        ("L1-L5, quality", base.with_quality(true)),
        ("L1-L5, Betti numbers", base.with_betti(true)),
    ] {
        assert!(judge(&input, &options, &Context::default()).no_failure(), "{name}");
        group.bench_function(name, |b| b.iter(|| judge(&input, &options, &Context::default())));
    }
    group.finish();
}

criterion_group!(benches, judging);
criterion_main!(benches);
