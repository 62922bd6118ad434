//! How a surface is swept.

use hexfill_search::Atlas;

/// Hexes wanted round an edge of the surface, by its two vertices.
pub type EdgeWant<'a> = &'a (dyn Fn(u32, u32) -> f32 + Sync);

/// How a surface is swept.
///
/// | option | default |
/// |---|---|
/// | pillows, seed, restarts, rounds of stirring | 0 |
/// | largest lens | any |
/// | atlas, wants of edges | none |
#[derive(Clone, Copy, Default)]
pub struct SweepOptions<'a> {
    pub(crate) pillows: u32,
    pub(crate) seed: u64,
    pub(crate) restarts: u32,
    pub(crate) stir: u32,
    pub(crate) largest_lens: Option<u32>,
    pub(crate) atlas: Option<&'a Atlas>,
    pub(crate) edge_want: Option<EdgeWant<'a>>,
}

impl<'a> SweepOptions<'a> {
    /// Whole layers of one hex a quad put first; after the first, everything on the front is interior and free to merge.
    #[must_use]
    pub fn with_pillows(self, pillows: u32) -> Self {
        Self { pillows, ..self }
    }

    /// Breaks ties among lenses of one size; 0: by index.
    #[must_use]
    pub fn with_seed(self, seed: u64) -> Self {
        Self { seed, ..self }
    }

    /// How often to start again, each time with other ties, while quads are left or wants are not met. The best result is kept: fewest quads
    /// left, then lowest cost, then fewest hexes.
    #[must_use]
    pub fn with_restarts(self, restarts: u32) -> Self {
        Self { restarts, ..self }
    }

    /// How many rounds of other flips to try on what is left in the end: the first searches, each later one starts from some random flips.
    #[must_use]
    pub fn with_stir(self, stir: u32) -> Self {
        Self { stir, ..self }
    }

    /// Most vertices a lens may have inside.
    #[must_use]
    pub fn with_largest_lens(self, most: u32) -> Self {
        Self { largest_lens: Some(most), ..self }
    }

    /// Fillings for what is left in the end.
    #[must_use]
    pub fn with_atlas(self, atlas: &'a Atlas) -> Self {
        Self { atlas: Some(atlas), ..self }
    }

    /// How many hexes are wanted round each edge of the surface, say its angle / 90 degrees. Lenses whose flips meet the wants come first.
    #[must_use]
    pub fn with_edge_want(self, want: EdgeWant<'a>) -> Self {
        Self { edge_want: Some(want), ..self }
    }
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
