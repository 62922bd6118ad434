//! Numbers of nodes and elements: from those of a file to positions, and back to those that are written.
//!
//! Gmsh, Abaqus, Nastran and I-DEAS files number their nodes as they like. Numbers that do not just count up from 1 become the data [`NODE`] on points, which
//! goes wherever data on points go; a format with numbers takes them from there, and points without one (inside a mesh made of a surface) get those that follow
//! the largest. Elements are numbered anew.
//!
//! Source: ours.

use crate::data::MeshData;
use rustc_hash::{FxHashMap, FxHashSet};

/// The data on points that are numbers of nodes.
pub(crate) const NODE: &str = "node";
/// Whole numbers up to here are the same in floating point.
const EXACT: f64 = 9_007_199_254_740_992.0;

/// From the numbers of a file to positions in it. Numbers that simply count up cost nothing.
#[derive(Default)]
pub(crate) struct Numbers {
    first: i64,
    count: u32,
    map: Option<FxHashMap<i64, u32>>,
}

impl Numbers {
    /// Adds the next number; false if it is there already (it then means the last one).
    pub(crate) fn push(&mut self, number: i64) -> bool {
        if self.count == 0 {
            self.first = number;
        }
        if self.map.is_none() && self.first.checked_add(i64::from(self.count)) != Some(number) {
            let first = self.first;
            self.map = Some((0..self.count).map(|i| (first + i64::from(i), i)).collect());
        }
        let known = self.map.as_mut().is_some_and(|map| map.insert(number, self.count).is_some());
        self.count += 1;
        !known
    }

    pub(crate) fn get(&self, number: i64) -> Option<u32> {
        match &self.map {
            Some(map) => map.get(&number).copied(),
            None => u32::try_from(number.checked_sub(self.first)?).ok().filter(|&i| i < self.count),
        }
    }
}

impl Numbers {
    /// The first and how many there are, if they count up.
    pub(crate) fn simple_range(&self) -> Option<(i64, usize)> {
        self.map.is_none().then_some((self.first, self.count as usize))
    }

    /// Keeps the numbers of a mesh's points, unless they just count up from 1.
    pub(crate) fn keep(&self, mesh: &mut MeshData) {
        let is_plain = self.map.is_none() && self.first == 1;
        if is_plain || mesh.point_data.iter().any(|(name, _)| name == NODE) {
            return;
        }
        let mut numbers = vec![f64::NAN; mesh.points.len()];
        match &self.map {
            Some(map) => map.iter().for_each(|(&number, &i)| numbers[i as usize] = number as f64),
            None => (0..).zip(&mut numbers).for_each(|(i, number)| *number = (self.first + i) as f64),
        }
        mesh.point_data.push((NODE.to_owned(), numbers));
    }
}

/// The numbers under which points are written.
pub(crate) struct NodeNumbers(Option<Vec<u64>>);

impl NodeNumbers {
    /// Those that the data of the points say, in a format whose largest number is `most`; from 1 on if there are none, or they are no different whole numbers
    /// from 1 to `most`.
    pub(crate) fn new(mesh: &MeshData, most: u64) -> Self {
        let given = mesh.point_data.iter().find(|(name, _)| name == NODE);
        Self(given.and_then(|(_, values)| completed(values, most)))
    }

    /// Whether they are the points' own.
    pub(crate) fn are_given(&self) -> bool {
        self.0.is_some()
    }

    /// The number of a point.
    pub(crate) fn of(&self, point: usize) -> u64 {
        self.0.as_ref().map_or(point as u64 + 1, |numbers| numbers[point])
    }

    /// The least and the largest; 0 without points.
    pub(crate) fn range(&self, n_points: usize) -> [u64; 2] {
        let all = || (0..n_points).map(|i| self.of(i));
        [all().min().unwrap_or(0), all().max().unwrap_or(0)]
    }
}

/// The numbers, those that are missing after the largest.
fn completed(values: &[f64], most: u64) -> Option<Vec<u64>> {
    let whole = |x: f64| (x.fract() == 0.0 && (1.0..=EXACT).contains(&x)).then_some(x as u64);
    let mut seen = FxHashSet::default();
    let mut largest = 0;
    for &x in values.iter().filter(|x| !x.is_nan()) {
        let number = whole(x)?;
        largest = largest.max(number);
        if !seen.insert(number) {
            return None;
        }
    }
    let mut next = largest;
    let numbers = values.iter().map(|&x| {
        whole(x).unwrap_or_else(|| {
            next += 1;
            next
        })
    });
    let numbers: Vec<u64> = numbers.collect();
    (next <= most && !seen.is_empty()).then_some(numbers)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_at_the_end_of_the_range_do_not_go_round() {
        let mut numbers = Numbers::default();
        assert!(numbers.push(i64::MAX - 1) && numbers.push(i64::MAX) && numbers.push(i64::MIN));
        assert!(!numbers.push(i64::MAX));
        assert_eq!([i64::MAX - 1, i64::MIN, 0].map(|n| numbers.get(n)), [Some(0), Some(2), None]);
        let mut mesh = MeshData { points: vec![[0.0; 3]; 4], ..MeshData::default() };
        numbers.keep(&mut mesh);
        assert!(!NodeNumbers::new(&mesh, u64::MAX).are_given());
    }

    #[test]
    fn new_points_are_numbered_after_the_largest() {
        assert_eq!(completed(&[7.0, f64::NAN, 3.0, f64::NAN], 100), Some(vec![7, 8, 3, 9]));
        assert_eq!(completed(&[7.0, f64::NAN], 7), None, "no room");
        for wrong in [[1.0, 1.0], [0.0, 1.0], [1.5, 2.0], [-1.0, 2.0], [1e300, 2.0], [f64::NAN, f64::NAN]] {
            assert_eq!(completed(&wrong, u64::MAX), None, "{wrong:?}");
        }
    }
}
