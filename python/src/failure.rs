//! Errors of the libraries as exceptions of `hexfill.errors`, with the ids they are about.

use crate::words::in_python;
use hexfill::io::{FormatError, Place, Position, QuadraticError, ReadError, WriteError};
use hexfill::mesh::{HexMeshError, ImproperPair, Offenders, QuadId, SignatureError, SurfaceError, VertexId};
use hexfill::unstable::enumerate::EnumerateError;
use hexfill::{EmbedError, Existence, FillError, ProblemError, RegionsError, SimplifyError, ThreadsError};
use pyo3::exceptions::PyOSError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Why something did not work, to be raised as one of the exceptions of `hexfill.errors`.
#[derive(Debug)]
pub(crate) struct Failure {
    /// Name of the class.
    class: &'static str,
    message: String,
    /// Attributes of the exception.
    ids: Vec<(&'static str, Ids)>,
    /// The system's error number and the file, if it was the system that failed.
    system: Option<(i32, String)>,
}

#[derive(Debug)]
enum Ids {
    One(Vec<u32>),
    Pairs(Vec<[u32; 2]>),
    Number(u64),
    Text(String),
}

impl Failure {
    fn new(class: &'static str, message: impl ToString) -> Self {
        Self { class, message: message.to_string(), ids: Vec::new(), system: None }
    }

    /// Input that cannot be used.
    pub(crate) fn input(message: impl ToString) -> Self {
        Self::new("InputError", message)
    }

    /// A defect of this program.
    pub(crate) fn internal(message: impl ToString) -> Self {
        Self::new("InternalError", message)
    }

    /// Ctrl-C, and nothing to show.
    pub(crate) fn cancelled() -> Self {
        Self::new("Cancelled", "stopped by Ctrl-C before there was a result")
    }

    /// No mesh was found, which proves nothing.
    pub(crate) fn not_found(message: impl ToString, stopped: &str) -> Self {
        Self::new("NoMeshFound", message).with("stopped", Ids::Text(stopped.to_owned()))
    }

    fn with(mut self, name: &'static str, ids: Ids) -> Self {
        self.ids.push((name, ids));
        self
    }

    fn vertices(self, ids: &[VertexId]) -> Self {
        self.with("vertices", Ids::One(ids.iter().map(|v| v.0).collect()))
    }

    fn quads(self, ids: &[QuadId]) -> Self {
        self.with("quads", Ids::One(ids.iter().map(|q| q.0).collect()))
    }

    fn edges(self, edges: &[hexfill::mesh::Edge]) -> Self {
        self.with("edges", Ids::Pairs(edges.iter().map(|e| [e.0.0, e.1.0]).collect()))
    }

    fn count<T>(self, of: &Offenders<T>) -> Self {
        self.with("count", Ids::Number(of.count as u64))
    }

    fn pairs(self, pairs: &Offenders<ImproperPair>) -> Self {
        self.with("pairs", Ids::Pairs(pairs.first.iter().map(|p| p.quads.map(|q| q.0)).collect())).count(pairs)
    }

    fn at(self, place: &Place) -> Self {
        let with_file = self.with("path", Ids::Text(place.file.clone()));
        match place.position {
            Position::Line(line) => with_file.with("line", Ids::Number(line)),
            _ => with_file,
        }
    }

    fn io(file: &str, source: &std::io::Error) -> Self {
        let number = source.raw_os_error().or(match source.kind() {
            // Errors of Rust's own making; the numbers are the same everywhere.
            std::io::ErrorKind::IsADirectory => Some(21),
            std::io::ErrorKind::NotFound => Some(2),
            _ => None,
        });
        let system = number.map(|n| (n, file.to_owned()));
        Self { system, ..Self::new("FileError", format!("{file}: {source}")).with("path", Ids::Text(file.to_owned())) }
    }

    /// The exception.
    pub(crate) fn raise(self, py: Python<'_>) -> PyErr {
        self.exception(py).unwrap_or_else(|error| error)
    }

    fn exception(self, py: Python<'_>) -> PyResult<PyErr> {
        if let Some((number, file)) = self.system {
            let words: String = py.import("os")?.call_method1("strerror", (number,))?.extract()?;
            return Ok(PyOSError::new_err((number, words, file)));
        }
        let attributes = PyDict::new(py);
        for (name, ids) in self.ids {
            match ids {
                Ids::One(ids) => attributes.set_item(name, ids)?,
                Ids::Pairs(pairs) => {
                    let tuples: Vec<(u32, u32)> = pairs.into_iter().map(|[a, b]| (a, b)).collect();
                    attributes.set_item(name, tuples)?;
                }
                Ids::Number(n) => attributes.set_item(name, n)?,
                Ids::Text(text) => attributes.set_item(name, text)?,
            }
        }
        let class = py.import("hexfill.errors")?.getattr(self.class)?;
        Ok(PyErr::from_value(class.call((in_python(&self.message),), Some(&attributes))?))
    }
}

impl From<SurfaceError> for Failure {
    fn from(error: SurfaceError) -> Self {
        let failure = Self::new("SurfaceError", &error);
        match &error {
            SurfaceError::NotQuads { offenders } => {
                let faces = offenders.first.iter().map(|f| f.face as u32).collect();
                failure.with("quads", Ids::One(faces)).count(offenders)
            }
            SurfaceError::IndexOutOfRange { quad, .. } => failure.quads(&[*quad]),
            SurfaceError::RepeatedVertex { quad, vertex } => failure.quads(&[*quad]).vertices(&[*vertex]),
            SurfaceError::RepeatedQuads { quads } => failure.quads(&quads.first).count(quads),
            SurfaceError::Open { edges } | SurfaceError::NonManifoldEdges { edges } => {
                failure.edges(&edges.first).count(edges)
            }
            SurfaceError::NonManifoldVertices { vertices } => failure.vertices(&vertices.first).count(vertices),
            SurfaceError::NotOrientable { quad, edge } => failure.quads(&[*quad]).edges(&[*edge]),
            _ => failure,
        }
    }
}

impl From<ProblemError> for Failure {
    fn from(error: ProblemError) -> Self {
        let message = error.to_string();
        match error {
            ProblemError::Read(error) => error.into(),
            ProblemError::Surface { source, .. } | ProblemError::Seams { source, .. } => {
                Self { message, ..source.into() }
            }
            ProblemError::NotFinite { points, .. } => {
                Self::new("SurfaceError", message).vertices(&points.first).count(&points)
            }
            ProblemError::NoFaces { .. } => Self::new("SurfaceError", message),
            _ => Self::input(message),
        }
    }
}

impl From<FillError> for Failure {
    fn from(error: FillError) -> Self {
        let message = error.to_string();
        let none = Self::new("NoMeshExists", &message);
        match &error {
            FillError::NoMesh(Existence::ImproperQuads { pairs, .. }) => none.pairs(pairs),
            FillError::NoMesh(Existence::OddCycleBounds { cycle }) => none.edges(cycle),
            FillError::NoMesh(_) => none,
            FillError::Construct(_) => Self::not_found(message, "finished"),
            FillError::Refused { .. } => Self::internal(message),
            _ => Self::input(message),
        }
    }
}

impl From<RegionsError> for Failure {
    fn from(error: RegionsError) -> Self {
        let message = error.to_string();
        match error {
            RegionsError::Open { edges, .. } => Self::new("SurfaceError", message).edges(&edges.first).count(&edges),
            RegionsError::Baffle { quads, .. } => Self::new("SurfaceError", message).quads(&quads.first).count(&quads),
            RegionsError::InsideOut { hexes, .. } => {
                let first = hexes.first.iter().map(|h| h.0).collect();
                Self::new("MeshError", message).with("hexes", Ids::One(first)).count(&hexes)
            }
            RegionsError::Fill { source, .. } => Self { message, ..source.into() },
            RegionsError::DoNotFit { .. } => Self::not_found(message, "finished"),
            _ => Self::input(message),
        }
    }
}

impl From<HexMeshError> for Failure {
    fn from(error: HexMeshError) -> Self {
        let failure = Self::new("MeshError", &error);
        match &error {
            HexMeshError::IndexOutOfRange { hex, .. } => failure.with("hexes", Ids::One(vec![hex.0])),
            HexMeshError::RepeatedVertex { hex, vertex } => {
                failure.with("hexes", Ids::One(vec![hex.0])).vertices(&[*vertex])
            }
            HexMeshError::BadFacets { facets } => {
                let hexes = facets.first.iter().map(|f| f.hex().0).collect();
                failure.with("hexes", Ids::One(hexes)).count(facets)
            }
            _ => failure,
        }
    }
}

impl From<EmbedError> for Failure {
    fn from(error: EmbedError) -> Self {
        let failure = Self::new("MeshError", &error);
        match &error {
            EmbedError::MissingPositions { vertices, .. } | EmbedError::NotFinite { vertices } => {
                failure.vertices(&vertices.first).count(vertices)
            }
            _ => failure,
        }
    }
}

impl From<SimplifyError> for Failure {
    fn from(error: SimplifyError) -> Self {
        match error {
            SimplifyError::Mesh(error) => error.into(),
            SimplifyError::Refused { .. } => Self::internal(error),
            _ => Self::new("MeshError", error),
        }
    }
}

impl From<ReadError> for Failure {
    fn from(error: ReadError) -> Self {
        let failure = Self::new("FileError", &error);
        match &error {
            ReadError::Io { file, source } => Self::io(file, source),
            ReadError::Empty { file, .. } => failure.with("path", Ids::Text(file.clone())),
            ReadError::Truncated { at, .. }
            | ReadError::Malformed { at, .. }
            | ReadError::NotFinite { at, .. }
            | ReadError::IndexOutOfRange { at, .. }
            | ReadError::TooLarge { at, .. }
            | ReadError::Unsupported { at, .. } => failure.at(at),
            _ => failure,
        }
    }
}

impl From<WriteError> for Failure {
    fn from(error: WriteError) -> Self {
        match &error {
            WriteError::Io { file, source } => Self::io(file, source),
            _ => Self::new("FileError", error),
        }
    }
}

impl From<QuadraticError> for Failure {
    fn from(error: QuadraticError) -> Self {
        Self::new("FileError", error)
    }
}

impl From<FormatError> for Failure {
    fn from(error: FormatError) -> Self {
        Self::new("FileError", error)
    }
}

impl From<EnumerateError> for Failure {
    fn from(error: EnumerateError) -> Self {
        match &error {
            EnumerateError::Stopped { .. } => Self::not_found(error, "stopped"),
            _ => Self::input(error),
        }
    }
}

impl From<SignatureError> for Failure {
    fn from(error: SignatureError) -> Self {
        Self::input(error)
    }
}

impl From<ThreadsError> for Failure {
    fn from(error: ThreadsError) -> Self {
        Self::input(format!("threads: {error}"))
    }
}
