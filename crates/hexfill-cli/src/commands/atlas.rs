//! `hexfill atlas build|complete|stats|lookup|prune`.

use crate::commands::families::is_exact_ball;
use crate::console::Console;
use crate::exit::Exit;
use crate::files::{self, InputArgs};
use anyhow::{Context as _, bail, ensure};
use hexfill::unstable::search::{
    Atlas, Cavity, CompleteOptions, GivenFilling, GrowOptions, GrowthLog, MAX_CAP, MAX_QUADS, Spread, complete,
};
use hexfill::{Context, StopReason};
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Flags of `atlas`.
#[derive(clap::Args)]
pub(crate) struct AtlasArgs {
    #[command(subcommand)]
    command: AtlasCommand,
}

#[derive(clap::Subcommand)]
enum AtlasCommand {
    /// Grow an atlas from one cube, level by level; an interrupted build goes on from its last whole level.
    Build {
        /// The file to write or to go on with.
        #[arg(short, long, value_name = "FILE")]
        output: PathBuf,
        /// Most quads a ball's boundary may have on the way.
        #[arg(long, default_value_t = 24, value_parser = clap::value_parser!(u64).range(6..=MAX_CAP as u64))]
        cap: u64,
        /// Grow to this many hexes.
        #[arg(long, default_value_t = 40)]
        levels: u32,
        /// States to keep per class (0: every Pareto state, which proves lower bounds).
        #[arg(long, default_value_t = 1)]
        width: u32,
        /// Keep on each level only so many classes of each size, those with the fewest blocked pairs (then it proves no bound).
        #[arg(long, value_name = "N")]
        beam: Option<usize>,
    },
    /// Make an atlas of every sphere of at most so many quads: grow FILE as `build` does, then search backward for what is missing.
    Complete {
        /// The growth to go on with; started if it does not exist.
        file: PathBuf,
        /// The packed atlas to write, one filling a class.
        #[arg(short, long, value_name = "FILE")]
        output: String,
        /// Most quads a ball's boundary may have on the way.
        #[arg(long, default_value_t = 26, value_parser = clap::value_parser!(u64).range(6..=MAX_CAP as u64))]
        cap: u64,
        /// Grow to this many hexes.
        #[arg(long, default_value_t = 56)]
        levels: u32,
        /// Keep on each level only so many classes of each size.
        #[arg(long, default_value_t = 50_000, value_name = "N")]
        beam: usize,
        /// Every 3-connected sphere of at most this many quads gets a filling.
        #[arg(long, default_value_t = 20, value_parser = clap::value_parser!(u64).range(6..=20))]
        max_quads: u64,
        /// A filling with more hexes than this is looked at again with each effort.
        #[arg(long, default_value_t = 56)]
        max_hexes: u32,
        /// Searches backward to make, each wider (and many times slower) than the one before.
        #[arg(long, default_value_t = 3)]
        efforts: usize,
        /// Rounds of exchanging balls in fillings that are still too large, each four times as long as the one before.
        #[arg(long, default_value_t = 3)]
        rounds: usize,
        /// The classes of this atlas stay, with no more hexes than there [default: the embedded one].
        #[arg(long, value_name = "FILE")]
        keep: Option<PathBuf>,
        /// Fillings from elsewhere: hex meshes, each a proper ball of at most 255 hexes.
        #[arg(long, value_name = "MESH", num_args = 1..)]
        given: Vec<String>,
    },
    /// Count what an atlas holds.
    Stats {
        /// The atlas [default: the embedded one].
        file: Option<PathBuf>,
    },
    /// Say what an atlas knows about a surface.
    Lookup {
        /// The surface.
        surface: String,
        /// The atlas [default: both of the program, the embedded one and that of smallest fillings].
        #[arg(long, value_name = "FILE")]
        atlas: Option<PathBuf>,
    },
    /// Write a smaller, packed atlas.
    Prune {
        /// The atlas to read.
        file: PathBuf,
        /// The packed atlas to write.
        #[arg(short, long, value_name = "FILE")]
        output: String,
        /// Keep classes of at most this many quads.
        #[arg(long, default_value_t = 20)]
        max_quads: usize,
        /// Also keep larger classes with fillings of at most this many hexes.
        #[arg(long, default_value_t = 0)]
        max_hexes: u32,
        /// Fillings to keep per class.
        #[arg(long, default_value_t = 1)]
        width: usize,
    },
}

#[derive(Serialize)]
struct BuildReport {
    levels: u32,
    classes: u64,
    states: u64,
    memory_bytes: u64,
    /// Classes left out on all levels, for the beam or the memory limit.
    thinned: u64,
    exhausted: bool,
    stopped: Option<StopReason>,
}

impl BuildReport {
    fn exit(&self) -> Exit {
        Exit::of_stop(self.stopped.unwrap_or(StopReason::Finished), Exit::Done)
    }
}

/// Runs the subcommand.
pub(crate) fn run(args: &AtlasArgs, console: &Console, ctx: &Context<'_>) -> anyhow::Result<Exit> {
    match &args.command {
        AtlasCommand::Build { output, cap, levels, width, beam } => {
            let width = if *width == 0 { u32::MAX } else { *width };
            let options = GrowOptions::default().with_cap(*cap as usize).with_width(width);
            let growth = build(output, options, *beam, *levels, console, ctx)?;
            if console.json {
                console.print_json(&growth)?;
            }
            Ok(growth.exit())
        }
        AtlasCommand::Complete {
            file,
            output,
            cap,
            levels,
            beam,
            max_quads,
            max_hexes,
            efforts,
            rounds,
            keep,
            given,
        } => {
            files::check_folder(output)?;
            let fillings = given.iter().map(|path| given_filling(path, ctx));
            let Some(given) = fillings.collect::<anyhow::Result<Option<Vec<_>>>>()? else { return Ok(Exit::Stopped) };
            files::check_distinct(&[&file.to_string_lossy(), output])?;
            let growth =
                build(file, GrowOptions::default().with_cap(*cap as usize), Some(*beam), *levels, console, ctx)?;
            if growth.stopped.is_some() {
                if console.json {
                    console.print_json(&serde_json::json!({ "growth": growth }))?;
                }
                return Ok(growth.exit());
            }
            let options = CompleteOptions::default()
                .with_max_quads(*max_quads as usize)
                .with_max_hexes(*max_hexes)
                .with_efforts(*efforts)
                .with_rounds(*rounds);
            let report = complete_atlas(file, output, keep.as_deref(), &given, &options, ctx)?;
            if console.json {
                console.print_json(&Completed { growth, completion: &report })?;
            } else {
                report.print(&options, console)?;
            }
            Ok(report.exit())
        }
        AtlasCommand::Stats { file } => {
            let read;
            let atlas = match file {
                Some(path) => {
                    read = Atlas::read_path(path)?;
                    &read
                }
                None => Atlas::embedded(),
            };
            stats(atlas, console)
        }
        AtlasCommand::Lookup { surface, atlas } => {
            let read = atlas.as_deref().map(Atlas::read_path).transpose()?;
            match &read {
                Some(atlas) => lookup(surface, &[atlas], console),
                None => lookup(surface, &[Atlas::fewest(), Atlas::embedded()], console),
            }
        }
        AtlasCommand::Prune { file, output, max_quads, max_hexes, width } => {
            files::check_folder(output)?;
            files::check_distinct(&[&file.to_string_lossy(), output])?;
            let atlas = Atlas::read_path(file)?;
            let pruned = atlas.pruned(*width, |quads, hexes| quads <= *max_quads || hexes <= *max_hexes);
            files::write_file(output, |out| pruned.write_packed(out))?;
            let bytes = std::fs::metadata(output)?.len();
            if console.json {
                console
                    .print_json(&serde_json::json!({ "file": output, "states": pruned.n_states(), "bytes": bytes }))?;
            }
            console.say(format!("{output}: {} of {} states, {bytes} bytes", pruned.n_states(), atlas.n_states()));
            Ok(Exit::Done)
        }
    }
}

#[derive(Serialize)]
struct Completed<'a> {
    growth: BuildReport,
    #[serde(flatten)]
    completion: &'a CompletionReport,
}

#[derive(Serialize)]
struct CompletionReport {
    file: String,
    states: usize,
    bytes: u64,
    /// Classes that were to get a filling; of them: grown, better in the atlas to keep, found backward, with more hexes
    /// than asked for, without a filling.
    classes: usize,
    grown: usize,
    kept: usize,
    found: usize,
    large: usize,
    missing: usize,
    stopped: Option<StopReason>,
}

impl CompletionReport {
    fn print(&self, options: &CompleteOptions, console: &Console) -> anyhow::Result<()> {
        console.print(format!(
            "{}: {} of {} spheres of at most {} quads filled, {} of them with more than {} hexes",
            self.file,
            self.classes - self.missing,
            self.classes,
            options.max_quads(),
            self.large,
            options.max_hexes()
        ))?;
        console.print(format!(
            "{} grown, {} new or smaller in the atlas to keep, {} new by searching backward",
            self.grown, self.kept, self.found
        ))?;
        console.print(format!("{} states, {} bytes", self.states, self.bytes))
    }

    fn exit(&self) -> Exit {
        let all_done = self.missing + self.large == 0;
        Exit::of_stop(self.stopped.unwrap_or(StopReason::Finished), if all_done { Exit::Done } else { Exit::No })
    }
}

/// The filling that a mesh file holds; `None` if the work was stopped.
fn given_filling(path: &str, ctx: &Context<'_>) -> anyhow::Result<Option<GivenFilling>> {
    let data = files::read_data(path, &InputArgs::default())?;
    let mesh = data.hex_mesh()?;
    let Some(is_ball) = hexfill::with_judged(&data, None, |judged| is_exact_ball(judged, ctx)) else {
        return Ok(None);
    };
    ensure!(is_ball, "{path} is no proper ball of hexes; see `hexfill check {path}`");
    let filling = GivenFilling::of_mesh(&mesh).with_context(|| {
        format!("{path}: no order of its {} hexes was found (at most 255) whose parts all have at most {MAX_CAP} boundary quads; simplify it", mesh.n_hexes())
    })?;
    Ok(Some(filling))
}

fn complete_atlas(
    file: &Path,
    output: &str,
    keep: Option<&Path>,
    given: &[GivenFilling],
    options: &CompleteOptions,
    ctx: &Context<'_>,
) -> anyhow::Result<CompletionReport> {
    let kept = keep.map(Atlas::read_path).transpose()?;
    let kept = kept.as_ref().unwrap_or_else(|| Atlas::embedded());
    let (atlas, done) = complete(&Atlas::read_path(file)?, kept, given, options, ctx).with_context(|| {
        format!("{} cannot be completed; leave out what is at fault, or build it again", file.display())
    })?;
    files::write_file(output, |out| atlas.write_packed(out))?;
    Ok(CompletionReport {
        file: output.to_owned(),
        states: atlas.n_states(),
        bytes: std::fs::metadata(output)?.len(),
        classes: done.targets,
        grown: done.grown,
        kept: done.kept,
        found: done.found,
        large: done.large,
        missing: done.missing,
        stopped: (done.stop != StopReason::Finished).then_some(done.stop),
    })
}

fn build(
    path: &Path,
    options: GrowOptions,
    beam: Option<usize>,
    levels: u32,
    console: &Console,
    ctx: &Context<'_>,
) -> anyhow::Result<BuildReport> {
    let (mut log, mut growth) = GrowthLog::open(path, options)?;
    if let Some(beam) = beam {
        growth = growth.with_beam(beam);
    }
    if growth.level() > 1 {
        console.say(format!("going on from level {} ({} states)", growth.level(), growth.n_states()));
    }
    if log.dropped_bytes() > 0 {
        console.note(format!("a torn last level of {} bytes was dropped from {}", log.dropped_bytes(), path.display()));
    }
    let mut stopped = None;
    while growth.level() < levels && !growth.is_exhausted() {
        let start = Instant::now();
        let report = growth.grow(ctx);
        if let Some(stop) = report.stopped {
            stopped = Some(stop);
            break;
        }
        log.append(&growth, &report)?;
        if console.verbose > 0 {
            console.say(format!(
                "level {:3}: {:9} flips, {:8} states kept, {:9} classes, {:9} states, {} thinned, {:.0} flips/s, {} MB",
                report.level,
                report.children,
                report.kept,
                report.classes,
                report.states,
                report.thinned,
                report.children as f64 / start.elapsed().as_secs_f64(),
                growth.memory() >> 20
            ));
        }
    }
    let report = BuildReport {
        levels: growth.level(),
        classes: growth.n_classes(),
        states: growth.n_states(),
        memory_bytes: growth.memory(),
        thinned: log.thinned(),
        exhausted: growth.is_exhausted(),
        stopped,
    };
    if !console.json {
        console.print(format!(
            "{}: {} levels, {} classes, {} states{}",
            path.display(),
            report.levels,
            report.classes,
            report.states,
            if report.exhausted { "; nothing is left to grow from" } else { "" }
        ))?;
    }
    if report.thinned > 0 {
        console.note(format!(
            "{} classes were left out to stay within the beam or the memory limit: this atlas proves no bound",
            report.thinned
        ));
    }
    match report.stopped {
        Some(StopReason::MemoryLimit) => console.say(format!(
            "the memory limit leaves no room for level {}; the same command with a larger --memory-limit goes on",
            report.levels + 1
        )),
        Some(_) => console.say(format!("stopped; the same command goes on from level {}", report.levels)),
        None => {}
    }
    Ok(report)
}

#[derive(Serialize)]
struct StatsRow {
    quads: usize,
    classes: usize,
    /// How many classes there are, where the atlas is that of all 3-connected spheres.
    #[serde(skip_serializing_if = "Option::is_none")]
    all_classes: Option<usize>,
    fewest_hexes: u32,
    mean_hexes: f64,
    median_hexes: u32,
    most_hexes: u32,
    fewest_interior_vertices: u32,
    mean_interior_vertices: f64,
    most_interior_vertices: u32,
}

/// The number of 3-connected quad spheres of a size, as published (see `hexfill_mesh::generate`).
fn all_classes(quads: usize) -> Option<usize> {
    [(6, 1), (8, 1), (10, 3), (12, 11), (14, 58), (16, 451), (18, 4_461), (20, 49_957), (22, 598_102)]
        .into_iter()
        .find_map(|(size, count)| (size == quads).then_some(count))
}

fn stats(atlas: &Atlas, console: &Console) -> anyhow::Result<Exit> {
    let stats = atlas.stats();
    let mean = |spread: Spread, classes: usize| spread.sum as f64 / classes as f64;
    let rows: Vec<StatsRow> = stats
        .classes
        .iter()
        .map(|(&quads, c)| StatsRow {
            quads,
            classes: c.classes,
            all_classes: all_classes(quads),
            fewest_hexes: c.hexes.fewest,
            mean_hexes: mean(c.hexes, c.classes),
            median_hexes: c.hexes.median,
            most_hexes: c.hexes.most,
            fewest_interior_vertices: c.interior.fewest,
            mean_interior_vertices: mean(c.interior, c.classes),
            most_interior_vertices: c.interior.most,
        })
        .collect();
    if console.json {
        let report = serde_json::json!({ "states": stats.states, "levels": stats.levels, "by_quads": rows });
        console.print_json(&report)?;
        return Ok(Exit::Done);
    }
    console.print(format!("{} states, up to {} hexes", stats.states, stats.levels))?;
    console
        .print("quads  classes   of all  hexes: fewest  mean  median  most  interior vertices: fewest  mean  most")?;
    for row in rows {
        console.print(format!(
            "{:5} {:8} {:>8} {:14} {:5.1} {:7} {:5} {:26} {:5.1} {:5}",
            row.quads,
            row.classes,
            row.all_classes.map_or("-".to_owned(), |n| n.to_string()),
            row.fewest_hexes,
            row.mean_hexes,
            row.median_hexes,
            row.most_hexes,
            row.fewest_interior_vertices,
            row.mean_interior_vertices,
            row.most_interior_vertices
        ))?;
    }
    Ok(Exit::Done)
}

#[derive(PartialEq, Serialize)]
struct LookupRow {
    hexes: usize,
    interior_vertices: u32,
    blocked_pairs: u32,
}

fn lookup(surface: &str, atlases: &[&Atlas], console: &Console) -> anyhow::Result<Exit> {
    let problem = files::load_problem(surface, &files::InputArgs::default())?;
    let Some((cavity, _)) = Cavity::from_surface(problem.surface()) else {
        bail!("{surface} is not one sphere of at most {MAX_QUADS} quads; the atlas knows no other surfaces");
    };
    let mut rows: Vec<LookupRow> = atlases
        .iter()
        .flat_map(|atlas| atlas.balls_for(&cavity))
        .map(|ball| LookupRow {
            hexes: ball.n_hexes(),
            interior_vertices: ball.n_vertices - cavity.n_vertices() as u32,
            blocked_pairs: ball.boundary.n_blocked(),
        })
        .collect();
    rows.sort_by_key(|row| (row.hexes, row.interior_vertices, row.blocked_pairs));
    rows.dedup();
    if console.json {
        console.print_json(&serde_json::json!({ "fillings": rows }))?;
    } else if rows.is_empty() {
        console.say(format!("{surface}: not in the atlas, which proves nothing; try `hexfill fill`"));
    } else {
        for row in &rows {
            console.print(format!(
                "{} hexes, {} interior vertices, {} blocked pairs",
                row.hexes, row.interior_vertices, row.blocked_pairs
            ))?;
        }
    }
    Ok(if rows.is_empty() { Exit::No } else { Exit::Done })
}
