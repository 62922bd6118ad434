//! The validity ladder and the rules on its rungs, with the names that code, command line and JSON share.
//!
//! Source: ours (book, page `definitions`, "The validity ladder"), and Weill for the rules `weill-*`.

use serde::{Serialize, Serializer};
use std::fmt;

/// A rung of the validity ladder. Each is judged on its own; a mesh is as good as its lowest failure.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug, Serialize)]
#[non_exhaustive]
pub enum Level {
    /// Indices and hex shape.
    L1,
    /// Face pairing and proper intersection.
    L2,
    /// Manifold, oriented, boundary = input, connected.
    L3,
    /// Positions finite, boundary bit-identical.
    L4,
    /// det J > 0 certified everywhere in every hex.
    L5,
}

impl Level {
    /// Every level, lowest first.
    pub const ALL: [Self; 5] = [Self::L1, Self::L2, Self::L3, Self::L4, Self::L5];

    /// What the level asks, in a few words.
    pub const fn title(self) -> &'static str {
        match self {
            Self::L1 => "indices and hex shape",
            Self::L2 => "face pairing and proper intersection",
            Self::L3 => "manifold, oriented, boundary = input",
            Self::L4 => "positions finite, boundary bit-identical",
            Self::L5 => "det J > 0 certified everywhere",
        }
    }
}

impl fmt::Display for Level {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(self, f)
    }
}

/// Which definition of a legal complex level 2 uses.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Rules {
    /// Proper intersection: two hexes share nothing, one vertex, one edge of both, or one quad of both.
    #[default]
    Strict,
    /// The rules of Weill's poster: the hexes are replayed in the given order, each glued on those before it.
    Weill,
}

macro_rules! rules {
    ($($(#[$doc:meta])* $name:ident = $id:literal @ $level:ident : $meaning:literal;)*) => {
        /// A rule that a mesh can break. [`Rule::id`] is stable and is what JSON holds.
        #[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
        #[non_exhaustive]
        pub enum Rule { $(#[doc = $meaning] $name,)* }

        impl Rule {
            /// Every rule, in order of level.
            pub const ALL: &'static [Self] = &[$(Self::$name,)*];

            /// The stable name.
            pub const fn id(self) -> &'static str {
                match self { $(Self::$name => $id,)* }
            }

            /// The level the rule belongs to.
            pub const fn level(self) -> Level {
                match self { $(Self::$name => Level::$level,)* }
            }

            /// What is wrong when the rule is broken, in one sentence.
            pub const fn meaning(self) -> &'static str {
                match self { $(Self::$name => $meaning,)* }
            }
        }
    };
}

rules! {
    MeshEmpty = "mesh-empty" @ L1: "the mesh has no hex";
    TooLarge = "too-large" @ L1: "more hexes, quads or vertices than the ids can name";
    IndexOutOfRange = "index-out-of-range" @ L1: "a hex uses a vertex index beyond the vertices";
    HexRepeatsVertex = "hex-repeats-vertex" @ L1: "a hex uses a vertex twice";
    SurfaceIndexOutOfRange = "surface-index-out-of-range" @ L1: "a surface quad uses a vertex index beyond the vertices";
    SurfaceQuadRepeatsVertex = "surface-quad-repeats-vertex" @ L1: "a surface quad uses a vertex twice";

    HexDuplicated = "hex-duplicated" @ L2: "two hexes have the same eight vertices";
    QuadInThreeHexes = "quad-in-three-hexes" @ L2: "a quad belongs to more than two hexes";
    QuadTwisted = "quad-twisted" @ L2: "two hexes have the same four vertices as a quad, in different cyclic orders";
    EdgeIsFaceDiagonal = "edge-is-face-diagonal" @ L2: "an edge of one hex is a face diagonal of another";
    EdgeIsBodyDiagonal = "edge-is-body-diagonal" @ L2: "an edge of one hex is a body diagonal of another";
    FaceDiagonalOfTwoQuads = "face-diagonal-of-two-quads" @ L2: "two different quads share both ends of a diagonal";
    FaceDiagonalIsBodyDiagonal = "face-diagonal-is-body-diagonal" @ L2: "a face diagonal of one hex is a body diagonal of another";
    BodyDiagonalShared = "body-diagonal-shared" @ L2: "two hexes share both ends of a body diagonal";
    WeillNotGlued = "weill-not-glued" @ L2: "a hex is glued to no exterior quad of the hexes before it";
    WeillMergesVertex = "weill-merges-vertex" @ L2: "a corner of the new hex outside its glued facets is an old vertex";
    WeillQuadNotExterior = "weill-quad-not-exterior" @ L2: "a facet of the new hex is a quad that is already interior, or one in another cyclic order";
    WeillFreeFacetTouches = "weill-free-facet-touches" @ L2: "a free facet of the new hex shares more than two vertices with an earlier hex";
    WeillSharesFive = "weill-shares-five" @ L2: "a new hex shares more than four vertices with an earlier hex";
    WeillBoundaryEdge = "weill-boundary-edge" @ L2: "after gluing, a boundary edge is not in exactly two boundary quads";

    SurfaceQuadRepeated = "surface-quad-repeated" @ L3: "two surface quads have the same four vertices";
    BoundaryQuadMissing = "boundary-quad-missing" @ L3: "a surface quad is not a boundary quad of the mesh";
    BoundaryQuadExtra = "boundary-quad-extra" @ L3: "a boundary quad of the mesh is not in the surface";
    BoundaryQuadTwisted = "boundary-quad-twisted" @ L3: "a boundary quad has the vertices of a surface quad in another cyclic order";
    EdgePinched = "edge-pinched" @ L3: "the hexes round an edge do not form one fan";
    VertexPinched = "vertex-pinched" @ L3: "the hexes round a vertex fall apart into pieces that meet only in the vertex";
    VertexLinkNotDisk = "vertex-link-not-disk" @ L3: "the link of a boundary vertex is a surface, but not a disk";
    VertexLinkNotSphere = "vertex-link-not-sphere" @ L3: "the link of an interior vertex is a surface, but not a sphere";
    NonOrientable = "non-orientable" @ L3: "a part of the mesh cannot be oriented";
    OrientationClash = "orientation-clash" @ L3: "two hexes on a quad are ordered in opposite senses";
    HexReflected = "hex-reflected" @ L3: "a hex is ordered in the opposite sense to the majority of its part of the mesh";
    MeshDisconnected = "mesh-disconnected" @ L3: "the mesh has more parts than allowed";

    PointsCount = "points-count" @ L4: "the number of positions is not the number of vertices";
    PositionNotFinite = "position-not-finite" @ L4: "a position is infinite or not a number";
    BoundaryMoved = "boundary-moved" @ L4: "the position of a surface vertex is not bit-identical to the one given";

    HexInsideOut = "hex-inside-out" @ L5: "det J is negative at all eight corners: the corners are listed in mirrored order";
    JacobianNotPositive = "jacobian-not-positive" @ L5: "det J is zero or negative at a point of the hex (proved in exact arithmetic)";
    JacobianUndecided = "jacobian-undecided" @ L5: "positivity of det J was not decided within the depth limit";
}

impl Rule {
    /// The rule of a stable name.
    pub fn from_id(id: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|r| r.id() == id)
    }
}

impl fmt::Display for Rule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.id())
    }
}

impl Serialize for Rule {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.id())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_are_distinct_and_found_again() {
        for (i, &rule) in Rule::ALL.iter().enumerate() {
            assert_eq!(Rule::from_id(rule.id()), Some(rule));
            assert!(Rule::ALL[..i].iter().all(|r| r.level() <= rule.level()), "{rule} in order of level");
        }
    }
}
