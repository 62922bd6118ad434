//! scratch
use hexfill_enumerate::*;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let n: usize = a[1].parse().unwrap();
    let rule: Rule = a[2].parse().unwrap();
    let threads: usize = a[3].parse().unwrap();
    let mut p = Params::new(n, rule);
    p.nonorientable = a.get(4).is_some_and(|s| s == "nonor");
    let ctx = hexfill_mesh::Context::default();
    let t = std::time::Instant::now();
    let plan = Plan::prepare(&p, &LevelOptions { threads, narrow_hashes: false }, &ctx).unwrap();
    println!("nodes {} {:?}", plan.n_nodes(), t.elapsed());
    let chunks: Vec<Chunk> = (0..256).map(|index| Chunk { index, of: 256 }).collect();
    let mut tally = Tally::default();
    let mut cpu = 0;
    plan.run_all(&chunks, threads, Wanted::default(), &ctx, &mut |r| {
        tally.merge(&r.tally);
        cpu += r.cpu_nanoseconds;
        Ok(())
    })
    .unwrap();
    println!(
        "{n} {:?} cpu {} mass {} classes {} {:.2} us/obj le3 {}\n   {}",
        t.elapsed(),
        cpu as f64 / 1e9,
        tally.mass_balances(),
        tally.classes,
        cpu as f64 / 1e3 / tally.classes as f64,
        tally.with_at_most_chords(3),
        serde_json::to_string(&tally).unwrap()
    );
}
