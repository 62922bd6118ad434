//! All cells, looked up by pattern.
//!
//! Source: ours; that 21 patterns are all there are is counted by its tests.

use super::cell::Cell;
use super::cell_files::{CELL_FILES, EMBEDDED_CELL_FILES};
use super::pattern::{Pattern, Role, SYMMETRIES, Side, Symmetry};
use std::sync::OnceLock;

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

impl CellLibrary {
    /// The cells shipped with the crate.
    pub fn built_in(choice: CellChoice) -> &'static Self {
        static FEWEST: OnceLock<CellLibrary> = OnceLock::new();
        static EMBEDDABLE: OnceLock<CellLibrary> = OnceLock::new();
        let parse =
            |(name, text): &(&str, &str)| Cell::parse(text).unwrap_or_else(|e| unreachable!("cell file {name}: {e}"));
        let fewest = || Self::new(CELL_FILES.iter().map(parse).collect());
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

fn placed_cell(placed: &[PlacedCell], i: u16) -> usize {
    placed[usize::from(i)].cell
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cells::template::template_position;
    use hexfill_mesh::cube::{EDGES, FACETS};
    use std::collections::BTreeSet;

    /// Proper intersection by definition: what two hexes share is a face of both.
    fn improper_pairs(cell: &Cell) -> usize {
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
    fn every_pattern_has_a_cell_among_the_files() {
        let classes = Pattern::all_classes();
        assert_eq!(classes.len(), 21);
        let shipped: BTreeSet<Pattern> =
            CELL_FILES.iter().map(|(_, text)| Cell::parse(text).unwrap().pattern).collect();
        assert!(classes.iter().all(|p| shipped.contains(p)) && shipped.len() == 21);
        for choice in [CellChoice::Fewest, CellChoice::Embeddable] {
            let library = CellLibrary::built_in(choice);
            for p in &classes {
                let cell = &library.cells()[library.find(p).unwrap().cell];
                assert!(SYMMETRIES.iter().any(|s| s.pattern(&cell.pattern) == *p));
                check(cell);
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
                    assert_eq!(positions[i], template_position(&cell.pattern, role), "{name}: {role}");
                }
            }
        }
    }
}
