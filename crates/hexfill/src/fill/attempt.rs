//! [`Attempt`]: what was tried.
//!
//! Source: ours.

use hexfill_construct::{ConstructError, Report};
use hexfill_search::{MAX_CAP, SimplifyReport};
use serde::{Serialize, Serializer};
use std::fmt;
use std::sync::Arc;

/// One thing that was tried; its words are for people, and JSON holds them.
///
/// ```
/// use hexfill::{Attempt, Context, FillOptions, Problem, Strategy, fill};
/// let cube = Problem::named("cube")?;
/// let made = fill(&cube, &FillOptions::default().with_strategy(Strategy::Construct), &Context::default())?;
/// assert!(matches!(&made.tried[..], [Attempt::Construction(_)]));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Attempt {
    /// Atlas look-up and inward flips.
    Atlas {
        /// States of the atlas.
        states: usize,
        /// Cavities looked at.
        cavities: u64,
    },
    /// More fillings of one small surface.
    Fillings {
        /// How many were found.
        found: usize,
    },
    /// Growth of an atlas towards the surface.
    Growth {
        /// Most quads of a ball.
        cap: usize,
        /// States kept per class.
        width: u32,
        /// Hexes reached.
        hexes: u32,
        /// Classes found.
        classes: u64,
    },
    /// No growth: the surface has too many quads.
    NoGrowth,
    /// Shelling.
    Shelling {
        /// Quads of the compressed surface.
        coarse_quads: usize,
        /// Complete meshes.
        meshes: usize,
        /// Fewest coarse quads that a sweep left; `usize::MAX` if it was stopped.
        left: usize,
    },
    /// Hexes laid one by one at valid positions.
    Laying {
        /// Complete meshes kept.
        meshes: usize,
    },
    /// Pillows round the last hexes without valid positions.
    Mending {
        /// Whether all are valid then.
        found: bool,
    },
    /// Pillows between the stages of a shelled mesh without valid positions.
    Pillows {
        /// Whether it has some then.
        found: bool,
    },
    /// Three sheets made one inside a shelled mesh.
    Coarsening {
        /// Hexes before.
        before: usize,
        /// Hexes after.
        after: usize,
        /// Whether that is better.
        found: bool,
    },
    /// The construction.
    Construction(Box<Report>),
    /// A construction that the context stopped.
    ConstructionStopped,
    /// The construction refused, and another way may remain.
    NoConstruction(Arc<ConstructError>),
    /// A construction made smaller.
    Simplification(SimplifyReport),
    /// What was tried for one of several components.
    Component {
        /// Its number among the solids, from 0.
        component: usize,
        /// What was tried.
        attempt: Box<Attempt>,
    },
}

impl fmt::Display for Attempt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Atlas { states, cavities } => {
                write!(f, "atlas of {states} states, inward flips over {cavities} cavities")
            }
            Self::Fillings { found } => write!(f, "{found} fillings"),
            Self::Growth { cap, width, hexes, classes } => {
                write!(f, "growth with cap {cap} and width {width} to {hexes} hexes: {classes} classes")
            }
            Self::NoGrowth => write!(f, "no growth: the surface has more than {MAX_CAP} quads"),
            Self::Shelling { coarse_quads, meshes, left } => {
                write!(f, "shelling from {coarse_quads} coarse quads: ")?;
                match (meshes, left) {
                    (0, &usize::MAX) => write!(f, "stopped"),
                    (0, 0) => write!(f, "nothing that lifts"),
                    (0, left) => write!(f, "{left} quads left"),
                    (n, _) => write!(f, "{n} meshes"),
                }
            }
            Self::Laying { meshes: 0 } => write!(f, "laying, in vain"),
            Self::Laying { meshes } => write!(f, "laying: {meshes} meshes"),
            Self::Mending { found: true } => write!(f, "pillows round the last hexes that were not valid"),
            Self::Mending { found: false } => write!(f, "pillows round the last hexes that were not valid, in vain"),
            Self::Pillows { found: true } => write!(f, "pillows between stages of the shelling"),
            Self::Pillows { found: false } => write!(f, "pillows between stages of the shelling, in vain"),
            Self::Coarsening { before, after, found } => {
                write!(f, "coarsening from {before} to {after} hexes{}", if *found { "" } else { ", in vain" })
            }
            Self::Construction(report) => report.fmt(f),
            Self::ConstructionStopped => write!(f, "construction, stopped before the mesh was complete"),
            Self::NoConstruction(why) => write!(f, "no construction: {why}"),
            Self::Simplification(SimplifyReport { before, after, sheets, columns, balls, .. }) => write!(
                f,
                "simplification from {before} to {after} hexes over {balls} balls, {sheets} sheets and {columns} columns collapsed"
            ),
            Self::Component { component, attempt } => write!(f, "component {component}: {attempt}"),
        }
    }
}

impl Serialize for Attempt {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}
