//! The second, independent method: all balls of n cubes by `hexfill-enumerate`, grouped by their boundary.

use hexfill_enumerate::{Code, LevelOptions, Params, Plan as Enumeration, Rule, Selection, Wanted, run_whole};
use hexfill_mesh::{
    Context, HexMesh, QuadSurface, VertexId, generate, hex_automorphisms, hex_signature, parse_surface_signature,
    surface_isomorphism, surface_signature,
};
use hexfill_prove::{Plan, Problem, Subgroup, Symmetries, search_whole};
use std::collections::{BTreeMap, BTreeSet};

/// All balls with exactly `n` cubes, each with its boundary: vertices renumbered so that the boundary's are 0, 1, ...
fn balls(n: usize) -> Vec<(QuadSurface, HexMesh)> {
    let ctx = Context::default();
    let plan = Enumeration::prepare(&Params::new(n, Rule::Strict), &LevelOptions::default(), &ctx).unwrap();
    let selection = Selection { balls: true, ..Selection::default() };
    let wanted = Wanted { selection: Some(&selection), list: true, targets: &[] };
    let (_, found) = run_whole(&plan, 2, wanted, &ctx).unwrap();
    let with_boundary = |code: &Code| {
        let mesh = code.decode().unwrap().to_hex_mesh().unwrap();
        let mut ids: Vec<u32> = mesh.boundary_quads().iter().flatten().map(|v| v.0).collect();
        ids.sort_unstable();
        ids.dedup();
        let n_boundary = ids.len();
        ids.extend(
            (0..mesh.n_vertices() as u32).filter(|v| ids[..n_boundary].binary_search(v).is_err()).collect::<Vec<_>>(),
        );
        let new = |v: VertexId| ids.iter().position(|&w| w == v.0).unwrap() as u32;
        let quads: Vec<[u32; 4]> = mesh.boundary_quads().iter().map(|q| q.map(new)).collect();
        let hexes: Vec<[u32; 8]> = mesh.hexes().iter().map(|h| h.map(new)).collect();
        (QuadSurface::try_new(n_boundary, &quads).unwrap(), HexMesh::try_new(mesh.n_vertices(), &hexes).unwrap())
    };
    found.selected.iter().map(with_boundary).collect()
}

fn searched(surface: &QuadSurface, most: usize, group: Subgroup) -> BTreeSet<String> {
    let ctx = Context::default();
    let plan = Plan::prepare(Problem::new(surface, most).unwrap().with_group(group), &ctx).unwrap();
    search_whole(&plan, 2, &ctx).unwrap().meshes.into_keys().collect()
}

/// Every boundary of a ball of at most `most` cubes: the search lists exactly the balls enumerated. Every other small sphere: none.
fn compare(most: usize, spheres_up_to: usize) {
    let mut all: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for n in 1..=most {
        for (boundary, mesh) in balls(n) {
            all.entry(surface_signature(&boundary)).or_default().insert(hex_signature(&mesh).unwrap());
        }
    }
    for quads in (6..=spheres_up_to).step_by(2) {
        for sphere in generate::all_spheres(quads) {
            all.entry(surface_signature(&sphere)).or_default();
        }
    }
    let mut total = 0;
    for (boundary, meshes) in &all {
        let found = searched(&parse_surface_signature(boundary).unwrap(), most, 1);
        assert_eq!(&found, meshes, "{boundary}");
        total += found.len();
    }
    assert_eq!(total, [1, 1, 3, 12, 60, 441, 3987][..most].iter().sum::<usize>());
}

/// Every boundary of a ball of at most `most` cubes, and every symmetry imposed: the search lists exactly the balls that have it.
fn compare_symmetric(most: usize) {
    let mut all: BTreeMap<String, Vec<(QuadSurface, HexMesh)>> = BTreeMap::new();
    for (boundary, mesh) in (1..=most).flat_map(balls) {
        all.entry(surface_signature(&boundary)).or_default().push((boundary, mesh));
    }
    let (mut groups, mut total) = (0, 0);
    for (signature, balls) in &all {
        let surface = parse_surface_signature(signature).unwrap();
        let symmetries = Symmetries::of(&surface).unwrap();
        // Of each ball the automorphisms, as they act on this surface.
        let named = |(boundary, mesh): &(QuadSurface, HexMesh)| {
            let map = surface_isomorphism(boundary, &surface).unwrap();
            let moved = |v: usize| map[v].unwrap().index();
            let images: Vec<Vec<u8>> = hex_automorphisms(mesh)
                .unwrap()
                .iter()
                .map(|a| {
                    let mut image = vec![0; surface.n_vertices()];
                    (0..image.len()).for_each(|v| image[moved(v)] = moved(a.vertices[v].index()) as u8);
                    image
                })
                .collect();
            (hex_signature(mesh).unwrap(), symmetries.generated_by(&images).unwrap())
        };
        let balls: Vec<(String, Subgroup)> = balls.iter().map(named).collect();
        for group in symmetries.subgroup_classes() {
            let has = |(_, own): &&(String, Subgroup)| symmetries.has_conjugate(group, *own);
            let expected: BTreeSet<String> = balls.iter().filter(has).map(|(s, _)| s.clone()).collect();
            assert_eq!(searched(&surface, most, group), expected, "{signature} {}", symmetries.describe(group));
            groups += 1;
            total += expected.len();
        }
    }
    println!("{} boundaries, {groups} groups, {total} balls", all.len());
}

#[test]
fn every_symmetry_of_every_boundary_of_five_cubes() {
    compare_symmetric(5);
}

#[test]
#[ignore = "minutes"]
fn every_symmetry_of_every_boundary_of_six_cubes() {
    compare_symmetric(6);
}

#[test]
fn every_boundary_of_five_cubes() {
    compare(5, 14);
}

#[test]
fn every_boundary_of_six_cubes() {
    compare(6, 12);
}

#[test]
#[ignore = "minutes"]
fn every_boundary_of_seven_cubes() {
    compare(7, 14);
}
