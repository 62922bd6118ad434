//! [`MeshData`]: what a file holds, as plain arrays in the order of the file. No topology is checked here;
//! `QuadSurface` and `HexMesh` do that.
//!
//! Invariants after reading: every index names a point (where there are coordinates), coordinates are finite,
//! `other_faces` is sorted by position, and tag and data arrays are as long as what they describe.
//!
//! Source: ours.

use crate::error::WriteError;
use crate::format::Format;
use crate::quadratic_cells::Quadratic;
use hexfill_mesh::{HexMesh, HexMeshError, QuadSurface, SurfaceError};
use std::collections::BTreeMap;

/// A face that is no quad.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OtherFace {
    /// Index among *all* faces of the file (quads included), from 0.
    pub position: usize,
    /// Its vertices in cyclic order: three, five or more.
    pub vertices: Vec<u32>,
    /// Its tag, 0 if it has none.
    pub tag: i64,
}

/// What a tag with a name is on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum TagOn {
    /// Points (node sets).
    Points,
    /// Faces (boundary conditions).
    Faces,
    /// Cells (materials).
    Cells,
}

/// A name of a tag: of a physical group of Gmsh, a set of Abaqus, a group, object or material of OBJ.
///
/// Groups may overlap, so a tag can have several names (it stands for what is in all of them), and a name several tags.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct TagName {
    /// Whose tags.
    pub on: TagOn,
    /// The tag, not 0.
    pub tag: i64,
    /// The name, as in the file.
    pub name: String,
}

impl TagOn {
    /// The dimension of what the tag is on, as Gmsh counts.
    pub(crate) fn dimension(self) -> i64 {
        [0, 2, 3][self as usize]
    }

    pub(crate) fn from_dimension(dimension: i64) -> Option<Self> {
        [Self::Points, Self::Faces, Self::Cells].into_iter().find(|on| on.dimension() == dimension)
    }
}

/// How the comments begin that hold names of tags in formats without a place for them.
const NAME_LINE: &str = "hexfill: tag of";

impl TagName {
    /// The name as the text of a comment.
    pub(crate) fn line(&self) -> String {
        let on = ["points", "faces", "cells"][self.on as usize];
        let name: String = self.name.chars().map(|c| if c.is_control() { '_' } else { c }).collect();
        format!("{NAME_LINE} {on} {} {name}", self.tag)
    }

    /// Reads the text of a comment, if it is such a one.
    pub(crate) fn from_line(text: &str) -> Option<Self> {
        let (on, rest) = text.trim().strip_prefix(NAME_LINE)?.trim_start().split_once(' ')?;
        let (tag, name) = rest.split_once(' ')?;
        let on = match on {
            "points" => TagOn::Points,
            "faces" => TagOn::Faces,
            "cells" => TagOn::Cells,
            _ => return None,
        };
        Some(Self { on, tag: tag.parse().ok()?, name: name.to_owned() })
    }
}

/// A surface, a mesh, or both, as a file holds it. All indices are 0-based.
///
/// A tag is a number a user gave to a point, face or cell (boundary condition, material; the "reference" of MEDIT, the
/// "physical group" of Gmsh). 0 means "none": an array of tags that are all 0 is read as `None`.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshData {
    /// Coordinates, bit for bit as in the file. Empty if `has_coordinates` is false.
    pub points: Vec<[f64; 3]>,
    /// The faces with four sides, in cyclic order.
    pub quads: Vec<[u32; 4]>,
    /// All other faces; their `position` says where they stand among the quads.
    pub other_faces: Vec<OtherFace>,
    /// Hexahedra in VTK_HEXAHEDRON order.
    pub hexes: Vec<[u32; 8]>,
    /// Tetrahedra.
    pub tets: Vec<[u32; 4]>,
    /// Wedges (prisms), in the order of the file.
    pub wedges: Vec<[u32; 6]>,
    /// Pyramids: base quad, then apex.
    pub pyramids: Vec<[u32; 5]>,
    /// One tag per point.
    pub point_tags: Option<Vec<i64>>,
    /// One tag per quad.
    pub quad_tags: Option<Vec<i64>>,
    /// One tag per hex.
    pub hex_tags: Option<Vec<i64>>,
    /// Names of tags, in order of what they are on, then of the tags.
    pub tag_names: Vec<TagName>,
    /// Named numbers, one per point. NaN means "no value". Arrays `name:0`, `name:1`, ... that stand side by side are the
    /// components of one array of the file (a vector); so in all data.
    pub point_data: Vec<(String, Vec<f64>)>,
    /// Named numbers, one per quad. NaN means "no value".
    pub quad_data: Vec<(String, Vec<f64>)>,
    /// Named numbers, one per hex (qualities). NaN means "no value".
    pub hex_data: Vec<(String, Vec<f64>)>,
    /// The points that lie only on edges, faces or insides of cells of higher order, rising; those cells are in the other arrays
    /// with their corners alone. See [`linearised`](Self::linearised).
    pub middles: Vec<u32>,
    /// What is written in place of `quads` and `hexes`: the same with nodes on their edges. Readers leave it empty; see
    /// [`into_quadratic`](Self::into_quadratic).
    pub quadratic: Option<Quadratic>,
    /// False if the file has connectivity only.
    pub has_coordinates: bool,
    /// What was recognised and what was passed over, for the user.
    pub notes: Vec<String>,
}

impl Default for MeshData {
    fn default() -> Self {
        Self {
            points: Vec::new(),
            quads: Vec::new(),
            other_faces: Vec::new(),
            hexes: Vec::new(),
            tets: Vec::new(),
            wedges: Vec::new(),
            pyramids: Vec::new(),
            point_tags: None,
            quad_tags: None,
            hex_tags: None,
            tag_names: Vec::new(),
            point_data: Vec::new(),
            quad_data: Vec::new(),
            hex_data: Vec::new(),
            middles: Vec::new(),
            quadratic: None,
            has_coordinates: true,
            notes: Vec::new(),
        }
    }
}

impl MeshData {
    /// A surface of quads.
    pub fn from_quads(points: Vec<[f64; 3]>, quads: Vec<[u32; 4]>) -> Self {
        Self { points, quads, ..Self::default() }
    }

    /// Number of vertices: of points, or without coordinates one more than the largest index.
    pub fn vertex_count(&self) -> usize {
        if self.has_coordinates { self.points.len() } else { self.largest_index().map_or(0, |i| i as usize + 1) }
    }

    /// Number of faces of any number of sides.
    pub fn face_count(&self) -> usize {
        self.quads.len() + self.other_faces.len()
    }

    /// Number of cells of any kind.
    pub fn cell_count(&self) -> usize {
        self.hexes.len() + self.tets.len() + self.wedges.len() + self.pyramids.len()
    }

    /// All faces in the order of the file, each as the cycle of its vertices.
    pub fn faces(&self) -> impl Iterator<Item = &[u32]> {
        self.tagged_faces().map(|(face, _)| face)
    }

    /// All faces with their tags (0 for none), in the order of the file.
    pub(crate) fn tagged_faces(&self) -> impl Iterator<Item = (&[u32], i64)> + Clone {
        self.numbered_faces().map(|(_, face, tag)| (face, tag))
    }

    /// All faces with their tags (0 for none), in the order of the file, and the index of each face that is a quad among the quads.
    pub fn numbered_faces(&self) -> impl Iterator<Item = (Option<usize>, &[u32], i64)> + Clone {
        let (mut position, mut quad, mut other) = (0, 0, 0);
        std::iter::from_fn(move || {
            // Positions that leave gaps (a hand-made MeshData) do no harm: the other faces then come last.
            let next = self.other_faces.get(other);
            let item = match next {
                Some(face) if face.position <= position || quad >= self.quads.len() => {
                    other += 1;
                    Some((None, face.vertices.as_slice(), face.tag))
                }
                _ => {
                    let item = self.quads.get(quad).map(|q| (Some(quad), q.as_slice(), self.quad_tag(quad)));
                    quad += 1;
                    item
                }
            };
            position += 1;
            item
        })
    }

    pub(crate) fn quad_tag(&self, quad: usize) -> i64 {
        self.quad_tags.as_ref().and_then(|tags| tags.get(quad)).copied().unwrap_or(0)
    }

    pub(crate) fn hex_tag(&self, hex: usize) -> i64 {
        self.hex_tags.as_ref().and_then(|tags| tags.get(hex)).copied().unwrap_or(0)
    }

    /// The faces as a closed surface.
    ///
    /// # Errors
    /// [`SurfaceError`]; faces that are not quads are named by their position in the file.
    pub fn quad_surface(&self) -> Result<QuadSurface, SurfaceError> {
        if self.other_faces.is_empty() {
            return QuadSurface::try_new(self.vertex_count(), &self.quads);
        }
        let faces: Vec<&[u32]> = self.faces().collect();
        QuadSurface::try_from_polygons(self.vertex_count(), &faces)
    }

    /// The hexes as a mesh.
    ///
    /// # Errors
    /// [`HexMeshError`].
    pub fn hex_mesh(&self) -> Result<HexMesh, HexMeshError> {
        HexMesh::try_new(self.vertex_count(), &self.hexes)
    }

    /// The same without cells: what a surface format can hold.
    pub fn surface_only(&self) -> Self {
        Self {
            hexes: Vec::new(),
            tets: Vec::new(),
            wedges: Vec::new(),
            pyramids: Vec::new(),
            hex_tags: None,
            hex_data: Vec::new(),
            tag_names: self.tag_names.iter().filter(|n| n.on != TagOn::Cells).cloned().collect(),
            quadratic: self.quadratic.clone().map(Quadratic::without_hexes),
            ..self.clone()
        }
    }

    /// The same without the [`middles`](Self::middles): cells of higher order have become straight ones for good. Other points keep
    /// their order.
    pub fn linearised(mut self) -> Self {
        let middles = std::mem::take(&mut self.middles);
        if middles.is_empty() {
            return self;
        }
        let kept = |v: usize| middles.binary_search(&(v as u32)).is_err();
        let n = self.points.len();
        let mut number = vec![u32::MAX; n];
        for (new, old) in (0..n).filter(|&v| kept(v)).enumerate() {
            number[old] = new as u32;
        }
        self.renumber(&number);
        self.notes.push(format!(
            "cells of higher order are read as their corners; {} points between these are dropped",
            middles.len()
        ));
        self
    }

    /// Gives points the numbers `number` (`u32::MAX`: dropped). The first point of each number keeps its data.
    pub(crate) fn renumber(&mut self, number: &[u32]) {
        let mut first: Vec<usize> = Vec::new();
        for (old, &new) in number.iter().enumerate() {
            if new as usize == first.len() {
                first.push(old);
            }
        }
        self.points = first.iter().map(|&v| self.points[v]).collect();
        if let Some(tags) = &mut self.point_tags {
            *tags = first.iter().map(|&v| tags[v]).collect();
        }
        for (_, values) in &mut self.point_data {
            *values = first.iter().map(|&v| values[v]).collect();
        }
        let faces = self.quads.iter_mut().flatten().chain(self.other_faces.iter_mut().flat_map(|f| &mut f.vertices));
        let cells = self.hexes.iter_mut().flatten().chain(self.tets.iter_mut().flatten());
        let rest = self.wedges.iter_mut().flatten().chain(self.pyramids.iter_mut().flatten());
        let second = self.quadratic.iter_mut().flat_map(Quadratic::nodes_mut);
        faces.chain(cells).chain(rest).chain(second).for_each(|v| *v = number[*v as usize]);
    }

    /// The names of each tag.
    pub(crate) fn names_by_tag(&self) -> BTreeMap<(TagOn, i64), Vec<&str>> {
        let mut names: BTreeMap<(TagOn, i64), Vec<&str>> = BTreeMap::new();
        for name in &self.tag_names {
            names.entry((name.on, name.tag)).or_default().push(&name.name);
        }
        names
    }

    /// Each name of a tag with all it stands for, as `[tag, dimension]`: how meshio and files of VTK keep the names of groups.
    pub(crate) fn names_as_fields(&self) -> Vec<(&str, Vec<[i64; 2]>)> {
        let mut fields: Vec<(&str, Vec<[i64; 2]>)> = Vec::new();
        let mut place_of: BTreeMap<&str, usize> = BTreeMap::new();
        for name in &self.tag_names {
            let place = *place_of.entry(&name.name).or_insert(fields.len());
            if place == fields.len() {
                fields.push((&name.name, Vec::new()));
            }
            fields[place].1.push([name.tag, name.on.dimension()]);
        }
        fields
    }

    fn largest_index(&self) -> Option<u32> {
        let faces = self.quads.iter().flatten().chain(self.other_faces.iter().flat_map(|f| &f.vertices));
        let cells = self.hexes.iter().flatten().chain(self.tets.iter().flatten());
        let rest = self.wedges.iter().flatten().chain(self.pyramids.iter().flatten());
        faces.chain(cells).chain(rest).max().copied()
    }

    /// Checks that the arrays fit together, that coordinates are finite and that `format` has a place for everything
    /// that must not be lost (points, faces, cells).
    ///
    /// # Errors
    /// The first [`WriteError`] that writing would meet.
    pub fn check_for(&self, format: Format) -> Result<(), WriteError> {
        if !self.has_coordinates && format != Format::Json {
            return Err(WriteError::NoCoordinates { format });
        }
        if !self.has_coordinates && !self.points.is_empty() {
            let what = format!("{} points although `has_coordinates` is false", self.points.len());
            return Err(WriteError::Inconsistent { what });
        }
        self.check_lengths()?;
        for (point, coordinates) in self.points.iter().enumerate() {
            for (&given, axis) in coordinates.iter().zip(['x', 'y', 'z']) {
                if !given.is_finite() {
                    return Err(WriteError::NotFinite { point, axis, given });
                }
            }
        }
        if self.has_coordinates
            && let Some(index) = self.largest_index().filter(|&i| i as usize >= self.points.len())
        {
            let what = format!("index {index} is used, but there are only {} points", self.points.len());
            return Err(WriteError::Inconsistent { what });
        }
        if !format.holds_cells() && self.cell_count() > 0 {
            return Err(WriteError::CannotHold {
                format,
                what: format!("{} cells ({} hexes)", self.cell_count(), self.hexes.len()),
                remedy: "write the surface alone, or use a mesh format such as .vtk, .vtu, .mesh or .msh".to_owned(),
            });
        }
        if self.quadratic.is_some() {
            WriteError::check_quadratic(format)?;
        }
        if !format.holds_polygons()
            && let Some(face) = self.other_faces.iter().find(|f| f.vertices.len() != 3)
        {
            return Err(WriteError::CannotHold {
                format,
                what: format!("a face with {} sides (face {}, 0-based)", face.vertices.len(), face.position),
                remedy: "use .vtk, .vtu, .obj, .off or .ply".to_owned(),
            });
        }
        let mixed = self.tets.len() + self.wedges.len() + self.pyramids.len();
        if format == Format::Unv && !self.pyramids.is_empty() {
            return Err(WriteError::CannotHold {
                format,
                what: format!("{} pyramids", self.pyramids.len()),
                remedy: "use .vtk, .vtu, .mesh or .msh".to_owned(),
            });
        }
        // Fields of eight columns.
        if format == Format::Nastran && self.points.len().max(self.face_count() + self.cell_count()) > 99_999_999 {
            return Err(WriteError::CannotHold {
                format,
                what: "more than 99,999,999 points or elements".to_owned(),
                remedy: "use .vtu".to_owned(),
            });
        }
        if format == Format::Json && mixed > 0 {
            return Err(WriteError::CannotHold {
                format,
                what: format!("{mixed} cells that are not hexes"),
                remedy: "use .vtk, .vtu, .mesh or .msh".to_owned(),
            });
        }
        Ok(())
    }

    fn check_lengths(&self) -> Result<(), WriteError> {
        let n = self.vertex_count();
        let arrays = [
            ("point_tags", self.point_tags.as_ref().map(Vec::len), n),
            ("quad_tags", self.quad_tags.as_ref().map(Vec::len), self.quads.len()),
            ("hex_tags", self.hex_tags.as_ref().map(Vec::len), self.hexes.len()),
        ];
        let tags = arrays.into_iter().filter_map(|(name, given, due)| given.map(|g| (name.to_owned(), g, due)));
        let point_data = self.point_data.iter().map(|(name, v)| (format!("point data `{name}`"), v.len(), n));
        let hex_data = self.hex_data.iter().map(|(name, v)| (format!("hex data `{name}`"), v.len(), self.hexes.len()));
        let quad_data =
            self.quad_data.iter().map(|(name, v)| (format!("quad data `{name}`"), v.len(), self.quads.len()));
        for (name, given, due) in tags.chain(point_data).chain(quad_data).chain(hex_data) {
            if given != due {
                return Err(WriteError::Inconsistent { what: format!("{name} has {given} values instead of {due}") });
            }
        }
        let is_alone = self.other_faces.is_empty() && self.cell_count() == self.hexes.len();
        if self.quadratic.as_ref().is_some_and(|q| !is_alone || !q.fits(&self.quads, &self.hexes, n)) {
            let what = "`quadratic` is not of these quads and hexes".to_owned();
            return Err(WriteError::Inconsistent { what });
        }
        if let Some(face) = self.other_faces.iter().find(|f| f.vertices.len() < 3 || f.vertices.len() == 4) {
            let what = format!("an entry of `other_faces` has {} vertices", face.vertices.len());
            return Err(WriteError::Inconsistent { what });
        }
        Ok(())
    }
}
