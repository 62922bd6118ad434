//! Surfaces with positions, and the judge.
#![allow(dead_code)]

use hexfill_check::{Judged, Level, judge};
use hexfill_construct::Construction;
use hexfill_mesh::generate::torus;
use hexfill_mesh::{Context, QuadSurface};

pub(crate) type Points = Vec<[f64; 3]>;

/// Levels 1 to 3, the Euler characteristic of a handlebody with cavities (half that of its boundary), and that nothing is unused.
pub(crate) fn check(surface: &QuadSurface, made: &Construction) {
    let hexes: Vec<[u32; 8]> = made.mesh.hexes().iter().map(|h| h.map(|v| v.0)).collect();
    let quads: Vec<[u32; 4]> = surface.quads_raw();
    let input = Judged::connectivity(made.mesh.n_vertices(), &hexes).with_surface(&quads);
    let report =
        judge(&input, &hexfill_check::Options::default().with_up_to(Level::L3).with_betti(false), &Context::default());
    assert!(report.passed(Level::L3), "{:?}", report.failures);
    assert_eq!(hexes.len(), made.report.n_hexes());
    assert!(made.mesh.used_vertices().iter().all(|&u| u));
    let edges = made.mesh.edges().len() as i64;
    let n_quads = (6 * hexes.len() + surface.n_quads()) as i64 / 2;
    let euler = made.mesh.n_vertices() as i64 - edges + n_quads - hexes.len() as i64;
    assert_eq!(2 * euler, surface.euler_characteristic());
    if let Some(start) = &made.start {
        assert_eq!(start.len(), made.mesh.n_vertices());
        assert!(start.iter().flatten().all(|x| x.is_finite()));
    }
}

/// The boundary of the filled cells of a grid, with positions.
pub(crate) fn voxels(size: [usize; 3], filled: impl Fn([usize; 3]) -> bool) -> (QuadSurface, Points) {
    let (surface, points) = hexfill_mesh::generate::voxels(size, filled).unwrap();
    (surface, points.into_iter().map(|p| p.map(f64::from)).collect())
}

/// A plate with `genus` square holes, its cells cut into `fineness`^3, and single voxels taken out of its inside.
pub(crate) fn plate(genus: usize, fineness: usize, cavities: &[[usize; 3]]) -> (QuadSurface, Points) {
    let size = [(2 * genus + 1) * fineness, 3 * fineness, fineness];
    let is_hole = |p: [usize; 3]| (p[0] / fineness) % 2 == 1 && p[1] / fineness == 1;
    voxels(size, |p| !is_hole(p) && !cavities.contains(&p))
}

/// Positions of `torus(n, m, shift)` with tube radius `r` round a circle of radius 3: index `i` runs round the tube or the axis.
pub(crate) fn torus_points(n: u32, m: u32, i_is_tube: bool, r: f64, at: [f64; 3]) -> Points {
    let turn = std::f64::consts::TAU;
    let mut points = Points::new();
    for j in 0..m {
        for i in 0..n {
            let (a, b) = (turn * f64::from(i) / f64::from(n), turn * f64::from(j) / f64::from(m));
            let (tube, axis) = if i_is_tube { (a, b) } else { (b, a) };
            let d = 3.0 + r * tube.cos();
            points.push([at[0] + d * axis.cos(), at[1] + d * axis.sin(), at[2] + r * tube.sin()]);
        }
    }
    points
}

pub(crate) fn volume(surface: &QuadSurface, points: &[[f64; 3]]) -> f64 {
    let mut volume = 0.0;
    for q in surface.quads() {
        let p = q.map(|v| points[v.index()]);
        for [a, b, c] in [[p[0], p[1], p[2]], [p[0], p[2], p[3]]] {
            volume += a[0] * (b[1] * c[2] - b[2] * c[1])
                + a[1] * (b[2] * c[0] - b[0] * c[2])
                + a[2] * (b[0] * c[1] - b[1] * c[0]);
        }
    }
    volume
}

/// The same surface facing outward for these positions.
pub(crate) fn outward(surface: &QuadSurface, points: &[[f64; 3]]) -> QuadSurface {
    if volume(surface, points) > 0.0 { surface.clone() } else { surface.inverted() }
}

/// A torus facing outward, or inward.
pub(crate) fn torus_at(n: u32, m: u32, i_is_tube: bool, r: f64, at: [f64; 3], outward: bool) -> (QuadSurface, Points) {
    let points = torus_points(n, m, i_is_tube, r, at);
    let surface = self::outward(&torus(n, m, 0).unwrap(), &points);
    (if outward { surface } else { surface.inverted() }, points)
}

/// A sphere of quads (a refined cube of half side `r`) facing outward, or inward.
pub(crate) fn box_at(k: usize, r: f64, at: [f64; 3], outward: bool) -> (QuadSurface, Points) {
    let (surface, points) = voxels([k, k, k], |_| true);
    let points = points.iter().map(|p| [0, 1, 2].map(|c| at[c] + r * (2.0 * p[c] / k as f64 - 1.0))).collect();
    (if outward { surface } else { surface.inverted() }, points)
}

/// Several surfaces as one.
pub(crate) fn together(parts: &[(QuadSurface, Points)]) -> (QuadSurface, Points) {
    let (mut quads, mut points) = (Vec::new(), Points::new());
    for (surface, p) in parts {
        let shift = points.len() as u32;
        quads.extend(surface.quads().iter().map(|q| q.map(|v| v.0 + shift)));
        points.extend(p);
    }
    (QuadSurface::try_new(points.len(), &quads).unwrap(), points)
}

/// The same surface with one quad more: quads `a b e f` and `b c d e` at an edge become three round a new vertex in its middle.
pub(crate) fn one_more((surface, points): (QuadSurface, Points)) -> (QuadSurface, Points) {
    let (mut quads, mut points) = (surface.quads_raw(), points);
    let d = surface
        .darts()
        .find(|&d| [surface.origin(d), surface.target(d)].iter().all(|&v| surface.degree(v) > 3))
        .unwrap();
    let t = surface.twin(d);
    let [b, e] = [surface.origin(d).0, surface.target(d).0];
    // Round the two quads: d runs from b to e in the one, t from e to b in the other.
    let (d2, d3) = (d.next().next(), d.prev());
    let (t2, t3) = (t.next().next(), t.prev());
    let [x, y] = [surface.origin(d2).0, surface.origin(d3).0];
    let [z, w] = [surface.origin(t2).0, surface.origin(t3).0];
    // Outlines: b e x y and e b z w; together b z w e x y.
    let s = points.len() as u32;
    let middle = [0, 1, 2].map(|c| (points[b as usize][c] + points[e as usize][c]) / 2.0);
    points.push(middle);
    let (p, q) = (d.quad().index(), t.quad().index());
    quads[p] = [b, z, w, s];
    quads[q] = [w, e, x, s];
    quads.push([x, y, b, s]);
    (QuadSurface::try_new(points.len(), &quads).unwrap(), points)
}

/// A box about the origin bulged, so that no three of its vertices are on a line.
pub(crate) fn bulged((surface, points): (QuadSurface, Points)) -> (QuadSurface, Points) {
    let largest = points.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
    let points = points.iter().map(|p| {
        let square: f64 = p.iter().map(|x| (x / largest).powi(2)).sum();
        p.map(|x| x * (1.0 - 0.1 * square))
    });
    (surface, points.collect())
}

/// The vertices and quads of an OBJ file.
pub(crate) fn read_obj(text: &str) -> (QuadSurface, Points) {
    let data = hexfill_io::read_from(text.as_bytes(), hexfill_io::Format::Obj, "surface").unwrap();
    (data.quad_surface().unwrap(), data.points)
}
