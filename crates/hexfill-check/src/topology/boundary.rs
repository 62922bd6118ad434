//! Level 3: the boundary against the prescribed surface, and the components of the boundary with their genus.
//!
//! Source: ours.

use super::boundary_quad::BoundaryQuad;
use super::parity::ParityForest;
use super::stars::Stars;
use crate::report::{BoundaryPart, Findings, Offender, SurfaceSense};
use crate::rule::Rule;
use hexfill_mesh::{HexId, cube::FACETS};
use rayon::prelude::*;

/// The four vertices in ascending order, and where the cycle goes from the smallest: next and opposite.
fn canonical(cycle: [u32; 4]) -> ([u32; 4], u32, u32) {
    let mut key = cycle;
    key.sort_unstable();
    let at = cycle.iter().position(|&v| v == key[0]).unwrap_or(0);
    (key, cycle[(at + 1) % 4], cycle[(at + 2) % 4])
}

/// Compares the boundary with `surface` (indices in range, four distinct vertices each).
pub(crate) fn compare(
    boundary: &[BoundaryQuad],
    surface: &[[u32; 4]],
    hexes: &[[u32; 8]],
    stars: &Stars,
) -> (Findings, Option<SurfaceSense>) {
    let matching = Matching::of(boundary, surface);
    let sense = matching.sense();
    (matching.findings(boundary, surface, hexes, stars), sense)
}

/// Cycles as vertex sets in ascending order, each with its place in `cycles`.
fn sorted(cycles: impl Iterator<Item = [u32; 4]>) -> Vec<([u32; 4], u32)> {
    let mut keys: Vec<([u32; 4], u32)> = cycles.zip(0u32..).map(|(cycle, i)| (canonical(cycle).0, i)).collect();
    keys.par_sort_unstable();
    keys
}

/// The quads of the boundary against those of the surface, matched by their vertex sets.
#[derive(Default)]
struct Matching {
    /// Quads of the boundary that the surface does not have.
    extra: Vec<u32>,
    /// Quads of the surface that the boundary does not have.
    missing: Vec<u32>,
    /// Quads of the surface and of the boundary with the same vertices in another cyclic order.
    twisted: Vec<(u32, u32)>,
    /// Quads of the surface that it has once before, and the one before.
    repeated: Vec<(u32, u32)>,
    /// Quads that match, with the normals of the surface pointing outward and inward.
    outward: u64,
    inward: u64,
}

impl Matching {
    /// Goes through both lists at once, in the order of vertex sets.
    fn of(boundary: &[BoundaryQuad], surface: &[[u32; 4]]) -> Self {
        let given = sorted(surface.iter().copied());
        let found = sorted(boundary.iter().map(|quad| quad.cycle));
        let mut matching = Self::default();
        let mut at = 0;
        for same in given.chunk_by(|a, b| a.0 == b.0) {
            let (key, q) = same[0];
            matching.repeated.extend(same[1..].iter().map(|&(_, r)| (r, q)));
            while at < found.len() && found[at].0 < key {
                matching.extra.push(found[at].1);
                at += 1;
            }
            // In a mesh that fails level 2 one vertex set may be several boundary quads, in different cyclic orders.
            let first = at;
            while at < found.len() && found[at].0 == key {
                at += 1;
            }
            if first == at {
                matching.missing.push(q);
            }
            for &(_, b) in &found[first..at] {
                matching.pair(q, surface[q as usize], b, boundary[b as usize].cycle);
            }
        }
        matching.extra.extend(found[at..].iter().map(|&(_, b)| b));
        matching
    }

    /// Two cycles of the same four vertices: which vertex is opposite to the smallest tells the cyclic order up to its sense,
    /// which vertex is next the sense.
    fn pair(&mut self, q: u32, given: [u32; 4], b: u32, found: [u32; 4]) {
        let (_, next, opposite) = canonical(given);
        let (_, found_next, found_opposite) = canonical(found);
        if found_opposite != opposite {
            self.twisted.push((q, b));
        } else if found_next == next {
            self.outward += 1;
        } else {
            self.inward += 1;
        }
    }

    fn sense(&self) -> Option<SurfaceSense> {
        match (self.outward, self.inward) {
            (0, 0) => None,
            (_, 0) => Some(SurfaceSense::Outward),
            (0, _) => Some(SurfaceSense::Inward),
            _ => Some(SurfaceSense::Mixed),
        }
    }

    /// What does not match, in the order of the surface's quads (extra quads: of their vertex sets).
    fn findings(
        mut self,
        boundary: &[BoundaryQuad],
        surface: &[[u32; 4]],
        hexes: &[[u32; 8]],
        stars: &Stars,
    ) -> Findings {
        let mut findings = Findings::default();
        for b in self.extra {
            let quad = boundary[b as usize];
            findings.add(Rule::BoundaryQuadExtra, || Offender::at(&[quad.hex], &quad.cycle));
        }
        // Found in the order of threads, told in the order of ids.
        self.missing.sort_unstable();
        for q in self.missing {
            let quad = surface[q as usize];
            findings.add(Rule::BoundaryQuadMissing, || {
                let holders = holders(quad, hexes, stars);
                let list = holders.iter().take(10).map(|&h| HexId(h).to_string()).collect::<Vec<_>>().join(" ");
                let note =
                    if holders.is_empty() { "not a quad of any hex".into() } else { format!("interior: in {list}") };
                Offender::quad(q, &quad).note(note)
            });
        }
        self.twisted.sort_unstable();
        for (q, b) in self.twisted {
            let quad = boundary[b as usize];
            findings.add(Rule::BoundaryQuadTwisted, || Offender {
                hexes: vec![quad.hex],
                ..Offender::quad(q, &surface[q as usize]).note("the surface's order; the hex has another")
            });
        }
        self.repeated.sort_unstable();
        for (r, q) in self.repeated {
            findings.add(Rule::SurfaceQuadRepeated, || Offender {
                quads: vec![q, r],
                vertices: surface[r as usize].to_vec(),
                ..Offender::default()
            });
        }
        findings
    }
}

/// The hexes that have the four vertices as a facet.
fn holders(quad: [u32; 4], hexes: &[[u32; 8]], stars: &Stars) -> Vec<u32> {
    let has = |h: u32| FACETS.iter().any(|f| f.iter().all(|&k| quad.contains(&hexes[h as usize][k])));
    let in_range = quad.iter().copied().min().filter(|&v| (v as usize) < stars.len());
    in_range.map_or(Vec::new(), |v| stars.of(v).iter().map(|c| c >> 3).filter(|&h| has(h)).collect())
}

/// The components of the boundary, connected through edges, largest first. `None` if some edge is not in exactly two
/// boundary quads. A vertex where several sheets of the boundary touch counts once for each of them.
pub(crate) fn parts(boundary: &[BoundaryQuad]) -> Option<Vec<BoundaryPart>> {
    let mut sides: Vec<(u64, u32)> = boundary
        .iter()
        .enumerate()
        .flat_map(|(b, quad)| {
            (0..4).map(move |i| {
                let (x, y) = (quad.cycle[i], quad.cycle[(i + 1) % 4]);
                (u64::from(x.min(y)) << 32 | u64::from(x.max(y)), (4 * b + i) as u32)
            })
        })
        .collect();
    sides.par_sort_unstable();
    let quads = ParityForest::new(boundary.len());
    let corners = ParityForest::new(4 * boundary.len());
    let mut crooked = Vec::new();
    for pair in sides.chunks(2) {
        let [(edge, one), (other, two)] = *pair else { return None };
        if edge != other {
            return None;
        }
        let start = |side: u32| boundary[side as usize / 4].cycle[side as usize % 4];
        let next = |side: u32| side & !3 | (side + 1) & 3;
        // Coherently oriented neighbours pass the edge in opposite directions.
        let clash = start(one) == start(two);
        if !quads.union(one / 4, two / 4, clash) {
            crooked.push(one / 4);
        }
        let (a, b) = if clash { (two, next(two)) } else { (next(two), two) };
        corners.union(one, a, false);
        corners.union(next(one), b, false);
    }
    if sides.windows(3).any(|w| w[0].0 == w[2].0) {
        return None;
    }
    // Sums by root; the roots are indices of quads.
    let mut sums = vec![(0u64, 0i64, true); boundary.len()];
    for b in 0..boundary.len() as u32 {
        let sum = &mut sums[quads.find(b).0 as usize];
        sum.0 += 1;
        // A quad brings itself and half of its four edges: 1 - 2.
        sum.1 -= 1;
        for corner in 4 * b..4 * b + 4 {
            sum.1 += i64::from(corners.find(corner).0 == corner);
        }
    }
    crooked.into_iter().for_each(|b| sums[quads.find(b).0 as usize].2 = false);
    let mut parts: Vec<BoundaryPart> = sums
        .into_iter()
        .filter(|s| s.0 > 0)
        .map(|(quads, euler, orientable)| {
            let genus = (orientable && euler <= 2 && euler % 2 == 0).then(|| ((2 - euler) / 2) as u64);
            BoundaryPart { quads, euler, genus }
        })
        .collect();
    parts.sort_unstable_by_key(|p| (std::cmp::Reverse(p.quads), p.euler));
    Some(parts)
}
