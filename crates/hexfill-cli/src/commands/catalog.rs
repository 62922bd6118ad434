//! `hexfill catalog list|show`.

use crate::console::Console;
use crate::exit::Exit;
use crate::files;
use anyhow::bail;
use hexfill::catalog::{self, Entry};
use hexfill::{Problem, ProblemError};
use serde::Serialize;

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
        /// Write the best mesh known to this file (connectivity in JSON; other formats need coordinates).
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
pub(crate) fn run(args: &CatalogArgs, console: &Console) -> anyhow::Result<Exit> {
    match args.command.as_ref().unwrap_or(&CatalogCommand::List) {
        CatalogCommand::List => {
            let all = catalog::entries().iter().map(describe).collect::<anyhow::Result<Vec<_>>>()?;
            if console.json {
                console.print_json(&all)?;
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
                let Some(data) = entry.best_mesh() else { bail!("no mesh is shipped for {}", shown.name) };
                files::write_data(path, None, &data, console)?;
            }
        }
    }
    Ok(Exit::Done)
}
