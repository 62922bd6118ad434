//! Drivers over the chunks of a plan: threads, with or without a ledger.
//!
//! Source: ours.

use crate::error::ProveError;
use crate::mesh::{Mesh, signature_of};
use crate::plan::{Outcome, Plan, Problem};
use hexfill_ledger::{Chunk, CpuClock, Header as _, Ledger, Merged, chunks_of_part, default_chunks, mixed_order};
use hexfill_mesh::Context;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Version of the ledger's format and of the tree: sums of two versions do not compare.
const FORMAT: u32 = 2;

/// What a ledger is about.
#[derive(Clone, PartialEq, Eq, Debug, Serialize, Deserialize)]
pub struct Header {
    /// Version of ledger and tree.
    pub search: u32,
    /// The boundary's signature.
    pub surface: String,
    /// The bound.
    pub max_hexes: usize,
    /// The subgroup imposed, a bit an element in the order of the signature's surface.
    pub group: u64,
    /// Number of chunks.
    pub chunks: usize,
}

impl Header {
    /// The header of a search in so many chunks.
    pub fn new(problem: &Problem, chunks: usize) -> Self {
        let surface = problem.signature().to_owned();
        Self { search: FORMAT, surface, max_hexes: problem.max_hexes(), group: problem.group(), chunks }
    }
}

impl hexfill_ledger::Header for Header {
    fn chunks(&self) -> usize {
        self.chunks
    }

    fn differences(&self, expected: &Self) -> String {
        let mut out = Vec::new();
        let mut compare = |name: &str, found: String, wanted: String| {
            if found != wanted {
                out.push(format!("{name} is {found}, not {wanted}"));
            }
        };
        compare("search format", self.search.to_string(), expected.search.to_string());
        compare("surface", self.surface.clone(), expected.surface.clone());
        compare("most hexes", self.max_hexes.to_string(), expected.max_hexes.to_string());
        compare("symmetry", format!("{:x}", self.group), format!("{:x}", expected.group));
        compare("number of chunks", self.chunks.to_string(), expected.chunks.to_string());
        out.join("; ")
    }
}

/// A finished chunk.
#[derive(Clone, PartialEq, Eq, Debug, Serialize, Deserialize)]
pub struct Record {
    /// Number of the chunk.
    pub chunk: usize,
    /// Processor time, nanoseconds.
    pub cpu_nanoseconds: u64,
    /// States visited.
    pub nodes: u64,
    /// Sum of a hash of every state visited, 32 hexadecimal digits.
    pub tree_sum: String,
    /// Meshes found: hexes in VTK order over the vertices of the signature's surface.
    pub meshes: Vec<Vec<[u32; 8]>>,
}

impl hexfill_ledger::Record for Record {
    fn chunk(&self) -> usize {
        self.chunk
    }
}

impl Record {
    /// Searches a chunk: what its line in a ledger says. For drivers that bring their own processes (MPI).
    ///
    /// # Errors
    /// [`ProveError::Stopped`], [`ProveError::Refused`].
    pub fn of_chunk(plan: &Plan, chunk: Chunk, ctx: &Context<'_>) -> Result<Self, ProveError> {
        let clock = CpuClock::start();
        let outcome = plan.run(chunk, ctx)?;
        Ok(Self::new(chunk, clock.elapsed(), &outcome))
    }

    fn new(chunk: Chunk, cpu_nanoseconds: u64, outcome: &Outcome) -> Self {
        let meshes = outcome.meshes.values().map(|m| m.hexes.clone()).collect();
        let tree_sum = format!("{:032x}", outcome.tree_sum);
        Self { chunk: chunk.index, cpu_nanoseconds, nodes: outcome.nodes, tree_sum, meshes }
    }

    /// What the chunk found; the meshes are judged again.
    fn outcome(&self, plan: &Plan) -> Result<Outcome, ProveError> {
        let bad = |e: std::num::ParseIntError| ProveError::BadParameters { why: format!("a sum in the ledger: {e}") };
        let mut out = Outcome {
            nodes: self.nodes,
            tree_sum: u128::from_str_radix(&self.tree_sum, 16).map_err(bad)?,
            ..Outcome::default()
        };
        for hexes in &self.meshes {
            let n_vertices = hexes.iter().flatten().max().map_or(0, |&v| v as usize + 1);
            let mesh = Mesh { n_vertices, hexes: hexes.clone() };
            if let Some(signature) = signature_of(plan.problem().surface(), &mesh)? {
                out.meshes.insert(signature, mesh);
            }
        }
        Ok(out)
    }
}

/// What a search did.
#[derive(Clone, Debug, Default)]
pub struct Searched {
    /// What was found.
    pub outcome: Outcome,
    /// Chunks asked for.
    pub chunks: usize,
    /// Chunks that were in the ledger already.
    pub found_done: usize,
    /// Chunks that are finished now.
    pub done: usize,
    /// Bytes of a torn last line that were dropped.
    pub dropped_bytes: usize,
    /// Processor time, nanoseconds.
    pub cpu_nanoseconds: u64,
}

impl Searched {
    /// What some finished chunks add up to; their meshes are judged again.
    ///
    /// # Errors
    /// [`ProveError::Refused`], [`ProveError::BadParameters`] for a sum that is none.
    pub fn of_records<'r>(records: impl Iterator<Item = &'r Record>, plan: &Plan) -> Result<Self, ProveError> {
        let mut out = Self::default();
        out.add(records, plan)?;
        Ok(out)
    }

    /// Adds up what a ledger holds.
    fn add<'r>(&mut self, records: impl Iterator<Item = &'r Record>, plan: &Plan) -> Result<(), ProveError> {
        for record in records {
            self.outcome.merge(record.outcome(plan)?);
            self.cpu_nanoseconds += record.cpu_nanoseconds;
            self.done += 1;
        }
        Ok(())
    }
}

/// A chunk searched: which, its processor time in nanoseconds, what was found.
type Done = (Chunk, u64, Outcome);

/// Runs chunks on threads; `done` gets each as it is finished, one call at a time, in any order.
fn run_chunks(
    plan: &Plan,
    chunks: &[Chunk],
    threads: usize,
    ctx: &Context<'_>,
    done: &mut (dyn FnMut(Done) -> Result<(), ProveError> + Send),
) -> Result<(), ProveError> {
    let run = |chunk| {
        let clock = CpuClock::start();
        let outcome = plan.run(chunk, ctx)?;
        Ok((chunk, clock.elapsed(), outcome))
    };
    hexfill_ledger::run_chunks(chunks, threads, ctx, &run, done)
}

/// Searches one part of the chunks, or all. With a folder, finished chunks are kept there: the same call goes on where a killed run
/// stopped.
///
/// # Errors
/// [`ProveError::Stopped`], [`ProveError::Refused`], [`ProveError::Ledger`].
pub fn search(
    plan: &Plan,
    part: Chunk,
    chunks: usize,
    folder: Option<&Path>,
    threads: usize,
    ctx: &Context<'_>,
) -> Result<Searched, ProveError> {
    let mut left = chunks_of_part(part, chunks)?;
    let mut out = Searched { chunks: left.len(), ..Searched::default() };
    let Some(folder) = folder else {
        let (sum, cpu) = (&mut out.outcome, &mut out.cpu_nanoseconds);
        run_chunks(plan, &left, threads, ctx, &mut |(_, nanoseconds, outcome)| {
            sum.merge(outcome);
            *cpu += nanoseconds;
            Ok(())
        })?;
        out.done = left.len();
        return Ok(out);
    };
    let header = Header::new(plan.problem(), chunks);
    let mut ledger: Ledger<Header, Record> = Ledger::open(folder, part, &header)?;
    out.found_done = ledger.records().len();
    out.dropped_bytes = ledger.dropped_bytes;
    left.retain(|c| !ledger.records().contains_key(&c.index));
    mixed_order(&mut left);
    run_chunks(plan, &left, threads, ctx, &mut |(chunk, nanoseconds, outcome)| {
        Ok(ledger.append(Record::new(chunk, nanoseconds, &outcome), None)?)
    })?;
    out.add(ledger.records().values(), plan)?;
    Ok(out)
}

/// Adds up the ledgers of a folder for a problem; refuses gaps, overlaps and mixed parameters.
///
/// # Errors
/// [`ProveError::Ledger`], [`ProveError::Refused`].
pub fn merge(plan: &Plan, folder: &Path) -> Result<Searched, ProveError> {
    let merged: Merged<Header, Record> = hexfill_ledger::merge(folder)?;
    let differences = merged.header.differences(&Header::new(plan.problem(), merged.header.chunks));
    if !differences.is_empty() {
        return Err(hexfill_ledger::LedgerError::OtherParameters { path: folder.into(), differences }.into());
    }
    let found_done = merged.records.len();
    Ok(Searched { chunks: merged.header.chunks, found_done, ..Searched::of_records(merged.records.values(), plan)? })
}

/// Searches everything on threads. The outcome does not depend on their number.
///
/// # Errors
/// [`ProveError::Stopped`], [`ProveError::Refused`].
pub fn search_whole(plan: &Plan, threads: usize, ctx: &Context<'_>) -> Result<Outcome, ProveError> {
    Ok(search(plan, Chunk { index: 0, of: 1 }, default_chunks(1), None, threads, ctx)?.outcome)
}
