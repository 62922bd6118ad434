//! Canonical names of quad surfaces, their automorphisms and isomorphisms.
//!
//! A signature is `Q1:` and the smallest breadth-first code of each component (file `surface_code.rs`), components in ascending order, joined by
//! `.`. Two surfaces have the same signature exactly if one becomes the other by renumbering vertices and quads and, perhaps, turning all of it inside out
//! (a mirror image). Vertices that no quad uses do not count. Time near linear for surfaces without much hidden regularity.
//!
//! Source: ours, after Brinkmann, McKay 2007.

use crate::ids::VertexId;
use crate::signature_text::{SEPARATOR, SignatureError, components, push_number};
use crate::surface::{QuadSurface, SurfaceError};
use crate::surface_code::{Canonical, Canonizer, Flag, Handedness, Walker};
use rustc_hash::FxHashSet;

const PREFIX: &str = "Q1:";

/// A permutation of the vertices that takes quads to quads.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct SurfaceAutomorphism {
    /// Per vertex its image; vertices no quad uses are fixed.
    pub vertices: Vec<VertexId>,
    /// Whether it reverses orientation.
    pub reflection: bool,
}

/// The quads of each component.
fn quads_by_component(surface: &QuadSurface) -> Vec<Vec<u32>> {
    let mut quads = vec![Vec::new(); surface.n_components()];
    for q in 0..surface.n_quads() as u32 {
        quads[surface.component(q.into())].push(q);
    }
    quads
}

/// The canonical form of a surface: its components, ordered by code.
struct Form {
    parts: Vec<Canonical>,
}

impl Form {
    /// The form over the given flags; for several components the handedness must be one for all of them.
    fn of(surface: &QuadSurface, handedness: Handedness) -> Self {
        let mut canonizer = Canonizer::new(surface);
        let mut parts: Vec<Canonical> =
            quads_by_component(surface).iter().map(|quads| canonizer.canonical(quads, handedness)).collect();
        parts.sort_by(|a, b| a.code.len().cmp(&b.code.len()).then_with(|| a.code.cmp(&b.code)));
        Self { parts }
    }

    fn key(&self) -> Vec<(usize, &[u32])> {
        self.parts.iter().map(|c| (c.code.len(), &c.code[..])).collect()
    }

    /// The smallest form of the surface or its mirror image.
    fn smallest(surface: &QuadSurface) -> Self {
        if surface.n_components() == 1 {
            return Self::of(surface, Handedness::Both);
        }
        // A mirror turns all components: a left and a right one are not two right ones.
        let direct = Self::of(surface, Handedness::Only { mirrored: false });
        let mirrored = Self::of(surface, Handedness::Only { mirrored: true });
        if mirrored.key() < direct.key() { mirrored } else { direct }
    }

    fn signature(&self) -> String {
        let mut text = String::from(PREFIX);
        for (i, part) in self.parts.iter().enumerate() {
            if i > 0 {
                text.push(SEPARATOR);
            }
            part.code.iter().for_each(|&number| push_number(&mut text, number));
        }
        text
    }
}

/// The canonical name of a surface up to isomorphism and reflection. See the module page.
///
/// # Example
/// The name does not depend on how vertices and quads are numbered, and it can be read back.
/// ```
/// use hexfill_mesh::{QuadSurface, parse_surface_signature, surface_signature};
///
/// let quads = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];
/// let renumbered = quads.map(|quad| quad.map(|v| 7 - v));
/// let name = surface_signature(&QuadSurface::try_new(8, &quads)?);
/// assert_eq!(name, surface_signature(&QuadSurface::try_new(8, &renumbered)?));
/// assert_eq!(parse_surface_signature(&name)?.n_quads(), 6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn surface_signature(surface: &QuadSurface) -> String {
    Form::smallest(surface).signature()
}

/// A surface's signature and how the surface lies on the one it names.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct CanonicalSurface {
    /// As [`surface_signature`].
    pub signature: String,
    /// Per vertex of the surface that [`parse_surface_signature`] makes of it: the vertex here.
    pub vertices: Vec<VertexId>,
    /// Whether that map turns the surface inside out.
    pub mirrored: bool,
}

/// The signature of a surface, with the map from the surface it names: so that what is stored for the name (a filling, say) can be carried over.
pub fn canonical_surface(surface: &QuadSurface) -> CanonicalSurface {
    let form = Form::smallest(surface);
    let mut walker = Walker::new(surface);
    let mut vertices = Vec::with_capacity(surface.n_used_vertices());
    for part in &form.parts {
        walker.code(part.flag);
        vertices.extend_from_slice(&walker.order);
    }
    CanonicalSurface { signature: form.signature(), vertices, mirrored: form.parts[0].flag.mirrored }
}

/// The surface that a signature names, vertices and quads in canonical order. Any well-formed code is read, smallest or not.
/// Time and memory are linear in the length of the text, whatever it says.
///
/// # Errors
/// [`SignatureError`].
pub fn parse_surface_signature(signature: &str) -> Result<QuadSurface, SignatureError> {
    let mut quads: Vec<[u32; 4]> = Vec::new();
    let mut n_vertices = 0u32;
    for mut reader in components(signature, "surface", PREFIX)? {
        // Directed edges that have their quad on the left.
        let mut taken: FxHashSet<(u32, u32)> = FxHashSet::default();
        let (first_quad, first_vertex) = (quads.len(), n_vertices);
        let mut at = first_quad;
        let mut found = Some([0, 1, 2, 3].map(|i| first_vertex + i));
        n_vertices += 4;
        loop {
            if let Some(quad) = found.take() {
                if quads.len() == QuadSurface::MAX_QUADS {
                    let limit = QuadSurface::MAX_QUADS;
                    return Err(SurfaceError::TooLarge { what: "quads", given: limit + 1, limit }.into());
                }
                for i in 0..4 {
                    if !taken.insert((quad[i], quad[(i + 1) % 4])) {
                        let position = reader.position();
                        return Err(SignatureError::Crowded { position, what: "quad on an edge" });
                    }
                }
                quads.push(quad);
            }
            // The next side without a neighbour; the quad beyond it is what the text goes on with.
            let open = loop {
                let Some(quad) = quads.get(at) else { break None };
                let side = (0..4).map(|i| (quad[i], quad[(i + 1) % 4])).find(|&(a, b)| !taken.contains(&(b, a)));
                if side.is_some() {
                    break side;
                }
                at += 1;
            };
            let Some((a, b)) = open else { break };
            let mut far = [0; 2];
            for slot in &mut far {
                let number = reader.number(n_vertices - first_vertex)?;
                *slot = n_vertices - number;
                n_vertices += u32::from(number == 0);
            }
            found = Some([b, a, far[0], far[1]]);
        }
        reader.finish()?;
    }
    Ok(QuadSurface::try_new(n_vertices as usize, &quads)?)
}

/// The order of the automorphism group, reflections included: permutations that keep the orientation of all components or reverse all.
/// Near linear time; `u128::MAX` stands for anything larger.
pub fn surface_symmetry_order(surface: &QuadSurface) -> u128 {
    let order = |form: &Form| {
        let mut order = 1u128;
        for run in form.parts.chunk_by(|a, b| a.code == b.code) {
            for (i, part) in run.iter().enumerate() {
                order = order.saturating_mul(part.flags.len() as u128).saturating_mul(i as u128 + 1);
            }
        }
        order
    };
    if surface.n_components() == 1 {
        return order(&Form::of(surface, Handedness::Both));
    }
    let direct = Form::of(surface, Handedness::Only { mirrored: false });
    let mirrored = Form::of(surface, Handedness::Only { mirrored: true });
    order(&direct).saturating_mul(if direct.key() == mirrored.key() { 2 } else { 1 })
}

/// All automorphisms of a surface, the identity first, reflections last. The list takes [`surface_symmetry_order`] times the number of vertices of memory:
/// ask that first where the surface may be large and regular or have many equal components.
pub fn surface_automorphisms(surface: &QuadSurface) -> Vec<SurfaceAutomorphism> {
    let direct = Form::of(surface, Handedness::Only { mirrored: false });
    let mirrored = Form::of(surface, Handedness::Only { mirrored: true });
    let mut all: Vec<SurfaceAutomorphism> = maps(surface, &direct, surface, &direct)
        .into_iter()
        .map(|vertices| SurfaceAutomorphism { vertices, reflection: false })
        .collect();
    if direct.key() == mirrored.key() {
        let reflections = maps(surface, &direct, surface, &mirrored);
        all.extend(reflections.into_iter().map(|vertices| SurfaceAutomorphism { vertices, reflection: true }));
    }
    // Ascending, so that the identity comes first and nothing depends on how the group was found.
    all.sort_by(|a, b| (a.reflection, &a.vertices).cmp(&(b.reflection, &b.vertices)));
    all
}

/// A map of the vertices of `a` to those of `b` that takes quads to quads, keeping all orientations or reversing all; `None` if there is none. Unused
/// vertices of `a` are mapped to `None`. Near linear time.
pub fn surface_isomorphism(a: &QuadSurface, b: &QuadSurface) -> Option<Vec<Option<VertexId>>> {
    if (a.n_quads(), a.n_used_vertices(), a.n_components()) != (b.n_quads(), b.n_used_vertices(), b.n_components()) {
        return None;
    }
    // One component may be mirrored by itself. Several must all be mirrored or none: an inner wall turned the other
    // way would be another solid.
    let (from, to) = if a.n_components() == 1 {
        (Form::of(a, Handedness::Both), Form::of(b, Handedness::Both))
    } else {
        let from = Form::of(a, Handedness::Only { mirrored: false });
        let to = Form::of(b, Handedness::Only { mirrored: false });
        let same = from.key() == to.key();
        (from, if same { to } else { Form::of(b, Handedness::Only { mirrored: true }) })
    };
    if from.key() != to.key() {
        return None;
    }
    let mut map = vec![None; a.n_vertices()];
    let (mut walk_a, mut walk_b) = (Walker::new(a), Walker::new(b));
    // Parts are sorted by code, so equal keys pair them; which of two equal parts goes where does not matter.
    for (x, y) in from.parts.iter().zip(&to.parts) {
        walk_a.code(x.flag);
        walk_b.code(y.flag);
        for (v, w) in walk_a.order.iter().zip(&walk_b.order) {
            map[v.index()] = Some(*w);
        }
    }
    Some(map)
}

/// Every vertex map from `a` to `b` that follows from two forms with equal keys; vertices of `a` no quad uses keep their id.
fn maps(a: &QuadSurface, from: &Form, b: &QuadSurface, to: &Form) -> Vec<Vec<VertexId>> {
    let mut walker_a = Walker::new(a);
    let mut walker_b = Walker::new(b);
    let identity: Vec<VertexId> = (0..a.n_vertices() as u32).map(VertexId).collect();
    // Partial maps, with the components of `b` already used.
    let mut partial = vec![(identity, vec![false; to.parts.len()])];
    for part in &from.parts {
        walker_a.code(part.flag);
        // (component of b, its vertices in the order of the labels) for every way to put `part` there.
        let images: Vec<(usize, Vec<VertexId>)> = to
            .parts
            .iter()
            .enumerate()
            .filter(|(_, image)| image.code == part.code)
            .flat_map(|(i, image)| image.flags.iter().map(move |&flag| (i, flag)))
            .map(|(i, flag): (usize, Flag)| {
                walker_b.code(flag);
                (i, walker_b.order.clone())
            })
            .collect();
        // Every choice so far with every image not taken yet: a product over the components, so its size is the
        // number of maps and cannot be less.
        let mut extended = Vec::new();
        for (map, used) in &partial {
            for (i, order) in images.iter().filter(|(i, _)| !used[*i]) {
                let (mut map, mut used) = (map.clone(), used.clone());
                used[*i] = true;
                for (v, w) in walker_a.order.iter().zip(order) {
                    map[v.index()] = *w;
                }
                extended.push((map, used));
            }
        }
        partial = extended;
    }
    partial.into_iter().map(|(map, _)| map).collect()
}
