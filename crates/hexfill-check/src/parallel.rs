//! Numbered tasks on the current rayon pool, results in order. A few tasks are run where they are: waking threads costs more
//! than judging a small mesh, and small meshes are judged by the million.
//!
//! Source: ours.

use rayon::prelude::*;

/// Up to this many tasks are run by the caller.
const FEW: usize = 4;

/// The results of tasks `0..n`, in order.
pub(crate) fn tasks<T: Send>(n: usize, task: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
    tasks_with(n, || (), |(), i| task(i))
}

/// The results of tasks `0..n`, in order; each thread makes itself a scratch space.
pub(crate) fn tasks_with<S, T: Send>(
    n: usize,
    scratch: impl Fn() -> S + Sync + Send,
    task: impl Fn(&mut S, usize) -> T + Sync + Send,
) -> Vec<T> {
    if n <= FEW {
        let mut own = scratch();
        return (0..n).map(|i| task(&mut own, i)).collect();
    }
    (0..n).into_par_iter().map_init(scratch, task).collect()
}

/// Piece `i` of `items`, `size` at a time; the number of pieces is `items.len().div_ceil(size)`.
pub(crate) fn piece<T>(items: &[T], size: usize, i: usize) -> &[T] {
    &items[i * size..items.len().min((i + 1) * size)]
}
