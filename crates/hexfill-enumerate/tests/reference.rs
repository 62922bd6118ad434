//! The reference numbers of the published table and of the design, by both engines; the mass formula; known meshes.

use hexfill_check::{Judged, Level as Ladder, Options, Rules, judge};
use hexfill_enumerate::{
    Boundary, Code, Complex, Filter, Keep, Level, LevelOptions, ListFormat, MASS_UNIT, Params, Plan, Rule, Selection,
    StrictOptions, Tally, Target, Wanted, all_levels, canonical, extend_strict, extend_weill, first_level, line,
    mesh_of, mirror_lines, next_level, run_whole, shape, strict_violations, weill_order, weill_violations,
};
use hexfill_mesh::Context;
use std::collections::{BTreeMap, BTreeSet};

/// Largest level of the slow checks: 7 with HEXFILL_SLOW=1, else 6.
fn top() -> usize {
    if std::env::var_os("HEXFILL_SLOW").is_some() { 7 } else { 6 }
}

fn levels(params: &Params, threads: usize) -> Vec<Tally> {
    let options = LevelOptions::default().with_threads(threads);
    let levels = all_levels(params, &options, Wanted::default(), false, &Context::default()).unwrap();
    levels.into_iter().map(|l| l.tally).collect()
}

/// A level with the codes of its classes.
fn classes(n: usize, rule: Rule) -> Level {
    let ctx = Context::default();
    let levels = all_levels(&Params::new(n, rule), &LevelOptions::default(), Wanted::default(), true, &ctx).unwrap();
    let level = levels.into_iter().next_back().unwrap();
    assert!(level.codes.len() as u64 == level.tally.classes && level.cubes == n);
    level
}

fn augmented(params: &Params) -> Tally {
    let ctx = Context::default();
    let plan = Plan::prepare(params, &LevelOptions::default(), &ctx).unwrap();
    run_whole(&plan, 2, Wanted::default(), &ctx).unwrap().0
}

#[test]
fn the_published_table_of_rule_weill() {
    // Cubes: classes, raw, min chords, min quads, classes with <= 3 chords, raw by glued facets.
    type Row = (u64, u64, u8, u8, u64, &'static [u64]);
    let table: [Row; 5] = [
        (6, 18, 4, 12, 0, &[10, 8]),
        (31, 212, 4, 12, 0, &[76, 130, 6]),
        (398, 1908, 3, 12, 1, &[498, 1348, 56, 6]),
        (9500, 34047, 3, 10, 27, &[7604, 25284, 1122, 35, 2]),
        (384_653, 1_116_045, 2, 6, 1103, &[210_554, 871_359, 33577, 545, 8, 2]),
    ];
    let found = levels(&Params::new(top(), Rule::Weill), 2);
    for (t, row) in found[2..].iter().zip(table) {
        let by_glued: Vec<u64> = t.raw_by_glued.0.values().copied().collect();
        let least = (t.chords.min().copied().unwrap(), t.boundary_quads.min().copied().unwrap());
        assert_eq!((t.classes, t.raw, least.0, least.1, t.with_at_most_chords(3), &by_glued[..]), row);
    }
}

#[test]
fn rule_strict_and_its_columns() {
    let counts = [1, 1, 6, 24, 240, 4026, 112_650];
    let distinct = [1, 1, 7, 29, 349, 6834, 210_252];
    let balls = [1, 1, 3, 12, 60, 441, 3987];
    for (n, t) in levels(&Params::new(top(), Rule::Strict), 2).iter().enumerate() {
        assert_eq!((t.classes, t.classes + t.chiral, t.balls), (counts[n], distinct[n], balls[n]), "{} cubes", n + 1);
    }
    let nonorientable = [1, 1, 8, 35, 442, 9450, 348_403];
    let params = Params { nonorientable: true, ..Params::new(top(), Rule::Strict) };
    for (n, t) in levels(&params, 2).iter().enumerate() {
        assert_eq!(t.classes, nonorientable[n], "{} cubes", n + 1);
    }
}

#[test]
fn both_engines_agree_and_the_mass_formula_balances() {
    for (rule, nonorientable) in [(Rule::Strict, false), (Rule::Strict, true), (Rule::Weill, false)] {
        for n in 1..=top() {
            let params = Params { nonorientable, ..Params::new(n, rule) };
            let by_level = levels(&params, 1).pop().unwrap();
            let mut by_augmentation = augmented(&params);
            assert!(by_augmentation.mass_balances(), "{params:?}");
            if rule == Rule::Strict {
                assert!(by_level.mass_balances(), "{params:?}");
                // Augmentation makes only the children with the fewest glued facets; classes must agree in everything.
                by_augmentation.raw = by_level.raw;
                by_augmentation.raw_by_glued = by_level.raw_by_glued.clone();
            }
            by_augmentation.mass_of_children = by_level.mass_of_children;
            by_augmentation.mass_of_parents = by_level.mass_of_parents;
            by_augmentation.parents = by_level.parents;
            assert_eq!(by_augmentation, by_level, "{params:?}");
        }
    }
}

#[test]
fn a_builder_without_merges_fails_the_mass_formula() {
    let found = |merges: bool| {
        let options = StrictOptions::default().with_merges(merges).with_fewest_first(false);
        let mut level = vec![canonical(&Complex::cube()).code];
        let mut rows = Vec::new();
        for _ in 2..=6 {
            let (mut parents, mut children) = (0, 0);
            let mut next = BTreeSet::new();
            for code in &level {
                let parent = code.decode().unwrap();
                let group = u128::from(canonical(&parent).automorphisms);
                extend_strict(&parent, options, |child, _| {
                    parents += MASS_UNIT / group;
                    let label = canonical(child);
                    if next.insert(label.code) {
                        // Removable cubes by the definition: the others stay connected.
                        let removable = (0..child.n_cubes()).filter(|&a| stays_connected(child, a)).count();
                        children += MASS_UNIT / u128::from(label.automorphisms) * removable as u128;
                    }
                });
            }
            level = next.into_iter().collect();
            rows.push((level.len(), parents == children));
        }
        rows
    };
    assert_eq!(found(true), [(1, true), (6, true), (24, true), (240, true), (4026, true)]);
    // The first miss is a ring of five bent cubes.
    let without = found(false);
    assert_eq!(without[2..].iter().map(|r| r.0).collect::<Vec<_>>(), [24, 239, 4006]);
    assert!(without.iter().any(|r| !r.1), "the mass formula must notice");
    assert!(!without[3].1 && !without[4].1);
}

/// Connectivity through common quads, from vertex sets alone.
fn stays_connected(c: &Complex, without: usize) -> bool {
    let sets: Vec<BTreeSet<u8>> = c.cubes().iter().map(|x| x.iter().copied().collect()).collect();
    let rest: Vec<usize> = (0..sets.len()).filter(|&a| a != without).collect();
    let mut seen = vec![rest[0]];
    let mut at = 0;
    while at < seen.len() {
        for &b in &rest {
            if !seen.contains(&b) && sets[seen[at]].intersection(&sets[b]).count() == 4 {
                seen.push(b);
            }
        }
        at += 1;
    }
    seen.len() == rest.len()
}

#[test]
fn every_mesh_passes_the_judge_under_the_rule_it_claims() {
    let ctx = Context::default();
    for (rule, rules) in [(Rule::Strict, Rules::Strict), (Rule::Weill, Rules::Weill)] {
        for n in 1..=top() {
            for code in &classes(n, rule).codes {
                let c = mesh_of(code, rule).unwrap();
                let cubes = c.cubes_wide();
                let options = Options::default().with_rules(rules).with_up_to(Ladder::L2);
                let report = judge(&Judged::connectivity(c.n_vertices(), &cubes), &options, &ctx);
                assert!(report.no_failure(), "{rule} {}: {report}", code.to_text());
                assert!(c.to_hex_mesh().is_ok());
                match rule {
                    Rule::Strict => assert!(strict_violations(&c).is_empty()),
                    Rule::Weill => assert!(weill_violations(&c).is_empty()),
                }
            }
        }
    }
}

/// A slow second method: every injective gluing of the new cube tried on vertex level, rules read off the design's words.
mod brute {
    use super::*;
    use hexfill_mesh::cube::{EDGES, FACETS};

    fn edge_of(cube: &[u8; 8], pair: &BTreeSet<u8>) -> bool {
        EDGES.iter().any(|e| e.iter().map(|&i| cube[i]).collect::<BTreeSet<_>>() == *pair)
    }

    fn facet_of(cube: &[u8; 8], set: &BTreeSet<u8>) -> bool {
        FACETS.iter().any(|f| f.iter().map(|&i| cube[i]).collect::<BTreeSet<_>>() == *set)
    }

    pub(crate) fn is_strict(cubes: &[[u8; 8]]) -> bool {
        cubes.iter().enumerate().all(|(a, x)| {
            let own: BTreeSet<u8> = x.iter().copied().collect();
            own.len() == 8
                && cubes[..a].iter().all(|y| {
                    let common: BTreeSet<u8> = y.iter().copied().filter(|v| own.contains(v)).collect();
                    match common.len() {
                        0 | 1 => true,
                        2 => edge_of(x, &common) && edge_of(y, &common),
                        4 => facet_of(x, &common) && facet_of(y, &common),
                        _ => false,
                    }
                })
        })
    }

    /// All children of a parent by brute force: each corner of the new cube is an old vertex or new, at least one facet is glued,
    /// no merging, old cubes unchanged; proper intersection, every quad in at most two cubes, glued consistently.
    pub(crate) fn children_without_merging(parent: &Complex) -> BTreeSet<Code> {
        let boundary = Boundary::of(parent);
        let mut out = BTreeSet::new();
        let old = parent.n_vertices() as u8;
        for quad in boundary.quads() {
            // The bottom is on this quad; the top is any choice of old boundary vertices and new ones.
            let mut top = [0u8; 4];
            loop {
                let mut fresh = old;
                let corners: [u8; 8] = std::array::from_fn(|i| {
                    if i < 4 {
                        quad[i]
                    } else if top[i - 4] == old {
                        fresh += 1;
                        fresh - 1
                    } else {
                        top[i - 4]
                    }
                });
                let mut cubes = parent.cubes().to_vec();
                cubes.push(corners);
                let repeated = (1..8).any(|i| corners[..i].contains(&corners[i]));
                // The vertices not on glued facets must be new: identifications come from gluing only.
                if !repeated
                    && is_strict(&cubes)
                    && let Ok(c) = Complex::from_cubes(&cubes)
                    && c.is_orientable()
                    && shared_vertices_are_glued(&cubes)
                {
                    out.insert(canonical(&c).code);
                }
                let Some(i) = (0..4).find(|&i| top[i] < old) else { break };
                top[i] += 1;
                top[..i].fill(0);
            }
        }
        out
    }

    fn shared_vertices_are_glued(cubes: &[[u8; 8]]) -> bool {
        let (new, others) = cubes.split_last().unwrap();
        new.iter().all(|v| {
            let shared = others.iter().any(|o| o.contains(v));
            let glued = FACETS.iter().any(|f| {
                let set: BTreeSet<u8> = f.iter().map(|&i| new[i]).collect();
                set.contains(v) && others.iter().any(|o| facet_of(o, &set))
            });
            !shared || glued
        })
    }
}

#[test]
fn brute_force_agrees_on_small_levels() {
    // Without merging, rule strict, from every class of up to 2 (slow: 3) cubes: the fast extension finds the same children.
    let options = StrictOptions::default().with_merges(false).with_fewest_first(false);
    let mut level = vec![Complex::cube()];
    for n in 1..=top() - 4 {
        let mut next = BTreeMap::new();
        for parent in &level {
            let mut fast = BTreeSet::new();
            extend_strict(parent, options, |child, _| {
                assert!(brute::is_strict(child.cubes()));
                let code = canonical(child).code;
                fast.insert(code);
                next.insert(code, *child);
            });
            assert_eq!(fast, brute::children_without_merging(parent), "{n} cubes");
        }
        level = next.into_values().collect();
    }
    // With merging, every child is strict in the words of the definition.
    for parent in &level {
        extend_strict(parent, StrictOptions::default().with_fewest_first(false), |child, _| {
            assert!(brute::is_strict(child.cubes()));
        });
    }
}

#[test]
fn the_posters_nine_cubes_with_one_chord() {
    let cubes = [
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
    let c = Complex::from_cubes(&cubes).unwrap();
    let s = shape(&c);
    assert_eq!((s.vertices, Boundary::of(&c).n_quads(), s.chords), (20, 22, 1));
    assert!(weill_order(&c).is_some(), "legal under rule weill");
    assert_eq!(strict_violations(&c).len(), 6, "{:?}", strict_violations(&c));
    // Every prefix is a legal step of rule weill in the order of the poster, and the extension makes it.
    for n in 2..=9 {
        let child = Complex::from_cubes(&cubes[..n]).unwrap();
        assert!(weill_violations(&child).is_empty());
        let wanted = canonical(&child).code;
        let parent = Complex::from_cubes(&cubes[..n - 1]).unwrap();
        let mut seen = false;
        extend_weill(&parent, |made, _| seen |= canonical(made).code == wanted);
        assert!(seen, "{n} cubes");
    }
    let target = Target::parse(&Boundary::of(&c).key().to_string()).unwrap();
    assert!(target.is(&Boundary::of(&c)));
}

#[test]
fn the_smallest_boundaries_of_seven_cubes() {
    // The tesseract minus a cube: six boundary quads, once among the strict complexes of seven cubes.
    if top() < 7 {
        return;
    }
    let selection = Selection { boundary_quads: Some((0, 6)), ..Selection::default() };
    let target = [Target::parse("6x[4,4]").unwrap()];
    let wanted = Wanted { selection: Some(&selection), list: true, targets: &target };
    let ctx = Context::default();
    let plan = Plan::prepare(&Params::new(7, Rule::Strict), &LevelOptions::default(), &ctx).unwrap();
    let (tally, found) = run_whole(&plan, 1, wanted, &ctx).unwrap();
    assert_eq!((tally.selected, found.selected.len(), found.targets.len()), (1, 1, 1));
    assert_eq!(canonical(&found.selected[0].decode().unwrap()).automorphisms, 48);
}

#[test]
fn settings_do_not_change_results() {
    let ctx = Context::default();
    let params = Params { filter: Some(Filter { max_chords: 4, from: 5 }), ..Params::new(6, Rule::Weill) };
    let everything = Selection::default();
    let wanted = Wanted { selection: Some(&everything), list: true, targets: &[] };
    let run = |threads, narrow_hashes| {
        let levels = all_levels(
            &params,
            &LevelOptions::default().with_threads(threads).with_narrow_hashes(narrow_hashes),
            wanted,
            false,
            &ctx,
        )
        .unwrap();
        levels.into_iter().map(|l| (l.tally, l.found)).collect::<Vec<_>>()
    };
    let one = run(1, false);
    assert_eq!(one, run(2, false));
    assert_eq!(one, run(3, true));
    assert_eq!(one[5].1.selected.len() as u64, one[5].0.classes);
    // The filter in both engines.
    let plan = Plan::prepare(&params, &LevelOptions::default(), &ctx).unwrap();
    let (tally, mut found) = run_whole(&plan, 2, wanted, &ctx).unwrap();
    found.selected.sort_unstable();
    assert_eq!((tally.classes, tally.hash_sum), (one[5].0.classes, one[5].0.hash_sum));
    assert_eq!(found, one[5].1);
}

#[test]
fn the_signatures_of_the_mesh_crate_tell_the_same_classes_apart() {
    // Another canonical form, by other code: as many names as classes, and the same groups.
    for rule in [Rule::Strict, Rule::Weill] {
        for n in 1..=5 {
            let level = classes(n, rule);
            let mut names = BTreeSet::new();
            for code in &level.codes {
                let mesh = code.decode().unwrap().to_hex_mesh().unwrap();
                names.insert(line(code, ListFormat::Signature, rule).unwrap());
                let group = hexfill_mesh::hex_automorphisms(&mesh).unwrap().len();
                let back = Complex::from_hex_mesh(&mesh).unwrap();
                let label = canonical(&back);
                assert_eq!((label.code, label.automorphisms as usize), (*code, group));
            }
            assert_eq!(names.len() as u64, level.tally.classes);
            let all = level.codes.iter().flat_map(|code| mirror_lines(code, ListFormat::Signature, rule).unwrap());
            assert_eq!(all.collect::<BTreeSet<_>>().len() as u64, level.tally.classes + level.tally.chiral);
        }
    }
}

#[test]
fn levels_one_by_one_are_all_levels() {
    let params = Params::new(4, Rule::Strict);
    let ctx = Context::default();
    let keep = Keep { codes: true, wanted: Wanted::default() };
    let mut level = first_level(&params, keep);
    for _ in 2..=4 {
        level = next_level(&params, &level.codes, &LevelOptions::default(), keep, &ctx).unwrap();
    }
    assert_eq!(level.tally, levels(&params, 1).pop().unwrap());
    assert_eq!(level.codes.len(), 24);
}
