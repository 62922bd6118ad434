//! First positions of a lifted mesh: coarse vertices where springs put them, the rest blended block by block.
//!
//! The inside of every block is the transfinite interpolation of its facets, theirs that of their edges (Gordon, Hall 1973).
//! Where the surface is a box that is exact; elsewhere it is a first guess for smoothing.
//!
//! Source: Gordon, Hall 1973 (transfinite interpolation).

use hexfill_mesh::Context;
use hexfill_mesh::cube::EDGES;
use rustc_hash::FxHashMap;

type Point = [f64; 3];

/// Sweeps of the springs over all coarse vertices at most.
const SWEEPS: usize = 300;

/// Positions of the coarse vertices that `fixed` does not know: each at the mean of its neighbours, weighted by how short the
/// edge to them is in fine edges. Told to stop, it leaves them on the way.
pub(crate) fn springs(
    hexes: &[[u32; 8]],
    segments: &FxHashMap<[u32; 2], u32>,
    fixed: &dyn Fn(u32) -> Option<Point>,
    ctx: &Context<'_>,
) -> FxHashMap<u32, Point> {
    let mut edges: Vec<[u32; 2]> =
        hexes.iter().flat_map(|h| EDGES.map(|[i, j]| [h[i].min(h[j]), h[i].max(h[j])])).collect();
    edges.sort_unstable();
    edges.dedup();
    let mut vertices: Vec<u32> = edges.iter().flatten().copied().collect();
    vertices.sort_unstable();
    vertices.dedup();
    let slot = |v: u32| vertices.binary_search(&v).expect("every vertex is on an edge");
    let mut neighbours: Vec<Vec<(usize, f64)>> = vec![Vec::new(); vertices.len()];
    for e in &edges {
        // An edge that will be cut into many pieces may be long: springs in a row are as soft as they are many.
        let weight = 1.0 / f64::from(segments[e]);
        let [a, b] = e.map(slot);
        neighbours[a].push((b, weight));
        neighbours[b].push((a, weight));
    }
    let known: Vec<Option<Point>> = vertices.iter().map(|&v| fixed(v)).collect();
    let n_known = known.iter().flatten().count().max(1) as f64;
    let centre: Point = std::array::from_fn(|k| known.iter().flatten().map(|p| p[k] / n_known).sum());
    let mut at: Vec<Point> = known.iter().map(|p| p.unwrap_or(centre)).collect();
    let free: Vec<usize> = (0..at.len()).filter(|&i| known[i].is_none()).collect();
    // Gauss-Seidel in the order of ids: the coarse mesh is small, and a fixed number of sweeps gives the same bytes
    // everywhere.
    for _ in 0..SWEEPS {
        let mut moved = 0.0f64;
        for &i in &free {
            let total: f64 = neighbours[i].iter().map(|n| n.1).sum();
            let mean: Point =
                std::array::from_fn(|k| neighbours[i].iter().map(|&(j, w)| w * at[j][k]).sum::<f64>() / total);
            moved = (0..3).map(|k| (mean[k] - at[i][k]).abs()).fold(moved, f64::max);
            at[i] = mean;
        }
        if moved == 0.0 || ctx.stop().is_some() {
            break;
        }
    }
    vertices.into_iter().zip(at).collect()
}

/// Fills in the positions of a block of `a x b x c` cells, x fastest: what is unknown (not a number) on its edges, then facets,
/// then inside. Corners are known.
pub(crate) fn blend_block(ids: &[u32], [a, b, c]: [u32; 3], at: &mut [Point]) {
    let size = [a, b, c];
    let id = |p: [u32; 3]| ids[((p[2] * (b + 1) + p[1]) * (a + 1) + p[0]) as usize] as usize;
    // How many of the three coordinates lie strictly inside: 1 on an edge, 2 on a facet, 3 in the block.
    for inner in 1..=3 {
        for z in 0..=c {
            for y in 0..=b {
                for x in 0..=a {
                    let p = [x, y, z];
                    let is_inner: [bool; 3] = std::array::from_fn(|k| p[k] > 0 && p[k] < size[k]);
                    if is_inner.iter().filter(|i| **i).count() != inner || !at[id(p)][0].is_nan() {
                        continue;
                    }
                    at[id(p)] = blend(p, size, is_inner, &|q| at[id(q)]);
                }
            }
        }
    }
}

/// The transfinite interpolation at `p` from the points with fewer inner coordinates: the alternating sum, over the sets of inner
/// axes that are moved to their ends, of the linear interpolations between those ends.
fn blend(p: [u32; 3], size: [u32; 3], is_inner: [bool; 3], at: &dyn Fn([u32; 3]) -> Point) -> Point {
    let mut sum = [0.0; 3];
    for set in 1..8usize {
        if (0..3).any(|k| set >> k & 1 == 1 && !is_inner[k]) {
            continue;
        }
        let sign = if set.count_ones() % 2 == 1 { 1.0 } else { -1.0 };
        for ends in 0..8usize {
            if ends & !set != 0 {
                continue;
            }
            let mut q = p;
            let mut weight = sign;
            for k in (0..3).filter(|k| set >> k & 1 == 1) {
                let t = f64::from(p[k]) / f64::from(size[k]);
                let end = ends >> k & 1 == 1;
                q[k] = if end { size[k] } else { 0 };
                weight *= if end { t } else { 1.0 - t };
            }
            let point = at(q);
            (0..3).for_each(|k| sum[k] += weight * point[k]);
        }
    }
    sum
}
