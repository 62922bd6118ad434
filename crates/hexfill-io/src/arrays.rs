//! Data arrays on the way between [`MeshData`] and files: components side by side in memory, together in files; numbers on quads and
//! on hexes apart in memory, one array over all cells in files.
//!
//! Source: ours.

use crate::data::MeshData;
use std::ops::Range;

/// The name of component `k` of an array.
pub(crate) fn component(name: &str, k: usize) -> String {
    format!("{name}:{k}")
}

/// Runs of `name:0`, `name:1`, ... as `(name, their places)`; every other name by itself.
fn runs<'a>(names: &[&'a str]) -> Vec<(&'a str, Range<usize>)> {
    let mut runs = Vec::new();
    let mut i = 0;
    while i < names.len() {
        let base = names[i].strip_suffix(":0").unwrap_or(names[i]);
        let length = names[i..].iter().enumerate().take_while(|(k, n)| **n == component(base, *k)).count();
        // One component alone is an array of its own name.
        let (name, length) = if length > 1 { (base, length) } else { (names[i], 1) };
        runs.push((name, i..i + length));
        i += length;
    }
    runs
}

/// An array over the points: its name and its components.
pub(crate) fn on_points(data: &MeshData) -> Vec<(&str, Vec<&[f64]>)> {
    let names: Vec<&str> = data.point_data.iter().map(|(name, _)| name.as_str()).collect();
    let columns = |range: Range<usize>| data.point_data[range].iter().map(|(_, v)| v.as_slice()).collect();
    runs(&names).into_iter().map(|(name, range)| (name, columns(range))).collect()
}

/// One component over all cells as they are written: faces, hexes, then the others.
#[derive(Clone, Copy)]
pub(crate) struct CellColumn<'a> {
    data: &'a MeshData,
    quads: Option<&'a [f64]>,
    hexes: Option<&'a [f64]>,
}

impl<'a> CellColumn<'a> {
    /// The value of each quad or other face; NaN where there is none.
    pub(crate) fn faces(self) -> impl Iterator<Item = f64> + 'a {
        self.data.numbered_faces().map(move |(quad, ..)| quad.and_then(|q| Some(self.quads?[q])).unwrap_or(f64::NAN))
    }

    /// The value of each hex.
    pub(crate) fn hexes(self) -> impl Iterator<Item = f64> + 'a {
        (0..self.data.hexes.len()).map(move |h| self.hexes.map_or(f64::NAN, |v| v[h]))
    }

    /// The value of each cell.
    pub(crate) fn all(self) -> impl Iterator<Item = f64> + 'a {
        let others = self.data.cell_count() - self.data.hexes.len();
        self.faces().chain(self.hexes()).chain(std::iter::repeat_n(f64::NAN, others))
    }

    /// Whether quads, and whether hexes have values.
    pub(crate) fn on(self) -> (bool, bool) {
        (self.quads.is_some(), self.hexes.is_some())
    }
}

/// The arrays over cells: those of hexes joined with those of quads of the same name, then the other ones of quads.
pub(crate) fn on_cells(data: &MeshData) -> Vec<(&str, Vec<CellColumn<'_>>)> {
    let mut left: Vec<Option<&(String, Vec<f64>)>> = data.quad_data.iter().map(Some).collect();
    let mut names = Vec::new();
    let mut columns = Vec::new();
    for (name, values) in &data.hex_data {
        let same = left.iter_mut().find(|q| q.is_some_and(|(n, _)| n == name));
        let quads = same.and_then(Option::take).map(|(_, v)| v.as_slice());
        names.push(name.as_str());
        columns.push(CellColumn { data, quads, hexes: Some(values) });
    }
    for (name, values) in left.into_iter().flatten() {
        names.push(name.as_str());
        columns.push(CellColumn { data, quads: Some(values), hexes: None });
    }
    runs(&names).into_iter().map(|(name, range)| (name, columns[range].to_vec())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn components_are_joined_and_single_names_stay() {
        let names = ["v:0", "v:1", "v:2", "a", "b:0", "c:1", "d:0", "d:2"];
        let found: Vec<(&str, usize)> = runs(&names).into_iter().map(|(n, r)| (n, r.len())).collect();
        assert_eq!(found, [("v", 3), ("a", 1), ("b:0", 1), ("c:1", 1), ("d:0", 1), ("d:2", 1)]);
    }
}
