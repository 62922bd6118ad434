//! Offers: a region of the mesh grown from a seed, and a filling of its boundary that may take its place.
//!
//! The filling is proper inside, its boundary is the region's, and the vertex pairs of that boundary that it uses inside are
//! used by no hex outside: that is all of proper intersection, since two hexes that share two vertices without sharing the
//! edge or quad they span would use one pair twice (see `flip.rs`). So a proper mesh stays proper, and since ball replaces
//! ball, it stays what it was as a space.
//!
//! Source: Verhetsel et al. 2018 (abstract: groups of hexes get new interiors with fewer); that blocked pairs are all there is to check is ours.

use crate::atlas::Atlas;
use crate::ball::Ball;
use crate::canonical::Canonical;
use crate::cavity::{Cavity, MAX_VERTICES, Pairs};
use crate::grow::class_hash;
use crate::simplify::live::LiveMesh;
use crate::simplify::region::Region;
use hexfill_mesh::Random;
use rustc_hash::FxHashMap;

/// The sequence of one seed of a region.
pub(crate) fn sequence(seed: u64, stream: u64) -> Random {
    Random::new(Random::new(seed ^ stream.wrapping_mul(0xD129_0B26_88EA_5F4D)).next_u64())
}

/// A filling ready to be placed.
struct Filling {
    ball: Ball,
    code: Vec<u8>,
    /// Canonical number of each boundary vertex, under a flag that was mirrored or not.
    numbers: [u8; MAX_VERTICES],
    mirrored: bool,
}

/// Fillings kept from replay to replay; more are thrown away together.
const KEPT: usize = 8192;

/// Most hexes of a small region, less one.
const SMALL: usize = 10;

/// What may take a region's place.
pub(crate) struct Offer {
    /// The hexes that go.
    pub removed: Vec<u32>,
    /// The hexes that come, in mesh vertices; from `first_new` on new ones.
    pub added: Vec<[u32; 8]>,
    pub first_new: u32,
    /// Pairs of boundary vertices used inside, in mesh vertices.
    pub pairs: Vec<[u32; 2]>,
    /// Hexes saved; 0 for another filling of the same size.
    pub gain: i32,
}

/// How regions grow and what is accepted.
#[derive(Clone, Copy)]
pub(crate) struct Search {
    /// Most quads of a region that is looked up.
    pub max_quads: usize,
    /// Most quads of a region on the way.
    pub grow_quads: usize,
    /// Most hexes of a region.
    pub max_hexes: usize,
    /// Whether another filling of the same size is worth an offer.
    pub sideways: bool,
    /// The chance, in thousandths, that an offer may have one more hex than the region, then another one, and so on.
    pub heat: u32,
}

/// Everything one thread needs to make offers.
pub(crate) struct Worker<'a> {
    atlas: &'a Atlas,
    canonical: Canonical,
    region: Region,
    fillings: FxHashMap<u32, Option<Filling>>,
    /// Regions looked up.
    pub looked_up: u64,
}

impl<'a> Worker<'a> {
    pub(crate) fn new(atlas: &'a Atlas) -> Self {
        Self { atlas, canonical: Canonical::new(), region: Region::new(), fillings: FxHashMap::default(), looked_up: 0 }
    }

    /// Grows a region from `seed` and returns the best offer met on the way: the one that saves most hexes, the first such.
    pub(crate) fn offer(&mut self, mesh: &LiveMesh, seed: u32, search: &Search, random: &mut Random) -> Option<Offer> {
        let mut region = std::mem::replace(&mut self.region, Region::new());
        region.start(mesh, seed);
        let mut best: Option<Offer> = None;
        let wild = random.below(4);
        // Half of the regions of a walk stay small: moves are cheapest there.
        let small = search.sideways && random.below(2) == 0;
        let max_hexes = if small { (2 + random.below(SMALL)).min(search.max_hexes) } else { search.max_hexes };
        let mut least_gain = i32::from(!search.sideways);
        // Geometric: each further hex that may be added is as improbable as the last, so large steps up are rare and
        // never ruled out.
        while random.below(1000) < search.heat as usize {
            least_gain -= 1;
        }
        while region.hexes().len() < max_hexes {
            let chosen = {
                let candidates = region.candidates(mesh, search.grow_quads);
                if candidates.is_empty() {
                    break;
                }
                // Mostly the hex that shares most quads, so that the boundary stays small; by chance, now and then, any.
                let most = candidates.iter().map(|c| c.shared).max().unwrap_or(0);
                let any = random.below(16) < wild;
                let count = candidates.iter().filter(|c| any || c.shared == most).count();
                let pick = random.below(count);
                candidates.iter().filter(|c| any || c.shared == most).nth(pick).map(|c| c.hex)
            };
            let Some(hex) = chosen else { break };
            region.join(mesh, hex);
            if region.n_quads() <= search.max_quads {
                self.look_up(mesh, &mut region, least_gain, &mut best, random);
            }
        }
        self.region = region;
        best
    }

    /// Looks the region's boundary up; a better offer takes the place of `best`.
    fn look_up(
        &mut self,
        mesh: &LiveMesh,
        region: &mut Region,
        least_gain: i32,
        best: &mut Option<Offer>,
        random: &mut Random,
    ) {
        let Some((mut cavity, ids)) = region.cavity(mesh) else { return };
        self.looked_up += 1;
        self.canonical.compute(&cavity);
        let states = self.atlas.states_of(class_hash(self.canonical.code()));
        let size = region.hexes().len() as i32;
        let least_gain = best.as_ref().map_or(least_gain, |b| b.gain + 1);
        let mut is_blocked = false;
        let mut own: Option<Pairs> = None;
        for state in states {
            let gain = size - self.atlas.hexes_of(state) as i32;
            // States come with the fewest hexes first: nothing better follows.
            if gain < least_gain {
                break;
            }
            if !is_blocked {
                // Late, because most boundaries are not in the atlas with fewer hexes, and what lies outside takes a
                // walk round every vertex.
                region.block_outside(mesh, &mut cavity, &ids);
                is_blocked = true;
            }
            if self.fillings.len() >= KEPT {
                self.fillings.clear();
            }
            let atlas = self.atlas;
            let filling = self.fillings.entry(state).or_insert_with(|| replayed(atlas, state));
            let Some(filling) = filling.as_ref().filter(|f| f.code == self.canonical.code()) else { continue };
            let flags = self.canonical.flags();
            // Of fillings of the same size any may lead on; where hexes are saved the first way round will do.
            let first = if gain > 0 { 0 } else { random.below(flags.len()) };
            for i in 0..flags.len() {
                let flag = flags[(first + i) % flags.len()];
                let map = map_onto(filling, &Canonical::vertex_numbers(&cavity, flag), cavity.n_vertices());
                let used = image(&filling.ball.boundary, &map);
                if used.iter().zip(&cavity.blocked).any(|(a, b)| a & b != 0) {
                    continue;
                }
                // The same pairs inside are as a rule the same filling again, and no step.
                if gain <= 0 && used == *own.get_or_insert_with(|| inside_pairs(mesh, region, &cavity, &ids)) {
                    continue;
                }
                let mirrored = filling.mirrored != flag.mirrored;
                let boundary: Vec<u32> = map.iter().map(|&v| ids[usize::from(v)]).collect();
                let first_new = mesh.n_vertex_slots() as u32;
                let (added, _) = filling.ball.hexes_in(&boundary, mirrored, first_new);
                let mut pairs = Vec::new();
                for (a, &row) in used.iter().enumerate().take(ids.len()) {
                    // Each pair once: its larger end is above the smaller.
                    let mut row = row >> a >> 1 << 1 << a;
                    while row != 0 {
                        pairs.push([ids[a], ids[row.trailing_zeros() as usize]]);
                        row &= row - 1;
                    }
                }
                *best = Some(Offer { removed: region.hexes().to_vec(), added, first_new, pairs, gain });
                return;
            }
        }
    }
}

fn replayed(atlas: &Atlas, state: u32) -> Option<Filling> {
    let ball = Ball::replay(atlas.flips_to(state))?;
    let mut canonical = Canonical::new();
    canonical.compute(&ball.boundary);
    let flag = canonical.flags()[0];
    Some(Filling {
        code: canonical.code().to_vec(),
        numbers: Canonical::vertex_numbers(&ball.boundary, flag),
        mirrored: flag.mirrored,
        ball,
    })
}

/// The cavity vertex of each boundary vertex of the filling, if both are numbered alike.
fn map_onto(filling: &Filling, numbers: &[u8; MAX_VERTICES], n: usize) -> Vec<u8> {
    let mut vertex = [0u8; MAX_VERTICES];
    for v in 0..n {
        vertex[usize::from(numbers[v])] = v as u8;
    }
    (0..n).map(|v| vertex[usize::from(filling.numbers[v])]).collect()
}

/// The blocked pairs of `boundary` in other vertex numbers.
fn image(boundary: &Cavity, map: &[u8]) -> Pairs {
    let mut pairs = [0; MAX_VERTICES];
    for (v, &to) in map.iter().enumerate() {
        let mut row = boundary.blocked[v];
        while row != 0 {
            pairs[usize::from(to)] |= 1 << map[row.trailing_zeros() as usize];
            row &= row - 1;
        }
    }
    pairs
}

/// The pairs of boundary vertices that the region itself uses inside.
fn inside_pairs(mesh: &LiveMesh, region: &Region, cavity: &Cavity, ids: &[u32]) -> Pairs {
    let surface = cavity.surface_pairs();
    let mut pairs = [0; MAX_VERTICES];
    for &hex in region.hexes() {
        let mut all = 0u64;
        for v in mesh.hex(hex) {
            if let Some(i) = ids.iter().position(|id| id == v) {
                all |= 1 << i;
            }
        }
        let mut rest = all;
        while rest != 0 {
            let a = rest.trailing_zeros() as usize;
            // Two corners of one hex are joined by something of that hex: an edge, a diagonal or a body diagonal.
            // What the surface has as well is not inside.
            pairs[a] |= all & !(1 << a) & !surface[a];
            rest &= rest - 1;
        }
    }
    pairs
}
