//! Writing and reading 8,000 hexes in every format that holds them, in memory. `cargo bench -p hexfill-io`; compare side by side,
//! absolute times depend on the machine. `tests/speed.rs` does the same for a million quads.

use criterion::{Criterion, criterion_group, criterion_main};
use hexfill_io::{Encoding, Format, MeshData, read_from, write_to_with};
use hexfill_mesh::generate::grid;

/// Cubes along an edge of the block.
const N: usize = 20;

fn formats(c: &mut Criterion) {
    let mesh = grid(N, N, N).expect("a block of cubes");
    // No two alike, and with many digits.
    let points = (0..mesh.n_vertices()).map(|v| [1, 2, 3].map(|k| (v as f64 / 7.0 + f64::from(k)).sin())).collect();
    let data = MeshData { points, hexes: mesh.hexes_raw(), ..MeshData::default() };
    let mut group = c.benchmark_group("8,000 hexes");
    group.sample_size(10);
    for format in Format::ALL {
        for encoding in [Encoding::Text, Encoding::Binary] {
            if data.check_for(format).is_err() || encoding == Encoding::Binary && !format.has_binary() {
                continue;
            }
            let name = format!("{} {encoding:?}", format.name());
            let mut file = Vec::new();
            write_to_with(&mut file, format, &data, encoding).expect("memory takes it");
            group.bench_function(format!("write {name}"), |b| {
                b.iter(|| write_to_with(&mut Vec::with_capacity(file.len()), format, &data, encoding));
            });
            group.bench_function(format!("read {name}"), |b| b.iter(|| read_from(file.as_slice(), format, "bench")));
        }
    }
    group.finish();
}

criterion_group!(benches, formats);
criterion_main!(benches);
