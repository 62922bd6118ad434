//! Time and memory of the judge on a block of n^3 cubes: `cargo run --release -p hexfill-check --example judge_scale -- N [shuffle] [jitter]`.
//!
//! `once` makes only the run with levels 1 to 5 and Betti numbers; `shuffle` renames vertices and reorders hexes at random (worst case for the caches); `jitter` moves the vertices so that
//! nothing is axis-parallel.

use hexfill_check::{Judged, Level, Options, judge};
use hexfill_mesh::Context;
use std::time::Instant;

fn random(state: &mut u64) -> u64 {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    *state
}

fn peak_memory() -> String {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    status.lines().find(|l| l.starts_with("VmHWM")).unwrap_or("memory unknown").to_string()
}

/// Processor seconds of all threads so far (Linux; clock ticks of 10 ms).
fn processor_seconds() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields: Vec<f64> = stat.rsplit(')').next().unwrap_or("").split(' ').filter_map(|x| x.parse().ok()).collect();
    // After the name: the state (no number) and ten fields, then user and system time.
    fields.get(10).zip(fields.get(11)).map_or(f64::NAN, |(user, system)| (user + system) / 100.0)
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let n: usize = words.first().and_then(|w| w.parse().ok()).unwrap_or(100);
    let shuffle = words.iter().any(|w| w == "shuffle");
    let jitter = if words.iter().any(|w| w == "jitter") { 0.3 } else { 0.0 };
    let id = |x: usize, y: usize, z: usize| (x + (n + 1) * (y + (n + 1) * z)) as u32;
    let mut hexes = Vec::with_capacity(n * n * n);
    for z in 0..n {
        for y in 0..n {
            for x in 0..n {
                let level = |z| [id(x, y, z), id(x + 1, y, z), id(x + 1, y + 1, z), id(x, y + 1, z)];
                let ([a, b, c, d], [e, f, g, h]) = (level(z), level(z + 1));
                hexes.push([a, b, c, d, e, f, g, h]);
            }
        }
    }
    let mut seed = 0x1234_5678_9abc_def1;
    let mut points = Vec::with_capacity((n + 1).pow(3));
    for z in 0..=n {
        for y in 0..=n {
            for x in 0..=n {
                let mut move_by = || jitter * ((random(&mut seed) >> 11) as f64 / (1u64 << 53) as f64 - 0.5);
                points.push([x as f64 + move_by(), y as f64 + move_by(), z as f64 + move_by()]);
            }
        }
    }
    if shuffle {
        let mut names: Vec<u32> = (0..points.len() as u32).collect();
        for i in (1..names.len()).rev() {
            names.swap(i, (random(&mut seed) % (i as u64 + 1)) as usize);
        }
        for i in (1..hexes.len()).rev() {
            hexes.swap(i, (random(&mut seed) % (i as u64 + 1)) as usize);
        }
        hexes.iter_mut().flatten().for_each(|v| *v = names[*v as usize]);
        let old = points.clone();
        old.iter().zip(&names).for_each(|(p, &name)| points[name as usize] = *p);
    }
    println!("{} hexes, {} vertices, {} threads", hexes.len(), points.len(), rayon::current_num_threads());
    println!("input: {}", peak_memory());
    let input = Judged::connectivity(points.len(), &hexes).with_points(&points);
    let base = Options::default().with_betti(false).with_quality(false);
    for (name, options) in [
        ("L1", base.with_up_to(Level::L1)),
        ("L1-L2", base.with_up_to(Level::L2)),
        ("L1-L3", base.with_up_to(Level::L3)),
        ("L1-L5", base),
        ("L1-L5, quality", base.with_quality(true)),
        ("L1-L5, Betti", base.with_betti(true)),
        ("L1-L5, Betti, quality", base.with_betti(true).with_quality(true)),
    ] {
        if words.iter().any(|w| w == "once") && name != "L1-L5, Betti" {
            continue;
        }
        let (start, before) = (Instant::now(), processor_seconds());
        let report = judge(&input, &options, &Context::default());
        let used = processor_seconds() - before;
        println!("{name:<22} {:8.2} s  {used:8.2} s of processor  {}", start.elapsed().as_secs_f64(), peak_memory());
        if name.contains("Betti") {
            print!("{report}");
        }
    }
}
