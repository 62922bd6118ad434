//! `hexfill fill SURFACE -o MESH`: the main job.

use crate::commands::view::write_view;
use crate::console::Console;
use crate::exit::Exit;
use crate::files;
use anyhow::bail;
use hexfill::io::Format;
use hexfill::search::{Atlas, GrowOptions};
use hexfill::{Context, FillOptions, FillReport, StopReason, Strategy};
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

/// Flags of `fill`.
#[derive(clap::Args)]
pub struct FillArgs {
    /// The surface: a file, `-`, a catalogue name such as :schneiders-pyramid, or a signature.
    surface: String,
    /// The mesh to write; format by extension; `-` for stdout. With --count the files are numbered OUT-1, OUT-2, ...
    #[arg(short, long, value_name = "OUT")]
    output: Option<String>,
    /// Format of the surface.
    #[arg(long, value_name = "FORMAT", value_parser = files::parse_format)]
    from: Option<Format>,
    /// Format of the mesh.
    #[arg(long, value_name = "FORMAT", value_parser = files::parse_format)]
    to: Option<Format>,
    /// Also write an HTML page that shows the mesh.
    #[arg(long, value_name = "FILE")]
    view: Option<String>,
    /// Also write a PNG picture of the mesh.
    #[arg(long, value_name = "FILE")]
    picture: Option<String>,
    /// How to fill.
    #[arg(long, value_enum, default_value = "auto")]
    strategy: StrategyArg,
    /// Accept only meshes of at most this many hexes.
    #[arg(long, value_name = "N")]
    max_hexes: Option<u32>,
    /// Look for this many meshes that are not isomorphic.
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=10_000))]
    count: u64,
    /// Look on for smaller meshes until --time-limit.
    #[arg(long, requires = "time_limit")]
    improve: bool,
    /// An atlas to use instead of the embedded one.
    #[arg(long, value_name = "FILE")]
    atlas: Option<PathBuf>,
    /// Where growth towards the surface (--strategy atlas) keeps its log; the same command goes on from it
    /// [default: OUT.hxgrow, removed once the surface is reached].
    #[arg(long, value_name = "FILE")]
    growth_log: Option<PathBuf>,
    /// Most quads a ball may have while growing towards the surface.
    #[arg(long, default_value_t = 24, value_name = "N")]
    cap: usize,
    /// States kept per class while growing towards the surface.
    #[arg(long, default_value_t = 1, value_name = "N")]
    width: u32,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug, clap::ValueEnum)]
enum StrategyArg {
    /// Atlas, then inward flips; what they do not fill is constructed.
    Auto,
    /// Atlas, inward flips, then growth towards the surface until --time-limit.
    Atlas,
    /// Construction only.
    Construct,
}

#[derive(Serialize)]
struct Output {
    files: Vec<String>,
    meshes: Vec<FillReport>,
    stopped: &'static str,
    seconds: f64,
    notes: Vec<String>,
}

/// Fills, judges, writes, reports.
pub fn run(args: &FillArgs, console: &Console, ctx: &Context<'_>) -> anyhow::Result<Exit> {
    let start = Instant::now();
    if let Some(output) = &args.output {
        files::check_output(output, args.to)?;
    }
    for file in args.view.iter().chain(&args.picture) {
        files::check_folder(file)?;
    }
    let problem = files::load_problem(&args.surface, args.from)?;
    for note in &problem.notes {
        console.note(note);
    }
    let own_log = args.growth_log.is_none().then(|| default_log(args)).flatten();
    let options = FillOptions {
        strategy: match args.strategy {
            StrategyArg::Auto => Strategy::Auto,
            StrategyArg::Atlas => Strategy::Atlas,
            StrategyArg::Construct => Strategy::Construct,
        },
        max_hexes: args.max_hexes.unwrap_or(u32::MAX),
        count: args.count as usize,
        improve: args.improve,
        atlas: args.atlas.as_deref().map(Atlas::read_path).transpose()?.map(Arc::new),
        growth_log: args.growth_log.clone().or_else(|| own_log.clone()),
        growth: GrowOptions { cap: args.cap, width: args.width.max(1) },
        ..FillOptions::default()
    };
    let result = hexfill::fill(&problem, &options, ctx)?;
    if result.meshes.is_empty() {
        if console.json {
            console.print_json(&Output {
                files: Vec::new(),
                meshes: Vec::new(),
                stopped: crate::commands::atlas::stop_word(result.stop),
                seconds: start.elapsed().as_secs_f64(),
                notes: result.tried.clone(),
            })?;
        }
        for tried in &result.tried {
            console.say(format!("tried: {tried}"));
        }
        console.say("no mesh found within the bounds, which does not mean that none exists");
        match (result.stop, &options.growth_log) {
            (StopReason::Finished, _) => console.say("raise --max-hexes, --cap or --width, or use --strategy auto"),
            (_, Some(log)) if log.exists() => {
                console.say(format!("stopped; the same command goes on from {}", log.display()));
            }
            _ => console.say("stopped before the search was done"),
        }
        return Ok(Exit::of_stop(result.stop, Exit::No));
    }
    if let Some(log) = own_log.filter(|log| log.exists()) {
        std::fs::remove_file(log)?;
    }
    let mut output = Output {
        files: Vec::new(),
        meshes: Vec::new(),
        stopped: crate::commands::atlas::stop_word(result.stop),
        seconds: 0.0,
        notes: problem.notes.clone(),
    };
    for (i, filled) in result.meshes.iter().enumerate() {
        let report = FillReport::new(&problem, filled, &result.tried);
        let points = hexfill::start_points(&problem, filled);
        let data = hexfill::mesh_data(&problem, &filled.mesh, points.clone());
        let numbered = |path: &str| if args.count == 1 || path == "-" { path.to_owned() } else { numbered(path, i + 1) };
        if let Some(path) = &args.output {
            let path = numbered(path);
            files::write_data(&path, args.to, &data)?;
            output.files.push(path);
        }
        if args.view.is_some() || args.picture.is_some() {
            let Some(points) = &points else { bail!("no positions to draw: the surface has none") };
            let facts = vec![("route".to_owned(), format!("{:?}", filled.route))];
            if let Some(path) = &args.view {
                let path = numbered(path);
                write_view(&path, &problem.name, points, &filled.mesh, &facts)?;
                output.files.push(path);
            }
            if let Some(path) = &args.picture {
                let path = numbered(path);
                crate::commands::view::write_picture(&path, &problem.name, points, &filled.mesh, &facts)?;
                output.files.push(path);
            }
        }
        output.meshes.push(report);
    }
    output.seconds = start.elapsed().as_secs_f64();
    if console.json && args.output.as_deref() != Some("-") {
        console.print_json(&output)?;
    } else {
        for report in &output.meshes {
            console.say(format!(
                "{}: {} quads filled with {} hexes ({:.1} per quad), {} interior vertices, {} sheets; by {}; judged: L1-L3 passed",
                report.surface,
                report.quads,
                report.hexes,
                report.hexes_per_quad,
                report.interior_vertices,
                report.sheets,
                route_words(report.route),
            ));
        }
        if output.meshes.len() < args.count as usize {
            console.say(format!("{} of {} meshes asked for were found", output.meshes.len(), args.count));
        }
        console.say(format!("{:.2} s; written: {}", output.seconds, if output.files.is_empty() { "nothing (give -o)".to_owned() } else { output.files.join(", ") }));
    }
    Ok(Exit::of_stop(result.stop, Exit::Done))
}

fn route_words(route: hexfill::Route) -> &'static str {
    match route {
        hexfill::Route::Atlas => "atlas look-up",
        hexfill::Route::InwardFlips => "inward flips and atlas",
        hexfill::Route::Growth => "growth towards the surface",
        _ => "construction",
    }
}

/// `mesh.vtk` and 2 -> `mesh-2.vtk`; `mesh.vtk.gz` -> `mesh-2.vtk.gz`.
fn numbered(path: &str, i: usize) -> String {
    let name_start = path.rfind('/').map_or(0, |at| at + 1);
    let dot = path[name_start..].find('.').map_or(path.len(), |at| name_start + at);
    format!("{}-{i}{}", &path[..dot], &path[dot..])
}

fn default_log(args: &FillArgs) -> Option<PathBuf> {
    let output = args.output.as_deref().filter(|o| *o != "-" && args.strategy == StrategyArg::Atlas)?;
    Some(Path::new(&format!("{output}.hxgrow")).to_owned())
}

#[cfg(test)]
mod tests {
    #[test]
    fn numbered_paths_keep_their_extension() {
        assert_eq!(super::numbered("a.b/mesh.vtk.gz", 2), "a.b/mesh-2.vtk.gz");
        assert_eq!(super::numbered("mesh", 1), "mesh-1");
    }
}
