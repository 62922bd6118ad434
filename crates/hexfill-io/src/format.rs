//! The file formats and the names they go by.
//!
//! Source: ours.

use std::fmt;
use std::path::Path;

/// A file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Format {
    /// Wavefront OBJ: a surface.
    Obj,
    /// Object File Format of Geomview: a surface.
    Off,
    /// Stanford PLY, ASCII and binary: a surface.
    Ply,
    /// Legacy VTK, ASCII and binary: surface and mesh.
    Vtk,
    /// VTK XML: unstructured grid (`.vtu`), and polygonal data (`.vtp`, read only).
    Vtu,
    /// MEDIT `.mesh` of INRIA: surface and mesh.
    Medit,
    /// Gmsh MSH 2.2: surface and mesh.
    Msh22,
    /// Gmsh MSH 4.1: surface and mesh.
    Msh41,
    /// Abaqus and CalculiX input: surface and mesh.
    Inp,
    /// Nastran bulk data: surface and mesh.
    Nastran,
    /// I-DEAS universal: surface and mesh.
    Unv,
    /// OpenVolumeMesh ASCII: mesh.
    Ovm,
    /// JSON of hexes and boundary quads, coordinates optional.
    Json,
}

/// A format nobody here knows.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FormatError {
    /// The extension of a path says nothing.
    #[error(
        "{path}: unknown file extension `{extension}`; known are {known} (each also with .gz or .zst), or name the format explicitly"
    )]
    UnknownExtension {
        /// The path.
        path: String,
        /// Its extension, empty if it has none.
        extension: String,
        /// The extensions that are known.
        known: String,
    },
    /// The extension of a format that is not read, with what to do.
    #[error("{path}: {title} cannot be read or written here; {remedy}")]
    Foreign {
        /// The path.
        path: String,
        /// What the format holds.
        title: &'static str,
        /// What to do.
        remedy: &'static str,
    },
    /// A name of a format that says nothing.
    #[error("unknown format `{given}`; known are {known}")]
    UnknownName {
        /// The name.
        given: String,
        /// The names that are known.
        known: String,
    },
    /// An extension that is read but not written.
    #[error("{path}: `.{extension}` is read but not written; use `.{instead}`")]
    ReadOnly {
        /// The path.
        path: String,
        /// Its extension.
        extension: String,
        /// The extension to use.
        instead: &'static str,
    },
}

/// How the bytes of a file are packed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Compression {
    /// gzip, `.gz`.
    Gzip,
    /// Zstandard, `.zst`.
    Zstd,
}

impl Compression {
    /// The packing that the last extension of a path names.
    pub fn from_path(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "gz" => Some(Self::Gzip),
            "zst" => Some(Self::Zstd),
            _ => None,
        }
    }
}

/// Extensions of formats that users try, what they hold, and what to do.
const FOREIGN: [(&[&str], &str, &str); 6] = [
    (
        &["stl"],
        "STL holds triangles and",
        "hexfill fills surfaces of quads: mesh the shape with quads (Gmsh with Mesh.RecombineAll=1, a quad remesher such as QuadriFlow) \
         and save it as .obj, .ply or .msh",
    ),
    (
        &["step", "stp", "iges", "igs", "brep", "sat", "x_t"],
        "CAD geometry has no mesh and",
        "mesh its surface with quads (Gmsh with Mesh.RecombineAll=1) and save it as .msh or .vtk",
    ),
    (
        &["dat"],
        "what .dat stands for is not known and",
        "rename it (.bdf if it is Nastran), or name the format explicitly",
    ),
    (&["exo", "e", "ex2", "cgns", "med", "xdmf", "h5"], "this format", "convert it with meshio to .vtu or .msh"),
    (&["meshb", "ovmb"], "the binary flavour of this format", "save it as text (.mesh, .ovm)"),
    (&["3ds", "dae", "fbx", "glb", "gltf", "blend"], "this format", "export .obj or .ply with quads, not triangulated"),
];

impl Format {
    /// All formats, in the order of the documentation.
    pub const ALL: [Self; 13] = [
        Self::Obj,
        Self::Off,
        Self::Ply,
        Self::Vtk,
        Self::Vtu,
        Self::Medit,
        Self::Msh22,
        Self::Msh41,
        Self::Inp,
        Self::Nastran,
        Self::Unv,
        Self::Ovm,
        Self::Json,
    ];

    /// The name by which a user asks for the format.
    pub fn name(self) -> &'static str {
        match self {
            Self::Obj => "obj",
            Self::Off => "off",
            Self::Ply => "ply",
            Self::Vtk => "vtk",
            Self::Vtu => "vtu",
            Self::Medit => "medit",
            Self::Msh22 => "msh22",
            Self::Msh41 => "msh41",
            Self::Inp => "inp",
            Self::Nastran => "nastran",
            Self::Unv => "unv",
            Self::Ovm => "ovm",
            Self::Json => "json",
        }
    }

    /// The name of the format in a sentence.
    pub fn title(self) -> &'static str {
        match self {
            Self::Obj => "Wavefront OBJ",
            Self::Off => "OFF",
            Self::Ply => "PLY",
            Self::Vtk => "legacy VTK",
            Self::Vtu => "VTK XML (VTU)",
            Self::Medit => "MEDIT .mesh",
            Self::Msh22 => "Gmsh MSH 2.2",
            Self::Msh41 => "Gmsh MSH 4.1",
            Self::Inp => "Abaqus/CalculiX .inp",
            Self::Nastran => "Nastran bulk data",
            Self::Unv => "I-DEAS universal",
            Self::Ovm => "OpenVolumeMesh ASCII",
            Self::Json => "JSON",
        }
    }

    /// The extensions of the format, the usual one first.
    ///
    /// `.msh` means [`Format::Msh22`] on writing; on reading the file itself says which version it is.
    pub fn extensions(self) -> &'static [&'static str] {
        match self {
            Self::Obj => &["obj"],
            Self::Off => &["off"],
            Self::Ply => &["ply"],
            Self::Vtk => &["vtk"],
            Self::Vtu => &["vtu", "vtp"],
            Self::Medit => &["mesh"],
            Self::Msh22 => &["msh", "msh2"],
            Self::Msh41 => &["msh4"],
            Self::Inp => &["inp"],
            Self::Nastran => &["bdf", "nas"],
            Self::Unv => &["unv"],
            Self::Ovm => &["ovm"],
            Self::Json => &["json"],
        }
    }

    /// The format that the extension of a path names; a final `.gz` or `.zst` is looked through.
    ///
    /// # Errors
    /// [`FormatError::UnknownExtension`] with the list of those known.
    ///
    /// # Example
    /// ```
    /// use hexfill_io::Format;
    /// use std::path::Path;
    ///
    /// assert_eq!(Format::from_path(Path::new("part.INP"))?, Format::Inp);
    /// assert_eq!(Format::from_path(Path::new("part.vtk.zst"))?, Format::Vtk);
    /// assert!(Format::from_path(Path::new("part.step")).is_err());
    /// # Ok::<(), hexfill_io::FormatError>(())
    /// ```
    pub fn from_path(path: &Path) -> Result<Self, FormatError> {
        let stem = Compression::from_path(path).and_then(|_| path.file_stem()).map(Path::new);
        let extension =
            stem.unwrap_or(path).extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
        Self::ALL.into_iter().find(|f| f.extensions().contains(&extension.as_str())).ok_or_else(|| {
            if let Some((_, title, remedy)) = FOREIGN.iter().find(|(names, ..)| names.contains(&extension.as_str())) {
                return FormatError::Foreign { path: path.display().to_string(), title, remedy };
            }
            let known: Vec<_> = Self::ALL.iter().flat_map(|f| f.extensions()).map(|e| format!(".{e}")).collect();
            FormatError::UnknownExtension { path: path.display().to_string(), extension, known: known.join(", ") }
        })
    }

    /// The format of a [`name`](Self::name) or of an extension, in any case.
    ///
    /// # Errors
    /// [`FormatError::UnknownName`] with the list of those known.
    pub fn from_name(name: &str) -> Result<Self, FormatError> {
        let lower = name.trim_start_matches('.').to_ascii_lowercase();
        Self::ALL.into_iter().find(|f| f.name() == lower || f.extensions().contains(&lower.as_str())).ok_or_else(|| {
            FormatError::UnknownName { given: name.to_owned(), known: Self::ALL.map(Self::name).join(", ") }
        })
    }

    /// Whether the format can hold hexahedra; the others hold surfaces only.
    pub fn holds_cells(self) -> bool {
        !matches!(self, Self::Obj | Self::Off | Self::Ply)
    }

    /// Whether the format can hold faces of any number of sides; the others hold triangles and quads.
    pub fn holds_polygons(self) -> bool {
        matches!(self, Self::Obj | Self::Off | Self::Ply | Self::Vtk | Self::Vtu | Self::Ovm | Self::Json)
    }

    /// Whether cells of second order (8-node quads, 20-node hexes) are written.
    pub fn holds_quadratic(self) -> bool {
        matches!(self, Self::Vtk | Self::Vtu | Self::Msh22 | Self::Msh41 | Self::Inp | Self::Nastran | Self::Unv)
    }

    /// Whether quads (and hexes, if it holds them) keep their tags.
    pub fn holds_cell_tags(self) -> bool {
        self != Self::Off
    }

    /// Whether points keep their tags.
    pub fn holds_point_tags(self) -> bool {
        !matches!(self, Self::Obj | Self::Off | Self::Nastran)
    }

    /// Whether named numbers on points, quads and hexes are kept.
    pub fn holds_data(self) -> bool {
        !matches!(self, Self::Obj | Self::Off | Self::Medit | Self::Inp | Self::Nastran | Self::Unv)
    }

    /// Whether the format has a binary flavour that is written here.
    pub fn has_binary(self) -> bool {
        matches!(self, Self::Ply | Self::Vtk | Self::Vtu)
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl std::str::FromStr for Format {
    type Err = FormatError;
    fn from_str(s: &str) -> Result<Self, FormatError> {
        Self::from_name(s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extensions_and_names_are_found_again() {
        for format in Format::ALL {
            assert_eq!(Format::from_name(format.name()), Ok(format));
            for extension in format.extensions() {
                for path in [format!("a.b/c.{extension}"), format!("c.{}.gz", extension.to_uppercase())] {
                    assert_eq!(Format::from_path(Path::new(&path)), Ok(format), "{path}");
                }
            }
        }
        for path in ["mesh", "mesh.xyz", "dir.obj/mesh", "mesh.gz", ".obj"] {
            let message = Format::from_path(Path::new(path)).unwrap_err().to_string();
            assert!(message.contains(".vtk") && message.contains(path), "{message}");
        }
        assert!(Format::from_name("stl").unwrap_err().to_string().contains("medit"));
    }
}
