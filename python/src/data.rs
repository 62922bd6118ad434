//! [`Data`]: what a file holds, as Python sees it, and files themselves.
//!
//! It is never changed, so that a mesh that was judged stays as it was judged. Arrays leave as `bytes`, which numpy reads without a
//! copy as arrays that cannot be written to.

use crate::work::{Run, run};
use hexfill::Problem;
use hexfill::io::{Format, MeshData, OtherFace};
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
    hex_data: Vec<(String, PyBuffer<f64>)>,
}

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

fn ids<'py>(py: Python<'py>, ids: &[u32]) -> Bound<'py, PyBytes> {
    bytes(py, ids, |id| i64::from(id).to_ne_bytes())
}

fn tags<'py>(py: Python<'py>, tags: Option<&Vec<i64>>) -> Option<Bound<'py, PyBytes>> {
    tags.map(|tags| bytes(py, tags, i64::to_ne_bytes))
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
        for (name, numbers) in given.hex_data {
            data.hex_data.push((name, numbers.to_vec(py)?));
        }
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
        let named = PyDict::new(py);
        for (name, numbers) in &self.0.hex_data {
            named.set_item(name, floats(py, numbers))?;
        }
        Ok(named)
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
    how: Run,
) -> PyResult<Vec<String>> {
    let data = Arc::clone(&data.0);
    let (losses, _) = run(py, how, move |_| {
        let path = Path::new(&path);
        let format = format.map_or_else(|| Format::from_path(path), |name| Format::from_name(&name))?;
        hexfill::io::write_path(path, Some(format), &data)?;
        Ok(data.losses(format))
    })?;
    Ok(losses)
}
