//! Chunks on threads.
//!
//! Source: ours.

use crate::chunk::Chunk;
use hexfill_mesh::Context;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Runs the work on so many threads, each of which calls it once; on this one if one is enough.
///
/// # Errors
/// The first of them in the order of the threads.
pub fn run_on<E: Send>(threads: usize, work: &(dyn Fn() -> Result<(), E> + Sync)) -> Result<(), E> {
    if threads <= 1 {
        return work();
    }
    std::thread::scope(|scope| {
        let handles: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        let mut out = Ok(());
        for handle in handles {
            match handle.join() {
                Ok(result) => out = out.and(result),
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
        out
    })
}

/// Runs chunks on threads; `done` gets each result as it is finished, one call at a time, in any order.
///
/// # Errors
/// Those of `run` and of `done`; the other threads end after the chunk they are in.
pub fn run_chunks<T: Send, E: Send>(
    chunks: &[Chunk],
    threads: usize,
    ctx: &Context<'_>,
    run: &(dyn Fn(Chunk) -> Result<T, E> + Sync),
    done: &mut (dyn FnMut(T) -> Result<(), E> + Send),
) -> Result<(), E> {
    let cursor = AtomicUsize::new(0);
    let done = Mutex::new((done, 0u64));
    run_on(threads, &|| {
        loop {
            let at = cursor.fetch_add(1, Ordering::Relaxed);
            let Some(&chunk) = chunks.get(at) else { return Ok(()) };
            let result = run(chunk).and_then(|result| {
                let mut guard = done.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
                guard.1 += 1;
                ctx.report("chunks", guard.1, Some(chunks.len() as u64), String::new);
                (guard.0)(result)
            });
            if result.is_err() {
                cursor.store(chunks.len(), Ordering::Relaxed);
                return result;
            }
        }
    })
}
