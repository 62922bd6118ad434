//! `hexfill simplify` through the real binary: fewer hexes, the boundary bit for bit, wrong input, interruption.

mod common;

use common::{hexfill, json};
use std::path::Path;
use std::time::{Duration, Instant};

/// A construction for the pyramid, not embedded.
fn constructed(dir: &Path, out: &str) -> u64 {
    let args = ["fill", ":schneiders-pyramid", "--strategy", "construct", "--no-embed", "--json", "-o", out];
    let (code, report, err) = hexfill(dir, &args);
    assert_eq!(code, 0, "{err}");
    json(&report)["meshes"][0]["hexes"].as_u64().unwrap()
}

#[test]
fn a_block_becomes_coarser_inside_and_embeds() {
    let dir = tempfile::tempdir().unwrap();
    // 9 x 9 x 9 cubes as an Abaqus file of someone else would have them.
    let at = |x: u32, y: u32, z: u32| z * 100 + y * 10 + x + 1;
    let mut text = String::from("*NODE\n");
    let all = |n: u32| (0..n * n * n).map(move |i| [i % n, i / n % n, i / n / n]);
    all(10).for_each(|[x, y, z]| text += &format!("{}, {x}, {y}, {z}\n", at(x, y, z)));
    text += "*ELEMENT, TYPE=C3D8\n";
    for (i, [x, y, z]) in all(9).enumerate() {
        let corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];
        let corners = corners.map(|[a, b, c]| at(x + a, y + b, z + c).to_string());
        text += &format!("{}, {}\n", i + 1, corners.join(", "));
    }
    std::fs::write(dir.path().join("block.inp"), text).unwrap();
    let args = ["simplify", "block.inp", "-o", "coarse.vtu", "--coarsen", "--json"];
    let (code, report, err) = hexfill(dir.path(), &args);
    assert_eq!(code, 0, "{err}");
    let report = json(&report);
    assert_eq!((&report["hexes_before"], &report["boundary_quads"]), (&729.into(), &486.into()));
    assert!(report["hexes"].as_u64().unwrap() < 600, "{report}");
    let (code, _, err) = hexfill(dir.path(), &["embed", "coarse.vtu", "-o", "good.vtu", "--require-valid"]);
    assert_eq!(code, 0, "{err}");
    let (code, out, _) = hexfill(dir.path(), &["check", "good.vtu"]);
    assert_eq!(code, 0, "{out}");
    // With what tries balls it makes no sense.
    let (code, _, err) = hexfill(dir.path(), &["simplify", "block.inp", "-o", "x.vtu", "--coarsen", "--balls", "3"]);
    assert_eq!(code, 2);
    assert!(err.contains("--coarsen") && err.contains("--balls"), "{err}");
}

#[track_caller]
fn assert_judged(dir: &Path, mesh: &str, hexes: u64) {
    let (_, out, _) = hexfill(dir, &["check", mesh, "--surface", ":schneiders-pyramid", "--json"]);
    let report = json(&out);
    assert!(report["levels"].as_array().unwrap()[..=2].iter().all(|l| l["outcome"] == "passed"), "{out}");
    assert_eq!(report["facts"]["hexes"], hexes);
    assert_eq!(report["facts"]["ball"], "yes");
}

#[test]
fn a_construction_becomes_smaller_and_keeps_its_boundary() {
    let dir = tempfile::tempdir().unwrap();
    let before = constructed(dir.path(), "large.json");
    let mut seen = Vec::new();
    for (out, threads) in [("small.json", "1"), ("again.json", "2")] {
        let args = ["simplify", "large.json", "-o", out, "--balls", "3000", "--seed", "5", "-j", threads, "--json"];
        let (code, report, err) = hexfill(dir.path(), &args);
        assert_eq!(code, 0, "{err}");
        let report = json(&report);
        assert_eq!((&report["hexes_before"], &report["stopped"]), (&before.into(), &"finished".into()));
        let hexes = report["hexes"].as_u64().unwrap();
        assert!(hexes < before * 9 / 10, "{before} -> {hexes}");
        assert_eq!(report["boundary_quads"], 16);
        assert_judged(dir.path(), out, hexes);
        seen.push(std::fs::read(dir.path().join(out)).unwrap());
    }
    assert_eq!(seen[0], seen[1], "the same bytes for any number of threads");
    let points = |file: &str| json(&std::fs::read_to_string(dir.path().join(file)).unwrap())["points"].clone();
    let (old, new) = (points("large.json"), points("small.json"));
    let bits = |p: &serde_json::Value| -> Vec<u64> {
        p.as_array().unwrap().iter().map(|x| x.as_f64().unwrap().to_bits()).collect()
    };
    for v in 0..18 {
        assert_eq!(bits(&old[v]), bits(&new[v]), "boundary vertex {v}");
    }
    assert!(
        new.as_array().unwrap().iter().flat_map(|p| p.as_array().unwrap()).all(|x| x.as_f64().unwrap().is_finite())
    );
}

#[test]
fn collapses_alone_need_no_balls() {
    let dir = tempfile::tempdir().unwrap();
    let before = constructed(dir.path(), "large.json");
    let args = ["simplify", "large.json", "-o", "small.json", "--collapse-only", "--json"];
    let (code, report, err) = hexfill(dir.path(), &args);
    assert_eq!(code, 0, "{err}");
    let report = json(&report);
    assert_eq!(report["balls"], 0);
    assert!(report["sheets"].as_u64().unwrap() > 0, "{report}");
    let hexes = report["hexes"].as_u64().unwrap();
    assert_eq!(hexes + report["collapsed_hexes"].as_u64().unwrap(), before);
    assert_judged(dir.path(), "small.json", hexes);
    let (code, _, _) =
        hexfill(dir.path(), &["simplify", "large.json", "-o", "x.json", "--collapse-only", "--balls", "9"]);
    assert_eq!(code, 2);
}

#[test]
fn certificates_are_kept() {
    let dir = tempfile::tempdir().unwrap();
    let args = ["fill", ":cube", "--strategy", "construct", "-o", "large.json"];
    let (code, _, err) = hexfill(dir.path(), &args);
    assert_eq!(code, 0, "{err}");
    let mut reports = Vec::new();
    for (out, threads) in [("small.json", "1"), ("again.json", "2")] {
        let args = ["simplify", "large.json", "-o", out, "--keep-valid", "--balls", "500", "-j", threads, "--json"];
        let (code, report, err) = hexfill(dir.path(), &args);
        assert_eq!(code, 0, "{err}");
        reports.push(json(&report));
    }
    let number = |key: &str| reports[0][key].as_u64().unwrap();
    assert!(number("hexes") < number("hexes_before") && number("refused") > 0, "{}", reports[0]);
    let read = |file: &str| std::fs::read(dir.path().join(file)).unwrap();
    assert_eq!(read("small.json"), read("again.json"));
    let checked = |file: &str| {
        let (code, out, err) = hexfill(dir.path(), &["check", file, "--surface", ":cube", "--json"]);
        assert_eq!(code, 0, "every hex certified: {err}");
        json(&out)["geometry"]["quality"]["certified_scaled_jacobian"][0].as_f64().unwrap()
    };
    assert!(checked("small.json") >= checked("large.json"));
    let (code, _, _) = hexfill(dir.path(), &["simplify", "large.json", "-o", "x.json", "--keep-valid", "--heat", "9"]);
    assert_eq!(code, 2);
}

#[test]
fn what_cannot_become_smaller_is_written_as_it_was() {
    let dir = tempfile::tempdir().unwrap();
    let (code, _, err) = hexfill(dir.path(), &["fill", ":cube", "-o", "cube.json"]);
    assert_eq!(code, 0, "{err}");
    let (code, _, err) = hexfill(dir.path(), &["simplify", "cube.json", "-o", "same.json"]);
    assert_eq!(code, 0, "{err}");
    assert!(err.contains("nothing smaller was found"), "{err}");
    let hexes = |file: &str| json(&std::fs::read_to_string(dir.path().join(file)).unwrap())["hexes"].clone();
    assert_eq!(hexes("cube.json"), hexes("same.json"));
}

#[test]
fn a_time_limit_ends_the_work_with_what_there_is() {
    let dir = tempfile::tempdir().unwrap();
    let before = constructed(dir.path(), "large.json");
    let start = Instant::now();
    let args = ["simplify", "large.json", "-o", "small.json", "--time-limit", "4s", "--json"];
    let (code, report, err) = hexfill(dir.path(), &args);
    assert_eq!(code, 3, "{err}");
    assert!(start.elapsed() < Duration::from_secs(60));
    let report = json(&report);
    assert_eq!(report["stopped"], "time-limit");
    let hexes = report["hexes"].as_u64().unwrap();
    assert!(hexes <= before);
    assert_judged(dir.path(), "small.json", hexes);
}

#[test]
fn fill_simplifies_when_asked() {
    let dir = tempfile::tempdir().unwrap();
    let before = constructed(dir.path(), "large.json");
    for extra in [["--simplify", "--no-embed", "--time-limit", "6s"].as_slice(), &["--no-embed", "--time-limit", "6s"]]
    {
        let args = ["fill", ":schneiders-pyramid", "--strategy", "construct", "--json", "-o", "small.json"];
        let (code, report, err) = hexfill(dir.path(), &[&args, extra].concat());
        assert_eq!(code, 0, "{err}");
        let hexes = json(&report)["meshes"][0]["hexes"].as_u64().unwrap();
        assert!(hexes < before, "{before} -> {hexes}");
        assert_judged(dir.path(), "small.json", hexes);
    }
}

#[test]
fn wrong_input_is_refused_with_its_reason() {
    let dir = tempfile::tempdir().unwrap();
    constructed(dir.path(), "large.json");
    let point = |i: usize| format!("[{}.0,0.0,0.0]", i);
    let points: Vec<String> = (0..12).map(point).collect();
    // Two hexes that share one diagonal of a quad and nothing else.
    let bad = format!("{{\"points\":[{}],\"hexes\":[[0,1,2,3,4,5,6,7],[0,8,2,9,10,11,1,3]]}}", points.join(","));
    std::fs::write(dir.path().join("bad.json"), bad).unwrap();
    for (args, words) in [
        (["simplify", "large.json", "-o", "large.json"], "same file"),
        (["simplify", "none.json", "-o", "o.json"], "no such file"),
        (["simplify", "large.json", "-o", "o.nothing"], "o.nothing"),
        (["simplify", "large.json", "-o", "gone/o.json"], "does not exist"),
        (["simplify", "bad.json", "-o", "o.json"], "not proper"),
    ] {
        let (code, out, err) = hexfill(dir.path(), &args);
        assert_eq!((code, out.as_str()), (2, ""), "{args:?}: {err}");
        assert!(err.contains(words), "{args:?}: {err}");
        assert!(!dir.path().join("o.json").exists());
    }
}
