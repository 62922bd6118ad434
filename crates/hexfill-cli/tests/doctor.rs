//! `hexfill doctor` on the sick surfaces of the corpus, and on what cannot be examined.

mod common;

use common::{hexfill, json};
use std::path::{Path, PathBuf};

fn sick(name: &str) -> String {
    let folder: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../corpus/sick");
    folder.join(name).to_str().unwrap().to_owned()
}

/// Examines and mends; the kinds found before and after, and the exit code.
fn mended(name: &str, flags: &[&str]) -> (Vec<String>, Vec<String>, i32) {
    let dir = tempfile::tempdir().unwrap();
    let surface = sick(name);
    let mut args = vec!["doctor", surface.as_str(), "--fix", "-o", "mended.obj", "--json"];
    args.extend(flags);
    let (code, stdout, _) = hexfill(dir.path(), &args);
    let report = json(&stdout);
    assert_eq!(report["exit_code"], code);
    let kinds = |found: &serde_json::Value| -> Vec<String> {
        found["findings"].as_array().unwrap().iter().map(|f| f["kind"].as_str().unwrap().to_owned()).collect()
    };
    let after = &report["mended"]["after"];
    assert_eq!(after["can_be_filled"], code == 0);
    if code == 0 {
        // What it says can be filled is filled.
        let (code, _, stderr) = hexfill(dir.path(), &["fill", "mended.obj", "-o", "mesh.vtk", "--no-embed"]);
        assert_eq!(code, 0, "{stderr}");
    }
    (kinds(&report), kinds(after), code)
}

#[test]
fn what_can_be_mended_is_and_then_filled() {
    let found = |kinds: &[&str]| kinds.iter().map(|k| (*k).to_owned()).collect::<Vec<_>>();
    assert_eq!(mended("mixed_box.obj", &[]), (found(&["triangles"]), found(&[]), 0));
    assert_eq!(mended("odd_ball.obj", &[]), (found(&["odd-quads"]), found(&[]), 0));
    assert_eq!(mended("odd_ball.obj", &["--refine"]), (found(&["odd-quads"]), found(&[]), 0));
    assert_eq!(mended("seams_box.obj", &[]), (found(&["coincident-points", "open-edges"]), found(&[]), 0));
    assert_eq!(mended("seams_box.obj", &["--weld", "0"]), (found(&[]), found(&[]), 0));
    assert_eq!(mended("mixed_box.obj", &["--refine"]), (found(&["triangles"]), found(&[]), 0));
    let crossing = found(&["crossing-faces"]);
    assert_eq!(mended("crossing_boxes.obj", &[]), (crossing.clone(), crossing, 0));
}

#[test]
fn what_cannot_is_said() {
    let found = |kinds: &[&str]| kinds.iter().map(|k| (*k).to_owned()).collect::<Vec<_>>();
    let open = found(&["open-edges"]);
    assert_eq!(mended("open_box.obj", &[]), (open.clone(), open, 1));
}

#[test]
fn quads_that_cross_are_named_before_the_work() {
    let dir = tempfile::tempdir().unwrap();
    let (_, _, stderr) = hexfill(dir.path(), &["fill", &sick("crossing_boxes.obj"), "-o", "mesh.vtk", "--no-embed"]);
    assert!(stderr.contains("30 pairs of quads cross or touch (q4 and q32"), "{stderr}");
}

#[test]
fn meshes_and_named_surfaces() {
    let dir = tempfile::tempdir().unwrap();
    let (code, stdout, _) = hexfill(dir.path(), &["doctor", ":schneiders-pyramid"]);
    assert!(code == 0 && stdout.contains("takes it as it is"));
    let regions = sick("../surfaces/three_regions.obj");
    let (code, stdout, _) = hexfill(dir.path(), &["doctor", &regions]);
    let said = |words: &str| stdout.contains(words);
    assert!(code == 0 && said("walls of 3 regions: v4-v5,") && said("; each is filled by itself"), "{stdout}");
    assert_eq!(hexfill(dir.path(), &["fill", ":cube", "-o", "cube.mesh"]).0, 0);
    let (code, _, stderr) = hexfill(dir.path(), &["doctor", "cube.mesh", "--fix", "-o", "cube.mesh"]);
    assert!(code == 2 && stderr.contains("same file"), "{stderr}");
    let (code, _, stderr) = hexfill(dir.path(), &["doctor", "none.obj"]);
    assert!(code == 2 && stderr.contains("no such file"), "{stderr}");
}

#[test]
fn more_threads_than_the_cores_can_carry_are_not_started() {
    let dir = tempfile::tempdir().unwrap();
    let (code, _, stderr) = hexfill(dir.path(), &["fill", ":cube", "-j", "10000", "-o", "cube.vtk"]);
    assert!(code == 0 && stderr.contains("4 for each core"), "{stderr}");
}
