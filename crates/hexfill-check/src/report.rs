//! What the judge says: which level passed, which rule fails where, and facts about the mesh.

use crate::geometry::overlap::Overlap;
use crate::geometry::quality::Quality;
use crate::rule::{Level, Rule, Rules};
use hexfill_mesh::{HexId, QuadId, VertexId};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt;

/// The cells at which a rule is broken.
#[derive(Clone, Debug, PartialEq, Eq, Default, Serialize)]
pub struct Offender {
    /// Hexes concerned.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub hexes: Vec<u32>,
    /// Quads of the given surface concerned.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub quads: Vec<u32>,
    /// Vertices concerned: a vertex, an edge or diagonal (2), a quad in cyclic order (4).
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub vertices: Vec<u32>,
    /// What there is to add, for a person.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub note: String,
}

impl Offender {
    /// Hexes `hexes` at vertices `vertices`.
    pub fn at(hexes: &[u32], vertices: &[u32]) -> Self {
        Self { hexes: hexes.to_vec(), vertices: vertices.to_vec(), ..Self::default() }
    }

    /// The surface quad `quad` with vertices `vertices`.
    pub fn quad(quad: u32, vertices: &[u32]) -> Self {
        Self { quads: vec![quad], vertices: vertices.to_vec(), ..Self::default() }
    }

    /// The same offender with a note.
    #[must_use]
    pub fn note(self, note: impl Into<String>) -> Self {
        Self { note: note.into(), ..self }
    }
}

impl fmt::Display for Offender {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut space = "";
        for &h in &self.hexes {
            write!(f, "{space}{}", HexId(h))?;
            space = " ";
        }
        for &q in &self.quads {
            write!(f, "{space}{}", QuadId(q))?;
            space = " ";
        }
        if !self.vertices.is_empty() {
            write!(f, "{space}(")?;
            for (i, &v) in self.vertices.iter().enumerate() {
                write!(f, "{}{}", if i == 0 { "" } else { " " }, VertexId(v))?;
            }
            f.write_str(")")?;
            space = " ";
        }
        if self.note.is_empty() { Ok(()) } else { write!(f, "{space}{}", self.note) }
    }
}

/// A broken rule.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Failure {
    /// The rule.
    pub rule: Rule,
    /// Its level.
    pub level: Level,
    /// How often it is broken.
    pub count: u64,
    /// The first offenders, at most ten, in order of id.
    pub first: Vec<Offender>,
}

/// How a level came out.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case", tag = "outcome", content = "why")]
#[non_exhaustive]
pub enum Outcome {
    /// Judged, no rule broken.
    Passed,
    /// Judged, and some rule is broken.
    Failed,
    /// Not judged, or not to the end, for this reason.
    NotJudged(String),
}

/// A level and how it came out.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct LevelReport {
    /// The level.
    pub level: Level,
    /// How it came out.
    #[serde(flatten)]
    pub outcome: Outcome,
}

/// A component of the mesh's boundary.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct BoundaryPart {
    /// Quads.
    pub quads: u64,
    /// Euler characteristic (of the surface with its pinched vertices pulled apart).
    pub euler: i64,
    /// Genus, if orientable.
    pub genus: Option<u64>,
}

/// Whether the mesh is a 3-ball.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Ball {
    /// Yes: it is a manifold and it collapses to a point.
    Yes,
    /// It has the homology of a ball over GF(2) and a sphere as boundary; no collapse to a point was found.
    Homology,
    /// No.
    No,
    /// Not determined: not a manifold, or Betti numbers were not asked for.
    Unknown,
}

/// How the surface given is oriented relative to the outward side of the mesh's hexes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum SurfaceSense {
    /// Every matching quad turns as the outward facet of its hex.
    Outward,
    /// Every matching quad turns the other way.
    Inward,
    /// Some of each.
    Mixed,
}

/// Numbers about the connectivity. What could not be computed for a mesh as broken as this one is absent.
#[derive(Clone, Debug, PartialEq, Eq, Default, Serialize)]
pub struct Facts {
    /// Hexes.
    pub hexes: u64,
    /// Vertex ids.
    pub vertices: u64,
    /// Vertex ids that no hex uses.
    pub unused_vertices: u64,
    /// Vertices in no boundary quad.
    pub interior_vertices: Option<u64>,
    /// Edges.
    pub edges: Option<u64>,
    /// Quads, boundary and interior.
    pub quads: Option<u64>,
    /// Quads in one hex.
    pub boundary_quads: Option<u64>,
    /// Euler characteristic: vertices used - edges + quads - hexes.
    pub euler: Option<i64>,
    /// Betti numbers over GF(2): b0, b1, b2, b3.
    pub betti: Option<[u64; 4]>,
    /// Parts connected through quads.
    pub parts: Option<u64>,
    /// Parts without boundary.
    pub closed_parts: Option<u64>,
    /// Whether the mesh can be oriented.
    pub orientable: Option<bool>,
    /// Whether the mesh is a ball.
    pub ball: Option<Ball>,
    /// Components of the boundary (through edges), largest first; absent where an edge is in more than two boundary quads.
    pub boundary: Option<Vec<BoundaryPart>>,
    /// How the surface is oriented relative to the hexes.
    pub surface_sense: Option<SurfaceSense>,
}

/// The verdict.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// Version of the judge.
    pub version: &'static str,
    /// The definition level 2 used.
    pub rules: Rules,
    /// Every level and how it came out.
    pub levels: Vec<LevelReport>,
    /// Every broken rule, lowest level first.
    pub failures: Vec<Failure>,
    /// Numbers about the connectivity.
    pub facts: Facts,
    /// Numbers about the geometry; absent if level 5 was not judged.
    pub geometry: Option<Geometry>,
}

/// Numbers about the geometry.
#[derive(Clone, Debug, PartialEq, Default, Serialize)]
pub struct Geometry {
    /// Hexes with det J > 0 certified everywhere.
    pub certified: u64,
    /// Hexes with a point at which det J is zero or negative.
    pub not_positive: u64,
    /// Hexes for which neither was shown.
    pub undecided: u64,
    /// Quality numbers; absent if not asked for.
    pub quality: Option<Quality>,
    /// Whether the mesh overlaps itself; absent if not asked for.
    pub overlap: Option<Overlap>,
}

/// "1 hex", "2 hexes".
fn hexes(n: u64) -> String {
    format!("{n} hex{}", if n == 1 { "" } else { "es" })
}

impl fmt::Display for Geometry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "det J > 0 certified in {}, not positive in {}, undecided in {}",
            hexes(self.certified),
            self.not_positive,
            self.undecided
        )?;
        if let Some(o) = &self.overlap {
            let verdict = if o.injective { "proved that the mesh does not overlap" } else { "overlap is not excluded" };
            writeln!(f, "{verdict}: {} of {} near pairs of boundary quads not separated", o.not_separated, o.pairs)?;
            for [a, b] in &o.first {
                writeln!(f, "   {} and {}", Offender::at(&[], a), Offender::at(&[], b))?;
            }
        }
        let Some(q) = &self.quality else { return Ok(()) };
        writeln!(
            f,
            "scaled Jacobian: corners {:.6} (mean {:.6}), Verdict {:.6}, certified {:.9} .. {:.9}",
            q.min_corner_scaled_jacobian,
            q.mean_corner_scaled_jacobian,
            q.min_verdict_scaled_jacobian,
            q.certified_scaled_jacobian[0],
            q.certified_scaled_jacobian[1]
        )?;
        writeln!(f, "condition at most {:.4}, edge ratio at most {:.4}", q.max_condition, q.max_edge_ratio)?;
        writeln!(f, "volume: hexes {:e}, enclosed by the boundary {:e}", q.volume, q.boundary_volume)?;
        write!(f, "corner scaled Jacobian:")?;
        for (i, &count) in q.histogram.iter().enumerate().filter(|x| *x.1 > 0) {
            write!(f, " [{:.1} {:.1}) {count}", i as f64 / 10.0 - 1.0, (i + 1) as f64 / 10.0 - 1.0)?;
        }
        write!(f, "\nworst:")?;
        for worst in &q.worst {
            write!(f, " {} {:.6}", HexId(worst.hex), worst.corner_scaled_jacobian)?;
        }
        writeln!(f)
    }
}

impl Report {
    /// How `level` came out.
    pub fn outcome(&self, level: Level) -> &Outcome {
        &self.levels[level as usize].outcome
    }

    /// Whether `level` and every level below it were judged and passed.
    pub fn passed(&self, level: Level) -> bool {
        self.levels[..=level as usize].iter().all(|l| l.outcome == Outcome::Passed)
    }

    /// The highest level up to which everything passed.
    pub fn highest_passed(&self) -> Option<Level> {
        Level::ALL.into_iter().take_while(|&l| self.passed(l)).last()
    }

    /// Whether no rule was found broken (levels that were not judged say nothing).
    pub fn no_failure(&self) -> bool {
        self.failures.is_empty()
    }

    /// Whether `rule` was found broken.
    pub fn breaks(&self, rule: Rule) -> bool {
        self.failure(rule).is_some()
    }

    /// The failure of `rule`, if it was found broken.
    pub fn failure(&self, rule: Rule) -> Option<&Failure> {
        self.failures.iter().find(|f| f.rule == rule)
    }

    /// The names of all broken rules.
    pub fn broken_rules(&self) -> Vec<&'static str> {
        self.failures.iter().map(|f| f.rule.id()).collect()
    }

    /// The report as JSON text.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).unwrap_or_else(|e| format!("{{\"error\":\"{e}\"}}"))
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for level in &self.levels {
            let outcome = match &level.outcome {
                Outcome::Passed => "passed".to_string(),
                Outcome::Failed => "FAILED".to_string(),
                Outcome::NotJudged(why) => format!("not judged: {why}"),
            };
            writeln!(f, "{} {:<42} {outcome}", level.level, level.level.title())?;
            for failure in self.failures.iter().filter(|x| x.level == level.level) {
                writeln!(f, "   {} ({}): {}", failure.rule, failure.count, failure.rule.meaning())?;
                for offender in &failure.first {
                    writeln!(f, "      {offender}")?;
                }
                let rest = failure.count.saturating_sub(failure.first.len() as u64);
                if rest > 0 {
                    writeln!(f, "      and {rest} more")?;
                }
            }
        }
        write!(f, "{}", self.facts)?;
        self.geometry.as_ref().map_or(Ok(()), |g| write!(f, "{g}"))
    }
}

impl fmt::Display for Facts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let number = |n: Option<u64>| n.map_or("?".to_string(), |n| n.to_string());
        writeln!(
            f,
            "{}, {} vertices ({} interior, {} unused), {} edges, {} quads ({} boundary)",
            hexes(self.hexes),
            self.vertices,
            number(self.interior_vertices),
            self.unused_vertices,
            number(self.edges),
            number(self.quads),
            number(self.boundary_quads)
        )?;
        let euler = self.euler.map_or("?".to_string(), |n| n.to_string());
        let betti = self.betti.map_or("not computed".to_string(), |b| format!("{} {} {} {}", b[0], b[1], b[2], b[3]));
        let ball = match self.ball {
            Some(Ball::Yes) => "a ball",
            Some(Ball::Homology) => "a ball by homology over GF(2)",
            Some(Ball::No) => "not a ball",
            _ => "ball or not: unknown",
        };
        writeln!(f, "Euler characteristic {euler}, Betti numbers over GF(2): {betti}; {ball}")?;
        if let (Some(parts), Some(boundary)) = (self.parts, &self.boundary) {
            write!(f, "{parts} part{}; boundary: ", if parts == 1 { "" } else { "s" })?;
            if boundary.is_empty() {
                write!(f, "none")?;
            }
            for (i, part) in boundary.iter().take(10).enumerate() {
                let comma = if i == 0 { "" } else { ", " };
                match part.genus {
                    Some(g) => write!(f, "{comma}genus {g} ({} quads)", part.quads)?,
                    None => write!(f, "{comma}non-orientable, Euler {} ({} quads)", part.euler, part.quads)?,
                }
            }
            if boundary.len() > 10 {
                write!(f, " and {} more", boundary.len() - 10)?;
            }
            writeln!(f)?;
        }
        Ok(())
    }
}

/// Collects offenders: the first ten of each rule and the count. Merging in order of id keeps the result the
/// same for any number of threads.
#[derive(Clone, Debug, Default)]
pub(crate) struct Findings {
    by_rule: BTreeMap<Rule, (u64, Vec<Offender>)>,
}

impl Findings {
    pub(crate) const SHOWN: usize = 10;

    /// Counts one more offender of `rule`; `offender` is only asked for if it will be shown.
    pub(crate) fn add(&mut self, rule: Rule, offender: impl FnOnce() -> Offender) {
        let entry = self.by_rule.entry(rule).or_default();
        entry.0 += 1;
        if entry.1.len() < Self::SHOWN {
            entry.1.push(offender());
        }
    }

    /// Appends findings that come later in the order of ids.
    pub(crate) fn append(&mut self, later: Self) {
        for (rule, (count, first)) in later.by_rule {
            let entry = self.by_rule.entry(rule).or_default();
            entry.0 += count;
            let room = Self::SHOWN - entry.1.len();
            entry.1.extend(first.into_iter().take(room));
        }
    }

    pub(crate) fn count(&self, rule: Rule) -> u64 {
        self.by_rule.get(&rule).map_or(0, |e| e.0)
    }

    pub(crate) fn breaks_level(&self, level: Level) -> bool {
        self.by_rule.keys().any(|r| r.level() == level)
    }

    /// Drops what was found on the way about levels above `level`.
    pub(crate) fn forget_above(&mut self, level: Level) {
        self.by_rule.retain(|rule, _| rule.level() <= level);
    }

    pub(crate) fn into_failures(self) -> Vec<Failure> {
        self.by_rule
            .into_iter()
            .map(|(rule, (count, first))| Failure { rule, level: rule.level(), count, first })
            .collect()
    }
}
