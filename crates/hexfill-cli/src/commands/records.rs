//! `hexfill records`: what is known of the problems whose best mesh the catalogue holds and of whole families of surfaces, and what was proved.

use super::families::{self, families, is_exact_ball, verdict};
use crate::console::Console;
use crate::exit::Exit;
use hexfill::catalog::{self, Entry, Record};
use hexfill::io::MeshData;
use hexfill::{Context, Problem};
use serde::Serialize;
use serde_json::json;

/// Flags of `records`.
#[derive(clap::Args)]
pub(crate) struct RecordsArgs {
    /// Judge every mesh anew: levels L1 to L3, its boundary the problem's, a ball.
    #[arg(long)]
    verify: bool,
}

/// A row of the table.
#[derive(Serialize)]
struct Row {
    problem: String,
    /// What follows, in words.
    #[serde(skip)]
    record: Record,
    quads: usize,
    /// Hexes of the mesh in the catalogue.
    hexes: usize,
    published: Option<usize>,
    published_by: Option<&'static str>,
    /// At least so many hexes are needed, of any hex ball.
    needed: Option<usize>,
    /// What writes the mesh.
    mesh_command: String,
    /// What proves the bound.
    bound_command: Option<String>,
    /// With `--verify`: whether the mesh was judged a ball with this boundary.
    verified: Option<bool>,
}

/// Prints the table; exit code 1 if a mesh does not stand up to the judge.
pub(crate) fn run(args: &RecordsArgs, console: &Console, ctx: &Context<'_>) -> anyhow::Result<Exit> {
    let entries = catalog::entries().iter().filter_map(|entry| entry.best_mesh().map(|mesh| (entry, mesh)));
    let rows = entries.map(|(entry, mesh)| row(entry, &mesh, args.verify, ctx)).collect::<anyhow::Result<Vec<_>>>()?;
    let families = families(args.verify, ctx)?;
    let mut verdicts = rows.iter().map(|row| row.verified).chain(families.iter().map(|family| family.verified));
    let stands = verdicts.all(|verified| verified != Some(false));
    let mut exit = if stands { Exit::Done } else { Exit::No };
    if args.verify
        && let Some(stop) = ctx.stop()
    {
        exit = Exit::of_stop(stop, exit);
    }
    if console.json {
        console.print_json(
            &json!({ "json_version": 1, "records": rows, "families": families, "exit_code": exit as i32 }),
        )?;
    } else {
        for row in &rows {
            console.print(line(row))?;
        }
        for family in &families {
            console.print(families::line(family))?;
        }
    }
    Ok(exit)
}

fn row(entry: &Entry, mesh: &MeshData, verify: bool, ctx: &Context<'_>) -> anyhow::Result<Row> {
    let Entry { name, record, .. } = entry;
    let problem = Problem::named(name)?;
    Ok(Row {
        problem: format!(":{name}"),
        record: *record,
        quads: problem.surface().n_quads(),
        hexes: mesh.hexes.len(),
        published: record.published.map(|(hexes, _)| hexes),
        published_by: record.published.map(|(_, by)| by),
        needed: record.needed(),
        mesh_command: format!("hexfill catalog show {name} --mesh {name}.json"),
        bound_command: record.exhausted.map(|most| format!("hexfill search :{name} --max-hexes {most}")),
        verified: verify.then(|| stands(mesh, &problem, ctx)).flatten(),
    })
}

/// Whether the judge finds the stored mesh to be a ball that fills the problem's surface; `None` if it was stopped.
fn stands(mesh: &MeshData, problem: &Problem, ctx: &Context<'_>) -> Option<bool> {
    hexfill::with_judged(mesh, Some(problem), |judged| is_exact_ball(judged, ctx))
}

fn line(row: &Row) -> String {
    let verified = verdict(row.verified);
    format!("{:<20} {:>2} quads  {}{verified}", row.problem, row.quads, row.record)
}
