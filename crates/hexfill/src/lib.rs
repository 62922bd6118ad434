//! **hexfill fills a closed quad surface with hexahedra and leaves the surface exactly as it is.**
//!
//! Say what to fill ([`Problem`]: a file, arrays, a name of the [`catalog`], a signature), fill it ([`fill_placed()`], or [`fill()`] for
//! connectivity alone), look at what came ([`FillReport`], [`GeometryReport`]) and [`save`] it. Every mesh has been accepted by a judge that
//! shares no code with what made it.
//!
//! ```
//! use hexfill::{Context, FillOptions, Problem, fill};
//!
//! let problem = Problem::named("schneiders-pyramid")?;
//! let result = fill(&problem, &FillOptions::default(), &Context::default())?;
//! assert_eq!(result.meshes[0].mesh().n_hexes(), 36);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Arrays in (quads by 0-based vertex ids, in any orientation), positions out, a file written:
//!
//! ```
//! use hexfill::io::MeshData;
//! use hexfill::{Context, FillOptions, PlaceOptions, Problem, fill_placed, save};
//!
//! let points = (0..8).map(|v| [0, 1, 2].map(|k| f64::from(v >> k & 1))).collect();
//! let quads = vec![[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
//! let problem = Problem::from_data("a cube", &MeshData::from_quads(points, quads))?;
//! let made = fill_placed(&problem, &FillOptions::default(), &PlaceOptions::default(), &Context::default())?;
//! let (filled, placed) = &made.meshes[0];
//! assert!(placed.as_ref().is_some_and(|p| p.is_certified() && p.worst() > 0.999));
//! let folder = tempfile::tempdir()?;
//! save(&folder.path().join("cube.vtu"), &problem, filled, placed.as_ref())?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Work is stopped through the context, and what is wrong with a surface is typed:
//!
//! ```
//! use hexfill::mesh::SurfaceError;
//! use hexfill::{Context, FillOptions, Problem, ProblemError, StopReason, fill};
//! use std::sync::atomic::AtomicBool;
//!
//! let problem = Problem::named("geode")?;
//! let stop = AtomicBool::new(true); // set by another thread, say
//! let ctx = Context { cancel: Some(&stop), ..Context::default() };
//! assert_eq!(fill(&problem, &FillOptions::default(), &ctx)?.stop, StopReason::Cancelled);
//!
//! let mut open = problem.data();
//! open.quads.pop();
//! match Problem::from_data("open", &open) {
//!     Err(ProblemError::Surface { source: SurfaceError::Open { edges }, .. }) => assert_eq!(edges.count, 4),
//!     other => panic!("{other:?}"),
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Whether there is anything to find is answered before the work, by theorem:
//!
//! ```
//! use hexfill::{Existence, Problem, existence};
//!
//! let pyramid = Problem::named("schneiders-pyramid")?;
//! assert!(matches!(existence(pyramid.surface(), pyramid.points()), Existence::Exists { .. }));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # What is stable
//! What this crate defines, and [`io`] and [`mesh`], whose types it takes and returns. The rooms behind it are under [`unstable`]: use them for
//! research, and pin the version.

mod best;
mod check;
mod doctor;
mod file;
mod fill;
mod info;
mod keep_valid;
mod place;
mod problem;
mod regions;
mod report;
mod simplify;
mod threads;

pub use best::choice::{Candidate, Choice, Outcome};
pub use best::estimate::{Estimate, estimate};
pub use best::{PlaceOptions, PlacedFill, fill_placed};
pub use check::{check_mesh, with_judged};
pub use doctor::crossings::crossing_quads;
pub use doctor::cure::{Cure, CureOptions, cure};
pub use doctor::{Diagnosis, doctor};
pub use file::{mesh_data, save};
pub use fill::attempt::Attempt;
pub use fill::error::{FillError, check_fillable};
pub use fill::fill;
pub use fill::filled::{FillResult, Filled, Route};
pub use fill::maker::Maker;
pub use fill::options::{Effort, FillOptions, InteriorFrom, Prefer, Strategy};
pub use hexfill_check::{CellQuality, Level, Options as CheckOptions, Report as CheckReport, Rules};
pub use hexfill_construct::{
    CellChoice, ConstructError, Existence, GivenTets, MissingInterior, NoChain, TetMisfit, TetgenTets, Undecided,
    existence,
};
pub use hexfill_embed::{EmbedError, EmbedReport, Objective, Options as EmbedOptions};
pub use hexfill_mesh::{Context, Progress, StopReason};
pub use hexfill_search::{Atlas, AtlasError, Collapse, GrowOptions, SimplifyOptions, SimplifyReport};
pub use hexfill_shell::{BoundaryLayers, ShellOptions};
pub use info::existence::ExistenceInfo;
pub use info::limits::{LimitsInfo, Named};
pub use info::mesh::{MeshInfo, SheetInfo, describe_mesh};
pub use info::surface::{ChordInfo, PartInfo, SurfaceInfo, describe_surface};
pub use place::embed_mesh::embed_mesh;
pub use place::place;
pub use place::placed::Placed;
pub use place::report::GeometryReport;
pub use problem::{Problem, ProblemError, catalog, is_named};
pub use regions::error::RegionsError;
pub use regions::fill::{FilledRegions, fill_regions};
pub use regions::{Region, has_regions, regions};
pub use report::FillReport;
pub use simplify::{SimplifiedData, SimplifyError, coarsen, default_balls, simplify, simplify_keeping_valid};
pub use threads::{MAX_THREADS, ThreadsError, with_threads};
pub use {hexfill_io as io, hexfill_mesh as mesh};

/// The rooms behind the facade, whole: they change with every version.
///
/// All meshes of n cubes, a look-up in the atlas, a certificate that another program can verify:
///
/// ```
/// use hexfill::unstable::check::{Judged, certify, verify_certificate};
/// use hexfill::unstable::enumerate::{LevelOptions, Params, Plan, Rule, Wanted, run_whole};
/// use hexfill::unstable::search::Cavity;
/// use hexfill::{Atlas, Context, Problem};
///
/// let ctx = Context::default();
/// let plan = Plan::prepare(&Params::new(4, Rule::Strict), &LevelOptions::default(), &ctx)?;
/// assert_eq!(run_whole(&plan, 1, Wanted::default(), &ctx)?.0.classes, 24);
///
/// let pyramid = Problem::named("schneiders-pyramid")?;
/// let (cavity, _) = Cavity::from_surface(pyramid.surface()).expect("a small sphere");
/// assert_eq!(Atlas::embedded().balls_for(&cavity).map(|ball| ball.n_hexes()).min(), Some(36));
///
/// let points = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];
/// let points = points.map(|p| p.map(f64::from));
/// let judged = Judged::connectivity(8, &[[0, 1, 2, 3, 4, 5, 6, 7]]).with_points(&points);
/// let certificate = certify(&judged, &ctx)?.to_json();
/// assert_eq!(verify_certificate(&certificate, &judged, &ctx)?.hexes, 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub mod unstable {
    pub use {
        hexfill_check as check, hexfill_construct as construct, hexfill_doctor as diagnosis, hexfill_embed as embed,
        hexfill_enumerate as enumerate, hexfill_ledger as ledger, hexfill_prove as prove, hexfill_search as search,
        hexfill_shell as shell, hexfill_view as view,
    };
}

/// The programs of the book.
#[cfg(doctest)]
#[doc = include_str!("../../../book/src/library.md")]
struct Library;
