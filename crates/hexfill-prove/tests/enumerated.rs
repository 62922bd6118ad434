//! The second, independent method: all balls of n cubes by `hexfill-enumerate`, grouped by their boundary.

use hexfill_enumerate::{LevelOptions, Params, Plan as Enumeration, Rule, Selection, Wanted, run_whole};
use hexfill_mesh::{Context, QuadSurface, generate, hex_signature, parse_surface_signature, surface_signature};
use hexfill_prove::{Plan, Problem};
use std::collections::{BTreeMap, BTreeSet};

/// By boundary signature the signatures of all balls with exactly `n` cubes.
fn balls(n: usize) -> BTreeMap<String, BTreeSet<String>> {
    let ctx = Context::default();
    let plan = Enumeration::prepare(&Params::new(n, Rule::Strict), &LevelOptions::default(), &ctx).unwrap();
    let selection = Selection { balls: true, ..Selection::default() };
    let wanted = Wanted { selection: Some(&selection), list: true, targets: &[] };
    let (_, found) = run_whole(&plan, 2, wanted, &ctx).unwrap();
    let mut out: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for code in &found.selected {
        let mesh = code.decode().unwrap().to_hex_mesh().unwrap();
        let quads: Vec<[u32; 4]> = mesh.boundary_quads().iter().map(|q| q.map(|v| v.0)).collect();
        let mut ids: Vec<u32> = quads.iter().flatten().copied().collect();
        ids.sort_unstable();
        ids.dedup();
        let quads: Vec<[u32; 4]> = quads.iter().map(|q| q.map(|v| ids.binary_search(&v).unwrap() as u32)).collect();
        let surface = QuadSurface::try_new(ids.len(), &quads).unwrap();
        out.entry(surface_signature(&surface)).or_default().insert(hex_signature(&mesh).unwrap());
    }
    out
}

fn searched(surface: &QuadSurface, most: usize) -> BTreeSet<String> {
    let ctx = Context::default();
    let plan = Plan::prepare(Problem::new(surface, most).unwrap(), &ctx).unwrap();
    plan.run_whole(2, &ctx).unwrap().meshes.into_keys().collect()
}

/// Every boundary of a ball of at most `most` cubes: the search lists exactly the balls enumerated. Every other small sphere: none.
fn compare(most: usize, spheres_up_to: usize) {
    let mut all: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for n in 1..=most {
        for (boundary, meshes) in balls(n) {
            all.entry(boundary).or_default().extend(meshes);
        }
    }
    for quads in (6..=spheres_up_to).step_by(2) {
        for sphere in generate::all_spheres(quads) {
            all.entry(surface_signature(&sphere)).or_default();
        }
    }
    let mut total = 0;
    for (boundary, meshes) in &all {
        let found = searched(&parse_surface_signature(boundary).unwrap(), most);
        assert_eq!(&found, meshes, "{boundary}");
        total += found.len();
    }
    assert_eq!(total, [1, 1, 3, 12, 60, 441, 3987][..most].iter().sum::<usize>());
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
