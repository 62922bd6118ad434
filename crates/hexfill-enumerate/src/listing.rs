//! How an object is written on one line, and the order of cubes that rule `weill` needs.
//!
//! Source: Weill for the form of a line.

use crate::canonical::{Code, canonical};
use crate::complex::{Complex, FREE, side_set_of};
use crate::error::EnumerateError;
use crate::params::Rule;
use crate::weill::{could_be_last, edges_are_manifold};
use hexfill_mesh::{hex_signature, oriented_hex_signature};
use std::fmt::Write;
use std::str::FromStr;

/// The format of a line.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum ListFormat {
    /// The mesh crate's signature, accepted wherever a mesh is.
    #[default]
    Signature,
    /// This crate's canonical code in hexadecimal digits; much faster to write.
    Code,
    /// Numbers: vertices, cubes, then eight 0-based vertices a cube in VTK order. Under rule `weill` the cubes are in an order in which
    /// the rule can have added them.
    Hexes,
}

impl FromStr for ListFormat {
    type Err = EnumerateError;

    fn from_str(text: &str) -> Result<Self, EnumerateError> {
        match text {
            "signature" => Ok(Self::Signature),
            "code" => Ok(Self::Code),
            "hexes" => Ok(Self::Hexes),
            _ => Err(EnumerateError::BadParameters {
                why: format!("there is no format {text:?}: signature, code or hexes"),
            }),
        }
    }
}

/// The line of one object, without its end.
///
/// # Errors
/// [`EnumerateError::BadCode`] if the code is of no complex, or of none that the rule can make.
///
/// # Example
/// ```
/// use hexfill_enumerate::{Complex, ListFormat, Rule, canonical, line};
///
/// let one = canonical(&Complex::cube()).code;
/// assert_eq!(line(&one, ListFormat::Hexes, Rule::Strict)?, "8 1 0 1 2 3 4 5 6 7");
/// # Ok::<(), hexfill_enumerate::EnumerateError>(())
/// ```
pub fn line(code: &Code, format: ListFormat, rule: Rule) -> Result<String, EnumerateError> {
    match format {
        ListFormat::Signature => Ok(hex_signature(&code.decode()?.to_hex_mesh()?)?),
        ListFormat::Code => Ok(code.to_text()),
        ListFormat::Hexes => Ok(hexes_text(&mesh_of(code, rule)?)),
    }
}

/// The lines of an object with mirror images distinct: one, or two if it differs from its mirror image.
///
/// Signatures are the oriented ones; a mirrored code is marked, since both have the same.
///
/// # Errors
/// As [`line()`]; [`EnumerateError::Signature`] for an object that is not orientable.
pub fn mirror_lines(code: &Code, format: ListFormat, rule: Rule) -> Result<Vec<String>, EnumerateError> {
    let c = mesh_of(code, rule)?;
    let mut out = Vec::new();
    let images = if canonical(&c).reversing { vec![c] } else { vec![c, mirrored(&c)?] };
    for (i, image) in images.iter().enumerate() {
        out.push(match format {
            ListFormat::Signature => oriented_hex_signature(&image.to_hex_mesh()?)?,
            ListFormat::Code => code.to_text() + if i == 0 { "" } else { " mirrored" },
            ListFormat::Hexes => hexes_text(image),
        });
    }
    Ok(out)
}

/// The mirror image: the same vertices, every cube seen upside down.
fn mirrored(c: &Complex) -> Result<Complex, EnumerateError> {
    let cubes: Vec<[u8; 8]> = c.cubes().iter().map(|x| [4, 5, 6, 7, 0, 1, 2, 3].map(|i: usize| x[i])).collect();
    Complex::from_cubes(&cubes)
}

fn hexes_text(c: &Complex) -> String {
    let mut text = format!("{} {}", c.n_vertices(), c.n_cubes());
    for v in c.cubes().iter().flatten() {
        // Writing to a string cannot fail.
        let _ = write!(text, " {v}");
    }
    text
}

/// The complex of a code, its cubes in an order the rule allows.
///
/// # Errors
/// As [`line()`].
pub fn mesh_of(code: &Code, rule: Rule) -> Result<Complex, EnumerateError> {
    let c = code.decode()?;
    match rule {
        Rule::Strict => Ok(c),
        Rule::Weill => weill_order(&c).ok_or_else(|| EnumerateError::BadCode {
            given: code.to_text(),
            why: "rule weill cannot make it in any order".into(),
        }),
    }
}

/// The same complex with its cubes in an order in which rule `weill` adds them one by one; `None` if there is none.
pub fn weill_order(c: &Complex) -> Option<Complex> {
    let mut order = Vec::new();
    if !edges_are_manifold(c) || !unbuild(c, &(0..c.n_cubes()).collect::<Vec<_>>(), &mut order) {
        return None;
    }
    order.reverse();
    let cubes: Vec<[u8; 8]> = order.iter().map(|&a| c.cubes[a]).collect();
    Complex::from_cubes(&cubes).ok()
}

/// Takes cubes away one by one while the rest stays legal. `names` are the original numbers of the cubes of `c`; those taken away are
/// appended to `order`.
fn unbuild(c: &Complex, names: &[usize], order: &mut Vec<usize>) -> bool {
    if c.n_cubes() == 1 {
        order.push(names[0]);
        return true;
    }
    let non_cut = c.non_cut();
    for a in (0..c.n_cubes()).rev() {
        if non_cut >> a & 1 == 0 || !could_be_last(c, a) || !shares_by_gluing_only(c, a) {
            continue;
        }
        let rest = c.removed(a);
        if !edges_are_manifold(&rest) {
            continue;
        }
        let mut left = names.to_vec();
        order.push(left.swap_remove(a));
        if unbuild(&rest, &left, order) {
            return true;
        }
        order.pop();
    }
    false
}

/// Whether every vertex that cube `a` shares with others lies on one of its glued sides: the others are new when it is added.
fn shares_by_gluing_only(c: &Complex, a: usize) -> bool {
    let others = (0..c.n_cubes()).filter(|&b| b != a).fold(0u64, |all, b| all | c.sets[b]);
    let glued = (0..6).filter(|&f| c.next[a][f] != FREE).fold(0u64, |all, f| all | side_set_of(&c.cubes[a], f));
    c.sets[a] & others & !glued == 0
}

#[cfg(test)]
mod tests {
    use super::*;
    use hexfill_mesh::parse_hex_signature;

    #[test]
    fn lines() {
        let code = canonical(&Complex::cube()).code;
        assert_eq!(line(&code, ListFormat::Hexes, Rule::Strict).unwrap(), "8 1 0 1 2 3 4 5 6 7");
        let signature = line(&code, ListFormat::Signature, Rule::Strict).unwrap();
        assert_eq!(parse_hex_signature(&signature).unwrap().n_hexes(), 1);
        assert_eq!(line(&code, ListFormat::Code, Rule::Weill).unwrap(), "01");
        assert!("xyz".parse::<ListFormat>().is_err());
    }
}
