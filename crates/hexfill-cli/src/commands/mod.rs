//! One file per subcommand: its flags and the glue to the libraries.

pub mod atlas;
pub mod catalog;
pub mod check;
pub mod completions;
pub mod convert;
pub mod doctor;
pub mod embed;
pub mod enumerate;
pub mod fill;
pub mod gallery;
pub mod info;
pub mod man;
pub mod search;
pub mod simplify;
pub mod view;
