//! [`Problem`]: a surface to fill, wherever it came from: a file, arrays, the catalogue, or a signature.
//!
//! Source: ours.

pub mod catalog;
mod error;
mod orient;
pub(crate) mod points;
pub(crate) mod size;
pub(crate) mod solids;

pub use error::ProblemError;
use hexfill_io::{Format, MeshData, TagName, TagOn, closing_tolerance};
use hexfill_mesh::{FaceSides, Offenders, QuadSurface, SurfaceError, VertexId, parse_surface_signature};
use orient::face_outward;
use std::path::Path;

/// A surface with what is known about it besides its connectivity.
#[derive(Clone, Debug)]
pub struct Problem {
    pub(crate) name: String,
    pub(crate) surface: QuadSurface,
    /// One for each vertex.
    pub(crate) points: Option<Vec<[f64; 3]>>,
    point_tags: Option<Vec<i64>>,
    quad_tags: Option<Vec<i64>>,
    tag_names: Vec<TagName>,
    point_data: Vec<(String, Vec<f64>)>,
    quad_data: Vec<(String, Vec<f64>)>,
    notes: Vec<String>,
}

/// Without coordinates so many ids may be unused: tables are as long as the largest id.
const MOST_UNUSED: usize = 1 << 20;

/// Whether a word names a problem without being a file: `:name` or a surface signature.
pub fn is_named(spec: &str) -> bool {
    spec.starts_with(':') || (spec.starts_with("Q1:") && !Path::new(spec).exists())
}

impl Problem {
    /// A problem from `:name`, a signature, or a path (format by extension unless given): what a command line accepts.
    ///
    /// # Errors
    /// [`ProblemError`].
    pub fn load(spec: &str, format: Option<Format>) -> Result<Self, ProblemError> {
        match spec.strip_prefix(':') {
            Some(_) => Self::named(spec),
            None if is_named(spec) => Self::from_signature(spec),
            None => Self::read(Path::new(spec), format),
        }
    }

    /// The surface in a file; format by extension unless given.
    ///
    /// ```no_run
    /// # use std::path::Path;
    /// let problem = hexfill::Problem::read(Path::new("bamboo_pen.obj"), None)?;
    /// println!("{}: {} quads, genus {}", problem.name(), problem.surface().n_quads(), problem.surface().genus());
    /// # Ok::<(), hexfill::ProblemError>(())
    /// ```
    ///
    /// # Errors
    /// [`ProblemError`].
    pub fn read(path: &Path, format: Option<Format>) -> Result<Self, ProblemError> {
        Self::from_data(&path.display().to_string(), &hexfill_io::read_path(path, format)?)
    }

    /// A surface of the [catalogue](catalog), with or without the colon.
    ///
    /// ```
    /// let spindle = hexfill::Problem::named("octagonal-spindle")?;
    /// assert_eq!(spindle.surface().n_quads(), 8);
    /// assert!(hexfill::Problem::named("no-such-thing").is_err());
    /// # Ok::<(), hexfill::ProblemError>(())
    /// ```
    ///
    /// # Errors
    /// [`ProblemError::UnknownName`].
    pub fn named(name: &str) -> Result<Self, ProblemError> {
        let bare = name.strip_prefix(':').unwrap_or(name);
        let entry = catalog::find(bare).ok_or_else(|| ProblemError::UnknownName { given: name.to_owned() })?;
        Self::from_data(&format!(":{bare}"), &entry.data())
    }

    /// The surface of a canonical signature ([`hexfill_mesh::surface_signature`]), without positions.
    ///
    /// ```
    /// use hexfill::{Problem, mesh::surface_signature};
    /// let cube = Problem::named("cube")?;
    /// let again = Problem::from_signature(&surface_signature(cube.surface()))?;
    /// assert!(again.surface().n_quads() == 6 && again.points().is_none());
    /// # Ok::<(), hexfill::ProblemError>(())
    /// ```
    ///
    /// # Errors
    /// [`ProblemError::Signature`].
    pub fn from_signature(signature: &str) -> Result<Self, ProblemError> {
        let surface = parse_surface_signature(signature)
            .map_err(|source| ProblemError::Signature { given: signature.to_owned(), source })?;
        Ok(Self::from_surface(signature, surface))
    }

    /// A surface with a position for each of its vertices, turned outward; the unit is yours.
    ///
    /// ```
    /// use hexfill::{Problem, ProblemError};
    /// let cube = Problem::named("cube")?;
    /// let points = cube.points().expect("it has some").iter().map(|p| p.map(|x| 2.0 * x)).collect();
    /// let larger = Problem::new("a larger cube", cube.surface().clone(), points)?;
    /// assert!(larger.notes().is_empty());
    /// let none = Problem::new("no points", cube.surface().clone(), Vec::new());
    /// assert!(matches!(none, Err(ProblemError::PointCount { given: 0, needed: 8, .. })));
    /// # Ok::<(), ProblemError>(())
    /// ```
    ///
    /// # Errors
    /// [`ProblemError::PointCount`], [`ProblemError::NotFinite`].
    pub fn new(name: &str, surface: QuadSurface, points: Vec<[f64; 3]>) -> Result<Self, ProblemError> {
        let mut problem = Self::from_surface(name, surface);
        problem.place(points)?;
        Ok(problem)
    }

    /// A surface without positions; it faces as it does.
    pub fn from_surface(name: &str, surface: QuadSurface) -> Self {
        Self {
            name: name.to_owned(),
            surface,
            points: None,
            point_tags: None,
            quad_tags: None,
            tag_names: Vec::new(),
            point_data: Vec::new(),
            quad_data: Vec::new(),
            notes: Vec::new(),
        }
    }

    /// A problem from what a file holds: its faces, which must be quads and close up. Indices count from 0; quads may list their corners in either sense
    /// and are turned to agree, and outward where there are positions. Tags and data stay with their quads and points.
    ///
    /// # Errors
    /// [`ProblemError::NoFaces`], [`ProblemError::Surface`] (with the offenders), [`ProblemError::Seams`] if welding would close it,
    /// [`ProblemError::NotFinite`], [`ProblemError::SparseIds`], [`ProblemError::HigherOrder`].
    pub fn from_data(name: &str, data: &MeshData) -> Result<Self, ProblemError> {
        let surface_error = |source| ProblemError::Surface { name: name.to_owned(), source };
        if !data.middles.is_empty() {
            return Err(ProblemError::HigherOrder { name: name.to_owned(), points: data.middles.len() });
        }
        if !data.other_faces.is_empty() {
            let offenders =
                data.other_faces.iter().map(|f| FaceSides { face: f.position, sides: f.vertices.len() }).collect();
            return Err(surface_error(SurfaceError::NotQuads { offenders }));
        }
        if data.quads.is_empty() {
            return Err(ProblemError::NoFaces { name: name.to_owned(), hexes: data.hexes.len() });
        }
        let n_vertices = if data.has_coordinates {
            data.points.len()
        } else {
            data.quads.iter().flatten().map(|&v| v as usize + 1).max().unwrap_or(0)
        };
        if !data.has_coordinates && n_vertices > MOST_UNUSED + 4 * data.quads.len() {
            return Err(ProblemError::SparseIds {
                name: name.to_owned(),
                largest: n_vertices - 1,
                faces: data.quads.len(),
            });
        }
        let surface = match QuadSurface::try_new(n_vertices, &data.quads) {
            Ok(surface) => surface,
            Err(source @ SurfaceError::Open { .. }) => {
                return Err(match closing_tolerance(data) {
                    Some(tolerance) => ProblemError::Seams { name: name.to_owned(), source, tolerance },
                    None => surface_error(source),
                });
            }
            Err(source) => return Err(surface_error(source)),
        };
        let mut notes = data.notes.clone();
        if !data.hexes.is_empty() {
            notes.push(format!("{} hexes of the file are not used: only its faces are filled", data.hexes.len()));
        }
        let unused = n_vertices - surface.n_used_vertices();
        if unused > 0 {
            notes.push(format!("{unused} points belong to no quad; they are kept"));
        }
        if !surface.reversed().is_empty() {
            notes.push(format!("{} quads were turned to agree with their neighbours", surface.reversed().len()));
        }
        let mut problem = Self {
            point_tags: data.point_tags.clone(),
            quad_tags: data.quad_tags.clone(),
            tag_names: data.tag_names.iter().filter(|n| n.on != TagOn::Cells).cloned().collect(),
            point_data: data.point_data.clone(),
            quad_data: data.quad_data.clone(),
            notes,
            ..Self::from_surface(name, surface)
        };
        if data.has_coordinates {
            problem.place(data.points.clone())?;
        }
        Ok(problem)
    }

    /// Gives the vertices positions and turns the quads outward.
    fn place(&mut self, points: Vec<[f64; 3]>) -> Result<(), ProblemError> {
        if points.len() != self.surface.n_vertices() {
            let (name, given, needed) = (self.name.clone(), points.len(), self.surface.n_vertices());
            return Err(ProblemError::PointCount { name, given, needed });
        }
        let not_finite = (0..points.len()).filter(|&v| !points[v].iter().all(|x| x.is_finite()));
        let bad: Offenders<VertexId> = not_finite.map(VertexId::new).collect();
        if !bad.is_empty() {
            return Err(ProblemError::NotFinite { name: self.name.clone(), points: bad });
        }
        let turned = face_outward(&mut self.surface, &points);
        if turned > 0 {
            let all = self.surface.n_components();
            let which =
                if all == 1 { "the quads".to_owned() } else { format!("the quads of {turned} of {all} components") };
            self.notes.push(format!("{which} faced into the solid; they were turned"));
        }
        self.points = Some(points);
        Ok(())
    }

    /// What the user called it.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The surface; outward where positions tell.
    pub fn surface(&self) -> &QuadSurface {
        &self.surface
    }

    /// Position of each vertex, in the unit of the input, bit for bit; absent for signatures and connectivity-only input. See also
    /// [`positions`](Self::positions).
    pub fn points(&self) -> Option<&[[f64; 3]]> {
        self.points.as_deref()
    }

    /// What was recognised, repaired or passed over, for the user.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// The surface as file data: the quads in the order of the input.
    pub fn data(&self) -> MeshData {
        let mut data = MeshData::from_quads(self.points.clone().unwrap_or_default(), self.surface.quads_raw());
        data.has_coordinates = self.points.is_some();
        data.point_tags.clone_from(&self.point_tags);
        data.quad_tags.clone_from(&self.quad_tags);
        data.tag_names.clone_from(&self.tag_names);
        data.point_data.clone_from(&self.point_data);
        data.quad_data.clone_from(&self.quad_data);
        data
    }
}
