//! VTK XML files: `.vtu` (UnstructuredGrid) and, read only, `.vtp` (PolyData).
//!
//! Arrays are read as ASCII, as base64 in place, and from the appended section (raw or base64), each of the latter three
//! plain or in zlib blocks, with 32- or 64-bit headers and either byte order. Several pieces are joined.
//!
//! Source: the VTK formats, "XML File Formats".

mod arrays;
mod read;
mod write;

pub(crate) use read::read;
pub(crate) use write::write;
