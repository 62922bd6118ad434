//! The name of a cavity: its smallest breadth-first code, and the vertex numbers in it.
//!
//! Two cavities with one name are the same sphere up to mirror images; the numbers carry the blocked pairs over.

use hexfill_search::Cavity;

/// Blocked pairs as bits: pair (a, b), a < b, is bit `b (b - 1) / 2 + a`.
pub(crate) type Bits = Vec<u64>;

/// Whether every bit of `a` is one of `b`.
pub(crate) fn is_subset(a: &Bits, b: &Bits) -> bool {
    a.iter().zip(b).all(|(a, b)| a & !b == 0)
}

/// Code and blocked pairs in the code's numbers.
pub(crate) fn name(cavity: &Cavity) -> (Vec<u8>, Bits) {
    let quads = cavity.quads();
    let n = cavity.n_vertices();
    let twins = twins(&quads, n);
    let mut best: Option<(Vec<u8>, Vec<u8>)> = None;
    for (dart, mirrored) in rarest_flags(&quads, n) {
        if let Some(found) = code(&quads, &twins, n, dart, mirrored, best.as_ref().map(|b| b.0.as_slice())) {
            best = Some(found);
        }
    }
    let (code, number) = best.unwrap_or_default();
    let mut bits = vec![0; (n * (n - 1) / 2).div_ceil(64)];
    for [a, b] in cavity.blocked_list() {
        let (a, b) = (usize::from(number[usize::from(a)]), usize::from(number[usize::from(b)]));
        let (a, b) = (a.min(b), a.max(b));
        let bit = b * (b - 1) / 2 + a;
        bits[bit / 64] |= 1 << (bit % 64);
    }
    (code, bits)
}

/// Dart `4 q + i` is side `i` of quad `q`.
fn twins(quads: &[[u8; 4]], n: usize) -> Vec<usize> {
    let mut dart = vec![0; n * n];
    let ends = |d: usize| (usize::from(quads[d / 4][d % 4]), usize::from(quads[d / 4][(d + 1) % 4]));
    for d in 0..4 * quads.len() {
        let (a, b) = ends(d);
        dart[a * n + b] = d;
    }
    (0..4 * quads.len())
        .map(|d| {
            let (a, b) = ends(d);
            dart[b * n + a]
        })
        .collect()
}

/// The flags (dart, mirrored) of the rarest local kind.
fn rarest_flags(quads: &[[u8; 4]], n: usize) -> Vec<(usize, bool)> {
    let mut degree = vec![0u64; n];
    for v in quads.iter().flatten() {
        degree[usize::from(*v)] += 1;
    }
    let mut kind = degree.iter().map(|d| d << 40).collect::<Vec<u64>>();
    for q in quads {
        for i in 0..4 {
            let at = |k: usize| degree[usize::from(q[(i + k) % 4])];
            kind[usize::from(q[i])] += 3 * (at(1).pow(2) + at(3).pow(2)) + 7 * at(2).pow(3);
        }
    }
    let mut flags: Vec<([u64; 4], usize, bool)> = (0..4 * quads.len())
        .flat_map(|d| {
            let at = |k: usize| kind[usize::from(quads[d / 4][(d + k) % 4])];
            [([at(0), at(1), at(2), at(3)], d, false), ([at(1), at(0), at(3), at(2)], d, true)]
        })
        .collect();
    flags.sort_unstable();
    let rarest = flags.chunk_by(|a, b| a.0 == b.0).min_by_key(|c| c.len()).unwrap_or(&[]);
    rarest.iter().map(|f| (f.1, f.2)).collect()
}

/// The code of one flag, unless it is no smaller than `best`.
fn code(
    quads: &[[u8; 4]],
    twins: &[usize],
    n: usize,
    start: usize,
    mirrored: bool,
    best: Option<&[u8]>,
) -> Option<(Vec<u8>, Vec<u8>)> {
    let mut number = vec![u8::MAX; n];
    let mut next = 0;
    let mut seen = vec![false; quads.len()];
    seen[start / 4] = true;
    let mut entry = vec![start];
    let mut code = Vec::with_capacity(4 * quads.len());
    let mut smaller = best.is_none();
    let mut at = 0;
    while at < entry.len() {
        let mut d = entry[at];
        at += 1;
        for _ in 0..4 {
            let v = usize::from(quads[d / 4][(d + usize::from(mirrored)) % 4]);
            if number[v] == u8::MAX {
                number[v] = next;
                next += 1;
            }
            let other = best.map_or(0, |b| b[code.len()]);
            if !smaller && number[v] > other {
                return None;
            }
            smaller |= number[v] < other;
            code.push(number[v]);
            let across = twins[d];
            if !seen[across / 4] {
                seen[across / 4] = true;
                entry.push(across);
            }
            d = d / 4 * 4 + (d + if mirrored { 3 } else { 1 }) % 4;
        }
    }
    smaller.then_some((code, number))
}
