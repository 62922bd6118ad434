//! OpenVolumeMesh ASCII (`.ovm`): edges as pairs of vertices, faces as cycles of half-edges, cells as sets of half-faces.
//!
//! Half-edge `2 e` runs as edge `e`, `2 e + 1` against it; half-face `2 f` is face `f`, `2 f + 1` its reverse. The half-faces of
//! a cell are counter-clockwise seen from inside. On writing, the faces of the mesh come first, as they are, then the other
//! facets of the hexes. On reading, the faces are those marked by our own property `hexfill:face`, otherwise all that have at most
//! one cell. Other properties are tags and data; names of tags are kept in comments. A second property keeps the first corner of each hex, because half-faces know the cell only up to rotation.
//!
//! Source: Kremer et al. 2013.

use crate::arrays::{self, component};
use crate::assembly::{Assembly, Slot, Values};
use crate::data::MeshData;
use crate::error::ReadError;
use crate::orders::OVM_HALF_FACES;
use crate::source::{Source, reserve};
use crate::write::{Real, has_cell_tags, unquoted, write_indices, write_point};
use rustc_hash::FxHashMap;
use std::io::{self, Write};

mod topology;

use topology::Topology;

const FACE_MARK: &str = "hexfill:face";
const CORNER_MARK: &str = "hexfill:corner";

/// A property that is data: on what, name, components, values.
type Array = (On, String, usize, Vec<f64>);

/// The properties of a file, ours by their names.
#[derive(Default)]
struct Properties {
    point_tags: Option<Vec<i64>>,
    face_tags: Option<Vec<i64>>,
    cell_tags: Option<Vec<i64>>,
    face_marks: Option<Vec<i64>>,
    corners: Option<Vec<i64>>,
    arrays: Vec<Array>,
}

/// What a property is on.
#[derive(Clone, Copy, PartialEq, Eq)]
enum On {
    Points,
    Faces,
    Cells,
}

/// How many numbers a value of a type has; 0 for a type that is no number.
fn components_of(scalar: &str) -> usize {
    match scalar {
        "int" | "long" | "short" | "char" | "unsigned int" | "uint" | "float" | "double" | "bool" => 1,
        vector => match vector.as_bytes() {
            [b'v', b'e', b'c', n @ b'2'..=b'4', b'd' | b'f' | b'i'] => usize::from(n - b'0'),
            _ => 0,
        },
    }
}

pub(crate) fn read(source: Source<'_>) -> Result<MeshData, ReadError> {
    let mut s = source.with_comments(b'#');
    let mut out = Assembly::default();
    read_header(&mut s)?;
    read_points(&mut s, &mut out)?;
    let n_points = out.mesh.points.len();
    let edges = read_edges(&mut s, n_points)?;
    let n = open_section(&mut s, "Faces")?;
    let mut faces: Vec<Vec<u32>> = Vec::with_capacity(reserve(n));
    for i in 0..n {
        line(&mut s, n, "faces", i)?;
        faces.push(read_face(&mut s, &edges)?);
    }
    let polyhedra = read_polyhedra(&mut s, faces.len())?;
    let properties = read_properties(&mut s, &mut out, n_points, faces.len(), polyhedra.cells.len())?;
    let face_slots = add_faces(&mut out, &faces, &polyhedra.of_face, &properties);
    let mut cell_slots = Vec::with_capacity(polyhedra.cells.len());
    for (c, cell) in polyhedra.cells.iter().enumerate() {
        let tag = properties.cell_tags.as_ref().map_or(0, |t| t[c]);
        let corner = properties.corners.as_ref().and_then(|t| u32::try_from(t[c]).ok());
        cell_slots.push(add_cell(&s, &mut out, &faces, cell, corner, tag, c)?);
    }
    add_arrays(&mut out, properties.arrays, &face_slots, &cell_slots);
    out.name_tags(s.take_tag_names().into_iter());
    if let Some(tags) = properties.point_tags {
        out.point_tags = tags;
    }
    Ok(out.finish())
}

fn read_header(s: &mut Source<'_>) -> Result<(), ReadError> {
    if !s.next_full_line()? {
        return Err(s.empty());
    }
    let span = s.need_word("`OVM`")?;
    if !s.text(span).eq_ignore_ascii_case(b"OVM") {
        return Err(s.malformed("`OVM ASCII`", span, "is this an OVM file? (.ovmb is another format)"));
    }
    let span = s.need_word("`ASCII`")?;
    if !s.text(span).eq_ignore_ascii_case(b"ASCII") {
        return Err(s.unsupported("binary OVM", "save it as ASCII"));
    }
    Ok(())
}

fn read_points(s: &mut Source<'_>, out: &mut Assembly) -> Result<(), ReadError> {
    let n = open_section(s, "Vertices")?;
    out.mesh.points.reserve(reserve(n));
    for i in 0..n {
        line(s, n, "points", i)?;
        out.mesh.points.push(s.point_on_line()?);
    }
    Ok(())
}

fn read_edges(s: &mut Source<'_>, n_points: usize) -> Result<Vec<[u32; 2]>, ReadError> {
    let n = open_section(s, "Edges")?;
    let mut edges: Vec<[u32; 2]> = Vec::with_capacity(reserve(n));
    for i in 0..n {
        line(s, n, "edges", i)?;
        let mut edge = [0; 2];
        for end in &mut edge {
            let span = s.need_word("a vertex")?;
            *end = s.index(span, 0, n_points, "vertex")?;
        }
        edges.push(edge);
    }
    Ok(edges)
}

/// The cells of a file.
struct Polyhedra {
    /// Half-faces per cell.
    cells: Vec<Vec<u32>>,
    /// Per face: number of cells, and the last half-face of it that a cell has.
    of_face: Vec<(u8, u32)>,
}

fn read_polyhedra(s: &mut Source<'_>, n_faces: usize) -> Result<Polyhedra, ReadError> {
    let n = open_section(s, "Polyhedra")?;
    let mut cells: Vec<Vec<u32>> = Vec::with_capacity(reserve(n));
    let mut of_face = vec![(0u8, 0u32); n_faces];
    for i in 0..n {
        line(s, n, "polyhedra", i)?;
        let span = s.need_word("the number of faces")?;
        let sides = s.count(span, "faces")?;
        let mut cell = Vec::new();
        for _ in 0..sides {
            let span = s.need_word_or(|| format!("{sides} half-faces"))?;
            let half_face = s.index(span, 0, 2 * n_faces, "half-face")?;
            let users = &mut of_face[half_face as usize / 2];
            *users = (users.0.saturating_add(1), half_face);
            cell.push(half_face);
        }
        cells.push(cell);
    }
    Ok(Polyhedra { cells, of_face })
}

/// Adds the faces of the mesh: those that our own property marks, otherwise those with at most one cell. Where each face went.
fn add_faces(out: &mut Assembly, faces: &[Vec<u32>], of_face: &[(u8, u32)], properties: &Properties) -> Vec<Slot> {
    let mut slots = vec![Slot::Elsewhere; faces.len()];
    for (f, face) in faces.iter().enumerate() {
        let (n_cells, half_face) = of_face[f];
        let listed = match &properties.face_marks {
            Some(marks) => marks[f] != 0,
            None => n_cells <= 1,
        };
        if !listed {
            continue;
        }
        let mut face = face.clone();
        // Without marks the faces have no orientation of their own: one whose cell is on its inner side is turned outwards.
        if properties.face_marks.is_none() && n_cells == 1 && half_face.is_multiple_of(2) {
            face[1..].reverse();
        }
        slots[f] = out.face(&face, properties.face_tags.as_ref().map_or(0, |t| t[f]));
    }
    slots
}

fn add_arrays(out: &mut Assembly, arrays: Vec<Array>, face_slots: &[Slot], cell_slots: &[Slot]) {
    // The faces that only cells have carry no data of their own.
    let listed: Vec<usize> = (0..face_slots.len()).filter(|&f| face_slots[f] != Slot::Elsewhere).collect();
    for (on, name, components, values) in arrays {
        match on {
            On::Points => out.point_array(&name, components, &Values::Real(values)),
            On::Faces => {
                let slots: Vec<Slot> = listed.iter().map(|&f| face_slots[f]).collect();
                let values = listed.iter().flat_map(|f| &values[f * components..][..components]).copied().collect();
                out.cell_array(&name, components, &Values::Real(values), &slots);
            }
            On::Cells => out.cell_array(&name, components, &Values::Real(values), cell_slots),
        }
    }
}

fn line(s: &mut Source<'_>, n: u64, what: &str, i: u64) -> Result<(), ReadError> {
    if s.next_full_line()? { Ok(()) } else { Err(s.truncated(format!("{n} {what}, found {i}"))) }
}

fn open_section(s: &mut Source<'_>, name: &str) -> Result<u64, ReadError> {
    line(s, 1, &format!("sections {name}"), 0)?;
    let span = s.need_word(name)?;
    if !s.text(span).eq_ignore_ascii_case(name.as_bytes()) {
        return Err(s.malformed(format!("`{name}`"), span, "correct the count of the section before"));
    }
    line(s, 1, "counts", 0)?;
    let span = s.need_word("a count")?;
    s.count(span, &name.to_lowercase())
}

/// The vertices of a face, from its half-edges.
fn read_face(s: &mut Source<'_>, edges: &[[u32; 2]]) -> Result<Vec<u32>, ReadError> {
    let span = s.need_word("the number of sides")?;
    let sides = s.count(span, "sides")?;
    if sides < 3 {
        return Err(s.malformed("a face with three or more sides", span, "remove or complete the face"));
    }
    let mut face = Vec::new();
    let mut first = 0;
    let mut at = 0;
    for k in 0..sides {
        let span = s.need_word_or(|| format!("{sides} half-edges"))?;
        let half_edge = s.index(span, 0, 2 * edges.len(), "half-edge")? as usize;
        let [mut from, mut to] = edges[half_edge / 2];
        if half_edge % 2 == 1 {
            std::mem::swap(&mut from, &mut to);
        }
        if k == 0 {
            first = from;
        } else if from != at {
            return Err(s.malformed(
                format!("a half-edge from vertex {at}"),
                span,
                "the half-edges of a face form a cycle",
            ));
        }
        face.push(from);
        at = to;
    }
    if at != first {
        let given = format!("a path that ends at vertex {at}");
        return Err(s.malformed_text(format!("a cycle back to vertex {first}"), given, "correct the half-edges"));
    }
    Ok(face)
}

fn read_properties(
    s: &mut Source<'_>,
    out: &mut Assembly,
    n_points: usize,
    n_faces: usize,
    n_cells: usize,
) -> Result<Properties, ReadError> {
    let mut properties = Properties::default();
    while s.next_full_line()? {
        let text = String::from_utf8_lossy(s.line()).into_owned();
        let mut words = text.split_whitespace();
        let kind = words.next().unwrap_or_default().to_ascii_lowercase();
        let scalar = words.next().unwrap_or_default().to_ascii_lowercase();
        let name = text.split('"').nth(1).unwrap_or_default();
        let whole = ["int", "long", "short", "unsigned int", "uint"].contains(&scalar.as_str());
        let (slot, n) = match (kind.as_str(), name) {
            ("vprop", "tag") => (&mut properties.point_tags, n_points),
            ("fprop", "tag") => (&mut properties.face_tags, n_faces),
            ("cprop", "tag") => (&mut properties.cell_tags, n_cells),
            ("fprop", FACE_MARK) => (&mut properties.face_marks, n_faces),
            ("cprop", CORNER_MARK) => (&mut properties.corners, n_cells),
            _ => {
                let (on, n) = match kind.as_str() {
                    "vprop" => (On::Points, n_points),
                    "fprop" => (On::Faces, n_faces),
                    "cprop" => (On::Cells, n_cells),
                    // How many lines another property has is not known: everything but headers is skipped.
                    _ => {
                        if kind.ends_with("prop") {
                            out.ignore("properties");
                        }
                        continue;
                    }
                };
                let components = components_of(&scalar);
                if components == 0 || name.is_empty() {
                    out.ignore("properties");
                    continue;
                }
                let values = read_values(s, n, components)?;
                properties.arrays.push((on, name.to_owned(), components, values));
                continue;
            }
        };
        if !whole {
            out.ignore("properties");
            continue;
        }
        let mut values = Vec::with_capacity(reserve(n as u64));
        for i in 0..n {
            line(s, n as u64, "values of the property", i as u64)?;
            let span = s.need_word("a value")?;
            values.push(s.integer(span, "a value")?);
        }
        *slot = Some(values);
    }
    Ok(properties)
}

/// The values of a property, one element a line.
fn read_values(s: &mut Source<'_>, n: usize, components: usize) -> Result<Vec<f64>, ReadError> {
    let mut values = Vec::with_capacity(reserve((n * components) as u64));
    for i in 0..n {
        line(s, n as u64, "values of the property", i as u64)?;
        for _ in 0..components {
            let span = s.need_word("a value")?;
            values.push(s.number(span, "a value")?);
        }
    }
    Ok(values)
}

/// Finds out what a cell is from its half-faces.
fn add_cell(
    s: &Source<'_>,
    out: &mut Assembly,
    faces: &[Vec<u32>],
    cell: &[u32],
    corner: Option<u32>,
    tag: i64,
    c: usize,
) -> Result<Slot, ReadError> {
    let cycles: Vec<Vec<u32>> = cell
        .iter()
        .map(|&half_face| {
            let mut cycle = faces[half_face as usize / 2].clone();
            if half_face % 2 == 1 {
                cycle.reverse();
            }
            cycle
        })
        .collect();
    let triangles = cycles.iter().filter(|c| c.len() == 3).count();
    let quads = cycles.iter().filter(|c| c.len() == 4).count();
    if triangles + quads != cycles.len() {
        out.ignore("polyhedra that are no hexes");
        return Ok(Slot::Elsewhere);
    }
    // The bottom: the triangle of a tet or wedge, the quad of a pyramid or hex.
    let (bottom, n_nodes) = match (triangles, quads) {
        (0, 6) => (0, 8),
        (4, 0) => (0, 4),
        (4, 1) => (cycles.iter().position(|c| c.len() == 4).unwrap_or(0), 5),
        (2, 3) => (cycles.iter().position(|c| c.len() == 3).unwrap_or(0), 6),
        _ => {
            out.ignore("polyhedra that are no hexes");
            return Ok(Slot::Elsewhere);
        }
    };
    let nodes = corners(&cycles, bottom, n_nodes).ok_or_else(|| {
        let given = format!("other half-faces in cell {c} (0-based)");
        s.malformed_text(format!("the closed surface of a cell with {n_nodes} vertices"), given, "repair the cell")
    })?;
    if let Ok(mut hex) = <[u32; 8]>::try_from(nodes.as_slice()) {
        if let Some(turns) = corner.and_then(|corner| hex[..4].iter().position(|&v| v == corner)) {
            hex[..4].rotate_left(turns);
            hex[4..].rotate_left(turns);
        }
        return Ok(out.hex(hex, tag));
    }
    out.small_cell(&nodes, tag);
    Ok(Slot::Elsewhere)
}

/// Nodes of a cell: the bottom cycle (seen from inside), then the vertex above each, then nothing else may be left.
fn corners(cycles: &[Vec<u32>], bottom: usize, n_nodes: usize) -> Option<Vec<u32>> {
    // Next vertex along each half-edge: a half-edge occurs once, its reverse in the neighbouring half-face.
    let mut next = FxHashMap::default();
    let mut vertices: Vec<u32> = cycles.iter().flatten().copied().collect();
    for cycle in cycles {
        for k in 0..cycle.len() {
            let (a, b, c) = (cycle[k], cycle[(k + 1) % cycle.len()], cycle[(k + 2) % cycle.len()]);
            if next.insert((a, b), c).is_some() {
                return None;
            }
        }
    }
    if next.keys().any(|&(a, b)| a == b || !next.contains_key(&(b, a))) {
        return None;
    }
    vertices.sort_unstable();
    vertices.dedup();
    if vertices.len() != n_nodes {
        return None;
    }
    let base = &cycles[bottom];
    let mut nodes = base.clone();
    if n_nodes == 4 || n_nodes == 5 {
        nodes.extend(vertices.iter().find(|v| !base.contains(v)));
    } else {
        for k in 0..base.len() {
            // The side face across the edge to the next vertex runs from that vertex to this one and then up.
            let above = *next.get(&(base[(k + 1) % base.len()], base[k]))?;
            nodes.push(above);
        }
    }
    let mut distinct = nodes.clone();
    distinct.sort_unstable();
    if distinct != vertices {
        return None;
    }
    // The top cycle must run against the bottom one.
    let top = &nodes[base.len()..];
    let closed = top.len() < 3 || (0..top.len()).all(|k| next.contains_key(&(top[(k + 1) % top.len()], top[k])));
    closed.then_some(nodes)
}

/// More edges than numbers: refused before anything is written.
fn check_size(data: &MeshData) -> io::Result<()> {
    let sides: usize = data.faces().map(<[u32]>::len).sum();
    let edges = [(12, data.hexes.len()), (6, data.tets.len()), (9, data.wedges.len()), (8, data.pyramids.len())];
    let most = edges.into_iter().fold(sides, |sum, (each, n)| sum.saturating_add(n.saturating_mul(each)));
    if most < 1 << 31 {
        Ok(())
    } else {
        Err(io::Error::other("too large: OVM files are written with up to 2^31 edges"))
    }
}

/// Half-faces of each kind of cell as its corners, counter-clockwise seen from inside.
const TET: [&[usize]; 4] = [&[0, 1, 2], &[0, 2, 3], &[0, 3, 1], &[1, 3, 2]];
const WEDGE: [&[usize]; 5] = [&[0, 1, 2], &[3, 5, 4], &[1, 0, 3, 4], &[2, 1, 4, 5], &[0, 2, 5, 3]];
const PYRAMID: [&[usize]; 5] = [&[0, 1, 2, 3], &[1, 0, 4], &[2, 1, 4], &[3, 2, 4], &[0, 3, 4]];

/// The half-faces of all cells, one after the other: hexes, tets, wedges, pyramids.
fn half_faces(topology: &mut Topology, data: &MeshData) -> Vec<u32> {
    let n_small = 4 * data.tets.len() + 5 * (data.wedges.len() + data.pyramids.len());
    let mut all = Vec::with_capacity(6 * data.hexes.len() + n_small);
    let mut cycle = Vec::with_capacity(4);
    let mut add = |nodes: &[u32], facets: &[&[usize]]| {
        for corners in facets {
            cycle.clear();
            cycle.extend(corners.iter().map(|&i| nodes[i]));
            all.push(topology.half_face(&cycle));
        }
    };
    let of_hex = OVM_HALF_FACES.each_ref().map(<[usize; 4]>::as_slice);
    data.hexes.iter().for_each(|hex| add(hex, &of_hex));
    data.tets.iter().for_each(|tet| add(tet, &TET));
    data.wedges.iter().for_each(|wedge| add(wedge, &WEDGE));
    data.pyramids.iter().for_each(|pyramid| add(pyramid, &PYRAMID));
    all
}

pub(crate) fn write(out: &mut dyn Write, data: &MeshData) -> io::Result<()> {
    check_size(data)?;
    let mut topology = Topology::default();
    data.faces().for_each(|face| topology.add_face(face));
    let n_listed = topology.n_faces();
    let cells = half_faces(&mut topology, data);
    let n_other = topology.n_faces() - n_listed;
    writeln!(out, "OVM ASCII")?;
    for name in &data.tag_names {
        writeln!(out, "#{}", name.line())?;
    }
    writeln!(out, "Vertices\n{}", data.points.len())?;
    for point in &data.points {
        write_point(out, point, " ")?;
        out.write_all(b"\n")?;
    }
    writeln!(out, "Edges\n{}", topology.edges.len())?;
    for [a, b] in &topology.edges {
        writeln!(out, "{a} {b}")?;
    }
    writeln!(out, "Faces\n{}", topology.n_faces())?;
    for face in data.faces() {
        let sides: Vec<u32> =
            (0..face.len()).map(|k| topology.half_edge(face[k], face[(k + 1) % face.len()])).collect();
        write_list(out, &sides)?;
    }
    for face in n_listed..topology.n_faces() {
        write_list(out, topology.half_edges(face))?;
    }
    writeln!(out, "Polyhedra\n{}", data.cell_count())?;
    let (hexes, rest) = cells.split_at(6 * data.hexes.len());
    let (tets, others) = rest.split_at(4 * data.tets.len());
    for (cells, facets) in [(hexes, 6), (tets, 4), (others, 5)] {
        for cell in cells.chunks_exact(facets) {
            write_list(out, cell)?;
        }
    }
    let face_marks = std::iter::repeat_n(1, n_listed).chain(std::iter::repeat_n(0, n_other));
    property(out, "FProp", FACE_MARK, face_marks)?;
    let n_small = data.cell_count() - data.hexes.len();
    let corners = data.hexes.iter().map(|hex| i64::from(hex[0])).chain(std::iter::repeat_n(-1, n_small));
    property(out, "CProp", CORNER_MARK, corners)?;
    if let Some(tags) = &data.point_tags {
        property(out, "VProp", "tag", tags.iter().copied())?;
    }
    if has_cell_tags(data) {
        let face_tags = data.tagged_faces().map(|(_, tag)| tag).chain(std::iter::repeat_n(0, n_other));
        property(out, "FProp", "tag", face_tags)?;
        let hex_tags = (0..data.hexes.len()).map(|h| data.hex_tag(h)).chain(std::iter::repeat_n(0, n_small));
        property(out, "CProp", "tag", hex_tags)?;
    }
    write_data(out, data, n_other, n_small)
}

/// The data as properties, component by component; `n_other` faces and `n_small` cells at the end have none.
fn write_data(out: &mut dyn Write, data: &MeshData, n_other: usize, n_small: usize) -> io::Result<()> {
    for (name, values) in &data.point_data {
        reals(out, "VProp", name, values.iter().copied())?;
    }
    let none = |n| std::iter::repeat_n(f64::NAN, n);
    for (name, columns) in arrays::on_cells(data) {
        let several = columns.len() > 1;
        for (k, column) in columns.into_iter().enumerate() {
            let name = if several { component(name, k) } else { name.to_owned() };
            let (on_quads, on_hexes) = column.on();
            if on_quads {
                reals(out, "FProp", &name, column.faces().chain(none(n_other)))?;
            }
            if on_hexes {
                reals(out, "CProp", &name, column.hexes().chain(none(n_small)))?;
            }
        }
    }
    Ok(())
}

fn reals(out: &mut dyn Write, kind: &str, name: &str, values: impl Iterator<Item = f64>) -> io::Result<()> {
    writeln!(out, "{kind} double \"{}\"", unquoted(name))?;
    for value in values {
        writeln!(out, "{}", Real(value))?;
    }
    Ok(())
}

fn write_list(out: &mut dyn Write, items: &[u32]) -> io::Result<()> {
    write!(out, "{}", items.len())?;
    write_indices(out, items, 0)?;
    out.write_all(b"\n")
}

fn property(out: &mut dyn Write, kind: &str, name: &str, values: impl Iterator<Item = i64> + Clone) -> io::Result<()> {
    let wide = values.clone().any(|v| i32::try_from(v).is_err());
    writeln!(out, "{kind} {} \"{name}\"", if wide { "long" } else { "int" })?;
    for value in values {
        writeln!(out, "{value}")?;
    }
    Ok(())
}
