//! `hexfill search SURFACE --max-hexes H [RES/MOD]`: every hex ball with at most H hexes on a sphere, or the proof that there is none.

use super::enumerate::parse_part;
use crate::console::Console;
use crate::exit::Exit;
use crate::files;
use anyhow::{Context as _, bail};
use hexfill::Context;
use hexfill::unstable::ledger::{Chunk, default_chunks};
use hexfill::mesh::hex_signature;
use hexfill::unstable::prove::{Mesh, Plan, Problem, ProveError, Searched, Subgroup, is_shellable, merge, search};
use serde_json::json;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::time::Instant;

/// Flags of `search`.
#[derive(clap::Args)]
pub struct SearchArgs {
    /// The surface: one three-connected sphere of quads, connectivity only.
    surface: String,
    /// Do only part RES of MOD, for job arrays: the parts together are the whole. Needs --checkpoint.
    #[arg(value_name = "RES/MOD", value_parser = parse_part, requires = "checkpoint")]
    part: Option<Chunk>,
    /// Meshes with at most so many hexes.
    #[arg(long, value_name = "H", required_unless_present = "list_symmetries")]
    max_hexes: Option<usize>,
    /// Only meshes with these symmetries: none (all meshes), auto (all the boundary has), or a number that --list-symmetries prints.
    #[arg(long, default_value = "none", value_name = "none|auto|K")]
    symmetry: String,
    /// Print the subgroups of the boundary's symmetries, one of each class of conjugate ones, and end.
    #[arg(long)]
    list_symmetries: bool,
    /// List only meshes that can be built hex by hex, a ball at every step. (What is searched is the same.)
    #[arg(long)]
    shellable: bool,
    /// Print only the number of meshes by number of hexes, not their signatures.
    #[arg(long)]
    count_all: bool,
    /// Keep a ledger of finished chunks here; the same command goes on where a killed run stopped.
    #[arg(long, value_name = "DIR")]
    checkpoint: Option<PathBuf>,
    /// Add up the ledgers in the folder of --checkpoint instead of searching.
    #[arg(long, requires = "checkpoint", conflicts_with = "part")]
    merge: bool,
    /// Number of chunks [default: 1024, or the next multiple of MOD].
    #[arg(long, value_name = "K")]
    chunks: Option<usize>,
    #[command(flatten)]
    reading: files::InputArgs,
}

/// Searches, or adds up what others searched.
pub fn run(args: &SearchArgs, threads: usize, console: &Console, ctx: &Context<'_>) -> anyhow::Result<Exit> {
    let started = Instant::now();
    let read = files::load_problem(&args.surface, &args.reading)?;
    let problem = Problem::new(read.surface(), args.max_hexes.unwrap_or(1))?;
    let classes = problem.symmetries().subgroup_classes();
    if args.list_symmetries {
        for (i, &group) in classes.iter().enumerate() {
            console.print(format!("{i}: {}", problem.symmetries().describe(group)))?;
        }
        return Ok(Exit::Done);
    }
    let group = group_of(&args.symmetry, &problem, &classes)?;
    let problem = problem.with_group(group);
    let stopped = |error: ProveError| match error {
        ProveError::Stopped { .. } => {
            let kept = if args.checkpoint.is_some() { "; the same command goes on from the checkpoint" } else { "" };
            console.say(format!("{error}: nothing is proved{kept}"));
            Ok(Exit::Stopped)
        }
        error => Err(error.into()),
    };
    let plan = match Plan::prepare(problem, ctx) {
        Ok(plan) => plan,
        Err(error) => return stopped(error),
    };
    let part = args.part.unwrap_or(Chunk { index: 0, of: 1 });
    let chunks = args.chunks.unwrap_or_else(|| default_chunks(part.of));
    let result = match &args.checkpoint {
        Some(folder) if args.merge => merge(&plan, folder),
        folder => search(&plan, part, chunks, folder.as_deref(), threads, ctx),
    };
    let searched = match result {
        Ok(searched) => searched,
        Err(error) => return stopped(error),
    };
    if searched.dropped_bytes > 0 {
        console.note(format!("a torn last line of {} bytes was dropped from the ledger", searched.dropped_bytes));
    }
    report(args, &plan, &searched, part, started, console)
}

/// The subgroup that `--symmetry` names.
fn group_of(text: &str, problem: &Problem, classes: &[Subgroup]) -> anyhow::Result<Subgroup> {
    match text {
        "none" => Ok(1),
        "auto" => Ok(problem.symmetries().whole()),
        number => match number.parse().ok().and_then(|i: usize| classes.get(i)) {
            Some(&group) => Ok(group),
            None => bail!("--symmetry {text}: none, auto, or a number below {} (see --list-symmetries)", classes.len()),
        },
    }
}

/// Says what was found and what that proves.
fn report(
    args: &SearchArgs,
    plan: &Plan,
    searched: &Searched,
    part: Chunk,
    started: Instant,
    console: &Console,
) -> anyhow::Result<Exit> {
    let problem = plan.problem();
    let mut meshes: Vec<Mesh> = searched.outcome.meshes.values().map(|m| problem.in_input_ids(m)).collect();
    if args.shellable {
        meshes.retain(is_shellable);
    }
    meshes.sort_by_key(|m| m.hexes.len());
    let mut counts: BTreeMap<usize, usize> = BTreeMap::new();
    for mesh in &meshes {
        *counts.entry(mesh.hexes.len()).or_insert(0) += 1;
    }
    let whole = part.of == 1;
    let symmetry = problem.symmetries().describe(problem.group());
    let kind = if args.shellable { "shellable hex balls" } else { "hex balls" };
    let class = if problem.group() == 1 { kind.to_owned() } else { format!("{kind} with symmetry of {symmetry}") };
    let most = problem.max_hexes();
    let verdict = match (whole, meshes.is_empty()) {
        (false, _) => format!("part {}/{} done: {} meshes; add up with --merge", part.index, part.of, meshes.len()),
        (true, true) => format!("exhausted: no mesh with at most {most} hexes in this class ({class})"),
        (true, false) => {
            format!("exhausted: {} meshes with at most {most} hexes in this class ({class})", meshes.len())
        }
    };
    let exit = if whole && meshes.is_empty() { Exit::No } else { Exit::Done };
    let signature = |m: &Mesh| -> anyhow::Result<String> {
        Ok(hex_signature(&hexfill::mesh::HexMesh::try_new(m.n_vertices, &m.hexes).context("a judged mesh")?)?)
    };
    let nodes = searched.outcome.nodes + plan.split_nodes();
    if console.json {
        let listed: Vec<_> =
            if args.count_all { Vec::new() } else { meshes.iter().map(|m| json!({ "hexes": m.hexes })).collect() };
        let mut rows = listed;
        for (row, mesh) in rows.iter_mut().zip(&meshes) {
            row["signature"] = json!(signature(mesh)?);
        }
        console.print_json(&json!({
            "json_version": 1,
            "surface": args.surface,
            "boundary": problem.signature(),
            "class": class,
            "max_hexes": most,
            "symmetry": symmetry,
            "shellable": args.shellable,
            "exhausted": whole,
            "counts": counts.iter().map(|(hexes, classes)| json!({ "hexes": hexes, "classes": classes })).collect::<Vec<_>>(),
            "meshes": rows,
            "nodes": nodes,
            "tasks": plan.n_tasks(),
            "chunks": searched.chunks,
            "chunks_found_done": searched.found_done,
            "tree_sum": format!("{:032x}", searched.outcome.tree_sum),
            "hash_sum": format!("{:032x}", searched.outcome.hash_sum()),
            "cpu_seconds": searched.cpu_nanoseconds as f64 / 1e9,
            "seconds": started.elapsed().as_secs_f64(),
            "exit_code": exit as i32,
        }))?;
        return Ok(exit);
    }
    if !args.count_all {
        for mesh in &meshes {
            console.print(signature(mesh)?)?;
        }
    }
    for (hexes, classes) in &counts {
        console.say(format!("{hexes} hexes: {classes} classes"));
    }
    console.print(verdict)?;
    console.say(format!(
        "{nodes} nodes, tree sum {:032x}, hash sum {:032x}, processor time {:.1} s",
        searched.outcome.tree_sum,
        searched.outcome.hash_sum(),
        searched.cpu_nanoseconds as f64 / 1e9
    ));
    Ok(exit)
}
