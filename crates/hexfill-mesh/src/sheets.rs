//! Sheets: the surfaces of the dual of a hex mesh, through opposite quads of hexes.
//!
//! A sheet is a class of edges under "opposite in a quad". It crosses a hex once for each of the hex's three directions whose four edges are in the
//! class, so it may cross itself in a hex (two directions) and even have a triple point there (three). Its boundary curves are chords of the mesh's
//! boundary.
//!
//! Source: Thurston 1993; Mitchell 1996; Folwell, Mitchell 1999.

use crate::chords::Chord;
use crate::components::root;
use crate::cube::EDGES;
use crate::hexmesh::{Facet, HexMesh};
use crate::ids::{Dart, HexId, QuadId, VertexId};

/// A sheet of a hex mesh.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Sheet {
    /// The hexes it passes, ascending, each with the direction it cuts across (0: the edges along x of the reference cube, 1: y, 2: z).
    pub crossings: Vec<(HexId, u8)>,
    /// The hexes it passes in two or three directions, ascending.
    pub self_crossings: Vec<HexId>,
    /// Of these, the hexes it passes in all three directions.
    pub triple_points: Vec<HexId>,
    /// Number of edges of the mesh it cuts: the vertices of the sheet as a surface of squares.
    pub n_edges: usize,
    /// Number of (quad, direction) pairs it cuts: the edges of the sheet as a surface of squares.
    pub n_quads: usize,
    /// Its boundary curves. Darts are those of the list of boundary quads ([`HexMesh::boundary_quads`]): quad `i` there is quad `i` of the darts. If the boundary is a
    /// surface, these are its [`chords`](crate::chords()).
    pub boundary: Vec<Chord>,
}

impl Sheet {
    /// Number of distinct hexes.
    pub fn n_hexes(&self) -> usize {
        self.crossings.len() - self.self_crossings.len() - self.triple_points.len()
    }

    /// Euler characteristic of the sheet as an immersed surface of squares (its pre-image: crossings are counted once for each branch).
    pub fn euler_characteristic(&self) -> i64 {
        self.n_edges as i64 - self.n_quads as i64 + self.crossings.len() as i64
    }
}

/// The sheets of a mesh, ordered by their first crossing. Time as a sort of 12 edges a hex.
///
/// # Example
/// Two cubes in a row: one sheet runs between them along both, and one crosses each.
/// ```
/// use hexfill_mesh::{HexMesh, sheets};
///
/// let mesh = HexMesh::try_new(12, &[[0, 1, 2, 3, 4, 5, 6, 7], [4, 5, 6, 7, 8, 9, 10, 11]])?;
/// let mut sizes: Vec<usize> = sheets(&mesh).iter().map(|s| s.n_hexes()).collect();
/// sizes.sort();
/// assert_eq!(sizes, [1, 1, 2, 2]);
/// # Ok::<(), hexfill_mesh::HexMeshError>(())
/// ```
pub fn sheets(mesh: &HexMesh) -> Vec<Sheet> {
    let edges = mesh.edges();
    // The edges are sorted, so those of one smaller vertex are together: a short search where all of them would be a long one.
    let mut begin = vec![0u32; mesh.n_vertices() + 1];
    for [a, _] in &edges {
        begin[a.index() + 1] += 1;
    }
    for v in 0..mesh.n_vertices() {
        begin[v + 1] += begin[v];
    }
    let id = |a: VertexId, b: VertexId| {
        let (a, b) = (a.min(b), a.max(b));
        let first = begin[a.index()] as usize;
        let i = edges[first..begin[a.index() + 1] as usize].binary_search_by_key(&b, |e| e[1]);
        (first + i.expect("edges() lists the edges of every hex")) as u32
    };
    // An edge by its rank among the sorted edges, and opposite edges of a hex made one: the classes are the sheets.
    // The smaller rank stays the root, so that classes do not depend on the order of the hexes.
    let mut parent: Vec<u32> = (0..edges.len() as u32).collect();
    for hex in mesh.hexes() {
        for direction in EDGES.chunks_exact(4) {
            let first = id(hex[direction[0][0]], hex[direction[0][1]]);
            for [i, j] in &direction[1..] {
                let (a, b) = (root(&mut parent, first), root(&mut parent, id(hex[*i], hex[*j])));
                parent[a.max(b) as usize] = a.min(b);
            }
        }
    }
    // Number the sheets by first crossing.
    let mut sheet_of_root = vec![usize::MAX; edges.len()];
    let mut sheets: Vec<Sheet> = Vec::new();
    for (h, hex) in mesh.hexes().iter().enumerate() {
        for (direction, group) in EDGES.chunks_exact(4).enumerate() {
            let r = root(&mut parent, id(hex[group[0][0]], hex[group[0][1]])) as usize;
            if sheet_of_root[r] == usize::MAX {
                sheet_of_root[r] = sheets.len();
                sheets.push(Sheet {
                    crossings: Vec::new(),
                    self_crossings: Vec::new(),
                    triple_points: Vec::new(),
                    n_edges: 0,
                    n_quads: 0,
                    boundary: Vec::new(),
                });
            }
            sheets[sheet_of_root[r]].crossings.push((HexId::new(h), direction as u8));
        }
    }
    let mut sheet_of = |a: VertexId, b: VertexId| sheet_of_root[root(&mut parent, id(a, b)) as usize];
    for &[a, b] in &edges {
        sheets[sheet_of(a, b)].n_edges += 1;
    }
    // A quad is crossed twice, once between either pair of its opposite sides; the sheet may be the same both times.
    for f in mesh.facets().filter(|&f| mesh.neighbour(f).is_none_or(|g| f < g)) {
        let [a, b, c, _] = mesh.facet_vertices(f);
        sheets[sheet_of(a, b)].n_quads += 1;
        sheets[sheet_of(b, c)].n_quads += 1;
    }
    for (chord, [a, b]) in boundary_chords(mesh) {
        sheets[sheet_of(a, b)].boundary.push(chord);
    }
    // Crossings of one hex follow each other, as they were pushed hex by hex.
    for sheet in &mut sheets {
        for run in sheet.crossings.chunk_by(|a, b| a.0 == b.0) {
            if run.len() > 1 {
                sheet.self_crossings.push(run[0].0);
            }
            if run.len() > 2 {
                sheet.triple_points.push(run[0].0);
            }
        }
    }
    sheets
}

/// The closed curves through opposite edges of boundary quads, each with an edge it crosses, ordered by smallest dart. Across an edge the curve goes on to
/// the boundary quad at the other end of the same fan of hexes, so it is well defined even where the boundary is not a manifold.
fn boundary_chords(mesh: &HexMesh) -> Vec<(Chord, [VertexId; 2])> {
    let facets: Vec<Facet> = mesh.boundary_facets().collect();
    let mut number = vec![u32::MAX; 6 * mesh.n_hexes()];
    for (i, f) in facets.iter().enumerate() {
        number[f.index()] = i as u32;
    }
    let ends = |d: Dart| {
        let quad = mesh.facet_vertices(facets[d.quad().index()]);
        [quad[d.side()], quad[(d.side() + 1) % 4]]
    };
    let mut seen = vec![false; 4 * facets.len()];
    let mut all = Vec::new();
    for start in (0..4 * facets.len() as u32).map(Dart) {
        if seen[start.index()] {
            continue;
        }
        let mut cycle = Vec::new();
        let mut d = start;
        loop {
            seen[d.index()] = true;
            // The other direction of the same curve begins here: it is not listed again.
            seen[d.opposite().index()] = true;
            cycle.push(d);
            let out = d.opposite();
            let edge = ends(out);
            let beyond = other_end_of_fan(mesh, facets[out.quad().index()], edge);
            let quad = QuadId(number[beyond.index()]);
            let side = (0..4).find(|&side| {
                let [a, b] = ends(Dart::new(quad, side));
                [a, b] == edge || [b, a] == edge
            });
            d = Dart::new(quad, side.expect("the fan turns about the edge"));
            if d == start {
                break;
            }
        }
        all.push((Chord::from_cycle(cycle), ends(start)));
    }
    all
}

/// Turns about an edge of a boundary facet, from hex to hex, to the other boundary facet of the fan.
fn other_end_of_fan(mesh: &HexMesh, mut f: Facet, [a, b]: [VertexId; 2]) -> Facet {
    loop {
        // In a hex two facets meet at an edge.
        let other = (0..6).map(|side| Facet::new(f.hex(), side)).find(|&g| {
            let quad = mesh.facet_vertices(g);
            g != f && quad.contains(&a) && quad.contains(&b)
        });
        let other = other.expect("each edge of a hex is on two of its facets");
        match mesh.neighbour(other) {
            Some(next) => f = next,
            None => return other,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chords::chords;
    use crate::generate::{grid, grid_mesh_of};
    use crate::surface::QuadSurface;

    /// What holds for every mesh whose boundary is a surface (or empty).
    fn check(mesh: &HexMesh) -> Vec<Sheet> {
        let all = sheets(mesh);
        assert_eq!(all.iter().map(|s| s.crossings.len()).sum::<usize>(), 3 * mesh.n_hexes());
        assert_eq!(all.iter().map(|s| s.n_edges).sum::<usize>(), mesh.edges().len());
        let quads: Vec<[u32; 4]> = mesh.boundary_quads_raw();
        if !quads.is_empty() {
            let surface = QuadSurface::try_new(mesh.n_vertices(), &quads).unwrap();
            assert!(surface.reversed().is_empty());
            let mut found: Vec<Chord> = all.iter().flat_map(|s| s.boundary.clone()).collect();
            found.sort_by_key(|c| c.crossings[0]);
            assert_eq!(found, chords(&surface));
        }
        all
    }

    #[test]
    fn a_block_has_one_disk_for_each_layer() {
        let all = check(&grid(2, 3, 4).unwrap());
        assert_eq!(all.len(), 9);
        for sheet in &all {
            assert_eq!((sheet.euler_characteristic(), sheet.boundary.len()), (1, 1));
            assert!(sheet.self_crossings.is_empty());
        }
        assert_eq!(all[0].n_hexes(), 12);
    }

    #[test]
    fn a_ring_has_annuli() {
        let all = check(&grid_mesh_of([3, 3, 1], |[x, y, _]| (x, y) != (1, 1)).unwrap());
        let mut characteristics: Vec<i64> = all.iter().map(Sheet::euler_characteristic).collect();
        characteristics.sort_unstable();
        // One annulus parallel to the plate; three rows and three columns, the middle ones cut in two by the hole.
        assert_eq!(characteristics, [0, 1, 1, 1, 1, 1, 1, 1, 1]);
        assert!(all.iter().all(|s| s.boundary.len() == 2 - s.euler_characteristic() as usize));
    }

    #[test]
    fn closed_meshes_have_closed_sheets() {
        // The boundary of the tesseract: vertex ids are the 16 corners, eight cubes, four spheres that cross pairwise.
        let mut hexes = Vec::new();
        for axis in 0..4 {
            for end in 0..2u32 {
                let others: Vec<u32> = (0..4).filter(|&k| k != axis).collect();
                hexes.push(
                    crate::cube::POSITIONS
                        .map(|p| (end << axis) | (0..3).map(|k| u32::from(p[k]) << others[k]).sum::<u32>()),
                );
            }
        }
        let mesh = HexMesh::try_new(16, &hexes).unwrap();
        let all = check(&mesh);
        assert_eq!(all.len(), 4);
        assert!(all.iter().all(|s| s.euler_characteristic() == 2 && s.n_hexes() == 6 && s.boundary.is_empty()));
    }

    #[test]
    fn a_sheet_may_cross_itself() {
        // Three cubes round an edge: sheets turn the corner; each pair of outer directions is one sheet.
        let hexes = [[0, 1, 2, 3, 7, 8, 9, 10], [0, 3, 4, 5, 7, 10, 11, 12], [0, 5, 6, 1, 7, 12, 13, 8]];
        let all = check(&HexMesh::try_new(14, &hexes).unwrap());
        assert_eq!(all.len(), 4);
        // A row of cubes bent round until two directions meet: found by looking, checked by the counts.
        let mesh =
            HexMesh::try_new(16, &[[0, 1, 2, 3, 4, 5, 6, 7], [4, 5, 6, 7, 8, 9, 10, 11], [8, 9, 10, 11, 1, 2, 3, 0]])
                .unwrap();
        let all = check(&mesh);
        let crossing = all.iter().find(|s| !s.self_crossings.is_empty()).unwrap();
        assert_eq!((crossing.n_hexes(), crossing.crossings.len()), (3, 6));
    }
}
