//! Abaqus and CalculiX input: `*NODE`, `*ELEMENT`, `*ELSET` and `*NSET`; everything else is passed over.
//!
//! Hexes are `C3D8`, quads are `S4`. Tags are element sets `TAG_n` (see `names`); the set on the `*ELEMENT` line comes first,
//! then `*ELSET` lists in their order. Tags of points are node sets `TAG_n`; node sets with other names are passed over.

use crate::assembly::{Assembly, Slot};
use crate::data::MeshData;
use crate::error::{ReadError, snippet};
use crate::formats::msh::Numbers;
use crate::names::{Names, name_of};
use crate::source::{Source, parse_integer};
use crate::write::write_point;
use std::io::{self, Write};

/// What element types are kept, and with how many nodes.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Face(usize),
    Hex,
    Small(usize),
    Other,
}

fn kind_of(element_type: &str) -> Kind {
    // The letters after the number of nodes choose an integration rule.
    let is = |names: &[&str]| {
        names.iter().any(|name| {
            element_type.strip_prefix(name).is_some_and(|rest| !rest.starts_with(|c: char| c.is_ascii_digit()))
        })
    };
    if is(&["C3D8", "DC3D8", "AC3D8"]) {
        Kind::Hex
    } else if is(&["S4", "SC4", "M3D4", "SFM3D4", "R3D4", "CPS4", "CPE4", "CAX4", "DC2D4", "DS4", "CPEG4"])
        || element_type == "S4R5"
    {
        Kind::Face(4)
    } else if is(&["S3", "STRI3", "M3D3", "SFM3D3", "R3D3", "CPS3", "CPE3", "CAX3", "DC2D3", "DS3"]) {
        Kind::Face(3)
    } else if is(&["C3D4", "DC3D4", "AC3D4"]) {
        Kind::Small(4)
    } else if is(&["C3D5", "DC3D5"]) {
        Kind::Small(5)
    } else if is(&["C3D6", "DC3D6", "AC3D6"]) {
        Kind::Small(6)
    } else {
        Kind::Other
    }
}

/// The block of data lines that a keyword line opens.
enum Block {
    Nothing,
    Nodes,
    Elements { kind: Kind, name: String, set: Option<usize> },
    ElementSet { set: usize, generate: bool },
    NodeSet { tag: i64, generate: bool },
}

struct Reader<'r> {
    s: Source<'r>,
    out: Assembly,
    nodes: Numbers,
    elements: Numbers,
    slots: Vec<Slot>,
    /// Per element: stand-in of its set + 1.
    sets: Vec<usize>,
    names: Names,
}

pub(crate) fn read(source: Source<'_>) -> Result<MeshData, ReadError> {
    let mut r = Reader {
        s: source.with_commas(),
        out: Assembly::default(),
        nodes: Numbers::default(),
        elements: Numbers::default(),
        slots: Vec::new(),
        sets: Vec::new(),
        names: Names::default(),
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
                each_member(&mut r, generate, |r, number| {
                    if let Some(element) = r.elements.get(number) {
                        let slot = &mut r.sets[element as usize];
                        if *slot == 0 {
                            *slot = set + 1;
                        }
                    }
                })?;
            }
            Block::NodeSet { tag, generate } => {
                let (tag, generate) = (*tag, *generate);
                each_member(&mut r, generate, |r, number| {
                    if let Some(node) = r.nodes.get(number) {
                        r.out.point_tags.resize(r.out.mesh.points.len(), 0);
                        r.out.point_tags[node as usize] = tag;
                    }
                })?;
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
            let set = get("ELSET").map(|set| r.names.stand_in(&set.to_ascii_uppercase()));
            Block::Elements { kind: kind_of(&name), name, set }
        }
        "*ELSET" => match get("ELSET") {
            Some(name) => {
                let set = r.names.stand_in(&name.to_ascii_uppercase());
                Block::ElementSet { set, generate: get("GENERATE").is_some() }
            }
            None => Block::Nothing,
        },
        "*NSET" => {
            let name = get("NSET").map(str::to_ascii_lowercase).unwrap_or_default();
            match name.strip_prefix("tag_").and_then(|n| n.parse().ok()) {
                Some(tag) => Block::NodeSet { tag, generate: get("GENERATE").is_some() },
                None => Block::Nothing,
            }
        }
        _ => Block::Nothing,
    })
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

fn read_element(r: &mut Reader<'_>, kind: Kind, name: &str, set: Option<usize>) -> Result<(), ReadError> {
    let span = r.s.need_word("an element number")?;
    let number = r.s.integer(span, "an element number")?;
    let n_nodes = match kind {
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
        match <[u32; 8]>::try_from(nodes.as_slice()) {
            Ok(hex) => r.out.hex(hex, 0),
            Err(_) if matches!(kind, Kind::Face(_)) => r.out.face(&nodes, 0),
            Err(_) => {
                r.out.small_cell(&nodes, 0);
                Slot::Elsewhere
            }
        }
    };
    r.elements.push(number);
    r.slots.push(slot);
    r.sets.push(set.map_or(0, |s| s + 1));
    Ok(())
}

/// Calls `take` for each number on the line; names of other sets are passed over.
fn each_member(
    r: &mut Reader<'_>,
    generate: bool,
    mut take: impl FnMut(&mut Reader<'_>, i64),
) -> Result<(), ReadError> {
    let mut range = Vec::new();
    while let Some(span) = r.s.word() {
        match parse_integer(r.s.text(span)) {
            Some(number) if generate => range.push(number),
            Some(number) => take(r, number),
            None => r.out.ignore("references to sets in sets"),
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
            take(r, number);
            let Some(next) = number.checked_add(step) else { break };
            number = next;
        }
    }
    Ok(())
}

fn finish(mut r: Reader<'_>) -> Result<MeshData, ReadError> {
    r.out.point_tags.resize(r.out.mesh.points.len(), 0);
    // A set counts if a face or hex is in it; if one nameless set holds everything it says nothing.
    let mut used = vec![false; r.sets.iter().max().map_or(0, |&s| s)];
    let mut kinds = [false; 2];
    for (&slot, &set) in r.slots.iter().zip(&r.sets) {
        if slot != Slot::Elsewhere {
            kinds[usize::from(matches!(slot, Slot::Hex(_)))] = true;
            if set > 0 {
                used[set - 1] = true;
            }
        }
    }
    let (tags, notes) = r.names.tags(&used, "element set");
    let sets_used = used.iter().filter(|&&u| u).count();
    let nameless = notes.len() == sets_used;
    let one_each = sets_used <= kinds.iter().filter(|&&k| k).count();
    if !(nameless && one_each) {
        for (&slot, &set) in r.slots.iter().zip(&r.sets) {
            if set > 0 && slot != Slot::Elsewhere {
                r.out.set_tag(slot, tags[set - 1]);
            }
        }
        notes.into_iter().for_each(|n| r.out.note(n));
    }
    Ok(r.out.finish())
}

pub(crate) fn write(out: &mut dyn Write, data: &MeshData) -> io::Result<()> {
    writeln!(out, "*HEADING\nhexfill: {} hexes, {} faces", data.hexes.len(), data.face_count())?;
    writeln!(out, "*NODE")?;
    for (i, point) in data.points.iter().enumerate() {
        write!(out, "{}, ", i + 1)?;
        write_point(out, point, ", ")?;
        out.write_all(b"\n")?;
    }
    let faces = data.tagged_faces().map(|(f, tag)| (if f.len() == 3 { "S3" } else { "S4" }, f, tag));
    let hexes = data.hexes.iter().enumerate().map(|(h, hex)| ("C3D8", hex.as_slice(), data.hex_tag(h)));
    let tets = data.tets.iter().map(|c| ("C3D4", c.as_slice(), 0));
    let wedges = data.wedges.iter().map(|c| ("C3D6", c.as_slice(), 0));
    let pyramids = data.pyramids.iter().map(|c| ("C3D5", c.as_slice(), 0));
    let mut block = None;
    let mut tags = Vec::new();
    for (i, (element_type, nodes, tag)) in faces.chain(hexes).chain(tets).chain(wedges).chain(pyramids).enumerate() {
        if block != Some(element_type) {
            block = Some(element_type);
            writeln!(out, "*ELEMENT, TYPE={element_type}")?;
        }
        write!(out, "{}", i + 1)?;
        for &node in nodes {
            write!(out, ", {}", u64::from(node) + 1)?;
        }
        out.write_all(b"\n")?;
        tags.push(tag);
    }
    // Each set once: meshio forgets all but the last part of a set that is spread over several blocks.
    write_sets(out, "ELSET", &tags)?;
    write_sets(out, "NSET", data.point_tags.as_deref().unwrap_or_default())
}

/// Lists of the members (counted from 1) of each tag but 0.
fn write_sets(out: &mut dyn Write, keyword: &str, tags: &[i64]) -> io::Result<()> {
    let mut sorted: Vec<(i64, usize)> = tags.iter().copied().zip(1..).filter(|&(tag, _)| tag != 0).collect();
    sorted.sort_unstable();
    for set in sorted.chunk_by(|a, b| a.0 == b.0) {
        writeln!(out, "*{keyword}, {keyword}={}", name_of(set[0].0).to_ascii_uppercase())?;
        for line in set.chunks(8) {
            let numbers: Vec<String> = line.iter().map(|(_, i)| i.to_string()).collect();
            writeln!(out, "{}", numbers.join(", "))?;
        }
    }
    Ok(())
}
