//! What goes to the terminal: messages, errors, progress. A bar on a terminal, a plain line every few seconds otherwise.

use crate::Common;
use crate::exit::Exit;
use hexfill::Progress;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::{IsTerminal, Write};
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// When to use colours.
#[derive(Clone, Copy, PartialEq, Eq, Debug, clap::ValueEnum)]
pub(crate) enum ColorWhen {
    /// On a terminal, unless NO_COLOR is set.
    Auto,
    /// Always.
    Always,
    /// Never.
    Never,
}

/// Where messages go.
pub(crate) struct Console {
    quiet: bool,
    /// How much more to say (0, 1, ...).
    pub verbose: u8,
    /// Whether the report is wanted as JSON.
    pub json: bool,
    color: bool,
    progress: Mutex<ProgressState>,
}

struct ProgressState {
    bar: Option<ProgressBar>,
    on_terminal: bool,
    last_line: Instant,
    started: Instant,
    /// The step under way, since when, and how much of it was done then.
    step: (&'static str, Instant, u64),
}

impl ProgressState {
    /// "40 %, about 12 s left of it": how far the step is, where its end is known.
    fn share(&mut self, p: &Progress) -> Option<String> {
        if self.step.0 != p.stage || p.done < self.step.2 {
            self.step = (p.stage, Instant::now(), p.done);
        }
        let total = p.total.filter(|&t| t > 0 && p.done <= t)?;
        let share = format!("{:.0} %", 100.0 * p.done as f64 / total as f64);
        let (since, made) = (self.step.1.elapsed(), p.done - self.step.2);
        if since < Duration::from_secs(2) || made == 0 || p.done == total {
            return Some(share);
        }
        let left = since.as_secs_f64() * (total - p.done) as f64 / made as f64;
        Some(format!("{share}, about {} left of it", duration(left)))
    }
}

/// An object as JSON, the version of its keys first.
pub(crate) fn versioned(value: &impl serde::Serialize) -> anyhow::Result<String> {
    let mut value = serde_json::to_value(value)?;
    let object = value.as_object_mut().expect("a report is an object");
    object.shift_insert(0, "json_version".to_owned(), JSON_VERSION.into());
    Ok(serde_json::to_string_pretty(&value)?)
}

/// The JSON of flags that could not be understood, where `--json` is among them: the first line of what was said.
pub(crate) fn print_usage_error(said: &str) {
    let first = said.lines().next().unwrap_or_default();
    let error = first.strip_prefix("error: ").unwrap_or(first);
    if let Ok(text) = versioned(&serde_json::json!({ "error": error, "exit_code": Exit::Usage as u8 })) {
        // Nothing is left to be done if stdout fails as well.
        let _ = writeln!(std::io::stdout(), "{text}");
    }
}

/// "1 hex", "2 hexes".
pub(crate) fn hexes(n: usize) -> String {
    format!("{n} hex{}", if n == 1 { "" } else { "es" })
}

/// "12 s", "3 min", "2 h".
fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 90.0 => format!("{s:.0} s"),
        s if s < 5400.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.0} h", s / 3600.0),
    }
}

/// Raised when a key of a JSON report goes or changes its meaning; new keys leave it as it is.
const JSON_VERSION: u32 = 1;

/// Time between two plain progress lines.
const LINE_EVERY: Duration = Duration::from_secs(5);

impl Console {
    /// A console as the flags ask for.
    pub(crate) fn new(common: &Common) -> Self {
        let on_terminal = std::io::stderr().is_terminal();
        let color = match common.color {
            ColorWhen::Always => true,
            ColorWhen::Never => false,
            ColorWhen::Auto => on_terminal && std::env::var_os("NO_COLOR").is_none(),
        };
        let now = Instant::now();
        let progress = ProgressState { bar: None, on_terminal, last_line: now, started: now, step: ("", now, 0) };
        Self { quiet: common.quiet, verbose: common.verbose, json: common.json, color, progress: Mutex::new(progress) }
    }

    /// A line for the user, on stderr.
    pub(crate) fn say(&self, text: impl AsRef<str>) {
        if !self.quiet {
            self.finish_progress();
            tell(text.as_ref());
        }
    }

    /// A remark about the input or result, on stderr.
    pub(crate) fn note(&self, text: impl AsRef<str>) {
        self.say(format!("{} {}", self.paint("note:", "36"), text.as_ref()));
    }

    /// An error with its causes, on stderr, in one message.
    pub(crate) fn error(&self, error: &anyhow::Error) {
        self.finish_progress();
        tell(&format!("{} {}", self.paint("error:", "1;31"), message(error)));
    }

    /// The error that ends the command: on stderr, and as JSON on stdout where JSON was asked for.
    pub(crate) fn fail(&self, error: &anyhow::Error, exit_code: u8) {
        self.error(error);
        if self.json {
            // Nothing is left to be done if stdout fails as well.
            let _ = self.print_json(&serde_json::json!({ "error": message(error), "exit_code": exit_code }));
        }
    }

    fn paint(&self, text: &str, code: &str) -> String {
        if self.color { format!("\x1b[{code}m{text}\x1b[0m") } else { text.to_owned() }
    }

    /// Prints data on stdout.
    ///
    /// # Errors
    /// If stdout cannot be written.
    pub(crate) fn print(&self, text: impl AsRef<str>) -> anyhow::Result<()> {
        let mut out = std::io::stdout().lock();
        out.write_all(text.as_ref().as_bytes())?;
        out.write_all(b"\n")?;
        out.flush()?;
        Ok(())
    }

    /// Prints an object as JSON on stdout, the version of its keys first.
    ///
    /// # Errors
    /// If stdout cannot be written.
    pub(crate) fn print_json(&self, value: &impl serde::Serialize) -> anyhow::Result<()> {
        self.print(versioned(value)?)
    }

    /// Shows progress of long work.
    pub(crate) fn progress(&self, p: &Progress) {
        if self.quiet {
            return;
        }
        let mut state = self.progress.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        let elapsed = state.started.elapsed();
        let share = state.share(p).map_or(String::new(), |share| format!(" ({share})"));
        let message = if p.message.is_empty() { String::new() } else { format!(": {}", p.message) };
        if state.on_terminal {
            let bar = state.bar.get_or_insert_with(|| {
                let bar = ProgressBar::new(0);
                bar.set_style(bar_style(false));
                bar
            });
            if let Some(total) = p.total {
                bar.set_style(bar_style(true));
                bar.set_length(total);
            } else {
                bar.set_style(bar_style(false));
            }
            bar.set_position(p.done);
            bar.set_message(format!("{}{share}{message}", p.stage));
            if elapsed > Duration::from_millis(100) {
                bar.tick();
            }
        } else if state.last_line.elapsed() >= LINE_EVERY {
            state.last_line = Instant::now();
            tell(&format!("[{:6.1}s] {}{share}{message}", elapsed.as_secs_f64(), p.stage));
        }
    }

    /// Clears the bar.
    pub(crate) fn finish_progress(&self) {
        let mut state = self.progress.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        if let Some(bar) = state.bar.take() {
            bar.finish_and_clear();
        }
    }
}

/// A line on stderr. Work goes on if stderr is closed or full: its result matters, and the exit code is still read.
pub(crate) fn tell(text: &str) {
    let _ = writeln!(std::io::stderr(), "{text}");
}

/// An error and its causes as one line; causes that a message already contains are not said again.
fn message(error: &anyhow::Error) -> String {
    let mut text = String::new();
    for cause in error.chain().map(ToString::to_string) {
        if !text.contains(&cause) {
            text = if text.is_empty() { cause } else { format!("{text}: {cause}") };
        }
    }
    text
}

fn bar_style(with_total: bool) -> ProgressStyle {
    let template = if with_total {
        "{elapsed:>6} {bar:24} {pos}/{len} {wide_msg}"
    } else {
        "{elapsed:>6} {spinner} {pos} {wide_msg}"
    };
    ProgressStyle::with_template(template).expect("the template is well formed")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn progress_tells_the_share_and_the_time_left_where_the_end_is_known() {
        let began = Instant::now().checked_sub(Duration::from_secs(10)).unwrap();
        let mut state =
            ProgressState { bar: None, on_terminal: false, last_line: began, started: began, step: ("work", began, 0) };
        let mut at = |done, total| state.share(&Progress { stage: "work", done, total, message: String::new() });
        assert_eq!(at(25, Some(100)).unwrap(), "25 %, about 30 s left of it");
        assert_eq!(at(100, Some(100)).unwrap(), "100 %");
        assert_eq!(at(100, None), None);
    }
}
