//! scratch
use hexfill_embed::*;
use hexfill_mesh::*;
#[test]
fn pyr() {
    let s = std::fs::read_to_string(std::env::var("MESH").unwrap_or("/tmp/emb/pyr36.txt".into())).unwrap();
    let mut l = s.lines();
    let head: Vec<usize> = l.next().unwrap().split(' ').map(|x| x.parse().unwrap()).collect();
    let mut points = vec![[0.0; 3]; head[0]];
    for p in points.iter_mut() {
        let v: Vec<f64> = l.next().unwrap().split(' ').map(|x| x.parse().unwrap()).collect();
        *p = [v[0], v[1], v[2]];
    }
    let hexes: Vec<[u32; 8]> = l
        .map(|l| {
            let v: Vec<u32> = l.split(' ').map(|x| x.parse().unwrap()).collect();
            v.try_into().unwrap()
        })
        .collect();
    let mesh = HexMesh::try_new(head[1], &hexes).unwrap();
    for objective in [Objective::UntangleOnly, Objective::ScaledJacobian, Objective::Balanced] {
        let t = std::time::Instant::now();
        let e = embed(&mesh, &points, None, &Options::new(objective), &Context::default()).unwrap();
        println!("{:?} {:#?}", t.elapsed(), e.report);
    }
}
