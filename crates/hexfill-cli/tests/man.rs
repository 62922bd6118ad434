//! Pages made from the flags.

mod common;

use common::hexfill;
use std::path::Path;

#[test]
fn the_page_of_the_book_has_the_flags_of_the_program() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../book/src/flags.md");
    let (code, made, err) = hexfill(Path::new("."), &["man", "--markdown"]);
    assert_eq!(code, 0, "{err}");
    let kept = std::fs::read_to_string(page).unwrap();
    let differs = kept.lines().zip(made.lines()).find(|(kept, made)| kept != made);
    assert!(kept == made, "hexfill man --markdown > book/src/flags.md; first difference: {differs:?}");
}

#[test]
fn every_command_has_a_manual_page() {
    let (_, whole, _) = hexfill(Path::new("."), &["man"]);
    let commands = whole.lines().filter_map(|l| l.strip_prefix("hexfill\\-")?.strip_suffix("(1)"));
    let commands: Vec<String> = commands.map(|name| name.replace('\\', "")).filter(|name| name != "help").collect();
    assert!(commands.len() > 12, "{commands:?}");
    for command in commands {
        let (code, page, err) = hexfill(Path::new("."), &["man", &command]);
        assert!(code == 0 && page.contains(".SH SYNOPSIS"), "{command}: {err}");
    }
}
