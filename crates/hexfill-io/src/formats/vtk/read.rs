//! Reading legacy VTK.
//!
//! Source: the VTK formats, "Simple Legacy Formats".

use super::{Scalar, cells};
use crate::assembly::{Assembly, Slot, Values};
use crate::data::MeshData;
use crate::error::{ReadError, snippet};
use crate::source::{Source, reserve};
use crate::write::decode_name;

/// Cells as the file lists them: cell `i` has the nodes `nodes[ends[i - 1]..ends[i]]`.
#[derive(Default)]
struct CellList {
    ends: Vec<usize>,
    nodes: Vec<u32>,
}

impl CellList {
    fn iter(&self) -> impl Iterator<Item = &[u32]> {
        let starts = std::iter::once(&0).chain(&self.ends);
        starts.zip(&self.ends).map(|(&a, &b)| &self.nodes[a..b])
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum On {
    Nothing,
    Points,
    Cells,
}

struct Reader<'r> {
    s: Source<'r>,
    binary: bool,
    /// Version 5 and later: offsets and connectivity are separate arrays.
    split_cells: bool,
    polydata: bool,
    out: Assembly,
    points_read: bool,
    has_cells: bool,
    /// Cells of an unstructured grid.
    cells: Option<CellList>,
    types: Option<Vec<u8>>,
    /// Vertices, lines, polygons and strips of polydata.
    parts: [Option<CellList>; 4],
    slots: Vec<Slot>,
    on: On,
    on_count: u64,
}

const PARTS: [&str; 4] = ["VERTICES", "LINES", "POLYGONS", "TRIANGLE_STRIPS"];

pub(crate) fn read(mut s: Source<'_>) -> Result<MeshData, ReadError> {
    let (binary, split_cells) = read_header(&mut s)?;
    let mut reader = Reader {
        s,
        binary,
        split_cells,
        polydata: false,
        out: Assembly::default(),
        points_read: false,
        has_cells: false,
        cells: None,
        types: None,
        parts: Default::default(),
        slots: Vec::new(),
        on: On::Nothing,
        on_count: 0,
    };
    reader.read_dataset()?;
    while let Some(span) = reader.s.word_anywhere()? {
        let keyword = reader.s.string(span).to_ascii_uppercase();
        if !reader.section(&keyword, span)? {
            break;
        }
    }
    if !reader.points_read {
        return Err(reader.s.truncated("a section POINTS"));
    }
    reader.place_cells()?;
    if !reader.has_cells {
        let sections = if reader.polydata { "a section POLYGONS" } else { "a section CELLS" };
        return Err(reader.s.truncated(sections));
    }
    Ok(reader.out.finish())
}

/// The first three lines. Returns (binary, cells in two arrays).
fn read_header(s: &mut Source<'_>) -> Result<(bool, bool), ReadError> {
    if !s.next_full_line()? {
        return Err(s.empty());
    }
    let first = String::from_utf8_lossy(s.line()).into_owned();
    let Some(version) = first.trim().to_ascii_lowercase().strip_prefix("# vtk datafile version").map(str::to_owned)
    else {
        let remedy = if first.trim_start().starts_with('<') {
            "this looks like VTK XML: name it .vtu, or name the format"
        } else {
            "is this a legacy VTK file? name the format if the extension is wrong"
        };
        return Err(s.malformed_text("`# vtk DataFile Version x.y`", snippet(first.as_bytes()), remedy));
    };
    let major: u32 = version.trim().split('.').next().and_then(|m| m.parse().ok()).unwrap_or(0);
    if !(1..=5).contains(&major) {
        let remedy = "save it as version 5.1 or older (VTK: SetFileVersion(42) or 51)";
        return Err(s.unsupported(format!("legacy VTK of version {}", version.trim()), remedy));
    }
    if !s.next_line()? {
        return Err(s.truncated("a title line")); // any text
    }
    if !s.next_full_line()? {
        return Err(s.truncated("`ASCII` or `BINARY`"));
    }
    let span = s.need_word("`ASCII` or `BINARY`")?;
    let binary = match s.string(span).to_ascii_uppercase().as_str() {
        "ASCII" => false,
        "BINARY" => true,
        _ => return Err(s.malformed("`ASCII` or `BINARY`", span, "the third line must say which")),
    };
    Ok((binary, major >= 5))
}

impl Reader<'_> {
    fn read_dataset(&mut self) -> Result<(), ReadError> {
        let span = self.s.need_word_anywhere("`DATASET`")?;
        if !self.s.text(span).eq_ignore_ascii_case(b"DATASET") {
            return Err(self.s.malformed("`DATASET`", span, "the fourth line must name the dataset"));
        }
        let span = self.s.need_word("a dataset type")?;
        match self.s.string(span).to_ascii_uppercase().as_str() {
            "UNSTRUCTURED_GRID" => {}
            "POLYDATA" => self.polydata = true,
            other => {
                let remedy =
                    "convert it to an unstructured grid or polydata (ParaView: Append Datasets or Extract Surface)";
                return Err(self.s.unsupported(format!("a VTK dataset {}", snippet(other.as_bytes())), remedy));
            }
        }
        Ok(())
    }

    /// One section; false if the rest of the file is not to be read.
    fn section(&mut self, keyword: &str, span: (usize, usize)) -> Result<bool, ReadError> {
        let part = PARTS.iter().position(|p| *p == keyword);
        match keyword {
            "POINTS" => self.read_points()?,
            "CELLS" if !self.polydata => {
                self.refuse_repetition(self.cells.is_some(), span)?;
                self.cells = Some(self.read_cells("cells")?);
            }
            "CELL_TYPES" if !self.polydata => {
                self.refuse_repetition(self.types.is_some(), span)?;
                self.types = Some(self.read_types()?);
            }
            _ if self.polydata && part.is_some() => {
                let k = part.unwrap_or(0);
                self.refuse_repetition(self.parts[k].is_some(), span)?;
                self.parts[k] = Some(self.read_cells(&keyword.to_lowercase())?);
            }
            "METADATA" => self.skip_metadata()?,
            "POINT_DATA" => self.begin_data(On::Points)?,
            "CELL_DATA" => self.begin_data(On::Cells)?,
            _ => return self.attribute(keyword, span),
        }
        Ok(true)
    }

    fn refuse_repetition(&self, repeated: bool, span: (usize, usize)) -> Result<(), ReadError> {
        if repeated {
            return Err(self.s.malformed("each section once", span, "remove the repeated section"));
        }
        Ok(())
    }

    fn count_on_line(&mut self, what: &str) -> Result<u64, ReadError> {
        let span = self.s.need_word(&format!("the number of {what}"))?;
        self.s.count(span, what)
    }

    fn scalar_on_line(&mut self) -> Result<Scalar, ReadError> {
        let span = self.s.need_word("a VTK type")?;
        Scalar::from_legacy_name(&self.s.string(span))
            .ok_or_else(|| self.s.malformed("a VTK type such as `double` or `int`", span, "use a numeric type"))
    }

    /// An array of `n` values after the current line.
    fn values(&mut self, n: u64, scalar: Scalar, what: &str) -> Result<Values, ReadError> {
        // A bit becomes a number: more than there are points and cells are an attack.
        let expected = 64 * (self.out.point_count() + self.slots.len() + 1) as u64;
        if scalar == Scalar::Bit && n > expected {
            return Err(self.s.malformed_text(
                format!("fewer than {expected} bits of {what}"),
                n.to_string(),
                "correct the count",
            ));
        }
        if self.binary {
            let bytes = if scalar == Scalar::Bit { n.div_ceil(8) } else { n.saturating_mul(scalar.size() as u64) };
            self.s.set_binary(true);
            let block = self.s.bytes(bytes, what)?;
            self.s.skip_line_end()?;
            self.s.set_binary(false);
            let mut values = scalar.decode(&block, true);
            if let Values::Whole(v) = &mut values {
                v.truncate(usize::try_from(n).unwrap_or(usize::MAX));
            }
            return Ok(values);
        }
        let missing = |i: usize| format!("{n} values of {what}, found {i}");
        if scalar.is_whole() {
            let mut values = Vec::with_capacity(reserve(n));
            while (values.len() as u64) < n {
                let span = self.s.need_word_anywhere_or(|| missing(values.len()))?;
                values.push(self.s.integer(span, what)?);
            }
            Ok(Values::Whole(values))
        } else {
            let mut values = Vec::with_capacity(reserve(n));
            while (values.len() as u64) < n {
                let span = self.s.need_word_anywhere_or(|| missing(values.len()))?;
                values.push(self.s.number(span, what)?);
            }
            Ok(Values::Real(values))
        }
    }

    fn whole_values(&mut self, n: u64, scalar: Scalar, what: &str) -> Result<Vec<i64>, ReadError> {
        match self.values(n, scalar, what)? {
            Values::Whole(v) => Ok(v),
            Values::Real(_) => {
                Err(self.s.malformed_text(format!("whole numbers for {what}"), "a real type".to_owned(), "use `int`"))
            }
        }
    }

    fn read_points(&mut self) -> Result<(), ReadError> {
        if std::mem::replace(&mut self.points_read, true) {
            return Err(self.s.malformed_text("each section once", "POINTS again".to_owned(), "remove the second one"));
        }
        let n = self.count_on_line("points")?;
        let scalar = self.scalar_on_line()?;
        if !self.binary {
            self.out.mesh.points.reserve(reserve(n));
            for i in 0..n {
                let point = self.s.point_anywhere(i, n)?;
                self.out.mesh.points.push(point);
            }
            return Ok(());
        }
        let values = match self.values(3 * n, scalar, "coordinates")? {
            Values::Real(v) => v,
            Values::Whole(v) => v.into_iter().map(|x| x as f64).collect(),
        };
        if let Some(i) = values.iter().position(|x| !x.is_finite()) {
            let what = format!("{} of point {} (0-based)", ["x", "y", "z"][i % 3], i / 3);
            return Err(ReadError::NotFinite { at: self.s.place(), what, given: values[i].to_string() });
        }
        self.out.mesh.points = values.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect();
        if scalar == Scalar::F32 {
            self.out.note("coordinates are stored with 32 bits");
        }
        Ok(())
    }

    /// The list after a header `NAME n size`, in either of its two layouts.
    fn read_cells(&mut self, what: &str) -> Result<CellList, ReadError> {
        if !self.points_read {
            return Err(self.s.unsupported(format!("{what} before POINTS"), "put POINTS first"));
        }
        self.has_cells = true;
        let n = self.count_on_line(what)?;
        let size = self.count_on_line(&format!("numbers in {what}"))?;
        if self.split_cells {
            return self.read_split_cells(n, size, what);
        }
        let mut list = CellList::default();
        list.ends.reserve(reserve(n));
        list.nodes.reserve(reserve(size.saturating_sub(n)));
        let count = self.out.point_count();
        let all = if self.binary { self.whole_values(size, Scalar::I32, what)? } else { Vec::new() };
        let mut next = 0;
        let mut word = |this: &mut Self, i: u64| -> Result<i64, ReadError> {
            if this.binary {
                next += 1;
                return all.get(next - 1).copied().ok_or_else(|| {
                    let expected = format!("{n} {what} in {size} numbers");
                    this.s.malformed_text(expected, format!("{i} of them"), "the header of the section is wrong")
                });
            }
            let span = this.s.need_word_anywhere_or(|| format!("{n} {what}, found {i}"))?;
            this.s.integer(span, what)
        };
        for i in 0..n {
            let sides = word(self, i)?;
            if sides < 0 || sides as u64 > size {
                let given = format!("{sides} for cell {i} (0-based)");
                return Err(self.s.malformed_text("a number of nodes", given, "correct the list of cells"));
            }
            for _ in 0..sides {
                let given = word(self, i)?;
                list.nodes.push(self.s.checked_index(given, 0, count, "point")?);
            }
            list.ends.push(list.nodes.len());
        }
        let found = list.nodes.len() as u64 + n;
        if found != size {
            let given = format!("{found} in the list");
            return Err(self.s.malformed_text(
                format!("{size} numbers for {n} {what}"),
                given,
                "correct the header or the list",
            ));
        }
        Ok(list)
    }

    fn read_split_cells(&mut self, n_offsets: u64, size: u64, what: &str) -> Result<CellList, ReadError> {
        let mut list = CellList::default();
        if n_offsets == 0 {
            return Ok(list);
        }
        let keyword = |this: &mut Self, name: &str| -> Result<Scalar, ReadError> {
            let span = this.s.need_word_anywhere(&format!("`{name}`"))?;
            if !this.s.text(span).eq_ignore_ascii_case(name.as_bytes()) {
                return Err(this.s.malformed(format!("`{name}` (version 5 layout)"), span, "repair the section"));
            }
            this.scalar_on_line()
        };
        let scalar = keyword(self, "OFFSETS")?;
        let offsets = self.whole_values(n_offsets, scalar, "offsets")?;
        let scalar = keyword(self, "CONNECTIVITY")?;
        let nodes = self.whole_values(size, scalar, what)?;
        let rising = offsets.windows(2).all(|w| w[0] <= w[1]);
        if offsets.first() != Some(&0) || !rising || offsets.last() != Some(&(nodes.len() as i64)) {
            let given = "others".to_owned();
            return Err(self.s.malformed_text(format!("offsets rising from 0 to {size}"), given, "repair the section"));
        }
        let count = self.out.point_count();
        list.nodes = nodes.iter().map(|&v| self.s.checked_index(v, 0, count, "point")).collect::<Result<_, _>>()?;
        list.ends = offsets[1..].iter().map(|&o| o as usize).collect();
        Ok(list)
    }

    fn read_types(&mut self) -> Result<Vec<u8>, ReadError> {
        let n = self.count_on_line("cell types")?;
        let types = self.whole_values(n, Scalar::I32, "cell types")?;
        // Unknown types are counted later; 255 stands for all beyond a byte.
        Ok(types.into_iter().map(|t| u8::try_from(t).unwrap_or(255)).collect())
    }

    /// Sorts the cells by kind; called once, before the first array on cells or at the end.
    fn place_cells(&mut self) -> Result<(), ReadError> {
        let mut slots = Vec::new();
        if let Some(list) = self.cells.take() {
            let types = self.types.take().ok_or_else(|| self.s.truncated("a section CELL_TYPES"))?;
            if types.len() != list.ends.len() {
                let expected = format!("{} cell types", list.ends.len());
                return Err(self.s.malformed_text(expected, format!("{}", types.len()), "one type for each cell"));
            }
            for (i, (nodes, &cell_type)) in list.iter().zip(&types).enumerate() {
                let slot = cells::add(&mut self.out, cell_type, nodes).map_err(|expected| {
                    let given = format!("{} for cell {i} (0-based)", nodes.len());
                    self.s.malformed_text(expected, given, "correct CELLS or CELL_TYPES")
                })?;
                slots.push(slot);
            }
        }
        for (k, part) in std::mem::take(&mut self.parts).into_iter().enumerate() {
            let Some(list) = part else { continue };
            for (i, nodes) in list.iter().enumerate() {
                slots.push(if k == 2 {
                    cells::add(&mut self.out, cells::POLYGON, nodes).map_err(|expected| {
                        let given = format!("{} for polygon {i} (0-based)", nodes.len());
                        self.s.malformed_text(expected, given, "remove or complete the polygon")
                    })?
                } else {
                    self.out.ignore(["vertex cells", "line cells", "", "triangle strips"][k]);
                    Slot::Elsewhere
                });
            }
        }
        if !slots.is_empty() {
            self.slots = slots;
        }
        Ok(())
    }

    fn begin_data(&mut self, on: On) -> Result<(), ReadError> {
        self.on_count = self.count_on_line(if on == On::Points { "point values" } else { "cell values" })?;
        self.on = on;
        if on == On::Cells {
            self.place_cells()?;
        }
        Ok(())
    }

    /// An array of points or cells; false if it is of a kind that is not known, and the rest is not read.
    fn attribute(&mut self, keyword: &str, span: (usize, usize)) -> Result<bool, ReadError> {
        let n = self.on_count;
        match keyword {
            "FIELD" => self.read_field()?,
            "SCALARS" => {
                let name = self.name()?;
                let scalar = self.scalar_on_line()?;
                let components = match self.s.word() {
                    Some(span) => self.s.count(span, "components")?,
                    None => 1,
                };
                // A line `LOOKUP_TABLE name` follows; some writers leave it out.
                if let Some(span) = self.s.word_anywhere()? {
                    if self.s.text(span).eq_ignore_ascii_case(b"LOOKUP_TABLE") {
                        self.s.word();
                    } else if self.binary {
                        return Err(self.s.malformed(
                            "`LOOKUP_TABLE`",
                            span,
                            "it must follow SCALARS in a binary file",
                        ));
                    } else {
                        self.s.unread(span);
                    }
                }
                let values = self.values(n.saturating_mul(components), scalar, &name)?;
                self.keep(&name, components, &values);
            }
            "VECTORS" | "NORMALS" | "TENSORS" | "TENSORS6" | "GLOBAL_IDS" | "PEDIGREE_IDS" => {
                let name = self.name()?;
                let span = self.s.need_word("a VTK type")?;
                let Some(scalar) = Scalar::from_legacy_name(&self.s.string(span)) else {
                    return self.stop(keyword);
                };
                let components = match keyword {
                    "VECTORS" | "NORMALS" => 3,
                    "TENSORS" => 9,
                    "TENSORS6" => 6,
                    _ => 1,
                };
                let values = self.values(n.saturating_mul(components), scalar, &name)?;
                self.keep(&name, components, &values);
            }
            "TEXTURE_COORDINATES" => {
                let name = self.name()?;
                let components = self.count_on_line("components")?;
                let scalar = self.scalar_on_line()?;
                let values = self.values(n.saturating_mul(components), scalar, &name)?;
                self.keep(&name, components, &values);
            }
            "COLOR_SCALARS" => {
                let name = self.name()?;
                let components = self.count_on_line("components")?;
                let scalar = if self.binary { Scalar::U8 } else { Scalar::F32 };
                self.values(n.saturating_mul(components), scalar, &name)?;
            }
            "LOOKUP_TABLE" => {
                let name = self.name()?;
                let entries = self.count_on_line("colours")?;
                let scalar = if self.binary { Scalar::U8 } else { Scalar::F32 };
                self.values(entries.saturating_mul(4), scalar, &name)?;
            }
            _ if self.on == On::Nothing => {
                return Err(self.s.malformed(
                    "a section of legacy VTK",
                    span,
                    "correct the counts of the section before",
                ));
            }
            _ => return self.stop(keyword),
        }
        Ok(true)
    }

    fn stop(&mut self, keyword: &str) -> Result<bool, ReadError> {
        let line = self.s.line_number();
        self.out.note(format!("data from line {line} on ({}) is not read", snippet(keyword.as_bytes())));
        Ok(false)
    }

    fn name(&mut self) -> Result<String, ReadError> {
        let span = self.s.need_word("the name of the array")?;
        Ok(decode_name(self.s.text(span)))
    }

    fn read_field(&mut self) -> Result<(), ReadError> {
        self.name()?;
        let n = self.count_on_line("arrays")?;
        for i in 0..n {
            let missing = format!("{n} arrays, found {i}");
            let mut span = self.s.need_word_anywhere(&missing)?;
            if self.s.text(span) == b"METADATA" {
                self.skip_metadata()?;
                span = self.s.need_word_anywhere(&missing)?;
            }
            let name = decode_name(self.s.text(span));
            let components = self.count_on_line("components")?;
            let tuples = self.count_on_line("tuples")?;
            let span = self.s.need_word("a VTK type")?;
            if self.s.text(span) == b"string" {
                if self.binary {
                    return Err(self.s.unsupported("an array of strings in a binary file", "remove the array"));
                }
                for _ in 0..components.saturating_mul(tuples) {
                    if !self.s.next_line()? {
                        return Err(self.s.truncated(format!("the strings of `{name}`")));
                    }
                }
                self.s.next_line()?;
                continue;
            }
            let Some(scalar) = Scalar::from_legacy_name(&self.s.string(span)) else {
                return Err(self.s.malformed("a VTK type such as `double` or `int`", span, "use a numeric type"));
            };
            let values = self.values(components.saturating_mul(tuples), scalar, &name)?;
            self.keep(&name, components, &values);
        }
        Ok(())
    }

    fn keep(&mut self, name: &str, components: u64, values: &Values) {
        let components = usize::try_from(components).unwrap_or(usize::MAX);
        match self.on {
            // Data of the file as a whole, such as the time.
            On::Nothing => self.out.field(name, components, values),
            On::Points => self.out.point_array(name, components, values),
            On::Cells => self.out.cell_array(name, components, values, &self.slots),
        }
    }

    /// METADATA ends with an empty line.
    fn skip_metadata(&mut self) -> Result<(), ReadError> {
        while self.s.next_line()? {
            if self.s.line().trim_ascii().is_empty() {
                break;
            }
        }
        Ok(())
    }
}
