//! A sphere of quads laid flat: circles in the plane, one for each vertex, edge and quad, that touch where one lies on the other.
//!
//! The barycentric subdivision of the surface is a triangulation; one vertex of the surface is taken out, and what is left is a disk.
//! Radii are found by relaxation (Collins and Stephenson, A circle packing algorithm, 2003): the angles at inner circles
//! sum to a full turn, those on the rim are all equal. Unlike in Tutte's drawing chords cross nearly at right angles. The disk is
//! then taken for a stereographic projection of the sphere and replaced by something like an equal-area one, which leaves room in the middle.
//!
//! Source: Collins, Stephenson 2003; the map of the disk that follows is ours.

use hexfill_mesh::{Dart, QuadSurface, VertexId};
use std::f64::consts::{PI, TAU};

/// Relaxation ends when no angle sum is off by more than this (radians), or after so many sweeps.
const TOLERANCE: f64 = 1e-10;
const SWEEPS: usize = 20_000;

/// The flat drawing. Seen from outside the surface, so counter-clockwise stays so.
pub(crate) struct Flat {
    /// Centre of the circle of each quad.
    pub quads: Vec<[f64; 2]>,
    /// Centre of the circle of the edge of each dart; twins have the same.
    pub edges: Vec<[f64; 2]>,
    /// Centre of the circle of each vertex; nothing for the outer one and for unused ones.
    pub vertices: Vec<Option<[f64; 2]>>,
}

/// Circles in order round one circle: all the way, or from one end to the other on the rim.
struct Flower {
    petals: Vec<u32>,
    closed: bool,
}

/// Lays a sphere flat, with the whole outside of the disk given to its vertex of highest degree (the first of them). Nothing if it comes
/// out folded: circles along thin tubes shrink by a constant factor a quad, until numbers are too coarse.
///
/// # Panics
/// If `surface` is no sphere.
pub(crate) fn lay_flat(surface: &QuadSurface) -> Option<Flat> {
    assert!(surface.is_sphere(), "only a sphere lies flat");
    let (nodes, edge_of) = flowers(surface);
    let start = (surface.n_quads() + surface.n_edges()) as u32;
    let outer = (0..surface.n_vertices())
        .max_by_key(|&v| (surface.degree(VertexId::new(v)), std::cmp::Reverse(v)))
        .map_or(0, |v| start + v as u32);
    let nodes: Vec<Flower> = nodes.into_iter().map(|f| without(f, outer)).collect();
    let radii = relax(&nodes, outer);
    let mut centres = place(&nodes, &radii, outer);
    if folded(surface, &flat(surface, &edge_of, &centres)) {
        return None;
    }
    spread(&mut centres, &radii, &nodes);
    Some(flat(surface, &edge_of, &centres))
}

/// The centres by what they stand for.
fn flat(surface: &QuadSurface, edge_of: &[u32], centres: &[Option<[f64; 2]>]) -> Flat {
    let at = |i: usize| centres[i].expect("every quad and edge is placed");
    Flat {
        quads: (0..surface.n_quads()).map(at).collect(),
        edges: edge_of.iter().map(|&e| at(e as usize)).collect(),
        vertices: centres[surface.n_quads() + surface.n_edges()..].to_vec(),
    }
}

/// Whether some triangle of vertex, edge and quad does not turn left.
fn folded(surface: &QuadSurface, flat: &Flat) -> bool {
    let turn = |[a, b, c]: [[f64; 2]; 3]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    let left = |triangle: [[f64; 2]; 3]| turn(triangle) > 0.0;
    !surface.darts().all(|d| {
        let (q, e) = (flat.quads[d.quad().index()], flat.edges[d.index()]);
        let [from, to] = [surface.origin(d), surface.target(d)].map(|v| flat.vertices[v.index()]);
        from.is_none_or(|v| left([q, v, e])) && to.is_none_or(|v| left([q, e, v]))
    })
}

/// The circles round each circle, counter-clockwise: quads first, then edges, then vertices; and the edge of each dart.
fn flowers(surface: &QuadSurface) -> (Vec<Flower>, Vec<u32>) {
    let (n_quads, n_edges) = (surface.n_quads() as u32, surface.n_edges() as u32);
    let mut edge_of = vec![u32::MAX; 4 * surface.n_quads()];
    let firsts: Vec<Dart> = surface.darts().filter(|&d| d.index() < surface.twin(d).index()).collect();
    for (e, &d) in firsts.iter().enumerate() {
        edge_of[d.index()] = n_quads + e as u32;
        edge_of[surface.twin(d).index()] = n_quads + e as u32;
    }
    let vertex = |v: VertexId| n_quads + n_edges + v.0;
    let closed = |petals: Vec<u32>| Flower { petals, closed: true };
    let of_quads = (0..surface.n_quads() as u32).map(|q| {
        closed((0..4).map(|s| Dart(4 * q + s)).flat_map(|d| [vertex(surface.origin(d)), edge_of[d.index()]]).collect())
    });
    let of_edges = firsts.iter().map(|&d| {
        closed(vec![vertex(surface.target(d)), d.quad().0, vertex(surface.origin(d)), surface.twin(d).quad().0])
    });
    let of_vertices = surface.dart_of_vertices().into_iter().map(|first| {
        let mut petals: Vec<u32> = first
            .into_iter()
            .flat_map(|d| surface.round_vertex(d))
            // Clockwise, so a dart's quad comes before its edge.
            .flat_map(|d| [d.quad().0, edge_of[d.index()]])
            .collect();
        petals.reverse();
        closed(petals)
    });
    (of_quads.chain(of_edges).chain(of_vertices).collect(), edge_of)
}

/// The flower without the circle `outer`: from behind it round to before it.
fn without(mut flower: Flower, outer: u32) -> Flower {
    if let Some(at) = flower.petals.iter().position(|&p| p == outer) {
        flower.petals.rotate_left(at);
        flower.petals.remove(0);
        flower.closed = false;
    }
    flower
}

/// The angle at a circle of radius `r` between two circles that touch it and each other.
fn angle(r: f64, a: f64, b: f64) -> f64 {
    2.0 * ((a / (r + a)) * (b / (r + b))).sqrt().min(1.0).asin()
}

/// Radii whose angles sum to what is wanted; the one of `outer` means nothing.
fn relax(nodes: &[Flower], outer: u32) -> Vec<f64> {
    let rim = nodes.iter().filter(|f| !f.closed).count() as f64;
    let mut radii = vec![1.0; nodes.len()];
    for _ in 0..SWEEPS {
        let mut worst = 0.0_f64;
        for (i, flower) in nodes.iter().enumerate().filter(|(i, f)| *i != outer as usize && !f.petals.is_empty()) {
            let (r, petals) = (radii[i], &flower.petals);
            let faces = if flower.closed { petals.len() } else { petals.len() - 1 };
            let wanted = if flower.closed { TAU } else { PI - TAU / rim };
            let corner = |k: usize| angle(r, radii[petals[k] as usize], radii[petals[(k + 1) % petals.len()] as usize]);
            let sum: f64 = (0..faces).map(corner).sum();
            worst = worst.max((sum - wanted).abs());
            // The radius that would be right if all petals were of one size.
            let (now, then) = ((sum / (2 * faces) as f64).sin(), (wanted / (2 * faces) as f64).sin());
            radii[i] = r * (now / (1.0 - now)) * ((1.0 - then) / then);
        }
        if worst < TOLERANCE {
            break;
        }
    }
    radii
}

/// Centres of all circles, petal after petal from the smallest circle, so that small ones keep their digits; the scale is that of the radii.
fn place(nodes: &[Flower], radii: &[f64], outer: u32) -> Vec<Option<[f64; 2]>> {
    let mut centres: Vec<Option<[f64; 2]>> = vec![None; nodes.len()];
    let first = (0..nodes.len())
        .filter(|&i| i != outer as usize && !nodes[i].petals.is_empty())
        .min_by(|&a, &b| radii[a].total_cmp(&radii[b]))
        .expect("a sphere has quads");
    let beside = nodes[first].petals[0] as usize;
    centres[first] = Some([0.0, 0.0]);
    centres[beside] = Some([radii[first] + radii[beside], 0.0]);
    let mut queue = std::collections::VecDeque::from([first, beside]);
    while let Some(i) = queue.pop_front() {
        let petals = &nodes[i].petals;
        let n = petals.len();
        let centre = centres[i].expect("circles in the queue are placed");
        let (known, at) = (0..n)
            .find_map(|k| centres[petals[k] as usize].map(|p| (k, p)))
            .expect("a circle in the queue was placed beside another");
        let from = (at[1] - centre[1]).atan2(at[0] - centre[0]);
        let corner = |k: usize| angle(radii[i], radii[petals[k % n] as usize], radii[petals[(k + 1) % n] as usize]);
        let last = if nodes[i].closed { known + n - 1 } else { n - 1 };
        let mut turned = Vec::with_capacity(n);
        (known..last).fold(from, |a, k| {
            turned.push(((k + 1) % n, a + corner(k)));
            a + corner(k)
        });
        if !nodes[i].closed {
            (0..known).rev().fold(from, |a, k| {
                turned.push((k, a - corner(k)));
                a - corner(k)
            });
        }
        for (k, a) in turned {
            let p = petals[k] as usize;
            if centres[p].is_none() {
                let distance = radii[i] + radii[p];
                centres[p] = Some([centre[0] + distance * a.cos(), centre[1] + distance * a.sin()]);
                queue.push_back(p);
            }
        }
    }
    centres
}

/// Moves circles outwards until they fill the disk evenly, each in its direction from the middle; turned so that the top lies
/// between two edges of the outer vertex.
fn spread(centres: &mut [Option<[f64; 2]>], radii: &[f64], nodes: &[Flower]) {
    // Where the circles are small.
    let weight = |r: f64| 1.0 / (r * r);
    let placed = || centres.iter().zip(radii).filter_map(|(p, &r)| Some(((*p)?, weight(r))));
    let all: f64 = placed().map(|(_, w)| w).sum();
    let middle = [0, 1].map(|k| placed().map(|(p, w)| w * p[k]).sum::<f64>() / all);
    let from_middle = |p: &[f64; 2]| [p[0] - middle[0], p[1] - middle[1]];
    // Squares of the distances from the middle.
    let squares: Vec<f64> = centres.iter().flatten().map(|p| from_middle(p).map(|x| x * x).iter().sum()).collect();
    // Near the share of circles that are nearer, but smooth: each circle is seen as the equator of a sphere, and this is the part of that
    // sphere within the distance, as in the equal-area projection.
    let part = |square: f64, s: f64| square / (square + s).max(f64::MIN_POSITIVE);
    let share = |square: f64| {
        let sum: f64 = squares.iter().map(|&s| part(square, s)).sum();
        // Without the circle itself: the middle stays where it is.
        ((sum - part(square, square)) / squares.len() as f64).max(0.0)
    };
    // The rim is quads and edges in turn; a quad is at the top.
    let top = (0..nodes.len()).find(|&i| !nodes[i].closed).and_then(|i| centres[i]).map_or(0.0, |p| {
        let [x, y] = from_middle(&p);
        y.atan2(x)
    });
    for (p, &square) in centres.iter_mut().flatten().zip(&squares) {
        let [x, y] = from_middle(p);
        let (far, turn) = (share(square).sqrt(), y.atan2(x) - top + PI / 2.0);
        *p = [far * turn.cos(), far * turn.sin()];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hexfill_mesh::generate::all_spheres;

    #[test]
    fn every_small_sphere_lies_flat() {
        for surface in (6..=12).flat_map(all_spheres) {
            let flat = lay_flat(&surface).expect("no folds");
            assert!(surface.darts().all(|d| flat.edges[d.index()] == flat.edges[surface.twin(d).index()]));
            assert_eq!(flat.vertices.iter().filter(|v| v.is_none()).count(), 1);
        }
    }

    #[test]
    fn a_tube_too_long_for_the_numbers_is_no_picture() {
        // Rings of four quads between two squares.
        let tube = |rings: u32| {
            let side = |r: u32, i: u32| [4 * r + i, 4 * r + (i + 1) % 4, 4 * r + 4 + (i + 1) % 4, 4 * r + 4 + i];
            let mut quads: Vec<[u32; 4]> = (0..rings).flat_map(|r| (0..4).map(move |i| side(r, i))).collect();
            quads.extend([[3, 2, 1, 0], [0, 1, 2, 3].map(|i| 4 * rings + i)]);
            QuadSurface::try_new(4 * rings as usize + 4, &quads).unwrap()
        };
        assert!(lay_flat(&tube(8)).is_some());
        assert!(lay_flat(&tube(200)).is_none());
    }
}
