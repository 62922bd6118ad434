//! Cells as data: the kinds of buffer cubes, their fillings, and where their points lie in the cube.

pub(crate) mod cell;
mod cell_files;
pub(crate) mod library;
pub(crate) mod pattern;
pub(crate) mod template;
