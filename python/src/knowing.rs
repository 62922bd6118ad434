//! What is known: descriptions, the atlas, the catalogue, and a mesh as a page or a picture.

use crate::data::Data;
use crate::failure::Failure;
use crate::words::in_python;
use crate::work::{Run, run};
use hexfill::io::MeshData;
use hexfill::io::TagOn;
use hexfill::mesh::{greedy_shelling, surface_signature};
use hexfill::unstable::check::{Judged, cell_quality};
use hexfill::unstable::search::{Atlas, Cavity, MAX_QUADS};
use hexfill::unstable::view::{Groups, ViewInput};
use hexfill::{CureOptions, FillOptions, PlaceOptions, Problem, catalog as named, describe_mesh, describe_surface};
use pyo3::prelude::*;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Describes a surface or a mesh; JSON.
///
/// # Errors
/// `SurfaceError`, `MeshError`.
#[pyfunction]
pub(crate) fn info(py: Python<'_>, data: &Data, name: String, how: Run) -> PyResult<String> {
    let data = Arc::clone(&data.0);
    let (text, _) = run(py, how, move |_| {
        let info = if data.hexes.is_empty() {
            let problem = Problem::from_data(&name, &data)?;
            let described = describe_surface(problem.surface(), problem.points());
            let estimate = hexfill::estimate(&problem, &FillOptions::default(), &PlaceOptions::default())
                .filter(|_| described.existence.hex_mesh != "none");
            let mut info = json!(described);
            info["estimate"] = json!(estimate);
            info
        } else {
            json!(describe_mesh(&data)?)
        };
        Ok(info.to_string())
    })?;
    Ok(text)
}

/// Everything that is wrong with a surface; JSON.
#[pyfunction]
pub(crate) fn doctor(py: Python<'_>, data: &Data, name: String, how: Run) -> PyResult<String> {
    let data = Arc::clone(&data.0);
    let (text, _) = run(py, how, move |_| Ok(in_python(&json!(hexfill::doctor(&name, &data)).to_string())))?;
    Ok(text)
}

/// A surface after the smallest changes, and what they were.
#[pyfunction]
pub(crate) fn mend(py: Python<'_>, data: &Data, name: String, refine: bool, how: Run) -> PyResult<(Data, Vec<String>)> {
    let data = Arc::clone(&data.0);
    let (cured, _) =
        run(py, how, move |_| Ok(hexfill::cure(&name, &data, &CureOptions::default().with_refine(refine))))?;
    Ok((cured.data.into(), cured.done.iter().map(|done| in_python(done)).collect()))
}

/// What the embedded atlas knows about a surface; JSON.
///
/// # Errors
/// `SurfaceError`, `InputError`.
#[pyfunction]
pub(crate) fn atlas(py: Python<'_>, data: &Data, name: String, how: Run) -> PyResult<String> {
    let data = Arc::clone(&data.0);
    let (text, _) = run(py, how, move |_| {
        let problem = Problem::from_data(&name, &data)?;
        let (cavity, _) = Cavity::from_surface(problem.surface()).ok_or_else(|| {
            Failure::input(format!(
                "{name} is not one sphere of at most {MAX_QUADS} quads; the atlas knows no other surfaces"
            ))
        })?;
        let row = |ball: &hexfill::unstable::search::Ball| {
            json!({
                "hexes": ball.n_hexes(),
                "interior_vertices": ball.n_vertices - cavity.n_vertices() as u32,
                "blocked_pairs": ball.boundary.n_blocked(),
            })
        };
        let mut balls: Vec<_> =
            [Atlas::fewest(), Atlas::embedded()].iter().flat_map(|atlas| atlas.balls_for(&cavity)).collect();
        balls.sort_by_key(hexfill::unstable::search::Ball::n_hexes);
        // Both atlases may hold the same numbers.
        let mut rows: Vec<Value> = balls.iter().map(row).collect();
        rows.dedup();
        Ok(json!(rows).to_string())
    })?;
    Ok(text)
}

/// The named problems; JSON.
///
/// # Errors
/// None but defects.
#[pyfunction]
pub(crate) fn catalog(py: Python<'_>, how: Run) -> PyResult<String> {
    let (text, _) = run(py, how, |_| {
        let mut all = Vec::new();
        for entry in named::entries() {
            let name = format!(":{}", entry.name);
            let problem = Problem::load(&name, None)?;
            all.push(json!({
                "name": name,
                "title": entry.title,
                "quads": problem.surface().n_quads(),
                "vertices": problem.surface().n_vertices(),
                "coordinates": problem.points().is_some(),
                "source": entry.source,
                "best": entry.record.to_string(),
                "mesh_hexes": entry.best_mesh().map(|m| m.hexes.len()),
                "signature": surface_signature(problem.surface()),
            }));
        }
        Ok(json!(all).to_string())
    })?;
    Ok(text)
}

/// The best mesh known for a named problem (without its colon), connectivity only; `None` if none is shipped.
///
/// # Errors
/// `InputError` if there is no such problem.
#[pyfunction]
pub(crate) fn catalog_mesh(py: Python<'_>, name: String, how: Run) -> PyResult<Option<Data>> {
    let (mesh, _) = run(py, how, move |_| {
        let known = || named::names().collect::<Vec<_>>().join(", ");
        let entry = named::find(&name)
            .ok_or_else(|| Failure::input(format!("no problem is called :{name}; known are {}", known())))?;
        Ok(entry.best_mesh())
    })?;
    Ok(mesh.map(Data::from))
}

/// Shelling orders are looked for in meshes up to this size: the animation of more hexes shows nothing.
const SHELLING_LIMIT: usize = 20_000;

/// Draws a mesh with its facts.
fn drawn<T>(
    data: &MeshData,
    title: &str,
    facts: &[(String, String)],
    is_page: bool,
    draw: impl Fn(&ViewInput<'_>) -> T,
) -> Result<T, Failure> {
    if data.hexes.is_empty() {
        return Err(Failure::input("there are no hexes to show; give a hex mesh"));
    }
    if !data.has_coordinates {
        return Err(Failure::input("the mesh has no coordinates to show it at"));
    }
    let mesh = data.hex_mesh()?;
    let judged = Judged::connectivity(data.points.len(), &data.hexes).with_points(&data.points);
    let of_cell =
        |c: &Option<hexfill::unstable::check::CellQuality>| c.as_ref().map_or(f64::NAN, |c| c.certified_lower);
    let values: Vec<f64> = cell_quality(&judged).iter().map(of_cell).collect();
    let shelling = if is_page && mesh.n_hexes() <= SHELLING_LIMIT { greedy_shelling(&mesh) } else { None };
    let names: BTreeMap<i64, String> =
        data.tag_names.iter().filter(|n| n.on == TagOn::Faces).map(|n| (n.tag, n.name.clone())).collect();
    let tags = data.quad_tags.as_deref().unwrap_or(&[]);
    let name = |tag: i64| names.get(&tag).cloned().unwrap_or_else(|| tag.to_string());
    let groups = Groups::new(&mesh, &data.quads, tags, name, false);
    Ok(draw(&ViewInput {
        title,
        points: &data.points,
        mesh: &mesh,
        hex_values: Some(("scaled Jacobian", &values)),
        shelling: shelling.as_deref(),
        groups: groups.as_ref(),
        facts,
    }))
}

/// The viewer's page.
///
/// # Errors
/// `InputError`, `MeshError`.
#[pyfunction]
pub(crate) fn html(
    py: Python<'_>,
    data: &Data,
    title: String,
    facts: Vec<(String, String)>,
    how: Run,
) -> PyResult<String> {
    let data = Arc::clone(&data.0);
    Ok(run(py, how, move |_| drawn(&data, &title, &facts, true, hexfill::unstable::view::html))?.0)
}

/// A picture, PNG.
///
/// # Errors
/// `InputError`, `MeshError`.
#[pyfunction]
pub(crate) fn png(py: Python<'_>, data: &Data, width: u32, height: u32, how: Run) -> PyResult<Vec<u8>> {
    let data = Arc::clone(&data.0);
    Ok(run(py, how, move |_| drawn(&data, "", &[], false, |input| hexfill::unstable::view::png(input, width, height)))?
        .0)
}
