//! The octagonal spindle (or a surface signature) step by step: the tables of the book's page `construction`.

use hexfill_construct::{
    BallCore, CellChoice, CellLibrary, ConstructOptions, RouteChoice, colouring, construct, core_triangles, light_sides,
};
use hexfill_mesh::generate::octagonal_spindle;
use hexfill_mesh::{Context, QuadId, VertexId, parse_surface_signature};

fn main() {
    let surface = match std::env::args().nth(1).map(|s| parse_surface_signature(&s)) {
        None => octagonal_spindle(),
        Some(Ok(surface)) => surface,
        Some(Err(e)) => return println!("{e}"),
    };
    let ctx = Context::default();
    println!("surface: {} quads, {} vertices, genus {}", surface.n_quads(), surface.n_used_vertices(), surface.genus());
    let colours = colouring(&surface, false);
    let white: Vec<VertexId> = colours.white.enumerate().filter(|(_, white)| **white).map(|(v, _)| v).collect();
    println!("1 plan: colours: white {white:?}, {} cut edges", colours.n_cut_edges);
    for q in 0..surface.n_quads() {
        println!("  q{q}: {:?}", surface.quad(QuadId::new(q)));
    }
    let triangles = core_triangles(&surface, RouteChoice::Auto);
    println!("2 core: {} inner triangles {:?}", triangles.len(), triangles);
    match light_sides(&surface, &[], 0, &ctx) {
        Ok(sides) => {
            let pairs: Vec<(u32, u32)> = surface
                .darts()
                .filter(|&d| d < surface.twin(d) && sides.light[d])
                .map(|d| (d.quad().0, surface.twin(d).quad().0))
                .collect();
            println!("3 layer: light sides between quads {pairs:?}");
        }
        Err(e) => return println!("{e}"),
    }
    for cell in CellLibrary::built_in(CellChoice::Fewest).cells() {
        println!("  cell {}: {} hexes, {} points inside", cell.pattern, cell.hexes.len(), cell.n_interior());
    }
    for (route, core) in [
        (RouteChoice::Auto, BallCore::Centred),
        (RouteChoice::Auto, BallCore::Fewest),
        (RouteChoice::Erickson, BallCore::Centred),
    ] {
        let options = ConstructOptions::default().with_route(route).with_ball_core(core);
        match construct(&surface, None, &options, &ctx) {
            Ok(made) => println!("{core:?}: {}", made.report),
            Err(e) => println!("{e}"),
        }
    }
}
