//! [`Section`]: plane quad meshes to be swept.

use crate::solid::Welder;
use std::f64::consts::PI;

/// A plane quad mesh.
pub(crate) struct Section {
    /// Positions.
    pub points: Vec<[f64; 2]>,
    /// Corners of each quad, counter-clockwise.
    pub quads: Vec<[u32; 4]>,
}

/// A map of the plane.
type Map<'a> = &'a dyn Fn([f64; 2]) -> [f64; 2];

/// How finely the unit square is cut, and where it goes.
type Patch<'a> = ([usize; 2], Map<'a>);

/// The point of the unit disk for a point of the square [-1, 1]^2 (elliptical grid mapping); squares become ellipses.
pub(crate) fn disk([x, y]: [f64; 2]) -> [f64; 2] {
    [x * (1.0 - y * y / 2.0).sqrt(), y * (1.0 - x * x / 2.0).sqrt()]
}

/// Between two points.
pub(crate) fn between<const N: usize>(a: [f64; N], b: [f64; N], t: f64) -> [f64; N] {
    std::array::from_fn(|k| a[k] + t * (b[k] - a[k]))
}

impl Section {
    /// Patches, each the image of the unit square cut into `n[0] * n[1]` quads, welded where they meet.
    fn patches(patches: &[Patch<'_>]) -> Self {
        let mut welder = Welder::default();
        let mut quads = Vec::new();
        for (n, map) in patches {
            for i in 0..n[0] * n[1] {
                let at = [i % n[0], i / n[0]];
                quads.push([[0, 0], [1, 0], [1, 1], [0, 1]].map(|p: [usize; 2]| {
                    let [x, y] = map([0, 1].map(|k| (at[k] + p[k]) as f64 / n[k] as f64));
                    welder.id([x, y, 0.0])
                }));
            }
        }
        Self { points: welder.points.iter().map(|&[x, y, _]| [x, y]).collect(), quads }
    }

    /// A rectangle about the origin.
    pub(crate) fn rectangle(n: [usize; 2], size: [f64; 2]) -> Self {
        Self::patches(&[(n, &|p| [0, 1].map(|k| size[k] * (p[k] - 0.5)))])
    }

    /// Unit cells of a grid given by their lowest corners.
    pub(crate) fn cells(cells: &[[i32; 2]]) -> Self {
        let maps: Vec<_> = cells.iter().map(|&c| move |p: [f64; 2]| [0, 1].map(|k| f64::from(c[k]) + p[k])).collect();
        let patches: Vec<Patch<'_>> = maps.iter().map(|map| ([1, 1], map as Map<'_>)).collect();
        Self::patches(&patches)
    }

    /// A convex polygon cut into one patch of `n * n` quads a corner, which meet at the centre.
    pub(crate) fn polygon(corners: &[[f64; 2]], n: usize) -> Self {
        let k = corners.len();
        let centre = [0, 1].map(|i| corners.iter().map(|c| c[i]).sum::<f64>() / k as f64);
        let maps: Vec<_> = (0..k)
            .map(|i| {
                let (a, before, after) = (corners[i], corners[(i + k - 1) % k], corners[(i + 1) % k]);
                let (b, d) = (between(a, after, 0.5), between(a, before, 0.5));
                move |[u, v]: [f64; 2]| between(between(a, b, u), between(d, centre, u), v)
            })
            .collect();
        let patches: Vec<Patch<'_>> = maps.iter().map(|map| ([n, n], map as Map<'_>)).collect();
        Self::patches(&patches)
    }

    /// A regular polygon with radius 1, as [`polygon`](Self::polygon).
    pub(crate) fn regular(k: usize, n: usize) -> Self {
        let corners: Vec<_> = (0..k).map(|i| unit(2.0 * PI * i as f64 / k as f64)).collect();
        Self::polygon(&corners, n)
    }

    /// The unit disk: a core of `core * core` quads and `rings` rings round it, listed from inside out.
    pub(crate) fn o_grid(core: usize, rings: usize) -> Self {
        Self::o_grid_part(core, rings, false)
    }

    /// The upper half of the unit disk: a core of `2 * core` by `core` quads and `rings` rings.
    pub(crate) fn half_o_grid(core: usize, rings: usize) -> Self {
        Self::o_grid_part(core, rings, true)
    }

    fn o_grid_part(core: usize, rings: usize, half: bool) -> Self {
        let inner = |p: [f64; 2]| between(p, disk(p), 0.4).map(|x| 0.6 * x);
        let low = if half { 0.0 } else { -1.0 };
        let (width, height) = if half { (2 * core, core) } else { (core, core) };
        let side = |at: usize, t: f64| match at {
            0 => [1.0, low + (1.0 - low) * t],
            1 => [1.0 - 2.0 * t, 1.0],
            2 => [-1.0, 1.0 - (1.0 - low) * t],
            _ => [2.0 * t - 1.0, -1.0],
        };
        let core_map = |[u, v]: [f64; 2]| inner([2.0 * u - 1.0, low + (1.0 - low) * v]);
        let mut maps = Vec::new();
        for ring in 0..rings {
            for at in 0..if half { 3 } else { 4 } {
                let n = if at % 2 == 0 { height } else { width };
                let map = move |[u, v]: [f64; 2]| {
                    let p = side(at, v);
                    between(inner(p), disk(p), (ring as f64 + u) / rings as f64)
                };
                maps.push(([1, n], map));
            }
        }
        let core_patch: Patch<'_> = ([width, height], &core_map);
        let patches: Vec<Patch<'_>> =
            std::iter::once(core_patch).chain(maps.iter().map(|(n, map)| (*n, map as Map<'_>))).collect();
        Self::patches(&patches)
    }

    /// A ring between two radii.
    pub(crate) fn annulus(around: usize, rings: usize, radii: [f64; 2]) -> Self {
        let map = |[u, v]: [f64; 2]| unit(2.0 * PI * v).map(|x| x * (radii[0] + u * (radii[1] - radii[0])));
        Self::patches(&[([rings, around], &map)])
    }

    /// The square [-1, 1]^2 with a round hole: `n` quads a side, `rings` rings.
    pub(crate) fn square_with_round_hole(n: usize, rings: usize, radius: f64) -> Self {
        let maps: Vec<_> = (0..4)
            .map(|at| {
                move |[u, v]: [f64; 2]| {
                    let (mut p, angle) = ([1.0, 2.0 * v - 1.0], PI / 2.0 * (v - 0.5));
                    let mut q = unit(angle).map(|x| radius * x);
                    for _ in 0..at {
                        (p, q) = ([-p[1], p[0]], [-q[1], q[0]]);
                    }
                    between(q, p, u)
                }
            })
            .collect();
        let patches: Vec<Patch<'_>> = maps.iter().map(|map| ([rings, n], map as Map<'_>)).collect();
        Self::patches(&patches)
    }
}

/// The point of the unit circle at an angle.
pub(crate) fn unit(angle: f64) -> [f64; 2] {
    [angle.cos(), angle.sin()]
}
