//! The ledger of a run in chunks: an append-only file, one line a finished chunk, synced to the disk before the chunk counts as done.
//!
//! Each line is the xxh3-128 of the JSON that follows it; the first line is the header. A killed run loses only the chunks in flight: its
//! last line may be torn, and a line without its end is dropped on reopening. Everything else that does not check is refused, with the
//! line.
//!
//! Source: ours.

use crate::chunk::Chunk;
use crate::error::LedgerError;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::collections::BTreeMap;
use std::fs::{File, OpenOptions};
use std::io::{Read, Seek, Write};
use std::path::{Path, PathBuf};

/// What a ledger is about: chunks of two ledgers add up only if their headers are equal.
pub trait Header: Serialize + DeserializeOwned + Clone {
    /// Number of chunks of the whole.
    fn chunks(&self) -> usize;

    /// Differences to an expected header, in words; empty if equal.
    fn differences(&self, expected: &Self) -> String;
}

/// A finished chunk.
pub trait Record: Serialize + DeserializeOwned {
    /// Number of the chunk.
    fn chunk(&self) -> usize;
}

/// A ledger open for appending, locked against other processes.
#[derive(Debug)]
pub struct Ledger<H, R> {
    path: PathBuf,
    file: File,
    header: H,
    records: BTreeMap<usize, R>,
    /// Bytes of a torn last line that were dropped on opening.
    pub dropped_bytes: usize,
}

/// The ledger file of one process of a job array, in a folder.
pub fn ledger_path(folder: &Path, part: Chunk) -> PathBuf {
    folder.join(format!("ledger-{}-of-{}.txt", part.index, part.of))
}

/// The file of the objects that a chunk lists.
pub fn objects_path(folder: &Path, chunk: Chunk) -> PathBuf {
    folder.join(format!("objects-{}-of-{}.txt", chunk.index, chunk.of))
}

pub(crate) fn io(path: &Path) -> impl FnOnce(std::io::Error) -> LedgerError + '_ {
    move |source| LedgerError::Io { path: path.into(), source }
}

fn line_of<T: Serialize>(value: &T, path: &Path) -> Result<String, LedgerError> {
    let json = serde_json::to_string(value)
        .map_err(|e| LedgerError::Io { path: path.into(), source: std::io::Error::other(e) })?;
    Ok(format!("{:032x} {json}\n", xxhash_rust::xxh3::xxh3_128(json.as_bytes())))
}

fn parse_line<T: DeserializeOwned>(text: &str, path: &Path, line: usize) -> Result<T, LedgerError> {
    let bad = |why: String| LedgerError::BadLedger { path: path.into(), line, why };
    let (sum, json) = text.split_once(' ').ok_or_else(|| bad("it has no checksum".into()))?;
    let found = format!("{:032x}", xxhash_rust::xxh3::xxh3_128(json.as_bytes()));
    if sum != found {
        return Err(bad(format!("its checksum is {found}, but {sum} is written: the line was changed")));
    }
    serde_json::from_str(json).map_err(|e| bad(format!("it cannot be read: {e}")))
}

/// The contents of a ledger: header, records, and the length of the whole lines.
#[allow(clippy::type_complexity)]
fn parse<H: Header, R: Record>(bytes: &[u8], path: &Path) -> Result<(H, BTreeMap<usize, R>, usize), LedgerError> {
    let whole = bytes.iter().rposition(|&b| b == b'\n').map_or(0, |i| i + 1);
    let bad = |line, why: &str| LedgerError::BadLedger { path: path.into(), line, why: why.into() };
    let text = std::str::from_utf8(&bytes[..whole]).map_err(|e| {
        let line = bytes[..e.valid_up_to()].iter().filter(|&&b| b == b'\n').count() + 1;
        bad(line, "it is not UTF-8: the line was changed")
    })?;
    let mut lines = text.lines();
    let header: H = parse_line(lines.next().ok_or_else(|| bad(1, "there is no header"))?, path, 1)?;
    let mut records = BTreeMap::new();
    for (i, line) in lines.enumerate() {
        let record: R = parse_line(line, path, i + 2)?;
        if record.chunk() >= header.chunks() {
            return Err(bad(i + 2, "its chunk number is beyond the number of chunks"));
        }
        if records.insert(record.chunk(), record).is_some() {
            return Err(bad(i + 2, "its chunk is there already"));
        }
    }
    Ok((header, records, whole))
}

/// Reads a ledger without changing it.
///
/// # Errors
/// [`LedgerError::Io`], [`LedgerError::BadLedger`].
pub fn read_ledger<H: Header, R: Record>(path: &Path) -> Result<(H, BTreeMap<usize, R>), LedgerError> {
    let bytes = std::fs::read(path).map_err(io(path))?;
    parse(&bytes, path).map(|(header, records, _)| (header, records))
}

impl<H: Header, R: Record> Ledger<H, R> {
    /// Opens or makes the ledger of one part in a folder.
    ///
    /// # Errors
    /// [`LedgerError::Io`] (also when another process holds it), [`LedgerError::BadLedger`], [`LedgerError::OtherParameters`].
    pub fn open(folder: &Path, part: Chunk, header: &H) -> Result<Self, LedgerError> {
        std::fs::create_dir_all(folder).map_err(io(folder))?;
        let path = ledger_path(folder, part);
        let mut file = OpenOptions::new().read(true).append(true).create(true).open(&path).map_err(io(&path))?;
        file.try_lock().map_err(|_| LedgerError::Io {
            path: path.clone(),
            source: std::io::Error::new(std::io::ErrorKind::WouldBlock, "another process is writing to it"),
        })?;
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).map_err(io(&path))?;
        if !bytes.contains(&b'\n') {
            // New, or killed while writing the header.
            file.set_len(0).map_err(io(&path))?;
            file.write_all(line_of(header, &path)?.as_bytes()).map_err(io(&path))?;
            file.sync_all().map_err(io(&path))?;
            // The folder entry must survive too.
            File::open(folder).and_then(|f| f.sync_all()).map_err(io(folder))?;
            let dropped_bytes = bytes.len();
            return Ok(Self { path, file, header: header.clone(), records: BTreeMap::new(), dropped_bytes });
        }
        let (found, records, whole): (H, _, _) = parse(&bytes, &path)?;
        let differences = found.differences(header);
        if !differences.is_empty() {
            return Err(LedgerError::OtherParameters { path, differences });
        }
        if whole < bytes.len() {
            file.set_len(whole as u64).map_err(io(&path))?;
            file.sync_all().map_err(io(&path))?;
            file.seek(std::io::SeekFrom::End(0)).map_err(io(&path))?;
        }
        Ok(Self { path, file, header: found, records, dropped_bytes: bytes.len() - whole })
    }

    /// The finished chunks.
    pub fn records(&self) -> &BTreeMap<usize, R> {
        &self.records
    }

    /// The header.
    pub fn header(&self) -> &H {
        &self.header
    }

    /// Writes down a finished chunk: first the listed objects, if any, as a file of their own, then the line, each synced. A chunk that is
    /// there already is left as it is.
    ///
    /// # Errors
    /// [`LedgerError::Io`].
    pub fn append(&mut self, record: R, objects: Option<&str>) -> Result<(), LedgerError> {
        let index = record.chunk();
        if self.records.contains_key(&index) {
            return Ok(());
        }
        if let Some(text) = objects {
            let folder = self.path.parent().unwrap_or(Path::new("."));
            write_whole(&objects_path(folder, Chunk { index, of: self.header.chunks() }), text.as_bytes())?;
        }
        self.file.write_all(line_of(&record, &self.path)?.as_bytes()).map_err(io(&self.path))?;
        self.file.sync_data().map_err(io(&self.path))?;
        self.records.insert(index, record);
        Ok(())
    }
}

/// Writes beside the target, syncs, renames.
fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), LedgerError> {
    let beside = path.with_extension("part");
    let mut file = File::create(&beside).map_err(io(&beside))?;
    file.write_all(bytes).map_err(io(&beside))?;
    file.sync_all().map_err(io(&beside))?;
    std::fs::rename(&beside, path).map_err(io(path))
}
