//! scratch
use hexfill_enumerate::*;
use std::collections::HashSet;
fn main() {
    let top: usize = std::env::args().nth(1).map_or(6, |s| s.parse().unwrap());
    let mut level = vec![Complex::cube()];
    for n in 2..=top {
        let t = std::time::Instant::now();
        let mut set = HashSet::new();
        let mut next = Vec::new();
        let mut raw = 0; let mut by = [0; 7];
        let mut minc = 999; let mut minq = 999; let mut le3 = 0;
        for p in &level {
            extend_weill(p, |c, g| {
                raw += 1; by[g as usize] += 1;
                let l = canonical(c);
                if set.insert(l.code) {
                    let b = Boundary::of(c);
                    let k = b.n_chords();
                    minc = minc.min(k); minq = minq.min(b.n_quads()); if k <= 3 { le3 += 1 }
                    next.push(*c);
                }
            });
        }
        println!("{n} classes {} raw {raw} {by:?} minc {minc} minq {minq} le3 {le3} {:?}", next.len(), t.elapsed());
        level = next;
    }
}
