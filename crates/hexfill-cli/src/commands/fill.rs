//! `hexfill fill SURFACE -o MESH`: the main job.

use crate::commands::fill_regions;
use crate::commands::view::Shown;
use crate::console::Console;
use crate::exit::Exit;
use crate::files;
use anyhow::bail;
use hexfill::construct::{CellChoice, GivenTets, TetgenTets};
use hexfill::io::{Format, MeshData};
use hexfill::search::{Atlas, GrowOptions};
use hexfill::{
    BoundaryLayers, Context, FillError, FillOptions, FillReport, Filled, GeometryReport, InteriorFrom, PlaceOptions,
    Placed, PlacedFill, Problem, ProblemError, StopReason, Strategy,
};
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Flags of `fill`.
#[derive(clap::Args)]
pub struct FillArgs {
    /// The surface: a file, `-`, a catalogue name such as :schneiders-pyramid, or a signature.
    pub(super) surface: String,
    /// The mesh to write; format by extension; `-` for stdout. With --count the files are numbered OUT-1, OUT-2, ...
    #[arg(short, long, value_name = "OUT")]
    pub(super) output: Option<String>,
    #[command(flatten)]
    reading: files::InputArgs,
    /// Format of the mesh.
    #[arg(long, value_name = "FORMAT", value_parser = files::parse_format)]
    pub(super) to: Option<Format>,
    /// Also write an HTML page that shows the mesh.
    #[arg(long, value_name = "FILE")]
    pub(super) view: Option<String>,
    /// Also write a PNG picture of the mesh.
    #[arg(long, value_name = "FILE")]
    pub(super) picture: Option<String>,
    /// How to fill.
    #[arg(long, value_enum, default_value = "auto")]
    strategy: StrategyArg,
    /// Which mesh to prefer among those that are certified with a worst scaled Jacobian of at least 0.2.
    #[arg(long, value_enum, default_value = "balance")]
    prefer: PreferArg,
    /// The first mesh with a certificate, in a fraction of the time.
    #[arg(long, conflicts_with = "best")]
    fast: bool,
    /// Look on though a good mesh is found: more candidates, each raised as far as it goes; many times the time (see --time-limit).
    #[arg(long)]
    best: bool,
    /// Put this many layers of hexahedra under the whole surface (boundary layers for flow).
    #[arg(long, value_name = "K", conflicts_with_all = ["count", "best_of", "no_embed", "improve"], value_parser = clap::value_parser!(u32).range(1..=1000))]
    layers: Option<u32>,
    /// Height of the first of them, in the unit of the surface [default: all layers of one place have the same height].
    #[arg(long, value_name = "H", requires = "layers", value_parser = positive)]
    layer_height: Option<f64>,
    /// Each layer is this many times as high as the one before.
    #[arg(long, value_name = "G", requires = "layer_height", default_value_t = 1.0, value_parser = positive)]
    growth: f64,
    /// Accept only meshes of at most this many hexes.
    #[arg(long, value_name = "N")]
    max_hexes: Option<u32>,
    /// Look for this many meshes that are not isomorphic.
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=10_000))]
    pub(super) count: u64,
    /// Look for this many meshes that are not isomorphic, embed them, and write the one with the largest worst scaled Jacobian.
    /// See also --max-hexes and --beam.
    #[arg(long, value_name = "N", conflicts_with_all = ["count", "no_embed"], value_parser = clap::value_parser!(u64).range(2..=10_000))]
    pub(super) best_of: Option<u64>,
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
    /// How many cavities inward flips may look at before the next strategy has its turn.
    #[arg(long, default_value_t = 1_000_000, value_name = "N")]
    inward_cavities: u64,
    /// How many of these cavities are kept on each level: more find more of the meshes --count asks for.
    #[arg(long, default_value_t = 1000, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    beam: u64,
    /// A tetrahedral mesh of the inside, for surfaces that are not spheres (boundary: the quads cut along diagonals).
    #[arg(long, value_name = "FILE", conflicts_with = "tetgen")]
    pub(super) tets: Option<String>,
    /// Call this TetGen program for the inside of surfaces that are not spheres.
    #[arg(long, value_name = "PROGRAM", num_args = 0..=1, default_missing_value = "tetgen")]
    pub(super) tetgen: Option<PathBuf>,
    /// Which cells the construction uses: those that embed, or those with the fewest hexes [default: fewest with --no-embed,
    /// else embeddable].
    #[arg(long, value_enum)]
    cells: Option<CellsArg>,
    /// Make a constructed mesh smaller (see `hexfill simplify`); done by itself with --no-embed and --time-limit.
    #[arg(long)]
    simplify: bool,
    /// Do not embed: interior vertices get start positions, and geometry is not judged.
    #[arg(long)]
    pub(super) no_embed: bool,
    /// How long the embedding of one mesh, or of all with --best-of, may take [default: as long as its bounded work takes].
    #[arg(long, value_name = "TIME", value_parser = files::parse_duration)]
    embed_limit: Option<Duration>,
    /// Write nothing unless det J > 0 is certified in every hex.
    #[arg(long, conflicts_with = "no_embed")]
    pub(super) require_valid: bool,
    /// States kept per class while growing towards the surface.
    #[arg(long, default_value_t = 1, value_name = "N")]
    width: u32,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug, clap::ValueEnum)]
enum StrategyArg {
    /// Atlas, shelling, inward flips, construction: the best mesh of them (see --prefer).
    Auto,
    /// Shelling only: the surface is swept inward by its own dual curves.
    Shell,
    /// Atlas, inward flips, then growth towards the surface until --time-limit.
    Atlas,
    /// Construction only.
    Construct,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug, clap::ValueEnum)]
enum PreferArg {
    /// Fewest hexes divided by the cube of the worst scaled Jacobian.
    Balance,
    /// Fewest hexes.
    Hexes,
    /// Largest worst scaled Jacobian.
    Quality,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug, clap::ValueEnum)]
enum CellsArg {
    /// Fewest hexes; coordinates cannot be valid.
    Fewest,
    /// Cells with valid coordinates of their own.
    Embeddable,
}

#[derive(Serialize)]
pub(super) struct MeshOutput {
    #[serde(flatten)]
    pub(super) report: FillReport,
    /// Absent without positions.
    pub(super) geometry: Option<GeometryReport>,
    pub(super) files: Vec<String>,
}

#[derive(Serialize)]
struct Output {
    meshes: Vec<MeshOutput>,
    /// Why the work ended.
    stopped: &'static str,
    /// As the process returns it.
    exit_code: u8,
    seconds: f64,
    notes: Vec<String>,
    /// Why this mesh and no other, if there was a choice.
    choice: Option<String>,
}

/// Fills, judges, writes, reports.
pub fn run(args: &FillArgs, console: &Console, ctx: &Context<'_>) -> anyhow::Result<Exit> {
    let result = fill(args, console, ctx);
    let is_sick = |error: &anyhow::Error| {
        let by_faces = matches!(error.downcast_ref(), Some(ProblemError::Surface { .. } | ProblemError::Seams { .. }));
        by_faces || matches!(error.downcast_ref(), Some(FillError::OddQuads { .. } | FillError::Improper { .. }))
    };
    if result.as_ref().is_err_and(is_sick) {
        console.note(format!(
            "`hexfill doctor {}` says everything that is wrong at once, and what --fix can mend",
            args.surface
        ));
    }
    result
}

fn fill(args: &FillArgs, console: &Console, ctx: &Context<'_>) -> anyhow::Result<Exit> {
    let start = Instant::now();
    check_files(args, console)?;
    let mut problem = match input(args)? {
        Input::Surface(problem) => *problem,
        Input::Regions(data, regions) => return fill_regions::run(args, &data, &regions, console, ctx),
    };
    problem.notes.extend(crossing_note(&problem));
    for note in &problem.notes {
        console.note(note);
    }
    if let Some(output) = &args.output {
        files::check_mesh_output(output, args.to, &boundary_data(&problem))?;
    }
    let own_log = args.growth_log.is_none().then(|| default_log(args)).flatten();
    let options = fill_options(args, own_log.clone(), ctx)?;
    let how = place_options(args);
    let result = hexfill::fill_placed(&problem, &options, &how, ctx)?;
    let mut output = Output {
        meshes: Vec::new(),
        stopped: crate::commands::atlas::stop_word(result.stop),
        exit_code: Exit::of_stop(result.stop, Exit::No) as u8,
        seconds: start.elapsed().as_secs_f64(),
        notes: problem.notes.clone(),
        choice: result.choice.clone(),
    };
    if result.meshes.is_empty() {
        output.notes.clone_from(&result.tried);
        if console.json {
            console.print_json(&output)?;
        }
        say_none(&result, options.growth_log.as_deref(), console);
        return Ok(Exit::of_stop(result.stop, Exit::No));
    }
    if let Some(log) = own_log.filter(|log| log.exists()) {
        std::fs::remove_file(log)?;
    }
    if problem.points.is_none() && result.meshes[0].1.is_some() {
        console.note("the surface has no coordinates; those of its canonical polyhedron are used");
    }
    let mut all_valid = true;
    for (i, (filled, placed)) in result.meshes.iter().enumerate() {
        let report = FillReport::new(&problem, filled, &result.tried);
        let valid = args.no_embed || placed.as_ref().is_none_or(Placed::is_certified);
        all_valid &= valid;
        let mut mesh = MeshOutput { report, geometry: placed.as_ref().map(Placed::report), files: Vec::new() };
        if valid || !args.require_valid {
            let suffix = (args.count > 1).then_some(i + 1);
            mesh.files = write_mesh(args, &problem, filled, placed.as_ref(), suffix, console)?;
        }
        output.meshes.push(mesh);
    }
    let enough = output.meshes.len() == args.count as usize;
    let exit = Exit::of_stop(result.stop, if all_valid && enough { Exit::Done } else { Exit::No });
    output.exit_code = exit as u8;
    output.seconds = start.elapsed().as_secs_f64();
    if console.json {
        console.print_json(&output)?;
    } else {
        say(&output, args, console);
    }
    Ok(exit)
}

/// One surface, or several regions at once.
enum Input {
    Surface(Box<Problem>),
    Regions(Box<MeshData>, Vec<hexfill::Region>),
}

fn input(args: &FillArgs) -> anyhow::Result<Input> {
    if hexfill::is_named(&args.surface) {
        return Ok(Input::Surface(Box::new(files::load_problem(&args.surface, &args.reading)?)));
    }
    let name = if args.surface == "-" { "stdin" } else { &args.surface };
    let data = files::read_data(&args.surface, &args.reading)?;
    if hexfill::has_regions(&data) {
        let regions = hexfill::regions(name, &data)?;
        if !regions.is_empty() {
            return Ok(Input::Regions(Box::new(data), regions));
        }
    }
    Ok(Input::Surface(Box::new(Problem::from_data(name, &data)?)))
}

pub(super) fn place_options(args: &FillArgs) -> PlaceOptions {
    let embed = (!args.no_embed).then(hexfill::embed::Options::default);
    PlaceOptions { embed, best: args.best_of.is_some(), limit: args.embed_limit }
}

/// A word on quads that cross: work on them is in vain.
fn crossing_note(problem: &Problem) -> Option<String> {
    let pairs = hexfill::crossing_quads(problem);
    let first: Vec<String> = pairs.iter().take(3).map(|[a, b]| format!("{a} and {b}")).collect();
    let more = if pairs.len() > 3 { ", ..." } else { "" };
    (!pairs.is_empty()).then(|| {
        format!(
            "{} pairs of quads cross or touch ({}{more}): a mesh of this surface overlaps itself; see `hexfill doctor`",
            pairs.len(),
            first.join(", ")
        )
    })
}

/// Refuses files that cannot be written, or would be written twice, before any work is done.
fn check_files(args: &FillArgs, console: &Console) -> anyhow::Result<()> {
    if let Some(output) = &args.output {
        files::check_output(output, args.to)?;
    }
    for file in args.view.iter().chain(&args.picture) {
        files::check_folder(file)?;
    }
    if let Some(picture) = args.picture.as_ref().filter(|p| !p.to_ascii_lowercase().ends_with(".png")) {
        bail!("{picture}: pictures are PNG; give a name that ends in .png");
    }
    if console.json && args.output.as_deref() == Some("-") {
        bail!("--json and -o - both write to stdout; give a file to one of them");
    }
    let written = [&args.output, &args.view, &args.picture];
    let named: Vec<&str> = std::iter::once(&args.surface)
        .filter(|s| !hexfill::is_named(s))
        .chain(written.into_iter().flatten())
        .map(String::as_str)
        .collect();
    files::check_distinct(&named)
}

/// What is known of the mesh before there is one: its boundary. A sphere without positions will get some.
fn boundary_data(problem: &Problem) -> MeshData {
    let mut data = problem.data();
    if problem.points.is_none() && problem.surface.is_sphere() {
        (data.has_coordinates, data.points) = (true, vec![[0.0; 3]; problem.surface.n_vertices()]);
    }
    data
}

/// What the flags mean.
pub(super) fn fill_options(
    args: &FillArgs,
    own_log: Option<PathBuf>,
    ctx: &Context<'_>,
) -> anyhow::Result<FillOptions> {
    Ok(FillOptions {
        strategy: match args.strategy {
            StrategyArg::Auto => Strategy::Auto,
            StrategyArg::Shell => Strategy::Shell,
            StrategyArg::Atlas => Strategy::Atlas,
            StrategyArg::Construct => Strategy::Construct,
        },
        max_hexes: args.max_hexes.unwrap_or(u32::MAX),
        count: args.best_of.unwrap_or(args.count) as usize,
        improve: args.improve,
        atlas: args.atlas.as_deref().map(Atlas::read_path).transpose()?.map(Arc::new),
        growth_log: args.growth_log.clone().or(own_log),
        inward_cavities: args.inward_cavities,
        beam: usize::try_from(args.beam).unwrap_or(usize::MAX),
        interior: interior(args)?,
        cells: match args.cells {
            Some(CellsArg::Fewest) => CellChoice::Fewest,
            Some(CellsArg::Embeddable) => CellChoice::Embeddable,
            None if args.no_embed => CellChoice::Fewest,
            None => CellChoice::Embeddable,
        },
        simplify: simplification(args, ctx),
        shell: hexfill::ShellOptions::default(),
        effort: match (args.fast, args.best) {
            (true, _) => hexfill::Effort::Fast,
            (_, true) => hexfill::Effort::Best,
            _ => hexfill::Effort::Normal,
        },
        prefer: match args.prefer {
            PreferArg::Balance => hexfill::Prefer::Balance,
            PreferArg::Hexes => hexfill::Prefer::Hexes,
            PreferArg::Quality => hexfill::Prefer::Quality,
        },
        layers: args.layers.map(|count| BoundaryLayers { count, height: args.layer_height, growth: args.growth }),
        growth: GrowOptions { cap: args.cap, width: args.width.max(1) },
    })
}

/// The report for a person where there is no mesh.
fn say_none(result: &PlacedFill, growth_log: Option<&Path>, console: &Console) {
    for tried in &result.tried {
        console.say(format!("tried: {tried}"));
    }
    console.say("no mesh found within the bounds, which does not mean that none exists");
    match (result.stop, growth_log) {
        (StopReason::Finished, _) => console.say("raise --max-hexes, --cap or --width, or use --strategy auto"),
        (_, Some(log)) if log.exists() => {
            console.say(format!("stopped; the same command goes on from {}", log.display()));
        }
        _ => console.say("stopped before the search was done"),
    }
}

/// A positive number.
fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x.is_finite() && x > 0.0 => Ok(x),
        _ => Err(format!("{text} is not a positive number")),
    }
}

/// Whether and how a construction is made smaller: as long as the deadline allows, or by a fixed number of balls. A smaller mesh
/// is harder to embed, so it must be asked for where positions are wanted.
fn simplification(args: &FillArgs, ctx: &Context<'_>) -> Option<hexfill::SimplifyOptions> {
    let wanted = args.simplify || args.no_embed && ctx.deadline.is_some();
    let balls = if ctx.deadline.is_some() { u64::MAX } else { SIMPLIFY_BALLS };
    wanted.then(|| hexfill::SimplifyOptions::default().with_balls(balls))
}

/// Balls of `--simplify` without a time limit.
const SIMPLIFY_BALLS: u64 = 200_000;

/// Where the tetrahedra of an interior that is not a ball come from.
fn interior(args: &FillArgs) -> anyhow::Result<InteriorFrom> {
    if let Some(file) = &args.tets {
        let data = files::read_data(file, &files::InputArgs::default())?;
        if data.tets.is_empty() {
            bail!("{file} has no tetrahedra");
        }
        let n_vertices = data.points.len();
        let points = data.has_coordinates.then_some(data.points);
        return Ok(InteriorFrom::Tets(Arc::new(GivenTets { n_vertices, tets: data.tets, points })));
    }
    Ok(match &args.tetgen {
        Some(program) => InteriorFrom::Tetgen(TetgenTets { program: program.clone() }),
        None => InteriorFrom::BuiltIn,
    })
}

/// Writes the mesh, its page and its picture; returns the names of the files.
fn write_mesh(
    args: &FillArgs,
    problem: &Problem,
    filled: &Filled,
    placed: Option<&Placed>,
    suffix: Option<usize>,
    console: &Console,
) -> anyhow::Result<Vec<String>> {
    let named = |path: &str| match suffix {
        Some(i) if path != "-" => numbered(path, i),
        _ => path.to_owned(),
    };
    let mut written = Vec::new();
    if let Some(output) = &args.output {
        let mut data = hexfill::mesh_data(problem, &filled.mesh, placed.map(|p| p.points.clone()));
        if let Some(placed) = placed.filter(|_| !args.no_embed) {
            placed.flag(&mut data);
        }
        let path = named(output);
        files::write_data(&path, args.to, &data, console)?;
        written.push(path);
    }
    if args.view.is_none() && args.picture.is_none() {
        return Ok(written);
    }
    let Some(placed) = placed else { bail!("no positions to draw: the surface has none") };
    let shown = Shown {
        title: files::short_name(&problem.name),
        points: &placed.points,
        mesh: &filled.mesh,
        scaled_jacobians: (!args.no_embed).then(|| placed.scaled_jacobians()),
        facts: vec![
            ("made by".to_owned(), filled.route.words().to_owned()),
            ("geometry".to_owned(), placed.report().to_string()),
        ],
    };
    if let Some(path) = &args.view {
        let path = named(path);
        shown.write_page(&path)?;
        written.push(path);
    }
    if let Some(path) = &args.picture {
        let path = named(path);
        shown.write_picture(&path)?;
        written.push(path);
    }
    Ok(written)
}

/// The report for a person.
fn say(output: &Output, args: &FillArgs, console: &Console) {
    for mesh in &output.meshes {
        say_mesh(mesh, console);
        if !mesh.files.is_empty() {
            console.say(format!("written: {}", mesh.files.join(", ")));
        } else if args.require_valid {
            console.say("nothing written: --require-valid");
        } else {
            console.say("nothing written: give -o OUT");
        }
    }
    if let Some(choice) = &output.choice {
        console.say(format!("choice: {choice}"));
    }
    if output.meshes.len() < args.count as usize {
        console.say(format!("{} of {} meshes asked for were found", output.meshes.len(), args.count));
    }
    if output.stopped != "finished" {
        console.say(format!("stopped early ({}); a longer run may bring a better mesh", output.stopped));
    }
    console.say(format!("{:.2} s", output.seconds));
}

/// The lines about one mesh.
pub(super) fn say_mesh(mesh: &MeshOutput, console: &Console) {
    let r = &mesh.report;
    console.say(format!(
        "{}: {} quads filled with {} hex{} ({:.1} per quad), {} interior vertices{}, by {}",
        r.surface,
        r.quads,
        r.hexes,
        if r.hexes == 1 { "" } else { "es" },
        r.hexes_per_quad,
        r.interior_vertices,
        r.sheets.map_or(String::new(), |n| format!(", {n} sheets")),
        r.route.words(),
    ));
    if r.stages.len() > 1 {
        let stages: Vec<String> = r.stages.iter().map(|(stage, n)| format!("{n} {stage}")).collect();
        console.say(format!("hexes by step: {}", stages.join(", ")));
    }
    console.say("connectivity: judged proper, boundary = surface (L1-L3)");
    match &mesh.geometry {
        Some(geometry) => {
            console.say(format!("geometry: {geometry}"));
            if let Some(line) = geometry.distribution().filter(|_| geometry.hexes > 1) {
                console.say(format!("scaled Jacobians: {line}"));
            }
            if geometry.ways > 1 {
                let ways = geometry.ways;
                console.say(format!("lies on the surface in {ways} ways that are not congruent; the best was kept"));
            }
        }
        None => console.say("geometry: none, the surface has no coordinates"),
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
