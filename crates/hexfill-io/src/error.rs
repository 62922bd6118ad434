//! What can go wrong with a file, said so that it can be mended: where (file and line, or byte of a binary file),
//! what was expected, what was found, and a remedy.

use crate::format::{Format, FormatError};
use std::fmt;
use std::io;

/// A position in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Position {
    /// A line of a text file, counted from 1.
    Line(u64),
    /// A byte of a binary file, counted from 0 (after decompression).
    Byte(u64),
    /// The file as a whole.
    Whole,
}

/// A place in a named file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// Name of the file as the caller gave it.
    pub file: String,
    /// The format it was read as.
    pub format: Format,
    /// Where in it.
    pub position: Position,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.position {
            Position::Line(line) => write!(f, "{}:{line}", self.file),
            Position::Byte(byte) => write!(f, "{}, byte {byte}", self.file),
            Position::Whole => f.write_str(&self.file),
        }
    }
}

/// Why a file could not be read. Nothing of the file is returned then.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The operating system or a decompressor failed.
    #[error("{file}: {source}")]
    Io {
        /// Name of the file.
        file: String,
        /// What failed.
        source: io::Error,
    },
    /// The format is not known.
    #[error(transparent)]
    Format(#[from] FormatError),
    /// Nothing but white space.
    #[error("{file}: the file is empty, expected {}; export it again", format.title())]
    Empty {
        /// Name of the file.
        file: String,
        /// The format it should have.
        format: Format,
    },
    /// The file ends in the middle of something.
    #[error("{at}: the file ends too early, expected {expected}; it is truncated: copy or export it again")]
    Truncated {
        /// Where it ends.
        at: Box<Place>,
        /// What should have come, and how much of it there was.
        expected: String,
    },
    /// Something else than the format asks for.
    #[error("{at}: expected {expected}, found {given}; {remedy}")]
    Malformed {
        /// Where.
        at: Box<Place>,
        /// What should be there.
        expected: String,
        /// What is there.
        given: String,
        /// What to do.
        remedy: String,
    },
    /// A coordinate that is no number or infinite.
    #[error("{at}: {what} is {given}, coordinates must be finite; repair the tool that wrote it or remove the point")]
    NotFinite {
        /// Where.
        at: Box<Place>,
        /// Which coordinate of what.
        what: String,
        /// The text or value found.
        given: String,
    },
    /// An index that names nothing.
    #[error("{at}: {what} {given} does not exist, {}; correct the index or add what is missing", range(*.lowest, *.highest))]
    IndexOutOfRange {
        /// Where.
        at: Box<Place>,
        /// What the index should name ("vertex", "node").
        what: String,
        /// The index as written in the file.
        given: i64,
        /// Lowest index allowed, in the counting of the file.
        lowest: i64,
        /// Highest index allowed (below `lowest`: nothing is there to be named).
        highest: i64,
    },
    /// More than this program can name with 32-bit ids.
    #[error("{at}: {given} {what} claimed, the limit is {limit}; the count is wrong or the mesh must be split")]
    TooLarge {
        /// Where.
        at: Box<Place>,
        /// What is too many.
        what: String,
        /// How many are claimed.
        given: u64,
        /// How many are allowed.
        limit: u64,
    },
    /// A correct file of a kind that is not read here.
    #[error("{at}: {what} cannot be read here; {remedy}")]
    Unsupported {
        /// Where.
        at: Box<Place>,
        /// What it is.
        what: String,
        /// What to do.
        remedy: String,
    },
}

fn range(lowest: i64, highest: i64) -> String {
    if highest < lowest {
        "there is none to name at all".to_owned()
    } else {
        format!("the file has {lowest} to {highest}")
    }
}

/// Why a mesh could not be written. The target file is left as it was.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WriteError {
    /// The operating system failed.
    #[error("{file}: {source}")]
    Io {
        /// Name of the file.
        file: String,
        /// What failed.
        source: io::Error,
    },
    /// The format is not known.
    #[error(transparent)]
    Format(#[from] FormatError),
    /// The format has no place for part of the mesh.
    #[error("{} cannot hold {what}; {remedy}", format.title())]
    CannotHold {
        /// The format asked for.
        format: Format,
        /// What it has no place for, and how many.
        what: String,
        /// What to do.
        remedy: String,
    },
    /// The mesh has connectivity only.
    #[error(
        "{} needs coordinates and the mesh has none; compute positions first (embed) or write JSON, which holds connectivity alone",
        format.title()
    )]
    NoCoordinates {
        /// The format asked for.
        format: Format,
    },
    /// A coordinate that is no number or infinite.
    #[error("coordinate {axis} of point {point} (0-based) is {given}; coordinates must be finite")]
    NotFinite {
        /// Index of the point.
        point: usize,
        /// `x`, `y` or `z`.
        axis: char,
        /// The value.
        given: f64,
    },
    /// Arrays of the mesh that do not fit together.
    #[error("the mesh is inconsistent: {what}")]
    Inconsistent {
        /// Which arrays and how.
        what: String,
    },
    /// A tag beyond what the format can hold.
    #[error("tag {given} does not fit in {}, whose tags are {limit}; renumber the tags or write VTU", format.title())]
    TagOutOfRange {
        /// The format asked for.
        format: Format,
        /// The tag.
        given: i64,
        /// The numbers allowed.
        limit: &'static str,
    },
}

impl WriteError {
    /// That a format has cells of second order.
    ///
    /// # Errors
    /// [`WriteError::CannotHold`] if it has none.
    pub fn check_quadratic(format: Format) -> Result<(), Self> {
        if format.holds_quadratic() {
            return Ok(());
        }
        Err(Self::CannotHold {
            format,
            what: "cells of second order".to_owned(),
            remedy: "use .vtu, .vtk, .msh, .inp, .bdf or .unv, or write straight cells".to_owned(),
        })
    }
}

/// Why cells cannot become cells of second order.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum QuadraticError {
    /// There is nowhere to put a node.
    #[error("nodes in the middles of edges need coordinates and the mesh has none; compute positions first (embed)")]
    NoCoordinates,
    /// Straight cells beside them would not fit.
    #[error(
        "{faces} faces and {cells} cells are no quads or hexes; cells of second order are written for these alone: leave out --quadratic"
    )]
    OtherCells {
        /// Faces that are no quads.
        faces: usize,
        /// Cells that are no hexes.
        cells: usize,
    },
    /// More points than 32-bit ids can name.
    #[error("the mesh would have {given} points, the limit is 4294967295")]
    TooMany {
        /// How many there would be.
        given: usize,
    },
}

/// A snippet of input for a message: printable, at most 40 characters, quoted.
pub(crate) fn snippet(bytes: &[u8]) -> String {
    const LONGEST: usize = 40;
    let cut = &bytes[..bytes.len().min(4 * LONGEST)];
    let text: String = String::from_utf8_lossy(cut)
        .trim()
        .chars()
        .take(LONGEST)
        .map(|c| if c.is_control() { '\u{fffd}' } else { c })
        .collect();
    let more = if text.chars().count() == LONGEST || cut.len() < bytes.len() { "..." } else { "" };
    if std::str::from_utf8(bytes).is_err() || bytes.contains(&0) {
        format!("`{text}{more}` (not text: a binary or damaged file?)")
    } else {
        format!("`{text}{more}`")
    }
}
