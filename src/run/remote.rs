//! Workers in other processes: what they are asked, and what they answer.
//!
//! The other process knows the study. A request names one of its models and an [`Errand`] (which design, what is made of
//! its rows), and a piece of it; the answer is what a thread of this process would have made of the piece. Blocks of quick
//! models come back as sums of constant size.

use std::io;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use super::LOOK;
use crate::binary::{Binary, Reader, binary_fields};
use crate::design::{Design, DesignSettings, Rows, Sampler};
use crate::model::{GiveUp, RunContext};

/// Workers in other processes, which [`serve`](crate::WorkerStudy::serve) a study there.
///
/// Each answers its requests in their order. Requests and answers are bytes of no meaning to the carrier.
pub trait RemoteWorkers: Sync {
    /// How many there are.
    fn count(&self) -> usize;

    /// Sends a request to a worker, without waiting for it.
    ///
    /// # Errors
    /// What keeps it from being sent.
    fn send(&self, worker: usize, request: Vec<u8>) -> io::Result<()>;

    /// The next answer of a worker, if there is one within `patience`.
    ///
    /// # Errors
    /// Why there will never be one.
    fn receive(&self, worker: usize, patience: Duration) -> io::Result<Option<Vec<u8>>>;

    /// Lets all workers end soon what they are at: the run is to end. May be called more than once.
    fn stop(&self);
}

/// Workers in other processes for one of the models of a study.
#[derive(Clone, Copy)]
pub(crate) struct Remote<'a> {
    pub workers: &'a dyn RemoteWorkers,
    /// Which model: 0 is that of the study, others are its cheaper ones, from 1.
    pub subject: u64,
}

impl<'a> Remote<'a> {
    /// The talk with one of the workers, in the run of `context`.
    pub fn talk(self, worker: usize, context: &'a RunContext<'a>) -> Talk<'a> {
        Talk { remote: self, worker, context, told_to_stop: AtomicBool::new(false) }
    }
}

/// How the pieces of a task and their outputs travel.
pub(crate) trait Abroad<P, O>: Sync {
    /// What the other process needs to know of the task.
    fn errand(&self) -> Errand;
    fn write_piece(&self, piece: &P, out: &mut Vec<u8>);
    /// `None` if the bytes are no piece of the task.
    fn read_piece(&self, from: &mut Reader<'_>) -> Option<P>;
    fn write_output(&self, output: &O, out: &mut Vec<u8>);
    /// `None` if the bytes are no output of the piece.
    fn read_output(&self, piece: &P, from: &mut Reader<'_>) -> Option<O>;
}

/// What another process needs to know of a task, beside the study.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Errand {
    /// Whether blocks are folded into sums; else rows are evaluated.
    pub is_of_blocks: bool,
    pub design: DesignKey,
    /// The base points of every replicate whose blocks are meant.
    pub from: u64,
    pub end: u64,
    pub keeps_outputs: bool,
    /// Whether the run ends when a row fails.
    pub fails: bool,
}

/// What designs of one study differ in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct DesignKey {
    sampler: u64,
    base_samples: u64,
    replicates: u64,
    seed: u64,
    plain_rows: u64,
}

binary_fields!(Errand { is_of_blocks, design, from, end, keeps_outputs, fails });
binary_fields!(DesignKey { sampler, base_samples, replicates, seed, plain_rows });

impl DesignKey {
    pub fn new(design: &Design) -> Self {
        let DesignSettings { sampler, base_samples, replicates, seed } = *design.settings();
        let sampler = Sampler::ALL.iter().position(|known| *known == sampler).unwrap_or_default() as u64;
        Self { sampler, base_samples, replicates, seed, plain_rows: design.plain_rows().into() }
    }

    /// The design that differs from `like` in this.
    pub fn design(self, like: &Design) -> Option<Design> {
        let Self { sampler, base_samples, replicates, seed, plain_rows } = self;
        let sampler = *Sampler::ALL.get(usize::try_from(sampler).ok()?)?;
        let rows = Rows { plain_rows: u32::try_from(plain_rows).ok()?, ..like.asked().clone() };
        Design::new(DesignSettings { sampler, base_samples, replicates, seed }, like.factors(), rows).ok()
    }
}

/// What a worker is asked.
pub(crate) struct Request<'a> {
    /// Which model: see [`Remote::subject`].
    pub subject: u64,
    /// The task.
    pub errand: Errand,
    /// The bytes of the piece.
    pub piece: &'a [u8],
}

impl<'a> Request<'a> {
    /// Reads a request; `None` if the bytes are none.
    pub fn read(bytes: &'a [u8]) -> Option<Self> {
        let mut from = Reader { bytes };
        let (subject, errand) = (u64::read(&mut from)?, Errand::read(&mut from)?);
        Some(Self { subject, errand, piece: from.bytes })
    }
}

/// What a worker answers.
pub(crate) struct Answer<O> {
    /// How long the piece took.
    pub seconds: f64,
    pub given_up: Option<GiveUp>,
    pub output: Option<O>,
}

impl<O> Answer<O> {
    pub fn write(&self, write_output: impl FnOnce(&O, &mut Vec<u8>)) -> Vec<u8> {
        let mut out = Vec::new();
        self.seconds.write(&mut out);
        self.given_up.write(&mut out);
        self.output.is_some().write(&mut out);
        if let Some(output) = &self.output {
            write_output(output, &mut out);
        }
        out
    }

    fn read(bytes: &[u8], read_output: impl FnOnce(&mut Reader<'_>) -> Option<O>) -> Option<Self> {
        let mut from = Reader { bytes };
        let (seconds, given_up) = (f64::read(&mut from)?, Option::read(&mut from)?);
        let output = if bool::read(&mut from)? { Some(read_output(&mut from)?) } else { None };
        from.bytes.is_empty().then_some(Self { seconds, given_up, output })
    }
}

/// The talk with one worker.
pub(crate) struct Talk<'a> {
    remote: Remote<'a>,
    worker: usize,
    context: &'a RunContext<'a>,
    told_to_stop: AtomicBool,
}

impl Talk<'_> {
    pub fn worker(&self) -> usize {
        self.worker
    }

    /// Sends a piece of a task.
    pub fn ask(&self, errand: &Errand, write_piece: impl FnOnce(&mut Vec<u8>)) -> io::Result<()> {
        let mut request = Vec::new();
        self.remote.subject.write(&mut request);
        errand.write(&mut request);
        write_piece(&mut request);
        self.remote.workers.send(self.worker, request)
    }

    /// The next answer. A worker that has long to do is told when the run is to end.
    pub fn hear<O>(&self, read_output: impl FnOnce(&mut Reader<'_>) -> Option<O>) -> io::Result<Answer<O>> {
        let answer = loop {
            if let Some(answer) = self.remote.workers.receive(self.worker, LOOK)? {
                break answer;
            }
            if self.context.is_stopped() && !self.told_to_stop.swap(true, std::sync::atomic::Ordering::Relaxed) {
                self.remote.workers.stop();
            }
        };
        let nonsense = || io::Error::new(io::ErrorKind::InvalidData, "it answers what was not asked");
        Answer::read(&answer, read_output).ok_or_else(nonsense)
    }
}
