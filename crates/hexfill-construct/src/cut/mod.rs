//! Step 4: Sigma, the dual surface, as the set of edges of the tetrahedra that it cuts.
//!
//! On the boundary the black-black edges are cut; inside, every triangle must have 0 or 2 cut edges (a Z/2-cocycle).
//! A cocycle of the tets is a class of H^1(T; Z/2) up to flipping vertices, so: number the edges by
//! their class (zero on a breadth-first tree, then through every triangle with one unknown edge; a free symbol if
//! stuck), and look for a class that agrees with the boundary up to flips of the boundary's vertices. Each quad-surface
//! edge off a spanning tree gives one equation in the few symbols. All passes are linear; the system is tiny.
//! If it has no solution, the equations that clash name a cycle of odd length that bounds in T: no hex mesh exists
//! (Thurston 1993, Mitchell 1996, Erickson 2014), and the cycle is returned as the certificate.
//!
//! Source: Erickson 2014, section 4 (the theorem) and section 5 (Sigma as what the hexes are dual to); the small system in place of an elimination over
//! all edges is ours.

mod classes;
#[cfg(test)]
mod oracle;
mod system;

use crate::core::Inside;
use crate::core::complex::{TetComplex, others, tet_edge};
use crate::error::ConstructError;
use crate::ids::EdgeId;
use crate::layer::Layer;
use crate::plan::colouring::Colouring;
use crate::plan::{Plan, stage};
use crate::surface::existence::Existence;
use classes::{Classes, edge_classes};
use hexfill_mesh::{Buckets, Context, Dart, Edge, IdVec, QuadId, QuadSurface, VertexId};
use std::collections::{BTreeSet, VecDeque};
use system::{Form, System, sum};

/// The set of edges of the core that Sigma crosses.
pub(crate) type Sigma = IdVec<EdgeId, bool>;

/// Extends Sigma from the surface to the core.
///
/// # Errors
/// [`ConstructError::NoMesh`] with the certificate; [`ConstructError::Stopped`].
pub(crate) fn cut(
    plan: &Plan<'_>,
    inside: &Inside,
    layer: &Layer<'_>,
    ctx: &Context<'_>,
) -> Result<Sigma, ConstructError> {
    stage("sigma", ctx)?;
    sigma(plan.surface, &plan.colours, &inside.complex, &surface_edges(plan.surface, inside, layer))
}

/// Per dart: the edge of the complex under it.
fn surface_edges(surface: &QuadSurface, inside: &Inside, layer: &Layer<'_>) -> IdVec<Dart, EdgeId> {
    let complex = &inside.complex;
    let mut triangle_of = IdVec::filled(None, complex.n_faces);
    for (t, &f) in inside.boundary.iter().enumerate() {
        triangle_of[f] = Some(t);
    }
    let mut edges = IdVec::filled(EdgeId(0), 4 * surface.n_quads());
    for (t, tet) in complex.tets.enumerate() {
        for i in 0..4 {
            let Some(triangle) = triangle_of[complex.tet_faces[t][i]] else { continue };
            let (q, half) = (QuadId::new(triangle / 2), (triangle % 2) as u8);
            for side in [2 * half, 2 * half + 1] {
                let d = layer.dart(q, side);
                let local = |v: VertexId| others(i).into_iter().find(|&j| tet[j] == v);
                if let (Some(a), Some(b)) = (local(surface.origin(d)), local(surface.target(d))) {
                    edges[d] = complex.tet_edges[t][tet_edge(a, b)];
                }
            }
        }
    }
    edges
}

/// The set of cut edges. `surface_edge[d]` is the edge of the complex under dart `d`.
///
/// # Errors
/// [`ConstructError::NoMesh`] with the certificate.
fn sigma(
    surface: &QuadSurface,
    colouring: &Colouring,
    complex: &TetComplex,
    surface_edge: &IdVec<Dart, EdgeId>,
) -> Result<Sigma, ConstructError> {
    if colouring.n_cut_edges == 0 {
        // The zero cocycle agrees with a bipartite surface, and it splits every tet in 4, the fewest there are.
        return Ok(IdVec::filled(false, complex.n_edges));
    }
    let ends = complex.edge_ends();
    let classes = edge_classes(complex, &ends);
    // What an edge of the surface adds to its class: 1 if it is to be cut.
    let is_black = |v: VertexId| !colouring.white[v];
    let form = |d: Dart| {
        let mut f = classes.of(surface_edge[d]).to_vec();
        f[0] ^= u64::from(is_black(surface.origin(d)) && is_black(surface.target(d)));
        f
    };
    let tree = potentials(surface, classes.width, &form);
    // A clash is no failure of the method: the edges whose equations add up to 1 = 0 form a cycle of odd length that
    // bounds inside, and no hex mesh exists (Erickson 2014, section 4).
    let solution = match agreement(surface, &classes, &tree, &form) {
        Ok(system) => system.solve(classes.width),
        Err(sources) => return Err(odd_cycle(surface, &tree.parent, &sources)),
    };
    let value = |f: &[u64]| f.iter().zip(&solution).fold(0, |s, (a, b)| s ^ (a & b).count_ones()) & 1 == 1;
    // Flips: on the boundary they are forced, inside they are free.
    let mut flipped: IdVec<VertexId, bool> = (0..complex.n_vertices)
        .map(|v| v < surface.n_vertices() && tree.potential[v].as_deref().is_some_and(value))
        .collect();
    let mut cut: Sigma = ends.enumerate().map(|(e, &[a, b])| value(classes.of(e)) ^ flipped[a] ^ flipped[b]).collect();
    fewer_cuts(surface, complex, &ends, &mut flipped, &mut cut);
    Ok(cut)
}

/// A breadth-first forest of the surface's vertices, and what they have to be flipped by along it.
struct Potentials {
    /// Per vertex, unless nothing uses it.
    potential: Vec<Option<Form>>,
    /// Per vertex: the dart that leads to it, but for roots.
    parent: Vec<Option<Dart>>,
}

/// Potentials whose differences are the forms, along the edges of the forest.
fn potentials(surface: &QuadSurface, width: usize, form: &impl Fn(Dart) -> Form) -> Potentials {
    let first = surface.dart_of_vertices();
    let mut potential: Vec<Option<Form>> = vec![None; surface.n_vertices()];
    let mut parent: Vec<Option<Dart>> = vec![None; surface.n_vertices()];
    for (v, root) in first.iter().enumerate() {
        if root.is_none() || potential[v].is_some() {
            continue;
        }
        potential[v] = Some(vec![0; width]);
        let mut queue = VecDeque::from([v]);
        while let Some(v) = queue.pop_front() {
            let Some(d) = first[v] else { continue };
            for e in surface.round_vertex(d) {
                let w = surface.target(e).index();
                if potential[w].is_none() {
                    potential[w] = Some(sum(potential[v].as_deref().unwrap_or(&[]), &form(e)));
                    parent[w] = Some(e);
                    queue.push_back(w);
                }
            }
        }
    }
    Potentials { potential, parent }
}

/// The equations that make a class agree with the surface: relations of the classes, and every edge of the surface off the forest.
///
/// # Errors
/// The edges of the surface whose equations add up to 1 = 0.
fn agreement(
    surface: &QuadSurface,
    classes: &Classes,
    tree: &Potentials,
    form: &impl Fn(Dart) -> Form,
) -> Result<System, BTreeSet<Dart>> {
    let zero = vec![0; classes.width];
    let at = |v: VertexId| tree.potential[v.index()].as_deref().unwrap_or(&zero);
    let mut system = System::default();
    for relation in &classes.relations {
        // A relation has no constant, so it cannot clash.
        let _ = system.add(relation.clone(), None);
    }
    let mut seen: BTreeSet<Form> = BTreeSet::new();
    for d in surface.darts().filter(|&d| d < surface.twin(d)) {
        let equation = sum(&sum(at(surface.origin(d)), at(surface.target(d))), &form(d));
        // A surface has many edges and few different equations; those seen before would be reduced to nothing, at the
        // cost of an elimination each.
        if equation.iter().any(|&w| w != 0) && seen.insert(equation.clone()) {
            system.add(equation, Some(d))?;
        }
    }
    Ok(system)
}

/// Flips inner vertices while that makes fewer hexes: a tet has one more for each of its edges that is cut.
fn fewer_cuts(
    surface: &QuadSurface,
    complex: &TetComplex,
    ends: &IdVec<EdgeId, [VertexId; 2]>,
    flipped: &mut IdVec<VertexId, bool>,
    cut: &mut Sigma,
) {
    let mut weight: IdVec<EdgeId, i64> = IdVec::filled(0, complex.n_edges);
    for &e in complex.tet_edges.iter().flatten() {
        weight[e] += 1;
    }
    let star = Buckets::new(complex.n_vertices, ends.enumerate().flat_map(|(e, pair)| pair.map(|v| (v, e))));
    for _ in 0..20 {
        let mut moved = false;
        for v in flipped.ids().skip(surface.n_vertices()) {
            // To flip a vertex is to add a coboundary: the class stays, so Sigma remains a solution. Every flip taken
            // saves hexes, so this ends; a least cut of the whole graph would save more and take more than linear
            // time.
            let balance: i64 = star[v].iter().map(|&e| if cut[e] { weight[e] } else { -weight[e] }).sum();
            if balance > 0 {
                flipped[v] = !flipped[v];
                for &e in &star[v] {
                    cut[e] = !cut[e];
                }
                moved = true;
            }
        }
        if !moved {
            break;
        }
    }
}

/// The sum of the fundamental cycles of some edges, which is odd and bounds.
fn odd_cycle(surface: &QuadSurface, parent: &[Option<Dart>], sources: &BTreeSet<Dart>) -> ConstructError {
    let mut cycle: BTreeSet<Edge> = BTreeSet::new();
    let mut toggle = |d: Dart| {
        let edge = Edge::new(surface.origin(d), surface.target(d));
        if !cycle.remove(&edge) {
            cycle.insert(edge);
        }
    };
    // Over Z/2: what two fundamental cycles share drops out, and an even number of edges is left at every vertex.
    for &d in sources {
        toggle(d);
        for mut v in [surface.origin(d), surface.target(d)] {
            while let Some(e) = parent[v.index()] {
                toggle(e);
                v = surface.origin(e);
            }
        }
    }
    ConstructError::NoMesh(Existence::OddCycleBounds { cycle: cycle.into_iter().collect() })
}
