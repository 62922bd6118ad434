//! Helpers of the writers: numbers as text, counters, tags that must fit.
//!
//! Source: ours.

use crate::data::MeshData;
use crate::error::WriteError;
use crate::format::Format;
use std::fmt;
use std::io::{self, Write};

/// A number as the shortest text that reads back to the same bits (at most 17 significant digits).
#[derive(Clone, Copy)]
pub(crate) struct Real(pub f64);

impl fmt::Display for Real {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0.is_nan() {
            return f.write_str("nan");
        }
        // Debug switches to an exponent for very large and small numbers, Display writes hundreds of zeros.
        write!(f, "{:?}", self.0)
    }
}

/// Writes the coordinates of a point, separated by `separator`.
pub(crate) fn write_point(out: &mut dyn Write, point: &[f64; 3], separator: &str) -> io::Result<()> {
    let [x, y, z] = point.map(Real);
    write!(out, "{x}{separator}{y}{separator}{z}")
}

/// Writes whole numbers, each shifted by `base` and preceded by a space.
pub(crate) fn write_indices(out: &mut dyn Write, indices: &[u32], base: u64) -> io::Result<()> {
    for &i in indices {
        write!(out, " {}", u64::from(i) + base)?;
    }
    Ok(())
}

/// Refuses tags outside `lowest..=highest`, all of them: points, faces and hexes.
pub(crate) fn check_tags(
    data: &MeshData,
    format: Format,
    lowest: i64,
    highest: i64,
    limit: &'static str,
) -> Result<(), WriteError> {
    match all_tags(data).find(|t| !(lowest..=highest).contains(t)) {
        Some(given) => Err(WriteError::TagOutOfRange { format, given, limit }),
        None => Ok(()),
    }
}

/// All tags of a mesh, in no particular order.
pub(crate) fn all_tags(data: &MeshData) -> impl Iterator<Item = i64> {
    let of = |tags: &'_ Option<Vec<i64>>| tags.clone().unwrap_or_default();
    let faces: Vec<i64> = data.other_faces.iter().map(|f| f.tag).collect();
    of(&data.point_tags).into_iter().chain(of(&data.quad_tags)).chain(of(&data.hex_tags)).chain(faces)
}

/// Whether any face or hex has a tag.
pub(crate) fn has_cell_tags(data: &MeshData) -> bool {
    data.quad_tags.is_some() || data.hex_tags.is_some() || data.other_faces.iter().any(|f| f.tag != 0)
}

/// A name on one line without quotation marks.
pub(crate) fn unquoted(name: &str) -> String {
    name.chars().map(|c| if c.is_control() || c == '"' { '_' } else { c }).collect()
}

/// Names are one word: VTK writes %20 for a blank.
pub(crate) fn encode_name(name: &str) -> String {
    let mut word = String::new();
    for &byte in name.as_bytes() {
        match byte {
            b'%' | b'"' | 0..=32 | 127.. => word.push_str(&format!("%{byte:02X}")),
            _ => word.push(char::from(byte)),
        }
    }
    if word.is_empty() { "unnamed".to_owned() } else { word }
}

/// Undoes the %20 of array names.
pub(crate) fn decode_name(text: &[u8]) -> String {
    let mut bytes = Vec::with_capacity(text.len());
    let mut i = 0;
    while i < text.len() {
        let hex = text.get(i + 1..i + 3).and_then(|h| std::str::from_utf8(h).ok());
        match hex.filter(|_| text[i] == b'%').and_then(|h| u8::from_str_radix(h, 16).ok()) {
            Some(byte) => {
                bytes.push(byte);
                i += 3;
            }
            None => {
                bytes.push(text[i]);
                i += 1;
            }
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}
