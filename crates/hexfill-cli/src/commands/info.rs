//! `hexfill info SURFACE|MESH`.

use crate::console::{self, Console};
use crate::exit::Exit;
use crate::files;
use anyhow::bail;
use hexfill::io::MeshData;
use hexfill::mesh::QuadSurface;
use hexfill::unstable::view::chord_drawing;
use hexfill::{Estimate, FillOptions, MeshInfo, PlaceOptions, Problem, SurfaceInfo, describe_mesh, describe_surface};
use serde::Serialize;
use std::fmt::Write as _;
use std::io::Write as _;

/// Flags of `info`.
#[derive(clap::Args)]
pub(crate) struct InfoArgs {
    /// A surface or a mesh: a file, `-`, a catalogue name or a signature.
    input: String,
    #[command(flatten)]
    reading: files::InputArgs,
    /// Where an odd cycle bounds inside, so that no hex mesh exists: write its edges, as lines (.obj) or as vertex pairs (.txt).
    #[arg(long, value_name = "FILE")]
    cycle: Option<String>,
    /// Draw the chords of the surface (of a mesh: of its boundary), laid flat, as SVG. Components that are no spheres are left out.
    #[arg(long, value_name = "FILE")]
    svg: Option<String>,
}

/// What a surface is, and what filling it by default may take.
#[derive(Serialize)]
struct Output<'a> {
    #[serde(flatten)]
    info: &'a SurfaceInfo,
    /// As `fill` says it; null if that takes some seconds at most, or no mesh exists.
    estimate: Option<Estimate>,
}

/// Describes a surface or a mesh.
pub(crate) fn run(args: &InfoArgs, console: &Console) -> anyhow::Result<Exit> {
    if let Some(file) = &args.cycle {
        files::check_folder(file)?;
        if !["obj", "txt"].iter().any(|e| file.to_ascii_lowercase().ends_with(&format!(".{e}"))) {
            bail!("{file}: the edges of a cycle are written as .obj (lines) or .txt (vertex pairs); give such a name");
        }
        files::check_distinct(&[&args.input, file])?;
    }
    if let Some(file) = &args.svg {
        files::check_folder(file)?;
        if !file.to_ascii_lowercase().ends_with(".svg") {
            bail!("{file}: chords are drawn as SVG; give a name that ends in .svg");
        }
        files::check_distinct(&[&args.input, file, args.cycle.as_deref().unwrap_or("-")])?;
    }
    let problem = if hexfill::is_named(&args.input) {
        files::load_problem(&args.input, &args.reading)?
    } else {
        let data = files::read_data(&args.input, &args.reading)?;
        if !data.hexes.is_empty() {
            if args.cycle.is_some() {
                bail!("{}: --cycle is about surfaces; this is a hex mesh", args.input);
            }
            return mesh_info(args, &data, console);
        }
        Problem::from_data(&args.input, &data)?
    };
    for note in problem.notes() {
        console.note(note);
    }
    let info = describe_surface(problem.surface(), problem.points());
    let estimate = hexfill::estimate(&problem, &FillOptions::default(), &PlaceOptions::default())
        .filter(|_| info.existence.hex_mesh != "none");
    if console.json {
        console.print_json(&Output { info: &info, estimate })?;
    } else {
        print_surface(&info, console)?;
        if let Some(estimate) = estimate {
            console.print(format!("estimate: {estimate}"))?;
        }
    }
    if let Some(file) = &args.cycle {
        match &info.bounding_cycle {
            Some(cycle) => {
                write_cycle(file, cycle, problem.points().unwrap_or(&[]))?;
                console.say(format!("wrote {file}: {} edges", cycle.len()));
            }
            None => console.note(format!("no odd cycle is known to bound inside; {file} was not written")),
        }
    }
    if let Some(file) = &args.svg {
        draw_chords(file, problem.surface(), &args.input, console)?;
    }
    Ok(Exit::Done)
}

/// Writes the chords of a surface as SVG and says what is not in it.
fn draw_chords(file: &str, surface: &QuadSurface, input: &str, console: &Console) -> anyhow::Result<()> {
    let drawing = chord_drawing(surface, &format!("Chords of {}", files::short_name(input)))?;
    for reason in &drawing.left_out {
        console.note(format!("{file}: {reason}"));
    }
    files::write_file(file, |out| out.write_all(drawing.svg.as_bytes()))?;
    console.say(format!("wrote {file}"));
    Ok(())
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
            1 => format!("{} ({} passages, crossing itself once)", c.quads, c.passages),
            k => format!("{} ({} passages, crossing itself {k} times)", c.quads, c.passages),
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
    console.print(info.existence.to_string())
}

fn mesh_info(args: &InfoArgs, data: &MeshData, console: &Console) -> anyhow::Result<Exit> {
    let info = describe_mesh(data)?;
    if console.json {
        console.print_json(&info)?;
    } else {
        print_mesh(&info, console)?;
    }
    if let Some(file) = &args.svg {
        let mesh = data.hex_mesh()?;
        let quads: Vec<[u32; 4]> = mesh.boundary_quads_raw();
        draw_chords(file, &QuadSurface::try_new(mesh.n_vertices(), &quads)?, &args.input, console)?;
    }
    Ok(Exit::Done)
}

fn print_mesh(info: &MeshInfo, console: &Console) -> anyhow::Result<()> {
    console.print(format!(
        "hex mesh: {}, {} vertices ({} interior), {} boundary quads",
        console::hexes(info.hexes),
        info.vertices,
        info.interior_vertices,
        info.boundary_quads
    ))?;
    console.print(format!("sheets: {}", info.sheets.len()))?;
    for (i, sheet) in info.sheets.iter().take(20).enumerate() {
        console.print(format!(
            "  sheet {i}: {}, {} self-crossings, {} boundary chords",
            console::hexes(sheet.hexes),
            sheet.self_crossings,
            sheet.boundary_chords
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
    Ok(())
}
