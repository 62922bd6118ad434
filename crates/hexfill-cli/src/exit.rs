//! Exit codes, signals and the quiet end of a broken pipe.

use hexfill::unstable::prove::ProveError;
use hexfill::{FillError, SimplifyError, StopReason};
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};

/// How a command ended.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Exit {
    /// Done and verified.
    Done = 0,
    /// Ran, and the answer is "no".
    No = 1,
    /// Bad usage or input.
    Usage = 2,
    /// Stopped by a limit or a signal.
    Stopped = 3,
    /// A defect of this program.
    Internal = 70,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(exit as u8)
    }
}

impl Exit {
    /// Done, or stopped if the work was.
    pub fn of_stop(stop: StopReason, otherwise: Self) -> Self {
        if stop == StopReason::Finished { otherwise } else { Self::Stopped }
    }
}

/// The exit code of an error: bad input unless it says otherwise.
pub(crate) fn code_of(error: &anyhow::Error) -> Exit {
    let fill = matches!(error.downcast_ref(), Some(FillError::Refused { .. }));
    let simplify = matches!(error.downcast_ref(), Some(SimplifyError::Refused { .. }));
    let search = matches!(error.downcast_ref(), Some(ProveError::Refused { .. }));
    if fill || simplify || search { Exit::Internal } else { Exit::Usage }
}

/// Whether the reader of our output went away.
pub(crate) fn is_broken_pipe(error: &anyhow::Error) -> bool {
    error
        .chain()
        .any(|e| e.downcast_ref::<std::io::Error>().is_some_and(|e| e.kind() == std::io::ErrorKind::BrokenPipe))
}

/// The first SIGINT or SIGTERM asks the work to stop, which is told; the second ends the process at once.
pub(crate) fn install_signal_handler(tell: fn(&str)) -> &'static AtomicBool {
    static CANCEL: AtomicBool = AtomicBool::new(false);
    let installed = ctrlc::set_handler(move || {
        if CANCEL.swap(true, Ordering::Relaxed) {
            std::process::exit(Exit::Stopped as i32);
        }
        tell("hexfill: stopping; once more to quit at once");
    });
    // Without a handler the signals keep their default meaning: the process ends.
    drop(installed);
    &CANCEL
}
