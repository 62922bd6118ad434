//! The level-by-level engine: all children of all classes of one size, one kept of each class in a set of hashes.
//!
//! Right for both rules, and the only choice for the poster's filter. Memory: 16 bytes a class for the set (8 with narrow
//! hashes) and a code for each class that is extended further. Threads share the set; which of them meets a class first
//! does not matter, since only its canonical code and invariants are used. Codes are sorted at the end of a
//! level, so that the result does not depend on the threads.
//!
//! Source: Weill, who goes level by level too.

use crate::canonical::{Code, canonical};
use crate::complex::Complex;
use crate::error::EnumerateError;
use crate::hashset::{HashKey, ShardedSet};
use crate::params::Params;
use crate::tally::{Counter, Tally};
use crate::targets::{Found, Wanted};
use hexfill_mesh::{Context, StopReason};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// How the level engine works; none of it changes a result.
///
/// | option | default |
/// |---|---|
/// | threads | 1 |
/// | narrow hashes | no |
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct LevelOptions {
    pub(crate) threads: usize,
    pub(crate) narrow_hashes: bool,
}

impl Default for LevelOptions {
    fn default() -> Self {
        Self { threads: 1, narrow_hashes: false }
    }
}

impl LevelOptions {
    /// Number of threads.
    #[must_use]
    pub fn with_threads(self, threads: usize) -> Self {
        Self { threads, ..self }
    }

    /// 64-bit instead of 128-bit hashes: half the memory, and at n = 8 a chance of about 1e-5 of a wrong count.
    #[must_use]
    pub fn with_narrow_hashes(self, narrow_hashes: bool) -> Self {
        Self { narrow_hashes, ..self }
    }

    /// Number of threads.
    pub fn threads(&self) -> usize {
        self.threads
    }
}

/// One finished level.
#[derive(Clone, Debug)]
pub struct Level {
    /// Number of cubes.
    pub cubes: usize,
    /// The counts.
    pub tally: Tally,
    /// Codes of the classes to be extended (all without a filter), sorted. Empty for the last level unless asked for.
    pub codes: Vec<Code>,
    /// What was listed, sorted.
    pub found: Found,
    /// Bytes held by the set of hashes at the end.
    pub set_bytes: u64,
}

/// What to keep of a level besides the counts.
#[derive(Clone, Copy, Default, Debug)]
pub struct Keep<'a> {
    /// The codes of the classes that go on to the next level.
    pub codes: bool,
    /// What to list.
    pub wanted: Wanted<'a>,
}

/// Level 1: one cube.
pub fn first_level(params: &Params, keep: Keep<'_>) -> Level {
    let cube = Complex::cube();
    let labelling = canonical(&cube);
    let mut counter = Counter::new(params.nonorientable);
    let (boundary, shape) = counter.class(&cube, &labelling, labelling.code.hash128());
    let mut found = Found::default();
    found.look(&keep.wanted, &mut counter, &boundary, &shape, labelling.code);
    let codes = if keep.codes && params.extends(1, shape.chords) { vec![labelling.code] } else { Vec::new() };
    Level { cubes: 1, tally: counter.finish(), codes, found, set_bytes: 0 }
}

/// The level after `parents`, which are codes of one size.
///
/// # Errors
/// [`EnumerateError::Stopped`] if the context says so, [`EnumerateError::BadCode`] for parents that are not codes.
pub fn next_level(
    params: &Params,
    parents: &[Code],
    options: &LevelOptions,
    keep: Keep<'_>,
    ctx: &Context<'_>,
) -> Result<Level, EnumerateError> {
    if options.narrow_hashes {
        grow::<u64>(params, parents, options, keep, ctx)
    } else {
        grow::<u128>(params, parents, options, keep, ctx)
    }
}

/// Levels 1 to `params.cubes`; only the last keeps selected codes, and it keeps codes to extend if `keep_last`.
///
/// # Errors
/// As [`next_level`].
pub fn all_levels(
    params: &Params,
    options: &LevelOptions,
    wanted: Wanted<'_>,
    keep_last: bool,
    ctx: &Context<'_>,
) -> Result<Vec<Level>, EnumerateError> {
    params.check()?;
    let keep = |n: usize| Keep {
        codes: n < params.cubes || keep_last,
        wanted: if n == params.cubes { wanted } else { Wanted::default() },
    };
    let mut levels = vec![first_level(params, keep(1))];
    for n in 2..=params.cubes {
        let parents = std::mem::take(&mut levels[n - 2].codes);
        let level = next_level(params, &parents, options, keep(n), ctx)?;
        levels.push(level);
    }
    Ok(levels)
}

fn grow<K: HashKey>(
    params: &Params,
    parents: &[Code],
    options: &LevelOptions,
    keep: Keep<'_>,
    ctx: &Context<'_>,
) -> Result<Level, EnumerateError> {
    const BLOCK: usize = 32;
    let cubes = parents.first().map_or(0, Code::n_cubes) + 1;
    let set = ShardedSet::<K>::new();
    let cursor = AtomicUsize::new(0);
    let parts = Mutex::new(Vec::new());
    let work = || -> Result<(), EnumerateError> {
        let mut counter = Counter::new(params.nonorientable);
        let mut codes = Vec::new();
        let mut found = Found::default();
        loop {
            // Which thread takes which parents does not matter: what a class counts is computed from its canonical
            // code, and whoever is first to insert it counts it.
            let start = cursor.fetch_add(BLOCK, Ordering::Relaxed);
            if start >= parents.len() {
                break;
            }
            if let Some(reason) = ctx.stop() {
                return Err(EnumerateError::Stopped { reason });
            }
            if ctx.memory_limit.is_some_and(|limit| set.bytes() > limit) {
                return Err(EnumerateError::Stopped { reason: StopReason::MemoryLimit });
            }
            for code in &parents[start..parents.len().min(start + BLOCK)] {
                let parent = code.decode()?;
                let automorphisms = canonical(&parent).automorphisms;
                counter.parent();
                params.extend(&parent, false, |child, glued| {
                    counter.raw(glued, automorphisms);
                    let labelling = canonical(child);
                    let hash = labelling.code.hash128();
                    if child.is_closed() {
                        counter.raw_closed();
                    }
                    if !set.insert(hash) {
                        return;
                    }
                    let (boundary, shape) = counter.class(child, &labelling, hash);
                    if params.rule == crate::Rule::Strict {
                        counter.removable(child.non_cut().count_ones(), labelling.automorphisms);
                    }
                    if keep.codes && params.extends(cubes, shape.chords) {
                        codes.push(labelling.code);
                    }
                    found.look(&keep.wanted, &mut counter, &boundary, &shape, labelling.code);
                });
            }
            ctx.report("level", (start + BLOCK).min(parents.len()) as u64, Some(parents.len() as u64), || {
                format!("{cubes} cubes")
            });
        }
        parts.lock().unwrap_or_else(std::sync::PoisonError::into_inner).push((counter.finish(), codes, found));
        Ok(())
    };
    hexfill_ledger::run_on(options.threads, &work)?;
    let mut level =
        Level { cubes, tally: Tally::default(), codes: Vec::new(), found: Found::default(), set_bytes: set.bytes() };
    // Sums do not care about the order of the parts; lists are sorted below.
    for (tally, codes, found) in parts.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner) {
        level.tally.merge(&tally);
        level.codes.extend(codes);
        level.found.merge(found);
    }
    level.codes.sort_unstable();
    level.found.sort();
    Ok(level)
}
