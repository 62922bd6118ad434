//! The spheres that are left are coned, one a solid, the fans glued and the prisms filled: a complex of tetrahedra.
//!
//! Edges and faces get names: those of the sphere's edges (merged where fans are glued) and spokes from the apex to every copy;
//! the sphere's triangles and walls from the apex over every edge. So an apex may have several edges to one vertex.
//!
//! Source: Eppstein 1999 (the cone); gluing the fans again is ours.

use super::cutting::Cutting;
use super::prism::{PRISM_TETS, Prism, SIDES};
use crate::core::complex::{TET_EDGES, TetComplex, others, sorted, tet_edge};
use crate::ids::{EdgeId, FaceId};
use crate::surface::polygons::{DartId, GonId};
use hexfill_geometry::Vector;
use hexfill_mesh::{Forest, IdVec, VertexId};

/// Cones the spheres that are left. `solid_of[t]` is the solid of
/// triangle `t`; the last `n_solids` points are the apexes.
pub(super) fn cone(cutting: &Cutting, solid_of: &[usize], n_solids: usize, points: Vec<Vector>) -> TetComplex {
    let s = &cutting.s;
    let first_apex = points.len() - n_solids;
    let solid = spread(cutting, solid_of);
    let names = Names::new(cutting);
    let mut complex = TetComplex {
        n_vertices: points.len(),
        n_edges: names.n_edges,
        n_faces: names.n_faces,
        points: Some(points),
        ..TetComplex::default()
    };
    for g in solid.ids() {
        let darts = [0, 1, 2].map(|k| s.side(g, k));
        let copies = darts.map(|d| s.origin[d]);
        let [a, b, c] = copies.map(|v| cutting.vertex[v]);
        complex.tets.push([VertexId::new(first_apex + solid[g]), a, b, c]);
        let mut edges = [EdgeId::NONE; 6];
        for k in 0..3 {
            edges[tet_edge(0, k + 1)] = names.spoke[copies[k]];
            edges[tet_edge(k + 1, (k + 1) % 3 + 1)] = names.edge[darts[k]];
        }
        complex.tet_edges.push(edges);
        // Opposite the apex, then opposite corners 0, 1, 2: the walls over sides 1, 2, 0.
        let [x, y, z] = darts.map(|d| names.wall[d]);
        complex.tet_faces.push([names.face[g], y, z, x]);
    }
    for prism in &cutting.prisms {
        fill_prism(prism, &names, &mut complex);
    }
    complex
}

/// Per triangle of the surface as it is now its solid.
fn spread(cutting: &Cutting, solid_of: &[usize]) -> IdVec<GonId, usize> {
    let s = &cutting.s;
    let mut solid = IdVec::filled(usize::MAX, s.n_gons());
    for (t, &k) in solid_of.iter().enumerate() {
        let mut stack = vec![GonId::new(t)];
        while let Some(g) = stack.pop() {
            if solid[g] == usize::MAX {
                solid[g] = k;
                stack.extend(s.sides(g).map(|d| s.gon(s.twin[d])));
            }
        }
    }
    solid
}

/// The names of edges and faces. See the module page.
struct Names {
    edge: IdVec<DartId, EdgeId>,
    spoke: IdVec<VertexId, EdgeId>,
    n_edges: usize,
    face: IdVec<GonId, FaceId>,
    wall: IdVec<DartId, FaceId>,
    n_faces: usize,
}

impl Names {
    fn new(cutting: &Cutting) -> Self {
        let s = &cutting.s;
        // Edges by smaller dart, merged where fans are glued: side 0 with side 0, the others crosswise.
        // Names, not vertex pairs: an apex may have several edges to one vertex, so an edge is not told by its ends.
        let mut same_edge: Forest<DartId> = Forest::new(s.len());
        for d in s.ids() {
            same_edge.union(d, s.twin[d]);
        }
        // The two copies of a fan triangle are one face of the solid: cutting along the disk is undone, and the genus
        // is back.
        let mut same_face: IdVec<GonId, GonId> = (0..s.n_gons()).map(GonId::new).collect();
        for &[l, r] in &cutting.glued {
            same_face[r] = l;
            for (x, y) in [(0, 0), (1, 2), (2, 1)] {
                same_edge.union(s.side(l, x), s.side(r, y));
            }
        }
        let (mut n_edges, mut n_faces) = (0, 0);
        let mut edge = IdVec::filled(EdgeId::NONE, s.len());
        let name = same_edge.names();
        for d in s.ids() {
            if name[d] == d {
                edge[d] = take(&mut n_edges, EdgeId::new);
            }
        }
        let edge = name.iter().map(|&d| edge[d]).collect();
        let mut face = IdVec::filled(FaceId::NONE, s.n_gons());
        for &g in &same_face {
            if face[g].is_none() {
                face[g] = take(&mut n_faces, FaceId::new);
            }
        }
        let face = same_face.iter().map(|&g| face[g]).collect();
        // Walls and spokes belong to the one cone, of which no part is glued: each copy has its own.
        let mut wall = IdVec::filled(FaceId::NONE, s.len());
        for d in s.ids().filter(|&d| d < s.twin[d]) {
            let name = take(&mut n_faces, FaceId::new);
            wall[d] = name;
            wall[s.twin[d]] = name;
        }
        let mut spoke = IdVec::filled(EdgeId::NONE, s.n_vertices);
        for &v in &s.origin {
            if spoke[v].is_none() {
                spoke[v] = take(&mut n_edges, EdgeId::new);
            }
        }
        Self { edge, spoke, n_edges, face, wall, n_faces }
    }
}

fn take<I>(n: &mut usize, id: impl Fn(usize) -> I) -> I {
    *n += 1;
    id(*n - 1)
}

/// Three tets; their edges are the sides', their faces the sides, both ends and two between them.
fn fill_prism(prism: &Prism, names: &Names, complex: &mut TetComplex) {
    let mut inner: Vec<[usize; 3]> = Vec::new();
    for tet in PRISM_TETS {
        complex.tets.push(tet.map(|c| prism.vertices[c]));
        complex.tet_edges.push(TET_EDGES.map(|[i, j]| {
            let (i, j) = (tet[i], tet[j]);
            let side = SIDES.iter().position(|t| t.contains(&i) && t.contains(&j)).unwrap_or(0);
            let k = (0..3).find(|&k| [SIDES[side][k], SIDES[side][(k + 1) % 3]].iter().all(|c| [i, j].contains(c)));
            names.edge[DartId(3 * prism.sides[side].0 + k.unwrap_or(0) as u32)]
        }));
        complex.tet_faces.push([0, 1, 2, 3].map(|opposite| {
            let corners = sorted(others(opposite).map(|k| tet[k]));
            if let Some(side) = SIDES.iter().position(|t| t.iter().all(|c| corners.contains(c))) {
                return names.face[prism.sides[side]];
            }
            let k = inner.iter().position(|t| *t == corners).unwrap_or_else(|| {
                inner.push(corners);
                inner.len() - 1
            });
            FaceId::new(complex.n_faces + k)
        }));
    }
    complex.n_faces += inner.len();
}
