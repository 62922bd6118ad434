//! Requests that make no sense are refused by name.

mod common;

use common::grid;
use hexfill_embed::{EmbedError, Options, embed};
use hexfill_mesh::{Context, HexMesh, VertexId};

fn refused(mesh: &HexMesh, boundary: &[[f64; 3]], start: Option<&[[f64; 3]]>) -> EmbedError {
    embed(mesh, boundary, start, &Options::default(), &Context::default()).unwrap_err()
}

#[test]
fn positions_must_be_there_and_finite() {
    let (mesh, points) = grid(2, 0.0);
    match refused(&mesh, &points[..20], None) {
        EmbedError::MissingPositions { vertices, given: 20, limit: 26 } => assert_eq!(vertices.first[0], VertexId(20)),
        other => panic!("{other}"),
    }
    for bad in [f64::NAN, f64::INFINITY] {
        let mut broken = points.clone();
        broken[3][1] = bad;
        match refused(&mesh, &broken, None) {
            EmbedError::NotFinite { vertices } => assert_eq!(vertices.first, [VertexId(3)]),
            other => panic!("{other}"),
        }
        // An interior vertex is not read without a start, and refused in one.
        let mut inner = points.clone();
        inner[13][0] = bad;
        assert!(embed(&mesh, &inner, None, &Options::default(), &Context::default()).is_ok());
        assert!(matches!(refused(&mesh, &points, Some(&inner)), EmbedError::NotFinite { .. }));
    }
    assert!(matches!(refused(&mesh, &points, Some(&points[1..])), EmbedError::StartLength { given: 26, limit: 27 }));
}

#[test]
fn the_boundary_must_have_an_extent() {
    let (mesh, points) = grid(2, 0.0);
    let same = vec![[1.0, 2.0, 3.0]; points.len()];
    assert!(matches!(refused(&mesh, &same, None), EmbedError::NoExtent { .. }));
    let subnormal: Vec<[f64; 3]> = points.iter().map(|p| p.map(|x| x * 1e-320)).collect();
    assert!(matches!(refused(&mesh, &subnormal, None), EmbedError::NoExtent { .. }));
}

#[test]
fn there_must_be_hexes_and_a_boundary() {
    let none = HexMesh::try_new(8, &[]).unwrap();
    assert_eq!(refused(&none, &[], None), EmbedError::NoHexes);
    // The three-torus of 3 x 3 x 3 hexes is closed.
    let at = |i: usize, j: usize, k: usize| (i % 3 + 3 * (j % 3) + 9 * (k % 3)) as u32;
    let mut hexes = Vec::new();
    for n in 0..27 {
        let (i, j, k) = (n % 3, n / 3 % 3, n / 9);
        hexes.push(hexfill_mesh::cube::POSITIONS.map(|p| at(i + p[0] as usize, j + p[1] as usize, k + p[2] as usize)));
    }
    let torus = HexMesh::try_new(27, &hexes).unwrap();
    assert_eq!(refused(&torus, &[], None), EmbedError::NoBoundary);
}
