//! Cells as data: fillings of the buffer cubes of [`Pattern`], one text file each in `data/cells`.
//!
//! A file names its pattern and lists its hexes by role names, so it can be read, checked and replaced on its
//! own. Invariant (tested for every file): the boundary is the pattern's, the filling is proper, and it is
//! *wall-safe*: no interior edge, interior quad or body diagonal joins two points of one side facet. That is
//! what allows any two cells to meet (see the page `construction` of the book). A filling that is not wall-safe
//! is made so by [`Cell::pillowed`].

use crate::construct::{Options, construct};
use crate::pattern::{Pattern, Role, SYMMETRIES, Side, Symmetry};
use hexfill_mesh::cube::{BODY_DIAGONALS, EDGES, FACET_DIAGONALS, FACETS};
use hexfill_mesh::{Context, QuadSurface};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::sync::OnceLock;

/// A filled buffer cube.
#[derive(Clone, Debug, PartialEq)]
pub struct Cell {
    /// Its boundary.
    pub pattern: Pattern,
    /// Its points: boundary points ascending, then interior points.
    pub points: Vec<Role>,
    /// Number of boundary points; the rest is interior.
    pub n_boundary: usize,
    /// The hexes as indices into `points`, corners in VTK order, the surface's side outward.
    pub hexes: Vec<[u16; 8]>,
    /// Positions in the cube, where known (`points` order): see [`crate::template`].
    pub positions: Option<Vec<[f64; 3]>>,
}

impl Cell {
    /// Reads a cell file.
    ///
    /// # Errors
    /// A sentence with the line that cannot be read.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut pattern: Option<Pattern> = None;
        let mut hexes: Vec<[Role; 8]> = Vec::new();
        let mut positions: BTreeMap<Role, [f64; 3]> = BTreeMap::new();
        for (number, line) in text.lines().enumerate() {
            let words: Vec<&str> = line.split_whitespace().collect();
            let bad = |why: String| format!("line {}: {why}", number + 1);
            match words.as_slice() {
                [] => {}
                [first, ..] if first.starts_with('#') => {}
                ["pattern", name] => pattern = Some(name.parse().map_err(bad)?),
                ["hex", corners @ ..] if corners.len() == 8 => {
                    let mut hex = [Role::Diagonal; 8];
                    for (slot, word) in hex.iter_mut().zip(corners) {
                        *slot = word.parse().map_err(bad)?;
                    }
                    hexes.push(hex);
                }
                ["at", role, xyz @ ..] if xyz.len() == 3 => {
                    let mut p = [0.0; 3];
                    for (slot, word) in p.iter_mut().zip(xyz) {
                        *slot = word.parse().map_err(|e| bad(format!("{word}: {e}")))?;
                    }
                    positions.insert(role.parse().map_err(bad)?, p);
                }
                _ => return Err(bad(format!("`{line}` is neither `pattern`, `hex` with 8 points, nor `at`"))),
            }
        }
        let pattern = pattern.ok_or("no line `pattern`")?;
        let boundary: BTreeSet<Role> = pattern.boundary().into_iter().flatten().collect();
        let used: BTreeSet<Role> = hexes.iter().flatten().copied().collect();
        let n_boundary = boundary.len();
        let points: Vec<Role> = boundary.iter().copied().chain(used.difference(&boundary).copied()).collect();
        if points.len() > usize::from(u16::MAX) {
            return Err(format!("{} points given, the limit is {}", points.len(), u16::MAX));
        }
        let index: BTreeMap<Role, u16> = points.iter().enumerate().map(|(i, &r)| (r, i as u16)).collect();
        let hexes = hexes.iter().map(|h| h.map(|r| index[&r])).collect();
        let positions = points.iter().map(|r| positions.get(r).copied()).collect();
        Ok(Self { pattern, points, n_boundary, hexes, positions })
    }

    /// The cell as the text of a file (the inverse of [`parse`](Self::parse)).
    pub fn to_text(&self) -> String {
        let mut text = format!("pattern {}\n", self.pattern);
        for hex in &self.hexes {
            text.push_str("hex");
            for &i in hex {
                let _ = write!(text, " {}", self.points[usize::from(i)]);
            }
            text.push('\n');
        }
        for (role, p) in self.points.iter().zip(self.positions.iter().flatten()) {
            let _ = writeln!(text, "at {role} {} {} {}", p[0], p[1], p[2]);
        }
        text
    }

    fn file_name(&self) -> String {
        format!("{}.cell", self.pattern)
    }

    /// Number of points inside.
    pub fn n_interior(&self) -> usize {
        self.points.len() - self.n_boundary
    }

    /// The pairs of points of one side facet that a hex of the cell marks although the facet does not:
    /// empty iff the cell is wall-safe.
    pub fn unsafe_pairs(&self) -> Vec<(Role, Role)> {
        let mut allowed: BTreeSet<(Role, Role)> = BTreeSet::new();
        for q in self.pattern.boundary() {
            for i in 0..4 {
                for j in 0..4 {
                    allowed.insert((q[i], q[j]));
                }
            }
        }
        let sides: Vec<Vec<Role>> = (0..4).map(|k| self.pattern.side_points(k)).collect();
        let mut found: BTreeSet<(Role, Role)> = BTreeSet::new();
        for hex in &self.hexes {
            let diagonals = FACET_DIAGONALS.iter().flatten();
            for &[i, j] in EDGES.iter().chain(diagonals).chain(&BODY_DIAGONALS) {
                let (a, b) = (self.points[usize::from(hex[i])], self.points[usize::from(hex[j])]);
                let together = sides.iter().any(|s| s.contains(&a) && s.contains(&b));
                if together && !allowed.contains(&(a, b)) {
                    found.insert((a.min(b), a.max(b)));
                }
            }
        }
        found.into_iter().collect()
    }

    /// The cell with one more hex on every boundary quad, under the same boundary: always wall-safe, because each
    /// new hex meets the boundary in its own quad only.
    #[must_use]
    pub fn pillowed(&self) -> Self {
        let shift = self.n_interior() as u16;
        let mut points = self.points.clone();
        points.extend((0..self.n_boundary).map(|i| Role::Interior(shift + i as u16)));
        let index: BTreeMap<Role, u16> = points.iter().enumerate().map(|(i, &r)| (r, i as u16)).collect();
        let old = self.points.len() as u16;
        let inward = |i: u16| if usize::from(i) < self.n_boundary { old + i } else { i };
        let mut hexes: Vec<[u16; 8]> = self.hexes.iter().map(|h| h.map(inward)).collect();
        for quad in self.pattern.boundary() {
            let top = quad.map(|r| index[&r]);
            let bottom = top.map(inward);
            hexes.push([bottom[0], bottom[1], bottom[2], bottom[3], top[0], top[1], top[2], top[3]]);
        }
        Self { pattern: self.pattern, points, n_boundary: self.n_boundary, hexes, positions: None }
    }

    /// Boundary quads of the hexes, outward, as roles.
    pub fn hex_boundary(&self) -> Vec<[Role; 4]> {
        let mut count: BTreeMap<[u16; 4], Vec<[u16; 4]>> = BTreeMap::new();
        for hex in &self.hexes {
            for facet in FACETS {
                let quad = facet.map(|i| hex[i]);
                let mut key = quad;
                key.sort_unstable();
                count.entry(key).or_default().push(quad);
            }
        }
        count.into_values().filter(|v| v.len() == 1).map(|v| v[0].map(|i| self.points[usize::from(i)])).collect()
    }
}

/// A cell in one of the four positions of its quad.
#[derive(Clone, Debug)]
pub struct PlacedCell {
    /// Index of the cell in [`CellLibrary::cells`].
    pub cell: usize,
    /// Roles of the cell's boundary points in the frame of the quad.
    pub boundary: Vec<Role>,
    /// Number of points inside.
    pub n_interior: usize,
    /// The hexes, turned the right way round if the position is a mirror image.
    pub hexes: Vec<[u16; 8]>,
    /// How the cell lies in the quad.
    pub symmetry: Symmetry,
}

/// Which of the shipped cells to use where a pattern has two.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum CellChoice {
    /// The ones with the fewest hexes: for the smallest connectivity.
    #[default]
    Fewest,
    /// The ones that embed in the cube with planar sides that fit their neighbours': for coordinates.
    Embeddable,
}

/// All cells, looked up by pattern.
#[derive(Clone, Debug)]
pub struct CellLibrary {
    cells: Vec<Cell>,
    placed: Vec<PlacedCell>,
    /// Per pattern code: index into `placed`.
    lookup: Vec<u16>,
}

const ABSENT: u16 = u16::MAX;

/// A pattern as a number below 1024.
fn code(p: &Pattern) -> usize {
    let side = |k: usize| match p.sides[k] {
        Side::Light => 0usize,
        Side::Heavy => 1,
        Side::StarDiagonal => 2,
        Side::StarOdd => 3,
    };
    usize::from(p.white[0]) | usize::from(p.white[1]) << 1 | (0..4).map(|k| side(k) << (2 + 2 * k)).sum::<usize>()
}

include!("cell_files.rs");

impl CellLibrary {
    /// The cells shipped with the crate.
    pub fn built_in(choice: CellChoice) -> &'static Self {
        static FEWEST: OnceLock<CellLibrary> = OnceLock::new();
        static EMBEDDABLE: OnceLock<CellLibrary> = OnceLock::new();
        let parse =
            |(name, text): &(&str, &str)| Cell::parse(text).unwrap_or_else(|e| unreachable!("cell file {name}: {e}"));
        let fewest = || Self::completed(CELL_FILES.iter().map(parse).collect());
        match choice {
            CellChoice::Fewest => FEWEST.get_or_init(fewest),
            CellChoice::Embeddable => EMBEDDABLE.get_or_init(|| {
                let mut cells: Vec<Cell> = EMBEDDED_CELL_FILES.iter().map(parse).collect();
                let rest = FEWEST.get_or_init(fewest).cells();
                cells.extend(
                    rest.iter().filter(|c| EMBEDDED_CELL_FILES.iter().all(|(name, _)| *name != c.file_name())).cloned(),
                );
                Self::new(cells)
            }),
        }
    }

    /// A library of given cells; a cell that is not wall-safe is pillowed. Of two cells with one pattern the one
    /// with fewer hexes is used, the first one if equal.
    pub fn new(cells: Vec<Cell>) -> Self {
        let cells: Vec<Cell> =
            cells.into_iter().map(|c| if c.unsafe_pairs().is_empty() { c } else { c.pillowed() }).collect();
        let mut placed = Vec::new();
        let mut lookup = vec![ABSENT; 1024];
        for (i, cell) in cells.iter().enumerate() {
            for s in SYMMETRIES {
                let image = code(&s.pattern(&cell.pattern));
                let old = lookup[image];
                if old != ABSENT && cells[placed_cell(&placed, old)].hexes.len() <= cell.hexes.len() {
                    continue;
                }
                lookup[image] = placed.len() as u16;
                let turn = |h: &[u16; 8]| if s.mirror { [0, 3, 2, 1, 4, 7, 6, 5].map(|k: usize| h[k]) } else { *h };
                placed.push(PlacedCell {
                    cell: i,
                    boundary: cell.points[..cell.n_boundary].iter().map(|&r| s.role(r)).collect(),
                    n_interior: cell.n_interior(),
                    hexes: cell.hexes.iter().map(turn).collect(),
                    symmetry: s,
                });
            }
        }
        Self { cells, placed, lookup }
    }

    /// As [`new`](Self::new), with a cell for every pattern: one that is missing is filled by the bipartite route itself
    /// (its boundary is a small 3-connected sphere) and pillowed. Large, but always there. Needs the two `ww` patterns.
    pub fn completed(mut cells: Vec<Cell>) -> Self {
        let library = Self::new(cells.clone());
        for pattern in Pattern::all_classes() {
            if library.find(&pattern).is_none() {
                cells.extend(fill_by_construction(pattern, &library));
            }
        }
        Self::new(cells)
    }

    /// The cells.
    pub fn cells(&self) -> &[Cell] {
        &self.cells
    }

    /// The cell for a pattern, placed in its frame.
    pub fn find(&self, p: &Pattern) -> Option<&PlacedCell> {
        self.placed.get(usize::from(self.lookup[code(p)]))
    }

    /// What a cell costs where the choice is free: its hexes, and much more if it has no positions although others have.
    pub(crate) fn cost(&self, p: &Pattern) -> usize {
        const NOT_PLACED: usize = 1 << 12;
        let Some(cell) = self.find(p) else { return 1 << 20 };
        let some_placed = self.cells.iter().any(|c| c.positions.is_some());
        let is_placed = self.cells[cell.cell].positions.is_some();
        cell.hexes.len() + if some_placed && !is_placed { NOT_PLACED } else { 0 }
    }

    /// Number of hexes of the cell for a pattern.
    pub fn n_hexes(&self, p: &Pattern) -> Option<usize> {
        self.find(p).map(|c| c.hexes.len())
    }
}

/// A filling of a pattern by the bipartite route, pillowed; `None` if the library lacks the cells for that.
fn fill_by_construction(pattern: Pattern, library: &CellLibrary) -> Option<Cell> {
    let quads = pattern.boundary();
    let roles: BTreeSet<Role> = quads.iter().flatten().copied().collect();
    let roles: Vec<Role> = roles.into_iter().collect();
    let ids: Option<Vec<[u32; 4]>> = quads
        .iter()
        .map(|q| {
            let mut ids = [0; 4];
            for (slot, r) in ids.iter_mut().zip(q) {
                *slot = roles.binary_search(r).ok()? as u32;
            }
            Some(ids)
        })
        .collect();
    let surface = QuadSurface::try_new(roles.len(), &ids?).ok()?;
    let options = Options { library: Some(library.clone()), ..Options::default() };
    let made = construct(&surface, None, &options, &Context::default()).ok()?;
    let n_boundary = roles.len();
    let mut points = roles;
    points.extend((0..made.mesh.n_vertices() - n_boundary).map(|i| Role::Interior(i as u16)));
    let hexes = made.mesh.hexes().iter().map(|h| h.map(|v| v.0 as u16)).collect();
    Some(Cell { pattern, points, n_boundary, hexes, positions: None }.pillowed())
}

fn placed_cell(placed: &[PlacedCell], i: u16) -> usize {
    placed[usize::from(i)].cell
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Proper intersection by definition: what two hexes share is a face of both.
    fn improper_pairs(cell: &Cell) -> usize {
        if cell.hexes.len() > 200 {
            // Made by the construction; the tests of the construction judge the like.
            return 0;
        }
        let faces = |h: &[u16; 8]| {
            let mut all: BTreeSet<Vec<u16>> = BTreeSet::from([Vec::new(), sorted(h)]);
            all.extend(h.iter().map(|&v| vec![v]));
            all.extend(EDGES.iter().map(|e| sorted(&e.map(|i| h[i]))));
            all.extend(FACETS.iter().map(|f| sorted(&f.map(|i| h[i]))));
            all
        };
        fn sorted(ids: &[u16]) -> Vec<u16> {
            let mut v = ids.to_vec();
            v.sort_unstable();
            v
        }
        let all: Vec<_> = cell.hexes.iter().map(faces).collect();
        let mut bad = 0;
        for i in 0..all.len() {
            for j in 0..i {
                let shared: Vec<u16> =
                    sorted(&cell.hexes[i]).into_iter().filter(|v| cell.hexes[j].contains(v)).collect();
                bad += usize::from(!(all[i].contains(&shared) && all[j].contains(&shared)));
            }
        }
        bad
    }

    fn rotated(mut q: [Role; 4]) -> [Role; 4] {
        let first = (0..4).min_by_key(|&i| q[i]).unwrap();
        q.rotate_left(first);
        q
    }

    #[test]
    fn every_cell_file_is_a_proper_wall_safe_filling_of_its_pattern() {
        let library = CellLibrary::built_in(CellChoice::Fewest);
        assert_eq!(library.cells().len(), Pattern::all_classes().len());
        for (cell, (name, text)) in library.cells().iter().zip(CELL_FILES) {
            assert_eq!(format!("{}.cell", cell.pattern), *name);
            assert_eq!(Cell::parse(&cell.to_text()).as_ref(), Ok(cell));
            let found = Cell::parse(text).unwrap();
            assert_eq!(*cell, if found.unsafe_pairs().is_empty() { found } else { found.pillowed() });
            check(cell);
            check(&cell.pillowed());
        }
    }

    fn check(cell: &Cell) {
        let name = cell.pattern;
        let boundary = |quads: Vec<[Role; 4]>| quads.into_iter().map(rotated).collect::<BTreeSet<_>>();
        assert_eq!(boundary(cell.hex_boundary()), boundary(name.boundary()), "{name}: boundary, outward");
        assert_eq!(improper_pairs(cell), 0, "{name}: proper");
        assert_eq!(cell.unsafe_pairs(), [], "{name}: wall-safe");
        let mut edges = BTreeSet::new();
        let mut quads = BTreeSet::new();
        for hex in &cell.hexes {
            assert_eq!(hex.iter().collect::<BTreeSet<_>>().len(), 8);
            edges.extend(EDGES.map(|e| {
                let mut e = e.map(|i| hex[i]);
                e.sort_unstable();
                e
            }));
            quads.extend(FACETS.map(|f| {
                let mut f = f.map(|i| hex[i]);
                f.sort_unstable();
                f
            }));
        }
        let euler = cell.points.len() as i64 - edges.len() as i64 + quads.len() as i64 - cell.hexes.len() as i64;
        assert_eq!(euler, 1, "{name}: Euler characteristic of a ball");
    }

    #[test]
    fn every_pattern_has_a_cell() {
        for choice in [CellChoice::Fewest, CellChoice::Embeddable] {
            let library = CellLibrary::built_in(choice);
            for p in Pattern::all_classes() {
                check(&library.cells()[library.find(&p).unwrap().cell]);
            }
        }
    }

    #[test]
    fn embedded_cells_are_wall_safe_and_agree_with_the_template_on_their_sides() {
        for (name, text) in EMBEDDED_CELL_FILES {
            let cell = Cell::parse(text).unwrap();
            assert_eq!(cell.file_name(), *name);
            assert_eq!(Cell::parse(&cell.to_text()).as_ref(), Ok(&cell));
            check(&cell);
            let positions = cell.positions.as_ref().unwrap();
            for k in 0..4 {
                for role in cell.pattern.side_points(k) {
                    let i = cell.points.iter().position(|&r| r == role).unwrap();
                    assert_eq!(positions[i], crate::start::template_position(&cell.pattern, role), "{name}: {role}");
                }
            }
        }
    }
}
