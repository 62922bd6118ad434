//! The name of a partly filled sphere up to given symmetries of the sphere: what lies behind each quad, read outside in.
//!
//! Source: ours, after Brinkmann, McKay 2007.

use crate::state::{Hex, MAX_VERTICES};
use hexfill_mesh::cube::FACETS;
use rustc_hash::FxHashMap;
use std::collections::VecDeque;

const NO_HEX: u8 = u8::MAX;
const SEEN_HEX: u8 = u8::MAX - 1;

/// The smallest code over the given images of the boundary. Every hex must be reached from the boundary through quads.
pub(crate) fn code(boundary: &[[u8; 4]], n_boundary: usize, hexes: &[Hex], images: &[Vec<u8>]) -> Vec<u8> {
    let mut behind: FxHashMap<[u8; 4], Vec<usize>> = FxHashMap::default();
    for (h, hex) in hexes.iter().enumerate() {
        for facet in FACETS {
            behind.entry(sorted(facet.map(|i| hex[i]))).or_default().push(h);
        }
    }
    images.iter().map(|image| one_code(boundary, n_boundary, hexes, &behind, image)).min().unwrap_or_default()
}

fn sorted(mut quad: [u8; 4]) -> [u8; 4] {
    quad.sort_unstable();
    quad
}

fn one_code(
    boundary: &[[u8; 4]],
    n_boundary: usize,
    hexes: &[Hex],
    behind: &FxHashMap<[u8; 4], Vec<usize>>,
    image: &[u8],
) -> Vec<u8> {
    let mut label = [NO_HEX; MAX_VERTICES];
    let mut preimage = vec![0u8; n_boundary];
    for (v, &w) in image.iter().enumerate() {
        label[v] = w;
        preimage[usize::from(w)] = v as u8;
    }
    let mut next = n_boundary as u8;
    let mut queue: VecDeque<[u8; 4]> = boundary.iter().map(|q| q.map(|v| preimage[usize::from(v)])).collect();
    let mut seen = vec![false; hexes.len()];
    let mut out = Vec::new();
    while let Some(near) = queue.pop_front() {
        // A quad has at most two hexes behind it, the one it was reached from and the next; both may be seen already,
        // where two ways meet.
        let here = behind.get(&sorted(near)).map_or(&[][..], Vec::as_slice);
        let Some(&h) = here.iter().find(|&&h| !seen[h]) else {
            out.push(if here.is_empty() { NO_HEX } else { SEEN_HEX });
            continue;
        };
        seen[h] = true;
        let far = above(&hexes[h], near);
        // Labels in the order of the walk: interior vertices have no names of their own, so two states that differ by
        // these get one code.
        for v in far.map(usize::from) {
            if label[v] == NO_HEX {
                label[v] = next;
                next += 1;
            }
            out.push(label[v]);
        }
        queue.push_back(far);
        for i in 0..4 {
            let j = (i + 1) % 4;
            queue.push_back([near[i], near[j], far[j], far[i]]);
        }
    }
    out
}

/// The vertices of a hex beyond those of one of its facets.
fn above(hex: &Hex, near: [u8; 4]) -> [u8; 4] {
    near.map(|v| {
        let i = hex.iter().position(|&w| w == v).unwrap_or(0);
        let across = hexfill_mesh::cube::CORNER_NEIGHBOURS[i].map(|k| hex[k]);
        across.into_iter().find(|w| !near.contains(w)).unwrap_or(v)
    })
}
