//! `hexfill fill` where the file has several regions with shared walls, or a void among its hexes: each is filled by itself, the whole is written.

use super::args::{FillArgs, fill_options, place_options};
use super::said::{MeshOutput, say_end, say_mesh};
use crate::commands::view::{Shown, groups};
use crate::console::Console;
use crate::exit::Exit;
use crate::files;
use anyhow::bail;
use hexfill::io::MeshData;
use hexfill::mesh::HexMesh;
use hexfill::unstable::check::{Judged, Level, Options, Rule, judge};
use hexfill::{Context, FillReport, FilledRegions, Placed, Region, StopReason};
use serde::Serialize;
use std::time::Instant;

#[derive(Serialize)]
struct Output {
    /// One for each region, in the order of their first face; hexes carry the number as tag, from 1.
    regions: Vec<MeshOutput>,
    /// Hexes of the whole, those of the file included.
    hexes: usize,
    files: Vec<String>,
    stopped: StopReason,
    exit_code: u8,
    seconds: f64,
    notes: Vec<String>,
}

/// Fills all regions and writes the whole.
pub(super) fn run(
    args: &FillArgs,
    data: &MeshData,
    regions: &[Region],
    console: &Console,
    ctx: &Context<'_>,
) -> anyhow::Result<Exit> {
    let start = Instant::now();
    if args.count > 1 || args.best_of.is_some() || args.tets.is_some() || args.tetgen.is_some() {
        bail!(
            "{} has {} regions; --count, --best-of, --tets and --tetgen are for one surface",
            args.surface,
            regions.len()
        );
    }
    for note in &data.notes {
        console.note(note);
    }
    if let Some(output) = &args.output {
        args.writing.check_mesh(output, data)?;
    }
    let options = fill_options(args, None, ctx)?;
    let whole = hexfill::fill_regions(data, regions, &options, &place_options(args), ctx)?;
    let mut notes = data.notes.clone();
    if whole.given_invalid > 0 {
        notes.push(format!("{} hexes of the file itself have no certificate of det J > 0", whole.given_invalid));
        console.note(&notes[notes.len() - 1]);
    }
    if let Some(note) = pinched_note(&whole) {
        console.note(&note);
        notes.push(note);
    }
    let valid = args.no_embed || whole.is_certified();
    let files =
        if whole.is_complete() && (valid || !args.require_valid) { write(args, &whole, console)? } else { Vec::new() };
    let made = regions.iter().zip(&whole.fills).filter_map(|(region, fill)| {
        let (filled, placed) = fill.meshes.first()?;
        let report = FillReport::new(&region.problem, filled, &fill.tried);
        Some(MeshOutput { report, geometry: placed.as_ref().map(Placed::report), files: Vec::new() })
    });
    let exit = Exit::of_stop(whole.stop, if valid && whole.is_complete() { Exit::Done } else { Exit::No });
    let output = Output {
        regions: made.collect(),
        hexes: whole.data.hexes.len(),
        files,
        stopped: whole.stop,
        exit_code: exit as u8,
        seconds: start.elapsed().as_secs_f64(),
        notes,
    };
    if console.json {
        console.print_json(&output)?;
    } else {
        say(&output, regions.len(), args, console);
    }
    Ok(exit)
}

/// A word on solids that touch in edges or vertices alone: each of them passes level 3, the whole does not.
fn pinched_note(whole: &FilledRegions) -> Option<String> {
    let judged = Judged::connectivity(whole.data.vertex_count(), &whole.data.hexes);
    let options = Options::default().with_up_to(Level::L3).with_betti(false).with_quality(false);
    let report = judge(&judged, &options, &Context::default());
    let count = |rule: Rule| report.failures.iter().find(|f| f.rule == rule).map_or(0, |f| f.count);
    let (edges, vertices) = (count(Rule::EdgePinched), count(Rule::VertexPinched));
    (edges + vertices > 0).then(|| {
        format!(
            "solids touch in edges ({edges}) or vertices ({vertices}) alone, as the file has it: there the whole is no manifold; give each solid points \
             of its own to part them"
        )
    })
}

fn say(output: &Output, n_regions: usize, args: &FillArgs, console: &Console) {
    for (i, region) in output.regions.iter().enumerate() {
        if n_regions > 1 {
            console.say(format!("region {} of {n_regions}:", i + 1));
        }
        say_mesh(region, console);
    }
    console.say(format!("the whole: {} hexes, judged proper (L1-L2)", output.hexes));
    if output.regions.len() < n_regions {
        console.say(format!("{} of {n_regions} regions were filled; nothing written", output.regions.len()));
    } else if output.files.is_empty() {
        console.say(if args.require_valid {
            "nothing written: --require-valid"
        } else {
            "nothing written: give -o OUT"
        });
    } else {
        console.say(format!("written: {}", output.files.join(", ")));
    }
    say_end(output.stopped, output.seconds, console);
}

/// Writes the mesh, its page and its picture; returns the names of the files.
fn write(args: &FillArgs, whole: &FilledRegions, console: &Console) -> anyhow::Result<Vec<String>> {
    let mut written = Vec::new();
    if let Some(output) = &args.output {
        args.writing.write(output, &whole.data, console)?;
        written.push(output.clone());
    }
    if args.view.is_none() && args.picture.is_none() {
        return Ok(written);
    }
    let mesh = HexMesh::try_new(whole.data.points.len(), &whole.data.hexes)?;
    let quality =
        whole.data.hex_data.iter().find(|(name, _)| name == "scaled_jacobian").map(|(_, values)| values.clone());
    let shown = Shown {
        title: files::short_name(&args.surface),
        points: &whole.data.points,
        mesh: &mesh,
        values: quality.filter(|values| values.iter().all(|x| x.is_finite())).and_then(Shown::by_quality),
        groups: groups(&mesh, &whole.data, false),
        facts: vec![("regions".to_owned(), whole.fills.len().to_string())],
    };
    written.extend(shown.write(args.view.clone(), args.picture.clone())?);
    Ok(written)
}
