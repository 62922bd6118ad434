//! The reference cube: every table of node orders in the field's VTK_HEXAHEDRON numbering.
//!
//! ```text
//!          7--------6         z   y
//!         /|       /|         |  /
//!        4--------5 |         | /
//!        | |      | |         |/
//!        | 3------|-2         +---- x
//!        |/       |/
//!        0--------1
//! ```
//! Bottom cycle `0 1 2 3`, top cycle `4 5 6 7`, and `i + 4` lies above `i`.
//!
//! Source: the VTK formats (numbering of VTK_HEXAHEDRON).

use std::sync::OnceLock;

/// The six facets, each seen from outside counter-clockwise; facet `f ^ 1` is opposite to `f`.
/// Order: x-, x+, y-, y+, z-, z+.
pub const FACETS: [[usize; 4]; 6] =
    [[0, 4, 7, 3], [1, 2, 6, 5], [0, 1, 5, 4], [3, 7, 6, 2], [0, 3, 2, 1], [4, 5, 6, 7]];

/// The twelve edges; four in direction x, four in y, four in z.
pub const EDGES: [[usize; 2]; 12] =
    [[0, 1], [3, 2], [4, 5], [7, 6], [0, 3], [1, 2], [4, 7], [5, 6], [0, 4], [1, 5], [2, 6], [3, 7]];

/// The two diagonals of each facet, in the order of [`FACETS`].
pub const FACET_DIAGONALS: [[[usize; 2]; 2]; 6] =
    [[[0, 7], [4, 3]], [[1, 6], [2, 5]], [[0, 5], [1, 4]], [[3, 6], [7, 2]], [[0, 2], [3, 1]], [[4, 6], [5, 7]]];

/// The four body diagonals.
pub const BODY_DIAGONALS: [[usize; 2]; 4] = [[0, 6], [1, 7], [2, 4], [3, 5]];

/// The three neighbours of each corner, in right-handed order (x, y, z rotated so that the frame is positive).
pub const CORNER_NEIGHBOURS: [[usize; 3]; 8] =
    [[1, 3, 4], [2, 0, 5], [3, 1, 6], [0, 2, 7], [7, 5, 0], [4, 6, 1], [5, 7, 2], [6, 4, 3]];

/// Position (0 or 1 along x, y, z) of each corner in the unit cube.
pub const POSITIONS: [[u8; 3]; 8] =
    [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];

/// The corner at a position of the unit cube (inverse of [`POSITIONS`]).
#[inline]
pub const fn corner_at(x: u8, y: u8, z: u8) -> usize {
    (4 * z + if y == 1 { 3 - x } else { x }) as usize
}

/// Symmetries of the cube as corner permutations: 24 rotations first, then 24 reflections.
///
/// Entry `s` maps corner `i` of the image to corner `s[i]` of the cube: `h.map(|i| hex[s[i]])` is the
/// same hex in another frame (for a rotation) or its mirror image (for a reflection). The first is the identity.
pub fn symmetries() -> &'static [[usize; 8]; 48] {
    static TABLE: OnceLock<[[usize; 8]; 48]> = OnceLock::new();
    TABLE.get_or_init(|| {
        let mut rotations = Vec::with_capacity(24);
        let mut reflections = Vec::with_capacity(24);
        const AXES: [([usize; 3], bool); 6] = [
            ([0, 1, 2], true),
            ([1, 2, 0], true),
            ([2, 0, 1], true),
            ([0, 2, 1], false),
            ([1, 0, 2], false),
            ([2, 1, 0], false),
        ];
        for (axes, even) in AXES {
            for flips in 0..8u8 {
                let mut map = [0; 8];
                for (i, slot) in map.iter_mut().enumerate() {
                    let p = POSITIONS[i];
                    let mut image = [0u8; 3];
                    for (k, &axis) in axes.iter().enumerate() {
                        image[k] = p[axis] ^ (flips >> k & 1);
                    }
                    *slot = corner_at(image[0], image[1], image[2]);
                }
                // A permutation of the axes and some axes turned round: the determinant is the product of both signs.
                let direct = even == flips.count_ones().is_multiple_of(2);
                if direct { rotations.push(map) } else { reflections.push(map) }
            }
        }
        rotations.append(&mut reflections);
        rotations.try_into().expect("24 rotations and 24 reflections")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn det(o: usize, n: [usize; 3]) -> i32 {
        let e = n.map(|k| {
            let mut d = [0i32; 3];
            for (c, slot) in d.iter_mut().enumerate() {
                *slot = i32::from(POSITIONS[k][c]) - i32::from(POSITIONS[o][c]);
            }
            d
        });
        e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) - e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0])
            + e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0])
    }

    #[test]
    fn tables_describe_the_unit_cube() {
        for (i, p) in POSITIONS.iter().enumerate() {
            assert_eq!(corner_at(p[0], p[1], p[2]), i);
            assert_eq!(det(i, CORNER_NEIGHBOURS[i]), 1, "corner {i} is right-handed");
        }
        for (f, facet) in FACETS.iter().enumerate() {
            // Counter-clockwise from outside: with the outward neighbour missing, the inward one closes a left-handed frame.
            let inward = (0..8)
                .find(|&k| {
                    !facet.contains(&k) && (0..3).filter(|&c| POSITIONS[k][c] != POSITIONS[facet[0]][c]).count() == 1
                })
                .unwrap();
            assert_eq!(det(facet[0], [facet[1], facet[3], inward]), -1, "facet {f} faces outward");
            assert!(facet.iter().all(|k| !FACETS[f ^ 1].contains(k)));
            for d in FACET_DIAGONALS[f] {
                assert!(d.iter().all(|k| facet.contains(k)));
                assert_eq!((0..3).filter(|&c| POSITIONS[d[0]][c] != POSITIONS[d[1]][c]).count(), 2);
            }
        }
        for e in EDGES {
            assert_eq!((0..3).filter(|&c| POSITIONS[e[0]][c] != POSITIONS[e[1]][c]).count(), 1);
        }
        for d in BODY_DIAGONALS {
            assert_eq!((0..3).filter(|&c| POSITIONS[d[0]][c] != POSITIONS[d[1]][c]).count(), 3);
        }
    }

    #[test]
    fn symmetries_form_the_group() {
        let all = symmetries();
        assert_eq!(all[0], [0, 1, 2, 3, 4, 5, 6, 7]);
        for (i, a) in all.iter().enumerate() {
            let n = CORNER_NEIGHBOURS[0].map(|k| a[k]);
            assert_eq!(det(a[0], n), if i < 24 { 1 } else { -1 });
            for b in all {
                let ab: [usize; 8] = std::array::from_fn(|k| a[b[k]]);
                assert!(all.contains(&ab));
            }
        }
    }
}
