//! Union-find: things that are made one, two at a time (Tarjan 1975, with path halving).
//!
//! Source: Tarjan 1975.

use crate::id_vec::{Id, IdVec};

/// A partition of the first `n` ids. Every class is named by its smallest id, whatever the order of the unions.
#[derive(Clone, Debug)]
pub struct Forest<I> {
    /// Per id: itself, or a smaller id of its class.
    up: IdVec<I, I>,
}

impl<I: Id> Forest<I> {
    /// Every id a class of its own.
    pub fn new(n: usize) -> Self {
        Self { up: (0..n).map(I::at).collect() }
    }

    /// The smallest id of a class.
    pub fn find(&mut self, mut i: I) -> I {
        while self.up[i] != i {
            self.up[i] = self.up[self.up[i]];
            i = self.up[i];
        }
        i
    }

    /// Makes the classes of `a` and `b` one; whether they were two.
    pub fn union(&mut self, a: I, b: I) -> bool {
        let (a, b) = (self.find(a), self.find(b));
        self.up[a.max(b)] = a.min(b);
        a != b
    }

    /// Per id: the smallest id of its class.
    pub fn names(mut self) -> IdVec<I, I> {
        let ids = self.up.ids();
        ids.map(|i| self.find(i)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::VertexId;

    #[test]
    fn classes_are_named_by_their_smallest_id() {
        let mut forest: Forest<VertexId> = Forest::new(6);
        assert!(forest.union(VertexId(5), VertexId(3)) && forest.union(VertexId(4), VertexId(5)));
        assert!(!forest.union(VertexId(3), VertexId(4)) && forest.union(VertexId(0), VertexId(1)));
        assert_eq!(forest.names().into_vec(), [0, 0, 2, 3, 3, 3].map(VertexId));
    }
}
