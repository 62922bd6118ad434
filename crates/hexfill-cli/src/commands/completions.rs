//! `hexfill completions SHELL`.

use crate::exit::Exit;
use clap::CommandFactory;

/// Flags of `completions`.
#[derive(clap::Args)]
pub struct CompletionsArgs {
    /// The shell to complete for.
    shell: clap_complete::Shell,
}

/// Prints the completion script.
pub fn run(args: &CompletionsArgs) -> anyhow::Result<Exit> {
    clap_complete::generate(args.shell, &mut crate::Cli::command(), "hexfill", &mut std::io::stdout());
    Ok(Exit::Done)
}
