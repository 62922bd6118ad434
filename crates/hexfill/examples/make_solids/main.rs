//! Writes test surfaces for `tests/campaign.py`: `cargo run --release --example make_solids -- FOLDER [KIND...]`.
//!
//! KIND is `solids` (some 30 solids with a known good hex mesh), `turned` (parts made on a lathe), `milled` (16 parts milled out of plates, 9 of several blocks, and 100 random ones), `voxels` (200 random ones of genus 0), `holes` (100 with tunnels and
//! cavities), `balls` (cubed spheres and ellipsoids), `cut` (triangulated spheres cut into quads), `radial` (radial graphs), `smooth`
//! (voxel solids refined and smoothed) or `mixed` (quad-dominant surfaces refined, with self-crossing chords); all these by default. `many`
//! is 1,000 random surfaces of 30 to 300 quads of all these kinds, `canonical` 1,000 random spheres of 18 to 24 quads on their canonical polyhedra, both without
//! known meshes. Each surface is `KIND_NAME.obj`; its known mesh, if there is one, is `reference/KIND_NAME.vtk`, whose first
//! vertices are those of the surface. `references.json` says for each file its kind, quads, and the reference's hexes and
//! certified scaled Jacobian. The same folder comes out everywhere, up to the last bits of sines.

mod milled;
mod refine;
mod section;
mod solid;
mod solids;
mod spheres;
mod voxels;

use hexfill::Context;
use hexfill::io::{MeshData, write_path};
use hexfill::unstable::check::{Judged, Level, Options, judge};
use hexfill::unstable::embed::canonical_polyhedron;
use hexfill_mesh::generate::random_sphere;
use serde_json::{Map, Value, json};
use solid::Solid;
use std::error::Error;
use std::path::{Path, PathBuf};

/// Where the files go, and what is known of them.
struct Folder {
    path: PathBuf,
    facts: Map<String, Value>,
}

impl Folder {
    /// Writes a solid's surface and mesh, and one line about it; a mesh the judge does not certify is an error.
    fn solid(&mut self, kind: &str, name: &str, solid: Solid) -> Result<(), Box<dyn Error>> {
        let (points, quads) = solid.surface();
        let surface = MeshData::from_quads(points, quads);
        let judged = Judged::connectivity(solid.points.len(), &solid.hexes).with_points(&solid.points);
        let report = judge(&judged.with_surface(&surface.quads), &Options::default(), &Context::default());
        if !report.passed(Level::L5) {
            return Err(format!("{kind}_{name}: {report}").into());
        }
        let quality = report.geometry.and_then(|g| g.quality).ok_or("the judge measures quality")?;
        let [jacobian, _] = quality.certified_scaled_jacobian;
        let hexes = solid.hexes.len();
        println!("{kind}_{name}: {} quads, {hexes} hexes, scaled Jacobian {jacobian:.3}", surface.quads.len());
        let entry = json!({"kind": kind, "quads": surface.quads.len(), "hexes": hexes, "scaled_jacobian": jacobian});
        let data = MeshData { points: solid.points, hexes: solid.hexes, ..MeshData::default() };
        write_path(&self.path.join(format!("reference/{kind}_{name}.vtk")), None, &data)?;
        self.surface(kind, name, &surface, entry)
    }

    /// Writes a surface of which no mesh is known.
    fn bare(&mut self, kind: &str, name: &str, (points, quads): spheres::Surface) -> Result<(), Box<dyn Error>> {
        println!("{kind}_{name}: {} quads", quads.len());
        let entry = json!({"kind": kind, "quads": quads.len()});
        self.surface(kind, name, &MeshData::from_quads(points, quads), entry)
    }

    fn surface(&mut self, kind: &str, name: &str, data: &MeshData, entry: Value) -> Result<(), Box<dyn Error>> {
        data.quad_surface()?;
        let file = format!("{kind}_{name}.obj");
        write_path(&self.path.join(&file), None, data)?;
        self.facts.insert(file, entry);
        Ok(())
    }
}

/// Divisions of the cubed spheres' faces: 96 to 5,046 quads.
const BALLS: [usize; 9] = [4, 5, 6, 8, 10, 12, 16, 22, 29];
/// Points of the triangulations: 20 to 500 triangles.
const CUT: [usize; 8] = [12, 16, 22, 32, 52, 92, 152, 252];
/// Points of the mixed surfaces: 90 to some 2,600 quads.
const MIXED: [usize; 8] = [24, 40, 60, 100, 150, 250, 400, 650];
/// Points of the radial graphs, even so that the quads are: 24 to 198 quads.
const RADIAL: [usize; 9] = [10, 12, 16, 20, 24, 30, 40, 54, 68];

const KINDS: [&str; 10] =
    ["solids", "turned", "milled", "voxels", "holes", "balls", "cut", "radial", "smooth", "mixed"];

fn make(kind: &str, folder: &mut Folder) -> Result<(), Box<dyn Error>> {
    match kind {
        "solids" => {
            for (name, solid) in solids::all() {
                folder.solid("solid", name, solid)?;
            }
        }
        "turned" => {
            for (name, solid) in solids::turned() {
                folder.solid("turned", name, solid)?;
            }
        }
        "milled" => {
            for (name, solid) in milled::parts().into_iter().chain(milled::assembled()) {
                folder.solid("milled", name, solid)?;
            }
            for seed in 0..100 {
                folder.solid("milled", &format!("{seed:03}"), milled::random(seed))?;
            }
        }
        "voxels" => {
            for seed in 0..200 {
                let cells = voxels::sphere(4 + (seed as usize * 7) % 57, seed);
                folder.solid("voxels", &format!("{seed:03}"), voxels::solid(&cells))?;
            }
        }
        "holes" => {
            for seed in 0..100u64 {
                let size = [0, 1, 2].map(|i| 3 + (seed / 3u64.pow(i) % 3) as i32);
                let tunnels = seed as usize % 4;
                let cavities = seed as usize / 4 % 3 + usize::from(tunnels == 0);
                let (cells, genus, parts) = voxels::with_holes(size, tunnels, cavities, seed as usize % 10, seed);
                let name = format!("{seed:03}_genus{genus}_parts{parts}");
                folder.solid("holes", &name, voxels::solid(&cells))?;
            }
        }
        "balls" => {
            for n in BALLS {
                let layers = 1 + n / 5;
                folder.solid("ball", &format!("{n}"), solids::o_grid_ball(n, layers, false))?;
                let ellipsoid = solids::o_grid_ball(n, layers, false).mapped(|[x, y, z]| [1.6 * x, 1.2 * y, 0.8 * z]);
                folder.solid("ellipsoid", &format!("{n}"), ellipsoid)?;
            }
        }
        "cut" => {
            for n in CUT {
                let quads = 3 * (2 * n - 4);
                folder.bare("cut", &format!("even_{quads}"), spheres::cut_triangles(&spheres::even_points(n)))?;
                let random = spheres::random_points(n, n as u64);
                folder.bare("cut", &format!("random_{quads}"), spheres::cut_triangles(&random))?;
            }
        }
        "radial" => {
            for n in RADIAL {
                let quads = 3 * n - 6;
                folder.bare("radial", &format!("even_{quads}"), spheres::radial(&spheres::even_points(n)))?;
                let random = spheres::random_points(n, n as u64);
                folder.bare("radial", &format!("random_{quads}"), spheres::radial(&random))?;
            }
        }
        "smooth" => {
            for seed in 0..30 {
                let solid = voxels::solid(&voxels::sphere(6 + seed as usize * 2, 1000 + seed));
                let mut surface = refine::catmull_clark_quads(&solid.surface());
                if seed % 3 == 2 {
                    surface = refine::catmull_clark_quads(&surface);
                }
                folder.bare("smooth", &format!("{seed:02}_{}", surface.1.len()), surface)?;
            }
        }
        "mixed" => {
            for n in MIXED {
                for (name, points) in
                    [("even", spheres::even_points(n)), ("random", spheres::random_points(n, 7 + n as u64))]
                {
                    let surface = refine::catmull_clark(&points, &refine::mixed(&points, n as u64));
                    let (points, quads) = surface;
                    let points = points.into_iter().map(|[x, y, z]| [1.4 * x, y, 0.9 * z]).collect();
                    folder.bare("mixed", &format!("{name}_{}", quads.len()), (points, quads))?;
                }
            }
        }
        "many" => {
            for seed in 0..1000 {
                let (name, surface) = one_of_many(seed);
                folder.bare("many", &format!("{seed:03}_{name}_{}", surface.1.len()), surface)?;
            }
        }
        "canonical" => {
            for seed in 0..1000u64 {
                let n = 18 + 2 * (seed as usize % 4);
                let sphere = random_sphere(n, seed).ok_or("there are spheres of every such size")?;
                let quads = sphere.quads_raw();
                folder.bare("canonical", &format!("{seed:03}_{n}"), (canonical_polyhedron(&sphere)?, quads))?;
            }
        }
        _ => return Err(format!("no kind {kind}").into()),
    }
    Ok(())
}

/// A random surface of 30 to 300 quads; kinds take turns, sizes grow and start again.
fn one_of_many(seed: u64) -> (&'static str, spheres::Surface) {
    let sizes = 2 + (seed / 8 * 7 % 29) as usize;
    let turned = |[x, y, z]: [f64; 3]| {
        let (sin, cos) = (0.1 * z).sin_cos();
        [cos * x - sin * y, sin * x + cos * y + 0.01 * z * z, z + 0.02 * x * x]
    };
    let made = (0..).map(|more| {
        let size = sizes + more;
        let seed = 10_000 + 1000 * more as u64 + seed;
        let radial = 12 + 3 * size - size % 2;
        match seed % 8 {
            0 => ("voxels", voxels::solid(&voxels::sphere(4 + 3 * size, seed)).surface()),
            1 => ("twisted", voxels::solid(&voxels::sphere(4 + 3 * size, seed)).mapped(turned).surface()),
            2 => {
                let cells = voxels::with_holes(
                    [3, 3 + size as i32 % 2, 3 + size as i32 / 15],
                    size % 4,
                    (size + 1) % 2,
                    size % 10,
                    seed,
                )
                .0;
                ("holes", voxels::solid(&cells).surface())
            }
            3 => ("cut", spheres::cut_triangles(&spheres::random_points(6 + 3 * size / 2, seed))),
            4 => ("radial", spheres::radial(&spheres::random_points(radial + radial % 2, seed))),
            5 => {
                let points = spheres::random_points(8 + 2 * size, seed);
                ("mixed", refine::catmull_clark(&points, &refine::mixed(&points, seed)))
            }
            6 => ("smooth", refine::catmull_clark_quads(&voxels::solid(&voxels::sphere(1 + size / 2, seed)).surface())),
            _ => {
                // Cubed boxes of any sides, as rough as stones.
                let cells = voxels::sphere(2 + size, seed);
                let rough = voxels::solid(&cells)
                    .mapped(|p| p.map(|x| x + 0.12 * (5.0 * (p[0] + 2.0 * p[1] + 3.0 * p[2]) + x).sin()));
                ("rough", rough.surface())
            }
        }
    });
    made.into_iter().find(|(_, (_, quads))| (30..=300).contains(&quads.len())).expect("sizes grow")
}

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let Some((path, kinds)) = words.split_first() else {
        return Err(
            "usage: make_solids FOLDER [solids|turned|milled|voxels|holes|balls|cut|radial|smooth|mixed ...]".into()
        );
    };
    let mut folder = Folder { path: Path::new(path).to_owned(), facts: Map::new() };
    std::fs::create_dir_all(folder.path.join("reference"))?;
    let kinds: Vec<&str> = kinds.iter().map(String::as_str).collect();
    for kind in if kinds.is_empty() { &KINDS[..] } else { &kinds } {
        make(kind, &mut folder)?;
    }
    let text = serde_json::to_string_pretty(&folder.facts)?;
    std::fs::write(folder.path.join("references.json"), text + "\n")?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use hexfill_mesh::QuadSurface;

    fn of((points, quads): &spheres::Surface) -> QuadSurface {
        QuadSurface::try_new(points.len(), quads).unwrap()
    }

    #[test]
    fn the_known_meshes_have_the_known_counts_and_are_certified() {
        let all = solids::all();
        assert!(all.len() >= 20);
        for (name, solid) in &all {
            let judged = Judged::connectivity(solid.points.len(), &solid.hexes).with_points(&solid.points);
            let quads = solid.boundary();
            let report = judge(&judged.with_surface(&quads), &Options::default(), &Context::default());
            assert!(report.passed(Level::L5), "{name}: {report}");
            assert!(report.geometry.unwrap().quality.unwrap().certified_scaled_jacobian[0] > 0.35, "{name}");
        }
        let counts = |wanted: &str| {
            let (_, solid) = all.iter().find(|(name, _)| *name == wanted).unwrap();
            let surface = of(&solid.surface());
            (surface.n_quads(), solid.hexes.len(), surface.genus(), surface.n_components())
        };
        assert_eq!(counts("box_4x5x3"), (94, 60, 0, 1));
        assert_eq!(counts("cylinder"), (208, 320, 0, 1));
        assert_eq!(counts("step_shaft"), (352, 5 * 80 + 7 * 48, 0, 1));
        assert_eq!(counts("hollow_sphere"), (300, 450, 0, 2));
        for ring in ["pipe_bend", "plate_square_hole", "plate_round_hole", "torus_block", "torus_round"] {
            assert_eq!(counts(ring).2, 1, "{ring}");
        }
    }

    #[test]
    fn triangulations_and_refinements_are_spheres() {
        for n in [12, 31, 100] {
            for points in [spheres::even_points(n), spheres::random_points(n, 3)] {
                assert_eq!(spheres::hull(&points).len(), 2 * n - 4);
                assert!(of(&spheres::cut_triangles(&points)).is_sphere());
                assert!(of(&spheres::radial(&points)).is_sphere());
                let refined = of(&refine::catmull_clark(&points, &refine::mixed(&points, 5)));
                assert!(refined.is_sphere());
                assert!(refined.darts().all(|d| refined.degree(refined.origin(d)) >= 3));
            }
        }
    }

    #[test]
    fn voxel_solids_are_what_they_should_be() {
        for seed in 0..20 {
            assert!(of(&voxels::solid(&voxels::sphere(30, seed)).surface()).is_sphere());
            let (cells, genus, parts) = voxels::with_holes([5, 4, 4], 2, 1, 4, seed);
            let surface = of(&voxels::solid(&cells).surface());
            assert_eq!((surface.genus(), surface.n_components()), (genus, parts));
        }
    }
}
