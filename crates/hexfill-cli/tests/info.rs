//! `hexfill info` on surfaces: whether a hex mesh exists, why not, the certificate as a file, and what positions allow.

mod common;

use common::{hexfill, json};
use std::collections::BTreeMap;
use std::path::Path;

fn info(dir: &Path, file: &str) -> serde_json::Value {
    let (code, out, err) = hexfill(dir, &["info", file, "--json"]);
    assert_eq!(code, 0, "{err}");
    json(&out)
}

/// A torus of `n` quads round the tube and `m` round the axis as OBJ text; `first` vertices come before it.
fn torus(n: usize, m: usize, r: f64, x: f64, outward: bool, first: usize) -> String {
    let turn = std::f64::consts::TAU;
    let mut text = String::new();
    for j in 0..m {
        for i in 0..n {
            let (a, b) = (turn * i as f64 / n as f64, turn * j as f64 / m as f64);
            let d = 3.0 + r * a.cos();
            text += &format!("v {} {} {}\n", x + d * b.cos(), d * b.sin(), r * a.sin());
        }
    }
    for j in 0..m {
        for i in 0..n {
            let at = |i: usize, j: usize| first + (j % m) * n + i % n + 1;
            let mut q = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
            if !outward {
                q.reverse();
            }
            text += &format!("f {} {} {} {}\n", q[0], q[1], q[2], q[3]);
        }
    }
    text
}

#[test]
fn the_cycle_that_bounds_is_named_and_exported() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    std::fs::write(at.join("odd.obj"), torus(5, 4, 1.0, 0.0, true, 0)).unwrap();
    let found = info(at, "odd.obj");
    assert_eq!(found["hex_mesh"], "none");
    let cycle = found["bounding_cycle"].as_array().unwrap();
    assert_eq!(cycle.len() % 2, 1);
    let (code, out, err) = hexfill(at, &["info", "odd.obj", "--cycle", "cycle.txt"]);
    assert_eq!(code, 0);
    assert!(out.contains("none exists: an odd cycle of") && err.contains("wrote cycle.txt"), "{out}{err}");
    let text = std::fs::read_to_string(at.join("cycle.txt")).unwrap();
    let edges: Vec<Vec<usize>> = text.lines().map(|l| l.split(' ').map(|w| w.parse().unwrap()).collect()).collect();
    assert_eq!(edges.len(), cycle.len());
    let mut degree: BTreeMap<usize, usize> = BTreeMap::new();
    edges.iter().flatten().for_each(|&v| *degree.entry(v).or_default() += 1);
    assert!(degree.values().all(|d| d % 2 == 0));
    // As lines: the same edges, 1-based, with the surface's points.
    hexfill(at, &["info", "odd.obj", "--cycle", "cycle.obj"]);
    let text = std::fs::read_to_string(at.join("cycle.obj")).unwrap();
    assert_eq!(text.lines().filter(|l| l.starts_with("v ")).count(), 20);
    let lines: Vec<String> = edges.iter().map(|e| format!("l {} {}", e[0] + 1, e[1] + 1)).collect();
    assert_eq!(text.lines().filter(|l| l.starts_with("l ")).collect::<Vec<_>>(), lines);
    // The construction refuses with a certificate of its own.
    let (code, _, err) = hexfill(at, &["fill", "odd.obj", "-o", "m.vtk"]);
    assert!(code == 2 && err.contains("odd cycle") && !at.join("m.vtk").exists(), "{err}");
}

#[test]
fn an_odd_cycle_that_does_not_bound_is_harmless() {
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("axis.obj"), torus(4, 5, 1.0, 0.0, true, 0)).unwrap();
    let found = info(dir.path(), "axis.obj");
    assert_eq!((&found["hex_mesh"], &found["bipartite"]), (&"exists".into(), &false.into()));
    let (code, _, err) = hexfill(dir.path(), &["info", "axis.obj", "--cycle", "c.txt"]);
    assert!(code == 0 && err.contains("c.txt was not written"), "{err}");
    assert!(!dir.path().join("c.txt").exists());
    for (file, word) in [("c.vtk", ".txt"), ("no/c.txt", "does not exist"), ("axis.obj", "same file")] {
        let (code, out, err) = hexfill(dir.path(), &["info", "axis.obj", "--cycle", file]);
        assert!(code == 2 && out.is_empty() && err.contains(word), "{err}");
    }
    let (code, _, err) = hexfill(dir.path(), &["info", "axis.obj", "--json"]);
    assert_eq!(code, 0, "{err}");
}

#[test]
fn odd_numbers_of_quads_are_counted_by_solid() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    std::fs::write(at.join("odd.obj"), torus(3, 5, 1.0, 0.0, true, 0)).unwrap();
    let found = info(at, "odd.obj");
    assert!(found["hex_mesh"] == "none" && found["because"].as_str().unwrap().contains("15 quads"));
    let apart = torus(3, 5, 1.0, 0.0, true, 0) + &torus(3, 5, 1.0, 20.0, true, 15);
    std::fs::write(at.join("apart.obj"), apart).unwrap();
    let found = info(at, "apart.obj");
    assert!(found["hex_mesh"] == "none" && found["because"].as_str().unwrap().contains("component 0"), "{found}");
    assert_eq!(found["parts"].as_array().unwrap().len(), 2);
    // One inside the other: 40 quads of one solid, and it can be filled.
    let nested = torus(5, 5, 2.0, 0.0, true, 0) + &torus(3, 5, 0.7, 0.0, false, 25);
    std::fs::write(at.join("nested.obj"), nested).unwrap();
    assert_eq!(info(at, "nested.obj")["hex_mesh"], "exists");
    let (code, _, err) = hexfill(at, &["fill", "nested.obj", "-o", "m.vtk", "--no-embed"]);
    assert_eq!(code, 0, "{err}");
    let (code, _, err) = hexfill(at, &["check", "m.vtk", "--surface", "nested.obj"]);
    assert!(code != 2, "{err}");
}

#[test]
fn quads_that_share_too_much_are_listed() {
    let dir = tempfile::tempdir().unwrap();
    let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nv 0.4 0.4 1\nv 0.6 0.6 1\n\
        f 1 5 8 4\nf 2 3 7 6\nf 1 2 6 5\nf 4 8 7 3\nf 1 4 3 2\nf 5 6 7 9\nf 5 9 7 10\nf 5 10 7 8\n";
    std::fs::write(dir.path().join("fan.obj"), text).unwrap();
    let found = info(dir.path(), "fan.obj");
    assert_eq!(found["hex_mesh"], "none");
    assert_eq!(found["improper_pairs"], 3);
    assert_eq!(found["first_improper_pairs"][0], serde_json::json!([5, 6]));
}

/// The boundary of unit cubes as OBJ text, each corner moved by `f`.
fn voxels(filled: &[[i32; 3]], f: impl Fn([f64; 3]) -> [f64; 3]) -> String {
    const SIDES: [([i32; 3], [[i32; 3]; 4]); 6] = [
        ([-1, 0, 0], [[0, 0, 0], [0, 0, 1], [0, 1, 1], [0, 1, 0]]),
        ([1, 0, 0], [[1, 0, 0], [1, 1, 0], [1, 1, 1], [1, 0, 1]]),
        ([0, -1, 0], [[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]]),
        ([0, 1, 0], [[0, 1, 0], [0, 1, 1], [1, 1, 1], [1, 1, 0]]),
        ([0, 0, -1], [[0, 0, 0], [0, 1, 0], [1, 1, 0], [1, 0, 0]]),
        ([0, 0, 1], [[0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]]),
    ];
    let add = |a: [i32; 3], b: [i32; 3]| [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
    let mut points: Vec<[i32; 3]> = Vec::new();
    let mut faces = String::new();
    for &cell in filled {
        for (to, corners) in SIDES {
            if filled.contains(&add(cell, to)) {
                continue;
            }
            faces += "f";
            for corner in corners {
                let p = add(cell, corner);
                let at = points.iter().position(|&q| q == p).unwrap_or(points.len());
                if at == points.len() {
                    points.push(p);
                }
                faces += &format!(" {}", at + 1);
            }
            faces += "\n";
        }
    }
    let line = |p: &[i32; 3]| {
        let [x, y, z] = f(p.map(f64::from));
        format!("v {x} {y} {z}\n")
    };
    points.iter().map(line).collect::<String>() + &faces
}

#[test]
fn vertices_without_a_direction_are_named() {
    let dir = tempfile::tempdir().unwrap();
    // Four cubes in a chain round one point: its quads look both ways along two axes.
    let chain = voxels(&[[0, 0, 0], [1, 0, 0], [1, 1, 0], [1, 1, 1]], |p| p);
    std::fs::write(dir.path().join("chain.obj"), &chain).unwrap();
    let middle = chain.lines().position(|l| l == "v 1 1 1").unwrap();
    let limits = &info(dir.path(), "chain.obj")["limits"];
    assert_eq!((&limits["no_direction"]["count"], &limits["sharp_edges"]["count"]), (&1.into(), &0.into()));
    assert_eq!(limits["no_direction"]["first"][0]["vertex"], middle);
    assert!(limits["any_mesh"].as_f64().unwrap() > 0.999 && limits["one_edge"].as_f64().unwrap().abs() < 1e-9);
    let (_, out, _) = hexfill(dir.path(), &["info", "chain.obj"]);
    let wanted = format!("1 vertex with no single direction that sees all its quads: v{middle} (0.000)");
    assert!(out.contains(&wanted), "{out}");
    // Without positions there is nothing to say.
    let (_, out, _) = hexfill(dir.path(), &["info", ":schneiders-pyramid", "--json"]);
    let signature = json(&out)["signature"].as_str().unwrap().to_owned();
    assert!(info(dir.path(), &signature)["limits"].is_null());
}

#[test]
fn sharp_edges_and_flat_corners_are_named() {
    let dir = tempfile::tempdir().unwrap();
    // A cube sheared to edges of 5.7 degrees: four of its edges, and needles and flat corners on two of its sides.
    let sheared = voxels(&[[0, 0, 0]], |[x, y, z]| [x, y + 10.0 * z, z]);
    std::fs::write(dir.path().join("sheared.obj"), sheared).unwrap();
    let limits = &info(dir.path(), "sheared.obj")["limits"];
    let count = |kind: &str| limits[kind]["count"].as_u64().unwrap();
    assert_eq!((count("sharp_edges"), count("needle_corners"), count("flat_corners")), (2, 4, 4));
    assert_eq!((count("reflex_corners"), count("no_direction")), (0, 0));
    let sine = 1.0 / 101f64.sqrt();
    assert!((limits["any_mesh"].as_f64().unwrap() - sine).abs() < 1e-9, "{limits}");
    let edge = &limits["sharp_edges"]["first"][0];
    assert!((edge["hexes"].as_f64().unwrap() - sine.asin().to_degrees() / 90.0).abs() < 1e-9);
    let (_, out, _) = hexfill(dir.path(), &["info", "sheared.obj"]);
    assert!(out.contains("2 sharp edges: v") && out.contains("(5.7 degrees, 0.06 hexes)"), "{out}");
    assert!(out.contains("scaled Jacobian: at most 0.100 in any mesh"), "{out}");
}

#[test]
fn chords_are_drawn_and_their_quads_counted_once() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    let (code, out, err) = hexfill(at, &["info", ":schneiders-pyramid", "--svg", "p.svg"]);
    assert_eq!(code, 0, "{err}");
    assert!(out.contains("chords: 2, of 16 (24 passages, crossing itself 8 times), 8 quads"), "{out}");
    let svg = std::fs::read_to_string(at.join("p.svg")).unwrap();
    assert!(svg.contains(">c0: 16 quads, 8 self-crossings (24 passages)<") && svg.contains(">c1: 8 quads<"), "{svg}");
    assert!(svg.contains("<title>Chords of :schneiders-pyramid</title>"));
    let chord = &info(at, ":schneiders-pyramid")["chords"][0];
    assert_eq!((&chord["quads"], &chord["passages"], &chord["self_crossings"]), (&16.into(), &24.into(), &8.into()));
    // A mesh: its boundary. A torus: refused, and nothing is written.
    let (code, _, err) = hexfill(at, &["fill", ":cube", "-o", "cube.vtk"]);
    assert_eq!(code, 0, "{err}");
    assert_eq!(hexfill(at, &["info", "cube.vtk", "--svg", "cube.svg"]).0, 0);
    assert!(std::fs::read_to_string(at.join("cube.svg")).unwrap().contains("6 quads, 3 chords"));
    std::fs::write(at.join("ring.obj"), torus(4, 5, 1.0, 0.0, true, 0)).unwrap();
    for (file, word) in [("ring.svg", "genus 1; only a sphere lies flat"), ("ring.png", "ends in .svg")] {
        let (code, _, err) = hexfill(at, &["info", "ring.obj", "--svg", file]);
        assert!(code == 2 && err.contains(word) && !at.join(file).exists(), "{err}");
    }
}

/// The estimate of `fill`, word for word; null where that would say nothing.
#[test]
fn the_estimate_of_fill_is_told() {
    let dir = tempfile::tempdir().unwrap();
    // A box of 12 x 12 x 12 that is bent: no grid fills it at once.
    let (surface, cells) = hexfill::mesh::generate::voxels([12, 12, 12], |_| true).unwrap();
    let bent = cells.into_iter().map(|p| p.map(f64::from)).map(|[x, y, z]| [x + 0.1 * y * y, y, z]).collect();
    let data = hexfill::io::MeshData::from_quads(bent, surface.quads_raw());
    hexfill::io::write_path(&dir.path().join("bent.obj"), None, &data).unwrap();
    let told = info(dir.path(), "bent.obj")["estimate"].clone();
    assert!(told["seconds"][0].as_f64() < told["seconds"][1].as_f64(), "{told}");
    assert_eq!(told["engines"][0], "shelling");
    let (_, out, _) = hexfill(dir.path(), &["info", "bent.obj"]);
    let line = out.lines().find(|line| line.starts_with("estimate: about ")).expect("a line");
    let (_, _, err) = hexfill(dir.path(), &["fill", "bent.obj", "--time-limit", "0"]);
    assert!(err.contains(line), "{line}\n{err}");
    assert!(info(dir.path(), ":cube")["estimate"].is_null());
}
