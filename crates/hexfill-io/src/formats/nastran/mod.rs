//! Nastran bulk data: `GRID`, `CQUAD4`, `CHEXA` and their like; everything else is passed over.
//!
//! Fields are 8 columns wide, 16 where the name of a card or a continuation ends (begins) with `*`, or stand between commas. Cards go on in lines
//! whose first field is empty or begins with `+` or `*`. The property of an element is its tag, since it is what boundary conditions and materials hang
//! on; its name is taken from comments of HyperMesh, ANSA and this program. Elements may come before the points they use.
//!
//! Source: the Nastran guide.

mod card;
mod write;

use crate::assembly::{Assembly, Slot};
use crate::data::MeshData;
use crate::error::{ReadError, snippet};
use crate::groups::{Combination, Groups, NONE};
use crate::numbers::Numbers;
use crate::source::{Source, parse_integer};
use card::{Card, parse_real};
use rustc_hash::FxHashMap;

pub(crate) use write::{MOST, rounded, write};

/// How comments begin that say which tag a property stands for, where they differ.
const PROPERTY_LINE: &str = "hexfill: property";

/// An element: corners, and all nodes that it may have.
#[derive(Clone, Copy)]
struct Kind {
    corners: usize,
    nodes: usize,
    is_face: bool,
}

/// The element of a card.
fn kind_of(name: &[u8]) -> Option<Kind> {
    // meshio 5.3.5 writes CHEXA_ and the like for cells of higher order.
    let (corners, nodes, is_face) = match name.strip_suffix(b"_").unwrap_or(name) {
        b"CQUAD4" | b"CQUADR" => (4, 4, true),
        b"CQUAD8" => (4, 8, true),
        b"CTRIA3" | b"CTRIAR" => (3, 3, true),
        b"CTRIA6" => (3, 6, true),
        b"CQUAD9" => (4, 9, true),
        b"CHEXA" => (8, 27, false),
        b"CTETRA" => (4, 10, false),
        b"CPENTA" => (6, 15, false),
        b"CPYRAM" | b"CPYRA" => (5, 13, false),
        _ => return None,
    };
    Some(Kind { corners, nodes, is_face })
}

/// Elements that are counted when they are passed over.
const PASSED_OVER: [&[u8]; 12] = [
    b"CBAR", b"CBEAM", b"CROD", b"CONROD", b"CTUBE", b"CBUSH", b"CSHEAR", b"CELAS1", b"CELAS2", b"RBE2", b"RBE3",
    b"CQUAD",
];

/// An element whose points may not be known yet.
struct Element {
    kind: Kind,
    line: u64,
    /// Where its nodes begin, and how many there are.
    first: usize,
    n_nodes: usize,
    group: Combination,
}

struct Reader<'r> {
    s: Source<'r>,
    out: Assembly,
    numbers: Numbers,
    elements: Vec<Element>,
    nodes: Vec<i64>,
    properties: Groups,
    /// Tags of properties that have others.
    tags: FxHashMap<i64, i64>,
    /// The first line of the current card.
    line: u64,
}

impl Reader<'_> {
    /// An error of the current card.
    fn malformed(&self, expected: impl Into<String>, given: String, remedy: &str) -> ReadError {
        let at = self.s.place_at_line(self.line);
        ReadError::Malformed { at, expected: expected.into(), given, remedy: remedy.to_owned() }
    }
}

pub(crate) fn read(source: Source<'_>) -> Result<MeshData, ReadError> {
    let mut r = Reader {
        s: source.with_comments(b'$'),
        out: Assembly::default(),
        numbers: Numbers::default(),
        elements: Vec::new(),
        nodes: Vec::new(),
        properties: Groups::default(),
        tags: FxHashMap::default(),
        line: 0,
    };
    let mut card = Card::default();
    let (mut first, mut known): (Option<Vec<u8>>, bool) = (None, false);
    while r.s.next_line()? {
        if let Some(text) = r.s.line().trim_ascii_start().strip_prefix(b"$") {
            if let Some((number, name)) = name_in_comment(text) {
                r.properties.set_name(number, &name);
            } else if let Some((number, tag)) = tag_in_comment(text) {
                r.tags.insert(number, tag);
            }
            continue;
        }
        if r.s.line().trim_ascii().is_empty() {
            continue;
        }
        if first.is_none() {
            first = Some(r.s.line().to_vec());
        }
        let head = r.s.line().trim_ascii_start().to_ascii_uppercase();
        if head.starts_with(b"ENDDATA") {
            known = true;
            break;
        }
        if head.starts_with(b"INCLUDE") {
            return Err(r.s.unsupported("`INCLUDE` of another file", "paste that file in here"));
        }
        known |= head.starts_with(b"BEGIN") || head.starts_with(b"CEND") || head.starts_with(b"SOL ");
        r.line = r.s.line_number();
        card.begin(&r.s);
        known |= read_card(&mut r, &mut card)?;
    }
    let Some(first) = first else { return Err(r.s.empty()) };
    if r.out.point_count() == 0 {
        if !known {
            let given = snippet(&first);
            let remedy = "is this a Nastran file? name the format if the extension is wrong";
            return Err(r.s.malformed_text("a bulk data card such as GRID", given, remedy));
        }
        return Err(r.s.truncated("points (GRID), found none"));
    }
    finish(r)
}

/// A property and its name in a comment of HyperMesh (`HMNAME COMP  1"wall"`) or ANSA (`ANSA_NAME_COMMENT;1;PSHELL;wall;`).
fn name_in_comment(text: &[u8]) -> Option<(i64, String)> {
    let text = std::str::from_utf8(text).ok()?.trim();
    let (number, name) = match text.strip_prefix("HMNAME COMP").or_else(|| text.strip_prefix("HMNAME PROP")) {
        Some(rest) => {
            let (number, name) = rest.split_once('"')?;
            (number, name.split('"').next()?)
        }
        None => {
            let mut words = text.strip_prefix("ANSA_NAME_COMMENT;")?.split(';');
            let number = words.next()?;
            (number, words.nth(1)?)
        }
    };
    let number = number.trim().parse().ok()?;
    (!name.trim().is_empty()).then(|| (number, name.trim().to_owned()))
}

/// A property and its tag in a comment of this program.
fn tag_in_comment(text: &[u8]) -> Option<(i64, i64)> {
    let (number, tag) = std::str::from_utf8(text).ok()?.trim().strip_prefix(PROPERTY_LINE)?.split_once(" has tag ")?;
    Some((number.trim().parse().ok()?, tag.trim().parse().ok()?))
}

/// Takes a card; whether it is one that is known.
fn read_card(r: &mut Reader<'_>, card: &mut Card) -> Result<bool, ReadError> {
    if card.name() == b"GRDSET" {
        card.take_continuations(&mut r.s)?;
        refuse_other_system(r, card)?;
        return Ok(true);
    }
    if card.name() == b"GRID" {
        card.take_continuations(&mut r.s)?;
        read_point(r, card)?;
        return Ok(true);
    }
    if let Some(kind) = kind_of(card.name()) {
        card.take_continuations(&mut r.s)?;
        read_element(r, card, kind)?;
        return Ok(true);
    }
    if PASSED_OVER.contains(&card.name()) {
        let what = format!("elements of type {}", String::from_utf8_lossy(card.name()));
        r.out.ignore(&what);
    }
    Ok(false)
}

/// Positions in another coordinate system than the basic one would be taken for what they are not.
fn refuse_other_system(r: &Reader<'_>, card: &Card) -> Result<(), ReadError> {
    match card.field(1) {
        b"" | b"0" => Ok(()),
        other => {
            let what = format!("points in coordinate system {}", String::from_utf8_lossy(other));
            let remedy = "export all of them in the basic coordinate system".to_owned();
            Err(ReadError::Unsupported { at: r.s.place_at_line(r.line), what, remedy })
        }
    }
}

fn read_point(r: &mut Reader<'_>, card: &Card) -> Result<(), ReadError> {
    refuse_other_system(r, card)?;
    let number = integer(r, card.field(0), "the number of a GRID")?;
    let mut point = [0.0; 3];
    for (k, axis) in ["x", "y", "z"].into_iter().enumerate() {
        let text = card.field(2 + k);
        // An empty field is 0.
        let value = if text.is_empty() { Some(0.0) } else { parse_real(text) };
        let Some(value) = value else {
            let given = snippet(text);
            return Err(r.malformed(format!("coordinate {axis} (a number)"), given, "correct this field"));
        };
        if !value.is_finite() {
            let given = String::from_utf8_lossy(text).into_owned();
            return Err(ReadError::NotFinite { at: r.s.place_at_line(r.line), what: axis.to_owned(), given });
        }
        point[k] = value;
    }
    if let Some(known) = r.numbers.get(number) {
        // The same point twice is legal; two points of one number are not.
        if r.out.mesh.points[known as usize] == point {
            return Ok(());
        }
        return Err(r.malformed("GRID numbers that differ", format!("{number} twice"), "renumber the points"));
    }
    r.numbers.push(number);
    r.out.mesh.points.push(point);
    Ok(())
}

fn read_element(r: &mut Reader<'_>, card: &Card, kind: Kind) -> Result<(), ReadError> {
    integer(r, card.field(0), "the number of an element")?;
    // An empty property is the number of the element, and Gmsh writes 0 for none: no groups.
    let property = match card.field(1) {
        b"" | b"0" => None,
        text => Some(integer(r, text, "the number of a property")?),
    };
    let first = r.nodes.len();
    for i in 0..kind.nodes {
        let text = card.field(2 + i);
        // Points between corners may be missing.
        if i >= kind.corners && (text.is_empty() || text == b"0" || parse_integer(text).is_none()) {
            continue;
        }
        let node = integer(r, text, "the number of a point")?;
        r.nodes.push(node);
    }
    let group = match property {
        Some(number) => {
            let group = r.properties.numbered(number);
            r.properties.join(NONE, group)
        }
        None => NONE,
    };
    let n_nodes = r.nodes.len() - first;
    r.elements.push(Element { kind, line: r.line, first, n_nodes, group });
    Ok(())
}

fn integer(r: &Reader<'_>, text: &[u8], what: &str) -> Result<i64, ReadError> {
    parse_integer(text).filter(|&n| n > 0).ok_or_else(|| {
        let given = if text.is_empty() { "nothing".to_owned() } else { snippet(text) };
        let remedy = "correct this field (8 columns each, 16 in cards with *, or commas)";
        r.malformed(format!("{what} (a positive whole number)"), given, remedy)
    })
}

/// Elements get their points, and their properties as tags.
fn finish(mut r: Reader<'_>) -> Result<MeshData, ReadError> {
    let (mut slots, mut combinations) = (Vec::new(), Vec::new());
    let mut ids = Vec::with_capacity(20);
    for element in std::mem::take(&mut r.elements) {
        ids.clear();
        for &node in &r.nodes[element.first..element.first + element.n_nodes] {
            ids.push(r.numbers.get(node).ok_or_else(|| ReadError::Malformed {
                at: r.s.place_at_line(element.line),
                expected: "the number of a GRID of this file".to_owned(),
                given: format!("{node}, which none has"),
                remedy: "correct it, or add the GRID".to_owned(),
            })?);
        }
        let corners = r.out.corners(&ids, element.kind.corners);
        let slot = match <[u32; 8]>::try_from(corners) {
            Ok(hex) => r.out.hex(hex, 0),
            Err(_) if element.kind.is_face => r.out.face(corners, 0),
            Err(_) => {
                r.out.small_cell(corners, 0);
                Slot::Elsewhere
            }
        };
        slots.push(slot);
        combinations.push(element.group);
    }
    r.out.tag_by_groups(&slots, &combinations, &r.properties);
    if !r.tags.is_empty() {
        for &slot in slots.iter().filter(|slot| **slot != Slot::Elsewhere) {
            let property = r.out.tag(slot);
            r.out.set_tag(slot, r.tags.get(&property).copied().unwrap_or(property));
        }
    }
    r.out.name_tags(r.s.take_tag_names().into_iter());
    let mut mesh = r.out.finish();
    r.numbers.keep(&mut mesh);
    Ok(mesh)
}
