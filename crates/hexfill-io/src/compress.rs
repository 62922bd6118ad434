//! gzip and Zstandard, recognised by their first bytes on reading and by the extension on writing.
//!
//! Source: RFC 1952 (gzip) and RFC 8878 (Zstandard) for the first bytes.

use crate::format::Compression;
use crate::limits;
use flate2::read::MultiGzDecoder;
use flate2::write::GzEncoder;
use ruzstd::decoding::errors::{FrameDecoderError, ReadFrameHeaderError};
use ruzstd::decoding::{BlockDecodingStrategy, FrameDecoder};
use ruzstd::encoding::{CompressionLevel, compress_to_vec};
use std::cell::Cell;
use std::io::{self, BufRead, BufReader, Cursor, Read, Write};
use std::rc::Rc;

const BUFFER: usize = 1 << 18;

/// Unpacks `reader` if its first bytes say that it is packed.
pub(crate) fn unpacked<'r>(mut reader: impl Read + 'r) -> io::Result<(Box<dyn BufRead + 'r>, Option<Compression>)> {
    let mut head = Vec::with_capacity(4);
    reader.by_ref().take(4).read_to_end(&mut head)?;
    let compression = match head.as_slice() {
        [0x1f, 0x8b, ..] => Some(Compression::Gzip),
        [0x28, 0xb5, 0x2f, 0xfd] | [0x50..=0x5f, 0x2a, 0x4d, 0x18] => Some(Compression::Zstd),
        _ => None,
    };
    let packed = Rc::new(Cell::new(0));
    let counted = Counted { source: Cursor::new(head).chain(reader), count: Rc::clone(&packed) };
    let whole = BufReader::with_capacity(BUFFER, counted);
    let limited = |unpacker: Box<dyn Read + 'r>| -> Box<dyn BufRead + 'r> {
        Box::new(BufReader::with_capacity(BUFFER, Limited { unpacker, packed, unpacked: 0 }))
    };
    let unpacked: Box<dyn BufRead + 'r> = match compression {
        None => Box::new(whole),
        Some(Compression::Gzip) => limited(Box::new(MultiGzDecoder::new(whole))),
        Some(Compression::Zstd) => limited(Box::new(ZstdReader::new(whole))),
    };
    Ok((unpacked, compression))
}

/// Counts the bytes that are read.
struct Counted<R> {
    source: R,
    count: Rc<Cell<u64>>,
}

impl<R: Read> Read for Counted<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let n = self.source.read(buffer)?;
        self.count.set(self.count.get() + n as u64);
        Ok(n)
    }
}

/// Stops an unpacker that makes too much of its bytes.
struct Limited<'r> {
    unpacker: Box<dyn Read + 'r>,
    packed: Rc<Cell<u64>>,
    unpacked: u64,
}

impl Read for Limited<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let n = self.unpacker.read(buffer)?;
        self.unpacked += n as u64;
        let packed = self.packed.get();
        if self.unpacked > limits::unpacked(packed) { Err(limits::bomb(packed)) } else { Ok(n) }
    }
}

/// All frames of a Zstandard stream, one after the other, checksums verified.
struct ZstdReader<R> {
    source: R,
    decoder: FrameDecoder,
    in_frame: bool,
}

impl<R: BufRead> ZstdReader<R> {
    fn new(source: R) -> Self {
        Self { source, decoder: FrameDecoder::new(), in_frame: false }
    }

    /// Opens the next frame; false at the end of the file.
    fn next_frame(&mut self) -> io::Result<bool> {
        loop {
            if self.source.fill_buf()?.is_empty() {
                return Ok(false);
            }
            match self.decoder.reset(&mut self.source) {
                Ok(()) => return Ok(true),
                Err(FrameDecoderError::ReadFrameHeaderError(ReadFrameHeaderError::SkipFrame { length, .. })) => {
                    let skipped = io::copy(&mut self.source.by_ref().take(u64::from(length)), &mut io::sink())?;
                    if skipped < u64::from(length) {
                        return Err(io::ErrorKind::UnexpectedEof.into());
                    }
                }
                Err(e) => return Err(damaged(&e)),
            }
        }
    }
}

fn damaged(error: &(dyn std::error::Error + 'static)) -> io::Error {
    // An early end is somewhere down the chain of causes.
    let mut cause: Option<&(dyn std::error::Error + 'static)> = Some(error);
    while let Some(e) = cause {
        if e.downcast_ref::<io::Error>().is_some_and(|e| e.kind() == io::ErrorKind::UnexpectedEof) {
            return io::ErrorKind::UnexpectedEof.into();
        }
        cause = e.source();
    }
    io::Error::new(io::ErrorKind::InvalidData, format!("damaged Zstandard data: {error}"))
}

impl<R: BufRead> Read for ZstdReader<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        loop {
            if buffer.is_empty() || (!self.in_frame && !self.next_frame()?) {
                return Ok(0);
            }
            self.in_frame = true;
            while self.decoder.can_collect() == 0 && !self.decoder.is_finished() {
                let step = BlockDecodingStrategy::UptoBytes(buffer.len());
                self.decoder.decode_blocks(&mut self.source, step).map_err(|e| damaged(&e))?;
            }
            let n = self.decoder.read(buffer)?;
            if n > 0 {
                return Ok(n);
            }
            let (stored, computed) = (self.decoder.get_checksum_from_data(), self.decoder.get_calculated_checksum());
            if stored.is_some() && stored != computed {
                return Err(io::Error::new(io::ErrorKind::InvalidData, "damaged Zstandard data: checksum differs"));
            }
            self.in_frame = false;
        }
    }
}

/// A writer that packs, to be closed with [`finish`](Self::finish).
pub(crate) enum Packer<W: Write> {
    /// Not packed.
    Plain(W),
    /// gzip.
    Gzip(Box<GzEncoder<W>>),
    /// Zstandard.
    Zstd(ZstdWriter<W>),
}

impl<W: Write> Packer<W> {
    pub(crate) fn new(writer: W, compression: Option<Compression>) -> Self {
        match compression {
            None => Self::Plain(writer),
            Some(Compression::Gzip) => {
                // No file name and no time in the header: same bytes every time.
                Self::Gzip(Box::new(flate2::GzBuilder::new().write(writer, flate2::Compression::default())))
            }
            Some(Compression::Zstd) => Self::Zstd(ZstdWriter { writer, block: Vec::new(), any: false }),
        }
    }

    /// Writes what is left and gives the inner writer back.
    pub(crate) fn finish(self) -> io::Result<W> {
        match self {
            Self::Plain(writer) => Ok(writer),
            Self::Gzip(encoder) => encoder.finish(),
            Self::Zstd(mut zstd) => {
                if !zstd.block.is_empty() || !zstd.any {
                    zstd.write_frame()?;
                }
                Ok(zstd.writer)
            }
        }
    }
}

impl<W: Write> Write for Packer<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Self::Plain(w) => w.write(bytes),
            Self::Gzip(w) => w.write(bytes),
            Self::Zstd(w) => w.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::Plain(w) => w.flush(),
            Self::Gzip(w) => w.flush(),
            Self::Zstd(_) => Ok(()), // a frame is written when it is full or at the end
        }
    }
}

/// Zstandard as a row of frames of a few megabytes each: the encoder wants its input whole.
pub(crate) struct ZstdWriter<W: Write> {
    writer: W,
    block: Vec<u8>,
    any: bool,
}

const FRAME: usize = 1 << 22;

impl<W: Write> ZstdWriter<W> {
    fn write_frame(&mut self) -> io::Result<()> {
        let packed = compress_to_vec(self.block.as_slice(), CompressionLevel::Fastest);
        self.block.clear();
        self.any = true;
        self.writer.write_all(&packed)
    }
}

impl<W: Write> Write for ZstdWriter<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let n = bytes.len().min(FRAME - self.block.len());
        self.block.extend_from_slice(&bytes[..n]);
        if self.block.len() == FRAME {
            self.write_frame()?;
        }
        Ok(n)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pack(data: &[u8], compression: Compression) -> Vec<u8> {
        let mut packer = Packer::new(Vec::new(), Some(compression));
        packer.write_all(data).unwrap();
        packer.finish().unwrap()
    }

    fn unpack(data: &[u8]) -> io::Result<Vec<u8>> {
        let mut out = Vec::new();
        unpacked(data)?.0.read_to_end(&mut out)?;
        Ok(out)
    }

    #[test]
    fn round_trips_in_one_and_many_frames() {
        let long: Vec<u8> = (0..2 * FRAME + 77).map(|i| (i % 251) as u8 ^ (i >> 9) as u8).collect();
        for compression in [Compression::Gzip, Compression::Zstd] {
            for data in [&[] as &[u8], b"a", b"v 0 0 0\n", &long] {
                assert!(unpack(&pack(data, compression)).unwrap() == data, "{compression:?} {}", data.len());
            }
            let mut twice = pack(b"first ", compression);
            twice.extend(pack(b"second", compression));
            assert_eq!(unpack(&twice).unwrap(), b"first second");
        }
    }

    #[test]
    fn damage_is_an_error() {
        let data: Vec<u8> = (0..50_000u32).flat_map(u32::to_le_bytes).collect();
        for compression in [Compression::Gzip, Compression::Zstd] {
            let packed = pack(&data, compression);
            for cut in [5, packed.len() / 2, packed.len() - 1] {
                assert!(unpack(&packed[..cut]).is_err(), "{compression:?} cut at {cut}");
            }
            let mut flipped = packed.clone();
            let middle = flipped.len() / 2;
            flipped[middle] ^= 0x55;
            assert!(unpack(&flipped).is_err(), "{compression:?}");
        }
    }

    #[test]
    fn bombs_are_stopped_at_the_limit() {
        // Zeros, packed by the thousand: 300 MiB of them.
        let mut gzip = Packer::new(Vec::new(), Some(Compression::Gzip));
        let zeros = vec![0; 1 << 20];
        (0..300).for_each(|_| gzip.write_all(&zeros).unwrap());
        let mut zstd = Packer::new(Vec::new(), Some(Compression::Zstd));
        (0..300).for_each(|_| zstd.write_all(&zeros).unwrap());
        for bomb in [gzip.finish().unwrap(), zstd.finish().unwrap()] {
            let (mut reader, _) = unpacked(bomb.as_slice()).unwrap();
            let error = io::copy(&mut reader, &mut io::sink()).unwrap_err().to_string();
            assert!(error.contains("the limit (256 MiB"), "{error}");
        }
    }

    #[test]
    fn skippable_frames_are_skipped() {
        let mut stream = vec![0x50, 0x2a, 0x4d, 0x18, 3, 0, 0, 0, 1, 2, 3];
        stream.extend(pack(b"data", Compression::Zstd));
        assert_eq!(unpack(&stream).unwrap(), b"data");
    }
}
