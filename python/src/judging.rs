//! The judge's verdict on a mesh.

use crate::choices::choice;
use crate::data::{Data, floats};
use crate::failure::Failure;
use crate::work::{Run, run};
use hexfill::Problem;
use hexfill::io::MeshData;
use hexfill::unstable::check::{CellQuality, Level, Options, Report, Rules, cell_quality, judge};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;

/// The verdict as JSON, as text, whether all five levels passed, and numbers per hex (absent without positions, or if a hex is malformed).
type Verdict<'py> = (String, String, bool, Option<Bound<'py, PyDict>>);

/// Judges a mesh, against a surface or its own boundary.
///
/// # Errors
/// `InputError`, `SurfaceError`.
#[pyfunction]
pub(crate) fn check<'py>(
    py: Python<'py>,
    mesh: &Data,
    surface: Option<&Data>,
    rules: &str,
    overlap: bool,
    how: Run,
) -> PyResult<Verdict<'py>> {
    let rules = choice("rules", rules, &[("strict", Rules::Strict), ("weill", Rules::Weill)]);
    let options = Options::default().with_rules(rules.map_err(|failure| failure.raise(py))?).with_overlap(overlap);
    let (data, surface) = (Arc::clone(&mesh.0), surface.map(|s| Arc::clone(&s.0)));
    let ((report, cells), interrupted) = run(py, how, move |ctx| judged(&data, surface.as_deref(), &options, ctx))?;
    if interrupted {
        // Half a verdict is none.
        return Err(Failure::cancelled().raise(py));
    }
    let numbers = cells.map(|cells| by_name(py, &cells)).transpose()?;
    Ok((report.to_json(), report.to_string(), report.passed(Level::L5), numbers))
}

fn judged(
    data: &MeshData,
    surface: Option<&MeshData>,
    options: &Options,
    ctx: &hexfill::Context<'_>,
) -> Result<(Report, Option<Vec<CellQuality>>), Failure> {
    if data.hexes.is_empty() {
        return Err(Failure::input("there are no hexes; give a hex mesh (a surface is described by hexfill.info)"));
    }
    let problem = surface.map(|data| Problem::from_data("the surface", data)).transpose()?;
    Ok(hexfill::with_judged(data, problem.as_ref(), |judged| {
        let cells = data.has_coordinates.then(|| cell_quality(judged).into_iter().collect::<Option<_>>()).flatten();
        (judge(judged, options, ctx), cells)
    }))
}

fn by_name<'py>(py: Python<'py>, cells: &[CellQuality]) -> PyResult<Bound<'py, PyDict>> {
    let numbers = PyDict::new(py);
    let column = |name: &str, number: fn(&CellQuality) -> f64| {
        let all: Vec<f64> = cells.iter().map(number).collect();
        numbers.set_item(name, floats(py, &all))
    };
    column("certified", |c| f64::from(u8::from(c.valid)))?;
    column("scaled_jacobian", |c| c.certified_lower)?;
    column("corner_scaled_jacobian", |c| c.corner_scaled_jacobian)?;
    column("verdict_scaled_jacobian", |c| c.verdict_scaled_jacobian)?;
    column("condition", |c| c.condition)?;
    column("edge_ratio", |c| c.edge_ratio)?;
    column("volume", |c| c.volume)?;
    Ok(numbers)
}
