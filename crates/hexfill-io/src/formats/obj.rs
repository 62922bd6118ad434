//! Wavefront OBJ: points (`v`), faces (`f`) and groups (`g`). Texture and normal indices are passed over.
//!
//! Indices count from 1; negative ones count back from the last point before the line. A backslash at the end joins a line
//! with the next. Groups become tags of faces (see `names`).

use crate::assembly::{Assembly, Slot};
use crate::data::MeshData;
use crate::error::ReadError;
use crate::names::{Names, name_of};
use crate::source::{Source, parse_integer};
use crate::write::{has_cell_tags, write_indices, write_point};
use std::io::{self, Write};

pub(crate) fn read(source: Source<'_>) -> Result<MeshData, ReadError> {
    let mut s = source.with_comments(b'#');
    let mut out = Assembly::default();
    let mut names = Names::default();
    let mut group = None;
    // Group of each face (0: none, otherwise stand-in + 1).
    let mut groups: Vec<usize> = Vec::new();
    let mut slots: Vec<Slot> = Vec::new();
    // The largest index that names a point further down, and its line.
    let mut forward: Option<(i64, u64)> = None;
    let mut face = Vec::new();
    let mut lines = 0u64;
    while s.next_full_line()? {
        lines += 1;
        let keyword = s.need_word("a keyword")?;
        match s.text(keyword) {
            b"v" => {
                let mut point = [0.0; 3];
                for (slot, axis) in point.iter_mut().zip(["x", "y", "z"]) {
                    let span = word(&mut s)?.ok_or_else(|| missing(&s, &format!("coordinate {axis}")))?;
                    *slot = s.coordinate(span, axis)?;
                }
                out.mesh.points.push(point);
            }
            b"f" => {
                face.clear();
                while let Some(span) = word(&mut s)? {
                    let reference = s.text(span);
                    let end = reference.iter().position(|&b| b == b'/').unwrap_or(reference.len());
                    let span = (span.0, span.0 + end);
                    let given = s.integer(span, "a vertex index, as in `f 1 2 3 4` or `f 1/5/2 ...`")?;
                    let count = out.point_count() as i64;
                    if given > count && given <= i64::from(u32::MAX) {
                        if forward.is_none_or(|(largest, _)| given > largest) {
                            forward = Some((given, s.line_number()));
                        }
                        face.push((given - 1) as u32);
                    } else {
                        let position = if given < 0 { count + given } else { given - 1 };
                        if !(0..count).contains(&position) {
                            return Err(out_of_range(&s, given, count));
                        }
                        face.push(position as u32);
                    }
                }
                if face.len() < 3 {
                    return Err(s.malformed_text(
                        "a face with three or more vertices",
                        format!("{} of them", face.len()),
                        "remove or complete the face",
                    ));
                }
                slots.push(out.face(&face, 0));
                groups.push(group.map_or(0, |g: usize| g + 1));
            }
            b"g" => {
                // Several names on the line are one combination of groups.
                let name = String::from_utf8_lossy(s.rest()).into_owned();
                group = (!name.is_empty()).then(|| names.stand_in(&name));
            }
            b"l" | b"p" => out.ignore("line and point elements"),
            b"vt" | b"vn" | b"vp" | b"s" | b"o" | b"usemtl" | b"mtllib" => skip_continued(&mut s)?,
            _ => {
                let text = s.string(keyword);
                let looks_like_obj = text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_') && lines > 1;
                if !looks_like_obj || parse_integer(text.as_bytes()).is_some() {
                    return Err(s.malformed(
                        "an OBJ keyword such as `v` or `f`",
                        keyword,
                        "is this an OBJ file? name the format if the extension is wrong",
                    ));
                }
                out.ignore(&format!("`{text}` lines"));
                skip_continued(&mut s)?;
            }
        }
    }
    if lines == 0 {
        return Err(s.empty());
    }
    if out.point_count() == 0 {
        return Err(s.truncated("points (`v x y z`), found none"));
    }
    if let Some((given, line)) = forward {
        let highest = out.point_count() as i64;
        if given > highest {
            let at = s.place_at_line(line);
            return Err(ReadError::IndexOutOfRange { at, what: "vertex".to_owned(), given, lowest: 1, highest });
        }
    }
    let mut used = vec![false; groups.iter().max().map_or(0, |&g| g)];
    for &group in &groups {
        if group > 0 {
            used[group - 1] = true;
        }
    }
    // One nameless number for all faces says nothing.
    let (tags, notes) = names.tags(&used, "group");
    let says_nothing = notes.len() == 1 && used.iter().filter(|&&u| u).count() == 1 && !groups.contains(&0);
    if !says_nothing {
        for (&slot, &group) in slots.iter().zip(&groups) {
            if group > 0 {
                out.set_tag(slot, tags[group - 1]);
            }
        }
        notes.into_iter().for_each(|n| out.note(n));
    }
    Ok(out.finish())
}

/// The next word, across backslashes at the end of a line.
fn word(s: &mut Source<'_>) -> Result<Option<(usize, usize)>, ReadError> {
    loop {
        let Some(span) = s.word() else { return Ok(None) };
        if s.text(span) != b"\\" {
            // `4\` at the end of a line: the backslash sticks to the word.
            if s.text(span).ends_with(b"\\") && s.peek_word().is_none() {
                let word = (span.0, span.1 - 1);
                s.unread((span.1 - 1, span.1));
                return Ok(Some(word));
            }
            return Ok(Some(span));
        }
        if !s.next_line()? {
            return Ok(None);
        }
    }
}

fn skip_continued(s: &mut Source<'_>) -> Result<(), ReadError> {
    while s.line().ends_with(b"\\") && s.next_line()? {}
    Ok(())
}

fn missing(s: &Source<'_>, what: &str) -> ReadError {
    s.malformed_text(what, "the end of the line".to_owned(), "a point is `v x y z`")
}

fn out_of_range(s: &Source<'_>, given: i64, count: i64) -> ReadError {
    let (lowest, highest) = if given < 0 { (-count, -1) } else { (1, count) };
    ReadError::IndexOutOfRange { at: s.place(), what: "vertex".to_owned(), given, lowest, highest }
}

pub(crate) fn write(out: &mut dyn Write, data: &MeshData) -> io::Result<()> {
    writeln!(out, "# {} points, {} faces", data.points.len(), data.face_count())?;
    for point in &data.points {
        out.write_all(b"v ")?;
        write_point(out, point, " ")?;
        out.write_all(b"\n")?;
    }
    let mut group = None;
    for (face, tag) in data.tagged_faces() {
        if has_cell_tags(data) && group != Some(tag) {
            writeln!(out, "g {}", name_of(tag))?;
            group = Some(tag);
        }
        out.write_all(b"f")?;
        write_indices(out, face, 1)?;
        out.write_all(b"\n")?;
    }
    Ok(())
}
