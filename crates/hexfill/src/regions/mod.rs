//! Several solids that share walls, and voids in a mesh of hexes: each region is filled by itself, and since no filling changes its surface, all fit together.
//!
//! Every face has two sides. Round an edge the faces are sorted by angle; between one and the next lies one region, whose sides there belong together.
//! So sides fall into shells: closed surfaces, seen from the region they bound. A shell of positive volume bounds a region from outside; one of
//! negative volume is a cavity of the region it lies in, or the outside of everything. Regions that hexes of the file fill already are left out.
//!
//! Source: ours.

pub(crate) mod error;
pub(crate) mod fill;
mod shells;

use crate::problem::size::at_ordinary_size;
use crate::problem::{Problem, ProblemError};
use error::RegionsError;
use hexfill_geometry::{Vector, cone, halves, holders, sub};
use hexfill_io::MeshData;
use hexfill_mesh::{Offenders, QuadId, SurfaceError};
use shells::{inside_out, outward, shells, walls};
use std::collections::{BTreeMap, BTreeSet};

/// One region: a problem of its own.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Region {
    /// Its boundary, outward from it.
    pub problem: Problem,
    /// Per vertex of the problem, the point of the file.
    pub points: Vec<u32>,
}

/// Whether a file may hold several regions, or hexes with a void: `surface` failed for edges with more than two faces, or there are hexes.
pub fn has_regions(data: &MeshData, surface: &Result<Problem, ProblemError>) -> bool {
    let is_walled = matches!(surface, Err(ProblemError::Surface { source: SurfaceError::NonManifoldEdges { .. }, .. }));
    data.has_coordinates && data.other_faces.is_empty() && (!data.hexes.is_empty() || is_walled)
}

/// The regions bounded by the faces of a file, and by the boundary of its hexes, that no hexes fill; ordered by their first face. Empty without
/// positions.
///
/// # Errors
/// [`RegionsError::Problem`] if the faces of a region are no closed quad surface; [`RegionsError::Open`], [`RegionsError::Baffle`] and
/// [`RegionsError::InsideOut`] with the faces that are at fault.
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
    // From a point of the shell itself: far from the origin the sign would drown in rounding.
    let volume = |quads: &[[u32; 4]]| {
        let origin = points[quads[0][0] as usize];
        quads.iter().map(|q| cone(at(*q).map(|p| sub(p, origin)))).sum::<f64>()
    };
    let volumes: Vec<f64> = of_shell.iter().map(|quads| volume(quads)).collect();
    let triangles: Vec<Vec<[Vector; 3]>> =
        of_shell.iter().map(|quads| quads.iter().flat_map(|q| halves(at(*q))).collect()).collect();
    // Of two shells, the two sides of one surface, none lies in the other.
    let holders = if shells.len() > 2 { holders(&triangles) } else { vec![Vec::new(); shells.len()] };
    let mut parts: BTreeMap<usize, Vec<usize>> =
        (0..shells.len()).filter(|&i| volumes[i] > 0.0).map(|i| (i, vec![i])).collect();
    for i in (0..shells.len()).filter(|&i| volumes[i] <= 0.0) {
        // The smallest region it lies in, but none that it has faces in common with: those lie on its other side.
        let touches = |o: usize| shells[o].iter().any(|s| shells[i].binary_search(&(s ^ 1)).is_ok());
        let around = holders[i].iter().copied().filter(|&o| volumes[o] > 0.0 && !touches(o));
        if let Some(o) = around.min_by(|&a, &b| volumes[a].total_cmp(&volumes[b])) {
            parts.get_mut(&o).expect("a shell of positive volume").push(i);
        }
    }
    let mut found = Vec::new();
    for parts in parts.into_values() {
        let sides: Vec<u32> = parts.iter().flat_map(|&i| shells[i].iter().copied()).collect();
        // Hexes of the file lie there: nothing is to be filled.
        if sides.iter().any(|&s| occupied[s as usize]) {
            continue;
        }
        let all: BTreeSet<u32> = sides.iter().copied().collect();
        // Both sides of a face in one region: a wall that ends inside. Filled as it is, its quads would be glued to
        // each other or left open.
        let baffles: Offenders<QuadId> =
            sides.iter().filter(|s| s.is_multiple_of(2) && all.contains(&(**s ^ 1))).map(|s| QuadId(s / 2)).collect();
        if !baffles.is_empty() {
            return Err(RegionsError::Baffle { name: name.to_owned(), quads: baffles });
        }
        found.push((sides.iter().map(|s| s / 2).min(), region(name, data, &walls, &sides)?));
    }
    found.sort_by_key(|(first, _)| *first);
    Ok(found.into_iter().map(|(_, region)| region).collect())
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::best::PlaceOptions;
    use crate::fill::options::FillOptions;
    use fill::{FilledRegions, fill_regions};
    use hexfill_mesh::Context;

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
        let how = PlaceOptions::default();
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
