//! `hexfill fill SURFACE -o MESH`: the main job.

mod args;
mod regions;
mod said;

use crate::commands::view::{Shown, groups};
use crate::console::Console;
use crate::exit::Exit;
use crate::files;
use anyhow::bail;
pub(crate) use args::FillArgs;
use args::{default_log, fill_options, place_options};
use hexfill::io::MeshData;
use hexfill::{Context, FillError, FillReport, Filled, Placed, Problem, ProblemError};
use said::{MeshOutput, Output, say, say_none};
use std::time::Instant;

/// Fills, judges, writes, reports.
pub(crate) fn run(args: &FillArgs, console: &Console, ctx: &Context<'_>) -> anyhow::Result<Exit> {
    let result = fill(args, console, ctx);
    let is_sick = |error: &anyhow::Error| {
        let by_faces = matches!(error.downcast_ref(), Some(ProblemError::Surface { .. } | ProblemError::Seams { .. }));
        by_faces || matches!(error.downcast_ref(), Some(FillError::NoMesh(_)))
    };
    if result.as_ref().is_err_and(is_sick) {
        console.note(format!(
            "`hexfill doctor {}` says everything that is wrong at once, and what --fix can mend",
            args.surface
        ));
    }
    result
}

fn fill(args: &FillArgs, console: &Console, ctx: &Context<'_>) -> anyhow::Result<Exit> {
    let start = Instant::now();
    check_files(args, console)?;
    let problem = match input(args)? {
        Input::Surface(problem) => *problem,
        Input::Regions(data, regions) => return regions::run(args, &data, &regions, console, ctx),
    };
    let notes: Vec<String> = problem.notes().iter().cloned().chain(crossing_note(&problem)).collect();
    for note in &notes {
        console.note(note);
    }
    if let Some(output) = &args.output {
        args.writing.check_mesh(output, &boundary_data(&problem))?;
    }
    let own_log = args.growth_log.is_none().then(|| default_log(args)).flatten();
    let options = fill_options(args, own_log.clone(), ctx)?;
    let how = place_options(args);
    let estimate = hexfill::estimate(&problem, &options, &how);
    if let Some(estimate) = &estimate {
        console.say(format!("estimate: {estimate}"));
    }
    let result = hexfill::fill_placed(&problem, &options, &how, ctx)?;
    let mut output = Output {
        meshes: Vec::new(),
        stopped: result.stop,
        exit_code: Exit::of_stop(result.stop, Exit::No) as u8,
        seconds: start.elapsed().as_secs_f64(),
        notes,
        choice: result.choice.clone(),
        estimate,
    };
    if result.meshes.is_empty() {
        output.notes = result.tried.iter().map(ToString::to_string).collect();
        if console.json {
            console.print_json(&output)?;
        }
        say_none(&result, options.growth_log(), console);
        return Ok(Exit::of_stop(result.stop, Exit::No));
    }
    if let Some(log) = own_log.filter(|log| log.exists()) {
        std::fs::remove_file(log)?;
    }
    if problem.points().is_none() && result.meshes[0].1.is_some() {
        console.note("the surface has no coordinates; those of its canonical polyhedron are used");
    }
    let mut all_valid = true;
    for (i, (filled, placed)) in result.meshes.iter().enumerate() {
        let report = FillReport::new(&problem, filled, &result.tried);
        let valid = args.no_embed || placed.as_ref().is_none_or(Placed::is_certified);
        all_valid &= valid;
        let mut mesh = MeshOutput { report, geometry: placed.as_ref().map(Placed::report), files: Vec::new() };
        if valid || !args.require_valid {
            let suffix = (args.count > 1).then_some(i + 1);
            mesh.files = write_mesh(args, &problem, filled, placed.as_ref(), suffix, console)?;
        }
        output.meshes.push(mesh);
    }
    let enough = output.meshes.len() == args.count as usize;
    let exit = Exit::of_stop(result.stop, if all_valid && enough { Exit::Done } else { Exit::No });
    output.exit_code = exit as u8;
    output.seconds = start.elapsed().as_secs_f64();
    if console.json {
        console.print_json(&output)?;
    } else {
        say(&output, args, console);
    }
    Ok(exit)
}

/// One surface, or several regions at once.
enum Input {
    Surface(Box<Problem>),
    Regions(Box<MeshData>, Vec<hexfill::Region>),
}

fn input(args: &FillArgs) -> anyhow::Result<Input> {
    if hexfill::is_named(&args.surface) {
        return Ok(Input::Surface(Box::new(files::load_problem(&args.surface, &args.reading)?)));
    }
    let name = if args.surface == "-" { "stdin" } else { &args.surface };
    let data = files::read_data(&args.surface, &args.reading)?;
    let surface = Problem::from_data(name, &data);
    if hexfill::has_regions(&data, &surface) {
        let regions = hexfill::regions(name, &data)?;
        if !regions.is_empty() {
            return Ok(Input::Regions(Box::new(data), regions));
        }
    }
    Ok(Input::Surface(Box::new(surface?)))
}

/// A word on quads that cross: work on them is in vain.
fn crossing_note(problem: &Problem) -> Option<String> {
    let pairs = hexfill::crossing_quads(problem);
    let first: Vec<String> = pairs.iter().take(3).map(|[a, b]| format!("{a} and {b}")).collect();
    let more = if pairs.len() > 3 { ", ..." } else { "" };
    let count = match pairs.len() {
        0 => return None,
        1 => "a pair".to_owned(),
        n => format!("{n} pairs"),
    };
    Some(format!(
        "{count} of quads cross or touch ({}{more}): a mesh of this surface overlaps itself; see `hexfill doctor`",
        first.join(", ")
    ))
}

/// Refuses files that cannot be written, or would be written twice, before any work is done.
fn check_files(args: &FillArgs, console: &Console) -> anyhow::Result<()> {
    if let Some(output) = &args.output {
        args.writing.check(output, &args.reading, console)?;
    }
    for file in args.view.iter().chain(&args.picture) {
        files::check_folder(file)?;
    }
    if let Some(picture) = args.picture.as_ref().filter(|p| !p.to_ascii_lowercase().ends_with(".png")) {
        bail!("{picture}: pictures are PNG; give a name that ends in .png");
    }
    if console.json && args.output.as_deref() == Some("-") {
        bail!("--json and -o - both write to stdout; give a file to one of them");
    }
    let written = [&args.output, &args.view, &args.picture];
    let named: Vec<&str> = std::iter::once(&args.surface)
        .filter(|s| !hexfill::is_named(s))
        .chain(written.into_iter().flatten())
        .map(String::as_str)
        .collect();
    files::check_distinct(&named)
}

/// What is known of the mesh before there is one: its boundary. A sphere without positions will get some.
fn boundary_data(problem: &Problem) -> MeshData {
    let mut data = problem.data();
    if problem.points().is_none() && problem.surface().is_sphere() {
        (data.has_coordinates, data.points) = (true, vec![[0.0; 3]; problem.surface().n_vertices()]);
    }
    data
}

/// Writes the mesh, its page and its picture; returns the names of the files.
fn write_mesh(
    args: &FillArgs,
    problem: &Problem,
    filled: &Filled,
    placed: Option<&Placed>,
    suffix: Option<usize>,
    console: &Console,
) -> anyhow::Result<Vec<String>> {
    let named = |path: &str| match suffix {
        Some(i) if path != "-" => numbered(path, i),
        _ => path.to_owned(),
    };
    let mut written = Vec::new();
    if let Some(output) = &args.output {
        let mut data = hexfill::mesh_data(problem, filled.mesh(), placed.map(|p| p.points().to_vec()));
        if let Some(placed) = placed.filter(|_| !args.no_embed) {
            placed.flag(&mut data);
        }
        filled.flag(&mut data);
        let path = named(output);
        args.writing.write(&path, &data, console)?;
        written.push(path);
    }
    if args.view.is_none() && args.picture.is_none() {
        return Ok(written);
    }
    let Some(placed) = placed else { bail!("no positions to draw: the surface has none") };
    let shown = Shown {
        title: files::short_name(problem.name()),
        points: placed.points(),
        mesh: filled.mesh(),
        values: if args.no_embed { None } else { Shown::by_quality(placed.scaled_jacobians()) },
        groups: groups(filled.mesh(), &problem.data(), false),
        facts: vec![
            ("made by".to_owned(), filled.route().words().to_owned()),
            ("geometry".to_owned(), placed.report().to_string()),
        ],
    };
    written.extend(shown.write(args.view.as_deref().map(named), args.picture.as_deref().map(named))?);
    Ok(written)
}

/// `mesh.vtk` and 2 -> `mesh-2.vtk`; `mesh.vtk.gz` -> `mesh-2.vtk.gz`.
fn numbered(path: &str, i: usize) -> String {
    let name_start = path.rfind('/').map_or(0, |at| at + 1);
    let dot = path[name_start..].find('.').map_or(path.len(), |at| name_start + at);
    format!("{}-{i}{}", &path[..dot], &path[dot..])
}

#[cfg(test)]
mod tests {
    #[test]
    fn numbered_paths_keep_their_extension() {
        assert_eq!(super::numbered("a.b/mesh.vtk.gz", 2), "a.b/mesh-2.vtk.gz");
        assert_eq!(super::numbered("mesh", 1), "mesh-1");
    }
}
