//! `hexfill view MESH -o view.html`.

use crate::console::Console;
use crate::exit::Exit;
use crate::files;
use anyhow::bail;
use hexfill::io::Format;
use hexfill::mesh::{HexId, HexMesh, greedy_shelling};
use hexfill::unstable::view::ViewInput;
use std::io::Write;

/// Flags of `view`.
#[derive(clap::Args)]
pub(crate) struct ViewArgs {
    /// The mesh to show.
    mesh: String,
    /// The file to write: .html for a page that opens from disk, .png for a picture.
    #[arg(short, long, value_name = "OUT")]
    output: String,
    /// Format of the mesh.
    #[arg(long, value_name = "FORMAT", value_parser = files::parse_format)]
    from: Option<Format>,
    /// Title of the page [default: the name of its file].
    #[arg(long)]
    title: Option<String>,
}

/// Reads a mesh and writes its page or picture.
pub(crate) fn run(args: &ViewArgs, console: &Console) -> anyhow::Result<Exit> {
    files::check_folder(&args.output)?;
    let data = files::read_data(&args.mesh, &args.from.into())?;
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
    let judged =
        hexfill::unstable::check::Judged::connectivity(data.points.len(), &data.hexes).with_points(&data.points);
    let scaled_jacobians = hexfill::unstable::check::cell_quality(&judged)
        .iter()
        .map(|c| c.as_ref().map_or(f64::NAN, |c| c.certified_lower))
        .collect();
    let shown = Shown {
        title: args.title.as_deref().unwrap_or_else(|| files::short_name(&args.mesh)),
        points: &data.points,
        mesh: &mesh,
        scaled_jacobians: Some(scaled_jacobians),
        facts: Vec::new(),
    };
    if args.output.to_ascii_lowercase().ends_with(".png") {
        shown.write_picture(&args.output)?;
    } else {
        shown.write_page(&args.output)?;
    }
    if console.json {
        console.print_json(&serde_json::json!({ "file": args.output, "hexes": mesh.n_hexes() }))?;
    }
    console.say(format!("{}: {} hexes", args.output, mesh.n_hexes()));
    Ok(Exit::Done)
}

/// Shelling orders are looked for in meshes up to this size: the animation of more hexes shows nothing.
const SHELLING_LIMIT: usize = 20_000;

/// A mesh to show.
pub(crate) struct Shown<'a> {
    pub title: &'a str,
    pub points: &'a [[f64; 3]],
    pub mesh: &'a HexMesh,
    /// Certified scaled Jacobian per hex.
    pub scaled_jacobians: Option<Vec<f64>>,
    /// Further lines of the legend: what and how much.
    pub facts: Vec<(String, String)>,
}

impl Shown<'_> {
    fn input<'b>(&'b self, shelling: Option<&'b [HexId]>) -> ViewInput<'b> {
        ViewInput {
            title: self.title,
            points: self.points,
            mesh: self.mesh,
            hex_values: self.scaled_jacobians.as_deref().map(|v| ("scaled Jacobian", v)),
            shelling,
            facts: &self.facts,
        }
    }

    /// Writes the page and the picture that are asked for; returns their names.
    pub(crate) fn write(&self, page: Option<String>, picture: Option<String>) -> anyhow::Result<Vec<String>> {
        if let Some(path) = &page {
            self.write_page(path)?;
        }
        if let Some(path) = &picture {
            self.write_picture(path)?;
        }
        Ok(page.into_iter().chain(picture).collect())
    }

    /// Writes the HTML page.
    fn write_page(&self, path: &str) -> anyhow::Result<()> {
        let shelling = if self.mesh.n_hexes() <= SHELLING_LIMIT { greedy_shelling(self.mesh) } else { None };
        files::write_file(path, |out| hexfill::unstable::view::write_html(&self.input(shelling.as_deref()), out))
    }

    /// Writes the PNG picture: the surface and a cut-away side by side.
    fn write_picture(&self, path: &str) -> anyhow::Result<()> {
        let bytes = hexfill::unstable::view::png(&self.input(None), 1200, 640);
        files::write_file(path, |out| out.write_all(&bytes))
    }
}
