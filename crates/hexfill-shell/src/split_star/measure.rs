use super::*;
fn read(file: &str) -> (Vec<[f64; 3]>, Vec<[u32; 8]>) {
    let text = std::fs::read_to_string(file).unwrap();
    let mut words = text.split_whitespace();
    let (mut points, mut hexes) = (vec![], vec![]);
    while let Some(w) = words.next() {
        if w == "Vertices" {
            let n: usize = words.next().unwrap().parse().unwrap();
            for _ in 0..n {
                points.push(std::array::from_fn(|_| words.next().unwrap().parse().unwrap()));
                words.next();
            }
        } else if w == "Hexahedra" {
            let n: usize = words.next().unwrap().parse().unwrap();
            for _ in 0..n {
                hexes.push(std::array::from_fn(|_| words.next().unwrap().parse::<u32>().unwrap() - 1));
                words.next();
            }
        }
    }
    (points, hexes)
}
#[test]
#[ignore]
fn measure() {
    let (points, hexes) = read(&std::env::var("MESH").unwrap());
    let mesh = HexMesh::try_new(points.len(), &hexes).unwrap();
    let mesh = if std::env::var("PILLOW").is_ok() { super::tests::pillowed(&mesh) } else { mesh };
    let mut options = SplitOptions::default();
    if let Ok(b) = std::env::var("BELOW") {
        options.below = b.parse().unwrap();
    }
    let t = std::time::Instant::now();
    let Some(split) = split_stars(&mesh, &points, &options, &Context::default()) else {
        println!("none {:?}", t.elapsed());
        return;
    };
    for s in &split.splits {
        println!("   {s:?}");
    }
    println!(
        "{} -> {} hexes, pillowed {} left {:?} {:?}",
        mesh.n_hexes(),
        split.mesh.n_hexes(),
        split.pillowed,
        split.left,
        t.elapsed()
    );
    super::tests::assert_proper(&split.mesh, &mesh);
    if std::env::var("EMBED").is_ok() {
        for (name, m) in [("before", &mesh), ("after", &split.mesh)] {
            let t = std::time::Instant::now();
            let r = hexfill_embed::embed(
                m,
                &points,
                None,
                &hexfill_embed::Options::new(hexfill_embed::Objective::UntangleOnly),
                &Context::default(),
            )
            .unwrap()
            .report;
            println!(
                "{name}: invalid {} sj {} bound {} {:?}",
                r.n_invalid,
                r.scaled_jacobian,
                r.upper_bound,
                t.elapsed()
            );
            for c in r.worst_cells.iter().take(6) {
                println!("   {:?} {:?}", c, m.hex(c.hex));
            }
            for c in r.star_bounds.iter().take(6) {
                println!("   {:?}", c);
            }
        }
    }
}
