//! Writing Abaqus and CalculiX input.
//!
//! Source: the Abaqus keywords guide; the CalculiX manual.

use super::BOUNDARY;
use crate::data::{MeshData, TagOn};
use crate::groups::name_of;
use crate::numbers::NodeNumbers;
use crate::orders::ABAQUS_FACES;
use crate::quadratic::{written_faces, written_hexes};
use crate::write::write_point;
use rustc_hash::FxHashMap;
use std::collections::BTreeMap;
use std::io::{self, Write};

/// The largest number of a node.
pub(crate) const MOST: u64 = 999_999_999;

pub(crate) fn write(out: &mut dyn Write, data: &MeshData) -> io::Result<()> {
    writeln!(out, "*HEADING\nhexfill: {} hexes, {} faces", data.hexes.len(), data.face_count())?;
    writeln!(out, "*NODE")?;
    let numbers = NodeNumbers::new(data, MOST);
    for (i, point) in data.points.iter().enumerate() {
        write!(out, "{}, ", numbers.of(i))?;
        write_point(out, point, ", ")?;
        out.write_all(b"\n")?;
    }
    let sides = sides_of_hexes(data);
    let shells: Vec<(&[u32], i64)> = data
        .numbered_faces()
        .zip(written_faces(data))
        .filter(|((quad, ..), _)| quad.is_none_or(|q| sides[q].is_none()))
        .map(|(_, face)| face)
        .collect();
    write_elements(out, data, &shells, &numbers)?;
    // Each set once: meshio forgets all but the last part of a set that is spread over several blocks.
    let names = SetNames::new(data);
    let first_hex = shells.len() + 1;
    let mut sets = Sets::new();
    for (i, &(_, tag)) in shells.iter().enumerate() {
        names.add(&mut sets, TagOn::Faces, tag, i + 1);
    }
    for h in 0..data.hexes.len() {
        names.add(&mut sets, TagOn::Cells, data.hex_tag(h), first_hex + h);
    }
    write_sets(out, "ELSET", &sets)?;
    let mut sets = Sets::new();
    for (i, &tag) in data.point_tags.iter().flatten().enumerate() {
        names.add(&mut sets, TagOn::Points, tag, numbers.of(i) as usize);
    }
    write_sets(out, "NSET", &sets)?;
    write_surfaces(out, data, &sides, &names, first_hex)
}

/// Shells, hexes and other cells, numbered from 1 in this order.
fn write_elements(
    out: &mut dyn Write,
    data: &MeshData,
    shells: &[(&[u32], i64)],
    numbers: &NodeNumbers,
) -> io::Result<()> {
    let shells = shells.iter().map(|(face, _)| {
        let element_type = match face.len() {
            3 => "S3",
            8 => "S8R",
            _ => "S4",
        };
        (element_type, *face)
    });
    let hexes = written_hexes(data).map(|(hex, _)| (if hex.len() == 20 { "C3D20" } else { "C3D8" }, hex));
    let tets = data.tets.iter().map(|c| ("C3D4", c.as_slice()));
    let wedges = data.wedges.iter().map(|c| ("C3D6", c.as_slice()));
    let pyramids = data.pyramids.iter().map(|c| ("C3D5", c.as_slice()));
    let mut block = None;
    for (i, (element_type, nodes)) in shells.chain(hexes).chain(tets).chain(wedges).chain(pyramids).enumerate() {
        if block != Some(element_type) {
            block = Some(element_type);
            writeln!(out, "*ELEMENT, TYPE={element_type}")?;
        }
        write!(out, "{}", i + 1)?;
        for (k, &node) in nodes.iter().enumerate() {
            // At most 16 numbers a line.
            let separator = if k == 15 { ",\n" } else { ", " };
            write!(out, "{separator}{}", numbers.of(node as usize))?;
        }
        out.write_all(b"\n")?;
    }
    Ok(())
}

/// Per quad: the first hex it is a face of, and the number of that face from 0.
fn sides_of_hexes(data: &MeshData) -> Vec<Option<(usize, usize)>> {
    let key = |mut quad: [u32; 4]| {
        quad.sort_unstable();
        quad
    };
    let mut sides: FxHashMap<[u32; 4], Option<(usize, usize)>> =
        data.quads.iter().filter(|_| !data.hexes.is_empty()).map(|&quad| (key(quad), None)).collect();
    for (h, hex) in data.hexes.iter().enumerate() {
        for (k, face) in ABAQUS_FACES.iter().enumerate() {
            if let Some(side) = sides.get_mut(&key(face.map(|i| hex[i]))) {
                side.get_or_insert((h, k));
            }
        }
    }
    // A quad listed twice is a face of a hex once.
    data.quads.iter().map(|&quad| sides.get_mut(&key(quad)).and_then(Option::take)).collect()
}

/// Members (counted from 1) by the name of the set.
type Sets = BTreeMap<String, Vec<usize>>;

/// The names of the sets that stand for tags.
struct SetNames<'a>(BTreeMap<(TagOn, i64), Vec<&'a str>>);

impl<'a> SetNames<'a> {
    fn new(data: &'a MeshData) -> Self {
        Self(data.names_by_tag())
    }

    /// The names of a tag, fit for a keyword line; none for 0.
    fn of(&self, on: TagOn, tag: i64) -> Vec<String> {
        let unfit = |c: char| c == ',' || c == '=' || c == '*' || c == '"' || c.is_control() || c.is_whitespace();
        match self.0.get(&(on, tag)) {
            _ if tag == 0 => Vec::new(),
            Some(names) => names.iter().map(|n| n.replace(unfit, "_")).collect(),
            None => vec![name_of(tag).to_ascii_uppercase()],
        }
    }

    fn add(&self, sets: &mut Sets, on: TagOn, tag: i64, member: usize) {
        for name in self.of(on, tag) {
            sets.entry(name).or_default().push(member);
        }
    }
}

fn write_sets(out: &mut dyn Write, keyword: &str, sets: &Sets) -> io::Result<()> {
    for (name, members) in sets {
        writeln!(out, "*{keyword}, {keyword}={name}")?;
        for line in members.chunks(8) {
            let numbers: Vec<String> = line.iter().map(usize::to_string).collect();
            writeln!(out, "{}", numbers.join(", "))?;
        }
    }
    Ok(())
}

/// The surface of all quads on hexes, then one for each name of a tag.
fn write_surfaces(
    out: &mut dyn Write,
    data: &MeshData,
    sides: &[Option<(usize, usize)>],
    names: &SetNames<'_>,
    first_hex: usize,
) -> io::Result<()> {
    let mut surfaces: BTreeMap<String, Vec<(usize, usize)>> = BTreeMap::new();
    for (q, &side) in sides.iter().enumerate().filter(|(_, side)| side.is_some()) {
        for name in names.of(TagOn::Faces, data.quad_tag(q)) {
            surfaces.entry(name).or_default().extend(side);
        }
    }
    let all: Vec<(usize, usize)> = sides.iter().flatten().copied().collect();
    let boundary = (!all.is_empty()).then(|| (BOUNDARY.to_owned(), all));
    for (name, sides) in boundary.into_iter().chain(surfaces) {
        writeln!(out, "*SURFACE, TYPE=ELEMENT, NAME={name}")?;
        for (hex, side) in sides {
            writeln!(out, "{}, S{}", first_hex + hex, side + 1)?;
        }
    }
    Ok(())
}
