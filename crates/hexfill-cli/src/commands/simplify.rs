//! `hexfill simplify MESH -o OUT`: fewer hexes, the same boundary.

use crate::console::Console;
use crate::exit::Exit;
use crate::files;
use anyhow::{Context as _, bail};
use hexfill::io::Format;
use hexfill::unstable::search::Atlas;
use hexfill::{Collapse, Context, SimplifyOptions, SimplifyReport, StopReason};
use serde::Serialize;
use std::path::PathBuf;
use std::time::Instant;

/// Which sheets and columns.
#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Which {
    /// All that leave the quads of the boundary alone.
    All,
    /// Those without hexes at the boundary.
    Inside,
}

/// Flags of `simplify`.
#[derive(clap::Args)]
pub(crate) struct SimplifyArgs {
    /// The hex mesh; its boundary stays as it is, positions bit for bit.
    mesh: String,
    /// The mesh to write; format by extension; `-` for stdout.
    #[arg(short, long, value_name = "OUT")]
    output: String,
    /// How many balls of hexes to try [default: ten for each hex, at least 20,000; with --time-limit as many as it allows].
    #[arg(long, value_name = "N")]
    balls: Option<u64>,
    /// Only collapse closed sheets and columns of hexes, without trying balls: takes a moment, for large meshes too. `inside`: none
    /// with a hex at the boundary, which leaves coordinates possible where they are.
    #[arg(long, value_name = "WHICH", num_args = 0..=1, require_equals = true, default_missing_value = "all")]
    #[arg(conflicts_with_all = ["balls", "heat", "atlas"])]
    collapse_only: Option<Which>,
    /// Only coarsen: three sheets that lie one on the other become one inside, in so many rounds, or as many as take hexes away. In a moment, for large meshes too; `hexfill
    /// embed` finds positions next.
    #[arg(long, value_name = "ROUNDS", num_args = 0..=1, require_equals = true, default_missing_value = "4294967295")]
    #[arg(conflicts_with_all = ["balls", "heat", "atlas", "collapse_only", "keep_valid"], value_parser = clap::value_parser!(u32).range(1..))]
    coarsen: Option<u32>,
    /// The chance, in thousandths, of taking one more hex (then another one, and so on) to leave a local minimum; it falls to
    /// nothing in the course of the work. 0: never more hexes.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=999))]
    heat: Option<u32>,
    /// Never worsen the geometry: only exchanges for fewer hexes whose new points have positions that keep every certificate and the smallest certified scaled Jacobian
    /// of the hexes exchanged. Nothing is collapsed, no point that stays is moved.
    #[arg(long, conflicts_with_all = ["collapse_only", "heat"])]
    keep_valid: bool,
    /// An atlas to use instead of the one that is grown at the start.
    #[arg(long, value_name = "FILE")]
    atlas: Option<PathBuf>,
    /// Format of the input.
    #[arg(long, value_name = "FORMAT", value_parser = files::parse_format)]
    from: Option<Format>,
    /// Format of the output.
    #[arg(long, value_name = "FORMAT", value_parser = files::parse_format)]
    to: Option<Format>,
}

#[derive(Serialize)]
struct Output {
    file: String,
    hexes_before: usize,
    hexes: usize,
    boundary_quads: usize,
    hexes_per_quad: f64,
    /// Sheets and columns collapsed, and the hexes that went with them.
    sheets: u64,
    columns: u64,
    collapsed_hexes: usize,
    balls: u64,
    looked_up: u64,
    /// Exchanges for fewer hexes, as many, more.
    exchanges: [u64; 3],
    /// Exchanges that --keep-valid refused.
    refused: u64,
    stopped: StopReason,
    seconds: f64,
}

/// Simplifies, judges, writes. Exit code 0 also if nothing smaller was found: the mesh is then written as it was.
pub(crate) fn run(args: &SimplifyArgs, console: &Console, ctx: &Context<'_>) -> anyhow::Result<Exit> {
    let start = Instant::now();
    files::check_output(&args.output, args.to)?;
    if console.json && args.output == "-" {
        bail!("--json and -o - both write to stdout; give a file to one of them");
    }
    files::check_distinct(&[&args.mesh, &args.output])?;
    let mut data = files::read_data(&args.mesh, &args.from.into())?;
    for note in std::mem::take(&mut data.notes) {
        console.note(note);
    }
    files::check_mesh_output(&args.output, args.to, &data)?;
    if data.hexes.is_empty() {
        bail!("{} has no hexes; give a hex mesh (`hexfill fill` makes one from a surface)", args.mesh);
    }
    let others = data.tets.len() + data.wedges.len() + data.pyramids.len();
    if others > 0 {
        bail!("{} has {others} cells that are no hexes; only pure hex meshes can be simplified", args.mesh);
    }
    let atlas = args.atlas.as_deref().map(Atlas::read_path).transpose()?;
    let balls = match (args.balls, ctx.deadline) {
        _ if args.collapse_only.is_some() => 0,
        (Some(balls), _) => balls,
        (None, Some(_)) => u64::MAX,
        (None, None) => hexfill::default_balls(data.hexes.len()),
    };
    let mut options = SimplifyOptions::default().with_balls(balls);
    if args.collapse_only == Some(Which::Inside) {
        options = options.with_collapse(Collapse::Inside);
    }
    if let Some(heat) = args.heat {
        options = options.with_heat(heat);
    }
    if args.keep_valid && !data.has_coordinates {
        bail!("{} has no coordinates, so that there is nothing for --keep-valid to keep", args.mesh);
    }
    let made = match args.coarsen {
        Some(rounds) => hexfill::coarsen(&data, rounds, ctx),
        None if args.keep_valid => hexfill::simplify_keeping_valid(&data, &options, atlas.as_ref(), ctx),
        None => hexfill::simplify(&data, &options, atlas.as_ref(), ctx),
    };
    let mut made = made.with_context(|| args.mesh.clone())?;
    for note in std::mem::take(&mut made.data.notes) {
        console.note(note);
    }
    files::write_data(&args.output, args.to, &made.data, console)?;
    let report = made.report;
    let mesh = made.data.hex_mesh()?;
    let quads = mesh.boundary_facets().count();
    let per_quad = report.after as f64 / quads.max(1) as f64;
    let seconds = start.elapsed().as_secs_f64();
    say(args, &report, per_quad, made.data.has_coordinates, console);
    console.say(format!("written: {}", args.output));
    if console.json {
        console.print_json(&Output {
            file: args.output.clone(),
            hexes_before: report.before,
            hexes: report.after,
            boundary_quads: quads,
            hexes_per_quad: per_quad,
            sheets: report.sheets,
            columns: report.columns,
            collapsed_hexes: report.collapsed,
            balls: report.balls,
            looked_up: report.looked_up,
            exchanges: report.exchanges,
            refused: report.refused,
            stopped: report.stop,
            seconds,
        })?;
    }
    Ok(Exit::of_stop(report.stop, Exit::Done))
}

/// What was done, in words.
fn say(args: &SimplifyArgs, report: &SimplifyReport, per_quad: f64, has_coordinates: bool, console: &Console) {
    let is_smaller = report.after < report.before;
    console.say(format!(
        "{}: {} -> {} hexes ({per_quad:.1} per boundary quad), {} sheets and {} columns collapsed, {} balls tried",
        args.mesh, report.before, report.after, report.sheets, report.columns, report.balls
    ));
    console.say(if is_smaller {
        "connectivity: judged proper, boundary unchanged (L1-L3)"
    } else {
        "nothing smaller was found; the mesh is written as it was"
    });
    if has_coordinates && is_smaller {
        console.say(match args.keep_valid {
            true => "geometry: vertices that stay were not moved, no certificate was lost",
            false if args.coarsen.is_some() => "geometry: no vertex was moved; run `hexfill embed` next, as hexes at the turns are flat",
            false => "geometry: vertices that stay were not moved, new ones lie at means of their neighbours; run `hexfill embed` next",
        });
    }
}
