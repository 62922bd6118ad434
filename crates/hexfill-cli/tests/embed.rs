//! Coordinates through the real binary: inputs that allow none or are hard for floating point, and the same bytes for any threads.

mod common;

use common::{hexfill, json};
use std::path::Path;

/// Writes the surface of a catalogue entry with its points changed.
fn surface(dir: &Path, name: &str, file: &str, change: impl Fn(usize, [f64; 3]) -> [f64; 3]) {
    assert_eq!(hexfill(dir, &["convert", name, "-o", "entry.obj"]).0, 0);
    let text = std::fs::read_to_string(dir.join("entry.obj")).unwrap();
    let mut vertex = 0;
    let mut lines = Vec::new();
    for line in text.lines() {
        let Some(rest) = line.strip_prefix("v ") else {
            lines.push(line.to_owned());
            continue;
        };
        let numbers: Vec<f64> = rest.split_whitespace().map(|x| x.parse().unwrap()).collect();
        let [x, y, z] = change(vertex, [numbers[0], numbers[1], numbers[2]]);
        lines.push(format!("v {x:e} {y:e} {z:e}"));
        vertex += 1;
    }
    std::fs::write(dir.join(file), lines.join("\n") + "\n").unwrap();
}

#[test]
fn sizes_near_the_ends_of_the_doubles_are_embedded() {
    let dir = tempfile::tempdir().unwrap();
    for (file, scale) in [("tiny.obj", 1e-300), ("huge.obj", 1e300)] {
        surface(dir.path(), ":schneiders-pyramid", file, |_, p| p.map(|x| x * scale));
        let (code, out, err) = hexfill(dir.path(), &["fill", file, "-o", "m.vtu", "--require-valid", "--json"]);
        assert_eq!(code, 0, "{file}: {err}");
        let geometry = &json(&out)["meshes"][0]["geometry"];
        assert_eq!(geometry["certified"], geometry["hexes"]);
        let (code, _, err) = hexfill(dir.path(), &["check", "m.vtu", "--surface", file]);
        assert_eq!(code, 0, "{file}: {err}");
    }
}

#[test]
fn boundaries_that_leave_no_room_are_named_and_the_mesh_is_written() {
    let dir = tempfile::tempdir().unwrap();
    let name = ":schneiders-pyramid";
    surface(dir.path(), name, "flat.obj", |_, p| [p[0], p[1], 0.0]);
    surface(dir.path(), name, "point.obj", |_, _| [1.0; 3]);
    surface(dir.path(), name, "coincident.obj", |v, p| if v < 2 { [0.0; 3] } else { p });
    surface(dir.path(), name, "crossed.obj", |v, p| if v == 1 { [0.0, 0.0, -3.0] } else { p });
    for (file, words) in [
        ("flat.obj", "leaves no room"),
        ("point.obj", "widest direction"),
        ("coincident.obj", "star bound"),
        ("crossed.obj", "certified in"),
    ] {
        let (code, _, err) = hexfill(dir.path(), &["fill", file, "-o", "m.vtu", "--embed-limit", "2s"]);
        assert_eq!(code, 1, "{file}: {err}");
        assert!(err.contains(words), "{file}: {err}");
        // The connectivity is good, and the file says which cells are not.
        let (_, out, _) = hexfill(dir.path(), &["check", "m.vtu", "--surface", file, "--json"]);
        let levels = json(&out)["levels"].clone();
        assert!(levels.as_array().unwrap()[..3].iter().all(|l| l["outcome"] == "passed"), "{file}: {levels}");
        assert!(std::fs::read_to_string(dir.path().join("m.vtu")).unwrap().contains("certified_positive"), "{file}");
        std::fs::remove_file(dir.path().join("m.vtu")).unwrap();
        let (code, _, err) =
            hexfill(dir.path(), &["fill", file, "-o", "m.vtu", "--require-valid", "--embed-limit", "2s"]);
        assert_eq!(code, 1, "{file}: {err}");
        assert!(!dir.path().join("m.vtu").exists(), "{file}");
    }
}

#[test]
fn no_coordinates_no_number_and_no_hexes_are_refused_with_the_remedy() {
    let dir = tempfile::tempdir().unwrap();
    assert_eq!(hexfill(dir.path(), &["fill", ":refinement-9-1", "-o", "m.json", "--no-embed"]).0, 0);
    let mut mesh = json(&std::fs::read_to_string(dir.path().join("m.json")).unwrap());
    mesh.as_object_mut().unwrap().remove("points");
    std::fs::write(dir.path().join("bare.json"), mesh.to_string()).unwrap();
    let (code, _, err) = hexfill(dir.path(), &["embed", "bare.json", "-o", "o.json"]);
    assert!(code == 2 && err.contains("no coordinates") && err.contains("hexfill fill"), "{code} {err}");
    surface(dir.path(), ":cube", "cube.obj", |_, p| p);
    let (code, _, err) = hexfill(dir.path(), &["embed", "cube.obj", "-o", "o.json"]);
    assert!(code == 2 && err.contains("no hexes"), "{code} {err}");
    surface(dir.path(), ":cube", "nan.obj", |v, p| if v == 0 { [f64::NAN; 3] } else { p });
    let (code, _, err) = hexfill(dir.path(), &["fill", "nan.obj", "-o", "o.json"]);
    assert!(code == 2 && err.contains("finite"), "{code} {err}");
}

#[test]
fn the_same_bytes_for_one_and_two_threads_and_a_symmetric_result_on_request() {
    let dir = tempfile::tempdir().unwrap();
    assert_eq!(hexfill(dir.path(), &["fill", ":schneiders-pyramid", "-o", "m.json", "--no-embed"]).0, 0);
    for threads in ["1", "2"] {
        let out = format!("out-{threads}.json");
        let args = ["embed", "m.json", "-o", &out, "--fresh", "--starts", "3", "--seed", "5", "-j", threads];
        let (code, _, err) = hexfill(dir.path(), &args);
        assert_eq!(code, 0, "{err}");
    }
    let bytes = |name: &str| std::fs::read(dir.path().join(name)).unwrap();
    assert_eq!(bytes("out-1.json"), bytes("out-2.json"));
    let (code, out, err) = hexfill(dir.path(), &["embed", "m.json", "-o", "s.json", "--symmetric", "--json"]);
    assert_eq!(code, 0, "{err}");
    let geometry = &json(&out)["geometry"];
    assert_eq!(geometry["embedding"]["symmetries"], 4);
    assert!(geometry["certified_scaled_jacobian"].as_f64().unwrap() > 0.3162);
}
