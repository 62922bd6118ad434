//! `hexfill view MESH -o view.html`.

use crate::console::Console;
use crate::exit::Exit;
use crate::files;
use anyhow::bail;
use hexfill::io::Format;
use hexfill::mesh::{HexMesh, greedy_shelling};
use hexfill::view::ViewInput;
use std::io::Write;

/// Flags of `view`.
#[derive(clap::Args)]
pub struct ViewArgs {
    /// The mesh to show.
    mesh: String,
    /// The file to write: .html for a page that opens from disk, .png for a picture.
    #[arg(short, long, value_name = "OUT")]
    output: String,
    /// Format of the mesh.
    #[arg(long, value_name = "FORMAT", value_parser = files::parse_format)]
    from: Option<Format>,
    /// Title of the page [default: the mesh's name].
    #[arg(long)]
    title: Option<String>,
}

/// Reads a mesh and writes its page or picture.
pub fn run(args: &ViewArgs, console: &Console) -> anyhow::Result<Exit> {
    files::check_folder(&args.output)?;
    let data = files::read_data(&args.mesh, args.from)?;
    for note in &data.notes {
        console.note(note);
    }
    if data.hexes.is_empty() {
        bail!("{} has no hexes; give a hex mesh", args.mesh);
    }
    if !data.has_coordinates {
        bail!("{} has no coordinates; compute them first or give a file that has", args.mesh);
    }
    let mesh = HexMesh::try_new(data.points.len(), &data.hexes)?;
    let title = args.title.as_deref().unwrap_or(&args.mesh);
    if args.output.to_ascii_lowercase().ends_with(".png") {
        write_picture(&args.output, title, &data.points, &mesh, &[])?;
    } else {
        write_view(&args.output, title, &data.points, &mesh, &[])?;
    }
    console.say(format!("{}: {} hexes", args.output, mesh.n_hexes()));
    Ok(Exit::Done)
}

/// Shelling orders are looked for in meshes up to this size: the animation of more hexes shows nothing.
const SHELLING_LIMIT: usize = 20_000;

/// Writes the HTML page of a mesh.
pub fn write_view(
    path: &str,
    title: &str,
    points: &[[f64; 3]],
    mesh: &HexMesh,
    facts: &[(String, String)],
) -> anyhow::Result<()> {
    let shelling = if mesh.n_hexes() <= SHELLING_LIMIT { greedy_shelling(mesh) } else { None };
    let input = ViewInput { title, points, mesh, hex_values: None, shelling: shelling.as_deref(), facts };
    files::write_file(path, |out| hexfill::view::write_html(&input, out))
}

/// Writes a PNG picture of a mesh.
pub fn write_picture(
    path: &str,
    title: &str,
    points: &[[f64; 3]],
    mesh: &HexMesh,
    facts: &[(String, String)],
) -> anyhow::Result<()> {
    let input = ViewInput { title, points, mesh, hex_values: None, shelling: None, facts };
    let bytes = hexfill::view::png(&input, 1200, 900);
    files::write_file(path, |out| out.write_all(&bytes))
}
