//! Arrays indexed by the ids of one kind, so that the index of one array cannot be used for another.
//!
//! Source: ours.

use std::fmt;
use std::marker::PhantomData;
use std::ops::{Index, IndexMut};

/// An id: a number below 2^32 of one kind of thing. [`id_type!`](crate::id_type) makes new ones.
pub trait Id: Copy + Ord {
    /// The id of position `i` of an array.
    fn at(i: usize) -> Self;

    /// The id as an index into an array.
    fn place(self) -> usize;
}

/// A vector with one element for each id of a kind, in the order of the ids.
pub struct IdVec<I, T> {
    items: Vec<T>,
    ids: PhantomData<fn(I) -> I>,
}

impl<I: Id, T> IdVec<I, T> {
    /// No elements.
    pub const fn new() -> Self {
        Self { items: Vec::new(), ids: PhantomData }
    }

    /// No elements, and room for some.
    pub fn with_capacity(n: usize) -> Self {
        Self { items: Vec::with_capacity(n), ids: PhantomData }
    }

    /// `n` times the same.
    pub fn filled(item: T, n: usize) -> Self
    where
        T: Clone,
    {
        vec![item; n].into()
    }

    /// Number of elements.
    pub fn len(&self) -> usize {
        self.items.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.items.is_empty()
    }

    /// All ids, ascending.
    pub fn ids(&self) -> impl DoubleEndedIterator<Item = I> + ExactSizeIterator + use<I, T> {
        (0..self.items.len()).map(I::at)
    }

    /// The id that [`push`](Self::push) gives next.
    pub fn next_id(&self) -> I {
        I::at(self.items.len())
    }

    /// Appends an element and returns its id.
    pub fn push(&mut self, item: T) -> I {
        let id = self.next_id();
        self.items.push(item);
        id
    }

    /// Takes the last element away.
    pub fn pop(&mut self) -> Option<T> {
        self.items.pop()
    }

    /// Makes room for `n` elements, new ones being `item`.
    pub fn resize(&mut self, n: usize, item: T)
    where
        T: Clone,
    {
        self.items.resize(n, item);
    }

    /// The elements, ascending by id.
    pub fn iter(&self) -> std::slice::Iter<'_, T> {
        self.items.iter()
    }

    /// The elements, ascending by id.
    pub fn iter_mut(&mut self) -> std::slice::IterMut<'_, T> {
        self.items.iter_mut()
    }

    /// The ids with their elements, ascending.
    pub fn enumerate(&self) -> impl DoubleEndedIterator<Item = (I, &T)> + ExactSizeIterator + Clone {
        self.items.iter().enumerate().map(|(i, item)| (I::at(i), item))
    }

    /// The element of an id, unless there is none.
    pub fn get(&self, id: I) -> Option<&T> {
        self.items.get(id.place())
    }

    /// Keeps the elements that `keep` is true for; the ids of the others change.
    pub fn retain(&mut self, keep: impl FnMut(&T) -> bool) {
        self.items.retain(keep);
    }

    /// The elements as a slice.
    pub fn as_slice(&self) -> &[T] {
        &self.items
    }

    /// The elements as a slice.
    pub fn as_mut_slice(&mut self) -> &mut [T] {
        &mut self.items
    }

    /// The elements as a vector.
    pub fn into_vec(self) -> Vec<T> {
        self.items
    }
}

impl<I: Id, T> Index<I> for IdVec<I, T> {
    type Output = T;

    #[inline]
    fn index(&self, id: I) -> &T {
        &self.items[id.place()]
    }
}

impl<I: Id, T> IndexMut<I> for IdVec<I, T> {
    #[inline]
    fn index_mut(&mut self, id: I) -> &mut T {
        &mut self.items[id.place()]
    }
}

impl<I, T> From<Vec<T>> for IdVec<I, T> {
    fn from(items: Vec<T>) -> Self {
        Self { items, ids: PhantomData }
    }
}

impl<I: Id, T> FromIterator<T> for IdVec<I, T> {
    fn from_iter<A: IntoIterator<Item = T>>(items: A) -> Self {
        Vec::from_iter(items).into()
    }
}

impl<I: Id, T> Extend<T> for IdVec<I, T> {
    fn extend<A: IntoIterator<Item = T>>(&mut self, items: A) {
        self.items.extend(items);
    }
}

impl<I: Id, T> IntoIterator for IdVec<I, T> {
    type Item = T;
    type IntoIter = std::vec::IntoIter<T>;

    fn into_iter(self) -> Self::IntoIter {
        self.items.into_iter()
    }
}

impl<'a, I: Id, T> IntoIterator for &'a IdVec<I, T> {
    type Item = &'a T;
    type IntoIter = std::slice::Iter<'a, T>;

    fn into_iter(self) -> Self::IntoIter {
        self.items.iter()
    }
}

impl<I, T> Default for IdVec<I, T> {
    fn default() -> Self {
        Vec::new().into()
    }
}

impl<I, T: Clone> Clone for IdVec<I, T> {
    fn clone(&self) -> Self {
        self.items.clone().into()
    }
}

impl<I, T: PartialEq> PartialEq for IdVec<I, T> {
    fn eq(&self, other: &Self) -> bool {
        self.items == other.items
    }
}

impl<I, T: Eq> Eq for IdVec<I, T> {}

impl<I, T: fmt::Debug> fmt::Debug for IdVec<I, T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.items.fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{HexId, QuadId};

    #[test]
    fn ids_are_places() {
        let mut names: IdVec<QuadId, &str> = IdVec::new();
        let (a, b) = (names.push("a"), names.push("b"));
        assert_eq!((names[a], names[b], names.next_id()), ("a", "b", QuadId(2)));
        assert_eq!(names.enumerate().map(|(q, n)| format!("{q}{n}")).collect::<Vec<_>>(), ["q0a", "q1b"]);
        assert_eq!(names.get(QuadId(2)), None);
        assert_eq!(IdVec::<HexId, u8>::filled(7, 3).into_vec(), [7, 7, 7]);
    }
}
