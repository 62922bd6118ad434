//! Which hexes to shrink: the arcs of a vertex's fan, grown by neighbouring quads, ranked by what all touched stars can reach.
//!
//! A star's penalty is the cube of what it lacks to [`GOOD`], so the worst of the touched vertices decide and good ones do not count. A
//! choice is worth the penalty it takes away from all surface vertices it touches (that of the vertex to be split
//! counts [`WEIGHT`] times, as no real placement reaches what its star alone could), less a little a hex. It may not push a vertex
//! that was fine below the limit, nor a poor one further down, unless the vertex to be split has no valid directions at all.
//!
//! Source: ours; measured in `record/split-stars-2026-11-22.md`.

use super::SplitOptions;
use crate::cells::{Cells, is_sphere};
use hexfill_geometry::{Ray, Vector, best_direction, climb_star, cross, direction, star_bound};
use hexfill_mesh::{Dart, QuadSurface};
use rayon::prelude::*;
use rustc_hash::FxHashMap;
use std::sync::Mutex;

/// A star that can reach this needs no more.
const GOOD: f64 = 0.7;

/// How much more the vertex to be split counts than the others. *Measured* on four cubes round a point behind a layer: with equal
/// weights a split at one quad wins, whose star could reach 0.447, and no valid placement was found; with this one a split at three, 0.666 and 0.29.
const WEIGHT: f64 = 10.0;

/// What one more hex costs, in penalty.
const HEX: f64 = 0.001;

/// Arcs that are tried with further quads.
const GROWN: usize = 6;

/// Quads an arc may take in.
const REACH: usize = 4;

/// Arcs of more quads round a vertex than this are not all tried: their ends keep to every second, third, ... edge.
const MOST_ENDS: usize = 16;

/// The share of what a star can reach that is left to it by a split of a neighbour which is not valid without. *Measured*: with all of it four random radial
/// surfaces kept a star without any valid directions; with half none did, and one got 350 hexes where it had 386.
const SPARED: f64 = 0.5;

/// A star that reaches no more is not valid: rounding.
pub(super) const NOTHING: f64 = 1e-6;

/// Stands for the new end of a vertex's new edge.
const NEW: u32 = u32::MAX;

/// Hexes to shrink.
#[derive(Clone, Debug)]
pub(super) struct Choice {
    /// The hexes, ascending.
    pub(super) set: Vec<u32>,
    /// Their facets to the outside.
    pub(super) skin: Vec<[u32; 4]>,
    /// The quads of the surface they were taken for.
    quads: Vec<Dart>,
    /// The penalty it takes away.
    worth: f64,
}

/// The surface and what stars on it can reach.
pub(super) struct Chooser<'a> {
    surface: &'a QuadSurface,
    points: &'a [Vector],
    /// Per vertex: a dart from it, for those on the surface.
    dart: Vec<Option<Dart>>,
    pub(super) options: SplitOptions,
}

impl<'a> Chooser<'a> {
    /// For a surface with a finite position at every used vertex.
    pub(super) fn new(surface: &'a QuadSurface, points: &'a [Vector], options: SplitOptions) -> Self {
        Self { surface, points, dart: surface.dart_of_vertices(), options }
    }

    fn is_surface(&self, v: u32) -> bool {
        self.dart.get(v as usize).is_some_and(|d| d.is_some())
    }

    /// The vertices at which no single direction reaches the limit, ascending.
    pub(super) fn vertices_no_direction_serves(&self) -> Vec<u32> {
        let all: Vec<(u32, Dart)> =
            self.dart.iter().enumerate().filter_map(|(v, d)| d.map(|d| (v as u32, d))).collect();
        all.into_par_iter()
            .with_min_len(256)
            .filter(|&(v, first)| {
                let to = |w: u32| self.direction(v, w);
                let normals: Vec<Vector> = self
                    .surface
                    .round_vertex(first)
                    // The frame (previous edge, next edge, inward) of an outward quad's corner is right-handed.
                    .map(|d| cross(to(self.origin(d.next().next().next())), to(self.origin(d.next()))))
                    .collect();
                best_direction(&normals).value < self.options.below
            })
            .map(|(v, _)| v)
            .collect()
    }

    fn origin(&self, d: Dart) -> u32 {
        self.surface.origin(d).0
    }

    /// The unit direction from v to w; zero, so that every corner on it is worthless, if they lie on one spot.
    fn direction(&self, v: u32, w: u32) -> Vector {
        direction(self.points[v as usize], self.points[w as usize]).unwrap_or([0.0; 3])
    }

    /// What the star of a surface vertex can reach in the mesh as it is.
    pub(super) fn value(&self, cells: &Cells, v: u32) -> f64 {
        let (corners, n_free) = self.star(v, &cells.corners_at(v, &[]));
        climb_star(&corners, n_free, 1.0).value
    }

    /// Of these vertices, ascending, those whose star cannot reach the limit, with what it can.
    pub(super) fn still_poor(&self, cells: &Cells, vertices: &[u32]) -> Vec<(u32, f64)> {
        let valued: Vec<(u32, f64)> = vertices.par_iter().map(|&v| (v, self.value(cells, v))).collect();
        valued.into_iter().filter(|(_, value)| *value < self.options.below).collect()
    }

    /// The penalties of the surface vertices on some quads, added up.
    pub(super) fn total_penalty(&self, cells: &Cells, quads: &[[u32; 4]]) -> f64 {
        self.surface_vertices(quads).into_iter().map(|v| penalty(self.value(cells, v))).sum()
    }

    fn surface_vertices(&self, quads: &[[u32; 4]]) -> Vec<u32> {
        let mut all: Vec<u32> = quads.iter().flatten().copied().filter(|&v| self.is_surface(v)).collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    /// A star's corners with the directions of its fixed edges, and the number of free ones; only ends on the surface are fixed.
    fn star(&self, v: u32, corners: &[[u32; 3]]) -> (Vec<[Ray; 3]>, usize) {
        let mut free: Vec<u32> = corners.iter().flatten().copied().filter(|&w| !self.is_surface(w)).collect();
        free.sort_unstable();
        free.dedup();
        let ray = |w: u32| match free.binary_search(&w) {
            Ok(j) => Ray::Free(j),
            Err(_) => Ray::Fixed(self.direction(v, w)),
        };
        (corners.iter().map(|ends| ends.map(ray)).collect(), free.len())
    }

    /// The star of v once the set is shrunk.
    fn star_after(&self, cells: &Cells, v: u32, set: &[u32], skin: &[[u32; 4]]) -> (Vec<[Ray; 3]>, usize) {
        let mut corners = cells.corners_at(v, set);
        for facet in skin {
            if let Some(i) = facet.iter().position(|&w| w == v) {
                // The new hex has this facet on top: previous, next, down is right-handed.
                corners.push([facet[(i + 3) % 4], facet[(i + 1) % 4], NEW]);
            }
        }
        self.star(v, &corners)
    }

    /// The best set to shrink for v, if any helps enough.
    pub(super) fn best_choice(&self, cells: &Cells, v: u32) -> Option<Choice> {
        let fan: Vec<Dart> = self.surface.round_vertex(self.dart[v as usize]?).collect();
        let k = fan.len();
        // All arcs are a square of the degree; at vertices of very many quads every so many ends do as well.
        let step = k.div_ceil(MOST_ENDS);
        let mut arcs: Vec<Vec<Dart>> = Vec::new();
        for start in (0..k).step_by(step) {
            for length in (1..k).step_by(step) {
                arcs.push((0..length).map(|i| fan[(start + i) % k]).collect());
            }
        }
        let known = Known::default();
        let mut found: Vec<Choice> =
            arcs.into_par_iter().filter_map(|arc| self.judge(cells, &known, v, arc, 0.0)).collect();
        let rank = |found: &mut Vec<Choice>| {
            found.sort_by(|a, b| b.worth.total_cmp(&a.worth).then(a.quads.cmp(&b.quads)));
        };
        rank(&mut found);
        found.truncate(GROWN);
        let mut found: Vec<Choice> = found.into_par_iter().map(|choice| self.grow(cells, &known, v, choice)).collect();
        rank(&mut found);
        found.into_iter().next()
    }

    /// Takes neighbouring quads in, one at a time, as long as that helps.
    fn grow(&self, cells: &Cells, known: &Known, v: u32, mut choice: Choice) -> Choice {
        for _ in 0..REACH {
            let mut next: Vec<Dart> = Vec::new();
            let has = |d: Dart| choice.quads.iter().any(|q| q.quad() == d.quad());
            for &d in &choice.quads {
                let mut side = d;
                for _ in 0..4 {
                    let over = self.surface.twin(side);
                    if !has(over) && !next.iter().any(|n| n.quad() == over.quad()) {
                        next.push(over);
                    }
                    side = side.next();
                }
            }
            let tried = next.into_iter().filter_map(|d| {
                let mut quads = choice.quads.clone();
                quads.push(d);
                self.judge(cells, known, v, quads, choice.worth)
            });
            // The first of the best.
            let Some(best) = tried.reduce(|a, b| if b.worth > a.worth { b } else { a }) else { break };
            choice = best;
        }
        choice
    }

    /// What shrinking the hexes on these quads is worth; `None` if it cannot be done, does not help v, or is not worth more than `floor`.
    fn judge(&self, cells: &Cells, known: &Known, v: u32, quads: Vec<Dart>, floor: f64) -> Option<Choice> {
        let mut set: Vec<u32> = Vec::new();
        for d in &quads {
            set.push(cells.owner(self.surface.quad(d.quad()).map(|w| w.0))?);
        }
        set.sort_unstable();
        set.dedup();
        let skin = cells.skin(&set);
        let least = |w: u32, before: f64| match () {
            // Where v is not valid, all that counts is to have it valid.
            () if w != v && self.known(cells, known, v) <= NOTHING => SPARED * before.min(self.options.below),
            // No other becomes poor, or poorer.
            () if w != v => before.min(self.options.below),
            // Where a quad has a needle there is little to gain.
            () if before <= NOTHING => 0.2 * self.options.gain,
            () => before + self.options.gain,
        };
        // First with what the stars can reach at most, which is quick; then one by one with what they do.
        let mut worth = -HEX * skin.len() as f64;
        let mut stars = Vec::new();
        for w in self.surface_vertices(&skin) {
            let (corners, n_free) = self.star_after(cells, w, &set, &skin);
            let (before, most) = (self.known(cells, known, w), star_bound(&corners, n_free));
            // Upper bounds refuse: if the best directions for single free edges are not enough, none are.
            if most < least(w, before) {
                return None;
            }
            let weight = if w == v { WEIGHT } else { 1.0 };
            worth += weight * (penalty(before) - penalty(most));
            stars.push((w, before, most, corners, n_free));
        }
        // A pillow round a set whose surface is no sphere would change the space.
        if worth <= floor || !is_sphere(&skin) {
            return None;
        }
        stars.sort_by_key(|star| (star.0 != v, star.0));
        for (w, before, most, corners, n_free) in stars {
            let after = climb_star(&corners, n_free, GOOD).value;
            let weight = if w == v { WEIGHT } else { 1.0 };
            worth += weight * (penalty(most) - penalty(after));
            if worth <= floor || after < least(w, before) {
                return None;
            }
        }
        Some(Choice { set, skin, quads, worth })
    }

    /// [`value`](Self::value), computed once.
    fn known(&self, cells: &Cells, known: &Known, v: u32) -> f64 {
        let lock = || known.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        if let Some(&value) = lock().get(&v) {
            return value;
        }
        let value = self.value(cells, v);
        lock().insert(v, value);
        value
    }
}

/// Values of stars in a mesh that does not change meanwhile.
type Known = Mutex<FxHashMap<u32, f64>>;

/// The penalty of a star; one that cannot be valid outweighs whatever else there is.
fn penalty(value: f64) -> f64 {
    (GOOD - value).max(0.0).powi(3) + if value <= NOTHING { 10.0 } else { 0.0 }
}
