//! [`Coarsening`]: three parallel sheets become one inside a mesh, where nothing asks for so many.
//!
//! A surface fixes how many sheets end in it, not how far in they go. Three sheets that lie one on the other may go in as one, the outer two turned
//! back into each other: the *core*, where all three are, keeps the vertices below and above and loses the two layers between. Along the rim of the
//! core, whose columns keep four vertices, one hex a facet stands between three and one:
//!
//! ```text
//!     .---.---.---.---.            .---.---.-------.
//!     |   |   |   |   |            |   |  /        |
//!     .---.---.---.---.            .---.-'         |     the core begins at the third line;
//!     |   |   |   |   |    ->      |   | |         |     its side of three edges is one, and a hex
//!     .---.---.---.---.            .---.-.         |     (here a quad) has all four of them
//!     |   |   |   |   |            |   |  \        |
//!     .---.---.---.---.            .---.---.-------.
//! ```
//! So a core of k columns with a rim of r facets loses 2 k - r hexes. Cells that met properly still do: no cell outside touches the core at levels
//! that are not neighbours, and no two columns share a vertex. Transitions do not touch each other sideways: what a fold left behind is no inner vertex of the next core.
//!
//! Source: Schneiders 1996 (three to one); Shepherd et al. 2010 (coarsening of what is there); folding whole stacks of sheets is ours.

use crate::classes::Classes;
use crate::stacks::{sheet_of, stacks};
use hexfill_mesh::cube::{EDGES, FACETS};
use hexfill_mesh::{Context, HexMesh, HexMeshError, sheets};
use rustc_hash::{FxHashMap, FxHashSet};

/// The corners below in each direction: with those above they are the hex, turned.
const BOTTOM: [[usize; 4]; 3] = [[3, 7, 4, 0], [4, 5, 1, 0], [0, 1, 2, 3]];
/// No sheet: one that was turned back, and a hex that is gone.
const NONE: u32 = u32::MAX;
/// The directions of a hex in which the edges of its bottom run, in turn.
const ROUND: [[usize; 2]; 3] = [[2, 1], [0, 2], [0, 1]];

/// A mesh that becomes coarser inside, round by round.
///
/// # Example
/// A block of 11 x 11 x 11 cubes.
/// ```
/// use hexfill_mesh::{Context, generate::grid};
/// use hexfill_shell::Coarsening;
///
/// let mesh = grid(11, 11, 11)?;
/// let mut coarsening = Coarsening::new(&mesh);
/// assert!(coarsening.round(&Context::default()));
/// let coarse = coarsening.mesh()?;
/// assert!(coarse.mesh.n_hexes() < 1000);
/// assert_eq!(coarse.mesh.boundary_quads().len(), mesh.boundary_quads().len());
/// # Ok::<(), hexfill_mesh::HexMeshError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Coarsening {
    /// Vertices that stay: those of the surface and those of no hex.
    stays: Vec<bool>,
    /// On the surface, or at a hex between three and one.
    is_marked: Vec<bool>,
    hexes: Vec<[u32; 8]>,
    /// The hex of the mesh given that each was.
    origin: Vec<Option<u32>>,
}

/// What a mesh has become.
#[derive(Clone, Debug)]
pub struct Coarsened {
    /// The mesh. Vertices keep their order; where those of the surface came first, they keep their ids. Vertices of no hex are kept.
    pub mesh: HexMesh,
    /// For each vertex the one of the mesh given that it was.
    pub vertices: Vec<u32>,
    /// For each hex the one that it was, or `None` between three and one. Those of a core were the middle ones.
    pub origin: Vec<Option<u32>>,
}

impl Coarsening {
    /// Begins with a mesh.
    pub fn new(mesh: &HexMesh) -> Self {
        let on_surface = mesh.boundary_vertices();
        let mut stays = vec![true; mesh.n_vertices()];
        mesh.hexes().iter().flatten().for_each(|v| stays[v.index()] = on_surface[v.index()]);
        Self {
            stays,
            is_marked: on_surface,
            origin: (0..mesh.n_hexes() as u32).map(Some).collect(),
            hexes: mesh.hexes_raw(),
        }
    }

    /// Folds every stack once, three sheets into one; whether that took hexes away. A stop is heeded between two folds.
    pub fn round(&mut self, ctx: &Context<'_>) -> bool {
        let Ok(mesh) = HexMesh::try_new(self.is_marked.len(), &self.hexes) else { return false };
        let before = self.hexes.len();
        let sheets = sheets(&mesh);
        let of = sheet_of(&mesh, &sheets);
        let mut work = Work::new(self, of, sheets.len());
        let stacks = stacks(&mesh, &sheets, &work.of);
        'stacks: for (i, stack) in stacks.iter().enumerate() {
            ctx.report("coarsen", i as u64, Some(stacks.len() as u64), || format!("{before} hexes at first"));
            for three in work.threes(stack) {
                if ctx.stop().is_some() {
                    break 'stacks;
                }
                work.fold(three);
            }
        }
        work.finish();
        self.hexes.len() < before
    }

    /// What the mesh is now.
    ///
    /// # Errors
    /// None for what [`HexMesh`] took in the first place.
    pub fn mesh(&self) -> Result<Coarsened, HexMeshError> {
        let mut stays = self.stays.clone();
        self.hexes.iter().flatten().for_each(|&v| stays[v as usize] = true);
        let vertices: Vec<u32> = (0..stays.len() as u32).filter(|&v| stays[v as usize]).collect();
        let mut new = vec![NONE; stays.len()];
        vertices.iter().zip(0..).for_each(|(&old, v)| new[old as usize] = v);
        let hexes: Vec<[u32; 8]> = self.hexes.iter().map(|h| h.map(|v| new[v as usize])).collect();
        Ok(Coarsened { mesh: HexMesh::try_new(vertices.len(), &hexes)?, vertices, origin: self.origin.clone() })
    }
}

/// A round.
struct Work<'a> {
    mesh: &'a mut Coarsening,
    /// The sheets of each hex; all `NONE` for a hex that is gone.
    of: Vec<[u32; 3]>,
    /// The hexes at each vertex.
    at: Vec<Vec<u32>>,
    /// The hexes of each sheet, with the direction.
    members: Vec<Vec<(u32, u8)>>,
}

/// Three hexes one on the other: the levels of their quads from below, each in the order of its columns.
#[derive(Clone, Copy)]
struct Column {
    hexes: [u32; 3],
    direction: u8,
    levels: [[u32; 4]; 4],
}

impl Column {
    /// The four vertices over a corner.
    fn over(&self, i: usize) -> [u32; 4] {
        self.levels.map(|quad| quad[i])
    }

    /// The middle sheet's lower edge from a corner to the next.
    fn side(&self, i: usize) -> [u32; 2] {
        let (a, b) = (self.levels[1][i], self.levels[1][(i + 1) % 4]);
        [a.min(b), a.max(b)]
    }
}

/// The columns at each side: one at the rim.
fn sides(core: &[Column]) -> FxHashMap<[u32; 2], Vec<u32>> {
    let mut sides: FxHashMap<[u32; 2], Vec<u32>> = FxHashMap::default();
    for (c, column) in core.iter().enumerate() {
        (0..4).for_each(|i| sides.entry(column.side(i)).or_default().push(c as u32));
    }
    sides
}

/// The connected parts of a core that have at least as many columns as sides at the rim.
fn worth_folding(core: Vec<Column>) -> Vec<Column> {
    let mut parts = Classes::new(core.len());
    let sides = sides(&core);
    sides.values().for_each(|columns| columns.iter().for_each(|&c| parts.join(columns[0], c)));
    let mut gain = vec![0i64; core.len()];
    (0..core.len() as u32).for_each(|c| gain[parts.root(c) as usize] += 1);
    sides.values().filter(|columns| columns.len() == 1).for_each(|c| gain[parts.root(c[0]) as usize] -= 1);
    core.into_iter().zip(0..).filter_map(|(c, i)| (gain[parts.root(i) as usize] >= 0).then_some(c)).collect()
}

impl<'a> Work<'a> {
    fn new(mesh: &'a mut Coarsening, of: Vec<[u32; 3]>, n_sheets: usize) -> Self {
        let mut at = vec![Vec::new(); mesh.is_marked.len()];
        let mut members = vec![Vec::new(); n_sheets];
        for (h, hex) in mesh.hexes.iter().enumerate() {
            hex.iter().for_each(|&v| at[v as usize].push(h as u32));
            (0..3).for_each(|d| members[of[h][d] as usize].push((h as u32, d as u8)));
        }
        Self { mesh, of, at, members }
    }

    /// The sheets of a stack in threes, begun where most columns can be folded; what is left over stays at the ends.
    fn threes(&self, stack: &[u32]) -> Vec<[u32; 3]> {
        let from = |first: usize| stack[first..].chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect::<Vec<_>>();
        let even = stack.len() % 3 / 2;
        let others = (0..3.min(stack.len() - 2)).filter(|&first| first != even);
        let all: Vec<_> = std::iter::once(even).chain(others).map(from).collect();
        // The first of equal ones.
        all.into_iter()
            .rev()
            .max_by_key(|threes| threes.iter().map(|&three| self.columns(three).count()).sum::<usize>())
            .unwrap_or_default()
    }

    /// The columns that three sheets have where all of them lie one on the other.
    fn columns(&self, sheets: [u32; 3]) -> impl Iterator<Item = Column> + '_ {
        let middle = &self.members[sheets[1] as usize];
        middle.iter().filter_map(move |&(h, d)| self.column(h, d, sheets))
    }

    /// Folds three sheets that lie one on the other, where that takes enough hexes away.
    fn fold(&mut self, sheets: [u32; 3]) {
        let mut core: Vec<Column> = self.columns(sheets).collect();
        loop {
            let bad = self.bad_vertices(&core);
            if bad.is_empty() {
                break;
            }
            core.retain(|c| !c.levels.as_flattened().iter().any(|v| bad.contains(v)));
        }
        self.replace(&worth_folding(core), sheets[1]);
    }

    /// The column round a hex of the middle sheet, if all three sheets are there and it stays away from the surface.
    fn column(&self, hex: u32, direction: u8, [low, _, high]: [u32; 3]) -> Option<Column> {
        let d = usize::from(direction);
        let corners = self.mesh.hexes[hex as usize];
        let [below, above] = [0, 1].map(|side| self.across(hex, FACETS[2 * d + side].map(|i| corners[i])));
        let (below, above) = (below?, above?);
        let sheet = |(h, d): (u32, usize)| self.of[h as usize][d];
        let mut q1 = BOTTOM[d].map(|i| corners[i]);
        let mut q2 = self.beyond((hex, d), q1)?;
        let (mut lower, mut upper) = (below, above);
        match (sheet(below), sheet(above)) {
            (b, a) if b == low && a == high => (),
            (b, a) if b == high && a == low => {
                (lower, upper) = (above, below);
                // Turned over it is seen from the other side.
                q1.reverse();
                q2.reverse();
                (q1, q2) = (q2, q1);
            }
            _ => return None,
        }
        let levels = [self.beyond(lower, q1)?, q1, q2, self.beyond(upper, q2)?];
        // These have hexes, so what stays is on the surface.
        let is_inside = |v: &u32| !self.mesh.stays[*v as usize];
        let is_free = |v: &u32| !self.mesh.is_marked[*v as usize];
        let is_fit = levels.as_flattened().iter().all(is_inside) && levels[1].iter().chain(&levels[2]).all(is_free);
        is_fit.then_some(Column { hexes: [lower.0, hex, upper.0], direction, levels })
    }

    /// The other hex at a facet, and the direction in which it lies there.
    fn across(&self, hex: u32, quad: [u32; 4]) -> Option<(u32, usize)> {
        let has = |h: u32| quad.iter().all(|v| self.mesh.hexes[h as usize].contains(v));
        let other = self.at[quad[0] as usize].iter().copied().find(|&h| h != hex && has(h))?;
        let corners = self.mesh.hexes[other as usize];
        let side = FACETS.iter().position(|f| f.iter().all(|&i| quad.contains(&corners[i])))?;
        Some((other, side / 2))
    }

    /// The vertices of a hex opposite to those of one of its quads in this direction.
    fn beyond(&self, (hex, d): (u32, usize), quad: [u32; 4]) -> Option<[u32; 4]> {
        let corners = self.mesh.hexes[hex as usize];
        let mut found = [NONE; 4];
        for (v, to) in quad.iter().zip(&mut found) {
            let mut edges = EDGES[4 * d..4 * d + 4].iter().map(|edge| edge.map(|i| corners[i]));
            *to = edges.find_map(|[a, b]| match *v {
                v if v == a => Some(b),
                v if v == b => Some(a),
                _ => None,
            })?;
        }
        Some(found)
    }

    /// Vertices of columns that a core must not have: where columns differ, where the rim touches itself, and where cells outside touch the core at levels that
    /// are not neighbours.
    fn bad_vertices(&self, core: &[Column]) -> FxHashSet<u32> {
        let mut bad = FxHashSet::default();
        let mut is_core: FxHashSet<u32> = FxHashSet::default();
        // The column and the level of each vertex.
        let mut place: FxHashMap<u32, ([u32; 4], usize)> = FxHashMap::default();
        for column in core {
            for h in column.hexes {
                if !is_core.insert(h) {
                    bad.extend(column.levels[1]);
                }
            }
            for over in (0..4).map(|i| column.over(i)) {
                for (level, &v) in over.iter().enumerate() {
                    if place.insert(v, (over, level)).is_some_and(|was| was != (over, level)) {
                        bad.insert(v);
                    }
                }
            }
        }
        let mut ends: FxHashMap<u32, u32> = FxHashMap::default();
        for (edge, _) in sides(core).iter().filter(|(_, columns)| columns.len() == 1) {
            edge.iter().for_each(|&v| *ends.entry(v).or_default() += 1);
        }
        bad.extend(ends.iter().filter(|(_, n)| **n != 2).map(|(&v, _)| v));
        for &v in place.keys() {
            for &h in self.at[v as usize].iter().filter(|h| !is_core.contains(h)) {
                let levels =
                    || self.mesh.hexes[h as usize].iter().filter_map(|w| place.get(w).map(|(_, level)| *level));
                if levels().min().zip(levels().max()).is_some_and(|(least, most)| most - least > 1) {
                    bad.insert(v);
                }
            }
        }
        bad
    }

    /// Puts one hex in the place of each column, and one at each facet of the rim.
    fn replace(&mut self, core: &[Column], middle: u32) {
        let sides = sides(core);
        for column in core {
            let hex = column.hexes[1] as usize;
            let (of, origin) = (self.of[hex], self.mesh.origin[hex]);
            let [bottom, low, high, top] = column.levels;
            let new = self.mesh.hexes[hex].map(|v| {
                let moved = |from: [u32; 4], to: [u32; 4]| from.iter().position(|&w| w == v).map(|i| to[i]);
                moved(low, bottom).or_else(|| moved(high, top)).unwrap_or(v)
            });
            column.hexes.iter().for_each(|&h| self.remove(h));
            self.add(new, of, origin);
            for i in (0..4).filter(|&i| sides[&column.side(i)].len() == 1) {
                let ([a0, a1, a2, a3], [b0, b1, b2, b3]) = (column.over(i), column.over((i + 1) % 4));
                let hex = [a0, a3, a2, a1, b0, b3, b2, b1];
                hex.iter().for_each(|&v| self.mesh.is_marked[v as usize] = true);
                // Its x is the middle sheet's direction, its y that of the two that turn back, its z runs along the rim.
                self.add(hex, [middle, NONE, of[ROUND[usize::from(column.direction)][i % 2]]], None);
            }
        }
    }

    /// Forgets the hexes that are gone.
    fn finish(self) {
        let Self { mesh, of, .. } = self;
        let mut stays = of.iter().map(|of| *of != [NONE; 3]);
        mesh.origin.retain(|_| stays.next() == Some(true));
        let mut stays = of.iter().map(|of| *of != [NONE; 3]);
        mesh.hexes.retain(|_| stays.next() == Some(true));
    }

    fn remove(&mut self, hex: u32) {
        for v in self.mesh.hexes[hex as usize] {
            self.at[v as usize].retain(|&h| h != hex);
        }
        self.of[hex as usize] = [NONE; 3];
    }

    fn add(&mut self, hex: [u32; 8], of: [u32; 3], origin: Option<u32>) {
        let h = self.mesh.hexes.len() as u32;
        hex.iter().for_each(|&v| self.at[v as usize].push(h));
        (0..3).filter(|&d| of[d] != NONE).for_each(|d| self.members[of[d] as usize].push((h, d as u8)));
        self.mesh.hexes.push(hex);
        self.mesh.origin.push(origin);
        self.of.push(of);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hexfill_check::{Judged, Level, judge};
    use hexfill_mesh::euler_characteristic;
    use hexfill_mesh::generate::{grid, grid_mesh_of};

    /// A mesh as coarse as it becomes, judged: proper, with the boundary it had, of the same kind. Every round takes hexes away.
    fn coarsened(fine: &HexMesh) -> Coarsened {
        let mut coarsening = Coarsening::new(fine);
        let mut before = fine.n_hexes();
        while coarsening.round(&Context::default()) {
            let made = coarsening.mesh().unwrap();
            assert!(made.mesh.n_hexes() < before);
            before = made.mesh.n_hexes();
            // Every vertex of the surface is still there.
            let new = |v: u32| made.vertices.binary_search(&v).unwrap() as u32;
            let quads: Vec<[u32; 4]> = fine.boundary_quads_raw().iter().map(|q: &[u32; 4]| q.map(new)).collect();
            let hexes = made.mesh.hexes_raw();
            let input = Judged::connectivity(made.mesh.n_vertices(), &hexes).with_surface(&quads);
            let options = hexfill_check::Options::default().with_up_to(Level::L3);
            let report = judge(&input, &options, &Context::default());
            assert!(report.passed(Level::L3), "{:?}", report.failures);
            assert_eq!(euler_characteristic(&made.mesh), euler_characteristic(fine));
        }
        let made = coarsening.mesh().unwrap();
        assert_eq!((made.mesh.n_hexes(), made.mesh.n_vertices()), (made.origin.len(), made.vertices.len()));
        let all = 0..fine.n_hexes() as u32;
        assert!(made.origin.iter().flatten().all(|h| all.contains(h)));
        made
    }

    #[test]
    fn every_small_block() {
        for [a, b, c] in (1..=9).flat_map(|a| (a..=9).flat_map(move |b| (b..=9).map(move |c| [a, b, c]))) {
            let made = coarsened(&grid(a, b, c).unwrap()).mesh.n_hexes();
            // Three sheets need one more at both ends; a core has at least as many columns as sides.
            let is_worth = |[l, x, y]: [usize; 3]| l >= 5 && x > 4 && y > 4 && (x - 4) * (y - 4) >= 4;
            let expected = [[a, b, c], [b, c, a], [c, a, b]].into_iter().any(is_worth);
            assert_eq!(made < a * b * c, expected, "{a} {b} {c}: {made}");
        }
    }

    #[test]
    fn a_large_block_of_three_directions() {
        // 20 x 20 x 20: six threes a direction. A third round would have cores as large as their rims.
        let made = coarsened(&grid(20, 20, 20).unwrap());
        assert!(made.mesh.n_hexes() < 3600, "{}", made.mesh.n_hexes());
    }

    #[test]
    fn solids_of_blocks() {
        let mut smaller = 0;
        for seed in 0..40u64 {
            let bits = (seed + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(23);
            let is_filled = |[x, y, z]: [usize; 3]| z == 0 || bits >> (9 * z + 3 * y + x) & 1 == 1;
            let mesh = grid_mesh_of([18; 3], |cell| is_filled(cell.map(|x| x / 6))).unwrap();
            // Blocks that touch in an edge only are no solid.
            let quads = mesh.boundary_quads_raw();
            if hexfill_mesh::QuadSurface::on_own_vertices(quads).is_ok() {
                smaller += usize::from(coarsened(&mesh).mesh.n_hexes() < mesh.n_hexes());
            }
        }
        assert!(smaller >= 3, "{smaller}");
    }

    #[test]
    fn rings_keep_three_sheets_round() {
        // Between 4 and 12 blocks of 7 x 7 in a ring.
        for n in 4..=12u32 {
            let at = |i: u32, x: u32, y: u32| (i % n) * 64 + y * 8 + x;
            let cells = (0..n).flat_map(|i| (0..49).map(move |c| (i, c % 7, c / 7)));
            let hexes: Vec<[u32; 8]> = cells
                .map(|(i, x, y)| {
                    let quad = |i| [at(i, x, y), at(i, x + 1, y), at(i, x + 1, y + 1), at(i, x, y + 1)];
                    let ([a, b, c, d], [e, f, g, h]) = (quad(i), quad(i + 1));
                    [a, b, c, d, e, f, g, h]
                })
                .collect();
            coarsened(&HexMesh::try_new(64 * n as usize, &hexes).unwrap());
        }
    }

    #[test]
    fn a_stop_ends_a_round_early() {
        let stop = std::sync::atomic::AtomicBool::new(true);
        let ctx = Context { cancel: Some(&stop), ..Context::default() };
        let mesh = grid(9, 9, 9).unwrap();
        let mut coarsening = Coarsening::new(&mesh);
        assert!(!coarsening.round(&ctx));
        assert_eq!(coarsening.mesh().unwrap().mesh.n_hexes(), 729);
    }
}
