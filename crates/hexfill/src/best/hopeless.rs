//! Surfaces on which the search for a good mesh is in vain: they cross themselves, or their own angles forbid one. Of each candidate they get
//! one embedding; where they cross themselves, or quads lie on each other, they get no candidates beyond the first engine that brings a mesh. Counts bound the work, not a
//! clock, so that the mesh is the same every time.
//!
//! Source: ours.

use crate::doctor::crossings::crossing_quads;
use crate::problem::Problem;
use hexfill_embed::surface_limits;

/// A surface that keeps every mesh below this scaled Jacobian is not worth many trials.
const LEAST: f64 = 0.01;
/// One that keeps every mesh below this leaves none: rounding alone keeps it from zero.
const NOTHING: f64 = 1e-12;

/// Why much work on a surface is in vain.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) enum Hopeless {
    /// Every mesh overlaps itself, or touches itself from outside.
    Crosses(String),
    /// Quads lie on each other, or corners are straight, up to rounding.
    Folded(String),
    /// No mesh can be good, though one may be valid.
    Sharp(String),
}

/// Why further work on a surface without a valid mesh yet is hardly worth it; `None` if it may be.
pub(crate) fn hopeless(problem: &Problem, boundary: &[[f64; 3]]) -> Option<Hopeless> {
    let pairs = crossing_quads(problem).len();
    if pairs > 0 {
        let pairs = if pairs == 1 { "a pair".to_owned() } else { format!("{pairs} pairs") };
        return Some(Hopeless::Crosses(format!("{pairs} of quads cross or touch")));
    }
    let limits = surface_limits(&problem.surface, boundary)?;
    let bounds = limits.sides.iter().map(|s| s.bound).chain(limits.edges.iter().map(|e| e.bound));
    match bounds.fold(1.0, f64::min) {
        bound if bound < NOTHING => {
            Some(Hopeless::Folded("the angles of the surface leave no mesh a positive scaled Jacobian".to_owned()))
        }
        bound if bound < LEAST => Some(Hopeless::Sharp(format!(
            "the angles of the surface keep every mesh below a scaled Jacobian of {LEAST}"
        ))),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Context, FillOptions, PlaceOptions, fill_placed};

    #[test]
    fn needles_and_crossings_are_hopeless_and_a_pyramid_is_not() {
        let problem = Problem::named("schneiders-pyramid").unwrap();
        let points = problem.points.clone().unwrap();
        assert_eq!(hopeless(&problem, &points), None);
        let flat: Vec<_> = points.iter().map(|p| [p[0], p[1], 1e-9 * p[2]]).collect();
        assert!(matches!(hopeless(&problem, &flat), Some(Hopeless::Sharp(_))));
        let mut folded = points.clone();
        // A quad is folded along its diagonal.
        let [corner, _, opposite, _] = problem.surface.quads()[0].map(|v| v.index());
        folded[corner] = folded[opposite];
        assert!(matches!(hopeless(&problem, &folded), Some(Hopeless::Folded(_))), "{:?}", hopeless(&problem, &folded));
        let (surface, cells) = hexfill_mesh::generate::voxels([3, 1, 1], |_| true).unwrap();
        let mut problem = Problem::from_surface("box", surface);
        let mut through: Vec<_> = cells.into_iter().map(|p| p.map(f64::from)).collect();
        // One end is pushed through the other.
        through.iter_mut().filter(|p| p[0] == 3.0).for_each(|p| *p = [-1.5, 0.5 + 0.3 * p[1], 0.4 + 0.3 * p[2]]);
        problem.points = Some(through.clone());
        assert!(matches!(hopeless(&problem, &through), Some(Hopeless::Crosses(_))));
        let how = PlaceOptions::default();
        let made = fill_placed(&problem, &FillOptions::default(), &how, &Context::default()).unwrap();
        assert!(
            made.choice.as_ref().is_some_and(|c| c.to_string().contains("cross or touch (--best goes on")),
            "{:?}",
            made.choice
        );
    }
}
