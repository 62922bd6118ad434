//! [`doctor`]: everything about a surface before the work.
//!
//! Source: ours.

pub(crate) mod crossings;
pub(crate) mod cure;

use crate::info::existence::ExistenceInfo;
use crate::info::limits::{self, LimitsInfo};
use crate::problem::Problem;
use crate::problem::size::at_ordinary_size;
use crate::regions::{has_regions, regions};
use cure::soup;
use hexfill_construct::existence as existence_of;
use hexfill_doctor::{Finding, Findings, Severity, examine};
use hexfill_io::{MeshData, closing_tolerance};
use serde::Serialize;

/// All that is known of a surface before it is filled.
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct Diagnosis {
    /// What points and faces tell, and what the theorems say, each with its remedy.
    #[serde(flatten)]
    pub findings: Findings,
    /// What was recognised and repaired in reading.
    pub notes: Vec<String>,
    /// Whether a hex mesh exists, and why; absent if the faces are no closed surface of quads.
    pub existence: Option<ExistenceInfo>,
    /// What the positions allow any mesh to reach; absent without positions and without a closed surface.
    pub limits: Option<LimitsInfo>,
    /// Whether `fill` takes the surface as it is.
    pub can_be_filled: bool,
}

/// Looks at everything a file says of a surface. Never fails: what cannot be filled is what it is for.
///
/// ```
/// use hexfill::{CureOptions, Problem, cure, doctor};
///
/// let mut sick = Problem::named("cube")?.data();
/// let [a, b, c, d] = sick.quads.pop().expect("six");
/// sick.quads.push([d, c, b, a]); // one quad turned over
/// sick.quads.push([a, b, c, d]); // and once more
/// let found = doctor("sick", &sick);
/// assert!(!found.can_be_filled && found.findings.findings.len() >= 1);
/// let healthy = cure("sick", &sick, &CureOptions::default());
/// assert!(doctor("healthy", &healthy.data).can_be_filled, "{:?}", healthy.done);
/// # Ok::<(), hexfill::ProblemError>(())
/// ```
pub fn doctor(name: &str, data: &MeshData) -> Diagnosis {
    let mut findings = examine(&soup(data));
    if let Some(open) = findings.findings.iter_mut().find(|f| f.kind == "open-edges") {
        open.remedy = match closing_tolerance(data) {
            Some(tolerance) => format!("--weld {tolerance} closes it"),
            None => "no welding closes it: close the holes".to_owned(),
        };
    }
    let (mut notes, mut existence, mut limits) = (data.notes.clone(), None, None);
    let read = Problem::from_data(name, data);
    let is_walled = read.is_err() && has_regions(data, &read) && look_at_regions(name, data, &mut findings);
    if let Ok(problem) = read {
        notes = problem.notes().to_vec();
        let at = problem.points.as_deref().map(at_ordinary_size);
        let found = existence_of(&problem.surface, at.as_deref());
        if found.is_none() && findings.worst() != Some(Severity::Fatal) {
            findings.findings.push(Finding {
                kind: "no-hex-mesh",
                severity: Severity::Fatal,
                count: 1,
                first: Vec::new(),
                text: format!("no hex mesh exists: {found}"),
                remedy: "--refine cuts every quad into four, which makes all cycles even".to_owned(),
            });
        }
        existence = Some(ExistenceInfo::from(&found));
        limits = at.and_then(|points| limits::describe(&problem.surface, &points));
    }
    let can_be_filled = (existence.is_some() || is_walled) && findings.worst() != Some(Severity::Fatal);
    Diagnosis { findings, notes, existence, limits, can_be_filled }
}

/// Edges in three or more faces are no fault where the faces are walls between regions, each a closed surface of its own: then every region is asked
/// whether it has a hex mesh. `false` if they are no such walls.
fn look_at_regions(name: &str, data: &MeshData, findings: &mut Findings) -> bool {
    let Ok(regions) = regions(name, data) else { return false };
    if regions.is_empty() {
        return false;
    }
    for finding in findings.findings.iter_mut().filter(|f| f.kind == "non-manifold-edges") {
        finding.kind = "walls";
        finding.severity = Severity::Remark;
        finding.text += &format!(", walls of {} region{}", regions.len(), if regions.len() == 1 { "" } else { "s" });
        finding.remedy = "each is filled by itself".to_owned();
    }
    for (i, region) in regions.iter().enumerate() {
        let at = region.problem.points.as_deref().map(at_ordinary_size);
        let found = existence_of(&region.problem.surface, at.as_deref());
        if found.is_none() {
            findings.findings.push(Finding {
                kind: "no-hex-mesh",
                severity: Severity::Fatal,
                count: 1,
                first: Vec::new(),
                text: format!("region {} of {} has no hex mesh: {found}", i + 1, regions.len()),
                remedy: "change its outer quads, or cut every quad of the file into four".to_owned(),
            });
        }
    }
    findings.not_examined = None;
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn walls_are_no_fault_unless_a_region_has_no_hex_mesh() {
        // Two cubes that share a wall.
        let points = (0..12).map(|v| [v % 3, v / 3 % 2, v / 6].map(f64::from)).collect();
        let mut quads = vec![[0, 3, 9, 6], [1, 4, 10, 7], [2, 5, 11, 8]];
        for x in 0..2 {
            let [a, b] = [x, x + 1];
            quads.extend([[a, b, b + 3, a + 3], [a + 6, b + 6, b + 9, a + 9]]);
            quads.extend([[a, b, b + 6, a + 6], [a + 3, b + 3, b + 9, a + 9]]);
        }
        let mut data = MeshData::from_quads(points, quads);
        let found = doctor("two cubes", &data);
        assert!(found.can_be_filled && found.findings.not_examined.is_none());
        let kinds = |found: &Diagnosis| found.findings.findings.iter().map(|f| f.kind).collect::<Vec<_>>();
        assert_eq!(kinds(&found), ["walls"]);
        // Two quads of the first become three round the middle of their edge, one of them bent: an odd number there.
        data.points.push([0.5, 0.0, 0.0]);
        data.quads.retain(|quad| ![[0, 1, 4, 3], [0, 1, 7, 6]].contains(quad));
        data.quads.extend([[0, 3, 4, 12], [4, 1, 7, 12], [7, 6, 0, 12]]);
        let found = doctor("two solids", &data);
        assert!(!found.can_be_filled);
        assert_eq!(kinds(&found), ["walls", "reflex-quads", "no-hex-mesh"]);
        assert!(found.findings.findings[2].text.starts_with("region 1 of 2 has no hex mesh: the surface has 7 quads"));
        // A wall that ends is one.
        data.quads.truncate(data.quads.len() - 1);
        assert!(!doctor("open", &data).can_be_filled);
    }
}
