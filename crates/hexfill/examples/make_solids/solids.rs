//! Solids an engineer would sweep or block, each with the good hex mesh known for it.

use crate::section::{Section, between, unit};
use crate::solid::{Map, Point, Solid};
use std::f64::consts::PI;

/// The point of the unit ball for a point of the cube [-1, 1]^3; the cube's faces go to the sphere.
pub(crate) fn ball([x, y, z]: Point) -> Point {
    let on = |a: f64, b: f64, c: f64| a * (1.0 - b * b / 2.0 - c * c / 2.0 + b * b * c * c / 3.0).sqrt();
    [on(x, y, z), on(y, z, x), on(z, x, y)]
}

/// A ball: a core of `n^3` hexes and `layers` layers of `6 n^2`; of the upper half only, if wanted (then `n` is even).
pub(crate) fn o_grid_ball(n: usize, layers: usize, upper_half: bool) -> Solid {
    let core = |p: Point| between(p, ball(p), 0.5).map(|x| 0.55 * x);
    let low = if upper_half { 0.0 } else { -1.0 };
    let height = if upper_half { n / 2 } else { n };
    let lift = move |w: f64| low + (1.0 - low) * w;
    let shell = |p: Point, t: f64| between(core(p), ball(p), t);
    let inside = |[u, v, w]: Point| core([2.0 * u - 1.0, 2.0 * v - 1.0, lift(w)]);
    let top = |[u, v, t]: Point| shell([2.0 * u - 1.0, 2.0 * v - 1.0, 1.0], t);
    let bottom = |[u, v, t]: Point| shell([2.0 * u - 1.0, 2.0 * v - 1.0, -1.0], t);
    let right = |[u, w, t]: Point| shell([1.0, 2.0 * u - 1.0, lift(w)], t);
    let left = |[u, w, t]: Point| shell([-1.0, 2.0 * u - 1.0, lift(w)], t);
    let back = |[u, w, t]: Point| shell([2.0 * u - 1.0, 1.0, lift(w)], t);
    let front = |[u, w, t]: Point| shell([2.0 * u - 1.0, -1.0, lift(w)], t);
    let side = [n, height, layers];
    let mut blocks: Vec<([usize; 3], Map<'_>)> = vec![
        ([n, n, height], &inside),
        ([n, n, layers], &top),
        (side, &right),
        (side, &left),
        (side, &back),
        (side, &front),
    ];
    if !upper_half {
        blocks.push(([n, n, layers], &bottom));
    }
    Solid::blocks(&blocks)
}

/// The shell between two spheres: `layers` layers of `6 n^2` hexes.
pub(crate) fn hollow_ball(n: usize, layers: usize, inner_radius: f64) -> Solid {
    let face = |axis: usize, sign: f64| {
        move |[u, v, t]: Point| {
            let mut p = [sign; 3];
            (p[(axis + 1) % 3], p[(axis + 2) % 3]) = (2.0 * u - 1.0, 2.0 * v - 1.0);
            ball(p).map(|x| x * (inner_radius + t * (1.0 - inner_radius)))
        }
    };
    let faces: Vec<_> = (0..6).map(|i| face(i / 2, if i % 2 == 0 { -1.0 } else { 1.0 })).collect();
    let blocks: Vec<([usize; 3], Map<'_>)> = faces.iter().map(|f| ([n, n, layers], f as Map<'_>)).collect();
    Solid::blocks(&blocks)
}

fn everywhere(_: usize, _: usize) -> bool {
    true
}

/// A section raised to a height.
fn prism(section: &Section, layers: usize, height: f64) -> Solid {
    Solid::swept(section, layers, everywhere, |[x, y], t| [x, y, height * t])
}

/// The cells of a box for which `filled` holds.
fn cells(size: [i32; 3], filled: impl Fn([i32; 3]) -> bool) -> Vec<[i32; 3]> {
    let [x, y, z] = size;
    let all = (0..x * y * z).map(|i| [i % x, i / x % y, i / x / y]);
    all.filter(|&c| filled(c)).collect()
}

/// A smooth deformation of a grid of some cells.
fn deformed([x, y, z]: Point) -> Point {
    [x + 0.25 * (0.6 * y + 0.4 * z).sin(), y + 0.25 * (0.5 * z + 0.3 * x).sin(), z + 0.2 * (0.5 * x - 0.4 * y).cos()]
}

/// Parts made on a lathe by name: tubes of four rings and rods of a core and five, of which rings are left out in some layers.
pub(crate) fn turned() -> Vec<(&'static str, Solid)> {
    type Keep = fn(usize, usize) -> bool;
    let tube = |keep: Keep| {
        let section = Section::annulus(24, 4, [1.0, 2.0]);
        Solid::swept(&section, 8, |quad, layer| keep(quad / 24, layer), |[x, y], t| [x, y, 2.0 * t])
    };
    // The core is ring 0.
    let rod = |keep: Keep| {
        let ring = |quad: usize| if quad < 16 { 0 } else { quad / 16 };
        Solid::swept(&Section::o_grid(4, 5), 12, |quad, layer| keep(ring(quad), layer), |[x, y], t| [x, y, 3.0 * t])
    };
    vec![
        ("flange", tube(|ring, layer| ring < 2 || layer < 2)),
        ("two_flanges", tube(|ring, layer| ring < 2 || !(2..6).contains(&layer))),
        ("pulley", tube(|ring, layer| ring < 3 || !(3..5).contains(&layer))),
        ("stepped_bore", tube(|ring, layer| ring > 1 || layer < 3)),
        ("three_diameters", rod(|ring, layer| ring < 3 || ring < 5 && layer < 8 || layer < 4)),
        ("dumbbell", rod(|ring, layer| ring < 3 || !(3..9).contains(&layer))),
        ("spool", rod(|ring, layer| ring < 3 || layer < 3 || ring < 5 && layer > 8)),
        ("cup", rod(|ring, layer| ring > 3 || layer < 3)),
        ("nozzle", rod(|ring, layer| ring > 3 || ring > 2 && layer < 9 || layer < 4)),
        ("piston", rod(|ring, layer| layer > 8 || ring > 2 && (ring < 5 || !matches!(layer, 2 | 5)))),
        ("grooved", rod(|ring, layer| ring < 5 || !matches!(layer, 2 | 3 | 7))),
    ]
}

/// All solids by name. A table, a line or two each: it is read by looking up, so it stays in one piece.
pub(crate) fn all() -> Vec<(&'static str, Solid)> {
    let square = |n: usize, a: f64| Section::rectangle([n, n], [a, a]);
    let l_cells: Vec<[i32; 2]> = (0..36).map(|i| [i % 6, i / 6]).filter(|&[x, y]| x < 2 || y < 2).collect();
    let t_cells: Vec<[i32; 2]> =
        (0..49).map(|i| [i % 7, i / 7]).filter(|&[x, y]| y >= 5 || (2..5).contains(&x)).collect();
    let frame: Vec<[i32; 2]> =
        (0..36).map(|i| [i % 6, i / 6]).filter(|c| !c.iter().all(|x| (2..4).contains(x))).collect();
    let shaft = Section::o_grid(4, 4);
    let wedge = [[0.0, 0.0], [4.0, 0.0], [4.0, 1.6]];
    vec![
        ("box_4x5x3", prism(&Section::rectangle([4, 5], [4.0, 5.0]), 3, 3.0)),
        ("box_10x10x10", prism(&square(10, 10.0), 10, 10.0)),
        ("prism_triangle", prism(&Section::regular(3, 3), 6, 2.0)),
        ("prism_pentagon", prism(&Section::regular(5, 2), 5, 2.0)),
        ("prism_hexagon", prism(&Section::regular(6, 2), 5, 2.0)),
        ("prism_octagon", prism(&Section::regular(8, 2), 6, 2.5)),
        ("cylinder", prism(&Section::o_grid(4, 3), 5, 2.0)),
        ("cylinder_fine", prism(&Section::o_grid(6, 4), 16, 4.0)),
        (
            "pipe_bend",
            Solid::swept(&Section::annulus(12, 2, [0.6, 1.0]), 10, everywhere, |[x, y], t| {
                let [c, s] = unit(PI / 2.0 * t);
                [(3.0 + x) * c, (3.0 + x) * s, y]
            }),
        ),
        (
            "rod_bend",
            Solid::swept(&Section::o_grid(4, 2), 12, everywhere, |[x, y], t| {
                let [c, s] = unit(PI / 2.0 * t);
                [(2.5 + x) * c, (2.5 + x) * s, y]
            }),
        ),
        (
            "twisted_bar",
            Solid::swept(&square(4, 1.0), 16, everywhere, |[x, y], t| {
                let [c, s] = unit(PI / 2.0 * t);
                [c * x - s * y, s * x + c * y, 4.0 * t]
            }),
        ),
        (
            "tapered_bar",
            Solid::swept(&square(4, 2.0), 12, everywhere, |[x, y], t| {
                [x * (1.0 - 0.6 * t), y * (1.0 - 0.6 * t), 6.0 * t]
            }),
        ),
        ("sphere", o_grid_ball(6, 2, false)),
        ("ellipsoid", o_grid_ball(6, 2, false).mapped(|[x, y, z]| [2.0 * x, 1.3 * y, z])),
        ("half_cylinder", prism(&Section::half_o_grid(3, 3), 8, 2.5)),
        ("l_bracket", prism(&Section::cells(&l_cells), 4, 4.0)),
        ("t_joint", prism(&Section::cells(&t_cells), 3, 3.0)),
        (
            // The rings listed last stay below: the shaft steps in above the fifth layer.
            "step_shaft",
            Solid::swept(&shaft, 12, |quad, layer| quad < 48 || layer < 5, |[x, y], t| [x, y, 4.0 * t]),
        ),
        ("plate_square_hole", prism(&Section::cells(&frame), 2, 2.0)),
        ("plate_round_hole", prism(&Section::square_with_round_hole(6, 4, 0.5), 2, 0.4)),
        (
            "torus_block",
            Solid::swept(&square(3, 1.0), 20, everywhere, |[x, y], t| {
                let [c, s] = unit(2.0 * PI * t);
                [(2.0 + x) * c, (2.0 + x) * s, y]
            }),
        ),
        (
            "torus_round",
            Solid::swept(&Section::o_grid(3, 2), 24, everywhere, |[x, y], t| {
                let [c, s] = unit(2.0 * PI * t);
                [(3.0 + x) * c, (3.0 + x) * s, y]
            }),
        ),
        ("hollow_sphere", hollow_ball(5, 3, 0.55)),
        ("wedge", prism(&Section::polygon(&wedge, 3), 4, 2.0)),
        ("dome", o_grid_ball(6, 2, true)),
        (
            "helix_bar",
            Solid::swept(&square(3, 0.8), 40, everywhere, |[x, y], t| {
                let [c, s] = unit(3.0 * PI * t);
                [(2.0 + x) * c, (2.0 + x) * s, y + 3.5 * t]
            }),
        ),
        ("stairs", Solid::voxels(&cells([5, 3, 5], |[x, _, z]| z <= x), &deformed)),
        (
            "mushroom",
            Solid::voxels(
                &cells([6, 6, 6], |[x, y, z]| z >= 4 || [x, y].iter().all(|a| (2..4).contains(a))),
                &deformed,
            ),
        ),
        ("u_shape", Solid::voxels(&cells([6, 2, 5], |[x, _, z]| z < 2 || !(2..4).contains(&x)), &deformed)),
    ]
}
