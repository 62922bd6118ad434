//! The buffer cube of one quad: which sides it has, its points by role, and its boundary quads.
//!
//! A cell sits between a quad `o0 o1 o2 o3` of the surface (outward) and its inner copy `i0 i1 i2 i3`, which one
//! diagonal splits into two triangles. Corners 0 and 2 are the ends of the diagonal and always black; corners 1
//! and 3 (the *odd* corners) are white or black.
//!
//! * A column has one segment over a black vertex and two (`o m i`) over a white one.
//! * An inner edge from black to white is *uncut* and has one midpoint `e`; an inner edge between two black
//!   vertices is *cut* by the dual surface Sigma and has two points, `ed` near the diagonal corner and `eo` near the
//!   odd corner.
//! * The triangle at a white corner is uncut and is covered by 3 quads round `f`; the one at a black corner is cut
//!   and is covered by 5 quads round `fl` (on the side of the odd corner) and `fp`. The diagonal `d` is never cut.
//! * So every side facet has a hexagon for outline, which takes an even or an odd number of quads:
//!   black-white 3 (`light`, one point x) or 4 (`heavy`, points y and z), black-black 2 (`light`, no point) or
//!   3 (`heavy`, a star s at one end).
//!
//! Invariant: a cell has an even number of quads iff an odd number of its sides is heavy.
//!
//! Source: Erickson 2014, section 5, with the cheaper bipartite facets of Verhetsel et al. 2019: the same construction with another colouring.

use std::fmt;
use std::str::FromStr;

/// How one side facet of a buffer cube is covered.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Side {
    /// Black-white in 3 quads, or black-black in 2.
    Light,
    /// Black-white in 4 quads.
    Heavy,
    /// Black-black in 3 quads, the star joined to the outer vertex at the diagonal corner.
    StarDiagonal,
    /// Black-black in 3 quads, the star joined to the outer vertex at the odd corner.
    StarOdd,
}

impl Side {
    /// Whether the side has the larger number of quads of its two coverings.
    pub const fn is_heavy(self) -> bool {
        !matches!(self, Self::Light)
    }
}

/// The kind of a buffer cube: colours of corners 1 and 3, and its four sides (side `k` joins corners `k`, `k + 1`).
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Pattern {
    /// Whether corner 1 and corner 3 are white.
    pub white: [bool; 2],
    /// The sides.
    pub sides: [Side; 4],
}

/// A point of a buffer cube by what it is. Corners, sides 0..4; triangles 0 (at corner 1) and 1 (at corner 3).
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Role {
    /// Corner of the quad of the surface.
    Outer(u8),
    /// Its inner copy.
    Inner(u8),
    /// Middle of a white column.
    Middle(u8),
    /// Midpoint of an uncut inner edge.
    Edge(u8),
    /// Point of a cut inner edge on the side of the diagonal corner.
    EdgeDiagonal(u8),
    /// Point of a cut inner edge on the side of the odd corner.
    EdgeOdd(u8),
    /// Inner point of a light black-white side.
    X(u8),
    /// Inner point of a heavy black-white side, joined to the inner midpoint and the middle of the white column.
    Y(u8),
    /// Inner point of a heavy black-white side, joined to the inner black and the outer white corner.
    Z(u8),
    /// Inner point of a heavy black-black side.
    Star(u8),
    /// Midpoint of the diagonal.
    Diagonal,
    /// Point of an uncut triangle.
    Face(u8),
    /// Point of a cut triangle on the side of the odd corner.
    FaceLone(u8),
    /// Point of a cut triangle on the side of the diagonal.
    FacePair(u8),
    /// A point inside the cell.
    Interior(u16),
}

impl fmt::Display for Role {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Outer(k) => write!(f, "o{k}"),
            Self::Inner(k) => write!(f, "i{k}"),
            Self::Middle(k) => write!(f, "m{k}"),
            Self::Edge(k) => write!(f, "e{k}"),
            Self::EdgeDiagonal(k) => write!(f, "e{k}d"),
            Self::EdgeOdd(k) => write!(f, "e{k}o"),
            Self::X(k) => write!(f, "x{k}"),
            Self::Y(k) => write!(f, "y{k}"),
            Self::Z(k) => write!(f, "z{k}"),
            Self::Star(k) => write!(f, "s{k}"),
            Self::Diagonal => write!(f, "d"),
            Self::Face(k) => write!(f, "f{k}"),
            Self::FaceLone(k) => write!(f, "f{k}l"),
            Self::FacePair(k) => write!(f, "f{k}p"),
            Self::Interior(k) => write!(f, "p{k}"),
        }
    }
}

impl FromStr for Role {
    type Err = String;

    fn from_str(s: &str) -> Result<Self, String> {
        let bad = || format!("`{s}` is not the name of a point of a cell");
        let Some(letter) = s.chars().next() else { return Err(bad()) };
        let rest = &s[letter.len_utf8()..];
        let digits = rest.trim_end_matches(|c: char| c.is_ascii_alphabetic());
        let suffix = &rest[digits.len()..];
        if letter == 'd' && rest.is_empty() {
            return Ok(Self::Diagonal);
        }
        if letter == 'p' && suffix.is_empty() {
            return digits.parse().map(Self::Interior).map_err(|_| bad());
        }
        let k: u8 = digits.parse().map_err(|_| bad())?;
        Ok(match (letter, suffix) {
            ('o', "") => Self::Outer(k),
            ('i', "") => Self::Inner(k),
            ('m', "") => Self::Middle(k),
            ('e', "") => Self::Edge(k),
            ('e', "d") => Self::EdgeDiagonal(k),
            ('e', "o") => Self::EdgeOdd(k),
            ('x', "") => Self::X(k),
            ('y', "") => Self::Y(k),
            ('z', "") => Self::Z(k),
            ('s', "") => Self::Star(k),
            ('f', "") => Self::Face(k),
            ('f', "l") => Self::FaceLone(k),
            ('f', "p") => Self::FacePair(k),
            _ => return Err(bad()),
        })
    }
}

/// A symmetry of the quad that keeps its diagonal: corner `k` goes to `corner[k]`, side `k` to `side[k]`.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Symmetry {
    /// Images of the corners.
    pub corner: [u8; 4],
    /// Images of the sides.
    pub side: [u8; 4],
    /// Whether it reverses orientation.
    pub mirror: bool,
}

/// The identity, the half turn, and the reflections in the two diagonals.
pub const SYMMETRIES: [Symmetry; 4] = [
    Symmetry { corner: [0, 1, 2, 3], side: [0, 1, 2, 3], mirror: false },
    Symmetry { corner: [2, 3, 0, 1], side: [2, 3, 0, 1], mirror: false },
    Symmetry { corner: [2, 1, 0, 3], side: [1, 0, 3, 2], mirror: true },
    Symmetry { corner: [0, 3, 2, 1], side: [3, 2, 1, 0], mirror: true },
];

impl Symmetry {
    /// Where a role goes.
    pub fn role(&self, r: Role) -> Role {
        let c = |k: u8| self.corner[k as usize];
        let s = |k: u8| self.side[k as usize];
        // Triangle t is the one at corner 2 t + 1.
        let t = |k: u8| (self.corner[2 * k as usize + 1] - 1) / 2;
        match r {
            Role::Outer(k) => Role::Outer(c(k)),
            Role::Inner(k) => Role::Inner(c(k)),
            Role::Middle(k) => Role::Middle(c(k)),
            Role::Edge(k) => Role::Edge(s(k)),
            Role::EdgeDiagonal(k) => Role::EdgeDiagonal(s(k)),
            Role::EdgeOdd(k) => Role::EdgeOdd(s(k)),
            Role::X(k) => Role::X(s(k)),
            Role::Y(k) => Role::Y(s(k)),
            Role::Z(k) => Role::Z(s(k)),
            Role::Star(k) => Role::Star(s(k)),
            Role::Diagonal => Role::Diagonal,
            Role::Face(k) => Role::Face(t(k)),
            Role::FaceLone(k) => Role::FaceLone(t(k)),
            Role::FacePair(k) => Role::FacePair(t(k)),
            Role::Interior(k) => Role::Interior(k),
        }
    }

    /// Where a position of the template goes (corner 0 at (-1, -1), 1 at (-1, 1), 2 at (1, 1), 3 at (1, -1)).
    pub fn position(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        match self.corner {
            [2, 3, 0, 1] => [-x, -y, z],
            [2, 1, 0, 3] => [-y, -x, z],
            [0, 3, 2, 1] => [y, x, z],
            _ => [x, y, z],
        }
    }

    /// The image of a pattern.
    pub fn pattern(&self, p: &Pattern) -> Pattern {
        let mut out = *p;
        for k in 0..4 {
            out.sides[self.side[k] as usize] = p.sides[k];
        }
        for t in 0..2 {
            out.white[usize::from(self.corner[2 * t + 1] - 1) / 2] = p.white[t];
        }
        out
    }
}

impl Pattern {
    /// The odd corner (1 or 3) of side `k`.
    pub const fn odd_corner(k: u8) -> u8 {
        if k < 2 { 1 } else { 3 }
    }

    /// The diagonal corner (0 or 2) of side `k`.
    pub const fn diagonal_corner(k: u8) -> u8 {
        if k == 0 || k == 3 { 0 } else { 2 }
    }

    /// Whether side `k` joins a black and a white vertex.
    pub const fn is_black_white(&self, k: u8) -> bool {
        self.white[(k / 2) as usize]
    }

    /// Whether the sides suit the colours and an odd number is heavy, so that the boundary is even.
    pub fn is_valid(&self) -> bool {
        let suits = |k: u8| match self.sides[k as usize] {
            Side::Light => true,
            Side::Heavy => self.is_black_white(k),
            Side::StarDiagonal | Side::StarOdd => !self.is_black_white(k),
        };
        (0..4).all(suits) && self.n_heavy() % 2 == 1
    }

    /// Number of heavy sides.
    pub fn n_heavy(&self) -> usize {
        self.sides.iter().filter(|s| s.is_heavy()).count()
    }

    /// Every valid pattern, one of each class under [`SYMMETRIES`], ascending.
    pub fn all_classes() -> Vec<Self> {
        const KINDS: [Side; 4] = [Side::Light, Side::Heavy, Side::StarDiagonal, Side::StarOdd];
        let mut classes: Vec<Self> = Vec::new();
        for colours in 0..4 {
            for code in 0..256usize {
                let sides = std::array::from_fn(|k| KINDS[code >> (2 * k) & 3]);
                let p = Self { white: [colours & 1 == 1, colours & 2 == 2], sides };
                if p.is_valid() && SYMMETRIES.iter().all(|s| s.pattern(&p) >= p) {
                    classes.push(p);
                }
            }
        }
        classes.sort_unstable();
        classes
    }

    /// The quads of side facet `k`, outward from the cell.
    pub fn side_quads(&self, k: u8) -> Vec<[Role; 4]> {
        let d = Self::diagonal_corner(k);
        let o = Self::odd_corner(k);
        let (od, oo) = (Role::Outer(d), Role::Outer(o));
        let (id, io) = (Role::Inner(d), Role::Inner(o));
        let mut quads = if self.is_black_white(k) {
            let (m, e) = (Role::Middle(o), Role::Edge(k));
            if self.sides[k as usize].is_heavy() {
                let (y, z) = (Role::Y(k), Role::Z(k));
                vec![[m, io, e, y], [e, id, z, y], [id, od, oo, z], [oo, m, y, z]]
            } else {
                let x = Role::X(k);
                vec![[od, oo, m, x], [m, io, e, x], [e, id, od, x]]
            }
        } else {
            let (ed, eo, s) = (Role::EdgeDiagonal(k), Role::EdgeOdd(k), Role::Star(k));
            match self.sides[k as usize] {
                Side::StarDiagonal => vec![[od, oo, io, s], [io, eo, ed, s], [ed, id, od, s]],
                Side::StarOdd => vec![[od, oo, s, id], [oo, io, eo, s], [eo, ed, id, s]],
                Side::Light | Side::Heavy => vec![[od, oo, io, id], [io, eo, ed, id]],
            }
        };
        // Written for the walk from the diagonal to the odd corner at the top; outward for sides 1 and 3.
        if k.is_multiple_of(2) {
            for q in &mut quads {
                q.reverse();
            }
        }
        quads
    }

    /// The quads on the inner triangle `t`, outward from the cell (into the core).
    pub fn triangle_quads(&self, t: u8) -> Vec<[Role; 4]> {
        // Sides before and after the odd corner.
        let (p, n) = (2 * t, 2 * t + 1);
        let o = Role::Inner(2 * t + 1);
        let (a, b) = (Role::Inner(Self::diagonal_corner(p)), Role::Inner(Self::diagonal_corner(n)));
        let d = Role::Diagonal;
        let mut quads = if self.white[t as usize] {
            let f = Role::Face(t);
            vec![[a, Role::Edge(p), f, d], [o, Role::Edge(n), f, Role::Edge(p)], [b, d, f, Role::Edge(n)]]
        } else {
            let (l, f) = (Role::FaceLone(t), Role::FacePair(t));
            let (pd, po, nd, no) = (Role::EdgeDiagonal(p), Role::EdgeOdd(p), Role::EdgeDiagonal(n), Role::EdgeOdd(n));
            vec![[a, pd, f, d], [b, d, f, nd], [o, no, l, po], [pd, po, l, f], [no, nd, f, l]]
        };
        for q in &mut quads {
            q.reverse();
        }
        quads
    }

    /// All boundary quads, outward from the cell: the outer quad, the sides, the inner facet.
    pub fn boundary(&self) -> Vec<[Role; 4]> {
        let mut quads = vec![[Role::Outer(0), Role::Outer(1), Role::Outer(2), Role::Outer(3)]];
        for k in 0..4 {
            quads.extend(self.side_quads(k));
        }
        for t in 0..2 {
            quads.extend(self.triangle_quads(t));
        }
        quads
    }

    /// The points of side facet `k`, columns included, sorted.
    pub fn side_points(&self, k: u8) -> Vec<Role> {
        let mut points: Vec<Role> = self.side_quads(k).into_iter().flatten().collect();
        points.sort_unstable();
        points.dedup();
        points
    }
}

impl fmt::Display for Pattern {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for white in self.white {
            f.write_str(if white { "w" } else { "b" })?;
        }
        f.write_str("-")?;
        for side in self.sides {
            f.write_str(match side {
                Side::Light => "l",
                Side::Heavy => "h",
                Side::StarDiagonal => "d",
                Side::StarOdd => "o",
            })?;
        }
        Ok(())
    }
}

impl FromStr for Pattern {
    type Err = String;

    fn from_str(s: &str) -> Result<Self, String> {
        let bad = || format!("`{s}` is not a cell pattern such as `ww-hhhl`");
        let &[w1, w3, b'-', s0, s1, s2, s3] = s.as_bytes() else { return Err(bad()) };
        let colour = |c: u8| match c {
            b'w' => Ok(true),
            b'b' => Ok(false),
            _ => Err(bad()),
        };
        let side = |c: u8| match c {
            b'l' => Ok(Side::Light),
            b'h' => Ok(Side::Heavy),
            b'd' => Ok(Side::StarDiagonal),
            b'o' => Ok(Side::StarOdd),
            _ => Err(bad()),
        };
        let p = Self { white: [colour(w1)?, colour(w3)?], sides: [side(s0)?, side(s1)?, side(s2)?, side(s3)?] };
        if p.is_valid() { Ok(p) } else { Err(bad()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hexfill_mesh::QuadSurface;

    #[test]
    fn every_pattern_is_a_closed_even_sphere_without_improper_quads() {
        let classes = Pattern::all_classes();
        for p in &classes {
            assert_eq!(p.to_string().parse::<Pattern>().as_ref(), Ok(p));
            let quads = p.boundary();
            let mut roles: Vec<Role> = quads.iter().flatten().copied().collect();
            roles.sort_unstable();
            roles.dedup();
            let index = |r: Role| roles.binary_search(&r).unwrap() as u32;
            let ids: Vec<[u32; 4]> = quads.iter().map(|q| q.map(index)).collect();
            let surface = QuadSurface::try_new(roles.len(), &ids).unwrap();
            assert!(surface.reversed().is_empty(), "{p}: all quads are written outward");
            assert!(surface.is_sphere() && quads.len().is_multiple_of(2), "{p}");
            let mut diagonals: Vec<[u32; 2]> =
                ids.iter().flat_map(|q| [[q[0], q[2]], [q[1], q[3]]]).map(|[a, b]| [a.min(b), a.max(b)]).collect();
            diagonals.sort_unstable();
            diagonals.dedup();
            assert_eq!(diagonals.len(), 2 * quads.len(), "{p}: no two quads share a diagonal");
            for r in roles {
                assert_eq!(r.to_string().parse(), Ok(r));
            }
            for s in SYMMETRIES {
                let image = s.pattern(p);
                let mut mapped: Vec<[Role; 4]> = quads.iter().map(|q| q.map(|r| s.role(r))).collect();
                let mut expected = image.boundary();
                for q in mapped.iter_mut().chain(&mut expected) {
                    q.sort_unstable();
                }
                mapped.sort_unstable();
                expected.sort_unstable();
                assert_eq!(mapped, expected, "{p} under a symmetry");
            }
        }
        let count = |white: [bool; 2]| classes.iter().filter(|p| p.white == white).count();
        assert_eq!(count([true, true]), 2);
        assert_eq!(count([false, false]), 10);
        assert_eq!(count([false, true]) + count([true, false]), 9);
    }
}
