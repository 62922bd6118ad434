//! An incremental Delaunay tetrahedralisation with exact predicates.
//!
//! Bowyer (1981) and Watson (1981): a new point removes the tets whose circumsphere strictly contains it, and is joined
//! to the faces round the hole. In exact arithmetic that hole is star-shaped, ties included: a face of the hole in
//! whose plane the point lies would have the point strictly inside the circumspheres on both of its sides. So every tet
//! is positively oriented, always. The points live in one huge tet; its four corners are vertices like all others.
//! Invariant: `around[t][i]` is the tet across the face of `t` opposite its vertex `i`, none at the huge tet.
//!
//! Source: Bowyer 1981, Watson 1981; Edelsbrunner 1990 (why the walk to a point ends); Shewchuk 1997, section 4.4 (ORIENT3D,
//! INSPHERE).

use crate::core::complex::OUTWARD;
use crate::ids::TetId;
use hexfill_geometry::{Vector, bounding_box};
use hexfill_mesh::{IdVec, VertexId};
use robust::{Coord3D, insphere, orient3d};

fn coord(p: Vector) -> Coord3D<f64> {
    Coord3D { x: p[0], y: p[1], z: p[2] }
}

/// A number with the exact sign of det(b - a, c - a, d - a).
pub(crate) fn orient([a, b, c, d]: [Vector; 4]) -> f64 {
    orient3d(coord(b), coord(c), coord(d), coord(a))
}

/// A Delaunay tetrahedralisation. See the module page.
pub(crate) struct Delaunay {
    /// Positions.
    pub points: IdVec<VertexId, Vector>,
    /// Vertices of the tets; a free place has none first.
    pub tets: IdVec<TetId, [VertexId; 4]>,
    /// The tets across the faces.
    pub around: IdVec<TetId, [TetId; 4]>,
    /// Per vertex a tet of it.
    pub tet_at: IdVec<VertexId, TetId>,
    free: Vec<TetId>,
    /// Per tet the stamp of the last search that met it.
    pub mark: IdVec<TetId, u32>,
    stamp: u32,
    last: TetId,
}

impl Delaunay {
    /// The huge tet alone: its corners get the first ids that are not those of `points`, which are not inserted yet.
    pub(super) fn new(points: &[Vector]) -> Self {
        let (low, high, size) = bounding_box(points);
        // Not infinitely far: hull tets of the points may be missing where the hull is nearly flat. That does no
        // harm, only what lies inside the surface is kept.
        let far = 4096.0 * size;
        let centre: Vector = std::array::from_fn(|c| low[c] + (high[c] - low[c]) / 2.0);
        let corner = |s: [f64; 3]| std::array::from_fn(|c| centre[c] + far * s[c]);
        let n = points.len();
        let mut all: IdVec<VertexId, Vector> = points.to_vec().into();
        all.extend([[-1.0, -1.0, -1.0], [1.0, 1.0, -1.0], [-1.0, 1.0, 1.0], [1.0, -1.0, 1.0]].map(corner));
        let mut tet = [n, n + 1, n + 2, n + 3].map(VertexId::new);
        if orient(tet.map(|v| all[v])) < 0.0 {
            tet.swap(0, 1);
        }
        let mut tet_at = IdVec::filled(TetId::NONE, all.len());
        tet.iter().for_each(|&v| tet_at[v] = TetId(0));
        Self {
            points: all,
            tets: vec![tet].into(),
            around: vec![[TetId::NONE; 4]].into(),
            tet_at,
            free: Vec::new(),
            mark: vec![0].into(),
            stamp: 0,
            last: TetId(0),
        }
    }

    fn at(&self, v: VertexId) -> Vector {
        self.points[v]
    }

    /// A tet that contains `p`, its boundary included, found by walking from `from`.
    pub(super) fn locate(&self, p: Vector, from: TetId) -> TetId {
        let mut t = from;
        // A visibility walk in a Delaunay tetrahedralisation never comes back (Edelsbrunner 1990).
        'walk: loop {
            for (i, face) in OUTWARD.iter().enumerate() {
                let [a, b, c] = face.map(|k| self.at(self.tets[t][k]));
                if orient([p, a, b, c]) < 0.0 && self.around[t][i].is_some() {
                    t = self.around[t][i];
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
    pub(super) fn add(&mut self, p: Vector, near: VertexId) -> Result<VertexId, VertexId> {
        let v = self.points.push(p);
        self.tet_at.push(TetId::NONE);
        let from = if self.tet_at[near].is_none() { self.last } else { self.tet_at[near] };
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
    pub(super) fn insert(&mut self, v: VertexId) -> Result<(), VertexId> {
        self.insert_from(v, self.last)
    }

    fn insert_from(&mut self, v: VertexId, from: TetId) -> Result<(), VertexId> {
        let p = self.at(v);
        let first = self.locate(p, from);
        // A second vertex at the place of a first is on the spheres round it and inside none: a face of the hole
        // through it would make a tet without volume.
        if let Some(&same) = self.tets[first].iter().find(|&&w| self.at(w) == p) {
            return Err(same);
        }
        let faces = self.dig(p, first);
        let mut sides: Vec<(VertexId, VertexId, TetId, u8)> = Vec::with_capacity(3 * faces.len());
        for ([a, b, c], other) in faces {
            let t = self.place([v, a, b, c]);
            debug_assert!(orient([v, a, b, c].map(|w| self.at(w))) > 0.0);
            self.around[t] = [other, TetId::NONE, TetId::NONE, TetId::NONE];
            if other.is_some() {
                let behind = self.tets[other];
                if let Some(k) = (0..4).find(|&k| ![a, b, c].contains(&behind[k])) {
                    self.around[other][k] = t;
                }
            }
            for (k, x, y) in [(1, b, c), (2, a, c), (3, a, b)] {
                sides.push((x.min(y), x.max(y), t, k));
            }
        }
        // Every edge round the hole is that of two new tets: what they share with `v`.
        sides.sort_unstable();
        for pair in sides.chunks_exact(2) {
            let [(_, _, t, i), (_, _, u, j)] = [pair[0], pair[1]];
            self.around[t][usize::from(i)] = u;
            self.around[u][usize::from(j)] = t;
        }
        Ok(())
    }

    /// Takes out the tets whose circumsphere contains `p`, which lies in the first one. What is left are the faces of the hole,
    /// counter-clockwise seen from outside it, with the tet behind.
    fn dig(&mut self, p: Vector, first: TetId) -> Vec<([VertexId; 3], TetId)> {
        let stamp = self.new_stamp(first);
        let mut hole = vec![first];
        let mut faces = Vec::new();
        let mut next = 0;
        while next < hole.len() {
            let t = hole[next];
            next += 1;
            for (i, face) in OUTWARD.iter().enumerate() {
                let other = self.around[t][i];
                if other.is_some() {
                    if self.mark[other] == stamp {
                        continue;
                    }
                    if self.is_in_sphere(other, p) {
                        self.mark[other] = stamp;
                        hole.push(other);
                        continue;
                    }
                }
                faces.push((face.map(|k| self.tets[t][k]), other));
            }
        }
        for &t in &hole {
            self.tets[t][0] = VertexId::NONE;
            self.free.push(t);
        }
        faces
    }

    /// A new tet in a free place.
    fn place(&mut self, tet: [VertexId; 4]) -> TetId {
        let t = self.free.pop().unwrap_or_else(|| {
            self.around.push([TetId::NONE; 4]);
            self.mark.push(0);
            self.tets.push(tet)
        });
        self.tets[t] = tet;
        self.mark[t] = 0;
        for w in tet {
            self.tet_at[w] = t;
        }
        self.last = t;
        t
    }

    /// A stamp that no tet is marked with but this one.
    pub(super) fn new_stamp(&mut self, t: TetId) -> u32 {
        self.stamp += 1;
        self.mark[t] = self.stamp;
        self.stamp
    }

    /// Whether the circumsphere of a tet strictly contains `p`.
    pub(super) fn is_in_sphere(&self, t: TetId, p: Vector) -> bool {
        let [a, b, c, d] = self.tets[t].map(|w| coord(self.at(w)));
        insphere(b, c, d, a, coord(p)) > 0.0
    }

    /// The tets of a vertex.
    pub(super) fn star(&mut self, v: VertexId) -> Vec<TetId> {
        self.stamp += 1;
        let first = self.tet_at[v];
        let mut star = vec![first];
        self.mark[first] = self.stamp;
        let mut next = 0;
        while next < star.len() {
            let t = star[next];
            next += 1;
            for i in 0..4 {
                let other = self.around[t][i];
                if self.tets[t][i] != v && other.is_some() && self.mark[other] != self.stamp {
                    self.mark[other] = self.stamp;
                    star.push(other);
                }
            }
        }
        star
    }

    /// Whether two vertices are joined by an edge.
    pub(super) fn has_edge(&mut self, a: VertexId, b: VertexId) -> bool {
        self.star(a).iter().any(|&t| self.tets[t].contains(&b))
    }

    /// The tets in use, ascending.
    pub(super) fn in_use(&self) -> impl Iterator<Item = TetId> + '_ {
        self.tets.ids().filter(|&t| self.tets[t][0].is_some())
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
                if other.is_some() {
                    assert!(d.around[other].contains(&t));
                    assert!((0..4).all(|k| k == i || d.tets[other].contains(&tet[k])));
                }
            }
            let [a, b, c, e] = tet.map(|v| coord(d.at(v)));
            assert!(d.points.iter().all(|&p| insphere(b, c, e, a, coord(p)) <= 0.0));
        }
    }

    #[test]
    fn grids_with_every_tie_there_is() {
        let points: Vec<Vector> =
            (0..64).map(|i| [f64::from(i % 4), f64::from(i / 4 % 4), f64::from(i / 16)]).collect();
        let mut d = Delaunay::new(&points);
        for v in 0..64 {
            // An order that jumps about.
            d.insert(VertexId(v * 29 % 64)).unwrap();
        }
        check(&d);
        assert_eq!(d.add([1.0, 1.0, 2.0], VertexId(0)), Err(VertexId(1 + 4 + 32)));
        assert_eq!(d.add([0.5, 1.0, 2.0], VertexId(0)), Ok(VertexId(68)));
        assert!(d.has_edge(VertexId(68), VertexId(4 + 32)) && !d.has_edge(VertexId(0), VertexId(63)));
        check(&d);
        // What lies in the grid's box has volume 27.
        let inside = d.in_use().map(|t| d.tets[t]).filter(|t| t.iter().all(|&v| !(64..68).contains(&v.0)));
        let total: f64 = inside.map(|t| orient(t.map(|v| d.at(v))) / 6.0).sum();
        assert!((total - 27.0).abs() < 1e-9, "{total}");
    }
}
