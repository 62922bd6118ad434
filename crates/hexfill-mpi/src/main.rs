//! `mpirun -n RANKS hexfill-mpi N [flags]`: the enumeration over MPI.
//!
//! Rank 0 is the manager: it gives out chunks, keeps the ledger if there is one, and prints the totals as JSON. The other ranks run
//! the same chunk function as every other driver. With one rank the manager does the work itself. Totals do not depend on
//! the number of ranks. Exit code 0: all chunks done; 1: some were not; 2: bad usage.

mod protocol;

use anyhow::{Context as _, bail};
use clap::Parser;
use hexfill_enumerate::{
    Chunk, ChunkResult, Filter, Header, Ledger, LevelOptions, Params, Plan, Rule, Selection, Tally, Target, Wanted,
    chunks_of_part, default_chunks,
};
use hexfill_mesh::Context;
use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator, Destination, Source};
use protocol::{Answer, Book, Order};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::path::PathBuf;
use std::process::ExitCode;

/// Every hex mesh of N cubes, over MPI.
#[derive(Parser)]
#[command(version)]
struct Args {
    /// Number of cubes.
    cubes: usize,
    /// strict or weill.
    #[arg(long, default_value = "strict")]
    rule: Rule,
    /// Also non-orientable gluings (rule strict).
    #[arg(long)]
    nonorientable: bool,
    /// Extend only meshes with at most K chords from --filter-from cubes on (rule weill).
    #[arg(long, value_name = "K")]
    max_chords: Option<u8>,
    /// First number of cubes at which --max-chords filters.
    #[arg(long, default_value_t = 8, value_name = "N")]
    filter_from: usize,
    /// Number of chunks [default: 1024].
    #[arg(long, value_name = "K")]
    chunks: Option<usize>,
    /// Keep a ledger here; the same command goes on where a killed run stopped.
    #[arg(long, value_name = "DIR")]
    checkpoint: Option<PathBuf>,
    /// Report meshes with these boundaries (as `hexfill enumerate --find`).
    #[arg(long, value_name = "BOUNDARY")]
    find: Vec<String>,
    /// For tests: this rank reports an error instead of doing its first chunk.
    #[arg(long, hide = true, value_name = "RANK")]
    fail_rank: Option<i32>,
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
    let outcome = job(&args).and_then(|job| {
        if world.rank() == 0 { manage(&args, &job, &world) } else { work(&args, &job, &world).map(|()| true) }
    });
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

/// What every rank derives from the command line in the same way.
struct Job {
    plan: Plan,
    targets: Vec<Target>,
    selection: Selection,
    chunks: Vec<Chunk>,
    header: Header,
}

impl Job {
    fn wanted(&self) -> Wanted<'_> {
        Wanted { selection: Some(&self.selection), list: false, targets: &self.targets }
    }
}

fn job(args: &Args) -> anyhow::Result<Job> {
    let params = Params {
        cubes: args.cubes,
        rule: args.rule,
        nonorientable: args.nonorientable,
        filter: args.max_chords.map(|max_chords| Filter { max_chords, from: args.filter_from }),
    };
    let mut targets = Vec::new();
    for name in &args.find {
        if name == "all" {
            targets.extend(Target::built_in()?);
        } else {
            targets.push(Target::parse(name)?);
        }
    }
    let selection = Selection { max_chords: args.max_chords, ..Selection::default() };
    let chunks = chunks_of_part(Chunk { index: 0, of: 1 }, args.chunks.unwrap_or_else(|| default_chunks(1)))?;
    let names = targets.iter().map(|t| t.name.clone()).collect();
    let header = Header::new(&params, selection.text(), false, names, chunks.len());
    let plan = Plan::prepare(&params, &LevelOptions::default(), &Context::default())?;
    Ok(Job { plan, targets, selection, chunks, header })
}

fn send<T: Serialize>(world: &SimpleCommunicator, to: i32, message: &T) -> anyhow::Result<()> {
    world.process_at_rank(to).send(&serde_json::to_vec(message)?[..]);
    Ok(())
}

fn parse<T: DeserializeOwned>(bytes: &[u8]) -> anyhow::Result<T> {
    serde_json::from_slice(bytes).context("a message between ranks cannot be read")
}

fn work(args: &Args, job: &Job, world: &SimpleCommunicator) -> anyhow::Result<()> {
    let mut answer = Answer::Ready;
    loop {
        send(world, 0, &answer)?;
        if let Answer::Failed(..) = answer {
            return Ok(());
        }
        if let Answer::Done(_) = answer {
            send(world, 0, &Answer::Ready)?;
        }
        let (bytes, _) = world.process_at_rank(0).receive_vec::<u8>();
        let Order::Do(chunk) = parse(&bytes)? else { return Ok(()) };
        answer = if args.fail_rank == Some(world.rank()) {
            Answer::Failed(chunk, "told to fail".into())
        } else {
            match job.plan.run(chunk, job.wanted(), &Context::default()) {
                Ok(result) => Answer::Done(Box::new(result.into())),
                Err(error) => Answer::Failed(chunk, error.to_string()),
            }
        };
    }
}

/// Totals, ledger and what was found.
struct Totals {
    ledger: Option<Ledger>,
    tally: Tally,
    cpu_nanoseconds: u64,
    found: Vec<(String, String)>,
}

impl Totals {
    fn take(&mut self, result: &ChunkResult, job: &Job) -> anyhow::Result<()> {
        if let Some(ledger) = &mut self.ledger {
            ledger.append(result)?;
        }
        self.tally.merge(&result.tally);
        self.cpu_nanoseconds += result.cpu_nanoseconds;
        self.found.extend(result.found.targets.iter().map(|(i, code)| (job.targets[*i].name.clone(), code.to_text())));
        Ok(())
    }
}

/// Rank 0. Whether all chunks are done.
fn manage(args: &Args, job: &Job, world: &SimpleCommunicator) -> anyhow::Result<bool> {
    let part = Chunk { index: 0, of: 1 };
    let ledger = args.checkpoint.as_ref().map(|folder| Ledger::open(folder, part, &job.header));
    let ledger = match ledger.transpose() {
        Ok(ledger) => ledger,
        Err(error) => {
            dismiss(world)?;
            return Err(error.into());
        }
    };
    let mut totals = Totals { ledger: None, tally: Tally::default(), cpu_nanoseconds: 0, found: Vec::new() };
    let mut left = job.chunks.clone();
    if let Some(ledger) = ledger {
        left.retain(|chunk| !ledger.records().contains_key(&chunk.index));
        for record in ledger.records().values() {
            totals.tally.merge(&record.tally);
            totals.cpu_nanoseconds += record.cpu_nanoseconds;
            totals.found.extend(record.targets.clone());
        }
        totals.ledger = Some(ledger);
    }
    let workers = world.size() - 1;
    let mut book = Book::new(left, workers as usize);
    if workers == 0 {
        while let Some(Order::Do(chunk)) = (book.undone() > 0).then(|| book.ready(0)).flatten() {
            totals.take(&job.plan.run(chunk, job.wanted(), &Context::default())?, job)?;
            book.done();
        }
    }
    while !book.is_closed() {
        let (bytes, status) = world.any_process().receive_vec::<u8>();
        let rank = status.source_rank();
        match parse(&bytes)? {
            Answer::Ready => {
                if let Some(order) = book.ready(rank) {
                    send(world, rank, &order)?;
                }
            }
            Answer::Done(result) => {
                totals.take(&(*result).try_into()?, job)?;
                book.done();
            }
            Answer::Failed(chunk, why) => book.failed(rank, chunk, &why),
        }
        for (rank, order) in book.release() {
            send(world, rank, &order)?;
        }
    }
    totals.found.sort();
    let report = serde_json::json!({
        "params": job.plan.params(),
        "chunks": job.chunks.len(),
        "undone": book.undone(),
        "failures": book.failures,
        "counts": totals.tally,
        "found": totals.found,
    });
    println!("{}", serde_json::to_string_pretty(&report)?);
    eprintln!(
        "hexfill-mpi: {} classes, {} ranks, {:.1} s processor time",
        totals.tally.classes,
        world.size(),
        totals.cpu_nanoseconds as f64 / 1e9
    );
    for failure in &book.failures {
        eprintln!("hexfill-mpi: {failure}");
    }
    Ok(book.undone() == 0)
}

/// Tells every worker to leave.
fn dismiss(world: &SimpleCommunicator) -> anyhow::Result<()> {
    for _ in 1..world.size() {
        let (bytes, status) = world.any_process().receive_vec::<u8>();
        if !matches!(parse(&bytes)?, Answer::Ready) {
            bail!("a worker answered before it was asked");
        }
        send(world, status.source_rank(), &Order::Stop)?;
    }
    Ok(())
}
