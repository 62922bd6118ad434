//! Surfaces of several components: which lies inside which. A solid is a component that faces outward with the cavities in it; an island in a
//! cavity is a solid of its own.
//!
//! Source: ours.

use hexfill_geometry::halves;
use hexfill_mesh::{QuadId, QuadSurface, VertexId};

/// Which other components each component lies in: an even number for an outer boundary, an odd one for the boundary of a cavity. Exact for
/// disjoint closed surfaces; surfaces that cross lie apart, as a rule.
fn holders(surface: &QuadSurface, points: &[[f64; 3]]) -> Vec<Vec<usize>> {
    let mut triangles: Vec<Vec<[[f64; 3]; 3]>> = vec![Vec::new(); surface.n_components()];
    for (q, quad) in surface.quads().iter().enumerate() {
        triangles[surface.component(QuadId::new(q))].extend(halves(quad.map(|v| points[v.index()])));
    }
    hexfill_geometry::holders(&triangles)
}

/// How many other components each component lies in: 0 for an outer boundary, 1 for the boundary of a cavity, 2 for an
/// island in a cavity, and so on.
pub(crate) fn depths(surface: &QuadSurface, points: &[[f64; 3]]) -> Vec<u32> {
    holders(surface, points).iter().map(|h| h.len() as u32).collect()
}

/// The components of each solid, its outer boundary first. Without positions all components lie apart.
pub(crate) fn solids(surface: &QuadSurface, points: Option<&[[f64; 3]]>) -> Vec<Vec<usize>> {
    let n = surface.n_components();
    let Some(points) = points.filter(|_| n > 1) else { return (0..n).map(|c| vec![c]).collect() };
    let holders = holders(surface, points);
    let mut solids: Vec<Vec<usize>> = (0..n).filter(|&c| holders[c].len().is_multiple_of(2)).map(|c| vec![c]).collect();
    for c in (0..n).filter(|&c| holders[c].len() % 2 == 1) {
        let owner = holders[c].iter().find(|&&h| holders[h].len() + 1 == holders[c].len());
        match owner.and_then(|o| solids.iter_mut().find(|s| s[0] == *o)) {
            Some(solid) => solid.push(c),
            // Surfaces that cross: each for itself.
            None => solids.push(vec![c]),
        }
    }
    solids
}

/// Some components as a surface of their own: with the map to the old vertex ids.
pub(crate) fn part(surface: &QuadSurface, components: &[usize]) -> (QuadSurface, Vec<VertexId>) {
    let quads = (0..).zip(surface.quads()).filter(|(q, _)| components.contains(&surface.component(QuadId::new(*q))));
    let quads = quads.map(|(_, quad)| quad.map(|v| v.0)).collect();
    QuadSurface::on_own_vertices(quads).expect("components of a surface are a surface")
}
