//! `hexfill completions SHELL`.
//!
//! clap writes the script; what it cannot know is put in here: a word that begins with a colon is a surface of the catalogue, wherever it stands.

use crate::exit::Exit;
use clap::CommandFactory;
use clap_complete::Shell;
use std::io::Write;

/// Flags of `completions`.
#[derive(clap::Args)]
pub(crate) struct CompletionsArgs {
    /// The shell to complete for.
    shell: Shell,
}

/// Prints the completion script.
pub(crate) fn run(args: &CompletionsArgs) -> anyhow::Result<Exit> {
    // Into memory first: the generator panics if its writer fails.
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut crate::Cli::command(), "hexfill", &mut script);
    let names: Vec<String> = hexfill::catalog::entries().iter().map(|entry| format!(":{}", entry.name)).collect();
    let script = with_names(args.shell, String::from_utf8(script)?, &names.join(" "));
    std::io::stdout().write_all(script.as_bytes())?;
    Ok(Exit::Done)
}

/// The script with the names of the catalogue; that of a shell whose words are not known stays as it is.
fn with_names(shell: Shell, script: String, names: &str) -> String {
    match shell {
        Shell::Bash => script + &BASH.replace("NAMES", names),
        Shell::Zsh => {
            // Every word that may be a file. The script ends with a call, so the function comes first, behind the line that must be first.
            let script = script.replace(":_default'", ":_hexfill_words'");
            script.replacen('\n', &ZSH.replace("NAMES", names), 1)
        }
        Shell::Fish => script + &FISH.replace("NAMES", names),
        _ => script,
    }
}

/// Bash breaks words at colons: what is completed is the part behind the colon.
const BASH: &str = r#"
_hexfill_words() {
    local before="${COMP_LINE:0:COMP_POINT}"
    local word="${before##*[[:space:]]}"
    if [[ "$word" == :* ]]; then
        COMPREPLY=($(compgen -W "NAMES" -- "$word"))
        [[ "$COMP_WORDBREAKS" == *:* ]] && COMPREPLY=("${COMPREPLY[@]#:}")
        return 0
    fi
    _hexfill "$@"
}

if [[ "${BASH_VERSINFO[0]}" -eq 4 && "${BASH_VERSINFO[1]}" -ge 4 || "${BASH_VERSINFO[0]}" -gt 4 ]]; then
    complete -F _hexfill_words -o nosort -o bashdefault -o default hexfill
else
    complete -F _hexfill_words -o bashdefault -o default hexfill
fi
"#;

const ZSH: &str = r#"
_hexfill_words() {
    if [[ "$PREFIX" == :* ]]; then
        compadd -- NAMES
    else
        _default
    fi
}
"#;

const FISH: &str = r#"
complete -c hexfill -n "string match -q ':*' -- (commandline -ct)" -a "NAMES"
"#;
