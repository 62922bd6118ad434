//! Work in chunks that survives being killed.
//!
//! Long work that falls into numbered [chunks](Chunk) keeps a [`Ledger`]: an append-only file, one line a finished chunk, synced to the
//! disk before the chunk counts as done. Jobs of an array take the chunks whose number is RES modulo MOD and write a ledger each into one
//! folder; [`read_ledgers`] and [`merge`] put them together. What is done, and what a chunk found, is the caller's: types for the
//! [header](Header) and the [records](Record).

mod chunk;
mod error;
mod ledger;
mod merged;
mod threads;

pub use chunk::{Chunk, CpuClock, chunks_of_part, default_chunks, mixed_order};
pub use error::LedgerError;
pub use ledger::{Header, Ledger, Record, ledger_path, objects_path, read_ledger};
pub use merged::{Merged, merge, read_ledgers};
pub use threads::{run_chunks, run_on};
