//! Every rule of levels 1 to 3 is broken on purpose and must be named.

mod common;

use common::*;
use hexfill_check::{Judged, Level, Options, Parts, Rule, SurfaceSense, judge};
use hexfill_mesh::Context;

fn samples() -> Vec<(&'static str, Sample)> {
    vec![
        ("cube", grid([1, 1, 1])),
        ("grid 2 1 1", grid([2, 1, 1])),
        ("grid 3 3 3", grid([3, 3, 3])),
        ("grid 4 3 2", grid([4, 3, 2])),
        ("refine 9 to 1", template("refine_9to1_13")),
        ("refine 16 to 4", template("refine_16to4_28")),
        ("tesseract minus a cube", tesseract_minus_cube()),
    ]
}

/// Exactly these rules are broken.
#[track_caller]
fn broken(sample: &Sample, rules: &[Rule]) {
    let report = sample.report();
    assert_eq!(report.broken_rules(), rules.iter().map(|r| r.id()).collect::<Vec<_>>(), "{report}");
    for failure in &report.failures {
        assert!(failure.count > 0 && failure.first.len() as u64 == failure.count.min(10));
    }
}

#[test]
fn good_meshes_pass_with_the_right_facts() {
    for (name, sample) in samples() {
        let report = sample.report();
        assert!(report.passed(Level::L3), "{name}: {report}");
        assert_eq!(report.facts.euler, Some(1), "{name}");
        assert_eq!(report.facts.boundary_quads, Some(sample.surface.len() as u64));
        let boundary = report.facts.boundary.as_ref().unwrap();
        assert_eq!((boundary.len(), boundary[0].genus), (1, Some(0)), "{name}");
    }
    let report = grid([3, 4, 5]).report();
    let facts = &report.facts;
    assert_eq!(facts.interior_vertices, Some(2 * 3 * 4));
    assert_eq!(facts.edges, Some((3 * 5 * 6 + 4 * 4 * 6 + 5 * 4 * 5) as u64));
    assert_eq!(facts.surface_sense, Some(SurfaceSense::Outward));
}

#[test]
fn a_closed_mesh_is_a_fact_not_a_failure() {
    let report = report(16, &tesseract());
    assert!(report.passed(Level::L3), "{report}");
    assert_eq!((report.facts.euler, report.facts.closed_parts), (Some(0), Some(1)));
    assert_eq!(report.facts.boundary, Some(vec![]));
}

#[test]
fn solid_tori_have_a_torus_as_boundary() {
    for twist in 0..4 {
        let (n, hexes) = ring(5, twist, false);
        let report = report(n, &hexes);
        assert!(report.passed(Level::L3), "{report}");
        assert_eq!(report.facts.boundary.as_ref().unwrap()[0].genus, Some(1));
        assert_eq!((report.facts.euler, report.facts.orientable), (Some(0), Some(true)));
    }
}

#[test]
fn level_1() {
    let mut s = grid([2, 2, 2]);
    s.hexes.clear();
    broken(&s, &[Rule::MeshEmpty]);

    let mut s = grid([2, 2, 2]);
    s.hexes[3][5] = 27;
    s.hexes[5][0] = u32::MAX;
    broken(&s, &[Rule::IndexOutOfRange]);
    let f = s.report();
    let f = f.failure(Rule::IndexOutOfRange).unwrap();
    assert_eq!((f.first[0].hexes[0], f.first[0].vertices[0], f.count), (3, 27, 2));
    assert!(f.first[0].to_string().starts_with("h3 (v27)"), "{}", f.first[0]);

    let mut s = grid([2, 2, 2]);
    s.hexes[4][7] = s.hexes[4][1];
    broken(&s, &[Rule::HexRepeatsVertex]);

    let mut s = grid([2, 2, 2]);
    s.surface[1][2] = 99;
    broken(&s, &[Rule::SurfaceIndexOutOfRange]);

    let mut s = grid([2, 2, 2]);
    s.surface[1][2] = s.surface[1][0];
    broken(&s, &[Rule::SurfaceQuadRepeatsVertex]);

    let hexes = [[0, 1, 2, 3, 4, 5, 6, 7]];
    let many = Judged::connectivity(1 << 33, &hexes);
    let report = judge(&many, &Options::default(), &Context::default());
    assert_eq!(report.broken_rules(), ["too-large"]);
}

#[test]
fn more_than_ten_offenders_are_counted() {
    let mut s = grid([3, 3, 3]);
    for hex in &mut s.hexes {
        hex[0] = 1000;
    }
    let report = s.report();
    let f = report.failure(Rule::IndexOutOfRange).unwrap();
    assert_eq!((f.count, f.first.len()), (27, 10));
    assert!(report.to_string().contains("and 17 more"));
    assert!(report.to_json().contains("\"index-out-of-range\""));
}

#[test]
fn a_dropped_hex_leaves_a_hole() {
    for (name, sample) in samples().into_iter().filter(|s| s.1.hexes.len() > 1) {
        for drop in 0..sample.hexes.len() {
            let mut s = sample.clone();
            s.hexes.remove(drop);
            let report = s.report();
            assert!(!report.passed(Level::L3), "{name} without h{drop}");
            assert!(report.passed(Level::L2), "{name} without h{drop}: {report}");
            let hidden = report.failure(Rule::BoundaryQuadMissing).map_or(0, |f| f.count);
            let laid_open = report.failure(Rule::BoundaryQuadExtra).map_or(0, |f| f.count);
            assert_eq!(hidden + laid_open, 6, "{name} without h{drop}: {report}");
        }
    }
}

#[test]
fn a_duplicated_hex_is_named() {
    let mut s = grid([3, 3, 3]);
    s.hexes.push(s.hexes[13]);
    broken(&s, &[Rule::HexDuplicated, Rule::QuadInThreeHexes, Rule::BodyDiagonalShared]);
    let report = s.report();
    assert_eq!(report.failure(Rule::HexDuplicated).unwrap().first[0].hexes, [13, 27]);
    assert_eq!(report.failure(Rule::QuadInThreeHexes).unwrap().count, 6);
    assert_eq!(report.failure(Rule::BodyDiagonalShared).unwrap().count, 4);

    // Two copies of one cube: every quad pairs up, and yet it is no mesh.
    let twice = [[0, 1, 2, 3, 4, 5, 6, 7], [0, 1, 2, 3, 4, 5, 6, 7]];
    let report = common::report(8, &twice);
    assert!(report.breaks(Rule::HexDuplicated) && report.breaks(Rule::OrientationClash), "{report}");
}

#[test]
fn a_reflected_hex_is_named() {
    for (name, sample) in samples().into_iter().filter(|s| s.1.hexes.len() > 2) {
        for h in 0..sample.hexes.len() {
            let mut s = sample.clone();
            let x = s.hexes[h];
            s.hexes[h] = [x[4], x[5], x[6], x[7], x[0], x[1], x[2], x[3]];
            broken(&s, &[Rule::OrientationClash, Rule::HexReflected]);
            let report = s.report();
            let f = report.failure(Rule::HexReflected).unwrap();
            assert_eq!((f.count, f.first[0].hexes.as_slice()), (1, &[h as u32][..]), "{name}");
        }
    }
}

#[test]
fn two_corners_of_a_hex_exchanged_break_level_2() {
    // An edge: the two quads on it are twisted. A face diagonal: its quad is turned over, edges become body diagonals. A body
    // diagonal: edges become face diagonals of other quads.
    let cases = [
        ([(0, 1), (0, 3), (0, 4), (6, 5)], Rule::EdgeIsFaceDiagonal, 2),
        ([(0, 2), (1, 6), (5, 0), (7, 2)], Rule::EdgeIsBodyDiagonal, 0),
        ([(0, 6), (1, 7), (2, 4), (3, 5)], Rule::EdgeIsFaceDiagonal, 0),
    ];
    for (pairs, rule, expected) in cases {
        for (i, j) in pairs {
            let mut s = grid([3, 3, 3]);
            s.hexes[13].swap(i, j);
            let report = s.report();
            assert!(report.breaks(rule), "corners {i} {j}: {report}");
            let twisted = report.failure(Rule::QuadTwisted).map_or(0, |f| f.count);
            assert_eq!(twisted, expected, "corners {i} {j}: {report}");
        }
    }
}

#[test]
fn two_vertices_exchanged_everywhere_change_nothing_but_the_boundary() {
    let mut s = grid([3, 3, 3]);
    for v in s.hexes.iter_mut().flatten() {
        *v = if *v == 0 {
            1
        } else if *v == 1 {
            0
        } else {
            *v
        };
    }
    broken(&s, &[Rule::BoundaryQuadMissing, Rule::BoundaryQuadExtra, Rule::BoundaryQuadTwisted]);
}

#[test]
fn glued_vertices_are_named() {
    // Far apart in a 4 x 1 x 1 bar: the hexes then share just that vertex, and it is pinched.
    let mut s = grid([4, 1, 1]);
    let glue = |s: &mut Sample, from: u32, to: u32| {
        s.hexes.iter_mut().flatten().chain(s.surface.iter_mut().flatten()).for_each(|v| {
            if *v == from {
                *v = to;
            }
        });
    };
    glue(&mut s, 4, 0);
    broken(&s, &[Rule::VertexPinched]);
    assert_eq!(s.report().failure(Rule::VertexPinched).unwrap().first[0].vertices, [0]);
    // A second pair next to it: an edge is pinched.
    glue(&mut s, 9, 5);
    broken(&s, &[Rule::EdgePinched]);
    assert_eq!(s.report().failure(Rule::EdgePinched).unwrap().first[0].vertices, [0, 5]);
    // Two cubes apart, opposite corners of a quad: its diagonal is another quad's too.
    let mut s = grid([3, 1, 1]);
    glue(&mut s, 3, 0);
    glue(&mut s, 15, 12);
    let report = s.report();
    assert!(report.breaks(Rule::FaceDiagonalOfTwoQuads), "{report}");
    // Neighbouring hexes: a hex would use the vertex twice, or hexes share a quad and more.
    let mut s = grid([2, 1, 1]);
    glue(&mut s, 2, 0);
    let report = s.report();
    assert!(!report.passed(Level::L2), "{report}");
}

#[test]
fn every_kind_of_improper_pair_is_named() {
    let a = [0, 1, 2, 3, 4, 5, 6, 7];
    let cases: [(Rule, [u32; 8]); 6] = [
        (Rule::EdgeIsFaceDiagonal, [0, 2, 10, 11, 12, 13, 14, 15]),
        (Rule::EdgeIsBodyDiagonal, [0, 6, 10, 11, 12, 13, 14, 15]),
        (Rule::FaceDiagonalOfTwoQuads, [0, 10, 2, 11, 12, 13, 14, 15]),
        (Rule::FaceDiagonalIsBodyDiagonal, [0, 10, 11, 12, 13, 14, 2, 15]),
        (Rule::BodyDiagonalShared, [0, 10, 11, 12, 13, 14, 6, 15]),
        (Rule::FaceDiagonalIsBodyDiagonal, [0, 10, 6, 12, 13, 14, 15, 16]),
    ];
    for (rule, b) in cases {
        for pair in [[a, b], [b, a]] {
            let options = Options::default().with_up_to(Level::L2);
            let report = judge(&Judged::connectivity(17, &pair), &options, &Context::default());
            assert_eq!(report.broken_rules(), [rule.id()], "{report}");
            assert_eq!(report.failures[0].count, 1);
        }
    }
    // One vertex set, two cyclic orders.
    let b = [0, 2, 1, 3, 10, 11, 12, 13];
    let report = report(14, &[a, b]);
    assert_eq!(report.failure(Rule::QuadTwisted).unwrap().count, 1, "{report}");
    assert_eq!(report.failure(Rule::EdgeIsFaceDiagonal).unwrap().count, 4);
}

#[test]
fn three_hexes_on_a_quad_are_named_even_where_all_pairs_are_proper() {
    let mut s = grid([2, 1, 1]);
    let quad = [1, 4, 10, 7];
    s.hexes.push([1, 4, 10, 7, 12, 13, 14, 15]);
    s.n = 16;
    assert!(s.hexes[0].iter().filter(|v| quad.contains(v)).count() == 4);
    let report = s.report();
    let f = report.failure(Rule::QuadInThreeHexes).unwrap();
    assert_eq!((f.count, f.first[0].hexes.as_slice()), (1, &[0, 1, 2][..]), "{report}");
    assert!(!report.breaks(Rule::BodyDiagonalShared));
}

#[test]
fn boundary_differences_are_named_quad_by_quad() {
    let mut s = grid([2, 2, 2]);
    let gone = s.surface.remove(7);
    broken(&s, &[Rule::BoundaryQuadExtra]);
    let report = s.report();
    let found = &report.failure(Rule::BoundaryQuadExtra).unwrap().first[0].vertices;
    assert!(gone.iter().all(|v| found.contains(v)));

    // An interior quad demanded as boundary, a quad of no hex, and a repeated one.
    let mut s = grid([2, 1, 1]);
    s.surface.push([1, 4, 10, 7]);
    s.surface.push([0, 1, 2, 3]);
    s.surface.push(s.surface[0]);
    broken(&s, &[Rule::SurfaceQuadRepeated, Rule::BoundaryQuadMissing]);
    let report = s.report();
    let missing = report.failure(Rule::BoundaryQuadMissing).unwrap();
    assert_eq!((missing.first[0].quads[0], missing.first[0].note.as_str()), (10, "interior: in h0 h1"));
    assert_eq!(missing.first[1].note, "not a quad of any hex");
    assert_eq!(report.failure(Rule::SurfaceQuadRepeated).unwrap().first[0].quads, [0, 12]);

    // A boundary id moved to a new vertex.
    let mut s = grid([2, 2, 2]);
    s.n += 1;
    s.hexes.iter_mut().flatten().filter(|v| **v == 0).for_each(|v| *v = 27);
    broken(&s, &[Rule::BoundaryQuadMissing, Rule::BoundaryQuadExtra]);
    assert_eq!(s.report().failure(Rule::BoundaryQuadMissing).unwrap().count, 3);

    // A surface quad with its corners in another order.
    let mut s = grid([2, 2, 2]);
    s.surface[4].swap(0, 1);
    broken(&s, &[Rule::BoundaryQuadTwisted]);

    // The sense of the surface is a fact, not a failure.
    let mut s = grid([2, 2, 2]);
    s.surface.iter_mut().for_each(|q| q.reverse());
    assert!(s.report().passed(Level::L3));
    assert_eq!(s.report().facts.surface_sense, Some(SurfaceSense::Inward));
    s.surface[0].reverse();
    assert_eq!(s.report().facts.surface_sense, Some(SurfaceSense::Mixed));
}

#[test]
fn links_that_are_no_disk_or_sphere_are_named() {
    let (n, hexes) = cone(&torus());
    let report = common::report(n, &hexes);
    assert_eq!(report.broken_rules(), ["vertex-link-not-sphere"], "{report}");
    assert_eq!(report.failures[0].first[0].vertices, [0]);

    let (n, hexes) = cone(&annulus());
    let report = common::report(n, &hexes);
    assert_eq!(report.broken_rules(), ["vertex-link-not-disk"], "{report}");

    let (n, hexes) = cone(&moebius());
    let report = common::report(n, &hexes);
    assert!(report.breaks(Rule::NonOrientable) && report.breaks(Rule::VertexLinkNotDisk), "{report}");

    let sphere: Vec<[u32; 3]> = vec![[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]];
    let (n, hexes) = cone(&sphere);
    assert!(common::report(n, &hexes).passed(Level::L3));
    let two: Vec<[u32; 3]> = sphere.iter().copied().chain(sphere.iter().map(|t| t.map(|v| v + 4))).collect();
    let (n, hexes) = cone(&two);
    let options = Options::default().with_parts(Parts::Any);
    let report = judge(&Judged::connectivity(n, &hexes), &options, &Context::default());
    assert_eq!(report.broken_rules(), ["vertex-pinched"], "{report}");
}

#[test]
fn a_solid_klein_bottle_is_not_orientable() {
    let (n, hexes) = ring(5, 0, true);
    let report = report(n, &hexes);
    assert_eq!(report.broken_rules(), ["non-orientable", "orientation-clash"], "{report}");
    assert_eq!(report.facts.orientable, Some(false));
    assert_eq!(report.facts.boundary.as_ref().unwrap()[0].genus, None);
}

#[test]
fn parts_are_counted_and_judged() {
    let mut s = grid([1, 1, 1]);
    s.hexes.push(s.hexes[0].map(|v| v + 8));
    s.n = 16;
    let alone = Judged::connectivity(s.n, &s.hexes);
    let run = |j: &Judged<'_>, parts| judge(j, &Options::default().with_parts(parts), &Context::default());
    assert_eq!(run(&alone, Parts::AsSurface).broken_rules(), ["mesh-disconnected"]);
    assert!(run(&alone, Parts::Any).no_failure());
    // With a surface of two parts it is as asked.
    s.surface.extend(grid([1, 1, 1]).surface.iter().map(|q| q.map(|v| v + 8)));
    assert!(run(&s.judged(), Parts::AsSurface).passed(Level::L3));
    assert_eq!(run(&s.judged(), Parts::One).broken_rules(), ["mesh-disconnected"]);
    // A closed part beside it is never as asked.
    s.hexes.extend(tesseract().iter().map(|h| h.map(|v| v + 16)));
    s.n = 32;
    let report = run(&s.judged(), Parts::AsSurface);
    assert_eq!(report.broken_rules(), ["mesh-disconnected"]);
    assert_eq!(report.failures[0].first[0].hexes, [2]);
}

#[test]
fn cancelled_work_says_so() {
    let s = grid([2, 2, 2]);
    let cancel = std::sync::atomic::AtomicBool::new(true);
    let ctx = Context { cancel: Some(&cancel), ..Context::default() };
    let report = judge(&s.judged(), &Options::default(), &ctx);
    assert!(report.passed(Level::L1) && !report.passed(Level::L2) && report.no_failure());
    assert!(report.to_string().contains("not judged: cancelled"));
}
