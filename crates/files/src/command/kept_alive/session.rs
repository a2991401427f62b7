//! A process that is kept alive: its pending rows, the lines that it prints, and its reply times; and the rows of a batch
//! with their replies.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use apportion::model::{Batch, RowFailure};

use crate::command::process::{IN_TRANSIT, Process};
use crate::command::{CommandModel, not_a_value};

/// Maximum number of bytes of a line, and of output without a reply in it.
pub(super) const LONGEST: usize = 1 << 20;

/// Row numbers have six digits, which all languages print in full, and wrap around: this limits the pending rows. They
/// do not begin at 1, so that a line about the program's own steps (`1,0.5`) is not taken for a reply.
const FIRST_NUMBER: u64 = 100_000;
const NUMBERS: u64 = 900_000;
/// Maximum number of pending rows.
pub(super) const MAX_PENDING: usize = 100_000;

pub(super) struct Session {
    pub process: Process,
    /// Number of texts that may be queued before one is written.
    pub credit: usize,
    /// Number of rows sent so far.
    pub sent: u64,
    /// The pending rows by their numbers.
    pub pending: BTreeMap<u64, usize>,
    /// Whether its input is closed.
    pub is_closed: bool,
    /// Whether the program itself has ended, seen after a time without events.
    pub has_ended: bool,
    /// The time of the last reply, or of the first row sent after a pause.
    last_reply: Instant,
    /// Bytes of lines that were not replies since the last reply, and a description of the last such line.
    pub strayed: usize,
    pub stray: Option<String>,
    /// The received part of the incomplete line.
    pub line: Vec<u8>,
}

/// The meaning of a row number that a program has printed.
pub(super) enum Lookup {
    /// A row of the batch that has no reply yet.
    Pending(usize),
    Answered,
    Unknown,
}

impl Session {
    pub(super) fn new(process: Process) -> Self {
        Self {
            process,
            credit: IN_TRANSIT,
            sent: 0,
            pending: BTreeMap::new(),
            is_closed: false,
            has_ended: false,
            last_reply: Instant::now(),
            strayed: 0,
            stray: None,
            line: Vec::new(),
        }
    }

    /// Records that a row is sent, and returns its number.
    pub(super) fn ask(&mut self, row: usize) -> u64 {
        let number = FIRST_NUMBER + self.sent % NUMBERS;
        if self.pending.is_empty() {
            // Time without pending rows does not count.
            self.last_reply = Instant::now();
        }
        self.pending.insert(number, row);
        self.sent += 1;
        number
    }

    /// Finds the row of that number and marks it as answered.
    pub(super) fn find(&mut self, number: u64) -> Lookup {
        match self.pending.remove(&number) {
            Some(row) => Lookup::Pending(row),
            None if (FIRST_NUMBER..FIRST_NUMBER + self.sent.min(NUMBERS)).contains(&number) => Lookup::Answered,
            None => Lookup::Unknown,
        }
    }

    /// Closes the input: the process replies to its pending rows and ends.
    pub(super) fn close(&mut self) {
        self.is_closed = true;
        self.process.close_input();
    }

    pub(super) fn silent_for(&self) -> Duration {
        self.last_reply.elapsed()
    }

    /// Records a reply and returns its time, the start of the process included.
    pub(super) fn note_answer(&mut self) -> Duration {
        let took = self.silent_for();
        self.last_reply = Instant::now();
        self.strayed = 0;
        took
    }

    /// Returns the lines that `bytes` complete.
    pub(super) fn lines(&mut self, bytes: &[u8]) -> Vec<Vec<u8>> {
        let mut lines = Vec::new();
        for part in bytes.split_inclusive(|byte| *byte == b'\n') {
            self.line.extend_from_slice(part);
            if self.line.pop_if(|byte| *byte == b'\n').is_some() {
                lines.push(std::mem::take(&mut self.line));
            }
        }
        lines
    }
}

/// The rows of a batch: they are pending or have a reply.
pub(super) struct Rows<'a> {
    model: &'a CommandModel,
    pub inputs: &'a [&'a [f64]],
    batch: &'a mut Batch,
    /// The first row that was never sent.
    next: usize,
    /// Number of rows without a reply.
    pub open: usize,
    /// Rows that were pending when processes ended, with the number of these: they are sent one at a time.
    pub suspects: BTreeMap<usize, u32>,
    /// In the order of the replies: the row, and the output if only that one failed.
    failures: Vec<(usize, Option<usize>, RowFailure)>,
}

impl<'a> Rows<'a> {
    pub(super) fn new(model: &'a CommandModel, inputs: &'a [&'a [f64]], batch: &'a mut Batch) -> Self {
        let open = batch.rows();
        Self { model, inputs, batch, next: 0, open, suspects: BTreeMap::new(), failures: Vec::new() }
    }

    /// Returns the row to send next, if any is left.
    pub(super) fn next(&mut self) -> Option<usize> {
        if let Some((row, _)) = self.suspects.first_key_value() {
            return Some(*row);
        }
        let row = Some(self.next).filter(|row| *row < self.batch.rows())?;
        self.next += 1;
        Some(row)
    }

    /// Records that a process ended while the row was pending, and returns how many have so far. A process that had
    /// answered other rows counts only once: it may have ended for another reason.
    pub(super) fn suspect(&mut self, row: usize, is_alone: bool) -> u32 {
        let is_new = !self.suspects.contains_key(&row);
        let count = self.suspects.entry(row).or_default();
        *count += u32::from(is_alone || is_new);
        *count
    }

    /// Sets the requested ones of the program's `values`.
    pub(super) fn answer(&mut self, row: usize, values: &[f64]) {
        let settings = &self.model.settings;
        for (column, place) in settings.requested.iter().enumerate() {
            self.batch.set(row, column, settings.outputs[*place].unit.to_si(values[*place]));
            if !values[*place].is_finite() {
                self.failures.push((row, Some(column), not_a_value(values[*place])));
            }
        }
        self.close(row);
    }

    pub(super) fn fail(&mut self, row: usize, reason: &str) {
        self.failures.push((row, None, RowFailure::new(reason)));
        self.close(row);
    }

    fn close(&mut self, row: usize) {
        self.suspects.remove(&row);
        self.open -= 1;
    }

    /// Reports the failures, in the order of the rows.
    pub(super) fn finish(mut self) {
        self.failures.sort_by_key(|(row, ..)| *row);
        for (row, column, failure) in self.failures {
            match column {
                Some(column) => self.batch.fail(row, column, failure),
                None => self.batch.fail_row(row, &failure),
            }
        }
    }
}
