//! The bytes of VTK XML arrays: base64 with padding in the middle, block headers, zlib.
//!
//! Source: the VTK formats, "XML File Formats"; RFC 4648 (base64), RFC 1950 (zlib).

use crate::source::reserve;
use flate2::read::ZlibDecoder;
use std::io::Read;

/// How binary arrays of a file are laid out.
#[derive(Clone, Copy)]
pub(crate) struct Layout {
    pub(crate) big_endian: bool,
    /// 4 or 8.
    pub(crate) header_size: usize,
    pub(crate) zlib: bool,
}

/// Bytes taken from the front, decoded as they go.
pub(crate) enum Bytes<'a> {
    Raw(&'a [u8]),
    Base64 { text: &'a [u8], pending: Vec<u8> },
}

impl<'a> Bytes<'a> {
    pub(crate) fn base64(text: &'a [u8]) -> Self {
        Self::Base64 { text, pending: Vec::new() }
    }

    /// The next `n` bytes; `None` if there are fewer or the text is not base64.
    fn take(&mut self, n: u64) -> Option<Vec<u8>> {
        let n = usize::try_from(n).ok()?;
        match self {
            Self::Raw(bytes) => {
                let (head, tail) = bytes.split_at_checked(n)?;
                *bytes = tail;
                Some(head.to_vec())
            }
            Self::Base64 { text, pending } => {
                if n > pending.len() + text.len() {
                    return None;
                }
                while pending.len() < n {
                    decode_group(text, pending)?;
                }
                let rest = pending.split_off(n);
                Some(std::mem::replace(pending, rest))
            }
        }
    }
}

/// Decodes the next four characters. A padded group does not end the data: VTK encodes header and data one by one.
fn decode_group(text: &mut &[u8], out: &mut Vec<u8>) -> Option<()> {
    let mut bits = 0u32;
    let mut letters = 0;
    let mut padding = 0;
    while letters + padding < 4 {
        let (&byte, rest) = text.split_first()?;
        *text = rest;
        let value = match byte {
            b'A'..=b'Z' => byte - b'A',
            b'a'..=b'z' => byte - b'a' + 26,
            b'0'..=b'9' => byte - b'0' + 52,
            b'+' => 62,
            b'/' => 63,
            b'=' if letters >= 2 => {
                padding += 1;
                continue;
            }
            _ if byte.is_ascii_whitespace() => continue,
            _ => return None,
        };
        if padding > 0 {
            return None;
        }
        bits = bits << 6 | u32::from(value);
        letters += 1;
    }
    bits <<= 6 * padding;
    let bytes = bits.to_be_bytes();
    out.extend_from_slice(&bytes[1..4 - padding]);
    Some(())
}

/// The bytes of one array: header, then plain data or zlib blocks. They are at most `limit`.
///
/// # Errors
/// What is wrong, as text.
pub(crate) fn unpack(mut bytes: Bytes<'_>, layout: Layout, limit: u64) -> Result<Vec<u8>, &'static str> {
    const LARGE: &str = "data beyond the memory limit (256 MiB and 16 bytes for each byte of the file)";
    const SHORT: &str = "data that ends too early, or is not base64";
    let h = layout.header_size as u64;
    let number = |chunk: &[u8]| match (<[u8; 4]>::try_from(chunk), <[u8; 8]>::try_from(chunk), layout.big_endian) {
        (Ok(b), _, false) => u64::from(u32::from_le_bytes(b)),
        (Ok(b), _, true) => u64::from(u32::from_be_bytes(b)),
        (_, Ok(b), false) => u64::from_le_bytes(b),
        (_, Ok(b), true) => u64::from_be_bytes(b),
        _ => 0,
    };
    let first = number(&bytes.take(h).ok_or(SHORT)?);
    if !layout.zlib {
        return if first > limit { Err(LARGE) } else { bytes.take(first).ok_or(SHORT) };
    }
    if first == 0 {
        return Ok(Vec::new());
    }
    let sizes = bytes.take(first.checked_add(2).and_then(|n| n.checked_mul(h)).ok_or(SHORT)?).ok_or(SHORT)?;
    let sizes: Vec<u64> = sizes.chunks_exact(layout.header_size).map(number).collect();
    let (block_size, last_size) = (sizes[0], sizes[1]);
    let mut out = Vec::with_capacity(reserve(first.saturating_mul(block_size)));
    for (i, &packed) in sizes[2..].iter().enumerate() {
        let is_last = i as u64 + 1 == first;
        let due = if is_last && last_size != 0 { last_size } else { block_size };
        if due > limit - out.len() as u64 {
            return Err(LARGE);
        }
        let block = bytes.take(packed).ok_or(SHORT)?;
        let got = ZlibDecoder::new(block.as_slice()).take(due).read_to_end(&mut out);
        if got.ok() != usize::try_from(due).ok() {
            return Err("a damaged zlib block");
        }
    }
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLAIN: Layout = Layout { big_endian: false, header_size: 4, zlib: false };

    #[test]
    fn header_and_data_in_one_or_two_pieces() {
        // 3 bytes "abc", encoded as one text and as two.
        assert_eq!(unpack(Bytes::base64(b"AwAAAGFiYw=="), PLAIN, 9).unwrap(), b"abc");
        assert_eq!(unpack(Bytes::base64(b" AwAA AA==\nYWJj "), PLAIN, 9).unwrap(), b"abc");
        assert_eq!(unpack(Bytes::Raw(b"\x03\0\0\0abcd"), PLAIN, 9).unwrap(), b"abc");
        for bad in ["AwAAAGFi", "Aw=AAGFiYw==", "AwAA*GFiYw==", "", "////////"] {
            assert!(unpack(Bytes::base64(bad.as_bytes()), PLAIN, 9).is_err(), "{bad}");
        }
    }

    #[test]
    fn claims_are_not_believed() {
        let layout = Layout { big_endian: false, header_size: 8, zlib: true };
        for claim in [u64::MAX, u64::MAX / 8, 1 << 40] {
            let mut bytes = claim.to_le_bytes().to_vec();
            bytes.extend([0; 64]);
            assert!(unpack(Bytes::Raw(&bytes), layout, u64::MAX).is_err());
        }
    }
}
