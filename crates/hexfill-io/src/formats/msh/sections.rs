//! Data sections of both versions, written.
//!
//! Source: the Gmsh manual, "MSH file format".

use super::common::{HEX, QUAD, elements, straight};
use crate::arrays::{self, CellColumn, component};
use crate::data::MeshData;
use crate::numbers::{NODE, NodeNumbers};
use crate::write::{Real, unquoted};
use std::io::{self, Write};

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
pub(crate) fn write_data(
    out: &mut dyn Write,
    data: &MeshData,
    numbers: &NodeNumbers,
    several_kinds: Layout,
) -> io::Result<()> {
    if let Some(tags) = &data.point_tags {
        let values: Vec<f64> = tags.iter().map(|&t| t as f64).collect();
        write_on_points(out, "tag", &[&values], numbers)?;
    }
    // Numbers of nodes stand where the nodes are.
    let is_said = |name: &str| name == NODE && numbers.are_given();
    for (name, columns) in arrays::on_points(data).into_iter().filter(|(name, _)| !is_said(name)) {
        for (name, columns) in as_gmsh_has_them(name, columns) {
            write_on_points(out, &name, &columns, numbers)?;
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

fn write_on_points(out: &mut dyn Write, name: &str, columns: &[&[f64]], numbers: &NodeNumbers) -> io::Result<()> {
    let n = columns[0].len();
    begin(out, "NodeData", name, columns.len(), n)?;
    for i in 0..n {
        write!(out, "{}", numbers.of(i))?;
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
        let element_type = straight(element_type).0;
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
