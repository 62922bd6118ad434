//! [`Effort`]: how long to look for a better mesh, and what that means in numbers. No clock: the same mesh every time.

use hexfill_shell::ShellOptions;

/// How much work goes into a better mesh where several are possible and the surface has coordinates.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
#[non_exhaustive]
pub enum Effort {
    /// The first mesh with a certificate; a fraction of the time.
    Fast,
    /// Until a mesh is good: certified, with a worst scaled Jacobian of at least 0.2.
    #[default]
    Normal,
    /// More candidates of every engine though one is good already, and each raised as far as it goes; many times the time.
    Best,
}

/// The bounds of the work.
#[derive(Clone, Debug)]
pub(crate) struct Budget {
    /// How to shell, given how it would be done normally.
    pub(crate) shell: ShellOptions,
    /// Linear programs for a shelled mesh while the best is looked for, and once it is found: it is near its best where it starts, and the last
    /// digits take most of the time.
    pub(crate) screening: usize,
    pub(crate) programs: usize,
    /// Most of them for the meshes of other engines; `None`: as many as the embedding does by itself.
    pub(crate) others: Option<usize>,
    /// Cavities inward flips may look at where shelling found nothing good.
    pub(crate) cavities: u64,
    /// Fillings of the smallest surfaces that are looked for where the first has no valid coordinates.
    pub(crate) fillings: usize,
    /// Engines are asked until there is a mesh of this class (0: good, 1: certified); `None`: all are.
    pub(crate) enough: Option<u8>,
}

impl Effort {
    pub(crate) fn budget(self, normal: &ShellOptions) -> Budget {
        let mut shell = normal.clone();
        match self {
            Self::Fast => {
                // Shelling takes little of the time, embedding most of it.
                shell.candidates = 1;
                let most = Some(5);
                Budget { shell, screening: 0, programs: 0, others: most, cavities: 1000, fillings: 10, enough: Some(1) }
            }
            Self::Normal => {
                let (cavities, fillings) = (30_000, 50);
                Budget { shell, screening: 5, programs: 20, others: None, cavities, fillings, enough: Some(0) }
            }
            Self::Best => {
                shell.restarts *= 4;
                shell.seeds *= 4;
                shell.candidates *= 3;
                Budget {
                    shell,
                    screening: 20,
                    programs: usize::MAX,
                    others: None,
                    cavities: 1_000_000,
                    fillings: 200,
                    enough: None,
                }
            }
        }
    }
}
