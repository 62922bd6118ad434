//! `hexfill enumerate N [RES/MOD]`, and `merge`, `verify`, `show` for its checkpoints and objects.

use super::gallery::{self, Gallery};
use crate::console::Console;
use crate::exit::Exit;
use anyhow::{Context as _, bail};
use hexfill::Context;
use hexfill::unstable::enumerate::{
    Boundary, Chunk, Code, Complex, EnumerateError, Filter, Found, Header, LevelOptions, ListFormat, Params, Plan,
    Rule, Selection, Tally, Target, Wanted, all_levels, canonical, chunks_of_part, default_chunks, histograms, line,
    merge, mirror_lines, parse_range, read_ledgers, run_checkpointed, run_in_order, shape, strict_violations, table,
    weill_order,
};
use serde_json::json;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Flags of `enumerate`.
#[derive(clap::Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub(crate) struct EnumerateArgs {
    #[command(subcommand)]
    action: Option<Action>,
    /// Number of cubes (1 to 12).
    #[arg(required = true, value_name = "N")]
    cubes: Option<usize>,
    /// Do only part RES of MOD, for job arrays: the parts together are the whole.
    #[arg(value_name = "RES/MOD", value_parser = parse_part)]
    part: Option<Chunk>,
    /// Which meshes are legal: strict (proper intersection, with merging) or weill (the BruteBuilder's published table).
    #[arg(long, default_value = "strict", value_name = "RULE")]
    rule: Rule,
    /// Whether mirror images are the same mesh.
    #[arg(long, default_value = "same", value_name = "same|distinct")]
    mirror: Mirror,
    /// Also glue so that the mesh becomes non-orientable (rule strict).
    #[arg(long)]
    nonorientable: bool,
    /// From --filter-from cubes on, extend only meshes with at most K chords, and list only those.
    #[arg(long, value_name = "K")]
    max_chords: Option<u8>,
    /// First number of cubes at which --max-chords filters.
    #[arg(long, default_value_t = 8, value_name = "N", requires = "max_chords")]
    filter_from: usize,
    /// List only meshes with so many boundary quads (a..b, both included).
    #[arg(long, value_name = "A..B")]
    boundary_quads: Option<String>,
    /// List only balls.
    #[arg(long)]
    balls: bool,
    /// List only meshes whose boundary has this key, such as `8x[8,16] 8x[16,16]`.
    #[arg(long, value_name = "KEY")]
    only_key: Option<String>,
    /// Report meshes whose boundary is this: pyramid, spindle, buffer-20, buffer-22, carbonera-10, `all` of these, a key or a
    /// surface signature. May be repeated.
    #[arg(long, value_name = "BOUNDARY")]
    find: Vec<String>,
    /// Count only.
    #[arg(short = 'u', long)]
    count_only: bool,
    /// Write the objects here instead of stdout.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// How an object is written: signature (accepted wherever a mesh is), code (one word, fastest) or hexes (vertices, cubes,
    /// 8 vertices a cube).
    #[arg(long, default_value = "signature", value_name = "FORMAT")]
    format: ListFormat,
    /// Write a page with a drawing of each object (the first 200): the chords of its boundary, counts, key, signature, symmetries.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["checkpoint", "count_only"])]
    gallery: Option<String>,
    /// Keep a ledger of finished chunks here; the same command goes on where a killed run stopped.
    #[arg(long, value_name = "DIR")]
    checkpoint: Option<PathBuf>,
    /// Number of chunks [default: 1024, or the next multiple of MOD].
    #[arg(long, value_name = "K")]
    chunks: Option<usize>,
    /// auto, level (level by level with a set of hashes) or augment (canonical augmentation, in chunks).
    #[arg(long, default_value = "auto", value_name = "ENGINE")]
    engine: Engine,
    /// 64-bit hashes in the level engine: half the memory, a small chance of a wrong count.
    #[arg(long)]
    narrow_hashes: bool,
}

/// What to do with checkpoints and objects.
#[derive(clap::Subcommand)]
enum Action {
    /// Add up the ledgers of a checkpoint folder; refuses gaps, overlaps and mixed parameters.
    Merge {
        /// The checkpoint folder.
        folder: PathBuf,
        /// Write the listed objects here.
        #[arg(short, long, value_name = "FILE")]
        output: Option<PathBuf>,
        /// How an object is written.
        #[arg(long, default_value = "signature", value_name = "FORMAT")]
        format: ListFormat,
    },
    /// Check a checkpoint folder: checksums, sums, mass formula, and some chunks by running them again.
    Verify {
        /// The checkpoint folder.
        folder: PathBuf,
        /// How many chunks to run again, evenly spread.
        #[arg(long, default_value_t = 3, value_name = "N")]
        redo: usize,
    },
    /// Describe an object (a signature, a code, or cubes as "0 1 2 3 4 5 6 7; ...") or the state of a checkpoint folder.
    Show {
        /// Signature, code, cubes or folder.
        what: String,
    },
}

/// Whether mirror images count as one.
#[derive(Clone, Copy, PartialEq, Eq, Debug, clap::ValueEnum)]
enum Mirror {
    Same,
    Distinct,
}

/// How to enumerate.
#[derive(Clone, Copy, PartialEq, Eq, Debug, clap::ValueEnum)]
enum Engine {
    Auto,
    Level,
    Augment,
}

pub(super) fn parse_part(text: &str) -> Result<Chunk, String> {
    let part = text.split_once('/').and_then(|(r, m)| Some(Chunk { index: r.parse().ok()?, of: m.parse().ok()? }));
    match part {
        Some(part) if part.index < part.of => Ok(part),
        _ => Err(format!("`{text}` is no part: write RES/MOD with RES from 0 to MOD - 1, such as 0/16")),
    }
}

/// Enumerates, or does what the subcommand says.
pub(crate) fn run(args: &EnumerateArgs, threads: usize, console: &Console, ctx: &Context<'_>) -> anyhow::Result<Exit> {
    let outcome = match &args.action {
        None => enumerate(args, threads, console, ctx),
        Some(Action::Merge { folder, output, format }) => merge_folder(folder, output.as_ref(), *format, console),
        Some(Action::Verify { folder, redo }) => verify(folder, *redo, threads, console, ctx),
        Some(Action::Show { what }) => show(what, console),
    };
    match outcome {
        Err(error) if matches!(error.downcast_ref(), Some(EnumerateError::Stopped { .. })) => {
            console.say(format!("{error}"));
            Ok(Exit::Stopped)
        }
        other => other,
    }
}

/// Where objects go, one a line.
struct Output {
    to: Option<Box<dyn Write + Send>>,
    format: ListFormat,
    rule: Rule,
    mirror: Mirror,
    lines: u64,
    gallery: Option<Gallery>,
}

impl Output {
    fn open(
        file: Option<&PathBuf>,
        wanted: bool,
        format: ListFormat,
        rule: Rule,
        mirror: Mirror,
    ) -> anyhow::Result<Self> {
        let to: Option<Box<dyn Write + Send>> = match file {
            _ if !wanted => None,
            Some(path) => {
                let file = std::fs::File::create(path).with_context(|| path.display().to_string())?;
                Some(Box::new(std::io::BufWriter::new(file)))
            }
            None => Some(Box::new(std::io::BufWriter::new(std::io::stdout()))),
        };
        Ok(Self { to, format, rule, mirror, lines: 0, gallery: None })
    }

    fn write(&mut self, code: &Code) -> Result<(), EnumerateError> {
        if let Some(gallery) = &mut self.gallery {
            gallery.add(code)?;
        }
        let Some(to) = &mut self.to else { return Ok(()) };
        let io = |source| EnumerateError::Io { path: "output".into(), source };
        let lines = match self.mirror {
            Mirror::Same => vec![line(code, self.format, self.rule)?],
            Mirror::Distinct => mirror_lines(code, self.format, self.rule)?,
        };
        for text in lines {
            writeln!(to, "{text}").map_err(io)?;
            self.lines += 1;
        }
        Ok(())
    }

    fn finish(&mut self) -> anyhow::Result<()> {
        if let Some(to) = &mut self.to {
            to.flush()?;
        }
        Ok(())
    }
}

fn enumerate(args: &EnumerateArgs, threads: usize, console: &Console, ctx: &Context<'_>) -> anyhow::Result<Exit> {
    let started = Instant::now();
    let params = params_of(args)?;
    if let Some(file) = &args.gallery {
        gallery::check(file)?;
    }
    if args.mirror == Mirror::Distinct && args.nonorientable {
        bail!("--mirror distinct needs orientable meshes: leave out --nonorientable");
    }
    let selection = selection_of(args)?;
    let targets = targets_of(&args.find)?;
    let list = !args.count_only;
    if list && console.json && args.output.is_none() && args.checkpoint.is_none() {
        bail!("--json prints the counts on stdout: add -u, or -o FILE for the objects");
    }
    let engine = engine_of(args, &params)?;
    let listed = list && args.checkpoint.is_none();
    let mut output = Output::open(args.output.as_ref(), listed, args.format, params.rule, args.mirror)?;
    output.gallery = args.gallery.is_some().then(Gallery::default);
    let wanted = Wanted { selection: Some(&selection), list, targets: &targets };
    let job = Job {
        params: &params,
        options: LevelOptions::default().with_threads(threads).with_narrow_hashes(args.narrow_hashes),
        wanted,
        ctx,
    };
    let mut counts = Counts::default();
    if engine == Engine::Level {
        job.by_levels(&mut output, &mut counts)?;
    } else {
        let part = args.part.unwrap_or(Chunk { index: 0, of: 1 });
        let chunks = args.chunks.unwrap_or_else(|| default_chunks(part.of));
        match &args.checkpoint {
            Some(folder) => job.with_ledger(folder, part, chunks, &selection, console, &mut counts)?,
            None => job.by_chunks(part, chunks, &mut output, &mut counts)?,
        }
    }
    output.finish()?;
    if let (Some(file), Some(gallery)) = (&args.gallery, &output.gallery) {
        gallery.write(file, &params, console)?;
    }
    report(&params, &counts.levels, &targets, &counts.found, args.count_only, console)?;
    let objects = counts
        .levels
        .last()
        .map_or(0, |(_, t)| if args.mirror == Mirror::Distinct { t.classes + t.chiral } else { t.classes });
    console.say(format!(">Z {objects} meshes generated in {:.2} sec", started.elapsed().as_secs_f64()));
    Ok(Exit::Done)
}

fn params_of(args: &EnumerateArgs) -> anyhow::Result<Params> {
    let params = Params {
        cubes: args.cubes.context("give the number of cubes")?,
        rule: args.rule,
        nonorientable: args.nonorientable,
        filter: args.max_chords.map(|max_chords| Filter { max_chords, from: args.filter_from }),
    };
    params.check()?;
    Ok(params)
}

fn selection_of(args: &EnumerateArgs) -> anyhow::Result<Selection> {
    Ok(Selection {
        boundary_quads: args.boundary_quads.as_deref().map(parse_range).transpose()?,
        balls: args.balls,
        max_chords: args.max_chords,
        key: args.only_key.as_deref().map(str::parse).transpose().map_err(EnumerateError::from)?,
    })
}

/// The engine that does what is asked; [`Engine::Auto`] is settled.
fn engine_of(args: &EnumerateArgs, params: &Params) -> anyhow::Result<Engine> {
    let in_chunks = args.part.is_some() || args.checkpoint.is_some() || args.chunks.is_some();
    let engine = match args.engine {
        Engine::Auto if in_chunks => Engine::Augment,
        Engine::Auto if params.rule == Rule::Strict && params.filter.is_none() => Engine::Augment,
        Engine::Auto => Engine::Level,
        engine => engine,
    };
    if engine == Engine::Level && in_chunks {
        bail!(
            "the level engine does not work in chunks: leave out RES/MOD, --checkpoint and --chunks, or use --engine augment"
        );
    }
    Ok(engine)
}

/// What is enumerated.
struct Job<'a> {
    params: &'a Params,
    options: LevelOptions,
    wanted: Wanted<'a>,
    ctx: &'a Context<'a>,
}

/// What has been counted, by the number of cubes, and the targets found.
#[derive(Default)]
struct Counts {
    levels: Vec<(usize, Tally)>,
    found: Found,
}

impl Job<'_> {
    fn by_levels(&self, output: &mut Output, counts: &mut Counts) -> anyhow::Result<()> {
        for level in all_levels(self.params, &self.options, self.wanted, false, self.ctx)? {
            for code in &level.found.selected {
                output.write(code)?;
            }
            counts.found.targets.extend(level.found.targets);
            counts.levels.push((level.cubes, level.tally));
        }
        Ok(())
    }

    fn by_chunks(&self, part: Chunk, chunks: usize, output: &mut Output, counts: &mut Counts) -> anyhow::Result<()> {
        let plan = Plan::prepare(self.params, &self.options, self.ctx)?;
        let mut tally = Tally::default();
        let all = chunks_of_part(part, chunks)?;
        run_in_order(&plan, &all, self.options.threads(), self.wanted, self.ctx, &mut |result| {
            tally.merge(&result.tally);
            for code in &result.found.selected {
                output.write(code)?;
            }
            counts.found.targets.extend(result.found.targets);
            Ok(())
        })?;
        counts.levels.push((self.params.cubes, tally));
        Ok(())
    }

    /// In chunks that a ledger in `folder` keeps: what it holds is not done again, and the objects stay there.
    fn with_ledger(
        &self,
        folder: &Path,
        part: Chunk,
        chunks: usize,
        selection: &Selection,
        console: &Console,
        counts: &mut Counts,
    ) -> anyhow::Result<()> {
        let plan = Plan::prepare(self.params, &self.options, self.ctx)?;
        let names = self.wanted.targets.iter().map(|t| t.name.clone()).collect();
        let header = Header::new(self.params, selection.text(), self.wanted.list, names, chunks);
        let done = run_checkpointed(&plan, folder, part, &header, self.options.threads(), self.wanted, self.ctx)?;
        if done.dropped_bytes > 0 {
            console.note(format!("a torn last line of {} bytes was dropped from the ledger", done.dropped_bytes));
        }
        console.say(format!(
            "chunks: {} of this part, {} found done; processor time {:.1} s; see `hexfill enumerate merge {}`",
            done.chunks,
            done.found_done,
            done.cpu_nanoseconds as f64 / 1e9,
            folder.display()
        ));
        counts.levels.push((self.params.cubes, done.tally));
        Ok(())
    }
}

fn targets_of(names: &[String]) -> anyhow::Result<Vec<Target>> {
    let mut out = Vec::new();
    for name in names {
        if name == "all" {
            out.extend(Target::built_in()?);
        } else {
            out.push(Target::parse(name)?);
        }
    }
    Ok(out)
}

/// Table and histograms: JSON on stdout, or text (on stdout if nothing else goes there).
fn report(
    params: &Params,
    levels: &[(usize, Tally)],
    targets: &[Target],
    found: &Found,
    on_stdout: bool,
    console: &Console,
) -> anyhow::Result<()> {
    let hits: Vec<_> = found.targets.iter().map(|(i, code)| (targets[*i].name.clone(), code.to_text())).collect();
    if console.json {
        let rows: Vec<_> = levels.iter().map(|(n, tally)| json!({ "cubes": n, "counts": tally })).collect();
        return console.print_json(&json!({ "params": params, "levels": rows, "found": hits }));
    }
    let few = params.filter.map_or(3, |f| f.max_chords);
    let mut text = table(levels.iter().map(|(n, t)| (*n, t)), few);
    if let Some((n, tally)) = levels.last() {
        text.push_str(&format!("{n} cubes, rule {}:\n{}", params.rule, histograms(tally)));
    }
    for (name, code) in hits {
        text.push_str(&format!("found {name}: {code}\n"));
    }
    if on_stdout {
        console.print(text.trim_end())?;
    } else {
        console.say(text.trim_end());
    }
    Ok(())
}

fn merge_folder(
    folder: &Path,
    output: Option<&PathBuf>,
    format: ListFormat,
    console: &Console,
) -> anyhow::Result<Exit> {
    let merged = merge(folder)?;
    if output.is_some() {
        let mut out = Output::open(output, true, format, merged.header.params.rule, Mirror::Same)?;
        merged.for_each_listed(&mut |code| out.write(&code))?;
        out.finish()?;
    }
    report_merged(&merged, console)?;
    Ok(Exit::Done)
}

fn report_merged(merged: &hexfill::unstable::enumerate::Merged, console: &Console) -> anyhow::Result<()> {
    let tally = merged.tally();
    let hits: Vec<_> = merged.records.values().flat_map(|r| r.targets.clone()).collect();
    if console.json {
        return console.print_json(&json!({
            "header": merged.header,
            "chunks_done": merged.records.len(),
            "counts": tally,
            "found": hits,
            "cpu_seconds": merged.cpu_nanoseconds() as f64 / 1e9,
            "projection": merged.projection(),
        }));
    }
    let params = &merged.header.params;
    console.print(table([(params.cubes, &tally)], params.filter.map_or(3, |f| f.max_chords)).trim_end())?;
    console.print(histograms(&tally).trim_end())?;
    for (name, code) in hits {
        console.print(format!("found {name}: {code}"))?;
    }
    console.print(format!(
        "rule {}, {} of {} chunks, {:.1} s processor time, hash sum {:032x}, mass formula {}",
        params.rule,
        merged.records.len(),
        merged.header.chunks,
        merged.cpu_nanoseconds() as f64 / 1e9,
        tally.hash_sum,
        if tally.mass_balances() { "balances" } else { "does not balance (yet)" }
    ))?;
    if let Some((classes, error)) = merged.projection()
        && merged.missing().next().is_some()
    {
        console.print(format!("projected classes of the whole: {classes:.4e} +- {error:.1e} (standard error)"))?;
    }
    Ok(())
}

fn verify(folder: &Path, redo: usize, threads: usize, console: &Console, ctx: &Context<'_>) -> anyhow::Result<Exit> {
    let merged = read_ledgers(folder)?;
    let mut findings = merged.inconsistencies();
    let missing = merged.missing().count();
    if redo > 0 && !merged.records.is_empty() {
        let plan = Plan::prepare(&merged.header.params, &LevelOptions::default().with_threads(threads), ctx)?;
        let step = merged.records.len().div_ceil(redo);
        for (&index, record) in merged.records.iter().step_by(step) {
            let chunk = Chunk { index, of: merged.header.chunks };
            let mut again = plan.run(chunk, Wanted::default(), ctx)?.tally;
            again.selected = record.tally.selected;
            if again != record.tally {
                findings.push(format!("chunk {index}: running it again gives other counts"));
            }
        }
    }
    let exit = if findings.is_empty() { Exit::Done } else { Exit::No };
    if console.json {
        console.print_json(&json!({
            "chunks": merged.header.chunks,
            "chunks_checked": merged.records.len(),
            "missing": missing,
            "findings": findings,
            "exit_code": exit as u8,
        }))?;
        return Ok(exit);
    }
    for finding in &findings {
        console.print(finding)?;
    }
    console.print(format!(
        "{} of {} chunks checked, {missing} missing, {} findings",
        merged.records.len(),
        merged.header.chunks,
        findings.len()
    ))?;
    Ok(exit)
}

fn show(what: &str, console: &Console) -> anyhow::Result<Exit> {
    let path = Path::new(what);
    if path.exists() {
        report_merged(&read_ledgers(path)?, console)?;
        return Ok(Exit::Done);
    }
    let complex = match what.parse::<Code>() {
        Ok(code) => code.decode()?,
        Err(_) => match hexfill::mesh::parse_hex_signature(what) {
            Ok(mesh) => Complex::from_hex_mesh(&mesh)?,
            Err(_) => parse_cubes(what)
                .with_context(|| format!("{what:?} is no folder, no signature, no code and no list of cubes"))?,
        },
    };
    let labelling = canonical(&complex);
    let boundary = Boundary::of(&complex);
    let measures = shape(&complex);
    let strict = strict_violations(&complex);
    let weill = weill_order(&complex);
    if console.json {
        console.print_json(&json!({
            "code": labelling.code.to_text(),
            "cubes": complex.cubes(),
            "vertices": measures.vertices,
            "euler": measures.euler,
            "boundary_quads": boundary.n_quads(),
            "boundary_genera": measures.components.text(),
            "chords": measures.chords,
            "key": boundary.key().to_string(),
            "automorphisms": labelling.automorphisms,
            "ball": measures.is_ball,
            "strict_violations": strict,
            "weill_order": weill.as_ref().map(|c| c.cubes().to_vec()),
        }))?;
        return Ok(Exit::Done);
    }
    console.print(format!("code {}", labelling.code.to_text()))?;
    for (i, cube) in complex.cubes().iter().enumerate() {
        console.print(format!("h{i} {}", cube.map(|v| v.to_string()).join(" ")))?;
    }
    console.print(format!(
        "{} cubes, {} vertices, Euler characteristic {}, {} boundary quads, genera {}, {} chords, |Aut| {}, {}",
        complex.n_cubes(),
        measures.vertices,
        measures.euler,
        boundary.n_quads(),
        measures.components.text(),
        measures.chords,
        labelling.automorphisms,
        if measures.is_ball { "a ball" } else { "not a ball" }
    ))?;
    console.print(format!("key {}", boundary.key()))?;
    console.print(if weill.is_some() { "legal under rule weill" } else { "not legal under rule weill" })?;
    if strict.is_empty() {
        console.print("legal under rule strict")?;
    } else {
        console.print(format!("breaks rule strict {} times: {}", strict.len(), strict.join("; ")))?;
    }
    Ok(Exit::Done)
}

/// Cubes as "0 1 2 3 4 5 6 7; 4 5 6 7 8 9 10 11".
fn parse_cubes(text: &str) -> anyhow::Result<Complex> {
    let mut cubes = Vec::new();
    for part in text.split(';').map(str::trim).filter(|p| !p.is_empty()) {
        let numbers: Result<Vec<u8>, _> = part.split_whitespace().map(str::parse).collect();
        let cube: Result<[u8; 8], _> = numbers?.try_into();
        cubes.push(cube.map_err(|v: Vec<u8>| anyhow::anyhow!("{part:?} has {} vertices, a cube has 8", v.len()))?);
    }
    Ok(Complex::from_cubes(&cubes)?)
}
