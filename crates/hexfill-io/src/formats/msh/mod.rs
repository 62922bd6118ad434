//! Gmsh MSH files, versions 2.2 and 4.1. The extension `.msh` is also used by ANSYS and Fluent: the file itself decides,
//! and a note says what it was taken for.
//!
//! Tags are Gmsh's physical groups. Where a file has none, the elementary entities take their place if there are several.
//! A tag with several names is in several physical groups; version 2.2, whose elements have one group, joins the names with `+`.
//! Tags of points, which Gmsh does not know, are written as node data named `tag`.
//!
//! Source: the Gmsh manual, "MSH file format" and "MSH file format version 2".

mod common;
mod physical;
mod read;
mod sections;
mod v2;
mod v4;

pub(crate) use read::read;
pub(crate) use v2::write as write22;
pub(crate) use v4::write as write41;
