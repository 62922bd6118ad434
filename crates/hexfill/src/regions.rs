//! Several solids that share walls, and voids in a mesh of hexes: each region is filled by itself, and since no filling changes its surface, all fit together.
//!
//! Every face has two sides. Round an edge the faces are sorted by angle; between one and the next lies one region, whose sides there belong together.
//! So sides fall into shells: closed surfaces, seen from the region they bound. A shell of positive volume bounds a region from outside; one of
//! negative volume is a cavity of the region it lies in, or the outside of everything. Regions that hexes of the file fill already are left out.

use crate::choose::GOOD;
use crate::fill::{FillError, FillOptions};
use crate::placed_fill::{PlaceOptions, PlacedFill, fill_placed};
use crate::problem::{Problem, ProblemError};
use crate::scale::at_ordinary_size;
use hexfill_check::{Judged, Level, cell_quality, judge};
use hexfill_geometry::{Vector, cone, cross, direction, dot, halves, holders, midpoint, sub};
use hexfill_io::MeshData;
use hexfill_mesh::{Context, Edge, Forest, HexId, HexMesh, Offenders, QuadId, StopReason, VertexId, cube, id_type};
use std::collections::BTreeMap;

id_type!(
    /// A side of a face: twice its number in front of it (where its normal points), one more behind it.
    Side,
    "s"
);

impl Side {
    fn of(quad: u32, behind: bool) -> Self {
        Self(2 * quad + u32::from(behind))
    }
}

/// One region: a problem of its own.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Region {
    /// Its boundary, outward from it.
    pub problem: Problem,
    /// Per vertex of the problem, the point of the file.
    pub points: Vec<u32>,
}

/// Why regions cannot be told or filled.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RegionsError {
    /// Faces that are not quads, points that are not finite, a boundary that is no surface.
    #[error(transparent)]
    Problem(#[from] ProblemError),
    /// An edge of one face only.
    #[error(
        "{name}: {} non-manifold edges, each in three or more quads: {shared}; they could be walls between regions, but walls end at {} edges: {edges}; close the walls, or split the surface",
        shared.count, edges.count
    )]
    Open {
        /// The input.
        name: String,
        /// The edges of one face.
        edges: Offenders<Edge>,
        /// The edges of more than two.
        shared: Offenders<Edge>,
    },
    /// A face with the same region on both sides.
    #[error("{name}: {} faces have the same region on both sides: {quads}; remove them, or close the walls they belong to", quads.count)]
    Baffle {
        /// The input.
        name: String,
        /// The faces, in the order of the file.
        quads: Offenders<QuadId>,
    },
    /// Hexes whose corners are listed in mirrored order: the void would be looked for on their wrong side.
    #[error("{name}: hexes of the file are inside out ({}): {hexes}; mirror the order of their corners", hexes.count)]
    InsideOut {
        /// The input.
        name: String,
        /// The hexes.
        hexes: Offenders<HexId>,
    },
    /// A region cannot be filled.
    #[error("region {region}: {source}")]
    Fill {
        /// Its number, from 1.
        region: usize,
        /// Why.
        source: FillError,
    },
    /// Hexes on both sides of a wall share too much, whatever was tried.
    #[error("the fillings of the regions do not fit together: {rules}; refine the walls")]
    DoNotFit {
        /// The rules of the judge that fail.
        rules: String,
    },
}

/// Whether a file may hold several regions, or hexes with a void: edges with more than two faces, or hexes.
pub fn has_regions(data: &MeshData) -> bool {
    let is_walled = || {
        let surface = hexfill_mesh::QuadSurface::try_new(data.points.len(), &data.quads);
        matches!(surface, Err(hexfill_mesh::SurfaceError::NonManifoldEdges { .. }))
    };
    data.has_coordinates && data.other_faces.is_empty() && (!data.hexes.is_empty() || is_walled())
}

/// The regions bounded by the faces of a file, and by the boundary of its hexes, that no hexes fill; ordered by their first face. Empty without
/// positions.
///
/// # Errors
/// [`RegionsError`].
pub fn regions(name: &str, data: &MeshData) -> Result<Vec<Region>, RegionsError> {
    let (walls, occupied) = walls(data);
    if !data.has_coordinates || walls.is_empty() {
        return Ok(Vec::new());
    }
    let points = at_ordinary_size(&data.points);
    let hexes = inside_out(&data.hexes, &points);
    if !hexes.is_empty() {
        return Err(RegionsError::InsideOut { name: name.to_owned(), hexes });
    }
    let shells = shells(name, &walls, &points)?;
    let of_shell: Vec<Vec<[u32; 4]>> =
        shells.iter().map(|sides| sides.iter().map(|&s| outward(&walls, s)).collect()).collect();
    let at = |quad: [u32; 4]| quad.map(|v| points[v as usize]);
    let volume = |quads: &[[u32; 4]]| {
        let origin = points[quads[0][0] as usize];
        quads.iter().map(|q| cone(at(*q).map(|p| sub(p, origin)))).sum::<f64>()
    };
    let volumes: Vec<f64> = of_shell.iter().map(|quads| volume(quads)).collect();
    let triangles: Vec<Vec<[Vector; 3]>> =
        of_shell.iter().map(|quads| quads.iter().flat_map(|q| halves(at(*q))).collect()).collect();
    let holders = if shells.len() > 2 { holders(&triangles) } else { vec![Vec::new(); shells.len()] };
    let mut parts: BTreeMap<usize, Vec<usize>> =
        (0..shells.len()).filter(|&i| volumes[i] > 0.0).map(|i| (i, vec![i])).collect();
    for i in (0..shells.len()).filter(|&i| volumes[i] <= 0.0) {
        // The smallest region it lies in, but none that it has faces in common with: those lie on its other side.
        let touches = |o: usize| shells[o].iter().any(|s| shells[i].contains(&(s ^ 1)));
        let around = holders[i].iter().copied().filter(|&o| volumes[o] > 0.0 && !touches(o));
        if let Some(o) = around.min_by(|&a, &b| volumes[a].total_cmp(&volumes[b])) {
            parts.get_mut(&o).expect("a shell of positive volume").push(i);
        }
    }
    let mut found = Vec::new();
    for parts in parts.into_values() {
        let sides: Vec<u32> = parts.iter().flat_map(|&i| shells[i].iter().copied()).collect();
        if sides.iter().any(|&s| occupied[s as usize]) {
            continue;
        }
        let baffles: Offenders<QuadId> =
            sides.iter().filter(|s| s.is_multiple_of(2) && sides.contains(&(**s ^ 1))).map(|s| QuadId(s / 2)).collect();
        if !baffles.is_empty() {
            return Err(RegionsError::Baffle { name: name.to_owned(), quads: baffles });
        }
        found.push((sides.iter().map(|s| s / 2).min(), region(name, data, &walls, &sides)?));
    }
    found.sort_by_key(|(first, _)| *first);
    Ok(found.into_iter().map(|(_, region)| region).collect())
}

/// The quads of a file, then the boundary quads of its hexes that are none of them; and per side (twice the quad: before it; one more: behind it) whether
/// a hex lies there.
fn walls(data: &MeshData) -> (Vec<[u32; 4]>, Vec<bool>) {
    let sorted = |quad: [u32; 4]| {
        let mut quad = quad;
        quad.sort_unstable();
        quad
    };
    let mut walls = data.quads.clone();
    let mut index: BTreeMap<[u32; 4], usize> = walls.iter().enumerate().map(|(q, quad)| (sorted(*quad), q)).collect();
    let mut facets: BTreeMap<[u32; 4], ([u32; 4], usize)> = BTreeMap::new();
    for hex in &data.hexes {
        for facet in cube::FACETS {
            let quad = facet.map(|k| hex[k]);
            facets.entry(sorted(quad)).or_insert((quad, 0)).1 += 1;
        }
    }
    let mut occupied = vec![false; 2 * walls.len()];
    for (key, (quad, times)) in facets {
        let q = match index.get(&key) {
            Some(&q) => q,
            None if times == 1 => {
                walls.push(quad);
                occupied.extend([false, false]);
                index.insert(key, walls.len() - 1);
                walls.len() - 1
            }
            None => continue,
        };
        // Facets face out of their hex, which lies behind them.
        let same = (0..4).any(|k| (0..4).all(|i| walls[q][(i + k) % 4] == quad[i]));
        if times == 1 {
            occupied[2 * q + usize::from(same)] = true;
        } else {
            occupied[2 * q] = true;
            occupied[2 * q + 1] = true;
        }
    }
    (walls, occupied)
}

/// Hexes of negative volume.
fn inside_out(hexes: &[[u32; 8]], points: &[Vector]) -> Offenders<HexId> {
    let volume = |hex: &[u32; 8]| {
        let at = |k: usize| sub(points[hex[k] as usize], points[hex[0] as usize]);
        cube::FACETS.iter().map(|facet| cone(facet.map(at))).sum::<f64>()
    };
    (0..hexes.len()).filter(|&h| volume(&hexes[h]) < 0.0).map(HexId::new).collect()
}

/// The quad of a side, facing out of the region on that side.
fn outward(walls: &[[u32; 4]], side: u32) -> [u32; 4] {
    let [a, b, c, d] = walls[side as usize / 2];
    if side.is_multiple_of(2) { [a, d, c, b] } else { [a, b, c, d] }
}

/// The sides that belong together, each shell ascending.
fn shells(name: &str, walls: &[[u32; 4]], points: &[Vector]) -> Result<Vec<Vec<u32>>, RegionsError> {
    // Per edge: the quads there, whether each runs along it from the smaller end.
    let mut edges: BTreeMap<[u32; 2], Vec<(u32, bool)>> = BTreeMap::new();
    for (q, quad) in (0..).zip(walls) {
        for k in 0..4 {
            let (a, b) = (quad[k], quad[(k + 1) % 4]);
            edges.entry([a.min(b), a.max(b)]).or_default().push((q, a < b));
        }
    }
    let with = |is_one: fn(usize) -> bool| -> Offenders<Edge> {
        let of = edges.iter().filter(|(_, quads)| is_one(quads.len()));
        of.map(|(&[a, b], _)| Edge(VertexId(a), VertexId(b))).collect()
    };
    let open = with(|n| n < 2);
    if !open.is_empty() {
        return Err(RegionsError::Open { name: name.to_owned(), edges: open, shared: with(|n| n > 2) });
    }
    let mut forest: Forest<Side> = Forest::new(2 * walls.len());
    for (&[a, b], quads) in &edges {
        let mut round: Vec<(f64, u32, bool)> =
            quads.iter().map(|&(q, along)| (angle(walls[q as usize], [a, b], points), q, along)).collect();
        round.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
        for (i, &(_, p, along)) in round.iter().enumerate() {
            let (_, q, next_along) = round[(i + 1) % round.len()];
            // A quad along the edge has growing angles before it.
            forest.union(Side::of(p, !along), Side::of(q, next_along));
        }
    }
    let mut shells: BTreeMap<Side, Vec<u32>> = BTreeMap::new();
    for side in 0..2 * walls.len() as u32 {
        shells.entry(forest.find(Side(side))).or_default().push(side);
    }
    let mut shells: Vec<Vec<u32>> = shells.into_values().collect();
    shells.sort();
    Ok(shells)
}

/// The angle of a quad round one of its edges, in a frame that depends on the edge alone.
fn angle(quad: [u32; 4], [a, b]: [u32; 2], points: &[Vector]) -> f64 {
    let at = |v: u32| points[v as usize];
    let others: Vec<Vector> = quad.into_iter().filter(|&v| v != a && v != b).map(at).collect();
    let along = direction(at(a), at(b)).unwrap_or([0.0, 0.0, 1.0]);
    let away = sub(others.get(1).map_or(others[0], |&other| midpoint(others[0], other)), midpoint(at(a), at(b)));
    // The axis least along the edge gives the frame.
    let k = (0..3).min_by(|&i, &j| along[i].abs().total_cmp(&along[j].abs())).unwrap_or(0);
    let mut axis = [0.0; 3];
    axis[k] = 1.0;
    let second = cross(along, axis);
    let first = cross(second, along);
    dot(away, second).atan2(dot(away, first))
}

/// The problem of a region.
fn region(name: &str, data: &MeshData, walls: &[[u32; 4]], sides: &[u32]) -> Result<Region, RegionsError> {
    let quads: Vec<[u32; 4]> = sides.iter().map(|&s| outward(walls, s)).collect();
    let mut points: Vec<u32> = quads.iter().flatten().copied().collect();
    points.sort_unstable();
    points.dedup();
    let number = |v: u32| points.binary_search(&v).expect("a point of the region") as u32;
    let positions = points.iter().map(|&v| data.points[v as usize]).collect();
    let mut own = MeshData::from_quads(positions, quads.iter().map(|q| q.map(number)).collect());
    own.quad_tags = data
        .quad_tags
        .as_ref()
        .map(|tags| sides.iter().map(|s| tags.get(*s as usize / 2).copied().unwrap_or(0)).collect());
    Ok(Region { problem: Problem::from_data(name, &own)?, points })
}

/// All regions filled.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct FilledRegions {
    /// The file with the hexes of all regions behind its own, and their points behind its own. Hexes carry the number of their region as tag, from 1, where
    /// there are several regions; those of the file keep theirs.
    pub data: MeshData,
    /// What was made for each region; empty where nothing was found.
    pub fills: Vec<PlacedFill>,
    /// Hexes of the file itself in which det J > 0 is not certified.
    pub given_invalid: usize,
    /// Why the work ended.
    pub stop: StopReason,
}

impl FilledRegions {
    /// Whether every region has a mesh.
    pub fn is_complete(&self) -> bool {
        self.fills.iter().all(|fill| !fill.meshes.is_empty())
    }

    /// Whether det J > 0 is certified in every hex, those of the file included.
    pub fn is_certified(&self) -> bool {
        let placed = |fill: &PlacedFill| {
            fill.meshes.first().is_some_and(|(_, p)| p.as_ref().is_some_and(crate::Placed::is_certified))
        };
        self.given_invalid == 0 && self.fills.iter().all(placed)
    }

    /// The least certified scaled Jacobian; -1 if a hex is not certified.
    pub fn worst(&self) -> f64 {
        let of =
            |fill: &PlacedFill| fill.meshes.first().and_then(|(_, p)| p.as_ref()).map_or(-1.0, crate::Placed::worst);
        self.fills.iter().map(of).fold(f64::INFINITY, f64::min)
    }

    /// Whether every region has a good mesh.
    pub fn is_good(&self) -> bool {
        self.is_certified() && self.worst() >= GOOD
    }
}

/// Fills each region and puts all together. If hexes on two sides of a wall then share more than a vertex, edge or facet, all are filled once more behind
/// pillows, where every wall quad has a hex of its own.
///
/// # Errors
/// [`RegionsError`].
pub fn fill_regions(
    data: &MeshData,
    regions: &[Region],
    options: &FillOptions,
    how: &PlaceOptions,
    ctx: &Context<'_>,
) -> Result<FilledRegions, RegionsError> {
    let filled = fill_once(data, regions, options, how, ctx)?;
    let Err(rules) = fits(&filled.data) else { return Ok(filled) };
    if ctx.stop().is_some() {
        return Err(RegionsError::DoNotFit { rules });
    }
    let mut pillowed = options.clone();
    pillowed.shell.pillows = vec![1];
    pillowed.strategy = crate::Strategy::Shell;
    let filled = fill_once(data, regions, &pillowed, how, ctx)?;
    fits(&filled.data).map_err(|rules| RegionsError::DoNotFit { rules })?;
    Ok(filled)
}

fn fill_once(
    data: &MeshData,
    regions: &[Region],
    options: &FillOptions,
    how: &PlaceOptions,
    ctx: &Context<'_>,
) -> Result<FilledRegions, RegionsError> {
    let mut all = data.clone();
    let mut tags = data.hex_tags.clone().unwrap_or_else(|| vec![0; data.hexes.len()]);
    let (mut fills, mut stop) = (Vec::new(), StopReason::Finished);
    let (mut certified, mut quality) = (vec![f64::NAN; data.hexes.len()], vec![f64::NAN; data.hexes.len()]);
    for (i, region) in regions.iter().enumerate() {
        let fill = fill_placed(&region.problem, options, how, ctx)
            .map_err(|source| RegionsError::Fill { region: i + 1, source })?;
        if fill.stop != StopReason::Finished {
            stop = fill.stop;
        }
        if let Some((filled, placed)) = fill.meshes.first() {
            let own = region.points.len();
            let first = all.points.len() as u32;
            let number = |v: u32| region.points.get(v as usize).copied().unwrap_or_else(|| first + v - own as u32);
            all.hexes.extend(filled.mesh.hexes_raw().into_iter().map(|hex| hex.map(number)));
            tags.resize(all.hexes.len(), i as i64 + 1);
            if let Some(placed) = placed {
                all.points.extend(&placed.points[own..]);
                certified.extend(placed.cells.iter().map(|c| f64::from(u8::from(c.valid))));
                quality.extend(placed.scaled_jacobians());
            }
            certified.resize(all.hexes.len(), f64::NAN);
            quality.resize(all.hexes.len(), f64::NAN);
        }
        fills.push(fill);
    }
    let n = all.points.len();
    all.hex_tags = (regions.len() > 1 || data.hex_tags.is_some()).then_some(tags);
    if let Some(tags) = &mut all.point_tags {
        tags.resize(n, 0);
    }
    all.point_data.iter_mut().for_each(|(_, values)| values.resize(n, f64::NAN));
    all.hex_data.retain(|(name, _)| name != "certified_positive" && name != "scaled_jacobian");
    all.hex_data.iter_mut().for_each(|(_, values)| values.resize(all.hexes.len(), f64::NAN));
    if how.embed.is_some() {
        all.hex_data.push(("certified_positive".to_owned(), certified));
        all.hex_data.push(("scaled_jacobian".to_owned(), quality));
    }
    let given = Judged::connectivity(data.points.len(), &data.hexes).with_points(&data.points);
    let given_invalid = cell_quality(&given).iter().filter(|c| c.as_ref().is_none_or(|c| !c.valid)).count();
    Ok(FilledRegions { data: all, fills, given_invalid, stop })
}

/// Levels 1 and 2 of the judge on the whole; the rules that fail.
fn fits(data: &MeshData) -> Result<(), String> {
    if HexMesh::try_new(data.points.len(), &data.hexes).is_err() {
        return Err("hexes share facets with more than one other".to_owned());
    }
    let judged = Judged::connectivity(data.points.len(), &data.hexes);
    let options = hexfill_check::Options::default().up_to(Level::L2).betti(false).quality(false);
    let report = judge(&judged, &options, &Context::default());
    if report.passed(Level::L2) { Ok(()) } else { Err(report.broken_rules().join(", ")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Boxes of unit cubes, given by opposite corners; walls between them come once.
    fn boxes(all: &[([u32; 3], [u32; 3])]) -> MeshData {
        let mut ids: BTreeMap<[u32; 3], u32> = BTreeMap::new();
        let mut data = MeshData::default();
        let mut seen: BTreeMap<[u32; 4], ()> = BTreeMap::new();
        for &(low, high) in all {
            for axis in 0..3 {
                let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
                for side in [low[axis], high[axis]] {
                    for i in low[u]..high[u] {
                        for j in low[v]..high[v] {
                            let corner = |di: u32, dj: u32| {
                                let mut p = [0; 3];
                                (p[axis], p[u], p[v]) = (side, i + di, j + dj);
                                p
                            };
                            let quad = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)].map(|p| {
                                *ids.entry(p).or_insert_with(|| {
                                    data.points.push(p.map(f64::from));
                                    data.points.len() as u32 - 1
                                })
                            });
                            let mut key = quad;
                            key.sort_unstable();
                            if seen.insert(key, ()).is_none() {
                                data.quads.push(quad);
                            }
                        }
                    }
                }
            }
        }
        data
    }

    fn filled(data: &MeshData, n: usize) -> FilledRegions {
        let found = regions("boxes", data).unwrap();
        assert_eq!(found.len(), n);
        let (options, how) = (FillOptions::default(), PlaceOptions::default());
        let filled = fill_regions(data, &found, &options, &how, &Context::default()).unwrap();
        assert!(filled.is_complete() && filled.is_certified(), "{}", filled.worst());
        assert_eq!(filled.data.points[..data.points.len()], data.points[..]);
        filled
    }

    #[test]
    fn boxes_that_share_walls_are_filled_and_tagged() {
        // Two side by side, one across both of them.
        let data = boxes(&[([0, 0, 0], [2, 2, 2]), ([2, 0, 0], [4, 2, 2]), ([0, 0, 2], [4, 2, 3])]);
        let whole = filled(&data, 3);
        let tags = whole.data.hex_tags.unwrap();
        let count = |tag: i64| tags.iter().filter(|&&t| t == tag).count();
        assert_eq!([count(1), count(2), count(3)], [8, 8, 8]);
    }

    #[test]
    fn a_box_in_a_box_is_a_region_and_so_is_what_lies_round_it() {
        let data = boxes(&[([0, 0, 0], [4, 4, 4]), ([1, 1, 1], [3, 3, 3])]);
        let whole = filled(&data, 2);
        assert_eq!(whole.data.hexes.len(), 64);
    }

    #[test]
    fn a_void_among_hexes_is_filled_and_the_whole_returned() {
        // Fill a box, take hexes out of its middle, and fill the void.
        let whole = filled(&boxes(&[([0, 0, 0], [4, 4, 4])]), 1);
        let mut holed = whole.data.clone();
        let centre = |hex: &[u32; 8]| {
            [0, 1, 2].map(|k: usize| hex.iter().map(|&v| whole.data.points[v as usize][k]).sum::<f64>() / 8.0)
        };
        holed.hexes.retain(|hex| !centre(hex).iter().all(|&x| x > 1.0 && x < 3.0));
        holed.hex_data.clear();
        assert_eq!(holed.hexes.len(), 56);
        let again = filled(&holed, 1);
        assert_eq!(again.data.hexes.len(), 64);
        assert_eq!(again.data.hexes[..56], holed.hexes[..]);
        // With no void nothing is left to fill.
        assert!(regions("whole", &whole.data).unwrap().is_empty());
    }

    #[test]
    fn hexes_of_the_file_are_judged_with_the_rest() {
        let mut data = boxes(&[([0, 0, 0], [2, 1, 1])]);
        let at = |p: [f64; 3]| data.points.iter().position(|&q| q == p).unwrap() as u32;
        let ring = [[1.0, 0.0], [1.0, 1.0], [2.0, 1.0], [2.0, 0.0]];
        let corner = |k: usize| at([ring[k % 4][0], ring[k % 4][1], if k < 4 { 0.0 } else { 1.0 }]);
        let hex = [0, 3, 2, 1, 4, 7, 6, 5].map(corner);
        // The quads between the cells are in no list: the hex closes its cell.
        data.hexes = vec![hex];
        assert_eq!(filled(&data, 1).data.hexes.len(), 2);
        let mut mirrored = data.clone();
        mirrored.hexes = vec![[0, 1, 2, 3, 4, 5, 6, 7].map(corner)];
        assert!(matches!(regions("mirrored", &mirrored), Err(RegionsError::InsideOut { .. })));
        // A corner pulled into the hex, off the void.
        let v = at([2.0, 1.0, 1.0]) as usize;
        data.points[v] = [1.3, 0.3, 0.3];
        let found = regions("bent", &data).unwrap();
        let how = PlaceOptions { embed: Some(hexfill_embed::Options::default()), ..PlaceOptions::default() };
        let whole = fill_regions(&data, &found, &FillOptions::default(), &how, &Context::default()).unwrap();
        assert!(whole.given_invalid == 1 && !whole.is_certified());
    }

    #[test]
    fn walls_that_end_are_named() {
        let mut data = boxes(&[([0, 0, 0], [2, 2, 2]), ([2, 0, 0], [4, 2, 2])]);
        data.quads.remove(0);
        assert!(matches!(regions("open", &data), Err(RegionsError::Open { .. })));
        // A wall inside that divides nothing.
        let mut data = boxes(&[([0, 0, 0], [4, 4, 4])]);
        let inner = boxes(&[([1, 1, 1], [2, 2, 2])]);
        let n = data.points.len() as u32;
        data.points.extend(&inner.points);
        data.quads.extend(inner.quads.iter().take(5).map(|q| q.map(|v| v + n)));
        assert!(matches!(regions("open", &data), Err(RegionsError::Open { .. })));
    }
}
