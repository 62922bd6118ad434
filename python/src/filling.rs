//! Verbs that make meshes: fill, embed, simplify. Each returns the mesh, a report as JSON, and whether Ctrl-C ended it.

use crate::choices::choice;
use crate::data::{Data, ids};
use crate::failure::Failure;
use crate::words::in_python;
use crate::work::{Run, limit, run};
use hexfill::io::MeshData;
use hexfill::{
    BoundaryLayers, CellChoice, Collapse, Context, Effort, EmbedOptions, FillOptions, FillReport, Objective,
    PlaceOptions, Placed, PlacedFill, Prefer, Problem, Region, SimplifyOptions, StopReason, Strategy,
};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use serde_json::{Value, json};
use std::sync::Arc;

/// A mesh, its report, and whether Ctrl-C ended the work.
type Made = (Data, String, bool);

/// Options of [`fill`]: a dictionary.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Filling {
    strategy: String,
    prefer: String,
    effort: String,
    layers: Option<u32>,
    layer_height: Option<f64>,
    growth: f64,
    max_hexes: Option<u32>,
    best_of: usize,
    embed: bool,
    embed_limit: Option<f64>,
    simplify: bool,
}

impl Filling {
    fn options(&self, has_limit: bool) -> Result<FillOptions, Failure> {
        let strategies = [
            ("auto", Strategy::Auto),
            ("shell", Strategy::Shell),
            ("atlas", Strategy::Atlas),
            ("construct", Strategy::Construct),
        ];
        let preferences = [("balance", Prefer::Balance), ("hexes", Prefer::Hexes), ("quality", Prefer::Quality)];
        let efforts = [("fast", Effort::Fast), ("normal", Effort::Normal), ("best", Effort::Best)];
        // As on the command line: what is not embedded is made as small as the time allows.
        let simplify = self.simplify || !self.embed && has_limit;
        let balls = if has_limit { u64::MAX } else { SIMPLIFY_BALLS };
        let (height, growth) = (self.layer_height, self.growth);
        let mut options = FillOptions::default()
            .with_strategy(choice("strategy", &self.strategy, &strategies)?)
            .with_prefer(choice("prefer", &self.prefer, &preferences)?)
            .with_effort(choice("effort", &self.effort, &efforts)?)
            .with_max_hexes(self.max_hexes.unwrap_or(u32::MAX))
            .with_count(self.best_of)
            .with_cells(if self.embed { CellChoice::Embeddable } else { CellChoice::Fewest });
        if simplify {
            options = options.with_simplify(SimplifyOptions::default().with_balls(balls));
        }
        if let Some(count) = self.layers {
            options = options.with_layers(BoundaryLayers { count, height, growth });
        }
        Ok(options)
    }

    fn placing(&self) -> PlaceOptions {
        let how = PlaceOptions::default().with_best(self.best_of > 1);
        let how = limit(self.embed_limit).map_or(how, |limit| how.with_limit(limit));
        if self.embed { how } else { how.without_embedding() }
    }
}

/// Balls that `simplify` tries without a time limit.
const SIMPLIFY_BALLS: u64 = 200_000;

/// Fills a surface.
///
/// # Errors
/// `SurfaceError`, `NoMeshExists`, `NoMeshFound`, `InputError`.
#[pyfunction]
pub(crate) fn fill(
    py: Python<'_>,
    surface: &Data,
    name: String,
    options: Filling,
    time_limit: Option<f64>,
    how: Run,
) -> PyResult<Made> {
    let surface = Arc::clone(&surface.0);
    let options_of_fill = options.options(time_limit.is_some()).map_err(|failure| failure.raise(py))?;
    let ((data, report), interrupted) =
        run(py, how, move |ctx| filled(&surface, &name, &options, &options_of_fill, ctx))?;
    Ok((data.into(), report, interrupted))
}

fn filled(
    surface: &MeshData,
    name: &str,
    options: &Filling,
    fill: &FillOptions,
    ctx: &Context<'_>,
) -> Result<(MeshData, String), Failure> {
    let problem = Problem::from_data(name, surface);
    if surface.middles.is_empty() && hexfill::has_regions(surface, &problem) {
        let found = hexfill::regions(name, surface)?;
        if !found.is_empty() {
            return regions_filled(surface, name, &found, options, fill, ctx);
        }
    }
    let problem = problem?;
    let made = hexfill::fill_placed(&problem, fill, &options.placing(), ctx)?;
    let Some((filled, placed)) = made.meshes.first() else {
        return Err(none_found("no mesh was found", &made));
    };
    let mut data = hexfill::mesh_data(&problem, filled.mesh(), placed.as_ref().map(|p| p.points().to_vec()));
    if let Some(placed) = placed.as_ref().filter(|_| options.embed) {
        placed.flag(&mut data);
    }
    filled.flag(&mut data);
    let mut report = report(&problem, &made);
    report["stopped"] = json!(made.stop);
    report["choice"] = json!(made.choice);
    report["notes"] = json!(problem.notes());
    Ok((data, in_python(&report.to_string())))
}

/// Several regions with shared walls, or a void among hexes: each filled by itself, the whole returned.
fn regions_filled(
    surface: &MeshData,
    name: &str,
    found: &[Region],
    options: &Filling,
    fill: &FillOptions,
    ctx: &Context<'_>,
) -> Result<(MeshData, String), Failure> {
    if options.best_of > 1 {
        return Err(Failure::input(format!("{name} has {} regions; best_of is for one surface", found.len())));
    }
    let whole = hexfill::fill_regions(surface, found, fill, &options.placing(), ctx)?;
    if let Some((i, made)) = whole.fills.iter().enumerate().find(|(_, made)| made.meshes.is_empty()) {
        return Err(none_found(&format!("no mesh of region {} of {} was found", i + 1, found.len()), made));
    }
    let reports: Vec<Value> =
        found.iter().zip(&whole.fills).map(|(region, made)| report(&region.problem, made)).collect();
    let report = json!({
        "regions": reports,
        "hexes": whole.data.hexes.len(),
        "given_invalid": whole.given_invalid,
        "stopped": whole.stop,
        "notes": surface.notes,
    });
    Ok((whole.data, in_python(&report.to_string())))
}

/// The numbers of the first mesh.
fn report(problem: &Problem, made: &PlacedFill) -> Value {
    let Some((filled, placed)) = made.meshes.first() else { return Value::Null };
    let mut report = json!(FillReport::new(problem, filled, &made.tried));
    report["geometry"] = json!(placed.as_ref().map(Placed::report));
    report
}

fn none_found(what: &str, made: &PlacedFill) -> Failure {
    let tried: Vec<String> = made.tried.iter().map(ToString::to_string).collect();
    let (stopped, tried) = (made.stop, tried.join("; "));
    let message = format!("{what} within the bounds ({stopped}), which does not mean that none exists; tried: {tried}");
    Failure::not_found(message, stopped.word())
}

/// The regions of a surface with walls, or the voids among hexes: the surface of each, and its points in the whole.
///
/// # Errors
/// `SurfaceError`, `MeshError`.
#[pyfunction]
pub(crate) fn regions<'py>(
    py: Python<'py>,
    data: &Data,
    name: String,
    how: Run,
) -> PyResult<Vec<(Data, Bound<'py, PyBytes>)>> {
    let data = Arc::clone(&data.0);
    let (found, _) = run(py, how, move |_| Ok(hexfill::regions(&name, &data)?))?;
    Ok(found.into_iter().map(|region| (region.problem.data().into(), ids(py, &region.points))).collect())
}

/// What makes hexes, in words: the numbers of the field `engine` are places in this list.
#[pyfunction]
pub(crate) fn engines() -> Vec<&'static str> {
    hexfill::Maker::ALL.iter().map(|maker| maker.words()).collect()
}

/// The hexes of file data, or why there are none to work on.
fn need_hexes(data: &MeshData) -> Result<(), Failure> {
    if data.hexes.is_empty() {
        return Err(Failure::input("there are no hexes; give a hex mesh (hexfill.fill makes one from a surface)"));
    }
    Ok(())
}

/// Moves the interior vertices of a mesh.
///
/// # Errors
/// `MeshError`, `InputError`.
#[pyfunction]
pub(crate) fn embed(
    py: Python<'_>,
    mesh: &Data,
    objective: &str,
    starts: u32,
    fresh: bool,
    symmetric: bool,
    how: Run,
) -> PyResult<Made> {
    let objectives =
        [("sj", Objective::ScaledJacobian), ("balanced", Objective::Balanced), ("untangle", Objective::UntangleOnly)];
    let objective = choice("objective", objective, &objectives).map_err(|failure| failure.raise(py))?;
    let options = EmbedOptions::new(objective).with_starts(starts).with_symmetric(symmetric);
    let data = Arc::clone(&mesh.0);
    let ((data, report), interrupted) = run(py, how, move |ctx| embedded(&data, fresh, &options, ctx))?;
    Ok((data.into(), report, interrupted))
}

fn embedded(
    data: &MeshData,
    fresh: bool,
    options: &EmbedOptions,
    ctx: &Context<'_>,
) -> Result<(MeshData, String), Failure> {
    need_hexes(data)?;
    if !data.has_coordinates {
        return Err(Failure::input(
            "the mesh has no coordinates; hexfill.fill places the boundary of a surface without any",
        ));
    }
    let mesh = data.hex_mesh()?;
    let start = (!fresh).then_some(data.points.as_slice());
    let placed = hexfill::embed_mesh(&mesh, &data.points, start, options, ctx)?;
    let stopped = placed.embedding().map_or(StopReason::Finished, |report| report.stop);
    let mut out = data.clone();
    placed.flag(&mut out);
    out.points = placed.points().to_vec();
    let report: Value = json!({ "geometry": placed.report(), "stopped": stopped });
    Ok((out, report.to_string()))
}

/// Makes a mesh smaller.
///
/// # Errors
/// `MeshError`, `InputError`.
#[pyfunction]
pub(crate) fn simplify(
    py: Python<'_>,
    mesh: &Data,
    balls: Option<u64>,
    collapse_only: Option<&str>,
    heat: Option<u32>,
    time_limit: Option<f64>,
    how: Run,
) -> PyResult<Made> {
    let collapse = collapse_only
        .map(|which| choice("collapse_only", which, &[("all", Collapse::All), ("inside", Collapse::Inside)]));
    let collapse = collapse.transpose().map_err(|failure| failure.raise(py))?;
    let balls = match (balls, time_limit) {
        _ if collapse.is_some() => 0,
        (Some(balls), _) => balls,
        (None, Some(_)) => u64::MAX,
        (None, None) => hexfill::default_balls(mesh.0.hexes.len()),
    };
    let mut options = SimplifyOptions::default().with_balls(balls).with_collapse(collapse.unwrap_or_default());
    if let Some(heat) = heat {
        options = options.with_heat(heat);
    }
    let data = Arc::clone(&mesh.0);
    let ((data, report), interrupted) = run(py, how, move |ctx| simplified(&data, &options, ctx))?;
    Ok((data.into(), report, interrupted))
}

fn simplified(data: &MeshData, options: &SimplifyOptions, ctx: &Context<'_>) -> Result<(MeshData, String), Failure> {
    need_hexes(data)?;
    let others = data.cell_count() - data.hexes.len();
    if others > 0 {
        return Err(Failure::input(format!(
            "there are {others} cells that are no hexes; only pure hex meshes can be simplified"
        )));
    }
    let made = hexfill::simplify(data, options, None, ctx)?;
    let r = &made.report;
    let report = json!({
        "hexes_before": r.before,
        "hexes": r.after,
        "sheets": r.sheets,
        "columns": r.columns,
        "collapsed_hexes": r.collapsed,
        "balls": r.balls,
        "looked_up": r.looked_up,
        "exchanges": r.exchanges,
        "stopped": r.stop,
        "notes": made.data.notes,
    });
    Ok((made.data, report.to_string()))
}
