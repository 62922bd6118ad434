//! Deterministic makers of surfaces and meshes for tests, benchmarks and corpora (feature `generate`).
//!
//! Everything random starts from a seed and gives the same bytes on every machine.

mod meshes;
mod shuffle;
mod spheres;
mod surfaces;

pub use crate::random::Random;
pub use meshes::{grid, grid_mesh_of};
pub use shuffle::{mirrored_mesh, shuffled_mesh, shuffled_surface};
pub use spheres::{all_spheres, all_spheres_up_to, pseudo_double_wheel, random_sphere};
pub use surfaces::{
    cube_surface, cubed_sphere, holed_plate, octagonal_spindle, refined, schneiders_pyramid, torus, voxel_surface,
    voxels,
};
