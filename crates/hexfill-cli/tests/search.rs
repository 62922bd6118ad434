//! `hexfill search`: exit codes, the same sums however the work is divided, and what it does not take.

mod common;

use common::{hexfill, json};
use serde_json::Value;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

const PYRAMID: [&str; 4] = ["search", ":schneiders-pyramid", "--max-hexes", "12"];

/// Exit code and report.
fn report(dir: &Path, args: &[&str], more: &[&str]) -> (i32, Value) {
    let (code, out, err) = hexfill(dir, &[args, more, &["--json"]].concat());
    assert!(out.starts_with('{'), "{args:?} {more:?}: {err}");
    (code, json(&out))
}

/// What two runs of the same question must agree on.
fn sums(report: &Value) -> Vec<Value> {
    ["boundary", "class", "exhausted", "counts", "meshes", "nodes", "tree_sum", "hash_sum", "exit_code"]
        .iter()
        .map(|key| report[key].clone())
        .collect()
}

#[test]
fn found_is_0_exhausted_is_1_stopped_is_3() {
    let dir = tempfile::tempdir().unwrap();
    let (code, found) = report(dir.path(), &["search", ":cube", "--max-hexes", "7"], &[]);
    assert_eq!((code, &found["exhausted"]), (0, &true.into()));
    assert_eq!(found["counts"], serde_json::json!([{ "hexes": 1, "classes": 1 }, { "hexes": 7, "classes": 1 }]));
    assert_eq!(found["meshes"][1]["hexes"].as_array().unwrap().len(), 7);
    let (code, none) = report(dir.path(), &PYRAMID, &[]);
    assert_eq!((code, &none["exhausted"], &none["counts"]), (1, &true.into(), &serde_json::json!([])));
    let (code, stopped) = report(dir.path(), &PYRAMID, &["--time-limit", "1ms"]);
    assert_eq!((code, &stopped["exhausted"], &stopped["stopped"]), (3, &false.into(), &"time-limit".into()));
}

#[test]
fn meshes_found_are_written_and_fill_the_surface() {
    let dir = tempfile::tempdir().unwrap();
    let (code, found) = report(dir.path(), &["search", ":cube", "--max-hexes", "7", "-o", "found/here"], &[]);
    assert_eq!(code, 0);
    for (file, mesh) in ["1-1", "7-1"].iter().zip(found["meshes"].as_array().unwrap()) {
        let file = format!("found/here/{file}.json");
        let written = json(&std::fs::read_to_string(dir.path().join(&file)).unwrap());
        assert_eq!(written["hexes"], mesh["hexes"]);
        let (code, _, err) = hexfill(dir.path(), &["check", &file, "--surface", ":cube"]);
        assert_eq!(code, 0, "{err}");
    }
}

#[test]
fn threads_and_parts_do_not_show() {
    let dir = tempfile::tempdir().unwrap();
    for (surface, hexes, symmetry) in
        [(":schneiders-pyramid", "13", "none"), (":cube", "7", "none"), (":cube", "7", "auto")]
    {
        let question = |part: &'static str| {
            let mut words = vec!["search", surface, "--max-hexes", hexes, "--symmetry", symmetry];
            words.extend((!part.is_empty()).then_some(part));
            words
        };
        let folder = format!("{}-{symmetry}", &surface[1..]);
        let kept = ["--checkpoint", folder.as_str()];
        let whole = report(dir.path(), &question(""), &["-j", "1"]).1;
        assert_eq!(sums(&report(dir.path(), &question(""), &["-j", "2"]).1), sums(&whole));
        for part in ["0/3", "2/3"] {
            let (code, one) = report(dir.path(), &question(part), &kept);
            assert_eq!((code, &one["exhausted"]), (0, &false.into()));
        }
        let (code, _, err) = hexfill(dir.path(), &[&question("")[..], &kept, &["--merge"]].concat());
        assert_eq!(code, 2, "a part is missing: {err}");
        report(dir.path(), &question("1/3"), &kept);
        let (_, merged) = report(dir.path(), &question(""), &[&kept[..], &["--merge"]].concat());
        assert_eq!(sums(&merged), sums(&whole), "{surface}");
    }
}

#[test]
#[cfg(unix)]
fn killed_and_begun_again_it_ends_with_the_same_sums() {
    let dir = tempfile::tempdir().unwrap();
    let question = ["search", ":schneiders-pyramid", "--max-hexes", "15"];
    let kept = ["--checkpoint", "kept"];
    for signal in ["-KILL", "-INT"] {
        let mut child = Command::new(assert_cmd::cargo::cargo_bin("hexfill"))
            .current_dir(dir.path())
            .args([&question[..], &kept].concat())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        // Until some more chunks are in the ledger.
        let size = || -> u64 {
            let files = std::fs::read_dir(dir.path().join("kept")).into_iter().flatten();
            files.map(|file| file.unwrap().metadata().unwrap().len()).sum()
        };
        let (before, begun) = (size(), Instant::now());
        while size() < before + 400 && begun.elapsed() < Duration::from_secs(120) {
            std::thread::sleep(Duration::from_millis(20));
        }
        assert!(child.try_wait().unwrap().is_none(), "it was to be killed in between");
        Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap();
        let code = child.wait().unwrap().code();
        assert_eq!(code, if signal == "-INT" { Some(3) } else { None });
    }
    let (_, resumed) = report(dir.path(), &question, &kept);
    assert!(resumed["chunks_found_done"].as_u64().unwrap() > 0);
    let (_, whole) = report(dir.path(), &question, &[]);
    assert_eq!(sums(&resumed), sums(&whole));
}

#[test]
fn what_it_does_not_take_is_said_with_a_remedy() {
    let dir = tempfile::tempdir().unwrap();
    let quad = |i: u32, j: u32| {
        let at = |i: u32, j: u32| 4 * (i % 4) + j % 4;
        [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]
    };
    let quads: Vec<[u32; 4]> = (0..16).map(|v| quad(v / 4, v % 4)).collect();
    std::fs::write(dir.path().join("torus.json"), serde_json::json!({ "quads": quads }).to_string()).unwrap();
    std::fs::write(dir.path().join("open.json"), serde_json::json!({ "quads": [[0, 1, 2, 3]] }).to_string()).unwrap();
    for (args, words) in [
        (&["torus.json", "--max-hexes", "4"][..], "not one sphere"),
        (&["open.json", "--max-hexes", "4"], "open"),
        (&[":cube", "--max-hexes", "0"], "1 to 120"),
        (&[":cube", "--max-hexes", "99999999999999"], "1 to 120"),
        (&[":cube"], "--max-hexes"),
        (&[":cube", "--max-hexes", "2", "--symmetry", "999"], "--list-symmetries"),
        (&[":cube", "--max-hexes", "2", "0/2"], "--checkpoint"),
        (&[":cube", "--max-hexes", "2", "--merge", "--checkpoint", "nowhere"], "nowhere"),
    ] {
        let (code, _, err) = hexfill(dir.path(), &[&["search"], args].concat());
        assert_eq!(code, 2, "{args:?}: {err}");
        assert!(err.contains(words), "{args:?}: {err}");
    }
}
