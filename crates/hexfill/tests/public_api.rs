//! The public items of the facade, as a listing that must be changed on purpose: `HEXFILL_UPDATE=1 cargo test -p hexfill --test public_api` writes it
//! anew. What `src/lib.rs` exports is a promise; a line that goes or changes is a breaking change and belongs into the changelog.

use std::fs;
use std::path::{Path, PathBuf};

/// Rust files below a folder, sorted.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// Whether the braces and brackets opened in a text are closed in it.
fn is_closed(text: &str) -> bool {
    let count = |chars: &[char]| text.matches(chars).count();
    count(&['{', '(', '[']) == count(&['}', ')', ']'])
}

/// The item that begins at a line: of a struct, an enum or an import all of it, of a function its head.
fn item(lines: &[&str]) -> String {
    let mut text = String::new();
    for line in lines {
        let line = line.trim();
        if line.starts_with("//") || line.starts_with("#[") || line.starts_with("pub(") {
            continue;
        }
        text += line;
        text.push(' ');
        let head = text.trim_end();
        let is_function = head.contains("fn ") && !head.starts_with("pub struct");
        if is_function && head.ends_with('{') {
            return head.trim_end_matches('{').trim_end().to_owned();
        }
        if is_closed(head) && (head.ends_with(';') || head.ends_with('}')) {
            break;
        }
    }
    text.trim_end().to_owned()
}

/// The public items of a file, each with the type it belongs to; tests left out.
fn listed(source: &str) -> Vec<String> {
    let code = source.split("#[cfg(test)]").next().unwrap();
    let lines: Vec<&str> = code.lines().collect();
    let mut of = String::new();
    let mut found = Vec::new();
    for (i, line) in lines.iter().enumerate() {
        if let Some(head) = line.strip_prefix("impl") {
            of = head.trim().trim_end_matches('{').trim().to_owned();
        }
        let Some(text) = line.trim_start().strip_prefix("pub ") else { continue };
        let inside = line.starts_with("    ");
        if inside && !text.starts_with("fn ") && !text.starts_with("const ") {
            continue; // Fields come with their struct.
        }
        let text = item(&lines[i..]);
        found.push(if inside { format!("{of}: {text}") } else { text });
    }
    found
}

#[test]
fn the_public_items_are_those_listed() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut all: Vec<String> =
        sources(&root.join("src")).iter().flat_map(|path| listed(&fs::read_to_string(path).unwrap())).collect();
    all.sort();
    let listing = all.join("\n") + "\n";
    let golden = root.join("public_api.txt");
    if std::env::var_os("HEXFILL_UPDATE").is_some() {
        fs::write(&golden, &listing).unwrap();
    }
    let before = fs::read_to_string(&golden).unwrap();
    for line in before.lines().filter(|line| !listing.lines().any(|l| l == *line)) {
        println!("- {line}");
    }
    for line in listing.lines().filter(|line| !before.lines().any(|l| l == *line)) {
        println!("+ {line}");
    }
    assert!(before == listing, "the public items changed: see the lines above, the changelog, and HEXFILL_UPDATE=1");
}

#[test]
fn a_changed_field_or_signature_is_seen() {
    let source = "/// A.\npub struct A {\n    /// x.\n    pub x: u8,\n    pub(crate) y: u8,\n}\n\nimpl A {\n    pub fn f(\n        &self,\n    ) -> u8 {\n        0\n    }\n    pub(crate) fn g() {}\n}\n";
    assert_eq!(listed(source), ["pub struct A { pub x: u8, }", "A: pub fn f( &self, ) -> u8"]);
    assert_ne!(listed(source), listed(&source.replace("pub x: u8", "pub x: u16")));
    assert_ne!(listed(source), listed(&source.replace("-> u8", "-> u16")));
}
