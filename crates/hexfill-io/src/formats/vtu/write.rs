//! Writing `.vtu`: one piece, arrays as ASCII (one point, one cell a line) or base64 in place. Names of tags are field data: for
//! each name its tags and the dimensions of what they are on.
//!
//! Source: the VTK formats, "XML File Formats".

use crate::arrays;
use crate::data::MeshData;
use crate::formats::vtk::cells;
use crate::write::{Real, has_cell_tags, write_indices, write_point};
use base64::engine::general_purpose::STANDARD;
use base64::write::EncoderWriter;
use std::io::{self, Write};

pub(crate) fn write(out: &mut dyn Write, data: &MeshData, binary: bool) -> io::Result<()> {
    let (n_points, n_cells) = (data.points.len(), data.face_count() + data.cell_count());
    writeln!(out, "<?xml version=\"1.0\"?>")?;
    writeln!(
        out,
        "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">"
    )?;
    writeln!(out, "<UnstructuredGrid>")?;
    write_names(out, data)?;
    writeln!(out, "<Piece NumberOfPoints=\"{n_points}\" NumberOfCells=\"{n_cells}\">")?;
    writeln!(out, "<Points>")?;
    let coordinates = data.points.iter().flatten();
    if binary {
        array(out, "Float64", "Points", 3, 24 * n_points, coordinates.map(|x| x.to_le_bytes()))?;
    } else {
        begin(out, "Float64", "Points", 3, "ascii")?;
        for point in &data.points {
            write_point(out, point, " ")?;
            out.write_all(b"\n")?;
        }
        end(out)?;
    }
    writeln!(out, "</Points>\n<Cells>")?;
    let n_nodes: usize = cells::all(data).map(|(_, nodes, _)| nodes.len()).sum();
    if binary {
        let nodes = cells::all(data).flat_map(|(_, nodes, _)| nodes).map(|&v| i64::from(v).to_le_bytes());
        array(out, "Int64", "connectivity", 1, 8 * n_nodes, nodes)?;
    } else {
        begin(out, "Int64", "connectivity", 1, "ascii")?;
        for (_, nodes, _) in cells::all(data) {
            write_indices(out, nodes, 0)?;
            out.write_all(b"\n")?;
        }
        end(out)?;
    }
    let mut end_of_cell = 0i64;
    let offsets = cells::all(data).map(|(_, nodes, _)| {
        end_of_cell += nodes.len() as i64;
        end_of_cell
    });
    wholes(out, "Int64", "offsets", n_cells, offsets, binary)?;
    if binary {
        array(out, "UInt8", "types", 1, n_cells, cells::all(data).map(|(t, _, _)| [t]))?;
    } else {
        wholes(out, "UInt8", "types", n_cells, cells::all(data).map(|(t, _, _)| i64::from(t)), false)?;
    }
    writeln!(out, "</Cells>\n<PointData>")?;
    if let Some(tags) = &data.point_tags {
        wholes(out, "Int64", "tag", n_points, tags.iter().copied(), binary)?;
    }
    for (name, columns) in arrays::on_points(data) {
        let values = columns.into_iter().map(|v| v.iter().copied()).collect();
        reals(out, name, n_points, values, binary)?;
    }
    writeln!(out, "</PointData>\n<CellData>")?;
    if has_cell_tags(data) {
        wholes(out, "Int64", "tag", n_cells, cells::all(data).map(|(_, _, tag)| tag), binary)?;
    }
    for (name, columns) in arrays::on_cells(data) {
        reals(out, name, n_cells, columns.into_iter().map(|c| c.all()).collect(), binary)?;
    }
    writeln!(out, "</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>")
}

/// A name as the value of an attribute.
fn escaped(name: &str) -> String {
    let mut escaped = String::new();
    for c in name.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            c if c.is_control() => escaped.push('_'),
            c => escaped.push(c),
        }
    }
    escaped
}

fn begin(out: &mut dyn Write, scalar: &str, name: &str, components: u32, format: &str) -> io::Result<()> {
    let escaped = escaped(name);
    writeln!(
        out,
        "<DataArray type=\"{scalar}\" Name=\"{escaped}\" NumberOfComponents=\"{components}\" format=\"{format}\">"
    )
}

fn end(out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "</DataArray>")
}

/// A base64 array: the number of bytes, then the bytes.
fn array<const N: usize>(
    out: &mut dyn Write,
    scalar: &str,
    name: &str,
    components: u32,
    bytes: usize,
    items: impl Iterator<Item = [u8; N]>,
) -> io::Result<()> {
    begin(out, scalar, name, components, "binary")?;
    let mut encoder = EncoderWriter::new(&mut *out, &STANDARD);
    encoder.write_all(&(bytes as u64).to_le_bytes())?;
    for item in items {
        encoder.write_all(&item)?;
    }
    encoder.finish()?;
    drop(encoder);
    out.write_all(b"\n")?;
    end(out)
}

fn wholes(
    out: &mut dyn Write,
    scalar: &str,
    name: &str,
    n: usize,
    items: impl Iterator<Item = i64>,
    binary: bool,
) -> io::Result<()> {
    if binary {
        return array(out, scalar, name, 1, 8 * n, items.map(i64::to_le_bytes));
    }
    begin(out, scalar, name, 1, "ascii")?;
    for item in items {
        writeln!(out, "{item}")?;
    }
    end(out)
}

/// An array of components given side by side, written value by value.
fn reals(
    out: &mut dyn Write,
    name: &str,
    n: usize,
    mut columns: Vec<impl Iterator<Item = f64>>,
    binary: bool,
) -> io::Result<()> {
    let components = columns.len();
    let mut row = || columns.iter_mut().map(|c| c.next().unwrap_or(f64::NAN)).collect::<Vec<f64>>();
    if binary {
        let values = (0..n).flat_map(|_| row()).map(f64::to_le_bytes);
        return array(out, "Float64", name, components as u32, 8 * n * components, values);
    }
    begin(out, "Float64", name, components as u32, "ascii")?;
    for _ in 0..n {
        let words: Vec<String> = row().into_iter().map(|x| Real(x).to_string()).collect();
        writeln!(out, "{}", words.join(" "))?;
    }
    end(out)
}

fn write_names(out: &mut dyn Write, data: &MeshData) -> io::Result<()> {
    let fields = data.names_as_fields();
    if fields.is_empty() {
        return Ok(());
    }
    writeln!(out, "<FieldData>")?;
    for (name, rows) in fields {
        let name = escaped(name);
        let n = rows.len();
        writeln!(
            out,
            "<DataArray type=\"Int64\" Name=\"{name}\" NumberOfComponents=\"2\" NumberOfTuples=\"{n}\" format=\"ascii\">"
        )?;
        for [tag, dimension] in rows {
            writeln!(out, "{tag} {dimension}")?;
        }
        end(out)?;
    }
    writeln!(out, "</FieldData>")
}
