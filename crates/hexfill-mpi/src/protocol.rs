//! The messages between manager and workers, and the manager's book of chunks. Nothing here knows MPI, so it is tested without.
//!
//! A worker says `Ready`, gets a chunk, answers `Done` or `Failed`, and so on until it is told to stop. A chunk that failed is
//! given to another worker; a worker that failed gets no more work. So the totals are those of any other run, or the
//! run ends with the chunks that could not be done.
//!
//! Source: ours.

use hexfill_ledger::Chunk;
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// From a worker to the manager. `R`: what a finished chunk sends.
#[derive(Serialize, Deserialize, Debug)]
pub(crate) enum Answer<R> {
    /// Give me work.
    Ready,
    /// A finished chunk.
    Done(R),
    /// The chunk could not be done, and why. The worker leaves.
    Failed(Chunk, String),
}

/// From the manager to a worker.
#[derive(Serialize, Deserialize, Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Order {
    /// Do this chunk.
    Do(Chunk),
    /// There is nothing left: leave.
    Stop,
}

/// What the manager knows.
#[derive(Debug)]
pub(crate) struct Book {
    left: VecDeque<Chunk>,
    in_flight: usize,
    /// Workers that wait because all chunks are in flight: if one fails, they get it.
    waiting: Vec<i32>,
    /// Workers that may still be given work.
    working: usize,
    /// Reports of failed chunks.
    pub(crate) failures: Vec<String>,
}

impl Book {
    /// A book of chunks to do by some workers.
    pub(crate) fn new(chunks: Vec<Chunk>, workers: usize) -> Self {
        Self { left: chunks.into(), in_flight: 0, waiting: Vec::new(), working: workers, failures: Vec::new() }
    }

    /// A worker wants work: what it is told now, or nothing if it must wait.
    pub(crate) fn ready(&mut self, worker: i32) -> Option<Order> {
        if let Some(chunk) = self.left.pop_front() {
            self.in_flight += 1;
            return Some(Order::Do(chunk));
        }
        if self.in_flight == 0 {
            self.working -= 1;
            return Some(Order::Stop);
        }
        self.waiting.push(worker);
        None
    }

    /// A chunk is finished.
    pub(crate) fn done(&mut self) {
        self.in_flight -= 1;
    }

    /// A chunk failed and its worker left: the chunk is to be done by another.
    pub(crate) fn failed(&mut self, worker: i32, chunk: Chunk, why: &str) {
        self.in_flight -= 1;
        self.working -= 1;
        self.left.push_front(chunk);
        self.failures.push(format!("rank {worker}, chunk {} of {}: {why}", chunk.index, chunk.of));
    }

    /// Orders for workers that waited and now need not.
    pub(crate) fn release(&mut self) -> Vec<(i32, Order)> {
        let waiting = std::mem::take(&mut self.waiting);
        waiting.into_iter().filter_map(|worker| self.ready(worker).map(|order| (worker, order))).collect()
    }

    /// Whether no worker is left to hear from.
    pub(crate) fn is_closed(&self) -> bool {
        self.working == 0
    }

    /// Whether every chunk was done, by whomever.
    pub(crate) fn all_done(&self) -> bool {
        self.left.is_empty()
    }

    /// Chunks that nobody did.
    pub(crate) fn undone(&self) -> usize {
        self.left.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chunks(n: usize) -> Vec<Chunk> {
        (0..n).map(|index| Chunk { index, of: n }).collect()
    }

    #[test]
    fn a_failed_chunk_goes_to_a_worker_that_waited() {
        let mut book = Book::new(chunks(2), 2);
        assert_eq!(book.ready(1), Some(Order::Do(Chunk { index: 0, of: 2 })));
        assert_eq!(book.ready(2), Some(Order::Do(Chunk { index: 1, of: 2 })));
        book.done();
        assert_eq!(book.ready(2), None, "chunk 0 is in flight and may yet fail");
        book.failed(1, Chunk { index: 0, of: 2 }, "disk on fire");
        assert_eq!(book.release(), [(2, Order::Do(Chunk { index: 0, of: 2 }))]);
        book.done();
        assert_eq!(book.ready(2), Some(Order::Stop));
        assert!(book.is_closed() && book.undone() == 0 && book.failures.len() == 1);
    }

    #[test]
    fn without_workers_the_undone_chunks_are_known() {
        let mut book = Book::new(chunks(3), 1);
        let Some(Order::Do(chunk)) = book.ready(1) else { panic!() };
        book.failed(1, chunk, "no");
        assert!(book.is_closed());
        assert_eq!(book.undone(), 3);
    }

    #[test]
    fn waiting_workers_are_let_go_at_the_end() {
        let mut book = Book::new(chunks(1), 3);
        assert!(matches!(book.ready(1), Some(Order::Do(_))));
        assert_eq!((book.ready(2), book.ready(3)), (None, None));
        book.done();
        assert_eq!(book.release(), [(2, Order::Stop), (3, Order::Stop)]);
        assert_eq!(book.ready(1), Some(Order::Stop));
        assert!(book.is_closed());
    }
}
