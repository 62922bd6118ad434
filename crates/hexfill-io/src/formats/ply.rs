//! Stanford PLY: ASCII and both binary byte orders. Elements `vertex` and `face` are read, all others passed over.
//!
//! In ASCII every element is one line. A property `tag` of points or faces carries tags, other properties that are no lists are
//! data; names of tags are kept in comments.
//!
//! Source: Turk 1994.

use crate::arrays::{self, CellColumn, component};
use crate::assembly::{Assembly, Slot, Values};
use crate::data::{MeshData, TagName};
use crate::error::ReadError;
use crate::source::{Source, reserve};
use crate::write::{Real, all_tags, has_cell_tags, unquoted, write_indices};
use std::collections::{BTreeMap, BTreeSet};
use std::io::{self, Write};

#[derive(Clone, Copy, PartialEq, Eq)]
enum Encoding {
    Ascii,
    Little,
    Big,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn from_name(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    fn is_whole(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }
}

struct Property {
    name: String,
    /// What the array of its values is called: its name unless a comment says otherwise.
    array: String,
    scalar: Scalar,
    /// Type of the length, for a list.
    list: Option<Scalar>,
}

struct Element {
    name: String,
    count: u64,
    properties: Vec<Property>,
}

/// What a property is good for.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Role {
    Skip,
    Axis(usize),
    Indices,
    /// Tags or data: the number of the array.
    Array(usize),
}

pub(crate) fn read(mut s: Source<'_>) -> Result<MeshData, ReadError> {
    let mut out = Assembly::default();
    let (encoding, elements) = read_header(&mut s, &mut out)?;
    if !elements.iter().any(|e| e.name == "vertex") {
        return Err(s.malformed_text(
            "an element `vertex`",
            "a header without one".to_owned(),
            "is this a mesh at all?",
        ));
    }
    s.set_binary(encoding != Encoding::Ascii);
    // The number of points is known from the header, but the faces may come first: indices are checked at the end then.
    let mut points_read = false;
    for element in &elements {
        match element.name.as_str() {
            "vertex" => {
                read_points(&mut s, encoding, element, &mut out)?;
                points_read = true;
            }
            "face" => {
                if !points_read {
                    return Err(s.unsupported("a PLY file with faces before points", "export points first"));
                }
                read_faces(&mut s, encoding, element, &mut out)?;
            }
            _ => {
                let mut values = Vec::new();
                for i in 0..element.count {
                    start_element(&mut s, encoding, element, i)?;
                    for property in &element.properties {
                        read_property(&mut s, encoding, property, &mut values)?;
                    }
                }
                out.ignore_many(&format!("`{}` elements", element.name), element.count);
            }
        }
    }
    Ok(out.finish())
}

fn read_header(s: &mut Source<'_>, out: &mut Assembly) -> Result<(Encoding, Vec<Element>), ReadError> {
    if !s.next_full_line()? {
        return Err(s.empty());
    }
    let magic = s.need_word("`ply`")?;
    if s.text(magic) != b"ply" {
        return Err(s.malformed("`ply`", magic, "is this a PLY file? name the format if the extension is wrong"));
    }
    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    let mut names: BTreeMap<String, String> = BTreeMap::new();
    loop {
        if !s.next_line()? {
            return Err(s.truncated("`end_header`"));
        }
        let Some(keyword) = s.word() else { continue };
        match s.text(keyword) {
            b"comment" => {
                let text = String::from_utf8_lossy(s.rest()).into_owned();
                out.name_tags(TagName::from_line(&text).into_iter());
                if let Some((property, name)) =
                    text.strip_prefix(NAME_COMMENT).and_then(|t| t.trim_start().split_once(' '))
                {
                    names.insert(property.to_owned(), name.to_owned());
                }
            }
            b"obj_info" => {}
            b"format" => {
                let span = s.need_word("ascii, binary_little_endian or binary_big_endian")?;
                encoding = Some(match s.text(span) {
                    b"ascii" => Encoding::Ascii,
                    b"binary_little_endian" => Encoding::Little,
                    b"binary_big_endian" => Encoding::Big,
                    _ => {
                        let expected = "ascii, binary_little_endian or binary_big_endian";
                        return Err(s.malformed(expected, span, "these are all the encodings PLY has"));
                    }
                });
            }
            b"element" => {
                let span = s.need_word("the name of the element")?;
                let name = s.string(span);
                if elements.iter().any(|e| e.name == name) {
                    return Err(s.malformed("each element once", span, "remove the repeated element"));
                }
                let span = s.need_word("the number of elements")?;
                let count = s.count(span, &format!("`{name}` elements"))?;
                elements.push(Element { name, count, properties: Vec::new() });
            }
            b"property" => {
                let property = read_property_line(s)?;
                let Some(element) = elements.last_mut() else {
                    return Err(s.malformed("an element before its properties", keyword, "repair the header"));
                };
                element.properties.push(property);
            }
            b"end_header" => break,
            _ => return Err(s.malformed("a line of a PLY header", keyword, "repair the header")),
        }
    }
    for property in elements.iter_mut().flat_map(|e| &mut e.properties) {
        if let Some(name) = names.get(&property.name) {
            property.array.clone_from(name);
        }
    }
    let Some(encoding) = encoding else {
        return Err(s.malformed_text("a `format` line", "a header without one".to_owned(), "repair the header"));
    };
    if let Some(element) = elements.iter().find(|e| e.properties.is_empty() && e.count > 0) {
        let given = format!("element `{}` without any", element.name);
        return Err(s.malformed_text("properties", given, "repair the header"));
    }
    Ok((encoding, elements))
}

fn read_property_line(s: &mut Source<'_>) -> Result<Property, ReadError> {
    let scalar = |s: &mut Source<'_>| {
        let span = s.need_word("a PLY type")?;
        Scalar::from_name(s.text(span))
            .ok_or_else(|| s.malformed("a PLY type such as `int` or `double`", span, "repair the header"))
    };
    let first = s.need_word("a type or `list`")?;
    let list = if s.text(first) == b"list" {
        let span = s.peek_word().unwrap_or(first);
        let length = scalar(s)?;
        if !length.is_whole() {
            return Err(s.malformed("a whole type for the length of a list", span, "repair the header"));
        }
        Some(length)
    } else {
        s.unread(first);
        None
    };
    let scalar = scalar(s)?;
    let span = s.need_word("the name of the property")?;
    let name = s.string(span);
    Ok(Property { array: name.clone(), name, scalar, list })
}

fn start_element(s: &mut Source<'_>, encoding: Encoding, element: &Element, i: u64) -> Result<(), ReadError> {
    if encoding == Encoding::Ascii && !s.next_full_line()? {
        return Err(s.truncated(format!("{} `{}` elements, found {i}", element.count, element.name)));
    }
    Ok(())
}

/// A value: whole numbers up to 2^32 are exact in both.
fn read_scalar(s: &mut Source<'_>, encoding: Encoding, scalar: Scalar, name: &str) -> Result<f64, ReadError> {
    if encoding == Encoding::Ascii {
        let span = s.need_word_or(|| format!("a value for `{name}`"))?;
        return if scalar.is_whole() { Ok(s.integer(span, name)? as f64) } else { s.number(span, name) };
    }
    let mut bytes = [0; 8];
    let size = scalar.size();
    s.exact(&mut bytes[..size], format_args!("a value for `{name}`"))?;
    if encoding == Encoding::Big {
        bytes[..size].reverse();
    }
    let [a, b, c, d, ..] = bytes;
    Ok(match scalar {
        Scalar::I8 => f64::from(a as i8),
        Scalar::U8 => f64::from(a),
        Scalar::I16 => f64::from(i16::from_le_bytes([a, b])),
        Scalar::U16 => f64::from(u16::from_le_bytes([a, b])),
        Scalar::I32 => f64::from(i32::from_le_bytes([a, b, c, d])),
        Scalar::U32 => f64::from(u32::from_le_bytes([a, b, c, d])),
        Scalar::F32 => f64::from(f32::from_le_bytes([a, b, c, d])),
        Scalar::F64 => f64::from_le_bytes(bytes),
    })
}

fn read_property(
    s: &mut Source<'_>,
    encoding: Encoding,
    property: &Property,
    values: &mut Vec<f64>,
) -> Result<(), ReadError> {
    values.clear();
    let length = match property.list {
        None => 1,
        Some(scalar) => {
            let length = read_scalar(s, encoding, scalar, "length of a list")?;
            if length < 0.0 {
                let name = &property.name;
                return Err(s.malformed_text(format!("a length for `{name}`"), format!("{length}"), "repair the file"));
            }
            length as u64
        }
    };
    for _ in 0..length {
        values.push(read_scalar(s, encoding, property.scalar, &property.name)?);
    }
    Ok(())
}

fn end_element(s: &mut Source<'_>, encoding: Encoding) -> Result<(), ReadError> {
    match s.peek_word() {
        Some(span) if encoding == Encoding::Ascii => {
            Err(s.malformed("the end of the line", span, "each element is one line with its properties"))
        }
        _ => Ok(()),
    }
}

fn read_points(s: &mut Source<'_>, encoding: Encoding, element: &Element, out: &mut Assembly) -> Result<(), ReadError> {
    let mut seen = [false; 3];
    let mut arrays: Vec<(String, Vec<f64>)> = Vec::new();
    let roles: Vec<Role> = element
        .properties
        .iter()
        .map(|p| match p.name.as_str() {
            _ if p.list.is_some() => Role::Skip,
            name => match ["x", "y", "z"].iter().position(|a| *a == name) {
                Some(axis) => {
                    seen[axis] = true;
                    if p.scalar == Scalar::F32 && axis == 0 {
                        out.note("coordinates are stored with 32 bits");
                    }
                    Role::Axis(axis)
                }
                None => array(&mut arrays, &p.array),
            },
        })
        .collect();
    if let Some(axis) = (0..3).find(|&a| !seen[a]) {
        let expected = format!("property `{}` of the points", ["x", "y", "z"][axis]);
        return Err(s.malformed_text(expected, "a header without it".to_owned(), "export 3D points"));
    }
    out.mesh.points.reserve(reserve(element.count));
    let mut values = Vec::new();
    for i in 0..element.count {
        start_element(s, encoding, element, i)?;
        let mut point = [0.0; 3];
        for (property, &role) in element.properties.iter().zip(&roles) {
            read_property(s, encoding, property, &mut values)?;
            match role {
                Role::Axis(axis) => {
                    point[axis] = values[0];
                    if !values[0].is_finite() {
                        let what = format!("{} of point {i}", property.name);
                        return Err(ReadError::NotFinite { at: s.place(), what, given: values[0].to_string() });
                    }
                }
                Role::Array(k) => arrays[k].1.push(values[0]),
                _ => {}
            }
        }
        end_element(s, encoding)?;
        out.mesh.points.push(point);
    }
    for (name, values) in arrays {
        out.point_array(&name, 1, &Values::Real(values));
    }
    Ok(())
}

/// A property that is an array of its own.
fn array(arrays: &mut Vec<(String, Vec<f64>)>, name: &str) -> Role {
    arrays.push((name.to_owned(), Vec::new()));
    Role::Array(arrays.len() - 1)
}

fn read_faces(s: &mut Source<'_>, encoding: Encoding, element: &Element, out: &mut Assembly) -> Result<(), ReadError> {
    let mut arrays: Vec<(String, Vec<f64>)> = Vec::new();
    let roles: Vec<Role> = element
        .properties
        .iter()
        .map(|p| match (p.name.as_str(), p.list) {
            ("vertex_indices" | "vertex_index", Some(_)) if p.scalar.is_whole() => Role::Indices,
            (_, None) => array(&mut arrays, &p.array),
            _ => Role::Skip,
        })
        .collect();
    if roles.iter().filter(|&&r| r == Role::Indices).count() != 1 {
        return Err(s.malformed_text(
            "one list property `vertex_indices` of the faces",
            "a header without it".to_owned(),
            "repair the header",
        ));
    }
    let mut values = Vec::new();
    let mut face = Vec::new();
    let mut slots: Vec<Slot> = Vec::new();
    for i in 0..element.count {
        start_element(s, encoding, element, i)?;
        for (property, &role) in element.properties.iter().zip(&roles) {
            read_property(s, encoding, property, &mut values)?;
            match role {
                Role::Indices => {
                    face.clear();
                    for &value in &values {
                        face.push(s.checked_index(value as i64, 0, out.mesh.points.len(), "vertex")?);
                    }
                }
                Role::Array(k) => arrays[k].1.push(values[0]),
                _ => {}
            }
        }
        end_element(s, encoding)?;
        if face.len() < 3 {
            let given = format!("{} of them", face.len());
            return Err(s.malformed_text("a face with three or more vertices", given, "remove or complete the face"));
        }
        slots.push(out.face(&face, 0));
    }
    for (name, values) in arrays {
        out.cell_array(&name, 1, &Values::Real(values), &slots);
    }
    Ok(())
}

/// Tags beyond this are not exact in any type of PLY.
pub(crate) const LARGEST_TAG: i64 = 1 << 53;

pub(crate) fn write(out: &mut dyn Write, data: &MeshData, binary: bool) -> io::Result<()> {
    let writer = Writer::new(data, binary);
    writer.header(out)?;
    writer.points(out)?;
    writer.faces(out)
}

/// What is written, and as which types.
struct Writer<'a> {
    data: &'a MeshData,
    binary: bool,
    /// Some tag needs more than 32 bits: tags are doubles then, because PLY has no wider whole type.
    wide: bool,
    /// Some face has more than 255 sides, which the usual type of lengths does not hold.
    long: bool,
    /// Whether faces have tags.
    face_tags: bool,
    on_faces: Vec<(String, CellColumn<'a>)>,
}

impl<'a> Writer<'a> {
    fn new(data: &'a MeshData, binary: bool) -> Self {
        Self {
            data,
            binary,
            wide: all_tags(data).any(|t| i32::try_from(t).is_err()),
            long: data.faces().any(|face| face.len() > 255),
            face_tags: has_cell_tags(data),
            on_faces: single_columns(data),
        }
    }

    fn header(&self, out: &mut dyn Write) -> io::Result<()> {
        let Self { data, on_faces, .. } = self;
        let tag_type = if self.wide { "double" } else { "int" };
        writeln!(out, "ply\nformat {} 1.0", if self.binary { "binary_little_endian" } else { "ascii" })?;
        for name in &data.tag_names {
            writeln!(out, "comment {}", name.line())?;
        }
        let arrays = data.point_data.iter().map(|(name, _)| name).chain(on_faces.iter().map(|(name, _)| name));
        let names = property_names(arrays.map(String::as_str));
        for (array, name) in names.iter().filter(|(array, name)| *array != name) {
            writeln!(out, "comment {NAME_COMMENT} {name} {}", unquoted(array))?;
        }
        writeln!(out, "element vertex {}", data.points.len())?;
        writeln!(out, "property double x\nproperty double y\nproperty double z")?;
        if data.point_tags.is_some() {
            writeln!(out, "property {tag_type} tag")?;
        }
        for (name, _) in &data.point_data {
            writeln!(out, "property double {}", names[name.as_str()])?;
        }
        let length_type = if self.long { "uint" } else { "uchar" };
        // `int` is what all readers take; it is enough for 2^31 points.
        let index_type = if data.points.len() > i32::MAX as usize { "uint" } else { "int" };
        writeln!(out, "element face {}\nproperty list {length_type} {index_type} vertex_indices", data.face_count())?;
        if self.face_tags {
            writeln!(out, "property {tag_type} tag")?;
        }
        for (name, _) in on_faces {
            writeln!(out, "property double {}", names[name.as_str()])?;
        }
        writeln!(out, "end_header")
    }

    fn points(&self, out: &mut dyn Write) -> io::Result<()> {
        for (i, point) in self.data.points.iter().enumerate() {
            if self.binary {
                for x in point {
                    out.write_all(&x.to_le_bytes())?;
                }
            } else {
                crate::write::write_point(out, point, " ")?;
            }
            if let Some(tags) = &self.data.point_tags {
                self.tag(out, tags[i])?;
            }
            for (_, values) in &self.data.point_data {
                self.value(out, values[i])?;
            }
            self.end(out)?;
        }
        Ok(())
    }

    fn faces(&self, out: &mut dyn Write) -> io::Result<()> {
        let mut values: Vec<_> = self.on_faces.iter().map(|(_, column)| column.faces()).collect();
        for (face, tag) in self.data.tagged_faces() {
            self.indices(out, face)?;
            if self.face_tags {
                self.tag(out, tag)?;
            }
            for values in &mut values {
                self.value(out, values.next().unwrap_or(f64::NAN))?;
            }
            self.end(out)?;
        }
        Ok(())
    }

    /// A face as a list: its length, then its vertices.
    fn indices(&self, out: &mut dyn Write, face: &[u32]) -> io::Result<()> {
        if !self.binary {
            write!(out, "{}", face.len())?;
            return write_indices(out, face, 0);
        }
        match self.long {
            true => out.write_all(&(face.len() as u32).to_le_bytes())?,
            false => out.write_all(&[face.len() as u8])?,
        }
        face.iter().try_for_each(|v| out.write_all(&v.to_le_bytes()))
    }

    fn tag(&self, out: &mut dyn Write, tag: i64) -> io::Result<()> {
        match (self.binary, self.wide) {
            (false, false) => write!(out, " {tag}"),
            (false, true) => write!(out, " {}", Real(tag as f64)),
            (true, false) => out.write_all(&(tag as i32).to_le_bytes()),
            (true, true) => out.write_all(&(tag as f64).to_le_bytes()),
        }
    }

    fn value(&self, out: &mut dyn Write, value: f64) -> io::Result<()> {
        match self.binary {
            true => out.write_all(&value.to_le_bytes()),
            false => write!(out, " {}", Real(value)),
        }
    }

    /// The end of an element: in ASCII every element is one line.
    fn end(&self, out: &mut dyn Write) -> io::Result<()> {
        if self.binary { Ok(()) } else { out.write_all(b"\n") }
    }
}

/// The arrays on faces, component by component, each with its name.
fn single_columns(data: &MeshData) -> Vec<(String, CellColumn<'_>)> {
    let mut all = Vec::new();
    for (name, columns) in arrays::on_cells(data) {
        let several = columns.len() > 1;
        let named = |k| if several { component(name, k) } else { name.to_owned() };
        all.extend(columns.iter().enumerate().map(|(k, &column)| (named(k), column)));
    }
    all
}

/// The comment that gives a property its name where PLY (or meshio) takes fewer characters.
const NAME_COMMENT: &str = "hexfill: property";

/// A name for each array of letters, digits and underscores, each its own and none that means something else.
fn property_names<'a>(arrays: impl Iterator<Item = &'a str>) -> BTreeMap<&'a str, String> {
    let mut taken: BTreeSet<String> =
        ["x", "y", "z", "tag", "vertex_indices", "vertex_index"].map(str::to_owned).into_iter().collect();
    let mut names = BTreeMap::new();
    for array in arrays {
        names.entry(array).or_insert_with(|| {
            let mut name: String = array.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
            while name.is_empty() || !taken.insert(name.clone()) {
                name.push('_');
            }
            name
        });
    }
    names
}
