//! Abaqus and CalculiX input: `*NODE`, `*ELEMENT`, `*ELSET`, `*NSET` and `*SURFACE`; everything else is passed over.
//!
//! Hexes are `C3D8`. Quads on hexes are faces S1 to S6 of these in surfaces, the first of which, `BOUNDARY`, has all of them in
//! their order; a shell there would carry load. Other quads are shells `S4`. Sets and surfaces are tags (see `groups`), those of
//! tags without a name are called `TAG_n`.
//!
//! Source: the Abaqus keywords guide; the CalculiX manual.

use crate::assembly::{Assembly, Slot};
use crate::data::{MeshData, TagOn};
use crate::error::{ReadError, snippet};
use crate::groups::{Combination, Groups, NONE};
use crate::numbers::Numbers;
use crate::orders::ABAQUS_FACES;
use crate::source::{Source, parse_integer};
use rustc_hash::FxHashMap;

mod write;

pub(crate) use write::{MOST, write};

/// The surface of all quads on hexes; not a name of a tag.
const BOUNDARY: &str = "BOUNDARY";

/// What element types are kept, and with how many corners.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Face(usize),
    Hex,
    Small(usize),
    Other,
}

/// The kind of an element type and its number of nodes, corners first.
fn kind_of(element_type: &str) -> (Kind, usize) {
    // The letters after the number of nodes choose an integration rule.
    let is = |names: &[&str]| {
        names.iter().any(|name| {
            element_type.strip_prefix(name).is_some_and(|rest| !rest.starts_with(|c: char| c.is_ascii_digit()))
        })
    };
    let kinds: [(Kind, usize, &[&str]); 13] = [
        (Kind::Hex, 8, &["C3D8", "DC3D8", "AC3D8"]),
        (Kind::Face(4), 4, &["S4", "SC4", "M3D4", "SFM3D4", "R3D4", "CPS4", "CPE4", "CAX4", "DC2D4", "DS4", "CPEG4"]),
        (Kind::Face(3), 3, &["S3", "STRI3", "M3D3", "SFM3D3", "R3D3", "CPS3", "CPE3", "CAX3", "DC2D3", "DS3"]),
        (Kind::Small(4), 4, &["C3D4", "DC3D4", "AC3D4"]),
        (Kind::Small(5), 5, &["C3D5", "DC3D5"]),
        (Kind::Small(6), 6, &["C3D6", "DC3D6", "AC3D6"]),
        (Kind::Hex, 20, &["C3D20", "DC3D20", "AC3D20"]),
        (Kind::Hex, 27, &["C3D27"]),
        (Kind::Face(4), 8, &["S8", "M3D8", "SFM3D8", "CPS8", "CPE8", "CAX8", "DC2D8", "DS8"]),
        (Kind::Face(4), 9, &["S9", "M3D9"]),
        (Kind::Face(3), 6, &["STRI65", "S6", "M3D6", "SFM3D6", "CPS6", "CPE6", "CAX6", "DC2D6", "DS6"]),
        (Kind::Small(4), 10, &["C3D10", "DC3D10", "AC3D10"]),
        (Kind::Small(6), 15, &["C3D15", "DC3D15", "AC3D15"]),
    ];
    if element_type == "S4R5" {
        return (Kind::Face(4), 4);
    }
    let found = kinds.iter().find(|(_, _, names)| is(names));
    found.map_or((Kind::Other, 0), |&(kind, n_nodes, _)| (kind, n_nodes))
}

/// The block of data lines that a keyword line opens.
enum Block {
    Nothing,
    Nodes,
    Elements {
        kind: (Kind, usize),
        name: String,
        set: Option<u32>,
    },
    ElementSet {
        set: u32,
        generate: bool,
    },
    NodeSet {
        set: u32,
        generate: bool,
    },
    /// Faces of elements; `None` is the surface of all quads.
    Surface {
        set: Option<u32>,
    },
}

/// A line of a surface: faces of one element, or of those in a set.
enum Side {
    Element(i64),
    Set(u32),
}

struct Reader<'r> {
    s: Source<'r>,
    out: Assembly,
    nodes: Numbers,
    elements: Numbers,
    slots: Vec<Slot>,
    /// Element sets and surfaces; the sets of each element.
    sets: Groups,
    of_element: Vec<Combination>,
    /// Node sets; those of each node.
    node_sets: Groups,
    of_node: Vec<Combination>,
    /// Names of sets in capitals, and as they were written first.
    spellings: FxHashMap<String, String>,
    /// Lines of surfaces: the surface, whose faces, and the number of the face.
    sides: Vec<(Option<u32>, Side, usize)>,
}

pub(crate) fn read(source: Source<'_>) -> Result<MeshData, ReadError> {
    let mut r = Reader {
        s: source.with_commas(),
        out: Assembly::default(),
        nodes: Numbers::default(),
        elements: Numbers::default(),
        slots: Vec::new(),
        sets: Groups::default(),
        of_element: Vec::new(),
        node_sets: Groups::default(),
        of_node: Vec::new(),
        spellings: FxHashMap::default(),
        sides: Vec::new(),
    };
    let mut block = Block::Nothing;
    let mut any = false;
    let mut keyword_seen = false;
    let mut parts = 0;
    while r.s.next_full_line()? {
        any = true;
        let line = r.s.line().trim_ascii();
        if line.starts_with(b"**") {
            continue;
        }
        if line.starts_with(b"*") {
            keyword_seen = true;
            let text = keyword_line(&mut r.s)?;
            block = open_block(&mut r, &text, &mut parts)?;
            continue;
        }
        if !keyword_seen {
            let given = snippet(line);
            let remedy = if line.first().is_some_and(u8::is_ascii_digit) {
                "this looks like AVS UCD, which is not read here: save it as VTK"
            } else {
                "is this an Abaqus or CalculiX file? name the format if the extension is wrong"
            };
            return Err(r.s.malformed_text("a keyword line `*...`", given, remedy));
        }
        match &block {
            Block::Nothing => {}
            Block::Nodes => read_node(&mut r)?,
            Block::Elements { kind, name, set } => read_element(&mut r, *kind, name, *set)?,
            Block::ElementSet { set, generate } => {
                let (set, generate) = (*set, *generate);
                read_members(&mut r, set, generate, true)?;
            }
            Block::NodeSet { set, generate } => {
                let (set, generate) = (*set, *generate);
                read_members(&mut r, set, generate, false)?;
            }
            Block::Surface { set } => {
                let set = *set;
                read_side(&mut r, set)?;
            }
        }
    }
    if !any {
        return Err(r.s.empty());
    }
    if r.out.point_count() == 0 {
        return Err(r.s.truncated("nodes (`*NODE`), found none"));
    }
    finish(r)
}

/// A keyword line with its continuations (lines that end in a comma go on).
fn keyword_line(s: &mut Source<'_>) -> Result<String, ReadError> {
    let mut text = String::from_utf8_lossy(s.line()).trim().to_owned();
    while text.ends_with(',') && s.next_line()? {
        if s.line().trim_ascii().starts_with(b"*") {
            s.unread_line();
            break;
        }
        text.push_str(String::from_utf8_lossy(s.line()).trim());
    }
    Ok(text)
}

fn open_block(r: &mut Reader<'_>, text: &str, parts: &mut u32) -> Result<Block, ReadError> {
    let mut words = text.split(',').map(str::trim);
    let keyword = words.next().unwrap_or_default().to_ascii_uppercase();
    let mut parameters = Vec::new();
    for word in words {
        let (name, value) = word.split_once('=').map_or((word, ""), |(n, v)| (n.trim(), v.trim()));
        parameters.push((name.to_ascii_uppercase(), value.trim_matches('"').to_owned()));
    }
    let get = |name: &str| parameters.iter().find(|(n, _)| n == name).map(|(_, v)| v.as_str());
    let outside = |r: &Reader<'_>| r.s.unsupported("data in another file (INPUT=)", "paste that file in here");
    Ok(match keyword.as_str() {
        "*NODE" => {
            if get("INPUT").is_some() {
                return Err(outside(r));
            }
            if *parts > 1 {
                let remedy = "flatten the assembly into one part, whose node numbers are all different";
                return Err(r.s.unsupported("a second part with nodes", remedy));
            }
            if get("SYSTEM").is_some_and(|s| !s.eq_ignore_ascii_case("R")) {
                return Err(r.s.unsupported("nodes in cylindrical or spherical coordinates", "export Cartesian ones"));
            }
            Block::Nodes
        }
        "*PART" => {
            if r.out.point_count() > 0 {
                *parts += 1;
            }
            *parts = (*parts).max(1);
            Block::Nothing
        }
        "*INCLUDE" => return Err(r.s.unsupported("`*INCLUDE` of another file", "paste that file in here")),
        "*ELEMENT" => {
            if get("INPUT").is_some() {
                return Err(outside(r));
            }
            let Some(name) = get("TYPE") else {
                let given = snippet(text.as_bytes());
                return Err(r.s.malformed_text("`TYPE=` of the elements", given, "add it, as in *ELEMENT, TYPE=C3D8"));
            };
            let name = name.to_ascii_uppercase();
            let set = get("ELSET").map(|set| r.element_set(set));
            Block::Elements { kind: kind_of(&name), name, set }
        }
        "*ELSET" => match get("ELSET") {
            Some(name) => Block::ElementSet { set: r.element_set(name), generate: get("GENERATE").is_some() },
            None => Block::Nothing,
        },
        "*NSET" => match get("NSET") {
            Some(name) => {
                let name = spelling(&mut r.spellings, name);
                Block::NodeSet { set: r.node_sets.named(&name), generate: get("GENERATE").is_some() }
            }
            None => Block::Nothing,
        },
        "*SURFACE" => match (get("NAME"), get("TYPE")) {
            (Some(name), kind) if kind.is_none_or(|k| k.eq_ignore_ascii_case("ELEMENT")) => {
                let all = name.eq_ignore_ascii_case(BOUNDARY);
                Block::Surface { set: (!all).then(|| r.element_set(name)) }
            }
            _ => Block::Nothing,
        },
        _ => Block::Nothing,
    })
}

/// The name as it was written first: names differ by more than capitals.
fn spelling(spellings: &mut FxHashMap<String, String>, name: &str) -> String {
    spellings.entry(name.to_ascii_uppercase()).or_insert_with(|| name.to_owned()).clone()
}

impl Reader<'_> {
    fn element_set(&mut self, name: &str) -> u32 {
        let name = spelling(&mut self.spellings, name);
        self.sets.named(&name)
    }
}

fn read_node(r: &mut Reader<'_>) -> Result<(), ReadError> {
    let span = r.s.need_word("a node number")?;
    let number = r.s.integer(span, "a node number")?;
    let mut point = [0.0; 3];
    for (k, axis) in ["x", "y", "z"].into_iter().enumerate() {
        match r.s.word() {
            Some(span) => point[k] = r.s.coordinate(span, axis)?,
            None if k == 2 => {} // a node in the plane
            None => {
                r.s.need_word(&format!("coordinate {axis}"))?;
            }
        }
    }
    if !r.nodes.push(number) {
        let given = format!("{number} twice");
        return Err(r.s.malformed_text("node numbers that differ", given, "renumber the nodes"));
    }
    r.out.mesh.points.push(point);
    Ok(())
}

fn read_element(
    r: &mut Reader<'_>,
    (kind, n_nodes): (Kind, usize),
    name: &str,
    set: Option<u32>,
) -> Result<(), ReadError> {
    let span = r.s.need_word("an element number")?;
    let number = r.s.integer(span, "an element number")?;
    let corners = match kind {
        Kind::Face(n) | Kind::Small(n) => n,
        Kind::Hex => 8,
        Kind::Other => 0,
    };
    let slot = if kind == Kind::Other {
        while r.s.line().trim_ascii_end().ends_with(b",") && r.s.next_full_line()? {}
        r.out.ignore(&format!("elements of type {name}"));
        Slot::Elsewhere
    } else {
        let mut nodes = Vec::with_capacity(8);
        while nodes.len() < n_nodes {
            let span = match r.s.word() {
                Some(span) => span,
                None if r.s.line().trim_ascii_end().ends_with(b",") && r.s.next_full_line()? => continue,
                None => {
                    let given = format!("{} nodes", nodes.len());
                    let expected = format!("{n_nodes} nodes of element {number} ({name})");
                    return Err(r.s.malformed_text(expected, given, "complete the line, or end it with a comma"));
                }
            };
            let node = r.s.integer(span, "a node number")?;
            nodes.push(r.nodes.get(node).ok_or_else(|| {
                let given = format!("{node}, which no node has");
                r.s.malformed_text("the number of a node given before", given, "correct it, or put *NODE first")
            })?);
        }
        if let Some(span) = r.s.peek_word() {
            return Err(r.s.malformed(format!("{n_nodes} nodes for {name}"), span, "correct the line or TYPE="));
        }
        let nodes = r.out.corners(&nodes, corners);
        match <[u32; 8]>::try_from(nodes) {
            Ok(hex) => r.out.hex(hex, 0),
            Err(_) if matches!(kind, Kind::Face(_)) => r.out.face(nodes, 0),
            Err(_) => {
                r.out.small_cell(nodes, 0);
                Slot::Elsewhere
            }
        }
    };
    r.elements.push(number);
    r.slots.push(slot);
    let of_element = set.map_or(NONE, |set| r.sets.join(NONE, set));
    r.of_element.push(of_element);
    Ok(())
}

/// The members of an element set or node set on the line: numbers, or names of sets given before.
fn read_members(r: &mut Reader<'_>, set: u32, generate: bool, elements: bool) -> Result<(), ReadError> {
    let mut range = Vec::new();
    while let Some(span) = r.s.word() {
        match parse_integer(r.s.text(span)) {
            Some(number) if generate => range.push(number),
            Some(number) => add_member(r, set, number, elements),
            None => {
                let name = spelling(&mut r.spellings, &String::from_utf8_lossy(r.s.text(span)));
                let (sets, of) = r.sets_of(elements);
                let other = sets.named(&name);
                for member in of.iter_mut() {
                    if sets.contains(*member, other) {
                        *member = sets.join(*member, set);
                    }
                }
            }
        }
    }
    if generate {
        let (Some(&first), Some(&last)) = (range.first(), range.get(1)) else {
            return Err(r.s.malformed_text("first, last and step", "less".to_owned(), "complete the line"));
        };
        let step = range.get(2).copied().unwrap_or(1);
        let known = r.slots.len().max(r.out.point_count()) as i64;
        if step < 1 || last.saturating_sub(first) / step > known.saturating_mul(64).saturating_add(1 << 20) {
            let given = format!("{first}, {last}, {step}");
            return Err(r.s.malformed_text("a range of numbers that exist", given, "correct the line"));
        }
        let mut number = first;
        while number <= last {
            add_member(r, set, number, elements);
            let Some(next) = number.checked_add(step) else { break };
            number = next;
        }
    }
    Ok(())
}

impl Reader<'_> {
    /// The sets of elements or of nodes, and which each is in.
    fn sets_of(&mut self, elements: bool) -> (&mut Groups, &mut Vec<Combination>) {
        if elements {
            return (&mut self.sets, &mut self.of_element);
        }
        self.of_node.resize(self.out.mesh.points.len(), NONE);
        (&mut self.node_sets, &mut self.of_node)
    }
}

/// Numbers that nothing has are passed over.
fn add_member(r: &mut Reader<'_>, set: u32, number: i64, elements: bool) {
    let place = if elements { r.elements.get(number) } else { r.nodes.get(number) };
    let (sets, of) = r.sets_of(elements);
    if let Some(place) = place {
        of[place as usize] = sets.join(of[place as usize], set);
    }
}

/// A line of a surface: an element or a set, and one of its faces.
fn read_side(r: &mut Reader<'_>, surface: Option<u32>) -> Result<(), ReadError> {
    let span = r.s.need_word("an element or a set")?;
    let whose = match parse_integer(r.s.text(span)) {
        Some(number) => Side::Element(number),
        None => {
            let name = String::from_utf8_lossy(r.s.text(span)).into_owned();
            Side::Set(r.element_set(&name))
        }
    };
    let side = r.s.word().map(|span| r.s.string(span).to_ascii_uppercase()).unwrap_or_default();
    match side.strip_prefix('S').and_then(|n| n.parse::<usize>().ok()) {
        Some(side @ 1..=6) => r.sides.push((surface, whose, side - 1)),
        // Both sides of a shell are the shell.
        _ if side == "SPOS" || side == "SNEG" => r.sides.push((surface, whose, 0)),
        _ => r.out.ignore("lines of surfaces without a face S1 to S6"),
    }
    Ok(())
}

/// The faces of elements that surfaces name: faces of the file where there are such, new ones on hexes otherwise.
fn place_sides(r: &mut Reader<'_>) {
    let key = |mut quad: [u32; 4]| {
        quad.sort_unstable();
        quad
    };
    let mut known: FxHashMap<[u32; 4], usize> = FxHashMap::default();
    if !r.sides.is_empty() {
        let quads = r.slots.iter().enumerate().filter_map(|(e, slot)| match slot {
            Slot::Quad(q) => Some((key(r.out.mesh.quads[*q as usize]), e)),
            _ => None,
        });
        known.extend(quads);
    }
    let n_elements = r.slots.len();
    for (surface, whose, side) in std::mem::take(&mut r.sides) {
        let members: Vec<usize> = match whose {
            Side::Element(number) => r.elements.get(number).map(|e| e as usize).into_iter().collect(),
            Side::Set(set) => (0..n_elements).filter(|&e| r.sets.contains(r.of_element[e], set)).collect(),
        };
        for element in members {
            let face = match r.slots[element] {
                Slot::Hex(h) => {
                    let quad = ABAQUS_FACES[side].map(|i| r.out.mesh.hexes[h as usize][i]);
                    *known.entry(key(quad)).or_insert_with(|| {
                        r.slots.push(r.out.quad(quad, 0));
                        r.of_element.push(NONE);
                        r.slots.len() - 1
                    })
                }
                Slot::Quad(_) | Slot::OtherFace(_) => element,
                Slot::Elsewhere => continue,
            };
            if let Some(surface) = surface {
                r.of_element[face] = r.sets.join(r.of_element[face], surface);
            }
        }
    }
}

fn finish(mut r: Reader<'_>) -> Result<MeshData, ReadError> {
    place_sides(&mut r);
    r.out.tag_by_groups(&r.slots, &r.of_element, &r.sets);
    r.of_node.resize(r.out.mesh.points.len(), NONE);
    let tags = r.node_sets.tags(r.of_node.iter().copied());
    r.out.point_tags = r.of_node.iter().map(|&c| tags.of(c)).collect();
    r.out.name_tags(tags.names(TagOn::Points));
    let mut mesh = r.out.finish();
    r.nodes.keep(&mut mesh);
    Ok(mesh)
}
