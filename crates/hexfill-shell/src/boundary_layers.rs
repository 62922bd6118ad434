//! Boundary layers: the hexes of a pillow, the one layer under the whole surface, cut into thin ones parallel to it.
//!
//! A pillow is a sheet that ends nowhere on the surface, so it may be cut into any number of layers: the surface stays. Heights
//! are measured along the pillow's own edges, from the surface inward; where an edge is too short for the heights asked for, they
//! shrink there by one factor.
//!
//! Source: ours; a sheet cut into layers is plain refinement along a dual surface.

use crate::blend::blend_block;
use crate::compress::uncompressed;
use crate::lift::{AXES, Lattice, parallel_classes};
use hexfill_geometry::{add_scaled, norm, sub};
use hexfill_mesh::cube::POSITIONS;
use hexfill_mesh::{HexMesh, QuadSurface};
use rustc_hash::FxHashMap;

/// Layers under the surface.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct BoundaryLayers {
    /// How many.
    pub count: u32,
    /// Height of the first one in the unit of the surface; `None`: all layers of one edge have the same height.
    pub height: Option<f64>,
    /// Each layer is this many times as high as the one before.
    pub growth: f64,
}

/// Of an edge, heights take at most this share.
const MOST: f64 = 0.8;

impl BoundaryLayers {
    /// How many cells an edge is cut into: with heights given, what is left of it is one more.
    fn cells(&self) -> u32 {
        self.count + u32::from(self.height.is_some())
    }

    /// Where an edge of this length is cut, as shares of it.
    fn cuts(&self, length: f64) -> Vec<f64> {
        let n = self.cells();
        let Some(height) = self.height else { return (1..n).map(|i| f64::from(i) / f64::from(n)).collect() };
        let mut sum = 0.0;
        let tops: Vec<f64> = (0..self.count)
            .map(|i| {
                sum += height * self.growth.powi(i as i32);
                sum
            })
            .collect();
        let shrink = (MOST * length / sum).min(1.0);
        tops.iter().map(|t| t * shrink / length).collect()
    }
}

/// A mesh with boundary layers.
#[derive(Clone, Debug)]
pub struct CutLayers {
    /// The mesh; surface vertices keep their ids.
    pub mesh: HexMesh,
    /// The positions of all vertices.
    pub points: Vec<[f64; 3]>,
    /// Per hex: the hex of the mesh before that it is, or `None` for a piece of one that was cut.
    pub origin: Vec<Option<u32>>,
}

/// Cuts the layer of hexes under the surface; `points` are those of all vertices of the mesh. `None` if some hex there is not in a pillow, so that a cut
/// would reach the surface, or one sheet is all there is between two parts of the surface, so that it has no outer side.
pub fn cut_boundary_layers(
    mesh: &HexMesh,
    surface: &QuadSurface,
    points: &[[f64; 3]],
    layers: &BoundaryLayers,
) -> Option<CutLayers> {
    if layers.cells() <= 1 {
        let origin = (0..mesh.n_hexes() as u32).map(Some).collect();
        return Some(CutLayers { mesh: mesh.clone(), points: points.to_vec(), origin });
    }
    let n_surface = surface.n_vertices() as u32;
    let hexes = mesh.hexes_raw();
    let classes = parallel_classes(&hexes);
    let key = |a: u32, b: u32| [a.min(b), a.max(b)];
    // A sheet is a class of parallel edges. Those that leave the surface are to be cut; if such a sheet had an edge
    // on the surface, it would end there, and the cut would split quads of the surface.
    let mut is_cut = vec![false; classes.n];
    for f in mesh.boundary_facets() {
        let (hex, side) = (hexes[f.hex().index()], f.side());
        let [i, j] = AXES[side / 2];
        is_cut[classes.of[&key(hex[i], hex[j])] as usize] = true;
    }
    for quad in surface.quads() {
        for i in 0..4 {
            let class = classes.of.get(&key(quad[i].0, quad[(i + 1) & 3].0))?;
            if is_cut[*class as usize] {
                return None;
            }
        }
    }
    let from_surface = inward(&hexes, &classes.of, &is_cut, n_surface)?;
    // The lattice numbers points as lifting does, the surface's own first; here every quad is a grid of one.
    let wanted = vec![2.0; 4 * surface.n_quads()];
    let mut lattice = Lattice::new(&uncompressed(surface, &wanted), n_surface);
    let mut at: Vec<[f64; 3]> = points[..n_surface as usize].to_vec();
    let (mut cut, mut origin) = (Vec::new(), Vec::new());
    for (h, hex) in (0..).zip(&hexes) {
        let sizes =
            AXES.map(|[i, j]| if is_cut[classes.of[&key(hex[i], hex[j])] as usize] { layers.cells() } else { 1 });
        let [a, b, c] = sizes.map(|s| s as usize);
        let ids = lattice.points_of(hex, sizes);
        let id = |i: usize, j: usize, k: usize| ids[(k * (b + 1) + j) * (a + 1) + i];
        at.resize(lattice.n_vertices() as usize, [f64::NAN; 3]);
        for (p, &v) in POSITIONS.iter().zip(hex) {
            at[id(p[0] as usize * a, p[1] as usize * b, p[2] as usize * c) as usize] = points[v as usize];
        }
        for e in hexfill_mesh::cube::EDGES {
            let [v, w] = e.map(|i| hex[i]);
            if is_cut[classes.of[&key(v, w)] as usize] {
                // Outer end first.
                let (v, w) = if *from_surface.get(&key(v, w))? == v { (v, w) } else { (w, v) };
                let (p, q) = (points[v as usize], points[w as usize]);
                let length = norm(sub(q, p));
                for (i, share) in layers.cuts(length).into_iter().enumerate() {
                    let inner = lattice.point_on_edge(v, w, i);
                    at[inner as usize] = add_scaled(p, share, sub(q, p));
                }
            }
        }
        blend_block(&ids, sizes, &mut at);
        let n_pieces = a * b * c;
        origin.extend(std::iter::repeat_n((n_pieces == 1).then_some(h), n_pieces));
        for k in 0..c {
            for j in 0..b {
                for i in 0..a {
                    cut.push(POSITIONS.map(|p| id(i + p[0] as usize, j + p[1] as usize, k + p[2] as usize)));
                }
            }
        }
    }
    let mesh = HexMesh::try_new(lattice.n_vertices() as usize, &cut).ok()?;
    Some(CutLayers { mesh, points: at, origin })
}

/// The outer end of every edge that is cut: the one on the surface, and for edges without one the end that corresponds to it.
/// `None` if the two sides of a sheet contradict each other; a sheet with both sides on the surface has no entries.
fn inward(
    hexes: &[[u32; 8]],
    classes: &FxHashMap<[u32; 2], u32>,
    is_cut: &[bool],
    n_surface: u32,
) -> Option<FxHashMap<[u32; 2], u32>> {
    let key = |a: u32, b: u32| [a.min(b), a.max(b)];
    let mut outer: FxHashMap<[u32; 2], u32> = FxHashMap::default();
    // Parallel edges of one hex, as (lower end, upper end) along an axis.
    let parallel = |axis: usize| {
        (0..8).filter(move |&i| POSITIONS[i][axis] == 0).map(move |i| {
            let mut p = POSITIONS[i];
            p[axis] = 1;
            [i, hexfill_mesh::cube::corner_at(p[0], p[1], p[2])]
        })
    };
    // From the surface through the sheet, hex by hex: parallel edges of one hex point the same way. A sheet that
    // meets itself turned round contradicts itself somewhere and is found by that.
    loop {
        let before = outer.len();
        for hex in hexes {
            for (axis, &[i, j]) in AXES.iter().enumerate() {
                if !is_cut[classes[&key(hex[i], hex[j])] as usize] {
                    continue;
                }
                let lower_is_outer = parallel(axis).find_map(|[i, j]| {
                    let (v, w) = (hex[i], hex[j]);
                    match (v < n_surface, w < n_surface) {
                        (true, false) => Some(true),
                        (false, true) => Some(false),
                        _ => outer.get(&key(v, w)).map(|&o| o == v),
                    }
                });
                let Some(lower_is_outer) = lower_is_outer else { continue };
                for [i, j] in parallel(axis) {
                    let end = if lower_is_outer { hex[i] } else { hex[j] };
                    if *outer.entry(key(hex[i], hex[j])).or_insert(end) != end {
                        return None;
                    }
                }
            }
        }
        if outer.len() == before {
            return Some(outer);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ShellOptions, shell};
    use hexfill_mesh::Context;
    use hexfill_mesh::generate::voxel_surface;

    /// A 2 x 2 x 2 box with its corner points, filled behind one pillow.
    fn pillowed_box() -> (QuadSurface, HexMesh, Vec<[f64; 3]>) {
        let surface = voxel_surface([2, 2, 2], |_| true).unwrap();
        let options = ShellOptions::default().with_pillows(vec![1]);
        let mesh = shell(&surface, None, &options, &Context::default()).meshes.remove(0).mesh;
        let points = (0..mesh.n_vertices()).map(|v| [v as f64, (v * v % 7) as f64, (v % 3) as f64]).collect();
        (surface, mesh, points)
    }

    #[test]
    fn a_pillow_is_cut_and_the_surface_stays() {
        let (surface, mesh, points) = pillowed_box();
        for (height, cells) in [(None, 3), (Some(0.01), 4)] {
            let layers = BoundaryLayers { count: 3, height, growth: 1.5 };
            let CutLayers { mesh: cut, points: at, origin } =
                cut_boundary_layers(&mesh, &surface, &points, &layers).unwrap();
            assert_eq!(cut.n_hexes(), mesh.n_hexes() + (cells - 1) * surface.n_quads());
            assert_eq!(at.len(), cut.n_vertices());
            assert_eq!(origin.iter().filter(|o| o.is_none()).count(), cells * surface.n_quads());
            assert_eq!(&at[..surface.n_vertices()], &points[..surface.n_vertices()]);
            assert!(at.iter().flatten().all(|x| x.is_finite()));
            let hexes = cut.hexes_raw();
            let quads: Vec<[u32; 4]> = surface.quads_raw();
            let judged = hexfill_check::Judged::connectivity(cut.n_vertices(), &hexes).with_surface(&quads);
            let options = hexfill_check::Options::default().with_up_to(hexfill_check::Level::L3);
            assert!(hexfill_check::judge(&judged, &options, &Context::default()).passed(hexfill_check::Level::L3));
        }
    }

    #[test]
    fn heights_grow_and_shrink_where_there_is_no_room() {
        let layers = BoundaryLayers { count: 2, height: Some(1.0), growth: 2.0 };
        assert_eq!(layers.cuts(10.0), [0.1, 0.3]);
        let tight = layers.cuts(1.5);
        assert!((tight[1] - MOST).abs() < 1e-12 && (tight[1] / tight[0] - 3.0).abs() < 1e-12);
    }

    #[test]
    fn a_sheet_between_two_surfaces_has_no_outer_side() {
        // A cube within a cube, joined by six hexes: every edge across has both ends on the surface.
        let hexes: Vec<[u32; 8]> = hexfill_mesh::cube::FACETS
            .map(|f| f.map(|v| v as u32))
            .map(|[a, b, c, d]| [a + 8, b + 8, c + 8, d + 8, a, b, c, d])
            .to_vec();
        let mesh = HexMesh::try_new(16, &hexes).unwrap();
        let surface = QuadSurface::try_new(16, &mesh.boundary_quads_raw()).unwrap();
        let layers = BoundaryLayers { count: 3, height: None, growth: 1.0 };
        assert!(cut_boundary_layers(&mesh, &surface, &[[0.0; 3]; 16], &layers).is_none());
    }

    #[test]
    fn without_a_pillow_nothing_is_cut() {
        let surface = voxel_surface([2, 2, 2], |_| true).unwrap();
        let options = ShellOptions::default().with_pillows(vec![0]);
        let mesh = shell(&surface, None, &options, &Context::default()).meshes.remove(0).mesh;
        let points = vec![[0.0; 3]; mesh.n_vertices()];
        let layers = BoundaryLayers { count: 2, height: None, growth: 1.0 };
        assert!(cut_boundary_layers(&mesh, &surface, &points, &layers).is_none());
    }
}
