//! What a construction is, and what it was made of.

use crate::cells::pattern::Pattern;
use crate::core::Inside;
use crate::core::maker::Core;
use crate::layer::Layer;
use crate::options::RouteChoice;
use crate::plan::Plan;
use hexfill_mesh::HexMesh;
use std::collections::BTreeMap;
use std::fmt;

/// A hex mesh whose boundary is the surface.
#[derive(Clone, Debug)]
pub struct Construction {
    /// The mesh. The surface's vertices keep their ids; inner vertices follow.
    pub mesh: HexMesh,
    /// What it was made of.
    pub report: Report,
    /// Start positions for every vertex, if the surface has positions: those of the surface bit for bit.
    pub start: Option<Vec<[f64; 3]>>,
}

/// How the surface was coloured.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Route {
    /// Two colours on every edge; Sigma is empty and every tet is split in 4.
    Bipartite,
    /// Few black-black edges; Sigma is spanned by them.
    Mixed,
    /// Black all over: Erickson's construction with 10-quad inner facets.
    Erickson,
}

impl fmt::Display for Route {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Bipartite => "bipartite",
            Self::Mixed => "mixed",
            Self::Erickson => "erickson",
        })
    }
}

/// The construction in numbers. Counts only: the same for the same input, always.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// How the surface was coloured.
    pub route: Route,
    /// Quads of the surface.
    pub n_quads: usize,
    /// White vertices.
    pub n_white: usize,
    /// Black-black edges (cut by Sigma).
    pub n_cut_edges: usize,
    /// Quads the matching left over, paired by a T-join.
    pub n_unmatched: usize,
    /// Buffer cells by pattern: how many, and hexes in one.
    pub cells: BTreeMap<Pattern, (usize, usize)>,
    /// Hexes of the buffer layer.
    pub n_cell_hexes: usize,
    /// Who made the tetrahedra.
    pub tets_by: Core,
    /// Tetrahedra of the core.
    pub n_tets: usize,
    /// Tetrahedra split into 4, 7 and 8 hexes.
    pub n_split: [usize; 3],
    /// Hexes of the core (without those that joins replace).
    pub n_core_hexes: usize,
    /// For a star-shaped surface with a core that is not a cone: the hexes that a cone would have had (of a bipartite surface).
    pub n_cone_hexes: Option<usize>,
    /// Pairs of odd components joined by a chain.
    pub n_joins: usize,
    /// Hexes of the joins.
    pub n_join_hexes: usize,
}

impl Report {
    /// The report before odd components are joined.
    pub(crate) fn new(
        plan: &Plan<'_>,
        inside: &Inside,
        layer: &Layer<'_>,
        cells: BTreeMap<Pattern, (usize, usize)>,
        n_split: [usize; 3],
    ) -> Self {
        let n_quads = plan.surface.n_quads();
        Self {
            route: match (plan.options.route, plan.colours.n_cut_edges) {
                (RouteChoice::Erickson, _) => Route::Erickson,
                (RouteChoice::Auto, 0) => Route::Bipartite,
                (RouteChoice::Auto, _) => Route::Mixed,
            },
            n_quads,
            n_white: plan.colours.white.iter().filter(|&&w| w).count(),
            n_cut_edges: plan.colours.n_cut_edges,
            n_unmatched: layer.n_unmatched(),
            n_cell_hexes: cells.values().map(|(count, hexes)| count * hexes).sum(),
            cells,
            tets_by: inside.core,
            n_tets: inside.complex.tets.len(),
            n_split,
            n_core_hexes: 4 * n_split[0] + 7 * n_split[1] + 8 * n_split[2],
            n_cone_hexes: (inside.is_star && inside.core == Core::Delaunay).then_some(8 * n_quads),
            n_joins: inside.corridors.len(),
            n_join_hexes: 0,
        }
    }

    /// One more pair joined: hexes of the core that went, and those that came.
    pub(crate) fn count_join(&mut self, n_removed: usize, n_filled: usize) {
        self.n_core_hexes -= n_removed;
        self.n_join_hexes += n_filled;
    }

    /// Number of hexes.
    pub fn n_hexes(&self) -> usize {
        self.n_cell_hexes + self.n_core_hexes + self.n_join_hexes
    }

    /// Hexes per quad of the surface.
    pub fn hexes_per_quad(&self) -> f64 {
        self.n_hexes() as f64 / self.n_quads as f64
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{} hexes for {} quads ({:.2} per quad), route {}",
            self.n_hexes(),
            self.n_quads,
            self.hexes_per_quad(),
            self.route
        )?;
        writeln!(
            f,
            "white vertices {}, cut edges {}, unmatched quads {}",
            self.n_white, self.n_cut_edges, self.n_unmatched
        )?;
        for (pattern, (count, hexes)) in &self.cells {
            writeln!(f, "cell {pattern}: {count} x {hexes} hexes")?;
        }
        if self.n_joins > 0 {
            writeln!(f, "pairs of odd components joined: {}, {} hexes", self.n_joins, self.n_join_hexes)?;
        }
        let [four, seven, eight] = self.n_split;
        write!(
            f,
            "core ({}): {} tetrahedra, split in 4/7/8: {four}/{seven}/{eight}, {} hexes",
            self.tets_by, self.n_tets, self.n_core_hexes
        )?;
        match self.n_cone_hexes {
            Some(n) => write!(f, " (a cone from one point: {n}, but needles)"),
            None => Ok(()),
        }
    }
}
