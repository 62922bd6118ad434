//! What the tests of simplification share.

use hexfill_check::{Judged, Level, Options, judge};
use hexfill_mesh::{Context, HexMesh, VertexId};
use hexfill_search::Simplified;
use std::collections::BTreeSet;

/// Boundary quads in the vertices of the input, each begun at its smallest vertex.
fn boundary(mesh: &HexMesh, origin: Option<&[Option<VertexId>]>) -> BTreeSet<[u32; 4]> {
    let name = |v: VertexId| origin.map_or(v, |o| o[v.index()].expect("boundary vertices are old")).0;
    let first = |mut q: [u32; 4]| {
        let at = (0..4).min_by_key(|&i| q[i]).unwrap();
        q.rotate_left(at);
        q
    };
    mesh.boundary_quads().into_iter().map(|q| first(q.map(name))).collect()
}

/// Proper, no larger, the boundary and the kind of space kept.
#[track_caller]
pub(crate) fn assert_sound(before: &HexMesh, made: &Simplified) {
    made.mesh.debug_check();
    assert_eq!(made.origin.len(), made.mesh.n_vertices());
    assert_eq!(boundary(before, None), boundary(&made.mesh, Some(&made.origin)));
    assert!(made.mesh.n_hexes() <= before.n_hexes());
    assert_eq!((made.report.before, made.report.after), (before.n_hexes(), made.mesh.n_hexes()));
    let hexes = made.mesh.hexes_raw();
    let options = Options::default().with_up_to(Level::L3).with_quality(false);
    let judged = Judged::connectivity(made.mesh.n_vertices(), &hexes);
    let report = judge(&judged, &options, &Context::default());
    assert!(report.passed(Level::L3), "{:?}", report.broken_rules());
    let given = before.hexes_raw();
    let was = judge(&Judged::connectivity(before.n_vertices(), &given), &options, &Context::default());
    assert_eq!(report.facts.ball, was.facts.ball);
}

/// The mesh with a layer of hexes put between `inside` and the rest, or round the whole mesh if all are inside.
/// The hexes outside and the boundary keep their vertices; the pillowed hexes get copies.
pub(crate) fn pillowed(mesh: &HexMesh, inside: impl Fn(usize) -> bool) -> HexMesh {
    let n = mesh.n_vertices() as u32;
    let mut rim = Vec::new();
    for f in mesh.facets().filter(|f| inside(f.hex().index())) {
        if mesh.neighbour(f).is_none_or(|g| !inside(g.hex().index())) {
            rim.push(mesh.facet_vertices(f).map(|v| v.0));
        }
    }
    let on_rim: BTreeSet<u32> = rim.iter().flatten().copied().collect();
    let copy = |v: u32| if on_rim.contains(&v) { v + n } else { v };
    let mut hexes: Vec<[u32; 8]> = mesh.hexes_raw();
    for (h, hex) in hexes.iter_mut().enumerate() {
        if inside(h) {
            *hex = hex.map(copy);
        }
    }
    // A facet is seen from outside counter-clockwise: its copy below, itself above.
    hexes.extend(rim.iter().map(|&[a, b, c, d]| [a + n, b + n, c + n, d + n, a, b, c, d]));
    let used: BTreeSet<u32> = hexes.iter().flatten().copied().chain(0..n).collect();
    let names: Vec<u32> = used.into_iter().collect();
    let compact: Vec<[u32; 8]> = hexes.iter().map(|h| h.map(|v| names.binary_search(&v).unwrap() as u32)).collect();
    HexMesh::try_new(names.len(), &compact).unwrap()
}
