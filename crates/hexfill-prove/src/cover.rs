//! Every hex that can cover an open quad: its four far vertices are old ones or new, each pair allowed by the pair table.
//!
//! New vertices are interchangeable, so only the next unused id is tried. Under a symmetry a new vertex comes with its whole orbit, one
//! try for each stabilizer it may have; the other vertices of the orbit are then old ones for the corners still to be chosen.
//!
//! Source: ours; hexes whose vertices are chosen from the boundary inward are the search of Verhetsel et al. 2018.

use crate::corners::{DISTANCE, HULL};
use crate::mirror::{Mirror, Sides};
use crate::state::{Hex, MAX_VERTICES, State};
use crate::symmetry::{Action, MAX_ORDER, NewOrbit};

/// The corners above the covered quad, in the order they are chosen.
const FAR: [usize; 4] = [4, 7, 6, 5];
const NEAR: [usize; 4] = [0, 3, 2, 1];
const BLANK: u128 = 1 << (MAX_VERTICES - 1);

/// Per far corner number the set of corners chosen then.
const CHOSEN: [u8; 4] = [0b0001_1111, 0b1001_1111, 0b1101_1111, 0b1111_1111];

/// A hex that can cover a quad, and the orbits of new vertices it brings (one vertex each without symmetry).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cover {
    pub hex: Hex,
    orbits: [NewOrbit; 4],
    n_orbits: u8,
}

impl Cover {
    /// The orbits of new vertices, in the order of their ids.
    pub(crate) fn new_orbits(&self) -> &[NewOrbit] {
        &self.orbits[..usize::from(self.n_orbits)]
    }
}

/// What a cover may bring.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Allowance {
    /// Most new vertices.
    pub new_vertices: i32,
    /// Most new edges less new vertices, of the hex and its images.
    pub excess: i32,
    /// Most hexes: the hex and its images.
    pub hexes: i32,
}

/// The vertices that may stand at each far corner, in the order of [`FAR`]. Of vertices not made yet all bits or none are set, except that
/// the image of one made for this hex may be asked for.
type Domains = [u128; 4];

/// The search for covers of one quad.
struct Search<'a, F> {
    state: &'a State,
    action: &'a mut Action,
    allowance: Allowance,
    cover: Cover,
    /// Place in the hex of each vertex that has one, plus 1.
    place: [u8; MAX_VERTICES],
    /// Number of vertices with those made for this hex.
    n: usize,
    coloured: u128,
    /// Elements that keep the quad, but the identity: they keep the hex. Where they carry each far corner.
    keeping: u64,
    carried: [[u8; 4]; MAX_ORDER],
    /// Per far corner the elements that fix its vertex, and those that do not.
    fixing: [u64; 4],
    moving: [u64; 4],
    /// Mirrors that do not keep the hex: it lies on this side of them. Then those that keep it.
    one_sided: Sides,
    crossed: u64,
    /// Per far corner chosen and mirror: the corners chosen that are on the mirror.
    on_mirror: [[u8; MAX_ORDER]; 5],
    /// Per far corner chosen and element: the corners chosen whose vertices are also in that image of the hex.
    shared: [[u8; MAX_ORDER]; 5],
    /// Least number of new edges so far, those of the images too.
    fresh: i32,
    visit: F,
}

/// Calls `visit` for each hex that can cover the open quad, until it says `false`. The action's images of vertices not made yet change.
pub(crate) fn covers<F: FnMut(&Cover) -> bool>(
    state: &State,
    action: &mut Action,
    q: u16,
    allowance: Allowance,
    visit: F,
) {
    let mut hex = [0; 8];
    for (i, v) in NEAR.into_iter().zip(state.quad(q)) {
        hex[i] = v;
    }
    let mut search = Search {
        state,
        action,
        allowance,
        cover: Cover { hex, orbits: [NewOrbit::default(); 4], n_orbits: 0 },
        place: [0; MAX_VERTICES],
        n: state.n(),
        coloured: state.coloured,
        keeping: 0,
        carried: [[0; 4]; MAX_ORDER],
        fixing: [0; 4],
        moving: [0; 4],
        one_sided: Sides::default(),
        crossed: 0,
        on_mirror: [[0; MAX_ORDER]; 5],
        shared: [[0; MAX_ORDER]; 5],
        fresh: 0,
        visit,
    };
    // Numbered from 1: 0 says that a vertex is no corner of this hex.
    for i in NEAR {
        search.place[usize::from(hex[i])] = i as u8 + 1;
    }
    let domains = search.first_domains(q);
    // Without symmetry nothing has to agree with its images, and the tables for it stay untouched.
    if search.action.order() == 1 {
        search.choose(0, domains);
    } else {
        search.meet_near();
        let domains = search.keep(domains);
        search.see_mirror(0, domains);
    }
}

impl<F: FnMut(&Cover) -> bool> Search<'_, F> {
    /// The vertices that the pair table and the colours allow at each far corner, the covered quad being all that is known.
    fn first_domains(&self, q: u16) -> Domains {
        let quad = self.state.quad(q);
        let unmade = !self.made();
        // Side k of the quad runs from its corner k to k + 1; on it stands a facet of the hex, which is new or one open quad there.
        let glued: [(u128, u128); 4] = std::array::from_fn(|k| self.state.beyond(4 * q + k as u16));
        std::array::from_fn(|k| {
            let [below, next, opposite, before] = std::array::from_fn(|i| quad[(k + i) % 4]);
            // A ball's mesh is bipartite as its boundary is, so a corner's colour follows from its distance to the quad:
            // half of the vertices are out at once.
            let colour = if self.state.coloured >> below & 1 == 1 { !self.coloured } else { self.coloured };
            self.state.live()
                & (colour | unmade)
                & self.state.edge_row(below)
                & (self.state.body_row(next) | glued[k].0)
                & (self.state.body_row(before) | glued[(k + 3) % 4].1)
                & self.state.body_row(opposite)
        })
    }

    /// Vertices made before this hex.
    fn made(&self) -> u128 {
        (1 << self.state.n()) - 1
    }

    /// The least that is known of the images of the hex: what they share with the covered quad.
    fn meet_near(&mut self) {
        for i in NEAR {
            let v = self.cover.hex[i];
            for (k, mirror) in self.action.mirrors().iter().enumerate() {
                self.on_mirror[0][k] |= ((self.action.fixers(v) >> mirror.element & 1) as u8) << i;
            }
            for &g in self.action.others() {
                let here = self.place[usize::from(self.action.image(usize::from(g), v))] > 0;
                self.shared[0][usize::from(g)] |= u8::from(here) << i;
            }
        }
    }

    /// An element that keeps the covered quad keeps the hex, since the quad is open to one hex alone. So it carries far corners as it
    /// carries those below.
    fn keep(&mut self, mut domains: Domains) -> Domains {
        let unmade = !self.made();
        for g in 1..self.action.order() {
            let images = NEAR.map(|i| self.action.image(g, self.cover.hex[i]));
            let to = images.map(|v| NEAR.iter().position(|&i| self.cover.hex[i] == v));
            if to.contains(&None) {
                continue;
            }
            self.keeping |= 1 << g;
            self.carried[g] = to.map(|d| d.unwrap_or(0) as u8);
            for (d, domain) in domains.iter_mut().enumerate() {
                if usize::from(self.carried[g][d]) == d {
                    self.fixing[d] |= 1 << g;
                    *domain &= self.action.fixed(g) | unmade;
                } else {
                    self.moving[d] |= 1 << g;
                    *domain &= !self.action.fixed(g) | unmade;
                }
            }
        }
        domains
    }

    /// Mirror number `k` and all after it: the hex lies on one side of a mirror, or the mirror keeps it. (A hex that a mirror does not
    /// keep has no inner point on the mirror: the image would have it too.) `false` ends the search.
    fn see_mirror(&mut self, k: usize, domains: Domains) -> bool {
        let Some(&Mirror { element, sides }) = self.action.mirrors().get(k) else {
            return !self.few_enough() || self.choose(0, domains);
        };
        let bit = 1 << k;
        if self.keeping >> element & 1 == 1 {
            self.crossed |= bit;
            let go_on = self.see_mirror(k + 1, domains);
            self.crossed &= !bit;
            return go_on;
        }
        let near = NEAR.iter().fold(0u128, |set, &i| set | 1 << self.cover.hex[i]);
        // A quad on a mirror lies between a hex and its image, so it is not open.
        debug_assert!(near & (sides[0] | sides[1]) != 0);
        let second = near & sides[1] != 0;
        if second && near & sides[0] != 0 {
            // A quad through a mirror is kept by it.
            return true;
        }
        // First the hexes on one side of the mirror: their corners are on that side or on the mirror. Then those that
        // the mirror keeps.
        let beyond = sides[usize::from(!second)] & self.made();
        let one_sided = self.one_sided;
        self.one_sided.add(k, second);
        let go_on = self.see_mirror(k + 1, domains.map(|d| d & !beyond));
        self.one_sided = one_sided;
        if !go_on {
            return false;
        }
        let Some((domains, fixing)) = self.through_mirror(element, domains) else { return true };
        let before = self.fixing;
        fixing.iter().zip(&mut self.fixing).for_each(|(&on, set)| *set |= u64::from(on) << element);
        self.crossed |= bit;
        let go_on = self.see_mirror(k + 1, domains);
        self.crossed &= !bit;
        self.fixing = before;
        go_on
    }

    /// What is left if a mirror that does not keep the quad keeps the hex: it carries the quad to the opposite facet, or to one at an edge
    /// on the mirror, and then the other two vertices above are on the mirror. With it, which far corners are on the mirror.
    fn through_mirror(&self, g: usize, mut domains: Domains) -> Option<(Domains, [bool; 4])> {
        let near = NEAR.map(|i| self.cover.hex[i]);
        let on = near.map(|v| self.action.fixers(v) >> g & 1 == 1);
        let image = |d: usize| 1u128 << self.action.image(g, near[d]);
        match on.iter().filter(|&&on| on).count() {
            0 => (0..4).for_each(|d| domains[d] &= image(d)),
            2 => {
                let first = (0..4).find(|&d| on[d] && on[(d + 1) % 4])?;
                domains[first] &= image((first + 3) % 4);
                domains[(first + 1) % 4] &= image((first + 2) % 4);
                for d in [(first + 2) % 4, (first + 3) % 4] {
                    domains[d] &= self.action.fixed(g) | !self.made();
                }
                return domains.iter().all(|&d| d != 0).then_some((domains, on.map(|on| !on)));
            }
            _ => return None,
        }
        domains.iter().all(|&d| d != 0).then_some((domains, [false; 4]))
    }

    /// Whether the hex and its images may be few enough.
    fn few_enough(&self) -> bool {
        let order = self.action.order() as i32;
        // Elements that are no products of these mirrors may keep the hex too.
        order <= self.allowance.hexes
            || !self.action.others().is_empty()
            || order >> self.crossed.count_ones() <= self.allowance.hexes
    }

    /// Chooses far vertex number `depth` and all after it. `false` ends the search.
    fn choose(&mut self, depth: usize, domains: Domains) -> bool {
        if depth == 4 {
            return self.state.glue(&self.cover.hex).is_none() || (self.visit)(&self.cover);
        }
        let mut set = domains[depth];
        // Elements whose image of the hex must share this corner too.
        let sharing = if depth == 3 { self.restrict_last(&mut set) } else { 0 };
        let mut old = set & ((1 << self.n) - 1);
        while old != 0 {
            let v = old.trailing_zeros() as u8;
            old &= old - 1;
            if (usize::from(v) < self.state.n() || self.new_fits(depth, v)) && !self.put(depth, v, &domains) {
                return false;
            }
        }
        if set & BLANK == 0 {
            return true;
        }
        let (n, coloured) = (self.n, self.coloured);
        for s in 0..self.action.n_stabilizers() {
            let members = self.action.stabilizer(s);
            // An image that must have this corner too has it only if it fixes the new vertex.
            if (sharing | self.fixing[depth]) & !members != 0 || self.moving[depth] & members != 0 {
                continue;
            }
            let size = self.action.orbit_size(s);
            let made = (n + size) as i32 - self.state.counts.vertices;
            // More vertices than Euler's formula and the hexes left allow: no completion exists.
            if made > self.allowance.new_vertices || n + size >= MAX_VERTICES {
                continue;
            }
            let orbit = NewOrbit { stabilizer: s as u8, sides: self.sides_of_new(depth, members) };
            let below_coloured = self.state.coloured >> self.cover.hex[NEAR[depth]] & 1 == 1;
            let mut colours = coloured;
            self.action.extend(n, orbit, |i, other| {
                let bit = 1 << (n + i);
                colours = if below_coloured == other { colours | bit } else { colours & !bit };
            });
            (self.n, self.coloured) = (n + size, colours);
            self.cover.orbits[usize::from(self.cover.n_orbits)] = orbit;
            self.cover.n_orbits += 1;
            let go_on = self.put(depth, n as u8, &domains);
            self.cover.n_orbits -= 1;
            (self.n, self.coloured) = (n, coloured);
            if !go_on {
                return false;
            }
        }
        true
    }

    /// On which side of each mirror a new vertex at a far corner lies.
    fn sides_of_new(&self, depth: usize, members: u64) -> Sides {
        let below = self.cover.hex[NEAR[depth]];
        let mut out = Sides::default();
        for (k, mirror) in self.action.mirrors().iter().enumerate() {
            if members >> mirror.element & 1 == 1 {
                continue;
            }
            // The edge up from the quad does not cross the mirror: a mirror that keeps quad and hex carries it to another one.
            match self.one_sided.of(k) {
                Some(second) => out.add(k, second),
                None => out.add(k, mirror.sides[1] >> below & 1 == 1),
            }
        }
        out
    }

    /// Whether a vertex made for this hex, or an image of it, may stand at a far corner too.
    fn new_fits(&self, depth: usize, v: u8) -> bool {
        let fixers = self.action.fixers(v);
        let below_coloured = self.state.coloured >> self.cover.hex[NEAR[depth]] & 1 == 1;
        let one_sided = |(k, mirror): (usize, &Mirror)| {
            self.one_sided.of(k).is_none_or(|second| mirror.sides[usize::from(!second)] >> v & 1 == 0)
        };
        below_coloured != (self.coloured >> v & 1 == 1)
            && self.fixing[depth] & !fixers == 0
            && self.moving[depth] & fixers == 0
            && self.action.mirrors().iter().enumerate().all(one_sided)
    }

    /// What symmetry leaves for the last corner: takes the rest out of `set`, and returns the elements that must fix a new vertex there.
    fn restrict_last(&self, set: &mut u128) -> u64 {
        let p = FAR[3];
        let mut sharing = 0;
        for (k, mirror) in self.action.mirrors().iter().enumerate() {
            // A hex on one side of a mirror meets its image in what is on the mirror: nothing, a vertex, an edge or a facet.
            let on = self.on_mirror[3][k];
            if self.crossed >> k & 1 == 0 && HULL[usize::from(on)] & !on & 1 << p != 0 {
                sharing |= 1 << mirror.element;
                *set &= self.action.fixed(mirror.element) | !((1u128 << self.n) - 1);
            }
        }
        for &g in self.action.others() {
            let g = usize::from(g);
            let shared = self.shared[3][g];
            let missing = HULL[usize::from(shared)] & !shared;
            let others = missing & !(1 << p);
            if others != 0 {
                // The corner missed must have its image here.
                *set &= 1 << self.action.image(g, self.cover.hex[others.trailing_zeros() as usize]);
            }
            if missing >> p & 1 == 1 {
                sharing |= 1 << g;
                let back = self.action.inverse(g);
                let mut images = !((1u128 << self.n) - 1);
                for o in Self::chosen(2) {
                    images |= 1 << self.action.image(back, self.cover.hex[o]);
                }
                *set &= images | self.action.fixed(g);
            }
        }
        sharing
    }

    /// Puts a vertex at far corner number `depth` and goes on.
    fn put(&mut self, depth: usize, v: u8, domains: &Domains) -> bool {
        self.cover.hex[FAR[depth]] = v;
        let Some(domains) = self.narrow(depth, v, domains) else { return true };
        let fresh = self.fresh;
        if !self.edges_fit(depth) {
            self.fresh = fresh;
            return true;
        }
        self.place[usize::from(v)] = FAR[depth] as u8 + 1;
        let go_on = !self.agrees(depth) || self.choose(depth + 1, domains);
        self.place[usize::from(v)] = 0;
        self.fresh = fresh;
        go_on
    }

    /// What a vertex at far corner number `depth` leaves for the later ones; `None` if nothing for one of them.
    fn narrow(&self, depth: usize, v: u8, domains: &Domains) -> Option<Domains> {
        let mut out = *domains;
        if depth == 3 {
            return Some(out);
        }
        // The same rule as for a finished hex, asked as soon as two of its far corners are known: a pair on one facet
        // is free, or belongs to an open quad that is this very facet and so names its fourth corner.
        let near = NEAR.map(|i| self.cover.hex[i]);
        let free = self.state.body_row(v);
        // The facets on two sides of the quad: new, or an open quad that has both diagonals.
        for e in [(depth + 1) % 4, (depth + 3) % 4] {
            if e > depth {
                out[e] &= self.state.edge_row(v);
                out[e] &= match free >> near[e] & 1 {
                    1 => self.state.body_row(near[depth]),
                    _ => self.state.fourth(near[e], v) & !(1 << near[depth]) & !(1 << near[e]) & !(1 << v),
                };
            }
        }
        // The facet opposite to the quad likewise.
        match depth {
            0 => out[2] &= self.state.diagonal_row(v),
            1 => out[3] &= self.state.diagonal_row(v),
            _ => {
                let [first, second] = [self.cover.hex[FAR[0]], self.cover.hex[FAR[1]]];
                if free >> first & 1 == 1 {
                    out[3] &= self.state.body_row(second);
                } else {
                    let quad = self.state.fourth(first, v);
                    if quad >> second & 1 == 0 {
                        return None;
                    }
                    out[3] &= quad & !(1 << first) & !(1 << second) & !(1 << v);
                }
            }
        }
        // A symmetry that keeps the hex carries chosen corners to chosen corners.
        let mut keeping = self.keeping;
        while keeping != 0 {
            let g = keeping.trailing_zeros() as usize;
            keeping &= keeping - 1;
            let e = usize::from(self.carried[g][depth]);
            if e > depth {
                out[e] &= 1 << self.action.image(g, v);
            }
        }
        out[depth + 1..].iter().all(|&d| d != 0).then_some(out)
    }

    /// Corners chosen up to far corner number `depth`.
    fn chosen(depth: usize) -> impl Iterator<Item = usize> {
        NEAR.into_iter().chain(FAR.into_iter().take(depth + 1))
    }

    /// Whether the hex so far and each of its images can share nothing, a vertex, an edge, a facet or all of it, and agree there.
    fn agrees(&mut self, depth: usize) -> bool {
        if self.action.order() == 1 {
            return true;
        }
        let (p, order) = (FAR[depth], self.action.order());
        let v = self.cover.hex[p];
        let fixers = self.action.fixers(v);
        let chosen = CHOSEN[depth];
        for (k, mirror) in self.action.mirrors().iter().enumerate() {
            let on = self.on_mirror[depth][k] | ((fixers >> mirror.element & 1) as u8) << p;
            self.on_mirror[depth + 1][k] = on;
            if self.crossed >> k & 1 == 0 && HULL[usize::from(on)] & !on & chosen != 0 {
                return false;
            }
        }
        if self.action.others().is_empty() {
            return true;
        }
        let (before, after) = self.shared.split_at_mut(depth + 1);
        let shared = &mut after[0];
        shared[..order].copy_from_slice(&before[depth][..order]);
        // A corner that an image has as well is a shared vertex, and distances in the cube between shared ones must
        // be the same in both: then what is shared is a vertex, an edge, a facet or the hex, or can still become so.
        for &g in self.action.others() {
            let g = usize::from(g);
            let at = usize::from(self.place[usize::from(self.action.image(g, v))]);
            if at == 0 {
                continue;
            }
            shared[g] |= 1 << p;
            shared[self.action.inverse(g)] |= 1 << (at - 1);
            for o in Self::chosen(depth) {
                let other = usize::from(self.place[usize::from(self.action.image(g, self.cover.hex[o]))]);
                if other > 0 && DISTANCE[at - 1][other - 1] != DISTANCE[p][o] {
                    return false;
                }
            }
        }
        // What is missing to a face of the cube can only come with the corners still to be chosen.
        self.action.others().iter().all(|&g| {
            let set = shared[usize::from(g)];
            (HULL[usize::from(set)] & !set & chosen).count_ones() as usize <= 3 - depth
        })
    }

    /// Counts the new edges at far corner number `depth`. `false` if those of the hex and its images are too many: the edges still to come
    /// outnumber the vertices still to come.
    fn edges_fit(&mut self, depth: usize) -> bool {
        let v = self.cover.hex[FAR[depth]];
        let fixers = self.action.fixers(v);
        let (order, alone) = (self.action.order() as i32, !self.action.others().is_empty());
        let free = self.state.body_row(v);
        let mut add = |o: u8| {
            if free >> o & 1 == 1 {
                // An edge has as many images as elements, over those that fix both ends. Two edges of the hex are images of one
                // another only by elements that keep the hex. With elements that are no products of mirrors only
                // the hex's own are counted.
                let same = (fixers & self.action.fixers(o)).count_ones() as i32;
                self.fresh += if alone { 1 } else { order / same };
            }
        };
        add(self.cover.hex[NEAR[depth]]);
        if depth > 0 {
            add(self.cover.hex[FAR[depth - 1]]);
        }
        if depth == 3 {
            add(self.cover.hex[FAR[0]]);
        }
        let most = self.allowance.excess + self.n as i32 - self.state.counts.vertices;
        let times = if alone { 0 } else { self.crossed.count_ones() };
        self.fresh <= most << times
    }
}
