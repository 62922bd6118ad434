//! What is counted of a complex besides its class: vertices, Euler characteristic, chords, boundary components, ball or not.
//!
//! Source: ours.

use crate::boundary::{Boundary, Components};
use crate::complex::{Complex, FREE, MAX_CUBES, MAX_VERTICES};
use crate::error::EnumerateError;
use crate::frames::side_set;
use hexfill_mesh::cube::EDGES;

/// Measures of one complex.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Shape {
    /// Vertices.
    pub vertices: u8,
    /// Vertices - edges + quads - cubes. Edges are pairs of vertices.
    pub euler: i16,
    /// Chords of the boundary.
    pub chords: u8,
    /// Euler characteristics of the boundary components.
    pub components: Components,
    /// Orientable, every vertex link a disk or a sphere, boundary one sphere, Euler characteristic 1: rule R4 of a ball.
    pub is_ball: bool,
}

/// Measures a complex.
pub fn shape(c: &Complex) -> Shape {
    measure(c, &Boundary::of(c), c.is_orientable())
}

pub(crate) fn measure(c: &Complex, boundary: &Boundary, orientable: bool) -> Shape {
    let n = c.n_cubes();
    let mut joined = [0u64; MAX_VERTICES];
    for cube in c.cubes() {
        for [i, j] in EDGES {
            let (v, w) = (cube[i] as usize & 63, cube[j] as usize & 63);
            joined[v] |= 1 << w;
            joined[w] |= 1 << v;
        }
    }
    let edges: i16 = joined.iter().map(|set| set.count_ones() as i16).sum::<i16>() / 2;
    let used = c.sets[..n].iter().fold(0u64, |all, set| all | set);
    let vertices = used.count_ones() as i16;
    let quads = (6 * n + boundary.n_quads()) as i16 / 2;
    let euler = vertices - edges + quads - n as i16;
    let components = boundary.components();
    let is_ball = orientable && euler == 1 && components.is_one_sphere() && links_are_simple(c, used, &joined);
    Shape { vertices: vertices as u8, euler, chords: boundary.n_chords() as u8, components, is_ball }
}

/// Whether every vertex link of an orientable complex is a disk or a sphere.
///
/// The link of v has a triangle per cube at v, an edge per quad at v, a vertex per edge at v. It is a surface if the cubes
/// round each edge at v are joined through quads at that edge; it is connected if the cubes at v are joined through
/// quads at v; then Euler characteristic 1 or 2 means disk or sphere, being orientable.
fn links_are_simple(c: &Complex, used: u64, joined: &[u64; MAX_VERTICES]) -> bool {
    let mut left = used;
    while left != 0 {
        let v = left.trailing_zeros() as u8;
        left &= left - 1;
        let (triangles, twice_edges, connected) = star(c, 1 << v);
        if !connected {
            return false;
        }
        let mut rest = joined[v as usize & 63];
        let vertices = rest.count_ones() as i32;
        while rest != 0 {
            let w = rest.trailing_zeros();
            rest &= rest - 1;
            if w as u8 > v && !star(c, 1 << v | 1 << w).2 {
                return false;
            }
        }
        // Orientable was made sure of before: a closed link of characteristic 2 is a sphere, one with a rim of
        // characteristic 1 a disk.
        let euler = vertices - twice_edges / 2 + triangles;
        if euler != 1 && euler != 2 {
            return false;
        }
    }
    true
}

/// The cubes that contain a set of vertices: their number, twice the number of their quads that contain the set (a boundary quad
/// counts twice, a common quad once from each side), and whether they are joined through such quads.
fn star(c: &Complex, set: u64) -> (i32, i32, bool) {
    let mut cubes = 0u16;
    for (a, other) in c.sets[..c.n_cubes()].iter().enumerate() {
        cubes |= u16::from(other & set == set) << a;
    }
    let mut twice = 0;
    let mut adjacency = [0u16; MAX_CUBES];
    let mut left = cubes;
    while left != 0 {
        let a = left.trailing_zeros() as usize;
        left &= left - 1;
        let mut corners = 0u8;
        for (i, &v) in c.cubes[a].iter().enumerate() {
            corners |= ((set >> (v & 63) & 1) as u8) << i;
        }
        for f in 0..6 {
            if side_set(f) & corners == corners {
                let b = c.next[a][f];
                if b == FREE {
                    twice += 2;
                } else {
                    twice += 1;
                    adjacency[a] |= 1 << (b & 15);
                }
            }
        }
    }
    let start = cubes.trailing_zeros() as usize;
    (cubes.count_ones() as i32, twice, crate::complex::reach(&adjacency, start, cubes) == cubes)
}

/// Which complexes a run lists.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Selection {
    /// Least and greatest number of boundary quads.
    pub boundary_quads: Option<(usize, usize)>,
    /// Balls only.
    pub balls: bool,
    /// At most so many chords.
    pub max_chords: Option<u8>,
    /// Exactly this boundary key.
    pub key: Option<hexfill_mesh::Key>,
}

impl Selection {
    /// Whether everything is selected.
    pub fn is_all(&self) -> bool {
        *self == Self::default()
    }

    /// Whether a complex is selected.
    pub(crate) fn wants(&self, boundary: &Boundary, shape: &Shape) -> bool {
        self.boundary_quads.is_none_or(|(low, high)| (low..=high).contains(&boundary.n_quads()))
            && (!self.balls || shape.is_ball)
            && self.max_chords.is_none_or(|k| shape.chords <= k)
            && self.key.as_ref().is_none_or(|key| boundary.has_key(key))
    }

    /// The selection in words, for ledgers and trailers; empty for everything.
    pub fn text(&self) -> String {
        let mut parts = Vec::new();
        if let Some((low, high)) = self.boundary_quads {
            parts.push(format!("boundary-quads {low}..{high}"));
        }
        if self.balls {
            parts.push("balls".into());
        }
        if let Some(k) = self.max_chords {
            parts.push(format!("max-chords {k}"));
        }
        if let Some(key) = &self.key {
            parts.push(format!("key {key}"));
        }
        parts.join(", ")
    }
}

/// Reads "a..b" (both ends included; either may be left out) or a single number.
///
/// # Errors
/// [`EnumerateError::BadParameters`] if it is neither.
pub fn parse_range(text: &str) -> Result<(usize, usize), EnumerateError> {
    let bad = || EnumerateError::BadParameters {
        why: format!("{text:?} is not a range of numbers: write a..b (both included), a.., ..b or a"),
    };
    let number = |s: &str, empty: usize| if s.is_empty() { Ok(empty) } else { s.parse().map_err(|_| bad()) };
    let (low, high) = match text.split_once("..") {
        Some((low, high)) => (number(low, 0)?, number(high.trim_start_matches('='), usize::MAX)?),
        None => {
            let n = text.parse().map_err(|_| bad())?;
            (n, n)
        }
    };
    if low > high { Err(bad()) } else { Ok((low, high)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn balls_and_others() {
        let s = shape(&Complex::cube());
        assert!(s.is_ball);
        assert_eq!((s.vertices, s.euler, s.chords), (8, 1, 3));
        let ring = [[0, 1, 2, 3, 4, 5, 6, 7], [4, 5, 6, 7, 8, 9, 10, 11], [8, 9, 10, 11, 0, 1, 2, 3]];
        let s = shape(&Complex::from_cubes(&ring).unwrap());
        assert!(!s.is_ball);
        assert_eq!((s.euler, s.components.text().as_str()), (0, "1"));
        // Two cubes that touch in a vertex, joined by a path of two others: the link there is two disks.
        let pinched = Complex::from_cubes(&[
            [0, 1, 2, 3, 4, 5, 6, 7],
            [1, 8, 9, 2, 5, 10, 11, 6],
            [8, 12, 13, 9, 10, 14, 15, 11],
            [12, 16, 17, 13, 14, 0, 18, 15],
        ])
        .unwrap();
        assert!(!shape(&pinched).is_ball);
    }

    #[test]
    fn ranges() {
        assert_eq!(parse_range("6..10").unwrap(), (6, 10));
        assert_eq!(parse_range("6").unwrap(), (6, 6));
        assert_eq!(parse_range("..10").unwrap(), (0, 10));
        assert_eq!(parse_range("3..").unwrap(), (3, usize::MAX));
        assert!(parse_range("9..3").is_err() && parse_range("x").is_err());
    }
}
