//! `hexfill search SURFACE --max-hexes H [RES/MOD]`: every hex ball with at most H hexes on a sphere, or the proof that there is none.

use super::enumerate::parse_part;
use crate::console::Console;
use crate::exit::Exit;
use crate::files;
use anyhow::{Context as _, bail};
use hexfill::io::MeshData;
use hexfill::mesh::{HexMesh, hex_signature, is_shellable};
use hexfill::unstable::ledger::{Chunk, default_chunks};
use hexfill::unstable::prove::{Mesh, Plan, Problem, ProveError, Searched, Subgroup, merge, search};
use hexfill::{Context, StopReason};
use serde_json::json;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Flags of `search`.
#[derive(clap::Args)]
pub(crate) struct SearchArgs {
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
    /// Write each mesh found into this folder (JSON, connectivity; the boundary's vertices first), named by its number of hexes.
    #[arg(short, long, value_name = "DIR", conflicts_with = "part")]
    output: Option<PathBuf>,
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
pub(crate) fn run(args: &SearchArgs, threads: usize, console: &Console, ctx: &Context<'_>) -> anyhow::Result<Exit> {
    let started = Instant::now();
    let input = files::load_problem(&args.surface, &args.reading)?;
    let problem = Problem::new(input.surface(), args.max_hexes.unwrap_or(1))?;
    let classes = problem.symmetries().subgroup_classes();
    if args.list_symmetries {
        return list_symmetries(&problem, &classes, console);
    }
    let group = group_of(&args.symmetry, &problem, &classes)?;
    let problem = problem.with_group(group);
    let question = Question::new(args, &problem);
    if let Some(folder) = &args.output {
        std::fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    }
    let plan = match Plan::prepare(problem, ctx) {
        Err(ProveError::Stopped { reason }) => return stopped(&question, reason, console),
        plan => plan?,
    };
    let part = args.part.unwrap_or(Chunk { index: 0, of: 1 });
    let chunks = args.chunks.unwrap_or_else(|| default_chunks(part.of));
    let result = match &args.checkpoint {
        Some(folder) if args.merge => merge(&plan, folder),
        folder => search(&plan, part, chunks, folder.as_deref(), threads, ctx),
    };
    let searched = match result {
        Err(ProveError::Stopped { reason }) => return stopped(&question, reason, console),
        searched => searched?,
    };
    if searched.dropped_bytes > 0 {
        console.note(format!("a torn last line of {} bytes was dropped from the ledger", searched.dropped_bytes));
    }
    let answer = Answer::new(question, &plan, &searched, part)?;
    if let Some(folder) = &args.output {
        answer.write(folder, &input.surface().quads_raw(), console)?;
    }
    if console.json {
        console.print_json(&answer.json(started))?;
    } else {
        answer.tell(console)?;
    }
    Ok(answer.exit())
}

/// Prints the classes of subgroups with the numbers `--symmetry` takes.
fn list_symmetries(problem: &Problem, classes: &[Subgroup], console: &Console) -> anyhow::Result<Exit> {
    let words: Vec<String> = classes.iter().map(|&group| problem.symmetries().describe(group)).collect();
    if console.json {
        console.print_json(&json!({ "json_version": 1, "symmetries": words, "exit_code": Exit::Done as i32 }))?;
        return Ok(Exit::Done);
    }
    for (i, words) in words.iter().enumerate() {
        console.print(format!("{i}: {words}"))?;
    }
    Ok(Exit::Done)
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

/// What is asked, in words.
struct Question<'a> {
    args: &'a SearchArgs,
    boundary: String,
    symmetry: String,
    class: String,
    max_hexes: usize,
}

impl<'a> Question<'a> {
    fn new(args: &'a SearchArgs, problem: &Problem) -> Self {
        let symmetry = problem.symmetries().describe(problem.group());
        let kind = if args.shellable { "shellable hex balls" } else { "hex balls" };
        let class = match problem.group() {
            1 => kind.to_owned(),
            _ => format!("{kind} with symmetry of {symmetry}"),
        };
        Self { args, boundary: problem.signature().to_owned(), symmetry, class, max_hexes: problem.max_hexes() }
    }
}

/// Says that the search did not come to its end, so that nothing is proved.
fn stopped(question: &Question<'_>, reason: StopReason, console: &Console) -> anyhow::Result<Exit> {
    if console.json {
        console.print_json(&json!({
            "json_version": 1,
            "surface": question.args.surface,
            "class": question.class,
            "max_hexes": question.max_hexes,
            "exhausted": false,
            "stopped": reason.word(),
            "exit_code": Exit::Stopped as i32,
        }))?;
    } else {
        let kept = match question.args.checkpoint {
            Some(_) => "; the same command goes on from the checkpoint",
            None => "; with --checkpoint DIR it could go on",
        };
        console.say(format!("stopped before the end ({reason}): nothing is proved{kept}"));
    }
    Ok(Exit::Stopped)
}

/// What was found.
struct Answer<'a> {
    question: Question<'a>,
    /// In the input's ids, ascending by number of hexes, with signatures.
    meshes: Vec<(String, Mesh)>,
    counts: BTreeMap<usize, usize>,
    part: Chunk,
    searched: &'a Searched,
    nodes: u64,
    tasks: usize,
}

impl<'a> Answer<'a> {
    fn new(question: Question<'a>, plan: &Plan, searched: &'a Searched, part: Chunk) -> anyhow::Result<Self> {
        let mut meshes = Vec::new();
        for mesh in searched.outcome.meshes.values() {
            let mesh = plan.problem().in_input_ids(mesh);
            let glued = HexMesh::try_new(mesh.n_vertices, &mesh.hexes)?;
            if !question.args.shellable || is_shellable(&glued) {
                meshes.push((hex_signature(&glued)?, mesh));
            }
        }
        meshes.sort_by(|(a, x), (b, y)| (x.hexes.len(), a).cmp(&(y.hexes.len(), b)));
        let mut counts = BTreeMap::new();
        for (_, mesh) in &meshes {
            *counts.entry(mesh.hexes.len()).or_insert(0) += 1;
        }
        let nodes = searched.outcome.nodes + plan.split_nodes();
        Ok(Self { question, meshes, counts, part, searched, nodes, tasks: plan.n_tasks() })
    }

    /// Whether all of the tree was searched, not a part of it.
    fn is_whole(&self) -> bool {
        self.part.of == 1
    }

    /// "No" is proved by the whole search alone.
    fn exit(&self) -> Exit {
        if self.is_whole() && self.meshes.is_empty() { Exit::No } else { Exit::Done }
    }

    /// Writes the meshes listed, each with the surface it fills: `36-1.json`, `36-2.json`, ... in the order of the list.
    fn write(&self, folder: &Path, quads: &[[u32; 4]], console: &Console) -> anyhow::Result<()> {
        let mut last = (0, 0);
        for (_, mesh) in &self.meshes {
            let n = mesh.hexes.len();
            last = if last.0 == n { (n, last.1 + 1) } else { (n, 1) };
            let data = MeshData {
                quads: quads.to_vec(),
                hexes: mesh.hexes.clone(),
                has_coordinates: false,
                ..MeshData::default()
            };
            let path = folder.join(format!("{n}-{}.json", last.1));
            files::write_data(&path.to_string_lossy(), None, &data, console)?;
        }
        console.say(format!("written to {}: {} meshes", folder.display(), self.meshes.len()));
        Ok(())
    }

    /// The result in one line.
    fn verdict(&self) -> String {
        let Question { class, max_hexes, .. } = &self.question;
        match (self.is_whole(), self.meshes.len()) {
            (false, n) => {
                format!("part {}/{} is done: classes found: {n}; add up with --merge", self.part.index, self.part.of)
            }
            (true, 0) => format!("exhausted: no mesh with at most {max_hexes} hexes in this class ({class})"),
            (true, n) => format!("exhausted: classes with at most {max_hexes} hexes: {n} ({class})"),
        }
    }

    fn json(&self, started: Instant) -> serde_json::Value {
        let listed = if self.question.args.count_all { &[] } else { self.meshes.as_slice() };
        let meshes: Vec<_> = listed
            .iter()
            .map(
                |(signature, mesh)| json!({ "signature": signature, "vertices": mesh.n_vertices, "hexes": mesh.hexes }),
            )
            .collect();
        let counts: Vec<_> =
            self.counts.iter().map(|(hexes, classes)| json!({ "hexes": hexes, "classes": classes })).collect();
        let outcome = &self.searched.outcome;
        json!({
            "json_version": 1,
            "surface": self.question.args.surface,
            "boundary": self.question.boundary,
            "class": self.question.class,
            "max_hexes": self.question.max_hexes,
            "symmetry": self.question.symmetry,
            "shellable": self.question.args.shellable,
            "exhausted": self.is_whole(),
            "stopped": StopReason::Finished.word(),
            "counts": counts,
            "meshes": meshes,
            "nodes": self.nodes,
            "tasks": self.tasks,
            "chunks": self.searched.chunks,
            "chunks_found_done": self.searched.found_done,
            "tree_sum": format!("{:032x}", outcome.tree_sum),
            "hash_sum": format!("{:032x}", outcome.hash_sum()),
            "cpu_seconds": self.searched.cpu_nanoseconds as f64 / 1e9,
            "seconds": started.elapsed().as_secs_f64(),
            "exit_code": self.exit() as i32,
        })
    }

    fn tell(&self, console: &Console) -> anyhow::Result<()> {
        if !self.question.args.count_all {
            for (signature, _) in &self.meshes {
                console.print(signature)?;
            }
        }
        for (hexes, classes) in &self.counts {
            console.print(format!("{hexes} hexes: {classes}"))?;
        }
        console.print(self.verdict())?;
        let outcome = &self.searched.outcome;
        console.say(format!(
            "{} nodes, tree sum {:032x}, hash sum {:032x}, processor time {:.1} s",
            self.nodes,
            outcome.tree_sum,
            outcome.hash_sum(),
            self.searched.cpu_nanoseconds as f64 / 1e9
        ));
        Ok(())
    }
}
