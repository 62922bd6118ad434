//! What a format has no place for, said before it is lost.
//!
//! Source: ours.

use crate::data::{MeshData, TagOn};
use crate::format::Format;
use crate::formats::{inp, nastran, unv};
use crate::numbers::{NODE, NodeNumbers};

impl MeshData {
    /// What `format` would drop without refusing: tags and data it has no place for, one sentence each.
    ///
    /// # Example
    /// ```
    /// use hexfill_io::{Format, MeshData};
    ///
    /// let points = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    /// let mesh = MeshData { quad_tags: Some(vec![7]), ..MeshData::from_quads(points, vec![[0, 1, 2, 3]]) };
    /// assert!(mesh.losses(Format::Vtu).is_empty());
    /// assert_eq!(mesh.losses(Format::Off).len(), 1); // one sentence: tags of quads
    /// ```
    pub fn losses(&self, format: Format) -> Vec<String> {
        let mut losses = Vec::new();
        let mut lost = |is_lost: bool, what: &str| {
            if is_lost {
                losses.push(format!("{} does not carry {what}", format.title()));
            }
        };
        lost(self.point_tags.is_some() && !format.holds_point_tags(), "tags of points");
        lost(self.quad_tags.is_some() && !format.holds_cell_tags(), "tags of quads");
        lost(self.names_lost(format), "names of tags");
        let has_data = self.point_data.iter().any(|(name, _)| name != NODE || !self.are_numbers_written(format));
        lost(has_data && !format.holds_data(), "data on points");
        lost(!self.quad_data.is_empty() && !format.holds_data(), "data on quads");
        lost(!self.hex_data.is_empty() && !format.holds_data(), "data on hexes");
        let rounded = if format == Format::Nastran { nastran::rounded(self) } else { 0 };
        lost(rounded > 0, &format!("all digits of {rounded} points: its fields have 16 characters"));
        losses
    }

    /// Whether the numbers of the points are those that `format` writes.
    fn are_numbers_written(&self, format: Format) -> bool {
        let most = match format {
            Format::Inp => inp::MOST,
            Format::Nastran => nastran::MOST,
            Format::Unv => unv::MOST,
            _ => return false,
        };
        NodeNumbers::new(self, most).are_given()
    }

    /// Whether `format` has tags without a place for their names, or no tags.
    fn names_lost(&self, format: Format) -> bool {
        let held = |on| if on == TagOn::Points { format.holds_point_tags() } else { format.holds_cell_tags() };
        self.tag_names.iter().any(|n| !held(n.on))
    }
}
