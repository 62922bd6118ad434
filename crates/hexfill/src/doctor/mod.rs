//! [`doctor`]: everything about a surface before the work.
//!
//! Source: ours.

pub(crate) mod crossings;
pub(crate) mod cure;

use crate::info::existence::ExistenceInfo;
use crate::info::limits::{self, LimitsInfo};
use crate::problem::Problem;
use crate::problem::size::at_ordinary_size;
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
    if let Ok(problem) = Problem::from_data(name, data) {
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
    let can_be_filled = existence.is_some() && findings.worst() != Some(Severity::Fatal);
    Diagnosis { findings, notes, existence, limits, can_be_filled }
}
