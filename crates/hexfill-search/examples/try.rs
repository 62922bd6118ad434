use hexfill_mesh::QuadSurface;
use hexfill_search::*;
fn load(p: &str) -> Cavity {
    let s = std::fs::read_to_string(p).unwrap();
    let nv = s.lines().filter(|l| l.starts_with("v ")).count();
    let q: Vec<[u32; 4]> = s
        .lines()
        .filter(|l| l.starts_with("f "))
        .map(|l| {
            let v: Vec<u32> = l[2..].split_whitespace().map(|x| x.parse::<u32>().unwrap() - 1).collect();
            [v[0], v[1], v[2], v[3]]
        })
        .collect();
    Cavity::from_surface(&QuadSurface::try_new(nv, &q).unwrap()).unwrap().0
}
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let mut g = Growth::new(GrowOptions { cap: a[1].parse().unwrap(), width: a[2].parse().unwrap() });
    let mut targets: Vec<(String, Cavity)> = a[4..].iter().map(|p| (p.clone(), load(p))).collect();
    let t = std::time::Instant::now();
    for _ in 0..a[3].parse::<u32>().unwrap() {
        let r = g.grow(&Default::default());
        println!(
            "{} children {} kept {} classes {} states {} {:.1}s {} MB",
            r.level,
            r.children,
            r.kept,
            r.classes,
            r.states,
            t.elapsed().as_secs_f64(),
            g.memory() >> 20
        );
        targets.retain(|(n, c)| {
            let b: Vec<Ball> = g.balls_for(c).collect();
            if let Some(b) = b.first() {
                b.debug_check();
                println!("FOUND {n} {} hexes {} placements", b.n_hexes(), b.placements(c).len());
            }
            b.is_empty()
        });
        if g.is_exhausted() || targets.is_empty() {
            break;
        }
    }
}
