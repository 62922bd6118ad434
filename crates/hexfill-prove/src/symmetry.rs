//! Groups of symmetries of a boundary: its subgroups, and how one acts on the vertices of a mesh that is to be invariant.
//!
//! An automorphism of a ball mesh is determined by what it does on the boundary, so a group of automorphisms of the mesh *is* a subgroup
//! of the boundary's automorphism group; how it acts on an interior vertex is told by the vertex's stabilizer.

use crate::state::MAX_VERTICES;
use hexfill_mesh::{QuadSurface, bipartition, surface_automorphisms};

/// Largest group, so that a subgroup is a `u64`.
pub const MAX_ORDER: usize = 64;

/// The automorphism group of a boundary.
#[derive(Clone, Debug)]
pub struct Symmetries {
    /// Per element the image of each vertex; the identity first.
    elements: Vec<Vec<u8>>,
    reflects: Vec<bool>,
    swaps: Vec<bool>,
    /// `product[a][b]`: first `b`, then `a`.
    product: Vec<Vec<u8>>,
    /// Per element the number of quads it fixes, of vertices it fixes: what tells elements apart in words.
    fixed: Vec<(usize, usize)>,
}

/// A set of elements, closed under products.
pub type Subgroup = u64;

impl Symmetries {
    /// All automorphisms of a sphere; `None` if there are more than [`MAX_ORDER`] (the sphere is a wheel-like large one).
    pub fn of(surface: &QuadSurface) -> Option<Self> {
        if hexfill_mesh::surface_symmetry_order(surface) > MAX_ORDER as u128 {
            return None;
        }
        let all = surface_automorphisms(surface);
        let colour = bipartition(surface).ok()?;
        let elements: Vec<Vec<u8>> = all.iter().map(|a| a.vertices.iter().map(|v| v.0 as u8).collect()).collect();
        let find = |image: &[u8]| elements.iter().position(|e| e == image).expect("closed under products") as u8;
        let product = elements
            .iter()
            .map(|a| {
                elements.iter().map(|b| find(&b.iter().map(|&v| a[usize::from(v)]).collect::<Vec<u8>>())).collect()
            })
            .collect();
        let fixed = elements.iter().map(|e| fixed_cells(surface, e)).collect();
        Some(Self {
            reflects: all.iter().map(|a| a.reflection).collect(),
            swaps: elements.iter().map(|e| colour[0] != colour[usize::from(e[0])]).collect(),
            elements,
            product,
            fixed,
        })
    }

    /// Order of the whole group.
    pub fn order(&self) -> usize {
        self.elements.len()
    }

    /// The whole group.
    pub fn whole(&self) -> Subgroup {
        u64::MAX >> (MAX_ORDER - self.order())
    }

    /// All subgroups, ascending by order, then by elements.
    pub fn subgroups(&self) -> Vec<Subgroup> {
        let mut all: Vec<Subgroup> = vec![1];
        let mut at = 0;
        while at < all.len() {
            for g in 1..self.order() {
                let larger = self.closure(all[at] | 1 << g);
                if !all.contains(&larger) {
                    all.push(larger);
                }
            }
            at += 1;
        }
        all.sort_unstable_by_key(|s| (s.count_ones(), *s));
        all
    }

    /// One subgroup of each class of conjugate ones, ascending by order: a mesh has one of the class as symmetries exactly if an image
    /// of the mesh under the boundary's automorphisms has the other.
    pub fn subgroup_classes(&self) -> Vec<Subgroup> {
        let mut out: Vec<Subgroup> = Vec::new();
        for s in self.subgroups() {
            if (0..self.order()).all(|g| !out.contains(&self.conjugate(s, g))) {
                out.push(s);
            }
        }
        out
    }

    /// What a subgroup is, in words: order, mirrors, rotations, rotary reflections.
    pub fn describe(&self, s: Subgroup) -> String {
        let mut kinds = [0usize; 3];
        for g in members(s).skip(1) {
            let mirror = self.reflects[g] && self.product[g][g] == 0 && self.fixed[g] != (0, 0);
            kinds[if mirror {
                0
            } else if self.reflects[g] {
                2
            } else {
                1
            }] += 1;
        }
        let word = |n: usize, one: &str| match n {
            0 => String::new(),
            1 => format!(", 1 {one}"),
            n => format!(", {n} {one}s"),
        };
        format!(
            "order {}{}{}{}",
            s.count_ones(),
            word(kinds[0], "mirror"),
            word(kinds[1], "rotation"),
            word(kinds[2], "rotary reflection")
        )
    }

    /// The elements that carry a subgroup to itself by conjugation.
    pub(crate) fn normalizer(&self, s: Subgroup) -> Vec<Vec<u8>> {
        (0..self.order()).filter(|&g| self.conjugate(s, g) == s).map(|g| self.elements[g].clone()).collect()
    }

    fn closure(&self, mut s: Subgroup) -> Subgroup {
        loop {
            let mut larger = s;
            for a in members(s) {
                for b in members(s) {
                    larger |= 1 << self.product[a][b];
                }
            }
            if larger == s {
                return s;
            }
            s = larger;
        }
    }

    fn conjugate(&self, s: Subgroup, by: usize) -> Subgroup {
        let inverse = (0..self.order()).find(|&h| self.product[by][h] == 0).unwrap_or(0);
        members(s).fold(0, |set, g| set | 1 << self.product[usize::from(self.product[by][g])][inverse])
    }
}

fn fixed_cells(surface: &QuadSurface, image: &[u8]) -> (usize, usize) {
    let quads =
        surface.quads().iter().filter(|q| q.iter().all(|v| q.iter().any(|w| w.0 as u8 == image[v.index()]))).count();
    (quads, image.iter().enumerate().filter(|(v, w)| *v == usize::from(**w)).count())
}

fn members(s: Subgroup) -> impl Iterator<Item = usize> {
    (0..MAX_ORDER).filter(move |g| s >> g & 1 == 1)
}

/// What the stabilizer of a new vertex may be, and the orbit it then has.
#[derive(Clone)]
struct Stabilizer {
    /// Per element the number of its left coset: the vertex of the orbit that it carries the first one to.
    coset: Vec<u8>,
    /// Per coset an element.
    representative: Vec<u8>,
}

/// A group imposed on a mesh, acting on the vertices made so far.
#[derive(Clone)]
pub(crate) struct Action {
    image: Vec<[u8; MAX_VERTICES]>,
    reflects: Vec<bool>,
    swaps: Vec<bool>,
    product: Vec<Vec<u8>>,
    stabilizers: Vec<Stabilizer>,
}

impl Action {
    /// A subgroup acting on the boundary's vertices.
    pub(crate) fn new(symmetries: &Symmetries, s: Subgroup) -> Self {
        let elements: Vec<usize> = members(s).collect();
        let index = |g: u8| elements.iter().position(|&e| e == usize::from(g)).expect("a subgroup is closed") as u8;
        let product: Vec<Vec<u8>> =
            elements.iter().map(|&a| elements.iter().map(|&b| index(symmetries.product[a][b])).collect()).collect();
        let image = elements
            .iter()
            .map(|&g| {
                let mut image = [0; MAX_VERTICES];
                image[..symmetries.elements[g].len()].copy_from_slice(&symmetries.elements[g]);
                image
            })
            .collect();
        let swaps: Vec<bool> = elements.iter().map(|&g| symmetries.swaps[g]).collect();
        let stabilizers = symmetries
            .subgroups()
            .into_iter()
            // What exchanges the colours fixes no vertex.
            .filter(|t| t & !s == 0 && members(*t).all(|g| !symmetries.swaps[g]))
            .map(|t| {
                let t: Vec<u8> = members(t).map(|g| index(g as u8)).collect();
                Stabilizer::new(&product, &t)
            })
            .collect();
        Self {
            image,
            reflects: elements.iter().map(|&g| symmetries.reflects[g]).collect(),
            swaps,
            product,
            stabilizers,
        }
    }

    /// Order of the group.
    #[inline]
    pub(crate) fn order(&self) -> usize {
        self.image.len()
    }

    /// Number of kinds of new vertices.
    pub(crate) fn n_stabilizers(&self) -> usize {
        self.stabilizers.len()
    }

    /// The image of a vertex.
    #[inline]
    pub(crate) fn image(&self, g: usize, v: u8) -> u8 {
        self.image[g][usize::from(v)]
    }

    /// Whether an element turns hexes into mirror images.
    pub(crate) fn reflects(&self, g: usize) -> bool {
        self.reflects[g]
    }

    /// Size of the orbit of a new vertex.
    #[inline]
    pub(crate) fn orbit_size(&self, stabilizer: usize) -> usize {
        self.stabilizers[stabilizer].representative.len()
    }

    /// Lets the group act on a new orbit: vertices `first..first + orbit_size`. Calls `colour` with the place in the orbit and whether its
    /// colour differs from the first vertex's.
    pub(crate) fn extend(&mut self, first: usize, stabilizer: usize, mut colour: impl FnMut(usize, bool)) {
        let s = &self.stabilizers[stabilizer];
        for (i, &r) in s.representative.iter().enumerate() {
            colour(i, self.swaps[usize::from(r)]);
            for g in 0..self.image.len() {
                let product = self.product[g][usize::from(r)];
                self.image[g][first + i] = first as u8 + s.coset[usize::from(product)];
            }
        }
    }
}

impl Stabilizer {
    fn new(product: &[Vec<u8>], members: &[u8]) -> Self {
        let mut coset = vec![u8::MAX; product.len()];
        let mut representative = Vec::new();
        for g in 0..product.len() {
            if coset[g] == u8::MAX {
                for &m in members {
                    coset[usize::from(product[g][usize::from(m)])] = representative.len() as u8;
                }
                representative.push(g as u8);
            }
        }
        Self { coset, representative }
    }
}
