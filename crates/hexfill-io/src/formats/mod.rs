//! One file per format. Each reader takes a `Source` and gives a `MeshData`; each writer takes a checked `MeshData`.
//!
//! Source: each file names its own.

pub(crate) mod inp;
pub(crate) mod json;
pub(crate) mod medit;
pub(crate) mod msh;
pub(crate) mod nastran;
pub(crate) mod obj;
pub(crate) mod off;
pub(crate) mod ovm;
pub(crate) mod ply;
pub(crate) mod unv;
pub(crate) mod vtk;
pub(crate) mod vtu;
