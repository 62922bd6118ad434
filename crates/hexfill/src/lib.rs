//! **hexfill fills a closed quad surface with hexahedra and leaves the surface exactly as it is.**
//!
//! This is the facade: [`Problem::load`] takes a file, a catalogue name or a signature, [`fill`] picks the strategy
//! and returns meshes the independent judge has accepted. The rooms behind it are re-exported.
//!
//! ```
//! use hexfill::{Context, FillOptions, Problem, fill};
//!
//! let problem = Problem::load(":schneiders-pyramid", None)?;
//! let result = fill(&problem, &FillOptions::default(), &Context::default())?;
//! assert_eq!(result.meshes[0].mesh.n_hexes(), 36);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Arrays in, positions out, a file written:
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
//! let problem = Problem::load(":geode", None)?;
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

pub mod catalog;
mod choose;
mod components;
mod describe;
mod doctor;
mod effort;
mod fill;
mod geometry;
mod hopeless;
mod last_resort;
mod limits;
mod no_room;
mod placed_fill;
mod placement;
mod problem;
mod regions;
mod scale;
mod simplify;
mod stored;
mod threads;

pub use choose::Prefer;
pub use describe::{ChordInfo, MeshInfo, PartInfo, SheetInfo, SurfaceInfo, describe_mesh, describe_surface};
pub use doctor::{Cure, CureOptions, Diagnosis, crossing_quads, cure, doctor};
pub use effort::Effort;
pub use fill::{
    FillError, FillOptions, FillReport, FillResult, Filled, InteriorFrom, Route, Strategy, check_fillable, fill,
    mesh_data, save,
};
pub use geometry::{GeometryReport, Placed, boundary_points, place, place_best, start_positions};
pub use hexfill_mesh::{Context, Progress, StopReason};
pub use hexfill_search::{Collapse, SimplifyOptions, SimplifyReport};
pub use hexfill_shell::{BoundaryLayers, ShellOptions};
pub use limits::{LimitsInfo, Named};
pub use placed_fill::{PlaceOptions, PlacedFill, fill_placed};
pub use problem::{Problem, ProblemError, is_named};
pub use regions::{FilledRegions, Region, RegionsError, fill_regions, has_regions, regions};
pub use simplify::{SimplifiedData, SimplifyError, default_balls, simplify};
pub use threads::{MAX_THREADS, ThreadsError, with_threads};
pub use {
    hexfill_check as check, hexfill_construct as construct, hexfill_doctor as diagnosis, hexfill_embed as embed,
    hexfill_enumerate as enumerate, hexfill_io as io, hexfill_ledger as ledger, hexfill_mesh as mesh,
    hexfill_prove as prove, hexfill_search as search,
    hexfill_shell as shell, hexfill_view as view,
};
