//! `hexfill enumerate N --gallery FILE`: the objects of an enumeration, drawn.

use crate::console::Console;
use crate::files;
use anyhow::bail;
use hexfill::mesh::{QuadSurface, hex_signature};
use hexfill::unstable::enumerate::{Boundary, Code, EnumerateError, Params, canonical, shape};
use hexfill::unstable::view::{GalleryItem, gallery};
use std::io::Write as _;

/// More objects than these nobody looks through.
const MOST: usize = 200;

/// Refuses the file of a gallery before any work.
pub(crate) fn check(file: &str) -> anyhow::Result<()> {
    if !file.to_ascii_lowercase().ends_with(".html") {
        bail!("{file}: a gallery is a page; give a name that ends in .html");
    }
    files::check_folder(file)
}

/// The first objects, and how many there were.
#[derive(Default)]
pub(crate) struct Gallery {
    items: Vec<GalleryItem>,
    objects: usize,
}

impl Gallery {
    /// Takes an object in, if there is still room.
    pub(crate) fn add(&mut self, code: &Code) -> Result<(), EnumerateError> {
        self.objects += 1;
        if self.items.len() == MOST {
            return Ok(());
        }
        let complex = code.decode()?;
        let (measures, boundary) = (shape(&complex), Boundary::of(&complex));
        let mesh = complex.to_hex_mesh().ok();
        let surface = mesh.as_ref().and_then(|mesh| {
            let quads: Vec<[u32; 4]> = mesh.boundary_quads_raw();
            QuadSurface::try_new(mesh.n_vertices(), &quads).ok()
        });
        let instead = match &surface {
            _ if boundary.n_quads() == 0 => "no boundary".to_owned(),
            None => "not drawn: the boundary is no manifold".to_owned(),
            Some(_) => format!("not drawn: the boundary is no sphere (genera {})", measures.components.text()),
        };
        self.items.push(GalleryItem {
            instead,
            surface,
            title: format!("{}{}", self.objects, if measures.is_ball { ": a ball" } else { "" }),
            lines: vec![
                format!("{} boundary quads, {} vertices", boundary.n_quads(), measures.vertices),
                format!("chords: {}; symmetries: {}", measures.chords, canonical(&complex).automorphisms),
                format!("key {}", boundary.key()),
            ],
            name: mesh.and_then(|mesh| hex_signature(&mesh).ok()).unwrap_or_else(|| code.to_text()),
        });
        Ok(())
    }

    /// Writes the page and says what is left out.
    pub(crate) fn write(&self, file: &str, params: &Params, console: &Console) -> anyhow::Result<()> {
        let left_out = match self.objects - self.items.len() {
            0 => String::new(),
            n => format!(
                " The first {} are shown, {n} are left out: select with --balls, --boundary-quads, --only-key.",
                self.items.len()
            ),
        };
        let title = format!("Hex meshes of {} cubes", params.cubes);
        let words = format!(
            "{} objects, rule {}: the boundary of each, laid flat and drawn by its chords; its vertex of highest degree is all of the outside.{left_out}",
            self.objects, params.rule
        );
        files::write_file(file, |out| out.write_all(gallery(&title, &words, &self.items).as_bytes()))?;
        console.say(format!("wrote {file}: {} of {} objects", self.items.len(), self.objects));
        Ok(())
    }
}
