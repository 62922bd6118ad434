//! Ids as plain numbers in reports.
//!
//! Source: ours.

use hexfill_mesh::{Edge, HexId, QuadId, VertexId};
use serde::{Serialize, Serializer};

pub(crate) fn serialize_vertex<S: Serializer>(v: &VertexId, s: S) -> Result<S::Ok, S::Error> {
    s.serialize_u32(v.0)
}

pub(crate) fn serialize_hex<S: Serializer>(h: &HexId, s: S) -> Result<S::Ok, S::Error> {
    s.serialize_u32(h.0)
}

pub(crate) fn serialize_quad<S: Serializer>(q: &QuadId, s: S) -> Result<S::Ok, S::Error> {
    s.serialize_u32(q.0)
}

pub(crate) fn serialize_edge<S: Serializer>(e: &Edge, s: S) -> Result<S::Ok, S::Error> {
    [e.0.0, e.1.0].serialize(s)
}
