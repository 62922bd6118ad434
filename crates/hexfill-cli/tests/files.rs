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
    for extension in ["msh", "msh4", "inp", "bdf", "unv", "vtk", "vtu", "mesh", "ovm", "json"] {
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
    // The viewer names them.
    done(dir.path(), &["view", "filled.vtu", "--groups", "-o", "groups.html"]);
    let page = std::fs::read_to_string(dir.path().join("groups.html")).unwrap();
    assert!(page.contains(r#""names":["Box + inlet","Box + outlet + wall","Box + wall + steel"]"#), "groups by name");
}

/// Every command that writes cells of second order, in every format that has them: the corners are those of the straight mesh, and it is certified.
#[test]
fn quadratic_cells_are_written_if_asked_for() {
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("in.obj"), GROUPS).unwrap();
    done(dir.path(), &["fill", "in.obj", "-o", "straight.vtu"]);
    let straight = read_path(&dir.path().join("straight.vtu"), None).unwrap();
    for extension in ["vtu", "vtk", "msh", "msh4", "inp", "bdf", "unv"] {
        let name = |stem: &str| format!("{stem}.{extension}");
        done(dir.path(), &["fill", "in.obj", "--quadratic", "-o", &name("filled")]);
        done(dir.path(), &["convert", "straight.vtu", "--quadratic", "-o", &name("converted")]);
        done(dir.path(), &["embed", &name("filled"), "--linearise", "--quadratic", "-o", &name("embedded")]);
        for stem in ["filled", "converted", "embedded"] {
            let data = read_path(&dir.path().join(name(stem)), None).unwrap();
            assert_eq!(data.middles.len(), 20, "{stem}.{extension}: two boxes of 12 edges, 4 of them in common");
            let data = data.linearised();
            assert_eq!((&data.points, &data.hexes), (&straight.points, &straight.hexes), "{stem}.{extension}");
            assert_eq!(names(&data), names(&straight), "{stem}.{extension}");
            done(dir.path(), &["check", &name(stem), "--linearise", "--surface", "in.obj"]);
        }
    }
    // Refused before the work.
    for output in ["out.mesh", "out.ovm", "out.json"] {
        let (code, _, err) = hexfill(dir.path(), &["fill", "in.obj", "--quadratic", "-o", output]);
        assert!(code == 2 && err.contains("second order") && err.contains(".vtu"), "{err}");
    }
    // Nodes of a curved input are not those of the output, and that is said.
    let (_, _, err) = hexfill(dir.path(), &["fill", "filled.vtu", "--linearise", "--quadratic", "-o", "again.vtu"]);
    assert!(err.contains("do not come back"), "{err}");
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

/// The faces of the box without points in common, the upper half off by `off`.
fn loose(off: f64) -> String {
    let mut text = String::new();
    let whole: Vec<&str> = GROUPS.lines().filter(|l| l.starts_with("v ")).collect();
    for face in GROUPS.lines().filter_map(|l| l.strip_prefix("f ")) {
        for corner in face.split(' ') {
            let mut point: Vec<f64> =
                whole[corner.parse::<usize>().unwrap() - 1][2..].split(' ').map(|x| x.parse().unwrap()).collect();
            point[0] += if face.split(' ').any(|c| c == "10") { off } else { 0.0 };
            text += &format!("v {} {} {}\n", point[0], point[1], point[2]);
        }
        text += "f -4 -3 -2 -1\n";
    }
    text
}

#[test]
fn seams_are_named_with_the_tolerance_that_closes_them() {
    let dir = tempfile::tempdir().unwrap();
    for (off, due) in [(0.0, "--weld 0)"), (1e-7, "--weld 0.0000001"), (0.03, "--weld 0.031)")] {
        std::fs::write(dir.path().join("loose.obj"), loose(off)).unwrap();
        let (code, _, err) = hexfill(dir.path(), &["fill", "loose.obj", "-o", "mesh.vtk"]);
        assert_eq!(code, 2, "{err}");
        assert!(err.contains("40 boundary edges") && err.contains(due), "{off}: {err}");
        let said = err.split("(--weld ").nth(1).unwrap().split(')').next().unwrap();
        done(dir.path(), &["fill", "loose.obj", "-o", "mesh.vtk", "--weld", said]);
        done(dir.path(), &["convert", "loose.obj", "-o", "closed.obj", "--weld", said]);
        done(dir.path(), &["check", "mesh.vtk", "--surface", "closed.obj"]);
        let (code, _, err) = hexfill(dir.path(), &["info", "loose.obj", "--weld", said]);
        assert_eq!(code, 0, "{err}");
        assert!(err.contains("28 points merged into others, 12 are left"), "{err}");
    }
    let (code, _, err) = hexfill(dir.path(), &["fill", "loose.obj", "-o", "mesh.vtk", "--weld", "1.1"]);
    assert_eq!(code, 2);
    assert!(err.contains("smaller tolerance"), "{err}");
}

/// The box with a point in the middle of each edge of each quad.
fn quad8() -> (Vec<[f64; 3]>, Vec<[usize; 8]>) {
    let numbers = |l: &str| -> Vec<f64> { l.split(' ').map(|x| x.parse().unwrap()).collect() };
    let lines = |key: &'static str| GROUPS.lines().filter_map(move |l| l.strip_prefix(key));
    let mut points: Vec<[f64; 3]> = lines("v ").map(|l| numbers(l).try_into().unwrap()).collect();
    let mut between = std::collections::BTreeMap::new();
    let quads = lines("f ")
        .map(|l| {
            let corners: Vec<usize> = numbers(l).iter().map(|x| *x as usize - 1).collect();
            let mut quad = [0; 8];
            for k in 0..4 {
                let (a, b) = (corners[k], corners[(k + 1) % 4]);
                quad[k] = a;
                quad[k + 4] = *between.entry((a.min(b), a.max(b))).or_insert_with(|| {
                    points.push([0, 1, 2].map(|i| 0.5 * (points[a][i] + points[b][i])));
                    points.len() - 1
                });
            }
            quad
        })
        .collect();
    (points, quads)
}

#[test]
fn quadratic_surfaces_are_refused_with_a_remedy_and_read_as_their_corners() {
    let dir = tempfile::tempdir().unwrap();
    let (points, quads) = quad8();
    let rows = |separator: &str, base: usize, prefix: &dyn Fn(usize) -> String| -> String {
        let row = |(i, quad): (usize, &[usize; 8])| {
            let words: Vec<String> = quad.iter().map(|v| (v + base).to_string()).collect();
            format!("{}{}\n", prefix(i), words.join(separator))
        };
        quads.iter().enumerate().map(row).collect()
    };
    let at = |separator: &str, prefix: &dyn Fn(usize) -> String| -> String {
        let row = |(i, p): (usize, &[f64; 3])| format!("{}{}{separator}{}{separator}{}\n", prefix(i), p[0], p[1], p[2]);
        points.iter().enumerate().map(row).collect()
    };
    let (n, m) = (points.len(), quads.len());
    let none = |_: usize| String::new();
    let vtk = format!(
        "# vtk DataFile Version 3.0\nquad8\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {n} double\n{}CELLS {m} {}\n{}CELL_TYPES {m}\n{}",
        at(" ", &none),
        9 * m,
        rows(" ", 0, &|_| "8 ".to_owned()),
        "23\n".repeat(m)
    );
    let msh = format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{n}\n{}$EndNodes\n$Elements\n{m}\n{}$EndElements\n",
        at(" ", &|i| format!("{} ", i + 1)),
        rows(" ", 1, &|i| format!("{} 16 2 0 1 ", i + 1))
    );
    let inp = format!(
        "*NODE\n{}*ELEMENT, TYPE=S8R\n{}",
        at(", ", &|i| format!("{}, ", i + 1)),
        rows(", ", 1, &|i| format!("{}, ", i + 1))
    );
    for (name, text) in [("q.vtk", vtk), ("q.msh", msh), ("q.inp", inp)] {
        std::fs::write(dir.path().join(name), text).unwrap();
        for command in
            [&["fill", name, "-o", "mesh.vtk"][..], &["info", name], &["convert", name, "-o", "straight.obj"]]
        {
            let (code, _, err) = hexfill(dir.path(), command);
            assert_eq!(code, 2, "{command:?}: {err}");
            assert!(err.contains("--linearise") && err.contains("20 of its points"), "{command:?}: {err}");
            done(dir.path(), &[command, &["--linearise"]].concat());
        }
        done(dir.path(), &["check", "mesh.vtk", "--surface", name, "--linearise"]);
        assert_eq!(read_path(&dir.path().join("straight.obj"), None).unwrap().points, points[..12]);
    }
}

#[test]
fn files_that_cannot_be_filled_say_what_they_are_and_what_to_do() {
    let dir = tempfile::tempdir().unwrap();
    for (name, parts) in [
        ("part.stl", ["triangles", "RecombineAll"]),
        ("part.step", ["CAD", ".msh"]),
        ("part.cgns", ["meshio", ".vtu"]),
        ("part.meshb", ["binary", ".mesh"]),
    ] {
        std::fs::write(dir.path().join(name), "solid part\n").unwrap();
        let (code, _, err) = hexfill(dir.path(), &["fill", name, "-o", "mesh.vtk"]);
        assert_eq!(code, 2);
        assert!(parts.iter().all(|p| err.contains(p)), "{err}");
    }
}

#[test]
fn a_page_is_titled_by_the_name_of_its_file_alone() {
    let dir = tempfile::tempdir().unwrap();
    let mesh = dir.path().join("cube.vtk");
    let mesh = mesh.to_str().unwrap();
    assert_eq!(hexfill(dir.path(), &["fill", ":cube", "-o", mesh, "--view", "filled.html"]).0, 0);
    assert_eq!(hexfill(dir.path(), &["view", mesh, "-o", "viewed.html"]).0, 0);
    for (page, title) in [("filled.html", ":cube"), ("viewed.html", "cube.vtk")] {
        let text = std::fs::read_to_string(dir.path().join(page)).unwrap();
        assert!(text.contains(&format!("<title>{title}</title>")), "{page}");
    }
}
