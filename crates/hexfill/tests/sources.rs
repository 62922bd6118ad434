//! Every module names its source, and the book's bibliography names nothing that is not used: both sides are read here.

use std::fs;
use std::path::{Path, PathBuf};

/// Words that may stand in the place of a key: ideas that are ours, or everybody's, or told by the files of a folder.
const NO_KEY: [&str; 4] = ["ours", "textbook knowledge", "name", "as said"];
/// Modules that only list, say or choose something.
const WITHOUT: [&str; 8] =
    ["lib.rs", "main.rs", "error.rs", "options.rs", "report.rs", "missing.rs", "sweep_options.rs", "samples.rs"];

/// Rust files of the workspace's crates, sorted; tests are left out, and so are the programs, which are flags and glue.
fn modules() -> Vec<PathBuf> {
    fn add(folder: &Path, found: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                add(&path, found);
            } else if path.extension().is_some_and(|e| e == "rs") {
                found.push(path);
            }
        }
    }
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let mut found = Vec::new();
    for entry in fs::read_dir(crates).unwrap() {
        let room = entry.unwrap().path();
        let is_glue = ["hexfill-cli", "hexfill-mpi"].iter().any(|glue| room.ends_with(glue));
        if !is_glue && room.join("src").is_dir() {
            add(&room.join("src"), &mut found);
        }
    }
    found.sort();
    found
}

/// The page of a module: the `//!` lines at its head, without the marks, in one line.
fn page(text: &str) -> String {
    let lines = text.lines().map_while(|l| l.strip_prefix("//!"));
    lines.map(str::trim).collect::<Vec<_>>().join(" ")
}

fn bibliography() -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../book/src/bibliography.md")).unwrap()
}

/// The keys: the first cells of the tables' rows. Two works in one row ("Bowyer 1981, Watson 1981") are one key.
fn keys(bibliography: &str) -> Vec<&str> {
    let cells = bibliography.lines().filter_map(|l| l.strip_prefix("| ")?.split(" |").next());
    cells.filter(|key| !key.starts_with("---") && *key != "key").collect()
}

#[test]
fn every_module_names_its_source() {
    let bibliography = bibliography();
    let keys = keys(&bibliography);
    let mut silent = Vec::new();
    for path in modules() {
        let name = path.file_name().unwrap().to_str().unwrap();
        // Files of tests are called so; the others are oracles and surfaces for tests.
        let is_test = name.contains("test") || ["oracle.rs", "check.rs"].contains(&name);
        let text = fs::read_to_string(&path).unwrap();
        // A folder's page that only lists its files has nothing to name.
        let is_list = name == "mod.rs" && !text.contains("fn ");
        if is_test || is_list || WITHOUT.contains(&name) {
            continue;
        }
        let page = page(&text);
        let names = page.split_once("Source: ").map(|(_, source)| source);
        if !names.is_some_and(|s| keys.iter().chain(&NO_KEY).any(|key| s.contains(key))) {
            silent.push(path);
        }
    }
    assert!(
        silent.is_empty(),
        "these modules do not end their page with `Source: ` and a key of book/src/bibliography.md, or \"ours\": {silent:#?}"
    );
}

#[test]
fn every_key_is_named_and_every_file_named_is_there() {
    let bibliography = bibliography();
    let modules = modules();
    let pages: Vec<String> = modules.iter().map(|path| page(&fs::read_to_string(path).unwrap())).collect();
    let unnamed: Vec<&str> =
        keys(&bibliography).into_iter().filter(|key| !pages.iter().any(|page| page.contains(key))).collect();
    assert!(unnamed.is_empty(), "no module names {unnamed:?}");
    for row in bibliography.lines().filter(|l| l.starts_with("| ")) {
        let used = row.trim_end_matches(" |").rsplit(" | ").next().unwrap();
        for file in used.split('`').filter(|word| word.ends_with(".rs")) {
            assert!(modules.iter().any(|path| path.ends_with(file)), "{file}, named in {row}, is not there");
        }
    }
}
