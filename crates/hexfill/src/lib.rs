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
    mesh_data,
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
    hexfill_enumerate as enumerate, hexfill_io as io, hexfill_mesh as mesh, hexfill_search as search,
    hexfill_shell as shell, hexfill_view as view,
};
