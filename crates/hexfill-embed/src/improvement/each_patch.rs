//! Many patches at a time: each is worked on from the same points, and what got better is written back.
//!
//! Patches share no cell, so the results do not depend on each other; they are written back in the order of the patches, whatever the threads did.
//!
//! Source: ours.

use crate::problem::Patch;
use crate::quality::Verdict;
use hexfill_geometry::Vector;
use hexfill_mesh::Context;
use rayon::prelude::*;

/// Does `work` on every patch and keeps a result if it is the better [`Verdict`].
pub(crate) fn improve_each(
    parts: &[Patch],
    points: &mut [Vector],
    context: &Context<'_>,
    work: impl Fn(&Patch, &mut Vec<Vector>, &Context<'_>) + Sync,
) {
    // Progress is reported by the thread that drives the work only.
    let (quiet, before) = (Context { progress: None, ..*context }, &*points);
    let results: Vec<Option<Vec<Vector>>> = parts
        .par_iter()
        .map(|part| {
            let old = part.points(before);
            let mut new = old.clone();
            work(part, &mut new, &quiet);
            (Verdict::of(&part.problem, &new) > Verdict::of(&part.problem, &old)).then_some(new)
        })
        .collect();
    for (part, result) in parts.iter().zip(results) {
        if let Some(result) = result {
            part.write_back(&result, points);
        }
    }
}
