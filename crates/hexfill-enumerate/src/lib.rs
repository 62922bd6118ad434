//! Every hex mesh with n cubes, without isomorphic copies (BruteBuilder)

mod boundary;
mod canonical;
mod complex;
mod error;
mod frames;
mod weill;

pub use boundary::{Boundary, Components, Key};
pub use canonical::{Code, FORM_VERSION, Labelling, canonical, canonical_over_all_flags};
pub use complex::{Complex, MAX_CUBES};
pub use error::EnumerateError;
pub use weill::{extend_weill, weill_violations};
