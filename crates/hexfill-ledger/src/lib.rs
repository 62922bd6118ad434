//! Work in chunks that survives being killed.
//!
//! Long work that falls into numbered [chunks](Chunk) keeps a [`Ledger`]: an append-only file, one line a finished chunk, synced to the
//! disk before the chunk counts as done. Jobs of an array take the chunks whose number is RES modulo MOD and write a ledger each into one
//! folder; [`read_ledgers`] and [`merge`] put them together. What is done, and what a chunk found, is the caller's: types for the
//! [header](Header) and the [records](Record).
//!
//! Not for a few quick chunks: every chunk costs a sync of the disk, some milliseconds, so a chunk should be a second of work or more. Not for results of any
//! size either: all records of a ledger are read into memory when it is opened.
//!
//! Invariants: a chunk counts as done only once its line is on the disk; a torn last line is dropped and anything else that does not check is refused with
//! its line; ledgers with different headers never add up, and a merge with gaps or overlaps is refused; a ledger has one writer at a time (a lock); what is
//! merged does not depend on threads, on the order of the chunks, nor on how often a run was killed. Papers: Brinkmann, McKay 2007 (the parts `res/mod` of a
//! job array); the key is that of the book's bibliography.
//!
//! ```
//! use hexfill_ledger::{Chunk, Header, Ledger, Record};
//! use serde::{Deserialize, Serialize};
//!
//! #[derive(Clone, Serialize, Deserialize)]
//! struct Squares { below: u64, chunks: usize }
//! impl Header for Squares {
//!     fn chunks(&self) -> usize { self.chunks }
//!     fn differences(&self, expected: &Self) -> String {
//!         if self.below == expected.below { String::new() } else { format!("below {}, not {}", self.below, expected.below) }
//!     }
//! }
//! #[derive(Serialize, Deserialize)]
//! struct Sum { chunk: usize, sum: u64 }
//! impl Record for Sum {
//!     fn chunk(&self) -> usize { self.chunk }
//! }
//!
//! let folder = std::env::temp_dir().join(format!("squares-{}", std::process::id()));
//! let (all, header) = (Chunk { index: 0, of: 1 }, Squares { below: 100, chunks: 2 });
//! let mut ledger: Ledger<Squares, Sum> = Ledger::open(&folder, all, &header)?;
//! ledger.append(Sum { chunk: 0, sum: (0..50).map(|x| x * x).sum() }, None)?;
//! drop(ledger); // killed here, and started again:
//! let ledger: Ledger<Squares, Sum> = Ledger::open(&folder, all, &header)?;
//! assert!(ledger.records().contains_key(&0) && !ledger.records().contains_key(&1));
//! # std::fs::remove_dir_all(&folder)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

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
