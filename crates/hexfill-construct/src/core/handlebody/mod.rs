//! Tetrahedra of a handlebody without a mesher: cut along disks, cone the ball that is left (Erickson 2014 asks for
//! tetrahedra of the interior; this is one way to have them from topology alone).
//!
//! A surface of genus g in space whose interior is a handlebody has g loops that bound disks inside and together
//! do not separate it. Cut along such a loop and cap both sides by a fan round a new vertex: the genus drops by one.
//! After g cuts a sphere is left; cone it from one apex and glue the two copies of every fan triangle again. The
//! result is a handlebody whose boundary is the triangulated surface, with 2 tets a quad and a few more per disk.
//! Edges are named by the sphere, so an apex may have several edges to one vertex: the complex is not simplicial as
//! vertex sets, but stars of vertices are, which is all the hexes need (the judge confirms every result).
//!
//! Several components: those of one solid (an outside and its cavities, of any genus, see `surface/nesting.rs`) are first joined by
//! prisms from a triangle of the one to a triangle of the next; what is left inside is treated as above. Each prism takes
//! three tets more. Solids apart get an apex each.
//!
//! Which loops: the shortest one that is null-homologous inside (by linking numbers, see `surface/linking.rs`) and does not
//! separate the surface. Null-homologous is necessary for bounding a disk and not sufficient: for an interior
//! that is no handlebody (outside of a knot, say) the mesh is a correct hex mesh of *a* handlebody with this boundary,
//! not of that interior. The report names the maker `handlebody` so that this is visible.
//!
//! `joining.rs` joins components by prisms -> `disk.rs` finds a loop -> `cutting.rs` cuts along it -> `coning.rs` makes the tetrahedra.
//!
//! Source: ours, with Erickson and Har-Peled 2004 for the loops.

mod coning;
mod cutting;
mod disk;
mod joining;
mod prism;

use super::complex::TetComplex;
use super::maker::{Core, InteriorTets};
use super::request::TetRequest;
use crate::error::ConstructError;
use crate::missing::MissingInterior;
use crate::surface::linking::{Linking, LinkingError, linking};
use crate::surface::nesting::solids;
use crate::surface::polygons::{Darts, GonId};
use coning::cone;
use cutting::{Cutting, Homology};
use disk::shortest_disk;
use hexfill_geometry::centroid;
use hexfill_mesh::{Context, VertexId};
use joining::join;

/// Cuts a handlebody along disks. See the module page.
#[derive(Clone, Copy, Debug, Default)]
pub struct HandlebodyTets;

/// Handles that are cut at most: the search for a loop keeps one bit for each of the 2 g basis loops.
const MOST_HANDLES: u64 = 32;

impl InteriorTets for HandlebodyTets {
    fn core(&self) -> Core {
        Core::Handlebody
    }

    fn fill(&self, request: &TetRequest<'_>, ctx: &Context<'_>) -> Result<TetComplex, ConstructError> {
        let needed = |reason| request.interior_needed(reason);
        let s = Darts::of_triangles(request.n_vertices, request.triangles);
        let points = request.points.ok_or_else(|| needed(MissingInterior::NoPositions))?;
        let (component, n_components) = request.components();
        let solids = match n_components {
            1 => vec![vec![0]],
            _ => solids(request.triangles, &component, n_components, points).map_err(needed)?,
        };
        let (genus, _) = request.shape();
        if genus > MOST_HANDLES {
            return Err(needed(MissingInterior::TooManyHandles));
        }
        let l = linking(&s, points, ctx).map_err(|e| match e {
            LinkingError::Undecided(reason) => needed(reason),
            LinkingError::Stopped(reason) => ConstructError::Stopped(reason),
        })?;
        // Numbers with loops pushed outward are coordinates of a loop's class inside, so that from here on nothing
        // asks the positions what bounds.
        let inside = homology(&s, &l);
        let mut cutting = Cutting::new(s, inside);
        for solid in &solids {
            for pair in solid.windows(2) {
                // A part gives its last triangle to the next prism and its first one to the prism before.
                let last = component.iter().rposition(|&c| c == pair[0]);
                let first = component.iter().position(|&c| c == pair[1]);
                if let (Some(a), Some(b)) = (last, first) {
                    join(&mut cutting, GonId::new(a), GonId::new(b));
                }
            }
        }
        let mut points = points.to_vec();
        for handle in 0..genus {
            if let Some(reason) = ctx.stop() {
                return Err(ConstructError::Stopped(reason));
            }
            ctx.report("disks", handle, Some(genus), String::new);
            let path = shortest_disk(&cutting, ctx)?.ok_or_else(|| needed(MissingInterior::NoHandlebody))?;
            let centre = VertexId::new(points.len());
            points.push(cutting.mean(&path, &points));
            cutting.cut(&path, centre);
        }
        let mut solid_of = vec![0; n_components];
        for (k, solid) in solids.iter().enumerate() {
            let own = request.triangles.iter().zip(&component).filter(|(_, c)| solid.contains(c));
            points.push(centroid(own.map(|(t, _)| t.map(|v| points[v.index()]))));
            solid.iter().for_each(|&c| solid_of[c] = k);
        }
        let solid_of: Vec<usize> = component.iter().map(|&c| solid_of[c]).collect();
        Ok(cone(&cutting, &solid_of, solids.len(), points))
    }
}

/// The interior's first homology as closed cochains, one a basis loop: by Alexander duality the linking numbers with the loops
/// pushed outward are coordinates of a loop's class inside.
fn homology(s: &Darts, l: &Linking) -> Homology {
    let width = l.loops.len();
    let mut inside = Homology::zero(width, s.len());
    for j in 0..width {
        let values: Vec<i64> = l.numbers.iter().map(|row| row[j]).collect();
        for (d, &x) in l.trees.closed_cochain(s, &values).enumerate() {
            inside.of_mut(d)[j] = x;
        }
    }
    inside
}
