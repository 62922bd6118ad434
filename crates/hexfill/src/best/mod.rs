//! Filling and placing in one: what a user wants is a mesh with valid coordinates.
//!
//! The smallest filling of a small surface often has none. Then more fillings are looked for, and at last the surface is
//! constructed, whose cells were chosen for their coordinates. Nothing is lost: where nothing is certified, the smallest
//! filling stays.
//!
//! Source: ours.

mod apart;
mod budget;
pub(crate) mod choice;
mod choose;
mod coarsen;
mod consider;
pub(crate) mod estimate;
mod hopeless;
mod leader;
mod mend;
mod no_room;
mod pillows;
mod rank;
mod stage;

use crate::fill::apart::lie_apart;
use crate::fill::attempt::Attempt;
use crate::fill::error::{FillError, check_fillable};
use crate::fill::fill;
use crate::fill::filled::{FillResult, Filled};
use crate::fill::options::{FillOptions, Strategy};
use crate::fill::scaled::Scaled;
use crate::place::placed::Placed;
use crate::place::{place_at, place_best, start_positions};
use crate::problem::Problem;
use crate::problem::solids::solids;
use apart::fill_best_apart;
use choice::Choice;
use choose::fill_best;
use hexfill_construct::CellChoice;
use hexfill_mesh::{Context, StopReason};
use std::time::Duration;

/// How to place fillings.
///
/// | option | default |
/// |---|---|
/// | embedding | each filling is embedded, in bounded work |
/// | best | no: every filling is kept |
/// | limit | none |
#[derive(Clone, Copy, Debug)]
pub struct PlaceOptions {
    pub(crate) embed: Option<hexfill_embed::Options>,
    pub(crate) best: bool,
    pub(crate) limit: Option<Duration>,
}

impl Default for PlaceOptions {
    fn default() -> Self {
        Self { embed: Some(hexfill_embed::Options::default()), best: false, limit: None }
    }
}

impl PlaceOptions {
    /// How to embed.
    #[must_use]
    pub fn with_embedding(self, options: hexfill_embed::Options) -> Self {
        Self { embed: Some(options), ..self }
    }

    /// Start positions only, judged only if the cells of the construction are embeddable ones.
    #[must_use]
    pub fn without_embedding(self) -> Self {
        Self { embed: None, ..self }
    }

    /// Keep the best of all fillings that were found, not each of them.
    #[must_use]
    pub fn with_best(self, best: bool) -> Self {
        Self { best, ..self }
    }

    /// How long one embedding may take; with [`with_best`](Self::with_best) all of them together.
    #[must_use]
    pub fn with_limit(self, limit: Duration) -> Self {
        Self { limit: Some(limit), ..self }
    }
}

/// Fillings with their coordinates.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct PlacedFill {
    /// The meshes, fewest hexes first, with positions if the surface has any.
    pub meshes: Vec<(Filled, Option<Placed>)>,
    /// Why the work ended.
    pub stop: StopReason,
    /// What was tried, in the order of the work.
    pub tried: Vec<Attempt>,
    /// Why this mesh and no other, if there was a choice.
    pub choice: Option<Choice>,
}

/// [`fill()`], then [`place`](crate::place). Where a single mesh is asked for, by any strategy ([`Strategy::Auto`]), and the first does not embed, others are
/// tried.
///
/// ```
/// use hexfill::{Context, FillOptions, PlaceOptions, Problem, fill_placed};
/// use std::time::Duration;
///
/// let pyramid = Problem::named("schneiders-pyramid")?;
/// let ctx = Context::default().with_time_limit(Duration::from_secs(60));
/// let made = fill_placed(&pyramid, &FillOptions::default(), &PlaceOptions::default(), &ctx)?;
/// let (filled, placed) = &made.meshes[0];
/// let placed = placed.as_ref().expect("the surface has positions");
/// assert!(filled.mesh().n_hexes() == 36 && placed.worst() > 0.316);
/// // Why this mesh: every engine that was asked, in words and as types.
/// assert!(!made.tried.is_empty() && made.tried[0].to_string().starts_with("atlas"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`fill()`].
pub fn fill_placed(
    problem: &Problem,
    options: &FillOptions,
    how: &PlaceOptions,
    ctx: &Context<'_>,
) -> Result<PlacedFill, FillError> {
    // A power of two changes no digit, but the judge works with the file's numbers: so it judges again once they are
    // back.
    if let Some(scaled) = Scaled::of(problem, options) {
        let mut made = fill_placed(&scaled.problem, &scaled.options, how, ctx)?;
        for (filled, placed) in &mut made.meshes {
            scaled.restore(filled);
            if let Some(placed) = placed {
                scaled.restore_points(&mut placed.points);
                if let Some(embedding) = &mut placed.embedding {
                    embedding.shortest_edge = scaled.restored(embedding.shortest_edge);
                }
                placed.judge_again(&filled.mesh);
            }
        }
        return Ok(made);
    }
    if let (Some(embed), Some(boundary)) = (&how.embed, problem.positions())
        && matches!(options.strategy, Strategy::Auto | Strategy::Shell)
        && options.count == 1
        && !options.improve
        && !how.best
    {
        let solids = solids(&problem.surface, Some(&boundary));
        if lie_apart(&solids, options) {
            return fill_best_apart(problem, &solids, options, how, &boundary, ctx);
        }
        if solids.len() == 1 {
            check_fillable(&problem.surface)?;
            return fill_best(problem, options, how, embed, &boundary, ctx);
        }
    }
    if options.layers.is_some() {
        return Err(FillError::NotForStrategy {
            what: "boundary layers are cut out of one embedded mesh of the strategies auto and shell".to_owned(),
            remedy: "use --strategy auto or shell, or leave --layers out",
        });
    }
    // Several meshes, a strategy of the caller's, or solids with tetrahedra from elsewhere: what is asked for is placed, and nothing else is tried.
    let FillResult { meshes, stop, tried } = fill(problem, options, ctx)?;
    let Some(boundary) = problem.positions().filter(|_| !meshes.is_empty()) else {
        return Ok(PlacedFill { meshes: meshes.into_iter().map(|m| (m, None)).collect(), stop, tried, choice: None });
    };
    let limited = || how.limit.map_or(*ctx, |limit| ctx.with_time_limit(limit));
    let mut choice = None;
    let placed: Vec<(Filled, Placed)> = match &how.embed {
        Some(embed) if how.best => {
            choice = Some(Choice { best_of: Some(meshes.len()), ..Choice::default() });
            place_best(&meshes, problem, &boundary, embed, &limited()).into_iter().collect()
        }
        embed => meshes
            .into_iter()
            .map(|filled| match embed {
                None if options.cells == CellChoice::Fewest => {
                    let placed = start_positions(&filled, &boundary, ctx);
                    (filled, placed)
                }
                embed => place_at(filled, problem, &boundary, embed.as_ref(), &limited()),
            })
            .collect(),
    };
    let meshes = placed.into_iter().map(|(filled, placed)| (filled, Some(placed))).collect();
    let stop = if stop == StopReason::Finished { ctx.stop().unwrap_or(stop) } else { stop };
    Ok(PlacedFill { meshes, stop, tried, choice })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fill::filled::Route;

    #[test]
    fn a_smallest_filling_without_coordinates_is_left_for_one_with() {
        let problem = Problem::named("buffer-cube-20").unwrap();
        let ctx = Context::default();
        let smallest = fill(&problem, &FillOptions::default(), &ctx).unwrap();
        let made = fill_placed(&problem, &FillOptions::default(), &PlaceOptions::default(), &ctx).unwrap();
        let (filled, placed) = &made.meshes[0];
        assert!(placed.as_ref().unwrap().is_certified(), "{:?}", made.tried);
        assert!(filled.mesh.n_hexes() > smallest.meshes[0].mesh.n_hexes());
        assert!(filled.route != Route::Construction);
    }

    #[test]
    fn a_mesh_gets_one_pillow_for_its_boundary_layers() {
        // Constructed, as nothing is swept: each split of a star used to be given one more pillow, without end.
        let cells = [[0, 0, 0], [0, 1, 0], [0, 2, 0], [1, 0, 0], [1, 0, 1], [1, 0, 2], [2, 0, 2], [2, 1, 2]];
        let (surface, points) = hexfill_mesh::generate::voxels([3, 3, 3], |p| cells.contains(&p)).unwrap();
        let problem = Problem::new("cells", surface, points.into_iter().map(|p| p.map(f64::from)).collect()).unwrap();
        let layers = hexfill_shell::BoundaryLayers { count: 2, height: None, growth: 1.0 };
        let mut options = FillOptions::default().with_layers(layers);
        options.shell = options.shell.with_direct(false).with_sweeps(false);
        let made = fill_placed(&problem, &options, &PlaceOptions::default(), &Context::default()).unwrap();
        let choice = made.choice.unwrap();
        assert_eq!(choice.layers, Some(2));
        assert!(choice.candidates.len() <= 3, "{choice}");
    }

    #[test]
    fn a_straight_corner_rules_out_every_mesh() {
        let mut problem = Problem::named("cube").unwrap();
        let points = problem.points.as_mut().unwrap();
        // One corner of the cube onto the line between two of its neighbours.
        let quad = problem.surface.quads()[0];
        let [a, b, c] = [0, 1, 2].map(|k: usize| quad[k].index());
        points[b] = [0, 1, 2].map(|k: usize| 0.5 * (points[a][k] + points[c][k]));
        let made =
            fill_placed(&problem, &FillOptions::default(), &PlaceOptions::default(), &Context::default()).unwrap();
        assert_eq!(made.meshes[0].0.mesh.n_hexes(), 1);
        assert!(!made.meshes[0].1.as_ref().unwrap().is_certified());
        assert!(
            made.choice.as_ref().is_some_and(|c| c.to_string().contains("straight or not convex")),
            "{:?}",
            made.choice
        );
    }
}
