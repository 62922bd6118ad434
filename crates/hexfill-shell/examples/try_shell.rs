//! `cargo run --example try_shell -- surface.obj`: what shelling makes of a surface.
use hexfill_mesh::{Context, QuadSurface};

fn main() {
    for file in std::env::args().skip(1) {
        let text = std::fs::read_to_string(&file).expect("readable");
        let (mut points, mut quads) = (Vec::new(), Vec::new());
        for line in text.lines() {
            let words: Vec<&str> = line.split_whitespace().collect();
            match words.first() {
                Some(&"v") => points.push([1, 2, 3].map(|i: usize| words[i].parse::<f64>().expect("number"))),
                Some(&"f") => quads
                    .push([1, 2, 3, 4].map(|i: usize| {
                        words[i].split('/').next().expect("index").parse::<u32>().expect("number") - 1
                    })),
                _ => {}
            }
        }
        let surface = QuadSurface::try_new(points.len(), &quads).expect("a surface");
        let start = std::time::Instant::now();
        let made = hexfill_shell::shell(&surface, Some(&points), &Default::default(), &Context::default());
        println!(
            "{file}: {} quads ({}), left {}, {:.2?}",
            surface.n_quads(),
            made.coarse_quads,
            made.left,
            start.elapsed()
        );
        for m in &made.meshes {
            println!("  {} hexes, cost {:.2}, {} pillows", m.mesh.n_hexes(), m.cost, m.pillows);
        }
    }
}
