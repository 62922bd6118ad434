//! The theorem as a program: does a hex mesh exist, and if not, why not?
//!
//! Thurston 1993, Mitchell 1996, Erickson 2014: a quad surface bounds a hex mesh of its interior iff the number of
//! quads is even and no odd cycle of edges bounds in the interior (Z/2-homology). A proper one needs moreover
//! that two quads share nothing, a vertex or an edge. Which cycles bound is read off linking numbers.
//!
//! Source: Thurston 1993, Mitchell 1996; Erickson 2014, section 4, for any genus. Reading it off linking numbers is ours.

use super::linking::{Linking, LinkingError, linking};
use super::nesting::solids;
use super::polygons::Darts;
use super::undecided::Undecided;
use crate::missing::MissingInterior;
use hexfill_mesh::{Context, Edge, ImproperPair, Offenders, QuadId, QuadSurface, bipartition, improper_pairs};
use std::collections::BTreeSet;
use std::fmt;

/// Whether a proper hex mesh with this boundary exists.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Existence {
    /// Yes.
    Exists {
        /// Why, in a sentence.
        because: &'static str,
    },
    /// No: the number of quads is odd.
    OddQuads {
        /// Number of quads.
        given: usize,
    },
    /// No: a component and the cavities in it have an odd number of quads together.
    OddSolid {
        /// The components, the outside first.
        components: Vec<usize>,
        /// Number of quads.
        given: usize,
    },
    /// No: a cycle of odd length bounds inside.
    OddCycleBounds {
        /// Its edges, sorted: every vertex has an even number of them, and their number is odd.
        cycle: Vec<Edge>,
    },
    /// No proper one: some quads share more than a vertex or an edge.
    ImproperQuads {
        /// The pairs.
        pairs: Offenders<ImproperPair>,
        /// Whether the surface is a sphere; then it is not 3-connected.
        sphere: bool,
    },
    /// Depends on the interior, which is not known.
    Unknown {
        /// What is missing.
        reason: Undecided,
    },
}

/// Edges of a cycle that are shown.
const SHOWN: usize = 20;

/// The reason in a sentence; whether a mesh exists is for the caller to say.
impl fmt::Display for Existence {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Exists { because } => f.write_str(because),
            Self::OddQuads { given } => write!(
                f,
                "the surface has {given} quads, an odd number, but every hex has six facets and interior quads pair up (Thurston 1993, Mitchell 1996); split one quad or merge two"
            ),
            Self::OddSolid { components, given } => {
                let names: Vec<String> = components.iter().map(ToString::to_string).collect();
                let (noun, bound) = if names.len() == 1 { ("component", "bounds") } else { ("components", "bound") };
                write!(
                    f,
                    "{noun} {} {bound} one solid with {given} quads, an odd number: every hex mesh of a connected solid has an even number of boundary quads (Thurston 1993)",
                    names.join(", ")
                )
            }
            Self::OddCycleBounds { cycle } => {
                let shown: Vec<String> = cycle.iter().take(SHOWN).map(ToString::to_string).collect();
                let more = if cycle.len() > SHOWN { " ..." } else { "" };
                write!(f, "an odd cycle of {} edges bounds inside: {}{more}", cycle.len(), shown.join(" "))
            }
            Self::ImproperQuads { pairs, sphere } => {
                let remark = if *sphere { " (the sphere is not 3-connected)" } else { "" };
                write!(
                    f,
                    "{} pairs of quads share more than one edge, which no proper mesh allows{remark}: {pairs}; refine the surface there",
                    pairs.count
                )
            }
            Self::Unknown { reason } => reason.fmt(f),
        }
    }
}

impl Existence {
    /// Whether it is known that there is no proper hex mesh.
    pub fn is_none(&self) -> bool {
        !matches!(self, Self::Exists { .. } | Self::Unknown { .. })
    }
}

/// What the quads alone forbid: an odd number of them, or two that share too much. Linear time up to sorting round each vertex.
pub fn forbidden(surface: &QuadSurface) -> Option<Existence> {
    if !surface.n_quads().is_multiple_of(2) {
        return Some(Existence::OddQuads { given: surface.n_quads() });
    }
    let pairs = improper_pairs(surface);
    (!pairs.is_empty()).then(|| Existence::ImproperQuads { pairs, sphere: surface.is_sphere() })
}

/// Whether a solid (an outside and its cavities) has an odd number of quads, where components do.
fn odd_solid(surface: &QuadSurface, points: Option<&[[f64; 3]]>) -> Option<Existence> {
    let mut size = vec![0usize; surface.n_components()];
    for q in 0..surface.n_quads() {
        size[surface.component(QuadId::new(q))] += 1;
    }
    if size.iter().all(|s| s.is_multiple_of(2)) {
        return None;
    }
    let unknown = |reason: Undecided| Some(Existence::Unknown { reason });
    let Some(points) = points else {
        return unknown(Undecided::OddComponents);
    };
    if points.len() < surface.n_vertices() || !points.iter().flatten().all(|x| x.is_finite()) {
        return unknown(MissingInterior::PositionsMissing.into());
    }
    let mut triangles = Vec::with_capacity(2 * surface.n_quads());
    let mut component = Vec::with_capacity(2 * surface.n_quads());
    for (q, quad) in surface.quads().iter().enumerate() {
        let [a, b, c, d] = *quad;
        triangles.extend([[a, b, c], [a, c, d]]);
        component.extend([surface.component(QuadId::new(q)); 2]);
    }
    match solids(&triangles, &component, size.len(), points) {
        Err(reason) => unknown(reason.into()),
        Ok(solids) => solids.into_iter().find_map(|components| {
            let given: usize = components.iter().map(|&c| size[c]).sum();
            (!given.is_multiple_of(2)).then_some(Existence::OddSolid { components, given })
        }),
    }
}

/// Decides existence. `points`, a position for each vertex id in any unit, are needed only if the surface has odd cycles or several components
/// of which some have odd numbers of quads (never for one sphere); where they are needed and too few or not finite the answer is
/// [`Existence::Unknown`]. Linear time, but for surfaces with handles and odd cycles: linking numbers of 2 g loops.
///
/// # Example
/// ```
/// use hexfill_construct::{Existence, existence};
/// use hexfill_mesh::QuadSurface;
///
/// // Three quads from pole to pole: closed, but any two share three vertices.
/// let quads = [[0, 1, 4, 2], [0, 2, 4, 3], [0, 3, 4, 1]];
/// assert!(matches!(existence(&QuadSurface::try_new(5, &quads)?, None), Existence::OddQuads { given: 3 }));
///
/// let quads = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];
/// assert!(matches!(existence(&QuadSurface::try_new(8, &quads)?, None), Existence::Exists { .. }));
/// # Ok::<(), hexfill_mesh::SurfaceError>(())
/// ```
pub fn existence(surface: &QuadSurface, points: Option<&[[f64; 3]]>) -> Existence {
    if let Some(no) = forbidden(surface) {
        return no;
    }
    if let Some(answer) = odd_solid(surface, points) {
        return answer;
    }
    if bipartition(surface).is_ok() {
        return Existence::Exists { because: "an even number of quads and no odd cycle" };
    }
    let Some(points) = points else {
        return Existence::Unknown { reason: Undecided::OddCycles };
    };
    let s = Darts::of_surface(surface);
    let l = match linking(&s, points, &Context::default()) {
        Ok(l) => l,
        Err(LinkingError::Undecided(reason)) => return Existence::Unknown { reason: reason.into() },
        Err(LinkingError::Stopped(reason)) => return Existence::Unknown { reason: Undecided::Stopped(reason) },
    };
    odd_cycle_inside(&s, &l)
        .map_or(Existence::Exists { because: "an even number of quads, and no odd cycle bounds inside" }, |cycle| {
            Existence::OddCycleBounds { cycle }
        })
}

/// A sum of basis loops that bounds inside and is odd, if there is one. By Alexander duality a sum bounds iff its linking numbers
/// with all basis loops, pushed outward, are even: Gaussian elimination over Z/2.
fn odd_cycle_inside(s: &Darts, l: &Linking) -> Option<Vec<Edge>> {
    // Rows: linking numbers mod 2, then the parity of the length, with the loops they are sums of.
    let n = l.loops.len();
    let mut rows: Vec<(Vec<bool>, bool, BTreeSet<usize>)> = (0..n)
        .map(|i| (l.numbers[i].iter().map(|x| x % 2 != 0).collect(), l.loops[i].len() % 2 == 1, BTreeSet::from([i])))
        .collect();
    let mut done = 0;
    for c in 0..n {
        let Some(pivot) = (done..n).find(|&r| rows[r].0[c]) else { continue };
        rows.swap(done, pivot);
        let head = rows[done].clone();
        for row in rows.iter_mut().skip(done + 1).filter(|r| r.0[c]) {
            row.0.iter_mut().zip(&head.0).for_each(|(x, y)| *x ^= y);
            row.1 ^= head.1;
            row.2 = row.2.symmetric_difference(&head.2).copied().collect();
        }
        done += 1;
    }
    let odd = rows[done..].iter().find(|r| r.1)?;
    let mut cycle: BTreeSet<Edge> = BTreeSet::new();
    for &d in odd.2.iter().flat_map(|&i| &l.loops[i]) {
        let edge = Edge::new(s.origin[d], s.target(d));
        if !cycle.remove(&edge) {
            cycle.insert(edge);
        }
    }
    Some(cycle.into_iter().collect())
}
