//! What versions 2.2 and 4.1 share: header, element types, node numbers, data sections.

use super::{v2, v4};
use crate::arrays::{self, CellColumn, component};
use crate::assembly::{Assembly, Slot, Values};
use crate::data::{MeshData, TagOn};
use crate::error::{ReadError, snippet};
use crate::format::Format;
use crate::groups::{Combination, Groups, NONE, carried};
use crate::source::{Source, Span};
use crate::write::{Real, unquoted};
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::BTreeMap;
use std::io::{self, Write};

/// Numbers of nodes of Gmsh's element types 1 to 31 (0: no such type here).
const NODES: [usize; 32] =
    [0, 2, 3, 4, 4, 8, 6, 5, 3, 6, 9, 10, 27, 18, 14, 1, 8, 20, 15, 13, 9, 10, 12, 15, 15, 21, 4, 5, 6, 20, 35, 56];

pub(crate) const TRIANGLE: i64 = 2;
pub(crate) const QUAD: i64 = 3;
pub(crate) const TET: i64 = 4;
pub(crate) const HEX: i64 = 5;
pub(crate) const WEDGE: i64 = 6;
pub(crate) const PYRAMID: i64 = 7;

/// Number of nodes of an element type, if it is known.
pub(crate) fn nodes_of(element_type: i64) -> Option<usize> {
    usize::try_from(element_type).ok().and_then(|t| NODES.get(t)).copied().filter(|&n| n > 0)
}

/// From the numbers of a file to positions in it. Numbers that simply count up cost nothing.
#[derive(Default)]
pub(crate) struct Numbers {
    first: i64,
    count: u32,
    map: Option<FxHashMap<i64, u32>>,
}

impl Numbers {
    /// Adds the next number; false if it is there already (it then means the last one).
    pub(crate) fn push(&mut self, number: i64) -> bool {
        if self.count == 0 {
            self.first = number;
        }
        if self.map.is_none() && number != self.first.wrapping_add(i64::from(self.count)) {
            let first = self.first;
            self.map = Some((0..self.count).map(|i| (first.wrapping_add(i64::from(i)), i)).collect());
        }
        let known = self.map.as_mut().is_some_and(|map| map.insert(number, self.count).is_some());
        self.count += 1;
        !known
    }

    pub(crate) fn get(&self, number: i64) -> Option<u32> {
        match &self.map {
            Some(map) => map.get(&number).copied(),
            None => u32::try_from(number.checked_sub(self.first)?).ok().filter(|&i| i < self.count),
        }
    }
}

/// A file being read.
pub(crate) struct Reader<'r> {
    pub(crate) s: Source<'r>,
    pub(crate) out: Assembly,
    pub(crate) nodes: Numbers,
    pub(crate) elements: Numbers,
    /// Per element, in order of the file: where it went.
    pub(crate) slots: Vec<Slot>,
    /// Per element: elementary entity.
    pub(crate) entities: Vec<i64>,
    /// Physical groups of faces and of cells, and per element the combination it is in.
    groups: [Groups; 2],
    combinations: Vec<Combination>,
    /// Physical groups (dimension, number) that stand for "no group".
    untagged: FxHashSet<(i64, i64)>,
    /// Binary file, and whether its bytes must be reversed.
    pub(crate) binary: Option<bool>,
    pub(crate) has_nodes: bool,
    pub(crate) has_elements: bool,
}

pub(crate) fn read(mut s: Source<'_>) -> Result<MeshData, ReadError> {
    let asked = s.format();
    // Comments may come before the header.
    loop {
        if !s.next_full_line()? {
            return Err(s.empty());
        }
        let line = s.line().trim_ascii();
        if line == b"$MeshFormat" {
            break;
        }
        if line == b"$Comments" {
            skip(&mut s, "Comments")?;
            continue;
        }
        if line == b"$NOD" {
            return Err(s.unsupported("Gmsh MSH 1", "save it as version 2.2 or 4.1 (gmsh -save -format msh22)"));
        }
        if line.starts_with(b"(") {
            let remedy = "save it as Gmsh 2.2 or 4.1 (`gmsh:` formats), VTK or MEDIT";
            return Err(s.unsupported("an ANSYS/Fluent .msh (this is not a Gmsh file)", remedy));
        }
        let given = snippet(line);
        return Err(s.malformed_text(
            "`$MeshFormat`",
            given,
            "is this a Gmsh file? name the format if the extension is wrong",
        ));
    }
    if !s.next_full_line()? {
        return Err(s.truncated("the version"));
    }
    let span = s.need_word("the version")?;
    let version = s.string(span);
    let span = s.need_word("0 (ASCII) or 1 (binary)")?;
    let is_binary = s.integer(span, "the file type")? != 0;
    let v4 = match version.as_str() {
        "2" | "2.0" | "2.1" | "2.2" => false,
        "4.1" => true,
        _ => {
            let remedy = "save it as version 2.2 or 4.1 (gmsh -save -format msh41)";
            return Err(s.unsupported(format!("Gmsh MSH {}", snippet(version.as_bytes())), remedy));
        }
    };
    let format = if v4 { Format::Msh41 } else { Format::Msh22 };
    s.set_format(format);
    let mut binary = None;
    if is_binary {
        let mut one = [0; 4];
        s.exact(&mut one, "the number 1 that shows the byte order")?;
        binary = Some(match (u32::from_le_bytes(one), u32::from_be_bytes(one)) {
            (1, _) => false,
            (_, 1) => true,
            _ => return Err(s.malformed_text("the number 1 in binary", "another".to_owned(), "the file is damaged")),
        });
    }
    let mut reader = Reader {
        s,
        out: Assembly::default(),
        nodes: Numbers::default(),
        elements: Numbers::default(),
        slots: Vec::new(),
        entities: Vec::new(),
        groups: Default::default(),
        combinations: Vec::new(),
        untagged: FxHashSet::default(),
        binary,
        has_nodes: false,
        has_elements: false,
    };
    let flavour = if is_binary { "binary" } else { "ASCII" };
    reader.out.note(format!("read as {} ({flavour}), not ANSYS/Fluent", format.title()));
    if asked != format && asked != Format::Msh22 {
        reader.out.note(format!("{} was asked for, but the file says version {version}", asked.title()));
    }
    reader.close("MeshFormat")?;
    if v4 {
        v4::sections(&mut reader)?
    } else {
        v2::sections(&mut reader)?
    }
    if !reader.has_nodes {
        return Err(reader.s.truncated("a section $Nodes"));
    }
    if !reader.has_elements {
        return Err(reader.s.truncated("a section $Elements"));
    }
    reader.groups_as_tags();
    reader.entities_as_tags();
    Ok(reader.out.finish())
}

/// Skips to the end of a section.
pub(crate) fn skip(s: &mut Source<'_>, name: &str) -> Result<(), ReadError> {
    let end = format!("$End{name}");
    while s.next_line()? {
        if s.line().trim_ascii() == end.as_bytes() {
            return Ok(());
        }
    }
    Err(s.truncated(format!("`{end}`")))
}

impl Reader<'_> {
    /// The name of the next section, without its `$`; `None` at the end of the file.
    pub(crate) fn next_section(&mut self) -> Result<Option<String>, ReadError> {
        if !self.s.next_full_line()? {
            return Ok(None);
        }
        let span = self.s.need_word("a section")?;
        let name = self.s.string(span);
        match name.strip_prefix('$') {
            Some(name) if !name.starts_with("End") => Ok(Some(name.to_owned())),
            _ => Err(self.s.malformed(
                "the beginning of a section, `$...`",
                span,
                "correct the counts of the section before",
            )),
        }
    }

    /// Expects the end of a section.
    pub(crate) fn close(&mut self, name: &str) -> Result<(), ReadError> {
        if self.binary.is_some() {
            self.s.skip_line_end()?;
        }
        let end = format!("$End{name}");
        if !self.s.next_full_line()? {
            return Err(self.s.truncated(format!("`{end}`")));
        }
        let span = self.s.need_word(&end)?;
        if self.s.text(span) != end.as_bytes() {
            return Err(self.s.malformed(format!("`{end}`"), span, "correct the count of the section"));
        }
        Ok(())
    }

    pub(crate) fn refuse_repetition(&mut self, name: &str) -> Result<(), ReadError> {
        let seen = if name == "Nodes" { &mut self.has_nodes } else { &mut self.has_elements };
        if std::mem::replace(seen, true) {
            let given = format!("${name} again");
            return Err(self.s.malformed_text("each section once", given, "remove the repeated section"));
        }
        if name == "Elements" && !self.has_nodes {
            return Err(self.s.unsupported("$Elements before $Nodes", "put the nodes first"));
        }
        Ok(())
    }

    /// A line of the section, or an error that says how much of it there was.
    pub(crate) fn need_line(&mut self, n: u64, what: &str, i: u64) -> Result<(), ReadError> {
        if self.s.next_full_line()? {
            return Ok(());
        }
        Err(self.s.truncated(format!("{n} {what}, found {i}")))
    }

    /// The next whole number of the line.
    pub(crate) fn integer(&mut self, what: &str) -> Result<i64, ReadError> {
        let span = self.s.need_word(what)?;
        self.s.integer(span, what)
    }

    /// The next count of the line.
    pub(crate) fn count(&mut self, what: &str) -> Result<u64, ReadError> {
        let span = self.s.need_word(&format!("the number of {what}"))?;
        self.s.count(span, what)
    }

    pub(crate) fn add_node(&mut self, number: i64, point: [f64; 3]) -> Result<(), ReadError> {
        if !self.nodes.push(number) {
            let given = format!("{number} twice");
            return Err(self.s.malformed_text("node numbers that differ", given, "renumber the nodes"));
        }
        self.out.mesh.points.push(point);
        Ok(())
    }

    /// The position of a node number.
    pub(crate) fn node(&self, number: i64) -> Result<u32, ReadError> {
        self.nodes.get(number).ok_or_else(|| {
            let count = self.nodes.count as usize;
            // The message counts the numbers of the file where they are simple.
            match self.s.checked_index(number, self.nodes.first, count, "node") {
                Err(e) if self.nodes.map.is_none() => e,
                _ => {
                    self.s.malformed_text("the number of a node", format!("{number}, which no node has"), "correct it")
                }
            }
        })
    }

    pub(crate) fn node_word(&mut self) -> Result<u32, ReadError> {
        let span: Span = self.s.need_word("a node")?;
        let number = self.s.integer(span, "a node number")?;
        self.node(number)
    }

    /// `$PhysicalNames`: dimension, number and name of groups.
    pub(crate) fn read_names(&mut self) -> Result<(), ReadError> {
        self.need_line(1, "the number of names", 0)?;
        let n = self.count("names")?;
        for i in 0..n {
            self.need_line(n, "names", i)?;
            let (dim, number) = (self.integer("a dimension")?, self.integer("the number of a physical group")?);
            let name = String::from_utf8_lossy(self.s.rest()).trim_matches('"').to_owned();
            if name == UNTAGGED {
                self.untagged.insert((dim, number));
            } else if let 2 | 3 = dim {
                self.groups[dim as usize - 2].set_name(number, &name);
            }
        }
        self.close("PhysicalNames")
    }

    /// The combination of some physical groups of a dimension.
    pub(crate) fn combination(&mut self, dim: i64, physical: &[i64]) -> Combination {
        if dim != 2 && dim != 3 {
            return NONE;
        }
        let groups = &mut self.groups[dim as usize - 2];
        let named = physical.iter().filter(|&&number| number != 0 && !self.untagged.contains(&(dim, number)));
        named.fold(NONE, |combination, &number| {
            let group = groups.numbered(number);
            groups.join(combination, group)
        })
    }

    /// Faces and hexes get the tags of their groups.
    fn groups_as_tags(&mut self) {
        for (k, groups) in std::mem::take(&mut self.groups).iter().enumerate() {
            let of_kind = |slot: Slot| matches!(slot, Slot::Hex(_)) == (k == 1);
            let combinations: Vec<Combination> = self
                .slots
                .iter()
                .zip(&self.combinations)
                .map(|(&slot, &combination)| if of_kind(slot) { combination } else { NONE })
                .collect();
            self.out.tag_by_groups(&self.slots, &combinations, groups);
        }
    }

    /// Adds an element by its type.
    pub(crate) fn add_element(
        &mut self,
        number: i64,
        element_type: i64,
        nodes: &[u32],
        combination: Combination,
        entity: i64,
    ) {
        let slot = match (element_type, <[u32; 8]>::try_from(nodes)) {
            (HEX, Ok(hex)) => self.out.hex(hex, 0),
            (TRIANGLE | QUAD, _) => self.out.face(nodes, 0),
            (TET | WEDGE | PYRAMID, _) => {
                self.out.small_cell(nodes, i64::from(combination != NONE));
                Slot::Elsewhere
            }
            _ => {
                self.out.ignore(match element_type {
                    1 => "line elements",
                    15 => "point elements",
                    _ => "elements of higher order",
                });
                Slot::Elsewhere
            }
        };
        self.elements.push(number);
        self.slots.push(slot);
        self.combinations.push(combination);
        self.entities.push(entity);
    }

    /// Where no element has a physical group, entities are the tags, if faces or hexes have several.
    fn entities_as_tags(&mut self) {
        if self.slots.iter().any(|&slot| self.out.tag(slot) != 0) {
            return;
        }
        let kind = |slot: Slot| match slot {
            Slot::Quad(_) | Slot::OtherFace(_) => 0,
            Slot::Hex(_) => 1,
            Slot::Elsewhere => 2,
        };
        let mut first = [None; 3];
        let mut several = [false; 3];
        for (&slot, &entity) in self.slots.iter().zip(&self.entities) {
            let k = kind(slot);
            several[k] |= first[k].replace(entity).is_some_and(|e| e != entity);
        }
        if several[0] || several[1] {
            for (&slot, &entity) in self.slots.iter().zip(&self.entities) {
                if several[kind(slot)] && slot != Slot::Elsewhere {
                    self.out.set_tag(slot, entity);
                }
            }
            self.out.note("there are no physical groups: the elementary entities are read as tags");
        }
    }

    /// `$NodeData`, `$ElementData` or `$ElementNodeData` (the same in both versions); of the last the mean over the nodes is kept.
    pub(crate) fn read_data(&mut self, section: &str) -> Result<(), ReadError> {
        let mut name = String::new();
        let missing = "the tags of the data";
        let mut header = [0i64; 3];
        for part in 0..3 {
            self.need_line(1, missing, 0)?;
            let n = self.count("tags")?;
            for i in 0..n {
                self.need_line(n, "tags", i)?;
                if part == 0 && i == 0 {
                    name = String::from_utf8_lossy(self.s.line().trim_ascii()).trim_matches('"').to_owned();
                } else if part == 2 && i < 3 {
                    header[i as usize] = self.integer("a whole number")?;
                }
            }
        }
        let [_, components, count] = header;
        let limit = i64::from(u32::MAX);
        if !(0..=limit).contains(&components) || !(0..=limit).contains(&count) {
            let given = "negative or enormous ones".to_owned();
            return Err(self.s.malformed_text("counts in the data", given, "correct them"));
        }
        // Gmsh knows 1, 3 and 9 components.
        let kept = usize::try_from(components).ok().filter(|c| (1..=9).contains(c)).unwrap_or(0);
        let on_nodes = section == "NodeData";
        let n = if on_nodes { self.out.point_count() } else { self.slots.len() };
        let mut values = vec![f64::NAN; n * kept];
        let mut filled = 0usize;
        let mut mean = vec![0.0; kept];
        let mut at_first = vec![0.0; kept];
        for i in 0..count as u64 {
            if self.binary.is_none() {
                self.need_line(count as u64, "values", i)?;
            }
            let number = self.data_integer("a node or element number")?;
            let nodes = if section == "ElementNodeData" { self.data_integer("a number of nodes")?.max(1) } else { 1 };
            let mut alike = true;
            mean.fill(0.0);
            for node in 0..nodes {
                for k in 0..components as usize {
                    let value = self.data_value()?;
                    if k >= kept {
                        continue;
                    }
                    if node == 0 {
                        at_first[k] = value;
                    }
                    alike &= value.to_bits() == at_first[k].to_bits();
                    mean[k] += value / nodes as f64;
                }
            }
            // To the bit where the nodes agree.
            let value = if alike { &at_first } else { &mean };
            let numbers = if on_nodes { &self.nodes } else { &self.elements };
            if let Some(position) = numbers.get(number) {
                values[position as usize * kept..][..kept].copy_from_slice(value);
                filled += 1;
            }
        }
        self.close(section)?;
        if kept == 0 {
            self.out.note(format!("array `{name}` with {components} components is not kept"));
            return Ok(());
        }
        if filled < n && name == "tag" {
            // Points that are not named have no tag.
            values.iter_mut().filter(|v| v.is_nan()).for_each(|v| *v = 0.0);
        }
        if on_nodes {
            self.out.point_array(&name, kept, &Values::Real(values));
        } else {
            self.out.cell_array(&name, kept, &Values::Real(values), &self.slots);
        }
        Ok(())
    }

    fn data_integer(&mut self, what: &str) -> Result<i64, ReadError> {
        let Some(reversed) = self.binary else { return self.integer(what) };
        let mut four = [0; 4];
        self.s.exact(&mut four, "more data")?;
        Ok(i64::from(if reversed { i32::from_be_bytes(four) } else { i32::from_le_bytes(four) }))
    }

    fn data_value(&mut self) -> Result<f64, ReadError> {
        let Some(reversed) = self.binary else {
            let span = self.s.need_word("a value")?;
            return self.s.number(span, "a value");
        };
        let mut eight = [0; 8];
        self.s.exact(&mut eight, "more data")?;
        Ok(if reversed { f64::from_be_bytes(eight) } else { f64::from_le_bytes(eight) })
    }

    pub(crate) fn skip_section(&mut self, name: &str) -> Result<(), ReadError> {
        skip(&mut self.s, name)?;
        self.out.ignore(&format!("${name} sections"));
        Ok(())
    }
}

/// Elements in the order they are written: type, nodes, tag; faces, hexes, then the others.
pub(crate) fn elements(data: &MeshData) -> impl Iterator<Item = (i64, &[u32], i64)> {
    let faces = data.tagged_faces().map(|(f, tag)| (if f.len() == 3 { TRIANGLE } else { QUAD }, f, tag));
    let hexes = data.hexes.iter().enumerate().map(|(h, hex)| (HEX, hex.as_slice(), data.hex_tag(h)));
    let tets = data.tets.iter().map(|c| (TET, c.as_slice(), 0));
    let wedges = data.wedges.iter().map(|c| (WEDGE, c.as_slice(), 0));
    let pyramids = data.pyramids.iter().map(|c| (PYRAMID, c.as_slice(), 0));
    faces.chain(hexes).chain(tets).chain(wedges).chain(pyramids)
}

/// Dimension of an element type that is written.
pub(crate) fn dimension(element_type: i64) -> u8 {
    if element_type == TRIANGLE || element_type == QUAD { 2 } else { 3 }
}

/// Name of the physical group of what has no tag, where all must have one.
const UNTAGGED: &str = "untagged";

/// The physical groups of a mesh, per dimension and tag.
pub(crate) struct Physical {
    /// Numbers of the groups of each tag.
    numbers: BTreeMap<(u8, i64), Vec<i64>>,
    /// Names of groups.
    names: BTreeMap<(u8, i64), String>,
}

impl Physical {
    /// A tag is a group of its number; a tag with several names is in a group for each of them, if `overlap` is possible,
    /// otherwise its group has all the names. With `everywhere` what has no tag is in a group, too, where others have one:
    /// meshio reads no mesh whose elements are partly in groups.
    pub(crate) fn new(data: &MeshData, overlap: bool, everywhere: bool) -> Self {
        let tags: std::collections::BTreeSet<(u8, i64)> =
            elements(data).map(|(t, _, tag)| (dimension(t), tag)).collect();
        let mut physical = Self { numbers: BTreeMap::new(), names: BTreeMap::new() };
        // The group of a name is the tag that has no other name.
        let mut group_of: BTreeMap<(u8, &str), i64> = BTreeMap::new();
        let named = |dim: u8, tag: i64| {
            let on = if dim == 2 { TagOn::Faces } else { TagOn::Cells };
            data.tag_names.iter().filter(move |n| n.on == on && n.tag == tag).map(|n| n.name.as_str())
        };
        for &(dim, tag) in &tags {
            let names: Vec<&str> = named(dim, tag).collect();
            if let [name] = names[..]
                && carried(name).is_none()
            {
                group_of.entry((dim, name)).or_insert(tag);
            }
            if !names.is_empty() && (names.len() == 1 || !overlap) {
                physical.names.insert((dim, tag), names.join("+"));
            }
        }
        let mut next = tags.iter().map(|&(_, tag)| tag).max().unwrap_or(0).max(0);
        let mut fresh = || {
            next += 1;
            next
        };
        for &(dim, tag) in tags.iter().filter(|(_, tag)| *tag != 0) {
            let names: Vec<&str> = named(dim, tag).collect();
            let mut numbers = Vec::new();
            // The number of the tag itself goes to the first name that has no other.
            let mut own = Some(tag);
            for name in names.into_iter().filter(|_| overlap) {
                let number = || own.take().unwrap_or_else(&mut fresh);
                numbers.push(carried(name).unwrap_or_else(|| *group_of.entry((dim, name)).or_insert_with(number)));
            }
            if numbers.is_empty() {
                numbers.push(tag);
            }
            physical.numbers.insert((dim, tag), numbers);
        }
        for ((dim, name), number) in group_of {
            physical.names.entry((dim, number)).or_insert_with(|| name.to_owned());
        }
        if everywhere && tags.iter().any(|&(_, tag)| tag != 0) {
            for &(dim, _) in tags.iter().filter(|(_, tag)| *tag == 0) {
                let number = fresh();
                physical.numbers.insert((dim, 0), vec![number]);
                physical.names.insert((dim, number), UNTAGGED.to_owned());
            }
        }
        physical
    }

    /// The groups of a tag.
    pub(crate) fn of(&self, dim: u8, tag: i64) -> &[i64] {
        self.numbers.get(&(dim, tag)).map_or(&[], Vec::as_slice)
    }

    /// The section with the names.
    pub(crate) fn write_names(&self, out: &mut dyn Write) -> io::Result<()> {
        if self.names.is_empty() {
            return Ok(());
        }
        writeln!(out, "$PhysicalNames\n{}", self.names.len())?;
        for ((dim, number), name) in &self.names {
            writeln!(out, "{dim} {number} \"{}\"", unquoted(name))?;
        }
        writeln!(out, "$EndPhysicalNames")
    }
}

/// How numbers on elements are written.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Layout {
    /// One value for each element of the mesh.
    Elements,
    /// One value for each node of the elements that have any. meshio 5.3.5 passes this over; it reads no file of version 2.2 with
    /// `$ElementData` if there are several kinds of elements.
    NodesOfElements,
}

/// The data sections at the end of a file.
pub(crate) fn write_data(out: &mut dyn Write, data: &MeshData, several_kinds: Layout) -> io::Result<()> {
    if let Some(tags) = &data.point_tags {
        let values: Vec<f64> = tags.iter().map(|&t| t as f64).collect();
        write_on_points(out, "tag", &[&values])?;
    }
    for (name, columns) in arrays::on_points(data) {
        for (name, columns) in as_gmsh_has_them(name, columns) {
            write_on_points(out, &name, &columns)?;
        }
    }
    let mut types = elements(data).map(|(element_type, ..)| element_type);
    let first = types.next();
    let layout = if types.all(|t| Some(t) == first) { Layout::Elements } else { several_kinds };
    for (name, columns) in arrays::on_cells(data) {
        for (name, columns) in as_gmsh_has_them(name, columns) {
            match layout {
                Layout::Elements => write_on_elements(out, data, &name, &columns)?,
                Layout::NodesOfElements => write_on_nodes_of_elements(out, data, &name, &columns)?,
            }
        }
    }
    Ok(())
}

/// Arrays of other than 1, 3 or 9 components are written component by component.
fn as_gmsh_has_them<T: Copy>(name: &str, columns: Vec<T>) -> Vec<(String, Vec<T>)> {
    match columns.len() {
        1 | 3 | 9 => vec![(name.to_owned(), columns)],
        _ => columns.iter().enumerate().map(|(k, &column)| (component(name, k), vec![column])).collect(),
    }
}

fn begin(out: &mut dyn Write, section: &str, name: &str, components: usize, n: usize) -> io::Result<()> {
    // One text, one time, three numbers: time step, components, count.
    writeln!(out, "${section}\n1\n\"{}\"\n1\n0.0\n3\n0\n{components}\n{n}", unquoted(name))
}

fn write_on_points(out: &mut dyn Write, name: &str, columns: &[&[f64]]) -> io::Result<()> {
    let n = columns[0].len();
    begin(out, "NodeData", name, columns.len(), n)?;
    for i in 0..n {
        write!(out, "{}", i + 1)?;
        for column in columns {
            write!(out, " {}", Real(column[i]))?;
        }
        out.write_all(b"\n")?;
    }
    writeln!(out, "$EndNodeData")
}

fn write_on_elements(out: &mut dyn Write, data: &MeshData, name: &str, columns: &[CellColumn<'_>]) -> io::Result<()> {
    let n = data.face_count() + data.cell_count();
    begin(out, "ElementData", name, columns.len(), n)?;
    let mut values: Vec<_> = columns.iter().map(|c| c.all()).collect();
    for i in 0..n {
        write!(out, "{}", i + 1)?;
        for column in &mut values {
            write!(out, " {}", Real(column.next().unwrap_or(f64::NAN)))?;
        }
        out.write_all(b"\n")?;
    }
    writeln!(out, "$EndElementData")
}

fn write_on_nodes_of_elements(
    out: &mut dyn Write,
    data: &MeshData,
    name: &str,
    columns: &[CellColumn<'_>],
) -> io::Result<()> {
    let on = columns.iter().map(|c| c.on()).fold((false, false), |a, b| (a.0 || b.0, a.1 || b.1));
    let n = data.quads.len() * usize::from(on.0) + data.hexes.len() * usize::from(on.1);
    begin(out, "ElementNodeData", name, columns.len(), n)?;
    let mut values: Vec<_> = columns.iter().map(|c| c.all()).collect();
    for (i, (element_type, nodes, _)) in elements(data).enumerate() {
        let value: Vec<Real> = values.iter_mut().map(|v| Real(v.next().unwrap_or(f64::NAN))).collect();
        if !(element_type == QUAD && on.0 || element_type == HEX && on.1) {
            continue;
        }
        write!(out, "{} {}", i + 1, nodes.len())?;
        for component in nodes.iter().flat_map(|_| &value) {
            write!(out, " {component}")?;
        }
        out.write_all(b"\n")?;
    }
    writeln!(out, "$EndElementNodeData")
}
