//! The messages between ranks.
//!
//! All MPI calls are made by the thread that initialised it (`MPI_THREAD_FUNNELED`, which every MPI provides); other
//! threads send it messages over a channel. It polls for messages and sleeps in between instead of waiting inside MPI,
//! which would occupy a core: every worker has its next batch already while it evaluates one, so a delay of a
//! millisecond costs nothing. Requests are short, so that sending them never blocks.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::Duration;
use std::{io, thread};

use ::mpi::Tag;
use ::mpi::request::{Request, Scope, scope};
use ::mpi::topology::SimpleCommunicator;
use ::mpi::traits::{Communicator, Destination, MatchedReceiveVec, Root, Source};
use anyhow::anyhow;
use apportion::study::Study;
use apportion::{RemoteWorkers, Requests, RunContext, WorkerStudy};
use serde::{Deserialize, Serialize};

use super::Ranks;
use crate::commands::{exit_code, say, stop};
use crate::failure::bad_input;

/// Times between two looks at messages: after one, and when nothing has come for long.
const SHORT: Duration = Duration::from_micros(20);
const LONG: Duration = Duration::from_millis(1);

/// Tags of messages to a rank; those to its workers, and from them, are tagged by the worker's number.
const STOP: Tag = 30_000;
const END: Tag = 30_001;

/// Stands for the length of the study where there is nothing to do.
const NOTHING: u64 = u64::MAX;

/// Bytes of the stack of the thread that runs the command, as many as a program has.
const STACK: usize = 8 << 20;

/// What a rank needs to know to work for a run. No file need be where rank 0 is, but for those of programs.
#[derive(Serialize, Deserialize)]
struct Setup {
    version: String,
    source: String,
    path: PathBuf,
    overrides: Vec<String>,
    threads: usize,
    /// Digests of the files that the study reads.
    files: serde_json::Value,
}

/// Runs `command` on rank 0, with the other ranks to work for it.
pub fn main(size: usize, command: impl FnOnce(&dyn Ranks) -> ExitCode + Send) -> ExitCode {
    let joined = ::mpi::initialize_with_threading(::mpi::Threading::Funneled);
    let Some((universe, _)) = joined else {
        return exit_code(Err(anyhow!("MPI is initialised already")));
    };
    let world = universe.world();
    if world.size() as usize != size {
        return exit_code(Err(anyhow!(
            "started as one of {size} ranks, but its MPI finds {}: mpirun and the program use different MPI libraries",
            world.size()
        )));
    }
    if world.rank() == 0 { lead(&world, command) } else { work(&world) }
}

/// What threads of rank 0 give to the one that sends messages.
enum Letter {
    /// The study; the answers of every worker go where it says.
    Begin {
        setup: Vec<u8>,
        threads: usize,
        inboxes: Vec<Sender<Vec<u8>>>,
    },
    /// Bytes for a worker.
    Request(usize, Vec<u8>),
    Stop,
}

/// The other ranks: their workers are counted rank by rank.
struct Others {
    size: usize,
    letters: Sender<Letter>,
    answers: OnceLock<Vec<Mutex<Receiver<Vec<u8>>>>>,
    is_stopped: AtomicBool,
}

fn lost() -> io::Error {
    io::Error::new(io::ErrorKind::BrokenPipe, "the messages between ranks have ended")
}

impl RemoteWorkers for Others {
    fn count(&self) -> usize {
        self.answers.get().map_or(0, Vec::len)
    }

    fn send(&self, worker: usize, bytes: Vec<u8>) -> io::Result<()> {
        self.letters.send(Letter::Request(worker, bytes)).map_err(|_| lost())
    }

    fn receive(&self, worker: usize, patience: Duration) -> io::Result<Option<Vec<u8>>> {
        let answers = self.answers.get().and_then(|answers| answers.get(worker)).ok_or_else(lost)?;
        match answers.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(patience) {
            Ok(answer) => Ok(Some(answer)),
            Err(RecvTimeoutError::Timeout) => Ok(None),
            Err(RecvTimeoutError::Disconnected) => Err(lost()),
        }
    }

    fn stop(&self) {
        if !self.is_stopped.swap(true, Ordering::Relaxed) {
            // If no rank receives messages any more, none is left to be stopped.
            let _ = self.letters.send(Letter::Stop);
        }
    }
}

impl Ranks for Others {
    fn begin(&self, study: &Study, path: &Path, threads: usize) -> anyhow::Result<usize> {
        let setup = Setup {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            source: study.source().to_owned(),
            path: std::path::absolute(path).unwrap_or_else(|_| path.to_owned()),
            overrides: study.overrides().to_vec(),
            threads,
            files: study.data_digests(),
        };
        let setup = serde_json::to_vec(&setup).map_err(|error| bad_input(format!("{}: {error}", path.display())))?;
        let (inboxes, answers) = (1..self.size).flat_map(|_| 0..threads).map(|_| mpsc::channel()).unzip();
        let answers: Vec<Receiver<Vec<u8>>> = answers;
        if self.answers.set(answers.into_iter().map(Mutex::new).collect()).is_ok() {
            let _ = self.letters.send(Letter::Begin { setup, threads, inboxes });
        }
        Ok(self.size)
    }
}

/// Rank 0: the command in a separate thread, the messages in this one.
fn lead(world: &SimpleCommunicator, command: impl FnOnce(&dyn Ranks) -> ExitCode + Send) -> ExitCode {
    let (letters, outbox) = mpsc::channel();
    let size = world.size() as usize;
    let others = Others { size, letters, answers: OnceLock::new(), is_stopped: AtomicBool::new(false) };
    thread::scope(|scope| {
        // The channel closes when the command ends.
        let run = thread::Builder::new().stack_size(STACK).spawn_scoped(scope, move || command(&others));
        carry(world, &outbox);
        match run.map(thread::ScopedJoinHandle::join) {
            Ok(Ok(code)) => code,
            Ok(Err(panic)) => std::panic::resume_unwind(panic),
            Err(error) => exit_code(Err(error.into())),
        }
    })
}

/// Sends letters, and passes answers on, until there are no more letters.
fn carry(world: &SimpleCommunicator, outbox: &Receiver<Letter>) {
    let (mut pause, mut inboxes, mut per_rank) = (SHORT, Vec::new(), 1);
    let (mut messages, mut bytes_in_all) = (0_u64, 0);
    loop {
        match outbox.recv_timeout(pause) {
            Ok(letter) => {
                pause = SHORT;
                match letter {
                    Letter::Begin { setup, threads, inboxes: all } => {
                        (inboxes, per_rank) = (all, threads);
                        broadcast(world, &mut [setup.len() as u64][..]);
                        broadcast(world, &mut setup.clone()[..]);
                    }
                    Letter::Request(worker, bytes) => {
                        (messages, bytes_in_all) = (messages + 1, bytes_in_all + bytes.len());
                        let rank = (1 + worker / per_rank) as i32;
                        world.process_at_rank(rank).send_with_tag(&bytes[..], (worker % per_rank) as Tag);
                    }
                    Letter::Stop => tell_all(world, STOP),
                }
            }
            Err(RecvTimeoutError::Timeout) => pause = (2 * pause).min(LONG),
            Err(RecvTimeoutError::Disconnected) => break,
        }
        while let Some(message) = world.any_process().immediate_matched_probe() {
            let (bytes, status) = message.matched_receive_vec::<u8>();
            (messages, bytes_in_all) = (messages + 1, bytes_in_all + bytes.len());
            let worker = (status.source_rank() as usize - 1) * per_rank + status.tag() as usize;
            // A run that has ended receives no more messages.
            let _ = inboxes.get(worker).map(|inbox: &Sender<Vec<u8>>| inbox.send(bytes));
            pause = SHORT;
        }
    }
    if inboxes.is_empty() {
        broadcast(world, &mut [NOTHING][..]);
    } else {
        tell_all(world, END);
    }
    // For those who ask.
    if std::env::var(super::SWITCH).is_ok_and(|switch| switch == "count") {
        say(&format!("note: {messages} messages of {bytes_in_all} bytes in all between the ranks"));
    }
}

fn tell_all(world: &SimpleCommunicator, tag: Tag) {
    for rank in 1..world.size() {
        world.process_at_rank(rank).send_with_tag(&[0_u8; 0][..], tag);
    }
}

/// From rank 0 to all others, without taking a core on those that wait.
fn broadcast<T: ::mpi::traits::Equivalence>(world: &SimpleCommunicator, buffer: &mut [T]) {
    scope(|scope| wait(world.process_at_rank(0).immediate_broadcast_into(scope, buffer)));
}

fn wait<'a, D: ?Sized, S: Scope<'a>>(mut request: Request<'a, D, S>) {
    while let Err(unfinished) = request.test() {
        request = unfinished;
        thread::sleep(LONG);
    }
}

/// Any other rank: works for rank 0 until it says that there is no more to do.
fn work(world: &SimpleCommunicator) -> ExitCode {
    // Rank 0 receives signals too, and passes them on.
    stop::leave_to_another();
    let mut length = [0];
    broadcast(world, &mut length[..]);
    if length[0] == NOTHING {
        return ExitCode::SUCCESS;
    }
    let mut setup = vec![0_u8; length[0] as usize];
    broadcast(world, &mut setup[..]);
    match study(&setup) {
        Ok((study, threads)) => serve(world, &study, threads),
        Err(why) => {
            say(&format!("error: rank {}: {why}", world.rank()));
            world.abort(1)
        }
    }
    ExitCode::SUCCESS
}

/// The study that is to be worked for, and how many workers are to.
fn study(setup: &[u8]) -> anyhow::Result<(WorkerStudy, usize)> {
    let Setup { version, source, path, overrides, threads, files } = serde_json::from_slice(setup)?;
    if version != env!("CARGO_PKG_VERSION") {
        return Err(anyhow!("this rank is version {}, but rank 0 is version {version}", env!("CARGO_PKG_VERSION")));
    }
    Ok((WorkerStudy::new(apportion_files::parse_study(&source, &path, &overrides)?, &files)?, threads))
}

/// The requests to one worker of this rank.
struct Queue {
    worker: usize,
    requests: Receiver<Vec<u8>>,
    answers: Sender<(usize, Vec<u8>)>,
}

impl Requests for Queue {
    fn next(&mut self) -> Option<Vec<u8>> {
        self.requests.recv().ok()
    }

    fn reply(&mut self, reply: Vec<u8>) {
        // After the end no worker waits for it.
        let _ = self.answers.send((self.worker, reply));
    }
}

fn serve(world: &SimpleCommunicator, study: &WorkerStudy, threads: usize) {
    let stop = AtomicBool::new(false);
    let name = Arc::<str>::from(format!("rank {}", world.rank()));
    let context = RunContext::new(Some(&stop), move |line| say(&format!("{name}: {line}")));
    let (answers, outbox) = mpsc::channel();
    let queue = |worker| {
        let (sender, requests) = mpsc::channel();
        (sender, Queue { worker, requests, answers: answers.clone() })
    };
    let (queues, workers): (Vec<Sender<Vec<u8>>>, Vec<Queue>) = (0..threads).map(queue).unzip();
    thread::scope(|scope| {
        for mut worker in workers {
            let context = &context;
            scope.spawn(move || study.serve(context, &mut worker));
        }
        let mut pause = SHORT;
        let first = world.process_at_rank(0);
        loop {
            while let Some(message) = first.immediate_matched_probe() {
                let (bytes, status) = message.matched_receive_vec::<u8>();
                match status.tag() {
                    // The workers end when their queues are closed.
                    END => return drop(queues),
                    STOP => stop.store(true, Ordering::Relaxed),
                    worker => drop(queues.get(worker as usize).map(|queue| queue.send(bytes))),
                }
                pause = SHORT;
            }
            match outbox.recv_timeout(pause) {
                Ok((worker, answer)) => {
                    first.send_with_tag(&answer[..], worker as Tag);
                    pause = SHORT;
                }
                Err(_) => pause = (2 * pause).min(LONG),
            }
        }
    });
}
