//! Properties: brute force and a plain matrix agree with the judge; names and orders do not matter.

mod common;

use common::*;
use hexfill_check::{Ball, Judged, Level, Options, Report, Rule, judge};
use hexfill_mesh::{Context, cube};
use proptest::prelude::*;
use std::collections::{BTreeMap, BTreeSet};

/// Two hexes share nothing, a vertex, an edge of both or a quad of both: by listing all cells.
fn proper(a: &[u32; 8], b: &[u32; 8]) -> bool {
    let shared: BTreeSet<u32> = a.iter().copied().filter(|v| b.contains(v)).collect();
    let is_edge = |h: &[u32; 8]| cube::EDGES.iter().any(|e| e.iter().map(|&k| h[k]).collect::<BTreeSet<_>>() == shared);
    let cycle = |h: &[u32; 8]| -> Option<BTreeSet<[u32; 2]>> {
        let f = cube::FACETS.iter().find(|f| f.iter().map(|&k| h[k]).collect::<BTreeSet<_>>() == shared)?;
        Some((0..4).map(|i| [h[f[i]].min(h[f[(i + 1) % 4]]), h[f[i]].max(h[f[(i + 1) % 4]])]).collect())
    };
    match shared.len() {
        0 | 1 => true,
        2 => is_edge(a) && is_edge(b),
        4 => cycle(a).is_some() && cycle(a) == cycle(b),
        _ => false,
    }
}

/// Betti numbers by ranks of dense boundary matrices over GF(2), cells named by their vertex sets.
fn betti_by_matrices(hexes: &[[u32; 8]]) -> [u64; 4] {
    let mut cells: [BTreeMap<Vec<u32>, usize>; 4] = Default::default();
    let set = |ids: Vec<u32>| {
        let mut ids = ids;
        ids.sort_unstable();
        ids
    };
    let mut boundary: [BTreeMap<Vec<u32>, BTreeSet<Vec<u32>>>; 4] = Default::default();
    for hex in hexes {
        let facets: BTreeSet<Vec<u32>> =
            cube::FACETS.iter().map(|f| set(f.iter().map(|&k| hex[k]).collect())).collect();
        boundary[3].insert(set(hex.to_vec()), facets);
        for f in cube::FACETS {
            let sides = (0..4).map(|i| set(vec![hex[f[i]], hex[f[(i + 1) % 4]]])).collect();
            boundary[2].insert(set(f.iter().map(|&k| hex[k]).collect()), sides);
        }
        for e in cube::EDGES {
            boundary[1].insert(set(vec![hex[e[0]], hex[e[1]]]), e.iter().map(|&k| vec![hex[k]]).collect());
        }
        for &v in hex {
            boundary[0].insert(vec![v], BTreeSet::new());
        }
    }
    for (d, of) in boundary.iter().enumerate() {
        cells[d] = of.keys().enumerate().map(|(i, k)| (k.clone(), i)).collect();
    }
    let mut ranks = [0u64; 5];
    for d in 1..4 {
        let mut rows: Vec<Vec<bool>> = boundary[d]
            .values()
            .map(|sides| {
                let mut row = vec![false; cells[d - 1].len()];
                sides.iter().for_each(|s| row[cells[d - 1][s]] ^= true);
                row
            })
            .collect();
        let mut rank = 0;
        for column in 0..cells[d - 1].len() {
            if let Some(p) = (rank..rows.len()).find(|&r| rows[r][column]) {
                rows.swap(rank, p);
                let pivot = rows[rank].clone();
                for row in rows[rank + 1..].iter_mut().filter(|r| r[column]) {
                    row.iter_mut().zip(&pivot).for_each(|(a, b)| *a ^= b);
                }
                rank += 1;
            }
        }
        ranks[d] = rank as u64;
    }
    std::array::from_fn(|d| boundary[d].len() as u64 - ranks[d] - ranks[d + 1])
}

fn connectivity(n: usize, hexes: &[[u32; 8]]) -> Report {
    judge(&Judged::connectivity(n, hexes), &Options::default(), &Context::default())
}

fn samples() -> Vec<Sample> {
    let bare = |(n, hexes): (usize, Vec<[u32; 8]>)| Sample { n, hexes, surface: vec![] };
    let mut hollow = grid([3, 3, 3]);
    hollow.hexes.remove(13);
    let mut drilled = grid([3, 3, 2]);
    drilled.hexes.remove(13);
    drilled.hexes.remove(4);
    let mut all = vec![
        grid([1, 1, 1]),
        grid([3, 3, 3]),
        template("refine_9to1_13"),
        template("refine_16to4_28"),
        tesseract_minus_cube(),
        bare((16, tesseract())),
        bare(ring(5, 0, false)),
        bare(ring(6, 1, false)),
        bare(ring(5, 0, true)),
        bare(cone(&torus())),
        bare(cone(&annulus())),
        bare(cone(&moebius())),
        hollow,
        drilled,
    ];
    for s in &mut all {
        s.surface.clear();
    }
    all
}

/// A 3-torus of n^3 cubes: b = 1 3 3 1.
fn three_torus(n: u32) -> (usize, Vec<[u32; 8]>) {
    let id = |x: u32, y: u32, z: u32| x % n + n * (y % n + n * (z % n));
    let mut hexes = Vec::new();
    for z in 0..n {
        for y in 0..n {
            for x in 0..n {
                let level = |z| [id(x, y, z), id(x + 1, y, z), id(x + 1, y + 1, z), id(x, y + 1, z)];
                let (a, b) = (level(z), level(z + 1));
                hexes.push([a[0], a[1], a[2], a[3], b[0], b[1], b[2], b[3]]);
            }
        }
    }
    ((n * n * n) as usize, hexes)
}

#[test]
fn betti_numbers_agree_with_matrices() {
    for s in samples() {
        let report = connectivity(s.n, &s.hexes);
        assert_eq!(report.facts.betti, Some(betti_by_matrices(&s.hexes)), "{report}");
    }
    let (n, hexes) = three_torus(4);
    let report = connectivity(n, &hexes);
    assert_eq!(report.facts.betti, Some([1, 3, 3, 1]), "{report}");
    assert_eq!(betti_by_matrices(&hexes), [1, 3, 3, 1]);
    assert!(report.passed(Level::L3));
}

#[test]
fn balls_are_known_as_such() {
    for s in [grid([1, 1, 1]), grid([7, 6, 5]), template("refine_9to1_13"), tesseract_minus_cube()] {
        assert_eq!(connectivity(s.n, &s.hexes).facts.ball, Some(Ball::Yes));
    }
    let (n, hexes) = ring(5, 0, false);
    assert_eq!(connectivity(n, &hexes).facts.ball, Some(Ball::No));
    let mut hollow = grid([3, 3, 3]);
    hollow.hexes.remove(13);
    let report = connectivity(hollow.n, &hollow.hexes);
    assert_eq!((report.facts.ball, report.facts.betti), (Some(Ball::No), Some([1, 0, 1, 0])));
    assert_eq!(report.facts.boundary.as_ref().unwrap().len(), 2);
}

const PAIR_RULES: [Rule; 6] = [
    Rule::HexDuplicated,
    Rule::EdgeIsFaceDiagonal,
    Rule::EdgeIsBodyDiagonal,
    Rule::FaceDiagonalOfTwoQuads,
    Rule::FaceDiagonalIsBodyDiagonal,
    Rule::BodyDiagonalShared,
];

/// A few hexes on few vertices: random ones, and neighbours glued on and then spoiled.
fn complexes() -> impl Strategy<Value = (usize, Vec<[u32; 8]>)> {
    (1u64..u64::MAX, 9usize..40, 2usize..7).prop_map(|(seed, n, count)| {
        let mut random = Random(seed);
        let mut hexes: Vec<[u32; 8]> = Vec::new();
        for _ in 0..count {
            let mut ids: Vec<u32> = (0..n as u32).collect();
            random.shuffle(&mut ids);
            let mut hex: [u32; 8] = std::array::from_fn(|i| ids[i]);
            // Often keep a vertex, an edge or a quad of an earlier hex, sometimes in a wrong place.
            if !hexes.is_empty() && random.below(8) > 0 {
                let other = hexes[random.below(hexes.len())];
                let symmetry = cube::symmetries()[random.below(48)];
                let keep: &[usize] = match random.below(5) {
                    0 => &[0],
                    1 => &[0, 1],
                    2 => &[0, 2],
                    3 => &[0, 1, 3],
                    _ => &[0, 1, 2, 3],
                };
                let fresh: Vec<u32> = ids.iter().copied().filter(|v| !other.contains(v)).collect();
                let filler = if fresh.len() >= 8 && random.below(4) > 0 { &fresh } else { &ids };
                let kept: Vec<u32> = keep.iter().map(|&k| other[symmetry[k]]).collect();
                let mut rest = filler.iter().copied().filter(|v| !kept.contains(v));
                for (k, slot) in hex.iter_mut().enumerate() {
                    *slot = match keep.iter().position(|&i| i == k) {
                        Some(i) => kept[i],
                        None => rest.next().unwrap(),
                    };
                }
                if random.below(6) == 0 {
                    hex.swap(random.below(8), random.below(8));
                }
            }
            hexes.push(hex);
        }
        (n, hexes)
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, ..ProptestConfig::default() })]

    /// The lemma of `topology/star.rs`, against all pairs of hexes.
    #[test]
    fn pair_kinds_are_proper_intersection((n, hexes) in complexes()) {
        let report = judge(&Judged::connectivity(n, &hexes), &Options::default().with_up_to(Level::L2), &Context::default());
        let by_force = (0..hexes.len()).all(|i| (0..i).all(|j| proper(&hexes[i], &hexes[j])));
        let by_pairs = !PAIR_RULES.iter().any(|&r| report.breaks(r));
        prop_assert_eq!(by_force, by_pairs, "{}", report);
        let twisted = (0..hexes.len()).flat_map(|i| (0..i).map(move |j| (i, j))).any(|(i, j)| {
            let quads = |h: &[u32; 8]| cube::FACETS.map(|f| {
                let c = f.map(|k| h[k]);
                let mut set = c;
                set.sort_unstable();
                (set, [c[0].min(c[2]), c[0].max(c[2])], [c[1].min(c[3]), c[1].max(c[3])])
            });
            quads(&hexes[i]).iter().any(|a| quads(&hexes[j]).iter().any(|b| a.0 == b.0 && a.1 != b.1 && a.1 != b.2))
        });
        prop_assert_eq!(twisted, report.breaks(Rule::QuadTwisted), "{}", report);
    }

    /// Random subsets of a grid: pinched everywhere, but never improper; Betti numbers as by matrices.
    #[test]
    fn betti_numbers_of_random_subsets(seed in 1u64..u64::MAX, keep in 2usize..9) {
        let mut random = Random(seed);
        let mut s = grid([3, 3, 3]);
        s.hexes.retain(|_| random.below(10) < keep);
        prop_assume!(!s.hexes.is_empty());
        let report = connectivity(s.n, &s.hexes);
        prop_assert!(report.passed(Level::L2));
        let betti = report.facts.betti.unwrap();
        prop_assert_eq!(betti, betti_by_matrices(&s.hexes));
        let euler = betti[0] as i64 - betti[1] as i64 + betti[2] as i64 - betti[3] as i64;
        prop_assert_eq!(report.facts.euler, Some(euler));
    }

    /// Links of random subsets of a grid, against octants: round a grid vertex the link is a disk or sphere iff the occupied
    /// octants and the empty ones are each connected through faces and no axis has a chequered pattern.
    #[test]
    fn links_of_random_subsets(seed in 1u64..u64::MAX, keep in 2usize..9) {
        let n = 4usize;
        let mut random = Random(seed);
        let full = grid([n, n, n]);
        let taken: Vec<bool> = (0..n * n * n).map(|_| random.below(10) < keep).collect();
        let hexes: Vec<[u32; 8]> = full.hexes.iter().zip(&taken).filter(|x| *x.1).map(|x| *x.0).collect();
        prop_assume!(!hexes.is_empty());
        let occupied = |x: i32, y: i32, z: i32| {
            let inside = [x, y, z].iter().all(|c| (0..n as i32).contains(c));
            inside && taken[(x + n as i32 * (y + n as i32 * z)) as usize]
        };
        let (mut pinched_ends, mut split, mut disks) = (0u64, 0u64, 0u64);
        for v in 0..full.n {
            let at = [v % (n + 1), v / (n + 1) % (n + 1), v / (n + 1) / (n + 1)].map(|c| c as i32);
            let octants: Vec<bool> = (0..8)
                .map(|o| occupied(at[0] - 1 + (o & 1), at[1] - 1 + (o >> 1 & 1), at[2] - 1 + (o >> 2)))
                .collect();
            // Each of the six half-axes: the four octants round it, in order.
            let mut chequered = 0;
            for axis in 0..3 {
                for side in 0..2 {
                    let bit = |a: usize, b: usize| side << axis | a << ((axis + 1) % 3) | b << ((axis + 2) % 3);
                    let round = [bit(0, 0), bit(1, 0), bit(1, 1), bit(0, 1)].map(|o| octants[o]);
                    chequered += u64::from(round[0] == round[2] && round[1] == round[3] && round[0] != round[1]);
                }
            }
            pinched_ends += chequered;
            let pieces = |value: bool, corners: bool| {
                let mut left: BTreeSet<usize> = (0..8).filter(|&o| octants[o] == value).collect();
                let mut count = 0;
                while let Some(first) = left.pop_first() {
                    count += 1;
                    let mut stack = vec![first];
                    while let Some(o) = stack.pop() {
                        let near: Vec<usize> = left.iter().copied().filter(|&p| {
                            let apart = (o ^ p).count_ones();
                            apart == 1 || (corners && apart == 2)
                        }).collect();
                        near.iter().for_each(|p| { left.remove(p); });
                        stack.extend(near);
                    }
                }
                count
            };
            // Octants that share only an edge are still joined in the link, through the pinched vertex.
            if pieces(true, true) > 1 {
                split += 1;
            } else if chequered == 0 && pieces(true, false) == 1 && pieces(false, false) > 1 {
                disks += 1;
            }
        }
        let report = connectivity(full.n, &hexes);
        let count = |rule| report.failure(rule).map_or(0, |f| f.count);
        prop_assert_eq!(2 * count(Rule::EdgePinched), pinched_ends, "{}", &report);
        prop_assert_eq!(count(Rule::VertexPinched), split, "{}", &report);
        prop_assert_eq!(count(Rule::VertexLinkNotDisk), disks, "{}", &report);
        prop_assert_eq!(count(Rule::VertexLinkNotSphere), 0);
    }

    /// Relabelling vertices, turning hexes' frames and permuting hexes change neither verdict nor facts.
    #[test]
    fn names_and_orders_do_not_matter(which in 0usize..14, seed in 1u64..u64::MAX, spoil in 0usize..4) {
        let mut random = Random(seed);
        let mut s = samples().swap_remove(which);
        if spoil > 0 && s.hexes.len() > 1 {
            let h = random.below(s.hexes.len());
            match spoil {
                1 => { s.hexes.remove(h); }
                2 => { let (i, j) = (random.below(8), random.below(8)); s.hexes[h].swap(i, j); }
                _ => {
                    let (from, to) = (random.below(s.n) as u32, random.below(s.n) as u32);
                    let merged = |hex: &[u32; 8]| hex.map(|v| if v == from { to } else { v });
                    if s.hexes.iter().all(|h| !(h.contains(&from) && h.contains(&to))) {
                        s.hexes = s.hexes.iter().map(merged).collect();
                    }
                }
            }
        }
        let before = connectivity(s.n, &s.hexes);
        let mut names: Vec<u32> = (0..s.n as u32).collect();
        random.shuffle(&mut names);
        let mut hexes: Vec<[u32; 8]> = s.hexes.iter().map(|h| {
            let frame = cube::symmetries()[random.below(24)];
            frame.map(|k| names[h[k] as usize])
        }).collect();
        random.shuffle(&mut hexes);
        let after = connectivity(s.n, &hexes);
        let counts = |r: &Report| r.failures.iter().map(|f| (f.rule, f.count)).collect::<Vec<_>>();
        prop_assert_eq!(&before.levels, &after.levels);
        let bare = |r: &Report| counts(r).into_iter().filter(|f| f.0 != Rule::HexReflected).collect::<Vec<_>>();
        prop_assert_eq!(bare(&before), bare(&after));
        let mut facts = after.facts.clone();
        // A collapse may be found for one order of the hexes and not for another; homology is the same.
        facts.ball = before.facts.ball;
        prop_assert_eq!(&before.facts, &facts);
    }
}

#[test]
fn the_report_is_the_same_for_any_number_of_threads() {
    let mut s = grid([12, 11, 10]);
    let mut random = Random(5);
    random.shuffle(&mut s.hexes);
    for _ in 0..40 {
        let (h, i, j) = (random.below(s.hexes.len()), random.below(8), random.below(8));
        s.hexes[h].swap(i, j);
    }
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| s.report().to_json())
    };
    let one = run(1);
    assert!(run(2) == one && run(5) == one);
}
