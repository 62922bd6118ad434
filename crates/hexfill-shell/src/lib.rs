//! Shelling: closed quad surfaces of any size swept inward by their own dual curves, until nothing is left to fill.
