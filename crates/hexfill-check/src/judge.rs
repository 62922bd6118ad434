//! [`judge`]: every level in turn, and the report.
//!
//! Source: ours: the rules are those of the book's page `definitions`, "The validity ladder".

use crate::geometry::overlap::overlap;
use crate::geometry::positions::{judge_jacobians, judge_positions};
use crate::geometry::quality::measure;
use crate::geometry::volume::enclosed;
use crate::input::{Judged, Options, Parts};
use crate::parallel::{piece, tasks, tasks_with};
use crate::report::{Ball, Facts, Findings, Geometry, LevelReport, Offender, Outcome, Report};
use crate::rule::{Level, Rule, Rules};
use crate::topology::boundary::{compare, parts};
use crate::topology::boundary_quad::BoundaryQuad;
use crate::topology::homology::homology;
use crate::topology::parity::ParityForest;
use crate::topology::shape::judge_shape;
use crate::topology::star::{StarJudge, StarRules, StarSums};
use crate::topology::stars::Stars;
use crate::topology::weill::replay;
use hexfill_mesh::{Context, StopReason};

/// Vertices judged as one task; fixed, so that results do not depend on the number of threads.
const CHUNK: usize = 1 << 12;
/// Tasks between two looks at the context.
const BATCH: usize = 64;

/// Judges `input` level by level, up to `options.up_to`, on the current rayon pool. Linear time and memory.
///
/// A level that fails does not hide the next ones: each is judged where the lower ones leave it a meaning (levels 2 to 5
/// need level 1). When `ctx` says stop, the levels not finished are reported as not judged.
///
/// # Example
/// Two hexes with one pair of corners exchanged in the second: the quad between them is twisted.
/// ```
/// use hexfill_check::{Judged, Level, Options, Rule, judge};
/// use hexfill_mesh::Context;
///
/// let mut hexes = [[0, 1, 2, 3, 4, 5, 6, 7], [4, 5, 6, 7, 8, 9, 10, 11]];
/// let options = Options::default().with_up_to(Level::L3);
/// assert!(judge(&Judged::connectivity(12, &hexes), &options, &Context::default()).passed(Level::L3));
///
/// hexes[1].swap(0, 1);
/// let report = judge(&Judged::connectivity(12, &hexes), &options, &Context::default());
/// let failure = report.failure(Rule::QuadTwisted).expect("the same four vertices in another cyclic order");
/// assert_eq!(failure.first[0].hexes, [0, 1]);
/// ```
pub fn judge(input: &Judged<'_>, options: &Options, ctx: &Context<'_>) -> Report {
    let mut run =
        Run { input, options, ctx, findings: Findings::default(), facts: Facts::default(), geometry: None, done: 0 };
    run.facts.hexes = input.hexes.len() as u64;
    run.facts.vertices = input.n_vertices as u64;
    let why = run.levels();
    // What was seen by the way above the level asked for is not reported: whoever asks for less gets the same report
    // whatever lies above.
    run.findings.forget_above(options.up_to);
    let levels = Level::ALL
        .into_iter()
        .map(|level| {
            let outcome = if run.findings.breaks_level(level) {
                Outcome::Failed
            } else if (level as usize) < run.done {
                Outcome::Passed
            } else {
                Outcome::NotJudged(why.clone().unwrap_or_else(|| "not asked for".into()))
            };
            LevelReport { level, outcome }
        })
        .collect();
    Report {
        version: env!("CARGO_PKG_VERSION"),
        rules: options.rules,
        levels,
        failures: run.findings.into_failures(),
        facts: run.facts,
        geometry: run.geometry,
    }
}

struct Run<'a> {
    input: &'a Judged<'a>,
    options: &'a Options,
    ctx: &'a Context<'a>,
    findings: Findings,
    facts: Facts,
    geometry: Option<Geometry>,
    /// How many levels were judged to the end.
    done: usize,
}

fn stopped(reason: StopReason) -> String {
    match reason {
        StopReason::TimeLimit => "the time limit was reached".into(),
        StopReason::MemoryLimit => "the memory limit was reached".into(),
        _ => "cancelled".into(),
    }
}

impl Run<'_> {
    /// Goes up the ladder; the reason if it ends before `options.up_to`.
    fn levels(&mut self) -> Option<String> {
        let (found, used) = judge_shape(self.input);
        self.findings.append(found);
        self.done = 1;
        // Only here it ends early: with an index out of range nothing above can even be asked. All other levels are
        // judged whatever failed before.
        if self.findings.breaks_level(Level::L1) {
            return Some("level 1 failed".into());
        }
        if self.options.up_to == Level::L1 {
            return None;
        }
        let stars = Stars::new(used, self.input.hexes);
        let forest = ParityForest::new(self.input.hexes.len());
        let mut sums = match self.stars(&stars, &forest) {
            Ok(sums) => sums,
            Err(why) => return Some(why),
        };
        self.findings.append(std::mem::take(&mut sums.findings));
        if self.options.rules == Rules::Weill {
            self.findings.append(replay(used, self.input.hexes));
        }
        self.done = 2;
        if self.options.up_to == Level::L2 {
            return None;
        }
        let boundary = std::mem::take(&mut sums.boundary);
        self.level_3(&stars, &forest, &sums, &boundary);
        self.done = 3;
        if self.options.up_to == Level::L3 {
            return None;
        }
        let Some(points) = self.input.points else { return Some("no positions were given".into()) };
        let found = judge_positions(self.input, points, &stars);
        self.findings.append(found);
        self.done = 4;
        if self.options.up_to == Level::L4 {
            return None;
        }
        if self.findings.count(Rule::PointsCount) + self.findings.count(Rule::PositionNotFinite) > 0 {
            return Some("level 4 failed".into());
        }
        self.level_5(points, &boundary).err()
    }

    /// det J > 0 everywhere, hex by hex, and quality.
    fn level_5(&mut self, points: &[[f64; 3]], boundary: &[BoundaryQuad]) -> Result<(), String> {
        let hexes = self.input.hexes;
        let mut geometry = Geometry::default();
        for (b, batch) in hexes.chunks(CHUNK * BATCH).enumerate() {
            if let Some(reason) = self.ctx.stop() {
                return Err(stopped(reason));
            }
            self.ctx.report("check det J", (b * CHUNK * BATCH) as u64, Some(hexes.len() as u64), String::new);
            let parts = tasks(batch.len().div_ceil(CHUNK), |i| {
                judge_jacobians((b * BATCH + i) * CHUNK, piece(batch, CHUNK, i), points)
            });
            parts.into_iter().for_each(|part| self.findings.append(part));
        }
        // From here on det J is judged; quality and overlap are extras that a stop may cut off.
        self.done = 5;
        let bad = |rule| self.findings.count(rule);
        geometry.not_positive = bad(Rule::HexInsideOut) + bad(Rule::JacobianNotPositive);
        geometry.undecided = bad(Rule::JacobianUndecided);
        geometry.certified = hexes.len() as u64 - geometry.not_positive - geometry.undecided;
        if self.options.quality {
            let valid = geometry.certified == hexes.len() as u64;
            geometry.quality = measure(hexes, points, enclosed(boundary, points), valid, self.ctx);
        }
        if self.options.overlap {
            let whole = geometry.certified == hexes.len() as u64
                && self.facts.parts == Some(1)
                && !self.findings.breaks_level(Level::L2)
                && !self.findings.breaks_level(Level::L3);
            geometry.overlap = overlap(boundary, points, whole, self.ctx);
        }
        self.geometry = Some(geometry);
        Ok(())
    }

    /// Judges the star of every vertex.
    fn stars(&mut self, stars: &Stars, forest: &ParityForest) -> Result<StarSums, String> {
        let strict = self.options.rules == Rules::Strict;
        let rules = StarRules { proper: strict, links: strict };
        let n_tasks = stars.len().div_ceil(CHUNK);
        let mut sums = StarSums::default();
        for first in (0..n_tasks).step_by(BATCH) {
            if let Some(reason) = self.ctx.stop() {
                return Err(stopped(reason));
            }
            let total = Some(stars.len() as u64);
            self.ctx.report("check stars", (first * CHUNK) as u64, total, String::new);
            let last = (first + BATCH).min(n_tasks);
            let parts = tasks_with(
                last - first,
                || StarJudge::new(self.input.hexes, forest, rules),
                |star, i| {
                    for v in (first + i) * CHUNK..((first + i + 1) * CHUNK).min(stars.len()) {
                        star.judge(v as u32, stars.of(v as u32));
                    }
                    std::mem::take(&mut star.sums)
                },
            );
            for part in parts {
                sums.findings.append(part.findings);
                sums.used += part.used;
                sums.on_boundary += part.on_boundary;
                sums.edges += part.edges;
                sums.quads += part.quads;
                sums.boundary.extend(part.boundary);
                sums.not_orientable.extend(part.not_orientable);
            }
        }
        Ok(sums)
    }

    fn level_3(&mut self, stars: &Stars, forest: &ParityForest, sums: &StarSums, boundary: &[BoundaryQuad]) {
        let facts = &mut self.facts;
        facts.unused_vertices = self.input.n_vertices as u64 - sums.used;
        facts.interior_vertices = Some(sums.used - sums.on_boundary);
        facts.edges = Some(sums.edges);
        facts.quads = Some(sums.quads);
        facts.boundary_quads = Some(boundary.len() as u64);
        facts.euler = Some(sums.used as i64 - sums.edges as i64 + sums.quads as i64 - self.input.hexes.len() as i64);
        facts.boundary = parts(boundary);
        if let Some(surface) = self.input.surface {
            let (found, sense) = compare(boundary, surface, self.input.hexes, stars);
            self.findings.append(found);
            self.facts.surface_sense = sense;
        }
        // Hexes round a quad that is in three of them have no sides to compare.
        if self.findings.count(Rule::QuadInThreeHexes) == 0 {
            self.orientation(forest, &sums.not_orientable);
        }
        self.parts(forest, boundary);
        self.homology(stars);
    }

    /// Names the parts that cannot be oriented, and in the others the hexes ordered against the majority.
    fn orientation(&mut self, forest: &ParityForest, not_orientable: &[u32]) {
        let mut crooked: Vec<u32> = not_orientable.iter().map(|&h| forest.find(h).0).collect();
        crooked.sort_unstable();
        crooked.dedup();
        self.facts.orientable = Some(crooked.is_empty());
        for &h in &crooked {
            self.findings.add(Rule::NonOrientable, || Offender::at(&[h], &[]).note("and its part of the mesh"));
        }
        if self.findings.count(Rule::OrientationClash) == 0 {
            return;
        }
        let n = self.input.hexes.len();
        let mut balance = vec![0i64; n];
        for h in 0..n as u32 {
            let (root, opposite) = forest.find(h);
            balance[root as usize] += if opposite { -1 } else { 1 };
        }
        for h in 0..n as u32 {
            let (root, opposite) = forest.find(h);
            // In a tie the smallest hex of the part is taken to be right.
            let minority = opposite == (balance[root as usize] >= 0);
            if minority && crooked.binary_search(&root).is_err() {
                self.findings.add(Rule::HexReflected, || Offender::at(&[h], &[]));
            }
        }
    }

    /// Counts the parts connected through quads.
    fn parts(&mut self, forest: &ParityForest, boundary: &[BoundaryQuad]) {
        let n = self.input.hexes.len();
        let mut open = vec![false; n];
        for quad in boundary {
            // A part without a boundary quad is closed, a 3-manifold of its own.
            open[forest.find(quad.hex).0 as usize] = true;
        }
        let roots: Vec<u32> = (0..n as u32).filter(|&h| forest.find(h).0 == h).collect();
        let closed: Vec<u32> = roots.iter().copied().filter(|&h| !open[h as usize]).collect();
        self.facts.parts = Some(roots.len() as u64);
        self.facts.closed_parts = Some(closed.len() as u64);
        let boundary_parts = self.facts.boundary.as_ref().map_or(1, Vec::len);
        let (limit, why) = match (self.options.parts, self.input.surface) {
            (Parts::Any, _) => return,
            (Parts::AsSurface, Some(_)) => (boundary_parts.max(1), "a further part"),
            _ => (1, "a further part"),
        };
        if self.input.surface.is_some() && self.options.parts == Parts::AsSurface {
            for &h in &closed {
                self.findings.add(Rule::MeshDisconnected, || Offender::at(&[h], &[]).note("a part without boundary"));
            }
        }
        if roots.len() > limit && self.findings.count(Rule::MeshDisconnected) == 0 {
            for &h in &roots[limit..] {
                self.findings.add(Rule::MeshDisconnected, || Offender::at(&[h], &[]).note(why));
            }
        }
    }

    /// Betti numbers, and whether the mesh is a ball.
    fn homology(&mut self, stars: &Stars) {
        self.facts.ball = Some(Ball::Unknown);
        if !self.options.betti || self.findings.count(Rule::QuadInThreeHexes) > 0 {
            return;
        }
        self.ctx.report("check homology", 0, None, String::new);
        let Some(found) = homology(self.input.hexes, stars, self.facts.closed_parts.unwrap_or(0), self.ctx) else {
            return;
        };
        self.facts.betti = Some(found.betti);
        if self.findings.breaks_level(Level::L2) || self.options.rules == Rules::Weill {
            return;
        }
        let links = [Rule::EdgePinched, Rule::VertexPinched, Rule::VertexLinkNotDisk, Rule::VertexLinkNotSphere];
        let manifold = links.iter().all(|&rule| self.findings.count(rule) == 0);
        let sphere = self.facts.boundary.as_ref().is_some_and(|b| b.len() == 1 && b[0].genus == Some(0));
        // Collapsed to a point, a manifold is a ball (Whitehead 1939). With the numbers of a ball and no such
        // collapse found it may be one; that is said as "homology".
        self.facts.ball = Some(if !manifold || !sphere || found.betti != [1, 0, 0, 0] {
            Ball::No
        } else if found.critical == [1, 0, 0, 0] {
            Ball::Yes
        } else {
            Ball::Homology
        });
    }
}
