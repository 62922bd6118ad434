//! Work in chunks: "run chunk k of K" gives a record of counts that adds up with the others'.
//!
//! The tree of canonical augmentations is cut at one level into *nodes*, whose order is fixed by the parameters alone; chunk k
//! of K has the nodes whose number is k modulo K, with all that is below them. So the chunks of any K partition the
//! classes, and threads, job arrays and MPI ranks are drivers of one function, [`Plan::run`].
//!
//! Source: Brinkmann, McKay 2007 (`res/mod`); sums that add up are ours.

use crate::augment::{Members, Walk, members};
use crate::canonical::{Code, canonical};
use crate::complex::Complex;
use crate::error::EnumerateError;
use crate::level::{LevelOptions, all_levels};
use crate::params::{Params, Rule};
use crate::tally::Tally;
use crate::targets::{Found, Wanted};
use hexfill_ledger::CpuClock;
use hexfill_mesh::Context;

pub use hexfill_ledger::Chunk;

/// The result of one chunk.
#[derive(Clone, Debug)]
pub struct ChunkResult {
    /// Which chunk.
    pub chunk: Chunk,
    /// Its counts.
    pub tally: Tally,
    /// What was listed, in the order of the walk.
    pub found: Found,
    /// Processor time used, in nanoseconds; not part of the result proper.
    pub cpu_nanoseconds: u64,
}

enum Nodes {
    /// Rule `strict`: complexes of an early level and the orders of their groups.
    Early(Vec<(Complex, u16)>),
    /// Rule `weill`: the level before the last, and the same as a set.
    Last(Vec<Code>, Members),
}

/// An enumeration prepared for being run in chunks.
pub struct Plan {
    params: Params,
    nodes: Nodes,
}

impl std::fmt::Debug for Plan {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Plan").field("params", &self.params).field("nodes", &self.n_nodes()).finish_non_exhaustive()
    }
}

impl Plan {
    /// Prepares: for rule `strict` the classes of three cubes less (milliseconds), for rule `weill` the whole level before the
    /// last, found by the level engine with `options`.
    ///
    /// # Errors
    /// [`EnumerateError::BadParameters`] for parameters that do not go together: a filter under rule `strict` needs the level
    /// engine. [`EnumerateError::Stopped`] if the context says so.
    pub fn prepare(params: &Params, options: &LevelOptions, ctx: &Context<'_>) -> Result<Self, EnumerateError> {
        params.check()?;
        let before = Params { cubes: params.cubes.saturating_sub(1).max(1), ..*params };
        let nodes = match params.rule {
            Rule::Strict => {
                if params.filter.is_some() {
                    return Err(EnumerateError::BadParameters {
                        why:
                            "under rule strict the chord filter needs the level engine: a complex may choose a parent \
                              that the filter drops"
                                .into(),
                    });
                }
                // Three levels below a node are work enough for a chunk, and the nodes so few that they are made anew
                // by everyone.
                let split = params.cubes.saturating_sub(3).max(1);
                let cube = Complex::cube();
                let mut nodes = vec![(cube, canonical(&cube).automorphisms)];
                let walk_params = Params { cubes: split, ..*params };
                let mut walk = Walk::new(&walk_params, None, Wanted::default());
                for _ in 1..split {
                    let mut next = Vec::new();
                    for (parent, automorphisms) in &nodes {
                        if let Some(reason) = ctx.stop() {
                            return Err(EnumerateError::Stopped { reason });
                        }
                        next.extend(walk.children(parent, *automorphisms));
                    }
                    nodes = next;
                }
                Nodes::Early(nodes)
            }
            // Not hereditary: whether a cube was last can only be told by whether the rest is a class of the level
            // before, so all of that level is needed.
            Rule::Weill => {
                let mut levels = all_levels(&before, options, Wanted::default(), true, ctx)?;
                let codes = levels.pop().map(|level| level.codes).unwrap_or_default();
                let set = members(&codes);
                Nodes::Last(codes, set)
            }
        };
        Ok(Self { params: *params, nodes })
    }

    /// The parameters.
    pub fn params(&self) -> &Params {
        &self.params
    }

    /// Number of nodes: chunks beyond it are empty.
    pub fn n_nodes(&self) -> usize {
        match &self.nodes {
            Nodes::Early(nodes) => nodes.len(),
            Nodes::Last(codes, _) => codes.len(),
        }
    }

    /// Runs one chunk. The same chunk always gives the same result (but for the processor time).
    ///
    /// # Errors
    /// [`EnumerateError::BadParameters`] unless `chunk.index < chunk.of`; [`EnumerateError::Stopped`] if the context says so.
    ///
    /// # Example
    /// Two chunks that two machines may run; their counts add up to the 240 classes of five cubes.
    /// ```
    /// use hexfill_enumerate::{Chunk, LevelOptions, Params, Plan, Rule, Wanted};
    /// use hexfill_mesh::Context;
    ///
    /// let ctx = Context::default();
    /// let plan = Plan::prepare(&Params::new(5, Rule::Strict), &LevelOptions::default(), &ctx)?;
    /// let mut tally = plan.run(Chunk { index: 0, of: 2 }, Wanted::default(), &ctx)?.tally;
    /// tally.merge(&plan.run(Chunk { index: 1, of: 2 }, Wanted::default(), &ctx)?.tally);
    /// assert_eq!(tally.classes, 240);
    /// # Ok::<(), hexfill_enumerate::EnumerateError>(())
    /// ```
    pub fn run(&self, chunk: Chunk, wanted: Wanted<'_>, ctx: &Context<'_>) -> Result<ChunkResult, EnumerateError> {
        if chunk.index >= chunk.of {
            return Err(EnumerateError::BadParameters {
                why: format!("chunk {} of {} asked for; chunks are numbered from 0", chunk.index, chunk.of),
            });
        }
        let clock = CpuClock::start();
        let before = match &self.nodes {
            Nodes::Early(_) => None,
            Nodes::Last(_, set) => Some(set),
        };
        let mut walk = Walk::new(&self.params, before, wanted);
        if self.params.cubes == 1 {
            // The cube has no parent: it belongs to the first chunk.
            if chunk.index == 0 {
                let cube = Complex::cube();
                let labelling = canonical(&cube);
                let (boundary, shape) = walk.counter.class(&cube, &labelling, labelling.code.hash128());
                walk.found.look(&wanted, &mut walk.counter, &boundary, &shape, labelling.code);
            }
        } else {
            for i in (chunk.index..self.n_nodes()).step_by(chunk.of) {
                match &self.nodes {
                    Nodes::Early(nodes) => walk.descend(&nodes[i].0, nodes[i].1, ctx)?,
                    Nodes::Last(codes, _) => {
                        if let Some(reason) = ctx.stop() {
                            return Err(EnumerateError::Stopped { reason });
                        }
                        let parent = codes[i].decode()?;
                        walk.count_children(&parent, canonical(&parent).automorphisms);
                    }
                }
            }
        }
        Ok(ChunkResult { chunk, tally: walk.counter.finish(), found: walk.found, cpu_nanoseconds: clock.elapsed() })
    }

    /// Runs several chunks on threads. `done` is called for each as it is finished, one call at a time, in any order; its error
    /// stops the run.
    ///
    /// # Errors
    /// Those of [`run`](Self::run) and of `done`.
    pub fn run_all(
        &self,
        chunks: &[Chunk],
        threads: usize,
        wanted: Wanted<'_>,
        ctx: &Context<'_>,
        done: &mut (dyn FnMut(ChunkResult) -> Result<(), EnumerateError> + Send),
    ) -> Result<(), EnumerateError> {
        hexfill_ledger::run_chunks(chunks, threads, ctx, &|chunk| self.run(chunk, wanted, ctx), done)
    }
}
