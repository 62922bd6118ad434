//! One file per subcommand: its flags and the glue to the libraries.

pub(crate) mod atlas;
pub(crate) mod catalog;
pub(crate) mod check;
pub(crate) mod completions;
pub(crate) mod convert;
pub(crate) mod doctor;
pub(crate) mod embed;
pub(crate) mod enumerate;
mod families;
pub(crate) mod fill;
pub(crate) mod gallery;
pub(crate) mod info;
pub(crate) mod man;
pub(crate) mod records;
pub(crate) mod search;
pub(crate) mod simplify;
pub(crate) mod view;
