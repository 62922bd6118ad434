//! How much memory a file may ask for. Plain files get what their bytes are worth: nothing is reserved on the word of a count
//! ([`RESERVE`]). Compressed data can claim a thousand times their size, so what they unpack to is limited here, in one place.
//!
//! Source: ours.

use std::io;

/// Most items (or bytes) that are reserved on the word of a file.
pub(crate) const RESERVE: usize = 1 << 16;

/// Bytes that any compressed file may unpack to.
const UNPACKED_ALWAYS: u64 = 256 << 20;

/// Bytes more that each byte of the compressed file may unpack to. Meshes reach 5 to 10.
const UNPACKED_PER_BYTE: u64 = 16;

/// Most groups of a file, combinations of groups, and groups of one point, face or cell.
pub(crate) const GROUPS: usize = 1 << 20;
pub(crate) const GROUPS_OF_ONE: usize = 64;

/// Most bytes that `packed` bytes may unpack to.
pub(crate) fn unpacked(packed: u64) -> u64 {
    UNPACKED_ALWAYS.saturating_add(packed.saturating_mul(UNPACKED_PER_BYTE))
}

/// Most bytes that the arrays of a file of `bytes` may unpack to; of one that was unpacked itself, once is enough.
pub(crate) fn unpacked_inside(bytes: u64, was_packed: bool) -> u64 {
    if was_packed { UNPACKED_ALWAYS.saturating_add(bytes) } else { unpacked(bytes) }
}

/// The error of a reader that unpacks more.
pub(crate) fn bomb(packed: u64) -> io::Error {
    let text = format!(
        "{packed} compressed bytes unpack to more than {} bytes, the limit ({} MiB and {UNPACKED_PER_BYTE} for each byte); is it \
         meant to be a mesh? unpack it by hand first",
        unpacked(packed),
        UNPACKED_ALWAYS >> 20
    );
    io::Error::new(io::ErrorKind::InvalidData, text)
}
