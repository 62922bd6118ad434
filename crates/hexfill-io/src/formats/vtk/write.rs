//! Writing legacy VTK, version 3.0: always an unstructured grid, faces first, then hexes and the other cells.

use super::cells;
use crate::data::MeshData;
use crate::write::{Real, has_cell_tags, write_indices, write_point};
use std::io::{self, Write};

pub(crate) fn write(out: &mut dyn Write, data: &MeshData, binary: bool) -> io::Result<()> {
    writeln!(out, "# vtk DataFile Version 3.0\nhexfill")?;
    writeln!(out, "{}\nDATASET UNSTRUCTURED_GRID", if binary { "BINARY" } else { "ASCII" })?;
    writeln!(out, "POINTS {} double", data.points.len())?;
    for point in &data.points {
        if binary {
            for x in point {
                out.write_all(&x.to_be_bytes())?;
            }
        } else {
            write_point(out, point, " ")?;
            out.write_all(b"\n")?;
        }
    }
    end(out, binary)?;
    let n = data.face_count() + data.cell_count();
    let size: usize = cells::all(data).map(|(_, nodes, _)| nodes.len() + 1).sum();
    writeln!(out, "CELLS {n} {size}")?;
    for (_, nodes, _) in cells::all(data) {
        if binary {
            out.write_all(&(nodes.len() as u32).to_be_bytes())?;
            for node in nodes {
                out.write_all(&node.to_be_bytes())?;
            }
        } else {
            write!(out, "{}", nodes.len())?;
            write_indices(out, nodes, 0)?;
            out.write_all(b"\n")?;
        }
    }
    end(out, binary)?;
    writeln!(out, "CELL_TYPES {n}")?;
    for (cell_type, _, _) in cells::all(data) {
        whole(out, i64::from(cell_type), false, binary)?;
    }
    end(out, binary)?;
    if has_cell_tags(data) || !data.hex_data.is_empty() {
        writeln!(out, "CELL_DATA {n}")?;
    }
    if has_cell_tags(data) {
        let wide = cells::all(data).any(|(_, _, tag)| i32::try_from(tag).is_err());
        begin(out, "tag", if wide { "long" } else { "int" })?;
        for (_, _, tag) in cells::all(data) {
            whole(out, tag, wide, binary)?;
        }
        end(out, binary)?;
    }
    for (name, values) in &data.hex_data {
        begin(out, name, "double")?;
        for value in cells::spread(data, values) {
            real(out, value, binary)?;
        }
        end(out, binary)?;
    }
    if data.point_tags.is_some() || !data.point_data.is_empty() {
        writeln!(out, "POINT_DATA {}", data.points.len())?;
    }
    if let Some(tags) = &data.point_tags {
        let wide = tags.iter().any(|&t| i32::try_from(t).is_err());
        begin(out, "tag", if wide { "long" } else { "int" })?;
        for &tag in tags {
            whole(out, tag, wide, binary)?;
        }
        end(out, binary)?;
    }
    for (name, values) in &data.point_data {
        begin(out, name, "double")?;
        for &value in values {
            real(out, value, binary)?;
        }
        end(out, binary)?;
    }
    Ok(())
}

fn begin(out: &mut dyn Write, name: &str, scalar: &str) -> io::Result<()> {
    writeln!(out, "SCALARS {} {scalar} 1\nLOOKUP_TABLE default", encode_name(name))
}

fn end(out: &mut dyn Write, binary: bool) -> io::Result<()> {
    if binary { out.write_all(b"\n") } else { Ok(()) }
}

fn whole(out: &mut dyn Write, value: i64, wide: bool, binary: bool) -> io::Result<()> {
    match (binary, wide) {
        (false, _) => writeln!(out, "{value}"),
        (true, true) => out.write_all(&value.to_be_bytes()),
        (true, false) => out.write_all(&(value as i32).to_be_bytes()),
    }
}

fn real(out: &mut dyn Write, value: f64, binary: bool) -> io::Result<()> {
    if binary { out.write_all(&value.to_be_bytes()) } else { writeln!(out, "{}", Real(value)) }
}

/// Names are one word: VTK writes %20 for a blank.
fn encode_name(name: &str) -> String {
    let mut word = String::new();
    for &byte in name.as_bytes() {
        match byte {
            b'%' | b'"' | 0..=32 | 127.. => word.push_str(&format!("%{byte:02X}")),
            _ => word.push(char::from(byte)),
        }
    }
    if word.is_empty() { "unnamed".to_owned() } else { word }
}
