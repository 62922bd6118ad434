//! The catalogue: named problems with their source and the best mesh known. `:name` is accepted wherever a surface is.
//!
//! Source: each entry names its own.

use hexfill_io::{Format, MeshData};

/// A named problem.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// Its name, without the colon.
    pub name: &'static str,
    /// What it is.
    pub title: &'static str,
    /// Where it comes from.
    pub source: &'static str,
    /// Fewest hexes of any mesh known for it, and who found it.
    pub best: &'static str,
    file: &'static str,
    format: Format,
    mesh: Option<&'static str>,
}

macro_rules! mesh {
    ($name:literal) => {
        Some(include_str!(concat!("../../catalog/", $name, ".mesh.json")))
    };
}

macro_rules! obj {
    ($name:literal) => {
        include_str!(concat!("../../catalog/", $name, ".obj"))
    };
}

static ENTRIES: &[Entry] = &[
    Entry {
        name: "cube",
        title: "the cube: 6 quads",
        source: "-",
        best: "1 hex",
        file: obj!("cube"),
        format: Format::Obj,
        mesh: None,
    },
    Entry {
        name: "octagonal-spindle",
        title: "octagonal spindle (tetragonal trapezohedron) with planar kites: 8 quads, one chord that crosses itself in every quad",
        source: "D. Eppstein, Linear complexity hexahedral mesh generation, 1999; coordinates computed for hexfill",
        best: "39 hexes by connectivity (found by hexfill; published: 40, Verhetsel, Pellerin, Remacle 2018); at least 23 are needed (complete search here; 21 published)",
        file: obj!("octagonal-spindle"),
        format: Format::Obj,
        mesh: mesh!("octagonal-spindle"),
    },
    Entry {
        name: "schneiders-pyramid",
        title: "Schneiders' pyramid: square base in 4 quads, each side in 3; 16 quads",
        source: "open problem posed by R. Schneiders, 1996; coordinates: Johnson solid J1 scaled by 2",
        best: "36 hexes (Verhetsel, Pellerin, Remacle 2019; the same number here); at least 20 are needed (complete search here; 17 published)",
        file: obj!("schneiders-pyramid"),
        format: Format::Obj,
        mesh: mesh!("schneiders-pyramid"),
    },
    Entry {
        name: "geode",
        title: "geode with two-quad walls: a square in 4 quads against two triangles of 3, walls of 2 quads; 18 quads",
        source: "S. Mitchell, The all-hex geode-template for conforming a diced tetrahedral mesh to any diced hexahedral mesh, 1999; boundary rebuilt here",
        best: "34 hexes (published; the same number here)",
        file: obj!("geode"),
        format: Format::Obj,
        mesh: mesh!("geode"),
    },
    Entry {
        name: "buffer-cube-20",
        title: "buffer cube: outer quad, inner facet in 6 quads, one side in 4 quads and three in 3; 20 quads",
        source: "buffer cell of the bipartite construction; built for hexfill",
        best: "37 hexes (found by hexfill)",
        file: obj!("buffer-cube-20"),
        format: Format::Obj,
        mesh: mesh!("buffer-cube-20"),
    },
    Entry {
        name: "buffer-cube-22",
        title: "buffer cube: outer quad, inner facet in 6 quads, three sides in 4 quads and one in 3; 22 quads",
        source: "buffer cell of the bipartite construction; built for hexfill",
        best: "28 hexes (found by hexfill)",
        file: obj!("buffer-cube-22"),
        format: Format::Obj,
        mesh: mesh!("buffer-cube-22"),
    },
    Entry {
        name: "carbonera-fig10",
        title: "Carbonera's figure 10: 24 quads (connectivity only)",
        source: "connectivity of figure 10 of C. Carbonera's HexMeshing examples, in a numbering of its own",
        best: "37 hexes (found by hexfill)",
        file: include_str!("../../catalog/carbonera-fig10.json"),
        format: Format::Json,
        mesh: mesh!("carbonera-fig10"),
    },
    Entry {
        name: "refinement-9-1",
        title: "refinement cube 9 -> 1: one facet in 3 x 3 quads, the opposite one whole; 26 quads",
        source: "joneuhauser/hex-templates, F9-1-H13.mesh (MIT); coordinates placed here",
        best: "13 hexes with valid geometry (published); 9 by connectivity alone (found by hexfill)",
        file: obj!("refinement-9-1"),
        format: Format::Obj,
        mesh: mesh!("refinement-9-1"),
    },
    Entry {
        name: "refinement-16-4",
        title: "refinement cube 16 -> 4: one facet in 4 x 4 quads, the opposite one in 2 x 2; 44 quads",
        source: "joneuhauser/hex-templates, F16-4-H28.mesh (MIT); coordinates placed here",
        best: "28 hexes (published)",
        file: obj!("refinement-16-4"),
        format: Format::Obj,
        mesh: mesh!("refinement-16-4"),
    },
];

/// All entries, in order of size.
///
/// ```
/// for entry in hexfill::catalog::entries() {
///     println!(":{}, {}; best known: {}", entry.name, entry.title, entry.best);
/// }
/// ```
pub fn entries() -> &'static [Entry] {
    ENTRIES
}

/// All names, with the colon.
pub fn names() -> impl Iterator<Item = String> {
    ENTRIES.iter().map(|e| format!(":{}", e.name))
}

/// The entry called `name` (without the colon); `None` if there is none.
pub fn find(name: &str) -> Option<&'static Entry> {
    ENTRIES.iter().find(|e| e.name == name)
}

impl Entry {
    /// The surface as file data.
    pub fn data(&self) -> MeshData {
        hexfill_io::read_from(self.file.as_bytes(), self.format, self.name).expect("a shipped surface is well formed")
    }

    /// The best mesh known, hexes over the surface's vertex ids (interior vertices follow), if one is shipped.
    pub fn best_mesh(&self) -> Option<MeshData> {
        self.mesh.map(|text| {
            hexfill_io::read_from(text.as_bytes(), Format::Json, self.name).expect("a shipped mesh is well formed")
        })
    }
}
