//! [`Data`]: what a file holds, as Python sees it, and files themselves.
//!
//! It is never changed, so that a mesh that was judged stays as it was judged. Arrays leave as `bytes`, which numpy reads without a
//! copy as arrays that cannot be written to.

use crate::failure::Failure;
use crate::work::{Run, run};
use hexfill::Problem;
use hexfill::io::{Format, MeshData, OtherFace, TagName, TagOn};
use hexfill::mesh::parse_hex_signature;
use pyo3::buffer::PyBuffer;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use std::path::Path;
use std::sync::Arc;

/// A surface, a mesh, or both. All ids are 0-based.
#[pyclass(frozen, module = "hexfill._native")]
pub(crate) struct Data(pub(crate) Arc<MeshData>);

/// Arrays that Python gives: a dictionary. They are in C order, of exactly these types; the Python half saw to that.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct Given {
    points: Option<PyBuffer<f64>>,
    quads: PyBuffer<u32>,
    other_faces: Vec<(usize, Vec<u32>)>,
    hexes: PyBuffer<u32>,
    point_tags: Option<PyBuffer<i64>>,
    quad_tags: Option<PyBuffer<i64>>,
    hex_tags: Option<PyBuffer<i64>>,
    point_data: Fields,
    quad_data: Fields,
    hex_data: Fields,
    tag_names: Vec<(String, i64, String)>,
}

/// Named numbers.
type Fields = Vec<(String, PyBuffer<f64>)>;

/// A flat buffer as rows of `N`.
fn rows<T: pyo3::buffer::Element, const N: usize>(py: Python<'_>, buffer: &PyBuffer<T>) -> PyResult<Vec<[T; N]>> {
    Ok(buffer.to_vec(py)?.as_chunks().0.to_vec())
}

/// Numbers as bytes, in the order of the machine.
fn bytes<'py, T: Copy, const N: usize>(
    py: Python<'py>,
    numbers: &[T],
    to: impl Fn(T) -> [u8; N],
) -> Bound<'py, PyBytes> {
    let filled = PyBytes::new_with(py, numbers.len() * N, |out| {
        for (place, &number) in out.as_chunks_mut::<N>().0.iter_mut().zip(numbers) {
            *place = to(number);
        }
        Ok(())
    });
    filled.expect("filling does not fail")
}

pub(crate) fn ids<'py>(py: Python<'py>, ids: &[u32]) -> Bound<'py, PyBytes> {
    bytes(py, ids, |id| i64::from(id).to_ne_bytes())
}

fn tags<'py>(py: Python<'py>, tags: Option<&Vec<i64>>) -> Option<Bound<'py, PyBytes>> {
    tags.map(|tags| bytes(py, tags, i64::to_ne_bytes))
}

/// Words for what tags are on.
const ON: [(TagOn, &str); 3] = [(TagOn::Points, "points"), (TagOn::Faces, "quads"), (TagOn::Cells, "hexes")];

/// Named numbers as bytes of float64.
fn fields<'py>(py: Python<'py>, fields: &[(String, Vec<f64>)]) -> PyResult<Bound<'py, PyDict>> {
    let named = PyDict::new(py);
    for (name, numbers) in fields {
        named.set_item(name, floats(py, numbers))?;
    }
    Ok(named)
}

/// Numbers as bytes of float64.
pub(crate) fn floats<'py>(py: Python<'py>, numbers: &[f64]) -> Bound<'py, PyBytes> {
    bytes(py, numbers, f64::to_ne_bytes)
}

impl From<MeshData> for Data {
    fn from(data: MeshData) -> Self {
        Self(Arc::new(data))
    }
}

#[pymethods]
impl Data {
    #[new]
    fn new(py: Python<'_>, given: Given) -> PyResult<Self> {
        let optional = |tags: &Option<PyBuffer<i64>>| tags.as_ref().map(|t| t.to_vec(py)).transpose();
        let mut data = MeshData::from_quads(Vec::new(), rows(py, &given.quads)?);
        data.has_coordinates = given.points.is_some();
        if let Some(points) = &given.points {
            data.points = rows(py, points)?;
        }
        data.hexes = rows(py, &given.hexes)?;
        data.other_faces = given
            .other_faces
            .into_iter()
            .map(|(position, vertices)| OtherFace { position, vertices, tag: 0 })
            .collect();
        data.point_tags = optional(&given.point_tags)?;
        data.quad_tags = optional(&given.quad_tags)?;
        data.hex_tags = optional(&given.hex_tags)?;
        let fields = |given: Fields| -> PyResult<Vec<(String, Vec<f64>)>> {
            given.into_iter().map(|(name, numbers)| Ok((name, numbers.to_vec(py)?))).collect()
        };
        data.point_data = fields(given.point_data)?;
        data.quad_data = fields(given.quad_data)?;
        data.hex_data = fields(given.hex_data)?;
        let on = |word: &str| ON.iter().find(|(_, known)| *known == word).map(|(on, _)| *on);
        let named = |(word, tag, name): (String, i64, String)| on(&word).map(|on| TagName { on, tag, name });
        data.tag_names = given.tag_names.into_iter().filter_map(named).collect();
        data.tag_names.sort();
        Ok(data.into())
    }

    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyBytes>> {
        self.0.has_coordinates.then(|| floats(py, self.0.points.as_flattened()))
    }

    #[getter]
    fn quads<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        ids(py, self.0.quads.as_flattened())
    }

    #[getter]
    fn hexes<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        ids(py, self.0.hexes.as_flattened())
    }

    #[getter]
    fn other_faces(&self) -> Vec<(usize, Vec<u32>)> {
        self.0.other_faces.iter().map(|face| (face.position, face.vertices.clone())).collect()
    }

    /// Cells that are no hexes.
    #[getter]
    fn n_other_cells(&self) -> usize {
        self.0.cell_count() - self.0.hexes.len()
    }

    #[getter]
    fn point_tags<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyBytes>> {
        tags(py, self.0.point_tags.as_ref())
    }

    #[getter]
    fn quad_tags<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyBytes>> {
        tags(py, self.0.quad_tags.as_ref())
    }

    #[getter]
    fn hex_tags<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyBytes>> {
        tags(py, self.0.hex_tags.as_ref())
    }

    #[getter]
    fn hex_data<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        fields(py, &self.0.hex_data)
    }

    #[getter]
    fn quad_data<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        fields(py, &self.0.quad_data)
    }

    #[getter]
    fn point_data<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        fields(py, &self.0.point_data)
    }

    /// What the tag is on, the tag, its name.
    #[getter]
    fn tag_names(&self) -> Vec<(&'static str, i64, String)> {
        let word = |on: TagOn| ON.iter().find(|(known, _)| *known == on).map_or("", |(_, word)| word);
        self.0.tag_names.iter().map(|n| (word(n.on), n.tag, n.name.clone())).collect()
    }

    #[getter]
    fn notes(&self) -> Vec<String> {
        self.0.notes.clone()
    }
}

/// What a path, a catalogue name or a signature stands for.
///
/// # Errors
/// `FileError`, `OSError`, `InputError`.
#[pyfunction]
pub(crate) fn load(py: Python<'_>, spec: String, format: Option<String>, how: Run) -> PyResult<Data> {
    let (data, _) = run(py, how, move |_| {
        if spec.starts_with("H1") && !Path::new(&spec).exists() {
            let mesh = parse_hex_signature(&spec)?;
            return Ok(MeshData { hexes: mesh.hexes_raw(), has_coordinates: false, ..MeshData::default() });
        }
        if hexfill::is_named(&spec) {
            return Ok(Problem::load(&spec, None)?.data());
        }
        let format = format.map(|name| Format::from_name(&name)).transpose()?;
        Ok(hexfill::io::read_path(Path::new(&spec), format)?)
    })?;
    Ok(data.into())
}

/// The same with points merged that are at most `weld` apart, and cells of higher order as their corners.
///
/// # Errors
/// `InputError`.
#[pyfunction]
pub(crate) fn prepared(
    py: Python<'_>,
    data: &Data,
    name: String,
    weld: Option<f64>,
    linearise: bool,
    how: Run,
) -> PyResult<Data> {
    let data = Arc::clone(&data.0);
    let (data, _) = run(py, how, move |_| {
        let mut data = (*data).clone();
        if linearise {
            data = data.linearised();
        }
        if let Some(tolerance) = weld {
            let welded = hexfill::io::weld(&mut data, tolerance);
            if welded.collapsed > 0 {
                return Err(Failure::input(format!(
                    "weld={tolerance} merges corners of {} faces or cells of {name} with each other; use a smaller tolerance",
                    welded.collapsed
                )));
            }
            let (merged, left) = (welded.merged, data.points.len());
            data.notes.push(format!("weld={tolerance}: {merged} points merged into others, {left} are left"));
        }
        Ok(data)
    })?;
    Ok(data.into())
}

/// Writes a file whole or not at all; returns what the format does not carry.
///
/// # Errors
/// `FileError`, `OSError`.
#[pyfunction]
pub(crate) fn write(
    py: Python<'_>,
    data: &Data,
    path: String,
    format: Option<String>,
    quadratic: bool,
    how: Run,
) -> PyResult<Vec<String>> {
    let mut data = Arc::clone(&data.0);
    let (losses, _) = run(py, how, move |_| {
        let path = Path::new(&path);
        let format = format.map_or_else(|| Format::from_path(path), |name| Format::from_name(&name))?;
        if quadratic {
            data = Arc::new(Arc::unwrap_or_clone(data).into_quadratic()?);
        }
        hexfill::io::write_path(path, Some(format), &data)?;
        Ok(data.losses(format))
    })?;
    Ok(losses)
}
