//! `hexfill view MESH -o view.html`.

use crate::console::Console;
use crate::exit::Exit;
use crate::files;
use anyhow::bail;
use hexfill::io::{Format, MeshData};
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
    /// Colour by this field of the hexes, such as layer or engine [default: the certified scaled Jacobian].
    #[arg(long, value_name = "FIELD")]
    field: Option<String>,
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
    let shown = Shown {
        title: args.title.as_deref().unwrap_or_else(|| files::short_name(&args.mesh)),
        points: &data.points,
        mesh: &mesh,
        values: Some(colours(args, &data)?),
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

/// What hexes are coloured by.
fn colours(args: &ViewArgs, data: &MeshData) -> anyhow::Result<(String, Vec<f64>)> {
    let Some(name) = &args.field else {
        let judged =
            hexfill::unstable::check::Judged::connectivity(data.points.len(), &data.hexes).with_points(&data.points);
        let quality = hexfill::unstable::check::cell_quality(&judged);
        let bounds = quality.iter().map(|c| c.as_ref().map_or(f64::NAN, |c| c.certified_lower)).collect();
        return Ok((QUALITY.to_owned(), bounds));
    };
    match data.hex_data.iter().find(|(field, _)| field == name) {
        Some(found) => Ok(found.clone()),
        None => {
            let known: Vec<&str> = data.hex_data.iter().map(|(field, _)| field.as_str()).collect();
            let known = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
            bail!("{} has no field {name} on its hexes; it has: {known}", args.mesh)
        }
    }
}

/// What certified scaled Jacobians are called in pages.
const QUALITY: &str = "scaled Jacobian";

/// Shelling orders are looked for in meshes up to this size: the animation of more hexes shows nothing.
const SHELLING_LIMIT: usize = 20_000;

/// A mesh to show.
pub(crate) struct Shown<'a> {
    pub title: &'a str,
    pub points: &'a [[f64; 3]],
    pub mesh: &'a HexMesh,
    /// What hexes are coloured by: its name, and a number per hex.
    pub values: Option<(String, Vec<f64>)>,
    /// Further lines of the legend: what and how much.
    pub facts: Vec<(String, String)>,
}

impl Shown<'_> {
    /// Colours by certified scaled Jacobians.
    pub(crate) fn by_quality(values: Vec<f64>) -> Option<(String, Vec<f64>)> {
        Some((QUALITY.to_owned(), values))
    }

    fn input<'b>(&'b self, shelling: Option<&'b [HexId]>) -> ViewInput<'b> {
        ViewInput {
            title: self.title,
            points: self.points,
            mesh: self.mesh,
            hex_values: self.values.as_ref().map(|(name, values)| (name.as_str(), values.as_slice())),
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
