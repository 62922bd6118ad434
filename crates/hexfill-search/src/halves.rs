//! A filling as two halves: cut a sphere along a circuit of its edges, close both sides by a membrane of quads, and fill each from the atlas.
//!
//! Flips and exchanged balls change a filling a few hexes at a time; where all of these lead upward, as on the trapezohedra, a cut still leads to two smaller
//! spheres. The halves meet properly by the same pair table that makes a flip legal: what the membrane joins may not be joined by the sphere already, and
//! what one half joins is blocked for the other.
//!
//! Source: ours.

use crate::atlas::Atlas;
use crate::backward::{Breadth, shorter_way};
use crate::ball::Ball;
use crate::canonical::{Canonical, relabel};
use crate::cavity::{Cavity, Pairs, next};
use crate::grow::class_hash;
use crate::known::Known;
use hexfill_mesh::{Context, HexMesh, QuadSurface};

/// Lengths of circuits, and vertices inside a membrane at most.
const CUTS: [(usize, usize); 5] = [(4, 0), (6, 7), (8, 6), (10, 5), (12, 4)];
/// Fewest quads on each side: less is what flips do.
const FEWEST: usize = 3;
/// Pairs of halves that are put together at most, those with fewest hexes on record first.
const TRIED: usize = 3_000;
/// Of these so many whose second half is searched backward, and how widely.
const SEARCHED: usize = 60;
const BREADTH: Breadth = Breadth { depth: 8, beam: 300, first: false };

/// A membrane: quads that span a circuit `0..length`, counter-clockwise, with vertices inside from `length` on.
type Disc = Vec<[u8; 4]>;

/// A circuit, a membrane, and the hexes on record for the two halves.
struct Cut<'m> {
    hexes: u32,
    circuit: Vec<u8>,
    /// Per quad of the sphere: whether it lies left of the circuit.
    left: u64,
    disc: &'m Disc,
}

/// The membranes by which spheres are cut: quads that span circuits of 4 to 12 edges, with a few vertices inside. To be made once.
#[derive(Clone, Debug)]
pub struct Membranes {
    /// By length of the circuit.
    discs: Vec<(usize, Vec<Disc>)>,
}

impl Default for Membranes {
    fn default() -> Self {
        Self::new(&CUTS)
    }
}

impl Membranes {
    /// Those for circuits of these lengths, each with at most so many vertices inside.
    fn new(cuts: &[(usize, usize)]) -> Self {
        Self { discs: cuts.iter().map(|&(length, inside)| (length, discs(length, inside))).collect() }
    }
}

/// A filling of a sphere with fewer than `limit` hexes that avoids its blocked pairs, from two halves that the atlases know; the vertices of the sphere
/// keep their numbers, others follow. `None` if no such cut was found; a smaller filling may exist. Some seconds for 20 quads.
pub fn two_halves(sphere: &Cavity, limit: u32, atlases: &[&Atlas], membranes: &Membranes) -> Option<HexMesh> {
    let mut cuts = cuts(sphere, limit, atlases, membranes).into_iter().take(TRIED);
    cuts.find_map(|cut| joined(sphere, &cut, limit, atlases, None))
}

/// [`two_halves`], and where two halves have fewer hexes on record than what came of it, the second from a way back to a known state. Half a minute at most;
/// `None` if the work was stopped before anything was found.
pub(crate) fn smallest_halves(
    sphere: &Cavity,
    limit: u32,
    atlases: &[&Atlas],
    membranes: &Membranes,
    known: &Known,
    ctx: &Context<'_>,
) -> Option<HexMesh> {
    let cuts = cuts(sphere, limit, atlases, membranes);
    let mut on_record = cuts.iter().take(TRIED).take_while(|_| ctx.stop().is_none());
    let mut best = on_record.find_map(|cut| joined(sphere, cut, limit, atlases, None));
    for cut in cuts.iter().take(SEARCHED).take_while(|_| ctx.stop().is_none()) {
        let limit = best.as_ref().map_or(limit, |mesh| mesh.n_hexes() as u32);
        if cut.hexes >= limit {
            break;
        }
        best = joined(sphere, cut, limit, atlases, Some((known, ctx))).or(best);
    }
    best
}

/// The cuts whose halves have fewer than `limit` hexes on record, fewest first.
fn cuts<'m>(sphere: &Cavity, limit: u32, atlases: &[&Atlas], membranes: &'m Membranes) -> Vec<Cut<'m>> {
    let mut cuts = Vec::new();
    let pairs = sphere.marked();
    let mut canonical = Canonical::new();
    for (length, discs) in &membranes.discs {
        for circuit in circuits(sphere, *length) {
            let left = left_of(sphere, &circuit);
            let n_left = left.count_ones() as usize;
            if n_left < FEWEST || sphere.n_quads() - n_left < FEWEST {
                continue;
            }
            for disc in discs {
                if !is_free(disc, &circuit, &pairs) {
                    continue;
                }
                let mut on_record = |side: bool| {
                    canonical.compute(&half(sphere, &circuit, left, disc, side)?.0);
                    let class = class_hash(canonical.code());
                    atlases.iter().filter_map(|atlas| atlas.hexes_hint(class)).min()
                };
                let one = on_record(true).filter(|&one| one < limit);
                let Some(hexes) = one.and_then(|one| Some(one + on_record(false)?)) else { continue };
                if hexes < limit {
                    cuts.push(Cut { hexes, circuit: circuit.clone(), left, disc });
                }
            }
        }
    }
    // Stable: circuits and membranes come in a fixed order.
    cuts.sort_by_key(|cut| cut.hexes);
    cuts
}

/// All quadrangulations of a polygon of `length` sides with at most so many vertices inside, without vertices inside of degree 2.
fn discs(length: usize, inside: usize) -> Vec<Disc> {
    /// Fills polygons one after the other; each time the quad at the first side of the last polygon.
    fn fill(mut open: Vec<Vec<u8>>, next: u8, left: usize, quads: &mut Disc, out: &mut Vec<Disc>) {
        let Some(polygon) = open.pop() else { return out.push(quads.clone()) };
        let n = polygon.len();
        let (a, b) = (polygon[0], polygon[1]);
        // The quad is (a, b, x, y), counter-clockwise; x and y on the polygon, or new. A new vertex is as good as another one, so it has one number.
        let mut with = |x: u8, y: u8, rest: Vec<Vec<u8>>, fresh: usize| {
            quads.push([a, b, x, y]);
            let mut open = open.clone();
            open.extend(rest.into_iter().filter(|polygon| polygon.len() > 2));
            fill(open, next + fresh as u8, left - fresh, quads, out);
            quads.pop();
        };
        // What is left are polygons between neighbours of the quad.
        for i in (2..n).filter(|i| i % 2 == 0) {
            for j in (i + 1..n).filter(|j| j % 2 == 1) {
                let rest = vec![polygon[1..=i].to_vec(), polygon[i..=j].to_vec(), wrapped(&polygon, j)];
                with(polygon[i], polygon[j], rest, 0);
            }
            if left >= 1 {
                let mut rest = polygon[i..].to_vec();
                rest.extend([a, next]);
                with(polygon[i], next, vec![polygon[1..=i].to_vec(), rest], 1);
            }
        }
        if left >= 1 {
            for j in (3..n).filter(|j| j % 2 == 1) {
                let mut rest = polygon[1..=j].to_vec();
                rest.push(next);
                with(next, polygon[j], vec![rest, wrapped(&polygon, j)], 1);
            }
        }
        if left >= 2 {
            let mut rest = polygon[1..].to_vec();
            rest.extend([a, next + 1, next]);
            with(next, next + 1, vec![rest], 2);
        }
    }
    /// The polygon from a vertex on round to the first.
    fn wrapped(polygon: &[u8], from: usize) -> Vec<u8> {
        let mut rest = polygon[from..].to_vec();
        rest.push(polygon[0]);
        rest
    }
    let mut all = Vec::new();
    fill(vec![(0..length as u8).collect()], length as u8, inside, &mut Vec::new(), &mut all);
    all.retain(|quads| {
        let degree = |v: u8| quads.iter().filter(|q| q.contains(&v)).count();
        let is_simple = quads.iter().all(|q| (0..4).all(|i| (0..i).all(|j| q[i] != q[j])));
        is_simple && quads.iter().flatten().all(|&v| usize::from(v) < length || degree(v) > 2)
    });
    all
}

/// The simple circuits of `length` edges, each once: from its smallest vertex, towards the smaller neighbour.
fn circuits(sphere: &Cavity, length: usize) -> Vec<Vec<u8>> {
    let mut neighbours = vec![Vec::new(); sphere.n_vertices()];
    for d in 0..4 * sphere.n_quads {
        neighbours[usize::from(sphere.origin[usize::from(d)])].push(sphere.origin[usize::from(next(d))]);
    }
    fn extend(path: &mut Vec<u8>, length: usize, neighbours: &[Vec<u8>], out: &mut Vec<Vec<u8>>) {
        let last = path[path.len() - 1];
        if path.len() == length {
            if neighbours[usize::from(last)].contains(&path[0]) && path[1] < last {
                out.push(path.clone());
            }
            return;
        }
        for &v in &neighbours[usize::from(last)] {
            if v > path[0] && !path.contains(&v) {
                path.push(v);
                extend(path, length, neighbours, out);
                path.pop();
            }
        }
    }
    let mut out = Vec::new();
    for v in 0..sphere.n_vertices {
        extend(&mut vec![v], length, &neighbours, &mut out);
    }
    out
}

/// The quads left of a circuit.
fn left_of(sphere: &Cavity, circuit: &[u8]) -> u64 {
    let n = circuit.len();
    let on = |a: u8, b: u8| (0..n).any(|i| [circuit[i], circuit[(i + 1) % n]] == [a, b]);
    let ends = |d: u8| (sphere.origin[usize::from(d)], sphere.origin[usize::from(next(d))]);
    let mut open: Vec<u8> = (0..4 * sphere.n_quads).filter(|&d| on(ends(d).0, ends(d).1)).map(|d| d / 4).collect();
    let mut left = 0u64;
    while let Some(quad) = open.pop() {
        if left >> quad & 1 == 1 {
            continue;
        }
        left |= 1 << quad;
        for d in 4 * quad..4 * quad + 4 {
            let (a, b) = ends(d);
            if !on(a, b) && !on(b, a) {
                open.push(sphere.twin[usize::from(d)] / 4);
            }
        }
    }
    left
}

/// Whether no pair of the circuit that a membrane joins is joined by the sphere, but for the edges of the circuit.
fn is_free(disc: &Disc, circuit: &[u8], pairs: &Pairs) -> bool {
    let n = circuit.len();
    let on_circuit = |v: u8| usize::from(v) < n;
    disc.iter().all(|q| {
        (0..4).all(|i| {
            (0..i).all(|j| {
                let (a, b) = (q[j].min(q[i]), q[i].max(q[j]));
                let is_side = b - a == 1 || a == 0 && usize::from(b) == n - 1;
                !on_circuit(a)
                    || !on_circuit(b)
                    || is_side
                    || pairs[usize::from(circuit[usize::from(a)])] >> circuit[usize::from(b)] & 1 == 0
            })
        })
    })
}

/// The half on one side, with the membrane, and its vertices in the numbers of the sphere; those inside the membrane follow.
fn half(sphere: &Cavity, circuit: &[u8], left: u64, disc: &Disc, is_left: bool) -> Option<(Cavity, Vec<u32>)> {
    let n = sphere.n_vertices() as u32;
    let of_sphere = sphere.origin[..4 * sphere.n_quads()].chunks_exact(4).enumerate();
    let mut quads: Vec<[u32; 4]> = of_sphere
        .filter(|(quad, _)| (left >> quad & 1 == 1) == is_left)
        .map(|(_, q)| [q[0], q[1], q[2], q[3]].map(u32::from))
        .collect();
    let id = |v: u8| circuit.get(usize::from(v)).map_or(n + u32::from(v) - circuit.len() as u32, |&v| u32::from(v));
    quads.extend(disc.iter().map(|q| {
        let q = q.map(id);
        // The circuit runs round the left side, so the membrane runs against it there.
        if is_left { [q[3], q[2], q[1], q[0]] } else { q }
    }));
    let surface = QuadSurface::try_new((n as usize) + disc.len(), &quads).ok()?;
    let (mut half, ids) = Cavity::from_surface(&surface)?;
    for pair in sphere.blocked_list() {
        if let [Ok(a), Ok(b)] = pair.map(|v| ids.binary_search(&u32::from(v))) {
            half.block(a as u8, b as u8);
        }
    }
    Some((half, ids))
}

/// Both halves filled and put together with fewer than `limit` hexes, if what one uses leaves a filling of the other: one on record, or one that a way back from
/// it leads to.
fn joined(
    sphere: &Cavity,
    cut: &Cut<'_>,
    limit: u32,
    atlases: &[&Atlas],
    known: Option<(&Known, &Context<'_>)>,
) -> Option<HexMesh> {
    let disc = cut.disc;
    for first_side in [true, false] {
        let (mut first, first_ids) = half(sphere, &cut.circuit, cut.left, disc, first_side)?;
        let (mut second, second_ids) = half(sphere, &cut.circuit, cut.left, disc, !first_side)?;
        block_shared(&mut first, &first_ids, &second.surface_pairs(), &second_ids);
        let Some((ball, map, mirrored)) = best_fit(atlases, &first, limit) else { continue };
        // From here on `first` blocks what its filling uses.
        first.blocked = relabel(&ball.boundary.blocked, first.n_vertices(), &map);
        block_shared(&mut second, &second_ids, &first.marked(), &first_ids);
        let n_first = ball.n_hexes() as u32;
        let spare = limit.saturating_sub(n_first);
        let on_record = || best_fit(atlases, &second, spare.saturating_sub(1)).map(|fit| placed(&fit, &second));
        let by_way = |(known, ctx): (&Known, &Context<'_>)| {
            let mesh = shorter_way(&second, spare, known, &BREADTH, ctx)?.filling(known)?;
            Some((mesh.hexes_raw(), mesh.n_vertices() as u32 - second.n_vertices() as u32))
        };
        let Some(other) = known.map_or_else(on_record, by_way) else { continue };
        let n = (sphere.n_quads() + 2 + inside(disc, cut.circuit.len())) as u32;
        let (mut n_vertices, mut hexes) = (n, Vec::new());
        for ((part, fresh), ids) in [(placed(&(ball, map, mirrored), &first), &first_ids), (other, &second_ids)] {
            // What is inside a half follows its surface.
            let id = |v: u32| ids.get(v as usize).copied().unwrap_or(n_vertices + v - ids.len() as u32);
            hexes.extend(part.iter().map(|hex| hex.map(id)));
            n_vertices += fresh;
        }
        return HexMesh::try_new(n_vertices as usize, &hexes).ok();
    }
    None
}

/// The hexes of a ball in the numbers of the half it fits, those of its interior following, and how many these are.
fn placed((ball, map, mirrored): &(Ball, Vec<u8>, bool), half: &Cavity) -> (Vec<[u32; 8]>, u32) {
    let ids: Vec<u32> = map.iter().map(|&v| u32::from(v)).collect();
    ball.hexes_in(&ids, *mirrored, half.n_vertices() as u32)
}

/// The smallest filling on record in any of the atlases.
fn best_fit(atlases: &[&Atlas], half: &Cavity, limit: u32) -> Option<(Ball, Vec<u8>, bool)> {
    atlases.iter().filter_map(|atlas| atlas.best_fit(half, limit)).min_by_key(|(ball, ..)| ball.n_hexes())
}

/// Number of vertices inside a membrane.
fn inside(disc: &Disc, length: usize) -> usize {
    disc.iter().flatten().map(|&v| (usize::from(v) + 1).saturating_sub(length)).max().unwrap_or(0)
}

/// Blocks in `cavity` the pairs that the other side uses, unless they are its own as well: those of the membrane.
fn block_shared(cavity: &mut Cavity, ids: &[u32], used: &Pairs, other_ids: &[u32]) {
    let own = cavity.surface_pairs();
    let there: Vec<Option<usize>> = ids.iter().map(|v| other_ids.binary_search(v).ok()).collect();
    for a in 0..ids.len() {
        for b in 0..a {
            if let (Some(x), Some(y)) = (there[a], there[b])
                && used[x] >> y & 1 == 1
                && own[a] >> b & 1 == 0
            {
                cavity.block(a as u8, b as u8);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hexfill_check::{Judged, Level, Options, judge};
    use hexfill_mesh::generate::{cube_surface, random_sphere, voxel_surface};

    fn filled(surface: &QuadSurface, limit: u32, membranes: &Membranes) -> Option<usize> {
        let (sphere, _) = Cavity::from_surface(surface).unwrap();
        Some(judged(&sphere, &two_halves(&sphere, limit, &[Atlas::fewest()], membranes)?))
    }

    /// The hexes of a filling of the sphere, judged.
    fn judged(sphere: &Cavity, mesh: &HexMesh) -> usize {
        let quads: Vec<[u32; 4]> = sphere.quads().iter().map(|q| q.map(u32::from)).collect();
        let hexes = mesh.hexes_raw();
        let judged = Judged::connectivity(mesh.n_vertices(), &hexes).with_surface(&quads);
        let report = judge(&judged, &Options::default().with_up_to(Level::L3), &Context::default());
        assert!(report.passed(Level::L3), "{report}");
        hexes.len()
    }

    /// Two vertices with `n` quads round each.
    fn trapezohedron(n: u32) -> QuadSurface {
        let (a, b) = (|i: u32| 2 + 2 * (i % n), |i: u32| 3 + 2 * (i % n));
        let quads: Vec<[u32; 4]> =
            (0..n).flat_map(|i| [[0, a(i), b(i), a(i + 1)], [1, b(i + 1), a(i + 1), b(i)]]).collect();
        QuadSurface::try_new(2 * n as usize + 2, &quads).unwrap()
    }

    #[test]
    fn membranes_are_counted() {
        // Without vertices inside: the ternary trees. One vertex inside a hexagon: three quads round it, two ways.
        assert_eq!([4, 6, 8].map(|n| discs(n, 0).len()), [1, 3, 12]);
        assert_eq!(discs(6, 1).len() - 3, 2);
        for disc in discs(8, 2) {
            assert_eq!(disc.len(), 3 + inside(&disc, 8));
        }
    }

    #[test]
    fn circuits_of_the_cube_are_counted() {
        let (cube, _) = Cavity::from_surface(&cube_surface()).unwrap();
        assert_eq!([4, 6, 8].map(|n| circuits(&cube, n).len()), [6, 16, 6]);
        for circuit in circuits(&cube, 6) {
            assert!([2, 3, 4].contains(&left_of(&cube, &circuit).count_ones()));
        }
    }

    #[test]
    fn what_is_cut_is_put_together_properly() {
        let membranes = Membranes::new(&[(4, 0), (6, 3), (8, 5)]);
        let row = voxel_surface([4, 1, 1], |_| true).unwrap();
        assert_eq!(filled(&row, 5, &membranes), Some(4));
        assert_eq!(filled(&row, 4, &membranes), None);
        // One chord, which flips and exchanged balls do not get below 150 hexes.
        assert_eq!(filled(&trapezohedron(9), 73, &membranes), Some(71));
        let found = (0..12).filter_map(|seed| filled(&random_sphere(14, seed).unwrap(), 200, &membranes));
        assert!(found.count() > 6);
    }
    #[test]
    fn a_way_back_gives_the_second_half_what_no_record_does() {
        let membranes = Membranes::new(&[(6, 3)]);
        // Few states: nothing on record avoids much.
        let atlas = Atlas::fewest().pruned(1, |quads, hexes| quads <= 16 && hexes < 45);
        let known = Known::from_atlas(&atlas).unwrap();
        let (mut fewer, mut found) = (0, 0);
        for seed in 0..4 {
            let (sphere, _) = Cavity::from_surface(&random_sphere(18, seed).unwrap()).unwrap();
            let plain = two_halves(&sphere, 200, &[&atlas], &membranes).map(|mesh| judged(&sphere, &mesh));
            let by_ways = smallest_halves(&sphere, 200, &[&atlas], &membranes, &known, &Context::default());
            let by_ways = by_ways.map(|mesh| judged(&sphere, &mesh));
            assert!(by_ways.is_some() || plain.is_none());
            assert!(by_ways <= plain || plain.is_none(), "{by_ways:?} {plain:?}");
            found += usize::from(by_ways.is_some());
            fewer += usize::from(by_ways.is_some() && (plain.is_none() || by_ways < plain));
        }
        assert!(found > 2 && fewer > 1, "{found} {fewer}");
    }
}
