//! Wavefront OBJ: points (`v`), faces (`f`), groups (`g`), objects (`o`) and materials (`usemtl`). Texture and normal indices are
//! passed over.
//!
//! Indices count from 1; negative ones count back from the last point before the line. A backslash at the end joins a line
//! with the next. Groups, objects and materials become tags of faces (see `groups`); all are written as groups.

use crate::assembly::{Assembly, Slot};
use crate::data::{MeshData, TagOn};
use crate::error::ReadError;
use crate::groups::{Combination, Groups, NONE, name_of};
use crate::source::{Source, parse_integer};
use crate::write::{has_cell_tags, write_indices, write_point};
use std::io::{self, Write};

pub(crate) fn read(source: Source<'_>) -> Result<MeshData, ReadError> {
    let mut s = source.with_comments(b'#');
    let mut out = Assembly::default();
    let mut groups = Groups::default();
    // The groups, the object and the material that faces are in now, and their combination.
    let mut now: [Vec<u32>; 3] = Default::default();
    let mut combination = NONE;
    let mut combinations: Vec<Combination> = Vec::new();
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
                combinations.push(combination);
            }
            // Several names of a `g` are several groups; objects and materials have one, blanks and all.
            kind @ (b"g" | b"o" | b"usemtl") => {
                let place = [b"g" as &[u8], b"o", b"usemtl"].iter().position(|k| *k == kind).unwrap_or(0);
                let rest = String::from_utf8_lossy(s.rest()).into_owned();
                let names = if place == 0 { rest.split_whitespace().collect() } else { vec![rest.as_str()] };
                // `default` is the name of what is in no group, `None` that of no material.
                let nothing = ["", "default", "None", "(null)", "off"];
                now[place] = names.into_iter().filter(|n| !nothing.contains(n)).map(|n| groups.named(n)).collect();
                combination = now.iter().flatten().fold(NONE, |c, &group| groups.join(c, group));
            }
            b"l" | b"p" => out.ignore("line and point elements"),
            b"vt" | b"vn" | b"vp" | b"s" | b"mtllib" => skip_continued(&mut s)?,
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
    out.tag_by_groups(&slots, &combinations, &groups);
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
            let names = data.tag_names.iter().filter(|n| n.on == TagOn::Faces && n.tag == tag);
            let words: Vec<String> =
                names.map(|n| n.name.replace(|c: char| c.is_whitespace() || c.is_control(), "_")).collect();
            writeln!(out, "g {}", if words.is_empty() { name_of(tag) } else { words.join(" ") })?;
            group = Some(tag);
        }
        out.write_all(b"f")?;
        write_indices(out, face, 1)?;
        out.write_all(b"\n")?;
    }
    Ok(())
}
