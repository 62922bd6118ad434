//! Wavefront OBJ: points (`v`), faces (`f`), groups (`g`), objects (`o`) and materials (`usemtl`). Texture and normal indices are
//! passed over.
//!
//! Indices count from 1; negative ones count back from the last point before the line. A backslash at the end joins a line
//! with the next. Groups, objects and materials become tags of faces (see `groups`); all are written as groups.
//!
//! Source: the Wavefront format.

use crate::assembly::{Assembly, Slot};
use crate::data::{MeshData, TagOn};
use crate::error::ReadError;
use crate::groups::{Combination, Groups, NONE, name_of};
use crate::source::{Source, Span, parse_integer};
use crate::write::{has_cell_tags, write_indices, write_point};
use std::io::{self, Write};

/// What the lines up to here have said.
#[derive(Default)]
struct Reading {
    out: Assembly,
    groups: Groups,
    /// The groups, the object and the material that faces are in now, at [`GROUPS`], [`OBJECT`] and [`MATERIAL`].
    now: [Vec<u32>; 3],
    /// What `now` makes together.
    combination: Combination,
    /// Per face: the combination it is in, and where it went.
    combinations: Vec<Combination>,
    slots: Vec<Slot>,
    /// The largest index that names a point further down, and its line.
    forward: Option<(i64, u64)>,
    /// The face of the line; kept for its memory.
    face: Vec<u32>,
}

const GROUPS: usize = 0;
const OBJECT: usize = 1;
const MATERIAL: usize = 2;

pub(crate) fn read(source: Source<'_>) -> Result<MeshData, ReadError> {
    let mut s = source.with_comments(b'#');
    let mut reading = Reading { combination: NONE, ..Reading::default() };
    let mut lines = 0u64;
    while s.next_full_line()? {
        lines += 1;
        let keyword = s.need_word("a keyword")?;
        match s.text(keyword) {
            b"v" => reading.point(&mut s)?,
            b"f" => reading.face(&mut s)?,
            b"g" => reading.enter(&s, GROUPS),
            b"o" => reading.enter(&s, OBJECT),
            b"usemtl" => reading.enter(&s, MATERIAL),
            b"l" | b"p" => reading.out.ignore("line and point elements"),
            b"vt" | b"vn" | b"vp" | b"s" | b"mtllib" => skip_continued(&mut s)?,
            _ => reading.other(&mut s, keyword, lines == 1)?,
        }
    }
    if lines == 0 {
        return Err(s.empty());
    }
    reading.finish(&s)
}

impl Reading {
    fn point(&mut self, s: &mut Source<'_>) -> Result<(), ReadError> {
        let mut point = [0.0; 3];
        for (slot, axis) in point.iter_mut().zip(["x", "y", "z"]) {
            let span = word(s)?.ok_or_else(|| missing(s, &format!("coordinate {axis}")))?;
            *slot = s.coordinate(span, axis)?;
        }
        self.out.mesh.points.push(point);
        Ok(())
    }

    fn face(&mut self, s: &mut Source<'_>) -> Result<(), ReadError> {
        self.face.clear();
        while let Some(span) = word(s)? {
            let corner = self.corner(s, span)?;
            self.face.push(corner);
        }
        if self.face.len() < 3 {
            return Err(s.malformed_text(
                "a face with three or more vertices",
                format!("{} of them", self.face.len()),
                "remove or complete the face",
            ));
        }
        self.slots.push(self.out.face(&self.face, 0));
        self.combinations.push(self.combination);
        Ok(())
    }

    /// The point that a reference `v`, `v/vt`, `v//vn` or `v/vt/vn` names.
    fn corner(&mut self, s: &Source<'_>, span: Span) -> Result<u32, ReadError> {
        let reference = s.text(span);
        let end = reference.iter().position(|&b| b == b'/').unwrap_or(reference.len());
        let given = s.integer((span.0, span.0 + end), "a vertex index, as in `f 1 2 3 4` or `f 1/5/2 ...`")?;
        let count = self.out.point_count() as i64;
        if given > count && given <= i64::from(u32::MAX) {
            // The point may follow: whether it does is seen at the end of the file.
            if self.forward.is_none_or(|(largest, _)| given > largest) {
                self.forward = Some((given, s.line_number()));
            }
            return Ok((given - 1) as u32);
        }
        let position = if given < 0 { count + given } else { given - 1 };
        if !(0..count).contains(&position) {
            return Err(out_of_range(s, given, count));
        }
        Ok(position as u32)
    }

    /// The rest of the line names the groups, the object or the material of the faces that follow.
    fn enter(&mut self, s: &Source<'_>, place: usize) {
        let rest = String::from_utf8_lossy(s.rest());
        // Several names of a `g` are several groups; objects and materials have one, blanks and all.
        let names = if place == GROUPS { rest.split_whitespace().collect() } else { vec![rest.as_ref()] };
        // `default` is the name of what is in no group, `None` that of no material.
        let nothing = ["", "default", "None", "(null)", "off"];
        let (now, groups) = (&mut self.now, &mut self.groups);
        now[place] = names.into_iter().filter(|n| !nothing.contains(n)).map(|n| groups.named(n)).collect();
        self.combination = now.iter().flatten().fold(NONE, |c, &group| groups.join(c, group));
    }

    /// A keyword that is none of ours: passed over, unless the file looks like no OBJ at all.
    fn other(&mut self, s: &mut Source<'_>, keyword: Span, is_first: bool) -> Result<(), ReadError> {
        let text = s.string(keyword);
        let looks_like_obj = text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_') && !is_first;
        if !looks_like_obj || parse_integer(text.as_bytes()).is_some() {
            return Err(s.malformed(
                "an OBJ keyword such as `v` or `f`",
                keyword,
                "is this an OBJ file? name the format if the extension is wrong",
            ));
        }
        self.out.ignore(&format!("`{text}` lines"));
        skip_continued(s)
    }

    fn finish(mut self, s: &Source<'_>) -> Result<MeshData, ReadError> {
        if self.out.point_count() == 0 {
            return Err(s.truncated("points (`v x y z`), found none"));
        }
        let highest = self.out.point_count() as i64;
        if let Some((given, line)) = self.forward.filter(|&(given, _)| given > highest) {
            let at = s.place_at_line(line);
            return Err(ReadError::IndexOutOfRange { at, what: "vertex".to_owned(), given, lowest: 1, highest });
        }
        self.out.tag_by_groups(&self.slots, &self.combinations, &self.groups);
        Ok(self.out.finish())
    }
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
    let names = data.names_by_tag();
    let mut group = None;
    for (face, tag) in data.tagged_faces() {
        if has_cell_tags(data) && group != Some(tag) {
            let names = names.get(&(TagOn::Faces, tag)).into_iter().flatten();
            let words: Vec<String> =
                names.map(|n| n.replace(|c: char| c.is_whitespace() || c.is_control(), "_")).collect();
            writeln!(out, "g {}", if words.is_empty() { name_of(tag) } else { words.join(" ") })?;
            group = Some(tag);
        }
        out.write_all(b"f")?;
        write_indices(out, face, 1)?;
        out.write_all(b"\n")?;
    }
    Ok(())
}
