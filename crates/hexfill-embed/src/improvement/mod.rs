//! Better positions: untangling, then raising the worst scaled Jacobian.
//!
//! | file | method | for |
//! |---|---|---|
//! | `untangle`, `foldover_free_energy` | an energy that is finite on inverted cells and a barrier in the end | any start |
//! | `untangle_patches` | the same on patches round bad cells that grow | few bad cells |
//! | `sequential_programs`, `program_rows`, `program_step` | linear and quadratic programs in a trust region | up to 100 hexes |
//! | `rising_barrier`, `barrier` | a logarithmic barrier below the worst value, which follows it | up to 400 hexes |
//! | `patch_programs` | programs in patches round the worst cells | few worst cells |
//! | `patch_barriers`, `barrier` | a rational barrier on all cells below a level | more than 2000 hexes |
//! | `large_meshes` | both in turn | more than 2000 hexes |
//! | `inflate` | stretches space round tiny cells, and lifts what that makes poor | meshes laid round an apex |
//!
//! `edge_floors` keeps edges from vanishing; `each_patch` does patches at the same time. Every step is kept only if the worst value
//! over whole cells rises.
//!
//! Source: each file names its own.

mod barrier;
mod each_patch;
mod edge_floors;
mod foldover_free_energy;
mod goal;
mod inflate;
mod large_meshes;
mod patch_barriers;
mod patch_programs;
mod program_rows;
mod program_step;
mod rising_barrier;
mod sequential_programs;
mod smoothing;
mod untangle;
mod untangle_patches;

pub(crate) use goal::Goal;
pub(crate) use inflate::inflate;
pub(crate) use large_meshes::{lift_barely_valid, raise_large};
pub(crate) use patch_programs::{climb_worst, is_worst_isolated};
pub(crate) use rising_barrier::{BarrierLimits, follow_worst};
pub(crate) use sequential_programs::{ProgramLimits, climb};
pub(crate) use untangle::{UntangleLimits, untangle};
pub(crate) use untangle_patches::{round_shapes, untangle_all, untangle_bad, untangle_rings, untangle_whole};
