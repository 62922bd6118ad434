//! Step 6: Sigma, the dual surface, as the set of edges of the tetrahedra that it cuts.
//!
//! On the boundary the black-black edges are cut; inside, every triangle must have 0 or 2 cut edges (a Z/2-cocycle).
//! A cocycle of the tets is a class of H^1(T; Z/2) up to flipping vertices, so: number the edges by
//! their class (zero on a breadth-first tree, then through every triangle with one unknown edge; a free symbol if
//! stuck), and look for a class that agrees with the boundary up to flips of the boundary's vertices. Each quad-surface
//! edge off a spanning tree gives one equation in the few symbols. All passes are linear; the system is tiny.
//! If it has no solution, the equations that clash name a cycle of odd length that bounds in T: no hex mesh exists
//! (Thurston 1993, Mitchell 1996, Erickson 2014), and the cycle is returned as the certificate.

use crate::colouring::Colouring;
use crate::error::ConstructError;
use crate::tets::{TET_EDGES, TetComplex, find, others, tet_edge};
use hexfill_mesh::{Dart, Edge, Offenders, QuadSurface, VertexId};
use std::collections::BTreeSet;

/// A linear form in the symbols: one bit each, and bit 0 for the constant 1.
type Form = Vec<u64>;

/// The set of cut edges, per edge of the complex.
///
/// `surface_edge[d]` is the edge of the complex under dart `d`.
///
/// # Errors
/// [`ConstructError::OddCycleBounds`] with the certificate.
pub fn sigma(
    surface: &QuadSurface,
    colouring: &Colouring,
    complex: &TetComplex,
    surface_edge: &[u32],
) -> Result<Vec<bool>, ConstructError> {
    if colouring.n_cut_edges == 0 {
        return Ok(vec![false; complex.n_edges]);
    }
    let classes = edge_classes(complex);
    let cut = |d: Dart| !colouring.white[surface.origin(d).index()] && !colouring.white[surface.target(d).index()];
    // Potentials of the boundary's vertices along a breadth-first forest of the surface.
    let first = surface.dart_of_vertices();
    let width = classes.width;
    let mut potential: Vec<Option<Form>> = vec![None; surface.n_vertices()];
    let mut parent: Vec<Option<Dart>> = vec![None; surface.n_vertices()];
    let form = |d: Dart| {
        let mut f = classes.of(surface_edge[d.index()]).to_vec();
        f[0] ^= u64::from(cut(d));
        f
    };
    for (v, root) in first.iter().enumerate() {
        if root.is_none() || potential[v].is_some() {
            continue;
        }
        potential[v] = Some(vec![0; width]);
        let mut queue = std::collections::VecDeque::from([v]);
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
    let zero = vec![0; width];
    let at = |v: VertexId| potential[v.index()].as_deref().unwrap_or(&zero);
    let mut system = System::default();
    for relation in &classes.relations {
        // A relation has no constant, so it cannot clash.
        let _ = system.add(relation.clone(), None);
    }
    let mut seen: BTreeSet<Form> = BTreeSet::new();
    for d in surface.darts().filter(|&d| d < surface.twin(d)) {
        let equation = sum(&sum(at(surface.origin(d)), at(surface.target(d))), &form(d));
        let new = equation.iter().any(|&w| w != 0) && seen.insert(equation.clone());
        if new && let Err(sources) = system.add(equation, Some(d)) {
            return Err(odd_cycle(surface, &parent, &sources));
        }
    }
    let solution = system.solve(width);
    let value = |f: &[u64]| f.iter().zip(&solution).fold(0, |s, (a, b)| s ^ (a & b).count_ones()) & 1 == 1;
    // Flips: on the boundary they are forced, inside they are free.
    let mut flipped: Vec<bool> = (0..complex.n_vertices)
        .map(|v| v < surface.n_vertices() && potential[v].as_deref().is_some_and(value))
        .collect();
    let ends = edge_ends(complex);
    let mut cut: Vec<bool> = (0..complex.n_edges)
        .map(|e| value(classes.of(e as u32)) ^ flipped[ends[e][0] as usize] ^ flipped[ends[e][1] as usize])
        .collect();
    fewer_cuts(surface, complex, &ends, &mut flipped, &mut cut);
    Ok(cut)
}

/// Flips inner vertices while that makes fewer hexes.
fn fewer_cuts(surface: &QuadSurface, complex: &TetComplex, ends: &[[u32; 2]], flipped: &mut [bool], cut: &mut [bool]) {
    let mut weight = vec![0i64; complex.n_edges];
    for e in complex.tet_edges.iter().flatten() {
        weight[*e as usize] += 1;
    }
    let inner = |v: u32| v as usize >= surface.n_vertices();
    let mut start = vec![0u32; complex.n_vertices + 1];
    for v in ends.iter().flatten() {
        start[*v as usize + 1] += 1;
    }
    for v in 0..complex.n_vertices {
        start[v + 1] += start[v];
    }
    let mut slot = start.clone();
    let mut star = vec![0u32; 2 * ends.len()];
    for (e, pair) in ends.iter().enumerate() {
        for v in pair {
            star[slot[*v as usize] as usize] = e as u32;
            slot[*v as usize] += 1;
        }
    }
    for _ in 0..20 {
        let mut moved = false;
        for v in (0..complex.n_vertices as u32).filter(|&v| inner(v)) {
            let round = &star[start[v as usize] as usize..start[v as usize + 1] as usize];
            let balance: i64 =
                round.iter().map(|&e| if cut[e as usize] { weight[e as usize] } else { -weight[e as usize] }).sum();
            if balance > 0 {
                flipped[v as usize] = !flipped[v as usize];
                for &e in round {
                    cut[e as usize] = !cut[e as usize];
                }
                moved = true;
            }
        }
        if !moved {
            break;
        }
    }
}

fn sum(a: &[u64], b: &[u64]) -> Form {
    a.iter().zip(b).map(|(x, y)| x ^ y).collect()
}

fn edge_ends(complex: &TetComplex) -> Vec<[u32; 2]> {
    let mut ends = vec![[0; 2]; complex.n_edges];
    for (t, tet) in complex.tets.iter().enumerate() {
        for (k, &[i, j]) in TET_EDGES.iter().enumerate() {
            ends[complex.tet_edges[t][k] as usize] = [tet[i], tet[j]];
        }
    }
    ends
}

/// A cocycle with symbols: per edge a form; `relations` must vanish.
struct Classes {
    width: usize,
    forms: Vec<u64>,
    relations: Vec<Form>,
}

impl Classes {
    fn of(&self, e: u32) -> &[u64] {
        &self.forms[self.width * e as usize..self.width * (e as usize + 1)]
    }
}

/// H^1(T; Z/2) with symbols: zero on a spanning forest, propagated through the triangles.
fn edge_classes(complex: &TetComplex) -> Classes {
    let mut width = 1;
    loop {
        if let Some(classes) = propagate(complex, width) {
            return classes;
        }
        width *= 2;
    }
}

/// As [`edge_classes`], or nothing if more than `64 width - 1` symbols are needed.
fn propagate(complex: &TetComplex, width: usize) -> Option<Classes> {
    let mut triangles = vec![[0u32; 3]; complex.n_faces];
    for (t, faces) in complex.tet_faces.iter().enumerate() {
        for (i, &f) in faces.iter().enumerate() {
            let [a, b, c] = others(i);
            triangles[f as usize] = [tet_edge(b, c), tet_edge(a, c), tet_edge(a, b)].map(|e| complex.tet_edges[t][e]);
        }
    }
    let mut start = vec![0u32; complex.n_edges + 1];
    for e in triangles.iter().flatten() {
        start[*e as usize + 1] += 1;
    }
    for e in 0..complex.n_edges {
        start[e + 1] += start[e];
    }
    let mut slot = start.clone();
    let mut faces_of = vec![0u32; 3 * triangles.len()];
    for (f, edges) in triangles.iter().enumerate() {
        for e in edges {
            faces_of[slot[*e as usize] as usize] = f as u32;
            slot[*e as usize] += 1;
        }
    }
    let mut classes = Classes { width, forms: vec![0; width * complex.n_edges], relations: Vec::new() };
    let mut known = vec![false; complex.n_edges];
    let mut queue: Vec<u32> = Vec::new();
    // Spanning forest by union-find over the edges, ascending.
    let ends = edge_ends(complex);
    let mut root: Vec<u32> = (0..complex.n_vertices as u32).collect();
    for (e, &[a, b]) in ends.iter().enumerate() {
        let (a, b) = (find(&mut root, a), find(&mut root, b));
        if a != b {
            root[a.max(b) as usize] = a.min(b);
            known[e] = true;
            queue.push(e as u32);
        }
    }
    let mut unknown: Vec<u8> = vec![3; triangles.len()];
    let mut n_symbols = 0;
    let mut next = 0;
    loop {
        while let Some(e) = queue.pop() {
            for k in start[e as usize]..start[e as usize + 1] {
                let f = faces_of[k as usize] as usize;
                unknown[f] -= 1;
                match unknown[f] {
                    1 => {
                        let edges = triangles[f];
                        let Some(&open) = edges.iter().find(|&&e| !known[e as usize]) else { continue };
                        for w in 0..width {
                            let s = edges
                                .iter()
                                .filter(|&&e| e != open)
                                .fold(0, |s, &e| s ^ classes.forms[width * e as usize + w]);
                            classes.forms[width * open as usize + w] = s;
                        }
                        known[open as usize] = true;
                        queue.push(open);
                    }
                    0 => {
                        let [a, b, c] = triangles[f];
                        let relation = sum(&sum(classes.of(a), classes.of(b)), classes.of(c));
                        if relation.iter().any(|&w| w != 0) {
                            classes.relations.push(relation);
                        }
                    }
                    _ => {}
                }
            }
        }
        let Some(e) = (next..known.len()).find(|&e| !known[e]) else { break };
        next = e;
        n_symbols += 1;
        if n_symbols >= 64 * width {
            return None;
        }
        // Symbol k is bit k; bit 0 of the form is the constant.
        classes.forms[width * e + n_symbols / 64] |= 1 << (n_symbols % 64);
        known[e] = true;
        queue.push(e as u32);
    }
    classes.relations.sort_unstable();
    classes.relations.dedup();
    Some(classes)
}

/// Linear equations `form = 0` in echelon form, each with the surface edges it came from.
#[derive(Default)]
struct System {
    rows: Vec<(usize, Form, BTreeSet<Dart>)>,
}

impl System {
    /// Adds an equation.
    ///
    /// # Errors
    /// If it says 1 = 0: the surface edges whose equations add up to that.
    fn add(&mut self, mut form: Form, source: Option<Dart>) -> Result<(), BTreeSet<Dart>> {
        let mut sources: BTreeSet<Dart> = source.into_iter().collect();
        for (pivot, row, from) in &self.rows {
            if form[pivot / 64] >> (pivot % 64) & 1 == 1 {
                form = sum(&form, row);
                sources = sources.symmetric_difference(from).copied().collect();
            }
        }
        let pivot = (1..64 * form.len()).find(|&k| form[k / 64] >> (k % 64) & 1 == 1);
        match pivot {
            Some(pivot) => {
                self.rows.push((pivot, form, sources));
                Ok(())
            }
            None if form[0] & 1 == 1 => Err(sources),
            None => Ok(()),
        }
    }

    /// Values of the symbols (free ones 0) as a mask whose bit 0 is the constant 1.
    fn solve(&self, width: usize) -> Form {
        let mut value = vec![0; width];
        value[0] = 1;
        // A row was reduced by the earlier ones only, so the later pivots are known first.
        for (pivot, row, _) in self.rows.iter().rev() {
            let others = row.iter().zip(&value).fold(0, |s, (a, b)| s ^ (a & b).count_ones()) & 1;
            if others == 1 {
                value[pivot / 64] |= 1 << (pivot % 64);
            }
        }
        value
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
    for &d in sources {
        toggle(d);
        for mut v in [surface.origin(d), surface.target(d)] {
            while let Some(e) = parent[v.index()] {
                toggle(e);
                v = surface.origin(e);
            }
        }
    }
    let cycle: Vec<Edge> = cycle.into_iter().collect();
    let edges: Offenders<Edge> = cycle.iter().copied().collect();
    ConstructError::OddCycleBounds { edges, cycle }
}
