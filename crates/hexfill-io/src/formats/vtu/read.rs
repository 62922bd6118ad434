//! Reading VTK XML. The whole file is kept in memory once, because appended arrays are addressed by offset; array texts are
//! borrowed from it.
//!
//! Source: the VTK formats, "XML File Formats".

use super::arrays::{Bytes, Layout, unpack};
use crate::assembly::{Assembly, Slot, Values};
use crate::data::MeshData;
use crate::error::{Place, Position, ReadError, snippet};
use crate::formats::vtk::{Scalar, cells};
use crate::limits::unpacked_inside;
use crate::source::{Source, parse_integer, parse_number};
use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};
use std::borrow::Cow;
use std::cell::Cell;

/// Where an array stands in a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Section {
    FieldData,
    Points,
    PointData,
    CellData,
    Cells,
    Verts,
    Lines,
    Strips,
    Polys,
}

impl Section {
    fn from_name(name: &str) -> Option<Self> {
        Some(match name {
            "FieldData" => Self::FieldData,
            "Points" => Self::Points,
            "PointData" => Self::PointData,
            "CellData" => Self::CellData,
            "Cells" => Self::Cells,
            "Verts" => Self::Verts,
            "Lines" => Self::Lines,
            "Strips" => Self::Strips,
            "Polys" => Self::Polys,
            _ => return None,
        })
    }
}

struct Array<'a> {
    section: Section,
    name: String,
    /// The type as named in the file.
    scalar: String,
    components: u64,
    format: String,
    offset: Option<u64>,
    text: &'a str,
    /// Byte of the file where the element begins.
    start: usize,
}

impl Array<'_> {
    /// Whether the array is data of the user, of which there may be any number.
    fn is_data(&self) -> bool {
        matches!(self.section, Section::PointData | Section::CellData)
    }
}

#[derive(Default)]
struct Piece<'a> {
    points: u64,
    cells: u64,
    arrays: Vec<Array<'a>>,
    start: usize,
}

/// The file in memory, for messages and appended arrays.
struct File<'a> {
    name: String,
    bytes: &'a [u8],
    layout: Layout,
    /// The appended section after its underscore, and whether it is base64.
    appended: Option<(&'a [u8], bool)>,
    format: crate::format::Format,
    /// Bytes that arrays may still unpack to, all together.
    left: Cell<u64>,
}

impl File<'_> {
    fn at(&self, byte: usize) -> Box<Place> {
        let byte = byte.min(self.bytes.len());
        let line = self.bytes[..byte].iter().filter(|&&b| b == b'\n').count() as u64 + 1;
        Box::new(Place { file: self.name.clone(), format: self.format, position: Position::Line(line) })
    }

    fn malformed(&self, byte: usize, expected: impl Into<String>, given: impl Into<String>, remedy: &str) -> ReadError {
        let (expected, given, remedy) = (expected.into(), given.into(), remedy.to_owned());
        ReadError::Malformed { at: self.at(byte), expected, given, remedy }
    }

    fn unsupported(&self, byte: usize, what: impl Into<String>, remedy: &str) -> ReadError {
        ReadError::Unsupported { at: self.at(byte), what: what.into(), remedy: remedy.to_owned() }
    }

    /// The byte of the file where a borrowed text begins.
    fn byte_of(&self, text: &str) -> usize {
        (text.as_ptr() as usize).saturating_sub(self.bytes.as_ptr() as usize)
    }

    fn values(&self, array: &Array<'_>) -> Result<Values, ReadError> {
        let Some(scalar) = Scalar::from_xml_name(&array.scalar) else {
            let remedy = "use a numeric type such as Float64 or Int64";
            let given = snippet(array.scalar.as_bytes());
            return Err(self.malformed(array.start, format!("a type for the array `{}`", array.name), given, remedy));
        };
        let bytes = match (array.format.as_str(), self.appended) {
            ("ascii", _) => return self.ascii(array, scalar),
            ("binary", _) => Bytes::base64(array.text.as_bytes()),
            ("appended", Some((data, base64))) => {
                let offset = array.offset.and_then(|o| usize::try_from(o).ok()).filter(|&o| o <= data.len());
                let Some(offset) = offset else {
                    let given = format!("{:?}", array.offset);
                    return Err(self.malformed(
                        array.start,
                        "an offset into the appended data",
                        given,
                        "repair the file",
                    ));
                };
                if base64 { Bytes::base64(&data[offset..]) } else { Bytes::Raw(&data[offset..]) }
            }
            ("appended", None) => {
                return Err(ReadError::Truncated {
                    at: self.at(self.bytes.len()),
                    expected: "AppendedData".to_owned(),
                });
            }
            (other, _) => {
                let given = snippet(other.as_bytes());
                return Err(self.malformed(array.start, "format ascii, binary or appended", given, "repair the file"));
            }
        };
        let data = unpack(bytes, self.layout, self.left.get()).map_err(|given| {
            let expected = format!("the data of array `{}`", array.name);
            self.malformed(array.start, expected, given, "the file is truncated or damaged: export it again")
        })?;
        self.left.set(self.left.get() - data.len() as u64);
        Ok(scalar.decode(&data, self.layout.big_endian))
    }

    fn ascii(&self, array: &Array<'_>, scalar: Scalar) -> Result<Values, ReadError> {
        let bad = |word: &str| {
            let given = snippet(word.as_bytes());
            self.malformed(self.byte_of(word), format!("a number for `{}`", array.name), given, "correct this word")
        };
        let words = array.text.split_ascii_whitespace();
        if scalar.is_whole() {
            let whole = words.map(|w| parse_integer(w.as_bytes()).ok_or_else(|| bad(w)));
            return whole.collect::<Result<_, _>>().map(Values::Whole);
        }
        let is_point = array.section == Section::Points;
        let real = words.map(|w| {
            let x = parse_number(w.as_bytes()).ok_or_else(|| bad(w))?;
            if is_point && !x.is_finite() {
                let at = self.at(self.byte_of(w));
                return Err(ReadError::NotFinite { at, what: "a coordinate".to_owned(), given: w.to_owned() });
            }
            Ok(x)
        });
        real.collect::<Result<_, _>>().map(Values::Real)
    }
}

pub(crate) fn read(mut source: Source<'_>) -> Result<MeshData, ReadError> {
    let bytes = source.read_all()?;
    if bytes.iter().all(u8::is_ascii_whitespace) {
        return Err(source.empty());
    }
    let mut file = File {
        name: source.file().to_owned(),
        bytes: &bytes,
        layout: Layout { big_endian: false, header_size: 4, zlib: false },
        appended: None,
        format: source.format(),
        left: Cell::new(unpacked_inside(bytes.len() as u64, source.is_packed())),
    };
    // The appended section may hold anything and is cut off before the XML is parsed.
    let cut = find(&bytes, b"<AppendedData").unwrap_or(bytes.len());
    let text = std::str::from_utf8(&bytes[..cut]).map_err(|e| {
        file.malformed(
            e.valid_up_to(),
            "XML in UTF-8",
            "other bytes",
            "is this a VTK XML file? name the format otherwise",
        )
    })?;
    if cut < bytes.len() {
        file.appended = Some(appended(&file, cut)?);
    }
    let (pieces, fields) = parse(&mut file, text)?;
    let mut out = Assembly::default();
    for field in fields.iter().filter(|f| Scalar::from_xml_name(&f.scalar).is_some_and(Scalar::is_whole)) {
        out.field(&field.name, field.components as usize, &file.values(field)?);
    }
    let several = pieces.len() > 1;
    for piece in &pieces {
        add_piece(&file, piece, several, &mut out)?;
    }
    Ok(out.finish())
}

fn find(bytes: &[u8], what: &[u8]) -> Option<usize> {
    let mut from = 0;
    while let Some(i) = bytes[from..].iter().position(|&b| b == what[0]) {
        if bytes[from + i..].starts_with(what) {
            return Some(from + i);
        }
        from += i + 1;
    }
    None
}

fn appended<'a>(file: &File<'a>, cut: usize) -> Result<(&'a [u8], bool), ReadError> {
    let section = &file.bytes[cut..];
    let truncated = || ReadError::Truncated { at: file.at(file.bytes.len()), expected: "appended data".to_owned() };
    let close = section.iter().position(|&b| b == b'>').ok_or_else(truncated)?;
    let tag = &section[..close];
    let base64 = find(tag, b"base64").is_some();
    if !base64 && find(tag, b"raw").is_none() {
        return Err(file.unsupported(cut, "this encoding of AppendedData", "save it as raw, base64 or ASCII"));
    }
    let data = &section[close + 1..];
    let start = data.iter().position(|&b| b == b'_').ok_or_else(truncated)?;
    Ok((&data[start + 1..], base64))
}

fn attribute(element: &BytesStart<'_>, name: &str) -> Option<String> {
    let attribute = element.try_get_attribute(name).ok()??;
    attribute.normalized_value(XmlVersion::Implicit1_0).ok().map(Cow::into_owned)
}

/// Reads the XML: sets the layout and collects the pieces with their arrays, and the arrays of the file as a whole.
fn parse<'a>(file: &mut File<'_>, text: &'a str) -> Result<(Vec<Piece<'a>>, Vec<Array<'a>>), ReadError> {
    let mut xml = Reader::from_str(text);
    let mut open = Open::default();
    loop {
        let start = xml.buffer_position() as usize;
        let event = xml.read_event().map_err(|e| {
            let at = xml.error_position() as usize;
            file.malformed(at, "well-formed XML", e.to_string(), "the file is truncated or damaged: export it again")
        })?;
        match event {
            Event::Start(element) => {
                open.depth += 1;
                open.element(file, &element, false, start)?;
            }
            Event::Empty(element) => open.element(file, &element, true, start)?,
            Event::End(element) => open.close(element.name().as_ref()),
            Event::Text(text) => open.text(file, text.into_inner(), start)?,
            Event::Eof => break,
            _ => {}
        }
    }
    if open.depth > 0 && file.appended.is_none() {
        return Err(ReadError::Truncated { at: file.at(text.len()), expected: "`</VTKFile>`".to_owned() });
    }
    if open.pieces.is_empty() {
        return Err(file.malformed(0, "a `<Piece>`", "none", "is this a VTK XML file? name the format otherwise"));
    }
    Ok((open.pieces, open.fields))
}

/// Where the reader is in the XML, and what it has met.
#[derive(Default)]
struct Open<'a> {
    pieces: Vec<Piece<'a>>,
    /// Arrays of the file as a whole.
    fields: Vec<Array<'a>>,
    /// Whether `<VTKFile>` has been met.
    root: bool,
    in_piece: bool,
    section: Option<Section>,
    /// The array whose text is being read, and how deep it lies.
    array: Option<Array<'a>>,
    array_depth: u32,
    /// Elements begun and not ended.
    depth: u32,
}

impl<'a> Open<'a> {
    /// An element begins (`empty`: and ends) at byte `start`.
    fn element(
        &mut self,
        file: &mut File<'_>,
        element: &BytesStart<'_>,
        empty: bool,
        start: usize,
    ) -> Result<(), ReadError> {
        match element.name().as_ref() {
            "VTKFile" => {
                self.root = true;
                read_root(file, element, start)?;
            }
            name if !self.root => {
                let remedy = "is this a VTK XML file? name the format otherwise";
                return Err(file.malformed(start, "`<VTKFile>`", format!("`<{name}>`"), remedy));
            }
            "Piece" => {
                self.in_piece = !empty;
                let (points, cells) =
                    (count(file, element, "NumberOfPoints", start)?, count(file, element, "NumberOfCells", start)?);
                self.pieces.push(Piece { points, cells, arrays: Vec::new(), start });
            }
            "FieldData" => self.section = (!empty).then_some(Section::FieldData),
            "DataArray" if self.in_piece || self.section == Some(Section::FieldData) => {
                self.data_array(element, empty, start);
            }
            name if self.in_piece => {
                self.section = if empty { None } else { Section::from_name(name).or(self.section) };
            }
            _ => {}
        }
        Ok(())
    }

    fn data_array(&mut self, element: &BytesStart<'_>, empty: bool, start: usize) {
        let Some(section) = self.section else { return };
        let array = Array {
            section,
            name: attribute(element, "Name").unwrap_or_default(),
            scalar: attribute(element, "type").unwrap_or_default(),
            components: attribute(element, "NumberOfComponents").and_then(|c| c.parse().ok()).unwrap_or(1),
            format: attribute(element, "format").unwrap_or_else(|| "ascii".to_owned()),
            offset: attribute(element, "offset").and_then(|o| o.parse().ok()),
            text: "",
            start,
        };
        match self.pieces.last_mut() {
            // An array of the file as a whole without text has nothing to say.
            _ if empty && !self.in_piece => {}
            // Appended arrays are empty elements.
            Some(piece) if empty => piece.arrays.push(array),
            _ => (self.array, self.array_depth) = (Some(array), self.depth),
        }
    }

    fn text(&mut self, file: &File<'_>, text: Cow<'a, str>, start: usize) -> Result<(), ReadError> {
        let (Some(array), Cow::Borrowed(text)) = (&mut self.array, text) else { return Ok(()) };
        if self.depth != self.array_depth {
            return Ok(()); // an InformationKey inside the array
        }
        if array.text.trim_ascii().is_empty() {
            array.text = text;
        } else if !text.trim_ascii().is_empty() {
            // Texts are borrowed from the file: two with a comment between them are no longer one.
            return Err(file.unsupported(start, "a comment inside an array", "remove the comment"));
        }
        Ok(())
    }

    fn close(&mut self, name: &str) {
        self.depth = self.depth.saturating_sub(1);
        match name {
            "DataArray" => match (self.array.take(), self.pieces.last_mut()) {
                (Some(done), _) if done.section == Section::FieldData => self.fields.push(done),
                (Some(done), Some(piece)) => piece.arrays.push(done),
                _ => {}
            },
            "Piece" => self.in_piece = false,
            name if Section::from_name(name).is_some() => self.section = None,
            _ => {}
        }
    }
}

/// A count among the attributes of a piece; 0 if it is not there.
fn count(file: &File<'_>, element: &BytesStart<'_>, name: &str, start: usize) -> Result<u64, ReadError> {
    let Some(text) = attribute(element, name) else { return Ok(0) };
    let count = text.trim().parse().ok().filter(|&n: &u64| n <= u64::from(u32::MAX));
    count.ok_or_else(|| {
        let expected = format!("a count below 2^32 for {name}");
        file.malformed(start, expected, snippet(text.as_bytes()), "repair the file")
    })
}

fn read_root(file: &mut File<'_>, element: &BytesStart<'_>, start: usize) -> Result<(), ReadError> {
    let kind = attribute(element, "type").unwrap_or_default();
    if kind != "UnstructuredGrid" && kind != "PolyData" {
        let remedy = "convert it to an unstructured grid (ParaView: Append Datasets) or extract the surface";
        return Err(file.unsupported(start, format!("VTK XML of type {}", snippet(kind.as_bytes())), remedy));
    }
    file.layout.big_endian = attribute(element, "byte_order").as_deref() == Some("BigEndian");
    file.layout.header_size = if attribute(element, "header_type").as_deref() == Some("UInt64") { 8 } else { 4 };
    match attribute(element, "compressor").as_deref() {
        None | Some("") => {}
        Some("vtkZLibDataCompressor") => file.layout.zlib = true,
        Some(other) => {
            let what = format!("compression by {}", snippet(other.as_bytes()));
            return Err(file.unsupported(start, what, "save it with zlib or without compression"));
        }
    }
    Ok(())
}

impl<'a> Piece<'a> {
    fn array(&self, section: Section, name: &str) -> Option<&Array<'a>> {
        // The points have one array, whatever its name.
        self.arrays.iter().find(|a| a.section == section && (a.name == name || section == Section::Points))
    }
}

/// The whole numbers of an array, or an empty list if there is none.
fn whole(file: &File<'_>, piece: &Piece<'_>, section: Section, name: &str) -> Result<Vec<i64>, ReadError> {
    let Some(array) = piece.array(section, name) else { return Ok(Vec::new()) };
    match file.values(array)? {
        Values::Whole(v) => Ok(v),
        Values::Real(_) => {
            Err(file.malformed(array.start, format!("whole numbers for `{name}`"), "a real type", "use Int64"))
        }
    }
}

fn add_piece(file: &File<'_>, piece: &Piece<'_>, several: bool, out: &mut Assembly) -> Result<(), ReadError> {
    let base = out.point_count();
    check_once(file, piece)?;
    add_points(file, piece, out)?;
    // Data are on the cells in this order, whatever the order of the sections in the file.
    let mut slots = Vec::new();
    for section in [Section::Verts, Section::Lines, Section::Strips, Section::Polys, Section::Cells] {
        add_cells(file, piece, section, base, out, &mut slots)?;
    }
    for array in piece.arrays.iter().filter(|a| a.is_data()) {
        if several || Scalar::from_xml_name(&array.scalar).is_none() {
            let why = if several { "the file has several pieces" } else { "it is text" };
            out.note(format!("array `{}` is not kept: {why}", array.name));
            continue;
        }
        let values = file.values(array)?;
        if array.section == Section::PointData {
            out.point_array(&array.name, array.components as usize, &values);
        } else {
            out.cell_array(&array.name, array.components as usize, &values, &slots);
        }
    }
    Ok(())
}

/// Refuses a piece that has one of its arrays twice, as its first array would silently win.
fn check_once(file: &File<'_>, piece: &Piece<'_>) -> Result<(), ReadError> {
    for (i, a) in piece.arrays.iter().enumerate() {
        let same = |b: &Array<'_>| b.section == a.section && (b.name == a.name || a.section == Section::Points);
        if !a.is_data() && piece.arrays[..i].iter().any(same) {
            let given = format!("`{}` again", a.name);
            return Err(file.malformed(a.start, "each array once", given, "remove the second one"));
        }
    }
    Ok(())
}

fn add_points(file: &File<'_>, piece: &Piece<'_>, out: &mut Assembly) -> Result<(), ReadError> {
    if let Some(array) = piece.array(Section::Points, "") {
        let values = match file.values(array)? {
            Values::Real(v) => v,
            Values::Whole(v) => v.into_iter().map(|x| x as f64).collect(),
        };
        if values.len() as u64 != 3 * piece.points {
            let given = format!("{}", values.len());
            let expected = format!("{} coordinates for {} points", 3 * piece.points, piece.points);
            return Err(file.malformed(array.start, expected, given, "correct NumberOfPoints or the array"));
        }
        if let Some(i) = values.iter().position(|x| !x.is_finite()) {
            let what = format!("{} of point {} (0-based)", ["x", "y", "z"][i % 3], i / 3);
            return Err(ReadError::NotFinite { at: file.at(array.start), what, given: values[i].to_string() });
        }
        if array.scalar == "Float32" {
            out.note("coordinates are stored with 32 bits");
        }
        out.mesh.points.extend(values.chunks_exact(3).map(|p| [p[0], p[1], p[2]]));
    } else if piece.points > 0 {
        return Err(file.malformed(piece.start, "an array of points", "none", "the file is damaged: export it again"));
    }
    if out.point_count() > u32::MAX as usize {
        let (given, limit) = (out.point_count() as u64, u64::from(u32::MAX));
        return Err(ReadError::TooLarge { at: file.at(piece.start), what: "points".to_owned(), given, limit });
    }
    Ok(())
}

/// The cells of one section, whose nodes count from `base`, the first point of the piece; appends where each went to `slots`.
fn add_cells(
    file: &File<'_>,
    piece: &Piece<'_>,
    section: Section,
    base: usize,
    out: &mut Assembly,
    slots: &mut Vec<Slot>,
) -> Result<(), ReadError> {
    let ends = whole(file, piece, section, "offsets")?;
    let nodes = whole(file, piece, section, "connectivity")?;
    let start = piece.array(section, "offsets").map_or(piece.start, |a| a.start);
    // VTK's offsets are the ends of the cells in `connectivity`, without a leading zero.
    let rising = ends.windows(2).all(|w| w[0] <= w[1]) && ends.first().is_none_or(|&e| e >= 0);
    if !rising || ends.last().copied().unwrap_or(0) != nodes.len() as i64 {
        let expected = format!("offsets rising to {} in {section:?}", nodes.len());
        return Err(file.malformed(start, expected, "others", "repair offsets or connectivity"));
    }
    let types = whole(file, piece, section, "types")?;
    if section == Section::Cells && (types.len() != ends.len() || ends.len() as u64 != piece.cells) {
        let given = format!("{} types and {} offsets", types.len(), ends.len());
        let expected = format!("{} cells", piece.cells);
        return Err(file.malformed(start, expected, given, "correct NumberOfCells or the arrays"));
    }
    let n = (out.point_count() - base) as i64;
    let mut cell = Vec::new();
    let mut from = 0;
    for (i, &end) in ends.iter().enumerate() {
        cell.clear();
        for &given in &nodes[from..end as usize] {
            if !(0..n).contains(&given) {
                let (at, what) = (file.at(start), "point".to_owned());
                return Err(ReadError::IndexOutOfRange { at, what, given, lowest: 0, highest: n - 1 });
            }
            cell.push((base + given as usize) as u32);
        }
        from = end as usize;
        // Only `Cells` lists the types of VTK; the other sections have one each.
        let cell_type = match section {
            Section::Verts => 2,
            Section::Lines => 4,
            Section::Strips => 6,
            Section::Polys => cells::POLYGON,
            _ => u8::try_from(types[i]).unwrap_or(255),
        };
        slots.push(cells::add(out, cell_type, &cell).map_err(|expected| {
            let given = format!("{} for cell {i} (0-based)", cell.len());
            file.malformed(start, expected, given, "correct connectivity or types")
        })?);
    }
    Ok(())
}
