//! Nothing a file carries is lost on the way through the commands, and files as people have them.

mod common;

use common::hexfill;
use hexfill::io::{MeshData, TagOn, read_path};
use std::path::Path;

/// Runs a command that must succeed.
#[track_caller]
fn done(dir: &Path, args: &[&str]) {
    let (code, _, err) = hexfill(dir, args);
    assert_eq!(code, 0, "{args:?}: {err}");
}

/// A box of 1 x 1 x 2 with groups that overlap, a material and an object.
const GROUPS: &str = "o Box\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nv 0 0 2\nv 1 0 2\nv 1 1 2\n\
    v 0 1 2\ng inlet\nf 1 4 3 2\ng outlet wall\nf 9 10 11 12\ng wall\nusemtl steel\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n\
    f 5 6 10 9\nf 6 7 11 10\nf 7 8 12 11\nf 8 5 9 12\n";

/// The names of each quad, sorted.
fn names(data: &MeshData) -> Vec<Vec<String>> {
    let of = |&tag: &i64| {
        let of_tag = data.tag_names.iter().filter(|n| n.on == TagOn::Faces && n.tag == tag);
        // Gmsh 2.2 has one group an element.
        let mut names: Vec<String> = of_tag.flat_map(|n| n.name.split('+').map(str::to_owned)).collect();
        names.sort();
        names
    };
    data.quad_tags.iter().flatten().map(of).collect()
}

#[test]
fn names_of_groups_go_through_every_command_and_format() {
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("in.obj"), GROUPS).unwrap();
    let due = names(&read_path(&dir.path().join("in.obj"), None).unwrap());
    assert_eq!(due[..3], [vec!["Box", "inlet"], vec!["Box", "outlet", "wall"], vec!["Box", "steel", "wall"]]);
    for extension in ["msh", "msh4", "inp", "vtk", "vtu", "mesh", "ovm", "json"] {
        let name = |stem: &str| format!("{stem}.{extension}");
        done(dir.path(), &["fill", "in.obj", "-o", &name("filled")]);
        done(dir.path(), &["embed", &name("filled"), "-o", &name("embedded")]);
        done(dir.path(), &["simplify", &name("embedded"), "-o", &name("simple"), "--balls", "1000"]);
        done(dir.path(), &["convert", &name("simple"), "-o", &name("converted")]);
        let data = read_path(&dir.path().join(name("converted")), None).unwrap();
        assert_eq!(names(&data), due, "{extension}");
        assert!(data.tag_names.iter().any(|n| n.on == TagOn::Cells && n.name == "volume"), "{extension}");
        assert!(data.hex_tags.is_some(), "{extension}");
        done(dir.path(), &["check", &name("converted"), "--surface", "in.obj"]);
    }
}

#[test]
fn data_on_quads_and_points_go_through_a_fill() {
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("in.obj"), GROUPS).unwrap();
    let mut surface = read_path(&dir.path().join("in.obj"), None).unwrap();
    surface.quad_data = vec![("heat".to_owned(), (0..10).map(|i| f64::from(i) / 3.0).collect())];
    surface.point_data =
        (0..3).map(|k| (format!("shift:{k}"), (0..12).map(|i| f64::from(3 * i + k) / 7.0).collect())).collect();
    hexfill::io::write_path(&dir.path().join("in.vtu"), None, &surface).unwrap();
    for extension in ["msh", "msh4", "vtk", "vtu", "ovm", "json"] {
        let name = format!("filled.{extension}");
        // Through a mesh with interior points, too.
        done(
            dir.path(),
            &["fill", "in.vtu", "-o", &name, "--strategy", "construct", "--cells", "fewest", "--no-embed"],
        );
        let data = read_path(&dir.path().join(&name), None).unwrap();
        assert_eq!(data.quad_data, surface.quad_data, "{extension}");
        assert!(data.points.len() > 12);
        for ((found, values), (due, at)) in data.point_data.iter().zip(&surface.point_data) {
            assert_eq!((found, &values[..12]), (due, at.as_slice()), "{extension}");
            assert!(values[12..].iter().all(|x| x.is_nan()), "{extension}");
        }
        assert_eq!(data.point_data.len(), 3, "{extension}");
    }
    // Where there is no place for them, that is said.
    let (_, _, err) = hexfill(dir.path(), &["fill", "in.vtu", "-o", "filled.mesh"]);
    assert!(err.contains("does not carry data on quads") && err.contains("data on points"), "{err}");
}

#[test]
fn a_mesh_for_a_solver_has_no_shells() {
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("in.obj"), GROUPS).unwrap();
    done(dir.path(), &["fill", "in.obj", "-o", "mesh.inp"]);
    let text = std::fs::read_to_string(dir.path().join("mesh.inp")).unwrap();
    assert!(!text.contains("TYPE=S4"), "{text}");
    for line in ["*ELEMENT, TYPE=C3D8", "*SURFACE, TYPE=ELEMENT, NAME=inlet", "*ELSET, ELSET=volume"] {
        assert!(text.lines().any(|l| l == line), "{line} is not in {text}");
    }
    // A surface alone has no other place.
    done(dir.path(), &["convert", "in.obj", "-o", "surface.inp"]);
    assert!(std::fs::read_to_string(dir.path().join("surface.inp")).unwrap().contains("TYPE=S4"));
}

#[test]
fn formats_that_hold_no_hexes_are_refused_before_any_work() {
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("in.obj"), GROUPS).unwrap();
    done(dir.path(), &["fill", "in.obj", "-o", "mesh.vtk"]);
    for (command, input) in [("fill", "in.obj"), ("embed", "mesh.vtk"), ("simplify", "mesh.vtk")] {
        for extension in ["obj", "off", "ply"] {
            let (code, _, err) = hexfill(dir.path(), &[command, input, "-o", &format!("out.{extension}")]);
            assert_eq!(code, 2, "{command}: {err}");
            assert!(err.contains("cannot hold") && err.contains(".vtk"), "{command}: {err}");
            assert!(!err.contains("filled with"), "{err}");
        }
    }
}
