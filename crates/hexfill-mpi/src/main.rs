//! `mpirun -n RANKS hexfill-mpi N [flags]` and `mpirun -n RANKS hexfill-mpi search SIGNATURE [flags]`: the enumeration and the complete
//! search over MPI.
//!
//! Rank 0 is the manager: it gives out chunks, keeps the ledger if there is one, and prints the totals as JSON. The other ranks run
//! the same chunk function as every other driver. With one rank the manager does the work itself. Totals do not depend on
//! the number of ranks. Exit code 0: all chunks done; 1: some were not; 2: bad usage.

mod enumerate;
mod manager;
mod protocol;
mod search;

use clap::Parser;
use mpi::traits::Communicator;
use std::process::ExitCode;

/// Every hex mesh of N cubes, or every hex ball on a sphere, over MPI.
#[derive(Parser)]
#[command(version, args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
struct Args {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    enumeration: enumerate::EnumerateArgs,
}

#[derive(clap::Subcommand)]
enum Command {
    /// List every hex mesh of a sphere with at most so many hexes, or prove that there is none.
    Search(search::SearchArgs),
}

fn main() -> ExitCode {
    let Some(universe) = mpi::initialize() else {
        eprintln!("hexfill-mpi: MPI is initialized already");
        return ExitCode::from(2);
    };
    let world = universe.world();
    let args = match Args::try_parse() {
        Ok(args) => args,
        Err(error) => {
            if world.rank() == 0 {
                // A closed pipe while printing help is no failure.
                let _ = error.print();
            }
            return ExitCode::from(if error.use_stderr() { 2 } else { 0 });
        }
    };
    // Bad parameters are found by every rank alike, before any message.
    let outcome = match &args.command {
        Some(Command::Search(search)) => search::run(search, &world),
        None => enumerate::run(&args.enumeration, &world),
    };
    match outcome {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            if world.rank() == 0 {
                eprintln!("hexfill-mpi: {error:#}");
            }
            ExitCode::from(2)
        }
    }
}
