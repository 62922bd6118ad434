//! What an [`Effort`] means in numbers. No clock: the same mesh every time.
//!
//! Source: ours.

use crate::best::pillows::PillowLimits;
use crate::fill::options::Effort;
use hexfill_lay::LayOptions;
use hexfill_shell::ShellOptions;

/// The bounds of the work.
#[derive(Clone, Debug)]
pub(crate) struct Budget {
    /// How to shell, given how it would be done normally.
    pub(crate) shell: ShellOptions,
    /// Linear programs for a shelled mesh while the best is looked for, and once it is found: it is near its best where it starts, and the last
    /// digits take most of the time.
    pub(crate) screening: usize,
    pub(crate) programs: usize,
    /// Most of them for the meshes of other engines.
    pub(crate) others: usize,
    /// Cavities inward flips may look at where shelling found nothing good.
    pub(crate) cavities: u64,
    /// Fillings of the smallest surfaces that are looked for where the first has no valid coordinates.
    pub(crate) fillings: usize,
    /// How hexes are laid where no shelled mesh has valid positions.
    pub(crate) lay: LayOptions,
    /// Pillows put between the stages of a shelled mesh that has no valid positions; `None`: not tried.
    pub(crate) pillows: Option<PillowLimits>,
    /// Engines are asked until there is a mesh of this class (0: good, 1: certified); `None`: all are.
    pub(crate) enough: Option<u8>,
}

impl Effort {
    pub(crate) fn budget(self, normal: &ShellOptions) -> Budget {
        let mut shell = normal.clone();
        let mut lay = LayOptions::default();
        match self {
            Self::Fast => {
                // Shelling takes little of the time, embedding most of it.
                shell = shell.with_candidates(1);
                lay = lay.with_attempts(2).with_batches(1);
                let most = 5;
                Budget {
                    shell,
                    lay,
                    screening: 0,
                    programs: 0,
                    others: most,
                    cavities: 1000,
                    fillings: 10,
                    pillows: None,
                    enough: Some(1),
                }
            }
            Self::Normal => {
                let (cavities, fillings) = (30_000, 50);
                let pillows = Some(PillowLimits { trials: 240, most: 8.0, most_bad: 16 });
                Budget {
                    shell,
                    lay,
                    screening: 5,
                    programs: 20,
                    others: usize::MAX,
                    cavities,
                    fillings,
                    pillows,
                    enough: Some(0),
                }
            }
            Self::Best => {
                shell = normal
                    .clone()
                    .with_restarts(4 * normal.restarts())
                    .with_seeds(4 * normal.seeds())
                    .with_candidates(3 * normal.candidates());
                lay = lay.with_attempts(16).with_batches(2);
                Budget {
                    shell,
                    lay,
                    screening: 20,
                    programs: usize::MAX,
                    others: usize::MAX,
                    cavities: 1_000_000,
                    fillings: 200,
                    pillows: Some(PillowLimits { trials: 1000, most: 10.0, most_bad: 150 }),
                    enough: None,
                }
            }
        }
    }
}
