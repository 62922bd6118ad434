//! Drivers over the chunk function: threads, with or without a ledger.
//!
//! Source: ours.

use crate::chunk::{Chunk, ChunkResult, Plan};
use crate::error::EnumerateError;
use crate::ledger::{Header, Ledger};
use crate::tally::Tally;
use crate::targets::{Found, Wanted};
use hexfill_ledger::{default_chunks, mixed_order};
use hexfill_mesh::Context;
use std::collections::BTreeMap;
use std::path::Path;

/// As [`hexfill_ledger::chunks_of_part`].
///
/// # Errors
/// [`EnumerateError::BadParameters`].
pub fn chunks_of_part(part: Chunk, chunks: usize) -> Result<Vec<Chunk>, EnumerateError> {
    Ok(hexfill_ledger::chunks_of_part(part, chunks)?)
}

/// Gives results on in the order of their chunks, holding back those that come too early.
struct InOrder<'a> {
    expected: std::iter::Copied<std::slice::Iter<'a, Chunk>>,
    next: Option<Chunk>,
    waiting: BTreeMap<Chunk, ChunkResult>,
    give: &'a mut (dyn FnMut(ChunkResult) -> Result<(), EnumerateError> + Send),
}

impl InOrder<'_> {
    fn take(&mut self, result: ChunkResult) -> Result<(), EnumerateError> {
        self.waiting.insert(result.chunk, result);
        while let Some(result) = self.next.and_then(|chunk| self.waiting.remove(&chunk)) {
            self.next = self.expected.next();
            (self.give)(result)?;
        }
        Ok(())
    }
}

/// Runs some chunks on threads and gives the results on in the order of the chunks.
///
/// # Errors
/// Those of [`Plan::run`] and of `give`.
pub fn run_in_order(
    plan: &Plan,
    chunks: &[Chunk],
    threads: usize,
    wanted: Wanted<'_>,
    ctx: &Context<'_>,
    give: &mut (dyn FnMut(ChunkResult) -> Result<(), EnumerateError> + Send),
) -> Result<(), EnumerateError> {
    let mut expected = chunks.iter().copied();
    let next = expected.next();
    let mut order = InOrder { expected, next, waiting: BTreeMap::new(), give };
    plan.run_all(chunks, threads, wanted, ctx, &mut |result| order.take(result))
}

/// What a checkpointed run did.
#[derive(Clone, Debug)]
pub struct Checkpointed {
    /// Chunks of this part.
    pub chunks: usize,
    /// Chunks that were in the ledger already.
    pub found_done: usize,
    /// Bytes of a torn last line that were dropped.
    pub dropped_bytes: usize,
    /// Sum over all chunks of this part.
    pub tally: Tally,
    /// Processor time over all chunks of this part, nanoseconds.
    pub cpu_nanoseconds: u64,
}

/// Runs the chunks of one part that its ledger does not have yet. May be killed at any time and started again.
///
/// # Errors
/// Those of [`Plan::run`] and [`Ledger`]; what was finished before is in the ledger.
pub fn run_checkpointed(
    plan: &Plan,
    folder: &Path,
    part: Chunk,
    header: &Header,
    threads: usize,
    wanted: Wanted<'_>,
    ctx: &Context<'_>,
) -> Result<Checkpointed, EnumerateError> {
    let chunks = chunks_of_part(part, header.chunks)?;
    let mut ledger = Ledger::open(folder, part, header)?;
    let found_done = ledger.records().len();
    let mut left: Vec<Chunk> = chunks.iter().copied().filter(|c| !ledger.records().contains_key(&c.index)).collect();
    mixed_order(&mut left);
    plan.run_all(&left, threads, wanted, ctx, &mut |result| ledger.append(&result))?;
    let mut tally = Tally::default();
    let mut cpu_nanoseconds = 0;
    for record in ledger.records().values() {
        tally.merge(&record.tally);
        cpu_nanoseconds += record.cpu_nanoseconds;
    }
    Ok(Checkpointed { chunks: chunks.len(), found_done, dropped_bytes: ledger.dropped_bytes, tally, cpu_nanoseconds })
}

/// Runs all chunks on threads and adds them up: the whole enumeration by canonical augmentation.
///
/// # Errors
/// Those of [`Plan::run`].
pub fn run_whole(
    plan: &Plan,
    threads: usize,
    wanted: Wanted<'_>,
    ctx: &Context<'_>,
) -> Result<(Tally, Found), EnumerateError> {
    let chunks = chunks_of_part(Chunk { index: 0, of: 1 }, default_chunks(1))?;
    let mut tally = Tally::default();
    let mut found = Found::default();
    run_in_order(plan, &chunks, threads, wanted, ctx, &mut |result| {
        tally.merge(&result.tally);
        found.merge(result.found);
        Ok(())
    })?;
    Ok((tally, found))
}
