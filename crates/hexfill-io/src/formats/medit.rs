//! MEDIT `.mesh` (ASCII): sections of a keyword, a count and that many lines, each line ending in a reference number (the tag).
//!
//! Written are quads first, then triangles: their order among each other is not kept.
//! Names of tags are kept in comments.
//! Sections that are not about points, faces and cells (corners, ridges, normals ...) are passed over. `End` closes the file.
//!
//! Source: Frey 2001.

use crate::assembly::Assembly;
use crate::data::MeshData;
use crate::error::ReadError;
use crate::source::{Source, reserve};
use crate::write::{write_indices, write_point};
use std::io::{self, Write};

/// Keyword and number of nodes of the sections that are kept.
const CELLS: [(&str, usize); 9] = [
    ("Triangles", 3),
    ("Quadrilaterals", 4),
    ("Quads", 4),
    ("Tetrahedra", 4),
    ("Hexahedra", 8),
    ("Hexaedra", 8),
    ("Prisms", 6),
    ("Wedges", 6),
    ("Pyramids", 5),
];

pub(crate) fn read(source: Source<'_>) -> Result<MeshData, ReadError> {
    let mut s = source.with_comments(b'#');
    let mut out = Assembly::default();
    read_version(&mut s, &mut out)?;
    let mut is_flat = false;
    let mut seen: Vec<String> = Vec::new();
    let mut ended = false;
    while let Some(span) = s.word_anywhere()? {
        let keyword = s.string(span);
        if !keyword.starts_with(|c: char| c.is_ascii_alphabetic()) {
            let remedy = "correct the count of the section before";
            return Err(s.malformed("a keyword of MEDIT", span, remedy));
        }
        if keyword == "End" {
            ended = true;
            break;
        }
        let cells = CELLS.iter().find(|(name, _)| *name == keyword);
        let kept = cells.is_some() || keyword == "Vertices" || keyword == "Dimension";
        if kept && seen.contains(&keyword) {
            return Err(s.malformed("each section once", span, "remove the repeated section"));
        }
        if keyword == "Dimension" {
            is_flat = read_dimension(&mut s, &mut out)?;
        } else if keyword == "Vertices" {
            read_points(&mut s, is_flat, &mut out)?;
        } else if let Some(&(_, n_nodes)) = cells {
            if !seen.iter().any(|k| k == "Vertices") {
                return Err(s.unsupported(format!("{keyword} before Vertices"), "put the points first"));
            }
            read_cells(&mut s, &keyword, n_nodes, &mut out)?;
        } else {
            skip_section(&mut s)?;
            out.ignore(&format!("`{keyword}` sections"));
        }
        seen.push(keyword);
    }
    if !seen.iter().any(|k| k == "Vertices") {
        return Err(s.truncated("a section Vertices"));
    }
    if !ended {
        out.note("the file has no `End`: it may be cut off between two sections");
    }
    out.name_tags(s.take_tag_names().into_iter());
    Ok(out.finish())
}

/// The first line, `MeshVersionFormatted` and the version.
fn read_version(s: &mut Source<'_>, out: &mut Assembly) -> Result<(), ReadError> {
    let Some(first) = s.word_anywhere()? else { return Err(s.empty()) };
    if s.text(first) == b"MFEM" {
        return Err(s.unsupported("an MFEM mesh", "save it as Gmsh 2.2 or VTK"));
    }
    if s.text(first) != b"MeshVersionFormatted" {
        let remedy =
            "is this a MEDIT file? (binary .meshb: convert it to ASCII); name the format if the extension is wrong";
        return Err(s.malformed("`MeshVersionFormatted`", first, remedy));
    }
    let span = s.need_word_anywhere("a version")?;
    let version = s.integer(span, "the version")?;
    if !(0..=4).contains(&version) {
        return Err(s.malformed("a version from 1 to 4", span, "is this a MEDIT file?"));
    }
    if version == 1 {
        out.note("MEDIT version 1: the coordinates may have been written with 32 bits");
    }
    Ok(())
}

/// The dimension; whether points have no z.
fn read_dimension(s: &mut Source<'_>, out: &mut Assembly) -> Result<bool, ReadError> {
    let span = s.need_word_anywhere("the dimension")?;
    match s.integer(span, "the dimension")? {
        2 => {
            out.note("dimension 2: z is set to 0");
            Ok(true)
        }
        3 => Ok(false),
        _ => Err(s.malformed("dimension 2 or 3", span, "export a mesh in space")),
    }
}

/// A section of faces or cells: their nodes (from 1) and reference numbers.
fn read_cells(s: &mut Source<'_>, keyword: &str, n_nodes: usize, out: &mut Assembly) -> Result<(), ReadError> {
    let span = s.need_word_anywhere(&format!("the number of {keyword}"))?;
    let n = s.count(span, keyword)?;
    let mut nodes = Vec::with_capacity(n_nodes);
    for i in 0..n {
        let missing = || format!("{n} {keyword}, found {i}");
        nodes.clear();
        for _ in 0..n_nodes {
            let span = s.need_word_anywhere_or(missing)?;
            nodes.push(s.index(span, 1, out.mesh.points.len(), "vertex")?);
        }
        let span = s.need_word_anywhere_or(missing)?;
        let tag = s.integer(span, "a reference number")?;
        // Tetrahedra have as many nodes as quads: the keyword tells them apart.
        match (keyword, <[u32; 8]>::try_from(nodes.as_slice())) {
            (_, Ok(hex)) => {
                out.hex(hex, tag);
            }
            ("Triangles" | "Quadrilaterals" | "Quads", _) => {
                out.face(&nodes, tag);
            }
            _ => {
                out.small_cell(&nodes, tag);
            }
        }
    }
    Ok(())
}

fn read_points(s: &mut Source<'_>, flat: bool, out: &mut Assembly) -> Result<(), ReadError> {
    let span = s.need_word_anywhere("the number of Vertices")?;
    let n = s.count(span, "points")?;
    out.mesh.points.reserve(reserve(n));
    out.point_tags.reserve(reserve(n));
    for i in 0..n {
        let missing = || format!("{n} points, found {i}");
        let mut point = [0.0; 3];
        for (slot, axis) in point.iter_mut().zip(["x", "y", "z"]).take(if flat { 2 } else { 3 }) {
            let span = s.need_word_anywhere_or(missing)?;
            *slot = s.coordinate(span, axis)?;
        }
        out.mesh.points.push(point);
        let span = s.need_word_anywhere_or(missing)?;
        out.point_tags.push(s.integer(span, "a reference number")?);
    }
    Ok(())
}

/// Skips to the next word that begins with a letter and is no number.
fn skip_section(s: &mut Source<'_>) -> Result<(), ReadError> {
    while let Some(span) = s.word_anywhere()? {
        let text = s.text(span);
        if text[0].is_ascii_alphabetic() && crate::source::parse_number(text).is_none() {
            s.unread(span);
            break;
        }
    }
    Ok(())
}

pub(crate) fn write(out: &mut dyn Write, data: &MeshData) -> io::Result<()> {
    writeln!(out, "MeshVersionFormatted 2")?;
    for name in &data.tag_names {
        writeln!(out, "#{}", name.line())?;
    }
    writeln!(out, "Dimension 3\nVertices\n{}", data.points.len())?;
    for (i, point) in data.points.iter().enumerate() {
        write_point(out, point, " ")?;
        writeln!(out, " {}", data.point_tags.as_ref().map_or(0, |tags| tags[i]))?;
    }
    let n_quads = data.quads.len();
    let quads = data.quads.iter().enumerate().map(|(q, quad)| (quad.as_slice(), data.quad_tag(q)));
    section(out, "Quadrilaterals", n_quads, quads)?;
    let triangles = data.other_faces.iter().map(|f| (f.vertices.as_slice(), f.tag));
    section(out, "Triangles", data.other_faces.len(), triangles)?;
    let hexes = data.hexes.iter().enumerate().map(|(h, hex)| (hex.as_slice(), data.hex_tag(h)));
    section(out, "Hexahedra", data.hexes.len(), hexes)?;
    section(out, "Tetrahedra", data.tets.len(), data.tets.iter().map(|c| (c.as_slice(), 0)))?;
    section(out, "Prisms", data.wedges.len(), data.wedges.iter().map(|c| (c.as_slice(), 0)))?;
    section(out, "Pyramids", data.pyramids.len(), data.pyramids.iter().map(|c| (c.as_slice(), 0)))?;
    writeln!(out, "End")
}

fn section<'a>(
    out: &mut dyn Write,
    keyword: &str,
    n: usize,
    cells: impl Iterator<Item = (&'a [u32], i64)>,
) -> io::Result<()> {
    if n == 0 {
        return Ok(());
    }
    writeln!(out, "{keyword}\n{n}")?;
    for (nodes, tag) in cells {
        write_indices(out, nodes, 1)?;
        writeln!(out, " {tag}")?;
    }
    Ok(())
}
