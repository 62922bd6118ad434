//! Lifting: a mesh of the coarse surface becomes one of the fine surface by cutting every hex along its sheets.
//!
//! Each sheet of the coarse mesh takes the multiplicity of the chords it ends in; one without an end takes 1. A hex whose
//! three sheets have multiplicities a, b, c is cut into a x b x c. Points on the surface are the fine surface's own, known
//! from the compression, so nothing is left to be matched afterwards.
//!
//! Source: ours; that sheets end in chords is Thurston 1993, Mitchell 1996.

use crate::blend::{blend_block, springs};
use crate::classes::Classes;
use crate::compress::Coarse;
use hexfill_mesh::cube::{EDGES, FACETS, POSITIONS};
use hexfill_mesh::{Context, HexMesh};
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// A sheet that ends in chords of different multiplicities.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct MultiplicityClash;

/// A fine mesh.
pub(crate) struct Lifted {
    /// Vertices of the surface first, then new ones.
    pub n_vertices: u32,
    pub hexes: Vec<[u32; 8]>,
    /// For each coarse hex the number of hexes before its own, and at last of all.
    pub before: Vec<usize>,
    /// A first guess at the positions of all vertices, if those of the surface are known.
    pub points: Option<Vec<[f64; 3]>>,
}

/// Lifts the hexes of a coarse mesh of a surface with `n_fine` vertices at `points`.
pub(crate) fn lift(
    coarse: &Coarse,
    n_fine: u32,
    points: Option<&[[f64; 3]]>,
    hexes: &[[u32; 8]],
    ctx: &Context<'_>,
) -> Result<Lifted, MultiplicityClash> {
    let segments = segments(coarse, hexes)?;
    let at_fixed = |v: u32| points.and_then(|p| coarse.vertices.get(v as usize).map(|fine| p[fine.index()]));
    let corners = points.map(|p| (p, springs(hexes, &segments, &at_fixed, ctx)));
    let corners = corners.as_ref().map(|(p, at)| (*p, |v: u32| at[&v]));
    Ok(cut(coarse, n_fine, hexes, &segments, corners))
}

/// Cuts coarse hexes. `corners`: positions of the fine surface's vertices, and of a coarse mesh's.
fn cut(
    coarse: &Coarse,
    n_fine: u32,
    hexes: &[[u32; 8]],
    segments: &FxHashMap<[u32; 2], u32>,
    corners: Option<(&[[f64; 3]], impl Fn(u32) -> [f64; 3])>,
) -> Lifted {
    let mut lattice = Lattice::new(coarse, n_fine);
    let (mut fine, mut before) = (Vec::new(), Vec::with_capacity(hexes.len() + 1));
    let mut guess = corners.as_ref().map(|(points, _)| points.to_vec());
    for hex in hexes {
        // Twelve edges, three sizes: parallel edges are in one sheet and have one length, which the caller has made
        // sure of.
        let sizes = AXES.map(|[i, j]| segments[&pair(hex[i], hex[j])]);
        let [a, b, c] = sizes.map(|s| s as usize);
        before.push(fine.len());
        let ids = lattice.points_of(hex, sizes);
        let at = |i: usize, j: usize, k: usize| ids[(k * (b + 1) + j) * (a + 1) + i];
        if let (Some(guess), Some((_, corner))) = (&mut guess, &corners) {
            guess.resize(lattice.n_vertices as usize, [f64::NAN; 3]);
            for (p, v) in POSITIONS.iter().zip(hex) {
                let id = at(p[0] as usize * a, p[1] as usize * b, p[2] as usize * c) as usize;
                guess[id] = corner(*v);
            }
            blend_block(&ids, sizes, guess);
        }
        for k in 0..c {
            for j in 0..b {
                for i in 0..a {
                    fine.push(POSITIONS.map(|p| at(i + p[0] as usize, j + p[1] as usize, k + p[2] as usize)));
                }
            }
        }
    }
    before.push(fine.len());
    Lifted { before, n_vertices: lattice.n_vertices, hexes: fine, points: guess }
}

/// The coarse mesh that a mesh was lifted from: few hexes to find positions for, which the fine mesh can start from.
#[derive(Clone, Debug)]
pub struct CoarseMesh {
    mesh: HexMesh,
    coarse: Arc<Coarse>,
    points: Arc<[[f64; 3]]>,
}

impl CoarseMesh {
    /// The coarse mesh of these hexes, over a surface with these points.
    pub(crate) fn new(coarse: &Arc<Coarse>, points: &Arc<[[f64; 3]]>, hexes: &[[u32; 8]]) -> Option<Self> {
        let n = hexes.iter().flatten().max()? + 1;
        let mesh = HexMesh::try_new(n as usize, hexes).ok()?;
        Some(Self { mesh, coarse: Arc::clone(coarse), points: Arc::clone(points) })
    }

    /// Its hexes.
    pub fn mesh(&self) -> &HexMesh {
        &self.mesh
    }

    /// Positions of the vertices of its boundary, which come first.
    pub fn boundary(&self) -> Vec<[f64; 3]> {
        self.coarse.vertices.iter().map(|fine| self.points[fine.index()]).collect()
    }

    /// Positions of all vertices of the fine mesh, blended between those of the coarse mesh; the surface's own come first, bit for bit.
    pub fn lifted(&self, at: &[[f64; 3]]) -> Option<Vec<[f64; 3]>> {
        let hexes = self.mesh.hexes_raw();
        let segments = segments(&self.coarse, &hexes).ok()?;
        let corners = Some((&*self.points, |v: u32| at[v as usize]));
        cut(&self.coarse, self.points.len() as u32, &hexes, &segments, corners).points
    }
}

/// Edges from corner 0 along x, y and z.
pub(crate) const AXES: [[usize; 2]; 3] = [[0, 1], [0, 3], [0, 4]];

fn pair(a: u32, b: u32) -> [u32; 2] {
    if a < b { [a, b] } else { [b, a] }
}

/// Classes of edges that are parallel across hexes: each is the edges one sheet crosses.
pub(crate) struct ParallelClasses {
    /// The class of each edge (smaller vertex first).
    pub of: FxHashMap<[u32; 2], u32>,
    pub n: usize,
}

/// The classes of a mesh, numbered by their first edge in the order of the hexes.
pub(crate) fn parallel_classes(hexes: &[[u32; 8]]) -> ParallelClasses {
    let mut of: FxHashMap<[u32; 2], u32> = FxHashMap::default();
    let mut classes = Classes::new(0);
    for hex in hexes {
        // The edges come four to an axis.
        for axis in EDGES.chunks(4) {
            let mut first = None;
            for &[i, j] in axis {
                let id = *of.entry(pair(hex[i], hex[j])).or_insert_with(|| classes.add());
                classes.join(id, *first.get_or_insert(id));
            }
        }
    }
    of.values_mut().for_each(|class| *class = classes.root(*class));
    ParallelClasses { of, n: classes.len() }
}

/// Per edge of the coarse mesh (smaller vertex first): into how many it is cut.
pub(crate) fn segments(coarse: &Coarse, hexes: &[[u32; 8]]) -> Result<FxHashMap<[u32; 2], u32>, MultiplicityClash> {
    let classes = parallel_classes(hexes);
    let mut of_class = vec![0u32; classes.n];
    for d in coarse.surface.darts() {
        let e = pair(coarse.surface.origin(d).0, coarse.surface.target(d).0);
        let Some(&class) = classes.of.get(&e) else { continue };
        let slot = &mut of_class[class as usize];
        let length = coarse.length[d.index()];
        // A sheet may end in several chords. Nothing in a flip keeps their multiplicities equal; a mesh in which they
        // differ cannot be cut.
        if *slot != 0 && *slot != length {
            return Err(MultiplicityClash);
        }
        *slot = length;
    }
    Ok(classes.of.into_iter().map(|(e, class)| (e, of_class[class as usize].max(1))).collect())
}

/// Ids of the fine points, as they are asked for.
pub(crate) struct Lattice {
    n_vertices: u32,
    /// Fine vertex of each coarse one; coarse vertices beyond the surface's get theirs on demand.
    corner: FxHashMap<u32, u32>,
    /// Points inside an edge, from its smaller vertex on.
    edge: FxHashMap<[u32; 2], Vec<u32>>,
    /// Points inside a quad: rows from its smallest vertex towards the smaller of that one's neighbours.
    quad: FxHashMap<[u32; 4], Vec<u32>>,
}

/// A quad seen from its smallest vertex, towards that one's smaller neighbour first.
struct Frame {
    key: [u32; 4],
    /// Corner the rows start at, and whether rows run along the second axis.
    corner: usize,
    swapped: bool,
}

/// `corners` in the order (0,0), (1,0), (1,1), (0,1).
fn frame(corners: [u32; 4]) -> Frame {
    let corner = (0..4).min_by_key(|&i| corners[i]).expect("four corners");
    let [ahead, behind] = [corners[(corner + 1) & 3], corners[(corner + 3) & 3]];
    let swapped = behind < ahead;
    let mut key = corners;
    key.sort_unstable();
    Frame { key, corner, swapped }
}

impl Frame {
    /// Index into the stored points of the inner point (i, j), `0 < i < a`, `0 < j < b`.
    fn index(&self, i: u32, j: u32, a: u32, b: u32) -> usize {
        // Steps along the cycle's first and second direction from the start corner.
        let (u, v, nu, nv) = match self.corner {
            0 => (i, j, a, b),
            1 => (j, a - i, b, a),
            2 => (a - i, b - j, a, b),
            _ => (b - j, i, b, a),
        };
        let (u, v, nu) = if self.swapped { (v, u, nv) } else { (u, v, nu) };
        ((v - 1) * (nu - 1) + u - 1) as usize
    }
}

impl Lattice {
    pub(crate) fn new(coarse: &Coarse, n_fine: u32) -> Self {
        let mut lattice = Self {
            n_vertices: n_fine,
            corner: coarse.vertices.iter().enumerate().map(|(v, fine)| (v as u32, fine.0)).collect(),
            edge: FxHashMap::default(),
            quad: FxHashMap::default(),
        };
        for (quad, grid) in coarse.surface.quads().iter().zip(&coarse.grids) {
            let corners = quad.map(|v| v.0);
            let (a, b) = (grid.width, grid.height);
            let at = |i: u32, j: u32| grid.vertices[(j * (a + 1) + i) as usize].0;
            let sides: [(usize, usize, Vec<u32>); 4] = [
                (0, 1, (1..a).map(|i| at(i, 0)).collect()),
                (1, 2, (1..b).map(|j| at(a, j)).collect()),
                (3, 2, (1..a).map(|i| at(i, b)).collect()),
                (0, 3, (1..b).map(|j| at(0, j)).collect()),
            ];
            for (from, to, mut points) in sides {
                let (from, to) = (corners[from], corners[to]);
                // Points of an edge are kept from its smaller vertex on, so that every hex at it reads them in one
                // order.
                if from > to {
                    points.reverse();
                }
                lattice.edge.insert(pair(from, to), points);
            }
            let frame = frame(corners);
            let mut inner = vec![0; (a as usize - 1) * (b as usize - 1)];
            for j in 1..b {
                for i in 1..a {
                    inner[frame.index(i, j, a, b)] = at(i, j);
                }
            }
            lattice.quad.insert(frame.key, inner);
        }
        lattice
    }

    pub(crate) fn n_vertices(&self) -> u32 {
        self.n_vertices
    }

    /// Point number `i` inside the edge from `v` to `w`, counted from `v`; the edge is one of a hex whose points were asked for.
    pub(crate) fn point_on_edge(&self, v: u32, w: u32, i: usize) -> u32 {
        let points = &self.edge[&pair(v, w)];
        if v < w { points[i] } else { points[points.len() - 1 - i] }
    }

    /// The points of a hex cut into `a x b x c`, x fastest.
    pub(crate) fn points_of(&mut self, hex: &[u32; 8], [a, b, c]: [u32; 3]) -> Vec<u32> {
        let sizes = [a, b, c];
        let mut points = vec![u32::MAX; (a as usize + 1) * (b as usize + 1) * (c as usize + 1)];
        let index = |p: [u32; 3]| ((p[2] * (b + 1) + p[1]) * (a + 1) + p[0]) as usize;
        let scaled =
            |corner: usize| -> [u32; 3] { std::array::from_fn(|k| u32::from(POSITIONS[corner][k]) * sizes[k]) };
        let next_id = &mut self.n_vertices;
        let mut fresh = || {
            *next_id += 1;
            *next_id - 1
        };
        for (i, &v) in hex.iter().enumerate() {
            points[index(scaled(i))] = *self.corner.entry(v).or_insert_with(&mut fresh);
        }
        for [i, j] in EDGES {
            let axis = (0..3).find(|&k| POSITIONS[i][k] != POSITIONS[j][k]).expect("an edge has a direction");
            let n = sizes[axis];
            let (from, to) = if hex[i] < hex[j] { (i, j) } else { (j, i) };
            // Whoever comes first makes the points; the others find them in the order from the smaller vertex on.
            let ids = self.edge.entry(pair(hex[i], hex[j])).or_insert_with(|| (1..n).map(|_| fresh()).collect());
            for s in 1..n {
                let mut p = scaled(from);
                p[axis] = if POSITIONS[to][axis] == 1 { s } else { n - s };
                points[index(p)] = ids[s as usize - 1];
            }
        }
        for facet in FACETS {
            // Two axes of the facet: from its corner 0 to 1, and from 0 to 3.
            let axis = |from: usize, to: usize| {
                (0..3).find(|&k| POSITIONS[from][k] != POSITIONS[to][k]).expect("neighbours differ in one axis")
            };
            let (x, y) = (axis(facet[0], facet[1]), axis(facet[0], facet[3]));
            let (nx, ny) = (sizes[x], sizes[y]);
            if nx < 2 || ny < 2 {
                continue;
            }
            // A quad is seen by its two hexes from either side and from any corner: its inner points are kept in a
            // frame that its vertices alone fix.
            let frame = frame(facet.map(|i| hex[i]));
            let n_inner = (nx as usize - 1) * (ny as usize - 1);
            let ids = self.quad.entry(frame.key).or_insert_with(|| (0..n_inner).map(|_| fresh()).collect());
            for j in 1..ny {
                for i in 1..nx {
                    let mut p = scaled(facet[0]);
                    p[x] = if POSITIONS[facet[1]][x] == 1 { i } else { nx - i };
                    p[y] = if POSITIONS[facet[3]][y] == 1 { j } else { ny - j };
                    points[index(p)] = ids[frame.index(i, j, nx, ny)];
                }
            }
        }
        // What is left is inside the hex and nobody else's.
        for p in &mut points {
            if *p == u32::MAX {
                *p = fresh();
            }
        }
        points
    }
}
