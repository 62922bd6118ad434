//! The construction from end to end.

use crate::assemble::{count_cells, place_cells};
use crate::ball::{BallCore, BallTets};
use crate::cell::{CellChoice, CellLibrary};
use crate::colouring::{Colouring, all_black, colouring};
use crate::delaunay::{DelaunayTets, GRADED_TRIANGLES};
use crate::error::ConstructError;
use crate::handlebody::HandlebodyTets;
use crate::join::{fill_join, joins};
use crate::layer::{Layer, triangles};
use crate::matching::light_sides;
use crate::report::{Report, Route};
use crate::sigma::sigma;
use crate::split::{core_points, split_tets};
use crate::start::{InnerCopy, star_centre, start_positions};
use crate::strain::relieve;
use crate::tets::{InteriorTets, TetComplex, TetRequest, others, tet_edge};
use crate::vector::volume;
use hexfill_mesh::{Context, HexMesh, QuadId, QuadSurface, improper_pairs};

/// Star-shaped surfaces with more quads than this get no cone as core where coordinates are wanted: its tetrahedra would be needles.
/// Measured on ellipsoids: with 96 quads the worst scaled Jacobian is 0.103 (Delaunay tetrahedra: 0.139), with 216 0.044 (0.108),
/// with 384 0.023 (0.127).
const CONE_QUADS: usize = 250;

/// Which colouring to use.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum RouteChoice {
    /// The bipartition if there is one, else few black-black edges.
    #[default]
    Auto,
    /// Black all over: Erickson's construction, for comparison.
    Erickson,
}

/// Choices for [`construct`].
#[derive(Default)]
pub struct Options {
    /// Which colouring.
    pub route: RouteChoice,
    /// How the core of a ball is made.
    pub ball_core: BallCore,
    /// Who makes the tetrahedra of the interior; without it a ball is coned, and anything else is cut along disks
    /// that positions tell (see [`crate::HandlebodyTets`]).
    pub tets: Option<Box<dyn InteriorTets>>,
    /// Which of the built-in cells.
    pub cells: CellChoice,
    /// Which of the choices that cost the same: an odd number exchanges the colours of a bipartite surface, half of it
    /// orders the matching. 0 is the usual one; another may suit a surface with sharp vertices better.
    pub variant: u64,
    /// Cells to use instead of the built-in ones.
    pub library: Option<CellLibrary>,
}

impl std::fmt::Debug for Options {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Options")
            .field("route", &self.route)
            .field("ball_core", &self.ball_core)
            .field("cells", &self.cells)
            .field("variant", &self.variant)
            .field("tets", &self.tets.as_ref().map(|t| t.name()))
            .finish_non_exhaustive()
    }
}

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

/// Fills `surface` with hexes; `points` are the positions of its vertices, if any.
///
/// Linear time and memory (the tetrahedra's edges and faces are sorted). The same bytes for the same input.
///
/// # Errors
/// [`ConstructError`]: no hex mesh exists (with the certificate), the interior is not known, or the work was stopped.
pub fn construct(
    surface: &QuadSurface,
    points: Option<&[[f64; 3]]>,
    options: &Options,
    ctx: &Context<'_>,
) -> Result<Construction, ConstructError> {
    if !surface.n_quads().is_multiple_of(2) {
        return Err(ConstructError::OddQuads { given: surface.n_quads() });
    }
    let pairs = improper_pairs(surface);
    if !pairs.is_empty() {
        return Err(ConstructError::ImproperQuads { pairs });
    }
    let stage = |name: &'static str| match ctx.stop() {
        Some(reason) => Err(ConstructError::Stopped(reason)),
        None => {
            ctx.report(name, 0, None, String::new);
            Ok(())
        }
    };
    if let Some(given) = points.map(<[_]>::len).filter(|&n| n != surface.n_vertices()) {
        return Err(ConstructError::Points { given, needed: surface.n_vertices() });
    }
    stage("colouring")?;
    let swap = options.variant % 2 == 1;
    let mut colours = match options.route {
        RouteChoice::Auto => colouring(surface, swap),
        RouteChoice::Erickson => all_black(surface),
    };
    let library = match &options.library {
        Some(library) => library,
        None => CellLibrary::built_in(options.cells),
    };
    // Sides that suit the positions; the colours are chosen with them.
    let relieved = |colours: &Colouring| {
        let points =
            points.filter(|_| options.cells == CellChoice::Embeddable && options.route == RouteChoice::Auto)?;
        let mut sides = light_sides(surface, &[], options.variant / 2, ctx).ok()?;
        let strain = relieve(surface, points, &colours.white, &mut sides, library)?;
        Some((strain, sides))
    };
    let mut planned = relieved(&colours);
    // Tetrahedra from elsewhere were made for the diagonals of one colouring.
    if options.tets.is_none()
        && let Some((here, _)) = &planned
    {
        let other = colouring(surface, !swap);
        let there = relieved(&other);
        if there.as_ref().is_some_and(|(there, _)| (there < here) != swap) {
            (colours, planned) = (other, there);
        }
    }
    stage("tetrahedra")?;
    let triangles = triangles(surface, &colours);
    let request = TetRequest { n_vertices: surface.n_vertices(), triangles: &triangles, points };
    let ball = BallTets { surface, colouring: &colours, core: options.ball_core };
    let centre = points.filter(|_| surface.is_sphere()).and_then(|p| star_centre(surface, p));
    // Coordinates need tetrahedra that are right side out; a star-shaped ball has them without any search, but a cone over many
    // quads is all needles.
    let wants_shape = options.cells == CellChoice::Embeddable && points.is_some();
    let is_asked_for = options.ball_core != BallCore::Auto;
    // Where Delaunay tetrahedra get no points for their shape, they are needles, too.
    let is_coned = surface.n_quads() <= CONE_QUADS || triangles.len() > GRADED_TRIANGLES;
    let cone = centre.filter(|_| !wants_shape || is_asked_for || is_coned);
    let offset = |p| InnerCopy::offset(surface, p, centre.is_some());
    let half_way = |p, centre| InnerCopy::half_way(surface, p, centre);
    let mut inner = points.map(|p| cone.map_or_else(|| offset(p), |centre| half_way(p, centre)));
    let topological: &dyn InteriorTets = if surface.is_sphere() { &ball } else { &HandlebodyTets };
    let geometric = || -> Result<Option<TetComplex>, ConstructError> {
        if wants_shape && cone.is_none() { geometric_tets(&request, inner.as_ref(), ctx) } else { Ok(None) }
    };
    let (maker, complex) = match &options.tets {
        Some(maker) => (maker.name(), maker.fill(&request, ctx)?),
        None => match geometric()? {
            Some(complex) => (DelaunayTets::default().name(), complex),
            None => {
                let mut complex = topological.fill(&request, ctx)?;
                if let (Some(p), Some(centre)) = (points, centre) {
                    let copy = half_way(p, centre);
                    move_apex(&mut complex, &copy, surface.n_vertices(), centre);
                    inner = Some(copy);
                }
                (topological.name(), complex)
            }
        },
    };
    let boundary = complex.match_boundary(&request)?;
    let joins = joins(surface, &complex, &boundary)?;
    stage("matching")?;
    let left_open: Vec<QuadId> = joins.iter().flat_map(|j| j.quads).collect();
    let sides = match planned {
        Some((_, sides)) if left_open.is_empty() => sides,
        _ => light_sides(surface, &left_open, options.variant / 2, ctx)?,
    };
    stage("buffer layer")?;
    let layer = Layer::new(surface, &colours, &sides, library)?;
    stage("sigma")?;
    let cut = sigma(surface, &colours, &complex, &surface_edges(surface, &layer, &complex, &boundary))?;
    stage("cells")?;
    let n_quads = surface.n_quads();
    let (cells, n_inner) = count_cells(&layer, library, n_quads)?;
    let n_cell_hexes = cells.values().map(|(count, hexes)| count * hexes).sum();
    let mut n_split = [0usize; 3];
    for edges in &complex.tet_edges {
        n_split[match edges.iter().filter(|&&e| cut[e as usize]).count() {
            0 => 0,
            3 => 1,
            _ => 2,
        }] += 1;
    }
    let mut report = Report {
        route: match (options.route, colours.n_cut_edges) {
            (RouteChoice::Erickson, _) => Route::Erickson,
            (RouteChoice::Auto, 0) => Route::Bipartite,
            (RouteChoice::Auto, _) => Route::Mixed,
        },
        n_quads,
        n_white: colours.white.iter().filter(|&&w| w).count(),
        n_cut_edges: colours.n_cut_edges,
        n_unmatched: sides.n_unmatched,
        cells,
        n_cell_hexes,
        tets_by: maker,
        n_tets: complex.tets.len(),
        n_split,
        n_core_hexes: 4 * n_split[0] + 7 * n_split[1] + 8 * n_split[2],
        n_cone_hexes: (centre.is_some() && maker == DelaunayTets::default().name()).then_some(8 * n_quads),
        n_joins: joins.len(),
        n_join_hexes: 0,
    };
    if report.n_hexes() > HexMesh::MAX_HEXES {
        return Err(ConstructError::TooLarge { what: "hexes", given: report.n_hexes(), limit: HexMesh::MAX_HEXES });
    }
    let mut hexes = Vec::with_capacity(report.n_hexes());
    place_cells(&layer, library, n_quads, layer.n_points(), &mut hexes, ctx)?;
    stage("core")?;
    let first = layer.n_points() as usize + n_inner;
    let first = u32::try_from(first).map_err(|_| ConstructError::TooLarge {
        what: "vertices",
        given: first,
        limit: u32::MAX as usize,
    })?;
    let core = core_points(&complex, &cut, &boundary, &layer, surface.n_vertices(), first)?;
    let first_core_hex = hexes.len();
    split_tets(&complex, &cut, &core, &mut hexes);
    debug_assert_eq!(hexes.len(), report.n_hexes());
    let mut n_vertices = core.end as usize;
    let mut start = inner.as_mut().map(|inner| {
        inner.fit_to_tets(surface, &complex);
        start_positions(surface, inner, &layer, library, &complex, &core)
    });
    if !joins.is_empty() {
        stage("odd components")?;
        let mut first_hex = vec![first_core_hex];
        for edges in &complex.tet_edges {
            let n_cut = edges.iter().filter(|&&e| cut[e as usize]).count();
            first_hex.push(first_hex.last().map_or(0, |l| l + 4 + n_cut));
        }
        let mut removed = vec![false; hexes.len()];
        let mut added: Vec<[u32; 8]> = Vec::new();
        for join in &joins {
            let made = fill_join(join, &layer, library, &hexes, &first_hex, start.as_deref(), ctx)?;
            made.removed.iter().for_each(|&h| removed[h] = true);
            report.n_core_hexes -= made.removed.len();
            report.n_join_hexes += made.filling.mesh.n_hexes();
            let n_old = made.ids.len();
            let first = n_vertices;
            n_vertices += made.filling.mesh.n_vertices() - n_old;
            if n_vertices > u32::MAX as usize {
                return Err(ConstructError::TooLarge { what: "vertices", given: n_vertices, limit: u32::MAX as usize });
            }
            let place = |v: usize| if v < n_old { made.ids[v] } else { (first + v - n_old) as u32 };
            added.extend(made.filling.mesh.hexes().iter().map(|h| h.map(|v| place(v.index()))));
            if let Some(start) = &mut start {
                match &made.filling.start {
                    Some(inner) => start.extend(&inner[n_old..]),
                    None => start.resize(n_vertices, [0.0; 3]),
                }
            }
        }
        let mut kept = removed.iter();
        hexes.retain(|_| kept.next().is_some_and(|r| !r));
        hexes.extend(added);
        n_vertices = without_gaps(surface.n_vertices(), n_vertices, &mut hexes, start.as_mut());
    }
    stage("mesh")?;
    drop((complex, core, cut, triangles));
    let mesh = HexMesh::try_new(n_vertices, &hexes)?;
    Ok(Construction { mesh, report, start })
}

/// Puts the apex of a cone over the inner copy of the surface to `centre`, which sees all of it, if it does not lie well already.
fn move_apex(complex: &mut TetComplex, inner: &InnerCopy, apex: usize, centre: [f64; 3]) {
    let Some(points) = complex.points.as_mut().filter(|p| p.len() == apex + 1) else { return };
    let at = |v: u32| if (v as usize) < apex { inner.at(v as usize) } else { points[v as usize] };
    if !complex.tets.iter().all(|t| volume(t.map(at)) > 0.0) {
        points[apex] = centre;
    }
}

/// Tetrahedra with positive volumes between the inner copies of the vertices, else between the vertices themselves (the inner
/// copy of a thin solid may meet itself); `None` if neither has any.
fn geometric_tets(
    request: &TetRequest<'_>,
    inner: Option<&InnerCopy>,
    ctx: &Context<'_>,
) -> Result<Option<TetComplex>, ConstructError> {
    let inner = inner.map(InnerCopy::points);
    for points in [inner.as_deref(), request.points] {
        match DelaunayTets::default().fill(&TetRequest { points, ..*request }, ctx) {
            Err(ConstructError::Stopped(reason)) => return Err(ConstructError::Stopped(reason)),
            Err(_) => {}
            Ok(complex) => return Ok(Some(complex)),
        }
    }
    Ok(None)
}

/// Renumbers the inner vertices that hexes use, in order; returns the number of vertices.
fn without_gaps(
    n_surface: usize,
    n_vertices: usize,
    hexes: &mut [[u32; 8]],
    start: Option<&mut Vec<[f64; 3]>>,
) -> usize {
    let mut used = vec![false; n_vertices];
    hexes.iter().flatten().for_each(|&v| used[v as usize] = true);
    used[..n_surface].fill(true);
    let mut number = vec![0u32; n_vertices];
    let mut next = 0u32;
    for (number, _) in number.iter_mut().zip(&used).filter(|(_, used)| **used) {
        *number = next;
        next += 1;
    }
    hexes.iter_mut().flatten().for_each(|v| *v = number[*v as usize]);
    if let Some(start) = start {
        let mut used = used.iter();
        start.retain(|_| used.next().is_some_and(|u| *u));
    }
    next as usize
}

/// The triangles that tetrahedra of the interior have to fill, outward, as vertices of the surface: two a quad. For
/// making tetrahedra elsewhere (see [`crate::GivenTets`]).
pub fn core_triangles(surface: &QuadSurface, route: RouteChoice) -> Vec<[u32; 3]> {
    triangles(
        surface,
        &match route {
            RouteChoice::Auto => colouring(surface, false),
            RouteChoice::Erickson => all_black(surface),
        },
    )
}

/// Per dart: the edge of the complex under it.
fn surface_edges(surface: &QuadSurface, layer: &Layer<'_>, complex: &TetComplex, boundary: &[u32]) -> Vec<u32> {
    let mut triangle_of = vec![u32::MAX; complex.n_faces];
    for (t, &f) in boundary.iter().enumerate() {
        triangle_of[f as usize] = t as u32;
    }
    let mut edges = vec![0; 4 * surface.n_quads()];
    for (t, tet) in complex.tets.iter().enumerate() {
        for i in 0..4 {
            let triangle = triangle_of[complex.tet_faces[t][i] as usize];
            if triangle == u32::MAX {
                continue;
            }
            let (q, half) = (QuadId(triangle / 2), (triangle % 2) as u8);
            for side in [2 * half, 2 * half + 1] {
                let d = layer.dart(q, side);
                let local = |v: u32| others(i).into_iter().find(|&j| tet[j] == v);
                if let (Some(a), Some(b)) = (local(surface.origin(d).0), local(surface.target(d).0)) {
                    edges[d.index()] = complex.tet_edges[t][tet_edge(a, b)];
                }
            }
        }
    }
    edges
}
