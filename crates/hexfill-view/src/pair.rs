//! Two meshes beside each other: two whole pages in one, whose cameras and cuts follow each other.
//!
//! Source: ours.

use crate::ViewInput;
use crate::page::{self, escape};
use crate::picture::{Panels, Picture, draw_rows, encoded};
use std::io::{self, Write};

const TEMPLATE: &str = include_str!("../viewer/pair.html");

/// Writes a page with two meshes beside each other. Turning one turns the other, and the cut plane, size and explosion are shared; all else is each one's own. Both are
/// scaled to their own size.
///
/// # Errors
/// Those of `out`.
pub fn write_pair_html(both: [&ViewInput<'_>; 2], out: &mut (impl Write + ?Sized)) -> io::Result<()> {
    let mut rest = TEMPLATE;
    while let Some((before, after)) = rest.split_once("<!--") {
        let (mark, after) = after.split_once("-->").expect("the template closes its comments");
        out.write_all(before.as_bytes())?;
        match mark {
            "title" => {
                write!(out, "{} | {}", escape(both[0].title), escape(both[1].title))?;
            }
            "left" | "right" => {
                let input = both[usize::from(mark == "right")];
                let mut inner = Vec::new();
                page::write(input, &mut inner)?;
                out.write_all(escape(&String::from_utf8_lossy(&inner)).as_bytes())?;
            }
            _ => unreachable!("the template has no mark {mark}"),
        }
        rest = after;
    }
    out.write_all(rest.as_bytes())
}

/// Draws two meshes beside each other as a PNG file (8-bit RGB) of `width` by `height` pixels: each cut open, from the same side, in its own half.
pub fn pair_png(both: [&ViewInput<'_>; 2], width: u32, height: u32) -> Vec<u8> {
    let half = Picture { panels: Panels::CutAway, ..Picture::new(width.clamp(32, 8192) / 2, height) };
    let [left, right] = both.map(|input| draw_rows(input, &half));
    let (w, h) = half.size();
    let bytes = 3 * w as usize;
    let rows =
        left.chunks(bytes).zip(right.chunks(bytes)).flat_map(|(l, r)| l.iter().chain(r)).copied().collect::<Vec<u8>>();
    encoded(2 * w, h, &rows)
}
