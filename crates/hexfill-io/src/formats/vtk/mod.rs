//! Legacy VTK files. Read: versions 2.0 to 5.1, ASCII and binary, `POLYDATA` and `UNSTRUCTURED_GRID`. Written: version 3.0
//! with one point and one cell a line, the only flavour that VTK, meshio, Gmsh and HexaLab all read.
//!
//! Source: the VTK formats, "Simple Legacy Formats".

pub(crate) mod cells;
mod read;
mod write;

pub(crate) use read::read;
pub(crate) use write::write;

/// A type of array elements, by its name in legacy files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Scalar {
    Bit,
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

impl Scalar {
    fn from_legacy_name(name: &str) -> Option<Self> {
        Some(match name.to_ascii_lowercase().as_str() {
            "bit" => Self::Bit,
            "char" | "signed_char" => Self::I8,
            "unsigned_char" => Self::U8,
            "short" => Self::I16,
            "unsigned_short" => Self::U16,
            // vtkIdType is written as `int` whatever its size in memory.
            "int" | "vtkidtype" => Self::I32,
            "unsigned_int" => Self::U32,
            "long" | "long_long" | "vtktypeint64" => Self::I64,
            "unsigned_long" | "unsigned_long_long" | "vtktypeuint64" => Self::U64,
            "float" => Self::F32,
            "double" => Self::F64,
            _ => return None,
        })
    }

    pub(crate) fn from_xml_name(name: &str) -> Option<Self> {
        Some(match name {
            "Int8" => Self::I8,
            "UInt8" => Self::U8,
            "Int16" => Self::I16,
            "UInt16" => Self::U16,
            "Int32" => Self::I32,
            "UInt32" => Self::U32,
            "Int64" => Self::I64,
            "UInt64" => Self::U64,
            "Float32" => Self::F32,
            "Float64" => Self::F64,
            _ => return None,
        })
    }

    pub(crate) fn is_whole(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }

    /// Bytes of one element (0 for bits, which are packed).
    pub(crate) fn size(self) -> usize {
        match self {
            Self::Bit => 0,
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    /// Decodes packed elements.
    pub(crate) fn decode(self, bytes: &[u8], big_endian: bool) -> crate::assembly::Values {
        use crate::assembly::Values;
        macro_rules! unpack {
            ($type:ty, $variant:ident, $as:ty) => {
                Values::$variant(
                    bytes
                        .chunks_exact(std::mem::size_of::<$type>())
                        .map(|chunk| {
                            let chunk = chunk.try_into().unwrap_or_default();
                            (if big_endian { <$type>::from_be_bytes(chunk) } else { <$type>::from_le_bytes(chunk) })
                                as $as
                        })
                        .collect(),
                )
            };
        }
        match self {
            Self::Bit => {
                Values::Whole(bytes.iter().flat_map(|b| (0..8).rev().map(move |k| i64::from(b >> k & 1))).collect())
            }
            Self::I8 => unpack!(i8, Whole, i64),
            Self::U8 => unpack!(u8, Whole, i64),
            Self::I16 => unpack!(i16, Whole, i64),
            Self::U16 => unpack!(u16, Whole, i64),
            Self::I32 => unpack!(i32, Whole, i64),
            Self::U32 => unpack!(u32, Whole, i64),
            Self::I64 => unpack!(i64, Whole, i64),
            // Beyond 2^63 this becomes negative: no index, and no tag anyone uses.
            Self::U64 => unpack!(u64, Whole, i64),
            Self::F32 => unpack!(f32, Real, f64),
            Self::F64 => unpack!(f64, Real, f64),
        }
    }
}
