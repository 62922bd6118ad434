//! Several components: cavities of any genus, solids apart and nested, odd components joined, one judge for all.

mod common;

use common::{box_at, check, one_more, plate, together, torus_at};
use hexfill_construct::{ConstructError, ConstructOptions, Construction, Existence, RouteChoice, construct, existence};
use hexfill_mesh::{Context, QuadSurface};

fn fill(surface: &QuadSurface, points: &[[f64; 3]]) -> Construction {
    let made = construct(surface, Some(points), &ConstructOptions::default(), &Context::default()).unwrap();
    println!("{}", made.report);
    check(surface, &made);
    made
}

const O: [f64; 3] = [0.0; 3];

#[test]
fn cavities_in_surfaces_with_handles() {
    for genus in 1..=3 {
        let (surface, points) = plate(genus, 3, &[[1, 1, 1], [1, 7, 1]]);
        assert_eq!((surface.genus(), surface.n_components()), (genus as u64, 3));
        assert!(matches!(existence(&surface, Some(&points)), Existence::Exists { .. }));
        fill(&surface, &points);
    }
}

#[test]
fn a_cavity_with_a_handle() {
    // A torus-shaped cavity in a box; its solid is odd round the tube, which does not bound in what is left.
    for (n, m) in [(4, 4), (4, 6), (4, 5), (6, 3)] {
        let (surface, points) = together(&[box_at(3, 6.0, O, true), torus_at(n, m, true, 1.0, O, false)]);
        assert_eq!((surface.genus(), surface.n_components()), (1, 2));
        let made = construct(&surface, Some(&points), &ConstructOptions::default(), &Context::default());
        // The loop round the axis bounds a disk across the hole of the torus.
        if m % 2 == 0 {
            assert!(matches!(existence(&surface, Some(&points)), Existence::Exists { .. }));
            check(&surface, &made.unwrap());
        } else {
            assert!(matches!(existence(&surface, Some(&points)), Existence::OddCycleBounds { .. }));
            assert!(matches!(made, Err(ConstructError::NoMesh(Existence::OddCycleBounds { .. }))));
        }
    }
    let (surface, points) = together(&[box_at(3, 6.0, O, true), torus_at(5, 4, true, 1.0, O, false)]);
    assert!(matches!(existence(&surface, Some(&points)), Existence::Exists { .. }));
    fill(&surface, &points);
}

#[test]
fn too_few_positions_are_none() {
    let (surface, points) = together(&[one_more(box_at(3, 6.0, O, true)), one_more(box_at(2, 1.0, O, false))]);
    assert!(surface.n_components() == 2 && surface.n_quads().is_multiple_of(2));
    assert!(!matches!(existence(&surface, Some(&points)), Existence::Unknown { .. }));
    assert!(matches!(existence(&surface, Some(&points[1..])), Existence::Unknown { .. }));
    assert!(matches!(existence(&surface, None), Existence::Unknown { .. }));
}

#[test]
fn solids_apart_and_nested() {
    let parts = [
        box_at(4, 10.0, O, true),
        box_at(3, 8.0, O, false),
        torus_at(4, 5, true, 1.0, O, true),
        torus_at(4, 6, true, 1.0, [20.0, 0.0, 0.0], true),
        box_at(2, 0.5, [0.0, 0.0, 9.0], false),
    ];
    let (surface, points) = together(&parts);
    assert!(matches!(existence(&surface, Some(&points)), Existence::Exists { .. }));
    fill(&surface, &points);
    // A cavity that faces outward is no cavity.
    let (surface, points) = together(&[box_at(4, 10.0, O, true), box_at(3, 8.0, O, true)]);
    match construct(&surface, Some(&points), &ConstructOptions::default(), &Context::default()) {
        Err(e @ ConstructError::InteriorNeeded { genus: 0, components: 2, .. }) => {
            assert!(e.to_string().contains("reverse"), "{e}");
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn messages_count_genus_over_all_components() {
    let (surface, _) =
        together(&[box_at(3, 10.0, O, true), box_at(2, 1.0, O, false), box_at(1, 0.1, [5.0, 0.0, 0.0], false)]);
    match construct(&surface, None, &ConstructOptions::default(), &Context::default()) {
        Err(e @ ConstructError::InteriorNeeded { genus: 0, components: 3, .. }) => {
            assert!(e.to_string().contains("genus 0, 3 component(s)"), "{e}");
        }
        other => panic!("{other:?}"),
    }
}

/// An odd number of quads in two components of one solid: tori with odd rows and columns are the small ones.
#[test]
fn odd_components_of_one_solid_are_joined() {
    // Outside odd round the axis only would be 4 x odd; an odd number of quads needs both odd, so the loop round the tube
    // is odd too: it must not bound. Inside the outer torus it does, round the cavity's it does not.
    for (n, inner, m) in [(3, 5, 5), (5, 5, 3), (5, 3, 5)] {
        // As many steps round the axis, so that the tori do not meet.
        let outer = torus_at(n, m, true, 2.0, O, true);
        let (surface, points) = together(&[outer, torus_at(inner, m, true, 0.7, O, false)]);
        // Both tubes odd: between them the tube's loop is homologous to that of the cavity, not null.
        let found = existence(&surface, Some(&points));
        assert!(matches!(found, Existence::Exists { .. }), "{found:?}");
        for route in [RouteChoice::Auto, RouteChoice::Erickson] {
            let options = ConstructOptions::default().with_route(route);
            let made = construct(&surface, Some(&points), &options, &Context::default()).unwrap();
            println!("{n} x {m} round {inner} x {m}: {}", made.report);
            assert_eq!(made.report.n_joins, 1);
            check(&surface, &made);
        }
    }
}

#[test]
fn a_solid_with_an_odd_number_of_quads_is_refused() {
    // Two solids of 15 quads each: 30 in all.
    let (surface, points) =
        together(&[torus_at(3, 5, true, 1.0, O, true), torus_at(3, 5, true, 1.0, [20.0, 0.0, 0.0], true)]);
    match existence(&surface, Some(&points)) {
        Existence::OddSolid { components, given: 15 } => assert_eq!(components, [0]),
        other => panic!("{other:?}"),
    }
    assert!(matches!(existence(&surface, None), Existence::Unknown { .. }));
    match construct(&surface, Some(&points), &ConstructOptions::default(), &Context::default()) {
        Err(ConstructError::NoMesh(Existence::OddSolid { given: 15, .. })) => {}
        other => panic!("{other:?}"),
    }
}

#[test]
fn odd_spheres_in_an_odd_sphere_are_joined() {
    let outer = one_more(box_at(3, 10.0, O, true));
    let cavity = |x: f64| one_more(box_at(3, 2.0, [x, 0.0, 0.0], false));
    for (parts, n_joins) in [
        (vec![outer.clone(), cavity(0.0)], 1),
        (vec![outer.clone(), cavity(-5.0), box_at(2, 1.0, O, false)], 1),
        (vec![box_at(3, 10.0, O, true), cavity(-5.0), cavity(5.0)], 1),
        (vec![outer.clone(), cavity(-5.0), cavity(0.0), cavity(5.0)], 2),
    ] {
        let (surface, points) = together(&parts);
        assert!(matches!(existence(&surface, Some(&points)), Existence::Exists { .. }));
        let made = fill(&surface, &points);
        assert_eq!(made.report.n_joins, n_joins);
    }
    // One odd cavity in an even outside: an odd number in all.
    let (surface, points) = together(&[box_at(3, 10.0, O, true), cavity(0.0)]);
    assert!(matches!(existence(&surface, Some(&points)), Existence::OddQuads { .. }));
}
