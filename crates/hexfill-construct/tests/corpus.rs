//! Surfaces of others: a sphere of 1,192 quads and a pen holder of genus 8.

mod common;

use common::read_obj;
use hexfill_check::{Judged, Level, judge};
use hexfill_construct::{ConstructOptions, Existence, construct, existence};
use hexfill_mesh::Context;

fn fill(text: &str, n_quads: usize, genus: u64) -> f64 {
    let (surface, points) = read_obj(text);
    assert_eq!((surface.n_quads(), surface.genus(), surface.n_components()), (n_quads, genus, 1));
    assert!(matches!(existence(&surface, Some(&points)), Existence::Exists { .. }));
    let made = construct(&surface, Some(&points), &ConstructOptions::default(), &Context::default()).unwrap();
    println!("{}", made.report);
    let hexes: Vec<[u32; 8]> = made.mesh.hexes().iter().map(|h| h.map(|v| v.0)).collect();
    let quads: Vec<[u32; 4]> = surface.quads_raw();
    let input = Judged::connectivity(made.mesh.n_vertices(), &hexes).with_surface(&quads);
    let report =
        judge(&input, &hexfill_check::Options::default().with_up_to(Level::L3).with_betti(false), &Context::default());
    assert!(report.passed(Level::L3), "{:?}", report.failures);
    let start = made.start.unwrap();
    assert_eq!(start.len(), made.mesh.n_vertices());
    assert!(start.iter().zip(&points).all(|(a, b)| a.map(f64::to_bits) == b.map(f64::to_bits)));
    assert!(start.iter().flatten().all(|x| x.is_finite()));
    made.report.hexes_per_quad()
}

#[test]
fn cubespikes() {
    assert!(fill(include_str!("../../../corpus/surfaces/cubespikes.obj"), 1192, 0) <= 46.0);
}

#[test]
fn bamboo_pen() {
    assert!(fill(include_str!("../../../corpus/surfaces/bamboo_pen.obj"), 1160, 8) <= 70.0);
}
