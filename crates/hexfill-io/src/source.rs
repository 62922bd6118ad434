//! [`Source`]: a text file read line by line and word by word, which always knows where it is.
//!
//! One line at a time is in memory. Counts claimed by a file are never trusted: vectors are reserved for at most
//! [`RESERVE`] items and grow with what really arrives, and binary blocks are read through a limit.
//!
//! Source: ours.

use crate::data::TagName;
use crate::error::{Place, Position, ReadError, snippet};
use crate::format::Format;
use crate::limits::RESERVE;
use std::fmt::Display;
use std::io::{self, BufRead, Read};

/// Capacity to reserve for a claimed count.
pub(crate) fn reserve(claimed: u64) -> usize {
    usize::try_from(claimed).unwrap_or(usize::MAX).min(RESERVE)
}

/// First and one-past-last byte of a word in the current line.
pub(crate) type Span = (usize, usize);

/// A buffered file, its current line and the place in it.
pub(crate) struct Source<'r> {
    reader: Box<dyn BufRead + 'r>,
    file: String,
    format: Format,
    line: Vec<u8>,
    cursor: usize,
    number: u64,
    /// Bytes consumed, the current line included.
    consumed: u64,
    /// A word that starts with this byte ends the line (a comment).
    comment: Option<u8>,
    /// Bytes that separate words besides white space.
    comma: bool,
    binary: bool,
    /// The current line is to be read once more.
    again: bool,
    /// The bytes come out of gzip or Zstandard.
    packed: bool,
    /// Names of tags in comments of this program.
    tag_names: Vec<TagName>,
}

impl<'r> Source<'r> {
    pub(crate) fn new(reader: Box<dyn BufRead + 'r>, file: &str, format: Format) -> Self {
        Self {
            reader,
            file: file.to_owned(),
            format,
            line: Vec::new(),
            cursor: 0,
            number: 0,
            consumed: 0,
            comment: None,
            comma: false,
            binary: false,
            again: false,
            packed: false,
            tag_names: Vec::new(),
        }
    }

    /// Comments run from this byte (at the start of a word) to the end of the line.
    pub(crate) fn with_comments(mut self, byte: u8) -> Self {
        self.comment = Some(byte);
        self
    }

    /// The file is compressed as a whole.
    pub(crate) fn with_packed(mut self, packed: bool) -> Self {
        self.packed = packed;
        self
    }

    pub(crate) fn is_packed(&self) -> bool {
        self.packed
    }

    /// Commas separate words, too.
    pub(crate) fn with_commas(mut self) -> Self {
        self.comma = true;
        self
    }

    /// From now on places are given in bytes.
    pub(crate) fn set_binary(&mut self, binary: bool) {
        self.binary = binary;
    }

    pub(crate) fn file(&self) -> &str {
        &self.file
    }

    pub(crate) fn format(&self) -> Format {
        self.format
    }

    /// A sniffed format replaces the one assumed.
    pub(crate) fn set_format(&mut self, format: Format) {
        self.format = format;
    }

    /// Number of the current line, from 1; 0 before the first.
    pub(crate) fn line_number(&self) -> u64 {
        self.number
    }

    /// The current line without its end.
    pub(crate) fn line(&self) -> &[u8] {
        &self.line
    }

    /// Reads the next line; false at the end of the file. What is left of the current line is dropped.
    pub(crate) fn next_line(&mut self) -> Result<bool, ReadError> {
        self.cursor = 0;
        if std::mem::take(&mut self.again) {
            return Ok(true);
        }
        self.line.clear();
        match self.reader.read_until(b'\n', &mut self.line) {
            Ok(0) => return Ok(false),
            Ok(n) => self.consumed += n as u64,
            Err(e) => return Err(self.io_error(e)),
        }
        self.number += 1;
        while matches!(self.line.last(), Some(b'\n' | b'\r')) {
            self.line.pop();
        }
        if self.number == 1 && self.line.starts_with(b"\xef\xbb\xbf") {
            self.cursor = 3; // a byte order mark
        }
        if let (Some(comment), Some((first, text))) = (self.comment, self.line.split_first())
            && *first == comment
        {
            self.tag_names.extend(std::str::from_utf8(text).ok().and_then(TagName::from_line));
        }
        Ok(true)
    }

    /// The next call of [`next_line`](Self::next_line) gives the current line once more.
    pub(crate) fn unread_line(&mut self) {
        self.again = true;
    }

    /// Reads the next line that has a word; false at the end of the file.
    pub(crate) fn next_full_line(&mut self) -> Result<bool, ReadError> {
        while self.next_line()? {
            if self.peek_word().is_some() {
                return Ok(true);
            }
        }
        Ok(false)
    }

    fn separates(&self, byte: u8) -> bool {
        byte.is_ascii_whitespace() || byte == 0x0b || (self.comma && byte == b',')
    }

    /// The next word of the current line.
    pub(crate) fn word(&mut self) -> Option<Span> {
        let span = self.peek_word()?;
        self.cursor = span.1;
        Some(span)
    }

    /// The next word of the current line, left where it is.
    pub(crate) fn peek_word(&self) -> Option<Span> {
        let rest = &self.line[self.cursor.min(self.line.len())..];
        let start = self.cursor + rest.iter().position(|&b| !self.separates(b))?;
        if self.comment == Some(self.line[start]) {
            return None;
        }
        let length = self.line[start..].iter().position(|&b| self.separates(b));
        Some((start, length.map_or(self.line.len(), |n| start + n)))
    }

    /// The next word of the file, on this line or a later one.
    pub(crate) fn word_anywhere(&mut self) -> Result<Option<Span>, ReadError> {
        loop {
            if let Some(span) = self.word() {
                return Ok(Some(span));
            }
            if !self.next_line()? {
                self.line.clear();
                self.cursor = 0;
                return Ok(None);
            }
        }
    }

    /// Puts a word back: it is read next.
    pub(crate) fn unread(&mut self, span: Span) {
        self.cursor = span.0;
    }

    /// The bytes of a word of the current line.
    pub(crate) fn text(&self, span: Span) -> &[u8] {
        &self.line[span.0..span.1]
    }

    /// The word as text for names; bytes that are not UTF-8 are replaced.
    pub(crate) fn string(&self, span: Span) -> String {
        String::from_utf8_lossy(self.text(span)).into_owned()
    }

    /// The rest of the current line after the last word read.
    pub(crate) fn rest(&self) -> &[u8] {
        self.line[self.cursor.min(self.line.len())..].trim_ascii()
    }

    pub(crate) fn place(&self) -> Box<Place> {
        let position = if self.binary {
            Position::Byte(self.consumed)
        } else if self.number == 0 {
            Position::Whole
        } else {
            Position::Line(self.number)
        };
        Box::new(Place { file: self.file.clone(), format: self.format, position })
    }

    pub(crate) fn place_at_line(&self, line: u64) -> Box<Place> {
        Box::new(Place { file: self.file.clone(), format: self.format, position: Position::Line(line) })
    }

    pub(crate) fn io_error(&self, source: io::Error) -> ReadError {
        if source.kind() == io::ErrorKind::UnexpectedEof {
            // Only decompressors say this.
            return self.truncated("the rest of the compressed data");
        }
        ReadError::Io { file: self.file.clone(), source }
    }

    pub(crate) fn truncated(&self, expected: impl Into<String>) -> ReadError {
        ReadError::Truncated { at: self.place(), expected: expected.into() }
    }

    pub(crate) fn empty(&self) -> ReadError {
        ReadError::Empty { file: self.file.clone(), format: self.format }
    }

    /// Error about a word of the current line.
    pub(crate) fn malformed(&self, expected: impl Into<String>, given: Span, remedy: &str) -> ReadError {
        self.malformed_text(expected, snippet(self.text(given)), remedy)
    }

    /// Error with free words for what was found.
    pub(crate) fn malformed_text(&self, expected: impl Into<String>, given: String, remedy: &str) -> ReadError {
        ReadError::Malformed { at: self.place(), expected: expected.into(), given, remedy: remedy.to_owned() }
    }

    pub(crate) fn unsupported(&self, what: impl Into<String>, remedy: impl Into<String>) -> ReadError {
        ReadError::Unsupported { at: self.place(), what: what.into(), remedy: remedy.into() }
    }

    /// A word on this line, or an error that says what is missing.
    pub(crate) fn need_word(&mut self, what: &str) -> Result<Span, ReadError> {
        self.word().ok_or_else(|| {
            self.malformed_text(
                what,
                "the end of the line".to_owned(),
                "complete the line, or split it as the format asks",
            )
        })
    }

    /// As [`need_word`](Self::need_word), for inner loops: the message is made only if it is needed.
    pub(crate) fn need_word_or(&mut self, what: impl FnOnce() -> String) -> Result<Span, ReadError> {
        match self.word() {
            Some(span) => Ok(span),
            None => self.need_word(&what()),
        }
    }

    /// As [`need_word_anywhere`](Self::need_word_anywhere), for inner loops.
    pub(crate) fn need_word_anywhere_or(&mut self, what: impl FnOnce() -> String) -> Result<Span, ReadError> {
        match self.word_anywhere()? {
            Some(span) => Ok(span),
            None => Err(self.truncated(what())),
        }
    }

    /// A word on this line or a later one, or [`ReadError::Truncated`].
    pub(crate) fn need_word_anywhere(&mut self, what: &str) -> Result<Span, ReadError> {
        match self.word_anywhere()? {
            Some(span) => Ok(span),
            None => Err(self.truncated(what)),
        }
    }

    /// A whole number.
    pub(crate) fn integer(&self, span: Span, what: &str) -> Result<i64, ReadError> {
        parse_integer(self.text(span)).ok_or_else(|| {
            self.malformed(format!("{what} (a whole number)"), span, "correct this word, or the counts before it")
        })
    }

    /// A count: a whole number that is not negative and within the limit of 32-bit ids.
    pub(crate) fn count(&self, span: Span, what: &str) -> Result<u64, ReadError> {
        let Some(given) = parse_integer(self.text(span)) else {
            return Err(self.malformed(
                format!("the number of {what}"),
                span,
                "correct this word, or the counts before it",
            ));
        };
        let Ok(given) = u64::try_from(given) else {
            return Err(self.malformed(format!("the number of {what}"), span, "a count is not negative"));
        };
        let limit = u64::from(u32::MAX);
        if given > limit {
            return Err(ReadError::TooLarge { at: self.place(), what: what.to_owned(), given, limit });
        }
        Ok(given)
    }

    /// A finite coordinate.
    pub(crate) fn coordinate(&self, span: Span, what: &str) -> Result<f64, ReadError> {
        let value = self.number(span, what)?;
        if value.is_finite() {
            return Ok(value);
        }
        let given = String::from_utf8_lossy(self.text(span)).into_owned();
        Err(ReadError::NotFinite { at: self.place(), what: what.to_owned(), given })
    }

    /// Any number, NaN and infinities included.
    pub(crate) fn number(&self, span: Span, what: &str) -> Result<f64, ReadError> {
        parse_number(self.text(span)).ok_or_else(|| {
            self.malformed(format!("{what} (a number)"), span, "correct this word, or the counts before it")
        })
    }

    /// The three coordinates of point number `index`, from this line or from the following ones.
    pub(crate) fn point_anywhere(&mut self, index: u64, count: u64) -> Result<[f64; 3], ReadError> {
        let mut point = [0.0; 3];
        for (slot, axis) in point.iter_mut().zip(["x", "y", "z"]) {
            let Some(span) = self.word_anywhere()? else {
                return Err(self.truncated(format!("{count} points, found {index}")));
            };
            *slot = self.coordinate(span, axis)?;
        }
        Ok(point)
    }

    /// The three coordinates on the rest of the current line.
    pub(crate) fn point_on_line(&mut self) -> Result<[f64; 3], ReadError> {
        let mut point = [0.0; 3];
        for (slot, axis) in point.iter_mut().zip(["x", "y", "z"]) {
            let span = self.need_word_or(|| format!("coordinate {axis}"))?;
            *slot = self.coordinate(span, axis)?;
        }
        Ok(point)
    }

    /// An index counted from `lowest` among `count` things called `what`, made 0-based.
    pub(crate) fn index(&self, span: Span, lowest: i64, count: usize, what: &str) -> Result<u32, ReadError> {
        let Some(given) = parse_integer(self.text(span)) else {
            let expected = format!("a {what} index (a whole number)");
            return Err(self.malformed(expected, span, "correct this word, or the counts before it"));
        };
        self.checked_index(given, lowest, count, what)
    }

    /// The same for a number already read.
    pub(crate) fn checked_index(&self, given: i64, lowest: i64, count: usize, what: &str) -> Result<u32, ReadError> {
        let highest = lowest.saturating_add(count as i64 - 1);
        if (lowest..=highest).contains(&given) {
            // Counts are limited to 32 bits.
            return Ok((given - lowest) as u32);
        }
        Err(ReadError::IndexOutOfRange { at: self.place(), what: what.to_owned(), given, lowest, highest })
    }

    /// Exactly `n` bytes after the current line.
    pub(crate) fn bytes(&mut self, n: u64, what: &str) -> Result<Vec<u8>, ReadError> {
        let mut block = Vec::with_capacity(reserve(n));
        let read = self.reader.by_ref().take(n).read_to_end(&mut block);
        self.consumed += block.len() as u64;
        match read {
            Err(e) => Err(self.io_error(e)),
            Ok(got) if (got as u64) < n => Err(self.truncated(format!("{n} bytes of {what}, found {got}"))),
            Ok(_) => Ok(block),
        }
    }

    /// Fills a small array from the bytes after the current line.
    pub(crate) fn exact(&mut self, buffer: &mut [u8], what: impl Display) -> Result<(), ReadError> {
        match self.reader.read_exact(buffer) {
            Ok(()) => {
                self.consumed += buffer.len() as u64;
                Ok(())
            }
            Err(e) if e.kind() == io::ErrorKind::UnexpectedEof => Err(self.truncated(what.to_string())),
            Err(e) => Err(self.io_error(e)),
        }
    }

    /// Takes an end of line that follows a binary block, if there is one.
    pub(crate) fn skip_line_end(&mut self) -> Result<(), ReadError> {
        for byte in [b'\r', b'\n'] {
            let next = match self.reader.fill_buf() {
                Ok(buffer) => buffer.first().copied(),
                Err(e) => return Err(self.io_error(e)),
            };
            if next == Some(byte) {
                self.reader.consume(1);
                self.consumed += 1;
            }
        }
        self.line.clear();
        self.cursor = 0;
        Ok(())
    }

    /// Everything that is left, for formats that need the whole file in memory.
    pub(crate) fn read_all(&mut self) -> Result<Vec<u8>, ReadError> {
        let mut all = Vec::new();
        self.reader.read_to_end(&mut all).map_err(|e| self.io_error(e))?;
        self.consumed += all.len() as u64;
        Ok(all)
    }

    /// The names of tags that comments held so far.
    pub(crate) fn take_tag_names(&mut self) -> Vec<TagName> {
        std::mem::take(&mut self.tag_names)
    }

    /// Skips white space; the number of lines skipped, or `None` if nothing else is left.
    pub(crate) fn skip_blank(&mut self) -> Result<Option<u64>, ReadError> {
        let mut lines = 0;
        loop {
            let buffer = match self.reader.fill_buf() {
                Ok([]) => return Ok(None),
                Ok(buffer) => buffer,
                Err(e) => return Err(self.io_error(e)),
            };
            let blank = buffer.iter().take_while(|b| b.is_ascii_whitespace()).count();
            lines += buffer[..blank].iter().filter(|&&b| b == b'\n').count() as u64;
            let more = blank < buffer.len();
            self.reader.consume(blank);
            if more {
                return Ok(Some(lines));
            }
        }
    }

    /// The reader itself, for parsers with their own position.
    pub(crate) fn reader(&mut self) -> &mut (dyn BufRead + 'r) {
        &mut *self.reader
    }
}

/// A whole number in decimal, with an optional sign.
pub(crate) fn parse_integer(text: &[u8]) -> Option<i64> {
    let (negative, digits) = match text {
        [b'-', rest @ ..] => (true, rest),
        [b'+', rest @ ..] => (false, rest),
        _ => (false, text),
    };
    if digits.is_empty() || digits.len() > 19 {
        return None;
    }
    let mut value: i64 = 0;
    for &byte in digits {
        if !byte.is_ascii_digit() {
            return None;
        }
        // Counting downwards reaches i64::MIN.
        value = value.checked_mul(10)?.checked_sub(i64::from(byte - b'0'))?;
    }
    if negative { Some(value) } else { value.checked_neg() }
}

/// A number in decimal; the `D` exponents of Fortran are understood.
pub(crate) fn parse_number(text: &[u8]) -> Option<f64> {
    let text = std::str::from_utf8(text).ok()?;
    if let Ok(value) = text.parse() {
        return Some(value);
    }
    let fortran = text.replace(['d', 'D'], "e");
    if fortran.ends_with(|c: char| c.is_ascii_digit()) { fortran.parse().ok() } else { None }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers() {
        assert_eq!(parse_integer(b"-9223372036854775808"), Some(i64::MIN));
        assert_eq!(parse_integer(b"9223372036854775807"), Some(i64::MAX));
        for bad in ["9223372036854775808", "", "-", "1.0", "0x1", "99999999999999999999", "1 "] {
            assert_eq!(parse_integer(bad.as_bytes()), None, "{bad}");
        }
        assert_eq!(parse_number(b"1.5D+03"), Some(1500.0));
        assert_eq!(parse_number(b"-0.0").map(f64::to_bits), Some((-0.0f64).to_bits()));
        assert!(parse_number(b"nan").is_some_and(f64::is_nan));
        for bad in ["", "1,5", "d", "1d", "abc", "0x10"] {
            assert_eq!(parse_number(bad.as_bytes()), None, "{bad}");
        }
    }

    #[test]
    fn words_lines_and_comments() {
        let text: &[u8] = b"\xef\xbb\xbfone two # no\r\n\n  # none\nthree";
        let mut s = Source::new(Box::new(text), "t", Format::Off).with_comments(b'#');
        let mut words = Vec::new();
        while let Some(span) = s.word_anywhere().unwrap() {
            words.push((s.string(span), s.line_number()));
        }
        assert_eq!(words, [("one".to_owned(), 1), ("two".to_owned(), 1), ("three".to_owned(), 4)]);
        assert_eq!(s.place().to_string(), "t:4");
    }
}
