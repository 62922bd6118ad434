//! How long a million quads take, in every format: only with `HEXFILL_SLOW=1`, because a shared machine says little.
//! Results are kept in `record/`.

use hexfill_io::{Encoding, Format, MeshData, read_from, write_to_with};
use std::time::Instant;

/// Seconds this thread has been running on a processor (Linux), which a busy machine does not stretch; otherwise wall time.
fn seconds(start: Instant) -> f64 {
    let stat = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let nanoseconds = stat.split_whitespace().next().and_then(|n| n.parse::<u64>().ok());
    nanoseconds.map_or_else(|| start.elapsed().as_secs_f64(), |n| n as f64 / 1e9)
}

#[test]
fn a_million_quads() {
    if std::env::var_os("HEXFILL_SLOW").is_none() {
        println!("skipped: set HEXFILL_SLOW=1");
        return;
    }
    let begin = Instant::now();
    let n: u32 = 1000;
    let point = |i: u32, j: u32| [f64::from(i) / 7.0, f64::from(j) / 11.0, (f64::from(i * j)).sin()];
    let points = (0..=n).flat_map(|i| (0..=n).map(move |j| point(i, j))).collect();
    let at = |i: u32, j: u32| i * (n + 1) + j;
    let quads =
        (0..n).flat_map(|i| (0..n).map(move |j| [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)])).collect();
    let mesh = MeshData::from_quads(points, quads);
    for format in Format::ALL {
        for encoding in [Encoding::Text, Encoding::Binary] {
            if encoding == Encoding::Binary && !format.has_binary() {
                continue;
            }
            let mut file = Vec::new();
            let before = seconds(begin);
            write_to_with(&mut file, format, &mesh, encoding).unwrap();
            let between = seconds(begin);
            let back = read_from(file.as_slice(), format, "speed").unwrap();
            let after = seconds(begin);
            assert_eq!(back.quads, mesh.quads);
            assert_eq!(back.points, mesh.points);
            println!(
                "{:6} {encoding:6?} {:6.1} MB  write {:5.2} s  read {:5.2} s",
                format.name(),
                file.len() as f64 / 1e6,
                between - before,
                after - between
            );
        }
    }
}
