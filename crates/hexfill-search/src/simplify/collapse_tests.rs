//! Every collapse of many meshes, one at a time, on both sides of the law: what is allowed passes the judge with the boundary
//! as it was, what is refused and done all the same does not.

use crate::atlas::Atlas;
use crate::inward::{FillOptions, fill_from_atlas};
use crate::simplify::column_collapse::{closed_columns, column_quotient, walk};
use crate::simplify::live::LiveMesh;
use crate::simplify::quotient::{Kept, Quotient, Refusal};
use crate::simplify::region::Region;
use crate::simplify::sheet_collapse::sheet_quotient;
use crate::simplify::{Collapse, Snapshot, single_sheet_collapses};
use hexfill_check::{Ball, Judged, Level, Options, judge};
use hexfill_mesh::generate::{Random, all_spheres, grid, octagonal_spindle, schneiders_pyramid};
use hexfill_mesh::{Context, HexMesh, sheets};
use std::collections::BTreeMap;

/// Whether a mesh of these hexes, same vertex ids, is proper and a manifold ball with the boundary quads of `before`.
fn is_sound(before: &HexMesh, hexes: &[[u32; 8]]) -> bool {
    let boundary: Vec<[u32; 4]> = before.boundary_quads().into_iter().map(|q| q.map(|v| v.0)).collect();
    let options = Options::default().with_up_to(Level::L3).with_quality(false);
    let judged = Judged::connectivity(before.n_vertices(), hexes).with_surface(&boundary);
    let report = judge(&judged, &options, &Context::default());
    report.passed(Level::L3) && report.facts.ball == Some(Ball::Yes)
}

/// The hexes after a collapse that nobody checks.
fn forced(mesh: &HexMesh, quotient: &Quotient) -> Vec<[u32; 8]> {
    let is_boundary = mesh.boundary_vertices();
    let mut to: Vec<u32> = (0..mesh.n_vertices() as u32).collect();
    for &[a, b] in &quotient.vertices {
        let (a, b) = (to[a as usize], to[b as usize]);
        let (from, into) = if is_boundary[a as usize] { (b, a) } else { (a, b) };
        to.iter_mut().filter(|v| **v == from).for_each(|v| *v = into);
    }
    let kept = (0..mesh.n_hexes()).filter(|&h| !quotient.removed.contains(&(h as u32)));
    kept.map(|h| mesh.hexes()[h].map(|v| to[v.index()])).collect()
}

/// The mesh with a pillow round a random ball of hexes.
fn with_pillow(mesh: &HexMesh, random: &mut Random) -> HexMesh {
    let live = LiveMesh::new(mesh);
    let mut region = Region::new();
    region.start(&live, random.below(mesh.n_hexes()) as u32);
    for _ in 0..random.below(6) {
        let candidates = region.candidates(&live, 40).to_vec();
        if candidates.is_empty() {
            break;
        }
        region.join(&live, candidates[random.below(candidates.len())].hex);
    }
    let is_inside = |h: u32| region.contains(h);
    let mut copy: BTreeMap<u32, u32> = BTreeMap::new();
    let mut hexes = mesh.hexes_raw();
    let n = mesh.n_vertices() as u32;
    let rim: Vec<[u32; 4]> = mesh
        .facets()
        .filter(|f| is_inside(f.hex().0) && mesh.neighbour(*f).is_none_or(|g| !is_inside(g.hex().0)))
        .map(|f| mesh.facet_vertices(f).map(|v| v.0))
        .collect();
    for &v in rim.iter().flatten() {
        let next = n + copy.len() as u32;
        copy.entry(v).or_insert(next);
    }
    for (h, hex) in hexes.iter_mut().enumerate() {
        if is_inside(h as u32) {
            *hex = hex.map(|v| copy.get(&v).copied().unwrap_or(v));
        }
    }
    hexes.extend(rim.iter().map(|&[a, b, c, d]| [copy[&a], copy[&b], copy[&c], copy[&d], a, b, c, d]));
    HexMesh::try_new(n as usize + copy.len(), &hexes).unwrap()
}

/// Tries every closed sheet, and every closed column both ways. Returns how many were allowed or refused and why.
fn try_all(mesh: &HexMesh, seen: &mut BTreeMap<(&'static str, Option<Refusal>), u32>) {
    let is_boundary = mesh.boundary_vertices();
    let live = LiveMesh::new(mesh);
    let mut all: Vec<(&str, Quotient)> = Vec::new();
    for sheet in sheets(mesh).iter().filter(|s| s.self_crossings.is_empty()) {
        let sheet: Vec<(u32, u8)> = sheet.crossings.iter().map(|&(h, d)| (h.0, d)).collect();
        all.push(("sheet", sheet_quotient(&live, &sheet)));
    }
    for (_, hex, direction) in closed_columns(&live) {
        let Some(column) = walk(&live, hex, direction) else { continue };
        all.extend([0, 1].map(|diagonal| ("column", column_quotient(&live, &column, diagonal).unwrap())));
    }
    for (kind, quotient) in all {
        let merges = quotient.merges(&live, &Kept { is_boundary: &is_boundary, hexes: false });
        *seen.entry((kind, merges.as_ref().err().copied())).or_default() += 1;
        let Ok(merges) = merges else {
            let hexes = forced(mesh, &quotient);
            assert!(!is_sound(mesh, &hexes), "a {kind} refused for {:?} could have gone", merges.unwrap_err());
            continue;
        };
        let mut changed = LiveMesh::new(mesh);
        changed.merge(&quotient.removed, &quotient.facets, &merges);
        let made = Snapshot::of(&changed).hexes;
        assert!(is_sound(mesh, &made), "a {kind} of {} hexes", quotient.removed.len());
        // The facets that were glued are those that the vertices say.
        let settled = HexMesh::try_new(mesh.n_vertices(), &made).unwrap();
        let glued = LiveMesh::new(&settled);
        let slots: Vec<u32> = changed.alive().collect();
        for (i, &h) in slots.iter().enumerate() {
            for side in 0..6 {
                let across = changed.neighbour(6 * h + side);
                let named = slots.binary_search(&(across / 6)).map_or(u32::MAX, |j| 6 * j as u32 + across % 6);
                assert_eq!(glued.neighbour(6 * i as u32 + side), named);
            }
        }
        assert!((0..mesh.n_vertices() as u32).all(|v| changed.hexes_at(v).count() as u32 == changed.degree(v)));
    }
}

#[test]
fn the_judge_agrees_with_every_answer() {
    let mut random = Random::new(9);
    let mut seen = BTreeMap::new();
    let mut starts = vec![grid(2, 2, 2).unwrap(), grid(3, 2, 1).unwrap(), grid(3, 3, 3).unwrap()];
    let surfaces = [8, 10, 12].into_iter().flat_map(all_spheres).chain([schneiders_pyramid(), octagonal_spindle()]);
    for surface in surfaces {
        let filled =
            fill_from_atlas(&surface, Atlas::embedded(), &FillOptions::default(), &Context::default()).unwrap();
        starts.extend(filled.fillings.into_iter().take(1).map(|f| f.mesh));
    }
    for start in starts {
        for _ in 0..4 {
            let mut mesh = start.clone();
            for _ in 0..4 {
                mesh = with_pillow(&mesh, &mut random);
                try_all(&mesh, &mut seen);
            }
        }
    }
    for kind in ["sheet", "column"] {
        for answer in [None, Some(Refusal::Boundary), Some(Refusal::Improper)] {
            assert!(seen.get(&(kind, answer)).is_some_and(|&n| n > 10), "{kind} {answer:?}: {seen:?}");
        }
    }
}

/// A pillow round any ball of hexes is one of the sheets that can go, and whatever goes leaves a sound mesh.
#[test]
fn one_sheet_less_is_a_sound_mesh() {
    let block = grid(3, 3, 3).unwrap();
    let mut random = Random::new(3);
    for _ in 0..20 {
        let pillowed = with_pillow(&block, &mut random);
        let fewer = single_sheet_collapses(&pillowed, Collapse::All);
        assert!(fewer.iter().any(|one| one.mesh.n_hexes() == block.n_hexes()), "the pillow goes");
        for one in fewer {
            assert!(is_sound(&pillowed, &one.mesh.hexes_raw()));
            // What the corners of the hexes that stayed became is a map of vertices.
            let mut became = BTreeMap::new();
            assert_eq!(one.hexes.len(), one.mesh.n_hexes());
            for (now, was) in one.mesh.hexes_raw().iter().zip(&one.hexes) {
                for (v, w) in pillowed.hexes_raw()[was.index()].into_iter().zip(now) {
                    assert_eq!(became.entry(v).or_insert(*w), w);
                }
            }
            assert!((0..).zip(&one.origin).all(|(v, was)| became.get(&was.0).is_none_or(|b| *b == v)));
        }
        assert!(single_sheet_collapses(&pillowed, Collapse::Nothing).is_empty());
    }
}
