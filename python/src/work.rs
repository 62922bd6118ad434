//! Work on a thread of its own, while Python's lock is released and the calling thread waits, listens for Ctrl-C and passes
//! progress on.
//!
//! The work owns its data, so that the caller may leave: a first Ctrl-C tells it to stop and waits for the best so far, a second
//! one leaves at once (the thread ends by itself a moment later and never touches Python). The callback runs on the calling
//! thread only.

use crate::failure::Failure;
use hexfill::{Context, Progress, with_threads};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict};
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// How often the calling thread looks for signals and progress.
const POLL: Duration = Duration::from_millis(50);

/// Longer limits are none (an instant so far away cannot be named everywhere).
const LONGEST: f64 = 1e9;

/// What every long verb takes besides its own options: a dictionary.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Run {
    threads: Option<usize>,
    time_limit: Option<f64>,
    seed: u64,
    progress: Option<Py<PyAny>>,
}

impl Run {
    /// The threads asked for, or one a core.
    pub(crate) fn n_threads(&self) -> usize {
        self.threads.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, usize::from))
    }
}

/// A time in seconds as a limit; `None` if it limits nothing.
pub(crate) fn limit(seconds: Option<f64>) -> Option<Duration> {
    seconds.filter(|&s| s < LONGEST).and_then(|s| Duration::try_from_secs_f64(s).ok())
}

/// Where the worker leaves its news.
struct Desk<T> {
    news: Mutex<News<T>>,
    bell: Condvar,
    cancel: AtomicBool,
}

struct News<T> {
    /// The latest that was not passed on.
    progress: Option<Progress>,
    outcome: Option<Result<T, Failure>>,
}

impl<T> Desk<T> {
    fn new() -> Self {
        let news = News { progress: None, outcome: None };
        Self { news: Mutex::new(news), bell: Condvar::new(), cancel: AtomicBool::new(false) }
    }

    fn lock(&self) -> MutexGuard<'_, News<T>> {
        self.news.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits for the outcome, at most a [`POLL`].
    fn wait(&self) -> News<T> {
        let ended = self.bell.wait_timeout_while(self.lock(), POLL, |news| news.outcome.is_none());
        let (mut news, _) = ended.unwrap_or_else(PoisonError::into_inner);
        News { progress: news.progress.take(), outcome: news.outcome.take() }
    }

    fn leave(&self, outcome: Result<T, Failure>) {
        self.lock().outcome = Some(outcome);
        self.bell.notify_all();
    }
}

/// Does the work. `true` beside the value: it was stopped by Ctrl-C, and the value is the best so far.
///
/// # Errors
/// Those of the work, and what the callback or a signal handler raised. Ctrl-C is `Cancelled` if it brought no value.
pub(crate) fn run<T: Send + 'static>(
    py: Python<'_>,
    run: Run,
    work: impl FnOnce(&Context<'_>) -> Result<T, Failure> + Send + 'static,
) -> PyResult<(T, bool)> {
    let desk = Arc::new(Desk::new());
    let worker = Arc::clone(&desk);
    let (threads, seed, time_limit, listened) = (run.threads, run.seed, limit(run.time_limit), run.progress.is_some());
    let thread = move || worker.leave(done(&worker, threads, seed, time_limit, listened, work));
    std::thread::Builder::new().name("hexfill".to_owned()).spawn(thread)?;
    let mut interrupt: Option<PyErr> = None;
    loop {
        let News { progress, outcome } = py.detach(|| desk.wait());
        if let Some(outcome) = outcome {
            return match (outcome, interrupt) {
                (Ok(value), None) => Ok((value, false)),
                (Ok(value), Some(stop)) if stop.is_instance_of::<PyKeyboardInterrupt>(py) => Ok((value, true)),
                (_, Some(stop)) if stop.is_instance_of::<PyKeyboardInterrupt>(py) => {
                    Err(Failure::cancelled().raise(py))
                }
                (_, Some(stop)) => Err(stop),
                (Err(failure), None) => Err(failure.raise(py)),
            };
        }
        let told = match (&run.progress, progress) {
            (Some(callback), Some(progress)) if interrupt.is_none() => tell(py, callback, &progress),
            _ => Ok(true),
        };
        match told.and_then(|go_on| py.check_signals().map(|()| go_on)) {
            Ok(true) => {}
            Ok(false) => desk.cancel.store(true, Ordering::Relaxed),
            Err(stop) => {
                desk.cancel.store(true, Ordering::Relaxed);
                if interrupt.is_some() {
                    return Err(stop);
                }
                interrupt = Some(stop);
            }
        }
    }
}

/// The work on the worker's side; a panic is an internal error.
fn done<T: Send>(
    desk: &Desk<T>,
    threads: Option<usize>,
    seed: u64,
    time_limit: Option<Duration>,
    listened: bool,
    work: impl FnOnce(&Context<'_>) -> Result<T, Failure> + Send,
) -> Result<T, Failure> {
    let progress = |progress: &Progress| desk.lock().progress = Some(progress.clone());
    let mut ctx = Context { cancel: Some(&desk.cancel), seed, ..Context::default() };
    if listened {
        ctx.progress = Some(&progress);
    }
    if let Some(limit) = time_limit {
        ctx = ctx.with_time_limit(limit);
    }
    match catch_unwind(AssertUnwindSafe(|| with_threads(threads, || work(&ctx)))) {
        Ok(outcome) => outcome?,
        Err(payload) => Err(Failure::internal(format!("please report this input: {}", text_of(&*payload)))),
    }
}

/// The words of a panic.
fn text_of(payload: &(dyn Any + Send)) -> &str {
    let text = payload.downcast_ref::<&str>().copied();
    text.or_else(|| payload.downcast_ref::<String>().map(String::as_str)).unwrap_or("no message")
}

/// Calls the callback; `false` if it says that the work is to stop.
fn tell(py: Python<'_>, callback: &Py<PyAny>, progress: &Progress) -> PyResult<bool> {
    let news = PyDict::new(py);
    news.set_item("stage", progress.stage)?;
    news.set_item("done", progress.done)?;
    news.set_item("total", progress.total)?;
    news.set_item("message", &progress.message)?;
    let answer = callback.call1(py, (news,))?;
    Ok(!answer.bind(py).is(PyBool::new(py, false)))
}

/// A defect, for the tests.
///
/// # Errors
/// Always.
#[cfg(debug_assertions)]
#[pyfunction]
pub(crate) fn panic_for_test(py: Python<'_>, run: Run) -> PyResult<()> {
    self::run(py, run, |_| -> Result<(), Failure> { panic!("provoked") }).map(|_| ())
}
