//! The search tree: take the open quad that the fewest hexes can cover, try each of them with its images, go on.
//!
//! Every finished mesh covers that quad by exactly one of the hexes, so the children of a node divide the finished meshes among them:
//! each mesh (its interior vertices unnamed) is met once. Nothing is random, and nothing depends on what was searched before.
//!
//! Source: the choice of what has fewest ways is the usual one of exact cover (Knuth 2000); what is covered is ours.

use crate::bound::{euler_rest, most_new_vertices};
use crate::cover::{Allowance, Cover, covers};
use crate::orbit::place_orbit;
use crate::state::{Hex, MAX_QUADS, State};
use crate::symmetry::Action;
use hexfill_mesh::{Context, StopReason};

/// How often the context is asked whether to stop.
const NODES_BETWEEN_STOPS: u64 = 1 << 12;

/// What a walk met.
#[derive(Clone, Debug, Default)]
pub(crate) struct Walked {
    /// States visited.
    pub nodes: u64,
    /// Sum over them of a hash of the hexes on the way there.
    pub tree_sum: u128,
    /// Finished meshes.
    pub found: Vec<Vec<Hex>>,
}

/// A state and what is needed to walk on from it.
#[derive(Clone)]
pub(crate) struct Walker {
    state: State,
    action: Action,
    /// Per quad met whether it stands for its images.
    stands: Vec<bool>,
    max_hexes: i32,
    /// Per quad how many covers were counted last, a guess for the next time.
    last_count: Vec<u32>,
    pub(crate) walked: Walked,
}

/// Where a walk is.
#[derive(Clone, Copy)]
struct Place {
    moment: crate::state::Moment,
    stands: usize,
}

impl Walker {
    pub(crate) fn new(state: State, action: Action, max_hexes: usize) -> Self {
        let n = state.n_quads_met() as u16;
        let sorted = |q: u16, g: usize| {
            let mut image = state.quad(q).map(|v| action.image(g, v));
            image.sort_unstable();
            image
        };
        let stands =
            (0..n).map(|q| (0..q).all(|p| (1..action.order()).all(|g| sorted(p, g) != sorted(q, 0)))).collect();
        Self {
            state,
            action,
            stands,
            max_hexes: max_hexes as i32,
            last_count: vec![8; MAX_QUADS],
            walked: Walked::default(),
        }
    }

    /// The hexes placed.
    pub(crate) fn hexes(&self) -> &[Hex] {
        &self.state.hexes
    }

    /// Whether no quad is open.
    pub(crate) fn is_finished(&self) -> bool {
        self.state.counts.open == 0
    }

    fn now(&self) -> Place {
        Place { moment: self.state.now(), stands: self.stands.len() }
    }

    fn undo(&mut self, to: Place) {
        self.state.undo(&to.moment);
        self.stands.truncate(to.stands);
    }

    /// Places a cover with its images; `false` if they do not fit (the state must be undone).
    pub(crate) fn place(&mut self, cover: &Cover) -> bool {
        let Some(made) = place_orbit(&mut self.state, &mut self.action, cover) else { return false };
        let first = self.stands.len();
        self.stands.resize(first + made, true);
        self.stands.resize(self.state.n_quads_met(), false);
        self.state.counts.hexes <= self.max_hexes
    }

    /// The hexes that can cover the most constrained open quad; none if the state cannot be finished.
    fn branches(&mut self) -> Vec<Cover> {
        let left = self.max_hexes - self.state.counts.hexes;
        let Some(new_vertices) = most_new_vertices(&self.state, left) else { return Vec::new() };
        let allowance = Allowance { new_vertices, excess: 2 * left + euler_rest(&self.state), hexes: left };
        // Those that had few covers before first: the fewer are known, the sooner counting stops. Of equal ones the oldest quad is
        // taken, so that the choice does not depend on the order.
        let mut quads: Vec<u16> = self.state.open_quads().filter(|&q| self.stands[usize::from(q)]).collect();
        quads.sort_by_key(|&q| self.last_count[usize::from(q)]);
        let mut best = None;
        let mut fewest = usize::MAX;
        for q in quads {
            let mut count = 0;
            covers(&self.state, &mut self.action, q, allowance, |_| {
                count += 1;
                count <= fewest
            });
            self.last_count[usize::from(q)] = count as u32;
            // Nothing covers this quad: no mesh lies below, whatever else is open.
            if count == 0 {
                return Vec::new();
            }
            if count < fewest || count == fewest && best.is_some_and(|b| q < b) {
                (best, fewest) = (Some(q), count);
            }
        }
        let mut out = Vec::with_capacity(fewest);
        if let Some(q) = best {
            covers(&self.state, &mut self.action, q, allowance, |cover| {
                out.push(*cover);
                true
            });
        }
        out
    }

    /// The covers that lead on from here and fit.
    pub(crate) fn children(&mut self) -> Vec<Cover> {
        let mut branches = self.branches();
        branches.retain(|cover| {
            let here = self.now();
            let fits = self.place(cover);
            self.undo(here);
            fits
        });
        branches
    }

    /// Visits this state and all below it. `path` is the hash of the hexes on the way.
    ///
    /// # Errors
    /// The reason to stop, if the context says so.
    pub(crate) fn descend(&mut self, path: u64, ctx: &Context<'_>) -> Result<(), StopReason> {
        self.walked.nodes += 1;
        // A sum, so that any division of the tree adds up to the same number: runs that agree in it have visited the
        // same states.
        self.walked.tree_sum = self.walked.tree_sum.wrapping_add(u128::from(mix(path)));
        if self.walked.nodes.is_multiple_of(NODES_BETWEEN_STOPS)
            && let Some(reason) = ctx.stop()
        {
            return Err(reason);
        }
        if self.is_finished() {
            self.walked.found.push(self.state.hexes.clone());
            return Ok(());
        }
        for cover in self.branches() {
            let here = self.now();
            if self.place(&cover) {
                self.descend(step(path, &cover), ctx)?;
            }
            self.undo(here);
        }
        Ok(())
    }
}

/// The hash of a longer way.
pub(crate) fn step(path: u64, cover: &Cover) -> u64 {
    mix(path ^ u64::from_le_bytes(cover.hex))
}

/// The finalizer of splitmix64 (Steele, Lea, Flood 2014).
fn mix(x: u64) -> u64 {
    let x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::symmetry::{Subgroup, Symmetries};
    use hexfill_mesh::cube::POSITIONS;
    use hexfill_mesh::{HexAutomorphism, HexMesh, QuadSurface, hex_automorphisms, parse_surface_signature};
    use hexfill_search::{Atlas, FillOptions, fill_from_atlas};

    /// The 48 ways a cube lies on itself.
    fn turns() -> Vec<[usize; 8]> {
        let axes = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
        let turned = |axes: [usize; 3], flip: usize| {
            std::array::from_fn(|k| {
                let at: [u8; 3] = std::array::from_fn(|i| POSITIONS[k][axes[i]] ^ (flip >> i & 1) as u8);
                POSITIONS.iter().position(|p| *p == at).unwrap()
            })
        };
        axes.into_iter().flat_map(|a| (0..8).map(move |flip| turned(a, flip))).collect()
    }

    /// Whether the tree has a branch at every node along a mesh that has the group's symmetries, and one of the branches is the mesh's own
    /// hex with its images. `Err` says where it ends.
    fn follow(surface: &QuadSurface, mesh: &HexMesh, group: Subgroup, more: usize) -> Result<(), String> {
        let action = Action::new(&Symmetries::of(surface).unwrap(), group);
        let n = surface.n_vertices();
        let automorphisms = hex_automorphisms(mesh).unwrap();
        // Per element of the group what it does with the mesh's vertices.
        let images: Vec<Vec<u32>> = (0..action.order())
            .map(|g| {
                let is = |a: &&HexAutomorphism| (0..n).all(|v| a.vertices[v].0 == u32::from(action.image(g, v as u8)));
                automorphisms.iter().find(is).unwrap().vertices.iter().map(|v| v.0).collect()
            })
            .collect();
        let mut walker = Walker::new(State::new(surface).unwrap(), action, mesh.n_hexes() + more);
        let hexes = mesh.hexes_raw();
        // Per vertex of the state, the vertex of the mesh.
        let mut vertex: Vec<u32> = (0..n as u32).collect();
        while !walker.is_finished() {
            let here = walker.now();
            let mut next = None;
            for cover in walker.branches() {
                for (hex, turn) in hexes.iter().flat_map(|hex| turns().into_iter().map(move |turn| (hex, turn))) {
                    let fits = (0..8).all(|k| match vertex.get(usize::from(cover.hex[k])) {
                        Some(&v) => v == hex[turn[k]],
                        None => !vertex.contains(&hex[turn[k]]),
                    });
                    if fits && walker.place(&cover) {
                        next = extended(&vertex, &walker, &images, &cover.hex, &turn.map(|k| hex[k]));
                    }
                    if next.is_some() {
                        break;
                    }
                    walker.undo(here);
                }
                if next.is_some() {
                    break;
                }
            }
            vertex = next.ok_or_else(|| format!("after {} hexes", walker.hexes().len()))?;
        }
        assert_eq!(walker.hexes().len(), mesh.n_hexes());
        Ok(())
    }

    /// The mesh's vertices for those just made; `None` if the group does not act on them as it does on the mesh's.
    fn extended(
        vertex: &[u32],
        walker: &Walker,
        images: &[Vec<u32>],
        hex: &Hex,
        of_mesh: &[u32; 8],
    ) -> Option<Vec<u32>> {
        let mut out: Vec<Option<u32>> = vertex.iter().map(|&v| Some(v)).collect();
        out.resize(walker.state.n(), None);
        for (&v, &w) in hex.iter().zip(of_mesh) {
            for (g, image) in images.iter().enumerate() {
                let (v, w) = (usize::from(walker.action.image(g, v)), image[w as usize]);
                if *out[v].get_or_insert(w) != w {
                    return None;
                }
            }
        }
        let out: Option<Vec<u32>> = out.into_iter().collect();
        out.filter(|out| (0..out.len()).all(|i| !out[..i].contains(&out[i])))
    }

    /// The subgroups of the boundary's automorphisms that a mesh has.
    fn groups(surface: &QuadSurface, mesh: &HexMesh) -> Vec<Subgroup> {
        let symmetries = Symmetries::of(surface).unwrap();
        let image = |a: &HexAutomorphism| (0..surface.n_vertices()).map(|v| a.vertices[v].0 as u8).collect();
        let own: Vec<Vec<u8>> = hex_automorphisms(mesh).unwrap().iter().map(image).collect();
        let own = symmetries.generated_by(&own).unwrap();
        symmetries.subgroups().into_iter().filter(|s| s & !own == 0).collect()
    }

    /// The bounds and the choice of covers cut no way to a mesh that exists, under any of its symmetries.
    #[test]
    fn the_way_to_a_known_mesh_is_never_cut() {
        // The spindle, the pyramid, the geode, the buffer cube of 22 quads, and one hex more than there are.
        let mut orders = Vec::new();
        for (signature, more) in [
            ("Q1:00101005101312", 0),
            ("Q1:000000070017100700171605141317", 0),
            ("Q1:000000070017100700171605141317", 1),
            ("Q1:0010000600100710071605051005142341", 0),
            ("Q1:000000070017001700101010009gb1122007152451", 0),
        ] {
            let surface = parse_surface_signature(signature).unwrap();
            let ctx = Context::default();
            let made = fill_from_atlas(&surface, Atlas::embedded(), &FillOptions::default(), &ctx).unwrap();
            let mesh = &made.fillings[0].mesh;
            for group in groups(&surface, mesh) {
                follow(&surface, mesh, group, more).unwrap_or_else(|e| panic!("{signature} {group:x}: {e}"));
                orders.push(group.count_ones());
            }
        }
        println!("orders of the groups imposed: {orders:?}");
    }
}
