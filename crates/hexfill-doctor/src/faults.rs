//! Faces and points that are wrong by themselves, each in linear time or by one sort.
//!
//! Source: ours.

use crate::soup::Soup;
use hexfill_geometry::{Vector, cross, dot, norm, sub};

/// The faces that use a point twice, or have fewer than three sides.
pub fn degenerate_faces(soup: &Soup) -> Vec<u32> {
    (0..).zip(&soup.faces).filter(|(_, face)| is_degenerate(face)).map(|(f, _)| f).collect()
}

pub(crate) fn is_degenerate(face: &[u32]) -> bool {
    let mut sorted = face.to_vec();
    sorted.sort_unstable();
    face.len() < 3 || sorted.windows(2).any(|w| w[0] == w[1])
}

/// The faces with the same points as an earlier one.
pub fn repeated_faces(soup: &Soup) -> Vec<u32> {
    let mut named: Vec<(Vec<u32>, u32)> = (0..)
        .zip(&soup.faces)
        .map(|(f, face)| {
            let mut sorted = face.clone();
            sorted.sort_unstable();
            (sorted, f)
        })
        .collect();
    named.sort_unstable();
    let mut repeated: Vec<u32> = named.windows(2).filter(|w| w[0].0 == w[1].0).map(|w| w[1].1).collect();
    repeated.sort_unstable();
    repeated
}

/// The points that no face uses.
pub fn unused_points(soup: &Soup) -> Vec<u32> {
    let mut used = vec![false; soup.n_points()];
    soup.faces.iter().flatten().for_each(|&v| used[v as usize] = true);
    (0..).zip(used).filter(|(_, used)| !used).map(|(v, _)| v).collect()
}

/// The points with a coordinate that is no number or infinite.
pub fn points_not_finite(soup: &Soup) -> Vec<u32> {
    (0..).zip(&soup.points).filter(|(_, p)| !p.iter().all(|x| x.is_finite())).map(|(v, _)| v).collect()
}

/// The points at the very place of an earlier one that faces use too: seams of a file that repeats them.
pub fn coincident_points(soup: &Soup) -> Vec<u32> {
    let mut used = vec![false; soup.n_points()];
    soup.faces.iter().flatten().for_each(|&v| used[v as usize] = true);
    // Adding zero: -0 and 0 are the same place.
    let place = |v: u32| soup.points[v as usize].map(|x| (x + 0.0).to_bits());
    let mut order: Vec<u32> = (0..soup.points.len() as u32).filter(|&v| used[v as usize]).collect();
    order.sort_unstable_by_key(|&v| (place(v), v));
    let mut later: Vec<u32> = order.windows(2).filter(|w| place(w[0]) == place(w[1])).map(|w| w[1]).collect();
    later.sort_unstable();
    later
}

/// A quad is called a sliver if its area is less than this share of the square of its longest side.
const SLIVER: f64 = 1e-3;

/// Quads of next to no area for their size, and quads with a corner that is reflex or straight (no hex on such a quad has a positive Jacobian everywhere).
pub fn slivers_and_reflex(soup: &Soup) -> (Vec<u32>, Vec<u32>) {
    let (mut slivers, mut reflex) = (Vec::new(), Vec::new());
    for (f, _) in soup.quads().filter(|(_, quad)| !is_degenerate(quad)) {
        let Some(at) = soup.at(f) else { continue };
        let longest = (0..4).map(|k| norm(sub(at[(k + 1) % 4], at[k]))).fold(0.0, f64::max);
        if longest.is_nan() || longest.is_infinite() {
            continue;
        }
        // About as large as one, so that nothing overflows.
        let at: Vec<Vector> = at.iter().map(|p| sub(*p, at[0]).map(|x| x / longest)).collect();
        let corner = |k: usize| cross(sub(at[(k + 1) % 4], at[k]), sub(at[(k + 3) % 4], at[k]));
        let normal = cross(sub(at[2], at[0]), sub(at[3], at[1]));
        // Half the cross product of the diagonals: also 0 if all corners lie in one place (0 / 0).
        if longest == 0.0 || 0.5 * norm(normal) < SLIVER {
            slivers.push(f as u32);
        } else if (0..4).any(|k| dot(corner(k), normal) <= 1e-12 * dot(normal, normal)) {
            reflex.push(f as u32);
        }
    }
    (slivers, reflex)
}
