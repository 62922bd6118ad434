//! Embeds a grid whose vertices were moved at random, from there: time and quality as the mesh grows.
//!
//! Usage: `jittered N [INNER] [OUTER] [SHARE] [untangle-only|scaled-jacobian]`: N x N x N unit cubes; a vertex is moved with
//! probability SHARE (1) by up to INNER (0.4) along each axis, on the boundary by up to OUTER (0). `HEXFILL_VERBOSE=1` shows progress.

use hexfill_embed::{Objective, Options, embed};
use hexfill_mesh::cube::POSITIONS;
use hexfill_mesh::{Context, HexMesh, Progress, Random};

/// Processor seconds of all threads so far (Linux; clock ticks of 10 ms).
fn processor_seconds() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields: Vec<f64> = stat.rsplit(')').next().unwrap_or("").split(' ').filter_map(|x| x.parse().ok()).collect();
    // After the name: the state (no number) and ten fields, then user and system time.
    fields.get(10).zip(fields.get(11)).map_or(f64::NAN, |(user, system)| (user + system) / 100.0)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let n: usize = words.first().map_or(Ok(22), |w| w.parse())?;
    let number = |i: usize, default: f64| words.get(i).map_or(Ok(default), |w| w.parse());
    let (inner, outer, share) = (number(1, 0.4)?, number(2, 0.0)?, number(3, 1.0)?);
    let objective = match words.get(4).map(String::as_str) {
        Some("untangle-only") => Objective::UntangleOnly,
        _ => Objective::ScaledJacobian,
    };
    let side = n + 1;
    let at = |[i, j, k]: [usize; 3]| (i + side * (j + side * k)) as u32;
    let hexes: Vec<[u32; 8]> = (0..n.pow(3))
        .map(|h| POSITIONS.map(|p| at([h % n + p[0] as usize, h / n % n + p[1] as usize, h / n / n + p[2] as usize])))
        .collect();
    let mut random = Random::of_task(7, 0);
    let points: Vec<[f64; 3]> = (0..side.pow(3))
        .map(|v| {
            let place = [v % side, v / side % side, v / side / side];
            let amount = if place.iter().all(|&x| x > 0 && x < n) { inner } else { outer };
            let moved = 0.5 * (random.signed() + 1.0) < share;
            place.map(|x| x as f64 + if moved { amount * random.signed() } else { 0.0 })
        })
        .collect();
    let mesh = HexMesh::try_new(points.len(), &hexes)?;
    let progress = |p: &Progress| eprintln!("{:7.2} s {} {} {}", processor_seconds(), p.stage, p.done, p.message);
    let verbose = std::env::var_os("HEXFILL_VERBOSE").is_some();
    let context = Context { progress: if verbose { Some(&progress) } else { None }, ..Context::default() };
    let before = processor_seconds();
    let report = embed(&mesh, &points, Some(&points), &Options::new(objective), &context)?.report;
    println!(
        "{} hexes: {:.2} s of processor, {} invalid, worst {:.6} (bound {:.6})",
        hexes.len(),
        processor_seconds() - before,
        report.n_invalid,
        report.scaled_jacobian,
        report.upper_bound
    );
    Ok(())
}
