//! [`Piece`]: a part of the unit sphere in which a direction is looked for.
//!
//! Pieces are spherical triangles, halved at their longest side, inside caps; the largest value of a linear function on a cap has a closed form.
//!
//! Source: ours.

use hexfill_geometry::{Vector, add, cross, dot, midpoint, norm, scale, sub, unit};

/// A piece of the sphere: all of it, or a spherical triangle inside a cap.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    /// A unit vector, or the origin for the whole sphere.
    pub(super) centre: Vector,
    /// No point of the piece is farther from the centre.
    pub(super) radius: f64,
    pub(super) triangle: [Vector; 3],
}

impl Piece {
    /// All of the sphere.
    pub(super) fn whole() -> Self {
        Self { centre: [0.0; 3], radius: 1.0, triangle: [[0.0; 3]; 3] }
    }

    pub(super) fn is_whole(&self) -> bool {
        self.centre == [0.0; 3]
    }

    /// A cap as a trust region; it is not split.
    pub(super) fn around(centre: Vector, radius: f64) -> Self {
        Self { centre, radius, triangle: [centre; 3] }
    }

    fn of_triangle(triangle: [Vector; 3]) -> Self {
        let [a, b, c] = triangle;
        let centre = unit(add(a, add(b, c))).expect("triangles of an octahedron do not degenerate");
        let radius = triangle.iter().map(|&p| norm(sub(p, centre))).fold(0.0, f64::max);
        Self { centre, radius: radius * (1.0 + 1e-14), triangle }
    }

    /// The octants of the whole sphere, or the halves of a triangle, cut at its longest side.
    pub(super) fn split(&self) -> Vec<Self> {
        if self.is_whole() {
            let mut octants = Vec::with_capacity(8);
            for signs in 0..8 {
                let axis = |k: usize| {
                    let mut p = [0.0; 3];
                    p[k] = if signs >> k & 1 == 1 { 1.0 } else { -1.0 };
                    p
                };
                octants.push(Self::of_triangle([axis(0), axis(1), axis(2)]));
            }
            return octants;
        }
        let t = self.triangle;
        let mut longest = 0;
        let length = |k: usize| norm(sub(t[k], t[(k + 1) % 3]));
        for k in 1..3 {
            // Strictly longer by more than rounding, so that equal sides are taken in order.
            if length(k) > length(longest) * (1.0 + 1e-9) {
                longest = k;
            }
        }
        let (a, b, c) = (t[longest], t[(longest + 1) % 3], t[(longest + 2) % 3]);
        let middle = unit(midpoint(a, b)).expect("sides are shorter than half a circle");
        vec![Self::of_triangle([a, middle, c]), Self::of_triangle([middle, b, c])]
    }

    /// Two tangents and the centre; the axes for the whole sphere.
    pub(super) fn frame(&self) -> [Vector; 3] {
        let c = self.centre;
        let Some(c) = unit(c) else { return [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] };
        let axis = if c[0].abs() < 0.6 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
        let a = unit(cross(c, axis)).expect("not parallel");
        [a, cross(c, a), c]
    }

    /// The maximum of `g . u` over the cap.
    pub(super) fn most(&self, g: Vector) -> f64 {
        let length = norm(g);
        if self.is_whole() {
            return length;
        }
        // Chord r, angle a: r = 2 sin(a / 2).
        let cos = 1.0 - 0.5 * self.radius * self.radius;
        let along = dot(g, self.centre);
        if along >= length * cos {
            return length;
        }
        let across = norm(sub(g, scale(along, self.centre)));
        along * cos + across * (1.0 - cos * cos).max(0.0).sqrt()
    }
}
