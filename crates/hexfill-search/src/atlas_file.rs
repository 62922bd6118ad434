//! The *log* that a growth appends to, level by level.
//!
//! Header (magic, cap, width), then one record a level: level, children, thinned, number of states, the states
//! (parent `u32`, flip 2 bytes, class hash 5 bytes), xxh3-64 of all that. A level is written in one go and synced, so a
//! killed growth loses the level in flight; a torn last record is cut off on resuming.
//! All numbers little-endian. The *packed* form of an atlas is another file ([`crate::atlas_packed`]).
//!
//! Source: ours.

use crate::atlas::{Atlas, short_hash};
use crate::atlas_packed::PACKED_MAGIC;
use crate::flip::Flip;
use crate::grow::{GrowOptions, Growth, LevelReport};
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use xxhash_rust::xxh3::xxh3_64;

const LOG_MAGIC: &[u8; 8] = b"HXGROW01";
const HASH_BYTES: usize = 5;
const STATE_BYTES: usize = 4 + 2 + HASH_BYTES;
const HEADER_BYTES: usize = 8 + 4 + 4;
const RECORD_HEADER_BYTES: usize = 4 + 8 + 8 + 8;

/// Why an atlas file cannot be used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum AtlasError {
    /// Reading or writing failed.
    #[error("{path}: {source}")]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// Not an atlas file.
    #[error("{path} is not a hexfill atlas; build one with `hexfill atlas build -o FILE`")]
    NotAnAtlas {
        /// The file.
        path: PathBuf,
    },
    /// A checksum or a value is wrong.
    #[error("{path} is damaged at byte {offset}: {what}; delete it and build it again")]
    Damaged {
        /// The file.
        path: PathBuf,
        /// Where.
        offset: u64,
        /// What is wrong.
        what: &'static str,
    },
    /// The log belongs to a growth with other options.
    #[error("{path} was grown with cap {} and width {}, not cap {} and width {}; use the same options or another file", given.cap, given.width, wanted.cap, wanted.width)]
    OtherOptions {
        /// The file.
        path: PathBuf,
        /// What the file says.
        given: GrowOptions,
        /// What was asked for.
        wanted: GrowOptions,
    },
    /// Another process is growing this atlas.
    #[error("{path} is in use by another process")]
    Locked {
        /// The file.
        path: PathBuf,
    },
}

fn io_error(path: &Path) -> impl Fn(io::Error) -> AtlasError + '_ {
    |source| AtlasError::Io { path: path.to_owned(), source }
}

/// One level as the log holds it.
struct Record {
    /// Classes left out.
    thinned: u64,
    parents: Vec<u32>,
    flips: Vec<Flip>,
    hashes: Vec<u64>,
}

/// The log of a growth, open for appending (and locked against a second writer).
pub struct GrowthLog {
    file: File,
    path: PathBuf,
    thinned: u64,
    dropped_bytes: usize,
}

impl GrowthLog {
    /// Classes left out on all its levels: if any, the growth proves no bound.
    pub fn thinned(&self) -> u64 {
        self.thinned
    }

    /// Bytes of a torn last level that were cut off.
    pub fn dropped_bytes(&self) -> usize {
        self.dropped_bytes
    }

    /// Opens the log at `path`, or starts it, and brings the growth up to the last whole level in it.
    ///
    /// # Errors
    /// [`AtlasError`] if the file is no log, is damaged before its last record, belongs to other options, or is in use.
    pub fn open(path: &Path, options: GrowOptions) -> Result<(Self, Growth), AtlasError> {
        let fail = io_error(path);
        let mut file = OpenOptions::new().read(true).append(true).create(true).open(path).map_err(&fail)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(AtlasError::Locked { path: path.to_owned() }),
            Err(TryLockError::Error(source)) => return Err(fail(source)),
        }
        let mut growth = Growth::new(options);
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).map_err(&fail)?;
        if bytes.len() < HEADER_BYTES {
            let header = header_bytes(growth.options());
            if !header.starts_with(&bytes) {
                return Err(AtlasError::NotAnAtlas { path: path.to_owned() });
            }
            file.set_len(0).map_err(&fail)?;
            file.write_all(&header).map_err(&fail)?;
            file.sync_data().map_err(&fail)?;
            return Ok((Self { file, path: path.to_owned(), thinned: 0, dropped_bytes: 0 }, growth));
        }
        let given = parse_header(&bytes, path)?;
        if given != growth.options() {
            return Err(AtlasError::OtherOptions { path: path.to_owned(), given, wanted: growth.options() });
        }
        let (mut at, mut thinned) = (HEADER_BYTES, 0);
        // Every flip is made again and judged legal again: a log that was edited is refused at the record it was
        // edited in.
        while let Some((record, end)) = parse_record(&bytes, at, growth.level() + 1, path)? {
            let damaged = |what| AtlasError::Damaged { path: path.to_owned(), offset: at as u64, what };
            growth
                .replay_level(&record.parents, &record.flips)
                .ok_or_else(|| damaged("a flip is not legal on its parent"))?;
            thinned += record.thinned;
            at = end;
        }
        // A torn last record: the level in flight when the process was killed.
        file.set_len(at as u64).map_err(&fail)?;
        file.seek(SeekFrom::End(0)).map_err(&fail)?;
        Ok((Self { file, path: path.to_owned(), thinned, dropped_bytes: bytes.len() - at }, growth))
    }

    /// Appends the newest level of the growth and syncs it to disk.
    ///
    /// # Errors
    /// [`AtlasError::Io`].
    pub fn append(&mut self, growth: &Growth, report: &LevelReport) -> Result<(), AtlasError> {
        let states = growth.newest_level();
        let mut bytes = Vec::with_capacity(RECORD_HEADER_BYTES + states.len() * STATE_BYTES + 8);
        bytes.extend_from_slice(&report.level.to_le_bytes());
        bytes.extend_from_slice(&report.children.to_le_bytes());
        bytes.extend_from_slice(&report.thinned.to_le_bytes());
        bytes.extend_from_slice(&(states.len() as u64).to_le_bytes());
        for (state, class) in states {
            bytes.extend_from_slice(&state.parent.to_le_bytes());
            bytes.extend_from_slice(&state.flip.to_bytes());
            bytes.extend_from_slice(&short_hash(class).to_le_bytes()[..HASH_BYTES]);
        }
        let sum = xxh3_64(&bytes);
        bytes.extend_from_slice(&sum.to_le_bytes());
        let fail = io_error(&self.path);
        self.file.write_all(&bytes).map_err(&fail)?;
        self.file.sync_data().map_err(&fail)?;
        self.thinned += report.thinned;
        Ok(())
    }
}

fn header_bytes(options: GrowOptions) -> Vec<u8> {
    let mut header = LOG_MAGIC.to_vec();
    header.extend_from_slice(&(options.cap as u32).to_le_bytes());
    header.extend_from_slice(&options.width.to_le_bytes());
    header
}

fn u32_at(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(bytes[at..at + 4].try_into().expect("four bytes"))
}

fn u64_at(bytes: &[u8], at: usize) -> u64 {
    u64::from_le_bytes(bytes[at..at + 8].try_into().expect("eight bytes"))
}

fn parse_header(bytes: &[u8], path: &Path) -> Result<GrowOptions, AtlasError> {
    if bytes.len() < HEADER_BYTES || &bytes[..8] != LOG_MAGIC {
        return Err(AtlasError::NotAnAtlas { path: path.to_owned() });
    }
    Ok(GrowOptions { cap: u32_at(bytes, 8) as usize, width: u32_at(bytes, 12) })
}

/// The record at byte `at` and where it ends; `None` at the end of the file or for a torn last record.
fn parse_record(bytes: &[u8], at: usize, level: u32, path: &Path) -> Result<Option<(Record, usize)>, AtlasError> {
    let damaged = |what| AtlasError::Damaged { path: path.to_owned(), offset: at as u64, what };
    let rest = &bytes[at..];
    if rest.len() < RECORD_HEADER_BYTES {
        return Ok(None);
    }
    let n = u64_at(rest, 20) as usize;
    let Some(end) = n.checked_mul(STATE_BYTES).and_then(|b| b.checked_add(RECORD_HEADER_BYTES)) else {
        return Err(damaged("impossible number of states"));
    };
    if rest.len() < end.saturating_add(8) {
        return Ok(None);
    }
    if xxh3_64(&rest[..end]) != u64_at(rest, end) {
        return Err(damaged("checksum does not match"));
    }
    if u32_at(rest, 0) != level {
        return Err(damaged("levels are out of order"));
    }
    let mut record = Record { thinned: u64_at(rest, 12), parents: Vec::new(), flips: Vec::new(), hashes: Vec::new() };
    for state in rest[RECORD_HEADER_BYTES..end].chunks_exact(STATE_BYTES) {
        record.parents.push(u32_at(state, 0));
        record.flips.push(Flip::from_bytes([state[4], state[5]]).ok_or_else(|| damaged("unknown flip"))?);
        let mut hash = [0; 8];
        hash[..HASH_BYTES].copy_from_slice(&state[6..]);
        record.hashes.push(u64::from_le_bytes(hash));
    }
    Ok(Some((record, at + end + 8)))
}

impl Atlas {
    /// Reads an atlas of either form.
    ///
    /// # Errors
    /// [`AtlasError`].
    pub fn read_path(path: &Path) -> Result<Self, AtlasError> {
        let bytes = std::fs::read(path).map_err(io_error(path))?;
        // A packed atlas of another version is named as such.
        if bytes.starts_with(&PACKED_MAGIC[..7]) {
            return Self::read_packed(&bytes).map_err(|what| AtlasError::Damaged {
                path: path.to_owned(),
                offset: 0,
                what,
            });
        }
        parse_header(&bytes, path)?;
        let mut starts = vec![0];
        let mut all = Record {
            thinned: 0,
            parents: vec![0],
            flips: vec![Flip::from_bytes([0, 0]).expect("kind 0 exists")],
            hashes: vec![short_hash(crate::grow::cube_class())],
        };
        let mut at = HEADER_BYTES;
        while let Some((record, end)) = parse_record(&bytes, at, starts.len() as u32 + 1, path)? {
            let below = all.parents.len() as u32;
            if record.parents.iter().any(|&p| p >= below) {
                return Err(AtlasError::Damaged {
                    path: path.to_owned(),
                    offset: at as u64,
                    what: "parent above its child",
                });
            }
            starts.push(below);
            all.parents.extend(record.parents);
            all.flips.extend(record.flips);
            all.hashes.extend(record.hashes);
            at = end;
        }
        Ok(Self::from_parts(starts, all.parents, all.flips, all.hashes))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hexfill_mesh::Context;

    fn grown(levels: u32) -> Growth {
        let mut growth = Growth::new(GrowOptions { cap: 18, width: 2 });
        while growth.level() < levels {
            growth.grow(&Context::default());
        }
        growth
    }

    #[test]
    fn a_torn_log_resumes_to_the_same_atlas() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.hxgrow");
        let options = GrowOptions { cap: 18, width: 2 };
        let whole = Atlas::from_growth(&grown(8));
        let mut previous_len = 0;
        for round in 0..12 {
            let (mut log, mut growth) = GrowthLog::open(&path, options).unwrap();
            assert_eq!(log.dropped_bytes() > 0, round % 3 == 2);
            if growth.level() == 8 {
                assert_eq!(Atlas::from_growth(&growth), whole);
                drop(log);
                assert_eq!(Atlas::read_path(&path).unwrap(), whole);
                break;
            }
            let report = growth.grow(&Context::default());
            log.append(&growth, &report).unwrap();
            drop(log);
            let len = std::fs::metadata(&path).unwrap().len();
            if round % 3 == 1 {
                // Killed while writing: half of the record is on disk.
                let file = OpenOptions::new().write(true).open(&path).unwrap();
                file.set_len(previous_len + (len - previous_len) / 2).unwrap();
            }
            previous_len = std::fs::metadata(&path).unwrap().len().max(previous_len);
        }
        let wrong = GrowthLog::open(&path, GrowOptions { cap: 20, width: 2 });
        assert!(matches!(wrong, Err(AtlasError::OtherOptions { .. })));
        let mut bytes = std::fs::read(&path).unwrap();
        bytes[60] ^= 1;
        std::fs::write(&path, &bytes).unwrap();
        assert!(matches!(GrowthLog::open(&path, options), Err(AtlasError::Damaged { .. })));
        std::fs::write(&path, b"something else entirely").unwrap();
        assert!(matches!(GrowthLog::open(&path, options), Err(AtlasError::NotAnAtlas { .. })));
    }

    #[test]
    fn a_growth_that_left_classes_out_says_so_when_it_is_resumed() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.hxgrow");
        let (mut log, growth) = GrowthLog::open(&path, GrowOptions::default()).unwrap();
        let mut growth = growth.with_beam(3);
        while growth.level() < 6 {
            let report = growth.grow(&Context::default());
            log.append(&growth, &report).unwrap();
        }
        let thinned = log.thinned();
        assert!(thinned > 0);
        drop(log);
        assert_eq!(GrowthLog::open(&path, GrowOptions::default()).unwrap().0.thinned(), thinned);
    }

    #[test]
    fn every_kept_state_replays_to_a_ball_of_its_class() {
        let growth = grown(9);
        let atlas = Atlas::from_growth(&growth);
        for state in 0..atlas.n_states() as u32 {
            let ball = crate::Ball::replay(atlas.flips_to(state)).unwrap();
            ball.debug_check();
            assert_eq!(ball.n_hexes(), atlas.hexes_of(state) as usize);
            let (best, _, _) = atlas.best_fit(&ball.boundary_only(), 99).unwrap();
            assert!(best.n_hexes() <= ball.n_hexes());
        }
    }
}
