//! [`Choice`]: why this mesh and no other.
//!
//! Source: ours.

use crate::fill::filled::{Filled, Route};
use serde::{Serialize, Serializer};
use std::fmt;

/// Of so many components at most the choice is told in words.
const MOST_TOLD: usize = 8;

/// A mesh that was considered.
#[derive(Clone, PartialEq, Debug)]
#[non_exhaustive]
pub struct Candidate {
    /// Its hexes.
    pub hexes: usize,
    /// How it was found.
    pub route: Route,
    /// What its geometry came to.
    pub outcome: Outcome,
}

/// What the geometry of a candidate came to.
#[derive(Clone, Copy, PartialEq, Debug)]
#[non_exhaustive]
pub enum Outcome {
    /// det J > 0 certified in every hex, with this worst scaled Jacobian.
    Certified(f64),
    /// Embedded, and some hex is not certified.
    NotCertified,
    /// Not embedded: no positions reach more than this scaled Jacobian.
    Bounded(f64),
}

/// Why this mesh and no other. Its words are for people, and JSON holds them.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct Choice {
    /// Hexes and route of the mesh that was kept, where there were several.
    pub kept: Option<(usize, Route)>,
    /// The meshes that were considered one by one, in the order of the work.
    pub candidates: Vec<Candidate>,
    /// How many fillings were embedded together, the best being kept.
    pub best_of: Option<usize>,
    /// Why no further mesh was tried.
    pub none_tried: Option<String>,
    /// Why each mesh had one start only.
    pub one_start: Option<String>,
    /// Boundary layers cut.
    pub layers: Option<u32>,
    /// Why this mesh of a component and no other, for those of several where there was a choice; by number from 0.
    pub components: Vec<(usize, Choice)>,
}

impl Candidate {
    pub(crate) fn new(filled: &Filled, outcome: Outcome) -> Self {
        Self { hexes: filled.mesh.n_hexes(), route: filled.route, outcome }
    }
}

impl Choice {
    /// Whether there is nothing to say.
    pub fn is_empty(&self) -> bool {
        self.kept.is_none()
            && self.best_of.is_none()
            && self.none_tried.is_none()
            && self.one_start.is_none()
            && self.layers.is_none()
            && self.components.is_empty()
    }
}

/// "36 hexes by atlas look-up".
struct Made(usize, Route);

impl fmt::Display for Made {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} hex{} by {}", self.0, if self.0 == 1 { "" } else { "es" }, self.1.words())
    }
}

impl fmt::Display for Candidate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        Made(self.hexes, self.route).fmt(f)?;
        match self.outcome {
            Outcome::Certified(worst) => write!(f, " ({worst:.3})"),
            Outcome::NotCertified => write!(f, " (not certified)"),
            Outcome::Bounded(bound) => write!(f, " (star bound {bound:.3})"),
        }
    }
}

impl fmt::Display for Choice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kept = self.kept.map(|(hexes, route)| {
            let seen: Vec<String> = self.candidates.iter().map(ToString::to_string).collect();
            format!("{}, the best of {}", Made(hexes, route), seen.join(", "))
        });
        let best_of = self.best_of.map(|n| format!("the best of {n} meshes"));
        let other = if self.candidates.len() > 1 { "further" } else { "other" };
        let none_tried = self.none_tried.as_ref().map(|why| format!("no {other} mesh was tried, since {why}"));
        let one_start = self.one_start.as_ref().map(|why| format!("one start for each mesh, since {why}"));
        let layers = self.layers.map(|n| format!("{n} boundary layers"));
        let told = self.components.iter().take(MOST_TOLD).map(|(c, choice)| format!("component {c}: {choice}"));
        let rest = self.components.len().checked_sub(MOST_TOLD + 1).map(|n| format!("and {} components more", n + 1));
        let components = told.chain(rest);
        let all: Vec<String> =
            [kept, best_of, none_tried, one_start, layers].into_iter().flatten().chain(components).collect();
        f.write_str(&all.join("; "))
    }
}

impl Serialize for Choice {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}
