//! `hexfill records`: what is known of the problems whose best mesh the catalogue holds, and what was proved.

use crate::console::Console;
use crate::exit::Exit;
use anyhow::Context as _;
use hexfill::catalog::{self, Entry};
use hexfill::unstable::check::{Ball, Level, Options, judge};
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

/// What others published about a problem, and the largest bound that `hexfill search` exhausted.
struct Known {
    name: &'static str,
    /// Fewest hexes published, and by whom.
    published: Option<(usize, &'static str)>,
    /// No ball has so many hexes or fewer, whatever its symmetry.
    exhausted: Option<usize>,
}

/// In the catalogue's order. The bounds are those of `record/search-2026-11-22.md`.
const KNOWN: [Known; 8] = [
    Known {
        name: "octagonal-spindle",
        published: Some((40, "Verhetsel, Pellerin, Remacle 2018")),
        exhausted: Some(22),
    },
    Known { name: "schneiders-pyramid", published: Some((36, "Xiang, Liu 2018")), exhausted: Some(19) },
    Known { name: "geode", published: Some((34, "joneuhauser/hex-templates 2026")), exhausted: None },
    Known { name: "buffer-cube-20", published: Some((40, "Verhetsel, Pellerin, Remacle 2019")), exhausted: None },
    Known { name: "buffer-cube-22", published: Some((40, "Verhetsel, Pellerin, Remacle 2019")), exhausted: None },
    Known { name: "carbonera-fig10", published: None, exhausted: None },
    Known { name: "refinement-9-1", published: Some((13, "joneuhauser/hex-templates 2026")), exhausted: None },
    Known { name: "refinement-16-4", published: Some((28, "joneuhauser/hex-templates 2026")), exhausted: None },
];

/// A row of the table.
#[derive(Serialize)]
struct Row {
    problem: String,
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
    let rows = KNOWN.iter().map(|known| row(known, args.verify, ctx)).collect::<anyhow::Result<Vec<_>>>()?;
    let stands = rows.iter().all(|row| row.verified != Some(false));
    let exit = if stands { Exit::Done } else { Exit::No };
    if console.json {
        console.print_json(&json!({ "json_version": 1, "records": rows, "exit_code": exit as i32 }))?;
    } else {
        for row in &rows {
            console.print(line(row))?;
        }
    }
    Ok(exit)
}

fn row(known: &Known, verify: bool, ctx: &Context<'_>) -> anyhow::Result<Row> {
    let entry = catalog::find(known.name).context(known.name)?;
    let problem = Problem::load(&format!(":{}", known.name), None)?;
    Ok(Row {
        problem: format!(":{}", known.name),
        quads: problem.surface().n_quads(),
        hexes: entry.best_mesh().context(known.name)?.hexes.len(),
        published: known.published.map(|(hexes, _)| hexes),
        published_by: known.published.map(|(_, by)| by),
        needed: known.exhausted.map(|most| most + 1),
        mesh_command: format!("hexfill catalog show {} --mesh {}.json", known.name, known.name),
        bound_command: known.exhausted.map(|most| format!("hexfill search :{} --max-hexes {most}", known.name)),
        verified: verify.then(|| stands(entry, &problem, ctx)).transpose()?,
    })
}

/// Whether the judge finds the stored mesh to be a ball that fills the problem's surface.
fn stands(entry: &Entry, problem: &Problem, ctx: &Context<'_>) -> anyhow::Result<bool> {
    let mesh = entry.best_mesh().context(entry.name)?;
    hexfill::with_judged(&mesh, Some(problem), |judged| {
        let report = judge(judged, &Options::default().with_up_to(Level::L3), ctx);
        Ok(report.passed(Level::L3) && report.facts.ball == Some(Ball::Yes))
    })
}

fn line(row: &Row) -> String {
    let published = match (row.published, row.published_by) {
        (Some(hexes), Some(by)) => format!("published {hexes} ({by})"),
        _ => "nothing published".to_owned(),
    };
    let needed = row.needed.map_or(String::new(), |n| format!("; at least {n} are needed"));
    let verified = match row.verified {
        Some(true) => "; judged: a ball, the boundary exact",
        Some(false) => "; REFUSED by the judge",
        None => "",
    };
    format!("{:<20} {:>2} quads  {:>2} hexes; {published}{needed}{verified}", row.problem, row.quads, row.hexes)
}
