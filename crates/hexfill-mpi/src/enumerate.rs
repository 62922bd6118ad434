//! `hexfill-mpi N`: every hex mesh of N cubes.
//!
//! Source: ours.

use crate::manager::{self, Job};
use anyhow::anyhow;
use hexfill_enumerate::{
    Chunk, ChunkResult, Code, EnumerateError, Filter, Found, Header, Ledger, LevelOptions, Params, Plan, Rule,
    Selection, Tally, Target, Wanted, chunks_of_part, default_chunks,
};
use hexfill_mesh::Context;
use mpi::topology::SimpleCommunicator;
use mpi::traits::Communicator;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// Flags of the enumeration.
#[derive(clap::Args)]
pub(crate) struct EnumerateArgs {
    /// Number of cubes.
    #[arg(required = true)]
    cubes: Option<usize>,
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

/// Does this rank's part. Whether all chunks are done.
pub(crate) fn run(args: &EnumerateArgs, world: &SimpleCommunicator) -> anyhow::Result<bool> {
    let job = Enumeration::new(args)?;
    if world.rank() == 0 {
        manage(args, &job, world)
    } else {
        manager::work(&job, world, args.fail_rank).map(|()| true)
    }
}

struct Enumeration {
    plan: Plan,
    targets: Vec<Target>,
    selection: Selection,
    chunks: Vec<Chunk>,
    header: Header,
}

impl Enumeration {
    fn new(args: &EnumerateArgs) -> anyhow::Result<Self> {
        let params = Params {
            cubes: args.cubes.ok_or_else(|| anyhow!("how many cubes?"))?,
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
        Ok(Self { plan, targets, selection, chunks, header })
    }
}

impl Job for Enumeration {
    type Result = Finished;

    fn run(&self, chunk: Chunk) -> anyhow::Result<Finished> {
        let wanted = Wanted { selection: Some(&self.selection), list: false, targets: &self.targets };
        Ok(self.plan.run(chunk, wanted, &Context::default())?.into())
    }
}

/// A chunk's result as it travels.
#[derive(Serialize, Deserialize, Debug)]
struct Finished {
    chunk: Chunk,
    tally: Tally,
    cpu_nanoseconds: u64,
    selected: Vec<String>,
    targets: Vec<(usize, String)>,
}

impl From<ChunkResult> for Finished {
    fn from(r: ChunkResult) -> Self {
        Self {
            chunk: r.chunk,
            tally: r.tally,
            cpu_nanoseconds: r.cpu_nanoseconds,
            selected: r.found.selected.iter().map(Code::to_text).collect(),
            targets: r.found.targets.iter().map(|(i, c)| (*i, c.to_text())).collect(),
        }
    }
}

impl TryFrom<Finished> for ChunkResult {
    type Error = EnumerateError;

    fn try_from(f: Finished) -> Result<Self, Self::Error> {
        let selected = f.selected.iter().map(|c| c.parse()).collect::<Result<_, _>>()?;
        let targets = f.targets.iter().map(|(i, c)| Ok((*i, c.parse()?))).collect::<Result<_, Self::Error>>()?;
        Ok(Self {
            chunk: f.chunk,
            tally: f.tally,
            cpu_nanoseconds: f.cpu_nanoseconds,
            found: Found { selected, targets },
        })
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
    fn take(&mut self, result: &ChunkResult, job: &Enumeration) -> anyhow::Result<()> {
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
fn manage(args: &EnumerateArgs, job: &Enumeration, world: &SimpleCommunicator) -> anyhow::Result<bool> {
    let part = Chunk { index: 0, of: 1 };
    let ledger = args.checkpoint.as_ref().map(|folder| Ledger::open(folder, part, &job.header));
    let ledger = match ledger.transpose() {
        Ok(ledger) => ledger,
        Err(error) => {
            manager::dismiss::<Enumeration>(world)?;
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
    let book = manager::manage(job, left, world, &mut |result| totals.take(&result.try_into()?, job))?;
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
    let classes = totals.tally.classes;
    let seconds = totals.cpu_nanoseconds as f64 / 1e9;
    eprintln!("hexfill-mpi: {classes} classes, {} ranks, {seconds:.1} s processor time", world.size());
    Ok(book.all_done())
}
