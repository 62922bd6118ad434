//! The smallest changes that make an odd number of quads even.
//!
//! Two quads beside each other become three round a new vertex: one quad more, but obtuse ones. Or a chord is doubled: every quad it passes
//! is cut in two along it, a quad it passes twice in four, so that the number of quads changes by k + 3 s. On a sphere k is even for every chord (two closed
//! curves cross an even number of times), and the number of quads is odd just if some chord crosses itself an odd number of times.
//! Doubling keeps the shape of the surface, with quads half as wide.
//!
//! Source: ours; two closed curves on a sphere cross an even number of times (Jordan).

use crate::cut::Cutter;
use crate::sines::least_sine;
use crate::soup::Soup;
use hexfill_geometry::midpoint;
use hexfill_mesh::{Chord, Dart, QuadId, QuadSurface, chords, improper_pairs};
use serde::Serialize;

/// A change of a surface that adds an odd number of quads.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case", tag = "change")]
#[non_exhaustive]
pub enum ParityChange {
    /// Two neighbours become three quads round a new vertex in the middle of their common edge.
    TwoToThree {
        /// The neighbours.
        quads: [u32; 2],
        /// Their common edge.
        edge: [u32; 2],
        /// The least sine of a corner of the new quads, in (0, 1]: 1 is a right angle.
        worst_sine: f64,
    },
    /// The quads along a chord are cut in two, those it passes twice in four.
    DoubleChord {
        /// The quads it passes, in order of passage.
        quads: Vec<u32>,
        /// The edges it crosses, in order of passage: each gets a vertex in its middle.
        edges: Vec<[u32; 2]>,
        /// How many quads are added.
        added: usize,
    },
}

/// Corners with a smaller sine are not made.
const LEAST_SINE: f64 = 0.05;
/// So many of the best pairs of neighbours are tried.
const TRIED: usize = 50;

/// The smallest change of each kind, the fewest quads first; empty if there is none. `points`: a position per vertex.
pub fn parity_changes(surface: &QuadSurface, points: &[[f64; 3]]) -> Vec<ParityChange> {
    [two_to_three(surface, points), double_chord(surface)].into_iter().flatten().collect()
}

fn edge_of(surface: &QuadSurface, d: Dart) -> [u32; 2] {
    let quad = surface.quads()[d.quad().index()];
    [quad[d.side()].0, quad[(d.side() + 1) % 4].0]
}

fn double_chord(surface: &QuadSurface) -> Option<ParityChange> {
    let added = |c: &Chord| c.length() + 2 * c.self_crossings.len();
    let odd = chords(surface).into_iter().filter(|c| added(c) % 2 == 1);
    let best = odd.min_by_key(|c| added(c))?;
    Some(ParityChange::DoubleChord {
        quads: best.quads().map(|q| q.0).collect(),
        edges: best.crossings.iter().map(|&d| edge_of(surface, d)).collect(),
        added: added(&best),
    })
}

/// The hexagon round the two quads at a dart, from the dart's origin on, and the quads round its middle when the corners of this parity are joined to it.
fn three(surface: &QuadSurface, d: Dart, parity: usize) -> ([u32; 6], [[usize; 3]; 3]) {
    let twin = surface.twin(d);
    let corner = |d: Dart, k: usize| surface.quads()[d.quad().index()][(d.side() + k) % 4].0;
    // Origin of d; then round the twin's quad to the end of d; then round the quad of d, back.
    let hexagon = [corner(d, 0), corner(twin, 2), corner(twin, 3), corner(d, 1), corner(d, 2), corner(d, 3)];
    (hexagon, [0, 2, 4].map(|k| [(k + parity) % 6, (k + parity + 1) % 6, (k + parity + 2) % 6]))
}

fn two_to_three(surface: &QuadSurface, points: &[[f64; 3]]) -> Option<ParityChange> {
    let at = |v: u32| points[v as usize];
    let mut ways: Vec<(f64, Dart, usize)> = Vec::new();
    for d in surface.darts().filter(|&d| d < surface.twin(d)) {
        for parity in 0..2 {
            let (hexagon, three) = three(surface, d, parity);
            let middle = midpoint(at(hexagon[0]), at(hexagon[3]));
            let quads = three.map(|corners| {
                let [a, b, c] = corners.map(|k| at(hexagon[k]));
                [middle, a, b, c]
            });
            ways.push((least_sine(&quads), d, parity));
        }
    }
    // The order of darts among equals.
    ways.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2)));
    let before = improper_pairs(surface).count;
    let soup = |way: &ParityChange| {
        let faces = surface.quads().iter().map(|q| q.map(|v| v.0).to_vec()).collect();
        changed(&Soup { points: points.to_vec(), faces }, way).0
    };
    ways.iter().take(TRIED).take_while(|way| way.0 >= LEAST_SINE).find_map(|&(worst_sine, d, parity)| {
        let [a, b] = edge_of(surface, d);
        // The end of the edge that keeps its edge to the middle is named first.
        let edge = if parity == 0 { [a, b] } else { [b, a] };
        let quads = [d.quad().0, surface.twin(d).quad().0];
        let way = ParityChange::TwoToThree { quads, edge, worst_sine };
        let after = soup(&way).surface().ok()?;
        // Three quads round a vertex may share too much with their neighbours: to be even and not fillable is no
        // gain.
        (improper_pairs(&after).count <= before).then_some(way)
    })
}

/// The soup after a change, and per new face the old one it is part of. New points come last.
pub(crate) fn changed(soup: &Soup, change: &ParityChange) -> (Soup, Vec<u32>) {
    match change {
        ParityChange::TwoToThree { quads, edge, .. } => made_three(soup, *quads, *edge),
        ParityChange::DoubleChord { edges, .. } => doubled(soup, edges),
    }
}

fn made_three(soup: &Soup, quads: [u32; 2], edge: [u32; 2]) -> (Soup, Vec<u32>) {
    let mut after = soup.clone();
    let new = soup.n_points() as u32;
    if !soup.points.is_empty() {
        after.points.push(midpoint(soup.points[edge[0] as usize], soup.points[edge[1] as usize]));
    }
    let Ok(surface) = soup.surface() else { return (after, (0..soup.faces.len() as u32).collect()) };
    let is_one = |d: &Dart| {
        let [a, b] = edge_of(&surface, *d);
        d.quad().0 == quads[0]
            && surface.twin(*d).quad().0 == quads[1]
            && (a.min(b), a.max(b)) == (edge[0].min(edge[1]), edge[0].max(edge[1]))
    };
    let Some(d) = surface.darts().find(is_one) else { return (after, (0..soup.faces.len() as u32).collect()) };
    let parity = usize::from(edge_of(&surface, d) != edge);
    let (hexagon, three) = three(&surface, d, parity);
    let of = three.map(|corners| {
        let [a, b, c] = corners.map(|k| hexagon[k]);
        vec![new, a, b, c]
    });
    let mut origin: Vec<u32> = (0..soup.faces.len() as u32).collect();
    let [p, q] = quads.map(|q| q as usize);
    let [first, second, third] = of;
    (after.faces[p], after.faces[q]) = (first, second);
    after.faces.push(third);
    origin.push(quads[0]);
    (after, origin)
}

/// Every edge gets a vertex in its middle, and every quad is cut between those of opposite edges.
fn doubled(soup: &Soup, edges: &[[u32; 2]]) -> (Soup, Vec<u32>) {
    let mut cutter = Cutter::new(soup);
    for &[a, b] in edges {
        cutter.middle_of_edge(a, b);
    }
    let mut origin = Vec::new();
    for (f, face) in (0..).zip(&soup.faces) {
        let sides: Vec<Option<u32>> =
            (0..face.len()).map(|k| cutter.known_middle(face[k], face[(k + 1) % face.len()])).collect();
        let cut: Vec<Vec<u32>> = match sides[..] {
            [Some(e), Some(f), Some(g), Some(h)] => {
                let m = cutter.middle(face);
                let [a, b, c, d] = [0, 1, 2, 3].map(|k: usize| face[k]);
                vec![vec![a, e, m, h], vec![e, b, f, m], vec![m, f, c, g], vec![h, m, g, d]]
            }
            [Some(e), None, Some(g), None] => vec![vec![face[0], e, g, face[3]], vec![e, face[1], face[2], g]],
            [None, Some(f), None, Some(h)] => vec![vec![face[0], face[1], f, h], vec![h, f, face[2], face[3]]],
            _ => vec![face.clone()],
        };
        origin.extend(cut.iter().map(|_| f));
        cutter.new.faces.extend(cut);
    }
    (cutter.new, origin)
}

impl std::fmt::Display for ParityChange {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::TwoToThree { quads: [p, q], edge: [a, b], worst_sine } => write!(
                f,
                "{} and {} become three quads round a vertex in the middle of v{a}-v{b} (worst corner {:.0} degrees off a right angle): 1 quad more",
                QuadId(*p),
                QuadId(*q),
                worst_sine.acos().to_degrees()
            ),
            Self::DoubleChord { quads, added, .. } => write!(
                f,
                "the chord through {} is doubled, each of its quads cut in two along it: {added} quads more",
                shown(quads)
            ),
        }
    }
}

fn shown(quads: &[u32]) -> String {
    let first: Vec<String> = quads.iter().take(6).map(|&q| QuadId(q).to_string()).collect();
    let more = if quads.len() > 6 { format!(" ... ({} passages)", quads.len()) } else { String::new() };
    first.join(" ") + &more
}

#[cfg(test)]
mod tests {
    use super::*;
    use hexfill_geometry::norm;

    /// The surface of n^3 cubes, its vertices moved onto a sphere half of the way.
    fn ball(n: usize) -> Soup {
        let (surface, corners) = hexfill_mesh::generate::voxels([n; 3], |_| true).unwrap();
        let point = |p: [i32; 3]| {
            let x = p.map(|c| 2.0 * f64::from(c) / n as f64 - 1.0);
            x.map(|c| c * (0.5 + 0.5 / norm(x)))
        };
        let faces = surface.quads().iter().map(|q| q.map(|v| v.0).to_vec()).collect();
        Soup { points: corners.into_iter().map(point).collect(), faces }
    }

    #[test]
    fn every_change_of_an_odd_sphere_makes_it_even() {
        for n in 2..5 {
            let even = ball(n);
            let surface = even.surface().unwrap();
            assert!(double_chord(&surface).is_none());
            let mut seen = 0;
            for d in surface.darts() {
                let edge = edge_of(&surface, d);
                let quads = [d.quad().0, surface.twin(d).quad().0];
                let (odd, from) = made_three(&even, quads, edge);
                assert_eq!((odd.faces.len(), from.len()), (even.faces.len() + 1, even.faces.len() + 1));
                let Ok(surface) = odd.surface() else { continue };
                if improper_pairs(&surface).count > 0 {
                    continue;
                }
                seen += 1;
                let changes = parity_changes(&surface, &odd.points);
                assert!(changes.iter().any(|c| matches!(c, ParityChange::DoubleChord { .. })));
                for change in &changes {
                    let (after, from) = changed(&odd, change);
                    let after = after.surface().unwrap();
                    assert!(after.is_sphere() && after.n_quads() % 2 == 0 && from.len() == after.n_quads());
                    assert_eq!(improper_pairs(&after).count, 0);
                    if let ParityChange::DoubleChord { added, .. } = change {
                        assert_eq!(after.n_quads(), odd.faces.len() + added);
                    }
                }
            }
            assert!(seen > 0);
        }
    }
}
