//! Sweep: a surface is filled from its front inward by emptying the smallest lens of the front's dual, again and again.
//!
//! A lens with k vertices inside is emptied by k - 1 flips of triangles at its arcs, the last of which zips two quads away. All flips of a
//! lens are one transaction: it ends with fewer quads or is taken back, so the sweep ends after at most half as many lenses as there are quads.
//! On spheres whose chords are simple this closes the void (Chang, Erickson, "Untangling planar curves", 2017); what stays elsewhere are chords
//! that cross themselves, or handles (see `plug`).
//!
//! Lenses are kept in a heap, one for each corner. A change of the front can make new ones only at corners whose arcs run through a changed quad:
//! those are found by following the chords back. A lens that changed otherwise is noticed when its turn comes.

use crate::front::{Front, Mark, NONE, next, opposite};
use crate::glue::Patch;
use crate::lens::{LensFinder, Stamps};
use hexfill_mesh::{Context, QuadSurface, Random, StopReason};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Hexes wanted round an edge of the surface, by its two vertices.
pub type EdgeWant<'a> = &'a (dyn Fn(u32, u32) -> f32 + Sync);

/// How a surface is swept.
#[derive(Clone, Copy, Default)]
pub struct SweepOptions<'a> {
    /// Whole layers of one hex a quad put first; after the first, everything on the front is interior and free to merge.
    pub pillows: u32,
    /// Breaks ties among lenses of one size; 0: by index.
    pub seed: u64,
    /// How often to start again, each time with other ties, while quads are left or wants are not met. The best result is kept: fewest quads
    /// left, then lowest cost, then fewest hexes.
    pub restarts: u32,
    /// Most vertices a lens may have inside; `None`: any number.
    pub largest_lens: Option<u32>,
    /// How many hexes are wanted round each edge of the surface, say its angle / 90 degrees. Lenses whose flips meet the wants come first.
    pub edge_want: Option<EdgeWant<'a>>,
}

impl std::fmt::Debug for SweepOptions<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("SweepOptions")
            .field("pillows", &self.pillows)
            .field("seed", &self.seed)
            .field("largest_lens", &self.largest_lens)
            .finish_non_exhaustive()
    }
}

/// Highest cost of a flip at each level; a lens that cannot be emptied at one level has another chance at the next.
const LEVELS: [f32; 4] = [0.3, 1.0, 3.0, f32::INFINITY];
/// What is wanted round the edges behind a pillow: this much of the surface's difference from flat.
const BEHIND_PILLOW: f32 = 0.3;

/// What a sweep made.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Swept {
    /// Number of vertices: those of the surface first, then the new ones.
    pub n_vertices: u32,
    /// The hexes, corners in VTK_HEXAHEDRON order, positively oriented with respect to the outward surface.
    pub hexes: Vec<[u32; 8]>,
    /// The quads still to fill, oriented as the surface (outward of what is left); empty when complete.
    pub front: Vec<[u32; 4]>,
    /// Why the sweep stopped early, if it did.
    pub stopped: Option<StopReason>,
}

/// Fills `surface` from its front inward. Each of its components must bound a ball (or a handlebody) of its own. Handles are cut by plugs, which
/// need `points`, a position for each vertex of the surface; without them a surface with handles is not filled to the end.
///
/// A surface with quads that meet improperly has no proper filling and comes back as it is: no hexes, all quads left.
pub fn sweep(
    surface: &QuadSurface,
    points: Option<&[[f64; 3]]>,
    options: &SweepOptions<'_>,
    ctx: &Context<'_>,
) -> Swept {
    let Ok(mut front) = Front::new(surface) else {
        let front = surface.quads().iter().map(|q| q.map(|v| v.0)).collect();
        return Swept { n_vertices: surface.n_vertices() as u32, hexes: Vec::new(), front, stopped: None };
    };
    let mut base: Vec<u32> = (0..surface.n_vertices() as u32).collect();
    let mut points: Option<Vec<[f64; 3]>> = points.filter(|p| p.len() == surface.n_vertices()).map(<[_]>::to_vec);
    for _ in 0..options.pillows {
        let (layered, below) = front.pillowed();
        front = layered;
        base.extend(below.iter().map(|&v| base[v as usize]).collect::<Vec<_>>());
        if let Some(points) = &mut points {
            points.extend(below.iter().map(|&v| points[v as usize]).collect::<Vec<_>>());
        }
    }
    if let Some(points) = &mut points {
        for handle in 0..surface.genus() {
            let Some(plugged) = ctx.stop().is_none().then(|| front.plug(points)).flatten() else { break };
            front = plugged;
            ctx.report("shelling", handle + 1, Some(surface.genus()), || "handles cut".to_owned());
        }
    }
    if let Some(want) = options.edge_want {
        front.set_wants(|a, b| {
            let (Some(&c), Some(&d)) = (base.get(a as usize), base.get(b as usize)) else { return 3.0 };
            match options.pillows {
                0 => want(c, d),
                _ => 2.0 + BEHIND_PILLOW * (want(c, d) - 2.0),
            }
        });
    }
    let mut best: Option<(Front, f64)> = None;
    let mut stopped = None;
    for restart in 0..=options.restarts {
        let mut attempt = front.clone();
        let seed = options.seed.wrapping_add(u64::from(restart));
        let mut sweeper = Sweeper::new(&mut attempt, &SweepOptions { seed, ..*options });
        stopped = sweeper.run(ctx);
        let cost = sweeper.cost;
        let rank = |front: &Front, cost: f64| (front.n_quads(), cost, front.hexes().len());
        if best.as_ref().is_none_or(|(front, least)| rank(&attempt, cost) < rank(front, *least)) {
            best = Some((attempt, cost));
        }
        if stopped.is_some() || best.as_ref().is_some_and(|(front, cost)| front.n_quads() == 0 && *cost < 1e-3) {
            break;
        }
    }
    best.map_or(front, |(best, _)| best).finish(stopped)
}

/// Empties lenses of a front until none can be emptied; `None`, or why it stopped early.
pub fn sweep_front(front: &mut Front, options: &SweepOptions<'_>, ctx: &Context<'_>) -> Option<StopReason> {
    Sweeper::new(front, options).run(ctx)
}

impl Front {
    /// The state after one more whole layer: a hex on every front quad, its other end on a copy of the front. With it, for
    /// each new vertex the one it is a copy of.
    pub fn pillowed(&self) -> (Self, Vec<u32>) {
        let mut below = Vec::new();
        let mut copy = vec![NONE; self.n_vertices() as usize];
        let mut n_vertices = self.n_vertices();
        let (mut hexes, mut quads) = (self.hexes().to_vec(), self.quads());
        for quad in &mut quads {
            let inner = quad.map(|v| {
                let slot = &mut copy[v as usize];
                if *slot == NONE {
                    *slot = n_vertices;
                    n_vertices += 1;
                    below.push(v);
                }
                *slot
            });
            let ([a, b, c, d], [e, f, g, h]) = (inner, *quad);
            hexes.push([a, b, c, d, e, f, g, h]);
            *quad = inner;
        }
        let state = self.with(n_vertices, &hexes, &quads).expect("a copy of a proper front meets nothing else");
        (state, below)
    }

    /// The result, with the vertices numbered without gaps: those of the surface keep their ids.
    pub fn finish(&self, stopped: Option<StopReason>) -> Swept {
        let (mut hexes, mut front) = (self.hexes().to_vec(), self.quads());
        let mut used = vec![false; self.n_vertices() as usize];
        let first_new = self.n_kept();
        used[..first_new as usize].fill(true);
        hexes.iter().flatten().for_each(|&v| used[v as usize] = true);
        let mut n_vertices = 0;
        let name: Vec<u32> = used
            .iter()
            .map(|&used| {
                n_vertices += u32::from(used);
                n_vertices.wrapping_sub(1)
            })
            .collect();
        hexes.iter_mut().flatten().for_each(|v| *v = name[*v as usize]);
        front.iter_mut().flatten().for_each(|v| *v = name[*v as usize]);
        Swept { n_vertices, hexes, front, stopped }
    }
}

/// A lens in the heap: level, size, noise, corner, and the corner's version when it was looked at.
type Entry = (u8, u32, u32, u32, u32);

/// The state of a sweep.
struct Sweeper<'a> {
    front: &'a mut Front,
    finder: LensFinder,
    heap: BinaryHeap<Reverse<Entry>>,
    /// Per dart: how often its corner was looked at; older entries of the heap are void.
    version: Vec<u32>,
    /// Darts whose corner was looked at in this round.
    looked: Stamps,
    /// Vertices of the lens that is being emptied.
    inside: Stamps,
    /// Lenses up to this size are known.
    limit: u32,
    largest: u32,
    /// Up to this size lenses are looked for before a lens has its chance at a higher level.
    wide: u32,
    /// Flips that empty no lens and may still be made, and the first quad to try.
    budget: u32,
    next_slot: u32,
    /// Sum of the costs of all flips.
    cost: f64,
    random: Option<Random>,
}

impl<'a> Sweeper<'a> {
    fn new(front: &'a mut Front, options: &SweepOptions<'_>) -> Self {
        let n_darts = 4 * front.n_slots() as usize;
        let n_vertices = front.n_quads() as u32 + 2;
        Self {
            front,
            finder: LensFinder::default(),
            heap: BinaryHeap::new(),
            version: vec![0; n_darts],
            looked: Stamps::default(),
            inside: Stamps::default(),
            limit: 0,
            budget: 8 * n_vertices,
            next_slot: 0,
            cost: 0.0,
            wide: options.largest_lens.unwrap_or(u32::MAX).min(n_vertices).min(8 + 4 * n_vertices.isqrt()),
            largest: options.largest_lens.unwrap_or(u32::MAX).min(n_vertices),
            random: (options.seed != 0).then(|| Random::new(options.seed)),
        }
    }

    fn run(&mut self, ctx: &Context<'_>) -> Option<StopReason> {
        self.front.commit();
        let total = self.front.n_quads() as u64;
        while self.front.n_quads() > 0 {
            if let Some(reason) = ctx.stop() {
                return Some(reason);
            }
            let level = self.heap.peek().map_or(1, |Reverse(entry)| entry.0);
            if level > 0 && self.front.has_wants() {
                // Larger lenses that cost little come before small ones that cost much, and so do single flips.
                if self.limit < self.wide {
                    self.widen();
                    continue;
                }
                if self.flip_anywhere() {
                    continue;
                }
            }
            let Some(Reverse((level, size, _, corner, version))) = self.heap.pop() else {
                if self.limit >= self.largest {
                    return None;
                }
                self.widen();
                continue;
            };
            if self.version[corner as usize] != version || !self.front.is_quad(corner / 4) {
                continue;
            }
            let Some(lens) = self.finder.find(self.front, corner, self.limit as usize) else { continue };
            if lens.len() as u32 != size {
                let size = lens.len() as u32;
                self.push(level, size, corner);
                continue;
            }
            let lens = lens.to_vec();
            let mark = self.front.mark();
            let most = if self.front.has_wants() { LEVELS[usize::from(level)] } else { f32::INFINITY };
            if !self.empty(lens, most) {
                if most < f32::INFINITY {
                    self.push(level + 1, size, corner);
                }
            } else {
                self.changed(mark);
                let (left, hexes) = (self.front.n_quads() as u64, self.front.hexes().len());
                ctx.report("shelling", total - left, Some(total), || format!("{left} quads left, {hexes} hexes"));
            }
        }
        None
    }

    /// Makes one flip that costs next to nothing, wherever it is, while the budget lasts: it is what the wants ask for, though it empties no lens.
    fn flip_anywhere(&mut self) -> bool {
        while self.budget > 0 && self.next_slot < self.front.n_slots() {
            let q = self.next_slot;
            self.next_slot += 1;
            // Each corner of the quad, and the two strips through it.
            for i in 0..6 {
                if !self.front.is_quad(q) {
                    break;
                }
                let mark = self.front.mark();
                let made = if i < 4 {
                    self.front.flip(self.front.origin(4 * q + i))
                } else {
                    self.front.glue_hex(4 * q + i - 4, Patch::Strip)
                };
                match made {
                    Ok(cost) if cost <= LEVELS[0] => {
                        self.budget -= 1;
                        self.cost += f64::from(cost);
                        self.changed(mark);
                        return true;
                    }
                    Ok(_) => self.front.take_back(mark),
                    Err(_) => {}
                }
            }
        }
        false
    }

    /// Looks at what changed since `mark` and makes it final.
    fn changed(&mut self, mark: Mark) {
        self.look_near(mark);
        self.front.commit();
        self.next_slot = 0;
    }

    /// Empties a lens by flips at its arcs, none of which costs more than `most`. The front is unchanged if that does not end with fewer quads.
    fn empty(&mut self, mut lens: Vec<u32>, most: f32) -> bool {
        let n_quads = self.front.n_quads();
        let (mark, cost) = (self.front.mark(), self.cost);
        self.inside.clear(self.front.n_vertices() as usize + lens.len() + 1);
        lens.iter().for_each(|&v| self.inside.set(v, 0));
        while let Some(i) = self.flip_one(&lens, most) {
            if self.front.n_quads() < n_quads {
                return true;
            }
            self.inside.unset(lens.swap_remove(i));
        }
        self.front.take_back(mark);
        self.cost = cost;
        false
    }

    /// Makes the flip of a triangle at an arc of the lens that costs least; its number in the lens.
    fn flip_one(&mut self, lens: &[u32], most: f32) -> Option<usize> {
        if !self.front.has_wants() {
            return (0..lens.len()).find(|&i| self.is_at_arc(lens[i]) && self.front.flip(lens[i]).is_ok());
        }
        let mut best: Option<(f32, usize)> = None;
        for i in 0..lens.len() {
            if self.is_at_arc(lens[i]) {
                let mark = self.front.mark();
                if let Ok(cost) = self.front.flip(lens[i]) {
                    self.front.take_back(mark);
                    if cost <= most && best.is_none_or(|(least, _)| cost < least) {
                        best = Some((cost, i));
                    }
                }
            }
        }
        let (cost, i) = best?;
        self.cost += f64::from(cost);
        self.front.flip(lens[i]).ok().map(|_| i)
    }

    /// Whether a vertex inside the lens has degree 3 and a neighbour outside: its triangle lies at an arc.
    fn is_at_arc(&self, v: u32) -> bool {
        self.front.degree(v) == 3
            && self.front.round_vertex(self.front.dart_of(v)).any(|d| !self.inside.is_set(self.front.target(d)))
    }

    fn push(&mut self, level: u8, size: u32, corner: u32) {
        let noise = self.random.as_mut().map_or(0, |r| r.next_u64() as u32);
        self.heap.push(Reverse((level, size, noise, corner, self.version[corner as usize])));
    }

    /// Looks at one corner, once a round.
    fn look(&mut self, corner: u32) {
        if self.looked.is_set(corner) {
            return;
        }
        self.looked.set(corner, 0);
        self.version[corner as usize] += 1;
        if let Some(lens) = self.finder.find(self.front, corner, self.limit as usize) {
            let size = lens.len() as u32;
            self.push(0, size, corner);
        }
    }

    /// Looks for lenses of twice the size.
    fn widen(&mut self) {
        self.limit = (2 * self.limit).max(4).min(self.largest);
        self.look_everywhere();
    }

    fn look_everywhere(&mut self) {
        self.looked.clear(self.version.len());
        for q in 0..self.front.n_slots() {
            if self.front.is_quad(q) {
                (4 * q..4 * q + 4).for_each(|d| self.look(d));
            }
        }
    }

    /// Looks at all corners whose arcs meet a quad that changed since `mark`.
    fn look_near(&mut self, mark: Mark) {
        self.version.resize(4 * self.front.n_slots() as usize, 0);
        self.looked.clear(self.version.len());
        for q in self.front.changed_slots(mark) {
            if !self.front.is_quad(q) {
                continue;
            }
            for d in 4 * q..4 * q + 4 {
                self.look(d);
                // Away from q across d; the arcs that come back this way leave each quad across the dart they entered by.
                let mut at = self.front.twin(d);
                for _ in 0..self.limit {
                    if at / 4 == q {
                        break;
                    }
                    self.look(at);
                    self.look(next(at));
                    at = self.front.twin(opposite(at));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_surfaces::{judged, read_obj, torus_at, voxels};
    use hexfill_mesh::generate::{random_sphere, voxel_surface};

    #[test]
    fn boxes_are_their_voxels() {
        for n in 2..=6 {
            let surface = voxel_surface([n, n, n], |_| true).unwrap();
            let swept = sweep(&surface, None, &SweepOptions::default(), &Context::default());
            assert_eq!(judged(&surface, &swept), n * n * n);
        }
    }

    #[test]
    fn handles_are_plugged() {
        let (surface, points) = torus_at(12, 8);
        for (pillows, hexes) in [(0, 36), (1, 132)] {
            let options = SweepOptions { pillows, ..Default::default() };
            let swept = sweep(&surface, Some(&points), &options, &Context::default());
            assert_eq!(judged(&surface, &swept), hexes);
        }
        let (pen, points) = read_obj(include_str!("../../../corpus/surfaces/bamboo_pen.obj"));
        let options = SweepOptions { pillows: 1, ..Default::default() };
        let swept = sweep(&pen, Some(&points), &options, &Context::default());
        println!("{}", judged(&pen, &swept));
    }

    /// The state that a result describes, checked.
    fn checked(surface: &QuadSurface, swept: &Swept) -> Front {
        let quads: Vec<[u32; 4]> = surface.quads().iter().map(|q| q.map(|v| v.0)).collect();
        let state = Front::try_from_parts(swept.n_vertices, &quads, &swept.hexes, &swept.front).unwrap();
        state.debug_check();
        state
    }

    /// A random triangulated sphere, every triangle cut into three quads: all chords are simple.
    fn cut_triangulation(n_points: u32, seed: u64) -> QuadSurface {
        let mut random = Random::new(seed);
        let mut triangles = vec![[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]];
        for v in 4..n_points {
            let [a, b, c] = triangles.swap_remove(random.below(triangles.len()));
            triangles.extend([[a, b, v], [b, c, v], [c, a, v]]);
        }
        // Edge slides mix the degrees, where the new edge is none yet.
        for _ in 0..10 * n_points {
            let (i, j) = (random.below(triangles.len()), random.below(triangles.len()));
            for k in 0..3 {
                let [a, b, c] = [0, 1, 2].map(|m| triangles[i][(k + m) % 3]);
                let Some(l) = (0..3).find(|&l| triangles[j][l] == b && triangles[j][(l + 1) % 3] == a) else {
                    continue;
                };
                let d = triangles[j][(l + 2) % 3];
                let taken = triangles.iter().any(|t| t.contains(&c) && t.contains(&d));
                if !taken {
                    triangles[i] = [c, a, d];
                    triangles[j] = [d, b, c];
                }
                break;
            }
        }
        let mut middles = std::collections::BTreeMap::new();
        let mut quads = Vec::new();
        let n_edges = 3 * n_points - 6;
        for (t, &[a, b, c]) in triangles.iter().enumerate() {
            let mut middle = |a: u32, b: u32| {
                let n = n_points + middles.len() as u32;
                *middles.entry((a.min(b), a.max(b))).or_insert(n)
            };
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            let centre = n_points + n_edges + t as u32;
            quads.extend([[a, ab, centre, ca], [b, bc, centre, ab], [c, ca, centre, bc]]);
        }
        QuadSurface::try_new((n_points + n_edges) as usize + triangles.len(), &quads).unwrap()
    }

    #[test]
    fn cut_triangulations_take_a_third_of_their_quads() {
        for seed in 0..60 {
            let surface = cut_triangulation(6 + 2 * seed as u32, seed);
            if !hexfill_mesh::is_proper(&surface) {
                continue;
            }
            for pillows in 0..2 {
                let options = SweepOptions { pillows, ..Default::default() };
                let swept = sweep(&surface, None, &options, &Context::default());
                let hexes = surface.n_quads() / 3 + pillows as usize * surface.n_quads();
                assert_eq!(judged(&surface, &swept), hexes, "{seed} {pillows}");
            }
        }
    }

    #[test]
    fn voxel_solids_are_their_voxels() {
        let letters: [(&str, [usize; 3], fn([usize; 3]) -> bool); 4] = [
            ("L", [6, 6, 3], |[x, y, _]| x < 3 || y < 3),
            ("T", [9, 6, 3], |[x, y, _]| y > 2 || (3..6).contains(&x)),
            ("U", [9, 6, 3], |[x, y, _]| y < 3 || !(3..6).contains(&x)),
            ("stairs", [4, 4, 4], |[x, y, z]| x + y + z < 4 + z % 2),
        ];
        for (name, size, filled) in letters {
            let (surface, angles) = voxels(size, filled).unwrap();
            let cells = (0..size[0] * size[1] * size[2])
                .filter(|i| filled([i % size[0], i / size[0] % size[1], i / size[0] / size[1]]))
                .count();
            let want = |a: u32, b: u32| angles[&(a.min(b), a.max(b))];
            let options = SweepOptions { edge_want: Some(&want), restarts: 20, ..Default::default() };
            let swept = sweep(&surface, None, &options, &Context::default());
            println!("{name} {cells} {} {}", swept.hexes.len(), swept.front.len());
            assert_eq!(judged(&surface, &swept), cells, "{name}");
        }
    }

    #[test]
    fn random_voxel_solids() {
        let (mut tried, mut exact) = (0, 0);
        for seed in 0..600 {
            let mut random = Random::new(seed);
            let size = [2, 3, 4].map(|n| n + random.below(3));
            let mut filled = std::collections::BTreeSet::from([[size[0] / 2, size[1] / 2, size[2] / 2]]);
            for _ in 0..100 {
                let cells: Vec<[usize; 3]> = filled.iter().copied().collect();
                let mut cell = cells[random.below(cells.len())];
                let axis = random.below(3);
                cell[axis] = (cell[axis] + 1 + random.below(2) * (size[axis] - 2)) % size[axis];
                filled.insert(cell);
            }
            let Some((surface, angles)) = voxels(size, |c| filled.contains(&c)) else { continue };
            if !surface.is_sphere() || !hexfill_mesh::is_proper(&surface) {
                continue;
            }
            tried += 1;
            let want = |a: u32, b: u32| angles[&(a.min(b), a.max(b))];
            let options = SweepOptions { edge_want: Some(&want), restarts: 20, ..Default::default() };
            let swept = sweep(&surface, None, &options, &Context::default());
            checked(&surface, &swept);
            if swept.hexes.len() != filled.len() {
                println!(
                    "seed {seed} {size:?} {} quads, {} cells: {} hexes {} left",
                    surface.n_quads(),
                    filled.len(),
                    swept.hexes.len(),
                    swept.front.len()
                );
            }
            if swept.front.is_empty() {
                exact += usize::from(judged(&surface, &swept) == filled.len());
            }
        }
        println!("{exact} of {tried}");
        assert!(tried > 20 && exact == tried, "{exact} of {tried}");
    }

    #[test]
    fn what_is_left_of_random_spheres_can_be_filled_on() {
        let mut left = [0, 0];
        for seed in 0..200 {
            let surface = random_sphere(10 + seed as usize / 3, seed).unwrap();
            let swept = sweep(&surface, None, &SweepOptions { seed, ..Default::default() }, &Context::default());
            let state = checked(&surface, &swept);
            if swept.front.is_empty() {
                judged(&surface, &swept);
            }
            left[0] += surface.n_quads();
            left[1] += state.n_quads();
        }
        println!("{left:?}");
    }
}
