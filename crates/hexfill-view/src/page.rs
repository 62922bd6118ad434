//! The page: a template with the style, the data, a still picture and the viewer put in.
//!
//! Everything that comes from the user passes [`escape`] (text in HTML) or [`json`] (data in a script element), so
//! no title and no fact can end an element. The template is cut at its marks once and what is put in is never searched again.
//!
//! Source: ours.

use crate::ViewInput;
use crate::colour::{FLAGGED, GROWTH, INSIDE, QUALITY, Rgb, SURFACE, Scale, UNKNOWN, category};
use crate::picture::{Panels, Picture, png_with};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use serde::Serialize;
use std::io::{self, Write};

const TEMPLATE: &str = include_str!("../viewer/page.html");
const STYLE: &str = include_str!("../viewer/style.css");
const SCRIPT: &str = include_str!("../viewer/dist/viewer.js");

/// What the viewer reads (`viewer/src/data.ts`); arrays are base64 of little-endian numbers.
#[derive(Serialize)]
struct Data<'a> {
    /// Name and version of this layout.
    format: &'static str,
    title: &'a str,
    vertices: usize,
    hexes: usize,
    /// `vertices` x 3 float64; NaN where there is no position.
    points: String,
    /// Bytes of an entry of `corners`: 1, 2 or 4.
    corner_bytes: usize,
    /// `hexes` x 8 unsigned integers, VTK order.
    corners: String,
    values: Option<Values<'a>>,
    /// `hexes` uint32, if a shelling was given.
    shelling: Option<String>,
    groups: Option<GroupData<'a>>,
    facts: &'a [(String, String)],
    problems: Vec<String>,
    colours: Colours,
}

#[derive(Serialize)]
struct Values<'a> {
    name: &'a str,
    /// `hexes` float64.
    data: String,
    low: f64,
    high: f64,
    flags_nonpositive: bool,
    ramp: &'static [Rgb],
}

#[derive(Serialize)]
struct GroupData<'a> {
    names: &'a [String],
    colours: Vec<Rgb>,
    /// uint32, rising: 6 times the hex plus the side.
    facets: String,
    /// uint32: the group of each of these.
    of: String,
    first: bool,
}

#[derive(Serialize)]
struct Colours {
    surface: Rgb,
    inside: Rgb,
    unknown: Rgb,
    flagged: Rgb,
    quality: &'static [Rgb],
    growth: &'static [Rgb],
}

/// Writes the page.
pub(crate) fn write(input: &ViewInput<'_>, out: &mut (impl Write + ?Sized)) -> io::Result<()> {
    let mut rest = TEMPLATE;
    while let Some((before, after)) = rest.split_once("<!--") {
        let (mark, after) = after.split_once("-->").expect("the template closes its comments");
        out.write_all(before.as_bytes())?;
        match mark {
            "title" => out.write_all(escape(input.title).as_bytes())?,
            "style" => out.write_all(STYLE.as_bytes())?,
            "still" => {
                let picture = Picture { panels: Panels::Both, ..Picture::new(960, 540) };
                out.write_all(STANDARD.encode(png_with(input, &picture)).as_bytes())?;
            }
            "facts" => out.write_all(facts(input).as_bytes())?,
            "data" => out.write_all(json(input)?.as_bytes())?,
            "script" => out.write_all(SCRIPT.as_bytes())?,
            _ => unreachable!("the template has no mark {mark}"),
        }
        rest = after;
    }
    out.write_all(rest.as_bytes())
}

/// The facts as table rows, for readers without scripts.
fn facts(input: &ViewInput<'_>) -> String {
    let row = |(name, value): &(String, String)| {
        format!("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", escape(name), escape(value))
    };
    input.facts.iter().map(row).collect()
}

/// `text` for an HTML element or a quoted attribute.
pub(crate) fn escape(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            '\'' => safe.push_str("&#39;"),
            // HTML has no way to write NUL.
            '\0' => safe.push('\u{fffd}'),
            _ => safe.push(c),
        }
    }
    safe
}

/// The data as JSON that may stand in a script element: `<`, `>` and `&` only ever occur in strings, as `\u003c` ...
fn json(input: &ViewInput<'_>) -> io::Result<String> {
    let mesh = input.mesh;
    let (corner_bytes, corners) = match mesh.n_vertices() {
        0..=0x100 => (1, encode(mesh.hexes().iter().flatten().map(|v| [v.0 as u8]))),
        0x101..=0x1_0000 => (2, encode(mesh.hexes().iter().flatten().map(|v| (v.0 as u16).to_le_bytes()))),
        _ => (4, encode(mesh.hexes().iter().flatten().map(|v| v.0.to_le_bytes()))),
    };
    let positions = (0..mesh.n_vertices())
        .flat_map(|v| if input.has_position(v) { input.points[v] } else { [f64::NAN; 3] })
        .map(f64::to_le_bytes);
    let data = Data {
        format: "hexfill-view 1",
        title: input.title,
        vertices: mesh.n_vertices(),
        hexes: mesh.n_hexes(),
        points: encode(positions),
        corner_bytes,
        corners,
        values: input.values().map(|(name, values)| {
            let scale = Scale::new(name, values);
            Values {
                name,
                data: encode(values.iter().map(|x| x.to_le_bytes())),
                low: scale.low,
                high: scale.high,
                flags_nonpositive: scale.flags_nonpositive,
                ramp: scale.ramp(),
            }
        }),
        shelling: input.order().map(|order| encode(order.iter().map(|h| h.0.to_le_bytes()))),
        groups: input.groups.map(|groups| GroupData {
            names: &groups.names,
            colours: (0..groups.names.len()).map(category).collect(),
            facets: encode(groups.facets.iter().map(|f| f.0.to_le_bytes())),
            of: encode(groups.facets.iter().map(|f| f.1.to_le_bytes())),
            first: groups.first,
        }),
        facts: input.facts,
        problems: input.problems(),
        colours: Colours {
            surface: SURFACE,
            inside: INSIDE,
            unknown: UNKNOWN,
            flagged: FLAGGED,
            quality: &QUALITY,
            growth: &GROWTH,
        },
    };
    let text = serde_json::to_string(&data)?;
    Ok(text.replace('<', "\\u003c").replace('>', "\\u003e").replace('&', "\\u0026"))
}

/// Base64 of the concatenated bytes.
fn encode<const N: usize>(numbers: impl Iterator<Item = [u8; N]>) -> String {
    STANDARD.encode(numbers.flatten().collect::<Vec<u8>>())
}
