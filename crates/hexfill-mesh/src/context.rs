//! What long work is given besides its data: a way to stop it, limits, a place to report progress.
//!
//! Long work polls [`Context::stop`] at least every 0.1 s and, when told to stop, returns the best
//! result so far together with the [`StopReason`].
//!
//! Source: ours.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Why long work came to an end.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum StopReason {
    /// Nothing was left to do.
    Finished,
    /// The caller asked for it.
    Cancelled,
    /// The time limit was reached.
    TimeLimit,
    /// The memory limit was reached.
    MemoryLimit,
}

impl StopReason {
    /// One word, as reports and JSON have it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Finished => "finished",
            Self::Cancelled => "cancelled",
            Self::TimeLimit => "time-limit",
            Self::MemoryLimit => "memory-limit",
        }
    }
}

impl std::fmt::Display for StopReason {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.word())
    }
}

impl serde::Serialize for StopReason {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.word())
    }
}

/// A progress report. `stage` is one word or two ("atlas level", "untangle"); `done` of `total` steps of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Progress {
    /// What is being done.
    pub stage: &'static str,
    /// Steps done.
    pub done: u64,
    /// Steps in all, where known.
    pub total: Option<u64>,
    /// Further words for a person: states, best so far.
    pub message: String,
}

/// Cancellation, limits, seed and progress for one run. The default has none of them.
///
/// # Example
/// ```
/// use hexfill_mesh::{Context, StopReason};
/// use std::sync::atomic::{AtomicBool, Ordering};
/// use std::time::Duration;
///
/// let cancel = AtomicBool::new(false);
/// let ctx = Context { cancel: Some(&cancel), ..Context::default() }.with_time_limit(Duration::from_secs(60));
/// assert_eq!(ctx.stop(), None);
/// cancel.store(true, Ordering::Relaxed); // from another thread, say
/// assert_eq!(ctx.stop(), Some(StopReason::Cancelled));
/// ```
#[derive(Clone, Copy, Default)]
pub struct Context<'a> {
    /// Set to `true` by the caller to stop the work.
    pub cancel: Option<&'a AtomicBool>,
    /// When to stop.
    pub deadline: Option<Instant>,
    /// How many bytes the work may hold.
    pub memory_limit: Option<u64>,
    /// Where every pseudo-random choice starts.
    pub seed: u64,
    /// Called with progress from the thread that drives the work.
    pub progress: Option<&'a (dyn Fn(&Progress) + Sync)>,
}

impl std::fmt::Debug for Context<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Context")
            .field("deadline", &self.deadline)
            .field("memory_limit", &self.memory_limit)
            .field("seed", &self.seed)
            .finish_non_exhaustive()
    }
}

impl Context<'_> {
    /// This context with a deadline `limit` from now (the earlier one wins).
    #[must_use]
    pub fn with_time_limit(mut self, limit: Duration) -> Self {
        // A limit beyond what clocks can say is none.
        if let Some(at) = Instant::now().checked_add(limit) {
            self.deadline = Some(self.deadline.map_or(at, |old| old.min(at)));
        }
        self
    }

    /// Whether the work must stop now, and why.
    pub fn stop(&self) -> Option<StopReason> {
        if self.cancel.is_some_and(|c| c.load(Ordering::Relaxed)) {
            return Some(StopReason::Cancelled);
        }
        self.deadline.is_some_and(|d| Instant::now() >= d).then_some(StopReason::TimeLimit)
    }

    /// Reports progress, if anyone listens.
    pub fn report(&self, stage: &'static str, done: u64, total: Option<u64>, message: impl FnOnce() -> String) {
        if let Some(progress) = self.progress {
            progress(&Progress { stage, done, total, message: message() });
        }
    }
}
