//! A defect of this program ends it with one line and exit code 70, whatever thread it shows in and however often.
//!
//! The work unwinds as usual, so that temporary files go and threads are joined; only the words of all panics but the
//! first are withheld. A panic because our output has no reader any more is a quiet success, as an error of that kind is.

use crate::console::versioned;
use crate::exit::Exit;
use std::any::Any;
use std::io::Write;
use std::panic::{AssertUnwindSafe, PanicHookInfo, catch_unwind};
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether the one line has been printed.
static TOLD: AtomicBool = AtomicBool::new(false);

/// How `print!` and its like begin their panics.
const PRINTING: &str = "failed printing to std";

/// Runs the program; a panic in it becomes an exit code.
pub(crate) fn guard(run: impl FnOnce() -> ExitCode) -> ExitCode {
    std::panic::set_hook(Box::new(hook));
    ended(run)
}

fn ended(run: impl FnOnce() -> ExitCode) -> ExitCode {
    match catch_unwind(AssertUnwindSafe(run)) {
        Ok(code) => code,
        Err(payload) => {
            let text = text_of(&*payload);
            let code = code_of(text);
            // The flags are not parsed here: a panic may come before, or from, parsing them.
            if code == Exit::Internal && std::env::args_os().any(|word| word == "--json") {
                let report = versioned(&serde_json::json!({ "error": one_line(text), "exit_code": code as u8 }));
                let _ = writeln!(std::io::stdout(), "{}", report.unwrap_or_default());
            }
            code.into()
        }
    }
}

/// Prints the first panic of all threads that is not about printing. Never panics itself.
fn hook(info: &PanicHookInfo<'_>) {
    let text = text_of(info.payload());
    if text.starts_with(PRINTING) || TOLD.swap(true, Ordering::Relaxed) {
        return;
    }
    let place = info.location().map_or_else(|| "an unknown place".to_owned(), ToString::to_string);
    // Nobody to tell if stderr is gone; the exit code says it.
    let _ = writeln!(std::io::stderr(), "{}", line(text, &place));
}

/// The words of a panic.
fn text_of(payload: &(dyn Any + Send)) -> &str {
    let text = payload.downcast_ref::<&str>().copied();
    text.or_else(|| payload.downcast_ref::<String>().map(String::as_str)).unwrap_or("no message")
}

/// What the user reads, on one line.
fn line(text: &str, place: &str) -> String {
    let text = one_line(text);
    let version = env!("CARGO_PKG_VERSION");
    format!("error: internal error, please report this line: hexfill {version}, {place}: {text}")
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The exit code of a panic with these words.
fn code_of(text: &str) -> Exit {
    // EPIPE; the number is the same on all systems that have one, and the words are not.
    let no_reader = text.starts_with(PRINTING) && text.ends_with("(os error 32)");
    if no_reader { Exit::Done } else { Exit::Internal }
}

/// Panics in every worker thread if a test asks for it; nothing outside builds with debug assertions.
pub(crate) fn provoked_by_test() {
    if cfg!(debug_assertions) && std::env::var_os("HEXFILL_TEST_PANIC").is_some() {
        use rayon::prelude::*;
        (0..1000).into_par_iter().for_each(|i| panic!("provoked\n  {i}"));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_message_is_one_line_with_its_place() {
        let line = line("assertion `left == right` failed\n  left: 1\n right: 2\r\n", "src/a.rs:3:5");
        assert_eq!(line.lines().count(), 1);
        assert!(
            line.contains("report") && line.contains("src/a.rs:3:5") && line.ends_with("left: 1 right: 2"),
            "{line}"
        );
    }

    #[test]
    fn a_lost_reader_is_no_defect_and_a_full_disk_is_not_hidden() {
        assert_eq!(code_of("failed printing to stdout: Broken pipe (os error 32)"), Exit::Done);
        assert_eq!(code_of("failed printing to stderr: No space left on device (os error 28)"), Exit::Internal);
        assert_eq!(code_of("index out of bounds"), Exit::Internal);
    }

    #[test]
    fn panics_of_any_kind_become_codes() {
        let code = |run: fn() -> ExitCode| format!("{:?}", ended(run));
        let expected = |exit: Exit| format!("{:?}", ExitCode::from(exit));
        assert_eq!(code(|| Exit::No.into()), expected(Exit::No));
        assert_eq!(code(|| std::panic::panic_any(5)), expected(Exit::Internal));
        assert_eq!(code(|| panic!("failed printing to stdout: Broken pipe (os error 32)")), expected(Exit::Done));
    }
}
