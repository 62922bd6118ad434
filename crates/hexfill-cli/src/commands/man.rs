//! `hexfill man [COMMAND]`.

use crate::exit::Exit;
use anyhow::bail;
use clap::CommandFactory;
use std::io::Write;

/// Flags of `man`.
#[derive(clap::Args)]
pub(crate) struct ManArgs {
    /// The command to describe [default: hexfill as a whole].
    command: Option<String>,
}

/// Prints the page, made from the flags themselves.
pub(crate) fn run(args: &ManArgs) -> anyhow::Result<Exit> {
    let mut whole = crate::Cli::command();
    whole.build();
    let page = match &args.command {
        None => clap_mangen::Man::new(whole),
        Some(name) => {
            let Some(command) = whole.find_subcommand(name) else {
                bail!("hexfill has no command {name}; see `hexfill --help`");
            };
            clap_mangen::Man::new(command.clone())
        }
    };
    let mut text = Vec::new();
    page.render(&mut text)?;
    std::io::stdout().write_all(&text)?;
    Ok(Exit::Done)
}
