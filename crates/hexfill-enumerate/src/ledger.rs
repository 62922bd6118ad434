//! What the enumeration writes into its ledger (see `hexfill-ledger`): parameters, counts a chunk, listed codes beside it.
//!
//! Source: ours.

use crate::canonical::{Code, FORM_VERSION};
use crate::chunk::{Chunk, ChunkResult};
use crate::error::EnumerateError;
use crate::params::Params;
use crate::tally::Tally;
use hexfill_ledger as ledgers;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;

pub use hexfill_ledger::ledger_path;

/// Version of the ledger's format.
const FORMAT: u32 = 1;

/// What a ledger is about: chunks of two ledgers add up only if these are equal.
#[derive(Clone, PartialEq, Eq, Debug, Serialize, Deserialize)]
pub struct Header {
    /// Version of the format of the file.
    pub ledger: u32,
    /// Version of the canonical form, which the hash sums depend on.
    pub form: u32,
    /// What is enumerated.
    pub params: Params,
    /// The selection in words; empty: everything.
    pub selection: String,
    /// Whether the selected codes are kept beside the ledger.
    pub listed: bool,
    /// Names of the targets looked for.
    pub targets: Vec<String>,
    /// Number of chunks.
    pub chunks: usize,
}

impl Header {
    /// The header of a run.
    pub fn new(params: &Params, selection: String, listed: bool, targets: Vec<String>, chunks: usize) -> Self {
        Self { ledger: FORMAT, form: FORM_VERSION, params: *params, selection, listed, targets, chunks }
    }
}

impl hexfill_ledger::Header for Header {
    fn chunks(&self) -> usize {
        self.chunks
    }

    fn differences(&self, expected: &Self) -> String {
        let mut out = self.params.differences(&expected.params);
        let mut compare = |name: &str, found: String, wanted: String| {
            if found != wanted {
                let gap = if out.is_empty() { "" } else { "; " };
                out.push_str(&format!("{gap}{name} is {found:?}, not {wanted:?}"));
            }
        };
        compare("ledger format", self.ledger.to_string(), expected.ledger.to_string());
        compare("canonical form", self.form.to_string(), expected.form.to_string());
        compare("selection", self.selection.clone(), expected.selection.clone());
        compare("listing", self.listed.to_string(), expected.listed.to_string());
        compare("targets", self.targets.join(" "), expected.targets.join(" "));
        compare("number of chunks", self.chunks.to_string(), expected.chunks.to_string());
        out
    }
}

/// A finished chunk.
#[derive(Clone, PartialEq, Eq, Debug, Serialize, Deserialize)]
pub struct Record {
    /// Number of the chunk.
    pub chunk: usize,
    /// Processor time, nanoseconds.
    pub cpu_nanoseconds: u64,
    /// The counts.
    pub tally: Tally,
    /// Recognised targets: name and code.
    pub targets: Vec<(String, String)>,
}

impl ledgers::Record for Record {
    fn chunk(&self) -> usize {
        self.chunk
    }
}

/// A ledger open for appending, locked against other processes.
#[derive(Debug)]
pub struct Ledger {
    inner: ledgers::Ledger<Header, Record>,
    /// Bytes of a torn last line that were dropped on opening.
    pub dropped_bytes: usize,
}

/// Reads a ledger without changing it.
///
/// # Errors
/// [`EnumerateError::Io`], [`EnumerateError::BadLedger`].
pub fn read_ledger(path: &Path) -> Result<(Header, BTreeMap<usize, Record>), EnumerateError> {
    Ok(ledgers::read_ledger(path)?)
}

impl Ledger {
    /// Opens or makes the ledger of one part in a folder.
    ///
    /// # Errors
    /// [`EnumerateError::Io`] (also when another process holds it), [`EnumerateError::BadLedger`],
    /// [`EnumerateError::OtherParameters`].
    pub fn open(folder: &Path, part: Chunk, header: &Header) -> Result<Self, EnumerateError> {
        let inner = ledgers::Ledger::open(folder, part, header)?;
        Ok(Self { dropped_bytes: inner.dropped_bytes, inner })
    }

    /// The finished chunks.
    pub fn records(&self) -> &BTreeMap<usize, Record> {
        self.inner.records()
    }

    /// Writes down a finished chunk: first the listed codes as a file of their own, then the line, each synced.
    ///
    /// # Errors
    /// [`EnumerateError::Io`].
    pub fn append(&mut self, result: &ChunkResult) -> Result<(), EnumerateError> {
        let header = self.inner.header();
        let listed = header.listed;
        let name = |i: usize| header.targets.get(i).cloned().unwrap_or_default();
        let targets = result.found.targets.iter().map(|(i, code)| (name(*i), code.to_text())).collect();
        let (chunk, cpu_nanoseconds) = (result.chunk.index, result.cpu_nanoseconds);
        let record = Record { chunk, cpu_nanoseconds, tally: result.tally.clone(), targets };
        let objects = || result.found.selected.iter().map(|c| c.to_text() + "\n").collect::<String>();
        Ok(self.inner.append(record, listed.then(objects).as_deref())?)
    }
}

/// Ledgers of one run, read together.
#[derive(Clone, Debug)]
pub struct Merged(ledgers::Merged<Header, Record>);

impl std::ops::Deref for Merged {
    type Target = ledgers::Merged<Header, Record>;

    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

/// Reads all ledgers of a folder, or one ledger file.
///
/// # Errors
/// [`EnumerateError::Io`], [`EnumerateError::BadLedger`]; [`EnumerateError::OtherParameters`] if two differ;
/// [`EnumerateError::Incomplete`] if a chunk is in two ledgers or there is no ledger.
pub fn read_ledgers(path: &Path) -> Result<Merged, EnumerateError> {
    Ok(Merged(ledgers::read_ledgers(path)?))
}

/// As [`read_ledgers`], and all chunks must be there.
///
/// # Errors
/// As [`read_ledgers`], and [`EnumerateError::Incomplete`] with the missing chunks.
pub fn merge(path: &Path) -> Result<Merged, EnumerateError> {
    Ok(Merged(ledgers::merge(path)?))
}

impl Merged {
    /// Sum of the counts.
    pub fn tally(&self) -> Tally {
        let mut out = Tally::default();
        for record in self.records.values() {
            out.merge(&record.tally);
        }
        out
    }

    /// Sum of the processor times, nanoseconds.
    pub fn cpu_nanoseconds(&self) -> u64 {
        self.records.values().map(|r| r.cpu_nanoseconds).sum()
    }

    /// Projected number of classes of the whole and its standard error, from the finished chunks taken as a random sample; `None`
    /// for fewer than two.
    pub fn projection(&self) -> Option<(f64, f64)> {
        let (m, all) = (self.records.len() as f64, self.header.chunks as f64);
        if m < 2.0 {
            return None;
        }
        let mean = self.records.values().map(|r| r.tally.classes as f64).sum::<f64>() / m;
        let square: f64 = self.records.values().map(|r| (r.tally.classes as f64 - mean).powi(2)).sum();
        let error = (square / (m - 1.0) / m * (1.0 - m / all)).sqrt();
        Some((mean * all, error * all))
    }

    /// The listed codes in the order of the chunks, given one by one.
    ///
    /// # Errors
    /// [`EnumerateError::Io`] or [`EnumerateError::BadCode`] for a file that is missing or changed, and the error of `each`.
    pub fn for_each_listed(
        &self,
        each: &mut dyn FnMut(Code) -> Result<(), EnumerateError>,
    ) -> Result<(), EnumerateError> {
        if !self.header.listed {
            return Err(EnumerateError::BadParameters { why: "this run only counted: it kept no list".into() });
        }
        for (&index, record) in &self.records {
            let path = self.objects_path(index);
            let text =
                std::fs::read_to_string(&path).map_err(|source| EnumerateError::Io { path: path.clone(), source })?;
            if text.lines().count() as u64 != record.tally.selected {
                return Err(EnumerateError::BadLedger {
                    path,
                    line: 1,
                    why: format!("{} codes listed, {} were found", text.lines().count(), record.tally.selected),
                });
            }
            for line in text.lines() {
                each(line.parse()?)?;
            }
        }
        Ok(())
    }

    /// Checks what can be checked without enumerating again: histograms that add up, and the mass formula. Returns the
    /// findings in words; empty if all is well.
    pub fn inconsistencies(&self) -> Vec<String> {
        let mut out = Vec::new();
        for (k, record) in &self.records {
            let t = &record.tally;
            let sums = [
                ("chords", t.chords.total()),
                ("boundary quads", t.boundary_quads.total()),
                ("vertices", t.vertices.total()),
                ("automorphisms", t.automorphisms.total()),
                ("Euler characteristics", t.euler.total()),
                ("genera", t.boundary_genera.total()),
            ];
            for (name, sum) in sums {
                if sum != t.classes {
                    out.push(format!("chunk {k}: the histogram of {name} has {sum} classes, not {}", t.classes));
                }
            }
            if t.raw_by_glued.total() != t.raw {
                out.push(format!("chunk {k}: the raw counts do not add up"));
            }
        }
        let complete = self.missing().next().is_none();
        if complete && self.header.params.cubes > 1 && !self.tally().mass_balances() {
            out.push("the mass formula does not balance".into());
        }
        out
    }
}
