//! The tables of the book's page on JSON reports, against what the program prints: every key is there, and no other.

mod common;

use common::{hexfill, json};
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::Path;

const LIMITS: [&str; 8] = [
    "no_direction",
    "poor_direction",
    "sharp_edges",
    "slit_edges",
    "turning_sides",
    "flat_corners",
    "needle_corners",
    "reflex_corners",
];

/// Objects said to be the same again, or to hold what `info` says of a vertex, corner or edge; a `boundary` that is text is a signature.
const SAID_ELSEWHERE: [&str; 4] = ["mended.after", "limits.KIND.first[]", "boundary", "counts"];

/// The keys of a report as the page writes them.
fn keys(value: &Value, path: &str, all: &mut BTreeSet<String>) {
    match value {
        Value::Object(_) if SAID_ELSEWHERE.contains(&path) => drop(all.insert(path.to_owned())),
        Value::Object(object) => object.iter().for_each(|(key, value)| {
            let key = if LIMITS.contains(&key.as_str()) { "KIND" } else { key };
            let key = if key.parse::<i32>().is_ok() { "N" } else { key };
            keys(value, &if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") }, all);
        }),
        Value::Array(values) if values.is_empty() => drop(all.insert(format!("{path}[]"))),
        Value::Array(values) => values.iter().for_each(|value| keys(value, &format!("{path}[]"), all)),
        _ => drop(all.insert(path.to_owned())),
    }
}

/// The keys in the first column of the table of a section.
fn listed(page: &str, section: &str) -> BTreeSet<String> {
    let rest = page.split_once(&format!("## `{section}`")).unwrap().1;
    let table = rest.lines().skip(1).take_while(|line| !line.starts_with("## ")).filter(|line| line.starts_with("| `"));
    let columns = table.map(|line| line.split('|').nth(1).unwrap());
    columns.flat_map(|keys| keys.split(',').map(|key| key.trim().trim_matches('`').to_owned())).collect()
}

#[test]
fn the_page_lists_every_key_and_no_other() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let page = std::fs::read_to_string(root.join("book/src/json.md")).unwrap();
    let sick = |name: &str| root.join("corpus/sick").join(name).to_str().unwrap().to_owned();
    let (odd, crossing, open) = (sick("odd_ball.obj"), sick("crossing_boxes.obj"), sick("open_box.obj"));
    let dir = tempfile::tempdir().unwrap();
    let radial = root.join("corpus/surfaces/radial_12.obj").to_str().unwrap().to_owned();
    let runs: [(&str, &[&[&str]]); 19] = [
        (
            "fill",
            &[
                &["fill", ":schneiders-pyramid", "-o", "a.vtu"],
                &["fill", ":schneiders-pyramid", "-o", "b.vtu", "--layers", "2"],
                &["fill", &crossing, "-o", "c.vtu", "--no-embed"],
                &["fill", &radial, "-o", "d.vtu", "--time-limit", "1ms"],
            ],
        ),
        (
            "check",
            &[&["check", "a.vtu", "--surface", ":schneiders-pyramid"], &["check", "a.vtu", "--surface", ":cube"]],
        ),
        ("info", &[&["info", ":schneiders-pyramid"], &["info", &odd], &["info", &radial]]),
        ("info MESH", &[&["info", "a.vtu"]]),
        ("doctor", &[&["doctor", &odd, "--fix", "-o", "even.obj"], &["doctor", &open]]),
        ("search", &[&["search", ":cube", "--max-hexes", "7"]]),
        ("records", &[&["records"]]),
        ("simplify", &[&["simplify", "b.vtu", "-o", "e.vtu", "--balls", "9"]]),
        ("convert", &[&["convert", "a.vtu", "-o", "e.vtk"]]),
        ("view", &[&["view", "a.vtu", "-o", "e.html"]]),
        ("catalog", &[&["catalog"]]),
        ("atlas stats", &[&["atlas", "stats"]]),
        ("atlas build", &[&["atlas", "build", "-o", "a.hxgrow", "--levels", "3"]]),
        (
            "atlas complete",
            &[&[
                "atlas",
                "complete",
                "b.hxgrow",
                "-o",
                "c.hxatlas",
                "--levels",
                "3",
                "--max-quads",
                "8",
                "--efforts",
                "0",
            ]],
        ),
        ("atlas prune", &[&["atlas", "prune", "c.hxatlas", "-o", "d.hxatlas"]]),
        ("enumerate", &[&["enumerate", "3", "-u"], &["enumerate", "3", "-u", "--checkpoint", "part", "--chunks", "4"]]),
        ("enumerate merge", &[&["enumerate", "merge", "part"], &["enumerate", "show", "part"]]),
        ("enumerate verify", &[&["enumerate", "verify", "part"]]),
        ("enumerate show", &[&["enumerate", "show", "0 1 2 3 4 5 6 7"]]),
    ];
    for (section, commands) in runs {
        let mut seen = BTreeSet::new();
        for command in commands {
            let mut args = command.to_vec();
            args.push("--json");
            let (_, out, err) = hexfill(dir.path(), &args);
            assert!(out.starts_with('{'), "{command:?}: {err}");
            keys(&json(&out), "", &mut seen);
        }
        // An array that is empty in one report and holds objects in another, null here and an object there: the longer names say it.
        let longer = seen.clone();
        seen.retain(|key| {
            !longer.iter().any(|k| {
                k.len() > key.len() && (k.starts_with(&format!("{key}.")) || k.starts_with(&format!("{key}[")))
            })
        });
        let listed = listed(&page, section);
        let missing: Vec<_> = seen.difference(&listed).collect();
        let gone: Vec<_> = listed.difference(&seen).collect();
        assert!(
            missing.is_empty() && gone.is_empty(),
            "{section}: not on the page: {missing:?}; not printed: {gone:?}"
        );
    }
}
