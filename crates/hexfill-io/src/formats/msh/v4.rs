//! MSH 4.1: nodes and elements in blocks, each block on an entity; entities carry the physical groups.
//!
//! Source: the Gmsh manual, "MSH file format".

use super::common::{Reader, dimension, elements, nodes_of, write_nodes};
use super::physical::Physical;
use super::sections::{Layout, write_data};
use crate::data::MeshData;
use crate::error::ReadError;
use crate::numbers::NodeNumbers;
use crate::source::reserve;
use crate::write::{Real, write_point};
use rustc_hash::FxHashMap;
use std::collections::BTreeMap;
use std::io::{self, Write};

/// Physical groups of each entity (dimension, number).
type Groups = FxHashMap<(i64, i64), Vec<i64>>;

pub(crate) fn sections(r: &mut Reader<'_>) -> Result<(), ReadError> {
    let mut groups = Groups::default();
    while let Some(name) = r.next_section()? {
        r.s.set_binary(r.binary.is_some());
        match name.as_str() {
            "Entities" => read_entities(r, &mut groups)?,
            "Nodes" => {
                r.refuse_repetition("Nodes")?;
                read_nodes(r)?;
            }
            "Elements" => {
                r.refuse_repetition("Elements")?;
                read_elements(r, &groups)?;
            }
            "PhysicalNames" => {
                r.s.set_binary(false);
                r.read_names()?;
            }
            "NodeData" | "ElementData" | "ElementNodeData" => r.read_data(&name)?,
            "PartitionedEntities" => {
                r.out.note("the mesh is partitioned: physical groups of partitions are not read");
                r.skip_section(&name)?;
            }
            _ => r.skip_section(&name)?,
        }
        r.s.set_binary(false);
    }
    Ok(())
}

/// A number of a binary file.
fn packed<const N: usize>(r: &mut Reader<'_>, what: &str) -> Result<[u8; N], ReadError> {
    let mut bytes = [0; N];
    r.s.exact(&mut bytes, what)?;
    if r.binary == Some(true) {
        bytes.reverse();
    }
    Ok(bytes)
}

/// The next `int` (4 bytes), on the current line of an ASCII file.
fn int(r: &mut Reader<'_>, what: &str) -> Result<i64, ReadError> {
    if r.binary.is_some() {
        return Ok(i64::from(i32::from_le_bytes(packed(r, what)?)));
    }
    r.integer(what)
}

/// The next `size_t` (8 bytes), on the current line of an ASCII file.
fn size(r: &mut Reader<'_>, what: &str) -> Result<i64, ReadError> {
    if r.binary.is_some() {
        return Ok(i64::from_le_bytes(packed(r, what)?));
    }
    r.integer(what)
}

fn count(r: &mut Reader<'_>, what: &str) -> Result<u64, ReadError> {
    let given = size(r, &format!("the number of {what}"))?;
    match u64::try_from(given) {
        Ok(n) if n <= u64::from(u32::MAX) => Ok(n),
        Ok(given) => {
            let (at, what) = (r.s.place(), what.to_owned());
            Err(ReadError::TooLarge { at, what, given, limit: u64::from(u32::MAX) })
        }
        Err(_) => {
            Err(r.s.malformed_text(format!("the number of {what}"), given.to_string(), "a count is not negative"))
        }
    }
}

fn real(r: &mut Reader<'_>, what: &str) -> Result<f64, ReadError> {
    if r.binary.is_some() {
        return Ok(f64::from_le_bytes(packed(r, what)?));
    }
    let span = r.s.need_word(what)?;
    r.s.number(span, what)
}

/// Goes to the next line of an ASCII file.
fn line(r: &mut Reader<'_>, n: u64, what: &str, i: u64) -> Result<(), ReadError> {
    if r.binary.is_some() { Ok(()) } else { r.need_line(n, what, i) }
}

fn read_entities(r: &mut Reader<'_>, groups: &mut Groups) -> Result<(), ReadError> {
    line(r, 1, "the numbers of entities", 0)?;
    let mut counts = [0; 4];
    for slot in &mut counts {
        *slot = count(r, "entities")?;
    }
    for (dim, &n) in (0i64..).zip(&counts) {
        for i in 0..n {
            line(r, n, "entities", i)?;
            let number = int(r, "the number of the entity")?;
            for _ in 0..if dim == 0 { 3 } else { 6 } {
                real(r, "a coordinate of the box")?;
            }
            for _ in 0..count(r, "physical groups")? {
                let group = int(r, "a physical group")?;
                groups.entry((dim, number)).or_default().push(group);
            }
            if dim > 0 {
                for _ in 0..count(r, "bounding entities")? {
                    int(r, "a bounding entity")?;
                }
            }
        }
    }
    r.close("Entities")
}

fn read_nodes(r: &mut Reader<'_>) -> Result<(), ReadError> {
    line(r, 1, "the numbers of nodes", 0)?;
    let n_blocks = count(r, "blocks")?;
    let n = count(r, "nodes")?;
    size(r, "the smallest node number")?;
    size(r, "the largest node number")?;
    r.out.mesh.points.reserve(reserve(n));
    let mut numbers = Vec::new();
    for block in 0..n_blocks {
        line(r, n_blocks, "blocks of nodes", block)?;
        let dim = int(r, "the dimension of the entity")?;
        int(r, "the number of the entity")?;
        let parametric = int(r, "0 or 1 (parametric)")? != 0;
        let in_block = count(r, "nodes in the block")?;
        numbers.clear();
        for i in 0..in_block {
            line(r, in_block, "node numbers", i)?;
            numbers.push(size(r, "a node number")?);
        }
        for (i, &number) in (0u64..).zip(&numbers) {
            line(r, in_block, "nodes", i)?;
            let mut point = [0.0; 3];
            for (slot, axis) in point.iter_mut().zip(["x", "y", "z"]) {
                *slot = real(r, axis)?;
                if !slot.is_finite() {
                    let (at, what) = (r.s.place(), format!("{axis} of node {number}"));
                    return Err(ReadError::NotFinite { at, what, given: slot.to_string() });
                }
            }
            for _ in 0..if parametric { dim.clamp(0, 3) } else { 0 } {
                real(r, "a parameter")?;
            }
            r.add_node(number, point)?;
        }
    }
    let found = r.out.point_count() as u64;
    if found != n {
        // Gmsh 4.15 itself miscounts nodes on entities without a physical group; the blocks say how long they are.
        r.out.note(format!("$Nodes announces {n} nodes and has {found}"));
    }
    r.close("Nodes")
}

fn read_elements(r: &mut Reader<'_>, groups: &Groups) -> Result<(), ReadError> {
    line(r, 1, "the numbers of elements", 0)?;
    let n_blocks = count(r, "blocks")?;
    let n = count(r, "elements")?;
    size(r, "the smallest element number")?;
    size(r, "the largest element number")?;
    let mut nodes = Vec::new();
    for block in 0..n_blocks {
        line(r, n_blocks, "blocks of elements", block)?;
        let dim = int(r, "the dimension of the entity")?;
        let entity = int(r, "the number of the entity")?;
        let element_type = int(r, "the element type")?;
        let in_block = count(r, "elements in the block")?;
        let n_nodes = nodes_of(element_type);
        if n_nodes.is_none() && (element_type <= 0 || r.binary.is_some()) {
            let given = element_type.to_string();
            return Err(r.s.malformed_text("an element type of Gmsh", given, "correct the header of the block"));
        }
        let combination = r.combination(dim, groups.get(&(dim, entity)).map_or(&[], Vec::as_slice));
        for i in 0..in_block {
            line(r, in_block, "elements of the block", i)?;
            let number = size(r, "an element number")?;
            nodes.clear();
            for _ in 0..n_nodes.unwrap_or(0) {
                let node = size(r, "a node")?;
                nodes.push(r.node(node)?);
            }
            if r.binary.is_none()
                && n_nodes.is_some()
                && let Some(span) = r.s.peek_word()
            {
                let expected = format!("{} nodes for element type {element_type}", nodes.len());
                return Err(r.s.malformed(expected, span, "correct the header of the block"));
            }
            r.add_element(number, element_type, &nodes, combination, entity);
        }
    }
    let found = r.slots.len() as u64;
    if found != n {
        r.out.note(format!("$Elements announces {n} elements and has {found}"));
    }
    r.close("Elements")
}

/// The largest number of a node: whole numbers up to here are the same in floating point, as data on points.
const MOST: u64 = 1 << 53;

/// One entity for each tag of each dimension, numbered from 1 in each dimension.
struct Entities {
    numbers: BTreeMap<(u8, i64), usize>,
    /// How many there are of each dimension.
    count: [usize; 4],
    /// The dimension of the entity on which all nodes stand: the first of the highest dimension.
    home: u8,
}

impl Entities {
    fn new(data: &MeshData) -> Self {
        let mut numbers: BTreeMap<(u8, i64), usize> =
            elements(data).map(|(element_type, _, tag)| ((dimension(element_type), tag), 0)).collect();
        let mut count = [0usize; 4];
        for ((dim, _), entity) in &mut numbers {
            count[usize::from(*dim)] += 1;
            *entity = count[usize::from(*dim)];
        }
        let home = if count[3] > 0 || count[2] == 0 { 3 } else { 2 };
        if count[2] + count[3] == 0 {
            count[3] = 1;
            numbers.insert((3, 0), 1);
        }
        Self { numbers, count, home }
    }
}

pub(crate) fn write(out: &mut dyn Write, data: &MeshData) -> io::Result<()> {
    writeln!(out, "$MeshFormat\n4.1 0 8\n$EndMeshFormat")?;
    let physical = Physical::new(data, true, true);
    physical.write_names(out)?;
    let entities = Entities::new(data);
    write_entities(out, data, &physical, &entities)?;
    let numbers = NodeNumbers::new(data, MOST);
    write_all_nodes(out, data, &numbers, entities.home)?;
    write_elements(out, data, &numbers, &entities)?;
    write_data(out, data, &numbers, Layout::Elements)
}

fn write_entities(out: &mut dyn Write, data: &MeshData, physical: &Physical, entities: &Entities) -> io::Result<()> {
    let mut low = [0.0f64; 3];
    let mut high = [0.0f64; 3];
    if let Some(first) = data.points.first() {
        (low, high) = (*first, *first);
    }
    for point in &data.points {
        for axis in 0..3 {
            low[axis] = low[axis].min(point[axis]);
            high[axis] = high[axis].max(point[axis]);
        }
    }
    writeln!(out, "$Entities\n0 0 {} {}", entities.count[2], entities.count[3])?;
    for ((dim, tag), entity) in &entities.numbers {
        write!(out, "{entity}")?;
        for x in low.iter().chain(&high) {
            write!(out, " {}", Real(*x))?;
        }
        // Groups, then bounding entities (none).
        let groups = physical.of(*dim, *tag);
        write!(out, " {}", groups.len())?;
        for group in groups {
            write!(out, " {group}")?;
        }
        writeln!(out, " 0")?;
    }
    writeln!(out, "$EndEntities")
}

fn write_all_nodes(out: &mut dyn Write, data: &MeshData, numbers: &NodeNumbers, home: u8) -> io::Result<()> {
    let n = data.points.len();
    let [least, largest] = numbers.range(n);
    writeln!(out, "$Nodes\n{} {n} {least} {largest}", usize::from(n > 0))?;
    if n > 0 {
        writeln!(out, "{home} 1 0 {n}")?;
    }
    for i in 0..n {
        writeln!(out, "{}", numbers.of(i))?;
    }
    for point in &data.points {
        write_point(out, point, " ")?;
        out.write_all(b"\n")?;
    }
    writeln!(out, "$EndNodes")
}

fn write_elements(out: &mut dyn Write, data: &MeshData, numbers: &NodeNumbers, entities: &Entities) -> io::Result<()> {
    // A block for each run of elements of one type and tag keeps the order.
    let mut blocks: Vec<(i64, i64, usize)> = Vec::new();
    for (element_type, _, tag) in elements(data) {
        match blocks.last_mut() {
            Some((t, g, count)) if (*t, *g) == (element_type, tag) => *count += 1,
            _ => blocks.push((element_type, tag, 1)),
        }
    }
    let n = data.face_count() + data.cell_count();
    writeln!(out, "$Elements\n{} {n} {} {n}", blocks.len(), usize::from(n > 0))?;
    let mut all = elements(data).enumerate();
    for (element_type, tag, count) in blocks {
        let dim = dimension(element_type);
        writeln!(out, "{dim} {} {element_type} {count}", entities.numbers[&(dim, tag)])?;
        for (i, (_, nodes, _)) in all.by_ref().take(count) {
            write!(out, "{}", i + 1)?;
            write_nodes(out, nodes, numbers)?;
            out.write_all(b"\n")?;
        }
    }
    writeln!(out, "$EndElements")
}
