//! Canonical names of hex meshes, their automorphisms and isomorphisms.
//!
//! A signature is `H1:` and the smallest breadth-first code of each part connected through quads (file `hex_code.rs`), parts in ascending order, joined by
//! `.`. Two meshes have the same signature exactly if one becomes the other by renumbering vertices and hexes and choosing other frames for the hexes, reflections included
//! (each part by itself). The oriented variant `H1+:` takes rotations only and so tells mirror images apart. Vertices no hex uses do not count. Parts that
//! share vertices without being connected through quads have no signature: the code of a part does not say how parts hang together.
//!
//! Source: ours; a name that is its object's code is Regina's idea of signatures (Burton 2011, abstract: they identify triangulations up
//! to isomorphism).

use crate::components::{disagreement, facet_components};
use crate::cube::FACETS;
use crate::hex_code::{Frames, HexCanonical, HexCanonizer, HexWalker, corner_across};
use crate::hexmesh::{HexMesh, HexMeshError};
use crate::ids::{HexId, VertexId};
use crate::signature_text::{NumberReader, SEPARATOR, SignatureError, components, push_number};
use rustc_hash::FxHashMap;

const PREFIX: &str = "H1:";
const ORIENTED_PREFIX: &str = "H1+:";

/// A permutation of vertices and hexes that keeps which vertices are corners, edges and facets of which hexes.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct HexAutomorphism {
    /// Per vertex its image; vertices no hex uses are fixed.
    pub vertices: Vec<VertexId>,
    /// Per hex its image.
    pub hexes: Vec<HexId>,
    /// Whether it turns hexes into mirror images; `None` if it does so with some hexes only, as given (a mesh of mixed orientation, or several parts).
    pub reflection: Option<bool>,
}

/// A map from one hex mesh to another.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct HexIsomorphism {
    /// Per vertex its image, `None` for vertices no hex uses.
    pub vertices: Vec<Option<VertexId>>,
    /// Per hex its image.
    pub hexes: Vec<HexId>,
}

/// The canonical forms of the parts of a mesh, in ascending order.
fn forms(mesh: &HexMesh, frames: Frames) -> Result<Vec<HexCanonical>, SignatureError> {
    let parts = facet_components(mesh);
    if parts.is_empty() {
        return Err(SignatureError::Empty);
    }
    let mut owner: Vec<Option<HexId>> = vec![None; mesh.n_vertices()];
    for part in &parts {
        for v in part.iter().flat_map(|&h| mesh.hex(h)) {
            match owner[v.index()] {
                Some(other) if other != part[0] => {
                    return Err(SignatureError::SharedVertex { hexes: [other, part[0]], vertex: v });
                }
                _ => owner[v.index()] = Some(part[0]),
            }
        }
    }
    let mut canonizer = HexCanonizer::new(mesh);
    let mut forms: Vec<HexCanonical> = parts.iter().map(|part| canonizer.canonical(part, frames)).collect();
    forms.sort_by(|a, b| key(a).cmp(&key(b)));
    Ok(forms)
}

fn key(form: &HexCanonical) -> (usize, &[u32]) {
    (form.code.len(), &form.code)
}

fn print(prefix: &str, forms: &[HexCanonical]) -> String {
    let mut text = String::from(prefix);
    for (i, form) in forms.iter().enumerate() {
        if i > 0 {
            text.push(SEPARATOR);
        }
        form.code.iter().for_each(|&number| push_number(&mut text, number));
    }
    text
}

/// The canonical name of a mesh up to isomorphism and reflection.
///
/// # Errors
/// [`SignatureError::Empty`], [`SignatureError::SharedVertex`].
///
/// # Example
/// ```
/// use hexfill_mesh::{HexMesh, hex_signature, hex_symmetry_order, parse_hex_signature};
///
/// let one = HexMesh::try_new(8, &[[0, 1, 2, 3, 4, 5, 6, 7]])?;
/// let turned = HexMesh::try_new(8, &[[1, 2, 3, 0, 5, 6, 7, 4]])?;
/// assert_eq!(hex_signature(&one)?, hex_signature(&turned)?);
/// assert_eq!(hex_symmetry_order(&one)?, 48);
/// assert_eq!(parse_hex_signature(&hex_signature(&one)?)?.n_hexes(), 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn hex_signature(mesh: &HexMesh) -> Result<String, SignatureError> {
    Ok(print(PREFIX, &forms(mesh, Frames::All)?))
}

/// The canonical name of a mesh up to isomorphism that keeps orientation: mirror images have different names unless a rotation makes them equal.
///
/// # Errors
/// As [`hex_signature`]; [`SignatureError::NotOriented`] if two neighbouring hexes have opposite handedness as given (see
/// [`orientation`](crate::orientation)).
pub fn oriented_hex_signature(mesh: &HexMesh) -> Result<String, SignatureError> {
    if let Some(hexes) = disagreement(mesh) {
        return Err(SignatureError::NotOriented { hexes });
    }
    Ok(print(ORIENTED_PREFIX, &forms(mesh, Frames::Rotations)?))
}

/// The mesh that a signature (`H1:` or `H1+:`) names, vertices and hexes in canonical order. Any well-formed code is read, smallest or not.
/// Time and memory are linear in the length of the text, whatever it says.
///
/// # Errors
/// [`SignatureError`].
pub fn parse_hex_signature(signature: &str) -> Result<HexMesh, SignatureError> {
    let prefix = if signature.starts_with(ORIENTED_PREFIX) { ORIENTED_PREFIX } else { PREFIX };
    let mut hexes: Vec<[u32; 8]> = Vec::new();
    let mut n_vertices = 0u32;
    for mut reader in components(signature, "hex mesh", prefix)? {
        // The inverse of the walk in `hex_code.rs`: hexes in the order in which they were entered, their facets in
        // the order of the frame. A facet that two hexes have already is one the walk passed in silence.
        let mut crowd = Crowd::default();
        let first_vertex = n_vertices;
        let mut at = hexes.len();
        hexes.push(std::array::from_fn(|i| first_vertex + i as u32));
        n_vertices += 8;
        crowd.add(&hexes[at], &reader)?;
        while at < hexes.len() {
            let hex = hexes[at];
            at += 1;
            for side in 0..6 {
                if crowd.hexes_on(&hex, side) == 2 {
                    continue;
                }
                let number = reader.number(n_vertices - first_vertex + 1)?;
                if number == 0 {
                    continue;
                }
                let mut next = [0; 8];
                let mut number = number - 1;
                for (j, &i) in FACETS[side].iter().enumerate() {
                    if j > 0 {
                        number = reader.number(n_vertices - first_vertex)?;
                    }
                    next[corner_across(side, i)] = hex[i];
                    next[i] = n_vertices - number;
                    n_vertices += u32::from(number == 0);
                }
                if hexes.len() == HexMesh::MAX_HEXES {
                    let limit = HexMesh::MAX_HEXES;
                    return Err(HexMeshError::TooLarge { what: "hexes", given: limit + 1, limit }.into());
                }
                crowd.add(&next, &reader)?;
                hexes.push(next);
            }
        }
        reader.finish()?;
    }
    Ok(HexMesh::try_new(n_vertices as usize, &hexes)?)
}

/// Number of hexes on each quad, by sorted vertices.
#[derive(Default)]
struct Crowd(FxHashMap<[u32; 4], u8>);

impl Crowd {
    fn quad(hex: &[u32; 8], side: usize) -> [u32; 4] {
        let mut quad = FACETS[side].map(|i| hex[i]);
        quad.sort_unstable();
        quad
    }

    fn hexes_on(&self, hex: &[u32; 8], side: usize) -> u8 {
        self.0.get(&Self::quad(hex, side)).copied().unwrap_or(0)
    }

    fn add(&mut self, hex: &[u32; 8], reader: &NumberReader<'_>) -> Result<(), SignatureError> {
        for side in 0..6 {
            let count = self.0.entry(Self::quad(hex, side)).or_insert(0);
            *count += 1;
            if *count > 2 {
                return Err(SignatureError::Crowded { position: reader.position(), what: "hex on a quad" });
            }
        }
        Ok(())
    }
}

/// The order of the automorphism group, reflections included; `u128::MAX` stands for anything larger.
///
/// # Errors
/// As [`hex_signature`].
pub fn hex_symmetry_order(mesh: &HexMesh) -> Result<u128, SignatureError> {
    let mut order = 1u128;
    for run in forms(mesh, Frames::All)?.chunk_by(|a, b| a.code == b.code) {
        for (i, form) in run.iter().enumerate() {
            order = order.saturating_mul(form.flags.len() as u128).saturating_mul(i as u128 + 1);
        }
    }
    Ok(order)
}

/// All automorphisms of a mesh, the identity first. The list takes [`hex_symmetry_order`] times the size of the mesh of memory.
///
/// # Errors
/// As [`hex_signature`].
pub fn hex_automorphisms(mesh: &HexMesh) -> Result<Vec<HexAutomorphism>, SignatureError> {
    let forms = forms(mesh, Frames::All)?;
    let (mut source, mut target) = (HexWalker::new(mesh), HexWalker::new(mesh));
    let identity = HexAutomorphism {
        vertices: (0..mesh.n_vertices() as u32).map(VertexId).collect(),
        hexes: (0..mesh.n_hexes() as u32).map(HexId).collect(),
        reflection: None,
    };
    // Partial maps, with the parts already used as images.
    let mut partial = vec![(identity, vec![false; forms.len()])];
    // An automorphism takes parts to parts of equal code, and a part onto another in as many ways as that one has
    // flags of the smallest code: the map follows from where one flag goes.
    for form in &forms {
        source.code(form.flag);
        let mut extended = Vec::new();
        for (i, image) in forms.iter().enumerate().filter(|(_, image)| image.code == form.code) {
            for &flag in &image.flags {
                target.code(flag);
                for (map, used) in partial.iter().filter(|(_, used)| !used[i]) {
                    let (mut map, mut used) = (map.clone(), used.clone());
                    used[i] = true;
                    for (v, w) in source.order.iter().zip(&target.order) {
                        map.vertices[v.index()] = *w;
                    }
                    for ((h, _), (k, _)) in source.entered.iter().zip(&target.entered) {
                        map.hexes[h.index()] = *k;
                    }
                    extended.push((map, used));
                }
            }
        }
        partial = extended;
    }
    let mut all: Vec<HexAutomorphism> = partial.into_iter().map(|(map, _)| map).collect();
    for map in &mut all {
        map.reflection = reflects(mesh, map);
    }
    all.sort_by(|a, b| (&a.vertices, &a.hexes).cmp(&(&b.vertices, &b.hexes)));
    Ok(all)
}

/// Whether all hexes are mirrored (`true`), none (`false`), or some.
fn reflects(mesh: &HexMesh, map: &HexAutomorphism) -> Option<bool> {
    let mirrored = |h: usize| {
        let image = mesh.hex(map.hexes[h]);
        let place = |v: VertexId| image.iter().position(|w| *w == map.vertices[v.index()]).map_or(0, |k| k as u8);
        crate::hex_code::is_mirrored(&mesh.hexes()[h].map(place))
    };
    let first = mirrored(0);
    (1..mesh.n_hexes()).all(|h| mirrored(h) == first).then_some(first)
}

/// A map from `a` to `b` if they are isomorphic (reflections allowed).
///
/// # Errors
/// As [`hex_signature`], for either mesh.
pub fn hex_isomorphism(a: &HexMesh, b: &HexMesh) -> Result<Option<HexIsomorphism>, SignatureError> {
    if a.n_hexes() != b.n_hexes() {
        return Ok(None);
    }
    let (from, to) = (forms(a, Frames::All)?, forms(b, Frames::All)?);
    if !from.iter().map(key).eq(to.iter().map(key)) {
        return Ok(None);
    }
    let mut map = HexIsomorphism { vertices: vec![None; a.n_vertices()], hexes: vec![HexId(0); a.n_hexes()] };
    let (mut source, mut target) = (HexWalker::new(a), HexWalker::new(b));
    for (x, y) in from.iter().zip(&to) {
        source.code(x.flag);
        target.code(y.flag);
        for (v, w) in source.order.iter().zip(&target.order) {
            map.vertices[v.index()] = Some(*w);
        }
        for ((h, _), (k, _)) in source.entered.iter().zip(&target.entered) {
            map.hexes[h.index()] = *k;
        }
    }
    Ok(Some(map))
}
