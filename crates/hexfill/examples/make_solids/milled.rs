//! Parts that are milled out of plates: squares side by side, with round holes, pins, bosses, pockets and steps; flat, bent, or closed to a ring; and parts of
//! several such blocks, each with a direction of its own.

use crate::section::{Section, between, unit};
use crate::solid::{Point, Solid, Welder};
use hexfill_mesh::Random;
use std::f64::consts::PI;
use std::ops::Range;

/// What a square of a plate is cut into.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Square {
    /// A grid.
    Plain,
    /// Rings round a round hole.
    Hole,
    /// Rings round a disk.
    Disk,
}

/// Where a quad of a plate lies: its square, and its ring from inside out; 0 is the disk, or all of a plain square.
type Place = ([usize; 2], usize);

/// A plate: how many squares it has along x and y, quads along the side of one, and rings round a hole.
struct Plate {
    squares: [usize; 2],
    side: usize,
    rings: usize,
    /// Closed to a ring about the z axis; squares follow each other round it.
    closed: bool,
}

impl Plate {
    fn new(squares: [usize; 2], side: usize, rings: usize) -> Self {
        Self { squares, side, rings, closed: false }
    }

    /// The same squares round an axis.
    fn ring(squares: [usize; 2], side: usize, rings: usize) -> Self {
        Self { squares, side, rings, closed: true }
    }

    /// A plate in the plane, or unrolled, and the places of its quads.
    fn section(&self, kind: impl Fn([usize; 2]) -> Square) -> (Section, Vec<Place>) {
        let mut welder = Welder::default();
        let (mut quads, mut places) = (Vec::new(), Vec::new());
        for i in 0..self.squares[0] * self.squares[1] {
            let square = [i % self.squares[0], i / self.squares[0]];
            let kind = kind(square);
            let mut part = match kind {
                Square::Plain => Section::rectangle([self.side; 2], [2.0; 2]),
                _ => Section::square_with_round_hole(self.side, self.rings, 0.5),
            };
            // Four patches, each with its rings one quad after the other along u.
            let ring = |q: usize| if kind == Square::Plain { 0 } else { 1 + q % self.rings };
            let mut rings: Vec<usize> = (0..part.quads.len()).map(ring).collect();
            if kind == Square::Disk {
                let disk = disk(self.side, 0.5);
                let first = part.points.len() as u32;
                rings.extend(disk.quads.iter().map(|_| 0));
                part.quads.extend(disk.quads.iter().map(|q| q.map(|v| v + first)));
                part.points.extend(disk.points);
            }
            let at = |v: u32| {
                let [x, y] = part.points[v as usize];
                let x = x + 2.0 * square[0] as f64;
                // A point on the seam is one, though it has two places on the way round.
                let period = 2.0 * self.squares[0] as f64;
                let x = if self.closed && x > period - 1.0 - 1e-9 { x - period } else { x };
                [x, y + 2.0 * square[1] as f64, 0.0]
            };
            for (quad, ring) in part.quads.iter().zip(rings) {
                quads.push(quad.map(|v| welder.id(at(v))));
                places.push((square, ring));
            }
        }
        (Section { points: welder.points.iter().map(|&[x, y, _]| [x, y]).collect(), quads }, places)
    }

    /// The plate with the layers that each place has, of 0.4 each, mapped.
    fn milled(
        &self,
        kind: impl Fn([usize; 2]) -> Square,
        layers: impl Fn(Place) -> Range<usize>,
        map: impl Fn(Point) -> Point,
    ) -> Solid {
        let (section, places) = self.section(kind);
        let high = places.iter().map(|&p| layers(p).end).max().unwrap_or(0);
        // Squares keep their size in the middle of the innermost row.
        let radius = self.squares[0] as f64 / PI;
        Solid::swept(
            &section,
            high,
            |quad, layer| layers(places[quad]).contains(&layer),
            |[x, y], t| {
                let z = 0.4 * high as f64 * t;
                let [c, s] = unit((x + 1.0) / radius);
                map(if self.closed { [(radius + y + 1.0) * c, (radius + y + 1.0) * s, z] } else { [x, y, z] })
            },
        )
    }
}

/// A disk of `n * n` quads between four arcs whose points lie evenly (Coons patch).
fn disk(n: usize, radius: f64) -> Section {
    let arc = |from: f64, to: f64, t: f64| unit(PI / 4.0 * (from + (to - from) * t));
    let corner = |x: f64, y: f64| match (x < 0.5, y < 0.5) {
        (true, true) => unit(-0.75 * PI),
        (false, true) => unit(-0.25 * PI),
        (false, false) => unit(0.25 * PI),
        (true, false) => unit(0.75 * PI),
    };
    let point = |x: f64, y: f64| -> [f64; 2] {
        let across = between(arc(-3.0, -1.0, x), arc(3.0, 1.0, x), y);
        let along = between(arc(5.0, 3.0, y), arc(-1.0, 1.0, y), x);
        let low = between(corner(0.0, 0.0), corner(1.0, 0.0), x);
        let high = between(corner(0.0, 1.0), corner(1.0, 1.0), x);
        let flat = between(low, high, y);
        [0, 1].map(|k| radius * (across[k] + along[k] - flat[k]))
    };
    let points = (0..=n).flat_map(|j| (0..=n).map(move |i| (i, j)));
    let quad = |i: usize, j: usize| [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[a, b]| ((j + b) * (n + 1) + i + a) as u32);
    Section {
        points: points.map(|(i, j)| point(i as f64 / n as f64, j as f64 / n as f64)).collect(),
        quads: (0..n * n).map(|q| quad(q % n, q / n)).collect(),
    }
}

fn as_it_is(p: Point) -> Point {
    p
}

fn bent([x, y, z]: Point) -> Point {
    let [s, c] = unit(PI / 2.0 - x / 6.0);
    [(6.0 + z) * c, y, (6.0 + z) * s]
}

/// Parts by name.
pub(crate) fn parts() -> Vec<(&'static str, Solid)> {
    use Square::{Disk, Hole, Plain};
    let plate = |squares| Plate::new(squares, 4, 2);
    let holes = |_: [usize; 2]| Hole;
    let disks = |_: [usize; 2]| Disk;
    vec![
        ("six_holes", plate([3, 2]).milled(holes, |_| 0..2, as_it_is)),
        ("six_holes_bent", plate([3, 2]).milled(holes, |_| 0..2, bent)),
        ("five_holes", plate([3, 3]).milled(|[i, j]| if (i + j) % 2 == 0 { Hole } else { Plain }, |_| 0..2, as_it_is)),
        ("sixteen_holes", plate([4, 4]).milled(holes, |_| 0..2, as_it_is)),
        ("block", Plate::new([2, 2], 4, 3).milled(holes, |_| 0..8, as_it_is)),
        ("bosses", plate([2, 1]).milled(holes, |(_, ring)| if ring == 1 { 0..4 } else { 0..2 }, as_it_is)),
        ("counterbores", Plate::new([3, 2], 4, 3).milled(holes, |(_, r)| 0..if r == 1 { 2 } else { 4 }, as_it_is)),
        ("blind_holes", plate([3, 1]).milled(disks, |(_, ring)| 0..if ring == 0 { 2 } else { 4 }, as_it_is)),
        (
            "one_blind",
            plate([3, 1]).milled(
                |[i, _]| if i == 1 { Disk } else { Hole },
                |(_, ring)| 0..if ring == 0 { 2 } else { 4 },
                as_it_is,
            ),
        ),
        ("pins", plate([3, 1]).milled(disks, |(_, ring)| 0..if ring == 0 { 5 } else { 2 }, as_it_is)),
        (
            "step",
            plate([3, 1]).milled(
                |[i, _]| if i == 1 { Plain } else { Hole },
                |([i, _], _)| 0..if i == 2 { 4 } else { 2 },
                as_it_is,
            ),
        ),
        (
            "rib",
            plate([3, 3]).milled(
                |[_, j]| if j == 1 { Plain } else { Hole },
                |([_, j], _)| 0..if j == 1 { 5 } else { 2 },
                as_it_is,
            ),
        ),
        (
            "tray",
            plate([3, 3]).milled(
                |c| if c == [1, 1] { Hole } else { Plain },
                |(c, _)| 0..if c == [1, 1] { 2 } else { 4 },
                bent,
            ),
        ),
        ("bolt_circle", Plate::ring([8, 1], 3, 2).milled(holes, |_| 0..3, as_it_is)),
        (
            "hub",
            Plate::ring([8, 2], 3, 2).milled(
                |[_, j]| if j == 1 { Hole } else { Plain },
                |([_, j], ring)| if j == 0 { 0..6 } else { 0..2 + usize::from(ring == 1) },
                as_it_is,
            ),
        ),
        (
            "both_sides",
            plate([3, 1]).milled(
                disks,
                |([i, _], ring)| match (i, ring) {
                    (0, 0) => 0..4,
                    (1, 0) => 2..6,
                    (1, 1) => 1..5,
                    _ => 2..4,
                },
                as_it_is,
            ),
        ),
    ]
}

/// Parts of several blocks by name. A square has sides of 2, a leg a thickness of 1.
pub(crate) fn assembled() -> Vec<(&'static str, Solid)> {
    let square = Section::square_with_round_hole(4, 2, 0.5);
    let raised = |layers: usize, high: f64, place: &dyn Fn(Point) -> Point| {
        Solid::swept(&square, layers, |_, _| true, |[x, y], t| place([x + 1.0, y + 1.0, high * t]))
    };
    let leg = |place: &dyn Fn(Point) -> Point| raised(2, 1.0, place);
    let bored = |place: &dyn Fn(Point) -> Point| raised(4, 2.0, place);
    let block = |n: [usize; 3], from: Point, size: Point| {
        Solid::blocks(&[(n, &|p: Point| [0, 1, 2].map(|k| from[k] + size[k] * p[k]) as Point)])
    };
    // Where two legs meet, and the cube of one square.
    let corner = |x: f64, rows: usize| block([2, 4 * rows, 2], [x, 0.0, 0.0], [1.0, 2.0 * rows as f64, 1.0]);
    let bracket = |along: usize, rows: usize| {
        let mut parts = vec![corner(0.0, rows)];
        for (i, j) in (0..along).flat_map(|i| (0..rows).map(move |j| (2.0 * i as f64, 2.0 * j as f64))) {
            parts.push(leg(&|[x, y, z]| [x + i + 1.0, y + j, z]));
            parts.push(leg(&|[x, y, z]| [z, y + j, x + i + 1.0]));
        }
        Solid::joined(&parts)
    };
    let upright = |at: f64| leg(&move |[x, y, z]| [z + at, y, x + 1.0]);
    let lying = |at: f64| leg(&move |[x, y, z]| [x + at, y, z]);
    vec![
        ("bracket", bracket(1, 1)),
        ("bracket_long", bracket(2, 1)),
        ("bracket_wide", bracket(2, 2)),
        ("bracket_bent", bracket(2, 1).mapped(|[x, y, z]| [x + 0.05 * y * z, y - 0.03 * x * z, z + 0.04 * x * x])),
        ("tee", Solid::joined(&[lying(0.0), corner(2.0, 1), lying(3.0), upright(2.0)])),
        ("clevis", Solid::joined(&[corner(0.0, 1), lying(1.0), corner(3.0, 1), upright(0.0), upright(3.0)])),
        (
            "lugs",
            Solid::joined(&[
                block([4; 3], [0.0; 3], [2.0; 3]),
                leg(&|[x, y, z]| [x + 2.0, y, z + 0.5]),
                leg(&|[x, y, z]| [z + 0.5, x + 2.0, y]),
                leg(&|[x, y, z]| [y, z + 0.5, x + 2.0]),
            ]),
        ),
        (
            "two_bores",
            Solid::joined(&[
                bored(&|p| p),
                block([4; 3], [2.0, 0.0, 0.0], [2.0; 3]),
                bored(&|[x, y, z]| [x + 4.0, z, y]),
            ]),
        ),
        (
            "three_bores",
            Solid::joined(&[bored(&|p| p), bored(&|[x, y, z]| [x + 2.0, z, y]), bored(&|[x, y, z]| [z, x + 2.0, y])]),
        ),
    ]
}

/// A random part. Squares of one column have the same layers, and within each the innermost ring and the disk have layers of their own.
pub(crate) fn random(seed: u64) -> Solid {
    let mut random = Random::new(seed);
    let closed = random.below(4) == 0;
    let squares = [if closed { 6 + random.below(3) } else { 1 + random.below(4) }, 1 + random.below(2)];
    let plate = Plate { squares, side: 3, rings: 2, closed };
    let n = squares[0] * squares[1];
    let kinds: Vec<Square> =
        (0..n).map(|_| [Square::Plain, Square::Hole, Square::Disk, Square::Disk][random.below(4)]).collect();
    // All have two layers in common, so that what is side by side is joined.
    let mut layers = || random.below(3)..5 + random.below(3);
    let column: Vec<Range<usize>> = (0..squares[0]).map(|_| layers()).collect();
    let inner: Vec<[Range<usize>; 2]> = (0..n).map(|_| [layers(), layers()]).collect();
    let number = |[i, j]: [usize; 2]| j * squares[0] + i;
    let range = |(square, ring): Place| match ring {
        0 | 1 if kinds[number(square)] != Square::Plain => inner[number(square)][ring].clone(),
        _ => column[square[0]].clone(),
    };
    plate.milled(|square| kinds[number(square)], range, if closed || seed.is_multiple_of(2) { as_it_is } else { bent })
}
