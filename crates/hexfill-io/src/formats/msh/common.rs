//! What versions 2.2 and 4.1 share: element types, node numbers, sections that are read alike.
//!
//! Source: the Gmsh manual, "MSH file format".

use crate::assembly::{Assembly, Slot, Values};
use crate::data::MeshData;
use crate::error::ReadError;
use crate::groups::{Combination, Groups, NONE};
use crate::numbers::{NodeNumbers, Numbers};
use crate::orders::{GMSH_HEX20, reorder};
use crate::quadratic::{written_faces, written_hexes};
use crate::source::{Source, Span};
use rustc_hash::FxHashSet;
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
const QUAD8: i64 = 16;
const HEX20: i64 = 17;

/// Name of the physical group of what has no tag, where all must have one.
pub(crate) const UNTAGGED: &str = "untagged";

/// Number of nodes of an element type, if it is known.
pub(crate) fn nodes_of(element_type: i64) -> Option<usize> {
    let high = [(36, 16), (37, 25), (47, 49), (92, 64), (93, 125)];
    if let Some((_, n)) = high.iter().find(|(t, _)| *t == element_type) {
        return Some(*n);
    }
    usize::try_from(element_type).ok().and_then(|t| NODES.get(t)).copied().filter(|&n| n > 0)
}

/// The straight type of an element type of higher order, whose corners come first, and their number.
pub(crate) fn straight(element_type: i64) -> (i64, usize) {
    match element_type {
        9 | 20 | 21 | 22 | 23 | 24 | 25 => (TRIANGLE, 3),
        10 | 16 | 36 | 37 | 47 => (QUAD, 4),
        11 | 29 | 30 | 31 => (TET, 4),
        12 | 17 | 92 | 93 => (HEX, 8),
        13 | 18 => (WEDGE, 6),
        14 | 19 => (PYRAMID, 5),
        _ => (element_type, usize::MAX),
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

impl<'r> Reader<'r> {
    /// Behind the header.
    pub(crate) fn new(s: Source<'r>, binary: Option<bool>) -> Self {
        Self {
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
        }
    }
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
            // The message counts the numbers of the file where they are simple.
            let range = self.nodes.simple_range();
            match range.map(|(first, count)| self.s.checked_index(number, first, count, "node")) {
                Some(Err(e)) => e,
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
    pub(crate) fn groups_as_tags(&mut self) {
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
        let (element_type, corners) = straight(element_type);
        let nodes = self.out.corners(nodes, corners);
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
    pub(crate) fn entities_as_tags(&mut self) {
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
    let faces = written_faces(data).map(|(face, tag)| {
        let element_type = match face.len() {
            3 => TRIANGLE,
            8 => QUAD8,
            _ => QUAD,
        };
        (element_type, face, tag)
    });
    let hexes = written_hexes(data).map(|(hex, tag)| (if hex.len() == 20 { HEX20 } else { HEX }, hex, tag));
    let tets = data.tets.iter().map(|c| (TET, c.as_slice(), 0));
    let wedges = data.wedges.iter().map(|c| (WEDGE, c.as_slice(), 0));
    let pyramids = data.pyramids.iter().map(|c| (PYRAMID, c.as_slice(), 0));
    faces.chain(hexes).chain(tets).chain(wedges).chain(pyramids)
}

/// Writes the nodes of an element in the order of Gmsh, counted from 1.
pub(crate) fn write_nodes(out: &mut dyn Write, nodes: &[u32], numbers: &NodeNumbers) -> io::Result<()> {
    let mut write = |nodes: &[u32]| nodes.iter().try_for_each(|&v| write!(out, " {}", numbers.of(v as usize)));
    match <[u32; 20]>::try_from(nodes) {
        Ok(nodes) => write(&reorder(nodes, GMSH_HEX20)),
        Err(_) => write(nodes),
    }
}

/// Dimension of an element type (0 for those that are passed over).
pub(crate) fn dimension(element_type: i64) -> u8 {
    match straight(element_type).0 {
        1 | 15 => 0,
        TRIANGLE | QUAD => 2,
        _ => 3,
    }
}
