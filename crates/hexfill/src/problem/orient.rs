//! Which way the quads of a surface face.
//!
//! Source: ours.

use crate::problem::solids::depths;
use hexfill_geometry::{cone, sub};
use hexfill_mesh::{QuadId, QuadSurface, VertexId};

/// Turns every component whose quads face into the solid: outer boundaries outward, boundaries of cavities inward.
/// Returns how many were turned.
pub(super) fn face_outward(surface: &mut QuadSurface, points: &[[f64; 3]]) -> usize {
    let depths = depths(surface, points);
    let volumes = enclosed_volumes(surface, points);
    // An outer component faces out, a cavity into the hole, which is out of the solid too: signs alternate with
    // depth.
    let wrong: Vec<bool> = depths
        .iter()
        .zip(volumes)
        .map(|(depth, volume)| if depth.is_multiple_of(2) { volume < 0.0 } else { volume > 0.0 })
        .collect();
    let turned = wrong.iter().filter(|&&w| w).count();
    if turned > 0 {
        let quads: Vec<[u32; 4]> = surface
            .quads()
            .iter()
            .enumerate()
            .map(|(q, quad)| {
                let [a, b, c, d] = quad.map(|v| v.0);
                if wrong[surface.component(QuadId::new(q))] { [a, d, c, b] } else { [a, b, c, d] }
            })
            .collect();
        *surface = QuadSurface::try_new(surface.n_vertices(), &quads).expect("turning a component keeps a surface");
    }
    turned
}

/// A multiple of the volume each component encloses, its quads cut along both diagonals; positive if they face outward.
/// Only the sign is used. Positions are scaled first, so that no finite input overflows.
fn enclosed_volumes(surface: &QuadSurface, points: &[[f64; 3]]) -> Vec<f64> {
    let largest = points.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
    let scale = if largest > 0.0 { largest } else { 1.0 };
    let at = |v: VertexId| points[v.index()].map(|x| x / scale);
    let mut origin = vec![None; surface.n_components()];
    let mut volume = vec![0.0; surface.n_components()];
    for (q, quad) in surface.quads().iter().enumerate() {
        let component = surface.component(QuadId::new(q));
        let quad = quad.map(at);
        let origin = *origin[component].get_or_insert(quad[0]);
        let [a, b, c, d] = quad.map(|p| sub(p, origin));
        // Both ways to cut a bent quad, so that the answer does not depend on where its list begins.
        volume[component] += cone([a, b, c, d]) + cone([b, c, d, a]);
    }
    volume
}
