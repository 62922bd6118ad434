//! Collapses of sheets and columns: pillows go again and leave the mesh they were put into, and nothing else is harmed.

mod common;

use common::{assert_sound, pillowed};
use hexfill_mesh::generate::{Random, all_spheres, grid, grid_mesh_of, shuffled_mesh};
use hexfill_mesh::{Context, HexMesh, StopReason, VertexId, hex_signature};
use hexfill_search::{
    Atlas, Collapse, FillOptions, Simplified, SimplifyOptions, collapse, fill_from_atlas, simplification_atlas,
    simplify,
};
use std::sync::atomic::AtomicBool;

fn run(mesh: &HexMesh) -> Simplified {
    let made = collapse(mesh, Collapse::All, &Context::default());
    assert_sound(mesh, &made);
    made
}

/// A random box of cells of a grid.
fn random_box(size: [usize; 3], random: &mut Random) -> [[usize; 2]; 3] {
    size.map(|n| {
        let low = random.below(n);
        [low, low + 1 + random.below(n - low)]
    })
}

#[test]
fn a_pillow_round_any_box_goes_again() {
    let mut random = Random::new(1);
    for size in [[2, 1, 1], [2, 2, 2], [3, 2, 1], [3, 3, 3], [5, 4, 3]] {
        let mesh = grid(size[0], size[1], size[2]).unwrap();
        for _ in 0..12 {
            let cells = random_box(size, &mut random);
            let inside = |h: usize| {
                let at = [h % size[0], h / size[0] % size[1], h / size[0] / size[1]];
                (0..3).all(|k| cells[k][0] <= at[k] && at[k] < cells[k][1])
            };
            let big = pillowed(&mesh, inside);
            let made = run(&shuffled_mesh(&big, random.next_u64()).0);
            assert_eq!(made.report.sheets, 1, "{size:?} {cells:?}");
            assert_eq!(made.report.collapsed, big.n_hexes() - mesh.n_hexes());
            assert_eq!(hex_signature(&made.mesh), hex_signature(&mesh), "{size:?} {cells:?}");
        }
    }
}

#[test]
fn pillows_in_pillows_go_too() {
    let mut random = Random::new(2);
    for round in 0..20 {
        let mesh = grid(3, 3, 2).unwrap();
        let mut big = mesh.clone();
        for _ in 0..3 {
            let n = big.n_hexes();
            // Round everything, or round one hex, which may be one of a pillow.
            let one = random.below(2 * n);
            big = pillowed(&big, |h| one >= n || h == one);
        }
        let made = run(&big);
        assert_eq!(hex_signature(&made.mesh), hex_signature(&mesh), "round {round}");
    }
}

#[test]
fn inside_only_keeps_every_hex_at_the_boundary() {
    let mesh = grid(5, 4, 4).unwrap();
    let inside = |h: usize| h == 1 + 5 * (1 + 4);
    let [outer, inner] = [pillowed(&mesh, |_| true), pillowed(&pillowed(&mesh, inside), |_| true)];
    for (big, after) in [(&outer, outer.n_hexes()), (&inner, outer.n_hexes())] {
        let made = collapse(big, Collapse::Inside, &Context::default());
        assert_sound(big, &made);
        assert_eq!(made.mesh.n_hexes(), after);
        let is_boundary = big.boundary_vertices();
        let left: Vec<[Option<VertexId>; 8]> =
            made.mesh.hexes().iter().map(|h| h.map(|v| made.origin[v.index()])).collect();
        let at_boundary = big.hexes().iter().filter(|h| h.iter().any(|v| is_boundary[v.index()]));
        assert!(at_boundary.into_iter().all(|h| left.contains(&h.map(Some))));
    }
}

#[test]
fn sheets_with_a_boundary_stay() {
    for mesh in [grid(4, 3, 2).unwrap(), grid_mesh_of([3, 3, 1], |[x, y, _]| x != 1 || y != 1).unwrap()] {
        let made = run(&mesh);
        assert_eq!((made.mesh, made.report.sheets, made.report.columns), (mesh, 0, 0));
    }
    let none = HexMesh::try_new(3, &[]).unwrap();
    assert_eq!(collapse(&none, Collapse::All, &Context::default()).mesh, none);
}

#[test]
fn pillowed_fillings_lose_their_pillows() {
    for surface in [6, 8, 10, 12].into_iter().flat_map(all_spheres) {
        let filled =
            fill_from_atlas(&surface, Atlas::embedded(), &FillOptions::default(), &Context::default()).unwrap();
        let small = &filled.fillings[0].mesh;
        let made = run(&pillowed(small, |_| true));
        assert!(made.mesh.n_hexes() <= small.n_hexes());
    }
}

#[test]
fn holes_stay_holes() {
    let ring = grid_mesh_of([3, 3, 1], |[x, y, _]| x != 1 || y != 1).unwrap();
    let shell = grid_mesh_of([3, 3, 3], |p| p != [1, 1, 1]).unwrap();
    for mesh in [ring, shell] {
        let made = run(&pillowed(&mesh, |_| true));
        assert!(made.report.sheets >= 1);
        assert_eq!(hex_signature(&made.mesh), hex_signature(&mesh));
    }
}

#[test]
fn simplify_collapses_before_balls_unless_told_not_to() {
    let mesh = pillowed(&grid(3, 3, 3).unwrap(), |_| true);
    let with = |options: SimplifyOptions| {
        let made = simplify(&mesh, simplification_atlas(), &options, &Context::default());
        assert_sound(&mesh, &made);
        made
    };
    let made = with(SimplifyOptions::default().with_balls(0));
    assert_eq!((made.report.sheets, made.report.collapsed, made.mesh.n_hexes()), (1, 54, 27));
    assert_eq!(made.report.balls, 0);
    let made = with(SimplifyOptions::default().with_balls(0).with_collapse(Collapse::Nothing));
    assert_eq!((made.report.sheets, &made.mesh), (0, &mesh));
}

#[test]
fn stopped_work_leaves_a_sound_mesh() {
    let mesh = pillowed(&grid(3, 3, 3).unwrap(), |_| true);
    let cancel = AtomicBool::new(true);
    let made = collapse(&mesh, Collapse::All, &Context { cancel: Some(&cancel), ..Context::default() });
    assert_sound(&mesh, &made);
    assert_eq!(made.report.stop, StopReason::Cancelled);
}
