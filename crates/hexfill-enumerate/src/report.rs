//! Counts as a table for people; the same as JSON comes from serializing a [`Tally`].

use crate::tally::{Histogram, Tally};
use std::fmt::{Display, Write};

/// The poster's columns, one row a level: cubes, classes, with mirror images distinct, raw, fewest chords, fewest boundary quads,
/// classes with at most `few` chords (closed complexes not counted), balls, closed complexes.
pub fn table<'a>(levels: impl IntoIterator<Item = (usize, &'a Tally)>, few: u8) -> String {
    let few_title = format!("<={few} chords");
    let mut rows = vec![
        ["cubes", "classes", "mirror distinct", "raw", "min chords", "min quads", &few_title, "balls", "closed"]
            .map(String::from),
    ];
    for (n, t) in levels {
        let least = |h: &Histogram<u8>| h.min().map_or("-".into(), u8::to_string);
        rows.push([
            n.to_string(),
            t.classes.to_string(),
            (t.classes + t.chiral).to_string(),
            t.raw.to_string(),
            least(&t.chords),
            least(&t.boundary_quads),
            (t.with_at_most_chords(few) - t.closed).to_string(),
            t.balls.to_string(),
            t.closed.to_string(),
        ]);
    }
    let widths: [usize; 9] = std::array::from_fn(|i| rows.iter().map(|r| r[i].len()).max().unwrap_or(0));
    let mut text = String::new();
    for row in &rows {
        let cells: Vec<String> = row.iter().zip(widths).map(|(cell, w)| format!("{cell:>w$}")).collect();
        let _ = writeln!(text, "{}", cells.join("  "));
    }
    text
}

/// The histograms of one level, one a line.
pub fn histograms(t: &Tally) -> String {
    let mut text = String::new();
    let mut put = |name: &str, values: String| {
        if !values.is_empty() {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "{name:>22}: {values}");
        }
    };
    put("raw by glued facets", items(&t.raw_by_glued));
    put("chords", items(&t.chords));
    put("boundary quads", items(&t.boundary_quads));
    put("vertices", items(&t.vertices));
    put("|Aut|", items(&t.automorphisms));
    put("Euler characteristic", items(&t.euler));
    put("genera of boundary", items(&t.boundary_genera));
    text
}

fn items<K: Ord + Display>(h: &Histogram<K>) -> String {
    h.0.iter().map(|(key, n)| format!("{key}:{n}")).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_line_up() {
        let t = Tally { classes: 12, chiral: 3, ..Tally::default() };
        let text = table([(3, &t), (4, &t)], 3);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 3);
        assert!(lines.iter().all(|l| l.len() == lines[0].len()));
        assert!(lines[1].contains("12") && lines[1].contains("15"));
        let mut t = Tally::default();
        t.chords.add(4, 7);
        assert_eq!(histograms(&t).trim(), "chords: 4:7");
    }
}
