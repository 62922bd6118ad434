//! [`mend`]: the faults that have one smallest remedy are mended; what stays is for the findings to say.
//!
//! Source: ours.

use crate::cut::Cutter;
use crate::faults::{degenerate_faces, repeated_faces};
use crate::parity::{changed, parity_changes};
use crate::soup::Soup;
use crate::triangles::merged_triangles;

/// What may be done.
///
/// | option | default |
/// |---|---|
/// | refine | no |
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MendOptions {
    refine: bool,
}

impl MendOptions {
    /// Cut every face of n sides into n quads, through its middle and those of its edges: always an even number.
    #[must_use]
    pub fn with_refine(self, refine: bool) -> Self {
        Self { refine }
    }
}

/// A mended surface. Points keep their numbers, new ones follow.
#[derive(Clone, Debug, PartialEq)]
pub struct Mended {
    /// The surface.
    pub soup: Soup,
    /// Per face the face of the input it comes from.
    pub origin: Vec<u32>,
    /// What was done, in words.
    pub done: Vec<String>,
}

/// Removes degenerate and repeated faces, merges triangles if all find a partner, refines if asked, and makes an odd number of quads even.
pub fn mend(soup: &Soup, options: &MendOptions) -> Mended {
    let mut mended = Mended { soup: soup.clone(), origin: (0..soup.faces.len() as u32).collect(), done: Vec::new() };
    mended.remove(degenerate_faces, "degenerate");
    mended.remove(repeated_faces, "repeated");
    if options.refine {
        mended.refine();
    } else {
        mended.merge_triangles();
    }
    mended.make_even();
    mended
}

impl Mended {
    fn remove(&mut self, which: fn(&Soup) -> Vec<u32>, word: &str) {
        let faces = which(&self.soup);
        if faces.is_empty() {
            return;
        }
        self.keep(|f| faces.binary_search(&f).is_err());
        self.done.push(format!("{} {word} faces removed", faces.len()));
    }

    fn keep(&mut self, stays: impl Fn(u32) -> bool) {
        let mut f = 0..;
        self.soup.faces.retain(|_| f.next().is_some_and(&stays));
        let mut f = 0..;
        self.origin.retain(|_| f.next().is_some_and(&stays));
    }

    /// The first triangle of each pair becomes the quad.
    fn merge_triangles(&mut self) {
        let (merged, alone) = merged_triangles(&self.soup);
        if merged.is_empty() || !alone.is_empty() {
            return;
        }
        let mut second: Vec<u32> = Vec::new();
        for pair in &merged {
            self.soup.faces[pair.faces[0] as usize] = pair.quad.to_vec();
            second.push(pair.faces[1]);
        }
        second.sort_unstable();
        self.keep(|f| second.binary_search(&f).is_err());
        self.done.push(format!("{} pairs of triangles merged", merged.len()));
    }

    fn refine(&mut self) {
        let old = std::mem::take(&mut self.soup);
        let origin = std::mem::take(&mut self.origin);
        let mut cutter = Cutter::new(&old);
        for (face, from) in old.faces.iter().zip(origin) {
            let n = face.len();
            let on: Vec<u32> = (0..n).map(|k| cutter.middle_of_edge(face[k], face[(k + 1) % n])).collect();
            let middle = cutter.middle(face);
            for k in 0..n {
                cutter.new.faces.push(vec![face[k], on[k], middle, on[(k + n - 1) % n]]);
                self.origin.push(from);
            }
        }
        self.done.push(format!("{} faces cut into {} quads", old.faces.len(), cutter.new.faces.len()));
        self.soup = cutter.new;
    }

    fn make_even(&mut self) {
        let Ok(surface) = self.soup.surface() else { return };
        if surface.n_quads().is_multiple_of(2) || self.soup.points.is_empty() {
            return;
        }
        let Some(change) = parity_changes(&surface, &self.soup.points).into_iter().next() else { return };
        // The change names quads as the surface has them, which are those of the soup.
        let (soup, from) = changed(&self.soup, &change);
        self.origin = from.into_iter().map(|f| self.origin[f as usize]).collect();
        self.soup = soup;
        self.done.push(change.to_string());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::findings::{Severity, examine};

    fn cube() -> Soup {
        let points = (0..8u32).map(|v| [0, 1, 2].map(|k| f64::from(v >> k & 1))).collect();
        let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        Soup { points, faces: sides.iter().map(|s| s.to_vec()).collect() }
    }

    #[test]
    fn what_is_well_stays() {
        let mended = mend(&cube(), &MendOptions::default());
        assert_eq!((mended.soup, mended.done.len()), (cube(), 0));
        assert_eq!(examine(&cube()).findings, []);
    }

    #[test]
    fn copies_flat_faces_and_triangles_go() {
        let mut sick = cube();
        let [a, b, c, d] = sick.faces[2][..] else { panic!() };
        sick.faces[2] = vec![a, b, c];
        sick.faces.extend([vec![a, c, d], vec![0, 0, 1, 1], vec![6, 7, 3, 2]]);
        let kinds: Vec<&str> = examine(&sick).findings.iter().map(|f| f.kind).collect();
        assert_eq!(kinds, ["triangles", "degenerate-faces", "repeated-faces", "non-manifold-edges"]);
        let mended = mend(&sick, &MendOptions::default());
        assert_eq!(mended.done.len(), 3);
        assert_eq!(mended.origin, [0, 1, 2, 3, 4, 5]);
        assert!(examine(&mended.soup).findings.is_empty());
    }

    #[test]
    fn refining_makes_quads_of_anything() {
        let mut sick = cube();
        let [a, b, c, d] = sick.faces[2][..] else { panic!() };
        sick.faces[2] = vec![a, b, c];
        sick.faces.push(vec![a, c, d]);
        sick.points.push([0.5, 0.5, -0.5]);
        let [a, b, c, d] = sick.faces[0][..] else { panic!() };
        sick.faces[0] = vec![a, b, 8];
        sick.faces.extend([vec![b, c, 8], vec![c, d, 8], vec![d, a, 8]]);
        let mended = mend(&sick, &MendOptions { refine: true });
        let surface = mended.soup.surface().unwrap();
        assert!(surface.is_sphere() && surface.n_quads() == 6 * 3 + 4 * 4);
        assert_eq!(examine(&mended.soup).worst(), None);
    }

    #[test]
    fn holes_and_crossings_are_named_together() {
        let mut sick = cube();
        sick.faces.pop();
        let mut far = cube();
        far.points.iter_mut().flatten().for_each(|x| *x += 0.5);
        sick.faces.extend(far.faces.into_iter().map(|f| f.into_iter().map(|v| v + 8).collect()));
        sick.points.extend(far.points);
        let found = examine(&sick);
        let kinds: Vec<&str> = found.findings.iter().map(|f| f.kind).collect();
        assert_eq!(kinds, ["open-edges", "crossing-faces"]);
        assert_eq!(found.worst(), Some(Severity::Fatal));
        assert!(found.not_examined.is_some());
    }
}
