//! An incremental Delaunay tetrahedralisation with exact predicates.
//!
//! Bowyer (1981) and Watson (1981): a new point removes the tets whose circumsphere strictly contains it, and is joined
//! to the faces round the hole. In exact arithmetic that hole is star-shaped, ties included: a face of the hole in
//! whose plane the point lies would have the point strictly inside the circumspheres on both of its sides. So every tet
//! is positively oriented, always. The points live in one huge tet; its four corners are vertices like all others.
//! Invariant: `around[t][i]` is the tet across the face of `t` opposite its vertex `i`, [`NONE`] at the huge tet.

use crate::tets::OUTWARD;
use crate::vector::{Point, bounding_box};
use robust::{Coord3D, insphere, orient3d};

/// No tet, no vertex.
pub(crate) const NONE: u32 = u32::MAX;

fn coord(p: Point) -> Coord3D<f64> {
    Coord3D { x: p[0], y: p[1], z: p[2] }
}

/// A number with the exact sign of det(b - a, c - a, d - a).
pub(crate) fn orient([a, b, c, d]: [Point; 4]) -> f64 {
    orient3d(coord(b), coord(c), coord(d), coord(a))
}

/// A Delaunay tetrahedralisation. See the module page.
pub(crate) struct Delaunay {
    /// Positions.
    pub points: Vec<Point>,
    /// Vertices of the tets; a free place has [`NONE`] first.
    pub tets: Vec<[u32; 4]>,
    /// The tets across the faces.
    pub around: Vec<[u32; 4]>,
    /// Per vertex a tet of it.
    pub tet_at: Vec<u32>,
    free: Vec<u32>,
    /// Per tet the stamp of the last search that met it.
    pub mark: Vec<u32>,
    stamp: u32,
    last: u32,
}

impl Delaunay {
    /// The huge tet alone: its corners get the first ids that are not those of `points`, which are not inserted yet.
    pub fn new(points: &[Point]) -> Self {
        let (low, high, size) = bounding_box(points);
        let far = 4096.0 * size;
        let centre: Point = std::array::from_fn(|c| low[c] + (high[c] - low[c]) / 2.0);
        let corner = |s: [f64; 3]| std::array::from_fn(|c| centre[c] + far * s[c]);
        let n = points.len() as u32;
        let mut all = points.to_vec();
        all.extend([[-1.0, -1.0, -1.0], [1.0, 1.0, -1.0], [-1.0, 1.0, 1.0], [1.0, -1.0, 1.0]].map(corner));
        let mut tet = [n, n + 1, n + 2, n + 3];
        if orient(tet.map(|v| all[v as usize])) < 0.0 {
            tet.swap(0, 1);
        }
        let mut tet_at = vec![NONE; all.len()];
        tet.iter().for_each(|&v| tet_at[v as usize] = 0);
        Self {
            points: all,
            tets: vec![tet],
            around: vec![[NONE; 4]],
            tet_at,
            free: Vec::new(),
            mark: vec![0],
            stamp: 0,
            last: 0,
        }
    }

    fn at(&self, v: u32) -> Point {
        self.points[v as usize]
    }

    /// A tet that contains `p`, its boundary included, found by walking from `from`.
    pub fn locate(&self, p: Point, from: u32) -> u32 {
        let mut t = from;
        // A visibility walk in a Delaunay tetrahedralisation never comes back (Edelsbrunner 1990).
        'walk: loop {
            for (i, face) in OUTWARD.iter().enumerate() {
                let [a, b, c] = face.map(|k| self.at(self.tets[t as usize][k]));
                if orient([p, a, b, c]) < 0.0 && self.around[t as usize][i] != NONE {
                    t = self.around[t as usize][i];
                    continue 'walk;
                }
            }
            return t;
        }
    }

    /// Adds a new position and inserts it, searching from the tets of vertex `near`.
    ///
    /// # Errors
    /// The vertex that is at this position already.
    pub fn add(&mut self, p: Point, near: u32) -> Result<u32, u32> {
        let v = self.points.len() as u32;
        self.points.push(p);
        self.tet_at.push(NONE);
        let from = if self.tet_at[near as usize] == NONE { self.last } else { self.tet_at[near as usize] };
        self.insert_from(v, from).inspect_err(|_| {
            self.points.pop();
            self.tet_at.pop();
        })?;
        Ok(v)
    }

    /// Inserts the vertex `v`.
    ///
    /// # Errors
    /// The vertex that is at this position already.
    pub fn insert(&mut self, v: u32) -> Result<(), u32> {
        self.insert_from(v, self.last)
    }

    fn insert_from(&mut self, v: u32, from: u32) -> Result<(), u32> {
        let p = self.at(v);
        let first = self.locate(p, from);
        if let Some(&same) = self.tets[first as usize].iter().find(|&&w| self.at(w) == p) {
            return Err(same);
        }
        let stamp = self.new_stamp(first);
        let mut hole = vec![first];
        // Faces of the hole, counter-clockwise seen from outside it, with the tet behind.
        let mut faces: Vec<([u32; 3], u32)> = Vec::new();
        let mut next = 0;
        while next < hole.len() {
            let t = hole[next];
            next += 1;
            for (i, face) in OUTWARD.iter().enumerate() {
                let other = self.around[t as usize][i];
                if other != NONE {
                    if self.mark[other as usize] == stamp {
                        continue;
                    }
                    if self.is_in_sphere(other, p) {
                        self.mark[other as usize] = stamp;
                        hole.push(other);
                        continue;
                    }
                }
                faces.push((face.map(|k| self.tets[t as usize][k]), other));
            }
        }
        for &t in &hole {
            self.tets[t as usize][0] = NONE;
            self.free.push(t);
        }
        let mut sides: Vec<(u32, u32, u32, u32)> = Vec::with_capacity(3 * faces.len());
        for ([a, b, c], other) in faces {
            let t = self.free.pop().unwrap_or_else(|| {
                self.tets.push([NONE; 4]);
                self.around.push([NONE; 4]);
                self.mark.push(0);
                self.tets.len() as u32 - 1
            });
            self.tets[t as usize] = [v, a, b, c];
            debug_assert!(orient([v, a, b, c].map(|w| self.at(w))) > 0.0);
            self.around[t as usize] = [other, NONE, NONE, NONE];
            self.mark[t as usize] = 0;
            if other != NONE {
                let behind = self.tets[other as usize];
                if let Some(k) = (0..4).find(|&k| ![a, b, c].contains(&behind[k])) {
                    self.around[other as usize][k] = t;
                }
            }
            for (k, x, y) in [(1, b, c), (2, a, c), (3, a, b)] {
                sides.push((x.min(y), x.max(y), t, k));
            }
            for w in [v, a, b, c] {
                self.tet_at[w as usize] = t;
            }
            self.last = t;
        }
        sides.sort_unstable();
        for pair in sides.chunks_exact(2) {
            let [(_, _, t, i), (_, _, u, j)] = [pair[0], pair[1]];
            self.around[t as usize][i as usize] = u;
            self.around[u as usize][j as usize] = t;
        }
        Ok(())
    }

    /// A stamp that no tet is marked with but this one.
    pub fn new_stamp(&mut self, t: u32) -> u32 {
        self.stamp += 1;
        self.mark[t as usize] = self.stamp;
        self.stamp
    }

    /// Whether the circumsphere of a tet strictly contains `p`.
    pub fn is_in_sphere(&self, t: u32, p: Point) -> bool {
        let [a, b, c, d] = self.tets[t as usize].map(|w| coord(self.at(w)));
        insphere(b, c, d, a, coord(p)) > 0.0
    }

    /// The tets of a vertex.
    pub fn star(&mut self, v: u32) -> Vec<u32> {
        self.stamp += 1;
        let first = self.tet_at[v as usize];
        let mut star = vec![first];
        self.mark[first as usize] = self.stamp;
        let mut next = 0;
        while next < star.len() {
            let t = star[next] as usize;
            next += 1;
            for i in 0..4 {
                let other = self.around[t][i];
                if self.tets[t][i] != v && other != NONE && self.mark[other as usize] != self.stamp {
                    self.mark[other as usize] = self.stamp;
                    star.push(other);
                }
            }
        }
        star
    }

    /// Whether two vertices are joined by an edge.
    pub fn has_edge(&mut self, a: u32, b: u32) -> bool {
        self.star(a).iter().any(|&t| self.tets[t as usize].contains(&b))
    }

    /// The tets in use, ascending.
    pub fn in_use(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.tets.len()).filter(|&t| self.tets[t][0] != NONE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every tet is positive, neighbours agree, no circumsphere contains a point.
    fn check(d: &Delaunay) {
        for t in d.in_use() {
            let tet = d.tets[t];
            assert!(orient(tet.map(|v| d.at(v))) > 0.0);
            for i in 0..4 {
                let other = d.around[t][i];
                if other != NONE {
                    assert!(d.around[other as usize].contains(&(t as u32)));
                    assert!((0..4).all(|k| k == i || d.tets[other as usize].contains(&tet[k])));
                }
            }
            let [a, b, c, e] = tet.map(|v| coord(d.at(v)));
            assert!(d.points.iter().all(|&p| insphere(b, c, e, a, coord(p)) <= 0.0));
        }
    }

    #[test]
    fn grids_with_every_tie_there_is() {
        let points: Vec<Point> = (0..64).map(|i| [f64::from(i % 4), f64::from(i / 4 % 4), f64::from(i / 16)]).collect();
        let mut d = Delaunay::new(&points);
        for v in 0..64 {
            // An order that jumps about.
            d.insert(v * 29 % 64).unwrap();
        }
        check(&d);
        assert_eq!(d.add([1.0, 1.0, 2.0], 0), Err(1 + 4 + 32));
        assert_eq!(d.add([0.5, 1.0, 2.0], 0), Ok(68));
        assert!(d.has_edge(68, 4 + 32) && !d.has_edge(0, 63));
        check(&d);
        // What lies in the grid's box has volume 27.
        let inside = d.in_use().map(|t| d.tets[t]).filter(|t| t.iter().all(|&v| !(64..68).contains(&v)));
        let total: f64 = inside.map(|t| orient(t.map(|v| d.at(v))) / 6.0).sum();
        assert!((total - 27.0).abs() < 1e-9, "{total}");
    }
}
