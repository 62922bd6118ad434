//! Colours: the bipartition where there is one, else a colouring with few black-black edges (Erickson 2014 colours all
//! vertices black; Verhetsel et al. 2019 use the bipartition).
//!
//! Invariant of every [`Colouring`]: white vertices are independent. Columns over white vertices have two segments,
//! and the dual surface Sigma crosses exactly the black-black edges, so a bipartite surface pays nothing for it and
//! Erickson's original construction is the colouring that is black all over.
//!
//! Source: Erickson 2014 and Verhetsel et al. 2019, the two ends; the colourings between them are ours.

use hexfill_mesh::{Dart, IdVec, QuadSurface, VertexId, bipartition};

/// White vertices, no two of them adjacent.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Colouring {
    /// Per vertex: whether it is white.
    pub white: IdVec<VertexId, bool>,
    /// Number of black-black edges.
    pub n_cut_edges: usize,
}

/// Per vertex: whether its depth in a breadth-first forest is odd (roots ascending).
fn depth_parity(surface: &QuadSurface) -> IdVec<VertexId, bool> {
    let first: IdVec<VertexId, Option<Dart>> = surface.dart_of_vertices().into();
    let mut odd = IdVec::filled(false, surface.n_vertices());
    let mut seen = IdVec::filled(false, surface.n_vertices());
    let mut queue = Vec::new();
    for start in first.ids() {
        if first[start].is_none() || seen[start] {
            continue;
        }
        seen[start] = true;
        queue.clear();
        queue.push(start);
        let mut at = 0;
        while at < queue.len() {
            let v = queue[at];
            at += 1;
            let Some(d) = first[v] else { continue };
            for e in surface.round_vertex(d) {
                let w = surface.target(e);
                if !seen[w] {
                    seen[w] = true;
                    odd[w] = !odd[v];
                    queue.push(w);
                }
            }
        }
    }
    odd
}

/// How many hexes of the core a white class saves on a ball: its vertices with three quads.
fn n_degree_three(surface: &QuadSurface, class: &IdVec<VertexId, bool>, side: bool) -> usize {
    class.enumerate().filter(|&(v, &c)| c == side && surface.degree(v) == 3).count()
}

/// A colouring with few black-black edges: none if the surface is bipartite. Linear time. `swap` exchanges the colours of a
/// bipartite surface.
pub fn colouring(surface: &QuadSurface, swap: bool) -> Colouring {
    if let Ok(odd) = bipartition(surface) {
        let odd: IdVec<VertexId, bool> = odd.into();
        // The class with more vertices of three quads becomes white (the core is cheaper there).
        let side = swap != (n_degree_three(surface, &odd, true) >= n_degree_three(surface, &odd, false));
        let white = odd.enumerate().map(|(v, &o)| surface.degree(v) > 0 && o == side).collect();
        return Colouring { white, n_cut_edges: 0 };
    }
    let first: IdVec<VertexId, Option<Dart>> = surface.dart_of_vertices().into();
    let mut white = depth_parity(surface);
    let whites_round = |white: &IdVec<VertexId, bool>, v: VertexId| {
        first[v].map_or(0, |d| surface.round_vertex(d).filter(|&e| white[surface.target(e)]).count() as u32)
    };
    // A vertex moves to the other colour when that removes one-coloured edges; a few sweeps settle it.
    for _ in 0..8 {
        let mut moved = false;
        for v in white.ids() {
            let degree = surface.degree(v);
            let same = whites_round(&white, v);
            let same = if white[v] { same } else { degree - same };
            if 2 * same > degree {
                white[v] = !white[v];
                moved = true;
            }
        }
        if !moved {
            break;
        }
    }
    // White must be independent: of two adjacent whites the one with more white neighbours turns black.
    for v in white.ids().filter(|&v| first[v].is_some()) {
        let mine = whites_round(&white, v);
        let is_worst = |w: VertexId| white[w] && whites_round(&white, w) <= mine;
        let mut round = first[v].into_iter().flat_map(|d| surface.round_vertex(d));
        if white[v] && mine > 0 && round.any(|e| is_worst(surface.target(e))) {
            white[v] = false;
        }
    }
    for v in white.ids() {
        if white[v] && whites_round(&white, v) > 0 {
            white[v] = false;
        }
    }
    for v in white.ids() {
        if !white[v] && first[v].is_some() && whites_round(&white, v) == 0 {
            white[v] = true;
        }
    }
    with_count(surface, white)
}

/// Erickson's colouring: black all over, every edge cut.
pub fn all_black(surface: &QuadSurface) -> Colouring {
    with_count(surface, IdVec::filled(false, surface.n_vertices()))
}

fn with_count(surface: &QuadSurface, white: IdVec<VertexId, bool>) -> Colouring {
    let cut = |d: &Dart| !white[surface.origin(*d)] && !white[surface.target(*d)];
    let n_cut_edges = surface.darts().filter(cut).count() / 2;
    Colouring { white, n_cut_edges }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hexfill_mesh::generate::torus;

    #[test]
    fn white_is_independent_and_only_odd_tori_have_cut_edges() {
        for m in 3..7u32 {
            for n in 3..7u32 {
                let s = torus(m, n, 0).unwrap();
                let c = colouring(&s, false);
                for d in s.darts() {
                    assert!(!(c.white[s.origin(d)] && c.white[s.target(d)]));
                }
                assert_eq!(c.n_cut_edges == 0, m % 2 == 0 && n % 2 == 0);
                assert!(c.n_cut_edges < s.n_edges());
                assert_eq!(all_black(&s).n_cut_edges, s.n_edges());
            }
        }
    }
}
