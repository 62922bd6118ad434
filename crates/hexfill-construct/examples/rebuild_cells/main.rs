//! Finds the cells again: `rebuild_cells FOLDER [pattern ...]` writes `pattern.cell` for every filling found
//! (all patterns by default) and prints its number of hexes beside that of the built-in cell.
//!
//! Balls grow outward from one cube by flips (`hexfill-search`), holes grow inward from the buffer cube with all pairs of each
//! side facet blocked, until a hole is in the atlas with a ball that avoids the hole's blocked pairs. Per class of holes
//! the smallest sets of blocked pairs are kept, none a subset of another (`WIDTH` of them), and per number of quads the
//! `BEAM` holes with the fewest. `FREE=1` blocks nothing at first: a filling that is not wall-safe is pillowed when it is loaded.
//! `FLAT=1` blocks the pairs of the inner facet as well: no hex then has two quads on one flat facet, so the cell may embed
//! (see the example `place_cells` of `hexfill`). `ALL=n` writes every filling met that has at most `n` hexes more than the
//! smallest one, as `pattern-0.cell` and so on, for `place_cells` to choose from.
//! Holes up to `HALVES` hexes in (1; some 30 s a pattern) are also cut in two, and both halves looked up in that atlas and the two of the library.
//! The environment variables `ATLAS` (a file of `hexfill atlas build`; else one is grown, `LEVELS` and `GROWTH_WIDTH`),
//! `WIDTH`, `DEPTH`, `BEAM` and `CAP` (quads of a hole) set the effort.

mod name;

use hexfill_construct::{Cell, CellChoice, CellLibrary, Pattern, Role};
use hexfill_mesh::{Context, HexMesh, QuadSurface};
use hexfill_search::{Atlas, Cavity, GrowOptions, Growth, Membranes, apply, legal_flips, two_halves};
use name::{Bits, is_subset, name};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Quads an atlas ball may have.
const ATLAS_CAP: usize = 24;

/// What is left to fill, seen from the hexes already there (inside out).
#[derive(Clone)]
struct Hole {
    cavity: Cavity,
    /// Mesh vertex of each cavity vertex.
    ids: Vec<u32>,
    n_vertices: u32,
    hexes: Vec<[u32; 8]>,
}

/// A hole one hex further that may be kept: (blocked pairs, their bits, parent, index of the flip).
type Candidate = (u32, Bits, usize, usize);

/// Per class: the sets of blocked pairs of its holes.
type Fronts = HashMap<Vec<u8>, Vec<Bits>>;

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

/// The buffer cube inside out, with the pairs of each side that the side does not join blocked if `walls`.
fn first_hole(pattern: &Pattern, roles: &[Role], walls: bool) -> Option<Hole> {
    let index = |r: Role| roles.iter().position(|&x| x == r).unwrap_or(0) as u32;
    let quads: Vec<[u32; 4]> = pattern.boundary().iter().map(|q| q.map(index)).collect();
    let surface = QuadSurface::try_new(roles.len(), &quads).ok()?;
    let (mut cavity, ids) = Cavity::from_surface(&surface.inverted())?;
    let joined = |a: u32, b: u32| quads.iter().any(|q| q.contains(&a) && q.contains(&b));
    let mut facets: Vec<Vec<Role>> = (0..4).filter(|_| walls).map(|k| pattern.side_points(k)).collect();
    if setting("FLAT", 0) == 1 {
        let mut inner: Vec<Role> = (0..2).flat_map(|t| pattern.triangle_quads(t)).flatten().collect();
        inner.sort_unstable();
        inner.dedup();
        facets.push(inner);
    }
    for facet in facets {
        let points: Vec<u32> = facet.into_iter().map(index).collect();
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

/// Number of vertices, and hexes.
type Filling = (u32, Vec<[u32; 8]>);

/// See [`signature`].
type Signature = Vec<Vec<(u32, u32)>>;

/// The fillings of the hole from the atlas that make at most `limit` hexes in all, the smallest only unless `all`.
fn close(hole: &Hole, atlas: &Atlas, limit: usize, all: bool) -> Vec<Filling> {
    let Some(most) = limit.checked_sub(hole.hexes.len()) else { return Vec::new() };
    if hole.cavity.n_quads() > ATLAS_CAP {
        return Vec::new();
    }
    let Some(inside) = mirror(&hole.cavity) else { return Vec::new() };
    let mut found = Vec::new();
    for ball in atlas.balls_for(&inside).take_while(|ball| ball.n_hexes() <= most) {
        for (map, mirrored) in ball.placements(&inside) {
            let ids: Vec<u32> = map.iter().map(|&v| hole.ids[usize::from(v)]).collect();
            let (mut hexes, fresh) = ball.hexes_in(&ids, mirrored, hole.n_vertices);
            hexes.extend(&hole.hexes);
            found.push((hole.n_vertices + fresh, hexes));
            if !all {
                return found;
            }
        }
    }
    found
}

/// The smallest fillings of these holes from two halves each, with at most `limit` hexes in all.
fn halved(holes: &[Hole], atlas: &Atlas, limit: usize, membranes: &Membranes) -> Vec<Filling> {
    let atlases = [atlas, Atlas::embedded(), Atlas::fewest()];
    let one = |hole: &Hole| {
        let below = u32::try_from(limit).map_or(u32::MAX, |most| most.saturating_add(1));
        let below = below.checked_sub(hole.hexes.len() as u32)?;
        let mesh = two_halves(&mirror(&hole.cavity)?, below, &atlases, membranes)?;
        let n = hole.ids.len() as u32;
        let id = |v: u32| hole.ids.get(v as usize).copied().unwrap_or_else(|| hole.n_vertices + v - n);
        let mut hexes: Vec<[u32; 8]> = mesh.hexes_raw().into_iter().map(|h| h.map(id)).collect();
        hexes.extend(&hole.hexes);
        Some((hole.n_vertices + mesh.n_vertices() as u32 - n, hexes))
    };
    holes.par_iter().filter_map(one).collect()
}

/// Equal for fillings that differ in the numbers of their inner vertices only (and for few others): the hexes by their
/// boundary vertices and by how many hexes their inner vertices have.
fn signature(hexes: &[[u32; 8]], n_boundary: u32) -> Signature {
    let mut degree = BTreeMap::<u32, u32>::new();
    hexes.iter().flatten().for_each(|&v| *degree.entry(v).or_default() += 1);
    let name = |v: u32| if v < n_boundary { (v, 0) } else { (n_boundary, degree[&v]) };
    let mut all: Vec<Vec<(u32, u32)>> = hexes
        .iter()
        .map(|h| {
            let mut hex = h.map(name).to_vec();
            hex.sort_unstable();
            hex
        })
        .collect();
    all.sort_unstable();
    all
}

/// The holes one hex further that no earlier one dominates.
fn deeper(holes: &[Hole], fronts: &mut Fronts, [cap, width, beam]: [usize; 3]) -> Vec<Hole> {
    let mut pending: BTreeMap<Vec<u8>, Vec<Candidate>> = BTreeMap::new();
    for (parent, hole) in holes.iter().enumerate() {
        for (i, placement) in legal_flips(&hole.cavity, cap).iter().enumerate() {
            let (after, _) = apply(&hole.cavity, placement);
            let (code, bits) = name(&after);
            if !fronts.get(&code).is_some_and(|f| f.iter().any(|old| is_subset(old, &bits))) {
                pending.entry(code).or_default().push((after.n_blocked(), bits, parent, i));
            }
        }
    }
    // Per number of quads, fewest blocked pairs first.
    let mut kept: BTreeMap<usize, Vec<(u32, usize, usize)>> = BTreeMap::new();
    for (code, mut candidates) in pending {
        candidates.sort_unstable();
        let n_quads = code.len() / 4;
        let front = fronts.entry(code).or_default();
        let fewest = front.iter().map(ones).min().unwrap_or(u32::MAX);
        for (n_blocked, bits, parent, i) in candidates {
            let enters = front.len() < width || n_blocked < fewest;
            if enters && !front.iter().any(|old| is_subset(old, &bits)) {
                front.push(bits);
                kept.entry(n_quads).or_default().push((n_blocked, parent, i));
            }
        }
    }
    let mut next = Vec::new();
    for (_, mut chosen) in kept {
        chosen.sort_unstable();
        for (_, parent, i) in chosen.into_iter().take(beam) {
            let hole = &holes[parent];
            let placement = &legal_flips(&hole.cavity, cap)[i];
            let (after, before) = apply(&hole.cavity, placement);
            let n = hole.cavity.n_vertices();
            let id = |v: u8| {
                let v = usize::from(v);
                if v < n { hole.ids[v] } else { hole.n_vertices + (v - n) as u32 }
            };
            let new = placement.corners.iter().filter(|&&v| usize::from(v) >= n).count() as u32;
            let mut hexes = hole.hexes.clone();
            hexes.push(placement.corners.map(id));
            let ids = before[..after.n_vertices()].iter().map(|&v| id(v)).collect();
            next.push(Hole { cavity: after, ids, n_vertices: hole.n_vertices + new, hexes });
        }
    }
    next
}

fn ones(bits: &Bits) -> u32 {
    bits.iter().map(|w| w.count_ones()).sum()
}

/// The smallest filling met; with `ALL=n` every one met with at most `n` hexes more, fewest first.
fn search(pattern: &Pattern, atlas: &Atlas, walls: bool) -> Vec<Cell> {
    let roles = roles_of(pattern);
    let Some(hole) = first_hole(pattern, &roles, walls) else { return Vec::new() };
    let mut holes = vec![hole];
    let mut met: BTreeMap<(usize, Signature), Filling> = BTreeMap::new();
    let mut fronts = Fronts::new();
    let sizes = [setting("CAP", ATLAS_CAP), setting("WIDTH", 3), setting("BEAM", 1000)];
    let all = std::env::var_os("ALL").is_some();
    let more = setting("ALL", 0);
    let membranes = Membranes::default();
    let limit = |met: &BTreeMap<(usize, Signature), Filling>| {
        met.keys().next().map_or(usize::MAX, |(n, _)| if all { n + more } else { n - 1 })
    };
    for depth in 0..=setting("DEPTH", 10) {
        if depth <= setting("HALVES", 1) {
            for filling in halved(&holes, atlas, limit(&met), &membranes) {
                met.entry((filling.1.len(), signature(&filling.1, roles.len() as u32))).or_insert(filling);
            }
        }
        for hole in &holes {
            for filling in close(hole, atlas, limit(&met), all) {
                let n = filling.1.len();
                met.entry((n, signature(&filling.1, roles.len() as u32))).or_insert(filling);
            }
            if let Some(fewest) = met.keys().next().map(|(n, _)| *n) {
                met = met.into_iter().filter(|((n, _), _)| *n <= fewest + more).collect();
            }
        }
        if std::env::var_os("VERBOSE").is_some() {
            let best = met.keys().next().map(|(n, _)| *n);
            println!("  {pattern} {depth}: {} holes, {} fillings, best {best:?}", holes.len(), met.len());
        }
        holes = deeper(&holes, &mut fronts, sizes);
    }
    let cell = |(n_vertices, hexes): Filling| {
        HexMesh::try_new(n_vertices as usize, &hexes).ok()?;
        let n_boundary = roles.len();
        let mut points = roles.clone();
        points.extend((0..n_vertices as usize - n_boundary).map(|i| Role::Interior(i as u16)));
        let hexes = hexes.iter().map(|h| h.map(|v| v as u16)).collect();
        Some(Cell { pattern: *pattern, points, n_boundary, hexes, positions: None })
    };
    let cells = met.into_values().filter_map(cell);
    if all { cells.collect() } else { cells.take(1).collect() }
}

fn boundary(quads: Vec<[Role; 4]>) -> BTreeSet<[Role; 4]> {
    let first = |q: &[Role; 4]| (0..4).min_by_key(|&i| q[i]).unwrap_or(0);
    quads
        .into_iter()
        .map(|mut q| {
            let at = first(&q);
            q.rotate_left(at);
            q
        })
        .collect()
}

fn atlas() -> Result<Atlas, String> {
    if let Some(path) = std::env::var_os("ATLAS") {
        return Atlas::read_path(path.as_ref()).map_err(|e| e.to_string());
    }
    let mut growth =
        Growth::new(GrowOptions::default().with_cap(ATLAS_CAP).with_width(setting("GROWTH_WIDTH", 3) as u32));
    while (growth.level() as usize) < setting("LEVELS", 30) && !growth.is_exhausted() {
        growth.grow(&Context::default());
    }
    Ok(Atlas::from_growth(&growth))
}

fn main() {
    let mut arguments = std::env::args().skip(1);
    let Some(folder) = arguments.next() else { return println!("usage: rebuild_cells FOLDER [pattern ...]") };
    let mut patterns: Vec<Pattern> = arguments.filter_map(|a| a.parse().ok()).collect();
    if patterns.is_empty() {
        patterns = Pattern::all_classes();
    }
    let atlas = match atlas() {
        Ok(atlas) => atlas,
        Err(e) => return println!("{e}"),
    };
    for pattern in patterns {
        let known = CellLibrary::built_in(CellChoice::Fewest).n_hexes(&pattern).unwrap_or(0);
        let cells = search(&pattern, &atlas, std::env::var_os("FREE").is_none());
        if cells.is_empty() {
            println!("{pattern}: nothing found (built in: {known})");
        }
        for (i, cell) in cells.iter().enumerate() {
            let right = boundary(cell.hex_boundary()) == boundary(pattern.boundary());
            let safe = cell.unsafe_pairs().is_empty();
            let n = cell.hexes.len() + if safe { 0 } else { pattern.boundary().len() };
            println!("{pattern}: {n} hexes (built in: {known}), wall-safe by itself: {safe}, boundary right: {right}");
            let name = if cells.len() == 1 { format!("{pattern}.cell") } else { format!("{pattern}-{i}.cell") };
            let path = std::path::Path::new(&folder).join(name);
            if right && let Err(e) = std::fs::write(&path, cell.to_text()) {
                println!("{}: {e}", path.display());
            }
        }
    }
}
