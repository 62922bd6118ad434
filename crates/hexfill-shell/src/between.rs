//! Hollow solids whose inner boundary is a copy of the outer one: layers from one to the other.
//!
//! Idea: pillows copy a surface, so where the front of some pillows is a mirror image of a cavity it can be closed onto it, whatever the
//! genus. Of all ways to lay the one component on the other (an isomorphism is told by the image of one dart) the one with the shortest columns is
//! taken; the number of layers is their mean length in edges.
//!
//! Invariant: with one vertex of the outer component, level 0, every column has a new vertex on each level and one of the cavity on the last.
//!
//! Source: ours.

use crate::front::{Front, NONE};
use hexfill_geometry::{Vector, cone, dot, sub};
use hexfill_mesh::{Dart, QuadSurface};

/// More hexes than this are not made.
const MOST_HEXES: usize = 4_000_000;
/// Images of the first dart that are tried, the nearest ones.
const MOST_IMAGES: usize = 400;

fn square_distance(a: Vector, b: Vector) -> f64 {
    dot(sub(a, b), sub(a, b))
}

/// The hexes between two components that are mirror images, vertices of the surface first; `None` if they are not.
pub(crate) fn between(surface: &QuadSurface, points: &[[f64; 3]]) -> Option<Vec<[u32; 8]>> {
    let of = |q: u32| surface.component(hexfill_mesh::QuadId(q));
    let quads = 0..surface.n_quads() as u32;
    let mut sides = [0, 1].map(|c| quads.clone().filter(|&q| of(q) == c).collect::<Vec<u32>>());
    if surface.n_components() != 2 || sides[0].len() != sides[1].len() {
        return None;
    }
    let volume = |side: &[u32]| -> f64 {
        let corners = |q: u32| surface.quads()[q as usize].map(|v| points[v.index()]);
        side.iter().map(|&q| cone(corners(q))).sum()
    };
    let mut volumes = [volume(&sides[0]), volume(&sides[1])];
    if volumes[0] < volumes[1] {
        sides.swap(0, 1);
        volumes.swap(0, 1);
    }
    if volumes[0] <= 0.0 || volumes[1] >= 0.0 {
        return None;
    }
    let first = Dart(4 * sides[0][0]);
    let from = points[surface.origin(first).index()];
    let mut images: Vec<(f64, u32)> = sides[1]
        .iter()
        .flat_map(|&q| 4 * q..4 * q + 4)
        .map(|d| (square_distance(from, points[surface.target(Dart(d)).index()]), d))
        .collect();
    images.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let mut best: Option<(f64, Vec<u32>)> = None;
    for &(_, d) in images.iter().take(MOST_IMAGES) {
        // One pair of darts tells the whole image, since the surface is connected: an isomorphism is tried in linear
        // time, nearest first.
        let Some(image) = mirrored(surface, first, Dart(d)) else { continue };
        let sum = (0..).zip(&image).filter(|(_, w)| **w != NONE);
        let sum: f64 = sum.map(|(v, &w): (usize, _)| square_distance(points[v], points[w as usize])).sum();
        if sum.is_finite() && best.as_ref().is_none_or(|(least, _)| sum < *least) {
            best = Some((sum, image));
        }
    }
    let (_, image) = best?;
    let columns: Vec<(usize, u32)> = (0..).zip(image.iter().copied()).filter(|&(_, w)| w != NONE).collect();
    let long = columns.iter().map(|&(v, w)| square_distance(points[v], points[w as usize]).sqrt()).sum::<f64>();
    let edges = surface
        .darts()
        .map(|d| square_distance(points[surface.origin(d).index()], points[surface.target(d).index()]).sqrt());
    let edge = edges.sum::<f64>() / (4 * surface.n_quads()) as f64;
    let ratio = long / columns.len() as f64 / edge;
    // Many thin layers are nobody's wish: the count is bounded by that of a cube.
    let layers = if ratio.is_finite() { (ratio.round() as u32).clamp(1, surface.n_quads() as u32) } else { 1 };
    if layers as usize * sides[0].len() > MOST_HEXES {
        return None;
    }
    let mut rank = vec![0; surface.n_vertices()];
    columns.iter().enumerate().for_each(|(i, &(v, _))| rank[v] = i as u32);
    let n = surface.n_vertices() as u32;
    let vertex = |v: u32, level: u32| match level {
        0 => v,
        _ if level == layers => image[v as usize],
        _ => n + (level - 1) * columns.len() as u32 + rank[v as usize],
    };
    let mut hexes = Vec::new();
    for level in 0..layers {
        for &q in &sides[0] {
            let [[a, b, c, d], [e, f, g, h]] =
                [level + 1, level].map(|l| surface.quads()[q as usize].map(|v| vertex(v.0, l)));
            hexes.push([a, b, c, d, e, f, g, h]);
        }
    }
    let quads: Vec<[u32; 4]> = surface.quads_raw();
    Front::try_from_parts(n + (layers - 1) * columns.len() as u32, &quads, &hexes, &[]).ok()?;
    Some(hexes)
}

/// The map of vertices that takes the component of one dart to that of the other, mirrored: the origin of `d` goes to the target of `image`.
fn mirrored(surface: &QuadSurface, d: Dart, image: Dart) -> Option<Vec<u32>> {
    let mut of = vec![NONE; surface.n_vertices()];
    let mut dart = vec![NONE; 4 * surface.n_quads()];
    let mut used = vec![false; surface.n_vertices()];
    let mut work = vec![(d, image)];
    while let Some((d, i)) = work.pop() {
        if dart[d.index()] != NONE {
            if dart[d.index()] != i.0 {
                return None;
            }
            continue;
        }
        dart[d.index()] = i.0;
        let (v, w) = (surface.origin(d).index(), surface.target(i));
        if of[v] == NONE && !std::mem::replace(&mut used[w.index()], true) {
            of[v] = w.0;
        }
        if of[v] != w.0 {
            return None;
        }
        work.push((d.next(), i.prev()));
        work.push((surface.twin(d), surface.twin(i)));
    }
    Some(of)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::Swept;
    use crate::test_surfaces::{judged, torus_at};

    #[test]
    fn a_hollow_torus_is_layers() {
        let (torus, points) = torus_at(12, 8);
        let n = points.len() as u32;
        let axis = |p: [f64; 3]| {
            let r = p[0].hypot(p[1]);
            [3.0 * p[0] / r, 3.0 * p[1] / r, 0.0]
        };
        let mut all = points.clone();
        all.extend(points.iter().map(|&p| [0, 1, 2].map(|k| 0.25 * p[k] + 0.75 * axis(p)[k])));
        let mut quads: Vec<[u32; 4]> = torus.quads_raw();
        quads.extend(torus.inverted().quads().iter().map(|q| q.map(|v| v.0 + n)));
        let hollow = QuadSurface::try_new(all.len(), &quads).unwrap();
        let hexes = between(&hollow, &all).unwrap();
        let n_vertices = hexes.iter().flatten().max().unwrap() + 1;
        let swept = Swept { n_vertices, hexes, plugs: 0, front: Vec::new(), stopped: None };
        assert!(judged(&hollow, &swept).is_multiple_of(96));
        assert!(between(&torus, &points).is_none());
    }
}
