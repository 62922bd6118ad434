//! Schneiders' pyramid with two mirrors: the classes that joneuhauser/hex-templates (2026) lists by a search of its own, 36:1, 40:3, 42:5, 44:8.

use hexfill_mesh::{Context, hex_signature, parse_surface_signature};
use hexfill_prove::{Plan, Problem, search_whole};
use hexfill_search::{Atlas, FillOptions, fill_from_atlas};

/// Classes by number of hexes, and the signatures.
fn searched(most: usize) -> (Vec<(usize, usize)>, Vec<String>) {
    let ctx = Context::default();
    let pyramid = parse_surface_signature("Q1:000000070017100700171605141317").unwrap();
    let problem = Problem::new(&pyramid, most).unwrap();
    let group = problem.symmetries().subgroup_classes()[6];
    assert_eq!(problem.symmetries().describe(group), "order 4, 2 mirrors, 1 rotation");
    let outcome = search_whole(&Plan::prepare(problem.with_group(group), &ctx).unwrap(), 2, &ctx).unwrap();
    (outcome.classes().into_iter().collect(), outcome.meshes.into_keys().collect())
}

/// There is one, the atlas's. A second mesh that the tree leads to is a punctured projective space, no ball.
#[test]
fn one_pyramid_of_36_hexes() {
    let pyramid = parse_surface_signature("Q1:000000070017100700171605141317").unwrap();
    let ctx = Context::default();
    let made = fill_from_atlas(&pyramid, Atlas::embedded(), &FillOptions::default(), &ctx).unwrap();
    let (classes, found) = searched(36);
    assert_eq!(classes, [(36, 1)]);
    assert_eq!(found, [hex_signature(&made.fillings[0].mesh).unwrap()]);
}

#[test]
#[ignore = "minutes"]
fn pyramids_of_44_hexes() {
    assert_eq!(searched(44).0, [(36, 1), (40, 3), (42, 5), (44, 8)]);
}
