//! scratch
use hexfill_enumerate::*;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let n: usize = a[1].parse().unwrap();
    let rule: Rule = a[2].parse().unwrap();
    let threads: usize = a[3].parse().unwrap();
    let narrow = a.get(4).is_some_and(|s| s == "narrow");
    let mut p = Params::new(n, rule);
    p.nonorientable = a.get(4).is_some_and(|s| s == "nonor");
    p.filter = a.get(5).map(|_| Filter { max_chords: 3, from: 8 });
    let opts = LevelOptions { threads, narrow_hashes: narrow };
    let ctx = hexfill_mesh::Context::default();
    let mut level = first_level(&p, Keep { codes: true, ..Default::default() });
    for m in 1..=n {
        let t = std::time::Instant::now();
        if m > 1 {
            level = next_level(&p, &level.codes, &opts, Keep { codes: m < n, ..Default::default() }, &ctx).unwrap();
        }
        println!(
            "{m} {:?} set {} mass {} le3 {}\n   {}",
            t.elapsed(),
            level.set_bytes,
            level.tally.mass_balances(),
            level.tally.with_at_most_chords(3),
            serde_json::to_string(&level.tally).unwrap()
        );
    }
}
