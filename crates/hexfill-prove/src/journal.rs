//! Numbers with an undo list: every change keeps the old value, so that a state goes back in time to the change.
//!
//! Source: ours.

use std::ops::Index;

/// An array whose changes can be taken back.
#[derive(Clone)]
pub(crate) struct Journal<T> {
    values: Vec<T>,
    changes: Vec<(u32, T)>,
}

impl<T: Copy + PartialEq> Journal<T> {
    /// `n` copies of a value.
    pub(crate) fn new(n: usize, value: T) -> Self {
        Self { values: vec![value; n], changes: Vec::new() }
    }

    /// Changes an entry.
    #[inline]
    pub(crate) fn set(&mut self, at: usize, value: T) {
        let old = std::mem::replace(&mut self.values[at], value);
        if old != value {
            self.changes.push((at as u32, old));
        }
    }

    /// A point in time for [`undo`](Self::undo).
    #[inline]
    pub(crate) fn now(&self) -> usize {
        self.changes.len()
    }

    /// Takes all changes since `then` back.
    #[inline]
    pub(crate) fn undo(&mut self, then: usize) {
        while self.changes.len() > then {
            if let Some((at, old)) = self.changes.pop() {
                self.values[at as usize] = old;
            }
        }
    }
}

impl<T> Index<usize> for Journal<T> {
    type Output = T;

    #[inline]
    fn index(&self, at: usize) -> &T {
        &self.values[at]
    }
}
