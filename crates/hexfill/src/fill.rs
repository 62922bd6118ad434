//! `fill`: from a problem to verified meshes. Picks the strategy, and lets nothing out that the judge refused.

use crate::choose::Prefer;
use crate::components::{fill_apart, solids};
use crate::effort::Effort;
use crate::geometry::boundary_points;
use crate::last_resort::{LastResort, leaving_time};
use crate::problem::Problem;
use crate::scale::Scaled;
use crate::simplify::simplify_construction;
use hexfill_check::{Judged, Level, judge};
use hexfill_construct::{CellChoice, ConstructOptions};
use hexfill_io::{MeshData, TagName, TagOn};
use hexfill_mesh::{
    Context, HexMesh, ImproperPair, Offenders, QuadSurface, StopReason, hex_signature, improper_pairs, sheets,
};
use hexfill_search::{
    Atlas, AtlasError, Cavity, FillOptions as InwardOptions, GrowOptions, Growth, GrowthLog, MAX_CAP, MAX_QUADS,
    SimplifyOptions, fill_from_atlas,
};
use hexfill_shell::{BoundaryLayers, ShellOptions, shell};
use serde::Serialize;
use std::path::PathBuf;
use std::sync::Arc;

/// How to fill.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
#[non_exhaustive]
pub enum Strategy {
    /// Atlas, shelling, inward flips; what they do not fill is constructed. With coordinates the best mesh is taken, see
    /// [`Prefer`].
    #[default]
    Auto,
    /// Shelling only: the surface swept inward by its own dual curves.
    Shell,
    /// Atlas, inward flips, then growth towards the surface until it is reached or time is up.
    Atlas,
    /// Construction only.
    Construct,
}

/// Where the tetrahedra of an interior that is not a ball come from.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub enum InteriorFrom {
    /// Handlebodies cut along disks, which positions tell.
    #[default]
    BuiltIn,
    /// A tetrahedral mesh of the inside of the surface.
    Tets(Arc<hexfill_construct::GivenTets>),
    /// An installed program called as a process.
    Tetgen(hexfill_construct::TetgenTets),
}

/// What to look for and where.
#[derive(Clone, Debug)]
pub struct FillOptions {
    /// How to fill.
    pub strategy: Strategy,
    /// Most hexes a mesh may have.
    pub max_hexes: u32,
    /// How many non-isomorphic meshes to look for.
    pub count: usize,
    /// Look on for smaller meshes until the context stops the search.
    pub improve: bool,
    /// The atlas to use; the embedded one by default.
    pub atlas: Option<Arc<Atlas>>,
    /// Where growth towards the surface keeps its log, so that an interrupted run can go on.
    pub growth_log: Option<PathBuf>,
    /// Options of that growth.
    pub growth: GrowOptions,
    /// How many cavities inward flips may look at before the next strategy has its turn (no clock: the same result
    /// every time).
    pub inward_cavities: u64,
    /// How many of them are kept on each level. More find more of the meshes that [`count`](Self::count) asks for.
    pub beam: usize,
    /// Where the construction gets the tetrahedra of an interior that is not a ball.
    pub interior: InteriorFrom,
    /// Which cells the construction uses where it has a choice: the ones with the fewest hexes do not embed.
    pub cells: CellChoice,
    /// Make a construction smaller ([`crate::simplify`]); `None`: leave it as it is. With a deadline this takes at most half of
    /// the time that is left, nine tenths if [`cells`](Self::cells) asks for the fewest hexes (nothing is embedded then).
    /// A mesh made smaller is harder to embed.
    pub simplify: Option<SimplifyOptions>,
    /// How to shell.
    pub shell: ShellOptions,
    /// How long to look for a better mesh, where there are coordinates.
    pub effort: Effort,
    /// What to prefer among certified meshes.
    pub prefer: Prefer,
    /// Boundary layers under the whole surface, cut once the mesh has positions; `None`: none.
    pub layers: Option<BoundaryLayers>,
}

impl Default for FillOptions {
    fn default() -> Self {
        Self {
            strategy: Strategy::Auto,
            max_hexes: u32::MAX,
            count: 1,
            improve: false,
            atlas: None,
            growth_log: None,
            growth: GrowOptions::default(),
            inward_cavities: 1_000_000,
            beam: InwardOptions::default().beam,
            interior: InteriorFrom::BuiltIn,
            cells: CellChoice::Embeddable,
            simplify: None,
            shell: ShellOptions::default(),
            effort: Effort::default(),
            prefer: Prefer::default(),
            layers: None,
        }
    }
}

/// Which way a mesh was found.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Route {
    /// The best known mesh of a surface of the catalogue.
    Catalogue,
    /// Looked up in the atlas.
    Atlas,
    /// Swept inward by the surface's dual curves.
    Shelling,
    /// Hexes glued inward, the rest from the atlas.
    InwardFlips,
    /// Reached by growing an atlas towards it.
    Growth,
    /// Constructed.
    Construction,
}

/// A verified mesh.
#[derive(Clone, Debug)]
pub struct Filled {
    /// The mesh; the surface's vertices keep their ids, interior vertices follow.
    pub mesh: HexMesh,
    /// How it was found.
    pub route: Route,
    /// Start positions that come with a construction or a shelling; absent for the other routes.
    pub start: Option<Vec<[f64; 3]>>,
    /// What made how many of its hexes, where more than one step did.
    pub stages: Vec<(&'static str, usize)>,
    /// The smaller mesh that a shelling was lifted from.
    pub(crate) coarse: Option<hexfill_shell::CoarseMesh>,
}

impl Filled {
    /// This filling after one more step, which added the hexes that `mesh` has more.
    pub(crate) fn changed(&self, step: &'static str, mesh: HexMesh) -> Self {
        let mut stages = self.stages.clone();
        if stages.is_empty() {
            stages.push((self.route.words(), self.mesh.n_hexes()));
        }
        stages.push((step, mesh.n_hexes().saturating_sub(self.mesh.n_hexes())));
        Self { mesh, route: self.route, start: None, stages, coarse: None }
    }
}

/// All that a fill brought.
#[derive(Clone, Debug)]
pub struct FillResult {
    /// The meshes, fewest hexes first, pairwise not isomorphic.
    pub meshes: Vec<Filled>,
    /// Why the work ended.
    pub stop: StopReason,
    /// What was tried, in words, for the report.
    pub tried: Vec<String>,
}

/// Why a surface has no hex mesh, or none was made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FillError {
    /// The parity theorem forbids it.
    #[error(
        "the surface has {quads} quads, an odd number: no hex mesh exists, since every hex has six facets and interior quads pair up (Thurston 1993, Mitchell 1996); split one quad or merge two"
    )]
    OddQuads {
        /// The number of quads.
        quads: usize,
    },
    /// Two quads that cannot both be facets of a proper hex mesh.
    #[error(
        "no proper hex mesh exists: {} pairs of quads share more than one edge{three_connected}: {pairs}; refine the surface there", pairs.count
    )]
    Improper {
        /// The pairs, with the vertices they share.
        pairs: Offenders<ImproperPair>,
        /// Remark for spheres.
        three_connected: &'static str,
    },
    /// The strategy asked for cannot take this surface.
    #[error("{what}; {remedy}")]
    NotForStrategy {
        /// What about the surface.
        what: String,
        /// What to do.
        remedy: &'static str,
    },
    /// The construction refused.
    #[error(transparent)]
    Construct(#[from] hexfill_construct::ConstructError),
    /// The atlas or the log of the growth cannot be used.
    #[error(transparent)]
    Atlas(#[from] AtlasError),
    /// A mesh was made that the judge refused: a defect of this program.
    #[error("internal error: the mesh made by {route:?} fails {rules}; please report this surface")]
    Refused {
        /// How it was made.
        route: Route,
        /// The rules it breaks.
        rules: String,
    },
}

/// Refuses surfaces that no proper hex mesh can have as boundary, naming the reason.
///
/// # Errors
/// [`FillError::OddQuads`], [`FillError::Improper`].
pub fn check_fillable(surface: &QuadSurface) -> Result<(), FillError> {
    if !surface.n_quads().is_multiple_of(2) {
        return Err(FillError::OddQuads { quads: surface.n_quads() });
    }
    let pairs = improper_pairs(surface);
    if !pairs.is_empty() {
        let three_connected = if surface.is_sphere() { " (the sphere is not 3-connected)" } else { "" };
        return Err(FillError::Improper { pairs, three_connected });
    }
    Ok(())
}

/// Fills the surface of a problem. Every mesh returned has passed levels 1 to 3 of the judge, its boundary being the
/// surface. An empty list means: none found within the bounds, which proves nothing.
///
/// Told to stop by the context, it returns the best so far. If there is none, the surface is constructed if the strategy allows it and
/// that takes no more than a second; else the list is empty.
///
/// # Errors
/// [`FillError`].
pub fn fill(problem: &Problem, options: &FillOptions, ctx: &Context<'_>) -> Result<FillResult, FillError> {
    check_fillable(&problem.surface)?;
    if let Some(scaled) = Scaled::of(problem, options) {
        let mut result = fill(&scaled.problem, &scaled.options, ctx)?;
        result.meshes.iter_mut().for_each(|filled| scaled.restore(filled));
        return Ok(result);
    }
    let solids = solids(&problem.surface, problem.points.as_deref());
    if solids.len() > 1 && matches!(options.interior, InteriorFrom::BuiltIn) {
        let result = fill_apart(problem, &solids, options, ctx)?;
        result.meshes.iter().try_for_each(|m| verify(&problem.surface, &m.mesh, m.route))?;
        return Ok(result);
    }
    let mut result = fill_component(problem, options, ctx)?;
    LastResort::default().fill(problem, options, ctx, &mut result)?;
    Ok(result)
}

/// Fills one component, or several at once where one lies in another. The caller has checked that it is fillable, and turns to the
/// [`LastResort`] if the work was stopped before there was a mesh.
pub(crate) fn fill_component(
    problem: &Problem,
    options: &FillOptions,
    ctx: &Context<'_>,
) -> Result<FillResult, FillError> {
    let surface = &problem.surface;
    let small = surface.is_sphere() && surface.n_quads() <= MAX_QUADS;
    if options.strategy == Strategy::Atlas && !small {
        return Err(FillError::NotForStrategy {
            what: format!(
                "the atlas fills one sphere of at most {MAX_QUADS} quads; this surface has {} components, genus {}, {} quads",
                surface.n_components(),
                surface.genus(),
                surface.n_quads()
            ),
            remedy: "use --strategy auto or construct",
        });
    }
    let mut result = FillResult { meshes: Vec::new(), stop: StopReason::Finished, tried: Vec::new() };
    let early = leaving_time(problem, options, ctx);
    let by_atlas = matches!(options.strategy, Strategy::Auto | Strategy::Atlas);
    let by_shelling = matches!(options.strategy, Strategy::Auto | Strategy::Shell);
    if small && by_atlas {
        // What the atlas does not hold is shelled before inward flips have their turn.
        let cavities = if options.strategy == Strategy::Auto && options.count == 1 && !options.improve {
            1
        } else {
            options.inward_cavities
        };
        search(surface, &FillOptions { inward_cavities: cavities, ..options.clone() }, &early, &mut result)?;
    }
    if result.meshes.len() < options.count && by_shelling && early.stop().is_none() {
        for filled in shelled(problem, options, &early, &mut result)? {
            accept(surface, filled, options, &mut result)?;
        }
    }
    if small && result.meshes.is_empty() && options.strategy == Strategy::Auto && early.stop().is_none() {
        search(surface, options, &early, &mut result)?;
    }
    let may_construct = matches!(options.strategy, Strategy::Auto | Strategy::Construct);
    if result.meshes.is_empty() && may_construct && ctx.stop().is_none() {
        construct(problem, options, ctx, &mut result)?;
    }
    if result.stop == StopReason::Finished {
        result.stop = ctx.stop().unwrap_or(StopReason::Finished);
    }
    result.meshes.sort_by_key(|m| m.mesh.n_hexes());
    Ok(result)
}

/// Complete meshes by shelling, judged, those with least cost first.
pub(crate) fn shelled(
    problem: &Problem,
    options: &FillOptions,
    ctx: &Context<'_>,
    result: &mut FillResult,
) -> Result<Vec<Filled>, FillError> {
    let points = boundary_points(problem);
    let mut how = options.shell.clone();
    if options.layers.is_some() {
        how.pillows = vec![1];
    }
    let made = shell(&problem.surface, points.as_deref(), &how, ctx);
    result.stop = ctx.stop().unwrap_or(result.stop);
    result.tried.push(made.to_string());
    let mut meshes = Vec::new();
    for shelled in made.meshes {
        if ctx.stop().is_some() && !meshes.is_empty() {
            break;
        }
        if shelled.mesh.n_hexes() as u64 <= u64::from(options.max_hexes) {
            verify(&problem.surface, &shelled.mesh, Route::Shelling)?;
            meshes.push(Filled {
                mesh: shelled.mesh,
                route: Route::Shelling,
                start: shelled.points,
                stages: shelled.stages,
                coarse: shelled.coarse,
            });
        }
    }
    Ok(meshes)
}

/// Atlas, inward flips and, if nothing else may follow, growth.
pub(crate) fn search(
    surface: &QuadSurface,
    options: &FillOptions,
    ctx: &Context<'_>,
    result: &mut FillResult,
) -> Result<(), FillError> {
    let atlas = options.atlas.as_deref().unwrap_or_else(|| Atlas::embedded());
    let inward = InwardOptions {
        max_hexes: options.max_hexes,
        // Several placements may be isomorphic as meshes: look for more than are asked for.
        count: if options.count == 1 { 1 } else { 8 * options.count },
        improve: options.improve,
        max_cavities: if options.improve { u64::MAX } else { options.inward_cavities },
        beam: options.beam,
    };
    let outcome = fill_from_atlas(surface, atlas, &inward, ctx).expect("the caller checked: a small sphere");
    if outcome.stop != StopReason::Finished {
        result.stop = outcome.stop;
    }
    result.tried.push(format!("atlas of {} states, inward flips over {} cavities", atlas.n_states(), outcome.cavities));
    for filling in outcome.fillings {
        let route = if filling.glued == 0 { Route::Atlas } else { Route::InwardFlips };
        accept(
            surface,
            Filled { mesh: filling.mesh, route, start: None, stages: Vec::new(), coarse: None },
            options,
            result,
        )?;
    }
    if options.strategy == Strategy::Atlas && result.meshes.len() < options.count && ctx.stop().is_none() {
        grow_towards(surface, options, ctx, result)?;
    }
    Ok(())
}

/// Grows an atlas from one cube until the surface is reached.
fn grow_towards(
    surface: &QuadSurface,
    options: &FillOptions,
    ctx: &Context<'_>,
    result: &mut FillResult,
) -> Result<(), FillError> {
    let (cavity, ids) = Cavity::from_surface(surface).expect("the caller checked: a small sphere");
    if surface.n_quads() > MAX_CAP {
        result.tried.push(format!("no growth: the surface has more than {MAX_CAP} quads"));
        return Ok(());
    }
    let grow_options = GrowOptions { cap: options.growth.cap.max(surface.n_quads()), ..options.growth };
    let (mut log, mut growth) = match &options.growth_log {
        Some(path) => {
            let (log, growth) = GrowthLog::open(path, grow_options)?;
            (Some(log), growth)
        }
        None => (None, Growth::new(grow_options)),
    };
    loop {
        for ball in growth.balls_for(&cavity) {
            if ball.n_hexes() as u64 > u64::from(options.max_hexes) {
                continue;
            }
            if let Some((map, mirrored)) = ball.placements(&cavity).into_iter().next() {
                let boundary: Vec<u32> = map.iter().map(|&v| ids[usize::from(v)]).collect();
                let first = surface.n_vertices() as u32;
                let (hexes, fresh) = ball.hexes_in(&boundary, mirrored, first);
                let mesh = HexMesh::try_new((first + fresh) as usize, &hexes).expect("a ball's hexes glue properly");
                accept(
                    surface,
                    Filled { mesh, route: Route::Growth, start: None, stages: Vec::new(), coarse: None },
                    options,
                    result,
                )?;
            }
        }
        if result.meshes.len() >= options.count || growth.is_exhausted() || growth.level() >= options.max_hexes {
            break;
        }
        let report = growth.grow(ctx);
        if let Some(stop) = report.stopped {
            result.stop = stop;
            break;
        }
        if let Some(log) = &mut log {
            log.append(&growth, &report)?;
        }
    }
    result.tried.push(format!(
        "growth with cap {} and width {} to {} hexes: {} classes",
        grow_options.cap,
        grow_options.width,
        growth.level(),
        growth.n_classes()
    ));
    Ok(())
}

/// Constructions tried for each mesh asked for: some variants are isomorphic.
const VARIANTS_PER_MESH: u64 = 4;

/// The construction for everything else. Several meshes are variants of it that cost the same.
pub(crate) fn construct(
    problem: &Problem,
    options: &FillOptions,
    ctx: &Context<'_>,
    result: &mut FillResult,
) -> Result<(), FillError> {
    let points = boundary_points(problem);
    // Tetrahedra that are given belong to the diagonals of the first variant.
    let given = matches!(options.interior, InteriorFrom::Tets(_));
    let variants = if given || options.count == 1 { 1 } else { VARIANTS_PER_MESH * options.count as u64 };
    for variant in 0..variants {
        let tets: Option<Arc<dyn hexfill_construct::InteriorTets>> = match &options.interior {
            InteriorFrom::BuiltIn => None,
            InteriorFrom::Tets(tets) => Some(tets.clone()),
            InteriorFrom::Tetgen(program) => Some(Arc::new(program.clone())),
        };
        let cells = options.cells;
        let how = ConstructOptions { tets, cells, variant, ..ConstructOptions::default() };
        let made = match hexfill_construct::construct(&problem.surface, points.as_deref(), &how, ctx) {
            Err(hexfill_construct::ConstructError::Stopped(reason)) => {
                result.stop = reason;
                result.tried.push("construction, stopped before the mesh was complete".to_owned());
                return Ok(());
            }
            made => made?,
        };
        if variant == 0 {
            result.tried.push(made.report.to_string());
        }
        let (mesh, start) = simplify_construction(made.mesh, made.start, options, ctx, &mut result.tried);
        if mesh.n_hexes() as u64 <= u64::from(options.max_hexes) {
            accept(
                &problem.surface,
                Filled { mesh, route: Route::Construction, start, stages: Vec::new(), coarse: None },
                options,
                result,
            )?;
        }
        if result.meshes.len() >= options.count {
            break;
        }
    }
    Ok(())
}

/// Judges a mesh and keeps it, unless an isomorphic one is kept already or enough are.
fn accept(
    surface: &QuadSurface,
    filled: Filled,
    options: &FillOptions,
    result: &mut FillResult,
) -> Result<(), FillError> {
    if result.meshes.len() >= options.count {
        return Ok(());
    }
    if options.count > 1 {
        let name = hex_signature(&filled.mesh).ok();
        if name.is_some() && result.meshes.iter().any(|m| hex_signature(&m.mesh).ok() == name) {
            return Ok(());
        }
    }
    verify(surface, &filled.mesh, filled.route)?;
    result.meshes.push(filled);
    Ok(())
}

/// Levels 1 to 3 of the judge against the surface.
///
/// # Errors
/// [`FillError::Refused`].
pub(crate) fn verify(surface: &QuadSurface, mesh: &HexMesh, route: Route) -> Result<(), FillError> {
    let hexes = mesh.hexes_raw();
    let quads: Vec<[u32; 4]> = surface.quads().iter().map(|q| q.map(|v| v.0)).collect();
    let judged = Judged::connectivity(mesh.n_vertices(), &hexes).with_surface(&quads);
    let options = hexfill_check::Options::default().up_to(Level::L3).betti(false).quality(false);
    let report = judge(&judged, &options, &Context::default());
    if report.passed(Level::L3) {
        Ok(())
    } else {
        Err(FillError::Refused { route, rules: report.broken_rules().join(", ") })
    }
}

/// Numbers about a filling, for people and for JSON.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FillReport {
    /// What the user called the surface.
    pub surface: String,
    /// Its quads.
    pub quads: usize,
    /// Hexes of the mesh.
    pub hexes: usize,
    /// Hexes per quad.
    pub hexes_per_quad: f64,
    /// Vertices that are not on the surface.
    pub interior_vertices: usize,
    /// Sheets of the mesh, counted up to a million hexes.
    pub sheets: Option<usize>,
    /// How it was found.
    pub route: Route,
    /// What made how many of the hexes, in the order of the work, where more than one step did.
    pub stages: Vec<(&'static str, usize)>,
    /// Canonical signature of the mesh, for meshes of at most 10,000 hexes.
    pub signature: Option<String>,
    /// What was tried.
    pub tried: Vec<String>,
}

impl FillReport {
    /// The report of one mesh of a result.
    pub fn new(problem: &Problem, filled: &Filled, tried: &[String]) -> Self {
        let (quads, hexes) = (problem.surface.n_quads(), filled.mesh.n_hexes());
        Self {
            surface: problem.name.clone(),
            quads,
            hexes,
            hexes_per_quad: hexes as f64 / quads as f64,
            interior_vertices: filled.mesh.n_interior_vertices(),
            sheets: (hexes <= 1_000_000).then(|| sheets(&filled.mesh).len()),
            route: filled.route,
            stages: filled.stages.clone(),
            signature: (hexes <= 10_000).then(|| hex_signature(&filled.mesh).ok()).flatten(),
            tried: tried.to_vec(),
        }
    }
}

/// Writes a mesh with its positions and, if they were judged, two numbers per hex (`certified_positive`, `scaled_jacobian`). The format follows from
/// the extension; the file appears whole or not at all.
///
/// # Errors
/// [`WriteError`](hexfill_io::WriteError): the format is unknown or holds no hexes, or the file cannot be written.
pub fn save(
    path: &std::path::Path,
    problem: &Problem,
    filled: &Filled,
    placed: Option<&crate::Placed>,
) -> Result<(), hexfill_io::WriteError> {
    let mut data = mesh_data(problem, &filled.mesh, placed.map(|p| p.points.clone()));
    if let Some(placed) = placed.filter(|p| !p.cells.is_empty()) {
        placed.flag(&mut data);
    }
    hexfill_io::write_path(path, None, &data)
}

/// The mesh as file data: the surface's points first, bit for bit, its quads in their order with their tags, then the hexes.
/// `points` are the positions of all vertices, or `None` for connectivity alone.
pub fn mesh_data(problem: &Problem, mesh: &HexMesh, points: Option<Vec<[f64; 3]>>) -> MeshData {
    let mut data = problem.data();
    data.hexes = mesh.hexes_raw();
    data.has_coordinates = points.is_some();
    data.points = points.unwrap_or_default();
    if let Some(tags) = &mut data.point_tags {
        tags.resize(mesh.n_vertices(), 0);
    }
    for (_, values) in &mut data.point_data {
        values.resize(mesh.n_vertices(), f64::NAN);
    }
    if data.quad_tags.is_some() {
        // Programs that work with groups want one for the cells, too.
        data.hex_tags = Some(vec![1; data.hexes.len()]);
        data.tag_names.push(TagName { on: TagOn::Cells, tag: 1, name: "volume".to_owned() });
    }
    data
}
