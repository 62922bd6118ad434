//! The pair table against the judge: a flip is legal exactly if the mesh with the new hex is a proper ball.
//! (A hex that meets the ball in a disk and, besides, in an edge can be proper, but what it makes is no ball.)

use hexfill_check::{Ball, Judged, Level, Options, judge};
use hexfill_mesh::Context;
use hexfill_mesh::cube::FACETS;
use hexfill_search::{Cavity, Flip, FlipKind, apply, is_legal, legal_flips, place};
use std::collections::BTreeSet;

/// A ball with its outside, grown without canonical forms.
#[derive(Clone)]
struct Grown {
    hexes: Vec<[u32; 8]>,
    n_vertices: u32,
    outside: Cavity,
    ids: Vec<u32>,
}

fn with_hex(ball: &Grown, corners: [u8; 8]) -> ([u32; 8], u32) {
    let old = ball.ids.len();
    let hex = corners.map(|c| {
        let c = usize::from(c);
        if c < old { ball.ids[c] } else { ball.n_vertices + (c - old) as u32 }
    });
    let fresh = corners.iter().filter(|&&c| usize::from(c) >= old).count() as u32;
    (hex, fresh)
}

fn is_proper_ball(hexes: &[[u32; 8]], n_vertices: u32) -> bool {
    let options = Options::default().up_to(Level::L3).quality(false);
    let report = judge(&Judged::connectivity(n_vertices as usize, hexes), &options, &Context::default());
    report.passed(Level::L3) && report.facts.ball == Some(Ball::Yes)
}

#[test]
fn a_flip_is_legal_exactly_if_the_judge_finds_a_proper_ball() {
    let mut state = 7u64;
    let mut random = move |limit: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % limit
    };
    let mut compared = [[0usize; 2]; 6];
    for _ in 0..60 {
        let mut ball = Grown {
            hexes: vec![[0, 1, 2, 3, 4, 5, 6, 7]],
            n_vertices: 8,
            outside: Cavity::cube(),
            ids: (0..8).collect(),
        };
        for _ in 0..14 {
            let legal = legal_flips(&ball.outside, 22);
            let names: BTreeSet<Flip> = legal.iter().map(|p| p.flip).collect();
            let quads: BTreeSet<[u8; 4]> = ball.outside.quads().iter().map(|q| sorted(*q)).collect();
            let mut degrees = [0; hexfill_search::MAX_VERTICES];
            ball.outside.quads().iter().flatten().for_each(|&v| degrees[usize::from(v)] += 1);
            for kind in FlipKind::ALL {
                for dart in 0..4 * ball.outside.n_quads() as u8 {
                    let flip = Flip { kind, dart };
                    let Some(placement) = place(&ball.outside, &degrees, flip) else { continue };
                    // A sample of the illegal ones, every listed one.
                    if !names.contains(&flip) && random(6) != 0 {
                        continue;
                    }
                    let (hex, fresh) = with_hex(&ball, placement.corners);
                    let mut hexes = ball.hexes.clone();
                    hexes.push(hex);
                    let proper = is_proper_ball(&hexes, ball.n_vertices + fresh);
                    let touched =
                        FACETS.iter().filter(|f| quads.contains(&sorted(f.map(|i| placement.corners[i])))).count();
                    let covers = [1, 2, 3, 3, 4, 5][kind as usize];
                    // A hex that happens to touch more quads than its kind covers is another flip, listed there or no disk.
                    let legal = proper && touched == covers;
                    assert_eq!(
                        is_marked_legal(&ball.outside, &placement),
                        legal,
                        "{flip:?} {hex:?} on {:?}",
                        ball.hexes
                    );
                    compared[kind as usize][usize::from(legal)] += 1;
                }
            }
            let Some(placement) = legal.get(random(legal.len().max(1))) else { break };
            let (hex, fresh) = with_hex(&ball, placement.corners);
            let (outside, before) = apply(&ball.outside, placement);
            let old = ball.ids.len();
            let ids = before[..outside.n_vertices()]
                .iter()
                .map(|&v| {
                    if usize::from(v) < old {
                        ball.ids[usize::from(v)]
                    } else {
                        ball.n_vertices + u32::from(v) - old as u32
                    }
                })
                .collect();
            ball.hexes.push(hex);
            ball = Grown { n_vertices: ball.n_vertices + fresh, outside, ids, ..ball };
        }
        assert!(is_proper_ball(&ball.hexes, ball.n_vertices), "{:?}", ball.hexes);
    }
    assert!(
        compared[1..].iter().all(|c| c[0] > 50 && c[1] > 50),
        "legal and illegal flips of every kind but 1->5, which is always legal: {compared:?}"
    );
}

fn sorted(mut q: [u8; 4]) -> [u8; 4] {
    q.sort_unstable();
    q
}

/// The pair table rebuilt from the cavity's public face: edges and diagonals of its quads, and its blocked pairs.
fn is_marked_legal(outside: &Cavity, placement: &hexfill_search::Placement) -> bool {
    let mut marked = [0u64; hexfill_search::MAX_VERTICES];
    let mut mark = |a: u8, b: u8| {
        marked[usize::from(a)] |= 1 << b;
        marked[usize::from(b)] |= 1 << a;
    };
    for q in outside.quads() {
        for (i, &a) in q.iter().enumerate() {
            q[i + 1..].iter().for_each(|&b| mark(a, b));
        }
    }
    outside.blocked_list().iter().for_each(|&[a, b]| mark(a, b));
    is_legal(placement, &marked)
}
