//! Level 4 as a whole, and level 5 for a range of hexes.
//!
//! Source: ours.

use super::bernstein::Vector;
use super::positivity::{decide, surely_positive};
use super::verdict::Positivity;
use crate::input::Judged;
use crate::report::{Findings, Offender};
use crate::rule::Rule;
use crate::topology::stars::Stars;

/// Positions: as many as vertices, finite where used, those of the surface bit-identical.
pub(crate) fn judge_positions(input: &Judged<'_>, points: &[Vector], stars: &Stars) -> Findings {
    let mut findings = Findings::default();
    let given = input.surface_points.unwrap_or_default();
    if points.len() != input.n_vertices {
        let note = format!("{} positions, {} vertices", points.len(), input.n_vertices);
        findings.add(Rule::PointsCount, || Offender::default().note(note));
    }
    if given.len() > points.len() {
        let note = format!("{} positions, {} of them of the surface", points.len(), given.len());
        findings.add(Rule::PointsCount, || Offender::default().note(note));
    }
    for (v, p) in points.iter().enumerate().take(stars.len()) {
        if p.iter().any(|x| !x.is_finite()) && !stars.of(v as u32).is_empty() {
            findings.add(Rule::PositionNotFinite, || {
                Offender::at(&[stars.of(v as u32)[0] >> 3], &[v as u32]).note(format!("{p:?}"))
            });
        }
    }
    for (v, (p, q)) in points.iter().zip(given).enumerate() {
        if p.map(f64::to_bits) != q.map(f64::to_bits) {
            findings.add(Rule::BoundaryMoved, || {
                Offender::at(&[], &[v as u32]).note(format!("{p:?}, the surface has {q:?}"))
            });
        }
    }
    findings
}

/// det J > 0 for the hexes `first..first + hexes.len()`.
pub(crate) fn judge_jacobians(first: usize, hexes: &[[u32; 8]], points: &[Vector]) -> Findings {
    let mut findings = Findings::default();
    for (i, hex) in hexes.iter().enumerate() {
        let p = hex.map(|v| points[v as usize]);
        if surely_positive(&p) {
            continue;
        }
        let h = (first + i) as u32;
        match decide(&p) {
            Positivity::Positive => {}
            Positivity::InsideOut => findings.add(Rule::HexInsideOut, || Offender::at(&[h], &[])),
            Positivity::NotPositive { at, zero } => findings.add(Rule::JacobianNotPositive, || {
                let how = if zero { "zero" } else { "negative" };
                Offender::at(&[h], &[]).note(format!("{how} at ({}, {}, {}) of the unit cube", at[0], at[1], at[2]))
            }),
            Positivity::Undecided => findings.add(Rule::JacobianUndecided, || Offender::at(&[h], &[])),
        }
    }
    findings
}
