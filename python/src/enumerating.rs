//! Every hex mesh of n cubes.

use crate::failure::Failure;
use crate::work::{Run, run};
use hexfill::Context;
use hexfill::unstable::enumerate::{
    EnumerateError, Filter, LevelOptions, ListFormat, Params, Plan, Rule, Selection, Tally, Wanted, all_levels, line,
    run_whole,
};
use pyo3::prelude::*;
use serde_json::json;

/// What to enumerate: a dictionary.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Enumeration {
    cubes: usize,
    rule: String,
    nonorientable: bool,
    max_chords: Option<u8>,
    filter_from: usize,
    boundary_quads: Option<(usize, usize)>,
    balls: bool,
    key: Option<String>,
    list: bool,
}

/// Enumerates; the counts as JSON, and the signatures of what was listed.
///
/// # Errors
/// `InputError`, `NoMeshFound` if it was stopped.
#[pyfunction]
pub(crate) fn enumerate(py: Python<'_>, what: Enumeration, how: Run) -> PyResult<(String, Vec<String>)> {
    let options = LevelOptions::default().with_threads(how.n_threads());
    let (made, _) = run(py, how, move |ctx| enumerated(&what, &options, ctx))?;
    Ok(made)
}

fn enumerated(what: &Enumeration, options: &LevelOptions, ctx: &Context<'_>) -> Result<(String, Vec<String>), Failure> {
    let params = Params {
        cubes: what.cubes,
        rule: what.rule.parse()?,
        nonorientable: what.nonorientable,
        filter: what.max_chords.map(|max_chords| Filter { max_chords, from: what.filter_from }),
    };
    params.check()?;
    let selection = Selection {
        boundary_quads: what.boundary_quads,
        balls: what.balls,
        max_chords: what.max_chords,
        key: what.key.as_deref().map(str::parse).transpose().map_err(EnumerateError::from)?,
    };
    let wanted = Wanted { selection: Some(&selection), list: what.list, targets: &[] };
    let mut levels: Vec<(usize, Tally)> = Vec::new();
    let mut codes = Vec::new();
    // As on the command line: canonical augmentation where it is possible, which needs no memory.
    if params.rule == Rule::Strict && params.filter.is_none() {
        let plan = Plan::prepare(&params, options, ctx)?;
        let (tally, found) = run_whole(&plan, options.threads(), wanted, ctx)?;
        levels.push((params.cubes, tally));
        codes = found.selected;
    } else {
        for level in all_levels(&params, options, wanted, false, ctx)? {
            codes.extend(level.found.selected);
            levels.push((level.cubes, level.tally));
        }
    }
    let rows: Vec<_> = levels.iter().map(|(n, tally)| json!({ "cubes": n, "counts": tally })).collect();
    let signatures =
        codes.iter().map(|code| line(code, ListFormat::Signature, params.rule)).collect::<Result<_, _>>()?;
    Ok((json!({ "params": params, "levels": rows }).to_string(), signatures))
}
