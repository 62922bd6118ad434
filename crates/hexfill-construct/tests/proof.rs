//! The finite part of the proof that the construction is proper: how a hex of a cell can meet a wall.
//!
//! The page `construction` of the book reduces "any two cells meet properly, on any proper surface" to this: every
//! hex of a cell meets each side facet in a face of that facet (nothing, a vertex, an edge or a quad), and two faces
//! of a side facet meet in a face. Both are checked here for every cell and every side, by definition.

use hexfill_construct::{Cell, CellChoice, CellLibrary, Role};
use std::collections::BTreeSet;

type Face = BTreeSet<Role>;

/// All faces of a side facet: nothing, its vertices, edges and quads.
fn faces(cell: &Cell, k: u8) -> BTreeSet<Face> {
    let mut all = BTreeSet::from([Face::new()]);
    for q in cell.pattern.side_quads(k) {
        all.insert(q.into_iter().collect());
        for i in 0..4 {
            all.insert(Face::from([q[i]]));
            all.insert(Face::from([q[i], q[(i + 1) % 4]]));
        }
    }
    all
}

/// The meetings of a hex with a side that are no face of the side.
fn bad_meetings(cell: &Cell) -> usize {
    let mut bad = 0;
    for k in 0..4 {
        let points: Face = cell.pattern.side_points(k).into_iter().collect();
        let faces = faces(cell, k);
        for hex in &cell.hexes {
            let met: Face = hex.iter().map(|&i| cell.points[usize::from(i)]).filter(|r| points.contains(r)).collect();
            bad += usize::from(!faces.contains(&met));
        }
    }
    bad
}

#[test]
fn every_hex_meets_every_wall_in_a_face_of_the_wall() {
    let cells =
        || [CellChoice::Fewest, CellChoice::Embeddable].into_iter().flat_map(|c| CellLibrary::built_in(c).cells());
    for cell in cells() {
        assert_eq!(bad_meetings(cell), 0, "{}", cell.pattern);
        for k in 0..4 {
            let faces = faces(cell, k);
            for a in &faces {
                for b in &faces {
                    assert!(faces.contains(&a.intersection(b).copied().collect()), "{} side {k}", cell.pattern);
                }
            }
            // Neighbours see the same facet: its quads depend on the side alone, not on the rest of the pattern.
            for other in cells().filter(|c| {
                c.pattern.sides[usize::from(k)] == cell.pattern.sides[usize::from(k)]
                    && c.pattern.is_black_white(k) == cell.pattern.is_black_white(k)
            }) {
                assert_eq!(other.pattern.side_quads(k), cell.pattern.side_quads(k));
            }
        }
    }
}

#[test]
fn the_check_sees_a_filling_that_is_not_wall_safe() {
    let text = include_str!("../data/cells/bb-lllo.cell");
    let found = Cell::parse(text).unwrap();
    assert!(bad_meetings(&found) > 0 && !found.unsafe_pairs().is_empty());
    assert_eq!(bad_meetings(&found.pillowed()), 0);
}
