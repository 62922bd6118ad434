//! The binary `hexfill`: flags and glue. Everything it does is in the libraries.
//!
//! Data goes to stdout, everything else to stderr. Exit codes: 0 done and verified; 1 ran, the answer is "no"; 2 bad usage
//! or input; 3 stopped by a limit or signal; 70 internal error. A broken pipe is a quiet success.

mod commands;
mod console;
mod exit;
mod files;
mod panics;

use clap::{Args, Parser, Subcommand};
use console::Console;
use exit::Exit;
use hexfill::Context;
use std::process::ExitCode;
use std::time::Duration;

/// Fill a closed quad surface with hexahedra and leave the surface exactly as it is.
///
/// A surface is a file (OBJ, OFF, PLY, VTK, VTU, VTP, MEDIT, MSH, INP, BDF, UNV, OVM, JSON, each also .gz or .zst), `-` for stdin
/// (with --from), a catalogue name such as :schneiders-pyramid, or a signature printed by `hexfill info`.
///
/// Exit codes: 0 done and verified, 1 the answer is "no", 2 bad usage or input, 3 stopped by a limit or signal before
/// the work was done (best result and checkpoint written), 70 internal error.
#[derive(Parser)]
#[command(name = "hexfill", version, max_term_width = 110)]
struct Cli {
    #[command(subcommand)]
    command: Command,
    #[command(flatten)]
    common: Common,
}

// Flags every command takes. (No doc comment: clap would print it as the description of the program.)
#[derive(Args, Clone)]
pub(crate) struct Common {
    /// Threads to use [default: all cores].
    #[arg(short = 'j', long, global = true, value_name = "N")]
    pub threads: Option<usize>,
    /// Where every pseudo-random choice starts.
    #[arg(long, global = true, default_value_t = 0, value_name = "N")]
    pub seed: u64,
    /// Stop after this long (90, 90s, 10m, 2h), keeping the best result so far.
    #[arg(long, global = true, value_name = "TIME", value_parser = files::parse_duration)]
    pub time_limit: Option<Duration>,
    /// While growing an atlas or enumerating, hold at most this much in memory (bytes, 800M, 6G).
    #[arg(long, global = true, value_name = "SIZE", value_parser = files::parse_size)]
    pub memory_limit: Option<u64>,
    /// Say less: errors only.
    #[arg(short, long, global = true)]
    pub quiet: bool,
    /// Say more.
    #[arg(short, long, global = true, action = clap::ArgAction::Count)]
    pub verbose: u8,
    /// Print the report as JSON on stdout.
    #[arg(long, global = true)]
    pub json: bool,
    /// When to use colours (also off with NO_COLOR).
    #[arg(long, global = true, default_value = "auto", value_name = "WHEN")]
    pub color: console::ColorWhen,
}

/// More threads than these are never of use.
const THREADS_PER_CORE: usize = 4;

#[derive(Subcommand)]
enum Command {
    /// Fill a surface with hexahedra.
    Fill(commands::fill::FillArgs),
    /// Judge a mesh: which level of the validity ladder it reaches, which rule fails where.
    Check(commands::check::CheckArgs),
    /// Say everything that is wrong with a surface before it is filled, and mend it.
    Doctor(commands::doctor::DoctorArgs),
    /// Say what a surface or mesh is: genus, chords, key, signature, whether a hex mesh exists.
    #[command(visible_alias = "dual")]
    Info(commands::info::InfoArgs),
    /// Move the interior vertices of a mesh until every hex is valid and good.
    #[command(visible_alias = "untangle")]
    Embed(commands::embed::EmbedArgs),
    /// Make a hex mesh smaller without touching its boundary.
    Simplify(commands::simplify::SimplifyArgs),
    /// Convert a surface or mesh between file formats.
    Convert(commands::convert::ConvertArgs),
    /// Write one HTML file that shows a mesh.
    View(commands::view::ViewArgs),
    /// Named problems with their sources and best known meshes.
    Catalog(commands::catalog::CatalogArgs),
    /// Build, inspect and query atlases of smallest known fillings.
    Atlas(commands::atlas::AtlasArgs),
    /// Enumerate every hex mesh of n cubes, without isomorphic copies.
    Enumerate(commands::enumerate::EnumerateArgs),
    /// List every hex mesh of a sphere with at most so many hexes, or prove that there is none.
    Search(commands::search::SearchArgs),
    /// The fewest hexes known for the catalogue's problems, and how few are proved to be needed.
    Records(commands::records::RecordsArgs),
    /// Print shell completions.
    Completions(commands::completions::CompletionsArgs),
    /// Print a manual page.
    Man(commands::man::ManArgs),
}

fn main() -> ExitCode {
    panics::guard(run)
}

fn run() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => {
            let code = if error.use_stderr() { Exit::Usage } else { Exit::Done };
            // A closed pipe while printing help is no failure.
            let _ = error.print();
            if error.use_stderr() && std::env::args_os().any(|arg| arg == "--json") {
                console::print_usage_error(&error.to_string());
            }
            return code.into();
        }
    };
    let console = Console::new(&cli.common);
    let cancel = exit::install_signal_handler(console::tell);
    if let Some(threads) = cli.common.threads {
        if threads == 0 {
            console.fail(&anyhow::anyhow!("--threads 0: give at least 1"), Exit::Usage as u8);
            return Exit::Usage.into();
        }
        // Results do not depend on it, and threads that wait for a core only stand in each other's way.
        let most = THREADS_PER_CORE * std::thread::available_parallelism().map_or(1, usize::from);
        if threads > most {
            console.note(format!("--threads {threads}: {most} are used, {THREADS_PER_CORE} for each core"));
        }
        let threads = threads.min(most);
        // More threads than the system gives is the user's number, no defect.
        if let Err(error) = rayon::ThreadPoolBuilder::new().num_threads(threads).build_global() {
            console.fail(&anyhow::anyhow!("--threads {threads}: {error}"), Exit::Usage as u8);
            return Exit::Usage.into();
        }
    }
    panics::provoked_by_test();
    let progress = |p: &hexfill::Progress| console.progress(p);
    let mut ctx = Context {
        cancel: Some(cancel),
        memory_limit: cli.common.memory_limit,
        seed: cli.common.seed,
        progress: Some(&progress),
        ..Context::default()
    };
    if let Some(limit) = cli.common.time_limit {
        ctx = ctx.with_time_limit(limit);
    }
    let outcome = match &cli.command {
        Command::Fill(args) => commands::fill::run(args, &console, &ctx),
        Command::Check(args) => commands::check::run(args, &console, &ctx),
        Command::Doctor(args) => commands::doctor::run(args, &console),
        Command::Info(args) => commands::info::run(args, &console),
        Command::Embed(args) => commands::embed::run(args, &console, &ctx),
        Command::Simplify(args) => commands::simplify::run(args, &console, &ctx),
        Command::Convert(args) => commands::convert::run(args, &console),
        Command::View(args) => commands::view::run(args, &console),
        Command::Catalog(args) => commands::catalog::run(args, &console, &ctx),
        Command::Atlas(args) => commands::atlas::run(args, &console, &ctx),
        Command::Enumerate(args) => commands::enumerate::run(args, rayon::current_num_threads(), &console, &ctx),
        Command::Search(args) => commands::search::run(args, rayon::current_num_threads(), &console, &ctx),
        Command::Records(args) => commands::records::run(args, &console, &ctx),
        Command::Completions(args) => commands::completions::run(args),
        Command::Man(args) => commands::man::run(args),
    };
    console.finish_progress();
    match outcome {
        Ok(code) => code.into(),
        Err(error) if exit::is_broken_pipe(&error) => Exit::Done.into(),
        Err(error) => {
            let code = exit::code_of(&error);
            console.fail(&error, code as u8);
            code.into()
        }
    }
}
