//! The poster's rules, on the poster's own example and on violations of each.

mod common;

use common::*;
use hexfill_check::{Judged, Level, Options, Report, Rule, Rules, judge};
use hexfill_mesh::Context;

fn weill(n: usize, hexes: &[[u32; 8]]) -> Report {
    judge(&Judged::connectivity(n, hexes), &Options::default().with_rules(Rules::Weill), &Context::default())
}

/// The 9 cubes with one chord of the poster: 20 vertices, 22 quads.
const POSTER: [[u32; 8]; 9] = [
    [0, 1, 2, 3, 4, 5, 6, 7],
    [4, 5, 6, 7, 8, 9, 10, 11],
    [0, 3, 2, 1, 12, 13, 14, 15],
    [4, 8, 11, 7, 13, 12, 15, 14],
    [0, 4, 7, 3, 16, 13, 14, 17],
    [1, 2, 6, 5, 15, 14, 10, 9],
    [0, 1, 5, 4, 16, 18, 19, 13],
    [8, 11, 15, 12, 1, 18, 19, 5],
    [7, 14, 15, 11, 3, 17, 19, 18],
];

#[test]
fn grids_and_templates_are_legal() {
    for s in [grid([1, 1, 1]), grid([3, 2, 2])] {
        let report = weill(s.n, &s.hexes);
        assert!(report.passed(Level::L2), "{report}");
    }
}

#[test]
fn every_rule_is_named() {
    let bar = grid([2, 1, 1]).hexes;
    let case = |n: usize, hexes: &[[u32; 8]], rule: Rule| {
        let report = weill(n, hexes);
        assert!(report.breaks(rule), "{rule}: {report}");
    };
    // Only a vertex, only an edge in common.
    case(15, &[[0, 1, 2, 3, 4, 5, 6, 7], [0, 8, 9, 10, 11, 12, 13, 14]], Rule::WeillNotGlued);
    case(15, &[[0, 1, 2, 3, 4, 5, 6, 7], [0, 8, 9, 10, 11, 12, 13, 14]], Rule::WeillMergesVertex);
    // A third cube on an interior quad; a quad in another order.
    let [a, b] = [bar[0], bar[1]];
    case(16, &[a, b, [1, 4, 10, 7, 12, 13, 14, 15]], Rule::WeillQuadNotExterior);
    case(12, &[[0, 1, 2, 3, 4, 5, 6, 7], [0, 2, 1, 3, 8, 9, 10, 11]], Rule::WeillQuadNotExterior);
    // Five vertices in common.
    case(11, &[[0, 1, 2, 3, 4, 5, 6, 7], [0, 3, 2, 1, 8, 9, 10, 4]], Rule::WeillSharesFive);
    // A free facet with three vertices of an earlier cube: over a corner diagonal.
    case(10, &[[0, 1, 2, 3, 4, 5, 6, 7], [0, 3, 2, 1, 8, 9, 4, 5]], Rule::WeillFreeFacetTouches);
}

#[test]
fn the_poster_example_is_legal_here_and_breaks_proper_intersection() {
    let report = weill(20, &POSTER);
    assert!(report.passed(Level::L2), "{report}");
    let strict = judge(&Judged::connectivity(20, &POSTER), &Options::default(), &Context::default());
    assert!(strict.passed(Level::L1) && !strict.passed(Level::L2), "{strict}");
    assert_eq!(report.facts.boundary_quads, Some(22));
    // Six pairs of cubes meet improperly.
    let offenders = strict.failures.iter().filter(|f| f.level == Level::L2).flat_map(|f| &f.first);
    let pairs: std::collections::BTreeSet<_> =
        offenders.map(|o| (o.hexes[0].min(o.hexes[1]), o.hexes[0].max(o.hexes[1]))).collect();
    assert_eq!(pairs.into_iter().collect::<Vec<_>>(), [(1, 7), (2, 4), (2, 6), (2, 7), (2, 8), (5, 7)], "{strict}");
}
