//! Meshes that the tests of this crate break on purpose. Built without the code under test.
#![allow(dead_code)]

use hexfill_check::{Judged, Options, Report, judge};
use hexfill_mesh::Context;

/// A mesh with its prescribed boundary.
#[derive(Clone, Debug)]
pub(crate) struct Sample {
    pub n: usize,
    pub hexes: Vec<[u32; 8]>,
    pub surface: Vec<[u32; 4]>,
}

impl Sample {
    pub(crate) fn judged(&self) -> Judged<'_> {
        Judged::connectivity(self.n, &self.hexes).with_surface(&self.surface)
    }

    pub(crate) fn report(&self) -> Report {
        judge(&self.judged(), &Options::default(), &Context::default())
    }
}

pub(crate) fn report(n: usize, hexes: &[[u32; 8]]) -> Report {
    judge(&Judged::connectivity(n, hexes), &Options::default(), &Context::default())
}

/// A block of `size` cubes, ids in lexicographic order, boundary quads outward.
pub(crate) fn grid(size: [usize; 3]) -> Sample {
    let [a, b, c] = size;
    let id = |x: usize, y: usize, z: usize| (x + (a + 1) * (y + (b + 1) * z)) as u32;
    let mut hexes = Vec::new();
    for z in 0..c {
        for y in 0..b {
            for x in 0..a {
                let level = |z| [id(x, y, z), id(x + 1, y, z), id(x + 1, y + 1, z), id(x, y + 1, z)];
                let ([p, q, r, s], [t, u, v, w]) = (level(z), level(z + 1));
                hexes.push([p, q, r, s, t, u, v, w]);
            }
        }
    }
    let mut surface = Vec::new();
    let mut both = |low: [u32; 4], high: [u32; 4]| {
        surface.push([low[0], low[3], low[2], low[1]]);
        surface.push(high);
    };
    for i in 0..b {
        for j in 0..c {
            let side = |x| [id(x, i, j), id(x, i + 1, j), id(x, i + 1, j + 1), id(x, i, j + 1)];
            both(side(0), side(a));
        }
    }
    for i in 0..c {
        for j in 0..a {
            let side = |y| [id(j, y, i), id(j, y, i + 1), id(j + 1, y, i + 1), id(j + 1, y, i)];
            both(side(0), side(b));
        }
    }
    for i in 0..a {
        for j in 0..b {
            let side = |z| [id(i, j, z), id(i + 1, j, z), id(i + 1, j + 1, z), id(i, j + 1, z)];
            both(side(0), side(c));
        }
    }
    Sample { n: (a + 1) * (b + 1) * (c + 1), hexes, surface }
}

/// Positions of the vertices of [`grid`].
pub(crate) fn grid_points(size: [usize; 3]) -> Vec<[f64; 3]> {
    let [a, b, c] = size;
    let mut points = Vec::new();
    for z in 0..=c {
        for y in 0..=b {
            for x in 0..=a {
                points.push([x as f64, y as f64, z as f64]);
            }
        }
    }
    points
}

/// A refinement template from `tests/data`.
pub(crate) fn template(name: &str) -> Sample {
    let path = format!("{}/tests/data/{name}.json", env!("CARGO_MANIFEST_DIR"));
    let data: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    let hexes: Vec<[u32; 8]> = serde_json::from_value(data["hexes"].clone()).unwrap();
    let surface = serde_json::from_value(data["boundary_quads"].clone()).unwrap();
    let n = hexes.iter().flatten().max().unwrap() + 1;
    Sample { n: n as usize, hexes, surface }
}

/// The eight cubes of the tesseract's boundary; the vertices are its 16 corners as bit patterns.
pub(crate) fn tesseract() -> Vec<[u32; 8]> {
    let mut hexes = Vec::new();
    for axis in 0..4u32 {
        for side in 0..2u32 {
            let others: Vec<u32> = (0..4).filter(|&k| k != axis).collect();
            let mut hex = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
                .map(|(x, y, z)| side << axis | x << others[0] | y << others[1] | z << others[2]);
            if (axis + side) % 2 == 1 {
                hex.swap(1, 3);
                hex.swap(5, 7);
            }
            hexes.push(hex);
        }
    }
    hexes
}

/// The tesseract without its first cube: seven cubes in a ball with six boundary quads.
pub(crate) fn tesseract_minus_cube() -> Sample {
    let all = tesseract();
    let h = all[0];
    // The quads of the hole, outward from the other seven: inward as facets of the removed cube.
    let surface = [[0, 3, 7, 4], [1, 5, 6, 2], [0, 4, 5, 1], [3, 2, 6, 7], [0, 1, 2, 3], [4, 7, 6, 5]];
    Sample { n: 16, hexes: all[1..].to_vec(), surface: surface.map(|q| q.map(|k| h[k])).to_vec() }
}

/// A closed ring of `n` cubes; with `twist` the last quad is glued to the first in another rotation, with `mirror` reflected
/// (a solid Klein bottle).
pub(crate) fn ring(n: usize, twist: usize, mirror: bool) -> (usize, Vec<[u32; 8]>) {
    let hexes = (0..n)
        .map(|i| {
            let bottom = [0, 1, 2, 3].map(|k| 4 * i as u32 + k);
            let mut top = [0, 1, 2, 3].map(|k| 4 * ((i + 1) % n) as u32 + k);
            if i + 1 == n {
                top.rotate_left(twist);
                if mirror {
                    top.reverse();
                }
            }
            [bottom[0], bottom[1], bottom[2], bottom[3], top[0], top[1], top[2], top[3]]
        })
        .collect();
    (4 * n, hexes)
}

/// The cubical cone over a triangulated surface: vertex 0 has exactly this surface as link, one hex a triangle.
pub(crate) fn cone(triangles: &[[u32; 3]]) -> (usize, Vec<[u32; 8]>) {
    let corners = triangles.iter().flatten().max().unwrap() + 1;
    let mut edges: Vec<[u32; 2]> = Vec::new();
    for t in triangles {
        for (a, b) in [(0, 1), (1, 2), (0, 2)] {
            let e = [t[a].min(t[b]), t[a].max(t[b])];
            if !edges.contains(&e) {
                edges.push(e);
            }
        }
    }
    let m = edges.len() as u32;
    let edge = |a: u32, b: u32| 1 + corners + edges.iter().position(|e| *e == [a.min(b), a.max(b)]).unwrap() as u32;
    let hexes = triangles
        .iter()
        .enumerate()
        .map(|(i, &[a, b, c])| {
            let top = 1 + corners + m + i as u32;
            [0, 1 + a, edge(a, b), 1 + b, 1 + c, edge(a, c), top, edge(b, c)]
        })
        .collect();
    ((1 + corners + m) as usize + triangles.len(), hexes)
}

/// Möbius' torus with seven vertices.
pub(crate) fn torus() -> Vec<[u32; 3]> {
    (0..7).flat_map(|i| [[i, (i + 1) % 7, (i + 3) % 7], [i, (i + 3) % 7, (i + 2) % 7]]).collect()
}

/// An annulus of six triangles.
pub(crate) fn annulus() -> Vec<[u32; 3]> {
    (0..3).flat_map(|i| [[i, (i + 1) % 3, 3 + i], [(i + 1) % 3, 3 + (i + 1) % 3, 3 + i]]).collect()
}

/// A Möbius band of five triangles.
pub(crate) fn moebius() -> Vec<[u32; 3]> {
    (0..5).map(|i| [i, (i + 1) % 5, (i + 2) % 5]).collect()
}

/// A small deterministic generator (splitmix64).
pub(crate) struct Random(pub u64);

impl Random {
    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub(crate) fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    /// Uniform in 0..1.
    pub(crate) fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    pub(crate) fn shuffle<T>(&mut self, items: &mut [T]) {
        for i in (1..items.len()).rev() {
            items.swap(i, self.below(i + 1));
        }
    }
}
