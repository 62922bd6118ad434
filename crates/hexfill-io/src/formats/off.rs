//! OFF of Geomview, ASCII: header, counts, one point a line, one face a line.
//!
//! Prefixes with texture, colour and normal (`STCNOFF`) are read, what they add to the points is passed over, as are the
//! colours after a face. Comments begin with `#`.
//!
//! Source: the Geomview manual, "OFF Files".

use crate::assembly::Assembly;
use crate::data::MeshData;
use crate::error::ReadError;
use crate::source::{Source, parse_number, reserve};
use crate::write::{write_indices, write_point};
use std::io::{self, Write};

pub(crate) fn read(source: Source<'_>) -> Result<MeshData, ReadError> {
    let mut s = source.with_comments(b'#');
    let mut out = Assembly::default();
    if !s.next_full_line()? {
        return Err(s.empty());
    }
    let header = s.need_word("`OFF`")?;
    let text = s.string(header);
    if parse_number(text.as_bytes()).is_some() {
        // The header line is optional.
        s.unread(header);
    } else {
        let Some(prefix) = text.strip_suffix("OFF") else {
            return Err(s.malformed("`OFF`", header, "is this an OFF file? name the format if the extension is wrong"));
        };
        if prefix.contains(['4', 'n']) {
            return Err(s.unsupported(format!("`{text}` (points in other dimensions than 3)"), "export 3D points"));
        }
        if !prefix.chars().all(|c| "STCN".contains(c)) {
            return Err(s.malformed("`OFF`", header, "is this an OFF file?"));
        }
        if s.rest().starts_with(b"BINARY") {
            return Err(s.unsupported("binary OFF", "export it as ASCII OFF, PLY or OBJ"));
        }
        if s.peek_word().is_none() && !s.next_full_line()? {
            return Err(s.truncated("the number of points and faces"));
        }
    }
    let span = s.need_word("the number of points")?;
    let n_points = s.count(span, "points")?;
    let span = s.need_word("the number of faces")?;
    let n_faces = s.count(span, "faces")?;
    out.mesh.points.reserve(reserve(n_points));
    for i in 0..n_points {
        if !s.next_full_line()? {
            return Err(s.truncated(format!("{n_points} points, found {i}")));
        }
        out.mesh.points.push(s.point_on_line()?);
    }
    let mut face = Vec::new();
    out.mesh.quads.reserve(reserve(n_faces));
    for i in 0..n_faces {
        if !s.next_full_line()? {
            return Err(s.truncated(format!("{n_faces} faces, found {i}")));
        }
        let span = s.need_word("the number of sides")?;
        let sides = s.count(span, "sides")?;
        if sides < 3 {
            return Err(s.malformed("a face with three or more sides", span, "remove or complete the face"));
        }
        face.clear();
        for k in 0..sides {
            let span = s.need_word_or(|| format!("{sides} vertex indices, found {k}"))?;
            face.push(s.index(span, 0, out.mesh.points.len(), "vertex")?);
        }
        out.face(&face, 0);
    }
    if s.next_full_line()? {
        let line = s.line_number();
        out.note(format!("what follows the last face, from line {line} on, is ignored"));
    }
    Ok(out.finish())
}

pub(crate) fn write(out: &mut dyn Write, data: &MeshData) -> io::Result<()> {
    writeln!(out, "OFF\n{} {} 0", data.points.len(), data.face_count())?;
    for point in &data.points {
        write_point(out, point, " ")?;
        out.write_all(b"\n")?;
    }
    for face in data.faces() {
        write!(out, "{}", face.len())?;
        write_indices(out, face, 0)?;
        out.write_all(b"\n")?;
    }
    Ok(())
}
