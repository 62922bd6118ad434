//! Finds the cells again: `rebuild_cells FOLDER [pattern ...]` writes `pattern.cell` for every wall-safe filling found
//! (all patterns by default) and prints its number of hexes beside that of the built-in cell.
//!
//! Balls grow outward from one cube by flips (`hexfill-search`), holes grow inward from the buffer cube with all pairs of each
//! side facet blocked, until a hole is in the atlas with a ball that avoids the hole's blocked pairs.
//! The environment variables `LEVELS`, `WIDTH` (states a class), `DEPTH` and `BEAM` set the effort.

use hexfill_construct::{Cell, CellChoice, CellLibrary, Pattern, Role};
use hexfill_mesh::{Context, HexMesh, QuadSurface, surface_signature};
use hexfill_search::{Atlas, Cavity, GrowOptions, Growth, apply, legal_flips};
use std::collections::{BTreeMap, BTreeSet};

/// Quads a hole or a ball may have on the way.
const CAP: usize = 24;

/// What is left to fill, seen from the hexes already there (inside out).
#[derive(Clone)]
struct Hole {
    cavity: Cavity,
    /// Mesh vertex of each cavity vertex.
    ids: Vec<u32>,
    n_vertices: u32,
    hexes: Vec<[u32; 8]>,
}

fn setting(name: &str, default: usize) -> usize {
    std::env::var(name).ok().and_then(|v| v.parse().ok()).unwrap_or(default)
}

/// The same cavity from its other side, vertex numbers kept.
fn mirror(cavity: &Cavity) -> Option<Cavity> {
    let (mut other, _) = Cavity::from_surface(&cavity.to_surface().inverted())?;
    for [a, b] in cavity.blocked_list() {
        other.block(a, b);
    }
    Some(other)
}

fn roles_of(pattern: &Pattern) -> Vec<Role> {
    let roles: BTreeSet<Role> = pattern.boundary().into_iter().flatten().collect();
    roles.into_iter().collect()
}

/// The buffer cube inside out, with the pairs of each side that the side does not join blocked.
fn first_hole(pattern: &Pattern, roles: &[Role]) -> Option<Hole> {
    let index = |r: Role| roles.iter().position(|&x| x == r).unwrap_or(0) as u32;
    let quads: Vec<[u32; 4]> = pattern.boundary().iter().map(|q| q.map(index)).collect();
    let surface = QuadSurface::try_new(roles.len(), &quads).ok()?;
    let (mut cavity, ids) = Cavity::from_surface(&surface.inverted())?;
    let joined = |a: u32, b: u32| quads.iter().any(|q| q.contains(&a) && q.contains(&b));
    for k in 0..4 {
        let points: Vec<u32> = pattern.side_points(k).into_iter().map(index).collect();
        for (i, &a) in points.iter().enumerate() {
            for &b in &points[..i] {
                if !joined(a, b) {
                    cavity.block(a as u8, b as u8);
                }
            }
        }
    }
    Some(Hole { cavity, ids, n_vertices: roles.len() as u32, hexes: Vec::new() })
}

/// A mesh of fewer than `limit` hexes that fills the hole from the atlas.
fn close(hole: &Hole, atlas: &Atlas, limit: usize) -> Option<(u32, Vec<[u32; 8]>)> {
    let most = limit.checked_sub(hole.hexes.len() + 1)?;
    let inside = mirror(&hole.cavity)?;
    let (ball, map, mirrored) = atlas.best_fit(&inside, most as u32)?;
    let ids: Vec<u32> = map.iter().map(|&v| hole.ids[usize::from(v)]).collect();
    let (mut hexes, fresh) = ball.hexes_in(&ids, mirrored, hole.n_vertices);
    hexes.extend(&hole.hexes);
    Some((hole.n_vertices + fresh, hexes))
}

/// The holes one hex further, one for each class and number of blocked pairs.
fn deeper(holes: &[Hole], beam: usize) -> Vec<Hole> {
    let mut kept: BTreeMap<(u32, String), Hole> = BTreeMap::new();
    for hole in holes {
        for placement in legal_flips(&hole.cavity, CAP) {
            let (after, before) = apply(&hole.cavity, &placement);
            let n = hole.cavity.n_vertices();
            let id = |v: u8| {
                let v = usize::from(v);
                if v < n { hole.ids[v] } else { hole.n_vertices + (v - n) as u32 }
            };
            let new = placement.corners.iter().filter(|&&v| usize::from(v) >= n).count() as u32;
            let key = (after.n_blocked(), surface_signature(&after.to_surface()));
            kept.entry(key).or_insert_with(|| {
                let mut hexes = hole.hexes.clone();
                hexes.push(placement.corners.map(id));
                let ids = before[..after.n_vertices()].iter().map(|&v| id(v)).collect();
                Hole { cavity: after, ids, n_vertices: hole.n_vertices + new, hexes }
            });
        }
    }
    kept.into_values().take(beam).collect()
}

/// The smallest wall-safe filling met.
fn search(pattern: &Pattern, atlas: &Atlas, depth: usize, beam: usize) -> Option<Cell> {
    let roles = roles_of(pattern);
    let mut holes = vec![first_hole(pattern, &roles)?];
    let mut best: Option<(u32, Vec<[u32; 8]>)> = None;
    for _ in 0..=depth {
        for hole in &holes {
            let limit = best.as_ref().map_or(usize::MAX, |b| b.1.len());
            best = close(hole, atlas, limit).or(best);
        }
        holes = deeper(&holes, beam);
    }
    let (n_vertices, hexes) = best?;
    HexMesh::try_new(n_vertices as usize, &hexes).ok()?;
    let n_boundary = roles.len();
    let mut points = roles;
    points.extend((0..n_vertices as usize - n_boundary).map(|i| Role::Interior(i as u16)));
    let hexes = hexes.iter().map(|h| h.map(|v| v as u16)).collect();
    Some(Cell { pattern: *pattern, points, n_boundary, hexes, positions: None })
}

fn main() {
    let mut arguments = std::env::args().skip(1);
    let Some(folder) = arguments.next() else { return println!("usage: rebuild_cells FOLDER [pattern ...]") };
    let mut patterns: Vec<Pattern> = arguments.filter_map(|a| a.parse().ok()).collect();
    if patterns.is_empty() {
        patterns = Pattern::all_classes();
    }
    let ctx = Context::default();
    let mut growth = Growth::new(GrowOptions { cap: CAP, width: setting("WIDTH", 3) as u32 });
    while (growth.level() as usize) < setting("LEVELS", 30) && !growth.is_exhausted() {
        growth.grow(&ctx);
    }
    let atlas = Atlas::from_growth(&growth);
    for pattern in patterns {
        let known = CellLibrary::built_in(CellChoice::Fewest).n_hexes(&pattern).unwrap_or(0);
        let Some(cell) = search(&pattern, &atlas, setting("DEPTH", 10), setting("BEAM", 2000)) else {
            println!("{pattern}: nothing found (built in: {known})");
            continue;
        };
        let boundary = |quads: Vec<[Role; 4]>| -> BTreeSet<[Role; 4]> {
            let first = |q: &[Role; 4]| (0..4).min_by_key(|&i| q[i]).unwrap_or(0);
            quads
                .into_iter()
                .map(|mut q| {
                    let at = first(&q);
                    q.rotate_left(at);
                    q
                })
                .collect()
        };
        let right = boundary(cell.hex_boundary()) == boundary(pattern.boundary()) && cell.unsafe_pairs().is_empty();
        println!("{pattern}: {} hexes (built in: {known}), boundary and walls right: {right}", cell.hexes.len());
        let path = std::path::Path::new(&folder).join(format!("{pattern}.cell"));
        if right && let Err(e) = std::fs::write(&path, cell.to_text()) {
            println!("{}: {e}", path.display());
        }
    }
}
