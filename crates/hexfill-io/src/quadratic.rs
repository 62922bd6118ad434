//! Cells of second order: a node in the middle of every edge (20 nodes a hex, 8 a quad; serendipity, no nodes inside faces or cells).
//!
//! The edges stay straight, and so the cells are the same maps as before: the serendipity shape functions contain the trilinear ones, hence a
//! node at the mean of two corners changes nothing (Zienkiewicz, Taylor 2000). What is certified of a hex holds
//! for its quadratic form, up to the rounding of the middles. Only written: readers keep corners (`linearised` brings them back).
//!
//! Source: Zienkiewicz, Taylor 2000, chapter 8 (serendipity elements).

use crate::data::MeshData;
use crate::error::QuadraticError;
use crate::numbers::NODE;
use crate::orders::{HEX_EDGES, QUAD_EDGES};
use crate::quadratic_cells::Quadratic;
use rustc_hash::FxHashMap;

impl MeshData {
    /// The same with cells of second order on straight edges, to be written: each edge gets one node, at the mean of its ends, after all points.
    ///
    /// Data on points are interpolated likewise. The node of an edge of a face has the tag of its ends, if they have the same (node sets of a
    /// boundary stay whole); other nodes have none.
    ///
    /// # Errors
    /// [`QuadraticError`]: there are no coordinates, or cells other than quads and hexes.
    ///
    /// # Example
    /// ```
    /// use hexfill_io::{Format, MeshData, read_from, write_to};
    ///
    /// let points = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    /// let straight = MeshData::from_quads(points, vec![[0, 1, 2, 3]]);
    /// let quadratic = straight.clone().into_quadratic()?;
    /// assert_eq!((quadratic.points.len(), quadratic.points[4]), (8, [0.5, 0.0, 0.0]));
    /// let mut file = Vec::new();
    /// write_to(&mut file, Format::Vtu, &quadratic)?; // VTK_QUADRATIC_QUAD
    /// assert_eq!(read_from(file.as_slice(), Format::Vtu, "square.vtu")?.linearised().quads, straight.quads);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn into_quadratic(mut self) -> Result<Self, QuadraticError> {
        self.check_straight()?;
        let mut middles = Middles { node_of: FxHashMap::default(), ends: Vec::new(), first: self.points.len() };
        let quads = self.quads.iter().map(|quad| middles.with(*quad, QUAD_EDGES)).collect();
        let on_faces = middles.ends.len();
        let hexes = self.hexes.iter().map(|hex| middles.with(*hex, HEX_EDGES)).collect();
        let Middles { ends, first, .. } = middles;
        if u32::try_from(first + ends.len()).is_err() {
            return Err(QuadraticError::TooMany { given: first + ends.len() });
        }
        let points = &mut self.points;
        for &[a, b] in &ends {
            let (a, b) = (points[a as usize], points[b as usize]);
            points.push(std::array::from_fn(|k| f64::midpoint(a[k], b[k])));
        }
        for (name, values) in &mut self.point_data {
            // The mean of two numbers of nodes is none.
            let mean = |a: f64, b: f64| if name == NODE { f64::NAN } else { f64::midpoint(a, b) };
            for &[a, b] in &ends {
                values.push(mean(values[a as usize], values[b as usize]));
            }
        }
        if let Some(tags) = &mut self.point_tags {
            for (i, &[a, b]) in ends.iter().enumerate() {
                let (a, b) = (tags[a as usize], tags[b as usize]);
                tags.push(if i < on_faces && a == b { a } else { 0 });
            }
        }
        self.quadratic = Some(Quadratic { quads, hexes });
        Ok(self)
    }

    /// That there are coordinates and only quads and hexes, as [`MeshData::into_quadratic`] wants them.
    ///
    /// # Errors
    /// [`QuadraticError`].
    pub fn check_straight(&self) -> Result<(), QuadraticError> {
        if !self.has_coordinates {
            return Err(QuadraticError::NoCoordinates);
        }
        let others = self.tets.len() + self.wedges.len() + self.pyramids.len();
        if self.other_faces.len() + others > 0 {
            return Err(QuadraticError::OtherCells { faces: self.other_faces.len(), cells: others });
        }
        Ok(())
    }
}

/// The faces of a mesh as they are written, with their tags, in the order of the file.
pub(crate) fn written_faces(data: &MeshData) -> impl Iterator<Item = (&[u32], i64)> + Clone {
    data.numbered_faces().map(|(quad, face, tag)| match (quad, &data.quadratic) {
        (Some(quad), Some(quadratic)) => (quadratic.quads[quad].as_slice(), tag),
        _ => (face, tag),
    })
}

/// The hexes of a mesh as they are written, with their tags.
pub(crate) fn written_hexes(data: &MeshData) -> impl Iterator<Item = (&[u32], i64)> + Clone {
    (0..data.hexes.len()).map(|h| {
        let straight = || data.hexes[h].as_slice();
        (data.quadratic.as_ref().map_or_else(straight, |quadratic| &quadratic.hexes[h]), data.hex_tag(h))
    })
}

/// The nodes of edges found so far.
struct Middles {
    node_of: FxHashMap<[u32; 2], u32>,
    /// The ends of the edge of each node, the smaller one first.
    ends: Vec<[u32; 2]>,
    /// The number of the first node.
    first: usize,
}

impl Middles {
    /// A cell with the nodes of its edges.
    fn with<const C: usize, const E: usize, const N: usize>(
        &mut self,
        corners: [u32; C],
        edges: [[usize; 2]; E],
    ) -> [u32; N] {
        const { assert!(C + E == N) };
        let mut nodes = [0; N];
        nodes[..C].copy_from_slice(&corners);
        for (node, [a, b]) in nodes[C..].iter_mut().zip(edges) {
            let (a, b) = (corners[a], corners[b]);
            let ends = [a.min(b), a.max(b)];
            *node = *self.node_of.entry(ends).or_insert_with(|| {
                self.ends.push(ends);
                (self.first + self.ends.len() - 1) as u32
            });
        }
        nodes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_have_one_node_each_and_sets_of_the_boundary_stay_whole() {
        let mut points: Vec<[f64; 3]> = Vec::new();
        for z in 0..3 {
            for (x, y) in [(0, 0), (1, 0), (1, 1), (0, 1)] {
                points.push([x, y, z].map(f64::from));
            }
        }
        let hexes = vec![[0, 1, 2, 3, 4, 5, 6, 7], [4, 5, 6, 7, 8, 9, 10, 11]];
        let mut mesh = MeshData { hexes, ..MeshData::from_quads(points, vec![[0, 3, 2, 1]]) };
        mesh.point_tags = Some((0..12).map(|v| i64::from(v < 8) * 3).collect());
        mesh.point_data = vec![("height".to_owned(), mesh.points.iter().map(|p| p[2]).collect())];
        let mesh = mesh.into_quadratic().unwrap();
        assert_eq!(mesh.points.len(), 12 + 20);
        let quadratic = mesh.quadratic.as_ref().unwrap();
        assert_eq!(quadratic.quads[0], [0, 3, 2, 1, 12, 13, 14, 15]);
        // The top of one hex is the bottom of the other, and the vertical edges come last.
        assert_eq!(quadratic.hexes[0][12..16], quadratic.hexes[1][8..12]);
        assert_eq!(mesh.points[quadratic.hexes[0][16] as usize], [0.0, 0.0, 0.5]);
        assert!(mesh.points.iter().zip(&mesh.point_data[0].1).all(|(p, h)| p[2] == *h));
        let tags = mesh.point_tags.unwrap();
        assert_eq!((&tags[12..16], &tags[16..]), (&[3; 4][..], &[0; 16][..]));
    }
}
