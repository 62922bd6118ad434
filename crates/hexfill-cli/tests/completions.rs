//! Completion scripts know the names of the catalogue.

mod common;

use common::hexfill;
use std::path::Path;
use std::process::Command;

fn script(shell: &str) -> String {
    let (code, out, err) = hexfill(Path::new("."), &["completions", shell]);
    assert_eq!((code, err.as_str()), (0, ""));
    out
}

/// What bash offers at the end of a line, split into words as bash splits it.
fn offered(line: &str, words: &[&str]) -> Option<Vec<String>> {
    let quoted: Vec<String> = words.iter().map(|w| format!("'{w}'")).collect();
    let run = format!(
        "{}\nCOMP_LINE='{line}' COMP_POINT={} COMP_CWORD={} COMP_WORDS=({})\n\
         registered=$(complete -p hexfill); registered=${{registered##*-F }}\n\
         _hexfill_words hexfill \"${{COMP_WORDS[COMP_CWORD]}}\" \"${{COMP_WORDS[COMP_CWORD-1]}}\"\n\
         printf '%s\\n' \"${{registered%% *}}\" \"${{COMPREPLY[@]}}\"",
        script("bash"),
        line.len(),
        words.len() - 1,
        quoted.join(" "),
    );
    let out = Command::new("bash").args(["--norc", "-c", &run]).output().ok()?;
    let text = String::from_utf8(out.stdout).unwrap();
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    let mut lines = text.lines().map(str::to_owned);
    assert_eq!(lines.next().as_deref(), Some("_hexfill_words"), "the function that is registered");
    Some(lines.collect())
}

#[test]
fn bash_completes_names_of_the_catalogue() {
    let Some(found) = offered("hexfill fill :cub", &["hexfill", "fill", ":", "cub"]) else {
        println!("skipped: there is no bash");
        return;
    };
    assert_eq!(found, ["cube"]);
    let all = offered("hexfill check m.vtu --surface :", &["hexfill", "check", "m.vtu", "--surface", ":"]).unwrap();
    assert!(all.contains(&"schneiders-pyramid".to_owned()) && all.len() > 5, "{all:?}");
    assert_eq!(offered("hexfill fill :no-such", &["hexfill", "fill", ":", "no-such"]).unwrap(), [""; 0]);
    // All else goes to the script of clap.
    let flags = offered("hexfill fill --stra", &["hexfill", "fill", "--stra"]).unwrap();
    assert_eq!(flags, ["--strategy"]);
}

#[test]
fn zsh_and_fish_know_the_same_names() {
    let zsh = script("zsh");
    assert!(zsh.contains("compadd -- :") && zsh.contains(" :schneiders-pyramid"));
    let surface = zsh.lines().find(|line| line.contains("':surface -- ")).unwrap();
    assert!(surface.contains(":_hexfill_words'"), "{surface}");
    let fish = script("fish");
    let names = fish.lines().find(|line| line.contains("commandline -ct") && line.contains(":schneiders-pyramid"));
    assert!(names.is_some_and(|line| line.contains(":cube ")), "{names:?}");
    assert!(script("elvish").contains("hexfill"));
}
