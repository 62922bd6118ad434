//! The core of a ball with cavities: several spheres, one of them outside.
//!
//! Two spheres are joined by a prism from a triangle of the one to a triangle of the other. What is left of the interior
//! is a ball whose boundary is both spheres without the two triangles and the sides of the prism; it is coned. The prism takes
//! 3 tets, and everything is simplicial, because the spheres have no vertex in common.

use crate::ball::centroid;
use crate::error::ConstructError;
use crate::tets::{InteriorTets, TetComplex, TetRequest};
use hexfill_mesh::Context;

/// Tetrahedra between an outer sphere and cavities inside it.
#[derive(Clone, Copy, Debug, Default)]
pub struct ShellTets;

impl InteriorTets for ShellTets {
    fn name(&self) -> &'static str {
        "shell"
    }

    fn fill(&self, request: &TetRequest<'_>, _ctx: &Context<'_>) -> Result<TetComplex, ConstructError> {
        let parts = components(request);
        let needed =
            |reason: &str| ConstructError::InteriorNeeded { genus: 0, components: parts.len(), reason: reason.into() };
        let points = request.points.ok_or_else(|| needed("without positions nothing tells what lies inside what"))?;
        let volume = |part: &Vec<[u32; 3]>| -> f64 {
            let origin = points[part[0][0] as usize];
            part.iter()
                .map(|t| {
                    let [a, b, c] = t.map(|v| std::array::from_fn::<f64, 3, _>(|k| points[v as usize][k] - origin[k]));
                    a[0] * (b[1] * c[2] - b[2] * c[1])
                        + a[1] * (b[2] * c[0] - b[0] * c[2])
                        + a[2] * (b[0] * c[1] - b[1] * c[0])
                })
                .sum()
        };
        if parts.iter().filter(|p| volume(p) > 0.0).count() != 1 {
            return Err(needed(
                "not one outer component that faces outward and cavities that face inward; fill separate solids one by one",
            ));
        }
        let apex = request.n_vertices as u32;
        let mut tets = Vec::new();
        let mut triangles = Vec::new();
        for (k, part) in parts.iter().enumerate() {
            // The first triangle of a part is taken by the prism from the part before, the last by that to the next.
            let first = usize::from(k > 0);
            let last = part.len() - usize::from(k + 1 < parts.len());
            triangles.extend(&part[first..last]);
            if let Some(next) = parts.get(k + 1) {
                let a = part[last];
                // The other triangle faces the first one: its order is turned round.
                let [c0, c2, c1] = next[0];
                let c = [c0, c1, c2];
                tets.extend([[a[0], a[1], a[2], c[2]], [a[0], a[1], c[2], c[1]], [a[0], c[0], c[1], c[2]]]);
                triangles.extend([
                    [a[0], a[1], c[1]],
                    [a[0], c[1], c[0]],
                    [a[1], a[2], c[2]],
                    [a[1], c[2], c[1]],
                    [a[2], a[0], c[2]],
                    [a[0], c[0], c[2]],
                ]);
            }
        }
        // The prism lies outside the ball that is coned: seen from the ball, A is not there and its tets lie behind.
        for tet in &mut tets {
            tet.swap(2, 3);
        }
        tets.extend(triangles.iter().map(|&[a, b, c]| [apex, a, b, c]));
        let mut complex = TetComplex::from_simplices(request.n_vertices + 1, tets);
        let mut all = points.to_vec();
        all.push(centroid(points, request.triangles));
        complex.points = Some(all);
        Ok(complex)
    }
}

/// The triangles of each connected component, by smallest vertex.
fn components(request: &TetRequest<'_>) -> Vec<Vec<[u32; 3]>> {
    let mut root: Vec<u32> = (0..request.n_vertices as u32).collect();
    fn find(root: &mut [u32], mut v: u32) -> u32 {
        while root[v as usize] != v {
            root[v as usize] = root[root[v as usize] as usize];
            v = root[v as usize];
        }
        v
    }
    for t in request.triangles {
        for k in 0..2 {
            let (a, b) = (find(&mut root, t[k]), find(&mut root, t[k + 1]));
            root[a.max(b) as usize] = a.min(b);
        }
    }
    let mut parts: std::collections::BTreeMap<u32, Vec<[u32; 3]>> = std::collections::BTreeMap::new();
    for &t in request.triangles {
        parts.entry(find(&mut root, t[0])).or_default().push(t);
    }
    parts.into_values().collect()
}
