//! [`Problem`]: a surface to fill, wherever it came from: a file, the catalogue, or a signature.

use crate::catalog;
use crate::components::depths;
use hexfill_geometry::{cone, sub};
use hexfill_io::{Format, MeshData, ReadError, TagName, TagOn, closing_tolerance};
use hexfill_mesh::{Offenders, QuadSurface, SignatureError, SurfaceError, parse_surface_signature};
use std::path::Path;

/// A surface with what is known about it besides its connectivity.
#[derive(Clone, Debug)]
pub struct Problem {
    /// What the user called it.
    pub name: String,
    /// The surface; outward where positions tell.
    pub surface: QuadSurface,
    /// Position of each vertex, in the unit of the file, bit for bit; absent for signatures and connectivity-only input.
    pub points: Option<Vec<[f64; 3]>>,
    /// One tag per vertex, as in the file.
    pub point_tags: Option<Vec<i64>>,
    /// One tag per quad, as in the file.
    pub quad_tags: Option<Vec<i64>>,
    /// Names of these tags.
    pub tag_names: Vec<TagName>,
    /// Named numbers per vertex, as in the file.
    pub point_data: Vec<(String, Vec<f64>)>,
    /// Named numbers per quad, as in the file.
    pub quad_data: Vec<(String, Vec<f64>)>,
    /// What was recognised, repaired or passed over, for the user.
    pub notes: Vec<String>,
}

/// Why there is no problem to work on. All are the input's fault.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ProblemError {
    /// The file cannot be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// The faces are no closed quad surface.
    #[error("{name}: {source}")]
    Surface {
        /// The input.
        name: String,
        /// What is wrong.
        source: SurfaceError,
    },
    /// The faces leave seams open: points in one spot that are not one point.
    #[error("{name}: {source}; welding closes it: merge points at most {tolerance} apart (--weld {tolerance})")]
    Seams {
        /// The input.
        name: String,
        /// What is open.
        source: SurfaceError,
        /// The least tolerance (rounded up) at which welding closes the surface.
        tolerance: f64,
    },
    /// The file has cells of higher order.
    #[error(
        "{name} has cells of higher order, {points} points lie between their corners; read it as straight ones (--linearise)"
    )]
    HigherOrder {
        /// The input.
        name: String,
        /// Points that are no corners.
        points: usize,
    },
    /// Ids that only a huge table could hold.
    #[error(
        "{name}: the largest vertex id is {largest}, with {faces} faces; number the vertices from 0 without large gaps"
    )]
    SparseIds {
        /// The input.
        name: String,
        /// The largest id.
        largest: usize,
        /// Number of faces.
        faces: usize,
    },
    /// The file has no faces at all.
    #[error("{name} has no faces{}; give a closed surface of quads", if *hexes > 0 { format!(" ({hexes} hexes: is it a mesh? then use `hexfill check`)") } else { String::new() })]
    NoFaces {
        /// The input.
        name: String,
        /// Hexes in the file.
        hexes: usize,
    },
    /// No such catalogue entry.
    #[error("no problem is called {given}; known are {}", catalog::names().collect::<Vec<_>>().join(", "))]
    UnknownName {
        /// What was asked for.
        given: String,
    },
    /// Not a signature.
    #[error("{given}: {source}")]
    Signature {
        /// What was given.
        given: String,
        /// What is wrong.
        source: SignatureError,
    },
    /// Vertices of one quad that lie on one spot are fine for topology, but non-finite positions are not.
    #[error("{name}: {} points are not finite: {points}", points.count)]
    NotFinite {
        /// The input.
        name: String,
        /// The points.
        points: Offenders<hexfill_mesh::VertexId>,
    },
}

/// Without coordinates so many ids may be unused: tables are as long as the largest id.
const MOST_UNUSED: usize = 1 << 20;

/// Whether a word names a problem without being a file: `:name` or a surface signature.
pub fn is_named(spec: &str) -> bool {
    spec.starts_with(':') || (spec.starts_with("Q1:") && !Path::new(spec).exists())
}

impl Problem {
    /// Loads a problem from `:name`, a signature, or a path (format by extension unless given).
    ///
    /// # Errors
    /// [`ProblemError`].
    pub fn load(spec: &str, format: Option<Format>) -> Result<Self, ProblemError> {
        if let Some(name) = spec.strip_prefix(':') {
            let entry = catalog::find(name).ok_or_else(|| ProblemError::UnknownName { given: spec.to_owned() })?;
            return Self::from_data(spec, &entry.data());
        }
        if is_named(spec) {
            let surface = parse_surface_signature(spec)
                .map_err(|source| ProblemError::Signature { given: spec.to_owned(), source })?;
            return Ok(Self::from_surface(spec, surface));
        }
        Self::from_data(spec, &hexfill_io::read_path(Path::new(spec), format)?)
    }

    /// A problem without positions.
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

    /// A problem from what a file holds: its faces, which must be quads and close up.
    ///
    /// # Errors
    /// [`ProblemError`].
    pub fn from_data(name: &str, data: &MeshData) -> Result<Self, ProblemError> {
        let surface_error = |source| ProblemError::Surface { name: name.to_owned(), source };
        if !data.middles.is_empty() {
            return Err(ProblemError::HigherOrder { name: name.to_owned(), points: data.middles.len() });
        }
        if !data.other_faces.is_empty() {
            let offenders = data
                .other_faces
                .iter()
                .map(|f| hexfill_mesh::FaceSides { face: f.position, sides: f.vertices.len() })
                .collect();
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
        let mut surface = match QuadSurface::try_new(n_vertices, &data.quads) {
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
        let points = data.has_coordinates.then(|| data.points.clone());
        if let Some(points) = &points {
            let bad: Offenders<_> = points
                .iter()
                .enumerate()
                .filter(|(_, p)| !p.iter().all(|x| x.is_finite()))
                .map(|(v, _)| hexfill_mesh::VertexId::new(v))
                .collect();
            if !bad.is_empty() {
                return Err(ProblemError::NotFinite { name: name.to_owned(), points: bad });
            }
            let turned = face_outward(&mut surface, points);
            if turned > 0 {
                let all = surface.n_components();
                let which = if all == 1 {
                    "the quads".to_owned()
                } else {
                    format!("the quads of {turned} of {all} components")
                };
                notes.push(format!("{which} faced into the solid; they were turned"));
            }
        }
        Ok(Self {
            name: name.to_owned(),
            surface,
            points,
            point_tags: data.point_tags.clone(),
            quad_tags: data.quad_tags.clone(),
            tag_names: data.tag_names.iter().filter(|n| n.on != TagOn::Cells).cloned().collect(),
            point_data: data.point_data.clone(),
            quad_data: data.quad_data.clone(),
            notes,
        })
    }

    /// The surface as file data: the quads in the order of the input.
    pub fn data(&self) -> MeshData {
        let quads = self.surface.quads().iter().map(|q| q.map(|v| v.0)).collect();
        let mut data = MeshData::from_quads(self.points.clone().unwrap_or_default(), quads);
        data.has_coordinates = self.points.is_some();
        data.point_tags.clone_from(&self.point_tags);
        data.quad_tags.clone_from(&self.quad_tags);
        data.tag_names.clone_from(&self.tag_names);
        data.point_data.clone_from(&self.point_data);
        data.quad_data.clone_from(&self.quad_data);
        data
    }
}

/// Turns every component whose quads face into the solid: outer boundaries outward, boundaries of cavities inward.
/// Returns how many were turned.
fn face_outward(surface: &mut QuadSurface, points: &[[f64; 3]]) -> usize {
    let depths = depths(surface, points);
    let volumes = enclosed_volumes(surface, points);
    let wrong: Vec<bool> = depths
        .iter()
        .zip(volumes)
        .map(|(depth, volume)| if depth.is_multiple_of(2) { volume < 0.0 } else { volume > 0.0 })
        .collect();
    let turned = wrong.iter().filter(|&&w| w).count();
    if turned > 0 {
        let quads: Vec<[u32; 4]> = surface
            .quads()
            .iter()
            .enumerate()
            .map(|(q, quad)| {
                let [a, b, c, d] = quad.map(|v| v.0);
                if wrong[surface.component(hexfill_mesh::QuadId::new(q))] { [a, d, c, b] } else { [a, b, c, d] }
            })
            .collect();
        *surface = QuadSurface::try_new(surface.n_vertices(), &quads).expect("turning a component keeps a surface");
    }
    turned
}

/// A multiple of the volume each component encloses, its quads cut along both diagonals; positive if they face outward.
/// Only the sign is used. Positions are scaled first, so that no finite input overflows.
fn enclosed_volumes(surface: &QuadSurface, points: &[[f64; 3]]) -> Vec<f64> {
    let largest = points.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
    let scale = if largest > 0.0 { largest } else { 1.0 };
    let at = |v: hexfill_mesh::VertexId| points[v.index()].map(|x| x / scale);
    let mut origin = vec![None; surface.n_components()];
    let mut volume = vec![0.0; surface.n_components()];
    for (q, quad) in surface.quads().iter().enumerate() {
        let component = surface.component(hexfill_mesh::QuadId::new(q));
        let quad = quad.map(at);
        let origin = *origin[component].get_or_insert(quad[0]);
        let [a, b, c, d] = quad.map(|p| sub(p, origin));
        volume[component] += cone([a, b, c, d]) + cone([b, c, d, a]);
    }
    volume
}
