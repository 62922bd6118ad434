//! One line a surface and way to construct it, with a hash of everything that comes back: `fingerprint [FILE ...]`, and without
//! files some fifty generated surfaces. Two versions of the crate are compared by comparing what this prints.
//!
//! Ways: the fewest hexes with and without positions, embeddable cells, Erickson's colouring, another variant, both cones,
//! tetrahedra given, and whether a mesh exists.

use hexfill_construct::{
    BallCore, CellChoice, ConstructOptions, DelaunayTets, GivenTets, InteriorTets, RouteChoice, TetRequest, construct,
    core_triangles, existence,
};
use hexfill_mesh::generate::{random_sphere, torus, voxels};
use hexfill_mesh::{Context, QuadSurface};
use std::sync::Arc;

/// Positions.
type Points = Vec<[f64; 3]>;

/// FNV-1a, 64 bits.
struct Hash(u64);

impl Hash {
    fn new() -> Self {
        Self(0xCBF2_9CE4_8422_2325)
    }

    fn add(&mut self, bytes: &[u8]) {
        for b in bytes {
            self.0 = (self.0 ^ u64::from(*b)).wrapping_mul(0x0100_0000_01B3);
        }
    }
}

fn line(name: &str, way: &str, surface: &QuadSurface, points: Option<&[[f64; 3]]>, options: &ConstructOptions) {
    match construct(surface, points, options, &Context::default()) {
        Ok(made) => {
            let mut mesh = Hash::new();
            made.mesh.hexes().iter().flatten().for_each(|v| mesh.add(&v.0.to_le_bytes()));
            let mut start = Hash::new();
            made.start.iter().flatten().flatten().for_each(|x| start.add(&x.to_bits().to_le_bytes()));
            let mut report = Hash::new();
            report.add(made.report.to_string().as_bytes());
            let (v, h) = (made.mesh.n_vertices(), made.mesh.n_hexes());
            println!("{name} {way} {v} {h} {:016x} {:016x} {:016x}", mesh.0, start.0, report.0);
        }
        Err(e) => println!("{name} {way} error {e}"),
    }
}

/// The built-in Delaunay tetrahedra as if they came from elsewhere.
fn given(surface: &QuadSurface, points: &[[f64; 3]]) -> Option<GivenTets> {
    let triangles = core_triangles(surface, RouteChoice::Auto);
    let request = TetRequest { n_vertices: surface.n_vertices(), triangles: &triangles, points: Some(points) };
    let made = DelaunayTets::default().fill(&request, &Context::default()).ok()?;
    let tets = made.tets.iter().map(|t| t.map(|v| v.0)).collect();
    Some(GivenTets { n_vertices: made.n_vertices, tets, points: made.points })
}

fn all_ways(name: &str, surface: &QuadSurface, points: Option<&[[f64; 3]]>) {
    println!("{name} existence {:?}", existence(surface, points));
    let of = |cells, route, ball_core, variant| {
        ConstructOptions::default().with_cells(cells).with_route(route).with_ball_core(ball_core).with_variant(variant)
    };
    let (auto, black) = (RouteChoice::Auto, RouteChoice::Erickson);
    let (fewest, embeddable) = (CellChoice::Fewest, CellChoice::Embeddable);
    line(name, "bare", surface, None, &of(fewest, auto, BallCore::Auto, 0));
    line(name, "bare-centred", surface, None, &of(fewest, auto, BallCore::Centred, 3));
    line(name, "bare-erickson", surface, None, &of(fewest, black, BallCore::Auto, 0));
    let Some(p) = points else { return };
    line(name, "fewest", surface, points, &of(fewest, auto, BallCore::Auto, 0));
    line(name, "fewest-cone", surface, points, &of(fewest, auto, BallCore::Fewest, 1));
    line(name, "embeddable", surface, points, &of(embeddable, auto, BallCore::Auto, 0));
    line(name, "embeddable-3", surface, points, &of(embeddable, auto, BallCore::Auto, 3));
    line(name, "embeddable-cone", surface, points, &of(embeddable, auto, BallCore::Centred, 0));
    line(name, "erickson", surface, points, &of(embeddable, black, BallCore::Auto, 0));
    if let Some(tets) = given(surface, p) {
        let given = of(embeddable, auto, BallCore::Auto, 0).with_tets(Arc::new(tets));
        line(name, "given", surface, points, &given);
    }
}

fn boxes(size: [usize; 3], filled: impl Fn([usize; 3]) -> bool) -> Option<(QuadSurface, Points)> {
    let (surface, points) = voxels(size, filled).ok()?;
    Some((surface, points.into_iter().map(|p| p.map(f64::from)).collect()))
}

fn tube(n: u32, m: u32, i_is_tube: bool) -> Option<(QuadSurface, Points)> {
    let turn = std::f64::consts::TAU;
    let of = |i: u32, j: u32| {
        let (a, b) = (turn * f64::from(i) / f64::from(n), turn * f64::from(j) / f64::from(m));
        let (tube, axis) = if i_is_tube { (a, b) } else { (b, a) };
        let d = 3.0 + tube.cos();
        [d * axis.cos(), d * axis.sin(), tube.sin()]
    };
    let points: Points = (0..m).flat_map(|j| (0..n).map(move |i| of(i, j))).collect();
    let surface = torus(n, m, 0).ok()?;
    Some((if i_is_tube { surface.inverted() } else { surface }, points))
}

/// A quad more: two quads at an edge become three round a new vertex in its middle.
fn one_more((surface, mut points): (QuadSurface, Points)) -> Option<(QuadSurface, Points)> {
    let mut quads: Vec<[u32; 4]> = surface.quads_raw();
    let d = surface.darts().find(|&d| [surface.origin(d), surface.target(d)].iter().all(|&v| surface.degree(v) > 3))?;
    let t = surface.twin(d);
    let [b, e] = [surface.origin(d).0, surface.target(d).0];
    let [x, y] = [surface.origin(d.next().next()).0, surface.origin(d.prev()).0];
    let [z, w] = [surface.origin(t.next().next()).0, surface.origin(t.prev()).0];
    let s = points.len() as u32;
    points.push([0, 1, 2].map(|c| (points[b as usize][c] + points[e as usize][c]) / 2.0));
    quads[d.quad().index()] = [b, z, w, s];
    quads[t.quad().index()] = [w, e, x, s];
    quads.push([x, y, b, s]);
    Some((QuadSurface::try_new(points.len(), &quads).ok()?, points))
}

/// A box of side `2 r` about `at`, facing outward or inward.
fn shell(k: usize, r: f64, at: [f64; 3], outward: bool) -> Option<(QuadSurface, Points)> {
    let (surface, points) = boxes([k, k, k], |_| true)?;
    let points = points.iter().map(|p| [0, 1, 2].map(|c| at[c] + r * (2.0 * p[c] / k as f64 - 1.0))).collect();
    Some((if outward { surface } else { surface.inverted() }, points))
}

fn together(parts: &[(QuadSurface, Points)]) -> Option<(QuadSurface, Points)> {
    let (mut quads, mut points) = (Vec::new(), Points::new());
    for (surface, p) in parts {
        let shift = points.len() as u32;
        quads.extend(surface.quads().iter().map(|q| q.map(|v| v.0 + shift)));
        points.extend(p);
    }
    Some((QuadSurface::try_new(points.len(), &quads).ok()?, points))
}

fn generated() -> Vec<(String, Option<(QuadSurface, Points)>)> {
    let mut all = Vec::new();
    for (n, m) in [(4, 4), (5, 4), (4, 5), (6, 5), (7, 8), (3, 8), (8, 3), (12, 20), (9, 40)] {
        for i_is_tube in [true, false] {
            all.push((format!("torus-{n}-{m}-{i_is_tube}"), tube(n, m, i_is_tube)));
        }
    }
    for genus in 1..=3 {
        let hole = move |p: [usize; 3]| (p[0] / 2) % 2 == 1 && p[1] / 2 == 1;
        all.push((format!("plate-{genus}"), boxes([4 * genus + 2, 6, 2], move |p| !hole(p))));
    }
    all.push(("hollow-1".into(), boxes([3, 3, 5], |p| p != [1, 1, 1])));
    all.push(("hollow-2".into(), boxes([3, 3, 5], |p| p != [1, 1, 1] && p != [1, 1, 3])));
    all.push((
        "hollow-torus".into(),
        boxes([5, 5, 5], |p| !(p[2] == 2 && (1..4).contains(&p[0]) && (1..4).contains(&p[1]) && p != [2, 2, 2])),
    ));
    let o = [0.0; 3];
    for (k, l) in [(3, 3), (4, 2), (5, 3)] {
        let pair = [shell(k, 10.0, o, true), shell(l, 2.0, o, false)];
        let [Some(a), Some(b)] = pair else { continue };
        all.push((format!("even-pair-{k}-{l}"), together(&[a.clone(), b.clone()])));
        let odd = [one_more(a), one_more(b)];
        let [Some(a), Some(b)] = odd else { continue };
        all.push((format!("odd-pair-{k}-{l}"), together(&[a.clone(), b.clone()])));
        if let Some(c) = shell(3, 1.0, [30.0, 0.0, 0.0], true) {
            all.push((format!("odd-pair-apart-{k}-{l}"), together(&[a.clone(), b, c])));
        }
        all.push((format!("odd-alone-{k}"), Some(a)));
    }
    let four: Option<Vec<_>> = [(0.0, 20.0, true), (-9.0, 2.0, false), (0.0, 2.0, false), (9.0, 2.0, false)]
        .into_iter()
        .map(|(x, r, outward)| one_more(shell(3, r, [x, 0.0, 0.0], outward)?))
        .collect();
    all.push(("odd-four".into(), four.and_then(|f| together(&f))));
    all
}

fn main() {
    let files: Vec<String> = std::env::args().skip(1).collect();
    for file in &files {
        let name = file.rsplit('/').next().unwrap_or(file);
        match hexfill_io::read_path(std::path::Path::new(file), None)
            .map_err(|e| e.to_string())
            .and_then(|data| data.quad_surface().map(|s| (s, data.points.clone())).map_err(|e| e.to_string()))
        {
            Ok((surface, points)) => all_ways(name, &surface, Some(&points)),
            Err(e) => println!("{name} unreadable {e}"),
        }
    }
    if files.is_empty() {
        for seed in 0..12u64 {
            let n = 8 + 10 * seed as usize;
            match random_sphere(n, seed) {
                Some(surface) => all_ways(&format!("sphere-{n}"), &surface, None),
                None => println!("sphere-{n} none"),
            }
        }
        for (name, made) in generated() {
            match made {
                Some((surface, points)) => all_ways(&name, &surface, Some(&points)),
                None => println!("{name} none"),
            }
        }
    }
}
