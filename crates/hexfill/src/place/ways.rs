//! The ways a mesh can lie on its surface.
//!
//! A surface may have symmetries that its positions lack: Schneiders' pyramid can change its apex for the middle of its base.
//! Each of them carries a filling to another one, isomorphic as a mesh, with other coordinates: the scaled Jacobian of one
//! pyramid of 44 hexes is at most 0 one way and reaches 0.396 the other. Two ways are the same if an automorphism of the mesh
//! and a congruence of the positions carry one to the other (double cosets).
//!
//! Source: ours.

use hexfill_embed::star_bounds;
use hexfill_geometry::{norm, sub};
use hexfill_mesh::{
    HexMesh, QuadSurface, SurfaceAutomorphism, VertexId, hex_automorphisms, hex_symmetry_order, surface_automorphisms,
    surface_symmetry_order,
};
use std::collections::BTreeSet;

/// Surfaces with more symmetries are taken as they are.
const MOST_SYMMETRIES: u128 = 200;

/// Positions that agree so far, relative to the size of the surface, are congruent.
const TOLERANCE: f64 = 1e-9;

/// A mesh on its surface.
#[derive(Clone, Debug)]
pub(crate) struct Placement {
    /// The mesh; its boundary is the surface.
    pub(crate) mesh: HexMesh,
    /// No coordinates of the interior have a larger worst scaled Jacobian.
    pub(crate) upper_bound: f64,
}

/// All ways to lay a mesh on its boundary `surface`, the most promising first; the mesh as it is first among equals.
/// Only that one if the surface is large or has no symmetries of its own, or if its positions have all of them.
pub(crate) fn placements(mesh: &HexMesh, surface: &QuadSurface, points: &[[f64; 3]]) -> Vec<Placement> {
    let as_it_is = || vec![Placement { mesh: mesh.clone(), upper_bound: f64::INFINITY }];
    let few = |order: u128| order <= MOST_SYMMETRIES;
    if surface.n_components() != 1 || !few(surface_symmetry_order(surface)) || !hex_symmetry_order(mesh).is_ok_and(few)
    {
        return as_it_is();
    }
    let turns = surface_automorphisms(surface);
    let congruences: Vec<&SurfaceAutomorphism> = turns.iter().filter(|t| is_congruence(t, points)).collect();
    // Every symmetry of the surface is one of its positions, too: all ways to lie on it are congruent.
    if congruences.len() == turns.len() {
        return as_it_is();
    }
    let n = surface.n_vertices();
    let symmetries = hex_automorphisms(mesh).unwrap_or_default();
    let mut seen: BTreeSet<Vec<VertexId>> = BTreeSet::new();
    let mut all = Vec::new();
    for turn in &turns {
        if seen.contains(&turn.vertices) {
            continue;
        }
        for congruence in &congruences {
            for symmetry in &symmetries {
                let image = |v: usize| congruence.vertices[turn.vertices[symmetry.vertices[v].index()].index()];
                // Ways that differ by a symmetry of the mesh or a congruence of the points have the same embeddings:
                // one of each double coset is tried.
                seen.insert((0..n).map(image).collect());
            }
        }
        // Ranked by what stars allow and not by embedding each: the bound costs a moment, and where it is 0 no
        // embedding can be valid.
        let mesh = turned(mesh, turn);
        let least = |bounds: Vec<hexfill_embed::StarBound>| bounds.iter().fold(f64::INFINITY, |m, b| m.min(b.bound));
        let upper_bound = star_bounds(&mesh, points).map_or(f64::NEG_INFINITY, least);
        all.push(Placement { mesh, upper_bound });
    }
    // Stable: the identity was first.
    all.sort_by(|a, b| b.upper_bound.total_cmp(&a.upper_bound));
    all
}

/// Whether the positions have this symmetry: all distances stay.
fn is_congruence(turn: &SurfaceAutomorphism, points: &[[f64; 3]]) -> bool {
    let n = turn.vertices.len().min(points.len());
    let largest = points.iter().flatten().fold(f64::MIN_POSITIVE, |m, x| m.max(x.abs()));
    let at = |v: usize| points[v].map(|x| x / largest);
    let distance = |v: usize, w: usize| norm(sub(at(v), at(w)));
    let image = |v: usize| turn.vertices[v].index();
    // All distances, as that is what an isometry keeps; reflections count, since a mirrored mesh embeds as well.
    // Surfaces with symmetries to ask about are small.
    (0..n).all(|v| (0..v).all(|w| (distance(v, w) - distance(image(v), image(w))).abs() <= TOLERANCE))
}

/// The mesh with its boundary vertices moved along the surface; a reflection mirrors the hexes.
fn turned(mesh: &HexMesh, turn: &SurfaceAutomorphism) -> HexMesh {
    let moved = |v: u32| turn.vertices.get(v as usize).map_or(v, |w| w.0);
    let hexes: Vec<[u32; 8]> = mesh
        .hexes_raw()
        .into_iter()
        .map(|hex| {
            let hex = hex.map(moved);
            if turn.reflection { [0, 3, 2, 1, 4, 7, 6, 5].map(|k: usize| hex[k]) } else { hex }
        })
        .collect();
    HexMesh::try_new(mesh.n_vertices(), &hexes).expect("an isomorphic copy of a mesh is one")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{FillOptions, Problem, fill};
    use hexfill_mesh::{Context, hex_signature};

    #[test]
    fn the_pyramid_lies_two_ways_and_the_canonical_polyhedron_one() {
        let mut problem = Problem::named("schneiders-pyramid").unwrap();
        let result = fill(&problem, &FillOptions::default(), &Context::default()).unwrap();
        let mesh = &result.meshes[0].mesh;
        let points = problem.points.clone().unwrap();
        let ways = placements(mesh, &problem.surface, &points);
        assert_eq!(ways.len(), 2);
        assert!((ways[0].upper_bound - 0.1f64.sqrt()).abs() < 1e-9 && ways[1].upper_bound < 1e-9);
        let boundary: BTreeSet<Vec<VertexId>> = problem.surface.quads().iter().map(|q| sorted(*q)).collect();
        for way in &ways {
            assert_eq!(hex_signature(&way.mesh).unwrap(), hex_signature(mesh).unwrap());
            let quads: BTreeSet<Vec<VertexId>> = way.mesh.boundary_quads().into_iter().map(sorted).collect();
            assert_eq!(quads, boundary);
        }
        // All 16 symmetries are congruences of the canonical polyhedron; none are of skew positions, so that all
        // images under the four symmetries of the mesh are the same, and no others.
        problem.points = None;
        let canonical = problem.positions().unwrap();
        assert_eq!(placements(mesh, &problem.surface, &canonical).len(), 1);
        let skew: Vec<[f64; 3]> = points.iter().map(|p| [p[0] + 0.1 * p[1], p[1] + 0.2 * p[2], p[2]]).collect();
        assert_eq!(placements(mesh, &problem.surface, &skew).len(), 4);
    }

    #[test]
    fn a_filling_that_lies_the_wrong_way_is_turned() {
        let problem = Problem::named("schneiders-pyramid").unwrap();
        let (ctx, options) = (Context::default(), hexfill_embed::Options::default());
        let result = fill(&problem, &FillOptions::default(), &ctx).unwrap();
        let points = problem.points.clone().unwrap();
        let wrong = placements(&result.meshes[0].mesh, &problem.surface, &points).pop().unwrap();
        let filled = crate::Filled { mesh: wrong.mesh, ..result.meshes[0].clone() };
        let (filled, placed) = crate::place(filled, &problem, Some(&options), &ctx).unwrap();
        assert!(placed.is_certified() && placed.ways == 2);
        assert!(placed.worst() > 0.3162, "{}", placed.worst());
        // Without an embedding it stays as it is.
        let before = filled.mesh.hexes_raw();
        let (filled, start) = crate::place(filled, &problem, None, &ctx).unwrap();
        assert_eq!((start.ways, filled.mesh.hexes_raw()), (1, before));
    }

    fn sorted(mut quad: [VertexId; 4]) -> Vec<VertexId> {
        quad.sort_unstable();
        quad.to_vec()
    }
}
