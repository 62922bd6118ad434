//! The flags of `fill` and what they mean.

use crate::files;
use anyhow::bail;
use hexfill::{
    Atlas, BoundaryLayers, CellChoice, Context, Effort, FillOptions, GivenTets, GrowOptions, InteriorFrom,
    PlaceOptions, Prefer, Strategy, TetgenTets,
};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

/// Flags of `fill`.
#[derive(clap::Args)]
pub(crate) struct FillArgs {
    /// The surface: a file, `-`, a catalogue name such as :schneiders-pyramid, or a signature.
    pub(super) surface: String,
    /// The mesh to write; format by extension; `-` for stdout. With --count the files are numbered OUT-1, OUT-2, ...
    #[arg(short, long, value_name = "OUT")]
    pub(super) output: Option<String>,
    #[command(flatten)]
    pub(super) reading: files::InputArgs,
    #[command(flatten)]
    pub(super) writing: files::OutputArgs,
    /// Also write an HTML page that shows the mesh.
    #[arg(long, value_name = "FILE")]
    pub(super) view: Option<String>,
    /// Also write a PNG picture of the mesh.
    #[arg(long, value_name = "FILE")]
    pub(super) picture: Option<String>,
    /// How to fill.
    #[arg(long, value_enum, default_value = "auto")]
    pub(super) strategy: StrategyArg,
    /// Which mesh to prefer among those that are certified with a worst scaled Jacobian of at least 0.2.
    #[arg(long, value_enum, default_value = "balance")]
    pub(super) prefer: PreferArg,
    /// The first mesh with a certificate, in a fraction of the time.
    #[arg(long, conflicts_with = "best")]
    pub(super) fast: bool,
    /// Look on though a good mesh is found: more candidates, each raised as far as it goes; many times the time (see --time-limit).
    #[arg(long)]
    pub(super) best: bool,
    /// Put this many layers of hexahedra under the whole surface (boundary layers for flow).
    #[arg(long, value_name = "K", conflicts_with_all = ["count", "best_of", "no_embed", "improve"], value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(super) layers: Option<u32>,
    /// Height of the first of them, in the unit of the surface [default: all layers of one place have the same height].
    #[arg(long, value_name = "H", requires = "layers", value_parser = positive)]
    pub(super) layer_height: Option<f64>,
    /// Each layer is this many times as high as the one before.
    #[arg(long, value_name = "G", requires = "layer_height", default_value_t = 1.0, value_parser = positive)]
    pub(super) growth: f64,
    /// Accept only meshes of at most this many hexes.
    #[arg(long, value_name = "N")]
    pub(super) max_hexes: Option<u32>,
    /// Look for this many meshes that are not isomorphic.
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=10_000))]
    pub(super) count: u64,
    /// Look for this many meshes that are not isomorphic, embed them, and write the one with the largest worst scaled Jacobian.
    /// See also --max-hexes and --beam.
    #[arg(long, value_name = "N", conflicts_with_all = ["count", "no_embed"], value_parser = clap::value_parser!(u64).range(2..=10_000))]
    pub(super) best_of: Option<u64>,
    /// Look on for smaller meshes until --time-limit.
    #[arg(long, requires = "time_limit")]
    pub(super) improve: bool,
    /// An atlas to use instead of the embedded one.
    #[arg(long, value_name = "FILE")]
    pub(super) atlas: Option<PathBuf>,
    /// Where growth towards the surface (--strategy atlas) keeps its log; the same command goes on from it
    /// [default: OUT.hxgrow, removed once the surface is reached].
    #[arg(long, value_name = "FILE")]
    pub(super) growth_log: Option<PathBuf>,
    /// Most quads a ball may have while growing towards the surface.
    #[arg(long, default_value_t = 24, value_name = "N")]
    pub(super) cap: usize,
    /// Most cavities that inward flips look at before the next strategy has its turn; where a certified mesh is wanted, 30,000 (--fast: 1,000) at most.
    #[arg(long, default_value_t = 1_000_000, value_name = "N")]
    pub(super) inward_cavities: u64,
    /// How many of these cavities are kept on each level: more find more of the meshes --count asks for.
    #[arg(long, default_value_t = 1000, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub(super) beam: u64,
    /// A tetrahedral mesh of the inside, for surfaces that are not spheres (boundary: the quads cut along diagonals).
    #[arg(long, value_name = "FILE", conflicts_with = "tetgen")]
    pub(super) tets: Option<String>,
    /// Call this TetGen program for the inside of surfaces that are not spheres.
    #[arg(long, value_name = "PROGRAM", num_args = 0..=1, default_missing_value = "tetgen")]
    pub(super) tetgen: Option<PathBuf>,
    /// Which cells the construction uses: those that embed, or those with the fewest hexes [default: fewest with --no-embed,
    /// else embeddable].
    #[arg(long, value_enum)]
    pub(super) cells: Option<CellsArg>,
    /// Make a constructed mesh smaller (see `hexfill simplify`); done by itself with --no-embed and --time-limit.
    #[arg(long)]
    pub(super) simplify: bool,
    /// Do not embed: interior vertices get start positions, and geometry is not judged.
    #[arg(long)]
    pub(super) no_embed: bool,
    /// How long the embedding of one mesh, or of all with --best-of, may take [default: as long as its bounded work takes].
    #[arg(long, value_name = "TIME", value_parser = files::parse_duration)]
    pub(super) embed_limit: Option<Duration>,
    /// Write nothing unless det J > 0 is certified in every hex.
    #[arg(long, conflicts_with = "no_embed")]
    pub(super) require_valid: bool,
    /// States kept per class while growing towards the surface.
    #[arg(long, default_value_t = 1, value_name = "N")]
    pub(super) width: u32,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug, clap::ValueEnum)]
pub(super) enum StrategyArg {
    /// Atlas, shelling, laying, inward flips, construction: the best mesh of them (see --prefer).
    Auto,
    /// Shelling: the surface is swept inward by its own dual curves; laying where no shelled mesh is certified.
    Shell,
    /// Atlas, inward flips, then growth towards the surface until --time-limit.
    Atlas,
    /// Construction only.
    Construct,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug, clap::ValueEnum)]
pub(super) enum PreferArg {
    /// Fewest hexes divided by the cube of the worst scaled Jacobian.
    Balance,
    /// Fewest hexes; inside, three sheets become one wherever they lie on each other.
    Hexes,
    /// Largest worst scaled Jacobian.
    Quality,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug, clap::ValueEnum)]
pub(super) enum CellsArg {
    /// Fewest hexes; coordinates cannot be valid.
    Fewest,
    /// Cells with valid coordinates of their own.
    Embeddable,
}

/// What the flags mean.
pub(super) fn fill_options(
    args: &FillArgs,
    own_log: Option<PathBuf>,
    ctx: &Context<'_>,
) -> anyhow::Result<FillOptions> {
    let mut options = FillOptions::default()
        .with_strategy(match args.strategy {
            StrategyArg::Auto => Strategy::Auto,
            StrategyArg::Shell => Strategy::Shell,
            StrategyArg::Atlas => Strategy::Atlas,
            StrategyArg::Construct => Strategy::Construct,
        })
        .with_max_hexes(args.max_hexes.unwrap_or(u32::MAX))
        .with_count(args.best_of.unwrap_or(args.count) as usize)
        .with_improve(args.improve)
        .with_inward_cavities(args.inward_cavities)
        .with_beam(usize::try_from(args.beam).unwrap_or(usize::MAX))
        .with_interior(interior(args)?)
        .with_cells(match args.cells {
            Some(CellsArg::Fewest) => CellChoice::Fewest,
            Some(CellsArg::Embeddable) => CellChoice::Embeddable,
            None if args.no_embed => CellChoice::Fewest,
            None => CellChoice::Embeddable,
        })
        .with_effort(match (args.fast, args.best) {
            (true, _) => Effort::Fast,
            (_, true) => Effort::Best,
            _ => Effort::Normal,
        })
        .with_prefer(match args.prefer {
            PreferArg::Balance => Prefer::Balance,
            PreferArg::Hexes => Prefer::Hexes,
            PreferArg::Quality => Prefer::Quality,
        })
        .with_growth(GrowOptions::default().with_cap(args.cap).with_width(args.width.max(1)));
    if let Some(file) = &args.atlas {
        options = options.with_atlas(Arc::new(Atlas::read_path(file)?));
    }
    if let Some(log) = args.growth_log.clone().or(own_log) {
        options = options.with_growth_log(log);
    }
    if let Some(how) = simplification(args, ctx) {
        options = options.with_simplify(how);
    }
    if let Some(count) = args.layers {
        options = options.with_layers(BoundaryLayers { count, height: args.layer_height, growth: args.growth });
    }
    Ok(options)
}

pub(super) fn place_options(args: &FillArgs) -> PlaceOptions {
    let how = PlaceOptions::default().with_best(args.best_of.is_some());
    let how = args.embed_limit.map_or(how, |limit| how.with_limit(limit));
    if args.no_embed { how.without_embedding() } else { how }
}

/// Whether and how a construction is made smaller: as long as the deadline allows, or by a fixed number of balls. A smaller mesh
/// is harder to embed, so it must be asked for where positions are wanted.
fn simplification(args: &FillArgs, ctx: &Context<'_>) -> Option<hexfill::SimplifyOptions> {
    let wanted = args.simplify || args.no_embed && ctx.deadline.is_some();
    let balls = if ctx.deadline.is_some() { u64::MAX } else { SIMPLIFY_BALLS };
    wanted.then(|| hexfill::SimplifyOptions::default().with_balls(balls))
}

/// Balls of `--simplify` without a time limit.
const SIMPLIFY_BALLS: u64 = 200_000;

/// Where the tetrahedra of an interior that is not a ball come from.
fn interior(args: &FillArgs) -> anyhow::Result<InteriorFrom> {
    if let Some(file) = &args.tets {
        let data = files::read_data(file, &files::InputArgs::default())?;
        if data.tets.is_empty() {
            bail!("{file} has no tetrahedra");
        }
        let n_vertices = data.points.len();
        let points = data.has_coordinates.then_some(data.points);
        return Ok(InteriorFrom::Tets(Arc::new(GivenTets { n_vertices, tets: data.tets, points })));
    }
    Ok(match &args.tetgen {
        Some(program) => InteriorFrom::Tetgen(TetgenTets { program: program.clone() }),
        None => InteriorFrom::BuiltIn,
    })
}

/// A positive number.
fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x.is_finite() && x > 0.0 => Ok(x),
        _ => Err(format!("{text} is not a positive number")),
    }
}

/// Where growth keeps its log if nothing else is said.
pub(super) fn default_log(args: &FillArgs) -> Option<PathBuf> {
    let output = args.output.as_deref().filter(|o| *o != "-" && args.strategy == StrategyArg::Atlas)?;
    Some(Path::new(&format!("{output}.hxgrow")).to_owned())
}
