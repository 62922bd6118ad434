//! `hexfill-mpi search SIGNATURE --max-hexes H`: every hex ball with at most H hexes on a sphere, or the proof that there is none.
//!
//! Source: ours.

use crate::manager::{self, Job};
use anyhow::bail;
use hexfill_ledger::{Chunk, Ledger, chunks_of_part, default_chunks};
use hexfill_mesh::{Context, parse_surface_signature};
use hexfill_prove::{Header, Plan, Problem, Record, Searched};
use mpi::topology::SimpleCommunicator;
use mpi::traits::Communicator;
use std::path::PathBuf;

/// Flags of the complete search.
#[derive(clap::Args)]
pub(crate) struct SearchArgs {
    /// The surface's signature, as `hexfill info SURFACE` prints it.
    signature: String,
    /// Meshes with at most so many hexes.
    #[arg(long, value_name = "H")]
    max_hexes: usize,
    /// Only meshes with these symmetries: none (all meshes), auto (all the boundary has), or a number that `hexfill search SIGNATURE --list-symmetries` prints.
    #[arg(long, default_value = "none", value_name = "none|auto|K")]
    symmetry: String,
    /// Number of chunks [default: 1024].
    #[arg(long, value_name = "K")]
    chunks: Option<usize>,
    /// Keep a ledger here; the same command goes on where a killed run stopped.
    #[arg(long, value_name = "DIR")]
    checkpoint: Option<PathBuf>,
    /// For tests: this rank reports an error instead of doing its first chunk.
    #[arg(long, hide = true, value_name = "RANK")]
    fail_rank: Option<i32>,
}

/// Does this rank's part. Whether all chunks are done.
pub(crate) fn run(args: &SearchArgs, world: &SimpleCommunicator) -> anyhow::Result<bool> {
    let job = Search { plan: Plan::prepare(problem(args)?, &Context::default())? };
    if world.rank() == 0 {
        manage(args, &job, world)
    } else {
        manager::work(&job, world, args.fail_rank).map(|()| true)
    }
}

fn problem(args: &SearchArgs) -> anyhow::Result<Problem> {
    let problem = Problem::new(&parse_surface_signature(&args.signature)?, args.max_hexes)?;
    let classes = problem.symmetries().subgroup_classes();
    let group = match (args.symmetry.as_str(), args.symmetry.parse::<usize>()) {
        ("none", _) => 1,
        ("auto", _) => problem.symmetries().whole(),
        (_, Ok(k)) if k < classes.len() => classes[k],
        (other, _) => bail!("--symmetry {other}: none, auto, or a number below {}", classes.len()),
    };
    Ok(problem.with_group(group))
}

struct Search {
    plan: Plan,
}

impl Job for Search {
    type Result = Record;

    fn run(&self, chunk: Chunk) -> anyhow::Result<Record> {
        Ok(Record::of_chunk(&self.plan, chunk, &Context::default())?)
    }
}

/// Rank 0. Whether all chunks are done.
fn manage(args: &SearchArgs, job: &Search, world: &SimpleCommunicator) -> anyhow::Result<bool> {
    let part = Chunk { index: 0, of: 1 };
    // Whatever is wrong here, the workers wait for an order.
    let begun = chunks_of_part(part, args.chunks.unwrap_or_else(|| default_chunks(1))).and_then(|chunks| {
        let header = Header::new(job.plan.problem(), chunks.len());
        let open = |folder: &PathBuf| Ledger::<Header, Record>::open(folder, part, &header);
        Ok((chunks, args.checkpoint.as_ref().map(open).transpose()?))
    });
    let (mut left, mut ledger) = match begun {
        Ok(begun) => begun,
        Err(error) => {
            manager::dismiss::<Search>(world)?;
            return Err(error.into());
        }
    };
    let (chunks, mut records) = (left.len(), Vec::new());
    if let Some(ledger) = &ledger {
        left.retain(|chunk| !ledger.records().contains_key(&chunk.index));
    }
    let book = manager::manage(job, left, world, &mut |record| {
        match &mut ledger {
            Some(ledger) => ledger.append(record, None)?,
            None => records.push(record),
        }
        Ok(())
    })?;
    let done = ledger.iter().flat_map(|ledger| ledger.records().values()).chain(&records);
    let searched = Searched::of_records(done, &job.plan)?;
    let outcome = &searched.outcome;
    let report = serde_json::json!({
        "boundary": job.plan.problem().signature(),
        "max_hexes": args.max_hexes,
        "symmetry": job.plan.problem().symmetries().describe(job.plan.problem().group()),
        "chunks": chunks,
        "undone": book.undone(),
        "failures": book.failures,
        "exhausted": book.all_done(),
        "classes": outcome.classes(),
        "meshes": outcome.meshes.keys().collect::<Vec<_>>(),
        "nodes": outcome.nodes + job.plan.split_nodes(),
        "tree_sum": format!("{:032x}", outcome.tree_sum),
        "hash_sum": format!("{:032x}", outcome.hash_sum()),
    });
    println!("{}", serde_json::to_string_pretty(&report)?);
    let (meshes, seconds) = (outcome.meshes.len(), searched.cpu_nanoseconds as f64 / 1e9);
    eprintln!("hexfill-mpi: {meshes} classes, {} ranks, {seconds:.1} s processor time", world.size());
    Ok(book.all_done())
}
