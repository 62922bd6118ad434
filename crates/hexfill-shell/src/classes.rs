//! Classes of things that turn out to be one (union-find); the least number speaks for its class.
//!
//! Source: Galler, Fischer 1964 (trees of equivalent elements), with path halving.

/// The classes.
#[derive(Clone, Debug)]
pub(crate) struct Classes(Vec<u32>);

impl Classes {
    /// `n` things, each alone.
    pub(crate) fn new(n: usize) -> Self {
        Self((0..n as u32).collect())
    }

    /// One thing more, alone; its number.
    pub(crate) fn add(&mut self) -> u32 {
        self.0.push(self.0.len() as u32);
        self.0.len() as u32 - 1
    }

    /// How many things there are.
    pub(crate) fn len(&self) -> usize {
        self.0.len()
    }

    /// The least of the class of `i`.
    pub(crate) fn root(&mut self, mut i: u32) -> u32 {
        while self.0[i as usize] != i {
            self.0[i as usize] = self.0[self.0[i as usize] as usize];
            i = self.0[i as usize];
        }
        i
    }

    /// Makes the classes of `i` and `j` one.
    pub(crate) fn join(&mut self, i: u32, j: u32) {
        let (a, b) = (self.root(i), self.root(j));
        self.0[a.max(b) as usize] = a.min(b);
    }
}
