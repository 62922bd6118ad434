//! Built-in tetrahedra with positions: positive, exactly the boundary asked for, the volume that it encloses.

mod common;

use common::{Points, box_at, one_more, plate, read_obj, together, torus_at, voxels};
use hexfill_construct::{ConstructError, DelaunayTets, InteriorTets, RouteChoice, TetRequest, core_triangles};
use hexfill_mesh::{Context, QuadSurface, StopReason};
use robust::{Coord3D, orient3d};
use std::sync::atomic::AtomicBool;
use std::time::Instant;

const O: [f64; 3] = [0.0; 3];

/// det(b - a, c - a, d - a), with the exact sign.
fn orient([a, b, c, d]: [[f64; 3]; 4]) -> f64 {
    let [a, b, c, d] = [a, b, c, d].map(|p| Coord3D { x: p[0], y: p[1], z: p[2] });
    orient3d(b, c, d, a)
}

fn fill(surface: &QuadSurface, points: &[[f64; 3]]) -> Result<(usize, usize), ConstructError> {
    let triangles = core_triangles(surface, RouteChoice::Auto);
    let request = TetRequest { n_vertices: points.len(), triangles: &triangles, points: Some(points) };
    let complex = DelaunayTets::default().fill(&request, &Context::default())?;
    complex.match_boundary(&request)?;
    let all = complex.points.as_ref().unwrap();
    assert_eq!(all.len(), complex.n_vertices);
    assert_eq!(&all[..points.len()], points);
    let mut inside = 0.0;
    for tet in &complex.tets {
        let volume = orient(tet.map(|v| all[v.index()]));
        assert!(volume > 0.0, "{tet:?}: {volume}");
        inside += volume;
    }
    let origin = points[triangles[0][0].index()];
    let enclosed: f64 =
        triangles.iter().map(|t| t.map(|v| points[v.index()])).map(|[a, b, c]| orient([origin, a, b, c])).sum();
    assert!((inside - enclosed).abs() < 1e-9 * enclosed, "{inside} {enclosed}");
    Ok((complex.tets.len(), complex.n_vertices - points.len()))
}

fn filled(name: &str, surface: &QuadSurface, points: &[[f64; 3]]) {
    let before = Instant::now();
    let (tets, inner) = fill(surface, points).unwrap_or_else(|e| panic!("{name}: {e}"));
    let n = surface.n_quads();
    println!(
        "{name}: {n} quads, {tets} tets ({:.2} a quad), {inner} inner points, {:.2} s",
        tets as f64 / n as f64,
        before.elapsed().as_secs_f64()
    );
}

/// Moved inward along the normals by `share` of the shortest edge at each vertex.
fn inset(surface: &QuadSurface, points: &[[f64; 3]], share: f64) -> Points {
    let sub = |a: [f64; 3], b: [f64; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    let length = |a: [f64; 3]| (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]).sqrt();
    let mut normal = vec![[0.0; 3]; points.len()];
    let mut shortest = vec![f64::INFINITY; points.len()];
    for d in surface.darts() {
        let at = |d| points[surface.origin(d).index()];
        let v = surface.origin(d).index();
        let (a, b) = (sub(at(d.next()), at(d)), sub(at(d.prev()), at(d)));
        let n = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
        let l = length(n);
        normal[v] = std::array::from_fn(|c| normal[v][c] + n[c] / l);
        shortest[v] = shortest[v].min(length(a));
    }
    let moved = |(p, (n, h)): (&[f64; 3], (&[f64; 3], &f64))| {
        let l = length(*n);
        std::array::from_fn(|c| p[c] - share * h * n[c] / l)
    };
    points.iter().zip(normal.iter().zip(&shortest)).map(moved).collect()
}

#[test]
fn boxes_and_plates() {
    for k in [1, 2, 3, 5] {
        let (surface, points) = box_at(k, 1.0, O, true);
        filled(&format!("box {k}"), &surface, &points);
    }
    for genus in 0..=4 {
        for fineness in [1, 2] {
            let (surface, points) = plate(genus, fineness, &[]);
            filled(&format!("plate {genus} {fineness}"), &surface, &points);
            filled(&format!("plate {genus} {fineness} inset"), &surface, &inset(&surface, &points, 0.2));
        }
    }
}

#[test]
fn tori() {
    for (n, m) in [(3, 4), (4, 3), (4, 4), (5, 8), (6, 6), (8, 7), (12, 24)] {
        for tube in [true, false] {
            for r in [0.3, 1.0, 2.5] {
                let (surface, points) = torus_at(n, m, tube, r, O, true);
                filled(&format!("torus {n} {m} {tube} {r}"), &surface, &points);
            }
        }
    }
}

#[test]
fn cavities() {
    for (name, (surface, points)) in [
        ("plate with a cavity", plate(1, 3, &[[1, 1, 1]])),
        ("two cavities", plate(2, 3, &[[1, 1, 1], [1, 7, 1]])),
        ("nested", together(&[box_at(4, 10.0, O, true), box_at(3, 8.0, O, false), torus_at(4, 6, true, 1.0, O, true)])),
        ("torus taken out", together(&[box_at(3, 6.0, O, true), torus_at(5, 4, true, 1.0, O, false)])),
        ("apart", together(&[box_at(2, 1.0, O, true), box_at(2, 1.0, [3.0, 0.1, 0.2], true)])),
    ] {
        filled(name, &surface, &points);
    }
}

#[test]
fn bamboo_pen_and_cubespikes() {
    for (name, text) in [
        ("bamboo_pen", include_str!("../../../corpus/surfaces/bamboo_pen.obj")),
        ("cubespikes", include_str!("../../../corpus/surfaces/cubespikes.obj")),
    ] {
        let (surface, points) = read_obj(text);
        filled(name, &surface, &points);
        for share in [0.1, 0.2, 0.4] {
            filled(&format!("{name} inset {share}"), &surface, &inset(&surface, &points, share));
        }
    }
}

/// Numbers that look random, the same every time.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

#[test]
fn random_voxels_and_stars() {
    let mut numbers = Numbers(7);
    let mut genera = std::collections::BTreeSet::new();
    for case in 0..3000 {
        let cells: Vec<bool> = (0..27).map(|_| numbers.next() < 0.6).collect();
        let is_in = |p: [usize; 3]| cells[p[0] + 3 * p[1] + 9 * p[2]];
        // Those that touch themselves along an edge or in a vertex are no surfaces.
        if hexfill_mesh::generate::voxel_surface([3, 3, 3], is_in).is_err() {
            continue;
        }
        let (surface, mut points) = voxels([3, 3, 3], is_in);
        genera.insert(surface.genus());
        filled(&format!("voxels {case} genus {}", surface.genus()), &surface, &points);
        points.iter_mut().flatten().for_each(|x| *x += 0.3 * numbers.next());
        filled(&format!("voxels {case} moved"), &surface, &points);
    }
    assert!(genera.len() > 2, "{genera:?}");
    for case in 0..10 {
        let (surface, mut points) = box_at(4, 1.0, O, true);
        for p in &mut points {
            let r = (0.5 + numbers.next()) / p.iter().map(|x| x * x).sum::<f64>().sqrt();
            *p = p.map(|x| r * x);
        }
        filled(&format!("star {case}"), &surface, &points);
    }
}

#[test]
fn refusals_say_why() {
    let reason = |surface: &QuadSurface, points: &[[f64; 3]]| match fill(surface, points) {
        Err(e @ ConstructError::InteriorNeeded { .. }) => e.to_string(),
        other => panic!("{other:?}"),
    };
    let (surface, points) = together(&[box_at(2, 1.0, O, true), box_at(2, 1.0, [0.7, 0.6, 0.5], true)]);
    let words = reason(&surface, &points);
    assert!(words.contains("meets itself") && words.contains("install tetgen"), "{words}");
    let (surface, points) = box_at(2, 1.0, O, false);
    assert!(reason(&surface, &points).contains("faces inward"));
    let (surface, points) = one_more(box_at(3, 6.0, O, true));
    assert!(reason(&surface, &points).contains("has no area"));
    let (surface, mut points) = box_at(2, 1.0, O, true);
    points[3][1] = f64::NAN;
    assert!(reason(&surface, &points).contains("vertex 3"));
    points[3] = points[4];
    let words = reason(&surface, &points);
    assert!(words.contains("same place") || words.contains("no area"), "{words}");
}

#[test]
fn the_same_twice_and_stopped_when_told() {
    let (surface, points) = torus_at(8, 7, true, 1.0, O, true);
    let triangles = core_triangles(&surface, RouteChoice::Auto);
    let request = TetRequest { n_vertices: points.len(), triangles: &triangles, points: Some(&points) };
    let made = |ctx: &Context<'_>| DelaunayTets::default().fill(&request, ctx);
    let [a, b] = [made(&Context::default()).unwrap(), made(&Context::default()).unwrap()];
    assert_eq!((a.tets, a.points), (b.tets, b.points));
    let cancel = AtomicBool::new(true);
    match made(&Context { cancel: Some(&cancel), ..Context::default() }) {
        Err(ConstructError::Stopped(StopReason::Cancelled)) => {}
        other => panic!("{other:?}"),
    }
}
