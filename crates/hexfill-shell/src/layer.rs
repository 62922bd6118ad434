//! Layers and closings: one hex on every quad of a side of a chord, so that the chord's ring is used up.
//!
//! A chord whose quads are distinct is a closed ring; taking it out leaves two sides, R and L, joined by the *rungs*, the
//! edges the chord crosses. A layer puts one hex on every quad of R; the ring's quads become lateral facets, the top of a
//! rim vertex is the other end of its rung, and the front is the old one with the ring contracted: all other chords
//! survive (successive dual cycle elimination; Müller-Hannemann 2001). If R and L are
//! mirror images across the rungs, the same hexes close the void. On surfaces that are not spheres a set of rings whose
//! union separates takes the place of one.
//!
//! The cost of a move is how far the edges it completes are from the hexes they want (book, page `shelling`, "Layers and closings").
//!
//! Source: Müller-Hannemann 2001 (dual cycles eliminated one after the other); the cost by angles and the closings are ours.

use crate::dart::{next, opposite, prev};
use crate::pairs::Join;
use crate::void::Void;
use rustc_hash::{FxHashMap, FxHashSet};

/// A closed ring of distinct quads, walked so that R is on the right: the darts by which its quads are entered. Each runs
/// along a rung from the left rim to the right rim.
pub(crate) type Ring = Vec<u32>;

/// A layer or a closing that may be possible, with its cost.
#[derive(Clone, Debug)]
pub(crate) struct Move {
    pub rings: Vec<Ring>,
    /// The quads of R, ascending.
    pub side: Vec<u32>,
    pub closes: bool,
    pub cost: f32,
    /// Hexes it takes after lifting.
    pub fine_hexes: u64,
}

/// Where a quad lies with respect to some rings.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Place {
    Elsewhere,
    Ring,
    Side,
}

/// The places of all quads with respect to the rings looked at now; used again for the next ones without being cleared.
#[derive(Debug, Default)]
pub(crate) struct Places {
    /// Twice the number of the look for ring quads, one more for side quads.
    mark: Vec<u32>,
    look: u32,
}

impl Places {
    fn begin(&mut self, n_quads: usize) {
        self.mark.resize(n_quads, 0);
        self.look += 1;
    }

    fn get(&self, q: u32) -> Place {
        match self.mark[q as usize] {
            // A stamp rather than a clear: looks at small sides of a large front would cost as much as the front.
            m if m == 2 * self.look => Place::Ring,
            m if m == 2 * self.look + 1 => Place::Side,
            _ => Place::Elsewhere,
        }
    }

    fn set(&mut self, q: u32, place: Place) {
        self.mark[q as usize] = 2 * self.look + u32::from(place == Place::Side);
    }
}

/// On fronts of more quads, sides of more than half of them are not looked at: they take more hexes than they are worth.
const LARGE: usize = 300;

/// A hex between two facets at an angle beyond this (in right angles) cannot be good.
const TOO_FLAT: f32 = 1.83;
/// What such a hex costs more.
const FLAT_HEX: f32 = 8.0;

/// The simple chords of the front, each walked in both directions.
pub(crate) fn rings(void: &Void) -> Vec<Ring> {
    let mut seen = vec![false; void.n_darts() as usize];
    let mut last_chord = vec![u32::MAX; void.quads.len()];
    let mut rings = Vec::new();
    for first in 0..void.n_darts() {
        if seen[first as usize] {
            continue;
        }
        let mut ring = Vec::new();
        let mut simple = true;
        let mut d = first;
        loop {
            seen[d as usize] = true;
            seen[opposite(d) as usize] = true;
            let quad = (d >> 2) as usize;
            simple &= last_chord[quad] != first;
            last_chord[quad] = first;
            ring.push(d);
            d = void.twin[opposite(d) as usize];
            if d == first {
                break;
            }
        }
        if simple {
            let back = ring.iter().rev().map(|&d| opposite(d)).collect();
            rings.push(ring);
            rings.push(back);
        }
    }
    rings
}

/// What a layer or a closing on these rings would be; `None` if the rings do not bound a side on their right, or a rung
/// would have to go to two places.
pub(crate) fn consider(void: &Void, places: &mut Places, rings: Vec<Ring>) -> Vec<Move> {
    let mut found = Vec::new();
    let Some(side) = side_of(void, places, &rings) else { return found };
    let Some(rungs) = Rungs::of(void, &rings) else { return found };
    let n_ring: usize = rings.iter().map(Vec::len).sum();
    let n_left = void.quads.len() - n_ring - side.len();
    let mut at_rim: FxHashMap<u32, u32> = FxHashMap::default();
    let mut inner_degree: FxHashMap<u32, u32> = FxHashMap::default();
    let mut cost = 0.0f32;
    let square = |x: f32| x * x;
    let mut base_hexes = 0u64;
    for &q in &side {
        for i in 0..4 {
            let d = (4 * q + i) as usize;
            let v = void.quads[q as usize][i as usize];
            if rungs.top.contains_key(&v) {
                *at_rim.entry(v).or_insert(0) += 1;
            } else {
                *inner_degree.entry(v).or_insert(0) += 1;
            }
            let t = void.twin[d] as usize;
            let weight = void.length[d] as f32;
            if places.get((t >> 2) as u32) == Place::Ring {
                cost += weight * square(void.wanted[d] - 1.0);
                if void.wanted[d] >= TOO_FLAT
                    && void.origin(d as u32) < void.n_surface
                    && void.origin(t as u32) < void.n_surface
                {
                    cost += weight * FLAT_HEX;
                }
            } else if d < t {
                cost += weight * square(void.wanted[d] - 2.0);
            }
        }
        base_hexes += u64::from(void.length[4 * q as usize]) * u64::from(void.length[4 * q as usize + 1]);
    }
    let height = void.length[rings[0][0] as usize];
    let mut left = 0.0f32;
    let mut left_close = 0.0f32;
    for ring in &rings {
        for &d in ring {
            // A rung has the hexes over its foot round it, which is all it will ever get: no later move reaches an
            // edge that is buried.
            let hexes = at_rim.get(&void.target(d)).copied().unwrap_or(0) as f32;
            cost += void.length[d as usize] as f32 * square(void.wanted[d as usize] - hexes);
            let rail = prev(d) as usize;
            let (weight, wanted) = (void.length[rail] as f32, void.wanted[rail]);
            left += weight * square((2.0 - wanted).max(0.0));
            left_close += weight * square(wanted - 1.0);
        }
    }
    // Sums over hash maps of small integers: exact in f32, so their order does not matter.
    cost += height as f32 * inner_degree.values().map(|&n| square(n as f32 - 4.0)).sum::<f32>();
    let fine_hexes = base_hexes * u64::from(height);
    // Cheap conditions first; whether the sides are mirror images is for `close` to find out.
    if n_left == side.len() && void.quads.len() == n_ring + 2 * side.len() {
        let mut close = cost + left_close;
        let is_left = |q: usize| places.get(q as u32) == Place::Elsewhere;
        for q in (0..void.quads.len()).filter(|&q| is_left(q)) {
            for d in 4 * q..4 * q + 4 {
                let t = void.twin[d] as usize;
                if d < t && is_left(t >> 2) {
                    close += void.length[d] as f32 * square(void.wanted[d] - 2.0);
                }
            }
        }
        found.push(Move { rings: rings.clone(), side: side.clone(), closes: true, cost: close, fine_hexes });
    }
    // A closed proper surface has six quads at least; a smaller front could only be closed, not layered.
    if side.len() + n_left >= 6 {
        found.push(Move { rings, side, closes: false, cost: cost + left, fine_hexes });
    }
    found
}

/// The quads on the right of the rings, ascending; the places of all quads are set. `None` if the right side meets the left, or is
/// too large.
fn side_of(void: &Void, places: &mut Places, rings: &[Ring]) -> Option<Vec<u32>> {
    let n = void.quads.len();
    // Of two sides the smaller one is enough on large surfaces, where a flood over half of the front for each ring
    // would be quadratic.
    let most = if n > LARGE { n / 2 } else { n };
    places.begin(n);
    for &d in rings.iter().flatten() {
        if places.get(d >> 2) == Place::Ring {
            return None;
        }
        places.set(d >> 2, Place::Ring);
    }
    let mut side = Vec::new();
    for &d in rings.iter().flatten() {
        let q = void.twin[next(d) as usize] >> 2;
        match places.get(q) {
            Place::Ring => return None,
            Place::Elsewhere => {
                places.set(q, Place::Side);
                side.push(q);
            }
            Place::Side => {}
        }
    }
    let mut at = 0;
    while at < side.len() {
        if side.len() > most {
            return None;
        }
        for d in 4 * side[at]..4 * side[at] + 4 {
            let q = void.twin[d as usize] >> 2;
            if places.get(q) == Place::Elsewhere {
                places.set(q, Place::Side);
                side.push(q);
            }
        }
        at += 1;
    }
    // The flood came round to the left of a ring: the rings together do not separate, and a layer would have no other
    // side to be contracted to.
    if rings.iter().flatten().any(|&d| places.get(void.twin[prev(d) as usize] >> 2) != Place::Elsewhere) {
        return None;
    }
    side.sort_unstable();
    Some(side)
}

/// The rungs as a map from the right rim to the left rim, one to one.
struct Rungs {
    top: FxHashMap<u32, u32>,
}

impl Rungs {
    fn of(void: &Void, rings: &[Ring]) -> Option<Self> {
        let mut top = FxHashMap::default();
        let mut left = FxHashSet::default();
        for &d in rings.iter().flatten() {
            if top.insert(void.target(d), void.origin(d)).is_some() || !left.insert(void.origin(d)) {
                return None;
            }
        }
        top.keys().all(|v| !left.contains(v)).then_some(Self { top })
    }
}

/// Makes a move. False, and nothing changes, if it is not legal.
pub(crate) fn make(void: &mut Void, the: &Move) -> bool {
    let mark = void.mark();
    let done = if the.closes { close(void, the) } else { layer(void, the) };
    if done.is_none() {
        void.take_back(mark);
    }
    done.is_some()
}

fn layer(void: &mut Void, the: &Move) -> Option<()> {
    let Rungs { mut top } = Rungs::of(void, &the.rings)?;
    let rim: FxHashSet<u32> = top.keys().copied().collect();
    let mut in_side = vec![false; void.quads.len()];
    the.side.iter().for_each(|&q| in_side[q as usize] = true);
    let mut in_ring = vec![false; void.quads.len()];
    the.rings.iter().flatten().for_each(|&d| in_ring[(d >> 2) as usize] = true);
    for &q in &the.side {
        let quad = void.quads[q as usize];
        for i in 0..4 {
            top.entry(quad[i]).or_insert_with(|| {
                void.n_vertices += 1;
                void.n_vertices - 1
            });
            let b = quad[(i + 1) & 3];
            // The copy of an edge across R between two vertices of the rim joins old vertices: it must be new.
            // The table would allow it where an older cell has this edge, and two fans of hexes would share it.
            if rim.contains(&quad[i]) && rim.contains(&b) {
                let d = 4 * q as usize + i;
                let inner = in_side[(void.twin[d] >> 2) as usize];
                if inner && (d as u32) < void.twin[d] && void.pairs.join(top[&quad[i]], top[&b]).is_some() {
                    return None;
                }
            }
        }
    }
    for &q in &the.side {
        let [a, b, c, d] = void.quads[q as usize];
        let hex = [top[&a], top[&b], top[&c], top[&d], a, b, c, d];
        if !void.push_hex(hex) {
            return None;
        }
    }
    let n = void.quads.len();
    // The front with the ring contracted: quads of R rise to their copies, those of L stay, and the ring's are gone,
    // so all other chords survive as they were.
    let (mut quads, mut wanted, mut length) =
        (Vec::with_capacity(n), Vec::with_capacity(4 * n), Vec::with_capacity(4 * n));
    let mut rim_wanted: FxHashMap<u32, f32> = FxHashMap::default();
    for &d in the.rings.iter().flatten() {
        let left = void.twin[prev(d) as usize];
        let right = void.twin[next(d) as usize];
        rim_wanted.insert(left, void.wanted[left as usize] - 1.0);
        rim_wanted.insert(right, void.wanted[left as usize] - 1.0);
    }
    for q in 0..n {
        if in_ring[q] {
            continue;
        }
        let quad = void.quads[q];
        quads.push(if in_side[q] { quad.map(|v| top[&v]) } else { quad });
        for d in 4 * q..4 * q + 4 {
            length.push(void.length[d]);
            wanted.push(match rim_wanted.get(&(d as u32)) {
                Some(&w) => w,
                None if in_side[q] => 2.0,
                None => void.wanted[d],
            });
        }
    }
    void.set_front(quads, wanted, length)
}

fn close(void: &mut Void, the: &Move) -> Option<()> {
    // Darts of R and the darts of L opposite them, which run the other way.
    let mut image: FxHashMap<u32, u32> = FxHashMap::default();
    let mut in_side = vec![false; void.quads.len()];
    the.side.iter().for_each(|&q| in_side[q as usize] = true);
    let mut in_ring = vec![false; void.quads.len()];
    the.rings.iter().flatten().for_each(|&d| in_ring[(d >> 2) as usize] = true);
    let mut work = Vec::new();
    for &d in the.rings.iter().flatten() {
        work.push((void.twin[next(d) as usize], void.twin[prev(d) as usize]));
    }
    let mut at: FxHashMap<u32, u32> = FxHashMap::default();
    while let Some((r, l)) = work.pop() {
        match image.insert(r, l) {
            Some(old) if old == l => continue,
            // Reached in two ways with two images: the sides are not mirror images.
            Some(_) => return None,
            None => {}
        }
        // Columns join these edges into one sheet, which has one multiplicity.
        if in_side[(l >> 2) as usize]
            || in_ring[(l >> 2) as usize]
            || void.length[r as usize] != void.length[l as usize]
        {
            return None;
        }
        match at.insert(void.origin(r), void.target(l)) {
            Some(old) if old != void.target(l) => return None,
            _ => {}
        }
        work.push((next(r), prev(l)));
        let (tr, tl) = (void.twin[r as usize], void.twin[l as usize]);
        if in_ring[(tr >> 2) as usize] != in_ring[(tl >> 2) as usize] {
            return None;
        }
        if !in_ring[(tr >> 2) as usize] {
            work.push((tr, tl));
        }
    }
    if image.len() != 4 * the.side.len() {
        return None;
    }
    let rim: FxHashMap<u32, u32> = Rungs::of(void, &the.rings)?.top;
    let mut hexes = Vec::with_capacity(the.side.len());
    for &q in &the.side {
        let [a, b, c, d] = void.quads[q as usize];
        let hex = [at[&a], at[&b], at[&c], at[&d], a, b, c, d];
        for v in [a, b, c, d] {
            // A vertical edge that is no rung is new.
            let is_new = !rim.contains_key(&v) && void.pairs.join(v, at[&v]).is_some_and(|join| join != Join::Edge);
            if is_new || v == at[&v] {
                return None;
            }
        }
        hexes.push(hex);
    }
    // Verticals first seen as edges of other cells would join two fans of hexes.
    let mut columns: Vec<[u32; 2]> =
        at.iter().filter(|(v, _)| !rim.contains_key(v)).map(|(&v, &w)| [v.min(w), v.max(w)]).collect();
    columns.sort_unstable();
    if columns.iter().any(|&[v, w]| void.pairs.join(v, w).is_some()) {
        return None;
    }
    if !hexes.into_iter().all(|hex| void.push_hex(hex)) {
        return None;
    }
    void.set_front(Vec::new(), Vec::new(), Vec::new())
}
