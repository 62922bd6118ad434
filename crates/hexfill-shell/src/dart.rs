//! Darts as numbers: `4 * quad + side`, the sides of a quad counter-clockwise seen from outside.
//!
//! Source: ours; darts are what others call half-edges.

/// The dart after `d` round its quad.
#[inline]
pub(crate) const fn next(d: u32) -> u32 {
    (d & !3) | ((d + 1) & 3)
}

/// The dart before `d` round its quad.
#[inline]
pub(crate) const fn prev(d: u32) -> u32 {
    (d & !3) | ((d + 3) & 3)
}

/// The dart opposite to `d` in its quad.
#[inline]
pub(crate) const fn opposite(d: u32) -> u32 {
    d ^ 2
}

/// The dart `by` sides after `d` round its quad.
#[inline]
pub(crate) const fn turn(d: u32, by: usize) -> u32 {
    (d & !3) | ((d + by as u32) & 3)
}
