//! Linear equations over Z/2 in a few symbols, with the surface edges they come from: a clash is a certificate.
//!
//! Source: ours; elimination over Z/2 that remembers which rows it added.

use hexfill_mesh::Dart;
use std::collections::BTreeSet;

/// A linear form in the symbols: one bit each, and bit 0 for the constant 1.
pub(super) type Form = Vec<u64>;

/// The sum of two forms.
pub(super) fn sum(a: &[u64], b: &[u64]) -> Form {
    a.iter().zip(b).map(|(x, y)| x ^ y).collect()
}

/// Linear equations `form = 0` in echelon form, each with the surface edges it came from.
#[derive(Default)]
pub(super) struct System {
    rows: Vec<(usize, Form, BTreeSet<Dart>)>,
}

impl System {
    /// Adds an equation.
    ///
    /// # Errors
    /// If it says 1 = 0: the surface edges whose equations add up to that.
    pub(super) fn add(&mut self, mut form: Form, source: Option<Dart>) -> Result<(), BTreeSet<Dart>> {
        let mut sources: BTreeSet<Dart> = source.into_iter().collect();
        for (pivot, row, from) in &self.rows {
            if form[pivot / 64] >> (pivot % 64) & 1 == 1 {
                form = sum(&form, row);
                sources = sources.symmetric_difference(from).copied().collect();
            }
        }
        // Bit 0 is the constant, no symbol: a row in which it alone is left says 1 = 0.
        let pivot = (1..64 * form.len()).find(|&k| form[k / 64] >> (k % 64) & 1 == 1);
        match pivot {
            Some(pivot) => {
                self.rows.push((pivot, form, sources));
                Ok(())
            }
            None if form[0] & 1 == 1 => Err(sources),
            None => Ok(()),
        }
    }

    /// Values of the symbols (free ones 0) as a mask whose bit 0 is the constant 1.
    pub(super) fn solve(&self, width: usize) -> Form {
        let mut value = vec![0; width];
        value[0] = 1;
        // A row was reduced by the earlier ones only, so the later pivots are known first.
        for (pivot, row, _) in self.rows.iter().rev() {
            let others = row.iter().zip(&value).fold(0, |s, (a, b)| s ^ (a & b).count_ones()) & 1;
            if others == 1 {
                value[pivot / 64] |= 1 << (pivot % 64);
            }
        }
        value
    }
}
