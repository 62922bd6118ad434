//! [`Soup`]: points and faces as a file holds them, nothing being known of how they fit.
//!
//! Source: ours.

use hexfill_mesh::{QuadSurface, SurfaceError};

/// Faces of any number of sides over points. Indices from 0; every index names a point where there are points.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Soup {
    /// Position of each point; empty if only the connectivity is known.
    pub points: Vec<[f64; 3]>,
    /// The faces, each the cycle of its points.
    pub faces: Vec<Vec<u32>>,
}

impl Soup {
    /// Number of points: of positions, or one more than the largest index.
    pub fn n_points(&self) -> usize {
        let largest = self.faces.iter().flatten().max().map_or(0, |&v| v as usize + 1);
        self.points.len().max(largest)
    }

    /// The faces that are quads, with their numbers.
    pub fn quads(&self) -> impl Iterator<Item = (usize, [u32; 4])> + '_ {
        self.faces.iter().enumerate().filter_map(|(f, face)| Some((f, <[u32; 4]>::try_from(face.as_slice()).ok()?)))
    }

    /// The closed surface of quads that this is.
    ///
    /// # Errors
    /// [`SurfaceError`]: it is none.
    pub fn surface(&self) -> Result<QuadSurface, SurfaceError> {
        let quads: Vec<[u32; 4]> = self.quads().map(|(_, quad)| quad).collect();
        if quads.len() < self.faces.len() {
            let other = self.faces.iter().enumerate().filter(|(_, face)| face.len() != 4);
            let offenders = other.map(|(f, face)| hexfill_mesh::FaceSides { face: f, sides: face.len() }).collect();
            return Err(SurfaceError::NotQuads { offenders });
        }
        QuadSurface::try_new(self.n_points(), &quads)
    }

    /// The positions of a face.
    pub(crate) fn at(&self, face: usize) -> Option<Vec<[f64; 3]>> {
        self.faces[face].iter().map(|&v| self.points.get(v as usize).copied()).collect()
    }
}
