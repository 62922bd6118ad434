//! Physical groups: names and tags as Gmsh has them.
//!
//! Source: the Gmsh manual, "MSH file format".

use super::common::{UNTAGGED, dimension, elements};
use crate::data::{MeshData, TagOn};
use crate::groups::carried;
use crate::write::unquoted;
use std::collections::BTreeMap;
use std::io::{self, Write};

/// The physical groups of a mesh, per dimension and tag.
pub(crate) struct Physical {
    /// Numbers of the groups of each tag.
    numbers: BTreeMap<(u8, i64), Vec<i64>>,
    /// Names of groups.
    names: BTreeMap<(u8, i64), String>,
}

impl Physical {
    /// A tag is a group of its number; a tag with several names is in a group for each of them, if `overlap` is possible,
    /// otherwise its group has all the names. With `everywhere` what has no tag is in a group, too, where others have one:
    /// meshio reads no mesh whose elements are partly in groups.
    pub(crate) fn new(data: &MeshData, overlap: bool, everywhere: bool) -> Self {
        let tags: std::collections::BTreeSet<(u8, i64)> =
            elements(data).map(|(t, _, tag)| (dimension(t), tag)).collect();
        let mut physical = Self { numbers: BTreeMap::new(), names: BTreeMap::new() };
        // The group of a name is the tag that has no other name.
        let mut group_of: BTreeMap<(u8, &str), i64> = BTreeMap::new();
        let all_names = data.names_by_tag();
        let named = |dim: u8, tag: i64| {
            let on = if dim == 2 { TagOn::Faces } else { TagOn::Cells };
            all_names.get(&(on, tag)).into_iter().flatten().copied()
        };
        for &(dim, tag) in &tags {
            let names: Vec<&str> = named(dim, tag).collect();
            if let [name] = names[..]
                && carried(name).is_none()
            {
                group_of.entry((dim, name)).or_insert(tag);
            }
            if !names.is_empty() && (names.len() == 1 || !overlap) {
                physical.names.insert((dim, tag), names.join("+"));
            }
        }
        let mut next = tags.iter().map(|&(_, tag)| tag).max().unwrap_or(0).max(0);
        let mut fresh = || {
            next += 1;
            next
        };
        for &(dim, tag) in tags.iter().filter(|(_, tag)| *tag != 0) {
            let names: Vec<&str> = named(dim, tag).collect();
            let mut numbers = Vec::new();
            // The number of the tag itself goes to the first name that has no other.
            let mut own = Some(tag);
            for name in names.into_iter().filter(|_| overlap) {
                let number = || own.take().unwrap_or_else(&mut fresh);
                numbers.push(carried(name).unwrap_or_else(|| *group_of.entry((dim, name)).or_insert_with(number)));
            }
            if numbers.is_empty() {
                numbers.push(tag);
            }
            physical.numbers.insert((dim, tag), numbers);
        }
        for ((dim, name), number) in group_of {
            physical.names.entry((dim, number)).or_insert_with(|| name.to_owned());
        }
        if everywhere && tags.iter().any(|&(_, tag)| tag != 0) {
            for &(dim, _) in tags.iter().filter(|(_, tag)| *tag == 0) {
                let number = fresh();
                physical.numbers.insert((dim, 0), vec![number]);
                physical.names.insert((dim, number), UNTAGGED.to_owned());
            }
        }
        physical
    }

    /// The groups of a tag.
    pub(crate) fn of(&self, dim: u8, tag: i64) -> &[i64] {
        self.numbers.get(&(dim, tag)).map_or(&[], Vec::as_slice)
    }

    /// The section with the names.
    pub(crate) fn write_names(&self, out: &mut dyn Write) -> io::Result<()> {
        if self.names.is_empty() {
            return Ok(());
        }
        writeln!(out, "$PhysicalNames\n{}", self.names.len())?;
        for ((dim, number), name) in &self.names {
            writeln!(out, "{dim} {number} \"{}\"", unquoted(name))?;
        }
        writeln!(out, "$EndPhysicalNames")
    }
}
