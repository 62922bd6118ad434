//! Named and regular surfaces: the cube, benchmark spheres, tori, voxel surfaces, refinement.
//!
//! Source: the catalogue for named surfaces; the others are ours.

use crate::cube::{FACETS, POSITIONS};
use crate::ids::VertexId;
use crate::surface::{QuadSurface, SurfaceError};
use rustc_hash::FxHashMap;

/// The cube's 6 quads, vertices as in [`crate::cube`], quads in the order of [`FACETS`].
pub fn cube_surface() -> QuadSurface {
    let quads = FACETS.map(|f| f.map(|v| v as u32));
    QuadSurface::try_new(8, &quads).expect("the cube is a surface")
}

/// The octagonal spindle (tetragonal trapezohedron): 8 quads, 10 vertices; the pseudo-double wheel with two poles of degree 4.
pub fn octagonal_spindle() -> QuadSurface {
    super::pseudo_double_wheel(4).expect("four is enough")
}

/// Schneiders' pyramid (open problem of 1996): a square base in 4 quads, each side in 3; 16 quads, 18 vertices.
pub fn schneiders_pyramid() -> QuadSurface {
    const QUADS: [[u32; 4]; 16] = [
        [10, 2, 12, 0],
        [0, 12, 9, 15],
        [11, 0, 15, 7],
        [5, 10, 0, 11],
        [12, 2, 3, 13],
        [9, 12, 13, 8],
        [13, 3, 1, 8],
        [10, 5, 4, 17],
        [2, 10, 17, 3],
        [3, 17, 4, 1],
        [4, 5, 11, 16],
        [11, 7, 6, 16],
        [1, 4, 16, 6],
        [14, 6, 7, 15],
        [9, 8, 14, 15],
        [1, 6, 14, 8],
    ];
    QuadSurface::try_new(18, &QUADS).expect("the pyramid is a surface")
}

/// A torus of `n * m` quads: vertex (i, j) is `n * j + i`; column index i runs modulo `n`, and row `m` is row 0 moved by `shift`.
///
/// # Errors
/// [`SurfaceError`] where so few rows or columns make edges coincide. From `n, m >= 3` on all is well; proper intersection may still fail (see
/// [`is_proper`](crate::is_proper)).
pub fn torus(n: u32, m: u32, shift: u32) -> Result<QuadSurface, SurfaceError> {
    let total = n as usize * m as usize;
    if total > QuadSurface::MAX_QUADS {
        return Err(SurfaceError::TooLarge { what: "quads", given: total, limit: QuadSurface::MAX_QUADS });
    }
    let at = |i: u32, j: u32| {
        let i = if j == m { (u64::from(i) + u64::from(shift)) % u64::from(n) } else { u64::from(i % n) };
        (j % m) * n + i as u32
    };
    let mut quads = Vec::with_capacity(total);
    for j in 0..m {
        for i in 0..n {
            quads.push([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    QuadSurface::try_new(total, &quads)
}

/// The boundary of the filled cells of a grid of `size` unit cells, outward; vertices numbered by first use, cells in the order x fastest.
///
/// # Errors
/// [`SurfaceError`]: no cell filled, or cells that touch along an edge or at a point only (non-manifold).
pub fn voxel_surface(size: [usize; 3], filled: impl Fn([usize; 3]) -> bool) -> Result<QuadSurface, SurfaceError> {
    voxels(size, filled).map(|(surface, _)| surface)
}

/// [`voxel_surface`], and the grid point of every vertex.
///
/// # Errors
/// As [`voxel_surface`].
pub fn voxels(
    size: [usize; 3],
    filled: impl Fn([usize; 3]) -> bool,
) -> Result<(QuadSurface, Vec<[i32; 3]>), SurfaceError> {
    let inside = |p: [i32; 3]| {
        let within = (0..3).all(|k| p[k] >= 0 && (p[k] as usize) < size[k]);
        within && filled(p.map(|x| x as usize))
    };
    let mut ids = FxHashMap::default();
    let (mut points, mut quads) = (Vec::new(), Vec::new());
    for i in 0..size[0] * size[1] * size[2] {
        let cell = [i % size[0], i / size[0] % size[1], i / size[0] / size[1]].map(|x| x as i32);
        if !inside(cell) {
            continue;
        }
        for (side, facet) in FACETS.iter().enumerate() {
            let mut other = cell;
            other[side / 2] += if side % 2 == 0 { -1 } else { 1 };
            if inside(other) {
                continue;
            }
            // Points by where they are: two cells that share an edge only make that edge non-manifold, and the
            // surface is refused.
            quads.push(facet.map(|corner| {
                let point: [i32; 3] = std::array::from_fn(|k| cell[k] + i32::from(POSITIONS[corner][k]));
                *ids.entry(point).or_insert_with(|| {
                    points.push(point);
                    points.len() as u32 - 1
                })
            }));
        }
    }
    Ok((QuadSurface::try_new(points.len(), &quads)?, points))
}

/// The cubed sphere: the boundary of `n`^3 cells ([`voxels`]), each point pushed to the unit sphere by the tangents of equal angles.
///
/// # Errors
/// [`SurfaceError`]: no cell.
pub fn cubed_sphere(n: usize) -> Result<(QuadSurface, Vec<[f64; 3]>), SurfaceError> {
    let (surface, points) = voxels([n; 3], |_| true)?;
    let round = |p: [i32; 3]| {
        let q = p.map(|x| (std::f64::consts::FRAC_PI_2 * (f64::from(x) / n as f64 - 0.5)).tan());
        let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
        q.map(|x| x / length)
    };
    Ok((surface, points.into_iter().map(round).collect()))
}

/// A plate of `(2 genus + 1) x 3` cells with `genus` square holes, each cell cut into `fineness`^3 voxels: a surface of that genus.
///
/// # Errors
/// As [`voxel_surface`]; `fineness` 0 gives an empty surface.
pub fn holed_plate(genus: usize, fineness: usize) -> Result<QuadSurface, SurfaceError> {
    let size = [(2 * genus + 1) * fineness, 3 * fineness, fineness];
    voxel_surface(size, |[x, y, _]| !((x / fineness) % 2 == 1 && y / fineness == 1))
}

/// Every quad cut into `k * k` quads. Old vertices keep their ids; then come the edge points, then the inner points.
///
/// # Errors
/// [`SurfaceError`] if that is too large; `k = 0` gives an empty surface.
pub fn refined(surface: &QuadSurface, k: u32) -> Result<QuadSurface, SurfaceError> {
    let too_large = |given| SurfaceError::TooLarge { what: "quads", given, limit: QuadSurface::MAX_QUADS };
    let total = (k as usize).saturating_mul(k as usize).saturating_mul(surface.n_quads());
    if total > QuadSurface::MAX_QUADS {
        return Err(too_large(total));
    }
    if k == 0 {
        return Err(SurfaceError::Empty);
    }
    let mut next = surface.n_vertices() as u32;
    // First new vertex on each edge, counted from the origin of the smaller of its two darts.
    let mut first_on = vec![0; 4 * surface.n_quads()];
    for d in surface.darts() {
        let t = surface.twin(d);
        if d < t {
            (first_on[d.index()], first_on[t.index()]) = (next, next);
            next += k - 1;
        }
    }
    // Point number `i` (0..=k) along a dart.
    let along = |d: crate::ids::Dart, i: u32| -> u32 {
        let VertexId(a) = surface.origin(d);
        let VertexId(b) = surface.target(d);
        match i {
            0 => a,
            i if i == k => b,
            i if d < surface.twin(d) => first_on[d.index()] + i - 1,
            i => first_on[d.index()] + (k - 1 - i),
        }
    };
    let mut quads = Vec::with_capacity(total);
    for q in 0..surface.n_quads() as u32 {
        let dart = |side| crate::ids::Dart::new(crate::ids::QuadId(q), side);
        let inner = next;
        next += (k - 1) * (k - 1);
        // The sides run counter-clockwise, so two of them against the grid's axes.
        let point = |i: u32, j: u32| match (i, j) {
            (i, 0) => along(dart(0), i),
            (i, j) if i == k => along(dart(1), j),
            (i, j) if j == k => along(dart(2), k - i),
            (0, j) => along(dart(3), k - j),
            (i, j) => inner + (j - 1) * (k - 1) + i - 1,
        };
        for j in 0..k {
            for i in 0..k {
                quads.push([point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)]);
            }
        }
    }
    QuadSurface::try_new(next as usize, &quads)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::improper::is_proper;

    #[test]
    fn tori_have_genus_one() {
        for n in 3..7 {
            for m in 3..7 {
                for shift in 0..=n {
                    let t = torus(n, m, shift).unwrap();
                    t.debug_check();
                    assert_eq!((t.genus(), t.n_quads()), (1, (n * m) as usize));
                }
            }
        }
        assert!(torus(0, 3, 0).is_err() && torus(1, 1, 0).is_err() && torus(u32::MAX, u32::MAX, 1).is_err());
    }

    #[test]
    fn voxel_surfaces() {
        let block = voxel_surface([2, 3, 4], |_| true).unwrap();
        assert_eq!((block.n_quads(), block.is_sphere()), (52, true));
        for genus in 0..4 {
            let plate = holed_plate(genus, 2).unwrap();
            assert_eq!((plate.genus(), plate.n_components(), is_proper(&plate)), (genus as u64, 1, true));
        }
        assert!(matches!(voxel_surface([2, 2, 1], |[x, y, _]| x == y), Err(SurfaceError::NonManifoldEdges { .. })));
        assert!(matches!(voxel_surface([2, 2, 2], |_| false), Err(SurfaceError::Empty)));
        let shell = voxel_surface([5, 5, 5], |p| p != [2, 2, 2]).unwrap();
        assert_eq!(shell.n_components(), 2);
    }

    #[test]
    fn refinement_keeps_the_surface() {
        for k in 1..5u32 {
            for s in [cube_surface(), schneiders_pyramid(), torus(3, 4, 1).unwrap()] {
                let fine = refined(&s, k).unwrap();
                fine.debug_check();
                assert_eq!(fine.n_quads(), s.n_quads() * (k * k) as usize);
                assert_eq!(fine.genus(), s.genus());
                assert_eq!(fine.n_used_vertices(), fine.n_vertices());
                for v in 0..s.n_vertices() as u32 {
                    assert_eq!(fine.degree(VertexId(v)), s.degree(VertexId(v)));
                }
            }
        }
        assert!(refined(&cube_surface(), 0).is_err() && refined(&cube_surface(), u32::MAX).is_err());
    }
}
