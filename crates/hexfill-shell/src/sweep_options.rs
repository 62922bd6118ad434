//! How a surface is swept.

use hexfill_search::Atlas;

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
    /// How many rounds of other flips to try on what is left in the end: the first searches, each later one starts from some random flips.
    pub stir: u32,
    /// Most vertices a lens may have inside; `None`: any number.
    pub largest_lens: Option<u32>,
    /// Fillings for what is left in the end.
    pub atlas: Option<&'a Atlas>,
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
