//! Reading and writing surface and mesh files: one file per format, one table of node orders ([`orders`]).
//!
//! [`read_path`] gives a [`MeshData`], plain arrays in the order of the file; [`write_path`] writes one, beside the target
//! and renamed when it is complete. gzip and Zstandard are unpacked and packed on the way. Coordinates come back bit for
//! bit in every text format: the shortest decimal that reads back to the same number is written.
//!
//! Nothing here trusts a file: counts are believed only as far as there is data, compressed files unpack to at most 256 MiB and 16
//! bytes for each of theirs, and every error says where it is, what was expected and what to do.
//!
//! Not for geometry kernels (STEP, IGES) nor triangle soups (STL): quads, and the cells of volume meshes, are what is read. Ids are 0-based in
//! memory whatever the file counts from. What a format cannot hold is told before it is written ([`MeshData::losses`]) and refused where the mesh would
//! not survive ([`MeshData::check_for`]).
//!
//! ```
//! use hexfill_io::{Format, MeshData, read_from, write_to};
//!
//! let points = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
//! let mesh = MeshData::from_quads(points, vec![[0, 1, 2, 3]]);
//! let mut file = Vec::new();
//! write_to(&mut file, Format::Off, &mesh)?;
//! assert_eq!(read_from(file.as_slice(), Format::Off, "square.off")?, mesh);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod arrays;
mod assembly;
mod compress;
mod data;
mod error;
mod format;
mod formats;
mod groups;
mod limits;
mod losses;
mod numbers;
pub mod orders;
mod quadratic;
mod quadratic_cells;
mod save;
mod source;
mod weld;
mod write;

pub use data::{MeshData, OtherFace, TagName, TagOn};
pub use error::{Place, Position, QuadraticError, ReadError, WriteError};
pub use format::{Compression, Format, FormatError};
pub use quadratic_cells::Quadratic;
pub use save::{Encoding, check_path, write_path, write_path_with, write_to, write_to_with};
pub use weld::{Weld, closing_tolerance, weld};

use formats::{inp, json, medit, msh, nastran, obj, off, ovm, ply, unv, vtk, vtu};
use source::Source;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Reads a file. Without a `format` the extension decides; compression is recognised by the content.
///
/// # Errors
/// [`ReadError`] with file, line (byte for binary data), what was expected and what to do.
///
/// # Example
/// ```
/// use hexfill_io::read_path;
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("open.off");
/// std::fs::write(&path, "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 9\n")?;
/// let error = read_path(&path, None).unwrap_err();
/// assert!(error.to_string().contains("open.off:7: vertex 9 does not exist"), "{error}");
/// # Ok::<(), std::io::Error>(())
/// ```
pub fn read_path(path: &Path, format: Option<Format>) -> Result<MeshData, ReadError> {
    let format = match format {
        Some(format) => format,
        None => Format::from_path(path)?,
    };
    let name = path.display().to_string();
    let io = |source| ReadError::Io { file: name.clone(), source };
    let file = File::open(path).map_err(io)?;
    if file.metadata().map_err(io)?.is_dir() {
        return Err(io(std::io::ErrorKind::IsADirectory.into()));
    }
    read_from(file, format, &name)
}

/// Reads from any stream; `name` stands for the file in messages.
///
/// # Errors
/// As [`read_path`].
///
/// # Example
/// ```
/// use hexfill_io::{Format, read_from};
///
/// let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
/// let mesh = read_from(text.as_bytes(), Format::Obj, "square.obj")?;
/// assert_eq!((mesh.points.len(), &mesh.quads[..]), (4, &[[0, 1, 2, 3]][..])); // OBJ counts from 1, arrays from 0
/// # Ok::<(), hexfill_io::ReadError>(())
/// ```
pub fn read_from(reader: impl Read, format: Format, name: &str) -> Result<MeshData, ReadError> {
    let (unpacked, compression) =
        compress::unpacked(reader).map_err(|source| ReadError::Io { file: name.to_owned(), source })?;
    let source = Source::new(unpacked, name, format).with_packed(compression.is_some());
    let mut mesh = match format {
        Format::Obj => obj::read(source),
        Format::Off => off::read(source),
        Format::Ply => ply::read(source),
        Format::Vtk => vtk::read(source),
        Format::Vtu => vtu::read(source),
        Format::Medit => medit::read(source),
        Format::Msh22 | Format::Msh41 => msh::read(source),
        Format::Inp => inp::read(source),
        Format::Nastran => nastran::read(source),
        Format::Unv => unv::read(source),
        Format::Ovm => ovm::read(source),
        Format::Json => json::read(source),
    }?;
    let named = Compression::from_path(Path::new(name));
    if named.is_some() && compression.is_none() {
        mesh.notes.push(format!("{name} is not compressed, whatever its name says"));
    }
    Ok(mesh)
}
