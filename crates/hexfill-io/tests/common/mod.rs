//! Meshes shared by the tests.

#![allow(dead_code, missing_docs)]

use hexfill_io::{Format, MeshData, OtherFace, TagName, TagOn};

/// Two hexes glued along a facet, of different heights and corner numberings, with the ten boundary quads outwards and a
/// different tag on everything: its mirror image is another mesh.
pub(crate) fn chiral() -> MeshData {
    let points = vec![
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.25],
        [0.0, 1.0, 0.0],
        [0.1, -0.0, 1.0],
        [1.0, 0.1, 1.5],
        [1.0, 1.0, 1.75],
        [0.0, 0.9, 1.0 / 3.0 + 1.0],
        [3.0, 0.0, -0.5],
        [2.0, 1.0, 0.1],
        [2.5, 0.2, 1.1],
        [2.0, 1.2, 2.1],
    ];
    // The second hex starts at a corner of its own and lies on its side.
    let hexes = vec![[0, 1, 2, 3, 4, 5, 6, 7], [9, 2, 1, 8, 11, 6, 5, 10]];
    let quads = vec![
        [0, 4, 7, 3],
        [0, 1, 5, 4],
        [3, 7, 6, 2],
        [0, 3, 2, 1],
        [4, 5, 6, 7],
        [1, 8, 10, 5],
        [2, 6, 11, 9],
        [9, 8, 1, 2],
        [5, 10, 11, 6],
        [8, 9, 11, 10],
    ];
    MeshData {
        points,
        quads,
        hexes,
        point_tags: Some((0..12).map(|i| i % 5 * 7).collect()),
        quad_tags: Some(vec![4, 1, 1, 2, 2, 1, 3, 3, 12, 4]),
        hex_tags: Some(vec![21, 22]),
        ..MeshData::default()
    }
}

/// The chiral mesh with names for its tags, as far as the format has tags: all named, some by several names, one name twice.
pub(crate) fn named_for(format: Format) -> MeshData {
    let mut mesh = chiral_for(format);
    // As numbered where names decide: by first appearance, single names first.
    mesh.quad_tags = Some(vec![1, 2, 2, 5, 5, 2, 3, 3, 4, 1]);
    mesh.hex_tags = (!mesh.hexes.is_empty()).then(|| vec![1, 2]);
    mesh.point_tags = Some((0..12).map(|i| i % 3).collect());
    let name = |(on, tag, name): (TagOn, i64, &str)| TagName { on, tag, name: name.to_owned() };
    mesh.tag_names = [
        (TagOn::Points, 1, "fixed"),
        (TagOn::Points, 2, "loaded"),
        (TagOn::Faces, 1, "inlet"),
        (TagOn::Faces, 2, "outlet"),
        (TagOn::Faces, 3, "wall"),
        (TagOn::Faces, 4, "roof"),
        (TagOn::Faces, 5, "inlet"),
        (TagOn::Faces, 5, "wall"),
        (TagOn::Cells, 1, "steel"),
        (TagOn::Cells, 2, "rubber"),
    ]
    .map(name)
    .to_vec();
    if mesh.hexes.is_empty() {
        mesh.tag_names.retain(|n| n.on != TagOn::Cells);
    }
    without_what_is_not_held(mesh, format)
}

/// The chiral mesh with data, for the formats that hold it.
pub(crate) fn chiral_for(format: Format) -> MeshData {
    let mut mesh = chiral();
    if format.holds_data() {
        mesh.hex_data = vec![("scaled Jacobian".to_owned(), vec![0.75, -1e-300])];
        mesh.point_data = vec![("height".to_owned(), (0..12).map(|i| f64::from(i) / 7.0).collect())];
        for k in 0..3 {
            let column = |n: i32, scale: f64| (0..n).map(|i| f64::from(3 * i + k) * scale).collect();
            mesh.point_data.push((format!("shift:{k}"), column(12, 0.1)));
            mesh.hex_data.push((format!("flux:{k}"), column(2, -1.5)));
            mesh.quad_data.push((format!("flux:{k}"), column(10, 0.3)));
        }
        mesh.quad_data.push(("load".to_owned(), (0..10).map(|i| f64::from(i) / 3.0).collect()));
    }
    if !format.holds_cells() {
        mesh = mesh.surface_only();
    }
    without_what_is_not_held(mesh, format)
}

pub(crate) fn without_what_is_not_held(mut mesh: MeshData, format: Format) -> MeshData {
    if !format.holds_point_tags() {
        mesh.point_tags = None;
        mesh.tag_names.retain(|n| n.on != TagOn::Points);
    }
    if !format.holds_cell_tags() {
        mesh.quad_tags = None;
        mesh.hex_tags = None;
        mesh.tag_names.clear();
        mesh.other_faces.iter_mut().for_each(|f| f.tag = 0);
    }
    if !format.holds_data() {
        mesh.point_data.clear();
        mesh.quad_data.clear();
        mesh.hex_data.clear();
    }
    mesh
}

/// Abaqus knows quads on hexes as faces of these: their first corner is not kept.
pub(crate) fn with_any_first_corner(mut mesh: MeshData, format: Format) -> MeshData {
    if format == Format::Inp {
        mesh.quads.iter_mut().for_each(|q| *q = quad_key(q));
    }
    mesh
}

/// A mesh with every kind of cell and face.
pub(crate) fn mixed() -> MeshData {
    let mut mesh = chiral();
    mesh.points.extend([[0.5, 0.5, 3.0], [5.0, 5.0, 5.0], [0.5, 2.0, 0.5]]);
    mesh.point_tags = None;
    mesh.tets = vec![[4, 5, 12, 13]];
    mesh.pyramids = vec![[4, 5, 6, 7, 12]];
    mesh.wedges = vec![[0, 3, 14, 1, 2, 13]];
    mesh.other_faces = vec![
        OtherFace { position: 0, vertices: vec![4, 5, 12], tag: 9 },
        OtherFace { position: 4, vertices: vec![5, 6, 12], tag: 0 },
        OtherFace { position: 12, vertices: vec![8, 9, 11, 13, 10], tag: -3 },
    ];
    mesh
}

/// Equality to the bit, notes aside.
pub(crate) fn assert_same(found: &MeshData, due: &MeshData, what: &str) {
    let bits = |m: &MeshData| -> Vec<[u64; 3]> { m.points.iter().map(|p| p.map(f64::to_bits)).collect() };
    assert_eq!(bits(found), bits(due), "points of {what}");
    let data_bits = |data: &[(String, Vec<f64>)]| -> Vec<(String, Vec<u64>)> {
        let canonical = |x: &f64| if x.is_nan() { f64::NAN.to_bits() } else { x.to_bits() };
        data.iter().map(|(name, values)| (name.clone(), values.iter().map(canonical).collect())).collect()
    };
    assert_eq!(data_bits(&found.hex_data), data_bits(&due.hex_data), "hex data of {what}");
    assert_eq!(data_bits(&found.point_data), data_bits(&due.point_data), "point data of {what}");
    assert_eq!(data_bits(&found.quad_data), data_bits(&due.quad_data), "quad data of {what}");
    let rest = |m: &MeshData| MeshData {
        points: Vec::new(),
        hex_data: Vec::new(),
        quad_data: Vec::new(),
        point_data: Vec::new(),
        notes: Vec::new(),
        ..m.clone()
    };
    assert_eq!(rest(found), rest(due), "{what}");
}

/// A hex or quad is the same whatever corner comes first; its orientation is kept by comparing over rotations only.
fn hex_key(hex: &[u32; 8]) -> [u32; 8] {
    let rotations = &hexfill_mesh::cube::symmetries()[..24];
    rotations.iter().map(|s| s.map(|i| hex[i])).min().unwrap()
}

pub(crate) fn quad_key(quad: &[u32; 4]) -> [u32; 4] {
    let mut quad = *quad;
    let start = (0..4).min_by_key(|&k| quad[k]).unwrap();
    quad.rotate_left(start);
    quad
}

fn sorted<T: Ord>(items: impl Iterator<Item = T>) -> Vec<T> {
    let mut items: Vec<T> = items.collect();
    items.sort();
    items
}

/// Compares node sets, connectivity with orientation, and tags, after matching the points by position.
pub(crate) fn compare(found: &MeshData, due: &MeshData, exact: bool, tags: bool, what: &str) {
    assert_eq!(found.points.len(), due.points.len(), "{what}");
    let tolerance = if exact { 0.0 } else { 1e-5 };
    let map: Vec<u32> = found
        .points
        .iter()
        .map(|p| {
            let same = |q: &[f64; 3]| (0..3).all(|k| (p[k] - q[k]).abs() <= tolerance);
            due.points.iter().position(same).unwrap_or_else(|| panic!("{what}: {p:?} is no point")) as u32
        })
        .collect();
    let quads = |m: &MeshData, map: &dyn Fn(u32) -> u32| {
        sorted(
            m.quads
                .iter()
                .enumerate()
                .map(|(i, q)| (quad_key(&q.map(map)), m.quad_tags.as_ref().map_or(0, |t| if tags { t[i] } else { 0 }))),
        )
    };
    let hexes = |m: &MeshData, map: &dyn Fn(u32) -> u32| {
        sorted(
            m.hexes
                .iter()
                .enumerate()
                .map(|(i, h)| (hex_key(&h.map(map)), m.hex_tags.as_ref().map_or(0, |t| if tags { t[i] } else { 0 }))),
        )
    };
    let there = |v: u32| map[v as usize];
    assert_eq!(quads(found, &there), quads(due, &|v| v), "quads of {what}");
    assert_eq!(hexes(found, &there), hexes(due, &|v| v), "hexes of {what}");
}

/// Reads the files of a list and compares them with the chiral mesh. A line is: name, `exact` or `single` precision,
/// `tags` or `notags`, and what is in it: `quads`, `hexes` or `both`.
pub(crate) fn compare_list(directory: &std::path::Path, list: &str) -> usize {
    let mesh = chiral();
    let mut count = 0;
    for line in list.lines().filter(|l| !l.starts_with('#')) {
        let words: Vec<&str> = line.split_whitespace().collect();
        let [name, precision, tags, cells] = words[..] else { panic!("{line}") };
        let found = hexfill_io::read_path(&directory.join(name), None).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(name.starts_with("quadratic"), !found.middles.is_empty(), "{name}");
        let found = found.linearised();
        let mut due = mesh.clone();
        match cells {
            "both" => {}
            "quads" => due = due.surface_only(),
            "hexes" => {
                due.quads.clear();
                due.quad_tags = None;
            }
            other => panic!("{other}"),
        }
        compare(&found, &due, precision == "exact", tags == "tags", name);
        count += 1;
    }
    count
}
