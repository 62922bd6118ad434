//! Levels 4 and 5: frozen hexes, extreme numbers, moved boundaries, quality numbers and certified intervals.

mod common;

use common::*;
use hexfill_check::{Judged, Level, Options, Report, Rule, cell_quality, judge, write_cell_csv};
use hexfill_mesh::{Context, cube};

const ONE: [[u32; 8]; 1] = [[0, 1, 2, 3, 4, 5, 6, 7]];

fn hex_report(points: &[[f64; 3]]) -> Report {
    let input = Judged::connectivity(8, &ONE).with_points(points);
    judge(&input, &Options::default(), &Context::default())
}

fn unit() -> Vec<[f64; 3]> {
    cube::POSITIONS.iter().map(|p| p.map(f64::from)).collect()
}

/// det J at a point, straight from the trilinear map.
fn jacobian(p: &[[f64; 3]], at: [f64; 3]) -> (f64, f64) {
    let mut j = [[0.0; 3]; 3];
    for (i, corner) in cube::POSITIONS.iter().enumerate() {
        let w = |k: usize| if corner[k] == 1 { at[k] } else { 1.0 - at[k] };
        let d = |k: usize| if corner[k] == 1 { 1.0 } else { -1.0 };
        for (axis, weight) in [d(0) * w(1) * w(2), w(0) * d(1) * w(2), w(0) * w(1) * d(2)].iter().enumerate() {
            (0..3).for_each(|c| j[axis][c] += weight * p[i][c]);
        }
    }
    let [a, b, c] = j;
    let det =
        a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
    let norms: f64 = j.iter().map(|v| v.iter().map(|x| x * x).sum::<f64>().sqrt()).product();
    (det, det / norms)
}

/// Eight positive corners, negative inside (found by random search on integer points).
const NEGATIVE_INSIDE: [[[f64; 3]; 8]; 3] = [
    [
        [2., -2., -2.],
        [7., 2., 0.],
        [3., 6., -2.],
        [-2., 6., 0.],
        [-2., 1., 4.],
        [1., -1., 1.],
        [3., 4., 4.],
        [0., 4., 3.],
    ],
    [
        [2., 0., 1.],
        [3., 2., -3.],
        [6., 3., 2.],
        [0., 3., -1.],
        [-1., 0., 7.],
        [1., -3., 6.],
        [4., 4., 6.],
        [3., 7., 5.],
    ],
    [
        [-3., -3., -2.],
        [3., 0., -3.],
        [6., 5., -3.],
        [0., 6., -2.],
        [3., 2., 6.],
        [7., -2., 3.],
        [3., 5., 3.],
        [-2., 2., 3.],
    ],
];

/// Valid, with a negative Bernstein coefficient.
const NEGATIVE_COEFFICIENT: [[[f64; 3]; 8]; 3] = [
    [
        [-3., -3., 0.],
        [3., 3., -2.],
        [5., 7., -2.],
        [-1., 3., -2.],
        [-3., 0., 6.],
        [4., 0., 1.],
        [1., 3., 7.],
        [1., 6., 4.],
    ],
    [
        [2., -1., -3.],
        [4., 3., -2.],
        [2., 3., -2.],
        [-1., 2., 1.],
        [-2., 2., 4.],
        [6., -2., 2.],
        [6., 5., 5.],
        [3., 5., 4.],
    ],
    [
        [2., 3., -2.],
        [7., 2., 0.],
        [5., 5., -1.],
        [0., 4., 2.],
        [3., -3., 6.],
        [6., -2., 6.],
        [1., 3., 6.],
        [-1., 1., 3.],
    ],
];

#[test]
fn the_unit_cube_is_perfect() {
    let report = hex_report(&unit());
    assert!(report.passed(Level::L5), "{report}");
    let q = report.geometry.unwrap().quality.unwrap();
    assert_eq!((q.min_corner_scaled_jacobian, q.min_verdict_scaled_jacobian, q.max_edge_ratio), (1.0, 1.0, 1.0));
    assert!((q.max_condition - 1.0).abs() < 1e-15 && q.volume == 1.0 && q.boundary_volume == 1.0);
    let [low, high] = q.certified_scaled_jacobian;
    assert!(low <= 1.0 && low > 1.0 - 1e-9 && high == 1.0);
    assert_eq!(q.histogram[19], 1);
}

#[test]
fn positive_corners_do_not_save_a_hex_that_is_negative_inside() {
    for p in NEGATIVE_INSIDE {
        let report = hex_report(&p);
        assert_eq!(report.broken_rules(), ["jacobian-not-positive"], "{report}");
        let g = report.geometry.as_ref().unwrap();
        let q = g.quality.as_ref().unwrap();
        assert!(q.min_corner_scaled_jacobian > 0.0 && g.not_positive == 1);
        assert!(q.certified_scaled_jacobian[1] < 0.0 && q.certified_scaled_jacobian[0] == -1.0);
        // The point named is a witness.
        let note = &report.failures[0].first[0].note;
        let inside = &note[note.find('(').unwrap() + 1..note.find(')').unwrap()];
        let at: Vec<f64> = inside.split(", ").map(|x| x.parse().unwrap()).collect();
        assert!(jacobian(&p, [at[0], at[1], at[2]]).0 < 0.0, "{note}");
    }
}

#[test]
fn a_negative_coefficient_does_not_condemn_a_valid_hex() {
    for p in NEGATIVE_COEFFICIENT {
        let report = hex_report(&p);
        assert!(report.passed(Level::L5), "{report}");
        let [low, high] = report.geometry.unwrap().quality.unwrap().certified_scaled_jacobian;
        // Against a fine lattice.
        let mut least = 1.0f64;
        for i in 0..=40 {
            for j in 0..=40 {
                for k in 0..=40 {
                    least = least.min(jacobian(&p, [i, j, k].map(|x| f64::from(x) / 40.0)).1);
                }
            }
        }
        assert!(low > 0.0 && low <= least && high <= least + 1e-9 && high - low < 2e-9, "{low} {high} {least}");
    }
}

#[test]
fn certified_intervals_hold_on_random_hexes() {
    let mut random = Random(11);
    let (mut valid, mut invalid) = (0, 0);
    for _ in 0..400 {
        let p: Vec<[f64; 3]> = unit().iter().map(|p| p.map(|x| x + 0.9 * (random.unit() - 0.5))).collect();
        let report = hex_report(&p);
        let mut least = 1.0f64;
        for _ in 0..400 {
            let snap = |x: f64| {
                if x < 0.1 {
                    0.0
                } else if x > 0.9 {
                    1.0
                } else {
                    (x - 0.1) / 0.8
                }
            };
            let at = [snap(random.unit()), snap(random.unit()), snap(random.unit())];
            least = least.min(jacobian(&p, at).1);
        }
        let ok = report.passed(Level::L5);
        let [low, high] = report.geometry.unwrap().quality.unwrap().certified_scaled_jacobian;
        if ok {
            valid += 1;
            assert!(0.0 <= low && low <= least + 1e-12 && low <= high && high - low < 2e-9, "{low} {high} {least}");
        } else {
            invalid += 1;
            assert!(low == -1.0 && high <= 1.0);
        }
        assert!(!(ok && least <= 0.0));
    }
    assert!(valid > 50 && invalid > 20, "{valid} {invalid}");
}

#[test]
fn exact_zeros_are_not_positive() {
    // A face folded flat on its neighbour: det J = 0 along an edge, exactly, whatever the scale.
    for scale in [1.0, 1e-300, 1e300, 3e-310, 0.1] {
        let mut p: Vec<[f64; 3]> = unit().iter().map(|p| p.map(|x| x * scale)).collect();
        assert!(hex_report(&p).passed(Level::L5), "cube of size {scale}: {}", hex_report(&p));
        p[2] = [scale, 0.0, 0.0];
        let report = hex_report(&p);
        assert_eq!(report.broken_rules(), ["jacobian-not-positive"], "{report}");
        assert!(report.failures[0].first[0].note.contains("zero"), "{report}");
    }
    // All vertices in one place.
    let report = hex_report(&[[0.3; 3]; 8]);
    assert_eq!(report.broken_rules(), ["jacobian-not-positive"], "{report}");
    // Flat.
    let p: Vec<[f64; 3]> = unit().iter().map(|p| [p[0], p[1], 0.0]).collect();
    assert_eq!(hex_report(&p).broken_rules(), ["jacobian-not-positive"]);
}

#[test]
fn the_last_bit_decides() {
    // Corner 2 on the line through 1 and 3 of a flat bottom: zero; one unit in the last place out or in: positive or negative.
    let base = |x: f64| {
        let mut p = unit();
        p[2] = [x, 0.5, 0.0];
        p[6] = [1.0, 1.0, 1.0];
        p
    };
    let at_zero = hex_report(&base(0.5));
    assert!(at_zero.failures[0].first[0].note.contains("zero"), "{at_zero}");
    let out = hex_report(&base(0.5f64.next_up()));
    assert!(out.passed(Level::L5), "{out}");
    let inside = hex_report(&base(0.5f64.next_down()));
    assert!(inside.failures[0].first[0].note.contains("negative"), "{inside}");
}

#[test]
fn extreme_numbers_get_a_clear_answer() {
    for (low, high) in [(0.0, f64::MAX), (-f64::MAX, f64::MAX), (0.0, 5e-324), (-1e300, 1e300), (1e-300, 1e300)] {
        let p: Vec<[f64; 3]> = cube::POSITIONS.iter().map(|p| p.map(|x| if x == 1 { high } else { low })).collect();
        let report = hex_report(&p);
        assert!(report.passed(Level::L5), "{low} {high}: {report}");
        let q = report.geometry.unwrap().quality.unwrap();
        assert!(q.certified_scaled_jacobian[0] >= 0.0 && q.min_corner_scaled_jacobian > 0.99, "{low} {high}: {q:?}");
    }
    // Needles: sizes 1e300 x 1 x 1e-300.
    let p: Vec<[f64; 3]> =
        cube::POSITIONS.iter().map(|p| [f64::from(p[0]) * 1e300, f64::from(p[1]), f64::from(p[2]) * 1e-300]).collect();
    assert!(hex_report(&p).passed(Level::L5), "{}", hex_report(&p));
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut p = unit();
        p[5][1] = bad;
        let report = hex_report(&p);
        assert_eq!(report.broken_rules(), ["position-not-finite"]);
        assert_eq!(report.failures[0].first[0].vertices, [5]);
        assert!(report.to_string().contains("L5") && report.to_string().contains("level 4 failed"));
    }
}

#[test]
fn a_mirrored_mesh_is_called_inside_out() {
    let p: Vec<[f64; 3]> = unit().iter().map(|p| [-p[0], p[1], p[2]]).collect();
    let report = hex_report(&p);
    assert_eq!(report.broken_rules(), ["hex-inside-out"], "{report}");
}

#[test]
fn positions_are_compared_bit_by_bit() {
    let size = [2, 2, 2];
    let (s, points) = (grid(size), grid_points(size));
    let judged = |points: &[[f64; 3]], given: &[[f64; 3]]| {
        let input = Judged { surface_points: Some(given), points: Some(points), ..s.judged() };
        judge(&input, &Options::default(), &Context::default())
    };
    let report = judged(&points, &points[..26]);
    assert!(report.passed(Level::L5), "{report}");
    let mut moved = points.clone();
    moved[3][0] = f64::from_bits(moved[3][0].to_bits() + 1);
    moved[0][1] = -0.0;
    let report = judged(&moved, &points[..26]);
    assert_eq!(report.broken_rules(), ["boundary-moved"]);
    let f = report.failure(Rule::BoundaryMoved).unwrap();
    assert_eq!((f.count, &f.first[0].vertices, &f.first[1].vertices), (2, &vec![0], &vec![3]));
    assert_eq!(judged(&points[..20], &points[..20]).broken_rules(), ["points-count"]);
    let mut more = points.clone();
    more.push([0.0; 3]);
    assert_eq!(judged(&points, &more).broken_rules(), ["points-count"]);
}

#[test]
fn volumes_balance_and_cells_are_listed() {
    let size = [5, 4, 3];
    let (s, mut points) = (grid(size), grid_points(size));
    let mut random = Random(3);
    for p in &mut points {
        *p = p.map(|x| x + 0.3 * (random.unit() - 0.5));
    }
    let input = s.judged().with_points(&points);
    let report = judge(&input, &Options::default(), &Context::default());
    let g = report.geometry.as_ref().unwrap();
    let q = g.quality.as_ref().unwrap();
    assert!((q.volume - q.boundary_volume).abs() < 1e-12 * q.volume && q.volume > 40.0, "{report}");
    assert_eq!(q.histogram.iter().sum::<u64>(), 60);
    assert_eq!(q.worst.len(), 10);
    assert_eq!(q.worst[0].corner_scaled_jacobian, q.min_corner_scaled_jacobian);
    let cells = cell_quality(&input);
    let least = cells.iter().map(|c| c.unwrap().certified_lower).fold(1.0, f64::min);
    assert!((least - q.certified_scaled_jacobian[0]).abs() < 1e-5);
    assert!((cells.iter().map(|c| c.unwrap().volume).sum::<f64>() - q.volume).abs() < 1e-12);
    let mut csv = Vec::new();
    write_cell_csv(&cells, &mut csv).unwrap();
    let text = String::from_utf8(csv).unwrap();
    assert_eq!(text.lines().count(), 61);
    assert!(text.lines().all(|l| l.split(',').count() == 9));
}

#[test]
fn a_sheared_box_has_the_scaled_jacobian_of_its_angle() {
    // x sheared by y: the angle between the edges is 45 degrees everywhere.
    let p: Vec<[f64; 3]> = unit().iter().map(|p| [p[0] + p[1], p[1], p[2]]).collect();
    let q = hex_report(&p).geometry.unwrap().quality.unwrap();
    let expected = 0.5f64.sqrt();
    assert!((q.min_corner_scaled_jacobian - expected).abs() < 1e-15);
    let [low, high] = q.certified_scaled_jacobian;
    assert!(low <= expected && expected <= high && high - low < 1e-9);
    // Frobenius condition number of [[1,0,0],[1,1,0],[0,0,1]] over 3: |A|^2 = 4, |A^-1|^2 = 4.
    assert!((q.max_condition - 4.0 / 3.0).abs() < 1e-14);
    assert!((q.max_edge_ratio - 2f64.sqrt()).abs() < 1e-15);
}

#[test]
fn overlap_is_excluded_where_it_is_and_only_there() {
    let run = |s: &Sample, points: &[[f64; 3]]| {
        let input = s.judged().with_points(points);
        let report = judge(&input, &Options::default().with_overlap(true), &Context::default());
        assert!(report.passed(Level::L5), "{report}");
        report.geometry.unwrap().overlap.unwrap()
    };
    // A block with moved vertices, and one as it is (coplanar neighbours).
    let size = [5, 4, 3];
    let (s, mut points) = (grid(size), grid_points(size));
    let found = run(&s, &points);
    assert!(found.injective && found.pairs > 100, "{found:?}");
    let mut random = Random(3);
    for p in &mut points {
        *p = p.map(|x| x + 0.3 * (random.unit() - 0.5));
    }
    let found = run(&s, &points);
    assert!(found.injective, "{found:?}");
    // A bar bent into a ring: apart by a little, and over its own start by a little.
    let n = 40;
    let bar = grid([n, 1, 1]);
    let bent = |turn: f64| -> Vec<[f64; 3]> {
        grid_points([n, 1, 1])
            .iter()
            .map(|p| {
                let (angle, radius) = (turn * p[0] / n as f64, 5.0 - p[1]);
                [radius * angle.cos(), radius * angle.sin(), p[2]]
            })
            .collect()
    };
    let full = 2.0 * std::f64::consts::PI;
    let mirrored = |points: Vec<[f64; 3]>| points.into_iter().map(|p| [p[0], p[1], -p[2]]).collect::<Vec<_>>();
    let positive = |points: Vec<[f64; 3]>| {
        let input = bar.judged().with_points(&points);
        let ok = judge(&input, &Options::default(), &Context::default()).passed(Level::L5);
        if ok { points } else { mirrored(points) }
    };
    let found = run(&bar, &positive(bent(full - 0.02)));
    assert!(found.injective, "{found:?}");
    let found = run(&bar, &positive(bent(full + 0.05)));
    assert!(!found.injective && found.not_separated > 0 && !found.first.is_empty(), "{found:?}");
}
