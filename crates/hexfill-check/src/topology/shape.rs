//! Level 1: every index in range, every hex with eight distinct vertices, every surface quad with four.
//!
//! Source: ours.

use super::stars::MAX_HEXES;
use crate::input::Judged;
use crate::parallel::{piece, tasks};
use crate::report::{Findings, Offender};
use crate::rule::Rule;

const CHUNK: usize = 1 << 14;

/// Judges level 1 and finds one more than the highest vertex id used.
pub(crate) fn judge_shape(input: &Judged<'_>) -> (Findings, usize) {
    let mut findings = Findings::default();
    if input.hexes.is_empty() {
        findings.add(Rule::MeshEmpty, Offender::default);
    }
    let quads = input.surface.unwrap_or_default();
    for (what, given, limit) in [
        ("hexes", input.hexes.len(), MAX_HEXES),
        ("surface quads", quads.len(), (u32::MAX / 4) as usize),
        ("vertices", input.n_vertices, u32::MAX as usize),
    ] {
        if given > limit {
            findings.add(Rule::TooLarge, || {
                Offender::default().note(format!("{given} {what} given, the limit is {limit}"))
            });
        }
    }
    if findings.count(Rule::TooLarge) > 0 {
        return (findings, 0);
    }
    let n = input.n_vertices;
    let parts = tasks(input.hexes.len().div_ceil(CHUNK), |i| {
        let hexes = piece(input.hexes, CHUNK, i);
        cells(i * CHUNK, hexes, n, Rule::IndexOutOfRange, Rule::HexRepeatsVertex)
    });
    let surface_parts = tasks(quads.len().div_ceil(CHUNK), |i| {
        cells(i * CHUNK, piece(quads, CHUNK, i), n, Rule::SurfaceIndexOutOfRange, Rule::SurfaceQuadRepeatsVertex)
    });
    let mut used = 0;
    for (part, top) in parts.into_iter().chain(surface_parts) {
        findings.append(part);
        used = used.max(top);
    }
    (findings, used)
}

/// Judges cells `first..first + cells.len()`, `K` distinct vertices each.
fn cells<const K: usize>(first: usize, cells: &[[u32; K]], n: usize, range: Rule, repeats: Rule) -> (Findings, usize) {
    let mut findings = Findings::default();
    let mut top = 0;
    let offender = |c: usize, v: u32, note: String| {
        let id = (first + c) as u32;
        let at = if K == 8 { Offender::at(&[id], &[v]) } else { Offender::quad(id, &[v]) };
        at.note(note)
    };
    for (c, cell) in cells.iter().enumerate() {
        for (i, &v) in cell.iter().enumerate() {
            if v as usize >= n {
                findings.add(range, || offender(c, v, format!("corner {i}; there are {n} vertices (0-based ids)")));
            } else {
                top = top.max(v as usize + 1);
                if let Some(j) = cell[..i].iter().position(|&w| w == v) {
                    findings.add(repeats, || offender(c, v, format!("corners {j} and {i}")));
                }
            }
        }
    }
    (findings, top)
}
