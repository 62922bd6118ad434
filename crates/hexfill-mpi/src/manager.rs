//! Manager and workers over MPI, whatever a chunk is: the loops, with messages as JSON.
//!
//! Rank 0 gives out chunks and takes results as they come; the other ranks run them. With one rank the manager does the work itself.
//!
//! Source: ours.

use crate::protocol::{Answer, Book, Order};
use anyhow::{Context as _, bail};
use hexfill_ledger::Chunk;
use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator, Destination, Source};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// Work in chunks: what every rank derives from the command line in the same way.
pub(crate) trait Job {
    /// What a finished chunk sends.
    type Result: Serialize + DeserializeOwned;

    /// Does a chunk.
    fn run(&self, chunk: Chunk) -> anyhow::Result<Self::Result>;
}

/// What a rank that works does until it is told to stop. The rank `fail_rank` reports an error instead of doing its first chunk.
pub(crate) fn work<J: Job>(job: &J, world: &SimpleCommunicator, fail_rank: Option<i32>) -> anyhow::Result<()> {
    let mut answer = Answer::Ready;
    loop {
        send(world, 0, &answer)?;
        match answer {
            Answer::Failed(..) => return Ok(()),
            Answer::Done(_) => send(world, 0, &Answer::<J::Result>::Ready)?,
            Answer::Ready => {}
        }
        let (bytes, _) = world.process_at_rank(0).receive_vec::<u8>();
        let Order::Do(chunk) = parse(&bytes)? else { return Ok(()) };
        answer = if fail_rank == Some(world.rank()) {
            Answer::Failed(chunk, "told to fail".into())
        } else {
            match job.run(chunk) {
                Ok(result) => Answer::Done(result),
                Err(error) => Answer::Failed(chunk, format!("{error:#}")),
            }
        };
    }
}

/// Rank 0: has the chunks done, each result given to `take` as it comes. The book says what could not be done.
pub(crate) fn manage<J: Job>(
    job: &J,
    chunks: Vec<Chunk>,
    world: &SimpleCommunicator,
    take: &mut dyn FnMut(J::Result) -> anyhow::Result<()>,
) -> anyhow::Result<Book> {
    let workers = world.size() - 1;
    let mut book = Book::new(chunks, workers as usize);
    if workers == 0 {
        while let Some(Order::Do(chunk)) = (book.undone() > 0).then(|| book.ready(0)).flatten() {
            take(job.run(chunk)?)?;
            book.done();
        }
    }
    while !book.is_closed() {
        let (bytes, status) = world.any_process().receive_vec::<u8>();
        let rank = status.source_rank();
        match parse(&bytes)? {
            Answer::Ready => {
                if let Some(order) = book.ready(rank) {
                    send(world, rank, &order)?;
                }
            }
            Answer::Done(result) => {
                take(result)?;
                book.done();
            }
            Answer::Failed(chunk, why) => book.failed(rank, chunk, &why),
        }
        for (rank, order) in book.release() {
            send(world, rank, &order)?;
        }
    }
    for failure in &book.failures {
        eprintln!("hexfill-mpi: {failure}");
    }
    Ok(book)
}

/// Tells every worker to leave, before any work.
pub(crate) fn dismiss<J: Job>(world: &SimpleCommunicator) -> anyhow::Result<()> {
    for _ in 1..world.size() {
        let (bytes, status) = world.any_process().receive_vec::<u8>();
        if !matches!(parse::<Answer<J::Result>>(&bytes)?, Answer::Ready) {
            bail!("a worker answered before it was asked");
        }
        send(world, status.source_rank(), &Order::Stop)?;
    }
    Ok(())
}

fn send<T: Serialize>(world: &SimpleCommunicator, to: i32, message: &T) -> anyhow::Result<()> {
    world.process_at_rank(to).send(&serde_json::to_vec(message)?[..]);
    Ok(())
}

fn parse<T: DeserializeOwned>(bytes: &[u8]) -> anyhow::Result<T> {
    serde_json::from_slice(bytes).context("a message between ranks cannot be read")
}
