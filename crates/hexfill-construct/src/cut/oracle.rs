//! An oracle for Sigma, for tests: the whole cocycle system, dense, eliminated over GF(2).
//!
//! One unknown per edge of the tets. A triangle has an even number of cut edges; surface edges between black ends are cut, the
//! others and the diagonals are not. Nothing is shared with the solver: no forest, no classes, no symbols.
//! The complexes: balls, tori of all parities (straight and twisted), chains of tori glued along quads (genus 2 to 4),
//! balls with cavities, and several of these apart.

use super::sigma;
use crate::core::complex::{TetComplex, sorted};
use crate::core::cone::{BallCore, ConeTets};
use crate::core::handlebody::HandlebodyTets;
use crate::core::maker::InteriorTets;
use crate::core::request::TetRequest;
use crate::error::ConstructError;
use crate::ids::{EdgeId, FaceId};
use crate::plan::colouring::{Colouring, all_black, colouring};
use crate::surface::existence::Existence;
use hexfill_mesh::generate::{Random, random_sphere, torus};
use hexfill_mesh::{Context, Dart, Edge, IdVec, QuadId, QuadSurface, VertexId, is_proper};
use std::collections::{BTreeMap, BTreeSet};

/// A row of bits; the last one is the right side.
type Row = Vec<u64>;

fn set(row: &mut Row, bit: usize) {
    row[bit / 64] ^= 1 << (bit % 64);
}

fn has(row: &Row, bit: usize) -> bool {
    row[bit / 64] >> (bit % 64) & 1 == 1
}

/// Whether `rows` (each `n` unknowns and a right side) have a solution.
fn solvable(mut rows: Vec<Row>, n: usize) -> bool {
    let mut done = 0;
    for bit in 0..n {
        let Some(pivot) = (done..rows.len()).find(|&r| has(&rows[r], bit)) else { continue };
        rows.swap(done, pivot);
        let head = rows[done].clone();
        for row in rows[done + 1..].iter_mut().filter(|r| has(r, bit)) {
            row.iter_mut().zip(&head).for_each(|(x, y)| *x ^= y);
        }
        done += 1;
    }
    rows[done..].iter().all(|r| !has(r, n))
}

/// A solid: its surface, the colours, the triangles (two a quad), tets, and the edge of the tets under each dart.
#[derive(Clone)]
struct Solid {
    surface: QuadSurface,
    colours: Colouring,
    triangles: Vec<[VertexId; 3]>,
    complex: TetComplex,
}

/// First corner of the diagonal of each quad, then its triangles: between black corners.
fn triangles(surface: &QuadSurface, colours: &Colouring) -> Vec<[VertexId; 3]> {
    let two = |q: [VertexId; 4]| {
        let turn = usize::from(colours.white[q[0]] || colours.white[q[2]]);
        let c = |k: usize| q[(k + turn) % 4];
        [[c(0), c(1), c(2)], [c(2), c(3), c(0)]]
    };
    (0..surface.n_quads()).flat_map(|q| two(surface.quad(QuadId::new(q)))).collect()
}

impl Solid {
    fn ball(surface: &QuadSurface, colours: Colouring, core: BallCore) -> Self {
        let triangles = triangles(surface, &colours);
        let request = TetRequest { n_vertices: surface.n_vertices(), triangles: &triangles, points: None };
        let complex = ConeTets { surface, colouring: &colours, core }.fill(&request, &Context::default()).unwrap();
        Self { surface: surface.clone(), colours, triangles, complex }
    }

    /// `None` if the positions are those of a surface that meets itself (a torus twisted too much for its few quads).
    fn handlebody(surface: &QuadSurface, colours: Colouring, points: &[[f64; 3]]) -> Option<Self> {
        let triangles = triangles(surface, &colours);
        let request = TetRequest { n_vertices: surface.n_vertices(), triangles: &triangles, points: Some(points) };
        match HandlebodyTets.fill(&request, &Context::default()) {
            Ok(complex) => Some(Self { surface: surface.clone(), colours, triangles, complex }),
            Err(ConstructError::InteriorNeeded { reason, .. }) if reason.to_string().contains("meets itself") => None,
            Err(other) => panic!("{other}"),
        }
    }

    /// Per triangle its face, and per dart of the surface the edge of the tets below it.
    fn boundary(&self) -> (Vec<FaceId>, IdVec<Dart, EdgeId>) {
        let request = TetRequest { n_vertices: self.surface.n_vertices(), triangles: &self.triangles, points: None };
        let faces = self.complex.match_boundary(&request).unwrap();
        let all = self.complex.faces();
        let mut edge = IdVec::filled(EdgeId::NONE, 4 * self.surface.n_quads());
        for (t, &f) in faces.iter().enumerate() {
            let (corners, edges) = all[f];
            for k in 0..4 {
                let d = Dart::new(QuadId::new(t / 2), k);
                let (a, b) = (self.surface.origin(d), self.surface.target(d));
                if let Some(i) = (0..3).find(|&i| {
                    let rest = [corners[(i + 1) % 3], corners[(i + 2) % 3]];
                    rest == [a, b] || rest == [b, a]
                }) {
                    edge[d] = edges[i];
                }
            }
        }
        assert!(edge.iter().all(|e| e.is_some()));
        (faces, edge)
    }

    /// What Sigma has to be on the boundary: cut or not, per boundary edge of the tets.
    fn prescribed(&self) -> BTreeMap<EdgeId, bool> {
        let (faces, edge) = self.boundary();
        let mut wanted = BTreeMap::new();
        for d in self.surface.darts() {
            let black = |v: VertexId| !self.colours.white[v];
            wanted.insert(edge[d], black(self.surface.origin(d)) && black(self.surface.target(d)));
        }
        let all = self.complex.faces();
        for f in faces {
            for e in all[f].1 {
                wanted.entry(e).or_insert(false);
            }
        }
        wanted
    }

    fn is_solvable(&self) -> bool {
        let n = self.complex.n_edges;
        let empty = || vec![0u64; n / 64 + 1];
        let mut rows = Vec::new();
        for (_, edges) in self.complex.faces() {
            let mut row = empty();
            edges.iter().for_each(|e| set(&mut row, e.index()));
            rows.push(row);
        }
        for (e, cut) in self.prescribed() {
            let mut row = empty();
            set(&mut row, e.index());
            if cut {
                set(&mut row, n);
            }
            rows.push(row);
        }
        solvable(rows, n)
    }

    /// Whether a set of surface edges is the boundary of a set of triangles of the tets.
    fn bounds(&self, cycle: &[Edge]) -> bool {
        let (_, edge) = self.boundary();
        let inside: BTreeSet<Edge> = cycle.iter().copied().collect();
        let n = self.complex.n_faces;
        let mut rows = vec![vec![0u64; n / 64 + 1]; self.complex.n_edges];
        for (f, (_, edges)) in self.complex.faces().into_iter().enumerate() {
            edges.iter().for_each(|e| set(&mut rows[e.index()], f));
        }
        for d in self.surface.darts().filter(|&d| d < self.surface.twin(d)) {
            if inside.contains(&Edge::new(self.surface.origin(d), self.surface.target(d))) {
                set(&mut rows[edge[d].index()], n);
            }
        }
        solvable(rows, n)
    }

    /// Compares `sigma` with the oracle. Returns whether a Sigma exists.
    fn check(&self) -> bool {
        let solvable = self.is_solvable();
        let (_, edge) = self.boundary();
        match sigma(&self.surface, &self.colours, &self.complex, &edge) {
            Ok(cut) => {
                assert!(solvable, "Sigma found although there is none");
                for (_, edges) in self.complex.faces() {
                    assert_eq!(edges.iter().filter(|&&e| cut[e]).count() % 2, 0);
                }
                for (e, wanted) in self.prescribed() {
                    assert_eq!(cut[e], wanted);
                }
            }
            Err(ConstructError::NoMesh(Existence::OddCycleBounds { cycle })) => {
                assert!(!solvable, "Sigma refused although there is one");
                assert_eq!(cycle.len() % 2, 1);
                let all: BTreeSet<Edge> =
                    self.surface.darts().map(|d| Edge::new(self.surface.origin(d), self.surface.target(d))).collect();
                let mut degree: BTreeMap<_, usize> = BTreeMap::new();
                for e in &cycle {
                    assert!(all.contains(e));
                    *degree.entry(e.0).or_default() += 1;
                    *degree.entry(e.1).or_default() += 1;
                }
                assert!(degree.values().all(|d| d % 2 == 0));
                assert!(self.bounds(&cycle), "the certificate does not bound");
            }
            Err(other) => panic!("{other}"),
        }
        solvable
    }

    /// This solid and another: apart, or glued along the first quad of the other and the last of this one.
    fn with(&self, other: &Self, glue: bool) -> Self {
        let shift = self.complex.n_vertices as u32;
        // Vertices: surface vertices of both must come first, so everything is renumbered by first use.
        let last = self.surface.n_quads() - 1;
        let (a, b) = (self.surface.quad(QuadId::new(last)), other.surface.quad(QuadId::new(0)));
        let shifted = |v: VertexId| VertexId(v.0 + shift);
        let mut same: BTreeMap<VertexId, VertexId> = BTreeMap::new();
        let skip = usize::from(glue);
        if glue {
            // Facing each other: the order is turned round, the diagonals (corners 0 and 2) coincide.
            for (i, j) in [(0, 0), (1, 3), (2, 2), (3, 1)] {
                same.insert(shifted(b[i]), a[j]);
            }
        }
        let vertex = |v: VertexId| *same.get(&shifted(v)).unwrap_or(&shifted(v));
        let quads: Vec<[VertexId; 4]> = self.surface.quads()[..=last - skip]
            .iter()
            .copied()
            .chain(other.surface.quads()[skip..].iter().map(|q| q.map(vertex)))
            .collect();
        let mut number: BTreeMap<VertexId, VertexId> = BTreeMap::new();
        let mut name = |v: VertexId| {
            let next = VertexId::new(number.len());
            *number.entry(v).or_insert(next)
        };
        let quads: Vec<[u32; 4]> = quads.iter().map(|q| q.map(|v| name(v).0)).collect();
        let n_surface = quads.iter().flatten().max().map_or(0, |v| *v as usize + 1);
        let mut tets: Vec<[VertexId; 4]> = self.complex.tets.iter().map(|t| t.map(&mut name)).collect();
        tets.extend(other.complex.tets.iter().map(|t| t.map(|v| name(vertex(v)))));
        let surface = QuadSurface::try_new(n_surface, &quads).unwrap();
        // Edges and faces of the other solid, those of the glued quad identified by their vertices.
        let (mut edges, mut faces) = (BTreeMap::new(), BTreeMap::new());
        if glue {
            let (mine, _) = self.boundary();
            let (theirs, _) = other.boundary();
            let (f1, f2) = (self.complex.faces(), other.complex.faces());
            for t2 in theirs.iter().take(2) {
                for t1 in &mine[2 * last..] {
                    let (c1, e1) = f1[*t1];
                    let (c2, e2) = f2[*t2];
                    if sorted(c1) == sorted(c2.map(vertex)) {
                        faces.insert(*t2, *t1);
                        for i in 0..3 {
                            let j = (0..3).find(|&j| c1[j] == vertex(c2[i])).unwrap();
                            edges.insert(e2[i], e1[j]);
                        }
                    }
                }
            }
            assert_eq!((faces.len(), edges.len()), (2, 5));
        }
        let edge = |e: EdgeId| *edges.get(&e).unwrap_or(&EdgeId::new(e.index() + self.complex.n_edges));
        let face = |f: FaceId| *faces.get(&f).unwrap_or(&FaceId::new(f.index() + self.complex.n_faces));
        let mut complex = TetComplex {
            n_vertices: number.len(),
            tets: tets.into(),
            tet_edges: self.complex.tet_edges.clone(),
            tet_faces: self.complex.tet_faces.clone(),
            points: None,
            ..TetComplex::default()
        };
        complex.tet_edges.extend(other.complex.tet_edges.iter().map(|t| t.map(edge)));
        complex.tet_faces.extend(other.complex.tet_faces.iter().map(|t| t.map(face)));
        // Ids without gaps.
        fn dense<I: Ord + Copy>(all: impl Iterator<Item = I>, new: impl Fn(usize) -> I) -> BTreeMap<I, I> {
            let used: BTreeSet<I> = all.collect();
            used.into_iter().enumerate().map(|(i, e)| (e, new(i))).collect()
        }
        let edges = dense(complex.tet_edges.iter().flatten().copied(), EdgeId::new);
        let faces = dense(complex.tet_faces.iter().flatten().copied(), FaceId::new);
        complex.tet_edges.iter_mut().flatten().for_each(|e| *e = edges[e]);
        complex.tet_faces.iter_mut().flatten().for_each(|f| *f = faces[f]);
        complex.n_edges = edges.len();
        complex.n_faces = faces.len();
        let colours = all_black(&surface);
        let triangles = triangles(&surface, &colours);
        Self { surface, colours, triangles, complex }
    }
}

/// Positions of `torus(n, m, shift)`: index `i` runs round the tube or round the axis.
fn torus_points(n: u32, m: u32, shift: u32, i_is_tube: bool) -> Vec<[f64; 3]> {
    let turn = std::f64::consts::TAU;
    let (nf, mf) = (f64::from(n), f64::from(m));
    (0..m)
        .flat_map(|j| (0..n).map(move |i| (f64::from(i), f64::from(j))))
        .map(|(i, j)| {
            // Row m is row 0 moved by the shift.
            let a = turn * (i + f64::from(shift) * j / mf) / nf;
            let b = turn * j / mf;
            let (tube, axis) = if i_is_tube { (a, b) } else { (b, a) };
            let r = 3.0 + tube.cos();
            [r * axis.cos(), r * axis.sin(), tube.sin()]
        })
        .collect()
}

fn outward(surface: QuadSurface, points: &[[f64; 3]]) -> QuadSurface {
    let mut volume = 0.0;
    for q in surface.quads() {
        let p = q.map(|v| points[v.index()]);
        for [a, b, c] in [[p[0], p[1], p[2]], [p[0], p[2], p[3]]] {
            volume += a[0] * (b[1] * c[2] - b[2] * c[1])
                + a[1] * (b[2] * c[0] - b[0] * c[2])
                + a[2] * (b[0] * c[1] - b[1] * c[0]);
        }
    }
    if volume > 0.0 { surface } else { surface.inverted() }
}

fn torus_solid(n: u32, m: u32, shift: u32, i_is_tube: bool, black: bool) -> Option<Solid> {
    let points = torus_points(n, m, shift, i_is_tube);
    let surface = outward(torus(n, m, shift).unwrap(), &points);
    let colours = if black { all_black(&surface) } else { colouring(&surface, false) };
    Solid::handlebody(&surface, colours, &points)
}

#[test]
fn tori_straight_and_twisted() {
    let (mut yes, mut no, mut twisted) = (0, 0, 0);
    for n in 3..=6 {
        for m in 3..=7 {
            for shift in 0..=n / 2 {
                for i_is_tube in [true, false] {
                    // Where quads share too much, the triangles below would as well: refused long before Sigma.
                    if !i_is_tube && shift > 0 || !is_proper(&torus(n, m, shift).unwrap()) {
                        continue;
                    }
                    for black in [true, false] {
                        let Some(solid) = torus_solid(n, m, shift, i_is_tube, black) else {
                            assert!(shift > 0);
                            continue;
                        };
                        twisted += usize::from(shift > 0);
                        let exists = solid.check();
                        assert_eq!(exists, (if i_is_tube { n } else { m }) % 2 == 0, "{n} {m} {shift} {i_is_tube}");
                        if exists { yes += 1 } else { no += 1 }
                    }
                }
            }
        }
    }
    println!("tori: {yes} with Sigma, {no} without, {twisted} of them twisted");
    assert!(yes > 60 && no > 60 && twisted > 20, "{yes} {no} {twisted}");
}

#[test]
fn balls() {
    for i in 0..12u64 {
        let surface = random_sphere(8 + 2 * (i as usize % 9), i).unwrap();
        for colours in [all_black(&surface), colouring(&surface, false)] {
            for core in [BallCore::Centred, BallCore::Fewest] {
                let solid = Solid::ball(&surface, colours.clone(), core);
                assert!(solid.check());
            }
        }
    }
}

/// The boundary of the filled cells of a grid, with positions.
fn voxels(size: [usize; 3], filled: impl Fn([usize; 3]) -> bool) -> (QuadSurface, Vec<[f64; 3]>) {
    let (surface, points) = hexfill_mesh::generate::voxels(size, filled).unwrap();
    (surface, points.into_iter().map(|p| p.map(f64::from)).collect())
}

/// A box with single cells taken out: a ball with cavities.
fn hollow(holes: &[[usize; 3]]) -> Solid {
    let (surface, points) = voxels([3, 3, 5], |p| !holes.contains(&p));
    assert_eq!(surface.n_components(), holes.len() + 1);
    let colours = all_black(&surface);
    Solid::handlebody(&surface, colours, &points).unwrap()
}

#[test]
fn plates_with_holes_and_balls_with_cavities() {
    for genus in 1..=3 {
        let (surface, points) = voxels([2 * genus + 1, 3, 1], |p| !(p[0] % 2 == 1 && p[1] == 1));
        assert_eq!(surface.genus(), genus as u64);
        assert!(Solid::handlebody(&surface, all_black(&surface), &points).unwrap().check());
    }
    assert!(hollow(&[[1, 1, 1]]).check());
    assert!(hollow(&[[1, 1, 1], [1, 1, 3]]).check());
}

#[test]
fn sums_of_solids_with_genus_cavities_and_components() {
    let mut random = Random::new(7);
    let (mut yes, mut no) = (0, 0);
    let tori: Vec<(Solid, bool)> = [(3, 4), (4, 3), (4, 4), (5, 4), (4, 5), (3, 3), (5, 3), (3, 5)]
        .into_iter()
        .flat_map(|(n, m)| [(n, m, true), (n, m, false)])
        .map(|(n, m, i_is_tube)| {
            (torus_solid(n, m, 0, i_is_tube, true).unwrap(), (if i_is_tube { n } else { m }) % 2 == 0)
        })
        .collect();
    let shells = [hollow(&[[1, 1, 1]]), hollow(&[[1, 1, 1], [1, 1, 3]])];
    for _ in 0..60 {
        let first = random.below(tori.len());
        let (mut solid, mut exists) = tori[first].clone();
        for _ in 0..random.below(4) {
            let glue = random.below(3) > 0;
            let (next, good) = match random.below(10) {
                0..=7 => {
                    let (t, good) = &tori[random.below(tori.len())];
                    (t, *good)
                }
                k => (&shells[k - 8], true),
            };
            solid = solid.with(next, glue);
            exists &= good;
        }
        assert_eq!(solid.check(), exists);
        if exists { yes += 1 } else { no += 1 }
    }
    println!("sums: {yes} with Sigma, {no} without");
    assert!(yes > 10 && no > 10, "{yes} {no}");
}
