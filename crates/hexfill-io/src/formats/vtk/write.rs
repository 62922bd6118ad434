//! Writing legacy VTK, version 3.0: always an unstructured grid, faces first, then hexes and the other cells. Names of tags are
//! field data: for each name its tags and the dimensions of what they are on.
//!
//! Source: the VTK formats, "Simple Legacy Formats".

use super::cells;
use crate::arrays::{self, component};
use crate::data::MeshData;
use crate::write::{Real, encode_name, has_cell_tags, write_indices, write_point};
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
    // Gmsh wants the points right after the dataset; here it passes over fields.
    write_names(out, data, binary)?;
    let arrays = arrays::on_cells(data);
    if has_cell_tags(data) || !arrays.is_empty() {
        writeln!(out, "CELL_DATA {n}")?;
    }
    if has_cell_tags(data) {
        write_tags(out, cells::all(data).map(|(_, _, tag)| tag).collect(), binary)?;
    }
    for (name, columns) in arrays {
        write_array(out, name, columns.into_iter().map(|c| c.all().collect()).collect(), binary)?;
    }
    let arrays = arrays::on_points(data);
    if data.point_tags.is_some() || !arrays.is_empty() {
        writeln!(out, "POINT_DATA {}", data.points.len())?;
    }
    if let Some(tags) = &data.point_tags {
        write_tags(out, tags.clone(), binary)?;
    }
    for (name, columns) in arrays {
        write_array(out, name, columns.into_iter().map(<[f64]>::to_vec).collect(), binary)?;
    }
    Ok(())
}

fn write_names(out: &mut dyn Write, data: &MeshData, binary: bool) -> io::Result<()> {
    let fields = data.names_as_fields();
    if fields.is_empty() {
        return Ok(());
    }
    writeln!(out, "FIELD FieldData {}", fields.len())?;
    let wide = data.tag_names.iter().any(|n| i32::try_from(n.tag).is_err());
    for (name, rows) in fields {
        writeln!(out, "{} 2 {} {}", encode_name(name), rows.len(), if wide { "long" } else { "int" })?;
        for value in rows.into_iter().flatten() {
            whole(out, value, wide, binary)?;
        }
        end(out, binary)?;
    }
    Ok(())
}

fn write_tags(out: &mut dyn Write, tags: Vec<i64>, binary: bool) -> io::Result<()> {
    let wide = tags.iter().any(|&t| i32::try_from(t).is_err());
    begin(out, "tag", if wide { "long" } else { "int" })?;
    for tag in tags {
        whole(out, tag, wide, binary)?;
    }
    end(out, binary)
}

/// Three components are a vector, any other number is written component by component.
fn write_array(out: &mut dyn Write, name: &str, columns: Vec<Vec<f64>>, binary: bool) -> io::Result<()> {
    if let [x, y, z] = columns.as_slice() {
        writeln!(out, "VECTORS {} double", encode_name(name))?;
        for ((&x, &y), &z) in x.iter().zip(y).zip(z) {
            if binary {
                [x, y, z].into_iter().try_for_each(|value| real(out, value, true))?;
            } else {
                writeln!(out, "{} {} {}", Real(x), Real(y), Real(z))?;
            }
        }
        return end(out, binary);
    }
    let several = columns.len() > 1;
    for (k, values) in columns.into_iter().enumerate() {
        begin(out, &if several { component(name, k) } else { name.to_owned() }, "double")?;
        for value in values {
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
