//! The 48 frames of the cube as compile-time byte tables, for the inner loops.
//!
//! A *frame* is a way to look at a cube: frame `s` sees corner `FRAMES[s][i]` of the cube where its own corner
//! `i` is. Frames 0..24 are rotations, 24..48 reflections, in the order of [`hexfill_mesh::cube::symmetries`].
//! Frames compose: `FRAMES[COMPOSE[a][b]][i] == FRAMES[a][FRAMES[b][i]]`.
//!
//! Walking from a cube through one of its sides carries the frame along ([`ACROSS`]), as a step in a grid does: the
//! common quad is side `f` of the cube left and side `f ^ 1` of the cube entered, and its corners keep their two
//! coordinates in the quad. Thus `frame of B = COMPOSE[across(A, side)][frame of A]` for any frame of A,
//! which makes a breadth-first walk from a flag a matter of table look-ups.
//!
//! Source: ours.

use hexfill_mesh::cube::{EDGES, FACETS, POSITIONS, corner_at};

/// Corner permutations of the frames.
pub(crate) const FRAMES: [[u8; 8]; 48] = build_frames();
/// The cube's side that a frame sees as its side `f`.
pub(crate) const SIDE: [[u8; 6]; 48] = build_sides();
/// Product of two frames.
pub(crate) static COMPOSE: [[u8; 48]; 48] = build_compose();
/// `MIRROR[side / 2][i]`: the corner on the opposite side, along the edge across.
pub(crate) const MIRROR: [[u8; 8]; 3] = build_mirror();
/// `ACROSS[side of A][side of B][j][reversed]`: the frame of B when A is seen in its identity frame, where
/// corner `FACETS[side of A][0]` is glued to corner `FACETS[side of B][j]` and the two cyclic orders run
/// against each other (`reversed == 1`, the orientation-consistent case) or along (`0`).
pub(crate) static ACROSS: [[[[u8; 2]; 4]; 6]; 6] = build_across();
/// The four corners on each side, any fixed order ascending in the frame.
pub(crate) const SIDE_CORNERS: [[u8; 4]; 6] = build_side_corners();
/// Per corner, a bit set of the corners it is joined to by an edge.
pub(crate) const JOINED: [u8; 8] = build_joined();
/// Per set of glued sides, the edges (bits in the order of `EDGES`) that lie on none of them.
pub(crate) const EDGES_OFF: [u16; 64] = build_edges_off();
/// The frames with a given corner at the origin: rotations first.
pub(crate) const FRAMES_AT: [[u8; 6]; 8] = build_frames_at();
/// `TURN[side][k]`: the other side of the cube that contains edge `k` of `side`, edge `k` running from corner
/// `FACETS[side][k]` to `FACETS[side][(k + 1) % 4]`; and that edge's index there.
pub(crate) const TURN: [[(u8, u8); 4]; 6] = build_turn();

const fn build_frames() -> [[u8; 8]; 48] {
    let axes: [([usize; 3], bool); 6] = [
        ([0, 1, 2], true),
        ([1, 2, 0], true),
        ([2, 0, 1], true),
        ([0, 2, 1], false),
        ([1, 0, 2], false),
        ([2, 1, 0], false),
    ];
    let mut out = [[0u8; 8]; 48];
    let mut rotations = 0;
    let mut reflections = 24;
    let mut a = 0;
    while a < 6 {
        let mut flips = 0u8;
        while flips < 8 {
            let mut map = [0u8; 8];
            let mut i = 0;
            while i < 8 {
                let p = POSITIONS[i];
                let mut image = [0u8; 3];
                let mut k = 0;
                while k < 3 {
                    image[k] = p[axes[a].0[k]] ^ (flips >> k & 1);
                    k += 1;
                }
                map[i] = corner_at(image[0], image[1], image[2]) as u8;
                i += 1;
            }
            // Rotations first: whether a frame reflects is then a comparison with 24.
            let direct = axes[a].1 == (flips.count_ones().is_multiple_of(2));
            if direct {
                out[rotations] = map;
                rotations += 1;
            } else {
                out[reflections] = map;
                reflections += 1;
            }
            flips += 1;
        }
        a += 1;
    }
    out
}

/// Bit set of the corners of a side.
pub(crate) const fn side_set(side: usize) -> u8 {
    let f = FACETS[side];
    1 << f[0] | 1 << f[1] | 1 << f[2] | 1 << f[3]
}

const fn build_sides() -> [[u8; 6]; 48] {
    let mut out = [[0u8; 6]; 48];
    let mut s = 0;
    while s < 48 {
        let mut f = 0;
        while f < 6 {
            let mut set = 0u8;
            let mut k = 0;
            while k < 4 {
                set |= 1 << FRAMES[s][FACETS[f][k]];
                k += 1;
            }
            let mut g = 0;
            while side_set(g) != set {
                g += 1;
            }
            out[s][f] = g as u8;
            f += 1;
        }
        s += 1;
    }
    out
}

/// The frame with the given images of corners 0, 1 and 3.
const fn frame_of(zero: u8, one: u8, three: u8) -> u8 {
    let mut s = 0;
    while s < 48 {
        if FRAMES[s][0] == zero && FRAMES[s][1] == one && FRAMES[s][3] == three {
            return s as u8;
        }
        s += 1;
    }
    u8::MAX
}

const fn build_compose() -> [[u8; 48]; 48] {
    let mut by_images = [u8::MAX; 512];
    let mut s = 0;
    while s < 48 {
        let f = FRAMES[s];
        by_images[f[0] as usize * 64 + f[1] as usize * 8 + f[3] as usize] = s as u8;
        s += 1;
    }
    let mut out = [[0u8; 48]; 48];
    let mut a = 0;
    while a < 48 {
        let mut b = 0;
        while b < 48 {
            let z = FRAMES[a][FRAMES[b][0] as usize] as usize;
            let o = FRAMES[a][FRAMES[b][1] as usize] as usize;
            let t = FRAMES[a][FRAMES[b][3] as usize] as usize;
            out[a][b] = by_images[z * 64 + o * 8 + t];
            b += 1;
        }
        a += 1;
    }
    out
}

const fn build_mirror() -> [[u8; 8]; 3] {
    let mut out = [[0u8; 8]; 3];
    let mut axis = 0;
    while axis < 3 {
        let mut i = 0;
        while i < 8 {
            let mut p = POSITIONS[i];
            p[axis] ^= 1;
            out[axis][i] = corner_at(p[0], p[1], p[2]) as u8;
            i += 1;
        }
        axis += 1;
    }
    out
}

const fn build_across() -> [[[[u8; 2]; 4]; 6]; 6] {
    let mut out = [[[[0u8; 2]; 4]; 6]; 6];
    let mut fa = 0;
    while fa < 6 {
        let mut fb = 0;
        while fb < 6 {
            let mut j = 0;
            while j < 4 {
                let mut reversed = 0;
                while reversed < 2 {
                    // Images under the frame of B: corner k of A's side, moved to the opposite side, goes to B's corner, and
                    // corner k itself to the one across B.
                    let mut image = [0u8; 8];
                    let mut k = 0;
                    while k < 4 {
                        let b = if reversed == 1 { FACETS[fb][(j + 4 - k) % 4] } else { FACETS[fb][(j + k) % 4] };
                        let a = FACETS[fa][k];
                        image[MIRROR[fa / 2][a] as usize] = b as u8;
                        image[a] = MIRROR[fb / 2][b];
                        k += 1;
                    }
                    out[fa][fb][j][reversed] = frame_of(image[0], image[1], image[3]);
                    reversed += 1;
                }
                j += 1;
            }
            fb += 1;
        }
        fa += 1;
    }
    out
}

const fn build_side_corners() -> [[u8; 4]; 6] {
    let mut out = [[0u8; 4]; 6];
    let mut f = 0;
    while f < 6 {
        let set = side_set(f);
        let mut k = 0;
        let mut i = 0;
        while i < 8 {
            if set >> i & 1 == 1 {
                out[f][k] = i as u8;
                k += 1;
            }
            i += 1;
        }
        f += 1;
    }
    out
}

const fn build_joined() -> [u8; 8] {
    let mut out = [0u8; 8];
    let mut e = 0;
    while e < 12 {
        let [a, b] = EDGES[e];
        out[a] |= 1 << b;
        out[b] |= 1 << a;
        e += 1;
    }
    out
}

const fn build_edges_off() -> [u16; 64] {
    let mut out = [0u16; 64];
    let mut sides = 0;
    while sides < 64 {
        let mut e = 0;
        while e < 12 {
            let [a, b] = EDGES[e];
            // Loops by hand, as constant evaluation has no iterators.
            let mut on = false;
            let mut f = 0;
            while f < 6 {
                if sides >> f & 1 == 1 && side_set(f) >> a & 1 == 1 && side_set(f) >> b & 1 == 1 {
                    on = true;
                }
                f += 1;
            }
            if !on {
                out[sides] |= 1 << e;
            }
            e += 1;
        }
        sides += 1;
    }
    out
}

const fn build_frames_at() -> [[u8; 6]; 8] {
    let mut out = [[0u8; 6]; 8];
    let mut corner = 0;
    while corner < 8 {
        let mut k = 0;
        let mut s = 0;
        while s < 48 {
            if FRAMES[s][0] as usize == corner {
                out[corner][k] = s as u8;
                k += 1;
            }
            s += 1;
        }
        corner += 1;
    }
    out
}

const fn build_turn() -> [[(u8, u8); 4]; 6] {
    let mut out = [[(0u8, 0u8); 4]; 6];
    let mut f = 0;
    while f < 6 {
        let mut k = 0;
        while k < 4 {
            let (a, b) = (FACETS[f][k], FACETS[f][(k + 1) % 4]);
            let mut g = 0;
            while g < 6 {
                let mut l = 0;
                while l < 4 {
                    // Outward sides run along a common edge in opposite directions.
                    if g != f && FACETS[g][l] == b && FACETS[g][(l + 1) % 4] == a {
                        out[f][k] = (g as u8, l as u8);
                    }
                    l += 1;
                }
                g += 1;
            }
            k += 1;
        }
        f += 1;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_the_symmetries_of_the_mesh_crate() {
        for (mine, theirs) in FRAMES.iter().zip(hexfill_mesh::cube::symmetries()) {
            assert_eq!(mine.map(usize::from), *theirs);
        }
        for a in 0..48 {
            for b in 0..48 {
                for i in 0..8 {
                    let ab = COMPOSE[a][b] as usize;
                    assert_eq!(FRAMES[ab][i], FRAMES[a][FRAMES[b][i] as usize]);
                }
            }
        }
    }

    #[test]
    fn crossing_a_side_carries_the_frame() {
        for fa in 0..6 {
            for fb in 0..6 {
                for j in 0..4 {
                    for reversed in 0..2 {
                        let t = FRAMES[ACROSS[fa][fb][j][reversed] as usize];
                        for k in 0..4 {
                            let b = if reversed == 1 { (j + 4 - k) % 4 } else { (j + k) % 4 };
                            let mirrored = MIRROR[fa / 2][FACETS[fa][k]] as usize;
                            assert_eq!(t[mirrored] as usize, FACETS[fb][b]);
                        }
                        // A step in a grid keeps the orientation, so exactly the consistent gluings are rotations.
                        assert_eq!(ACROSS[fa][fb][j][reversed] < 24, reversed == 1);
                    }
                }
            }
        }
    }

    #[test]
    fn turning_round_an_edge_is_an_involution() {
        for f in 0..6 {
            for k in 0..4 {
                let (g, l) = TURN[f][k];
                assert_eq!(TURN[g as usize][l as usize], (f as u8, k as u8));
            }
        }
    }
}
