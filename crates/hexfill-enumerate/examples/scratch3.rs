//! scratch
use hexfill_enumerate::*;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let n: usize = a[1].parse().unwrap();
    let rule: Rule = a[2].parse().unwrap();
    let threads: usize = a[3].parse().unwrap();
    let chunks: usize = a[4].parse().unwrap();
    let p = Params::new(n, rule);
    let ctx = hexfill_mesh::Context::default();
    let plan = Plan::prepare(&p, &LevelOptions { threads, narrow_hashes: false }, &ctx).unwrap();
    let h = Header::new(
        &p,
        String::new(),
        false,
        vec!["pyramid".into(), "spindle".into(), "buffer-20".into(), "buffer-22".into(), "carbonera-10".into()],
        chunks,
    );
    let t = Target::built_in().unwrap();
    let w = Wanted { selection: None, list: false, targets: &t };
    let r =
        run_checkpointed(&plan, std::path::Path::new(&a[5]), Chunk { index: 0, of: 1 }, &h, threads, w, &ctx).unwrap();
    println!("{r:?}");
}
