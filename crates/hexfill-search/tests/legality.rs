//! The pair table against the judge: a flip is legal exactly if the mesh with the new hex is a proper ball.
//! (A hex that meets the ball in a disk and, besides, in an edge can be proper, but what it makes is no ball.)

use hexfill_check::{Ball, Judged, Level, Options, judge};
use hexfill_mesh::Context;
use hexfill_mesh::cube::FACETS;
use hexfill_search::{Cavity, Flip, FlipKind, MAX_QUADS, MAX_VERTICES, Placement, apply, is_legal, legal_flips, place};
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
    let options = Options::default().with_up_to(Level::L3).with_quality(false);
    let report = judge(&Judged::connectivity(n_vertices as usize, hexes), &options, &Context::default());
    report.passed(Level::L3) && report.facts.ball == Some(Ball::Yes)
}

/// A generator of numbers below a limit.
fn random_from(mut state: u64) -> impl FnMut(usize) -> usize {
    move |limit: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % limit
    }
}

/// Asks the judge about every legal flip of a ball and a sample of the others (one in `sample` of the illegal and the legal ones),
/// and counts them by kind and legality.
fn compare(ball: &Grown, cap: usize, sample: [usize; 2], random: &mut impl FnMut(usize) -> usize) -> [[usize; 2]; 6] {
    let mut compared = [[0usize; 2]; 6];
    let names: BTreeSet<Flip> = legal_flips(&ball.outside, cap).iter().map(|p| p.flip).collect();
    let quads: BTreeSet<[u8; 4]> = ball.outside.quads().iter().map(|q| sorted(*q)).collect();
    let mut degrees = [0; MAX_VERTICES];
    ball.outside.quads().iter().flatten().for_each(|&v| degrees[usize::from(v)] += 1);
    for kind in FlipKind::ALL {
        for dart in 0..4 * ball.outside.n_quads() as u8 {
            let flip = Flip { kind, dart };
            let Some(placement) = place(&ball.outside, &degrees, flip) else { continue };
            // The last kind is too rare to be sampled.
            if kind != FlipKind::FiveToOne && random(sample[usize::from(names.contains(&flip))]) != 0 {
                continue;
            }
            let (hex, fresh) = with_hex(ball, placement.corners);
            let mut hexes = ball.hexes.clone();
            hexes.push(hex);
            let proper = is_proper_ball(&hexes, ball.n_vertices + fresh);
            let touched = FACETS.iter().filter(|f| quads.contains(&sorted(f.map(|i| placement.corners[i])))).count();
            let covers = [1, 2, 3, 3, 4, 5][kind as usize];
            // A hex that happens to touch more quads than its kind covers is another flip, listed there or no disk.
            let legal = proper && touched == covers;
            assert_eq!(is_marked_legal(&ball.outside, &placement), legal, "{flip:?} {hex:?} on {:?}", ball.hexes);
            compared[kind as usize][usize::from(legal)] += 1;
        }
    }
    compared
}

impl Grown {
    fn cube() -> Self {
        Self { hexes: vec![[0, 1, 2, 3, 4, 5, 6, 7]], n_vertices: 8, outside: Cavity::cube(), ids: (0..8).collect() }
    }

    fn after(mut self, placement: &Placement) -> Self {
        let (hex, fresh) = with_hex(&self, placement.corners);
        let (outside, before) = apply(&self.outside, placement);
        let old = self.ids.len();
        let id = |v: u8| {
            let v = usize::from(v);
            if v < old { self.ids[v] } else { self.n_vertices + (v - old) as u32 }
        };
        let ids = before[..outside.n_vertices()].iter().map(|&v| id(v)).collect();
        self.hexes.push(hex);
        Self { n_vertices: self.n_vertices + fresh, outside, ids, ..self }
    }

    /// The outside's quads in mesh vertices are those the hexes leave open.
    fn check_outside(&self) {
        self.outside.debug_check();
        let mut open = BTreeSet::new();
        for hex in &self.hexes {
            for facet in FACETS {
                let mut q = facet.map(|i| hex[i]);
                q.sort_unstable();
                if !open.remove(&q) {
                    open.insert(q);
                }
            }
        }
        let outside = self.outside.quads().into_iter().map(|q| {
            let mut q = q.map(|v| self.ids[usize::from(v)]);
            q.sort_unstable();
            q
        });
        assert_eq!(outside.collect::<BTreeSet<_>>(), open);
    }
}

fn add(total: &mut [[usize; 2]; 6], more: [[usize; 2]; 6]) {
    total.iter_mut().flatten().zip(more.as_flattened()).for_each(|(a, b)| *a += b);
}

#[test]
fn a_flip_is_legal_exactly_if_the_judge_finds_a_proper_ball() {
    let mut random = random_from(7);
    let mut compared = [[0usize; 2]; 6];
    for _ in 0..60 {
        let mut ball = Grown::cube();
        for _ in 0..14 {
            add(&mut compared, compare(&ball, 22, [6, 1], &mut random));
            let legal = legal_flips(&ball.outside, 22);
            let Some(placement) = legal.get(random(legal.len().max(1))) else { break };
            ball = ball.after(placement);
        }
        assert!(is_proper_ball(&ball.hexes, ball.n_vertices), "{:?}", ball.hexes);
    }
    assert!(
        compared[1..].iter().all(|c| c[0] > 50 && c[1] > 50),
        "legal and illegal flips of every kind but 1->5, which is always legal: {compared:?}"
    );
}

/// The tables of a cavity are full at the limit: a flip may bring vertices before it buries others.
#[test]
fn flips_of_cavities_up_to_the_limit_are_right() {
    let mut random = random_from(11);
    let mut compared = [[0usize; 2]; 6];
    let mut at_the_limit = [0usize; 6];
    for _ in 0..12 {
        let mut ball = Grown::cube();
        let mut full = 0;
        for _ in 0..200 {
            let n = ball.outside.n_quads();
            if n >= MAX_QUADS - 4 {
                full += 1;
                add(&mut compared, compare(&ball, MAX_QUADS, [40, 8], &mut random));
            }
            // Every flip of a full cavity comes out whole.
            let legal = legal_flips(&ball.outside, MAX_QUADS);
            if n == MAX_QUADS {
                for placement in &legal {
                    ball.clone().after(placement).check_outside();
                    at_the_limit[placement.flip.kind as usize] += 1;
                }
            }
            if full == 12 {
                break;
            }
            // Grow quickly, then wander below the limit.
            let growing: Vec<_> = legal.iter().filter(|p| p.flip.kind.gain() > 0).collect();
            let placement = if growing.is_empty() || full > 0 {
                &legal[random(legal.len())]
            } else {
                growing[random(growing.len())]
            };
            ball = ball.after(placement);
            ball.check_outside();
        }
        assert_eq!(full, 12);
    }
    assert!(compared[..5].iter().all(|c| c[1] > 10), "legal flips of every kind but the rarest: {compared:?}");
    assert!(at_the_limit[FlipKind::Corner as usize] > 100, "{at_the_limit:?}");
    assert_eq!(at_the_limit[..2], [0, 0], "nothing grows beyond the limit");
}

fn sorted(mut q: [u8; 4]) -> [u8; 4] {
    q.sort_unstable();
    q
}

/// The pair table rebuilt from the cavity's public face: edges and diagonals of its quads, and its blocked pairs.
fn is_marked_legal(outside: &Cavity, placement: &Placement) -> bool {
    let mut marked = [0u64; MAX_VERTICES];
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
