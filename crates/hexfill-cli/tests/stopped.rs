//! `fill` stopped by a limit or a signal: a whole mesh or no file, exit code 3, and JSON that says the same.
#![cfg(unix)]

mod common;

use common::{hexfill, json};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Fills that take many seconds: a small sphere the atlas holds, spikes it does not hold, and a file of the corpus.
fn slow_surfaces(dir: &Path) -> Vec<String> {
    std::fs::write(dir.join("spikes.obj"), spikes(9)).unwrap();
    vec![":buffer-cube-20".to_owned(), "spikes.obj".to_owned(), corpus("radial_12.obj")]
}

/// The surface of a cube of n^3 cells with its vertices at wild distances from the centre, as OBJ.
fn spikes(n: u32) -> String {
    let (mut ids, mut points, mut faces) = (std::collections::BTreeMap::new(), String::new(), String::new());
    for (axis, side) in (0..3).flat_map(|axis| [(axis, 0), (axis, n)]) {
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let mut quad = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(a, b)| {
                let mut p = [side; 3];
                (p[(axis + 1) % 3], p[(axis + 2) % 3]) = (a, b);
                let number = ids.len() + 1;
                *ids.entry(p).or_insert_with(|| {
                    let wild = 1.0 + f64::from((p[0] * 7 + p[1] * 11 + p[2] * 5) % 4) / 2.0;
                    let [x, y, z] = p.map(|x| wild * (2.0 * f64::from(x) / f64::from(n) - 1.0));
                    points += &format!("v {x} {y} {z}\n");
                    number
                })
            });
            if side == 0 {
                quad.reverse();
            }
            faces += &format!("f {} {} {} {}\n", quad[0], quad[1], quad[2], quad[3]);
        }
    }
    points + &faces
}

fn corpus(name: &str) -> String {
    let path: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../corpus/surfaces").join(name);
    path.to_str().unwrap().to_owned()
}

fn is_whole(dir: &Path, mesh: &str, surface: &str) -> bool {
    let (_, out, _) = hexfill(dir, &["check", mesh, "--surface", surface, "--json"]);
    json(&out)["levels"].as_array().unwrap()[..=2].iter().all(|l| l["outcome"] == "passed")
}

/// What a fill says that was sent `signal` after a while; how long it took from there.
fn signalled(dir: &Path, args: &[&str], signal: &str, after: Duration) -> (Option<i32>, String, Duration) {
    let mut child = Command::new(assert_cmd::cargo::cargo_bin("hexfill"))
        .current_dir(dir)
        .args(args)
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    std::thread::sleep(after);
    let sent = Instant::now();
    if child.try_wait().unwrap().is_none() {
        Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap();
    }
    let out = child.wait_with_output().unwrap();
    (out.status.code(), String::from_utf8(out.stdout).unwrap(), sent.elapsed())
}

#[test]
fn out_of_time_there_is_a_mesh_and_exit_code_3() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    for surface in slow_surfaces(at) {
        for limit in ["1ms", "300ms", "1"] {
            let args = ["fill", &surface, "-o", "m.vtk", "--time-limit", limit, "--json"];
            let (code, out, err) = hexfill(at, &args);
            let report = json(&out);
            assert_eq!(code, 3, "{surface} {limit}: {err}");
            assert_eq!((&report["exit_code"], &report["stopped"]), (&3.into(), &"time-limit".into()), "{surface}");
            assert!(is_whole(at, "m.vtk", &surface), "{surface} {limit}");
            std::fs::remove_file(at.join("m.vtk")).unwrap();
        }
    }
    // A fill that is done in time is not called stopped.
    let (code, out, _) = hexfill(at, &["fill", ":cube", "-o", "m.vtk", "--time-limit", "1h", "--json"]);
    let report = json(&out);
    assert_eq!((code, &report["exit_code"], &report["stopped"]), (0, &0.into(), &"finished".into()));
}

#[test]
fn a_signal_ends_with_a_mesh_and_exit_code_3() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    for surface in slow_surfaces(at) {
        for signal in ["-INT", "-TERM"] {
            let args = ["fill", &surface, "-o", "m.vtk", "--json"];
            let (code, out, took) = signalled(at, &args, signal, Duration::from_secs(1));
            let report = json(&out);
            assert_eq!(code, Some(3), "{surface} {signal}");
            assert_eq!((&report["exit_code"], &report["stopped"]), (&3.into(), &"cancelled".into()), "{surface}");
            assert!(is_whole(at, "m.vtk", &surface), "{surface} {signal}");
            // Two seconds on a machine of its own.
            assert!(took < Duration::from_secs(20), "{surface} {signal}: {took:?}");
            std::fs::remove_file(at.join("m.vtk")).unwrap();
        }
    }
}

#[test]
fn stopped_without_a_mesh_nothing_is_written() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    std::fs::write(at.join("spikes.obj"), spikes(9)).unwrap();
    for more in [&["--strategy", "shell"][..], &["--max-hexes", "20"], &["--require-valid"]] {
        let args = [&["fill", "spikes.obj", "-o", "m.vtk", "--time-limit", "1ms", "--json"], more].concat();
        let (code, out, err) = hexfill(at, &args);
        assert_eq!((code, &json(&out)["exit_code"]), (3, &3.into()), "{more:?}: {err}");
        assert!(!at.join("m.vtk").exists(), "{more:?}");
    }
}

#[test]
fn killed_at_any_moment_the_file_is_whole_or_as_it_was() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    let surface = corpus("bamboo_pen.obj");
    // A quick fill with a large file, so that some are killed while it is written.
    let args = ["fill", &surface, "--strategy", "construct", "--no-embed", "-o", "m.vtk"];
    let start = Instant::now();
    assert_eq!(hexfill(at, &args).0, 0);
    let whole_run = start.elapsed();
    for existing in [None, Some("what was here before")] {
        for i in 1..=12 {
            match existing {
                Some(text) => std::fs::write(at.join("m.vtk"), text).unwrap(),
                None => drop(std::fs::remove_file(at.join("m.vtk"))),
            }
            signalled(at, &args, "-KILL", whole_run * i / 12);
            let found = std::fs::read_to_string(at.join("m.vtk")).ok();
            assert!(found.as_deref() == existing || is_whole(at, "m.vtk", &surface), "killed at {i} of 12");
        }
    }
}

#[test]
fn what_cannot_be_written_is_refused_before_the_work() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    std::fs::create_dir(at.join("folder.vtk")).unwrap();
    std::fs::write(at.join("file"), "").unwrap();
    // Connectivity of a torus: no positions are made for it.
    let quad = |i: u32, j: u32| {
        let at = |i: u32, j: u32| 4 * (i % 4) + j % 4;
        [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]
    };
    let quads: Vec<[u32; 4]> = (0..16).map(|v| quad(v / 4, v % 4)).collect();
    let torus = serde_json::json!({ "quads": quads });
    std::fs::write(at.join("torus.json"), torus.to_string()).unwrap();
    for (surface, output, words) in [
        (":buffer-cube-20", "m.obj", "hexahedra"),
        (":buffer-cube-20", "m.off.gz", "hexahedra"),
        (":buffer-cube-20", "m.vtp", ".vtu"),
        (":buffer-cube-20", "folder.vtk", "folder"),
        (":buffer-cube-20", "file/m.vtk", "file"),
        (":buffer-cube-20", "/proc/m.vtk", "takes no files"),
        ("torus.json", "m.vtk", "coordinates"),
    ] {
        // The clock of a fill runs out at once; what is refused before it is no matter of time.
        let (code, out, err) = hexfill(at, &["fill", surface, "-o", output, "--time-limit", "0", "--json"]);
        assert_eq!((code, &json(&out)["exit_code"]), (2, &2.into()), "{output}: {err}");
        assert!(err.contains(words), "{output}: {err}");
        assert!(!err.contains("tried"), "{output}: {err}");
    }
    assert_eq!(std::fs::read_dir(at).unwrap().count(), 3, "no temporary file is left");
}
