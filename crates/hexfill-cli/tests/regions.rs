//! Several regions with shared walls, and voids among hexes, through the real binary.

mod common;

use common::{hexfill, json};
use std::path::Path;

fn three() -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../corpus/surfaces/three_regions.obj").to_str().unwrap().to_owned()
}

#[test]
fn regions_are_filled_tagged_and_judged_whole() {
    let dir = tempfile::tempdir().unwrap();
    let (code, out, err) =
        hexfill(dir.path(), &["fill", &three(), "-o", "whole.vtu", "--json", "--picture", "whole.png"]);
    assert_eq!(code, 0, "{err}");
    let report = json(&out);
    assert_eq!((report["regions"].as_array().unwrap().len(), report["hexes"].as_u64()), (3, Some(24)));
    let (_, out, _) = hexfill(dir.path(), &["check", "whole.vtu", "--json"]);
    assert!(json(&out)["levels"].as_array().unwrap().iter().all(|l| l["outcome"] == "passed"), "{out}");
    // The same bytes for any number of threads.
    hexfill(dir.path(), &["fill", &three(), "-o", "one.vtu", "-j", "1"]);
    let read = |name: &str| std::fs::read(dir.path().join(name)).unwrap();
    assert_eq!(read("one.vtu"), read("whole.vtu"));
    let (code, _, err) = hexfill(dir.path(), &["fill", &three(), "-o", "many.vtu", "--count", "2"]);
    assert!(code == 2 && err.contains("3 regions"), "{err}");
}

#[test]
fn a_void_is_filled_and_the_hexes_of_the_file_stay() {
    let dir = tempfile::tempdir().unwrap();
    let (code, _, err) = hexfill(dir.path(), &["fill", &three(), "-o", "whole.json", "--no-embed"]);
    assert_eq!(code, 0, "{err}");
    let mut data = json(&std::fs::read_to_string(dir.path().join("whole.json")).unwrap());
    // The hexes of the second region go, and with them all faces: what is left has a notch, no void.
    let hexes = data["hexes"].as_array().unwrap().clone();
    let notched: Vec<_> =
        hexes.iter().enumerate().filter(|(h, _)| !(8..16).contains(h)).map(|(_, h)| h.clone()).collect();
    data = serde_json::json!({ "points": data["points"], "hexes": notched });
    std::fs::write(dir.path().join("notched.json"), data.to_string()).unwrap();
    let (code, _, err) = hexfill(dir.path(), &["fill", "notched.json", "-o", "x.json"]);
    assert!(code == 2 && err.contains("no faces"), "{err}");
    // With the walls of the notch it is a region again.
    let (_, out, _) = hexfill(dir.path(), &["convert", &three(), "-o", "walls.json", "--json"]);
    assert!(!out.is_empty());
    let walls = json(&std::fs::read_to_string(dir.path().join("walls.json")).unwrap());
    let walled =
        serde_json::json!({ "points": data["points"], "hexes": notched, "boundary_quads": walls["boundary_quads"] });
    std::fs::write(dir.path().join("walled.json"), walled.to_string()).unwrap();
    let (code, out, err) = hexfill(dir.path(), &["fill", "walled.json", "-o", "again.json", "--json"]);
    assert_eq!(code, 0, "{err}");
    assert_eq!((json(&out)["regions"].as_array().unwrap().len(), json(&out)["hexes"].as_u64()), (1, Some(24)));
    let again = json(&std::fs::read_to_string(dir.path().join("again.json")).unwrap());
    assert_eq!(again["hexes"].as_array().unwrap()[..16], notched[..]);
}

/// Two cubes that share an edge are two regions: each is a solid, the whole is no manifold there, and that is said.
#[test]
fn solids_that_touch_in_an_edge_are_named() {
    let dir = tempfile::tempdir().unwrap();
    let cube = |corners: [usize; 8]| -> String {
        let faces = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];
        faces.map(|face| format!("f {}\n", face.map(|i: usize| corners[i].to_string()).join(" "))).concat()
    };
    let mut text = String::new();
    for (x, y) in [(0, 0), (1, 0), (1, 1), (0, 1), (2, 1), (2, 2), (1, 2)] {
        text += &format!("v {x} {y} 0\nv {x} {y} 1\n");
    }
    // Vertex 2 i + 1 lies at the bottom of column i; column 2 is in both.
    let columns = |c: [usize; 4]| -> [usize; 8] { std::array::from_fn(|i| 2 * c[i % 4] + 1 + i / 4) };
    text += &(cube(columns([0, 1, 2, 3])) + &cube(columns([2, 4, 5, 6])));
    std::fs::write(dir.path().join("edge.obj"), text).unwrap();
    let (code, out, err) = hexfill(dir.path(), &["fill", "edge.obj", "-o", "whole.vtu", "--json"]);
    assert_eq!(code, 0, "{err}");
    assert!(err.contains("touch in edges (1)") && json(&out)["notes"].to_string().contains("no manifold"), "{err}");
    let (code, out, _) = hexfill(dir.path(), &["check", "whole.vtu"]);
    assert!(code == 1 && out.contains("edge-pinched"), "{out}");
    let (_, _, err) = hexfill(dir.path(), &["fill", &three(), "-o", "three.vtu"]);
    assert!(!err.contains("no manifold"), "{err}");
}
