//! The certificates of the shipped meshes hold, and the table beside them tells their numbers.

mod common;

use common::{hexfill, json};
use std::path::Path;

#[test]
fn every_shipped_mesh_has_a_certificate_that_holds() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../corpus/meshes");
    let table = std::fs::read_to_string(folder.join("README.md")).unwrap();
    let mut n_meshes = 0;
    for entry in std::fs::read_dir(&folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|e| e != "vtk") {
            continue;
        }
        n_meshes += 1;
        let name = path.file_stem().unwrap().to_str().unwrap();
        let row = table.lines().find(|l| l.starts_with(&format!("| `{name}` |"))).expect(name);
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        let certificate = format!("{name}.certificate.json");
        let mesh = format!("{name}.vtk");
        let args = ["check", &mesh, "--surface", cells[2].trim_matches('`'), "--verify-certificate", &certificate];
        let (code, out, err) = hexfill(&folder, &args);
        assert_eq!(code, 0, "{name}: {out}{err}");
        let certified = json(&std::fs::read_to_string(folder.join(&certificate)).unwrap());
        assert_eq!(certified["hexes"].to_string(), cells[3], "{name}");
        let least = certified["scaled_jacobian"][0].as_f64().unwrap();
        assert_eq!(format!("{least:.6}"), cells[4], "{name}");
    }
    assert_eq!(n_meshes, 8);
}
