//! Work on threads of its own: none is left behind when it is done, and none is shared with another process or library.
//!
//! Source: ours.

use rayon::ThreadPoolBuilder;

/// Most threads that can be asked for.
pub const MAX_THREADS: usize = 1024;

/// Bytes of stack a thread: as much as a main thread has, twice.
const STACK: usize = 16 << 20;

/// Why there are no threads.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ThreadsError {
    /// None, or too many.
    #[error("{given} threads asked for; give 1 to {MAX_THREADS}")]
    Number {
        /// The number asked for.
        given: usize,
    },
    /// The system refused.
    #[error("the system gives no {given} threads: {source}")]
    Refused {
        /// The number asked for; 0: one a core.
        given: usize,
        /// What it says.
        source: rayon::ThreadPoolBuildError,
    },
}

/// Does the work on this many threads, 1 to [`MAX_THREADS`]; `None`: one a core (or what `RAYON_NUM_THREADS` says). Results do not depend on it.
///
/// ```
/// use hexfill::{Context, FillOptions, Problem, fill, with_threads};
/// let geode = Problem::named("geode")?;
/// let filled = |n| with_threads(Some(n), || fill(&geode, &FillOptions::default(), &Context::default()));
/// let (one, two) = (filled(1)??, filled(2)??);
/// assert_eq!(one.meshes[0].mesh().hexes_raw(), two.meshes[0].mesh().hexes_raw());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`ThreadsError`]; the work has not begun then.
pub fn with_threads<T: Send>(threads: Option<usize>, work: impl FnOnce() -> T + Send) -> Result<T, ThreadsError> {
    if let Some(given) = threads.filter(|&n| n == 0 || n > MAX_THREADS) {
        return Err(ThreadsError::Number { given });
    }
    let given = threads.unwrap_or(0);
    let pool = ThreadPoolBuilder::new().num_threads(given).stack_size(STACK).build();
    Ok(pool.map_err(|source| ThreadsError::Refused { given, source })?.install(work))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn threads_are_as_many_as_asked_for() {
        assert_eq!(with_threads(Some(3), rayon::current_num_threads).unwrap(), 3);
        assert!(with_threads(None, rayon::current_num_threads).unwrap() > 0);
        for given in [0, MAX_THREADS + 1, usize::MAX] {
            assert!(matches!(with_threads(Some(given), || ()), Err(ThreadsError::Number { given: g }) if g == given));
        }
    }
}
