//! Bridges: a column of hexes from the outer component of the front to that of a cavity, so that both become one.
//!
//! Idea: between two components the void is no ball, and no sweep of one closes it. A column of k hexes takes a quad of each away, and its
//! sides join them: the void is cut open along it. The column goes where it is shortest and stands most upright on both quads; the cavity's quad is turned
//! so that the column twists least, and k is its length in edges (any k keeps the parity of the front).
//!
//! Invariant: the column lies inside the surface as far as samples of its axis tell.
//!
//! Source: ours.

use crate::front::Front;
use crate::inside::winding_number;
use hexfill_geometry::{Vector as Point, add_scaled, cross, dot, norm, sub};
use hexfill_mesh::{QuadId, QuadSurface};

/// Columns less upright than this (cosine at either quad) are not built.
const MOST_LEANING: f64 = 0.3;
/// A column has at most this share of the front's quads as hexes, or so many where that is less: what it adds has to be swept again. Only
/// needles and specks ask for more.
const LONGEST_SHARE: f64 = 0.25;
const LONGEST_OF_FEW: u32 = 8;
/// Columns whose axis is looked at: winding numbers take time.
const LOOKED_AT: usize = 50;

fn between(a: Point, b: Point, t: f64) -> Point {
    add_scaled(a, t, sub(b, a))
}

/// A quad's centre, outward unit normal and mean edge.
struct Seat {
    quad: [u32; 4],
    centre: Point,
    normal: Point,
    edge: f64,
}

impl Seat {
    fn new(quad: [u32; 4], points: &[Point]) -> Self {
        let [a, b, c, d] = quad.map(|v| points[v as usize]);
        let normal = cross(sub(c, a), sub(d, b));
        let length = norm(normal);
        let edge = [[a, b], [b, c], [c, d], [d, a]].into_iter().map(|[p, q]| norm(sub(p, q)));
        Self {
            quad,
            centre: [0, 1, 2].map(|k| (a[k] + b[k] + c[k] + d[k]) / 4.0),
            normal: normal.map(|n| n / length),
            edge: edge.sum::<f64>() / 4.0,
        }
    }

    /// What a column to `other` costs: its length, more where it leans; `None` if it would leave the solid.
    fn cost(&self, other: &Self) -> Option<f64> {
        let axis = sub(other.centre, self.centre);
        let length = norm(axis);
        let (here, there) = (-dot(axis, self.normal) / length, dot(axis, other.normal) / length);
        (here.min(there) > MOST_LEANING).then(|| length / (here * there))
    }
}

impl Front {
    /// Joins the component of the first quad to another by a bridge; `None` if there is none. `points` holds a position for each vertex
    /// (of the surface, or near it), and `pillows` says how many layers lie on the surface; it grows with the vertices.
    pub(crate) fn bridged(&self, points: &mut Vec<Point>, pillows: u32) -> Option<Self> {
        let surface = QuadSurface::try_new(self.n_vertices() as usize, &self.quads()).ok()?;
        let home = surface.component(QuadId(0));
        let (outer, inner): (Vec<usize>, Vec<usize>) =
            (0..surface.n_quads()).partition(|&q| surface.component(QuadId::new(q)) == home);
        let quads = self.quads();
        let seats = |of: &[usize]| -> Vec<Seat> { of.iter().map(|&q| Seat::new(quads[q], points)).collect() };
        let (outer, inner) = (seats(&outer), seats(&inner));
        let mut columns: Vec<(f64, usize, usize)> = Vec::new();
        for (j, to) in inner.iter().enumerate() {
            let all = outer.iter().enumerate().filter_map(|(i, from)| Some((from.cost(to)?, i, j)));
            columns.extend(all.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))));
        }
        columns.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        let is_inside = |&(_, i, j): &(f64, usize, usize)| {
            let (a, b) = (outer[i].centre, inner[j].centre);
            [0.1, 0.5, 0.9].into_iter().all(|t| {
                let turns = winding_number(self.surface(), points, between(a, b, t));
                (turns - 1.0).abs() < 0.5
            })
        };
        let longest = LONGEST_OF_FEW.max((LONGEST_SHARE * quads.len() as f64) as u32);
        let found = columns.iter().take(LOOKED_AT).filter(|c| is_inside(c)).find_map(|&(_, i, j)| {
            let (from, to) = (&outer[i], &inner[j]);
            let axis = sub(to.centre, from.centre);
            let length = (2.0 * norm(axis) / (from.edge + to.edge)).round();
            // Both ends stand on pillows already.
            let k = (length as u32).saturating_sub(2 * pillows).clamp(1, longest);
            self.column(from.quad, to.quad, k, points)
        });
        let (state, new) = found?;
        points.extend(new);
        Some(state)
    }

    /// The state with `k` hexes in a column between two quads, and the positions of its new vertices; `None` if that is improper.
    fn column(&self, from: [u32; 4], to: [u32; 4], k: u32, points: &[Point]) -> Option<(Self, Vec<Point>)> {
        let at = |v: u32| points[v as usize];
        // Seen along the column the quad at its end runs the other way.
        // Four ways to join two quads without a twist in the orientation; the nearest corners give the least turn.
        let ends = (0..4).map(|turn: usize| [0, 1, 2, 3].map(|i: usize| to[(turn + 4 - i) % 4]));
        let far = |end: &[u32; 4]| -> f64 { (0..4).map(|i| sub(at(from[i]), at(end[i]))).map(|d| dot(d, d)).sum() };
        let end = ends.min_by(|a, b| far(a).total_cmp(&far(b)))?;
        let mut n_vertices = self.n_vertices();
        let mut new = Vec::new();
        let (mut hexes, mut quads) = (self.hexes().to_vec(), self.quads());
        quads.retain(|q| *q != from && *q != to);
        let mut above = from;
        for level in 1..=k {
            let below = if level == k {
                end
            } else {
                let t = f64::from(level) / f64::from(k);
                new.extend((0..4).map(|i| between(at(from[i]), at(end[i]), t)));
                n_vertices += 4;
                [4, 3, 2, 1].map(|i| n_vertices - i)
            };
            let ([a, b, c, d], [e, f, g, h]) = (below, above);
            hexes.push([a, b, c, d, e, f, g, h]);
            quads.extend([0, 1, 2, 3].map(|i: usize| [below[i], above[i], above[(i + 1) & 3], below[(i + 1) & 3]]));
            above = below;
        }
        Some((self.with(n_vertices, &hexes, &quads).ok()?, new))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shell::shell;
    use crate::shell_options::ShellOptions;
    use crate::sweep::Swept;
    use crate::test_surfaces::{judged, voxel_points};
    use hexfill_mesh::Context;

    /// A box of 5 x 5 x 5 with a cavity in the middle, bent so much that it is no polycube.
    fn hollow() -> (QuadSurface, Vec<Point>) {
        let (surface, mut points) = voxel_points([5, 5, 5], |c| c != [2; 3]).unwrap();
        for p in &mut points {
            let r = p.iter().fold(0.0f64, |m, x| m.max((x - 2.5).abs()));
            let l = p.iter().map(|x| (x - 2.5) * (x - 2.5)).sum::<f64>().sqrt();
            *p = p.map(|x| (x - 2.5) * r / l);
        }
        (surface, points)
    }

    #[test]
    fn a_bridge_joins_two_components() {
        let (surface, mut points) = hollow();
        let bridged = Front::new(&surface).unwrap().bridged(&mut points, 0).unwrap();
        bridged.debug_check();
        assert_eq!(bridged.hexes().len(), 3);
        assert_eq!(bridged.n_quads(), surface.n_quads() - 2 + 4 * 3);
        assert_eq!(points.len() as u32, bridged.n_vertices());
        assert!(QuadSurface::try_new(points.len(), &bridged.quads()).unwrap().is_sphere());
    }

    #[test]
    fn a_ball_with_a_cavity_is_filled() {
        let (surface, points) = hollow();
        let made = shell(&surface, Some(&points), &ShellOptions::default(), &Context::default());
        assert!(!made.meshes.is_empty());
        for shelled in made.meshes {
            let hexes = shelled.mesh.hexes_raw();
            let swept = Swept {
                n_vertices: shelled.mesh.n_vertices() as u32,
                hexes,
                plugs: 0,
                front: Vec::new(),
                stopped: None,
            };
            println!("{} hexes, {} pillows", judged(&surface, &swept), shelled.pillows);
        }
    }
}
