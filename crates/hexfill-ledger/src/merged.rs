//! Ledgers of one run, read together: gaps, overlaps and mixed parameters are refused.
//!
//! Source: ours.

use crate::chunk::Chunk;
use crate::error::LedgerError;
use crate::ledger::{Header, Record, objects_path, read_ledger};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Ledgers of one run, read together.
#[derive(Clone, Debug)]
pub struct Merged<H, R> {
    /// The common header.
    pub header: H,
    /// Per finished chunk its record.
    pub records: BTreeMap<usize, R>,
    folder: PathBuf,
}

/// Reads all ledgers of a folder, or one ledger file.
///
/// # Errors
/// [`LedgerError::Io`], [`LedgerError::BadLedger`]; [`LedgerError::OtherParameters`] if two differ;
/// [`LedgerError::Incomplete`] if a chunk is in two ledgers or there is no ledger.
pub fn read_ledgers<H: Header, R: Record>(path: &Path) -> Result<Merged<H, R>, LedgerError> {
    let (folder, files) = if path.is_dir() {
        let mut files = Vec::new();
        for entry in std::fs::read_dir(path).map_err(crate::ledger::io(path))? {
            let file = entry.map_err(crate::ledger::io(path))?.path();
            let name = file.file_name().and_then(|n| n.to_str()).unwrap_or_default();
            if name.starts_with("ledger-") && name.ends_with(".txt") {
                files.push(file);
            }
        }
        files.sort();
        (path.to_path_buf(), files)
    } else {
        (path.parent().unwrap_or(Path::new(".")).to_path_buf(), vec![path.to_path_buf()])
    };
    let mut merged: Option<Merged<H, R>> = None;
    let mut home: BTreeMap<usize, &Path> = BTreeMap::new();
    let mut overlaps = Vec::new();
    for file in &files {
        let (header, records): (H, BTreeMap<usize, R>) = read_ledger(file)?;
        let merged = merged.get_or_insert_with(|| Merged {
            header: header.clone(),
            records: BTreeMap::new(),
            folder: folder.clone(),
        });
        let differences = header.differences(&merged.header);
        if !differences.is_empty() {
            return Err(LedgerError::OtherParameters { path: file.clone(), differences });
        }
        for (chunk, record) in records {
            if let Some(other) = home.insert(chunk, file) {
                overlaps.push(format!("chunk {chunk} is in {} and in {}", other.display(), file.display()));
            }
            merged.records.insert(chunk, record);
        }
    }
    if !overlaps.is_empty() {
        return Err(LedgerError::Incomplete { why: first_ten(&overlaps) });
    }
    merged.ok_or_else(|| LedgerError::Incomplete { why: format!("there is no ledger in {}", path.display()) })
}

/// As [`read_ledgers`], and all chunks must be there.
///
/// # Errors
/// As [`read_ledgers`], and [`LedgerError::Incomplete`] with the missing chunks.
pub fn merge<H: Header, R: Record>(path: &Path) -> Result<Merged<H, R>, LedgerError> {
    let merged = read_ledgers(path)?;
    let missing: Vec<String> = merged.missing().map(|k| k.to_string()).collect();
    if missing.is_empty() {
        return Ok(merged);
    }
    let why = format!("{} of {} chunks are missing: {}", missing.len(), merged.header.chunks(), first_ten(&missing));
    Err(LedgerError::Incomplete { why })
}

fn first_ten(items: &[String]) -> String {
    let mut text = items.iter().take(10).cloned().collect::<Vec<_>>().join(", ");
    if items.len() > 10 {
        text.push_str(&format!(" and {} more", items.len() - 10));
    }
    text
}

impl<H: Header, R: Record> Merged<H, R> {
    /// Chunks that are not finished.
    pub fn missing(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.header.chunks()).filter(|k| !self.records.contains_key(k))
    }

    /// The file of the objects that a chunk lists.
    pub fn objects_path(&self, index: usize) -> PathBuf {
        objects_path(&self.folder, Chunk { index, of: self.header.chunks() })
    }
}
