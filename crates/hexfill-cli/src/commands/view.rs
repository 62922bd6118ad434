//! `hexfill view MESH -o view.html`.

use crate::console::{self, Console};
use crate::exit::Exit;
use crate::files;
use anyhow::bail;
use hexfill::io::{Format, MeshData, TagOn};
use hexfill::mesh::{HexId, HexMesh, greedy_shelling};
use hexfill::unstable::view::{Groups, ViewInput};
use std::collections::BTreeMap;
use std::io::Write;

/// Flags of `view`.
#[derive(clap::Args)]
pub(crate) struct ViewArgs {
    /// The mesh to show.
    mesh: String,
    /// A second mesh, shown beside the first: cameras and cuts follow each other.
    beside: Option<String>,
    /// The file to write: .html for a page that opens from disk, .png for a picture.
    #[arg(short, long, value_name = "OUT")]
    output: String,
    /// Format of the mesh, or of both.
    #[arg(long, value_name = "FORMAT", value_parser = files::parse_format)]
    from: Option<Format>,
    /// Colour by this field of the hexes, such as layer or engine [default: the certified scaled Jacobian].
    #[arg(long, value_name = "FIELD")]
    field: Option<String>,
    /// Colour by the groups of quads: boundary conditions, walls between regions.
    #[arg(long, conflicts_with = "field")]
    groups: bool,
    /// Title of the page of one mesh [default: the name of its file].
    #[arg(long, conflicts_with = "beside")]
    title: Option<String>,
}

/// Reads a mesh, or two, and writes their page or picture.
pub(crate) fn run(args: &ViewArgs, console: &Console) -> anyhow::Result<Exit> {
    files::check_folder(&args.output)?;
    let names: Vec<&str> = std::iter::once(&args.mesh).chain(&args.beside).map(String::as_str).collect();
    let read: Vec<(MeshData, HexMesh)> =
        names.iter().map(|name| read(name, args, console)).collect::<anyhow::Result<_>>()?;
    let shown: Vec<Shown<'_>> = names
        .iter()
        .zip(&read)
        .map(|(name, (data, mesh))| {
            let groups = groups(mesh, data, args.groups);
            if args.groups && groups.is_none() {
                bail!("{name} has no groups: none of its quads has a tag");
            }
            Ok(Shown {
                title: args.title.as_deref().unwrap_or_else(|| files::short_name(name)),
                points: &data.points,
                mesh,
                values: Some(colours(name, args, data)?),
                groups,
                facts: Vec::new(),
            })
        })
        .collect::<anyhow::Result<_>>()?;
    let is_picture = args.output.to_ascii_lowercase().ends_with(".png");
    match (shown.as_slice(), is_picture) {
        ([one], true) => one.write_picture(&args.output)?,
        ([one], false) => one.write_page(&args.output)?,
        (both, true) => write_pair_picture(both, &args.output)?,
        (both, false) => write_pair_page(both, &args.output)?,
    }
    let hexes: Vec<usize> = shown.iter().map(|one| one.mesh.n_hexes()).collect();
    if console.json {
        let hexes = if let [one] = hexes[..] { one.into() } else { serde_json::json!(hexes) };
        console.print_json(&serde_json::json!({ "file": args.output, "hexes": hexes }))?;
    }
    let words: Vec<String> = hexes.iter().map(|&n| console::hexes(n)).collect();
    console.say(format!("{}: {}", args.output, words.join(" and ")));
    Ok(Exit::Done)
}

/// A mesh with positions.
fn read(name: &str, args: &ViewArgs, console: &Console) -> anyhow::Result<(MeshData, HexMesh)> {
    let data = files::read_data(name, &args.from.into())?;
    for note in &data.notes {
        console.note(note);
    }
    if data.hexes.is_empty() {
        bail!("{name} has no hexes; give a hex mesh");
    }
    if !data.has_coordinates {
        bail!("{name} has no coordinates; compute them first or give a file that has");
    }
    let mesh = HexMesh::try_new(data.points.len(), &data.hexes)?;
    Ok((data, mesh))
}

/// The groups of the quads of a mesh, by their names; `first`: shown in their colours.
pub(crate) fn groups(mesh: &HexMesh, data: &MeshData, first: bool) -> Option<Groups> {
    let mut names: BTreeMap<i64, Vec<&str>> = BTreeMap::new();
    for name in data.tag_names.iter().filter(|name| name.on == TagOn::Faces) {
        names.entry(name.tag).or_default().push(&name.name);
    }
    let name = |tag: i64| names.get(&tag).map_or_else(|| format!("tag {tag}"), |names| names.join(" + "));
    Groups::new(mesh, &data.quads, data.quad_tags.as_deref().unwrap_or(&[]), name, first)
}

/// The order in which a page builds a mesh up.
fn shelling(mesh: &HexMesh) -> Option<Vec<HexId>> {
    if mesh.n_hexes() <= SHELLING_LIMIT { greedy_shelling(mesh) } else { None }
}

fn write_pair_page(both: &[Shown<'_>], path: &str) -> anyhow::Result<()> {
    let orders = [shelling(both[0].mesh), shelling(both[1].mesh)];
    let inputs = [0, 1].map(|i| both[i].input(orders[i].as_deref()));
    files::write_file(path, |out| hexfill::unstable::view::write_pair_html([&inputs[0], &inputs[1]], out))
}

fn write_pair_picture(both: &[Shown<'_>], path: &str) -> anyhow::Result<()> {
    let inputs = [0, 1].map(|i| both[i].input(None));
    let bytes = hexfill::unstable::view::pair_png([&inputs[0], &inputs[1]], 1200, 640);
    files::write_file(path, |out| out.write_all(&bytes))
}

/// What hexes are coloured by.
fn colours(file: &str, args: &ViewArgs, data: &MeshData) -> anyhow::Result<(String, Vec<f64>)> {
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
            bail!("{file} has no field {name} on its hexes; it has: {known}")
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
    /// Groups of its quads.
    pub groups: Option<Groups>,
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
            groups: self.groups.as_ref(),
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
        let shelling = shelling(self.mesh);
        files::write_file(path, |out| hexfill::unstable::view::write_html(&self.input(shelling.as_deref()), out))
    }

    /// Writes the PNG picture: the surface and a cut-away side by side.
    fn write_picture(&self, path: &str) -> anyhow::Result<()> {
        let bytes = hexfill::unstable::view::png(&self.input(None), 1200, 640);
        files::write_file(path, |out| out.write_all(&bytes))
    }
}
