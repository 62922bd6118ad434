//! [`Membrane`]: a disk of quads across a waist, which shuts both sides off.
//!
//! Source: ours.

use crate::waist::Waist;
use hexfill_geometry::{Vector, best_direction, cross, direction, halves, winding_number};
use hexfill_mesh::{QuadSurface, chords, chords_by_quad};
use hexfill_shell::{Front, Quadrangulation};
use rustc_hash::FxHashMap;

/// Passes that bring the inner vertices to the means of their neighbours.
const PASSES: usize = 100;
/// The least that one edge inward from each of its vertices must reach, on both sides. With 0.05 a horse of 2,398 quads kept two invalid hexes at the corner
/// of a membrane where 0.07 was possible; with 0.15 three pieces fewer are cut from it, one of them with a void of 234 quads.
const ROOM: f64 = 0.12;
/// Grids looked at closely, the best first.
const CLOSELY: usize = 10;

/// A disk of quads whose rim is a waist.
#[derive(Clone, Debug)]
struct Membrane {
    /// Counter-clockwise as the waist; vertices beyond those given are its own.
    quads: Vec<[u32; 4]>,
    /// Positions of its own vertices.
    points: Vec<Vector>,
}

/// The quads of a sphere at `points` as those of two spheres, the waist closed by a membrane in each, whose own vertices are added to `points`. `None`
/// if no grid of quads leaves room on both sides.
pub(crate) fn cut_at(waist: &Waist, quads: &[[u32; 4]], points: &mut Vec<Vector>) -> Option<[Vec<[u32; 4]>; 2]> {
    let side = |near: bool| -> Vec<[u32; 4]> {
        quads.iter().zip(&waist.near).filter(|(_, is)| **is == near).map(|(q, _)| *q).collect()
    };
    let sides = [side(true), side(false)];
    let is_even = |cut: &Quadrangulation| (cut.quads.len() + sides[0].len()).is_multiple_of(2);
    let n = |membrane: &Membrane| points.len() + membrane.points.len();
    let mut membranes: Vec<(usize, f64, Membrane)> = Quadrangulation::grids(waist.circuit.len())
        .filter(is_even)
        .map(|cut| Membrane::new(&cut, &waist.circuit, points))
        .map(|membrane| (membrane.room(&sides, points), membrane))
        .filter(|(room, _)| *room > ROOM)
        .map(|(room, m)| (m.shut(&sides).iter().map(|piece| self_crossings(n(&m), piece)).sum(), room, m))
        .collect();
    // The membrane joins the strands that end at the waist, and a chord that crosses itself is what no sweep untangles. Stable: among equals the first.
    membranes.sort_by(|a, b| a.0.cmp(&b.0).then(b.1.total_cmp(&a.1)));
    membranes.into_iter().take(CLOSELY).find_map(|(.., membrane)| {
        let pieces = membrane.shut(&sides);
        let n = points.len() + membrane.points.len();
        let is_good = pieces.iter().all(|p| is_proper_sphere(n, p)) && membrane.is_inside(quads, points);
        is_good.then(|| {
            points.extend(&membrane.points);
            pieces
        })
    })
}

/// The quads that one chord passes twice; all of them if these are no surface.
fn self_crossings(n_vertices: usize, quads: &[[u32; 4]]) -> usize {
    QuadSurface::try_new(n_vertices, quads).map_or(quads.len(), |surface| {
        chords_by_quad(&surface, &chords(&surface)).iter().filter(|[a, b]| a == b).count()
    })
}

/// Whether some quads are one sphere on which a mesh can be proper.
fn is_proper_sphere(n_vertices: usize, quads: &[[u32; 4]]) -> bool {
    QuadSurface::try_new(n_vertices, quads)
        .is_ok_and(|s| s.reversed().is_empty() && s.is_sphere() && Front::new(&s).is_ok())
}

impl Membrane {
    fn new(cut: &Quadrangulation, circuit: &[u32], points: &[Vector]) -> Self {
        let k = cut.n_corners;
        let mut at: Vec<Vector> = circuit.iter().map(|&v| points[v as usize]).collect();
        let mean: Vector = std::array::from_fn(|axis| at.iter().map(|p| p[axis]).sum::<f64>() / k as f64);
        at.resize(k + cut.n_inner, mean);
        let mut near = vec![Vec::new(); k + cut.n_inner];
        for q in &cut.quads {
            (0..4).for_each(|i| near[q[i]].extend([q[(i + 1) % 4], q[(i + 3) % 4]]));
        }
        for _ in 0..PASSES {
            for v in k..at.len() {
                let share = 1.0 / near[v].len() as f64;
                at[v] = std::array::from_fn(|axis| near[v].iter().map(|&u| share * at[u][axis]).sum());
            }
        }
        let id = |i: usize| circuit.get(i).copied().unwrap_or((points.len() + i - k) as u32);
        Self { quads: cut.quads.iter().map(|q| q.map(id)).collect(), points: at.split_off(k) }
    }

    /// Both sides with the membrane. The waist has the near side on its left, so that side sees the membrane from behind.
    fn shut(&self, [near, far]: &[Vec<[u32; 4]>; 2]) -> [Vec<[u32; 4]>; 2] {
        let behind = self.quads.iter().map(|&[a, b, c, d]| [a, d, c, b]);
        [near.iter().copied().chain(behind).collect(), far.iter().chain(&self.quads).copied().collect()]
    }

    /// What one edge inward can reach at the vertices of the membrane, at the worst of them, on the worse side.
    fn room(&self, sides: &[Vec<[u32; 4]>; 2], points: &[Vector]) -> f64 {
        let at = |v: u32| points.get(v as usize).copied().unwrap_or_else(|| self.points[v as usize - points.len()]);
        let mut least = 1.0f64;
        for piece in self.shut(sides) {
            let mut normals: FxHashMap<u32, Vec<Vector>> = FxHashMap::default();
            self.quads.iter().flatten().for_each(|&v| drop(normals.insert(v, Vec::new())));
            for (q, i) in piece.iter().flat_map(|q| (0..4).map(move |i| (q, i))) {
                if let Some(normals) = normals.get_mut(&q[i]) {
                    let [here, next, previous] = [q[i], q[(i + 1) % 4], q[(i + 3) % 4]].map(at);
                    let along = |to| direction(here, to).unwrap_or([0.0; 3]);
                    // The frame (next edge, previous edge, inward) of an outward quad's corner is left-handed.
                    normals.push(cross(along(previous), along(next)));
                }
            }
            // The least of them: the order does not matter.
            least = normals.values().map(|normals| best_direction(normals).value).fold(least, f64::min);
        }
        least
    }

    /// Whether its own vertices lie inside the sphere of these quads.
    fn is_inside(&self, quads: &[[u32; 4]], points: &[Vector]) -> bool {
        let triangles = || quads.iter().flat_map(|q| halves(q.map(|v| points[v as usize])));
        self.points.iter().all(|&p| winding_number(triangles(), p) > 0.5)
    }
}
