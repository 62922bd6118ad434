//! `hexfill man [COMMAND]`: everything here is made from the flags themselves.

use crate::exit::Exit;
use anyhow::bail;
use clap::{Arg, Command, CommandFactory};
use std::fmt::Write as _;
use std::io::Write as _;

/// Flags of `man`.
#[derive(clap::Args)]
pub(crate) struct ManArgs {
    /// The command to describe [default: hexfill as a whole].
    command: Option<String>,
    /// All commands with all their flags, as a page of the book (Markdown).
    #[arg(long, conflicts_with = "command")]
    markdown: bool,
}

/// Prints the page.
pub(crate) fn run(args: &ManArgs) -> anyhow::Result<Exit> {
    let mut whole = crate::Cli::command();
    whole.build();
    let mut text = Vec::new();
    match &args.command {
        _ if args.markdown => text = markdown(&whole).into_bytes(),
        None => clap_mangen::Man::new(whole).render(&mut text)?,
        Some(name) => {
            let Some(command) = whole.find_subcommand(name) else {
                bail!("hexfill has no command {name}; see `hexfill --help`");
            };
            clap_mangen::Man::new(command.clone()).render(&mut text)?;
        }
    }
    std::io::stdout().write_all(&text)?;
    Ok(Exit::Done)
}

/// The page `flags.md` of the book.
fn markdown(whole: &Command) -> String {
    let mut page = "# All flags\n\nMade by `hexfill man --markdown`; a test holds it. What they are for stands in [Command line](command-line.md).\n".to_owned();
    page += "\n## Every command\n\n";
    page += &table(whole.get_arguments().filter(|arg| arg.is_global_set()));
    for command in whole.get_subcommands().filter(|command| command.get_name() != "help") {
        describe(command, "hexfill", &mut page);
    }
    page
}

/// A section for a command, and one for each below it.
fn describe(command: &Command, before: &str, page: &mut String) {
    let name = format!("{before} {}", command.get_name());
    let aliases: Vec<String> = command.get_visible_aliases().map(|alias| format!("`{alias}`")).collect();
    let also = if aliases.is_empty() { String::new() } else { format!(" Also called {}.", aliases.join(", ")) };
    let about = command.get_about().map(ToString::to_string).unwrap_or_default();
    let _ = writeln!(page, "\n## `{name}`\n\n{}.{also}\n", about.trim_end_matches('.'));
    *page += &table(command.get_arguments().filter(|arg| !arg.is_global_set()));
    for below in command.get_subcommands().filter(|below| below.get_name() != "help") {
        describe(below, &name, page);
    }
}

/// Flags and what they do; nothing if there are none.
fn table<'a>(flags: impl Iterator<Item = &'a Arg>) -> String {
    let shown = flags.filter(|arg| !arg.is_hide_set() && !["help", "version"].contains(&arg.get_id().as_str()));
    let rows: String = shown.map(row).collect();
    if rows.is_empty() { rows } else { format!("| flag | |\n|---|---|\n{rows}") }
}

fn row(arg: &Arg) -> String {
    let values: Vec<&str> = arg.get_value_names().unwrap_or_default().iter().map(clap::builder::Str::as_str).collect();
    let value = if arg.get_num_args().is_some_and(|n| n.takes_values()) { values.join(" ") } else { String::new() };
    let names: Vec<String> = [arg.get_short().map(|c| format!("-{c}")), arg.get_long().map(|l| format!("--{l}"))]
        .into_iter()
        .flatten()
        .collect();
    let flag = match (names.is_empty(), value.is_empty()) {
        (true, _) => value,
        (false, true) => names.join(", "),
        (false, false) => format!("{} {value}", names.join(", ")),
    };
    let help = arg.get_long_help().or(arg.get_help()).map(ToString::to_string).unwrap_or_default();
    let mut words = help.split_whitespace().collect::<Vec<_>>().join(" ");
    let defaults: Vec<_> = arg.get_default_values().iter().map(|v| v.to_string_lossy()).collect();
    if !defaults.is_empty() && !value_is_flag(arg) {
        let _ = write!(words, " [{}]", defaults.join(", "));
    }
    for value in arg.get_possible_values().iter().filter(|_| !value_is_flag(arg)) {
        let meaning = value.get_help().map_or(String::new(), |h| format!(": {}", h.to_string().trim_end_matches('.')));
        let _ = write!(words, "; `{}`{meaning}", value.get_name());
    }
    format!("| `{}` | {} |\n", flag.replace('|', "\\|"), words.replace('|', "\\|").replace('<', "&lt;"))
}

/// Whether a flag has no value of its own: it is given or not.
fn value_is_flag(arg: &Arg) -> bool {
    !arg.get_action().takes_values()
}
