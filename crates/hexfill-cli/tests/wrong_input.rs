//! Wrong input: exit code 2 and one clear message that names the place, the reason and a remedy.

mod common;

use common::hexfill;

const CUBE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n";
const FACES: &str = "f 1 5 8 4\nf 2 3 7 6\nf 1 2 6 5\nf 4 8 7 3\nf 1 4 3 2\nf 5 6 7 8\n";

/// Fills a file with this content; checks for exit code 2, one error line with all the words, and no output file.
fn refused(name: &str, content: &[u8], words: &[&str]) {
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join(name), content).unwrap();
    let (code, stdout, stderr) = hexfill(dir.path(), &["fill", name, "-o", "out.vtk"]);
    assert_eq!(code, 2, "{name}: {stderr}");
    assert_eq!(stdout, "");
    let errors: Vec<&str> = stderr.lines().filter(|l| l.starts_with("error:")).collect();
    assert_eq!(errors.len(), 1, "{name}: {stderr}");
    for word in words {
        assert!(errors[0].contains(word), "{name}: `{word}` is missing in: {stderr}");
    }
    assert!(!dir.path().join("out.vtk").exists(), "{name}: an output file was left behind");
}

fn obj(points: &str, faces: &str) -> Vec<u8> {
    format!("{points}{faces}").into_bytes()
}

#[test]
fn open_and_non_manifold_surfaces() {
    let open = FACES.lines().take(5).map(|l| format!("{l}\n")).collect::<String>();
    refused("open.obj", &obj(CUBE, &open), &["open", "4 boundary edges", "v4-v5"]);
    let extra = format!("{FACES}f 1 2 9 10\n");
    refused("edge.obj", &obj(&format!("{CUBE}v 5 5 5\nv 6 6 6\n"), &extra), &["non-manifold edge", "v0-v1"]);
    let second: String = CUBE.lines().skip(1).map(|l| format!("{}\n", l.replace("v ", "v -"))).collect();
    let shifted: String = FACES
        .lines()
        .map(|l| {
            let ids: Vec<String> = l[2..]
                .split(' ')
                .map(|i| i.parse::<u32>().unwrap())
                .map(|i| if i == 1 { 1 } else { i + 7 }.to_string())
                .collect();
            format!("f {}\n", ids.join(" "))
        })
        .collect();
    refused("vertex.obj", &obj(&format!("{CUBE}{second}"), &format!("{FACES}{shifted}")), &["non-manifold vert", "v0"]);
}

#[test]
fn faces_that_are_not_quads() {
    let triangles = FACES.replace("f 5 6 7 8\n", "f 5 6 7\nf 5 7 8\n");
    refused("tri.obj", &obj(CUBE, &triangles), &["face 5 (3 sides)", "face 6 (3 sides)"]);
    let pentagon = format!("{CUBE}v 0.5 0.5 1\nf 5 6 7 8 9\n");
    refused("penta.obj", pentagon.as_bytes(), &["face 0 (5 sides)"]);
}

#[test]
fn surfaces_without_a_hex_mesh() {
    // Seven quads: an odd torus grid of 3 x 3 has nine.
    let mut torus = String::new();
    for i in 0..3 {
        for j in 0..3 {
            torus += &format!("v {i} {j} {}\n", i * j);
        }
    }
    for i in 0..3u32 {
        for j in 0..3 {
            let at = |i: u32, j: u32| 3 * (i % 3) + j % 3 + 1;
            torus += &format!("f {} {} {} {}\n", at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
        }
    }
    refused("odd.obj", torus.as_bytes(), &["9 quads", "odd", "Thurston"]);
    // A cube with one face cut by a quad in a quad of which two corners have degree 2.
    let fan = format!("{CUBE}v 0.4 0.4 1\nv 0.6 0.6 1\n");
    let faces = FACES.replace("f 5 6 7 8\n", "f 5 6 7 9\nf 5 9 7 10\nf 5 10 7 8\n");
    refused("fan.obj", &obj(&fan, &faces), &["3-connected", "v4", "v6", "q"]);
}

#[test]
fn broken_files() {
    let high = FACES.replace("f 5 6 7 8", "f 5 6 7 9");
    refused("high.obj", &obj(CUBE, &high), &["high.obj:14", "9"]);
    refused("copy.obj", &obj(CUBE, &format!("{FACES}f 8 7 6 5\n")), &["q6", "same four vertices"]);
    let twice = FACES.replace("f 5 6 7 8", "f 5 6 7 7");
    refused("twice.obj", &obj(CUBE, &twice), &["twice"]);
    refused("nan.obj", &obj(&CUBE.replace("v 1 1 1", "v 1 nan 1"), FACES), &["nan.obj:7", "finite"]);
    refused("empty.obj", b"", &["empty"]);
    refused("empty.vtk", b"", &["empty"]);
    refused("points.obj", CUBE.as_bytes(), &["no faces"]);
    refused("surface.xyz", b"1 2 3", &["surface.xyz", "extension", "obj"]);
    refused(
        "cut.vtk",
        b"# vtk DataFile Version 3.0\ncut\nASCII\nDATASET POLYDATA\nPOINTS 8 double\n0 0 0\n1 0 0\n",
        &["cut.vtk", "truncated"],
    );
    refused(
        "huge.vtk",
        b"# vtk DataFile Version 3.0\nhuge\nASCII\nDATASET POLYDATA\nPOINTS 1000000000 double\n0 0 0\n",
        &["huge.vtk"],
    );
    refused("huge.off", b"OFF\n1000000000 1000000000 0\n0 0 0\n", &["huge.off"]);
}

#[test]
fn wrong_usage() {
    let dir = tempfile::tempdir().unwrap();
    let no = |args: &[&str], words: &[&str]| {
        let (code, _, stderr) = hexfill(dir.path(), args);
        assert_eq!(code, 2, "{args:?}: {stderr}");
        for word in words {
            assert!(stderr.contains(word), "{args:?}: `{word}` is missing in: {stderr}");
        }
    };
    no(&["fill"], &["Usage"]);
    no(&["fill", "missing.obj"], &["missing.obj", "no such file"]);
    no(&["fill", "."], &["folder"]);
    no(&["fill", ":cube", "-o", "a.vtk", "--view", "a.vtk"], &["same file"]);
    no(&["fill", ":cube", "--picture", "a.jpg"], &["a.jpg", ".png"]);
    no(&["fill", ":cube", "-o", "-", "--to", "vtk", "--json"], &["--json"]);
    std::fs::write(dir.path().join("cube.obj"), format!("{CUBE}{FACES}")).unwrap();
    no(&["fill", "cube.obj", "-o", "cube.obj"], &["same file"]);
    std::os::unix::fs::symlink("cube.obj", dir.path().join("link.obj")).unwrap();
    no(&["fill", "cube.obj", "-o", "link.obj"], &["same file"]);
    no(&["fill", ":no-such-problem"], &[":no-such-problem", ":schneiders-pyramid"]);
    no(&["fill", "Q1:nonsense"], &["Q1:nonsense"]);
    no(&["fill", ":cube", "-o", "cube.unknown"], &["cube.unknown", "extension"]);
    no(&["fill", ":cube", "-o", "missing/cube.vtk"], &["missing", "does not exist"]);
    no(&["fill", ":cube", "-o", "-"], &["--to"]);
    no(&["fill", "-"], &["--from"]);
    no(&["fill", ":cube", "--time-limit", "soon"], &["soon"]);
    no(&["fill", ":cube", "--improve"], &["--time-limit"]);
    no(&["fill", ":cube", "--count", "0"], &["0"]);
    no(&["check", ":cube"], &["cube"]);
    no(&["atlas", "build", "-o", "a.hxgrow", "--cap", "99"], &["99"]);
    no(&["--threads", "0", "fill", ":cube"], &["--threads"]);
    std::fs::write(dir.path().join("a.hxgrow"), "not an atlas at all").unwrap();
    no(&["atlas", "build", "-o", "a.hxgrow"], &["not a hexfill atlas"]);
    no(&["atlas", "stats", "a.hxgrow"], &["not a hexfill atlas"]);
}

#[test]
fn errors_are_json_where_json_was_asked_for_and_say_a_thing_once() {
    let dir = tempfile::tempdir().unwrap();
    let (code, out, err) = hexfill(dir.path(), &["info", "Q1:nonsense", "--json"]);
    assert_eq!(code, 2);
    let value: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert_eq!(value["exit_code"], 2);
    let message = value["error"].as_str().unwrap();
    assert!(err.contains(message));
    let half = &message[message.len() / 2..];
    assert_eq!(message.matches(half).count(), 1, "{message}");
    // Flags that mean nothing, too.
    for args in [&["fill", ":cube", "--bad", "--json"][..], &["info", ":cube", "-j", "0", "--json"]] {
        let (code, out, err) = hexfill(dir.path(), args);
        let value: serde_json::Value = serde_json::from_str(&out).unwrap_or_else(|e| panic!("{args:?}: {e}: {out}"));
        assert_eq!((code, &value["exit_code"], &value["json_version"]), (2, &2.into(), &1.into()), "{args:?}");
        assert!(err.contains(value["error"].as_str().unwrap()), "{err}");
    }
}

#[test]
fn an_atlas_that_does_not_fit_in_memory_is_not_called_complete() {
    let dir = tempfile::tempdir().unwrap();
    let build = ["atlas", "build", "--cap", "20", "--levels", "9", "-o", "a.hxgrow", "--json"];
    let (code, out, err) = hexfill(dir.path(), &[&build[..], &["--memory-limit", "1"]].concat());
    assert_eq!(code, 3, "{err}");
    let value: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert_eq!((&value["exhausted"], &value["stopped"]), (&false.into(), &"memory-limit".into()));
    let (code, out, _) = hexfill(dir.path(), &build);
    assert_eq!(code, 0);
    let value: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert_eq!((&value["levels"], &value["thinned"]), (&9.into(), &0.into()));
}

#[test]
fn a_full_disk_is_an_error_and_no_panic() {
    for args in [&["completions", "bash"][..], &["catalog"], &["info", ":cube"]] {
        let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        let status = std::process::Command::new(assert_cmd::cargo::cargo_bin("hexfill"))
            .args(args)
            .stdout(full)
            .stderr(std::process::Stdio::null())
            .status()
            .unwrap();
        assert_eq!(status.code(), Some(2), "{args:?}");
    }
}

#[test]
fn ids_that_only_a_huge_table_could_hold() {
    let quads = "[[0,1,2,3],[0,1,5,4],[1,2,6,5],[2,3,7,6],[3,0,4,7],[4,5,6,4000000000]]";
    refused(
        "sparse.json",
        format!("{{\"boundary_quads\": {quads}}}").as_bytes(),
        &["4000000000", "without large gaps"],
    );
}
