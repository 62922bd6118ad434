//! A search prepared for being run in parts: the tree is cut where it is wide enough, and each state there is a task.
//!
//! Of tasks that symmetries of the boundary carry to each other one is kept: what lies below one is the image of what lies below the
//! other. The tasks depend on surface, bound and group alone.
//!
//! Source: ours.

use crate::code::code;
use crate::cover::Cover;
use crate::error::ProveError;
use crate::mesh::{Mesh, signature_of};
use crate::state::{MAX_VERTICES, State};
use crate::symmetry::{Action, Subgroup, Symmetries};
use crate::tree::{Walker, step};
use hexfill_ledger::Chunk;
use hexfill_mesh::{Context, QuadSurface, canonical_surface, parse_surface_signature};
use rustc_hash::FxHashSet;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

/// The tree is cut where it has at least so many states, or at its end.
const TASKS: usize = 4096;

/// What is searched for: hex balls with the given boundary, at most so many hexes, and the subgroup among their symmetries.
#[derive(Clone, Debug)]
pub struct Problem {
    /// In the numbering of its signature: tasks and sums do not depend on the input's.
    surface: QuadSurface,
    signature: String,
    /// Per vertex the input's; `mirrored` if this turns the surface inside out.
    input_vertex: Vec<u32>,
    mirrored: bool,
    n_input_vertices: usize,
    max_hexes: usize,
    symmetries: Symmetries,
    group: Subgroup,
}

impl Problem {
    /// A problem with no symmetry imposed.
    ///
    /// # Errors
    /// [`ProveError::BadSurface`] unless the surface is one sphere, three-connected, all of whose vertices are used, with at most
    /// [`MAX_ORDER`](crate::MAX_ORDER) automorphisms; [`ProveError::BadParameters`] for a bound that is too large for it.
    pub fn new(surface: &QuadSurface, max_hexes: usize) -> Result<Self, ProveError> {
        let bad = |why: &str| Err(ProveError::BadSurface { why: why.into() });
        if !surface.is_sphere() || surface.n_used_vertices() != surface.n_vertices() {
            return bad("it is not one sphere all of whose vertices are used; the doctor says what it is");
        }
        if surface.n_vertices() > 100 {
            return bad("it has more than 98 quads; a proof for so many is out of reach");
        }
        if max_hexes == 0 || max_hexes > 120 {
            return Err(ProveError::BadParameters { why: format!("at most {max_hexes} hexes: 1 to 120 are possible") });
        }
        // Euler: at most 2 H + 1 - Q / 2 interior vertices.
        let most = surface.n_vertices() + 2 * max_hexes + 1 - surface.n_quads() / 2;
        if most >= MAX_VERTICES {
            return Err(ProveError::BadParameters {
                why: format!(
                    "{max_hexes} hexes may need {most} vertices, fewer than {MAX_VERTICES} are possible: ask for fewer hexes"
                ),
            });
        }
        let canonical = canonical_surface(surface);
        let named =
            parse_surface_signature(&canonical.signature).map_err(|e| ProveError::BadSurface { why: e.to_string() })?;
        let Some(symmetries) = Symmetries::of(&named) else { return bad("it has more than 64 automorphisms") };
        Ok(Self {
            surface: named,
            signature: canonical.signature,
            input_vertex: canonical.vertices.iter().map(|v| v.0).collect(),
            mirrored: canonical.mirrored,
            n_input_vertices: surface.n_vertices(),
            max_hexes,
            symmetries,
            group: 1,
        })
    }

    /// The same problem for meshes that have a subgroup of the boundary's automorphisms among their symmetries.
    #[must_use]
    pub fn with_group(self, group: Subgroup) -> Self {
        Self { group, ..self }
    }

    /// The boundary's automorphisms.
    pub fn symmetries(&self) -> &Symmetries {
        &self.symmetries
    }

    /// The boundary's signature.
    pub fn signature(&self) -> &str {
        &self.signature
    }

    /// The boundary, numbered as its signature says.
    pub(crate) fn surface(&self) -> &QuadSurface {
        &self.surface
    }

    /// The bound.
    pub fn max_hexes(&self) -> usize {
        self.max_hexes
    }

    /// The subgroup imposed.
    pub fn group(&self) -> Subgroup {
        self.group
    }

    /// A mesh found, over the vertex ids of the surface as it was given; interior vertices follow.
    pub fn in_input_ids(&self, mesh: &Mesh) -> Mesh {
        let n = self.input_vertex.len();
        let id = |v: u32| match self.input_vertex.get(v as usize) {
            Some(&w) => w,
            None => (v as usize - n + self.n_input_vertices) as u32,
        };
        let order = if self.mirrored { [4, 5, 6, 7, 0, 1, 2, 3] } else { [0, 1, 2, 3, 4, 5, 6, 7] };
        Mesh {
            n_vertices: mesh.n_vertices - n + self.n_input_vertices,
            hexes: mesh.hexes.iter().map(|h| order.map(|i: usize| id(h[i]))).collect(),
        }
    }
}

/// A state at which the tree was cut: the hexes on the way, and their hash.
#[derive(Clone)]
struct Task {
    covers: Vec<Cover>,
    path: u64,
}

/// See the module page.
pub struct Plan {
    problem: Problem,
    root: Walker,
    tasks: Vec<Task>,
    split_nodes: u64,
}

impl std::fmt::Debug for Plan {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Plan").field("problem", &self.problem).field("tasks", &self.tasks.len()).finish_non_exhaustive()
    }
}

/// What the search of some tasks found. Sums of these do not depend on order or division.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Outcome {
    /// States visited.
    pub nodes: u64,
    /// Sum of a hash of every state visited.
    pub tree_sum: u128,
    /// The meshes by signature, one of each class.
    pub meshes: BTreeMap<String, Mesh>,
}

impl Outcome {
    /// Adds what other tasks found.
    pub fn merge(&mut self, other: Self) {
        self.nodes += other.nodes;
        self.tree_sum = self.tree_sum.wrapping_add(other.tree_sum);
        other.meshes.into_iter().for_each(|(signature, mesh)| self.add(signature, mesh));
    }

    /// Adds a mesh. Of equal classes the smaller list stays: no order or division of the work shows.
    fn add(&mut self, signature: String, mesh: Mesh) {
        match self.meshes.entry(signature) {
            Entry::Vacant(slot) => drop(slot.insert(mesh)),
            Entry::Occupied(mut slot) if mesh.hexes < slot.get().hexes => drop(slot.insert(mesh)),
            Entry::Occupied(_) => {}
        }
    }

    /// Sum of the xxh3-128 of the signatures: the same for any order and division of the work.
    pub fn hash_sum(&self) -> u128 {
        let hash = |s: &String| xxhash_rust::xxh3::xxh3_128(s.as_bytes());
        self.meshes.keys().map(hash).fold(0, u128::wrapping_add)
    }

    /// Number of classes by number of hexes.
    pub fn classes(&self) -> BTreeMap<usize, usize> {
        let mut out = BTreeMap::new();
        for mesh in self.meshes.values() {
            *out.entry(mesh.hexes.len()).or_insert(0) += 1;
        }
        out
    }
}

impl Plan {
    /// Cuts the tree.
    ///
    /// # Errors
    /// [`ProveError::BadSurface`]; [`ProveError::Stopped`] if the context says so.
    pub fn prepare(problem: Problem, ctx: &Context<'_>) -> Result<Self, ProveError> {
        let state = State::new(&problem.surface)?;
        let action = Action::new(&problem.symmetries, problem.group);
        let root = Walker::new(state, action, problem.max_hexes);
        let images = problem.symmetries.normalizer(problem.group);
        let boundary: Vec<[u8; 4]> = problem.surface.quads().iter().map(|q| q.map(|v| v.0 as u8)).collect();
        let n_boundary = problem.surface.n_vertices();
        let mut plan = Self { problem, root, tasks: vec![Task { covers: Vec::new(), path: 0 }], split_nodes: 0 };
        // Level by level, so that a task is a path of covers and the same tasks come out whoever cuts.
        while !plan.tasks.is_empty() && plan.tasks.len() < TASKS {
            let mut next = Vec::new();
            let mut seen = FxHashSet::default();
            let mut deeper = false;
            for task in &plan.tasks {
                if let Some(reason) = ctx.stop() {
                    return Err(ProveError::Stopped { reason });
                }
                let mut walker = plan.walker(task);
                if walker.is_finished() {
                    next.push(task.clone());
                    continue;
                }
                plan.split_nodes += 1;
                for cover in walker.children() {
                    let mut child = task.clone();
                    child.covers.push(cover);
                    child.path = step(task.path, &cover);
                    let hexes = plan.walker(&child).hexes().to_vec();
                    // What lies below images of one another under the normalizer are images again: one of them is
                    // searched.
                    if seen.insert(code(&boundary, n_boundary, &hexes, &images)) {
                        deeper = true;
                        next.push(child);
                    }
                }
            }
            plan.tasks = next;
            if !deeper {
                break;
            }
        }
        Ok(plan)
    }

    /// What is searched for.
    pub fn problem(&self) -> &Problem {
        &self.problem
    }

    /// Number of tasks; parts beyond it are empty.
    pub fn n_tasks(&self) -> usize {
        self.tasks.len()
    }

    /// States visited while cutting the tree.
    pub fn split_nodes(&self) -> u64 {
        self.split_nodes
    }

    fn walker(&self, task: &Task) -> Walker {
        let mut walker = self.root.clone();
        for cover in &task.covers {
            // It fitted when the tree was cut.
            let fits = walker.place(cover);
            debug_assert!(fits);
        }
        walker
    }

    /// Searches the tasks of a chunk: those whose number is `chunk.index` modulo `chunk.of`.
    ///
    /// # Errors
    /// [`ProveError::Stopped`]; [`ProveError::Refused`] if the judge refuses a mesh found, which is a defect of this crate.
    pub fn run(&self, chunk: Chunk, ctx: &Context<'_>) -> Result<Outcome, ProveError> {
        let mut out = Outcome::default();
        for task in self.tasks.iter().skip(chunk.index).step_by(chunk.of.max(1)) {
            // A walker asks every few thousand states, and a task may have fewer.
            if let Some(reason) = ctx.stop() {
                return Err(ProveError::Stopped { reason });
            }
            let mut walker = self.walker(task);
            walker.descend(task.path, ctx).map_err(|reason| ProveError::Stopped { reason })?;
            let walked = std::mem::take(&mut walker.walked);
            out.nodes += walked.nodes;
            out.tree_sum = out.tree_sum.wrapping_add(walked.tree_sum);
            for hexes in &walked.found {
                let mesh = Mesh::new(hexes);
                if let Some(signature) = signature_of(&self.problem.surface, &mesh)? {
                    out.add(signature, mesh);
                }
            }
        }
        Ok(out)
    }
}
