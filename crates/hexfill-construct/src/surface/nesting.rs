//! Which components of a surface bound the same solid: an outer one and the cavities right inside it.
//!
//! A component lies inside another iff the other winds round one of its vertices ([`holders`]). At even depth it is the outside
//! of a solid, at odd depth a cavity of the solid round it; outsides must face outward (positive volume), cavities the other way.
//!
//! Source: van Oosterom, Strackee 1983 (winding numbers); levels by parity are ours.

use crate::missing::MissingInterior;
use hexfill_geometry::{Vector, det, holders, sub};
use hexfill_mesh::VertexId;

/// The solids as lists of components, the outside first; ascending by outside. `component[t]` is that of triangle `t`.
///
/// # Errors
/// A component that faces the wrong way for its depth, or lies in no solid.
pub(crate) fn solids(
    triangles: &[[VertexId; 3]],
    component: &[usize],
    n_components: usize,
    points: &[Vector],
) -> Result<Vec<Vec<usize>>, MissingInterior> {
    let mut parts: Vec<Vec<[Vector; 3]>> = vec![Vec::new(); n_components];
    for (t, &c) in triangles.iter().zip(component) {
        parts[c].push(t.map(|v| points[v.index()]));
    }
    // From a corner of its own: far from the origin the products would lose the digits that decide the sign.
    let volume = |part: &[[Vector; 3]]| -> f64 {
        let from_origin = part.iter().map(|t| t.map(|p| sub(p, part[0][0])));
        from_origin.map(|[a, b, c]| det(a, b, c)).sum()
    };
    let around = holders(&parts);
    let mut solids: Vec<Vec<usize>> = Vec::new();
    let mut solid_of = vec![usize::MAX; n_components];
    for c in (0..n_components).filter(|&c| around[c].len().is_multiple_of(2)) {
        if volume(&parts[c]) <= 0.0 {
            return Err(MissingInterior::OutsideFacesInward { component: c });
        }
        solid_of[c] = solids.len();
        solids.push(vec![c]);
    }
    // Second pass: a cavity may have a smaller number than the solid it is in.
    for c in (0..n_components).filter(|&c| !around[c].len().is_multiple_of(2)) {
        if volume(&parts[c]) >= 0.0 {
            return Err(MissingInterior::CavityFacesOutward { component: c });
        }
        // The innermost component around it.
        let outside = around[c].iter().copied().max_by_key(|&o| around[o].len());
        match outside.map(|o| solid_of[o]).filter(|&s| s != usize::MAX) {
            Some(s) => solids[s].push(c),
            None => return Err(MissingInterior::InNoSolid { component: c }),
        }
    }
    Ok(solids)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cube of half side `r` about (x, 0, 0), outward or inward.
    fn cube(x: f64, r: f64, outward: bool, points: &mut Vec<Vector>, triangles: &mut Vec<[VertexId; 3]>) {
        use hexfill_mesh::cube::{FACETS, POSITIONS};
        let first = points.len();
        points.extend(POSITIONS.map(|p| {
            let at = |k: usize| r * (2.0 * f64::from(p[k]) - 1.0);
            [x + at(0), at(1), at(2)]
        }));
        for f in FACETS {
            let [a, b, c, d] = f.map(|k| VertexId::new(first + k));
            for t in [[a, b, c], [a, c, d]] {
                triangles.push(if outward { t } else { [t[0], t[2], t[1]] });
            }
        }
    }

    #[test]
    fn nested_and_apart() {
        let (mut points, mut triangles) = (Vec::new(), Vec::new());
        // A cavity, its outside, an island in the cavity, another solid, a cavity of the island.
        let all = [(0.0, 4.0, false), (0.0, 5.0, true), (0.5, 2.0, true), (20.0, 1.0, true), (0.0, 1.0, false)];
        for (x, r, outward) in all {
            cube(x, r, outward, &mut points, &mut triangles);
        }
        let component: Vec<usize> = (0..triangles.len()).map(|t| t / 12).collect();
        assert_eq!(solids(&triangles, &component, 5, &points).unwrap(), [vec![1, 0], vec![2, 4], vec![3]]);
        let flipped: Vec<[VertexId; 3]> = triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
        assert!(solids(&flipped, &component, 5, &points).is_err());
    }
}
