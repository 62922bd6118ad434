//! `hexfill catalog list|show`.

use crate::console::Console;
use crate::exit::Exit;
use crate::files;
use anyhow::bail;
use hexfill::catalog::{self, Entry};
use hexfill::io::{Format, MeshData};
use hexfill::{Context, EmbedOptions, Problem, ProblemError, StopReason};
use serde::Serialize;
use std::path::Path;

/// Flags of `catalog`.
#[derive(clap::Args)]
pub(crate) struct CatalogArgs {
    #[command(subcommand)]
    command: Option<CatalogCommand>,
}

#[derive(clap::Subcommand)]
enum CatalogCommand {
    /// List all named problems (the default).
    List,
    /// Describe one problem.
    Show {
        /// Its name, with or without the colon.
        name: String,
        /// Write the surface to this file.
        #[arg(short, long, value_name = "OUT")]
        output: Option<String>,
        /// Write the best mesh known to this file: in JSON its connectivity alone, in other formats laid into the surface and embedded.
        #[arg(long, value_name = "OUT")]
        mesh: Option<String>,
    },
}

#[derive(Serialize)]
struct Shown {
    name: String,
    title: &'static str,
    quads: usize,
    vertices: usize,
    coordinates: bool,
    source: &'static str,
    best: String,
    mesh_hexes: Option<usize>,
    signature: String,
}

fn describe(entry: &Entry) -> anyhow::Result<Shown> {
    let name = format!(":{}", entry.name);
    let problem = Problem::load(&name, None)?;
    Ok(Shown {
        name,
        title: entry.title,
        quads: problem.surface().n_quads(),
        vertices: problem.surface().n_vertices(),
        coordinates: problem.points().is_some(),
        source: entry.source,
        best: entry.record.to_string(),
        mesh_hexes: entry.best_mesh().map(|m| m.hexes.len()),
        signature: hexfill::mesh::surface_signature(problem.surface()),
    })
}

/// Lists or shows.
pub(crate) fn run(args: &CatalogArgs, console: &Console, ctx: &Context<'_>) -> anyhow::Result<Exit> {
    match args.command.as_ref().unwrap_or(&CatalogCommand::List) {
        CatalogCommand::List => {
            let all = catalog::entries().iter().map(describe).collect::<anyhow::Result<Vec<_>>>()?;
            if console.json {
                console.print_json(&serde_json::json!({ "problems": all }))?;
            } else {
                for entry in all {
                    console.print(format!("{:<22} {:>3} quads  {}", entry.name, entry.quads, entry.best))?;
                }
            }
        }
        CatalogCommand::Show { name, output, mesh } => {
            let bare = name.strip_prefix(':').unwrap_or(name);
            let Some(entry) = catalog::find(bare) else {
                return Err(ProblemError::UnknownName { given: name.clone() }.into());
            };
            let shown = describe(entry)?;
            if console.json {
                console.print_json(&shown)?;
            } else {
                console.print(format!("{}\n  {}", shown.name, shown.title))?;
                console.print(format!("  {} quads, {} vertices", shown.quads, shown.vertices))?;
                console.print(format!("  source:    {}", shown.source))?;
                console.print(format!("  best:      {}", shown.best))?;
                console.print(format!("  signature: {}", shown.signature))?;
            }
            if let Some(path) = output {
                files::write_data(path, None, &entry.data(), console)?;
            }
            if let Some(path) = mesh {
                return write_best_mesh(entry, path, console, ctx);
            }
        }
    }
    Ok(Exit::Done)
}

/// The mesh stored for an entry. Where the format has to have coordinates it gets the surface's own, and those of the interior are embedded: exit
/// code 1 if some hex is not certified.
fn write_best_mesh(entry: &Entry, path: &str, console: &Console, ctx: &Context<'_>) -> anyhow::Result<Exit> {
    let Some(mut data) = entry.best_mesh() else { bail!("no mesh is shipped for :{}", entry.name) };
    files::check_output(path, None)?;
    if Format::from_path(Path::new(path))? == Format::Json {
        files::write_data(path, None, &data, console)?;
        return Ok(Exit::Done);
    }
    let Some(boundary) = Problem::named(entry.name)?.positions() else {
        bail!(
            ":{} has no coordinates, and none can be computed; write JSON, which holds connectivity alone",
            entry.name
        )
    };
    let surface = MeshData { points: boundary.clone(), has_coordinates: true, ..entry.data() };
    files::check_mesh_output(path, None, &surface)?;
    let placed = hexfill::embed_mesh(&data.hex_mesh()?, &boundary, None, &EmbedOptions::default(), ctx)?;
    console.say(placed.report().to_string());
    (data.points, data.has_coordinates) = (placed.points().to_vec(), true);
    placed.flag(&mut data);
    files::write_data(path, None, &data, console)?;
    let stop = placed.embedding().map_or(StopReason::Finished, |report| report.stop);
    Ok(Exit::of_stop(stop, if placed.is_certified() { Exit::Done } else { Exit::No }))
}
