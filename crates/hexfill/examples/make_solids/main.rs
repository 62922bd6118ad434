//! Writes test surfaces for `tests/campaign.py`: `cargo run --release --example make_solids -- FOLDER [KIND...]`.
//!
//! KIND is `solids` (some 30 solids with a known good hex mesh), `voxels` (200 random ones of genus 0), `holes` (100 with tunnels and
//! cavities), `balls` (cubed spheres and ellipsoids), `cut` (triangulated spheres cut into quads) or `radial` (radial graphs);
//! all by default. Each surface is `KIND_NAME.obj`; its known mesh, if there is one, is `reference/KIND_NAME.vtk`, whose first
//! vertices are those of the surface. `references.json` says for each file its kind, quads, and the reference's hexes and
//! certified scaled Jacobian. The same folder comes out everywhere, up to the last bits of sines.

mod section;
mod solid;
mod solids;
mod spheres;
mod voxels;

use hexfill::Context;
use hexfill::check::{Judged, Level, Options, judge};
use hexfill::io::{MeshData, write_path};
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
        let quads = solid.boundary();
        let n = quads.iter().flatten().max().map_or(0, |&v| v as usize + 1);
        let surface = MeshData::from_quads(solid.points[..n].to_vec(), quads);
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
/// Points of the radial graphs, even so that the quads are: 24 to 198 quads.
const RADIAL: [usize; 9] = [10, 12, 16, 20, 24, 30, 40, 54, 68];

fn make(kind: &str, folder: &mut Folder) -> Result<(), Box<dyn Error>> {
    match kind {
        "solids" => {
            for (name, solid) in solids::all() {
                folder.solid("solid", name, solid)?;
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
        _ => return Err(format!("no kind {kind}").into()),
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let Some((path, kinds)) = words.split_first() else {
        return Err("usage: make_solids FOLDER [solids|voxels|holes|balls|cut|radial ...]".into());
    };
    let mut folder = Folder { path: Path::new(path).to_owned(), facts: Map::new() };
    std::fs::create_dir_all(folder.path.join("reference"))?;
    let kinds: Vec<&str> = kinds.iter().map(String::as_str).collect();
    for kind in if kinds.is_empty() { &["solids", "voxels", "holes", "balls", "cut", "radial"][..] } else { &kinds } {
        make(kind, &mut folder)?;
    }
    let text = serde_json::to_string_pretty(&folder.facts)?;
    std::fs::write(folder.path.join("references.json"), text + "\n")?;
    Ok(())
}
