//! One self-contained HTML file, or a PNG picture, that shows a hex mesh; the chords of a surface as SVG.
//!
//! [`html`] puts the mesh, as base64 typed arrays, and a bundled viewer (`viewer/`, TypeScript on three.js) into
//! one file that opens from disk. The page asks the browser to refuse every network request (content security
//! policy `default-src 'none'`), so it works offline and sends nothing anywhere. [`png()`] draws a still picture with
//! a software rasteriser; the page carries one for browsers without WebGL. [`chord_drawing()`] draws the dual curves of a sphere.
//!
//! Invariant: both are pure functions of the input: same input, same bytes. They never fail: what does not fit
//! the mesh (a missing position, a value too few) is left out, and the page says so ([`ViewInput::problems`]).
//!
//! Not for exploring files of millions of hexes (a page holds its data whole, 45 to 100 bytes a hex; ParaView reads what `hexfill-io` writes), nor for
//! judging: colours show numbers that others computed. Invariants beside that: text of the user's can end no element of the page; a picture uses only
//! operations that IEEE 754 fixes to the last bit. Paper: Collins, Stephenson 2003 (spheres laid flat); the key is that of the book's bibliography.
//!
//! ```
//! use hexfill_mesh::HexMesh;
//! use hexfill_view::{ViewInput, html, png};
//!
//! let mesh = HexMesh::try_new(8, &[[0, 1, 2, 3, 4, 5, 6, 7]])?;
//! // One corner has no position: said, and not drawn.
//! let input = ViewInput { title: "<b>", points: &[[0.0; 3]; 7], mesh: &mesh, hex_values: None, shelling: None, groups: None, facts: &[] };
//! assert_eq!(input.problems().len(), 1);
//! assert!(html(&input).contains("<title>&lt;b&gt;"));
//! # Ok::<(), hexfill_mesh::HexMeshError>(())
//! ```

mod chord_drawing;
mod circle_packing;
mod colour;
mod gallery;
mod groups;
mod page;
mod pair;
mod picture;
mod raster;

use hexfill_mesh::{HexId, HexMesh};
use std::io::{self, Write};

pub use chord_drawing::{ChordDrawing, DrawingError, MOST_QUADS, chord_drawing, chord_thumbnail};
pub use gallery::{GalleryItem, gallery};
pub use groups::Groups;
pub use pair::{pair_png, write_pair_html};
pub use picture::{Panels, Picture, png, png_with};

/// What is shown.
#[derive(Clone, Copy, Debug)]
pub struct ViewInput<'a> {
    /// Title of the page; any text.
    pub title: &'a str,
    /// Position of each vertex, in the user's unit; `points[v]` belongs to vertex `v`.
    pub points: &'a [[f64; 3]],
    /// The mesh.
    pub mesh: &'a HexMesh,
    /// Name and one value per hex, for colours and a histogram, for example the scaled Jacobian. If the name
    /// contains "Jacobian", the scale is 0 to 1 and values of 0 and below are flagged; otherwise it is the range of the values.
    pub hex_values: Option<(&'a str, &'a [f64])>,
    /// The hexes in the order of a shelling, for the animation; without one it runs in index order.
    pub shelling: Option<&'a [HexId]>,
    /// Groups of quads, told apart by colour.
    pub groups: Option<&'a Groups>,
    /// Lines of a small table beside the picture: name and value, any text.
    pub facts: &'a [(String, String)],
}

impl ViewInput<'_> {
    /// What does not fit the mesh and is therefore left out, one sentence each; empty if all is well.
    pub fn problems(&self) -> Vec<String> {
        let n_hexes = self.mesh.n_hexes();
        let mut problems = Vec::new();
        let undrawn = self.mesh.hexes().iter().filter(|hex| !hex.iter().all(|v| self.has_position(v.index()))).count();
        if undrawn > 0 {
            problems.push(format!(
                "{undrawn} of {n_hexes} hexes have a corner without a finite position and are not drawn"
            ));
        }
        if let Some((name, values)) = self.hex_values
            && values.len() != n_hexes
        {
            problems.push(format!("\"{name}\" has {} values for {n_hexes} hexes: not shown", values.len()));
        }
        if let Some(order) = self.shelling
            && self.order().is_none()
        {
            problems.push(format!(
                "the shelling of {} entries is no order of the {n_hexes} hexes (each once): index order is shown instead",
                order.len()
            ));
        }
        problems
    }

    /// Whether `v` can be drawn.
    fn has_position(&self, v: usize) -> bool {
        // Beyond single precision the graphics card sees infinity.
        self.points.get(v).is_some_and(|p| p.iter().all(|c| c.abs() < 1e30))
    }

    /// The values, if there is one for each hex.
    fn values(&self) -> Option<(&str, &[f64])> {
        self.hex_values.filter(|(_, values)| values.len() == self.mesh.n_hexes())
    }

    /// The shelling, if it lists every hex once.
    fn order(&self) -> Option<&[HexId]> {
        let order = self.shelling?;
        let mut seen = vec![false; self.mesh.n_hexes()];
        let all_new = order.iter().all(|h| seen.get_mut(h.index()).is_some_and(|s| !std::mem::replace(s, true)));
        (all_new && order.len() == seen.len()).then_some(order)
    }
}

/// The page as text (UTF-8 HTML 5). See [`write_html`].
///
/// # Example
/// ```
/// use hexfill_mesh::HexMesh;
/// use hexfill_view::{ViewInput, html};
///
/// let mesh = HexMesh::try_new(8, &[[0, 1, 2, 3, 4, 5, 6, 7]])?;
/// let corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];
/// let points = corners.map(|p| p.map(f64::from));
/// let input = ViewInput { title: "a cube", points: &points, mesh: &mesh, hex_values: None, shelling: None, groups: None, facts: &[] };
/// assert!(input.problems().is_empty() && html(&input).contains("<title>a cube"));
/// # Ok::<(), hexfill_mesh::HexMeshError>(())
/// ```
pub fn html(input: &ViewInput<'_>) -> String {
    let mut bytes = Vec::new();
    page::write(input, &mut bytes).expect("writing to memory does not fail");
    String::from_utf8(bytes).expect("the page is made of strings")
}

/// Writes the page to `out`: about 0.7 MB for the viewer, and 45 to 100 bytes a hex.
///
/// # Errors
/// Those of `out`.
pub fn write_html(input: &ViewInput<'_>, out: &mut (impl Write + ?Sized)) -> io::Result<()> {
    page::write(input, out)
}
