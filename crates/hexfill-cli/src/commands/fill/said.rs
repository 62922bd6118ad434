//! What `fill` says: for people, and as JSON.

use super::args::FillArgs;
use crate::console::Console;
use hexfill::{Choice, Estimate, FillReport, GeometryReport, PlacedFill, StopReason};
use serde::Serialize;
use std::path::Path;

#[derive(Serialize)]
pub(super) struct MeshOutput {
    #[serde(flatten)]
    pub(super) report: FillReport,
    /// Absent without positions.
    pub(super) geometry: Option<GeometryReport>,
    pub(super) files: Vec<String>,
}

#[derive(Serialize)]
pub(super) struct Output {
    pub(super) meshes: Vec<MeshOutput>,
    /// Why the work ended.
    pub(super) stopped: StopReason,
    /// As the process returns it.
    pub(super) exit_code: u8,
    pub(super) seconds: f64,
    pub(super) notes: Vec<String>,
    /// Why this mesh and no other, if there was a choice.
    pub(super) choice: Option<Choice>,
    /// What was expected before the work, unless it was short.
    pub(super) estimate: Option<Estimate>,
}

/// The report for a person where there is no mesh.
pub(super) fn say_none(result: &PlacedFill, growth_log: Option<&Path>, console: &Console) {
    for tried in &result.tried {
        console.say(format!("tried: {tried}"));
    }
    console.say("no mesh found within the bounds, which does not mean that none exists");
    match (result.stop, growth_log) {
        (StopReason::Finished, _) => console.say("raise --max-hexes, --cap or --width, or use --strategy auto"),
        (_, Some(log)) if log.exists() => {
            console.say(format!("stopped; the same command goes on from {}", log.display()));
        }
        _ => console.say("stopped before the search was done"),
    }
}

/// The report for a person.
pub(super) fn say(output: &Output, args: &FillArgs, console: &Console) {
    for mesh in &output.meshes {
        say_mesh(mesh, console);
        if !mesh.files.is_empty() {
            console.say(format!("written: {}", mesh.files.join(", ")));
        } else if args.require_valid {
            console.say("nothing written: --require-valid");
        } else {
            console.say("nothing written: give -o OUT");
        }
    }
    if let Some(choice) = &output.choice {
        console.say(format!("choice: {choice}"));
    }
    if output.meshes.len() < args.count as usize {
        console.say(format!("{} of {} meshes asked for were found", output.meshes.len(), args.count));
    }
    say_end(output.stopped, output.seconds, console);
}

/// The last lines: whether the work was stopped, and how long it took.
pub(super) fn say_end(stopped: StopReason, seconds: f64, console: &Console) {
    if stopped != StopReason::Finished {
        console.say(format!("stopped early ({stopped}); a longer run may bring a better mesh"));
    }
    console.say(format!("{seconds:.2} s"));
}

/// The lines about one mesh.
pub(super) fn say_mesh(mesh: &MeshOutput, console: &Console) {
    let r = &mesh.report;
    console.say(format!(
        "{}: {} quads filled with {} hex{} ({:.1} per quad), {} interior vertices{}, by {}",
        r.surface,
        r.quads,
        r.hexes,
        if r.hexes == 1 { "" } else { "es" },
        r.hexes_per_quad,
        r.interior_vertices,
        r.sheets.map_or(String::new(), |n| format!(", {n} sheets")),
        r.route.words(),
    ));
    if r.stages.len() > 1 {
        let stages: Vec<String> = r.stages.iter().map(|(stage, n)| format!("{n} {stage}")).collect();
        console.say(format!("hexes by step: {}", stages.join(", ")));
    }
    console.say("connectivity: judged proper, boundary = surface (L1-L3)");
    match &mesh.geometry {
        Some(geometry) => {
            console.say(format!("geometry: {geometry}"));
            if let Some(line) = geometry.distribution().filter(|_| geometry.hexes > 1) {
                console.say(format!("scaled Jacobians: {line}"));
            }
            if geometry.ways > 1 {
                let ways = geometry.ways;
                console.say(format!("lies on the surface in {ways} ways that are not congruent; the best was kept"));
            }
        }
        None => console.say("geometry: none, the surface has no coordinates"),
    }
}
