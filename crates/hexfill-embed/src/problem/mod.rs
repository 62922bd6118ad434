//! What is placed: hexes with free and fixed vertices, their symmetric variables, and parts of them.
//!
//! Source: ours.

mod find_symmetry;
mod free_vertices;
mod patches;
#[cfg(test)]
pub(crate) mod samples;
mod symmetric_variables;

pub(crate) use find_symmetry::find_symmetry;
pub(crate) use free_vertices::{FIXED, Problem};
pub(crate) use patches::{Incidence, Patch, patches};
