//! Lists of few elements, one an id, in two arrays (compressed sparse rows): what a `Vec<Vec<_>>` holds in a fraction of its space.
//!
//! Source: ours; compressed rows by counting sort.

use crate::id_vec::Id;
use std::marker::PhantomData;
use std::ops::Index;

/// Per id a list.
#[derive(Clone, Debug)]
pub struct Buckets<I, T> {
    /// Per id where its list starts; one entry more for the end.
    first: Vec<u32>,
    items: Vec<T>,
    ids: PhantomData<fn(I) -> I>,
}

impl<I: Id, T: Copy + Default> Buckets<I, T> {
    /// The pairs by id, those of one id in the order given. A counting sort: linear time, the pairs are walked twice.
    ///
    /// # Panics
    /// If an id is not below `n`, or there are 2^32 pairs or more.
    pub fn new(n: usize, pairs: impl Iterator<Item = (I, T)> + Clone) -> Self {
        let mut first = vec![0u32; n + 1];
        let mut total = 0usize;
        for (id, _) in pairs.clone() {
            first[id.place() + 1] += 1;
            total += 1;
        }
        assert!(u32::try_from(total).is_ok(), "{total} pairs, the limit is 2^32 - 1");
        for i in 0..n {
            first[i + 1] += first[i];
        }
        let mut next = first.clone();
        let mut items = vec![T::default(); total];
        for (id, item) in pairs {
            let slot = &mut next[id.place()];
            items[*slot as usize] = item;
            *slot += 1;
        }
        Self { first, items, ids: PhantomData }
    }
}

impl<I: Id, T> Index<I> for Buckets<I, T> {
    type Output = [T];

    #[inline]
    fn index(&self, id: I) -> &[T] {
        &self.items[self.first[id.place()] as usize..self.first[id.place() + 1] as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{HexId, VertexId};

    #[test]
    fn lists_keep_the_order_of_the_pairs() {
        let pairs = [(2, 7), (0, 3), (2, 1), (2, 9)].map(|(v, h)| (VertexId(v), HexId(h)));
        let buckets = Buckets::new(4, pairs.into_iter());
        assert_eq!(buckets[VertexId(2)], [7, 1, 9].map(HexId));
        assert_eq!(buckets[VertexId(0)], [HexId(3)]);
        assert!(buckets[VertexId(1)].is_empty() && buckets[VertexId(3)].is_empty());
    }
}
