//! Fills an array of quads and prints the worst cells: `cargo run -p hexfill --example fill_array`.

use hexfill::io::MeshData;
use hexfill::{Context, FillOptions, PlaceOptions, Problem, fill_placed};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // A ring of three quads closed by three on each side: a hexagonal prism, sheared.
    let height = |z: f64| move |[x, y]: [f64; 2]| [x + 0.3 * z, y, z];
    let corners = [[0.0, 0.0], [2.0, 0.0], [3.0, 1.5], [2.0, 3.0], [0.0, 3.0], [-1.0, 1.5], [1.0, 1.5]];
    let points: Vec<[f64; 3]> = corners.map(height(0.0)).into_iter().chain(corners.map(height(2.0))).collect();
    let caps = [[0, 1, 2, 6], [2, 3, 4, 6], [4, 5, 0, 6]];
    let mut quads: Vec<[u32; 4]> = caps.iter().map(|&[a, b, c, d]| [d, c, b, a]).collect();
    quads.extend(caps.map(|cap| cap.map(|v| v + 7)));
    quads.extend((0..6).map(|v| [v, (v + 1) % 6, (v + 1) % 6 + 7, v + 7]));

    let problem = Problem::from_data("prism", &MeshData::from_quads(points, quads))?;
    let made = fill_placed(&problem, &FillOptions::default(), &PlaceOptions::default(), &Context::default())?;
    let (filled, placed) = made.meshes.first().ok_or("no mesh was found")?;
    let placed = placed.as_ref().ok_or("the surface has no positions")?;
    println!("{} hexes by {}: {}", filled.mesh().n_hexes(), filled.route().words(), placed.report());
    let mut worst: Vec<(usize, f64)> = placed.cells().iter().map(|c| c.certified_lower).enumerate().collect();
    worst.sort_by(|a, b| a.1.total_cmp(&b.1));
    for (hex, scaled_jacobian) in worst.into_iter().take(5) {
        println!("h{hex}: scaled Jacobian at least {scaled_jacobian:.4}");
    }
    Ok(())
}
