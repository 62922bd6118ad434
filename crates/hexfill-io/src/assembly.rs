//! [`Assembly`]: what the readers put points, faces and cells into.
//!
//! It keeps faces in order, sorts cells by kind, hands the arrays given "per cell of the file" to those cells they
//! belong to, counts what is passed over, and turns an array of zeros back into "no tags".
//!
//! Source: ours.

use crate::arrays::component;
use crate::data::{MeshData, OtherFace, TagName, TagOn};
use crate::groups::{Combination, Groups, NONE};
use rustc_hash::FxHashSet;
use std::collections::BTreeMap;

/// Where a cell of the file went.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Slot {
    Quad(u32),
    OtherFace(u32),
    Hex(u32),
    /// Another kind of cell, whose tag is not kept.
    Elsewhere,
}

/// An array read from a file, one value per point or cell.
#[derive(Clone, Debug)]
pub(crate) enum Values {
    Whole(Vec<i64>),
    Real(Vec<f64>),
}

impl Values {
    pub(crate) fn len(&self) -> usize {
        match self {
            Self::Whole(v) => v.len(),
            Self::Real(v) => v.len(),
        }
    }

    /// The values as tags, if all of them are whole numbers.
    fn as_tags(&self) -> Option<Vec<i64>> {
        const EXACT: f64 = 9_007_199_254_740_992.0; // 2^53
        match self {
            Self::Whole(v) => Some(v.clone()),
            Self::Real(v) => v.iter().map(|&x| (x.fract() == 0.0 && x.abs() <= EXACT).then_some(x as i64)).collect(),
        }
    }

    fn real(&self, i: usize) -> f64 {
        match self {
            Self::Whole(v) => v[i] as f64,
            Self::Real(v) => v[i],
        }
    }
}

/// Names under which tags are stored as a data array, our own first; the earlier one wins.
const TAG_NAMES: [&str; 9] =
    ["tag", "tags", "gmsh:physical", "medit:ref", "CellEntityIds", "MaterialIds", "material", "label", "attribute"];

/// The names of the components of an array: its own if there is one component.
fn columns(name: &str, components: usize) -> impl Iterator<Item = (String, usize)> + '_ {
    (0..components).map(move |k| (if components == 1 { name.to_owned() } else { component(name, k) }, k))
}

fn tag_rank(name: &str) -> Option<usize> {
    TAG_NAMES.iter().position(|n| n.eq_ignore_ascii_case(name))
}

/// A mesh under construction.
#[derive(Default)]
pub(crate) struct Assembly {
    pub(crate) mesh: MeshData,
    pub(crate) point_tags: Vec<i64>,
    quad_tags: Vec<i64>,
    hex_tags: Vec<i64>,
    /// The tags of points (cells) have come from a data array of this rank.
    point_rank: Option<usize>,
    cell_rank: Option<usize>,
    ignored: BTreeMap<String, u64>,
    lost_tags: u64,
}

impl Assembly {
    /// Number of points so far.
    pub(crate) fn point_count(&self) -> usize {
        self.mesh.points.len()
    }

    /// Adds a face with three sides or more.
    pub(crate) fn face(&mut self, vertices: &[u32], tag: i64) -> Slot {
        if let Ok(quad) = <[u32; 4]>::try_from(vertices) {
            return self.quad(quad, tag);
        }
        let position = self.mesh.face_count();
        self.mesh.other_faces.push(OtherFace { position, vertices: vertices.to_vec(), tag });
        Slot::OtherFace(self.mesh.other_faces.len() as u32 - 1)
    }

    pub(crate) fn quad(&mut self, quad: [u32; 4], tag: i64) -> Slot {
        self.mesh.quads.push(quad);
        self.quad_tags.push(tag);
        Slot::Quad(self.mesh.quads.len() as u32 - 1)
    }

    pub(crate) fn hex(&mut self, hex: [u32; 8], tag: i64) -> Slot {
        self.mesh.hexes.push(hex);
        self.hex_tags.push(tag);
        Slot::Hex(self.mesh.hexes.len() as u32 - 1)
    }

    /// Adds a tetrahedron, pyramid or wedge, told by its number of nodes; false for any other number.
    pub(crate) fn small_cell(&mut self, nodes: &[u32], tag: i64) -> bool {
        if let Ok(tet) = <[u32; 4]>::try_from(nodes) {
            self.mesh.tets.push(tet);
        } else if let Ok(pyramid) = <[u32; 5]>::try_from(nodes) {
            self.mesh.pyramids.push(pyramid);
        } else if let Ok(wedge) = <[u32; 6]>::try_from(nodes) {
            self.mesh.wedges.push(wedge);
        } else {
            return false;
        }
        self.lost_tags += u64::from(tag != 0);
        true
    }

    /// The corners of a cell, of which there are `corners`; the other nodes of one of higher order lie between them.
    pub(crate) fn corners<'n>(&mut self, nodes: &'n [u32], corners: usize) -> &'n [u32] {
        let (corners, middles) = nodes.split_at(corners.min(nodes.len()));
        self.mesh.middles.extend_from_slice(middles);
        corners
    }

    /// Counts something that is passed over.
    pub(crate) fn ignore(&mut self, what: &str) {
        self.ignore_many(what, 1);
    }

    pub(crate) fn ignore_many(&mut self, what: &str, count: u64) {
        if count == 0 {
            return;
        }
        if let Some(n) = self.ignored.get_mut(what) {
            *n += count;
        } else {
            self.ignored.insert(what.to_owned(), count);
        }
    }

    pub(crate) fn note(&mut self, note: impl Into<String>) {
        self.mesh.notes.push(note.into());
    }

    /// The tag of a cell already added.
    pub(crate) fn tag(&self, slot: Slot) -> i64 {
        match slot {
            Slot::Quad(i) => self.quad_tags[i as usize],
            Slot::OtherFace(i) => self.mesh.other_faces[i as usize].tag,
            Slot::Hex(i) => self.hex_tags[i as usize],
            Slot::Elsewhere => 0,
        }
    }

    pub(crate) fn set_tag(&mut self, slot: Slot, tag: i64) {
        match slot {
            Slot::Quad(i) => self.quad_tags[i as usize] = tag,
            Slot::OtherFace(i) => self.mesh.other_faces[i as usize].tag = tag,
            Slot::Hex(i) => self.hex_tags[i as usize] = tag,
            Slot::Elsewhere => self.lost_tags += u64::from(tag != 0),
        }
    }

    /// Takes an array over the points with its values point by point: tags if its name says so, data otherwise.
    pub(crate) fn point_array(&mut self, name: &str, components: usize, values: &Values) {
        let n = self.point_count();
        if components == 0 || values.len() != n.saturating_mul(components) {
            let given = values.len();
            self.note(format!("point array `{name}` has {given} values for {n} points: not kept"));
            return;
        }
        if components == 1
            && let (Some(rank), Some(tags)) = (tag_rank(name), values.as_tags())
            && self.point_rank.is_none_or(|r| rank < r)
        {
            self.point_rank = Some(rank);
            self.point_tags = tags;
            return;
        }
        for (name, k) in columns(name, components) {
            self.mesh.point_data.push((name, (0..n).map(|i| values.real(i * components + k)).collect()));
        }
    }

    /// Takes an array over the cells of the file, whose places are `slots`.
    pub(crate) fn cell_array(&mut self, name: &str, components: usize, values: &Values, slots: &[Slot]) {
        if components == 0 || values.len() != slots.len().saturating_mul(components) {
            let (given, n) = (values.len(), slots.len());
            self.note(format!("cell array `{name}` has {given} values for {n} cells: not kept"));
            return;
        }
        if components == 1
            && let (Some(rank), Some(tags)) = (tag_rank(name), values.as_tags())
            && self.cell_rank.is_none_or(|r| rank < r)
        {
            self.cell_rank = Some(rank);
            for (&slot, &tag) in slots.iter().zip(&tags) {
                self.set_tag(slot, tag);
            }
            if rank > 0 {
                self.note(format!("cell array `{name}` is read as tags"));
            }
            return;
        }
        let mut on_quads = vec![f64::NAN; self.mesh.quads.len() * components];
        let mut on_hexes = vec![f64::NAN; self.mesh.hexes.len() * components];
        let mut elsewhere = 0u64;
        for (i, &slot) in slots.iter().enumerate() {
            let from = i * components;
            let to = match slot {
                Slot::Quad(q) => &mut on_quads[q as usize * components..][..components],
                Slot::Hex(h) => &mut on_hexes[h as usize * components..][..components],
                Slot::OtherFace(_) | Slot::Elsewhere => {
                    elsewhere += u64::from((0..components).any(|k| !values.real(from + k).is_nan()));
                    continue;
                }
            };
            to.iter_mut().enumerate().for_each(|(k, x)| *x = values.real(from + k));
        }
        if elsewhere > 0 {
            self.note(format!(
                "cell array `{name}`: values on {elsewhere} cells other than quads and hexes are not kept"
            ));
        }
        // An array over hexes alone fills the quads with NaN, and the other way round.
        let filled = |v: &[f64]| v.iter().any(|x| !x.is_nan());
        let (quads, hexes) = slots.iter().fold((false, false), |(quads, hexes), slot| {
            (quads || matches!(slot, Slot::Quad(_)), hexes || matches!(slot, Slot::Hex(_)))
        });
        let quads_too = filled(&on_quads) || (quads && !hexes);
        let hexes_too = filled(&on_hexes) || (hexes && !quads_too);
        let column = |v: &[f64], k: usize| v.iter().skip(k).step_by(components).copied().collect();
        for (name, k) in columns(name, components) {
            if quads_too {
                self.mesh.quad_data.push((name.clone(), column(&on_quads, k)));
            }
            if hexes_too {
                self.mesh.hex_data.push((name, column(&on_hexes, k)));
            }
        }
    }

    /// The mesh has names for some of its tags.
    pub(crate) fn name_tags(&mut self, names: impl Iterator<Item = TagName>) {
        self.mesh.tag_names.extend(names);
    }

    /// An array of the file as a whole: names of tags if it is pairs of a tag and a dimension, otherwise passed over.
    pub(crate) fn field(&mut self, name: &str, components: usize, values: &Values) {
        let Values::Whole(values) = values else { return };
        let named =
            |row: &[i64]| Some(TagName { on: TagOn::from_dimension(row[1])?, tag: row[0], name: name.to_owned() });
        let pairs = components == 2 || (components == 1 && values.len() == 2);
        if pairs && values.len().is_multiple_of(2) {
            let names: Option<Vec<TagName>> = values.chunks_exact(2).map(named).collect();
            self.name_tags(names.unwrap_or_default().into_iter());
        }
    }

    /// Faces and cells have the tags of their combinations of groups, with the names of those.
    pub(crate) fn tag_by_groups(&mut self, slots: &[Slot], combinations: &[Combination], groups: &Groups) {
        let placed = || slots.iter().copied().zip(combinations.iter().copied()).filter(|(s, _)| *s != Slot::Elsewhere);
        self.mesh.notes.extend(groups.note());
        let tags = groups.tags(placed().map(|(_, c)| c));
        let mut on = [FxHashSet::default(), FxHashSet::default()];
        for (slot, combination) in placed().filter(|(_, c)| *c != NONE) {
            self.set_tag(slot, tags.of(combination));
            on[usize::from(matches!(slot, Slot::Hex(_)))].insert(tags.of(combination));
        }
        for (kind, used) in [TagOn::Faces, TagOn::Cells].into_iter().zip(&on) {
            self.name_tags(tags.names(kind).filter(|n| used.contains(&n.tag)));
        }
    }

    /// A point is in the middle only if it is a corner of nothing.
    fn sort_middles(&mut self) {
        let mesh = &mut self.mesh;
        if mesh.middles.is_empty() {
            return;
        }
        let mut corner = vec![false; mesh.points.len()];
        let faces = mesh.quads.iter().flatten().chain(mesh.other_faces.iter().flat_map(|f| &f.vertices));
        let cells = mesh.hexes.iter().flatten().chain(mesh.tets.iter().flatten());
        let rest = mesh.wedges.iter().flatten().chain(mesh.pyramids.iter().flatten());
        faces.chain(cells).chain(rest).for_each(|&v| corner[v as usize] = true);
        mesh.middles.retain(|&v| !corner[v as usize]);
        mesh.middles.sort_unstable();
        mesh.middles.dedup();
    }

    /// The finished mesh.
    pub(crate) fn finish(mut self) -> MeshData {
        let some = |tags: Vec<i64>, n: usize| (tags.len() == n && tags.iter().any(|&t| t != 0)).then_some(tags);
        self.sort_middles();
        self.mesh.tag_names.retain(|n| n.tag != 0);
        self.mesh.tag_names.sort_by_key(|n| (n.on, n.tag));
        self.mesh.tag_names.dedup();
        self.mesh.point_tags = some(self.point_tags, self.mesh.points.len());
        self.mesh.quad_tags = some(self.quad_tags, self.mesh.quads.len());
        self.mesh.hex_tags = some(self.hex_tags, self.mesh.hexes.len());
        for (what, count) in &self.ignored {
            self.mesh.notes.push(format!("{count} {what} ignored"));
        }
        if self.lost_tags > 0 {
            self.mesh.notes.push(format!("tags of {} tetrahedra, wedges or pyramids are not kept", self.lost_tags));
        }
        self.mesh
    }
}
