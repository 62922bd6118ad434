//! `hexfill completions SHELL`.

use crate::exit::Exit;
use clap::CommandFactory;
use std::io::Write;

/// Flags of `completions`.
#[derive(clap::Args)]
pub(crate) struct CompletionsArgs {
    /// The shell to complete for.
    shell: clap_complete::Shell,
}

/// Prints the completion script.
pub(crate) fn run(args: &CompletionsArgs) -> anyhow::Result<Exit> {
    // Into memory first: the generator panics if its writer fails.
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut crate::Cli::command(), "hexfill", &mut script);
    std::io::stdout().write_all(&script)?;
    Ok(Exit::Done)
}
