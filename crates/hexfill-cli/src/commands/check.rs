//! `hexfill check MESH [--surface S]`.

use crate::console::Console;
use crate::exit::Exit;
use crate::files;
use anyhow::bail;
use hexfill::Context;
use hexfill::check::{Judged, Options, judge};
use hexfill::io::Format;

/// Flags of `check`.
#[derive(clap::Args)]
pub struct CheckArgs {
    /// The mesh to judge.
    mesh: String,
    /// The surface it must fill; without it the mesh is judged against its own boundary.
    #[arg(long, value_name = "FILE")]
    surface: Option<String>,
    /// Format of the mesh.
    #[arg(long, value_name = "FORMAT", value_parser = files::parse_format)]
    from: Option<Format>,
}

/// Judges and reports; exit code 1 if a rule is broken.
pub fn run(args: &CheckArgs, console: &Console, ctx: &Context<'_>) -> anyhow::Result<Exit> {
    let data = files::read_data(&args.mesh, args.from)?;
    for note in &data.notes {
        console.note(note);
    }
    if data.hexes.is_empty() {
        bail!("{} has no hexes; give a hex mesh (a surface is described by `hexfill info`)", args.mesh);
    }
    let highest = data.hexes.iter().flatten().max().map_or(0, |&v| v as usize + 1);
    let n_vertices = if data.has_coordinates { data.points.len() } else { highest };
    let problem = args.surface.as_ref().map(|s| files::load_problem(s, None)).transpose()?;
    let quads: Option<Vec<[u32; 4]>> =
        problem.as_ref().map(|p| p.surface.quads().iter().map(|q| q.map(|v| v.0)).collect());
    let judged = Judged {
        surface: quads.as_deref(),
        points: data.has_coordinates.then_some(data.points.as_slice()),
        surface_points: problem.as_ref().and_then(|p| p.points.as_deref()),
        ..Judged::connectivity(n_vertices, &data.hexes)
    };
    let report = judge(&judged, &Options::default(), ctx);
    if console.json {
        console.print(report.to_json())?;
    } else {
        console.print(report.to_string().trim_end())?;
    }
    if let Some(stop) = ctx.stop() {
        return Ok(Exit::of_stop(stop, Exit::No));
    }
    Ok(if report.no_failure() { Exit::Done } else { Exit::No })
}
