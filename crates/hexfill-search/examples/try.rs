use hexfill_search::*;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let mut g = Growth::new(GrowOptions { cap: a[1].parse().unwrap(), width: a[2].parse().unwrap() });
    let t = std::time::Instant::now();
    for _ in 0..a[3].parse::<u32>().unwrap() {
        let r = g.grow(&Default::default());
        println!("{:?} {:.1}s {} MB", r, t.elapsed().as_secs_f64(), g.memory() >> 20);
        if g.is_exhausted() {
            break;
        }
    }
}
