//! [`Stage`]: which step of the engine glued a hex.
//!
//! Source: ours.

/// Which step of the shelling hexes come from, in the order of the steps.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Stage {
    /// A cell of the grid into which the surface unrolls.
    Grid,
    /// In a column: over a quad of the section, or between mirror images.
    Columns,
    /// The layer of one hex under every quad.
    Pillows,
    /// Cuts a handle, or joins a cavity to the outside.
    Plugs,
    /// Swept in whole layers.
    Layers,
    /// Swept by flips of the dual curves.
    Flips,
    /// Fills what the sweep left.
    Residual,
}
