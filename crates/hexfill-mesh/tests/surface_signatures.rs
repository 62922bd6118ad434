//! Signatures, automorphisms and isomorphisms of surfaces, on every small sphere and on random surfaces.

use hexfill_mesh::generate::{
    Random, all_spheres_up_to, cube_surface, holed_plate, octagonal_spindle, pseudo_double_wheel, random_sphere,
    refined, schneiders_pyramid, shuffled_surface, torus,
};
use hexfill_mesh::{
    CanonicalSurface, QuadSurface, SignatureError, VertexId, canonical_surface, parse_surface_signature,
    surface_automorphisms, surface_isomorphism, surface_signature, surface_symmetry_order,
};
use proptest::prelude::*;
use std::collections::{BTreeMap, BTreeSet};

/// The quads as vertex sets in cyclic order, whatever their start and sense.
fn unoriented(surface: &QuadSurface, map: impl Fn(VertexId) -> VertexId) -> BTreeSet<[VertexId; 4]> {
    let canonical = |mut q: [VertexId; 4]| {
        let first = (0..4).min_by_key(|&i| q[i]).unwrap();
        q.rotate_left(first);
        if q[3] < q[1] {
            q.swap(1, 3);
        }
        q
    };
    surface.quads().iter().map(|q| canonical(q.map(&map))).collect()
}

/// The quads in their sense, each from its smallest vertex.
fn oriented(surface: &QuadSurface) -> BTreeSet<[VertexId; 4]> {
    surface.quads().iter().map(|q| from_smallest(*q)).collect()
}

fn from_smallest(mut q: [VertexId; 4]) -> [VertexId; 4] {
    let first = (0..4).min_by_key(|&i| q[i]).unwrap();
    q.rotate_left(first);
    q
}

/// The quads of a named surface, carried over to the surface whose canonical form is given.
fn carried(named: &QuadSurface, c: &CanonicalSurface) -> BTreeSet<[VertexId; 4]> {
    let carry = |q: &[VertexId; 4]| {
        let mut image = q.map(|v| c.vertices[v.index()]);
        if c.mirrored {
            image.reverse();
        }
        from_smallest(image)
    };
    named.quads().iter().map(carry).collect()
}

/// Automorphisms of the graph by plain backtracking over vertices. On a 3-connected sphere each of them is one of the surface (Whitney 1932).
fn graph_automorphisms(surface: &QuadSurface) -> usize {
    let n = surface.n_vertices();
    let mut joined = vec![vec![false; n]; n];
    for d in surface.darts() {
        joined[surface.origin(d).index()][surface.target(d).index()] = true;
    }
    fn extend(image: &mut Vec<usize>, joined: &[Vec<bool>]) -> usize {
        let n = joined.len();
        let v = image.len();
        if v == n {
            return 1;
        }
        let mut count = 0;
        for w in 0..n {
            if !image.contains(&w) && (0..v).all(|u| joined[u][v] == joined[image[u]][w]) {
                image.push(w);
                count += extend(image, joined);
                image.pop();
            }
        }
        count
    }
    extend(&mut Vec::new(), &joined)
}

#[test]
fn every_small_sphere() {
    for (n, spheres) in all_spheres_up_to(14).into_iter().enumerate() {
        let mut names = BTreeSet::new();
        for (i, s) in spheres.iter().enumerate() {
            let name = surface_signature(s);
            assert!(names.insert(name.clone()), "two classes with {n} quads share {name}");
            for seed in 0..4 {
                let (other, _) = shuffled_surface(s, seed + 10 * i as u64, seed % 2 == 1);
                assert_eq!(surface_signature(&other), name);
                let map = surface_isomorphism(s, &other).unwrap();
                assert_eq!(unoriented(s, |v| map[v.index()].unwrap()), unoriented(&other, |v| v));
            }
            assert_eq!(surface_signature(&s.inverted()), name);
            let back = parse_surface_signature(&name).unwrap();
            back.debug_check();
            assert_eq!(surface_signature(&back), name);
            assert!(surface_isomorphism(s, &back).is_some());

            for surface in [s, &s.inverted(), &shuffled_surface(s, 7, i % 2 == 0).0] {
                let c = canonical_surface(surface);
                assert_eq!(c.signature, name);
                assert_eq!(carried(&back, &c), oriented(surface));
            }

            let group = surface_automorphisms(s);
            assert_eq!(group.len() as u128, surface_symmetry_order(s));
            assert_eq!(group.len(), graph_automorphisms(s), "{name}");
            assert!(group[0].vertices.iter().enumerate().all(|(v, w)| v == w.index()) && !group[0].reflection);
            let distinct: BTreeSet<&Vec<VertexId>> = group.iter().map(|a| &a.vertices).collect();
            assert_eq!(distinct.len(), group.len());
            let oriented = oriented(s);
            for a in &group {
                assert_eq!(unoriented(s, |v| a.vertices[v.index()]), unoriented(s, |v| v));
                // A reflection, and only a reflection, turns quads over.
                for q in s.quads() {
                    let mut image = q.map(|v| a.vertices[v.index()]);
                    if a.reflection {
                        image.reverse();
                    }
                    assert!(oriented.contains(&from_smallest(image)));
                }
            }
        }
    }
}

/// The published counts of 3-connected quad spheres to 20 quads (22 vertices). About half a minute: only with HEXFILL_SLOW=1.
#[test]
fn counts_to_twenty_quads() {
    if std::env::var_os("HEXFILL_SLOW").is_none() {
        return;
    }
    let counts: Vec<usize> = all_spheres_up_to(20).iter().map(Vec::len).collect();
    assert_eq!(counts[6..], [1, 0, 1, 1, 3, 3, 11, 18, 58, 139, 451, 1326, 4461, 14554, 49957]);
}

#[test]
fn groups_of_known_surfaces() {
    for (s, order) in [
        (cube_surface(), 48),
        (octagonal_spindle(), 16),
        (pseudo_double_wheel(5).unwrap(), 20),
        // Twice the symmetries of the pyramid in space: the apex and the middle of the base can change places.
        (schneiders_pyramid(), 16),
        (refined(&cube_surface(), 3).unwrap(), 48),
        (holed_plate(1, 1).unwrap(), 16),
        (holed_plate(3, 2).unwrap(), 8),
        // Translations, and all 8 symmetries of the square or 4 of the rectangle.
        (torus(5, 5, 0).unwrap(), 25 * 8),
        (torus(5, 7, 0).unwrap(), 35 * 4),
        // A sheared lattice keeps the half turn only, (1, 2)-knight's moves the quarter turn.
        (torus(7, 5, 1).unwrap(), 35 * 2),
        (torus(13, 1, 5).unwrap(), 13 * 4),
    ] {
        assert_eq!(surface_symmetry_order(&s), order);
        if s.is_sphere() && s.n_vertices() < 20 {
            assert_eq!(graph_automorphisms(&s) as u128, order);
        }
        let group = surface_automorphisms(&s);
        assert_eq!(group.len() as u128, order);
        let set: BTreeSet<Vec<VertexId>> = group.iter().map(|a| a.vertices.clone()).collect();
        let sample: Vec<_> = group.iter().step_by(group.len().div_ceil(12)).collect();
        for a in &sample {
            for b in &sample {
                let product: Vec<VertexId> = b.vertices.iter().map(|v| a.vertices[v.index()]).collect();
                assert!(set.contains(&product), "closed under composition");
            }
        }
    }
}

#[test]
fn chiral_surfaces_have_no_reflection_and_one_name() {
    let s = torus(13, 1, 5).unwrap();
    assert!(surface_automorphisms(&s).iter().all(|a| !a.reflection));
    assert_eq!(surface_signature(&s), surface_signature(&torus(13, 1, 8).unwrap()));
}

fn joined(parts: &[&QuadSurface]) -> QuadSurface {
    let mut quads: Vec<[u32; 4]> = Vec::new();
    let mut first = 1;
    for s in parts {
        quads.extend(s.quads().iter().map(|q| q.map(|v| v.0 + first)));
        first += s.n_vertices() as u32 + 1;
    }
    QuadSurface::try_new(first as usize, &quads).unwrap()
}

#[test]
fn several_components_are_mirrored_together() {
    let (cube, spindle) = (cube_surface(), octagonal_spindle());
    let both = joined(&[&cube, &spindle]);
    let name = surface_signature(&both);
    assert_eq!(name, surface_signature(&joined(&[&spindle, &cube])));
    assert_eq!(name.matches('.').count(), 1);
    assert_eq!(surface_signature(&parse_surface_signature(&name).unwrap()), name);
    // 24 rotations times 8 rotations, and as many pairs of reflections.
    assert_eq!(surface_symmetry_order(&both), 2 * 24 * 8);
    assert_eq!(surface_automorphisms(&both).len(), 2 * 24 * 8);
    let three = joined(&[&cube, &cube, &spindle]);
    assert_eq!(surface_symmetry_order(&three), 2 * (24 * 24 * 2) * 8);
    assert!(surface_isomorphism(&three, &joined(&[&cube, &spindle, &cube])).is_some());
    assert!(surface_isomorphism(&three, &joined(&[&cube, &spindle, &spindle])).is_none());

    for s in [&both, &three, &three.inverted()] {
        let c = canonical_surface(s);
        assert_eq!(carried(&parse_surface_signature(&c.signature).unwrap(), &c), oriented(s));
    }

    let left = torus(13, 1, 5).unwrap();
    let right = left.inverted();
    let same = joined(&[&left, &left]);
    assert_eq!(surface_signature(&same), surface_signature(&joined(&[&right, &right])));
    assert_ne!(surface_signature(&same), surface_signature(&joined(&[&left, &right])));
    assert!(surface_isomorphism(&same, &joined(&[&right, &right])).is_some());
    assert!(surface_isomorphism(&same, &joined(&[&left, &right])).is_none());
}

#[test]
fn names_do_not_change_between_versions() {
    // Q1 is a promise: these strings may stand in files. A change of the code needs a new prefix.
    let names = [cube_surface(), octagonal_spindle(), schneiders_pyramid(), torus(3, 3, 1).unwrap()]
        .map(|s| surface_signature(&s));
    assert_eq!(names, PINNED);
}

const PINNED: [&str; 4] =
    ["Q1:0010101412", "Q1:00101005101312", "Q1:000000070017100700171605141317", "Q1:0000402331721342"];

#[test]
fn malformed_signatures_are_refused() {
    let name = surface_signature(&schneiders_pyramid());
    for end in 0..name.len() {
        assert!(parse_surface_signature(&name[..end]).is_err(), "{}", &name[..end]);
    }
    assert!(matches!(parse_surface_signature("H1:00"), Err(SignatureError::Prefix { .. })));
    assert!(matches!(parse_surface_signature("Q1:"), Err(SignatureError::Truncated { position: 3, .. })));
    assert!(matches!(parse_surface_signature(&format!("{name}0")), Err(SignatureError::Trailing { .. })));
    assert!(matches!(parse_surface_signature(&format!("{name}.")), Err(SignatureError::Truncated { .. })));
    assert!(matches!(parse_surface_signature("Q1:é"), Err(SignatureError::Character { position: 3, given: 'é' })));
    assert!(matches!(parse_surface_signature("Q1:9"), Err(SignatureError::Number { given: 9, limit: 4, .. })));
    assert!(parse_surface_signature("").is_err());
    // The message names the place.
    let message = parse_surface_signature("Q1:00~").unwrap_err().to_string();
    assert!(message.contains("character 5"), "{message}");
}

/// Every text of up to four numbers: parsed or refused, never a panic, and what is parsed has a signature that is parsed back.
#[test]
fn every_short_text() {
    let alphabet = "0123456789vw-_.";
    let mut texts = vec![String::from("Q1:")];
    let mut surfaces = 0;
    for _ in 0..4 {
        texts = texts.iter().flat_map(|t| alphabet.chars().map(move |c| format!("{t}{c}"))).collect();
        for t in &texts {
            if let Ok(s) = parse_surface_signature(t) {
                s.debug_check();
                surfaces += 1;
                let name = surface_signature(&s);
                assert_eq!(surface_signature(&parse_surface_signature(&name).unwrap()), name);
            }
        }
    }
    assert!(surfaces > 0);
}

#[test]
fn large_surfaces_are_named_quickly() {
    for s in [
        random_sphere(20_000, 1).unwrap(),
        refined(&schneiders_pyramid(), 30).unwrap(),
        torus(100, 130, 7).unwrap(),
        holed_plate(9, 8).unwrap(),
        pseudo_double_wheel(5_000).unwrap(),
    ] {
        let name = surface_signature(&s);
        assert_eq!(surface_signature(&shuffled_surface(&s, 5, true).0), name);
        assert!(surface_isomorphism(&s, &parse_surface_signature(&name).unwrap()).is_some());
    }
}

#[test]
fn equal_names_and_isomorphism_agree_on_tori() {
    let mut by_name: BTreeMap<String, Vec<QuadSurface>> = BTreeMap::new();
    for (n, m) in [(4, 6), (6, 4), (3, 8), (8, 3), (12, 2), (24, 1)] {
        for shift in 0..n {
            if let Ok(t) = torus(n, m, shift) {
                by_name.entry(surface_signature(&t)).or_default().push(t);
            }
        }
    }
    let classes: Vec<&Vec<QuadSurface>> = by_name.values().collect();
    assert!(classes.len() > 5);
    for (i, a) in classes.iter().enumerate() {
        for (j, b) in classes.iter().enumerate() {
            assert_eq!(surface_isomorphism(&a[0], b.last().unwrap()).is_some(), i == j);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn renumbering_keeps_the_name(n in 8usize..200, seed: u64, mirror: bool) {
        let s = random_sphere(n, seed).unwrap();
        let (other, new) = shuffled_surface(&s, seed ^ 1, mirror);
        let name = surface_signature(&s);
        prop_assert_eq!(&surface_signature(&other), &name);
        let map = surface_isomorphism(&s, &other).unwrap();
        prop_assert_eq!(unoriented(&s, |v| map[v.index()].unwrap()), unoriented(&s, |v| VertexId(new[v.index()])));
        prop_assert_eq!(surface_symmetry_order(&s), surface_symmetry_order(&other));
    }

    #[test]
    fn any_text_is_parsed_or_refused(text in "(Q1:)?[0-9a-zA-Z_.~-]{0,40}") {
        if let Ok(s) = parse_surface_signature(&text) {
            s.debug_check();
        }
    }

    #[test]
    fn damaged_signatures_do_no_harm(seed: u64, n in 6usize..40) {
        prop_assume!(n != 7);
        let mut text: Vec<u8> = surface_signature(&random_sphere(n, seed).unwrap()).into_bytes();
        let mut random = Random::new(seed);
        for _ in 0..1 + random.below(3) {
            let at = 3 + random.below(text.len() - 3);
            text[at] = b"0123456789abcdefvwzAZ-_."[random.below(24)];
        }
        if let Ok(s) = parse_surface_signature(std::str::from_utf8(&text).unwrap()) {
            s.debug_check();
            let name = surface_signature(&s);
            prop_assert!(surface_isomorphism(&s, &parse_surface_signature(&name).unwrap()).is_some());
        }
    }
}
