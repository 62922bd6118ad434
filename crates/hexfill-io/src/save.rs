//! Writing: checks first, then a temporary file beside the target, then a rename. Never half a file.
//!
//! Source: ours.

use crate::compress::Packer;
use crate::data::MeshData;
use crate::error::WriteError;
use crate::format::{Compression, Format, FormatError};
use crate::formats::{inp, json, medit, msh, nastran, obj, off, ovm, ply, unv, vtk, vtu};
use crate::write::check_tags;
use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// Text or binary numbers, for the formats that have both.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Encoding {
    /// Decimal numbers, which everything reads and which still are exact.
    #[default]
    Text,
    /// Binary: PLY (little-endian), legacy VTK (big-endian), VTU (base64 in place).
    Binary,
}

/// Writes a file as text. Without a `format` the extension decides; `.gz` and `.zst` pack the file.
///
/// The file appears whole or not at all: it is written beside the target and renamed. A target that is no regular
/// file (a device, a pipe) is written directly.
///
/// # Errors
/// [`WriteError`]; the target is then as it was before.
///
/// # Example
/// A hex written and read in a format that the name tells, packed on the way.
/// ```
/// use hexfill_io::{MeshData, read_path, write_path};
///
/// let corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];
/// let points = corners.map(|p| p.map(f64::from)).to_vec();
/// let mesh = MeshData { hexes: vec![[0, 1, 2, 3, 4, 5, 6, 7]], ..MeshData::from_quads(points, vec![]) };
/// let path = tempfile::tempdir()?.keep().join("cube.vtu.gz");
/// write_path(&path, None, &mesh)?;
/// assert_eq!(read_path(&path, None)?.hexes, mesh.hexes);
/// # std::fs::remove_dir_all(path.parent().unwrap())?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_path(path: &Path, format: Option<Format>, data: &MeshData) -> Result<(), WriteError> {
    write_path_with(path, format, data, Encoding::Text)
}

/// Refuses what [`write_path`] would refuse before it writes: formats that are not known, or that have no place for the mesh.
///
/// # Errors
/// [`WriteError`].
pub fn check_path(path: &Path, format: Option<Format>, data: &MeshData) -> Result<(), WriteError> {
    check(format.map_or_else(|| by_extension(path), Ok)?, data, Encoding::Text)
}

/// [`write_path`] with a choice of encoding.
///
/// # Errors
/// As [`write_path`], and [`WriteError::CannotHold`] if the format has no such encoding.
pub fn write_path_with(
    path: &Path,
    format: Option<Format>,
    data: &MeshData,
    encoding: Encoding,
) -> Result<(), WriteError> {
    let format = format.map_or_else(|| by_extension(path), Ok)?;
    check(format, data, encoding)?;
    let failed = |source| WriteError::Io { file: path.display().to_string(), source };
    save(path, format, data, encoding).map_err(failed)
}

/// The format of an extension, if it is one that is written.
fn by_extension(path: &Path) -> Result<Format, FormatError> {
    let format = Format::from_path(path)?;
    let name = path.to_string_lossy().to_ascii_lowercase();
    let name = name.trim_end_matches(".gz").trim_end_matches(".zst");
    if name.ends_with(".vtp") {
        let (path, extension) = (path.display().to_string(), "vtp".to_owned());
        return Err(FormatError::ReadOnly { path, extension, instead: "vtu" });
    }
    Ok(format)
}

fn save(path: &Path, format: Format, data: &MeshData, encoding: Encoding) -> io::Result<()> {
    let compression = Compression::from_path(path);
    // Through a symbolic link to the file it names, so that the link stays.
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let existing = fs::metadata(&target).ok();
    if existing.as_ref().is_some_and(|m| !m.is_file()) {
        let file = fs::OpenOptions::new().write(true).open(&target)?;
        return emit(Packer::new(file, compression), format, data, encoding).map(drop);
    }
    let directory = match target.parent() {
        Some(parent) if parent != Path::new("") => parent.to_owned(),
        _ => PathBuf::from("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".hexfill-").suffix(".part");
    #[cfg(unix)]
    let all = {
        use std::os::unix::fs::PermissionsExt;
        // As for any new file: what the umask leaves of rw-rw-rw-.
        fs::Permissions::from_mode(0o666)
    };
    #[cfg(unix)]
    builder.permissions(all);
    let file = builder.tempfile_in(directory)?;
    let file = emit(Packer::new(file, compression), format, data, encoding)?;
    if let Some(metadata) = existing {
        file.as_file().set_permissions(metadata.permissions())?;
    }
    file.as_file().sync_all()?;
    file.persist(&target).map(drop).map_err(|e| e.error)
}

fn emit<W: Write>(packer: Packer<W>, format: Format, data: &MeshData, encoding: Encoding) -> io::Result<W> {
    let mut buffer = BufWriter::with_capacity(1 << 18, packer);
    write_checked(&mut buffer, format, data, encoding)?;
    let mut inner = buffer.into_inner().map_err(io::IntoInnerError::into_error)?.finish()?;
    inner.flush()?;
    Ok(inner)
}

/// Writes text to any stream, not compressed.
///
/// # Errors
/// [`WriteError`]; nothing is written if the mesh does not fit the format.
pub fn write_to(writer: impl Write, format: Format, data: &MeshData) -> Result<(), WriteError> {
    write_to_with(writer, format, data, Encoding::Text)
}

/// [`write_to`] with a choice of encoding.
///
/// # Errors
/// As [`write_to`], and [`WriteError::CannotHold`] if the format has no such encoding.
pub fn write_to_with(
    writer: impl Write,
    format: Format,
    data: &MeshData,
    encoding: Encoding,
) -> Result<(), WriteError> {
    check(format, data, encoding)?;
    emit(Packer::new(writer, None), format, data, encoding)
        .map(drop)
        .map_err(|source| WriteError::Io { file: "output".to_owned(), source })
}

fn check(format: Format, data: &MeshData, encoding: Encoding) -> Result<(), WriteError> {
    data.check_for(format)?;
    const INT: (i64, i64) = (i32::MIN as i64, i32::MAX as i64);
    match format {
        Format::Ply => check_tags(data, format, -ply::LARGEST_TAG, ply::LARGEST_TAG, "within 2^53")?,
        Format::Medit | Format::Msh22 | Format::Msh41 => check_tags(data, format, INT.0, INT.1, "32-bit integers")?,
        _ => {}
    }
    if encoding == Encoding::Binary {
        let refuse = |what: &str, remedy: &str| {
            Err(WriteError::CannotHold { format, what: what.to_owned(), remedy: remedy.to_owned() })
        };
        if !format.has_binary() {
            return refuse("binary numbers", "write text, or use .vtu, .vtk or .ply");
        }
        if data.points.len() > i32::MAX as usize && format != Format::Vtu {
            return refuse("more than 2^31 points in binary", "write text or VTU");
        }
    }
    Ok(())
}

fn write_checked(out: &mut dyn Write, format: Format, data: &MeshData, encoding: Encoding) -> io::Result<()> {
    let binary = encoding == Encoding::Binary;
    match format {
        Format::Obj => obj::write(out, data),
        Format::Off => off::write(out, data),
        Format::Ply => ply::write(out, data, binary),
        Format::Vtk => vtk::write(out, data, binary),
        Format::Vtu => vtu::write(out, data, binary),
        Format::Medit => medit::write(out, data),
        Format::Msh22 => msh::write22(out, data),
        Format::Msh41 => msh::write41(out, data),
        Format::Inp => inp::write(out, data),
        Format::Nastran => nastran::write(out, data),
        Format::Unv => unv::write(out, data),
        Format::Ovm => ovm::write(out, data),
        Format::Json => json::write(out, data),
    }
}
