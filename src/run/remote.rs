//! Workers in other processes: their requests and replies.
//!
//! The other process has loaded the study. A request identifies one of its models, a design, and rows of the design;
//! the reply contains the outputs of the rows.

use std::io;
use std::time::Duration;

use serde::{Deserialize, Serialize};
use serde_json::json;

use super::journal::{Reader, record, write_record};
use super::rows::RowRange;
use super::{RowBlock, STOP_POLL_INTERVAL};
use crate::design::{Design, DesignSettings, Rows};
use crate::model::{GiveUp, RowFailure, RunContext};

/// Workers in other processes, which [`serve`](crate::WorkerStudy::serve) a study there.
///
/// Each replies to its requests in order. The transport treats requests and replies as opaque bytes.
pub trait RemoteWorkers: Sync {
    /// Returns the number of workers.
    fn count(&self) -> usize;

    /// Sends a request to a worker, without waiting for the reply.
    ///
    /// # Errors
    /// Why it cannot be sent.
    fn send(&self, worker: usize, request: Vec<u8>) -> io::Result<()>;

    /// Returns the next reply of a worker, if one arrives within `patience`.
    ///
    /// # Errors
    /// Why no reply will ever arrive.
    fn receive(&self, worker: usize, patience: Duration) -> io::Result<Option<Vec<u8>>>;

    /// Asks all workers to stop their current work soon, because the run stops. May be called more than once.
    fn stop(&self);
}

/// Remote workers for one of the models of a study.
#[derive(Clone, Copy)]
pub(crate) struct Remote<'a> {
    pub workers: &'a dyn RemoteWorkers,
    /// Index of the model: 0 is the study's model, its low-fidelity models follow from 1.
    pub subject: usize,
}

impl Remote<'_> {
    /// Waits for the reply to the oldest open request to `worker`, which was for `range`. Stops the workers if the run
    /// of `context` is to stop.
    pub fn receive(
        self,
        worker: usize,
        context: &RunContext<'_>,
        range: &RowRange,
        outputs: usize,
    ) -> io::Result<Reply> {
        loop {
            if let Some(reply) = self.workers.receive(worker, STOP_POLL_INTERVAL)? {
                return Reply::read(&reply, range, outputs)
                    .ok_or_else(|| io::Error::new(io::ErrorKind::InvalidData, "its reply does not match the request"));
            }
            if context.is_stopped() {
                self.workers.stop();
            }
        }
    }
}

/// The fields in which designs of one study differ.
#[derive(Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct DesignKey {
    settings: DesignSettings,
    is_plain: bool,
}

impl DesignKey {
    pub fn new(design: &Design) -> Self {
        Self { settings: design.settings().clone(), is_plain: design.is_plain() }
    }

    /// Returns the design that differs from `like` in these fields.
    pub fn design(&self, like: &Design) -> Option<Design> {
        let rows = if self.is_plain { Rows::default() } else { like.requested().clone() };
        Design::new(self.settings.clone(), like.factors(), rows).ok()
    }
}

/// Rows that a worker is to evaluate.
#[derive(Serialize, Deserialize)]
pub(crate) struct Request {
    /// Index of the model: see [`Remote::subject`].
    pub subject: usize,
    pub design: DesignKey,
    pub range: RowRange,
}

/// The reply to a request.
pub(crate) struct Reply {
    /// Evaluation time of the rows.
    pub seconds: f64,
    pub given_up: Option<GiveUp>,
    /// Outputs, encoded as in the journal, after a line of JSON with the other fields.
    pub blocks: Vec<RowBlock>,
}

impl Reply {
    pub fn write(&self) -> Vec<u8> {
        let given_up = self.given_up.as_ref().map(|why| (why.reason.to_string(), why.is_bad_input));
        let mut out = format!("{}\n", json!([self.seconds, given_up])).into_bytes();
        self.blocks.iter().for_each(|block| write_record(&mut out, block));
        out
    }

    /// Reads the reply to a request for rows of `outputs` outputs each; returns `None` if the bytes are invalid.
    fn read(bytes: &[u8], range: &RowRange, outputs: usize) -> Option<Self> {
        let (head, bytes) = bytes.split_at_checked(bytes.iter().position(|byte| *byte == b'\n')? + 1)?;
        let (seconds, given_up): (f64, Option<(String, bool)>) = serde_json::from_slice(head).ok()?;
        let given_up = given_up.map(|(reason, is_bad_input)| GiveUp { reason: RowFailure::new(&reason), is_bad_input });
        let mut from = Reader { bytes };
        let mut blocks = Vec::new();
        while !from.bytes.is_empty() {
            let block = record(&mut from)?;
            let end = block.first.checked_add(block.rows(outputs))?;
            let is_requested =
                block.replicate == range.replicate && range.rows.start <= block.first && end <= range.rows.end;
            if !is_requested || !block.is_complete(outputs) {
                return None;
            }
            blocks.push(block);
        }
        Some(Self { seconds, given_up, blocks })
    }
}
