//! Signatures, automorphisms, sheets and shellings of hex meshes: many small complexes, renumbered, turned and mirrored.

use hexfill_mesh::cube::POSITIONS;
use hexfill_mesh::generate::{Random, grid, grid_mesh_of, mirrored_mesh, shuffled_mesh};
use hexfill_mesh::{
    Chord, Facet, HexId, HexMesh, QuadSurface, SignatureError, VertexId, chords, disagreement, euler_characteristic,
    greedy_shelling, hex_automorphisms, hex_isomorphism, hex_signature, hex_symmetry_order, is_shelling,
    mesh_statistics, oriented_hex_signature, parse_hex_signature, sheets, surface_signature,
};
use proptest::prelude::*;
use std::collections::BTreeSet;

/// How two corners of the cube lie: 1 along an edge, 2 across a facet, 3 across the cube.
fn distance(i: usize, j: usize) -> usize {
    (0..3).filter(|&k| POSITIONS[i][k] != POSITIONS[j][k]).count()
}

/// Whether the corners set so far (`new[..n]`) may meet `old` properly: pairs of common vertices lie alike in both and not across the cube.
fn may_meet(new: &[u32], old: &[u32; 8]) -> bool {
    let at: Vec<(usize, usize)> =
        (0..new.len()).filter_map(|i| old.iter().position(|v| *v == new[i]).map(|j| (i, j))).collect();
    at.iter()
        .enumerate()
        .all(|(n, &(i, j))| at[..n].iter().all(|&(k, l)| distance(i, k) == distance(j, l) && distance(i, k) < 3))
}

/// Whether two whole hexes share nothing, a vertex, an edge or a facet. Common pairs lie alike (see `may_meet`), so only the number is left to look at.
fn meet(new: &[u32; 8], old: &[u32; 8]) -> bool {
    let common: Vec<usize> = (0..8).filter(|&i| old.contains(&new[i])).collect();
    match common[..] {
        [] | [_] => true,
        [i, j] => distance(i, j) == 1,
        _ => common.len() == 4,
    }
}

/// Every way to glue one more cube on boundary quads, without merging old vertices: proper intersection, orientation kept, and every old vertex
/// of the new cube on one of the quads it is glued on.
fn children(mesh: &HexMesh) -> Vec<HexMesh> {
    let old = mesh.hexes_raw();
    let n = mesh.n_vertices() as u32;
    let mut all = Vec::new();
    for quad in mesh.boundary_quads() {
        // Outward, the quad runs round as the bottom of the new cube seen from inside it.
        let mut stack = vec![quad.map(|v| v.0).to_vec()];
        while let Some(corners) = stack.pop() {
            if !old.iter().all(|h| may_meet(&corners, h)) {
                continue;
            }
            let Ok(hex) = <[u32; 8]>::try_from(&corners[..]) else {
                let fresh = n + corners.len() as u32 - 4;
                let next = (0..n).filter(|v| !corners.contains(v)).chain([fresh]);
                stack.extend(next.map(|v| [&corners[..], &[v]].concat()));
                continue;
            };
            let mut hexes = old.clone();
            hexes.push(hex);
            let Ok(child) = HexMesh::try_new(n as usize + 4, &hexes) else { continue };
            let new = HexId::new(old.len());
            let glued: BTreeSet<VertexId> = (0..6)
                .map(|side| Facet::new(new, side))
                .filter(|&f| child.neighbour(f).is_some())
                .flat_map(|f| child.facet_vertices(f))
                .collect();
            let through_quads = hex.iter().all(|&v| v >= n || glued.contains(&VertexId(v)));
            if through_quads && old.iter().all(|h| meet(&hex, h)) && disagreement(&child).is_none() {
                all.push(child);
            }
        }
    }
    all
}

/// The classes of complexes with 1, ..., `n` cubes that `children` reaches.
fn complexes(n: usize) -> Vec<Vec<HexMesh>> {
    let mut levels = vec![vec![grid(1, 1, 1).unwrap()]];
    for i in 1..n {
        let mut seen = BTreeSet::new();
        let level = levels[i - 1].iter().flat_map(children).filter(|m| seen.insert(hex_signature(m).unwrap()));
        let level = level.collect();
        levels.push(level);
    }
    levels
}

/// Hexes as sets of facets by vertices: what an isomorphism must keep.
fn facet_sets(mesh: &HexMesh, map: impl Fn(VertexId) -> VertexId) -> BTreeSet<Vec<[VertexId; 4]>> {
    let facet = |f: Facet| {
        let mut q = mesh.facet_vertices(f).map(&map);
        let first = (0..4).min_by_key(|&i| q[i]).unwrap();
        q.rotate_left(first);
        if q[3] < q[1] {
            q.swap(1, 3);
        }
        q
    };
    (0..mesh.n_hexes())
        .map(|h| {
            let mut facets: Vec<_> = (0..6).map(|side| facet(Facet::new(HexId::new(h), side))).collect();
            facets.sort_unstable();
            facets
        })
        .collect()
}

/// Automorphisms by brute force: every image of hex 0 in every frame, carried over by the vertex map it forces along facets.
fn brute_force_automorphisms(mesh: &HexMesh) -> usize {
    let target = facet_sets(mesh, |v| v);
    let mut maps = BTreeSet::new();
    for image in mesh.hexes() {
        for frame in hexfill_mesh::cube::symmetries() {
            let mut map: Vec<Option<VertexId>> = vec![None; mesh.n_vertices()];
            for k in 0..8 {
                map[mesh.hexes()[0][k].index()] = Some(image[frame[k]]);
            }
            // Grow: a hex with a mapped facet takes its other facet from the one hex beyond the image of that facet.
            let mut pairs = vec![(HexId(0), mesh.hexes().iter().position(|h| h == image).unwrap())];
            let mut done = BTreeSet::from([HexId(0)]);
            let mut good = true;
            while let (Some((h, k)), true) = (pairs.pop(), good) {
                for side in 0..6 {
                    let f = Facet::new(h, side);
                    let vertices: BTreeSet<_> =
                        mesh.facet_vertices(f).iter().map(|v| map[v.index()].unwrap()).collect();
                    let g = (0..6)
                        .map(|s| Facet::new(HexId::new(k), s))
                        .find(|&g| mesh.facet_vertices(g).iter().all(|v| vertices.contains(v)));
                    let Some(g) = g else {
                        good = false;
                        break;
                    };
                    match (mesh.neighbour(f), mesh.neighbour(g)) {
                        (None, None) => {}
                        (Some(f2), Some(g2)) => {
                            if done.insert(f2.hex()) {
                                pairs.push((f2.hex(), g2.hex().index()));
                                for &v in &mesh.facet_vertices(f2) {
                                    let far = across(mesh, f2, v);
                                    let far_image = across(mesh, g2, map[v.index()].unwrap());
                                    if *map[far.index()].get_or_insert(far_image) != far_image {
                                        good = false;
                                    }
                                }
                            }
                        }
                        _ => good = false,
                    }
                }
            }
            if good && map.iter().flatten().collect::<BTreeSet<_>>().len() == map.iter().flatten().count() {
                let images = facet_sets(mesh, |v| map[v.index()].unwrap());
                if images == target {
                    maps.insert(map);
                }
            }
        }
    }
    maps.len()
}

/// The other end of the edge that leaves facet `f` of its hex at `v`.
fn across(mesh: &HexMesh, f: Facet, v: VertexId) -> VertexId {
    let hex = mesh.hex(f.hex());
    let k = hex.iter().position(|w| *w == v).unwrap();
    let facet = mesh.facet_vertices(f);
    let far = hexfill_mesh::cube::CORNER_NEIGHBOURS[k].map(|j| hex[j]).into_iter().find(|w| !facet.contains(w));
    far.unwrap()
}

fn check(mesh: &HexMesh, seed: u64) {
    let name = hex_signature(mesh).unwrap();
    let oriented = oriented_hex_signature(mesh).unwrap();
    let mirror = mirrored_mesh(mesh);
    assert_eq!(hex_signature(&mirror).unwrap(), name);
    let (other, new) = shuffled_mesh(if seed.is_multiple_of(2) { mesh } else { &mirror }, seed);
    assert_eq!(hex_signature(&other).unwrap(), name);
    let map = hex_isomorphism(mesh, &other).unwrap().unwrap();
    assert_eq!(facet_sets(mesh, |v| map.vertices[v.index()].unwrap()), facet_sets(&other, |v| v));
    assert_eq!(facet_sets(mesh, |v| VertexId(new[v.index()])), facet_sets(&other, |v| v));
    for (h, hex) in mesh.hexes().iter().enumerate() {
        let mut a = hex.map(|v| map.vertices[v.index()].unwrap());
        let mut b = other.hex(map.hexes[h]);
        a.sort_unstable();
        b.sort_unstable();
        assert_eq!(a, b);
    }
    for text in [&name, &oriented] {
        let back = parse_hex_signature(text).unwrap();
        assert_eq!(hex_signature(&back).unwrap(), name);
        assert!(hex_isomorphism(mesh, &back).unwrap().is_some());
    }
    assert_eq!(oriented_hex_signature(&parse_hex_signature(&oriented).unwrap()).unwrap(), oriented);

    let group = hex_automorphisms(mesh).unwrap();
    assert_eq!(group.len() as u128, hex_symmetry_order(mesh).unwrap());
    assert_eq!(group[0].reflection, Some(false));
    assert!(group[0].vertices.iter().enumerate().all(|(v, w)| v == w.index()));
    for a in &group {
        assert_eq!(facet_sets(mesh, |v| a.vertices[v.index()]), facet_sets(mesh, |v| v));
    }
    // Chiral exactly if no automorphism is a reflection.
    let chiral = oriented_hex_signature(&mirror).unwrap() != oriented;
    assert_eq!(chiral, group.iter().all(|a| a.reflection == Some(false)));
}

/// The boundary as a surface with the vertex ids of the mesh, if it is one.
fn boundary(mesh: &HexMesh) -> Option<QuadSurface> {
    let quads: Vec<[u32; 4]> = mesh.boundary_quads_raw();
    QuadSurface::try_new(mesh.n_vertices(), &quads).ok()
}

/// The curves in which the sheets end are the chords of the boundary.
fn check_sheets(mesh: &HexMesh) {
    let all = sheets(mesh);
    assert_eq!(all.iter().map(|s| s.crossings.len()).sum::<usize>(), 3 * mesh.n_hexes());
    let mut ends: Vec<Chord> = all.iter().flat_map(|s| s.boundary.clone()).collect();
    ends.sort_by_key(|c| c.crossings[0]);
    if let Some(surface) = boundary(mesh) {
        assert_eq!(ends, chords(&surface));
    }
    assert_eq!(ends.iter().map(|c| c.crossings.len()).sum::<usize>(), 2 * mesh.boundary_facets().count());
}

/// Every beginning of a shelling is a ball as far as its boundary and Euler characteristic tell. So few cubes that form a ball are shellable,
/// and greed finds it.
fn check_shelling(mesh: &HexMesh) {
    let is_ball = |m: &HexMesh| boundary(m).is_some_and(|s| s.is_sphere()) && euler_characteristic(m) == 1;
    let order = greedy_shelling(mesh);
    if order.is_some() || mesh.n_hexes() <= 8 {
        assert_eq!(order.is_some(), is_ball(mesh));
    }
    for n in 1..=order.as_ref().map_or(0, Vec::len) {
        let hexes: Vec<[u32; 8]> = order.iter().flatten().take(n).map(|&h| mesh.hex(h).map(|v| v.0)).collect();
        assert!(is_ball(&HexMesh::try_new(mesh.n_vertices(), &hexes).unwrap()));
    }
}

#[test]
fn every_small_complex() {
    // Classes of properly meeting cubes up to reflection, known from two other programs; at five cubes one class of 240 needs a merge of old vertices.
    // The last level takes most of the time: only with HEXFILL_SLOW=1.
    let expected = [1, 1, 6, 24, 239];
    let n = if std::env::var_os("HEXFILL_SLOW").is_some() { 5 } else { 4 };
    let levels = complexes(n);
    let sizes: Vec<usize> = levels.iter().map(Vec::len).collect();
    assert_eq!(sizes, expected[..n]);
    for (i, mesh) in levels.iter().flatten().enumerate() {
        check(mesh, i as u64);
        assert_eq!(hex_automorphisms(mesh).unwrap().len(), brute_force_automorphisms(mesh));
    }
    for mesh in levels.iter().flatten() {
        check_sheets(mesh);
        check_shelling(mesh);
    }
    // With mirror images distinct.
    for (level, expected) in levels.iter().zip([1, 1, 7, 29]) {
        let names: BTreeSet<String> = level
            .iter()
            .flat_map(|m| [m.clone(), mirrored_mesh(m)].map(|m| oriented_hex_signature(&m).unwrap()))
            .collect();
        assert_eq!(names.len(), expected);
    }
}

#[test]
fn boundaries_of_equal_meshes_are_equal() {
    for (i, mesh) in complexes(4)[3].iter().enumerate() {
        let boundary = |m: &HexMesh| boundary(m).map(|s| surface_signature(&s));
        assert_eq!(boundary(mesh), boundary(&shuffled_mesh(mesh, i as u64).0));
    }
}

#[test]
fn groups_of_known_meshes() {
    for (mesh, order) in [
        (grid(1, 1, 1), 48),
        (grid(2, 2, 2), 48),
        (grid(3, 3, 1), 16),
        (grid(1, 2, 3), 8),
        (grid_mesh_of([3, 3, 3], |p| p != [1, 1, 1]), 48),
    ] {
        let mesh = mesh.unwrap();
        assert_eq!(hex_symmetry_order(&mesh).unwrap(), order);
        assert_eq!(
            hex_automorphisms(&mesh).unwrap().iter().filter(|a| a.reflection == Some(true)).count() as u128,
            order / 2
        );
    }
}

#[test]
fn chiral_meshes_have_two_oriented_names() {
    let screw = grid_mesh_of([2, 2, 2], |p| [[0, 0, 0], [1, 0, 0], [1, 1, 0], [1, 1, 1]].contains(&p)).unwrap();
    let mirror = mirrored_mesh(&screw);
    assert_eq!(hex_signature(&screw), hex_signature(&mirror));
    assert_ne!(oriented_hex_signature(&screw), oriented_hex_signature(&mirror));
    assert!(oriented_hex_signature(&screw).unwrap().starts_with("H1+:"));
}

#[test]
fn the_boundary_of_the_tesseract() {
    let mut hexes = Vec::new();
    for axis in 0..4 {
        for end in 0..2u32 {
            let others: Vec<u32> = (0..4).filter(|&k| k != axis).collect();
            hexes.push(POSITIONS.map(|p| (end << axis) | (0..3).map(|k| u32::from(p[k]) << others[k]).sum::<u32>()));
        }
    }
    let mesh = HexMesh::try_new(16, &hexes).unwrap();
    assert_eq!(hex_symmetry_order(&mesh).unwrap(), 384);
    let s = mesh_statistics(&mesh);
    assert_eq!((s.euler_characteristic, s.boundary_quads, s.interior_vertices), (0, 0, 16));
    let order = greedy_shelling(&mesh).unwrap();
    assert!(is_shelling(&mesh, &order));
}

#[test]
fn parts_are_joined_if_they_share_no_vertex() {
    let two = grid_mesh_of([3, 1, 1], |p| p[0] != 1).unwrap();
    let name = hex_signature(&two).unwrap();
    assert_eq!(hex_symmetry_order(&two).unwrap(), 2 * 48 * 48);
    assert_eq!(hex_signature(&parse_hex_signature(&name).unwrap()).unwrap(), name);
    let group = hex_automorphisms(&grid_mesh_of([4, 1, 1], |p| p[0] != 1).unwrap()).unwrap();
    assert_eq!(group.len(), 48 * 16);
    assert_eq!(group.iter().filter(|a| a.reflection.is_none()).count(), 48 * 16 / 2);
    let touching = grid_mesh_of([2, 2, 1], |[x, y, _]| x == y).unwrap();
    match hex_signature(&touching) {
        Err(SignatureError::SharedVertex { hexes, .. }) => assert_eq!(hexes, [HexId(0), HexId(1)]),
        other => panic!("{other:?}"),
    }
    assert_eq!(hex_signature(&grid(0, 0, 0).unwrap()), Err(SignatureError::Empty));
}

#[test]
fn identifications_that_no_quad_causes_count() {
    // A row of three cubes, and the same row with an edge of the last one on an edge of the first one.
    let open = [[0, 1, 2, 3, 4, 5, 6, 7], [1, 8, 9, 2, 5, 10, 11, 6], [8, 12, 13, 9, 10, 14, 15, 11]];
    let mut glued = open;
    glued[2] = [8, 0, 3, 9, 10, 14, 15, 11];
    let (open, glued) = (HexMesh::try_new(16, &open).unwrap(), HexMesh::try_new(16, &glued).unwrap());
    assert_eq!(mesh_statistics(&open).facet_components, 1);
    assert_ne!(hex_signature(&open), hex_signature(&glued));
    for mesh in [open, glued] {
        let name = hex_signature(&mesh).unwrap();
        assert!(hex_isomorphism(&mesh, &parse_hex_signature(&name).unwrap()).unwrap().is_some());
        assert_eq!(hex_signature(&shuffled_mesh(&mesh, 3).0).unwrap(), name);
    }
}

#[test]
fn not_orientable_meshes_have_a_name_but_no_oriented_one() {
    let ring = [[0, 1, 2, 3, 4, 5, 6, 7], [4, 5, 6, 7, 8, 9, 10, 11], [8, 9, 10, 11, 1, 0, 3, 2]];
    let mesh = HexMesh::try_new(12, &ring).unwrap();
    let name = hex_signature(&mesh).unwrap();
    assert_eq!(hex_signature(&shuffled_mesh(&mesh, 1).0).unwrap(), name);
    assert!(hex_isomorphism(&mesh, &parse_hex_signature(&name).unwrap()).unwrap().is_some());
    assert!(matches!(oriented_hex_signature(&mesh), Err(SignatureError::NotOriented { .. })));
}

#[test]
fn names_do_not_change_between_versions() {
    // H1 is a promise: these strings may stand in files. A change of the code needs a new prefix.
    let bar = grid(2, 1, 1).unwrap();
    assert_eq!(hex_signature(&grid(1, 1, 1).unwrap()).unwrap(), "H1:000000");
    assert_eq!(hex_signature(&bar).unwrap(), "H1:00001000000000");
    assert_eq!(oriented_hex_signature(&bar).unwrap(), "H1+:00001000000000");
}

#[test]
fn malformed_signatures_are_refused() {
    let name = hex_signature(&grid(2, 2, 1).unwrap()).unwrap();
    for end in 0..name.len() {
        assert!(parse_hex_signature(&name[..end]).is_err(), "{}", &name[..end]);
    }
    assert!(matches!(parse_hex_signature("Q1:000"), Err(SignatureError::Prefix { .. })));
    assert!(matches!(parse_hex_signature(&format!("{name}0")), Err(SignatureError::Trailing { .. })));
    assert!(matches!(
        parse_hex_signature("H1:0000000.00"),
        Err(SignatureError::Trailing { position: 9, component: 0 })
    ));
    assert!(matches!(parse_hex_signature("H1:a"), Err(SignatureError::Number { given: 10, limit: 9, .. })));
}

#[test]
fn large_meshes_are_named_quickly() {
    let mesh = grid(20, 21, 22).unwrap();
    let name = hex_signature(&mesh).unwrap();
    assert_eq!(hex_signature(&shuffled_mesh(&mesh, 1).0).unwrap(), name);
    assert_eq!(hex_symmetry_order(&mesh).unwrap(), 8);
    let sheets = sheets(&mesh);
    assert_eq!(sheets.len(), 63);
    let order = greedy_shelling(&mesh).unwrap();
    assert!(is_shelling(&mesh, &order));
}

/// A random connected set of cells of a grid.
fn random_cells(n: usize, seed: u64) -> HexMesh {
    let mut random = Random::new(seed);
    let size = 5;
    let mut cells = vec![[2usize, 2, 2]];
    while cells.len() < n {
        let mut next = cells[random.below(cells.len())];
        let axis = random.below(3);
        next[axis] = (next[axis] + if random.below(2) == 0 { 1 } else { size - 1 }) % size;
        let wraps = cells.iter().all(|c| (0..3).map(|k| c[k].abs_diff(next[k])).sum::<usize>() != 1);
        if !wraps && !cells.contains(&next) {
            cells.push(next);
        }
    }
    grid_mesh_of([size; 3], |p| cells.contains(&p)).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn random_cells_keep_their_name(n in 1usize..40, seed: u64) {
        let mesh = random_cells(n, seed);
        check(&mesh, seed);
        check_sheets(&mesh);
        check_shelling(&mesh);
    }

    #[test]
    fn sheets_do_not_depend_on_numbering(n in 1usize..40, seed: u64) {
        let mesh = random_cells(n, seed);
        let (other, _) = shuffled_mesh(&mesh, seed ^ 3);
        let describe = |m: &HexMesh| {
            let mut all: Vec<_> = sheets(m)
                .iter()
                .map(|s| {
                    let mut lengths: Vec<usize> = s.boundary.iter().map(|c| c.length()).collect();
                    lengths.sort_unstable();
                    (s.n_hexes(), s.euler_characteristic(), s.self_crossings.len(), lengths)
                })
                .collect();
            all.sort();
            all
        };
        prop_assert_eq!(describe(&mesh), describe(&other));
        prop_assert_eq!(mesh_statistics(&mesh), mesh_statistics(&other));
    }

    #[test]
    fn any_text_is_parsed_or_refused(text in "(H1\\+?:)?[0-9a-zA-Z_.~-]{0,40}") {
        if let Ok(m) = parse_hex_signature(&text) {
            m.debug_check();
        }
    }

    #[test]
    fn damaged_signatures_do_no_harm(n in 1usize..12, seed: u64) {
        let mut text: Vec<u8> = hex_signature(&random_cells(n, seed)).unwrap().into_bytes();
        let mut random = Random::new(seed);
        for _ in 0..1 + random.below(3) {
            let at = 3 + random.below(text.len() - 3);
            text[at] = b"0123456789abcdefvwzAZ-_."[random.below(24)];
        }
        if let Ok(m) = parse_hex_signature(std::str::from_utf8(&text).unwrap()) {
            m.debug_check();
            if let Ok(name) = hex_signature(&m) {
                prop_assert!(hex_isomorphism(&m, &parse_hex_signature(&name).unwrap()).unwrap().is_some());
            }
        }
    }
}
