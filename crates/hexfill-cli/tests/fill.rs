//! The main job through the real binary: known numbers, the boundary contract, interruption, other formats.

mod common;

use assert_cmd::Command;
use common::{hexfill, json};
use std::path::Path;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

/// Judges connectivity and boundary of `mesh` with the real binary.
fn judged(dir: &Path, mesh: &str, surface: &str) -> serde_json::Value {
    let (_, out, _) = hexfill(dir, &["check", mesh, "--surface", surface, "--json"]);
    json(&out)
}

fn passed(report: &serde_json::Value, level: usize) -> bool {
    report["levels"].as_array().unwrap()[..=level].iter().all(|l| l["outcome"] == "passed")
}

#[test]
fn every_catalogue_entry_is_filled_as_well_as_known() {
    let dir = tempfile::tempdir().unwrap();
    for (name, at_most) in [
        (":cube", 1),
        (":octagonal-spindle", 39),
        (":schneiders-pyramid", 36),
        (":geode", 34),
        (":buffer-cube-20", 37),
        (":buffer-cube-22", 28),
        (":carbonera-fig10", 37),
        (":refinement-9-1", 13),
    ] {
        let start = Instant::now();
        let (code, out, err) = hexfill(dir.path(), &["fill", name, "-o", "m.json", "--no-embed", "--json"]);
        assert_eq!(code, 0, "{name}: {err}");
        assert!(start.elapsed() < Duration::from_secs(10), "{name} took {:?}", start.elapsed());
        let hexes = json(&out)["meshes"][0]["hexes"].as_u64().unwrap();
        assert!(hexes <= at_most, "{name}: {hexes} hexes");
        let report = judged(dir.path(), "m.json", name);
        assert!(passed(&report, 2), "{name}: {report}");
        assert_eq!(report["facts"]["ball"], "yes");
        assert_eq!(report["facts"]["hexes"], hexes);
    }
}

#[test]
fn shipped_meshes_are_what_the_catalogue_says() {
    let dir = tempfile::tempdir().unwrap();
    let (_, out, _) = hexfill(dir.path(), &["catalog", "--json"]);
    for entry in json(&out)["problems"].as_array().unwrap() {
        let Some(hexes) = entry["mesh_hexes"].as_u64() else { continue };
        let name = entry["name"].as_str().unwrap();
        let (code, _, err) = hexfill(dir.path(), &["catalog", "show", name, "--mesh", "best.json"]);
        assert_eq!(code, 0, "{err}");
        let report = judged(dir.path(), "best.json", name);
        assert!(passed(&report, 2), "{name}: {report}");
        assert!(entry["best"].as_str().unwrap().starts_with(&format!("{hexes} hexes")), "{name}");
    }
}

#[test]
fn stored_meshes_are_written_with_positions_where_the_format_has_them() {
    let dir = tempfile::tempdir().unwrap();
    for (name, code, level) in [
        (":refinement-9-1", 0, 4),
        (":refinement-16-4", 0, 4),
        (":carbonera-fig10", 0, 2),
        (":octagonal-spindle", 1, 2),
    ] {
        let (found, _, err) = hexfill(dir.path(), &["catalog", "show", name, "--mesh", "best.vtu"]);
        assert_eq!(found, code, "{name}: {err}");
        let report = judged(dir.path(), "best.vtu", name);
        assert!(passed(&report, level), "{name}: {report}");
    }
    let (code, _, err) = hexfill(dir.path(), &["catalog", "show", ":geode", "--mesh", "nowhere/best.vtu"]);
    assert!(code == 2 && err.contains("does not exist") && !err.contains("certified"), "{err}");
}

#[test]
fn the_surface_comes_back_bit_for_bit() {
    let dir = tempfile::tempdir().unwrap();
    let points = "v -0.0 0 0\nv 1e-300 0.1 0.30000000000000004\nv 1 1 0\nv 0 1 5e-324\nv 0 0 1\nv 1 0 1\nv 1 1 1.7976931348623157e300\nv 0 1 1\nv 9 9 9\n";
    // Inside out, one quad turned, and a point nobody uses.
    let faces = "f 4 8 5 1\nf 6 7 3 2\nf 1 2 6 5\nf 3 7 8 4\nf 2 3 4 1\nf 8 7 6 5\n";
    std::fs::write(dir.path().join("s.obj"), format!("{points}{faces}")).unwrap();
    for out in ["m.vtk", "m.vtu", "m.mesh", "m.json", "m.vtk.gz"] {
        let (code, _, err) = hexfill(dir.path(), &["fill", "s.obj", "-o", out, "--no-embed"]);
        assert_eq!(code, 0, "{err}");
        assert!(err.contains("turned"), "{err}");
        let (code, back, err) = hexfill(dir.path(), &["convert", out, "-o", "-", "--to", "json"]);
        assert_eq!(code, 0, "{err}");
        let given: Vec<u64> = points
            .lines()
            .flat_map(|l| l[2..].split_whitespace().map(|x| x.parse::<f64>().unwrap().to_bits()).collect::<Vec<_>>())
            .collect();
        let written: Vec<u64> = json(&back)["points"]
            .as_array()
            .unwrap()
            .iter()
            .flat_map(|p| p.as_array().unwrap().iter().map(|x| x.as_f64().unwrap().to_bits()).collect::<Vec<_>>())
            .collect();
        assert_eq!(written[..27], given[..], "{out}");
        let (_, report, _) = hexfill(dir.path(), &["check", out, "--surface", "s.obj", "--json"]);
        assert!(passed(&json(&report), 2), "{out}: {report}");
    }
}

#[test]
fn names_signatures_stdin_and_stdout_are_accepted() {
    let dir = tempfile::tempdir().unwrap();
    let (_, out, _) = hexfill(dir.path(), &["info", ":octagonal-spindle", "--json"]);
    let info = json(&out);
    assert_eq!(info["key"], "8x[8,8]");
    let signature = info["signature"].as_str().unwrap();
    let (code, _, err) = hexfill(dir.path(), &["fill", signature, "-o", "m.json", "--no-embed"]);
    assert_eq!(code, 0, "{err}");
    let (_, surface, _) = hexfill(dir.path(), &["convert", ":buffer-cube-22", "-o", "-", "--to", "off"]);
    let piped = Command::cargo_bin("hexfill")
        .unwrap()
        .args(["fill", "-", "--from", "off", "-o", "-", "--to", "json", "--no-embed"])
        .write_stdin(surface)
        .output()
        .unwrap();
    assert_eq!(piped.status.code(), Some(0));
    let mesh = json(&String::from_utf8(piped.stdout).unwrap());
    assert_eq!(mesh["hexes"].as_array().unwrap().len(), 28);
}

#[test]
fn several_meshes_are_pairwise_different() {
    let dir = tempfile::tempdir().unwrap();
    let args = ["fill", ":buffer-cube-20", "-o", "m.json", "--count", "3", "--no-embed", "--json"];
    let (code, out, err) = hexfill(dir.path(), &args);
    assert_eq!(code, 0, "{err}");
    let report = json(&out);
    let mut signatures: Vec<&str> =
        report["meshes"].as_array().unwrap().iter().map(|m| m["signature"].as_str().unwrap()).collect();
    assert_eq!(signatures.len(), 3);
    signatures.sort_unstable();
    signatures.dedup();
    assert_eq!(signatures.len(), 3);
    for i in 1..=3 {
        assert!(passed(&judged(dir.path(), &format!("m-{i}.json"), ":buffer-cube-20"), 2));
    }
}

#[test]
fn no_answer_is_exit_code_1_and_writes_nothing() {
    let dir = tempfile::tempdir().unwrap();
    let args = ["fill", ":octagonal-spindle", "--strategy", "atlas", "--max-hexes", "8", "-o", "m.vtk"];
    let (code, _, err) = hexfill(dir.path(), &args);
    assert_eq!(code, 1, "{err}");
    assert!(err.contains("which does not mean that none exists"), "{err}");
    assert!(!dir.path().join("m.vtk").exists());
}

#[test]
fn the_same_bytes_for_any_number_of_threads() {
    let dir = tempfile::tempdir().unwrap();
    for threads in ["1", "2", "7"] {
        let out = format!("m{threads}.vtk");
        let args = ["-j", threads, "fill", ":refinement-9-1", "--no-embed", "-o", "m.json"];
        assert_eq!(hexfill(dir.path(), &args).0, 0);
        std::fs::rename(dir.path().join("m.json"), dir.path().join(&out)).unwrap();
        assert_eq!(
            std::fs::read(dir.path().join(&out)).unwrap(),
            std::fs::read(dir.path().join("m1.vtk")).unwrap(),
            "{threads} threads"
        );
    }
}

fn start(dir: &Path, args: &[&str]) -> Child {
    std::process::Command::new(assert_cmd::cargo::cargo_bin("hexfill"))
        .current_dir(dir)
        .args(args)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap()
}

fn wait_for_size(path: &Path, size: u64) {
    let start = Instant::now();
    while std::fs::metadata(path).map_or(0, |m| m.len()) < size {
        assert!(start.elapsed() < Duration::from_secs(120), "{} did not grow", path.display());
        std::thread::sleep(Duration::from_millis(5));
    }
}

#[test]
fn a_killed_atlas_build_goes_on_and_ends_with_the_same_bytes() {
    let dir = tempfile::tempdir().unwrap();
    let whole = ["atlas", "build", "--cap", "24", "--levels", "28", "-o", "whole.hxgrow"];
    assert_eq!(hexfill(dir.path(), &whole).0, 0);
    let killed = ["atlas", "build", "--cap", "24", "--levels", "28", "-o", "killed.hxgrow"];
    for size in [40, 20_000, 200_000] {
        let mut child = start(dir.path(), &killed);
        wait_for_size(&dir.path().join("killed.hxgrow"), size);
        child.kill().unwrap();
        child.wait().unwrap();
    }
    let (code, _, err) = hexfill(dir.path(), &killed);
    assert_eq!(code, 0, "{err}");
    assert_eq!(
        std::fs::read(dir.path().join("whole.hxgrow")).unwrap(),
        std::fs::read(dir.path().join("killed.hxgrow")).unwrap()
    );
    let (_, out, _) = hexfill(dir.path(), &["atlas", "stats", "whole.hxgrow", "--json"]);
    assert_eq!(json(&out)["by_quads"][0]["quads"], 6);
}

#[cfg(unix)]
#[test]
fn an_interrupted_fill_says_so_and_goes_on() {
    let dir = tempfile::tempdir().unwrap();
    // An atlas of one cube forces the growth; the limit stops it on the way to the pyramid.
    assert_eq!(hexfill(dir.path(), &["atlas", "build", "--levels", "1", "-o", "tiny.hxgrow"]).0, 0);
    let args = [
        "fill",
        ":buffer-cube-22",
        "--strategy",
        "atlas",
        "--atlas",
        "tiny.hxgrow",
        "--cap",
        "22",
        "--max-hexes",
        "29",
        "-o",
        "m.json",
        "--no-embed",
        "--growth-log",
        "grow.hxgrow",
        "--inward-cavities",
        "0",
    ];
    let child = start(dir.path(), &args);
    wait_for_size(&dir.path().join("grow.hxgrow"), 2_000);
    let status = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(status.success());
    let out = child.wait_with_output().unwrap();
    assert!([Some(3), Some(0), Some(1)].contains(&out.status.code()), "{out:?}");
    let before = std::fs::metadata(dir.path().join("grow.hxgrow")).unwrap().len();
    let (code, _, err) = hexfill(dir.path(), &args);
    assert!(code == 0 || code == 1, "{err}");
    assert!(std::fs::metadata(dir.path().join("grow.hxgrow")).unwrap().len() >= before);
}

#[test]
fn view_and_picture_are_written() {
    let dir = tempfile::tempdir().unwrap();
    let args = ["fill", ":buffer-cube-22", "-o", "m.vtk", "--view", "m.html", "--picture", "m.png", "--no-embed"];
    let (code, _, err) = hexfill(dir.path(), &args);
    assert_eq!(code, 0, "{err}");
    let html = std::fs::read_to_string(dir.path().join("m.html")).unwrap();
    assert!(html.starts_with("<!") && html.contains("</html>"));
    assert_eq!(&std::fs::read(dir.path().join("m.png")).unwrap()[1..4], b"PNG");
    let (code, _, err) = hexfill(dir.path(), &["view", "m.vtk", "-o", "again.html"]);
    assert_eq!(code, 0, "{err}");
}

#[test]
fn a_certificate_holds_for_its_mesh_and_for_no_other() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    assert_eq!(hexfill(at, &["fill", ":octagonal-spindle", "--prefer", "hexes", "-o", "m.vtk"]).0, 0);
    let surface = ["--surface", ":octagonal-spindle"];
    let check = |mesh: &str, more: &[&str]| hexfill(at, &[&["check", mesh], &surface[..], more].concat());
    let (code, out, err) = check("m.vtk", &["--certificate", "c.json", "--csv", "cells.csv"]);
    assert_eq!(code, 0, "{out}{err}");
    assert_eq!(std::fs::read_to_string(at.join("cells.csv")).unwrap().lines().count(), 41);
    assert_eq!(check("m.vtk", &["--verify-certificate", "c.json"]).0, 0);
    let certificate = std::fs::read_to_string(at.join("c.json")).unwrap();
    let forged = |name: &str, text: &str| {
        std::fs::write(at.join(name), text).unwrap();
        let (code, _, err) = check("m.vtk", &["--verify-certificate", name]);
        assert_eq!(code, 1, "{name}: {err}");
        assert!(err.contains("does not hold"), "{name}: {err}");
    };
    forged("digit.json", &certificate.replacen("0.2391", "0.2491", 1));
    forged("cut.json", &certificate[..certificate.len() / 2]);
    let moved = std::fs::read_to_string(at.join("m.vtk")).unwrap();
    let line = moved.lines().nth(20).unwrap();
    let other = moved.replacen(line, &line.replacen('1', "2", 1), 1);
    if other != moved {
        std::fs::write(at.join("other.vtk"), other).unwrap();
        assert_eq!(check("other.vtk", &["--verify-certificate", "c.json"]).0, 1);
    }
}

#[test]
fn real_surfaces_are_constructed_and_judged() {
    let dir = tempfile::tempdir().unwrap();
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../corpus/surfaces");
    for (name, quads) in [("cubespikes.obj", 1192), ("bamboo_pen.obj", 1160)] {
        let path = corpus.join(name);
        let path = path.to_str().unwrap();
        let (code, out, err) = hexfill(dir.path(), &["fill", path, "-o", "m.vtu", "--no-embed", "--json"]);
        assert_eq!(code, 0, "{err}");
        let hexes = json(&out)["meshes"][0]["hexes"].as_u64().unwrap();
        assert!(hexes <= 46 * quads, "{name}: {hexes} hexes");
        assert!(passed(&judged(dir.path(), "m.vtu", path), 3), "{name}");
    }
}

#[test]
fn points_on_one_spot_cost_the_geometry_and_not_the_mesh() {
    let dir = tempfile::tempdir().unwrap();
    let faces = "f 1 5 8 4\nf 2 3 7 6\nf 1 2 6 5\nf 4 8 7 3\nf 1 4 3 2\nf 5 6 7 8\n";
    std::fs::write(dir.path().join("s.obj"), format!("{}{faces}", "v 3 3 3\n".repeat(8))).unwrap();
    let (code, _, err) = hexfill(dir.path(), &["fill", "s.obj", "-o", "m.vtk", "--no-embed"]);
    assert_eq!(code, 0, "{err}");
    let (code, _, err) = hexfill(dir.path(), &["fill", "s.obj", "-o", "m.vtk"]);
    assert_eq!(code, 1, "{err}");
    assert!(passed(&judged(dir.path(), "m.vtk", "s.obj"), 3));
    let (code, _, err) = hexfill(dir.path(), &["fill", "s.obj", "-o", "n.vtk", "--require-valid"]);
    assert_eq!(code, 1, "{err}");
    assert!(!dir.path().join("n.vtk").exists());
}

#[test]
fn fewer_meshes_than_asked_for_are_said() {
    let dir = tempfile::tempdir().unwrap();
    let args = ["fill", ":cube", "--count", "5", "--max-hexes", "1", "-o", "m.vtk", "--no-embed"];
    let (code, _, err) = hexfill(dir.path(), &args);
    assert_eq!(code, 1, "{err}");
    assert!(err.contains("1 of 5 meshes asked for were found"), "{err}");
}

#[test]
fn long_work_is_estimated_before_it_begins_and_the_estimate_holds() {
    let dir = tempfile::tempdir().unwrap();
    let surfaces = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../corpus/surfaces");
    let spikes = surfaces.join("cubespikes.obj");
    let (code, out, err) = hexfill(dir.path(), &["fill", spikes.to_str().unwrap(), "-o", "m.vtu", "--json"]);
    assert_eq!(code, 0, "{err}");
    assert!(
        err.starts_with("estimate: about 0.5 to 24 s of processor time and 300 to 5600 hexes, by shelling"),
        "{err}"
    );
    let report = json(&out);
    let range = |key: &str| [0, 1].map(|i| report["estimate"][key][i].as_f64().unwrap());
    let hexes = report["meshes"][0]["hexes"].as_f64().unwrap();
    let [few, many] = range("hexes");
    assert!(few <= hexes && hexes <= many, "{hexes}");
    // Processor time: that of all cores; a busy machine takes longer.
    let cores = std::thread::available_parallelism().map_or(1.0, |n| n.get() as f64);
    assert!(range("seconds")[0] <= cores * report["seconds"].as_f64().unwrap());
    // Small work, and the cells of a grid, say nothing.
    for surface in [":schneiders-pyramid", surfaces.join("channel.obj").to_str().unwrap()] {
        let (code, out, err) = hexfill(dir.path(), &["fill", surface, "-o", "s.vtu", "--json"]);
        assert!(code == 0 && !err.contains("estimate") && json(&out)["estimate"].is_null(), "{err}");
    }
}

/// The numbers of a field of the hexes in a JSON mesh.
fn field(mesh: &serde_json::Value, name: &str) -> Vec<u64> {
    mesh["hex_data"][name].as_array().unwrap().iter().map(|x| x.as_f64().unwrap() as u64).collect()
}

#[test]
fn engine_and_layer_of_every_hex_are_written_and_agree_with_the_report() {
    let dir = tempfile::tempdir().unwrap();
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../corpus/surfaces");
    let regions = corpus.join("three_regions.obj").to_str().unwrap().to_owned();
    let makers: std::collections::BTreeMap<&str, u64> =
        hexfill::Maker::ALL.iter().map(|m| (m.words(), u64::from(m.number()))).collect();
    for args in [
        &["fill", ":schneiders-pyramid"][..],
        &["fill", ":schneiders-pyramid", "--strategy", "shell"],
        &["fill", ":cube", "--strategy", "construct", "--no-embed"],
        &["fill", ":cube", "--strategy", "construct", "--no-embed", "--time-limit", "1"],
        &["fill", ":cube", "--layers", "3"],
        &["fill", &regions],
    ] {
        let (_, out, err) = hexfill(dir.path(), &[args, &["-o", "m.json", "--json"]].concat());
        let report = json(&out);
        let mesh = json(&std::fs::read_to_string(dir.path().join("m.json")).unwrap());
        let (engines, layers) = (field(&mesh, "engine"), field(&mesh, "layer"));
        assert_eq!(engines.len(), mesh["hexes"].as_array().unwrap().len(), "{args:?}: {err}");
        let mut counted = 0;
        let meshes = report["meshes"].as_array().or_else(|| report["regions"].as_array()).unwrap();
        let stages = || meshes.iter().flat_map(|m| m["stages"].as_array().unwrap());
        for (name, number) in &makers {
            let told: u64 = stages().filter(|s| s[0] == *name).map(|s| s[1].as_u64().unwrap()).sum();
            assert_eq!(engines.iter().filter(|e| *e == number).count() as u64, told, "{args:?}: {name}");
            counted += told;
        }
        assert_eq!(counted as usize, engines.len(), "{args:?}");
        assert!(layers.contains(&1) && !layers.contains(&0), "{args:?}");
        if args.contains(&"--layers") {
            // Six quads with three layers over each, and one hex in the middle.
            let in_layers = |layer: u64| layers.iter().filter(|l| **l == layer).count();
            assert_eq!([1, 2, 3, 4].map(in_layers), [6, 6, 6, 1]);
            let thin = engines.iter().zip(&layers).filter(|(e, _)| **e == makers["boundary layers"]);
            assert!(thin.clone().count() == 18 && thin.clone().all(|(_, l)| *l <= 3));
        }
    }
    let (code, _, err) = hexfill(dir.path(), &["view", "m.json", "-o", "m.html", "--field", "layer"]);
    assert_eq!(code, 0, "{err}");
    assert!(std::fs::read_to_string(dir.path().join("m.html")).unwrap().contains("\"layer\""));
    let (code, _, err) = hexfill(dir.path(), &["view", "m.json", "-o", "m.png", "--groups"]);
    assert!(code == 2 && err.contains("no groups"), "{err}");
    let (code, out, err) = hexfill(dir.path(), &["view", "m.json", "m.json", "-o", "both.html", "--json"]);
    assert!(code == 0 && common::json(&out)["hexes"].as_array().is_some_and(|n| n.len() == 2), "{err}");
    let (code, _, err) = hexfill(dir.path(), &["view", "m.json", "-o", "m.png", "--field", "nothing"]);
    assert!(code == 2 && err.contains("it has: certified_positive, scaled_jacobian, engine, layer"), "{err}");
}
