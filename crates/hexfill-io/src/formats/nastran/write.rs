//! Writing Nastran bulk data: wide fields for points, narrow ones for elements.
//!
//! Source: the Nastran guide.

use super::PROPERTY_LINE;
use super::card::parse_real;
use crate::data::{MeshData, TagOn};
use crate::numbers::NodeNumbers;
use crate::orders::{NASTRAN_HEX20, reorder};
use crate::quadratic::{written_faces, written_hexes};
use std::collections::{BTreeMap, BTreeSet};
use std::io::{self, Write};

/// The largest number of a point.
pub(crate) const MOST: u64 = 99_999_999;

/// Characters of a wide field.
const WIDE: usize = 16;

/// A number in at most 16 characters: all its digits if they fit, else as many as do.
fn real(x: f64) -> String {
    let exact = format!("{x:?}");
    if exact.len() <= WIDE && !exact.contains('e') {
        return exact;
    }
    (0..=16)
        .rev()
        .map(|digits| {
            let text = format!("{x:.digits$e}");
            let (mantissa, exponent) = text.split_once('e').expect("a number in scientific notation");
            let sign = if exponent.starts_with('-') { "" } else { "+" };
            let point = if mantissa.contains('.') { "" } else { "." };
            // The last zeros say nothing.
            let mantissa = if point.is_empty() { mantissa.trim_end_matches('0') } else { mantissa };
            format!("{mantissa}{point}{sign}{exponent}")
        })
        // Rounded up, the largest numbers would be infinite.
        .find(|text| text.len() <= WIDE && parse_real(text.as_bytes()).is_some_and(f64::is_finite))
        .expect("one digit fits")
}

/// How many points are not written bit for bit.
pub(crate) fn rounded(data: &MeshData) -> usize {
    let is_exact = |x: f64| parse_real(real(x).as_bytes()).is_some_and(|y| y.to_bits() == x.to_bits());
    data.points.iter().filter(|point| !point.iter().all(|&x| is_exact(x))).count()
}

/// Numbers of properties, which shells and solids share: a tag keeps its own if it can.
struct Properties(BTreeMap<(TagOn, i64), i64>);

impl Properties {
    fn new(data: &MeshData) -> Self {
        let faces = data.numbered_faces().map(|(.., tag)| (TagOn::Faces, tag));
        let cells = (0..data.hexes.len()).map(|h| (TagOn::Cells, data.hex_tag(h)));
        let others = (data.cell_count() > data.hexes.len()).then_some((TagOn::Cells, 0));
        let wanted: BTreeSet<(TagOn, i64)> = faces.chain(cells).chain(others).collect();
        let mut taken = BTreeSet::new();
        let fits = |tag: i64| (1..100_000_000).contains(&tag);
        let mut numbers: BTreeMap<(TagOn, i64), i64> =
            wanted.iter().filter(|(_, tag)| fits(*tag) && taken.insert(*tag)).map(|&key| (key, key.1)).collect();
        let mut next = 1;
        for key in wanted {
            numbers.entry(key).or_insert_with(|| {
                while !taken.insert(next) {
                    next += 1;
                }
                next
            });
        }
        Self(numbers)
    }
}

pub(crate) fn write(out: &mut dyn Write, data: &MeshData) -> io::Result<()> {
    writeln!(out, "$ hexfill: {} hexes, {} faces", data.hexes.len(), data.face_count())?;
    let properties = Properties::new(data);
    for name in &data.tag_names {
        writeln!(out, "${}", name.line())?;
    }
    for ((_, tag), number) in properties.0.iter().filter(|((_, tag), number)| tag != *number) {
        writeln!(out, "${PROPERTY_LINE} {number} has tag {tag}")?;
    }
    writeln!(out, "BEGIN BULK")?;
    let numbers = NodeNumbers::new(data, MOST);
    for (i, point) in data.points.iter().enumerate() {
        let [x, y, z] = point.map(real);
        writeln!(out, "GRID*   {:>16}{:>16}{x:>16}{y:>16}\n*       {z:>16}", numbers.of(i), "")?;
    }
    let mut number = 0;
    let mut element = |name: &str, on: TagOn, tag: i64, nodes: &[u32]| -> io::Result<()> {
        number += 1;
        write!(out, "{name:<8}{number:>8}{:>8}", properties.0[&(on, tag)])?;
        for (i, &node) in nodes.iter().enumerate() {
            // Six nodes on the first line, eight on those that follow.
            if i == 6 || i == 14 {
                out.write_all(b"+\n+       ")?;
            }
            write!(out, "{:>8}", numbers.of(node as usize))?;
        }
        out.write_all(b"\n")
    };
    for (face, tag) in written_faces(data) {
        let name = match face.len() {
            3 => "CTRIA3",
            8 => "CQUAD8",
            _ => "CQUAD4",
        };
        element(name, TagOn::Faces, tag, face)?;
    }
    for (hex, tag) in written_hexes(data) {
        match <[u32; 20]>::try_from(hex) {
            Ok(hex) => element("CHEXA", TagOn::Cells, tag, &reorder(hex, NASTRAN_HEX20))?,
            Err(_) => element("CHEXA", TagOn::Cells, tag, hex)?,
        }
    }
    for tet in &data.tets {
        element("CTETRA", TagOn::Cells, 0, tet)?;
    }
    for wedge in &data.wedges {
        element("CPENTA", TagOn::Cells, 0, wedge)?;
    }
    for pyramid in &data.pyramids {
        element("CPYRAM", TagOn::Cells, 0, pyramid)?;
    }
    writeln!(out, "ENDDATA")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_fit_and_are_exact_where_they_can_be() {
        for x in [0.0, -0.0, 1.0, 0.1, -1234.5, 1e300, 5e-324, -1e-10, 123_456_789.125] {
            let text = real(x);
            assert!(text.len() <= WIDE && text.contains('.'), "{text}");
            assert_eq!(parse_real(text.as_bytes()).map(f64::to_bits), Some(x.to_bits()), "{text}");
        }
        for x in [1.0 / 3.0, -1.0 / 3.0, f64::MAX, -f64::MIN_POSITIVE, -std::f64::consts::PI * 1e-100] {
            let text = real(x);
            let back = parse_real(text.as_bytes()).unwrap();
            assert!(text.len() <= WIDE && ((back - x) / x).abs() < 1e-8, "{x}: {text}");
        }
    }
}
