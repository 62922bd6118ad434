//! Cells as data: fillings of the buffer cubes of [`Pattern`], one text file each in `data/cells`. (Found for hexfill: book, page
//! `construction`, "Cells"; the idea of a few cells once and for all is Eppstein's, 1999.)
//!
//! A file names its pattern and lists its hexes by role names, so it can be read, checked and replaced on its
//! own. Invariant (tested for every file): the boundary is the pattern's, the filling is proper, and it is
//! *wall-safe*: no interior edge, interior quad or body diagonal joins two points of one side facet. That is
//! what allows any two cells to meet (see the page `construction` of the book). A filling that is not wall-safe
//! is made so by [`Cell::pillowed`].
//!
//! Source: Eppstein 1999 (abstract: a finite case analysis) for the idea of a few cells once and for all; the cells and the condition of wall-safety are ours.

use super::pattern::{Pattern, Role};
use hexfill_mesh::cube::{BODY_DIAGONALS, EDGES, FACET_DIAGONALS, FACETS};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

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

    pub(super) fn file_name(&self) -> String {
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
