//! Writes a few meshes as pages and pictures into a folder: `cargo run -p hexfill-view --example view_demo -- FOLDER`.

#[path = "../tests/common/mod.rs"]
mod common;

use common::Shape;
use hexfill_view::{Groups, Picture, ViewInput, html, pair_png, png, png_with, write_pair_html};
use std::path::Path;

fn main() -> std::io::Result<()> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| "view-demo".into());
    std::fs::create_dir_all(&folder)?;
    let mut shapes: Vec<(&str, &str, Shape)> = vec![
        ("grid", "Grid of 6 x 4 x 3 cubes", common::grid(6, 4, 3)),
        ("ball", "Ball with a cubic core", common::ball(4, 3)),
        ("refinement", "Refinement transition, 9 quads to 1", common::refinement()),
    ];
    if let Some(k) = std::env::args().nth(2).and_then(|k| k.parse().ok()) {
        shapes.push(("large", "Large grid", common::grid(k, k, k)));
    }
    // What does not fit is named on the page; an empty mesh is a page too.
    let mut broken = common::grid(3, 2, 2);
    broken.points[0] = [f64::NAN; 3];
    let mut input = ViewInput {
        title: "<b>Broken</b> </script> \"input\"",
        points: &broken.points,
        mesh: &broken.mesh,
        hex_values: Some(("Scaled Jacobian", &[1.0])),
        shelling: Some(&[]),
        groups: None,
        facts: &[],
    };
    std::fs::write(Path::new(&folder).join("broken.html"), html(&input))?;
    let nothing = hexfill_mesh::HexMesh::try_new(0, &[]).expect("no hexes are a mesh");
    input = ViewInput { title: "Empty", mesh: &nothing, hex_values: None, shelling: None, ..input };
    std::fs::write(Path::new(&folder).join("empty.html"), html(&input))?;
    for (name, title, shape) in &shapes {
        let quality = common::scaled_jacobian(shape);
        let order = common::facet_order(&shape.mesh);
        let facts = [
            ("made by".to_string(), "view_demo".to_string()),
            ("inner vertices".to_string(), shape.mesh.n_interior_vertices().to_string()),
        ];
        let mut input = ViewInput {
            title,
            points: &shape.points,
            mesh: &shape.mesh,
            hex_values: Some(("Scaled Jacobian", &quality)),
            shelling: Some(&order),
            groups: None,
            facts: &facts,
        };
        let folder = Path::new(&folder);
        std::fs::write(folder.join(format!("{name}.html")), html(&input))?;
        std::fs::write(folder.join(format!("{name}.png")), png(&input, 1200, 640))?;
        if *name == "grid" {
            groups_and_pair(folder, &input)?;
        }
        input.hex_values = None;
        std::fs::write(folder.join(format!("{name}-plain.html")), html(&input))?;
        let dark = Picture { dark: true, ..Picture::new(600, 560) };
        std::fs::write(folder.join(format!("{name}-dark.png")), png_with(&input, &dark))?;
    }
    Ok(())
}

/// A mesh whose boundary has groups by the direction of the quads, and two meshes beside each other.
fn groups_and_pair(folder: &Path, input: &ViewInput<'_>) -> std::io::Result<()> {
    let quads = input.mesh.boundary_quads_raw();
    let height = |quad: &[u32; 4]| quad.map(|v| input.points[v as usize][2]);
    let tags: Vec<i64> =
        quads.iter().map(|quad| i64::from(height(quad).iter().all(|z| *z == height(quad)[0]))).collect();
    let groups = Groups::new(input.mesh, &quads, &tags, |tag| format!("level <{tag}>"), true);
    let with = ViewInput { groups: groups.as_ref(), ..*input };
    std::fs::write(folder.join("groups.html"), html(&with))?;
    std::fs::write(folder.join("groups.png"), png(&with, 1200, 640))?;
    let mut page = Vec::new();
    write_pair_html([input, &with], &mut page)?;
    std::fs::write(folder.join("pair.html"), page)?;
    std::fs::write(folder.join("pair.png"), pair_png([input, &with], 1200, 640))
}
