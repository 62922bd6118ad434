//! Ids: `u32` newtypes that print as `v12`, `q3`, `h7`.
//!
//! Limits: 2^32 - 1 vertices, 2^30 - 1 quads (a dart is `4 * quad + corner` in a `u32`),
//! (2^32 - 1) / 6 hexes (a facet is `6 * hex + side` in a `u32`).
//!
//! Source: ours.

use crate::id_vec::Id;
use std::fmt;

/// A new kind of id: a `u32` newtype that prints as its letter and number.
#[macro_export]
macro_rules! id_type {
    ($(#[$doc:meta])* $name:ident, $letter:literal) => {
        $(#[$doc])*
        #[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
        #[repr(transparent)]
        pub struct $name(pub u32);

        impl $name {
            /// No id: larger than all others.
            pub const NONE: Self = Self(u32::MAX);

            /// Whether this is an id at all.
            #[inline]
            pub const fn is_some(self) -> bool {
                self.0 != u32::MAX
            }

            /// Whether this is [`NONE`](Self::NONE).
            #[inline]
            pub const fn is_none(self) -> bool {
                self.0 == u32::MAX
            }

            /// The id as an index into an array.
            #[inline]
            pub const fn index(self) -> usize {
                self.0 as usize
            }

            /// The id of position `i` of an array.
            ///
            /// # Panics
            /// If `i` does not fit in a `u32`; arrays of this crate are checked against its limits first.
            #[inline]
            pub fn new(i: usize) -> Self {
                Self(u32::try_from(i).expect("id fits in u32: array lengths are checked on entry"))
            }
        }

        impl $crate::Id for $name {
            #[inline]
            fn at(i: usize) -> Self {
                debug_assert!(u32::try_from(i).is_ok());
                Self(i as u32)
            }

            #[inline]
            fn place(self) -> usize {
                self.0 as usize
            }
        }

        impl ::std::fmt::Display for $name {
            fn fmt(&self, f: &mut ::std::fmt::Formatter<'_>) -> ::std::fmt::Result {
                write!(f, concat!($letter, "{}"), self.0)
            }
        }

        impl ::std::fmt::Debug for $name {
            fn fmt(&self, f: &mut ::std::fmt::Formatter<'_>) -> ::std::fmt::Result {
                ::std::fmt::Display::fmt(self, f)
            }
        }

        impl From<u32> for $name {
            fn from(i: u32) -> Self {
                Self(i)
            }
        }
    };
}

id_type!(
    /// A vertex (0-based).
    VertexId, "v"
);
id_type!(
    /// A quad of a surface (0-based).
    QuadId, "q"
);
id_type!(
    /// A hexahedron of a mesh (0-based).
    HexId, "h"
);

/// A directed edge of a quad surface: side `i` of quad `q`, from corner `i` to corner `i + 1`, as `4 * q + i`.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug, Default)]
#[repr(transparent)]
pub struct Dart(pub u32);

impl Dart {
    /// No dart: larger than all others.
    pub const NONE: Self = Self(u32::MAX);

    /// Whether this is a dart at all.
    #[inline]
    pub const fn is_some(self) -> bool {
        self.0 != u32::MAX
    }

    /// Whether this is [`NONE`](Self::NONE).
    #[inline]
    pub const fn is_none(self) -> bool {
        self.0 == u32::MAX
    }

    /// The dart of side `side` (0..4) of `quad`.
    #[inline]
    pub const fn new(quad: QuadId, side: u32) -> Self {
        Self(4 * quad.0 + side)
    }

    /// The dart as an index.
    #[inline]
    pub const fn index(self) -> usize {
        self.0 as usize
    }

    /// The quad on the left of the dart.
    #[inline]
    pub const fn quad(self) -> QuadId {
        QuadId(self.0 / 4)
    }

    /// The side (0..4) of the quad.
    #[inline]
    pub const fn side(self) -> usize {
        (self.0 % 4) as usize
    }

    /// The next dart round the quad.
    #[inline]
    pub const fn next(self) -> Self {
        Self((self.0 & !3) | ((self.0 + 1) & 3))
    }

    /// The dart opposite in the quad.
    #[inline]
    pub const fn opposite(self) -> Self {
        Self(self.0 ^ 2)
    }

    /// The previous dart round the quad.
    #[inline]
    pub const fn prev(self) -> Self {
        Self((self.0 & !3) | ((self.0 + 3) & 3))
    }
}

impl Id for Dart {
    #[inline]
    fn at(i: usize) -> Self {
        debug_assert!(u32::try_from(i).is_ok());
        Self(i as u32)
    }

    #[inline]
    fn place(self) -> usize {
        self.index()
    }
}

/// The first few offenders of a kind, and how many there are in all.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Offenders<T> {
    /// The first offenders, at most [`Offenders::SHOWN`].
    pub first: Vec<T>,
    /// How many there are in all.
    pub count: usize,
}

impl<T> Default for Offenders<T> {
    fn default() -> Self {
        Self { first: Vec::new(), count: 0 }
    }
}

impl<T> Offenders<T> {
    /// How many offenders are kept.
    pub const SHOWN: usize = 10;

    /// Counts one more offender and keeps it if there is room.
    pub fn push(&mut self, offender: T) {
        if self.first.len() < Self::SHOWN {
            self.first.push(offender);
        }
        self.count += 1;
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }
}

impl<T> FromIterator<T> for Offenders<T> {
    fn from_iter<I: IntoIterator<Item = T>>(items: I) -> Self {
        let mut all = Self::default();
        items.into_iter().for_each(|item| all.push(item));
        all
    }
}

impl<T: fmt::Display> fmt::Display for Offenders<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, item) in self.first.iter().enumerate() {
            write!(f, "{}{item}", if i == 0 { "" } else { ", " })?;
        }
        let rest = self.count - self.first.len();
        if rest > 0 { write!(f, " and {rest} more") } else { Ok(()) }
    }
}

/// An undirected edge, printed as `v1-v2`.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Edge(pub VertexId, pub VertexId);

impl Edge {
    /// The edge between `a` and `b`, smaller id first.
    pub fn new(a: VertexId, b: VertexId) -> Self {
        if a < b { Self(a, b) } else { Self(b, a) }
    }
}

impl fmt::Display for Edge {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}-{}", self.0, self.1)
    }
}
