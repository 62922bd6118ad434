//! A circle packing laid out in the plane and lifted to the sphere.
//!
//! The touching point of an edge is shared by the two vertices' circles, which touch there, and by the two quads' circles, which cross them at
//! right angles: so going once round a circle, kite by kite, gives the touching points of its edges and the centres of its neighbours. Circles are
//! gone round in the order of their radii, largest first, as errors grow from large to small ones least.
//! The lift is the stereographic projection of the touching points.
//!
//! Source: Bobenko, Springborn 2004 (kites); the order of the circles is ours.

use super::circle_packing::Packing;
use hexfill_geometry::Vector;
use hexfill_mesh::{Dart, QuadSurface};
use std::collections::BinaryHeap;
use std::f64::consts::PI;

type Point = [f64; 2];

/// The touching points on the unit sphere: one per dart, the same for a dart and its twin.
pub(super) fn touching_points(packing: &Packing, surface: &QuadSurface) -> Vec<Vector> {
    let mut layout = Layout::new(packing, surface);
    if !layout.place_first() {
        return vec![[0.0; 3]; 4 * surface.n_quads()];
    }
    let mut done = vec![false; packing.log_radius.len()];
    while let Some((_, circle, from)) = layout.queue.pop() {
        if !std::mem::replace(&mut done[circle], true) {
            layout.walk_round(circle, from);
        }
    }
    layout.project()
}

struct Layout<'a> {
    packing: &'a Packing,
    surface: &'a QuadSurface,
    /// Per dart: where its edge is touched.
    touch: Vec<Option<Point>>,
    /// Per circle; none for lines.
    centre: Vec<Option<Point>>,
    /// Circles with a centre, with one dart whose edge they touch at a known point; the largest first.
    queue: BinaryHeap<(u64, usize, Dart)>,
}

impl<'a> Layout<'a> {
    fn new(packing: &'a Packing, surface: &'a QuadSurface) -> Self {
        let n_circles = packing.log_radius.len();
        let touch = vec![None; 4 * surface.n_quads()];
        Self { packing, surface, touch, centre: vec![None; n_circles], queue: BinaryHeap::new() }
    }

    /// The radius as an integer of the same order.
    fn priority(&self, circle: usize) -> u64 {
        let bits = self.packing.log_radius[circle].to_bits();
        if bits >> 63 == 1 { !bits } else { bits | 1 << 63 }
    }

    fn is_vertex(&self, circle: usize) -> bool {
        circle < self.packing.n_vertices
    }

    /// The circles of a kite: those of the dart's origin and of its quad.
    fn circles_of(&self, d: Dart) -> (usize, usize) {
        (self.surface.origin(d).index(), self.packing.n_vertices + d.quad().index())
    }

    /// Puts the largest circle at the origin, with one touching point to its right. False if there is none.
    fn place_first(&mut self) -> bool {
        // Where the plane's origin lies does not matter, as the lift centres it; a large circle first keeps errors
        // small.
        let first = self
            .surface
            .darts()
            .flat_map(|d| [(self.circles_of(d).0, d), (self.circles_of(d).1, d)])
            .filter(|&(circle, _)| !self.packing.is_line[circle])
            .max_by_key(|&(circle, d)| (self.priority(circle), std::cmp::Reverse(d)));
        let Some((circle, dart)) = first else { return false };
        self.centre[circle] = Some([0.0; 2]);
        self.set_touch(dart, [self.packing.log_radius[circle].exp(), 0.0]);
        self.queue.push((self.priority(circle), circle, dart));
        true
    }

    fn set_touch(&mut self, d: Dart, point: Point) {
        self.touch[d.index()] = Some(point);
        self.touch[self.surface.twin(d).index()] = Some(point);
    }

    /// Goes once round a circle, counter-clockwise, from the known touching point of `from`: each kite leads from one touching point to the next.
    fn walk_round(&mut self, circle: usize, from: Dart) {
        let c = self.centre[circle].expect("a queued circle has a centre");
        let at = self.touch[from.index()].expect("a queued circle has a touching point");
        let log_radius = &self.packing.log_radius;
        let radius = log_radius[circle].exp();
        let mut angle = (at[1] - c[1]).atan2(at[0] - c[0]);
        let mut d = from;
        loop {
            // The kite after the touching point of d: for a vertex that of dart d, for a quad that of the next dart.
            let (kite, next) =
                if self.is_vertex(circle) { (d, self.surface.twin(d.prev())) } else { (d.next(), d.next()) };
            let (v, q) = self.circles_of(kite);
            let other = if self.is_vertex(circle) { q } else { v };
            let is_line = self.packing.is_line[other];
            // Circles of a kite are orthogonal; with a line its angle is straight.
            let half = if is_line { 0.5 * PI } else { (log_radius[other] - log_radius[circle]).exp().atan() };
            if !is_line && self.centre[other].is_none() {
                let distance = radius.hypot(log_radius[other].exp());
                let direction = angle + half;
                self.centre[other] = Some([c[0] + distance * direction.cos(), c[1] + distance * direction.sin()]);
                // The other circle touches the same edge: as its own quad's dart, or as the dart that starts at its vertex.
                let handle = if self.is_vertex(circle) { d } else { self.surface.twin(d) };
                self.queue.push((self.priority(other), other, handle));
            }
            angle += 2.0 * half;
            d = next;
            if d == from {
                break;
            }
            if self.touch[d.index()].is_none() {
                self.set_touch(d, [c[0] + radius * angle.cos(), c[1] + radius * angle.sin()]);
            }
        }
    }

    /// Stereographic lift after centring and scaling to median distance 1, the infinite point to the south pole.
    fn project(&self) -> Vec<Vector> {
        let known: Vec<Point> = self.touch.iter().flatten().copied().collect();
        let count = known.len().max(1) as f64;
        // The polyhedron is centred exactly later, by Lorentz boosts; this only keeps the lift from crowding all
        // points into one cap, where digits are lost.
        let middle = [0, 1].map(|k| known.iter().map(|p| p[k]).sum::<f64>() / count);
        let mut distances: Vec<f64> = known.iter().map(|p| (p[0] - middle[0]).hypot(p[1] - middle[1])).collect();
        distances.sort_by(f64::total_cmp);
        let size = distances.get(distances.len() / 2).copied().unwrap_or(1.0);
        let infinite = [self.packing.infinite, self.surface.twin(self.packing.infinite)];
        let lift = |d: Dart| match self.touch[d.index()] {
            Some(p) if !infinite.contains(&d) => {
                let (x, y) = ((p[0] - middle[0]) / size, (p[1] - middle[1]) / size);
                let square = x * x + y * y;
                [2.0 * x / (1.0 + square), 2.0 * y / (1.0 + square), (1.0 - square) / (1.0 + square)]
            }
            _ => [0.0, 0.0, -1.0],
        };
        self.surface.darts().map(lift).collect()
    }
}
