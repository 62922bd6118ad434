//! `hexfill info SURFACE|MESH`.

use crate::commands::limits::{self, LimitsInfo};
use crate::console::Console;
use crate::exit::Exit;
use crate::files;
use anyhow::bail;
use hexfill::construct::{Existence, existence};
use hexfill::io::MeshData;
use hexfill::mesh::{
    HexMesh, QuadSurface, bipartition, chords, hex_signature, improper_pairs, key, sheets, surface_automorphisms,
    surface_signature,
};
use hexfill::{Problem, check_fillable};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::Write as _;

/// Flags of `info`.
#[derive(clap::Args)]
pub struct InfoArgs {
    /// A surface or a mesh: a file, `-`, a catalogue name or a signature.
    input: String,
    #[command(flatten)]
    reading: files::InputArgs,
    /// Where an odd cycle bounds inside, so that no hex mesh exists: write its edges, as lines (.obj) or as vertex pairs (.txt).
    #[arg(long, value_name = "FILE")]
    cycle: Option<String>,
}

#[derive(Serialize)]
struct SurfaceInfo {
    kind: &'static str,
    quads: usize,
    vertices: usize,
    edges: usize,
    components: usize,
    /// Quads and genus of each component, where there are several.
    parts: Vec<PartInfo>,
    genus: u64,
    euler: i64,
    bipartite: bool,
    odd_cycle: Option<Vec<u32>>,
    /// "exists", "none" or "unknown".
    hex_mesh: &'static str,
    because: String,
    /// The odd cycle that bounds inside, if that is why there is none.
    bounding_cycle: Option<Vec<[u32; 2]>>,
    /// How many pairs of quads share more than a vertex or an edge, and the first ones.
    improper_pairs: usize,
    first_improper_pairs: Vec<[u32; 2]>,
    degrees: BTreeMap<u32, usize>,
    chords: Vec<ChordInfo>,
    key: String,
    automorphisms: Option<usize>,
    signature: Option<String>,
    /// What the positions allow any mesh to reach; absent without positions.
    limits: Option<LimitsInfo>,
}

#[derive(Serialize)]
struct PartInfo {
    quads: usize,
    genus: u64,
}

#[derive(Serialize)]
struct ChordInfo {
    quads: usize,
    self_crossings: usize,
}

#[derive(Serialize)]
struct MeshInfo {
    kind: &'static str,
    hexes: usize,
    vertices: usize,
    interior_vertices: usize,
    boundary_quads: usize,
    sheets: Vec<SheetInfo>,
    signature: Option<String>,
    boundary: Option<SurfaceInfo>,
}

#[derive(Serialize)]
struct SheetInfo {
    hexes: usize,
    self_crossings: usize,
    boundary_chords: usize,
}

/// Larger surfaces are not searched for symmetries, nor printed as a signature.
const SIGNATURE_LIMIT: usize = 20_000;

/// Describes a surface or a mesh.
pub fn run(args: &InfoArgs, console: &Console) -> anyhow::Result<Exit> {
    if let Some(file) = &args.cycle {
        files::check_folder(file)?;
        if !["obj", "txt"].iter().any(|e| file.to_ascii_lowercase().ends_with(&format!(".{e}"))) {
            bail!("{file}: the edges of a cycle are written as .obj (lines) or .txt (vertex pairs); give such a name");
        }
        files::check_distinct(&[&args.input, file])?;
    }
    let problem = if hexfill::is_named(&args.input) {
        files::load_problem(&args.input, &args.reading)?
    } else {
        let data = files::read_data(&args.input, &args.reading)?;
        if !data.hexes.is_empty() {
            if args.cycle.is_some() {
                bail!("{}: --cycle is about surfaces; this is a hex mesh", args.input);
            }
            return mesh_info(&data, console);
        }
        Problem::from_data(&args.input, &data)?
    };
    for note in &problem.notes {
        console.note(note);
    }
    let info = describe(&problem.surface, problem.points.as_deref());
    if console.json {
        console.print_json(&info)?;
    } else {
        print_surface(&info, console)?;
    }
    if let Some(file) = &args.cycle {
        match &info.bounding_cycle {
            Some(cycle) => {
                write_cycle(file, cycle, problem.points.as_deref().unwrap_or(&[]))?;
                console.say(format!("wrote {file}: {} edges", cycle.len()));
            }
            None => console.note(format!("no odd cycle is known to bound inside; {file} was not written")),
        }
    }
    Ok(Exit::Done)
}

/// The edges of a cycle, 0-based pairs a line, or with all points of the surface as Wavefront lines.
fn write_cycle(file: &str, cycle: &[[u32; 2]], points: &[[f64; 3]]) -> anyhow::Result<()> {
    let mut text = String::new();
    if file.to_ascii_lowercase().ends_with(".txt") {
        for [a, b] in cycle {
            let _ = writeln!(text, "{a} {b}");
        }
    } else {
        for [x, y, z] in points {
            let _ = writeln!(text, "v {x} {y} {z}");
        }
        for [a, b] in cycle {
            let _ = writeln!(text, "l {} {}", a + 1, b + 1);
        }
    }
    files::write_file(file, |out| out.write_all(text.as_bytes()))
}

/// Whether a hex mesh exists, why, and the cycle that forbids it.
fn verdict(surface: &QuadSurface, points: Option<&[[f64; 3]]>) -> (&'static str, String, Option<Vec<[u32; 2]>>) {
    if let Err(refusal) = check_fillable(surface) {
        return ("none", refusal.to_string(), None);
    }
    match existence(surface, points) {
        Existence::Exists { because } => ("exists", because.to_owned(), None),
        Existence::OddCycleBounds { cycle } => {
            let edges: Vec<[u32; 2]> = cycle.iter().map(|e| [e.0.0, e.1.0]).collect();
            let shown: Vec<String> = cycle.iter().take(20).map(ToString::to_string).collect();
            let more = if cycle.len() > 20 { " ..." } else { "" };
            let because = format!("an odd cycle of {} edges bounds inside: {}{more}", cycle.len(), shown.join(" "));
            ("none", because, Some(edges))
        }
        Existence::OddSolid { components, given } => {
            let names: Vec<String> = components.iter().map(ToString::to_string).collect();
            let (noun, bound) = if names.len() == 1 { ("component", "bounds") } else { ("components", "bound") };
            let because = format!(
                "{noun} {} {bound} one solid with {given} quads, an odd number: every hex mesh of a connected solid has an even number of boundary quads (Thurston 1993)",
                names.join(", ")
            );
            ("none", because, None)
        }
        Existence::Unknown { reason } => ("unknown", reason, None),
        Existence::OddQuads { given } => ("none", format!("the surface has {given} quads, an odd number"), None),
        Existence::ImproperQuads { pairs } => ("none", format!("quads share too much: {pairs}"), None),
        // A verdict of a later version of the library.
        other => ("unknown", format!("{other:?}"), None),
    }
}

fn describe(surface: &QuadSurface, points: Option<&[[f64; 3]]>) -> SurfaceInfo {
    let small = surface.n_quads() <= SIGNATURE_LIMIT;
    let colours = bipartition(surface);
    let (hex_mesh, because, bounding_cycle) = verdict(surface, points);
    let mut degrees = BTreeMap::new();
    for v in 0..surface.n_vertices() {
        let degree = surface.degree(hexfill::mesh::VertexId::new(v));
        if degree > 0 {
            *degrees.entry(degree).or_insert(0) += 1;
        }
    }
    let chords = chords(surface);
    let pairs = improper_pairs(surface);
    let parts = if surface.n_components() > 1 { surface.split_components() } else { Vec::new() };
    SurfaceInfo {
        kind: "surface",
        quads: surface.n_quads(),
        vertices: surface.n_used_vertices(),
        edges: surface.n_edges(),
        components: surface.n_components(),
        parts: parts.iter().map(|(s, _, _)| PartInfo { quads: s.n_quads(), genus: s.genus() }).collect(),
        genus: surface.genus(),
        euler: surface.euler_characteristic(),
        bipartite: colours.is_ok(),
        odd_cycle: colours.err().map(|c| c.vertices.iter().map(|v| v.0).collect()),
        hex_mesh,
        because,
        bounding_cycle,
        improper_pairs: pairs.count,
        first_improper_pairs: pairs.first.iter().map(|p| p.quads.map(|q| q.0)).collect(),
        degrees,
        chords: chords
            .iter()
            .map(|c| ChordInfo { quads: c.length(), self_crossings: c.self_crossings.len() })
            .collect(),
        key: key(surface).to_string(),
        automorphisms: (small && surface.n_components() == 1).then(|| surface_automorphisms(surface).len()),
        signature: small.then(|| surface_signature(surface)),
        limits: points.and_then(|points| limits::describe(surface, points)),
    }
}

fn print_surface(info: &SurfaceInfo, console: &Console) -> anyhow::Result<()> {
    let shape = match (info.components, info.genus) {
        (1, 0) => "a sphere".to_owned(),
        (1, g) => format!("genus {g}"),
        (c, g) => format!("{c} components, genus {g} in all"),
    };
    console.print(format!(
        "closed quad surface, {shape}: {} quads, {} vertices, {} edges, Euler characteristic {}",
        info.quads, info.vertices, info.edges, info.euler
    ))?;
    for (c, part) in info.parts.iter().enumerate().take(20) {
        console.print(format!("component {c}: {} quads, genus {}", part.quads, part.genus))?;
    }
    if info.parts.len() > 20 {
        console.print(format!("... and {} more components", info.parts.len() - 20))?;
    }
    let degrees: Vec<String> = info.degrees.iter().map(|(d, n)| format!("{n} of degree {d}")).collect();
    console.print(format!("vertices: {}", degrees.join(", ")))?;
    let chords: Vec<String> = info
        .chords
        .iter()
        .take(10)
        .map(|c| match c.self_crossings {
            0 => c.quads.to_string(),
            k => format!("{} (crossing itself {k} times)", c.quads),
        })
        .collect();
    let more = if info.chords.len() > 10 { ", ..." } else { "" };
    console.print(format!("chords: {}, of {}{more} quads", info.chords.len(), chords.join(", ")))?;
    let key = if info.key.len() > 400 { format!("{}...", &info.key[..400]) } else { info.key.clone() };
    console.print(format!("key: {key}"))?;
    console.print(match &info.odd_cycle {
        None => "bipartite: yes".to_owned(),
        Some(cycle) => {
            let shown: Vec<String> = cycle.iter().take(30).map(|v| format!("v{v}")).collect();
            let more = if cycle.len() > 30 { " ..." } else { "" };
            format!("bipartite: no, odd cycle of {} edges: {}{more}", cycle.len(), shown.join(" "))
        }
    })?;
    if let Some(n) = info.automorphisms {
        console.print(format!("automorphisms: {n} (reflections included)"))?;
    }
    if let Some(signature) = info.signature.as_ref().filter(|s| s.len() <= 2000) {
        console.print(format!("signature: {signature}"))?;
    }
    if let Some(limits) = &info.limits {
        limits.lines().into_iter().try_for_each(|line| console.print(line))?;
    }
    console.print(match info.hex_mesh {
        "exists" => format!("hex mesh: exists ({})", info.because),
        "none" => format!("hex mesh: none exists: {}", info.because),
        _ => format!("hex mesh: not known: {}", info.because),
    })
}

fn mesh_info(data: &MeshData, console: &Console) -> anyhow::Result<Exit> {
    let highest = data.hexes.iter().flatten().max().map_or(0, |&v| v as usize + 1);
    let mesh = HexMesh::try_new(data.points.len().max(highest), &data.hexes)?;
    let quads: Vec<[u32; 4]> = mesh.boundary_quads().iter().map(|q| q.map(|v| v.0)).collect();
    let boundary = QuadSurface::try_new(mesh.n_vertices(), &quads).ok();
    let info = MeshInfo {
        kind: "mesh",
        hexes: mesh.n_hexes(),
        vertices: mesh.used_vertices().iter().filter(|&&u| u).count(),
        interior_vertices: mesh.n_interior_vertices(),
        boundary_quads: quads.len(),
        sheets: sheets(&mesh)
            .iter()
            .map(|s| SheetInfo {
                hexes: s.n_hexes(),
                self_crossings: s.self_crossings.len(),
                boundary_chords: s.boundary.len(),
            })
            .collect(),
        signature: (mesh.n_hexes() <= SIGNATURE_LIMIT).then(|| hex_signature(&mesh).ok()).flatten(),
        boundary: boundary.as_ref().map(|b| describe(b, data.has_coordinates.then_some(data.points.as_slice()))),
    };
    if console.json {
        console.print_json(&info)?;
        return Ok(Exit::Done);
    }
    console.print(format!(
        "hex mesh: {} hexes, {} vertices ({} interior), {} boundary quads",
        info.hexes, info.vertices, info.interior_vertices, info.boundary_quads
    ))?;
    console.print(format!("sheets: {}", info.sheets.len()))?;
    for (i, sheet) in info.sheets.iter().take(20).enumerate() {
        console.print(format!(
            "  sheet {i}: {} hexes, {} self-crossings, {} boundary chords",
            sheet.hexes, sheet.self_crossings, sheet.boundary_chords
        ))?;
    }
    if let Some(signature) = info.signature.as_ref().filter(|s| s.len() <= 4000) {
        console.print(format!("signature: {signature}"))?;
    }
    match &info.boundary {
        Some(boundary) => {
            console.print("boundary:")?;
            print_surface(boundary, console)?;
        }
        None => console.print("boundary: not a closed manifold; see `hexfill check`")?,
    }
    Ok(Exit::Done)
}
