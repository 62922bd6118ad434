//! The ledger of a run in chunks: an append-only file, one line a finished chunk, synced to the disk before the chunk counts as done.
//!
//! Each line is the xxh3-128 of the JSON that follows it; the first line is the header: parameters, selection and number of chunks.
//! A killed run loses only the chunks in flight: its last line may be torn, and a line without its end is dropped on
//! reopening. Everything else that does not check is refused, with the line. Several processes (a job array) write one file each into
//! the same folder; [`merge`] adds them up and refuses gaps, overlaps and mixed parameters.

use crate::canonical::{Code, FORM_VERSION};
use crate::chunk::{Chunk, ChunkResult};
use crate::error::EnumerateError;
use crate::params::Params;
use crate::tally::Tally;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs::{File, OpenOptions};
use std::io::{Read, Seek, Write};
use std::path::{Path, PathBuf};

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

    /// Differences to an expected header, in words; empty if equal.
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

/// A ledger open for appending, locked against other processes.
#[derive(Debug)]
pub struct Ledger {
    path: PathBuf,
    file: File,
    header: Header,
    records: BTreeMap<usize, Record>,
    /// Bytes of a torn last line that were dropped on opening.
    pub dropped_bytes: usize,
}

/// The ledger file of one process of a job array, in a folder.
pub fn ledger_path(folder: &Path, part: Chunk) -> PathBuf {
    folder.join(format!("ledger-{}-of-{}.txt", part.index, part.of))
}

fn io(path: &Path) -> impl FnOnce(std::io::Error) -> EnumerateError + '_ {
    move |source| EnumerateError::Io { path: path.into(), source }
}

fn line_of<T: Serialize>(value: &T, path: &Path) -> Result<String, EnumerateError> {
    let json = serde_json::to_string(value)
        .map_err(|e| EnumerateError::Io { path: path.into(), source: std::io::Error::other(e) })?;
    Ok(format!("{:032x} {json}\n", xxhash_rust::xxh3::xxh3_128(json.as_bytes())))
}

fn parse_line<'a, T: Deserialize<'a>>(text: &'a str, path: &Path, line: usize) -> Result<T, EnumerateError> {
    let bad = |why: String| EnumerateError::BadLedger { path: path.into(), line, why };
    let (sum, json) = text.split_once(' ').ok_or_else(|| bad("it has no checksum".into()))?;
    let found = format!("{:032x}", xxhash_rust::xxh3::xxh3_128(json.as_bytes()));
    if sum != found {
        return Err(bad(format!("its checksum is {found}, but {sum} is written: the line was changed")));
    }
    serde_json::from_str(json).map_err(|e| bad(format!("it cannot be read: {e}")))
}

/// The contents of a ledger: header, records, and the length of the whole lines.
fn parse(bytes: &[u8], path: &Path) -> Result<(Header, BTreeMap<usize, Record>, usize), EnumerateError> {
    let whole = bytes.iter().rposition(|&b| b == b'\n').map_or(0, |i| i + 1);
    let bad = |line, why: &str| EnumerateError::BadLedger { path: path.into(), line, why: why.into() };
    let text = std::str::from_utf8(&bytes[..whole]).map_err(|e| {
        let line = bytes[..e.valid_up_to()].iter().filter(|&&b| b == b'\n').count() + 1;
        bad(line, "it is not UTF-8: the line was changed")
    })?;
    let mut lines = text.lines();
    let header: Header = parse_line(lines.next().ok_or_else(|| bad(1, "there is no header"))?, path, 1)?;
    let mut records = BTreeMap::new();
    for (i, line) in lines.enumerate() {
        let record: Record = parse_line(line, path, i + 2)?;
        if record.chunk >= header.chunks {
            return Err(bad(i + 2, "its chunk number is beyond the number of chunks"));
        }
        if records.insert(record.chunk, record).is_some() {
            return Err(bad(i + 2, "its chunk is there already"));
        }
    }
    Ok((header, records, whole))
}

/// Reads a ledger without changing it.
///
/// # Errors
/// [`EnumerateError::Io`], [`EnumerateError::BadLedger`].
pub fn read_ledger(path: &Path) -> Result<(Header, BTreeMap<usize, Record>), EnumerateError> {
    let bytes = std::fs::read(path).map_err(io(path))?;
    parse(&bytes, path).map(|(header, records, _)| (header, records))
}

impl Ledger {
    /// Opens or makes the ledger of one part in a folder.
    ///
    /// # Errors
    /// [`EnumerateError::Io`] (also when another process holds it), [`EnumerateError::BadLedger`],
    /// [`EnumerateError::OtherParameters`].
    pub fn open(folder: &Path, part: Chunk, header: &Header) -> Result<Self, EnumerateError> {
        std::fs::create_dir_all(folder).map_err(io(folder))?;
        let path = ledger_path(folder, part);
        let mut file = OpenOptions::new().read(true).append(true).create(true).open(&path).map_err(io(&path))?;
        file.try_lock().map_err(|_| EnumerateError::Io {
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
        let (found, records, whole) = parse(&bytes, &path)?;
        let differences = found.differences(header);
        if !differences.is_empty() {
            return Err(EnumerateError::OtherParameters { path, differences });
        }
        if whole < bytes.len() {
            file.set_len(whole as u64).map_err(io(&path))?;
            file.sync_all().map_err(io(&path))?;
            file.seek(std::io::SeekFrom::End(0)).map_err(io(&path))?;
        }
        Ok(Self { path, file, header: found, records, dropped_bytes: bytes.len() - whole })
    }

    /// The finished chunks.
    pub fn records(&self) -> &BTreeMap<usize, Record> {
        &self.records
    }

    /// Writes down a finished chunk: first the listed codes as a file of their own, then the line, each synced.
    ///
    /// # Errors
    /// [`EnumerateError::Io`].
    pub fn append(&mut self, result: &ChunkResult) -> Result<(), EnumerateError> {
        let index = result.chunk.index;
        if self.records.contains_key(&index) {
            return Ok(());
        }
        if self.header.listed {
            let folder = self.path.parent().unwrap_or(Path::new("."));
            let text: String = result.found.selected.iter().map(|c| c.to_text() + "\n").collect();
            write_whole(&objects_path(folder, result.chunk), text.as_bytes())?;
        }
        let targets = result
            .found
            .targets
            .iter()
            .map(|(i, code)| (self.header.targets.get(*i).cloned().unwrap_or_default(), code.to_text()))
            .collect();
        let record =
            Record { chunk: index, cpu_nanoseconds: result.cpu_nanoseconds, tally: result.tally.clone(), targets };
        self.file.write_all(line_of(&record, &self.path)?.as_bytes()).map_err(io(&self.path))?;
        self.file.sync_data().map_err(io(&self.path))?;
        self.records.insert(index, record);
        Ok(())
    }
}

/// The listed codes of a chunk.
fn objects_path(folder: &Path, chunk: Chunk) -> PathBuf {
    folder.join(format!("objects-{}-of-{}.txt", chunk.index, chunk.of))
}

/// Writes beside the target, syncs, renames.
fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), EnumerateError> {
    let beside = path.with_extension("part");
    let mut file = File::create(&beside).map_err(io(&beside))?;
    file.write_all(bytes).map_err(io(&beside))?;
    file.sync_all().map_err(io(&beside))?;
    std::fs::rename(&beside, path).map_err(io(path))
}

/// Ledgers of one run, read together.
#[derive(Clone, Debug)]
pub struct Merged {
    /// The common header.
    pub header: Header,
    /// Per finished chunk its record.
    pub records: BTreeMap<usize, Record>,
    folder: PathBuf,
}

/// Reads all ledgers of a folder, or one ledger file.
///
/// # Errors
/// [`EnumerateError::Io`], [`EnumerateError::BadLedger`]; [`EnumerateError::OtherParameters`] if two differ;
/// [`EnumerateError::Incomplete`] if a chunk is in two ledgers or there is no ledger.
pub fn read_ledgers(path: &Path) -> Result<Merged, EnumerateError> {
    let (folder, files) = if path.is_dir() {
        let mut files = Vec::new();
        for entry in std::fs::read_dir(path).map_err(io(path))? {
            let file = entry.map_err(io(path))?.path();
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
    let mut merged: Option<Merged> = None;
    let mut home: BTreeMap<usize, &Path> = BTreeMap::new();
    let mut overlaps = Vec::new();
    for file in &files {
        let (header, records) = read_ledger(file)?;
        let merged = merged.get_or_insert_with(|| Merged {
            header: header.clone(),
            records: BTreeMap::new(),
            folder: folder.clone(),
        });
        let differences = header.differences(&merged.header);
        if !differences.is_empty() {
            return Err(EnumerateError::OtherParameters { path: file.clone(), differences });
        }
        for (chunk, record) in records {
            if let Some(other) = home.insert(chunk, file) {
                overlaps.push(format!("chunk {chunk} is in {} and in {}", other.display(), file.display()));
            }
            merged.records.insert(chunk, record);
        }
    }
    if !overlaps.is_empty() {
        return Err(EnumerateError::Incomplete { why: first_ten(&overlaps) });
    }
    merged.ok_or_else(|| EnumerateError::Incomplete { why: format!("there is no ledger in {}", path.display()) })
}

/// As [`read_ledgers`], and all chunks must be there.
///
/// # Errors
/// As [`read_ledgers`], and [`EnumerateError::Incomplete`] with the missing chunks.
pub fn merge(path: &Path) -> Result<Merged, EnumerateError> {
    let merged = read_ledgers(path)?;
    let missing: Vec<String> = merged.missing().map(|k| k.to_string()).collect();
    if missing.is_empty() {
        return Ok(merged);
    }
    let why = format!("{} of {} chunks are missing: {}", missing.len(), merged.header.chunks, first_ten(&missing));
    Err(EnumerateError::Incomplete { why })
}

fn first_ten(items: &[String]) -> String {
    let mut text = items.iter().take(10).cloned().collect::<Vec<_>>().join(", ");
    if items.len() > 10 {
        text.push_str(&format!(" and {} more", items.len() - 10));
    }
    text
}

impl Merged {
    /// Chunks that are not finished.
    pub fn missing(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.header.chunks).filter(|k| !self.records.contains_key(k))
    }

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
            let path = objects_path(&self.folder, Chunk { index, of: self.header.chunks });
            let text = std::fs::read_to_string(&path).map_err(io(&path))?;
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
