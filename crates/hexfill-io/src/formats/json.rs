//! JSON as used for hex templates: `{"hexes": [[8 indices], ...], "boundary_quads": [[4 indices], ...]}`, optionally with
//! `points`, `point_tags`, `quad_tags`, `hex_tags`, `tag_names` (`[["faces", 3, "inlet"], ...]`), and `point_data`, `quad_data` and
//! `hex_data` (objects of arrays, `null` for "no value"). Without `points` a file holds connectivity alone.
//!
//! Source: ours; RFC 8259 for the text.

use crate::assembly::Assembly;
use crate::data::{MeshData, TagName, TagOn};
use crate::error::{Place, Position, ReadError};
use crate::source::Source;
use crate::write::Real;
use serde::Deserialize;
use std::io::{self, Write};

/// Arrays in the order of the file.
#[derive(Default)]
struct Data(Vec<(String, Vec<f64>)>);

impl<'de> Deserialize<'de> for Data {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Visitor;
        impl<'de> serde::de::Visitor<'de> for Visitor {
            type Value = Data;
            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("an object of arrays of numbers")
            }
            fn visit_map<A: serde::de::MapAccess<'de>>(self, mut map: A) -> Result<Data, A::Error> {
                let mut arrays = Vec::new();
                while let Some((name, values)) = map.next_entry::<String, Vec<Option<f64>>>()? {
                    arrays.push((name, values.into_iter().map(|x| x.unwrap_or(f64::NAN)).collect()));
                }
                Ok(Data(arrays))
            }
        }
        deserializer.deserialize_map(Visitor)
    }
}

#[derive(Deserialize)]
struct File {
    #[serde(default)]
    hexes: Vec<[u32; 8]>,
    /// Faces of any number of sides, although the name says quads.
    #[serde(default, alias = "quads")]
    boundary_quads: Vec<Vec<u32>>,
    points: Option<Vec<[f64; 3]>>,
    point_tags: Option<Vec<i64>>,
    quad_tags: Option<Vec<i64>>,
    hex_tags: Option<Vec<i64>>,
    #[serde(default)]
    tag_names: Vec<(String, i64, String)>,
    #[serde(default)]
    point_data: Data,
    #[serde(default)]
    quad_data: Data,
    #[serde(default)]
    hex_data: Data,
    /// Entries that are passed over.
    #[serde(flatten)]
    rest: std::collections::BTreeMap<String, serde::de::IgnoredAny>,
}

pub(crate) fn read(mut source: Source<'_>) -> Result<MeshData, ReadError> {
    let file = parse(&mut source)?;
    if file.hexes.is_empty() && file.boundary_quads.is_empty() {
        let expected = "`hexes` or `boundary_quads`".to_owned();
        return Err(malformed(&source, expected, "neither".to_owned(), "is this a mesh?"));
    }
    let n_points = check_indices(&source, &file)?;
    check_lengths(&source, &file, n_points)?;
    assemble(&source, file)
}

/// The place of a line of the object, which begins after `skipped` blank lines; line 0 is the file as a whole.
fn place(source: &Source<'_>, line: usize, skipped: u64) -> Box<Place> {
    let position = if line == 0 { Position::Whole } else { Position::Line(line as u64 + skipped) };
    Box::new(Place { file: source.file().to_owned(), format: source.format(), position })
}

/// What is wrong with the object as a whole: the parser keeps no lines of its parts.
fn malformed(source: &Source<'_>, expected: String, given: String, remedy: &str) -> ReadError {
    ReadError::Malformed { at: place(source, 0, 0), expected, given, remedy: remedy.to_owned() }
}

fn parse(source: &mut Source<'_>) -> Result<File, ReadError> {
    let skipped = source.skip_blank()?.ok_or_else(|| source.empty())?;
    let error = match serde_json::from_reader(source.reader()) {
        Ok(file) => return Ok(file),
        Err(e) if e.is_io() => return Err(source.io_error(e.into())),
        Err(e) => e,
    };
    let at = place(source, error.line(), skipped);
    if error.is_eof() {
        return Err(ReadError::Truncated { at, expected: "the end of the object".to_owned() });
    }
    let mut given = error.to_string();
    if let Some(cut) = given.rfind(" at line ") {
        given.truncate(cut);
    }
    let expected = "an object with `hexes`, `boundary_quads` and perhaps `points`".to_owned();
    Err(ReadError::Malformed { at, expected, given, remedy: "correct this place".to_owned() })
}

/// Checks that every index names a point; the number of points.
fn check_indices(source: &Source<'_>, file: &File) -> Result<usize, ReadError> {
    let n_indices = 8 * file.hexes.len() + file.boundary_quads.iter().map(Vec::len).sum::<usize>();
    let indices = file.hexes.iter().flatten().chain(file.boundary_quads.iter().flatten()).copied();
    let largest = indices.max().unwrap_or(0);
    let n_points = file.points.as_ref().map_or_else(|| largest as usize + 1, Vec::len);
    if largest as usize >= n_points {
        let (at, what) = (place(source, 0, 0), "point".to_owned());
        let highest = n_points as i64 - 1;
        return Err(ReadError::IndexOutOfRange { at, what, given: i64::from(largest), lowest: 0, highest });
    }
    if file.points.is_none() && largest as usize >= n_indices {
        // Every vertex that exists is used somewhere; this also keeps a small file from claiming a huge mesh.
        let expected = format!("indices without large gaps (the file lists {n_indices})");
        let given = format!("index {largest}");
        return Err(malformed(source, expected, given, "renumber the vertices from 0, or give `points`"));
    }
    if let Some(i) = file.boundary_quads.iter().position(|q| q.len() < 3) {
        let expected = "faces with three or more vertices".to_owned();
        return Err(malformed(source, expected, format!("face {i}"), "complete the face"));
    }
    Ok(n_points)
}

/// Checks that tags and data have one value for each point, face or hex.
fn check_lengths(source: &Source<'_>, file: &File, n_points: usize) -> Result<(), ReadError> {
    for (name, tags, due) in [
        ("point_tags", &file.point_tags, n_points),
        ("quad_tags", &file.quad_tags, file.boundary_quads.len()),
        ("hex_tags", &file.hex_tags, file.hexes.len()),
    ] {
        if let Some(tags) = tags.as_ref().filter(|t| t.len() != due) {
            return Err(malformed(source, format!("{due} `{name}`"), format!("{}", tags.len()), "give one each"));
        }
    }
    // Data are on quads proper, tags on faces of any number of sides.
    let n_quads = file.boundary_quads.iter().filter(|q| q.len() == 4).count();
    for (name, arrays, due) in [
        ("point_data", &file.point_data, n_points),
        ("quad_data", &file.quad_data, n_quads),
        ("hex_data", &file.hex_data, file.hexes.len()),
    ] {
        if let Some((array, values)) = arrays.0.iter().find(|(_, v)| v.len() != due) {
            let expected = format!("{due} values of `{array}` in `{name}`");
            return Err(malformed(source, expected, format!("{}", values.len()), "give one each"));
        }
    }
    Ok(())
}

/// The mesh of a file whose indices and lengths are checked.
fn assemble(source: &Source<'_>, file: File) -> Result<MeshData, ReadError> {
    let mut names = Vec::new();
    for (on, tag, name) in file.tag_names {
        let Some(&(_, on)) = ON.iter().find(|(word, _)| *word == on) else {
            let expected = "`points`, `faces` or `cells` in `tag_names`".to_owned();
            return Err(malformed(source, expected, on, "correct it"));
        };
        names.push(TagName { on, tag, name });
    }
    let mut out = Assembly::default();
    out.name_tags(names.into_iter());
    for key in file.rest.keys() {
        out.ignore(&format!("`{key}` entries"));
    }
    for (i, face) in file.boundary_quads.iter().enumerate() {
        out.face(face, file.quad_tags.as_ref().map_or(0, |t| t[i]));
    }
    for (i, &hex) in file.hexes.iter().enumerate() {
        out.hex(hex, file.hex_tags.as_ref().map_or(0, |t| t[i]));
    }
    let has_coordinates = file.points.is_some();
    out.mesh.points = file.points.unwrap_or_default();
    let mut mesh = out.finish();
    mesh.has_coordinates = has_coordinates;
    (mesh.point_data, mesh.quad_data, mesh.hex_data) = (file.point_data.0, file.quad_data.0, file.hex_data.0);
    mesh.point_tags = file.point_tags.filter(|tags| tags.iter().any(|&t| t != 0));
    Ok(mesh)
}

pub(crate) fn write(out: &mut dyn Write, data: &MeshData) -> io::Result<()> {
    out.write_all(b"{")?;
    let mut separator = "\n";
    if data.has_coordinates {
        write!(out, "{separator}\"points\": ")?;
        rows(out, data.points.iter().map(|p| p.iter().map(|&x| Real(x))))?;
        separator = ",\n";
    }
    write!(out, "{separator}\"hexes\": ")?;
    rows(out, data.hexes.iter().map(|h| h.iter()))?;
    out.write_all(b",\n\"boundary_quads\": ")?;
    rows(out, data.faces().map(|f| f.iter()))?;
    let face_tags: Vec<i64> = data.tagged_faces().map(|(_, tag)| tag).collect();
    let quad_tags = face_tags.iter().any(|&t| t != 0).then_some(&face_tags);
    for (name, tags) in
        [("point_tags", data.point_tags.as_ref()), ("quad_tags", quad_tags), ("hex_tags", data.hex_tags.as_ref())]
    {
        if let Some(tags) = tags {
            write!(out, ",\n\"{name}\": ")?;
            row(out, tags.iter())?;
        }
    }
    write_names(out, data)?;
    for (name, arrays) in
        [("point_data", &data.point_data), ("quad_data", &data.quad_data), ("hex_data", &data.hex_data)]
    {
        if arrays.is_empty() {
            continue;
        }
        write!(out, ",\n\"{name}\": ")?;
        let mut separator = "{\n";
        for (name, values) in arrays {
            write!(out, "{separator}{}: ", text(name))?;
            row(out, values.iter().map(|&x| if x.is_finite() { Real(x).to_string() } else { "null".to_owned() }))?;
            separator = ",\n";
        }
        out.write_all(b"\n}")?;
    }
    out.write_all(b"\n}\n")
}

/// The words for what a tag is on.
const ON: [(&str, TagOn); 3] = [("points", TagOn::Points), ("faces", TagOn::Faces), ("cells", TagOn::Cells)];

fn write_names(out: &mut dyn Write, data: &MeshData) -> io::Result<()> {
    if data.tag_names.is_empty() {
        return Ok(());
    }
    let word = |on| ON.iter().find(|(_, o)| *o == on).map_or("", |(word, _)| word);
    out.write_all(b",\n\"tag_names\": ")?;
    rows(out, data.tag_names.iter().map(|n| [text(word(n.on)), n.tag.to_string(), text(&n.name)].into_iter()))
}

/// A JSON string.
fn text(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

fn rows<T: std::fmt::Display>(
    out: &mut dyn Write,
    rows: impl Iterator<Item = impl Iterator<Item = T>>,
) -> io::Result<()> {
    let mut separator = "[\n";
    for items in rows {
        out.write_all(separator.as_bytes())?;
        row(out, items)?;
        separator = ",\n";
    }
    out.write_all(if separator == "[\n" { b"[]" } else { b"\n]" })
}

fn row<T: std::fmt::Display>(out: &mut dyn Write, items: impl Iterator<Item = T>) -> io::Result<()> {
    out.write_all(b"[")?;
    for (i, item) in items.enumerate() {
        if i > 0 {
            out.write_all(b", ")?;
        }
        write!(out, "{item}")?;
    }
    out.write_all(b"]")
}
