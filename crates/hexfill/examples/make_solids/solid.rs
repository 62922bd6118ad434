//! [`Solid`]: a hex mesh with positions, put together from blocks or swept from a section; its boundary is a test surface.

use crate::section::Section;
use hexfill_mesh::cube::{FACETS, POSITIONS};
use std::collections::{BTreeMap, HashMap};

/// A point of space.
pub(crate) type Point = [f64; 3];

/// A map of space.
pub(crate) type Map<'a> = &'a dyn Fn(Point) -> Point;

/// Points closer than this are one vertex; the solids have sizes of 0.01 to 30.
const SAME: f64 = 1e-6;

/// Gives points numbers, equal points equal ones.
#[derive(Default)]
pub(crate) struct Welder {
    /// The points by number.
    pub points: Vec<Point>,
    cells: HashMap<[i64; 3], Vec<u32>>,
}

impl Welder {
    /// The number of a point.
    pub(crate) fn id(&mut self, p: Point) -> u32 {
        let cell = p.map(|x| (x / (4.0 * SAME)).floor() as i64);
        // A point near the wall of its cell may have been met on the other side.
        for i in 0..27 {
            let near = [cell[0] + i % 3 - 1, cell[1] + i / 3 % 3 - 1, cell[2] + i / 9 - 1];
            let met = self.cells.get(&near).into_iter().flatten();
            let same = |&&v: &&u32| {
                let q = self.points[v as usize];
                (0..3).all(|k| (p[k] - q[k]).abs() < SAME)
            };
            if let Some(&v) = { met }.find(same) {
                return v;
            }
        }
        let v = self.points.len() as u32;
        self.points.push(p);
        self.cells.entry(cell).or_default().push(v);
        v
    }
}

/// A hex mesh. The vertices of its boundary come first, in the order of [`boundary`](Self::boundary).
pub(crate) struct Solid {
    /// Positions.
    pub points: Vec<Point>,
    /// Corners in VTK order, positively oriented.
    pub hexes: Vec<[u32; 8]>,
}

impl Solid {
    /// Blocks of `n[0] * n[1] * n[2]` hexes, each the image of the unit cube under its map, welded where they meet.
    pub(crate) fn blocks(blocks: &[([usize; 3], Map<'_>)]) -> Self {
        let mut welder = Welder::default();
        let mut hexes = Vec::new();
        for (n, map) in blocks {
            for i in 0..n[0] * n[1] * n[2] {
                let at = [i % n[0], i / n[0] % n[1], i / n[0] / n[1]];
                hexes.push(
                    POSITIONS
                        .map(|p| welder.id(map([0, 1, 2].map(|k| (at[k] + usize::from(p[k])) as f64 / n[k] as f64)))),
                );
            }
        }
        Self { points: welder.points, hexes }.settled()
    }

    /// The cells of a grid, given by their lowest corners, under a map.
    pub(crate) fn voxels(cells: &[[i32; 3]], map: Map<'_>) -> Self {
        let mut ids = BTreeMap::new();
        let mut points = Vec::new();
        let corner = |cell: &[i32; 3], p: [u8; 3]| [0, 1, 2].map(|k| cell[k] + i32::from(p[k]));
        let hexes = cells.iter().map(|cell| {
            POSITIONS.map(|p| {
                let at = corner(cell, p);
                *ids.entry(at).or_insert_with(|| {
                    points.push(map(at.map(f64::from)));
                    points.len() as u32 - 1
                })
            })
        });
        let hexes = hexes.collect();
        Self { points, hexes }.settled()
    }

    /// A section swept through `layers` layers; `map` takes a point of the section and the height (0 to 1). The layer of a quad
    /// is left out where `filled` (quad, layer) says so. If the ends meet, they are welded.
    pub(crate) fn swept(
        section: &Section,
        layers: usize,
        filled: impl Fn(usize, usize) -> bool,
        map: impl Fn([f64; 2], f64) -> Point,
    ) -> Self {
        let mut welder = Welder::default();
        let mut hexes = Vec::new();
        for layer in 0..layers {
            for (_, corners) in section.quads.iter().enumerate().filter(|&(quad, _)| filled(quad, layer)) {
                hexes.push(std::array::from_fn(|i| {
                    let height = (layer + i / 4) as f64 / layers as f64;
                    welder.id(map(section.points[corners[i % 4] as usize], height))
                }));
            }
        }
        Self { points: welder.points, hexes }.settled()
    }

    /// Several meshes, welded where they meet.
    pub(crate) fn joined(parts: &[Self]) -> Self {
        let mut welder = Welder::default();
        let mut hexes = Vec::new();
        for part in parts {
            hexes.extend(part.hexes.iter().map(|h| h.map(|v| welder.id(part.points[v as usize]))));
        }
        Self { points: welder.points, hexes }.settled()
    }

    /// The same mesh, moved.
    #[must_use]
    pub(crate) fn mapped(self, map: impl Fn(Point) -> Point) -> Self {
        Self { points: self.points.into_iter().map(map).collect(), ..self }.settled()
    }

    /// Orients the hexes and puts the boundary's vertices first.
    fn settled(mut self) -> Self {
        for i in 0..self.hexes.len() {
            if self.volume_sign(self.hexes[i]) < 0.0 {
                let [a, b, c, d, e, f, g, h] = self.hexes[i];
                self.hexes[i] = [e, f, g, h, a, b, c, d];
            }
        }
        let mut number = vec![u32::MAX; self.points.len()];
        let mut points = Vec::with_capacity(self.points.len());
        let boundary = self.boundary();
        for v in boundary.iter().flatten().chain(self.hexes.iter().flatten()).map(|&v| v as usize) {
            if number[v] == u32::MAX {
                number[v] = points.len() as u32;
                points.push(self.points[v]);
            }
        }
        let hexes = self.hexes.iter().map(|h| h.map(|v| number[v as usize])).collect();
        Self { points, hexes }
    }

    /// The sign of the determinant at the centre.
    fn volume_sign(&self, hex: [u32; 8]) -> f64 {
        let mut axes = [[0.0; 3]; 3];
        for (corner, v) in POSITIONS.iter().zip(hex) {
            for (axis, &side) in axes.iter_mut().zip(corner) {
                for (x, p) in axis.iter_mut().zip(self.points[v as usize]) {
                    *x += if side == 1 { p } else { -p };
                }
            }
        }
        let [a, b, c] = axes;
        a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
    }

    /// The quads in one hex, seen from outside.
    pub(crate) fn boundary(&self) -> Vec<[u32; 4]> {
        let mut open: HashMap<[u32; 4], u32> = HashMap::new();
        let facets = || self.hexes.iter().flat_map(|h| FACETS.map(|f| f.map(|i| h[i])));
        let sorted = |mut q: [u32; 4]| {
            q.sort_unstable();
            q
        };
        for facet in facets() {
            *open.entry(sorted(facet)).or_default() += 1;
        }
        facets().filter(|&q| open[&sorted(q)] == 1).collect()
    }

    /// The boundary with its points, which are the first of the mesh.
    pub(crate) fn surface(&self) -> (Vec<Point>, Vec<[u32; 4]>) {
        let quads = self.boundary();
        let n = quads.iter().flatten().max().map_or(0, |&v| v as usize + 1);
        (self.points[..n].to_vec(), quads)
    }
}
