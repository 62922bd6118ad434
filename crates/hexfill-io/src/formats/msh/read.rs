//! The header, which tells the version, and what a whole file must have.
//!
//! Source: the Gmsh manual, "MSH file format".

use super::common::{Reader, skip};
use super::{v2, v4};
use crate::data::MeshData;
use crate::error::{ReadError, snippet};
use crate::format::Format;
use crate::source::Source;

pub(crate) fn read(mut s: Source<'_>) -> Result<MeshData, ReadError> {
    let asked = s.format();
    to_header(&mut s)?;
    if !s.next_full_line()? {
        return Err(s.truncated("the version"));
    }
    let span = s.need_word("the version")?;
    let version = s.string(span);
    let span = s.need_word("0 (ASCII) or 1 (binary)")?;
    let is_binary = s.integer(span, "the file type")? != 0;
    let format = match version.as_str() {
        "2" | "2.0" | "2.1" | "2.2" => Format::Msh22,
        "4.1" => Format::Msh41,
        _ => {
            let remedy = "save it as version 2.2 or 4.1 (gmsh -save -format msh41)";
            return Err(s.unsupported(format!("Gmsh MSH {}", snippet(version.as_bytes())), remedy));
        }
    };
    s.set_format(format);
    let binary = is_binary.then(|| is_reversed(&mut s)).transpose()?;
    let mut reader = Reader::new(s, binary);
    let flavour = if is_binary { "binary" } else { "ASCII" };
    reader.out.note(format!("read as {} ({flavour}), not ANSYS/Fluent", format.title()));
    if asked != format && asked != Format::Msh22 {
        reader.out.note(format!("{} was asked for, but the file says version {version}", asked.title()));
    }
    reader.close("MeshFormat")?;
    if format == Format::Msh41 {
        v4::sections(&mut reader)?;
    } else {
        v2::sections(&mut reader)?;
    }
    if !reader.has_nodes {
        return Err(reader.s.truncated("a section $Nodes"));
    }
    if !reader.has_elements {
        return Err(reader.s.truncated("a section $Elements"));
    }
    reader.groups_as_tags();
    reader.entities_as_tags();
    let mut mesh = reader.out.finish();
    reader.nodes.keep(&mut mesh);
    Ok(mesh)
}

/// To the line behind `$MeshFormat`. Comments may come before it.
fn to_header(s: &mut Source<'_>) -> Result<(), ReadError> {
    loop {
        if !s.next_full_line()? {
            return Err(s.empty());
        }
        let line = s.line().trim_ascii();
        if line == b"$MeshFormat" {
            return Ok(());
        }
        if line == b"$Comments" {
            skip(s, "Comments")?;
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
}

/// Whether the bytes of a binary file must be reversed.
fn is_reversed(s: &mut Source<'_>) -> Result<bool, ReadError> {
    let mut one = [0; 4];
    s.exact(&mut one, "the number 1 that shows the byte order")?;
    match (u32::from_le_bytes(one), u32::from_be_bytes(one)) {
        (1, _) => Ok(false),
        (_, 1) => Ok(true),
        _ => Err(s.malformed_text("the number 1 in binary", "another".to_owned(), "the file is damaged")),
    }
}
