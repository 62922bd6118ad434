//! Levels 2 and 3 at one vertex: pair kinds, face pairing, orientation, edge and vertex links.
//!
//! # Why pairs suffice
//! A pair of vertices has a *kind* in a hex that contains both: edge, face diagonal of one quad, or body diagonal.
//!
//! **Lemma.** Two hexes g, h (eight distinct vertices each) intersect properly (they share nothing, one vertex, one edge
//! of both, or one quad of both, in the same cyclic order) iff every pair of vertices contained in both has the same kind
//! in both, that kind is not body diagonal, and where it is face diagonal it is so of the same quad (same vertex set).
//!
//! *Proof.* Let S be the set of shared vertices. (=>) If S is an edge of both the only pair is that edge. If S is a quad
//! of both in one cyclic order, its four sides are edges of both and its two diagonals are face diagonals of that quad in
//! both. (<=) Assume the condition and |S| >= 2. (a) If no pair of S is a face diagonal, all pairs of S are edges of h; the
//! graph of the cube has no triangle, so |S| = 2 and S is an edge of both. (b) If {a, c} in S is a face diagonal, it is so
//! of one quad Q = {a, b, c, d} of both, so Q is contained in S. A further vertex of S would lie off Q in h, where every
//! vertex off Q is the body-diagonal partner of one of Q: excluded. So S = Q, and as ac is a diagonal in both, bd is the
//! other one in both: the cyclic orders agree. QED
//!
//! So a mesh obeys R2 iff every *pair* of vertices has one kind over all hexes that contain it, with body diagonals in one
//! hex only and face diagonals belonging to one quad only. That is a statement about each vertex's star: 7 pairs a hex,
//! sorted by the other vertex. The same sorted list pairs the quads round the vertex, because a quad at `v` is known by its
//! corner opposite to `v`: the list has the incidence of the vertex link too. Work is linear in the mesh but for the sorting
//! within each star.
//!
//! Source: ours.

use super::parity::ParityForest;
use crate::report::{Findings, Offender};
use crate::rule::Rule;
use crate::topology::boundary_quad::BoundaryQuad;
use hexfill_mesh::cube;

/// For each corner: its three neighbours (right-handed), then the corners opposite in the quad spanned by neighbours
/// 1 2, 2 0 and 0 1, then the body-diagonal partner.
pub(crate) fn corner_table() -> [[usize; 7]; 8] {
    std::array::from_fn(|c| {
        let n = cube::CORNER_NEIGHBOURS[c];
        let opposite = |a: usize, b: usize| {
            let at = |k: usize| cube::POSITIONS[a][k] ^ cube::POSITIONS[b][k] ^ cube::POSITIONS[c][k];
            cube::corner_at(at(0), at(1), at(2))
        };
        let far = cube::POSITIONS[c].map(|x| 1 - x);
        [
            n[0],
            n[1],
            n[2],
            opposite(n[1], n[2]),
            opposite(n[2], n[0]),
            opposite(n[0], n[1]),
            cube::corner_at(far[0], far[1], far[2]),
        ]
    })
}

/// What the stars of a range of vertices add up to.
#[derive(Default)]
pub(crate) struct StarSums {
    pub(crate) findings: Findings,
    /// Vertices that some hex uses.
    pub(crate) used: u64,
    /// Used vertices in some boundary quad.
    pub(crate) on_boundary: u64,
    /// Edges, counted at their smaller vertex.
    pub(crate) edges: u64,
    /// Quads, counted at their smallest vertex.
    pub(crate) quads: u64,
    /// Boundary quads, at their smallest vertex.
    pub(crate) boundary: Vec<BoundaryQuad>,
    /// Hexes at which orienting their part failed.
    pub(crate) not_orientable: Vec<u32>,
}

/// Which judgements to make besides pairing the quads.
#[derive(Clone, Copy)]
pub(crate) struct StarRules {
    /// Proper intersection by pair kinds.
    pub(crate) proper: bool,
    /// Vertex and edge links.
    pub(crate) links: bool,
}

/// Scratch space of one thread.
pub(crate) struct StarJudge<'a> {
    hexes: &'a [[u32; 8]],
    forest: &'a ParityForest,
    rules: StarRules,
    table: [[usize; 7]; 8],
    /// Per hex of the star: the seven other corners in the order of `table`.
    around: Vec<[u32; 7]>,
    /// `other vertex << 32 | place in star << 3 | slot in table`.
    entries: Vec<u64>,
    /// Union-find over link triangles (hexes of the star).
    triangles: Vec<u32>,
    /// Union-find over corners of link triangles, `3 * triangle + k`.
    corners: Vec<u32>,
    /// Face entries of one group where they do not pair up simply.
    faces: Vec<(u64, u64)>,
    pub(crate) sums: StarSums,
}

fn root(parents: &mut [u32], mut i: u32) -> u32 {
    while parents[i as usize] != i {
        let up = parents[parents[i as usize] as usize];
        parents[i as usize] = up;
        i = up;
    }
    i
}

/// Joins two classes; 1 if they were different.
fn join(parents: &mut [u32], a: u32, b: u32) -> u32 {
    let (a, b) = (root(parents, a), root(parents, b));
    parents[a.max(b) as usize] = a.min(b);
    u32::from(a != b)
}

/// State of one star while its groups are gone through.
struct Link {
    vertices: u32,
    edges: u32,
    boundary_edges: u32,
    triangle_pieces: u32,
    corner_classes: u32,
    broken: bool,
}

/// How often a pair has each kind, and entries of that kind: the last edge, the first two faces, the last body diagonal.
#[derive(Default)]
struct Kinds {
    edges: u32,
    faces: u32,
    bodies: u32,
    edge: u64,
    /// Two are enough to see a quad of the boundary or between two hexes; more take the general way.
    face: [u64; 2],
    body: u64,
}

impl Kinds {
    #[inline]
    fn of(entries: &[u64]) -> Self {
        let mut kinds = Self::default();
        for &entry in entries {
            match entry & 7 {
                0..=2 => {
                    kinds.edges += 1;
                    kinds.edge = entry;
                }
                6 => {
                    kinds.bodies += 1;
                    kinds.body = entry;
                }
                _ => {
                    if kinds.faces < 2 {
                        kinds.face[kinds.faces as usize] = entry;
                    }
                    kinds.faces += 1;
                }
            }
        }
        kinds
    }
}

impl<'a> StarJudge<'a> {
    pub(crate) fn new(hexes: &'a [[u32; 8]], forest: &'a ParityForest, rules: StarRules) -> Self {
        Self {
            hexes,
            forest,
            rules,
            table: corner_table(),
            around: Vec::new(),
            entries: Vec::new(),
            triangles: Vec::new(),
            corners: Vec::new(),
            faces: Vec::new(),
            sums: StarSums::default(),
        }
    }

    /// Judges the star of `v`; `codes` are `8 * hex + corner`, ascending.
    pub(crate) fn judge(&mut self, v: u32, codes: &[u32]) {
        if codes.is_empty() {
            return;
        }
        self.gather(codes);
        let d = codes.len() as u32;
        let mut link =
            Link { vertices: 0, edges: 0, boundary_edges: 0, triangle_pieces: d, corner_classes: 3 * d, broken: false };
        let mut conflict = false;
        let mut start = 0;
        while start < self.entries.len() {
            let w = (self.entries[start] >> 32) as u32;
            let mut end = start + 1;
            while end < self.entries.len() && (self.entries[end] >> 32) as u32 == w {
                end += 1;
            }
            conflict |= self.judge_group(v, w, start..end, codes, &mut link);
            start = end;
        }
        self.sums.used += 1;
        self.sums.on_boundary += u64::from(link.boundary_edges > 0);
        if conflict && self.rules.proper {
            self.name_conflicts(v, codes);
        }
        if self.rules.links && !link.broken {
            self.judge_link(v, codes, &link);
        }
    }

    fn gather(&mut self, codes: &[u32]) {
        self.around.clear();
        self.entries.clear();
        for (i, &code) in codes.iter().enumerate() {
            let hex = &self.hexes[(code >> 3) as usize];
            let near = self.table[(code & 7) as usize].map(|k| hex[k]);
            self.around.push(near);
            let place = (i as u64) << 3;
            self.entries.extend(near.iter().zip(0u64..).map(|(&w, slot)| u64::from(w) << 32 | place | slot));
        }
        // One sort answers everything: entries of one pair are neighbours now, with their kinds, and quads round v
        // are known by their opposite corner.
        self.entries.sort_unstable();
        self.triangles.clear();
        self.triangles.extend(0..codes.len() as u32);
        self.corners.clear();
        self.corners.extend(0..3 * codes.len() as u32);
    }

    /// All entries `{v, w}`; whether their kinds conflict.
    fn judge_group(&mut self, v: u32, w: u32, group: std::ops::Range<usize>, codes: &[u32], link: &mut Link) -> bool {
        let kinds = Kinds::of(&self.entries[group.clone()]);
        if kinds.edges > 0 {
            link.vertices += 1;
            self.sums.edges += u64::from(v < w);
        }
        let quads = match kinds.faces {
            0 => 0,
            1 => {
                self.boundary_quad(v, w, kinds.face[0], codes, link);
                1
            }
            // By far the most common pairs; only what does not fit is collected and sorted.
            2 if self.others(kinds.face[0]) == self.others(kinds.face[1]) => {
                self.interior_quad(v, w, kinds.face[0], kinds.face[1], codes, link);
                1
            }
            _ => self.pair_quads(v, w, group.clone(), codes, link),
        };
        // The lemma: one kind, of one quad if it is a face diagonal, in one hex if it is a body diagonal.
        let different = u32::from(kinds.edges > 0) + u32::from(kinds.faces > 0) + u32::from(kinds.bodies > 0);
        let clean = different == 1 && quads <= 1 && kinds.bodies <= 1;
        if !clean && v < w && self.rules.proper {
            self.name_kinds(v, w, &kinds, quads, group, codes);
        }
        !clean
    }

    /// Pairs up the quads with diagonal `{v, w}` where they are more than one boundary quad or one interior quad; how many
    /// there are.
    #[cold]
    fn pair_quads(&mut self, v: u32, w: u32, group: std::ops::Range<usize>, codes: &[u32], link: &mut Link) -> u32 {
        let mut faces = std::mem::take(&mut self.faces);
        faces.clear();
        let entries = self.entries[group].iter().copied();
        faces.extend(entries.filter(|&e| is_face(e)).map(|e| (self.others(e), e)));
        faces.sort_unstable();
        let mut quads = 0;
        for same in faces.chunk_by(|a, b| a.0 == b.0) {
            quads += 1;
            match *same {
                [(_, one)] => self.boundary_quad(v, w, one, codes, link),
                [(_, one), (_, two)] => self.interior_quad(v, w, one, two, codes, link),
                _ => {
                    link.broken = true;
                    self.crowded_quad(v, w, same, codes);
                }
            }
        }
        self.faces = faces;
        quads
    }

    /// Names a quad in three or more hexes at its smallest vertex; `same` are its entries, with the two other vertices.
    fn crowded_quad(&mut self, v: u32, w: u32, same: &[(u64, u64)], codes: &[u32]) {
        let (x, y) = ((same[0].0 >> 32) as u32, same[0].0 as u32);
        if v >= w || v >= x {
            return;
        }
        self.sums.quads += 1;
        let hexes: Vec<u32> = same.iter().take(10).map(|e| hex_of(e.1, codes)).collect();
        self.sums
            .findings
            .add(Rule::QuadInThreeHexes, || Offender::at(&hexes, &[v, x, w, y]).note(format!("{} hexes", same.len())));
        // One part all the same; its orientation is then not judged.
        for &(_, e) in &same[1..] {
            self.forest.union(hex_of(same[0].1, codes), hex_of(e, codes), false);
        }
    }

    /// Names what is wrong with the kinds of the pair `{v, w}`, each time with two hexes that disagree.
    #[cold]
    fn name_kinds(&mut self, v: u32, w: u32, kinds: &Kinds, quads: u32, group: std::ops::Range<usize>, codes: &[u32]) {
        let &Kinds { edge, face: [face, _], body, .. } = kinds;
        let entries = &self.entries[group];
        let other_face = || {
            let first = self.others(face);
            entries.iter().copied().find(|&e| is_face(e) && self.others(e) != first).unwrap_or(face)
        };
        let first_body = || entries.iter().copied().find(|&e| e & 7 == 6).unwrap_or(body);
        let (edges, faces, bodies) = (kinds.edges > 0, kinds.faces > 0, kinds.bodies > 0);
        let pairs = [
            (edges && faces).then_some((Rule::EdgeIsFaceDiagonal, edge, face)),
            (edges && bodies).then_some((Rule::EdgeIsBodyDiagonal, edge, body)),
            (quads > 1).then(|| (Rule::FaceDiagonalOfTwoQuads, face, other_face())),
            (faces && bodies).then_some((Rule::FaceDiagonalIsBodyDiagonal, face, body)),
            (kinds.bodies > 1).then(|| (Rule::BodyDiagonalShared, first_body(), body)),
        ];
        for (rule, one, two) in pairs.into_iter().flatten() {
            let hexes = [hex_of(one, codes), hex_of(two, codes)];
            self.sums.findings.add(rule, || Offender::at(&hexes, &[v, w]));
        }
    }

    /// The two other vertices of a face entry's quad, as `smaller << 32 | larger`.
    fn others(&self, entry: u64) -> u64 {
        let [x, y] = self.sides(entry);
        u64::from(x.min(y)) << 32 | u64::from(x.max(y))
    }

    /// The two neighbours of `v` in a face entry's quad, in right-handed order.
    fn sides(&self, entry: u64) -> [u32; 2] {
        let near = &self.around[place(entry)];
        let k = (entry & 7) as usize - 3;
        [near[(k + 1) % 3], near[(k + 2) % 3]]
    }

    fn boundary_quad(&mut self, v: u32, w: u32, entry: u64, codes: &[u32], link: &mut Link) {
        link.edges += 1;
        link.boundary_edges += 1;
        let [x, y] = self.sides(entry);
        // Seen from all four corners, counted and named from the smallest: no set of quads is ever needed.
        if v < w && v < x && v < y {
            self.sums.quads += 1;
            // The right-handed order x, y turns inward; outward is the other way round.
            self.sums.boundary.push(BoundaryQuad { cycle: [v, y, w, x], hex: hex_of(entry, codes) });
        }
    }

    fn interior_quad(&mut self, v: u32, w: u32, one: u64, two: u64, codes: &[u32], link: &mut Link) {
        link.edges += 1;
        let ([x, y], [x2, _]) = (self.sides(one), self.sides(two));
        // Hexes in the same sense pass their common quad in opposite directions.
        let clash = x == x2;
        let (i, j) = (place(one) as u32, place(two) as u32);
        let (k, l) = ((one & 7) as u32 - 3, (two & 7) as u32 - 3);
        link.triangle_pieces -= join(&mut self.triangles, i, j);
        // The quad is an edge of the link between two triangles: its ends are the corners of both at the same
        // neighbours of v. What is left apart at one neighbour in the end is a fan of its own.
        let (c1, c2) = (3 * i + (k + 1) % 3, 3 * i + (k + 2) % 3);
        let (mut d1, mut d2) = (3 * j + (l + 2) % 3, 3 * j + (l + 1) % 3);
        if clash {
            std::mem::swap(&mut d1, &mut d2);
        }
        link.corner_classes -= join(&mut self.corners, c1, d1) + join(&mut self.corners, c2, d2);
        if v < w && v < x && v < y {
            self.sums.quads += 1;
            let (g, h) = (hex_of(one, codes), hex_of(two, codes));
            if clash {
                self.sums.findings.add(Rule::OrientationClash, || Offender::at(&[g.min(h), g.max(h)], &[v, x, w, y]));
            }
            if !self.forest.union(g, h, clash) {
                self.sums.not_orientable.push(g);
            }
        }
    }

    /// Names what stands behind conflicting pairs at `v`: twisted quads and duplicated hexes, each at its smallest vertex.
    fn name_conflicts(&mut self, v: u32, codes: &[u32]) {
        let mut quads: Vec<([u32; 3], u32, u32)> = Vec::new();
        for (i, near) in self.around.iter().enumerate() {
            for k in 0..3 {
                let opposite = near[3 + k];
                let mut key = [near[(k + 1) % 3], near[(k + 2) % 3], opposite];
                key.sort_unstable();
                // Each at its smallest vertex, so that it is told once.
                if v < key[0] {
                    quads.push((key, opposite, codes[i] >> 3));
                }
            }
        }
        quads.sort_unstable();
        for same in quads.chunk_by(|a, b| a.0 == b.0) {
            if let Some(other) = same.iter().find(|q| q.1 != same[0].1) {
                let [a, b, c] = same[0].0;
                self.sums.findings.add(Rule::QuadTwisted, || Offender::at(&[same[0].2, other.2], &[v, a, b, c]));
            }
        }
        let mut hexes: Vec<([u32; 7], u32)> = self.around.iter().zip(codes).map(|(n, c)| (*n, c >> 3)).collect();
        hexes.iter_mut().for_each(|h| h.0.sort_unstable());
        hexes.sort_unstable();
        for same in hexes.chunk_by(|a, b| a.0 == b.0) {
            if same.len() > 1 && v < same[0].0[0] {
                let ids: Vec<u32> = same.iter().take(10).map(|h| h.1).collect();
                self.sums.findings.add(Rule::HexDuplicated, || Offender::at(&ids, &[]));
            }
        }
    }

    /// Whether the link of `v` is a disk or a sphere. A connected surface with Euler characteristic 2 is a sphere; one with
    /// boundary and Euler characteristic 1 is a disk (classification of surfaces).
    fn judge_link(&mut self, v: u32, codes: &[u32], link: &Link) {
        let d = codes.len() as u32;
        let mut pieces = link.triangle_pieces;
        if link.corner_classes > link.vertices {
            // Some edge has several fans. Name the edges, and see whether the link is connected through them.
            let edges: Vec<u64> = self.entries.iter().copied().filter(|e| e & 7 < 3).collect();
            for fan in edges.chunk_by(|a, b| a >> 32 == b >> 32) {
                let w = (fan[0] >> 32) as u32;
                let first = root(&mut self.corners, corner(fan[0]));
                let mut other = None;
                for &entry in fan {
                    pieces -= join(&mut self.triangles, place(fan[0]) as u32, place(entry) as u32);
                    if other.is_none() && root(&mut self.corners, corner(entry)) != first {
                        other = Some(entry);
                    }
                }
                if let Some(other) = other
                    && v < w
                {
                    let hexes = [hex_of(fan[0], codes), hex_of(other, codes)];
                    self.sums.findings.add(Rule::EdgePinched, || Offender::at(&hexes, &[v, w]));
                }
            }
        }
        if pieces > 1 {
            let first = root(&mut self.triangles, 0);
            let other = (1..d).find(|&i| root(&mut self.triangles, i) != first).unwrap_or(0);
            let hexes = [codes[0] >> 3, codes[other as usize] >> 3];
            let note = format!("{pieces} pieces");
            self.sums.findings.add(Rule::VertexPinched, || Offender::at(&hexes, &[v]).note(note));
        } else if link.corner_classes == link.vertices {
            // Connected, and every edge in one fan: a surface with or without boundary, which its Euler
            // characteristic names.
            let euler = i64::from(link.vertices) - i64::from(link.edges) + i64::from(d);
            let (rule, wanted) =
                if link.boundary_edges == 0 { (Rule::VertexLinkNotSphere, 2) } else { (Rule::VertexLinkNotDisk, 1) };
            if euler != wanted {
                let note = format!("link with Euler characteristic {euler}");
                self.sums.findings.add(rule, || Offender::at(&[codes[0] >> 3], &[v]).note(note));
            }
        }
    }
}

/// Place in the star of an entry's hex.
fn place(entry: u64) -> usize {
    ((entry & 0xffff_ffff) >> 3) as usize
}

/// Whether an entry is the diagonal of a face.
fn is_face(entry: u64) -> bool {
    matches!(entry & 7, 3..=5)
}

fn corner(entry: u64) -> u32 {
    3 * place(entry) as u32 + (entry & 7) as u32
}

fn hex_of(entry: u64, codes: &[u32]) -> u32 {
    codes[place(entry)] >> 3
}
