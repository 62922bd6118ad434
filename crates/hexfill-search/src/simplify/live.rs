//! [`LiveMesh`]: a hex mesh in which balls of hexes are exchanged in place.
//!
//! Facet neighbours and, per vertex, a doubly linked list of the hex corners there. An exchange costs what the ball costs,
//! whatever the size of the mesh. Ids of removed hexes and vertices are used again, last removed first, so the result does
//! not depend on anything but the sequence of exchanges.
//!
//! Source: ours.

use hexfill_mesh::HexMesh;
use hexfill_mesh::cube::FACETS;

/// No hex, facet, corner or vertex.
pub(crate) const NONE: u32 = u32::MAX;

/// A mesh that changes. Hex `h` has facets `6 h + side` and corners `8 h + i`.
#[derive(Clone)]
pub(crate) struct LiveMesh {
    hexes: Vec<[u32; 8]>,
    neighbour: Vec<u32>,
    /// Per corner: the next and the previous corner at the same vertex.
    next: Vec<u32>,
    previous: Vec<u32>,
    /// Per vertex: its first corner.
    first: Vec<u32>,
    /// Per vertex: how many hexes it has.
    degree: Vec<u32>,
    /// Per vertex: whether it came with an exchange.
    is_new: Vec<bool>,
    /// Per hex: the exchange that made it, 0 for those of the input.
    made: Vec<u32>,
    exchanges: u32,
    free_hexes: Vec<u32>,
    free_vertices: Vec<u32>,
    n_hexes: usize,
}

/// A quad's vertices, ascending: its name.
fn name(quad: [u32; 4]) -> [u32; 4] {
    let mut name = quad;
    name.sort_unstable();
    name
}

impl LiveMesh {
    pub(crate) fn new(mesh: &HexMesh) -> Self {
        let hexes = mesh.hexes_raw();
        let n = hexes.len();
        let neighbour = mesh.facets().map(|f| mesh.neighbour(f).map_or(NONE, |g| g.0)).collect();
        let mut live = Self {
            neighbour,
            next: vec![NONE; 8 * n],
            previous: vec![NONE; 8 * n],
            first: vec![NONE; mesh.n_vertices()],
            degree: vec![0; mesh.n_vertices()],
            is_new: vec![false; mesh.n_vertices()],
            made: vec![0; n],
            exchanges: 0,
            free_hexes: Vec::new(),
            free_vertices: Vec::new(),
            n_hexes: n,
            hexes,
        };
        for h in 0..n as u32 {
            live.link(h);
        }
        live
    }

    /// Number of hexes.
    pub(crate) fn n_hexes(&self) -> usize {
        self.n_hexes
    }

    /// One more than the largest hex id.
    pub(crate) fn n_hex_slots(&self) -> usize {
        self.hexes.len()
    }

    /// One more than the largest vertex id.
    pub(crate) fn n_vertex_slots(&self) -> usize {
        self.first.len()
    }

    pub(crate) fn is_alive(&self, hex: u32) -> bool {
        self.hexes[hex as usize][0] != NONE
    }

    #[inline]
    pub(crate) fn hex(&self, hex: u32) -> &[u32; 8] {
        &self.hexes[hex as usize]
    }

    /// The vertices of a facet, counter-clockwise from outside its hex.
    #[inline]
    pub(crate) fn facet(&self, facet: u32) -> [u32; 4] {
        let hex = &self.hexes[(facet / 6) as usize];
        FACETS[(facet % 6) as usize].map(|i| hex[i])
    }

    /// The facet glued to this one, or [`NONE`].
    #[inline]
    pub(crate) fn neighbour(&self, facet: u32) -> u32 {
        self.neighbour[facet as usize]
    }

    /// How many hexes a vertex has.
    #[inline]
    pub(crate) fn degree(&self, vertex: u32) -> u32 {
        self.degree[vertex as usize]
    }

    /// Whether the vertex came with an exchange.
    pub(crate) fn is_new(&self, vertex: u32) -> bool {
        self.is_new[vertex as usize]
    }

    /// The hexes at a vertex.
    pub(crate) fn hexes_at(&self, vertex: u32) -> impl Iterator<Item = u32> + '_ {
        let mut corner = self.first[vertex as usize];
        std::iter::from_fn(move || {
            if corner == NONE {
                return None;
            }
            let hex = corner / 8;
            corner = self.next[corner as usize];
            Some(hex)
        })
    }

    /// How many exchanges were made.
    pub(crate) fn exchanges(&self) -> u32 {
        self.exchanges
    }

    /// Whether all of `hexes` are there and were there after `exchange` exchanges.
    pub(crate) fn are_untouched_since(&self, hexes: &[u32], exchange: u32) -> bool {
        hexes.iter().all(|&h| self.is_alive(h) && self.made[h as usize] <= exchange)
    }

    fn link(&mut self, hex: u32) {
        for i in 0..8 {
            let (corner, v) = (8 * hex + i, self.hexes[hex as usize][i as usize] as usize);
            let second = self.first[v];
            self.next[corner as usize] = second;
            self.previous[corner as usize] = NONE;
            if second != NONE {
                self.previous[second as usize] = corner;
            }
            self.first[v] = corner;
            self.degree[v] += 1;
        }
    }

    fn unlink(&mut self, hex: u32) {
        for i in 0..8 {
            let (corner, v) = ((8 * hex + i) as usize, self.hexes[hex as usize][i as usize] as usize);
            let (before, after) = (self.previous[corner], self.next[corner]);
            if before == NONE {
                self.first[v] = after;
            } else {
                self.next[before as usize] = after;
            }
            if after != NONE {
                self.previous[after as usize] = before;
            }
            self.degree[v] -= 1;
        }
    }

    /// Takes hexes out.
    fn remove(&mut self, hexes: &[u32]) {
        // In descending order, so that ids come back in ascending order.
        let mut order = hexes.to_vec();
        order.sort_unstable_by(|a, b| b.cmp(a));
        for h in order {
            self.unlink(h);
            self.hexes[h as usize] = [NONE; 8];
            self.free_hexes.push(h);
        }
    }

    /// Takes the hexes `removed` out and puts `added` in their place. Both are balls with the same boundary quads; vertex ids
    /// of `added` from `first_new` on stand for new vertices. Returns the ids of the new hexes.
    pub(crate) fn exchange(&mut self, removed: &[u32], added: &[[u32; 8]], first_new: u32) -> Vec<u32> {
        self.exchanges += 1;
        // The rim: facets of the removed hexes towards what stays, by the name of their quad.
        let mut open: Vec<([u32; 4], u32)> = Vec::with_capacity(32);
        for &h in removed {
            for f in 6 * h..6 * h + 6 {
                let across = self.neighbour(f);
                if across == NONE || !removed.contains(&(across / 6)) {
                    open.push((name(self.facet(f)), across));
                }
            }
        }
        let mut old_vertices: Vec<u32> = removed.iter().flat_map(|&h| *self.hex(h)).collect();
        old_vertices.sort_unstable();
        old_vertices.dedup();
        self.remove(removed);
        let mut new_vertices: Vec<u32> = Vec::new();
        let mut ids = Vec::with_capacity(added.len());
        for hex in added {
            let h = self.free_hexes.pop().unwrap_or_else(|| self.new_hex_slot());
            self.hexes[h as usize] = hex.map(|v| {
                if v < first_new {
                    return v;
                }
                let i = (v - first_new) as usize;
                while new_vertices.len() <= i {
                    let id = self.free_vertices.pop().unwrap_or_else(|| {
                        self.first.push(NONE);
                        self.degree.push(0);
                        self.is_new.push(true);
                        self.first.len() as u32 - 1
                    });
                    self.is_new[id as usize] = true;
                    new_vertices.push(id);
                }
                new_vertices[i]
            });
            self.made[h as usize] = self.exchanges;
            self.link(h);
            ids.push(h);
        }
        // A vertex that no hex uses any more was inside: its id is free.
        for &v in old_vertices.iter().rev() {
            if self.degree[v as usize] == 0 {
                self.free_vertices.push(v);
            }
        }
        // Each facet of the new hexes meets another of them, or the rim, once.
        open.extend(ids.iter().flat_map(|&h| 6 * h..6 * h + 6).map(|f| (name(self.facet(f)), f)));
        open.sort_unstable();
        for pair in open.chunk_by(|a, b| a.0 == b.0) {
            debug_assert_eq!(pair.len(), 2, "the ball's boundary is the removed ball's");
            if let [(_, f), (_, g)] = *pair {
                for (f, g) in [(f, g), (g, f)] {
                    if f != NONE {
                        self.neighbour[f as usize] = g;
                    }
                }
            }
        }
        self.n_hexes = self.n_hexes + added.len() - removed.len();
        ids
    }

    /// Presses the hexes `removed` flat: of each pair of their facets, what lies beyond the one is glued to what lies beyond the
    /// other, and the first vertex of each of `merges` becomes the second. The collapse must be a legal one (`quotient.rs`).
    pub(crate) fn merge(&mut self, removed: &[u32], facets: &[[u32; 2]], merges: &[[u32; 2]]) {
        self.exchanges += 1;
        // One pair after the other: where several quads become one, the outer two are left.
        for &[f, g] in facets {
            let (f, g) = (self.neighbour[f as usize], self.neighbour[g as usize]);
            for (f, g) in [(f, g), (g, f)] {
                if f != NONE {
                    self.neighbour[f as usize] = g;
                }
            }
        }
        self.remove(removed);
        for &[from, to] in merges {
            let hexes: Vec<u32> = self.hexes_at(from).collect();
            for h in hexes {
                self.unlink(h);
                self.hexes[h as usize] = self.hexes[h as usize].map(|v| if v == from { to } else { v });
                self.made[h as usize] = self.exchanges;
                self.link(h);
            }
        }
        self.free_vertices.extend(merges.iter().rev().map(|&[from, _]| from));
        self.n_hexes -= removed.len();
    }

    fn new_hex_slot(&mut self) -> u32 {
        self.hexes.push([NONE; 8]);
        self.made.push(0);
        self.neighbour.extend([NONE; 6]);
        self.next.extend([NONE; 8]);
        self.previous.extend([NONE; 8]);
        self.hexes.len() as u32 - 1
    }

    /// The hexes in the order of their ids, with their own vertex ids.
    pub(crate) fn alive(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.hexes.len() as u32).filter(|&h| self.is_alive(h))
    }
}
