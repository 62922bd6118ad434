//! `hexfill check MESH [--surface S]`.

use crate::console::Console;
use crate::exit::Exit;
use crate::files;
use anyhow::{Context as _, bail};
use hexfill::Context;
use hexfill::io::MeshData;
use hexfill::mesh::cube::FACETS;
use hexfill::unstable::check::{
    Judged, Level, Options, Rules, cell_quality, certificate_of, judge, verify_certificate, write_cell_csv,
};
use std::collections::BTreeSet;
use std::io::Write;

/// Flags of `check`.
#[derive(clap::Args)]
pub(crate) struct CheckArgs {
    /// The mesh to judge.
    mesh: String,
    /// The surface it must fill; without it the mesh is judged against its own boundary.
    #[arg(long, value_name = "FILE")]
    surface: Option<String>,
    /// Which definition of a legal complex to judge by.
    #[arg(long, value_enum, default_value = "strict")]
    rules: RulesArg,
    /// The highest level to judge.
    #[arg(long, value_enum, default_value = "l5", ignore_case = true, conflicts_with_all = ["certificate", "verify_certificate"])]
    up_to: LevelArg,
    /// Do not compute Betti numbers, nor whether the mesh is a ball.
    #[arg(long)]
    no_betti: bool,
    /// Do not measure quality: positive Jacobians are certified all the same.
    #[arg(long, conflicts_with_all = ["certificate", "verify_certificate"])]
    no_quality: bool,
    /// Also test that the boundary does not touch or cross itself, so that the mesh does not overlap.
    #[arg(long)]
    overlap: bool,
    /// Write a certificate (JSON) that every level holds; refused if one does not.
    #[arg(long, value_name = "OUT", requires = "surface")]
    certificate: Option<String>,
    /// Verify a certificate of this mesh (and surface) by judging anew.
    #[arg(long, value_name = "FILE", conflicts_with = "certificate")]
    verify_certificate: Option<String>,
    /// Write the quality of every cell as CSV.
    #[arg(long, value_name = "OUT")]
    csv: Option<String>,
    #[command(flatten)]
    reading: files::InputArgs,
}

#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum RulesArg {
    /// Proper intersection.
    Strict,
    /// The rules of the published enumeration, in the order of the hexes.
    Weill,
}

#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum LevelArg {
    /// Indices and the shape of hexes.
    L1,
    /// Faces that pair up, proper intersection.
    L2,
    /// A manifold, oriented, its boundary as given.
    L3,
    /// Finite positions, those of the boundary unchanged.
    L4,
    /// det J > 0 in every hex.
    L5,
}

impl LevelArg {
    const fn level(self) -> Level {
        match self {
            Self::L1 => Level::L1,
            Self::L2 => Level::L2,
            Self::L3 => Level::L3,
            Self::L4 => Level::L4,
            Self::L5 => Level::L5,
        }
    }
}

impl CheckArgs {
    fn options(&self) -> Options {
        let rules = match self.rules {
            RulesArg::Strict => Rules::Strict,
            RulesArg::Weill => Rules::Weill,
        };
        Options::default()
            .with_rules(rules)
            .with_up_to(self.up_to.level())
            .with_betti(!self.no_betti)
            .with_quality(!self.no_quality)
            .with_overlap(self.overlap)
    }
}

/// How many quads are listed in the file but no boundary of its hexes, or the other way round.
fn faces_not_on_boundary(data: &MeshData) -> usize {
    let sorted = |mut q: [u32; 4]| {
        q.sort_unstable();
        q
    };
    let mut facets: Vec<[u32; 4]> = data.hexes.iter().flat_map(|h| FACETS.map(|f| sorted(f.map(|i| h[i])))).collect();
    facets.sort_unstable();
    let boundary: BTreeSet<[u32; 4]> =
        facets.chunk_by(|a, b| a == b).filter(|run| run.len() == 1).map(|run| run[0]).collect();
    let listed: BTreeSet<[u32; 4]> = data.quads.iter().map(|&q| sorted(q)).collect();
    listed.symmetric_difference(&boundary).count()
}

/// Judges and reports; exit code 1 if a rule is broken.
pub(crate) fn run(args: &CheckArgs, console: &Console, ctx: &Context<'_>) -> anyhow::Result<Exit> {
    let data = files::read_data(&args.mesh, &args.reading)?;
    for note in &data.notes {
        console.note(note);
    }
    if data.hexes.is_empty() {
        bail!("{} has no hexes; give a hex mesh (a surface is described by `hexfill info`)", args.mesh);
    }
    if args.surface.is_none() && !data.quads.is_empty() {
        let differ = faces_not_on_boundary(&data);
        if differ > 0 {
            console.note(format!(
                "{differ} quads are faces of the file or boundary of the mesh, but not both; give --surface FILE to have a surface judged"
            ));
        }
    }
    let problem = args
        .surface
        .as_ref()
        .map(|s| files::load_problem(s, &files::InputArgs { from: None, ..args.reading.clone() }))
        .transpose()?;
    hexfill::with_judged(&data, problem.as_ref(), |judged| judge_and_report(args, judged, console, ctx))
}

fn judge_and_report(
    args: &CheckArgs,
    judged: &Judged<'_>,
    console: &Console,
    ctx: &Context<'_>,
) -> anyhow::Result<Exit> {
    if let Some(file) = &args.verify_certificate {
        let text = std::fs::read_to_string(file).with_context(|| file.clone())?;
        return match verify_certificate(&text, judged, ctx) {
            Ok(certificate) => {
                let [lower, upper] = certificate.scaled_jacobian;
                console.print(format!(
                    "{file}: holds: {} hexes with det J > 0, scaled Jacobian {lower:.9} .. {upper:.9}",
                    certificate.hexes
                ))?;
                Ok(Exit::Done)
            }
            Err(error) => {
                console.error(&anyhow::Error::new(error).context(format!("{file} does not hold")));
                Ok(Exit::No)
            }
        };
    }
    let report = judge(judged, &args.options(), ctx);
    if let Some(path) = &args.csv {
        let cells = cell_quality(judged);
        files::write_file(path, |out| write_cell_csv(&cells, &mut std::io::BufWriter::new(out)))?;
    }
    if let Some(path) = &args.certificate {
        match certificate_of(judged, &report) {
            Ok(certificate) => files::write_file(path, |out| out.write_all(certificate.to_json().as_bytes()))?,
            Err(error) => console.error(&anyhow::Error::new(error).context("no certificate written")),
        }
    }
    if console.json {
        console.print(report.to_json())?;
    } else {
        console.print(report.to_string().trim_end())?;
    }
    if let Some(stop) = ctx.stop() {
        return Ok(Exit::of_stop(stop, Exit::No));
    }
    Ok(if report.no_failure() { Exit::Done } else { Exit::No })
}
