//! [`Rank`]: the order of meshes. Certified ones first, then those whose worst scaled Jacobian is at least [`GOOD`], then fewest hexes for their
//! quality ([`Prefer`]). Where none is certified, a few hexes a quad with one or two more to mend are worth more than 46 a quad ([`MANY`]).
//!
//! Source: ours.

use crate::fill::filled::Filled;
use crate::fill::options::Prefer;
use crate::place::placed::Placed;

/// The worst scaled Jacobian from which on a mesh is good enough to compute on.
pub(crate) const GOOD: f64 = 0.2;

/// Of meshes that are not certified, one may have so many hexes more for each vertex of the surface as another has invalid ones.
const MANY: f64 = 10.0;

/// The place of a mesh in the order, smaller is better: a class (0 good, 1 certified, 2 neither), and within it.
pub(super) type Rank = (u8, f64);

/// The rank of a mesh whose surface has `n_surface` vertices.
pub(super) fn rank(filled: &Filled, placed: &Placed, prefer: Prefer, n_surface: usize) -> Rank {
    let invalid = placed.cells.iter().filter(|c| !c.valid).count();
    if placed.cells.is_empty() {
        return (2, f64::MAX);
    }
    if invalid > 0 {
        return (2, invalid as f64 + filled.mesh.n_hexes() as f64 / (MANY * n_surface as f64));
    }
    let worst = placed.worst();
    (u8::from(worst < GOOD), within(filled.mesh.n_hexes(), worst, prefer))
}

/// The order among good meshes.
pub(super) fn within(hexes: usize, worst: f64, prefer: Prefer) -> f64 {
    match prefer {
        Prefer::Balance => hexes as f64 / worst.powi(3),
        Prefer::Hexes => hexes as f64,
        Prefer::Quality => -worst,
    }
}
