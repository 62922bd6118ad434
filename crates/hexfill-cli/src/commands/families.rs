//! The rows of `hexfill records` that are about many surfaces, or about a mesh with a further property: what the program itself holds says the numbers.

use anyhow::Context as _;
use hexfill::catalog::VERHETSEL_2019;
use hexfill::unstable::check::{Ball, Judged, Level, Options, judge};
use hexfill::unstable::construct::{Cell, CellLibrary};
use hexfill::unstable::search::Atlas;
use hexfill::{CellChoice, Context};
use serde::Serialize;

/// The pattern of the cell that every quad of a bipartite surface can have.
const WALL_SAFE: &str = "ww-lhhh";
/// Tetrahedra a quad of a coned sphere, and hexes of each.
const TETS_A_QUAD: usize = 2;
const HEXES_A_TET: usize = 4;
/// The number of 3-connected spheres of 6 to 20 quads (Brinkmann et al. 2005).
const SPHERES_TO_20: usize = 54_943;

/// A row.
#[derive(Serialize)]
pub(crate) struct Family {
    problem: &'static str,
    /// At most so many hexes each: in all, or for every quad of the surface.
    hexes: usize,
    per_quad: bool,
    published: Option<usize>,
    published_by: Option<&'static str>,
    note: String,
    /// What makes such a mesh.
    mesh_command: Option<&'static str>,
    /// With `--verify`: whether the mesh was judged; `null` where there are too many.
    pub(crate) verified: Option<bool>,
}

/// All rows; with `verify` the one mesh that is stored is judged anew.
pub(crate) fn families(verify: bool, ctx: &Context<'_>) -> anyhow::Result<Vec<Family>> {
    let library = CellLibrary::built_in(CellChoice::Fewest);
    let is_wall_safe = |cell: &&Cell| cell.pattern.to_string() == WALL_SAFE;
    let cell = library.cells().iter().find(is_wall_safe).context("the library has a cell for every pattern")?;
    let n_cell = cell.hexes.len();
    let stats = Atlas::fewest().stats();
    let filled: usize = stats.classes.values().map(|class| class.classes).sum();
    let hexes: u64 = stats.classes.values().map(|class| class.hexes.sum).sum();
    Ok(vec![
        Family {
            problem: "wall-safe buffer cube of 22 quads",
            hexes: n_cell,
            per_quad: false,
            published: None,
            published_by: None,
            note: format!("no hex joins two points of one side facet (cell `{WALL_SAFE}` of the construction)"),
            mesh_command: None,
            verified: verify.then(|| stands(cell, ctx)).flatten(),
        },
        Family {
            problem: "each 3-connected sphere of at most 20 quads",
            hexes: stats.classes.values().map(|class| class.hexes.most as usize).max().unwrap_or(0),
            per_quad: false,
            published: Some(72),
            published_by: Some(VERHETSEL_2019),
            note: format!("{filled} of {SPHERES_TO_20} filled, mean {:.1}", hexes as f64 / filled as f64),
            mesh_command: Some("hexfill fill SURFACE --strategy atlas --no-embed -o MESH"),
            verified: None,
        },
        Family {
            problem: "any 3-connected sphere with an even number of quads",
            hexes: n_cell + TETS_A_QUAD * HEXES_A_TET,
            per_quad: true,
            published: Some(78),
            published_by: Some(VERHETSEL_2019),
            note: "a cell and two tetrahedra for each quad if the matching found is perfect, which is not proved (the published number is)".to_owned(),
            mesh_command: Some("hexfill fill SURFACE --strategy construct --no-embed -o MESH"),
            verified: None,
        },
    ])
}

/// Whether the cell is a ball with its pattern's boundary, and wall-safe.
fn stands(cell: &Cell, ctx: &Context<'_>) -> Option<bool> {
    let id = |role| cell.points.iter().position(|&r| r == role).map_or(u32::MAX, |i| i as u32);
    let quads: Vec<[u32; 4]> = cell.pattern.boundary().into_iter().map(|quad| quad.map(id)).collect();
    let hexes: Vec<[u32; 8]> = cell.hexes.iter().map(|hex| hex.map(u32::from)).collect();
    let judged = Judged::connectivity(cell.points.len(), &hexes).with_surface(&quads);
    Some(is_exact_ball(&judged, ctx)? && cell.unsafe_pairs().is_empty())
}

/// Whether the judge finds a proper ball with exactly the surface it is given; `None` if it was stopped.
pub(super) fn is_exact_ball(judged: &Judged<'_>, ctx: &Context<'_>) -> Option<bool> {
    let report = judge(judged, &Options::default().with_up_to(Level::L3), ctx);
    let is_ball = report.passed(Level::L3) && report.facts.ball == Some(Ball::Yes);
    (is_ball || ctx.stop().is_none()).then_some(is_ball)
}

/// A row in words.
pub(crate) fn line(family: &Family) -> String {
    let a_quad = if family.per_quad { " a quad" } else { "" };
    let published = family.published.zip(family.published_by);
    let published = published.map_or(String::new(), |(n, by)| format!("; published {n}{a_quad} ({by})"));
    let verified = verdict(family.verified);
    let Family { problem, hexes, note, .. } = family;
    format!("{problem}: at most {hexes} hexes{a_quad}{published}; {note}{verified}")
}

/// What the judge said, at the end of a line.
pub(super) fn verdict(verified: Option<bool>) -> &'static str {
    match verified {
        Some(true) => "; judged: a ball, the boundary exact",
        Some(false) => "; REFUSED by the judge",
        None => "",
    }
}
