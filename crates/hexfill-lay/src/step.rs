//! [`Step`]: what made a hex of a laid mesh.
//!
//! Source: ours.

/// Which step made a hex.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Step {
    /// The pillow under the surface.
    Pillow,
    /// A plug that cuts a handle.
    Plug,
    /// The sweep, up to the void it leaves.
    Sweep,
    /// A pillow in the void, which gives room.
    Between,
    /// Laid in the void.
    Laid,
}

impl Step {
    /// What made each hex of a sweep: `pillow` hexes of the pillow and `plugs` of plugs come first, of `n` in all.
    pub(crate) fn of_sweep(pillow: usize, plugs: usize, n: usize) -> Vec<Self> {
        let mut steps = vec![Self::Pillow; pillow];
        steps.resize(pillow + plugs, Self::Plug);
        steps.resize(n, Self::Sweep);
        steps
    }
}
