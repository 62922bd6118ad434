//! [`Card`]: one card of bulk data with its continuations, in fields of 8 or 16 columns or between commas.
//!
//! Source: the Nastran guide.

use crate::error::ReadError;
use crate::source::Source;

/// Most fields that are kept of a card: those of an element of 20 nodes, and what may follow.
const MOST_FIELDS: usize = 64;

/// Columns of a line that count: a name, eight fields or four wide ones. The next eight point to the continuation.
const COLUMNS: usize = 72;

/// A card. The buffers are used again for the next.
#[derive(Default)]
pub(super) struct Card {
    name: Vec<u8>,
    text: Vec<u8>,
    /// Where each field ends in the text.
    ends: Vec<usize>,
    line: Vec<u8>,
}

impl Card {
    /// Its name in capitals, without `*`.
    pub(super) fn name(&self) -> &[u8] {
        &self.name
    }

    /// Field number `i` after the name, without blanks; empty if there is none.
    pub(super) fn field(&self, i: usize) -> &[u8] {
        let start = if i == 0 { 0 } else { self.ends.get(i - 1).copied().unwrap_or(self.text.len()) };
        let end = self.ends.get(i).copied().unwrap_or(start);
        self.text[start..end].trim_ascii()
    }

    /// Starts with the current line.
    pub(super) fn begin(&mut self, s: &Source<'_>) {
        self.text.clear();
        self.ends.clear();
        self.name = self.take_line(s);
        if self.name.ends_with(b"*") {
            self.name.pop();
        }
    }

    /// Adds the lines that go on with the card; the line after is left to be read.
    pub(super) fn take_continuations(&mut self, s: &mut Source<'_>) -> Result<(), ReadError> {
        while s.next_line()? {
            let line = s.line();
            if line.starts_with(b"$") {
                continue;
            }
            let first = line.first().copied();
            let goes_on = matches!(first, Some(b'+' | b'*' | b',' | b'\t'))
                || first == Some(b' ')
                    && line[..line.len().min(8)].iter().all(|&b| b == b' ')
                    && !line.trim_ascii().is_empty();
            if !goes_on {
                s.unread_line();
                return Ok(());
            }
            self.take_line(s);
        }
        Ok(())
    }

    /// Adds the fields of the current line; returns its first field in capitals.
    fn take_line(&mut self, s: &Source<'_>) -> Vec<u8> {
        let line = s.line();
        let line = &line[..line.iter().position(|&b| b == b'$').unwrap_or(line.len())];
        if line.contains(&b',') {
            let mut words = line.split(|&b| b == b',');
            let first = words.next().unwrap_or_default().trim_ascii().to_ascii_uppercase();
            // Eight fields a line, four of a wide one; what follows points to the continuation.
            let most = if first.contains(&b'*') { 4 } else { 8 };
            let before = self.ends.len();
            words.take(most).for_each(|word| self.push(word));
            self.pad(before + most);
            return first;
        }
        let mut columns = std::mem::take(&mut self.line);
        columns.clear();
        for &byte in line {
            match byte {
                b'\t' => columns.resize((columns.len() / 8 + 1) * 8, b' '),
                byte => columns.push(byte),
            }
        }
        columns.truncate(COLUMNS);
        let (first, rest) = columns.split_at(columns.len().min(8));
        let first = first.trim_ascii().to_ascii_uppercase();
        let (most, width) = if first.contains(&b'*') { (4, 16) } else { (8, 8) };
        let before = self.ends.len();
        rest.chunks(width).for_each(|field| self.push(field));
        self.pad(before + most);
        self.line = columns;
        first
    }

    fn push(&mut self, field: &[u8]) {
        if self.ends.len() < MOST_FIELDS {
            self.text.extend_from_slice(field);
            self.ends.push(self.text.len());
        }
    }

    /// Empty fields at the end of a line may be left out.
    fn pad(&mut self, n: usize) {
        while self.ends.len() < n.min(MOST_FIELDS) {
            self.ends.push(self.text.len());
        }
    }
}

/// A real number of Nastran: the letter of the exponent may be missing (`1.5-3`), or be D.
pub(super) fn parse_real(text: &[u8]) -> Option<f64> {
    if let Some(value) = crate::source::parse_number(text) {
        return Some(value);
    }
    let text = std::str::from_utf8(text).ok()?;
    let at = text.rfind(['+', '-']).filter(|&at| at > 0)?;
    let (digits, exponent) = text.split_at(at);
    digits.ends_with(|c: char| c.is_ascii_digit() || c == '.').then(|| format!("{digits}e{exponent}").parse().ok())?
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_as_nastran_writes_them() {
        for (text, value) in
            [("1.5-3", 1.5e-3), ("-7.+2", -700.0), (".25", 0.25), ("1.D1", 10.0), ("-1.2E-2", -0.012), ("3", 3.0)]
        {
            assert_eq!(parse_real(text.as_bytes()), Some(value), "{text}");
        }
        for bad in ["", "-", "1.5--3", "e5", "1.5-", "x-3"] {
            assert_eq!(parse_real(bad.as_bytes()), None, "{bad}");
        }
    }
}
