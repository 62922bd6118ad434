//! The corners of the cube: how far apart they are, and which faces hold them.
//!
//! Source: ours.

use hexfill_mesh::cube::POSITIONS;

/// Number of edges between two corners: 1 an edge, 2 a face diagonal, 3 a body diagonal.
const fn distance(i: usize, j: usize) -> u8 {
    let (p, q) = (POSITIONS[i], POSITIONS[j]);
    p[0].abs_diff(q[0]) + p[1].abs_diff(q[1]) + p[2].abs_diff(q[2])
}

pub(crate) const DISTANCE: [[u8; 8]; 8] = {
    let mut table = [[0; 8]; 8];
    let mut i = 0;
    while i < 64 {
        table[i / 8][i % 8] = distance(i / 8, i % 8);
        i += 1;
    }
    table
};

/// Per set of corners the smallest face of the cube that holds it.
pub(crate) const HULL: [u8; 256] = {
    let mut table = [0; 256];
    let mut set = 1usize;
    while set < 256 {
        // Coordinates on which all corners of the set agree stay fixed.
        let (mut all, mut any, mut i) = ([1u8; 3], [0u8; 3], 0);
        while i < 8 {
            if set >> i & 1 == 1 {
                let mut axis = 0;
                while axis < 3 {
                    all[axis] &= POSITIONS[i][axis];
                    any[axis] |= POSITIONS[i][axis];
                    axis += 1;
                }
            }
            i += 1;
        }
        i = 0;
        while i < 8 {
            let (mut inside, mut axis) = (true, 0);
            while axis < 3 {
                inside &= POSITIONS[i][axis] >= all[axis] && POSITIONS[i][axis] <= any[axis];
                axis += 1;
            }
            table[set] |= (inside as u8) << i;
            i += 1;
        }
        set += 1;
    }
    table
};
