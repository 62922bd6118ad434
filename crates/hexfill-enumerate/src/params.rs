//! What to enumerate: size, rule, filter. Two runs with equal parameters count the same things.
//!
//! Source: Weill for the filter by chords.

use crate::complex::{Complex, MAX_CUBES};
use crate::error::EnumerateError;
use crate::strict::{StrictOptions, extend_strict};
use crate::weill::extend_weill;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// Which complexes count as legal.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Rule {
    /// The order-dependent rule of the published BruteBuilder table, see [`extend_weill`].
    Weill,
    /// Proper intersection of any two cubes, see [`extend_strict`].
    Strict,
}

impl fmt::Display for Rule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Weill => "weill",
            Self::Strict => "strict",
        })
    }
}

impl FromStr for Rule {
    type Err = EnumerateError;

    fn from_str(text: &str) -> Result<Self, EnumerateError> {
        match text {
            "weill" => Ok(Self::Weill),
            "strict" => Ok(Self::Strict),
            _ => Err(EnumerateError::BadParameters { why: format!("there is no rule {text:?}: weill or strict") }),
        }
    }
}

/// The poster's filter: from some size on, only complexes with few chords are extended.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize)]
pub struct Filter {
    /// Most chords a complex may have to be extended.
    pub max_chords: u8,
    /// The first size at which this is asked. Smaller complexes are all extended.
    pub from: usize,
}

/// The parameters of an enumeration.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize)]
pub struct Params {
    /// Number of cubes.
    pub cubes: usize,
    /// The rule.
    pub rule: Rule,
    /// Rule `strict` only: also gluings that make the complex non-orientable.
    pub nonorientable: bool,
    /// The poster's filter, if any.
    pub filter: Option<Filter>,
}

impl Params {
    /// All complexes of `cubes` cubes under a rule.
    pub fn new(cubes: usize, rule: Rule) -> Self {
        Self { cubes, rule, nonorientable: false, filter: None }
    }

    /// Checks that the parameters go together.
    ///
    /// # Errors
    /// [`EnumerateError::BadParameters`] if not.
    pub fn check(&self) -> Result<(), EnumerateError> {
        let bad = |why: String| Err(EnumerateError::BadParameters { why });
        if self.cubes == 0 || self.cubes > MAX_CUBES {
            return bad(format!("{} cubes asked for, 1 to {MAX_CUBES} are possible", self.cubes));
        }
        if self.nonorientable && self.rule == Rule::Weill {
            return bad("non-orientable gluings exist under rule strict only".into());
        }
        if self.filter.is_some_and(|f| f.from == 0) {
            return bad("the filter starts at one cube or more".into());
        }
        Ok(())
    }

    /// Whether the filter lets a complex of `cubes` cubes and `chords` chords be extended.
    pub fn extends(&self, cubes: usize, chords: u8) -> bool {
        self.filter.is_none_or(|f| cubes < f.from || chords <= f.max_chords)
    }

    /// Every legal extension of a parent by one cube.
    pub(crate) fn extend(&self, parent: &Complex, fewest_first: bool, visit: impl FnMut(&Complex, u8)) {
        match self.rule {
            Rule::Weill => extend_weill(parent, visit),
            Rule::Strict => {
                let options =
                    StrictOptions::default().with_nonorientable(self.nonorientable).with_fewest_first(fewest_first);
                extend_strict(parent, options, visit);
            }
        }
    }

    /// The differences to other parameters in words; empty if equal.
    pub fn differences(&self, expected: &Self) -> String {
        let mut out = Vec::new();
        let mut compare = |name: &str, found: String, wanted: String| {
            if found != wanted {
                out.push(format!("{name} is {found}, not {wanted}"));
            }
        };
        compare("cubes", self.cubes.to_string(), expected.cubes.to_string());
        compare("rule", self.rule.to_string(), expected.rule.to_string());
        compare("nonorientable", self.nonorientable.to_string(), expected.nonorientable.to_string());
        compare("filter", filter_text(self.filter), filter_text(expected.filter));
        out.join("; ")
    }
}

fn filter_text(filter: Option<Filter>) -> String {
    filter.map_or("none".into(), |f| format!("{} chords from {} cubes on", f.max_chords, f.from))
}
