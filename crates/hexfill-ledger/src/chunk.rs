//! Chunks, the parts of a job array, and the processor time they take.
//!
//! Source: Brinkmann, McKay 2007 (`res/mod`).

use crate::error::LedgerError;
use serde::{Deserialize, Serialize};

/// Chunk `index` of `of`; also part RES of MOD of a job array.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug, Serialize, Deserialize)]
pub struct Chunk {
    /// Which, from 0.
    pub index: usize,
    /// Of how many.
    pub of: usize,
}

/// The chunks of one job of an array: those of `chunks` whose number is `part.index` modulo `part.of`.
///
/// # Errors
/// [`LedgerError::BadParameters`] unless `part.index < part.of <= chunks` and `part.of` divides `chunks`, so that the jobs
/// partition the chunks.
///
/// # Example
/// ```
/// use hexfill_ledger::{Chunk, chunks_of_part};
///
/// // The second of three jobs has a third of twelve chunks.
/// let mine: Vec<usize> = chunks_of_part(Chunk { index: 1, of: 3 }, 12)?.iter().map(|chunk| chunk.index).collect();
/// assert_eq!(mine, [1, 4, 7, 10]);
/// assert!(chunks_of_part(Chunk { index: 1, of: 5 }, 12).is_err()); // five does not divide twelve
/// # Ok::<(), hexfill_ledger::LedgerError>(())
/// ```
pub fn chunks_of_part(part: Chunk, chunks: usize) -> Result<Vec<Chunk>, LedgerError> {
    if part.index >= part.of || chunks == 0 || !chunks.is_multiple_of(part.of) {
        return Err(LedgerError::BadParameters {
            why: format!(
                "part {}/{} of {chunks} chunks: RES must be below MOD, and the number of chunks a multiple of MOD",
                part.index, part.of
            ),
        });
    }
    Ok((part.index..chunks).step_by(part.of).map(|index| Chunk { index, of: chunks }).collect())
}

/// The number of chunks to use for `parts` jobs when the user does not say: at least 1024, so that work spreads evenly, and a multiple
/// of `parts`. It does not depend on the number of threads, so neither does the order of a listing.
pub fn default_chunks(parts: usize) -> usize {
    1024usize.next_multiple_of(parts.max(1))
}

/// Chunks in a mixed order, so that those done of an unfinished run are a fair sample: neighbours are alike.
pub fn mixed_order(chunks: &mut [Chunk]) {
    chunks.sort_by_key(|c| xxhash_rust::xxh3::xxh3_64(&(c.index as u64).to_le_bytes()));
}

/// Processor time of the current thread where the system tells it, else the time that passed.
#[derive(Debug)]
pub struct CpuClock {
    start: Option<u64>,
    wall: std::time::Instant,
}

impl CpuClock {
    /// Starts it.
    pub fn start() -> Self {
        Self { start: thread_nanoseconds(), wall: std::time::Instant::now() }
    }

    /// Nanoseconds since.
    pub fn elapsed(&self) -> u64 {
        match (self.start, thread_nanoseconds()) {
            (Some(start), Some(now)) => now - start,
            _ => self.wall.elapsed().as_nanos() as u64,
        }
    }
}

/// Linux: the first number of the thread's `schedstat`.
fn thread_nanoseconds() -> Option<u64> {
    std::fs::read_to_string("/proc/thread-self/schedstat").ok()?.split(' ').next()?.parse().ok()
}
