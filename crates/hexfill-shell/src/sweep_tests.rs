//! Sweeps of whole surfaces, every result judged.

use crate::front::Front;
use crate::sweep::{Swept, sweep};
use crate::sweep_options::SweepOptions;
use crate::test_surfaces::{judged, read_obj, torus_at, voxels};
use hexfill_mesh::generate::{random_sphere, voxel_surface};
use hexfill_mesh::{Context, QuadSurface, Random};
use hexfill_search::Atlas;

#[test]
fn boxes_are_their_voxels() {
    for n in 2..=6 {
        let surface = voxel_surface([n, n, n], |_| true).unwrap();
        let swept = sweep(&surface, None, &SweepOptions::default(), &Context::default());
        assert_eq!(judged(&surface, &swept), n * n * n);
    }
}

#[test]
fn handles_are_plugged() {
    let (surface, points) = torus_at(12, 8);
    for (pillows, hexes) in [(0, 36), (1, 132)] {
        let options = SweepOptions { pillows, ..Default::default() };
        let swept = sweep(&surface, Some(&points), &options, &Context::default());
        assert_eq!(judged(&surface, &swept), hexes);
    }
    let (pen, points) = read_obj(include_str!("../../../corpus/surfaces/bamboo_pen.obj"));
    let options = SweepOptions { pillows: 1, ..Default::default() };
    let swept = sweep(&pen, Some(&points), &options, &Context::default());
    assert!(judged(&pen, &swept) <= 2280);
}

/// The state that a result describes, checked.
fn checked(surface: &QuadSurface, swept: &Swept) -> Front {
    let quads: Vec<[u32; 4]> = surface.quads_raw();
    let state = Front::try_from_parts(swept.n_vertices, &quads, &swept.hexes, &swept.front).unwrap();
    state.debug_check();
    state
}

/// A random triangulated sphere, every triangle cut into three quads: all chords are simple.
fn cut_triangulation(n_points: u32, seed: u64) -> QuadSurface {
    let mut random = Random::new(seed);
    let mut triangles = vec![[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]];
    for v in 4..n_points {
        let [a, b, c] = triangles.swap_remove(random.below(triangles.len()));
        triangles.extend([[a, b, v], [b, c, v], [c, a, v]]);
    }
    // Edge slides mix the degrees, where the new edge is none yet.
    for _ in 0..10 * n_points {
        let (i, j) = (random.below(triangles.len()), random.below(triangles.len()));
        for k in 0..3 {
            let [a, b, c] = [0, 1, 2].map(|m| triangles[i][(k + m) % 3]);
            let Some(l) = (0..3).find(|&l| triangles[j][l] == b && triangles[j][(l + 1) % 3] == a) else {
                continue;
            };
            let d = triangles[j][(l + 2) % 3];
            let taken = triangles.iter().any(|t| t.contains(&c) && t.contains(&d));
            if !taken {
                triangles[i] = [c, a, d];
                triangles[j] = [d, b, c];
            }
            break;
        }
    }
    let mut middles = std::collections::BTreeMap::new();
    let mut quads = Vec::new();
    let n_edges = 3 * n_points - 6;
    for (t, &[a, b, c]) in triangles.iter().enumerate() {
        let mut middle = |a: u32, b: u32| {
            let n = n_points + middles.len() as u32;
            *middles.entry((a.min(b), a.max(b))).or_insert(n)
        };
        let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
        let centre = n_points + n_edges + t as u32;
        quads.extend([[a, ab, centre, ca], [b, bc, centre, ab], [c, ca, centre, bc]]);
    }
    QuadSurface::try_new((n_points + n_edges) as usize + triangles.len(), &quads).unwrap()
}

#[test]
fn cut_triangulations_take_a_third_of_their_quads() {
    for seed in 0..40 {
        let surface = cut_triangulation(6 + 2 * seed as u32, seed);
        if !hexfill_mesh::is_proper(&surface) {
            continue;
        }
        for pillows in 0..2 {
            let options = SweepOptions { pillows, ..Default::default() };
            let swept = sweep(&surface, None, &options, &Context::default());
            let hexes = surface.n_quads() / 3 + pillows as usize * surface.n_quads();
            assert_eq!(judged(&surface, &swept), hexes, "{seed} {pillows}");
        }
    }
}

#[test]
fn voxel_solids_are_their_voxels() {
    type Letter = (&'static str, [usize; 3], fn([usize; 3]) -> bool);
    let letters: [Letter; 4] = [
        ("L", [6, 6, 3], |[x, y, _]| x < 3 || y < 3),
        ("T", [9, 6, 3], |[x, y, _]| y > 2 || (3..6).contains(&x)),
        ("U", [9, 6, 3], |[x, y, _]| y < 3 || !(3..6).contains(&x)),
        ("stairs", [4, 4, 4], |[x, y, z]| x + y + z < 4 + z % 2),
    ];
    for (name, size, filled) in letters {
        let (surface, angles) = voxels(size, filled).unwrap();
        let cells = (0..size[0] * size[1] * size[2])
            .filter(|i| filled([i % size[0], i / size[0] % size[1], i / size[0] / size[1]]))
            .count();
        let want = |a: u32, b: u32| angles[&(a.min(b), a.max(b))];
        let options = SweepOptions { edge_want: Some(&want), restarts: 20, ..Default::default() };
        let swept = sweep(&surface, None, &options, &Context::default());
        assert_eq!(judged(&surface, &swept), cells, "{name}");
    }
}

#[test]
fn random_voxel_solids() {
    let (mut tried, mut exact) = (0, 0);
    for seed in 0..600 {
        let mut random = Random::new(seed);
        let size = [2, 3, 4].map(|n| n + random.below(3));
        let mut filled = std::collections::BTreeSet::from([[size[0] / 2, size[1] / 2, size[2] / 2]]);
        for _ in 0..100 {
            let cells: Vec<[usize; 3]> = filled.iter().copied().collect();
            let mut cell = cells[random.below(cells.len())];
            let axis = random.below(3);
            cell[axis] = (cell[axis] + 1 + random.below(2) * (size[axis] - 2)) % size[axis];
            filled.insert(cell);
        }
        let Some((surface, angles)) = voxels(size, |c| filled.contains(&c)) else { continue };
        if !surface.is_sphere() || !hexfill_mesh::is_proper(&surface) {
            continue;
        }
        tried += 1;
        let want = |a: u32, b: u32| angles[&(a.min(b), a.max(b))];
        let options = SweepOptions { edge_want: Some(&want), restarts: 20, ..Default::default() };
        let swept = sweep(&surface, None, &options, &Context::default());
        checked(&surface, &swept);
        if swept.front.is_empty() {
            exact += usize::from(judged(&surface, &swept) == filled.len());
        }
    }
    println!("{exact} of {tried}");
    assert!(tried > 20 && exact == tried, "{exact} of {tried}");
}

#[test]
fn random_spheres_close() {
    let mut open = Vec::new();
    let (mut n_quads, mut n_hexes) = (0, 0);
    for seed in 0..40 {
        let surface = random_sphere(10 + 2 * (seed as usize / 2), seed).unwrap();
        let options = SweepOptions { seed, stir: 30, atlas: Some(Atlas::embedded()), ..Default::default() };
        let swept = sweep(&surface, None, &options, &Context::default());
        checked(&surface, &swept);
        if swept.front.is_empty() {
            n_hexes += judged(&surface, &swept);
            n_quads += surface.n_quads();
        } else {
            open.push((seed, surface.n_quads(), swept.front.len()));
        }
    }
    println!("{n_hexes} hexes for {n_quads} quads; open: {open:?}");
    assert!(open.len() <= 1);
}
