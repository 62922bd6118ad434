//! Wanted boundaries: surfaces recognised while enumerating, and what a run lists.
//!
//! A surface is recognised by its number of quads first, then by its key, and last by its canonical signature, which
//! decides. A boundary that touches itself is no surface and is never recognised.
//!
//! Source: ours; keys: Weill.

use crate::boundary::Boundary;
use crate::canonical::Code;
use crate::error::EnumerateError;
use crate::shape::{Selection, Shape};
use crate::tally::Counter;
use hexfill_mesh::{Key, QuadSurface, key, parse_surface_signature, surface_signature};

/// A wanted boundary.
#[derive(Clone, Debug)]
pub struct Target {
    /// What to call it.
    pub name: String,
    key: Key,
    signature: Option<String>,
}

impl Target {
    /// A surface, up to isomorphism.
    pub fn surface(name: impl Into<String>, surface: &QuadSurface) -> Self {
        Self { name: name.into(), key: key(surface), signature: Some(surface_signature(surface)) }
    }

    /// Any boundary with this key.
    pub fn key(key: Key) -> Self {
        Self { name: key.to_string(), key, signature: None }
    }

    /// A surface signature, a key, or the name of a built-in target.
    ///
    /// # Errors
    /// [`EnumerateError::Key`] or [`EnumerateError::Signature`] if the text is none of them.
    pub fn parse(text: &str) -> Result<Self, EnumerateError> {
        if let Some((name, signature)) = BUILT_IN.iter().find(|(name, _)| *name == text) {
            return Ok(Self::surface(*name, &parse_surface_signature(signature)?));
        }
        if text.starts_with("Q1:") {
            return Ok(Self::surface(text, &parse_surface_signature(text)?));
        }
        Ok(Self::key(text.parse()?))
    }

    /// The published open boundaries: Schneiders' pyramid, the octagonal spindle, the buffer cubes of 20 and 22 quads, and
    /// figure 10 of Carbonera's examples.
    ///
    /// # Errors
    /// None in practice: the signatures are tested.
    pub fn built_in() -> Result<Vec<Self>, EnumerateError> {
        BUILT_IN.iter().map(|(name, _)| Self::parse(name)).collect()
    }

    /// Whether a boundary is this one.
    pub fn is(&self, boundary: &Boundary) -> bool {
        boundary.has_key(&self.key)
            && self
                .signature
                .as_ref()
                .is_none_or(|wanted| boundary.to_surface().is_ok_and(|surface| surface_signature(&surface) == *wanted))
    }
}

/// Names and signatures of the built-in targets. The two first: R. Schneiders' pyramid (1996) and the octagonal spindle (tetragonal
/// trapezohedron); the buffer cubes are the cells of this project's buffer layer; the last is from C. Carbonera's HexMeshing examples.
const BUILT_IN: [(&str, &str); 5] = [
    ("pyramid", "Q1:000000070017100700171605141317"),
    ("spindle", "Q1:00101005101312"),
    ("buffer-20", "Q1:00100006001016100010085605101014101412"),
    ("buffer-22", "Q1:000000070017001700101010009gb1122007152451"),
    ("carbonera-10", "Q1:001000061400100010001000191200h80816190015122k"),
];

/// What to look for among the classes.
#[derive(Clone, Copy, Default, Debug)]
pub struct Wanted<'a> {
    /// Count the classes of this selection.
    pub selection: Option<&'a Selection>,
    /// Keep the codes of the selected classes.
    pub list: bool,
    /// Recognise these boundaries.
    pub targets: &'a [Target],
}

/// What was found.
#[derive(Clone, Default, Debug, PartialEq, Eq)]
pub struct Found {
    /// Codes of the selected classes, if a list was asked for.
    pub selected: Vec<Code>,
    /// Index of the target and code of each class recognised.
    pub targets: Vec<(usize, Code)>,
}

impl Found {
    /// Looks at one class.
    pub(crate) fn look(
        &mut self,
        wanted: &Wanted<'_>,
        counter: &mut Counter,
        boundary: &Boundary,
        shape: &Shape,
        code: Code,
    ) {
        if wanted.selection.is_some_and(|s| s.wants(boundary, shape)) {
            counter.selected();
            if wanted.list {
                self.selected.push(code);
            }
        }
        for (i, target) in wanted.targets.iter().enumerate() {
            if target.is(boundary) {
                self.targets.push((i, code));
            }
        }
    }

    /// Adds what another found.
    pub fn merge(&mut self, other: Self) {
        self.selected.extend(other.selected);
        self.targets.extend(other.targets);
    }

    /// Ascending codes.
    pub(crate) fn sort(&mut self) {
        self.selected.sort_unstable();
        self.targets.sort_unstable();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Complex;

    #[test]
    fn built_in_targets_are_spheres_with_their_published_keys() {
        let all = Target::built_in().unwrap();
        let quads: Vec<usize> = all.iter().map(|t| t.key.n_quads()).collect();
        assert_eq!(quads, [16, 8, 20, 22, 24]);
        assert_eq!(all[0].key.to_string(), "8x[8,16] 8x[16,16]");
        assert_eq!(all[1].key.to_string(), "8x[8,8]");
        for (_, signature) in BUILT_IN {
            assert!(parse_surface_signature(signature).unwrap().is_sphere());
        }
    }

    #[test]
    fn a_boundary_is_recognised_by_key_and_by_signature() {
        let b = Boundary::of(&Complex::cube());
        assert!(Target::parse("6x[4,4]").unwrap().is(&b));
        let signature = surface_signature(&b.to_surface().unwrap());
        assert!(Target::parse(&signature).unwrap().is(&b));
        assert!(Target::built_in().unwrap().iter().all(|t| !t.is(&b)));
        assert!(Target::parse("nonsense").is_err() && Target::parse("Q1:***").is_err());
    }
}
