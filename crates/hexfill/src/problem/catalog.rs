//! The catalogue: named problems with their source and the best mesh known. `:name` is accepted wherever a surface is.
//!
//! Source: each entry names its own.

use hexfill_io::{Format, MeshData};
use std::fmt;

/// A named problem.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// Its name, without the colon.
    pub name: &'static str,
    /// What it is.
    pub title: &'static str,
    /// Where it comes from.
    pub source: &'static str,
    /// What is known of the fewest hexes it needs.
    pub record: Record,
    file: &'static str,
    format: Format,
    mesh: Option<&'static str>,
}

/// The fewest hexes known to fill a surface, and what others published. [`Record::fmt`](std::fmt::Display) says it in a line.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Record {
    /// Hexes of the best mesh known here; where one is shipped, it has as many.
    pub hexes: usize,
    /// Fewest hexes published, and by whom.
    pub published: Option<(usize, &'static str)>,
    /// No ball of so many hexes or fewer fills it, whatever its symmetry: the largest bound that `hexfill search` exhausted
    /// (`record/search-2026-11-22.md`).
    pub exhausted: Option<usize>,
    /// What else is to be said.
    pub note: Option<&'static str>,
}

impl Record {
    const fn of(hexes: usize) -> Self {
        Self { hexes, published: None, exhausted: None, note: None }
    }

    const fn published(mut self, hexes: usize, by: &'static str) -> Self {
        self.published = Some((hexes, by));
        self
    }

    const fn exhausted(mut self, hexes: usize) -> Self {
        self.exhausted = Some(hexes);
        self
    }

    const fn note(mut self, note: &'static str) -> Self {
        self.note = Some(note);
        self
    }

    /// At least so many hexes are needed, if that was proved here.
    pub fn needed(&self) -> Option<usize> {
        self.exhausted.map(|most| most + 1)
    }
}

impl fmt::Display for Record {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} hex{}", self.hexes, if self.hexes == 1 { "" } else { "es" })?;
        if let Some((hexes, by)) = self.published {
            write!(f, "; published {hexes} ({by})")?;
        }
        if let Some(needed) = self.needed() {
            write!(f, "; at least {needed} are needed")?;
        }
        self.note.map_or(Ok(()), |note| write!(f, "; {note}"))
    }
}

const VERHETSEL_2018: &str = "Verhetsel, Pellerin, Remacle 2018";
/// Who published most of the numbers that are compared with.
pub const VERHETSEL_2019: &str = "Verhetsel, Pellerin, Remacle 2019";
const TEMPLATES: &str = "joneuhauser/hex-templates 2026";

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
        record: Record::of(1),
        file: obj!("cube"),
        format: Format::Obj,
        mesh: None,
    },
    Entry {
        name: "octagonal-spindle",
        title: "octagonal spindle (tetragonal trapezohedron) with planar kites: 8 quads, one chord that crosses itself in every quad",
        source: "D. Eppstein, Linear complexity hexahedral mesh generation, 1999; coordinates computed for hexfill",
        record: Record::of(39).published(40, VERHETSEL_2018).exhausted(22),
        file: obj!("octagonal-spindle"),
        format: Format::Obj,
        mesh: mesh!("octagonal-spindle"),
    },
    Entry {
        name: "schneiders-pyramid",
        title: "Schneiders' pyramid: square base in 4 quads, each side in 3; 16 quads",
        source: "open problem posed by R. Schneiders, 1996; coordinates: Johnson solid J1 scaled by 2",
        record: Record::of(36).published(36, "Xiang, Liu 2018").exhausted(19),
        file: obj!("schneiders-pyramid"),
        format: Format::Obj,
        mesh: mesh!("schneiders-pyramid"),
    },
    Entry {
        name: "geode",
        title: "geode with two-quad walls: a square in 4 quads against two triangles of 3, walls of 2 quads; 18 quads",
        source: "S. Mitchell, The all-hex geode-template for conforming a diced tetrahedral mesh to any diced hexahedral mesh, 1999; boundary rebuilt here",
        record: Record::of(34).published(34, TEMPLATES),
        file: obj!("geode"),
        format: Format::Obj,
        mesh: mesh!("geode"),
    },
    Entry {
        name: "buffer-cube-20",
        title: "buffer cube: outer quad, inner facet in 6 quads, one side in 4 quads and three in 3; 20 quads",
        source: "buffer cell of the bipartite construction; built for hexfill",
        record: Record::of(37).published(40, VERHETSEL_2019),
        file: obj!("buffer-cube-20"),
        format: Format::Obj,
        mesh: mesh!("buffer-cube-20"),
    },
    Entry {
        name: "buffer-cube-22",
        title: "buffer cube: outer quad, inner facet in 6 quads, three sides in 4 quads and one in 3; 22 quads",
        source: "buffer cell of the bipartite construction; built for hexfill",
        record: Record::of(28).published(40, VERHETSEL_2019),
        file: obj!("buffer-cube-22"),
        format: Format::Obj,
        mesh: mesh!("buffer-cube-22"),
    },
    Entry {
        name: "carbonera-fig10",
        title: "Carbonera's figure 10: 24 quads (connectivity only)",
        source: "connectivity of figure 10 of C. Carbonera's HexMeshing examples, in a numbering of its own",
        record: Record::of(37),
        file: include_str!("../../catalog/carbonera-fig10.json"),
        format: Format::Json,
        mesh: mesh!("carbonera-fig10"),
    },
    Entry {
        name: "refinement-9-1",
        title: "refinement cube 9 -> 1: one facet in 3 x 3 quads, the opposite one whole; 26 quads",
        source: "joneuhauser/hex-templates, F9-1-H13.mesh (MIT); coordinates placed here",
        record: Record::of(13).published(13, TEMPLATES).note("9 by connectivity alone, found here"),
        file: obj!("refinement-9-1"),
        format: Format::Obj,
        mesh: mesh!("refinement-9-1"),
    },
    Entry {
        name: "refinement-16-4",
        title: "refinement cube 16 -> 4: one facet in 4 x 4 quads, the opposite one in 2 x 2; 44 quads",
        source: "joneuhauser/hex-templates, F16-4-H28.mesh (MIT); coordinates placed here",
        record: Record::of(28).published(28, TEMPLATES),
        file: obj!("refinement-16-4"),
        format: Format::Obj,
        mesh: mesh!("refinement-16-4"),
    },
];

/// All entries, in order of size.
///
/// ```
/// for entry in hexfill::catalog::entries() {
///     println!(":{}, {}; best known: {}", entry.name, entry.title, entry.record);
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
