//! Shelling: closed quad surfaces of any size swept inward by their own dual curves, until nothing is left to fill.

mod split_star;

pub use split_star::{Layer, SplitOptions, SplitStars, SplitVertex, split_stars};
