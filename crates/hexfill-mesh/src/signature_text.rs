//! Numbers as printable text, and the errors of signatures.
//!
//! The alphabet `0-9a-zA-Z-_` is safe in file names, URLs and shells. Each character carries 5 bits and, in its sixth bit, whether more
//! follow; the lowest bits come first. So 0..31 take one character, 32..1023 two, and a text never claims a length.
//!
//! Source: ours; after the characters of Regina's signatures (Burton 2011).

use crate::hexmesh::HexMeshError;
use crate::surface::SurfaceError;

const ALPHABET: &[u8; 64] = b"0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ-_";

/// Separates components.
pub(crate) const SEPARATOR: char = '.';

/// Why a text is not a signature, or why an object has none. Positions are counted in characters from 0, the prefix included.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SignatureError {
    /// The text does not begin as it must.
    #[error("a {what} signature begins with '{expected}', but '{given}' was given")]
    Prefix {
        /// "surface" or "hex mesh".
        what: &'static str,
        /// The prefix of this version.
        expected: &'static str,
        /// How the text begins.
        given: String,
    },
    /// A character outside the alphabet.
    #[error("character {position} of the signature is {given:?}; allowed are 0-9 a-z A-Z - _ and . between components")]
    Character {
        /// Where.
        position: usize,
        /// What stands there.
        given: char,
    },
    /// The text ends while quads (hexes) are still to come.
    #[error(
        "the signature ends too early, at character {position}: component {component} is still open; was it cut off?"
    )]
    Truncated {
        /// Where.
        position: usize,
        /// Component (0-based).
        component: usize,
    },
    /// The component is complete, but the text goes on.
    #[error(
        "component {component} of the signature is complete at character {position}, but the text goes on; remove the rest or separate components by '.'"
    )]
    Trailing {
        /// Where the rest begins.
        position: usize,
        /// Component (0-based).
        component: usize,
    },
    /// A number that is too long or not in its shortest form.
    #[error("no number begins at character {position} of the signature: too many digits, or a superfluous zero")]
    Digits {
        /// Where.
        position: usize,
    },
    /// A number that names no vertex met so far.
    #[error("the number at character {position} of the signature is {given}, but at most {limit} is possible there")]
    Number {
        /// Where it begins.
        position: usize,
        /// The number.
        given: u64,
        /// The largest number possible there.
        limit: u64,
    },
    /// A third quad at an edge, or a third hex at a quad.
    #[error("before character {position} the signature puts a third {what}; it names no manifold")]
    Crowded {
        /// Where.
        position: usize,
        /// "quad on an edge", "hex on a quad".
        what: &'static str,
    },
    /// The signature is well-formed but what it lists is not a surface.
    #[error("the signature lists quads that are not a surface: {0}")]
    Surface(#[from] SurfaceError),
    /// The signature is well-formed but what it lists is not a hex mesh.
    #[error("the signature lists hexes that are not a mesh: {0}")]
    Mesh(#[from] HexMeshError),
    /// There is no hex.
    #[error("a mesh without hexes has no signature")]
    Empty,
    /// Parts of a mesh that are not connected through quads have vertices in common.
    #[error(
        "the parts of the mesh round {} and {} share {vertex} but are not connected through quads; such a mesh has no signature", hexes[0], hexes[1]
    )]
    SharedVertex {
        /// A hex of each part.
        hexes: [crate::ids::HexId; 2],
        /// The vertex.
        vertex: crate::ids::VertexId,
    },
    /// Mirror images cannot be told apart because the mesh has no orientation as given.
    #[error("hexes {} and {} have opposite orientation; a signature that tells mirror images apart needs all hexes of one handedness", hexes[0], hexes[1])]
    NotOriented {
        /// Two neighbours that disagree.
        hexes: [crate::ids::HexId; 2],
    },
}

/// Appends a number.
pub(crate) fn push_number(text: &mut String, mut number: u32) {
    loop {
        let more = number > 31;
        text.push(ALPHABET[(number & 31) as usize + if more { 32 } else { 0 }] as char);
        number >>= 5;
        if !more {
            break;
        }
    }
}

/// Reads the numbers of one component.
pub(crate) struct NumberReader<'a> {
    text: &'a [u8],
    at: usize,
    /// Number of characters of the whole signature before this component.
    offset: usize,
    component: usize,
}

impl<'a> NumberReader<'a> {
    /// A reader over one component, which must be in the alphabet (see [`components`]).
    fn new(text: &'a str, offset: usize, component: usize) -> Self {
        Self { text: text.as_bytes(), at: 0, offset, component }
    }

    pub(crate) fn position(&self) -> usize {
        self.offset + self.at
    }

    /// The next number, at most `limit`.
    pub(crate) fn number(&mut self, limit: u32) -> Result<u32, SignatureError> {
        let begin = self.position();
        let mut value = 0u64;
        for shift in (0..).step_by(5) {
            let Some(&byte) = self.text.get(self.at) else {
                return Err(SignatureError::Truncated { position: self.position(), component: self.component });
            };
            self.at += 1;
            let digit = digit(byte).expect("components are in the alphabet");
            if shift > 30 || shift > 0 && digit == 0 {
                return Err(SignatureError::Digits { position: begin });
            }
            value |= u64::from(digit & 31) << shift;
            if digit < 32 {
                break;
            }
        }
        if value > limit.into() {
            return Err(SignatureError::Number { position: begin, given: value, limit: limit.into() });
        }
        Ok(value as u32)
    }

    /// Checks that nothing is left.
    pub(crate) fn finish(&self) -> Result<(), SignatureError> {
        if self.at == self.text.len() {
            Ok(())
        } else {
            Err(SignatureError::Trailing { position: self.position(), component: self.component })
        }
    }
}

/// Position in [`ALPHABET`].
fn digit(byte: u8) -> Option<u8> {
    match byte {
        b'0'..=b'9' => Some(byte - b'0'),
        b'a'..=b'z' => Some(byte - b'a' + 10),
        b'A'..=b'Z' => Some(byte - b'A' + 36),
        b'-' => Some(62),
        b'_' => Some(63),
        _ => None,
    }
}

/// A reader for each component of a signature with the given prefix; checks prefix and alphabet.
pub(crate) fn components<'a>(
    text: &'a str,
    what: &'static str,
    prefix: &'static str,
) -> Result<Vec<NumberReader<'a>>, SignatureError> {
    let Some(body) = text.strip_prefix(prefix) else {
        let given = text.chars().take(prefix.len()).collect();
        return Err(SignatureError::Prefix { what, expected: prefix, given });
    };
    for (i, c) in body.chars().enumerate() {
        let known = u8::try_from(c).ok().and_then(digit).is_some();
        if !known && c != SEPARATOR {
            return Err(SignatureError::Character { position: prefix.len() + i, given: c });
        }
    }
    let mut readers = Vec::new();
    let mut offset = prefix.len();
    for (i, part) in body.split(SEPARATOR).enumerate() {
        readers.push(NumberReader::new(part, offset, i));
        offset += part.len() + 1;
    }
    Ok(readers)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_back() {
        let numbers = [0, 1, 31, 32, 33, 1023, 1024, 65_535, 1 << 20, 1 << 30, u32::MAX];
        let mut text = String::from("T:");
        numbers.iter().for_each(|&n| push_number(&mut text, n));
        let mut readers = components(&text, "test", "T:").unwrap();
        for n in numbers {
            assert_eq!(readers[0].number(u32::MAX).unwrap(), n);
        }
        readers[0].finish().unwrap();
        assert!(matches!(readers[0].number(9), Err(SignatureError::Truncated { .. })));
    }

    #[test]
    fn the_alphabet_is_inverted() {
        assert!(ALPHABET.iter().enumerate().all(|(i, &b)| digit(b) == Some(i as u8)));
        assert_eq!((0..=255u8).filter(|&b| digit(b).is_some()).count(), 64);
    }

    #[test]
    fn numbers_have_one_form_and_a_limit() {
        let read = |text: &str, limit| components(text, "test", "T:").unwrap()[0].number(limit);
        assert_eq!(read("T:w0", 99), Err(SignatureError::Digits { position: 2 }));
        assert_eq!(read("T:__________", 99), Err(SignatureError::Digits { position: 2 }));
        assert_eq!(read("T:a", 9), Err(SignatureError::Number { position: 2, given: 10, limit: 9 }));
        assert!(matches!(components("T:0é", "test", "T:"), Err(SignatureError::Character { position: 3, given: 'é' })));
        assert!(matches!(components("U:0", "test", "T:"), Err(SignatureError::Prefix { .. })));
    }
}
