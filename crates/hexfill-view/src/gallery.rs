//! A page of many small drawings: surfaces by their chords, each with words under it. One self-contained HTML file without scripts.
//!
//! Source: ours.

use crate::chord_drawing::chord_thumbnail;
use crate::page::escape;
use hexfill_mesh::QuadSurface;
use std::fmt::Write as _;

/// One object of a gallery.
#[derive(Clone, Debug)]
pub struct GalleryItem {
    /// The surface to draw; without one, or if it is no sphere, `instead` stands in its place.
    pub surface: Option<QuadSurface>,
    /// Why there is no drawing.
    pub instead: String,
    /// The first line under the drawing.
    pub title: String,
    /// The others.
    pub lines: Vec<String>,
    /// A long name, in small print.
    pub name: String,
}

const STYLE: &str = "body{font:13px/1.4 system-ui,sans-serif;margin:24px;color:#1c2630;background:#fff}\
h1{font-size:20px;margin:0 0 4px}p{margin:0 0 12px;max-width:90ch}\
main{display:grid;grid-template-columns:repeat(auto-fill,minmax(210px,1fr));gap:14px}\
figure{margin:0;border:1px solid #d3dae1;border-radius:7px;padding:10px}\
.none{height:180px;display:flex;align-items:center;justify-content:center;text-align:center;color:#566471}\
svg{display:block;margin:0 auto 6px}b{display:block}\
code{display:block;font-size:10px;color:#566471;overflow-wrap:anywhere;margin-top:4px}";

/// The page as text; `words` stand under its title.
pub fn gallery(title: &str, words: &str, items: &[GalleryItem]) -> String {
    let mut page = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{0}</title>\n<style>{STYLE}</style>\n</head>\n\
         <body>\n<h1>{0}</h1>\n<p>{1}</p>\n<main>\n",
        escape(title),
        escape(words)
    );
    for item in items {
        let drawing = item.surface.as_ref().and_then(|surface| chord_thumbnail(surface, 180.0));
        let drawing = drawing.unwrap_or_else(|| format!("<div class=\"none\">{}</div>", escape(&item.instead)));
        let _ = writeln!(page, "<figure>{drawing}<figcaption><b>{}</b>", escape(&item.title));
        for line in &item.lines {
            let _ = writeln!(page, "{}<br>", escape(line));
        }
        let _ = writeln!(page, "<code>{}</code></figcaption></figure>", escape(&item.name));
    }
    page.push_str("</main>\n</body>\n</html>\n");
    page
}
