//! `hexfill embed MESH -o OUT`: new positions for the interior vertices of a mesh.

use crate::console::Console;
use crate::exit::Exit;
use crate::files;
use anyhow::bail;
use hexfill::mesh::HexMesh;
use hexfill::{Context, EmbedOptions, GeometryReport, Objective, StopReason};
use serde::Serialize;

/// Flags of `embed`.
#[derive(clap::Args)]
pub(crate) struct EmbedArgs {
    /// The mesh; the positions of its boundary vertices are kept bit for bit.
    mesh: String,
    /// The mesh to write; format by extension; `-` for stdout.
    #[arg(short, long, value_name = "OUT")]
    output: String,
    /// What the positions should be good at.
    #[arg(long, value_enum, default_value = "sj")]
    objective: ObjectiveArg,
    /// Starts at most; 0 chooses by size.
    #[arg(long, default_value_t = 0, value_name = "N")]
    starts: u32,
    /// Do not begin with the interior positions of the file.
    #[arg(long)]
    fresh: bool,
    /// Keep the symmetries of the boundary that the mesh has, too: a symmetric result from fewer variables.
    #[arg(long)]
    symmetric: bool,
    /// Write nothing unless det J > 0 is certified in every hex.
    #[arg(long)]
    require_valid: bool,
    #[command(flatten)]
    reading: files::InputArgs,
    #[command(flatten)]
    writing: files::OutputArgs,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug, clap::ValueEnum)]
enum ObjectiveArg {
    /// The largest least scaled Jacobian.
    Sj,
    /// The smallest condition number with 95 % of the best scaled Jacobian.
    Balanced,
    /// Valid cells, no more.
    Untangle,
}

#[derive(Serialize)]
struct Output {
    file: Option<String>,
    geometry: GeometryReport,
}

/// Embeds, judges, writes; exit code 1 if some hex is not certified.
pub(crate) fn run(args: &EmbedArgs, console: &Console, ctx: &Context<'_>) -> anyhow::Result<Exit> {
    args.writing.check(&args.output, &args.reading, console)?;
    let mut data = files::read_data(&args.mesh, &args.reading)?;
    for note in std::mem::take(&mut data.notes) {
        console.note(note);
    }
    args.writing.check_mesh(&args.output, &data)?;
    if data.hexes.is_empty() {
        bail!("{} has no hexes; give a hex mesh (`hexfill fill` makes one from a surface)", args.mesh);
    }
    if !data.has_coordinates {
        bail!("{} has no coordinates; `hexfill fill` places the boundary of a surface without any", args.mesh);
    }
    let mesh = HexMesh::try_new(data.points.len(), &data.hexes)?;
    let options = EmbedOptions::new(match args.objective {
        ObjectiveArg::Sj => Objective::ScaledJacobian,
        ObjectiveArg::Balanced => Objective::Balanced,
        ObjectiveArg::Untangle => Objective::UntangleOnly,
    })
    .with_starts(args.starts)
    .with_symmetric(args.symmetric);
    let start = (!args.fresh).then_some(data.points.as_slice());
    let placed = hexfill::embed_mesh(&mesh, &data.points, start, &options, ctx)?;
    let stop = placed.embedding().map_or(StopReason::Finished, |report| report.stop);
    let valid = placed.is_certified();
    let report = placed.report();
    console.say(report.to_string());
    let written = valid || !args.require_valid;
    if written {
        placed.flag(&mut data);
        data.points = placed.points().to_vec();
        args.writing.write(&args.output, &data, console)?;
        console.say(format!("written: {}", args.output));
    } else {
        console.say("nothing written: some hexes are not certified, and --require-valid was given");
    }
    if console.json && args.output != "-" {
        console.print_json(&Output { file: written.then(|| args.output.clone()), geometry: report })?;
    }
    Ok(Exit::of_stop(stop, if valid { Exit::Done } else { Exit::No }))
}
