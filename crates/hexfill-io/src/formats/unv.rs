//! I-DEAS universal files: nodes (datasets 2411 and 781), elements (2412) and groups (2435, 2452, 2467, 2477); all other datasets are passed over.
//!
//! A dataset stands between lines of `-1` and begins with its number. Cells of higher order list corners and the points between them by turns, round each
//! face: [`kind_of`] says where the corners are.
//!
//! Source: the I-DEAS datasets.

use crate::assembly::{Assembly, Slot};
use crate::data::{MeshData, TagOn};
use crate::error::{ReadError, snippet};
use crate::groups::{Combination, Groups, NONE, name_of};
use crate::numbers::{NodeNumbers, Numbers};
use crate::orders::{UNV_HEX20, UNV_QUAD8};
use crate::quadratic::{written_faces, written_hexes};
use crate::source::Source;
use crate::write::unquoted;
use std::collections::BTreeMap;
use std::io::{self, Write};

/// An element type: whether it is a face, how many nodes it has, and which are its corners.
struct Kind {
    is_face: bool,
    nodes: usize,
    corners: &'static [usize],
}

/// What a descriptor of finite elements stands for.
fn kind_of(descriptor: i64) -> Option<Kind> {
    let (is_face, nodes, corners): (bool, usize, &'static [usize]) = match descriptor {
        // Plane stress, plane strain, plate, membrane, axisymmetric, thin shell: linear, then parabolic.
        41 | 51 | 61 | 71 | 81 | 91 => (true, 3, &[0, 1, 2]),
        44 | 54 | 64 | 74 | 84 | 94 => (true, 4, &[0, 1, 2, 3]),
        42 | 52 | 62 | 72 | 82 | 92 => (true, 6, &[0, 2, 4]),
        45 | 55 | 65 | 75 | 85 | 95 => (true, 8, &[0, 2, 4, 6]),
        111 => (false, 4, &[0, 1, 2, 3]),
        112 => (false, 6, &[0, 1, 2, 3, 4, 5]),
        115 => (false, 8, &[0, 1, 2, 3, 4, 5, 6, 7]),
        118 => (false, 10, &[0, 2, 4, 9]),
        113 => (false, 15, &[0, 2, 4, 9, 11, 13]),
        116 => (false, 20, &[0, 2, 4, 6, 12, 14, 16, 18]),
        _ => return None,
    };
    Some(Kind { is_face, nodes, corners })
}

/// Rods and beams have a line more.
fn is_beam(descriptor: i64) -> bool {
    matches!(descriptor, 11 | 21..=24)
}

/// An element whose nodes may not be known yet.
struct Element {
    descriptor: i64,
    line: u64,
    /// Where its nodes begin.
    first: usize,
}

/// What a group consists of.
const NODES: i64 = 7;
const ELEMENTS: i64 = 8;

struct Reader<'r> {
    s: Source<'r>,
    out: Assembly,
    numbers: Numbers,
    element_numbers: Numbers,
    elements: Vec<Element>,
    nodes: Vec<i64>,
    /// Groups of faces, of cells and of nodes, which number tags by themselves; their names, and their members: the name, what it is, its number.
    faces: Groups,
    cells: Groups,
    points: Groups,
    names: Vec<String>,
    members: Vec<(u32, i64, i64)>,
}

pub(crate) fn read(source: Source<'_>) -> Result<MeshData, ReadError> {
    let mut r = Reader {
        s: source,
        out: Assembly::default(),
        numbers: Numbers::default(),
        element_numbers: Numbers::default(),
        elements: Vec::new(),
        nodes: Vec::new(),
        faces: Groups::default(),
        cells: Groups::default(),
        points: Groups::default(),
        names: Vec::new(),
        members: Vec::new(),
    };
    let mut any = false;
    while r.s.next_full_line()? {
        any = true;
        if !is_end(&r.s) {
            let given = snippet(r.s.line());
            let remedy = "is this an I-DEAS universal file? name the format if the extension is wrong";
            return Err(r.s.malformed_text("a line `-1` before a dataset", given, remedy));
        }
        if !r.s.next_full_line()? {
            return Err(r.s.truncated("the number of a dataset"));
        }
        let span = r.s.need_word("the number of a dataset")?;
        match r.s.integer(span, "the number of a dataset")? {
            2411 | 781 => read_nodes(&mut r)?,
            2412 => read_elements(&mut r)?,
            2435 | 2452 | 2467 | 2477 => read_groups(&mut r)?,
            _ => skip(&mut r.s)?,
        }
    }
    if !any {
        return Err(r.s.empty());
    }
    if r.out.point_count() == 0 {
        return Err(r.s.truncated("nodes (dataset 2411), found none"));
    }
    finish(r)
}

/// Whether the current line is `-1` alone.
fn is_end(s: &Source<'_>) -> bool {
    s.line().trim_ascii() == b"-1"
}

fn skip(s: &mut Source<'_>) -> Result<(), ReadError> {
    while s.next_line()? {
        if is_end(s) {
            return Ok(());
        }
    }
    Err(s.truncated("the end of a dataset (`-1`)"))
}

/// The next line of a dataset; false at its end.
fn next_record(s: &mut Source<'_>) -> Result<bool, ReadError> {
    if !s.next_full_line()? {
        return Err(s.truncated("the end of a dataset (`-1`)"));
    }
    Ok(!is_end(s))
}

/// A line that must be there.
fn need_record(s: &mut Source<'_>, what: &str) -> Result<(), ReadError> {
    if next_record(s)? {
        return Ok(());
    }
    Err(s.malformed_text(what, "the end of the dataset".to_owned(), "complete it, or export it again"))
}

fn next_integer(s: &mut Source<'_>, what: &str) -> Result<i64, ReadError> {
    let span = s.need_word(what)?;
    s.integer(span, what)
}

fn read_nodes(r: &mut Reader<'_>) -> Result<(), ReadError> {
    while next_record(&mut r.s)? {
        let number = next_integer(&mut r.s, "the number of a node")?;
        let system = next_integer(&mut r.s, "a coordinate system")?;
        // 0 and 1 are what everybody writes for the global one.
        if !(0..=1).contains(&system) {
            let what = format!("nodes in coordinate system {system}");
            return Err(r.s.unsupported(what, "export them in the global Cartesian one"));
        }
        need_record(&mut r.s, "the coordinates of a node")?;
        let point = r.s.point_on_line()?;
        if !r.numbers.push(number) {
            let given = format!("{number} twice");
            return Err(r.s.malformed_text("node numbers that differ", given, "renumber the nodes"));
        }
        r.out.mesh.points.push(point);
    }
    Ok(())
}

fn read_elements(r: &mut Reader<'_>) -> Result<(), ReadError> {
    while next_record(&mut r.s)? {
        let line = r.s.line_number();
        let number = next_integer(&mut r.s, "the number of an element")?;
        let descriptor = next_integer(&mut r.s, "the type of an element")?;
        for what in ["a physical property", "a material property", "a colour"] {
            next_integer(&mut r.s, what)?;
        }
        let given = next_integer(&mut r.s, "a number of nodes")?;
        let kind = kind_of(descriptor);
        if let Some(kind) = kind.as_ref().filter(|kind| kind.nodes as i64 != given) {
            let expected = format!("{} nodes of an element of type {descriptor}", kind.nodes);
            return Err(r.s.malformed_text(expected, given.to_string(), "correct the line"));
        }
        if is_beam(descriptor) {
            need_record(&mut r.s, "the orientation of a beam")?;
        }
        let first = r.nodes.len();
        for _ in 0..given.max(0) {
            let span = loop {
                match r.s.word() {
                    Some(span) => break span,
                    None => need_record(&mut r.s, "the nodes of an element")?,
                }
            };
            let node = r.s.integer(span, "the number of a node")?;
            if kind.is_some() {
                r.nodes.push(node);
            }
        }
        if kind.is_none() {
            r.out.ignore(&format!("elements of type {descriptor}"));
        }
        r.element_numbers.push(number);
        r.elements.push(Element { descriptor, line, first });
    }
    Ok(())
}

fn read_groups(r: &mut Reader<'_>) -> Result<(), ReadError> {
    while next_record(&mut r.s)? {
        let mut head = [0; 8];
        for slot in &mut head {
            *slot = next_integer(&mut r.s, "the head of a group: eight whole numbers")?;
        }
        let [number, .., count] = head;
        if !r.s.next_line()? {
            return Err(r.s.truncated("the name of a group"));
        }
        let name = String::from_utf8_lossy(r.s.line()).trim().to_owned();
        let name = if name.is_empty() { number.to_string() } else { name };
        let group = r.names.len() as u32;
        r.names.push(name);
        if count > 0 {
            // The name is done with.
            need_record(&mut r.s, "the members of a group")?;
        }
        for _ in 0..count.max(0) {
            let mut entry = [0; 4];
            for slot in &mut entry {
                let span = loop {
                    match r.s.word() {
                        Some(span) => break span,
                        None => need_record(&mut r.s, "the members of a group")?,
                    }
                };
                *slot = r.s.integer(span, "a member of a group")?;
            }
            match entry[0] {
                what @ (NODES | ELEMENTS) => r.members.push((group, what, entry[1])),
                _ => r.out.ignore("members of groups that are no nodes or elements"),
            }
        }
    }
    Ok(())
}

fn finish(mut r: Reader<'_>) -> Result<MeshData, ReadError> {
    let mut slots = Vec::with_capacity(r.elements.len());
    let (mut corners, mut middles) = (Vec::with_capacity(8), Vec::new());
    for element in &r.elements {
        let Some(kind) = kind_of(element.descriptor) else {
            slots.push(Slot::Elsewhere);
            continue;
        };
        corners.clear();
        for (i, &node) in r.nodes[element.first..element.first + kind.nodes].iter().enumerate() {
            let id = r.numbers.get(node).ok_or_else(|| ReadError::Malformed {
                at: r.s.place_at_line(element.line),
                expected: "the number of a node of this file".to_owned(),
                given: format!("{node}, which none has"),
                remedy: "correct it, or add the node".to_owned(),
            })?;
            if kind.corners.contains(&i) { corners.push(id) } else { middles.push(id) }
        }
        slots.push(match <[u32; 8]>::try_from(corners.as_slice()) {
            Ok(hex) => r.out.hex(hex, 0),
            Err(_) if kind.is_face => r.out.face(&corners, 0),
            Err(_) => {
                r.out.small_cell(&corners, 0);
                Slot::Elsewhere
            }
        });
    }
    r.out.mesh.middles = middles;
    place_groups(&mut r, &slots);
    let mut mesh = r.out.finish();
    r.numbers.keep(&mut mesh);
    Ok(mesh)
}

/// Groups become tags; numbers that nothing has are passed over.
fn place_groups(r: &mut Reader<'_>, slots: &[Slot]) {
    let mut of_element: Vec<Combination> = vec![NONE; slots.len()];
    let mut of_node: Vec<Combination> = vec![NONE; r.out.point_count()];
    for (group, what, number) in std::mem::take(&mut r.members) {
        let name = &r.names[group as usize];
        if what == NODES {
            let Some(of) = r.numbers.get(number).map(|node| &mut of_node[node as usize]) else { continue };
            let group = r.points.named(name);
            *of = r.points.join(*of, group);
        } else {
            let Some(element) = r.element_numbers.get(number).map(|e| e as usize) else { continue };
            let groups = if matches!(slots[element], Slot::Hex(_)) { &mut r.cells } else { &mut r.faces };
            let group = groups.named(name);
            of_element[element] = groups.join(of_element[element], group);
        }
    }
    let only = |hexes: bool| -> Vec<Slot> {
        let is_wanted = |slot: &Slot| matches!(slot, Slot::Hex(_)) == hexes;
        slots.iter().map(|&slot| if is_wanted(&slot) { slot } else { Slot::Elsewhere }).collect()
    };
    r.out.tag_by_groups(&only(false), &of_element, &r.faces);
    r.out.tag_by_groups(&only(true), &of_element, &r.cells);
    let tags = r.points.tags(of_node.iter().copied());
    r.out.point_tags = of_node.iter().map(|&c| tags.of(c)).collect();
    r.out.name_tags(tags.names(TagOn::Points));
}

/// A number with all its digits, as Fortran writes it.
fn real(x: f64) -> String {
    let text = format!("{x:.16e}");
    let (digits, exponent) = text.split_once('e').expect("a number in scientific notation");
    let exponent: i32 = exponent.parse().expect("an exponent");
    format!("{digits}D{exponent:+03}")
}

/// The largest number of a node.
pub(crate) const MOST: u64 = 2_147_483_647;

pub(crate) fn write(out: &mut dyn Write, data: &MeshData) -> io::Result<()> {
    writeln!(out, "    -1\n  2411")?;
    let numbers = NodeNumbers::new(data, MOST);
    for (i, point) in data.points.iter().enumerate() {
        let [x, y, z] = point.map(real);
        writeln!(out, "{:>10}{:>10}{:>10}{:>10}\n{x:>25}{y:>25}{z:>25}", numbers.of(i), 1, 1, 11)?;
    }
    writeln!(out, "    -1\n    -1\n  2412")?;
    let faces = written_faces(data).map(|(face, _)| {
        let descriptor = match face.len() {
            3 => 91,
            8 => 95,
            _ => 94,
        };
        (descriptor, face)
    });
    let hexes = written_hexes(data).map(|(hex, _)| (if hex.len() == 20 { 116 } else { 115 }, hex));
    let tets = data.tets.iter().map(|cell| (111, cell.as_slice()));
    let wedges = data.wedges.iter().map(|cell| (112, cell.as_slice()));
    for (i, (descriptor, nodes)) in faces.chain(hexes).chain(tets).chain(wedges).enumerate() {
        writeln!(out, "{:>10}{descriptor:>10}{:>10}{:>10}{:>10}{:>10}", i + 1, 1, 1, 7, nodes.len())?;
        write_nodes(out, descriptor, nodes, &numbers)?;
    }
    writeln!(out, "    -1")?;
    write_groups(out, data, &numbers)
}

/// The nodes of an element in the order of I-DEAS, eight a line.
fn write_nodes(out: &mut dyn Write, descriptor: i64, nodes: &[u32], numbers: &NodeNumbers) -> io::Result<()> {
    let order: &[usize] = match descriptor {
        95 => &UNV_QUAD8,
        116 => &UNV_HEX20,
        _ => &[0, 1, 2, 3, 4, 5, 6, 7][..nodes.len()],
    };
    for line in order.chunks(8) {
        line.iter().try_for_each(|&i| write!(out, "{:>10}", numbers.of(nodes[i] as usize)))?;
        out.write_all(b"\n")?;
    }
    Ok(())
}

/// A group for each name of a tag; tags without one are called `tag_n`.
fn write_groups(out: &mut dyn Write, data: &MeshData, numbers: &NodeNumbers) -> io::Result<()> {
    let names = data.names_by_tag();
    let mut groups: BTreeMap<(TagOn, String), Vec<usize>> = BTreeMap::new();
    let mut add = |on: TagOn, tag: i64, number: usize| {
        let named = names.get(&(on, tag)).filter(|_| tag != 0);
        let own = (tag != 0 && named.is_none()).then(|| name_of(tag));
        for name in named.into_iter().flatten().map(|name| (*name).to_owned()).chain(own) {
            groups.entry((on, name)).or_default().push(number);
        }
    };
    data.numbered_faces().enumerate().for_each(|(i, (.., tag))| add(TagOn::Faces, tag, i + 1));
    (0..data.hexes.len()).for_each(|h| add(TagOn::Cells, data.hex_tag(h), data.face_count() + h + 1));
    data.point_tags.iter().flatten().enumerate().for_each(|(v, &tag)| add(TagOn::Points, tag, numbers.of(v) as usize));
    if groups.is_empty() {
        return Ok(());
    }
    writeln!(out, "    -1\n  2467")?;
    for (i, ((on, name), members)) in groups.iter().enumerate() {
        let head = [i + 1, 0, 0, 0, 0, 0, 0, members.len()];
        head.iter().try_for_each(|n| write!(out, "{n:>10}"))?;
        writeln!(out, "\n{}", unquoted(name))?;
        let what = if *on == TagOn::Points { NODES } else { ELEMENTS };
        for line in members.chunks(2) {
            line.iter().try_for_each(|n| write!(out, "{what:>10}{n:>10}{:>10}{:>10}", 0, 0))?;
            out.write_all(b"\n")?;
        }
    }
    writeln!(out, "    -1")
}
