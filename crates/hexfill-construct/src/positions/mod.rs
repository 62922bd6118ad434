//! Step 6: start positions. Every buffer cube is the trilinear image of its cell's template, the core's points are
//! means of the tets' corners. What an embedding then has to do is local. (Ours; book, page `construction`, "From topology to
//! geometry".)
//!
//! Source: ours.

use crate::cells::library::CellLibrary;
use crate::cells::template::{CORNERS, template};
use crate::core::Inside;
use crate::core::complex::{TET_EDGES, others};
use crate::core::inner_copy::InnerCopy;
use crate::hexes::tets::CorePoints;
use crate::ids::{PointId, TetId};
use crate::layer::Layer;
use crate::plan::Plan;
use hexfill_geometry::Vector;
use hexfill_mesh::{IdVec, QuadId, VertexId};

/// Start positions of every vertex of the mesh, if the surface has positions; those of the surface are its own, bit for bit.
pub(crate) fn positions(
    plan: &Plan<'_>,
    inside: &mut Inside,
    layer: &Layer<'_>,
    core: &CorePoints,
) -> Option<IdVec<PointId, Vector>> {
    let mut inner = inside.inner.take()?;
    // Tets may have been made between other places than the inner copies are at; the copies give way until those tets
    // are right side out.
    inner.fit_to_tets(plan.surface, &inside.complex);
    let mut out = IdVec::filled([0.0; 3], core.end.index());
    out.as_mut_slice()[..inner.outer.len()].copy_from_slice(&inner.outer);
    // Core first: what lies on the inner facets is then written again by the cells.
    let start = CoreStart { inside, inner: &inner, core };
    for t in inside.complex.tets.ids() {
        start.place(t, &mut out);
    }
    place_layer(plan.library, layer, &inner, &mut out);
    Some(out)
}

/// The points of the core's hexes as means of corners.
struct CoreStart<'a> {
    inside: &'a Inside,
    inner: &'a InnerCopy,
    core: &'a CorePoints,
}

impl CoreStart<'_> {
    fn vertex(&self, v: VertexId) -> Vector {
        match self.inside.complex.points.as_ref() {
            _ if v.index() < self.inner.outer.len() => self.inner.at(v),
            Some(p) => p[v.index()],
            None => [0.0; 3],
        }
    }

    /// The points of one tet. Where Sigma passes, both copies of a point lean to their side: they weigh its corners twice.
    fn place(&self, t: TetId, out: &mut IdVec<PointId, Vector>) {
        let (complex, core) = (&self.inside.complex, self.core);
        let tet = complex.tets[t];
        let p = tet.map(|v| self.vertex(v));
        let mean = |local: &[usize], weights: &[f64]| -> Vector {
            let total: f64 = weights.iter().sum();
            std::array::from_fn(|c| local.iter().zip(weights).map(|(&i, w)| w * p[i][c]).sum::<f64>() / total)
        };
        let mut side = [false; 4];
        for (k, &[i, j]) in TET_EDGES.iter().enumerate() {
            let [low, high] = core.edge[complex.tet_edges[t][k]];
            let (i, j) = if tet[i] < tet[j] { (i, j) } else { (j, i) };
            if low == high {
                out[low] = mean(&[i, j], &[1.0, 1.0]);
            } else {
                // Thirds: the two copies of a point lie apart by as much as either from its end, and sheet hexes get
                // volume.
                out[low] = mean(&[i, j], &[2.0, 1.0]);
                out[high] = mean(&[i, j], &[1.0, 2.0]);
            }
            if i == 0 || j == 0 {
                side[i.max(j)] = low != high;
            }
        }
        let split = |local: &[usize], near: bool| {
            let weights: Vec<f64> = local.iter().map(|&i| if side[i] == near { 2.0 } else { 1.0 }).collect();
            mean(local, &weights)
        };
        for i in 0..4 {
            let f = others(i);
            let [lone, pair] = core.face[complex.tet_faces[t][i]];
            if lone == pair {
                out[lone] = mean(&f, &[1.0; 3]);
            } else {
                let n_far = f.iter().filter(|&&k| side[k]).count();
                out[lone] = split(&f, n_far == 1);
                out[pair] = split(&f, n_far == 2);
            }
        }
        let [near, far] = core.tet[t];
        out[near] = if near == far { mean(&[0, 1, 2, 3], &[1.0; 4]) } else { split(&[0, 1, 2, 3], false) };
        if near != far {
            out[far] = split(&[0, 1, 2, 3], true);
        }
        for (v, at) in tet.into_iter().zip(p) {
            out[core.vertex[v]] = at;
        }
    }
}

/// Trilinear map of the template's cube to the hexahedron with outer corners `low` and inner corners `high`.
fn trilinear(low: &[Vector; 4], high: &[Vector; 4], p: Vector) -> Vector {
    let weight = |k: usize| (1.0 + CORNERS[k][0] * p[0]) * (1.0 + CORNERS[k][1] * p[1]) / 4.0;
    let s = (1.0 + p[2]) / 2.0;
    std::array::from_fn(|c| (0..4).map(|k| weight(k) * ((1.0 - s) * low[k][c] + s * high[k][c])).sum())
}

/// Every cell as the image of its template.
fn place_layer(library: &CellLibrary, layer: &Layer<'_>, inner: &InnerCopy, out: &mut IdVec<PointId, Vector>) {
    let templates: Vec<Vec<Vector>> = library.cells().iter().map(template).collect();
    let n_surface = inner.outer.len();
    let mut next = layer.end();
    for q in (0..layer.n_quads()).map(QuadId::new) {
        // Templates have congruent sides, so both cells at an edge put the points of their common side to the same
        // place but for rounding, whichever comes last.
        let Some(cell) = library.find(&layer.pattern(q)) else { continue };
        let corners = [0, 1, 2, 3].map(|k| layer.corner(q, k));
        let (low, high) = (corners.map(|v| inner.outer[v.index()]), corners.map(|v| inner.at(v)));
        for (i, &p) in templates[cell.cell].iter().enumerate() {
            let at = trilinear(&low, &high, cell.symmetry.position(p));
            match cell.boundary.get(i) {
                Some(&role) => {
                    let point = layer.point(q, role);
                    // The image of a corner may be off by a rounding; the surface keeps its bits.
                    if point.index() >= n_surface {
                        out[point] = at;
                    }
                }
                None => {
                    out[next] = at;
                    next = next.plus(1);
                }
            }
        }
    }
}
