//! Whatever the arrays hold, there is an answer: no panic, and reports that agree with themselves.

mod common;

use common::*;
use hexfill_check::{
    Judged, Level, Options, Outcome, Parts, Rules, cell_quality, certify, judge, verify_certificate, write_cell_csv,
};
use hexfill_mesh::Context;
use proptest::prelude::*;

fn id() -> impl Strategy<Value = u32> {
    prop_oneof![30 => 0u32..14, 1 => Just(u32::MAX), 1 => 14u32..40]
}

fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        20 => (-4i32..4).prop_map(f64::from),
        5 => -1.0f64..1.0,
        1 => Just(f64::NAN),
        1 => Just(f64::INFINITY),
        1 => Just(f64::MAX),
        1 => Just(-f64::MAX),
        1 => Just(5e-324),
        1 => Just(-1e-300),
        1 => Just(-0.0),
    ]
}

fn point() -> impl Strategy<Value = [f64; 3]> {
    [coordinate(), coordinate(), coordinate()]
}

/// Hexes of a small grid, some of them spoiled, or arrays of anything.
fn hexes() -> impl Strategy<Value = Vec<[u32; 8]>> {
    let anything = prop::collection::vec(prop::array::uniform8(id()), 0..6);
    let spoiled = (prop::collection::vec((0usize..4, 0usize..8, id()), 0..3)).prop_map(|changes| {
        let mut s = grid([2, 2, 1]);
        changes.into_iter().for_each(|(h, corner, v)| s.hexes[h][corner] = v);
        s.hexes
    });
    prop_oneof![anything, spoiled]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1500, ..ProptestConfig::default() })]

    #[test]
    fn there_is_always_an_answer(
        n in prop_oneof![8 => Just(18usize), 1 => 0usize..30, 1 => Just(1usize << 40)],
        hexes in hexes(),
        surface in prop::option::of(prop::collection::vec(prop::array::uniform4(id()), 0..8)),
        points in prop::option::of(prop::collection::vec(point(), 17..20)),
        surface_points in prop::option::of(prop::collection::vec(point(), 0..30)),
        weill in any::<bool>(),
    ) {
        let input = Judged {
            n_vertices: n,
            hexes: &hexes,
            surface: surface.as_deref(),
            points: points.as_deref(),
            surface_points: surface_points.as_deref(),
        };
        let rules = if weill { Rules::Weill } else { Rules::Strict };
        for parts in [Parts::AsSurface, Parts::Any] {
            let options = Options::default().with_rules(rules).with_parts(parts).with_overlap(true);
            let report = judge(&input, &options, &Context::default());
            for level in Level::ALL {
                let failed = report.failures.iter().any(|f| f.level == level);
                prop_assert_eq!(failed, *report.outcome(level) == Outcome::Failed);
            }
            prop_assert!(report.failures.iter().all(|f| f.count >= f.first.len() as u64 && !f.first.is_empty()));
            prop_assert!(!report.to_string().is_empty());
            let json: serde_json::Value = serde_json::from_str(&report.to_json()).unwrap();
            prop_assert_eq!(json["levels"].as_array().unwrap().len(), 5);
            if let Ok(certificate) = certify(&input, &Context::default()) {
                prop_assert!(verify_certificate(&certificate.to_json(), &input, &Context::default()).is_ok());
            }
        }
        let cells = cell_quality(&input);
        prop_assert_eq!(cells.len(), hexes.len());
        for cell in cells.iter().flatten() {
            prop_assert!(cell.certified_lower <= cell.certified_upper && cell.certified_lower >= -1.0);
            prop_assert!(cell.valid || cell.certified_lower == -1.0);
        }
        write_cell_csv(&cells, &mut Vec::new()).unwrap();
    }
}
