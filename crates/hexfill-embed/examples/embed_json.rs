//! Embeds a mesh given as JSON and prints the report as JSON and the time.
//!
//! Usage: `embed_json FILE [untangle-only|scaled-jacobian|balanced] [starts] [seed]`; the file has `hexes` (8 indices each),
//! `boundary_points` (for the first vertices) and, if wanted, `start` (a point for every vertex).
//! With `HEXFILL_OUT=PATH` the points are written there as JSON; with `HEXFILL_STARS=1` all star bounds are printed first; with
//! `HEXFILL_SYMMETRIC=1` the positions share the symmetries of the boundary.

use hexfill_embed::{Objective, Options, embed, star_bounds};
use hexfill_mesh::{Context, HexMesh};
use serde::Deserialize;

#[derive(Deserialize)]
struct Input {
    hexes: Vec<[u32; 8]>,
    boundary_points: Vec<[f64; 3]>,
    start: Option<Vec<[f64; 3]>>,
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let input: Input = serde_json::from_str(&std::fs::read_to_string(&arguments[1])?)?;
    let n = input.hexes.iter().flatten().max().map_or(0, |&v| v as usize + 1).max(input.boundary_points.len());
    let mesh = HexMesh::try_new(n, &input.hexes)?;
    let options = Options::new(match arguments.get(2).map(String::as_str) {
        Some("untangle-only") => Objective::UntangleOnly,
        Some("balanced") => Objective::Balanced,
        _ => Objective::ScaledJacobian,
    })
    .with_symmetric(std::env::var_os("HEXFILL_SYMMETRIC").is_some())
    .with_starts(arguments.get(3).map_or(Ok(0), |s| s.parse())?);
    let seed = arguments.get(4).map_or(Ok(0), |s| s.parse())?;
    let progress = |p: &hexfill_mesh::Progress| eprintln!("{} {} {}", p.stage, p.done, p.message);
    let verbose = std::env::var_os("HEXFILL_VERBOSE").is_some();
    let context = Context { seed, progress: if verbose { Some(&progress) } else { None }, ..Context::default() };
    if std::env::var_os("HEXFILL_STARS").is_some() {
        for star in star_bounds(&mesh, &input.boundary_points)? {
            eprintln!("{} at most {:.6}, attained {:.6}", star.vertex, star.bound, star.attained);
        }
    }
    let before = std::time::Instant::now();
    let done = embed(&mesh, &input.boundary_points, input.start.as_deref(), &options, &context)?;
    eprintln!("{:.3} s", before.elapsed().as_secs_f64());
    if let Some(path) = std::env::var_os("HEXFILL_OUT") {
        std::fs::write(path, serde_json::to_string(&done.points)?)?;
    }
    println!("{}", serde_json::to_string(&done.report)?);
    Ok(())
}
