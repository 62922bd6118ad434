//! What a new user found (issue 12) and no other test holds.

mod common;

use common::{hexfill, json};
use std::path::Path;

/// A box of cubes as OBJ, each of its coordinates scaled.
fn box_of(size: [u32; 3], scale: [f64; 3]) -> String {
    let (mut ids, mut points, mut faces) = (std::collections::BTreeMap::new(), String::new(), String::new());
    for (axis, end) in (0..3).flat_map(|axis| [(axis, 0), (axis, size[axis])]) {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for (i, j) in (0..size[u]).flat_map(|i| (0..size[v]).map(move |j| (i, j))) {
            let mut quad = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(a, b)| {
                let mut p = [end; 3];
                (p[u], p[v]) = (a, b);
                let number = ids.len() + 1;
                *ids.entry(p).or_insert_with(|| {
                    points += &format!("v {} {} {}\n", f(p, scale, 0), f(p, scale, 1), f(p, scale, 2));
                    number
                })
            });
            if end == 0 {
                quad.reverse();
            }
            faces += &format!("f {} {} {} {}\n", quad[0], quad[1], quad[2], quad[3]);
        }
    }
    points + &faces
}

fn f(p: [u32; 3], scale: [f64; 3], k: usize) -> String {
    format!("{:?}", f64::from(p[k]) * scale[k])
}

/// The report of a fill and its exit code.
fn filled(dir: &Path, surface: &str) -> (i32, serde_json::Value) {
    std::fs::write(dir.join("s.obj"), surface).unwrap();
    let (code, out, _) = hexfill(dir, &["fill", "s.obj", "-o", "m.vtu", "--json"]);
    (code, json(&out))
}

#[test]
fn a_box_gets_its_cubes_whatever_its_size() {
    let dir = tempfile::tempdir().unwrap();
    for scale in [1.0, 1e-6, 1e6, 1e-160, 1e160, 1e-300, 1e300] {
        let (code, report) = filled(dir.path(), &box_of([2, 3, 4], [scale; 3]));
        assert_eq!((code, &report["meshes"][0]["hexes"]), (0, &24.into()), "{scale}");
        // Volumes may be no doubles; then no ratio of them is told, and no wrong one.
        let ratio = &report["meshes"][0]["geometry"]["volume_ratio"];
        assert!(ratio.is_null() || (ratio.as_f64().unwrap() - 1.0).abs() < 1e-9, "{scale}: {ratio}");
    }
}

#[test]
fn flat_surfaces_are_told_so() {
    let dir = tempfile::tempdir().unwrap();
    let (code, report) = filled(dir.path(), &box_of([2, 2, 1], [1.0, 1.0, 0.0]));
    assert_eq!(code, 1);
    let choice = report["choice"].as_str().unwrap();
    assert!(choice.contains("none can be valid"), "{choice}");
}

#[test]
fn boxes_that_cross_are_filled_each_for_itself_and_it_is_said() {
    let dir = tempfile::tempdir().unwrap();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let crossing = std::fs::read_to_string(root.join("corpus/sick/crossing_boxes.obj")).unwrap();
    let (code, report) = filled(dir.path(), &crossing);
    assert_eq!((code, &report["meshes"][0]["hexes"]), (0, &16.into()));
    let notes = report["notes"].to_string();
    assert!(notes.contains("overlaps itself") && !notes.contains("turned"), "{notes}");
}

#[test]
fn one_hex_is_not_called_hexes_and_the_catalogue_is_read_without_remarks() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    let (_, _, filled) = hexfill(at, &["fill", ":cube", "-o", "m.vtu"]);
    let (_, checked, _) = hexfill(at, &["check", "m.vtu"]);
    let (_, _, viewed) = hexfill(at, &["view", "m.vtu", "-o", "m.html"]);
    let (_, told, _) = hexfill(at, &["info", "m.vtu"]);
    for said in [&filled, &checked, &viewed, &told] {
        assert!(said.contains("1 hex") && !said.contains("1 hexes"), "{said}");
    }
    assert_eq!(hexfill(at, &["catalog", "show", ":geode", "--mesh", "g.json"]).0, 0);
    let (code, _, err) = hexfill(at, &["check", "g.json"]);
    assert_eq!((code, err.as_str()), (0, ""));
}

#[test]
fn a_summary_tells_of_all_hexes_in_the_digits_it_prints() {
    let dir = tempfile::tempdir().unwrap();
    let (code, _, err) = hexfill(dir.path(), &["fill", ":refinement-9-1", "-o", "m.vtu"]);
    assert_eq!(code, 0);
    // The least are certified to be 0.5 less a rounding: they count as 0.5, as they are printed.
    assert!(err.contains("at least 0.500000") && err.contains("scaled Jacobians: mean 0.633; 6 from 0.5"), "{err}");
    assert!(err.contains("volumes differ by a factor of"), "{err}");
}

#[test]
fn more_threads_than_can_work_are_not_started() {
    let dir = tempfile::tempdir().unwrap();
    let (code, _, err) = hexfill(dir.path(), &["fill", ":cube", "-o", "m.vtu", "-j", "10000"]);
    assert!(code == 0 && err.contains("--threads 10000:"), "{err}");
}

#[test]
fn a_surface_that_needs_no_mending_is_told_so() {
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("s.obj"), box_of([1, 1, 2], [1.0; 3])).unwrap();
    let (code, _, err) = hexfill(dir.path(), &["doctor", "s.obj", "--weld", "0", "--fix", "-o", "fixed.obj"]);
    assert!(code == 0 && err.contains("mended: nothing; it can be filled"), "{err}");
}
