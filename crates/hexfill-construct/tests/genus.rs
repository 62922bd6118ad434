//! Tori of all parities and plates with holes: judged proper, boundary identical, impossible ones refused with a
//! certificate that is verified here.

mod common;

use common::{outward, torus_points};
use hexfill_check::{Judged, Level, judge};
use hexfill_construct::{ConstructError, ConstructOptions, Construction, Existence, RouteChoice, construct, existence};
use hexfill_mesh::generate::{holed_plate, torus};
use hexfill_mesh::{Context, Edge, QuadSurface};
use std::collections::{BTreeMap, BTreeSet};

fn check(surface: &QuadSurface, made: &Construction) {
    let hexes: Vec<[u32; 8]> = made.mesh.hexes().iter().map(|h| h.map(|v| v.0)).collect();
    let quads: Vec<[u32; 4]> = surface.quads_raw();
    let input = Judged::connectivity(made.mesh.n_vertices(), &hexes).with_surface(&quads);
    let report = judge(&input, &hexfill_check::Options::default().with_up_to(Level::L3), &Context::default());
    assert!(report.passed(Level::L3), "{:?}", report.failures);
    // A handlebody: Euler characteristic is half that of its boundary.
    let edges = made.mesh.edges().len() as i64;
    let quads = (6 * hexes.len() + surface.n_quads()) as i64 / 2;
    let vertices = made.mesh.used_vertices().iter().filter(|&&u| u).count() as i64;
    assert_eq!(2 * (vertices - edges + quads - hexes.len() as i64), surface.euler_characteristic());
}

fn is_odd_cycle(surface: &QuadSurface, cycle: &[Edge]) {
    let all: BTreeSet<Edge> = surface.darts().map(|d| Edge::new(surface.origin(d), surface.target(d))).collect();
    assert_eq!(cycle.len() % 2, 1);
    let mut degree: BTreeMap<_, usize> = BTreeMap::new();
    for e in cycle {
        assert!(all.contains(e));
        *degree.entry(e.0).or_default() += 1;
        *degree.entry(e.1).or_default() += 1;
    }
    assert!(degree.values().all(|d| d % 2 == 0));
}

#[test]
fn tori_of_all_parities() {
    for (n, m) in [(3, 4), (4, 3), (4, 4), (5, 4), (4, 5), (6, 3), (6, 6), (8, 7), (7, 8)] {
        for n_is_tube in [true, false] {
            let points = torus_points(n, m, n_is_tube, 1.0, [0.0; 3]);
            let surface = outward(&torus(n, m, 0).unwrap(), &points);
            let tube = if n_is_tube { n } else { m };
            let made = construct(&surface, Some(&points), &ConstructOptions::default(), &Context::default());
            if tube % 2 == 0 {
                assert!(matches!(existence(&surface, Some(&points)), Existence::Exists { .. }));
                let made = made.unwrap();
                println!("torus {n} x {m}, tube {tube}: {}", made.report);
                check(&surface, &made);
            } else {
                let Existence::OddCycleBounds { cycle } = existence(&surface, Some(&points)) else { panic!("exists") };
                is_odd_cycle(&surface, &cycle);
                match made {
                    Err(ConstructError::NoMesh(Existence::OddCycleBounds { cycle })) => is_odd_cycle(&surface, &cycle),
                    other => panic!("{other:?}"),
                }
            }
        }
    }
}

#[test]
fn plates_with_holes() {
    for genus in 0..=4 {
        let surface = holed_plate(genus, 1).unwrap();
        let points = plate_points(genus);
        assert_eq!(surface.genus(), genus as u64);
        let made = construct(&surface, Some(&points), &ConstructOptions::default(), &Context::default()).unwrap();
        println!("genus {genus}: {}", made.report);
        check(&surface, &made);
        // Erickson's colouring needs no bipartition and costs more.
        let options = ConstructOptions::default().with_route(RouteChoice::Erickson);
        let old = construct(&surface, Some(&points), &options, &Context::default()).unwrap();
        println!("genus {genus}: {}", old.report);
        check(&surface, &old);
        assert!(old.report.n_hexes() > made.report.n_hexes());
    }
}

/// Corner positions of `holed_plate(genus, 1)`, numbered by first use as the generator does.
fn plate_points(genus: usize) -> Vec<[f64; 3]> {
    use hexfill_mesh::cube::{FACETS, POSITIONS};
    let filled = |x: i32, y: i32, z: i32| {
        let inside = (0..(2 * genus + 1) as i32).contains(&x) && (0..3).contains(&y) && z == 0;
        inside && !(x % 2 == 1 && y == 1)
    };
    let mut points: Vec<[f64; 3]> = Vec::new();
    for y in 0..3 {
        for x in 0..(2 * genus + 1) as i32 {
            if !filled(x, y, 0) {
                continue;
            }
            for (f, facet) in FACETS.iter().enumerate() {
                let step = if f % 2 == 0 { -1 } else { 1 };
                let beside = [(step, 0, 0), (0, step, 0), (0, 0, step)][f / 2];
                if filled(x + beside.0, y + beside.1, beside.2) {
                    continue;
                }
                for k in facet {
                    let p = POSITIONS[*k];
                    let p = [f64::from(x) + f64::from(p[0]), f64::from(y) + f64::from(p[1]), f64::from(p[2])];
                    if !points.contains(&p) {
                        points.push(p);
                    }
                }
            }
        }
    }
    points
}

#[test]
fn without_positions_an_odd_torus_is_not_decided() {
    let surface = torus(4, 5, 0).unwrap();
    assert!(matches!(existence(&surface, None), Existence::Unknown { .. }));
    let made = construct(&surface, None, &ConstructOptions::default(), &Context::default());
    assert!(matches!(made, Err(ConstructError::InteriorNeeded { genus: 1, .. })));
    assert!(matches!(existence(&torus(4, 6, 0).unwrap(), None), Existence::Exists { .. }));
    assert!(matches!(existence(&torus(3, 5, 0).unwrap(), None), Existence::OddQuads { given: 15 }));
}

/// A cube of `n^3` cells with unit cells taken out of its inside, one at each of `holes`.
fn cube_with_cavities(n: i32, holes: &[[i32; 3]]) -> (QuadSurface, Vec<[f64; 3]>) {
    use hexfill_mesh::cube::{FACETS, POSITIONS};
    let filled = |p: [i32; 3]| p.iter().all(|x| (0..n).contains(x)) && !holes.contains(&p);
    let (mut points, mut quads): (Vec<[f64; 3]>, Vec<[u32; 4]>) = (Vec::new(), Vec::new());
    for x in 0..n {
        for y in 0..n {
            for z in (0..n).filter(|&z| filled([x, y, z])) {
                for (f, facet) in FACETS.iter().enumerate() {
                    let mut beside = [x, y, z];
                    beside[f / 2] += if f % 2 == 0 { -1 } else { 1 };
                    if !filled(beside) {
                        quads.push(facet.map(|k| {
                            let p = POSITIONS[k];
                            let p = [x, y, z]
                                .map(f64::from)
                                .iter()
                                .zip(p)
                                .map(|(a, b)| a + f64::from(b))
                                .collect::<Vec<_>>();
                            let p = [p[0], p[1], p[2]];
                            points.iter().position(|q| *q == p).unwrap_or_else(|| {
                                points.push(p);
                                points.len() - 1
                            }) as u32
                        }));
                    }
                }
            }
        }
    }
    (QuadSurface::try_new(points.len(), &quads).unwrap(), points)
}

#[test]
fn cavities() {
    for holes in [vec![[1, 1, 1]], vec![[1, 1, 1], [3, 3, 3]]] {
        let (surface, points) = cube_with_cavities(5, &holes);
        assert_eq!((surface.n_components(), surface.genus()), (holes.len() + 1, 0));
        let made = construct(&surface, Some(&points), &ConstructOptions::default(), &Context::default()).unwrap();
        println!("{} cavities: {}", holes.len(), made.report);
        check(&surface, &made);
        let made = construct(&surface, None, &ConstructOptions::default(), &Context::default());
        assert!(matches!(made, Err(ConstructError::InteriorNeeded { .. })));
    }
}
