//! Development: a surface all of whose edges bend by right angles is unrolled into the integer grid.
//!
//! An edge that wants w hexes (its angle inside the solid in right angles, rounded to 1, 2 or 3) tells how its two quads lie to each other, so
//! one quad placed in the grid places all others of its component: unit squares with an axis as normal. The surface *develops* iff every quad comes out
//! at the same place on all ways. (The integer-grid maps of polycube methods, here read off the surface instead of solved for; Tarini, Hormann,
//! Cignoni, Montani 2004.)
//!
//! A solid that is bent until its ends meet, a flange or a pulley, comes out at places that differ by multiples of one *period* along an axis: it is a surface in the
//! grid rolled up that way, and develops, too.
//!
//! Components are developed one by one; a cavity is placed by the affine map that takes the outer component's development nearest to its positions.
//!
//! Invariant: neighbouring vertices lie one step apart, up to the period, and quads face outward of the solid as those of the surface do.
//!
//! Source: ours, after Tarini et al. 2004.

use hexfill_geometry::{cone, det};
use hexfill_mesh::{Dart, QuadSurface};

/// Coordinates in the grid.
pub(crate) type Site = [i32; 3];

/// A surface in the grid.
#[derive(Clone, Debug)]
pub(crate) struct Development {
    /// Per vertex: its place.
    pub at: Vec<Site>,
    /// Per quad: its outward unit normal.
    pub normal: Vec<Site>,
    /// After how many steps along z the grid comes back to where it began; 0 if never.
    pub period: i32,
}

/// Shorter periods are none: three hexes make the smallest proper ring.
const SHORTEST_PERIOD: i32 = 3;

fn add(a: Site, b: Site) -> Site {
    [0, 1, 2].map(|k| a[k] + b[k])
}

fn minus(a: Site) -> Site {
    a.map(|x| -x)
}

fn cross(a: Site, b: Site) -> Site {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The surface in the grid; `wanted` is per dart. `None` if it does not develop, or the place of a cavity cannot be told: that needs
/// positions, and one component that faces outward.
pub(crate) fn develop(surface: &QuadSurface, wanted: &[f32], points: Option<&[[f64; 3]]>) -> Option<Development> {
    let mut development = Development {
        at: vec![[i32::MIN; 3]; surface.n_vertices()],
        normal: vec![[0; 3]; surface.n_quads()],
        period: 0,
    };
    let mut periods = [0; 3];
    let mut components = Vec::new();
    for q in 0..surface.n_quads() as u32 {
        if development.normal[q as usize] == [0; 3] {
            components.push(development.component(surface, wanted, q, &mut periods)?);
        }
    }
    development.roll_up(periods, components.len())?;
    if components.len() > 1 {
        development.place_cavities(surface, &components, points?)?;
    }
    Some(development)
}

impl Development {
    /// Develops the component of quad `first`; its quads.
    fn component(&mut self, surface: &QuadSurface, wanted: &[f32], first: u32, periods: &mut Site) -> Option<Vec<u32>> {
        // Per quad to look at: its dart 0's direction.
        let mut quads: Vec<(u32, Site)> = Vec::new();
        let start = surface.quads()[first as usize][0].index();
        self.put(surface, Dart(4 * first), [0, 0, 1], [1, 0, 0], [0; 3], periods)?;
        debug_assert_eq!(self.at[start], [0; 3]);
        quads.push((first, [1, 0, 0]));
        let mut done = 0;
        while let Some(&(q, mut along)) = quads.get(done) {
            done += 1;
            let normal = self.normal[q as usize];
            for i in 0..4 {
                let (d, inward) = (Dart(4 * q + i), cross(normal, along));
                let t = surface.twin(d);
                // One hex: a convex edge, the next quad faces away from this one; two: as this one; three: towards
                // it. No other number has a place in a grid.
                let turned = match wanted[d.index()].round() as i32 {
                    1 => minus(inward),
                    2 => normal,
                    3 => inward,
                    _ => return None,
                };
                let from = self.at[surface.target(d).index()];
                // Quads that are placed already are put again: that they come out at the same place on every way is
                // what developing means.
                let known = self.normal[t.quad().index()] != [0; 3];
                self.put(surface, t, turned, minus(along), from, periods)?;
                if !known {
                    let back = (0..(4 - t.side()) % 4).fold(minus(along), |e, _| cross(turned, e));
                    quads.push((t.quad().0, back));
                }
                along = inward;
            }
        }
        Some(quads.into_iter().map(|(q, _)| q).collect())
    }

    /// Places the quad of dart `d`, which starts at `from` in direction `along`. A corner that has a place elsewhere keeps it, and how far away that is
    /// becomes a multiple of the period of that axis; `None` if the quad lies another way round, or a corner is off along two axes.
    fn put(
        &mut self,
        surface: &QuadSurface,
        d: Dart,
        normal: Site,
        along: Site,
        from: Site,
        periods: &mut Site,
    ) -> Option<()> {
        let slot = &mut self.normal[d.quad().index()];
        if *slot != [0; 3] && *slot != normal {
            return None;
        }
        *slot = normal;
        let (mut d, mut along, mut at) = (d, along, from);
        for _ in 0..4 {
            let slot = &mut self.at[surface.origin(d).index()];
            if *slot == [i32::MIN; 3] {
                *slot = at;
            }
            let off = add(at, minus(*slot));
            match off.iter().filter(|&&x| x != 0).count() {
                0 => (),
                1 => (0..3).for_each(|k| periods[k] = gcd(periods[k], off[k].abs())),
                _ => return None,
            }
            at = add(at, along);
            along = cross(normal, along);
            d = d.next();
        }
        Some(())
    }

    /// Turns the axis with a period into z, and brings all places into the first period. `None` if there are several, a short one, or one and several components.
    fn roll_up(&mut self, periods: Site, n_components: usize) -> Option<()> {
        let Some(axis) = periods.iter().position(|&p| p != 0) else { return Some(()) };
        let period = periods[axis];
        if periods.iter().filter(|&&p| p != 0).count() > 1 || period < SHORTEST_PERIOD || n_components > 1 {
            return None;
        }
        // A cyclic change of axes is a rotation: outward stays outward.
        let turned = |x: Site| [1, 2, 3].map(|k| x[(axis + k) % 3]);
        self.period = period;
        for v in 0..self.at.len() {
            self.at[v] = self.rolled(turned(self.at[v]));
        }
        self.normal.iter_mut().for_each(|x| *x = turned(*x));
        Some(())
    }

    /// A place in the first period.
    pub(crate) fn rolled(&self, mut site: Site) -> Site {
        if self.period != 0 {
            site[2] = site[2].rem_euclid(self.period);
        }
        site
    }

    /// Six times the volume of some quads' component, in the grid.
    fn is_outward(&self, surface: &QuadSurface, quads: &[u32]) -> bool {
        let corner = |q: u32, i: usize| self.at[surface.quads()[q as usize][i].index()].map(f64::from);
        let volume: f64 = quads.iter().map(|&q| cone([0, 1, 2, 3].map(|i| corner(q, i)))).sum();
        volume > 0.0
    }

    /// Turns and shifts every component that faces inward to where the positions say it lies within the one that faces outward.
    fn place_cavities(&mut self, surface: &QuadSurface, components: &[Vec<u32>], points: &[[f64; 3]]) -> Option<()> {
        let (outer, inner): (Vec<_>, Vec<_>) = components.iter().partition(|c| self.is_outward(surface, c));
        let [outer] = outer[..] else { return None };
        let vertices = |quads: &[u32]| -> Vec<usize> {
            let mut all: Vec<usize> =
                quads.iter().flat_map(|&q| surface.quads()[q as usize]).map(|v| v.index()).collect();
            all.sort_unstable();
            all.dedup();
            all
        };
        let outer = vertices(outer);
        // Unrolled alone, a cavity lies anywhere and turned in one of 24 ways. The outer component's own map tells
        // where it belongs, nearly; whole numbers make it exact, and the polycube refuses what came out wrong.
        let to_grid = Affine::fit(outer.iter().map(|&v| (points[v], self.at[v].map(f64::from))))?;
        for quads in inner {
            let vertices = vertices(quads);
            let near: Vec<[f64; 3]> = vertices.iter().map(|&v| to_grid.apply(points[v])).collect();
            let n = vertices.len() as f64;
            let mut best: Option<(f64, [Site; 3], Site)> = None;
            for turn in rotations() {
                let turned = |v: usize| turn.map(|row| (0..3).map(|k| row[k] * self.at[v][k]).sum::<i32>());
                let off = |k: usize| -> f64 {
                    vertices.iter().zip(&near).map(|(&v, p)| p[k] - f64::from(turned(v)[k])).sum::<f64>() / n
                };
                let shift = [0, 1, 2].map(|k| off(k).round() as i32);
                let far = |v: usize, p: &[f64; 3]| -> f64 {
                    let at = add(turned(v), shift);
                    (0..3).map(|k| (f64::from(at[k]) - p[k]) * (f64::from(at[k]) - p[k])).sum()
                };
                let sum: f64 = vertices.iter().zip(&near).map(|(&v, p)| far(v, p)).sum();
                if sum.is_finite() && best.is_none_or(|(least, ..)| sum < least) {
                    best = Some((sum, turn, shift));
                }
            }
            let (_, turn, shift) = best?;
            let turned = |x: Site| turn.map(|row| (0..3).map(|k| row[k] * x[k]).sum::<i32>());
            vertices.iter().for_each(|&v| self.at[v] = add(turned(self.at[v]), shift));
            quads.iter().for_each(|&q| self.normal[q as usize] = turned(self.normal[q as usize]));
        }
        Some(())
    }
}

/// The greatest common divisor, with gcd(0, b) = b.
fn gcd(a: i32, b: i32) -> i32 {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// The 24 rotations of the grid, by rows.
fn rotations() -> Vec<[Site; 3]> {
    let axes: Vec<Site> = (0..6)
        .map(|i| {
            let mut axis = [0; 3];
            axis[i / 2] = if i % 2 == 0 { 1 } else { -1 };
            axis
        })
        .collect();
    let pairs = axes.iter().flat_map(|&a| axes.iter().map(move |&b| (a, b)));
    pairs.map(|(a, b)| [a, b, cross(a, b)]).filter(|turn| turn[2] != [0; 3]).collect()
}

/// An affine map: a matrix and what it takes to the origin of the image.
struct Affine {
    rows: [[f64; 3]; 3],
    from: [f64; 3],
    to: [f64; 3],
}

impl Affine {
    /// The map nearest to pairs (point, image), by least squares; `None` if the points lie in a plane.
    fn fit(pairs: impl Iterator<Item = ([f64; 3], [f64; 3])> + Clone) -> Option<Self> {
        let n = pairs.clone().count() as f64;
        let (mut from, mut to) = ([0.0; 3], [0.0; 3]);
        for (p, image) in pairs.clone() {
            (0..3).for_each(|k| from[k] += p[k] / n);
            (0..3).for_each(|k| to[k] += image[k] / n);
        }
        let (mut square, mut mixed) = ([[0.0; 3]; 3], [[0.0; 3]; 3]);
        for (p, image) in pairs {
            for i in 0..3 {
                for j in 0..3 {
                    square[i][j] += (p[i] - from[i]) * (p[j] - from[j]);
                    mixed[i][j] += (image[i] - to[i]) * (p[j] - from[j]);
                }
            }
        }
        let determinant = |[a, b, c]: [[f64; 3]; 3]| det(a, b, c);
        let whole = determinant(square);
        // Cramer's rule, row by row: rows[i] * square = mixed[i], and square is symmetric.
        let rows = mixed.map(|m| {
            [0, 1, 2].map(|k| {
                let mut with = square;
                with[k] = m;
                determinant(with) / whole
            })
        });
        rows.iter().flatten().all(|x| x.is_finite()).then_some(Self { rows, from, to })
    }

    fn apply(&self, p: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|i| self.to[i] + (0..3).map(|k| self.rows[i][k] * (p[k] - self.from[k])).sum::<f64>())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::angles::wanted_hexes;
    use crate::test_surfaces::torus_at;
    use hexfill_mesh::generate::cube_surface;

    #[test]
    fn there_are_24_rotations() {
        let all = rotations();
        assert_eq!(all.len(), 24);
        let determinant = |m: &[Site; 3]| {
            let [a, b, c] = m.map(|row| row.map(f64::from));
            det(a, b, c)
        };
        assert!(all.iter().all(|m| determinant(m) == 1.0));
    }

    #[test]
    fn a_cube_develops_and_a_torus_does_not() {
        let cube = cube_surface();
        let development = develop(&cube, &[1.0; 24], None).unwrap();
        let mut at = development.at;
        at.sort_unstable();
        at.dedup();
        assert_eq!(at.len(), 8);
        assert!(develop(&cube, &[2.0; 24], None).is_none());
        let (torus, points) = torus_at(12, 8);
        assert!(develop(&torus, &wanted_hexes(&torus, Some(&points)), Some(&points)).is_none());
    }
}
