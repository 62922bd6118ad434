//! The first cohomology of the tetrahedra modulo 2, with a symbol for every generator.
//!
//! Zero on a spanning forest (a gauge: every cocycle is so up to flipping vertices), then through every triangle with one unknown
//! edge; where that is stuck an edge becomes a free symbol. Every triangle whose edges are all known gives a relation, which is
//! mostly void.
//!
//! Source: Erickson 2014, section 4, says what must hold; the gauge and the symbols that make it linear are ours.

use super::system::{Form, sum};
use crate::core::complex::{TetComplex, others, tet_edge};
use crate::ids::{EdgeId, FaceId};
use hexfill_mesh::{Buckets, Forest, IdVec, VertexId};

/// A cocycle with symbols: per edge a form; `relations` must vanish.
pub(super) struct Classes {
    /// Words of a form.
    pub(super) width: usize,
    forms: Vec<u64>,
    pub(super) relations: Vec<Form>,
}

impl Classes {
    /// The form of an edge.
    pub(super) fn of(&self, e: EdgeId) -> &[u64] {
        &self.forms[self.width * e.index()..self.width * (e.index() + 1)]
    }
}

/// H^1(T; Z/2) with symbols: zero on a spanning forest, propagated through the triangles.
pub(super) fn edge_classes(complex: &TetComplex, ends: &IdVec<EdgeId, [VertexId; 2]>) -> Classes {
    let triangles = triangles(complex);
    let faces_of = Buckets::new(complex.n_edges, triangles.enumerate().flat_map(|(f, edges)| edges.map(|e| (e, f))));
    let mut width = 1;
    loop {
        let mut spread = Spread {
            triangles: &triangles,
            faces_of: &faces_of,
            classes: Classes { width, forms: vec![0; width * complex.n_edges], relations: Vec::new() },
            known: IdVec::filled(false, complex.n_edges),
            unknown: IdVec::filled(3, triangles.len()),
            queue: Vec::new(),
        };
        if spread.run(ends, complex.n_vertices).is_some() {
            return spread.classes;
        }
        // Symbols are as many as H^1 has generators, a word or two; a form of fixed width is one slice, so it is made
        // anew rather than let grow.
        width *= 2;
    }
}

/// Per face its edges.
fn triangles(complex: &TetComplex) -> IdVec<FaceId, [EdgeId; 3]> {
    let mut triangles = IdVec::filled([EdgeId::NONE; 3], complex.n_faces);
    for (t, faces) in complex.tet_faces.enumerate() {
        for (i, &f) in faces.iter().enumerate() {
            let [a, b, c] = others(i);
            triangles[f] = [tet_edge(b, c), tet_edge(a, c), tet_edge(a, b)].map(|e| complex.tet_edges[t][e]);
        }
    }
    triangles
}

/// The classes while they spread from edge to edge.
struct Spread<'a> {
    triangles: &'a IdVec<FaceId, [EdgeId; 3]>,
    faces_of: &'a Buckets<EdgeId, FaceId>,
    classes: Classes,
    known: IdVec<EdgeId, bool>,
    /// Per face: edges not known yet, or not looked at.
    unknown: IdVec<FaceId, u8>,
    queue: Vec<EdgeId>,
}

impl Spread<'_> {
    /// Nothing if more than `64 width - 1` symbols are needed.
    fn run(&mut self, ends: &IdVec<EdgeId, [VertexId; 2]>, n_vertices: usize) -> Option<()> {
        // Spanning forest by union-find over the edges, ascending.
        let mut forest: Forest<VertexId> = Forest::new(n_vertices);
        for (e, &[a, b]) in ends.enumerate() {
            if forest.union(a, b) {
                self.set_known(e);
            }
        }
        let width = self.classes.width;
        let mut n_symbols = 0;
        for e in self.known.ids() {
            while let Some(known) = self.queue.pop() {
                self.look_round(known);
            }
            if self.known[e] {
                continue;
            }
            n_symbols += 1;
            if n_symbols >= 64 * width {
                return None;
            }
            // Symbol k is bit k; bit 0 of the form is the constant.
            self.classes.forms[width * e.index() + n_symbols / 64] |= 1 << (n_symbols % 64);
            self.set_known(e);
        }
        while let Some(known) = self.queue.pop() {
            self.look_round(known);
        }
        self.classes.relations.sort_unstable();
        self.classes.relations.dedup();
        Some(())
    }

    fn set_known(&mut self, e: EdgeId) {
        self.known[e] = true;
        self.queue.push(e);
    }

    /// What a known edge tells about the other edges of its triangles.
    fn look_round(&mut self, e: EdgeId) {
        let width = self.classes.width;
        for &f in &self.faces_of[e] {
            let edges = self.triangles[f];
            // An edge is looked round once, so a face is met three times in all and every pass is linear.
            self.unknown[f] -= 1;
            match self.unknown[f] {
                1 => {
                    let Some(&open) = edges.iter().find(|&&e| !self.known[e]) else { continue };
                    for w in 0..width {
                        let rest = edges.iter().filter(|&&e| e != open);
                        let s = rest.fold(0, |s, &e| s ^ self.classes.of(e)[w]);
                        self.classes.forms[width * open.index() + w] = s;
                    }
                    self.set_known(open);
                }
                0 => {
                    let [a, b, c] = edges.map(|e| self.classes.of(e));
                    let relation = sum(&sum(a, b), c);
                    if relation.iter().any(|&w| w != 0) {
                        self.classes.relations.push(relation);
                    }
                }
                _ => {}
            }
        }
    }
}
