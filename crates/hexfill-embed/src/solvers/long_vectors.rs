//! Loops over long vectors: spread over threads, the same to the last bit at any number of them.
//!
//! Source: ours.

use rayon::prelude::*;

/// From this many entries on, loops are spread over threads.
pub(crate) const PARALLEL: usize = 4096;

/// `out[i] = f(i)`, in parallel for long arrays; elementwise, so the same at any number of threads.
pub(crate) fn fill<T: Send>(out: &mut [T], f: impl Fn(usize) -> T + Sync) {
    if out.len() >= PARALLEL {
        out.par_iter_mut().with_min_len(256).enumerate().for_each(|(i, o)| *o = f(i));
    } else {
        out.iter_mut().enumerate().for_each(|(i, o)| *o = f(i));
    }
}

/// Scalar product in chunks of fixed length, summed in order: the same at any number of threads.
pub(crate) fn dot_long(a: &[f64], b: &[f64]) -> f64 {
    const CHUNK: usize = 16384;
    let one = |(a, b): (&[f64], &[f64])| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    if a.len() > 4 * CHUNK {
        let parts: Vec<f64> = a.par_chunks(CHUNK).zip(b.par_chunks(CHUNK)).map(one).collect();
        parts.iter().sum()
    } else {
        a.chunks(CHUNK).zip(b.chunks(CHUNK)).map(one).sum()
    }
}

/// `y += s * x`.
pub(crate) fn add_long(y: &mut [f64], s: f64, x: &[f64]) {
    if y.len() > 65536 {
        y.par_iter_mut().with_min_len(8192).zip(x).for_each(|(y, x)| *y += s * x);
    } else {
        y.iter_mut().zip(x).for_each(|(y, x)| *y += s * x);
    }
}
