//! MSH 2.2: nodes with numbers, elements with numbers and two tags (physical group, elementary entity).
//!
//! Source: the Gmsh manual, "MSH file format version 2".

use super::common::{Reader, dimension, elements, nodes_of, write_nodes};
use super::physical::Physical;
use super::sections::{Layout, write_data};
use crate::data::MeshData;
use crate::error::ReadError;
use crate::groups::Combination;
use crate::numbers::NodeNumbers;
use crate::source::reserve;
use crate::write::write_point;
use std::collections::BTreeMap;
use std::fmt::Display;
use std::io::{self, Write};

pub(crate) fn sections(r: &mut Reader<'_>) -> Result<(), ReadError> {
    while let Some(name) = r.next_section()? {
        match name.as_str() {
            "Nodes" => {
                r.refuse_repetition("Nodes")?;
                read_nodes(r)?;
            }
            "Elements" => {
                r.refuse_repetition("Elements")?;
                read_elements(r)?;
            }
            "PhysicalNames" => r.read_names()?,
            "NodeData" | "ElementData" | "ElementNodeData" => r.read_data(&name)?,
            _ => r.skip_section(&name)?,
        }
    }
    Ok(())
}

fn int(r: &mut Reader<'_>, reversed: bool, what: impl Display) -> Result<i64, ReadError> {
    let mut bytes = [0; 4];
    r.s.exact(&mut bytes, what)?;
    Ok(i64::from(if reversed { i32::from_be_bytes(bytes) } else { i32::from_le_bytes(bytes) }))
}

fn read_nodes(r: &mut Reader<'_>) -> Result<(), ReadError> {
    r.need_line(1, "the number of nodes", 0)?;
    let n = r.count("nodes")?;
    r.out.mesh.points.reserve(reserve(n));
    r.s.set_binary(r.binary.is_some());
    for i in 0..n {
        if let Some(reversed) = r.binary {
            let missing = format_args!("{n} nodes, found {i}");
            let number = int(r, reversed, missing)?;
            let mut point = [0.0; 3];
            for (slot, axis) in point.iter_mut().zip(["x", "y", "z"]) {
                let mut bytes = [0; 8];
                r.s.exact(&mut bytes, missing)?;
                *slot = if reversed { f64::from_be_bytes(bytes) } else { f64::from_le_bytes(bytes) };
                if !slot.is_finite() {
                    let (at, what) = (r.s.place(), format!("{axis} of node {number}"));
                    return Err(ReadError::NotFinite { at, what, given: slot.to_string() });
                }
            }
            r.add_node(number, point)?;
        } else {
            r.need_line(n, "nodes", i)?;
            let number = r.integer("a node number")?;
            let point = r.s.point_on_line()?;
            r.add_node(number, point)?;
        }
    }
    r.s.set_binary(false);
    r.close("Nodes")
}

fn read_elements(r: &mut Reader<'_>) -> Result<(), ReadError> {
    r.need_line(1, "the number of elements", 0)?;
    let n = r.count("elements")?;
    if let Some(reversed) = r.binary {
        r.s.set_binary(true);
        read_binary_elements(r, n, reversed)?;
        r.s.set_binary(false);
        return r.close("Elements");
    }
    let mut nodes = Vec::new();
    for i in 0..n {
        r.need_line(n, "elements", i)?;
        let number = r.integer("an element number")?;
        let element_type = r.integer("an element type")?;
        let n_tags = r.count("tags")?;
        let mut tags = [0; 2];
        for k in 0..n_tags {
            let tag = r.integer("a tag")?;
            if let Some(slot) = tags.get_mut(k as usize) {
                *slot = tag;
            }
        }
        nodes.clear();
        match nodes_of(element_type) {
            Some(count) => {
                for _ in 0..count {
                    nodes.push(r.node_word()?);
                }
                if let Some(span) = r.s.peek_word() {
                    let expected = format!("{count} nodes for element type {element_type}");
                    return Err(r.s.malformed(expected, span, "correct the type or the number of tags"));
                }
            }
            None if element_type <= 0 => {
                let given = element_type.to_string();
                return Err(r.s.malformed_text("an element type of Gmsh", given, "correct the line"));
            }
            None => {} // a type of higher order: the line is passed over
        }
        let combination = group(r, element_type, tags[0]);
        r.add_element(number, element_type, &nodes, combination, tags[1]);
    }
    r.close("Elements")
}

/// The physical group of an element, by its number.
fn group(r: &mut Reader<'_>, element_type: i64, number: i64) -> Combination {
    r.combination(i64::from(dimension(element_type)), &[number])
}

fn read_binary_elements(r: &mut Reader<'_>, n: u64, reversed: bool) -> Result<(), ReadError> {
    let mut nodes = Vec::new();
    let mut done = 0;
    while done < n {
        let missing = format!("{n} elements, found {done}");
        let element_type = int(r, reversed, &missing)?;
        let count = int(r, reversed, &missing)?;
        let n_tags = int(r, reversed, &missing)?;
        let (Some(n_nodes), true) = (nodes_of(element_type), count > 0 && (0..=1000).contains(&n_tags)) else {
            let given = format!("type {element_type}, {count} elements, {n_tags} tags");
            return Err(r.s.malformed_text("the header of a block of elements", given, "the file is damaged"));
        };
        for _ in 0..count {
            let number = int(r, reversed, &missing)?;
            let mut tags = [0; 2];
            for k in 0..n_tags {
                let tag = int(r, reversed, &missing)?;
                if let Some(slot) = tags.get_mut(k as usize) {
                    *slot = tag;
                }
            }
            nodes.clear();
            for _ in 0..n_nodes {
                let number = int(r, reversed, &missing)?;
                nodes.push(r.node(number)?);
            }
            let combination = group(r, element_type, tags[0]);
            r.add_element(number, element_type, &nodes, combination, tags[1]);
            done += 1;
        }
    }
    Ok(())
}

/// The largest number of a node: Gmsh reads them as `int`.
const MOST: u64 = 2_147_483_647;

pub(crate) fn write(out: &mut dyn Write, data: &MeshData) -> io::Result<()> {
    writeln!(out, "$MeshFormat\n2.2 0 8\n$EndMeshFormat")?;
    Physical::new(data, false, false).write_names(out)?;
    writeln!(out, "$Nodes\n{}", data.points.len())?;
    let numbers = NodeNumbers::new(data, MOST);
    for (i, point) in data.points.iter().enumerate() {
        write!(out, "{} ", numbers.of(i))?;
        write_point(out, point, " ")?;
        out.write_all(b"\n")?;
    }
    writeln!(out, "$EndNodes\n$Elements\n{}", data.face_count() + data.cell_count())?;
    // One elementary entity for each tag of each dimension, numbered from 1.
    let mut entities: BTreeMap<(u8, i64), usize> =
        elements(data).map(|(element_type, _, tag)| ((dimension(element_type), tag), 0)).collect();
    let mut last = [0; 4];
    for ((dim, _), entity) in &mut entities {
        last[usize::from(*dim)] += 1;
        *entity = last[usize::from(*dim)];
    }
    for (i, (element_type, nodes, tag)) in elements(data).enumerate() {
        let entity = entities[&(dimension(element_type), tag)];
        write!(out, "{} {element_type} 2 {tag} {entity}", i + 1)?;
        write_nodes(out, nodes, &numbers)?;
        out.write_all(b"\n")?;
    }
    writeln!(out, "$EndElements")?;
    write_data(out, data, &numbers, Layout::NodesOfElements)
}
