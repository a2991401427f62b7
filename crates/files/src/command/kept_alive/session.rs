//! A process that is kept alive: the rows that it was asked, the lines that it prints, and how long it takes.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use super::super::process::{IN_TRANSIT, Process};

/// Bytes that a line may have, and that a process may print without an answer among them.
pub(super) const LONGEST: usize = 1 << 20;

/// Row numbers have six digits, which all languages print in full, and come round: so many rows may be under way. They do not
/// begin at 1, so that what a program prints about its own steps (`1,0.5`) is taken for no answer.
const FIRST_NUMBER: u64 = 100_000;
const NUMBERS: u64 = 900_000;
const MAX_ASKED: usize = 100_000;

pub(super) struct Session {
    pub process: Process,
    /// Texts that may be handed over before one is written.
    pub credit: usize,
    /// Rows that it was asked so far.
    pub sent: u64,
    /// Those without an answer, by their numbers.
    pub asked: BTreeMap<u64, usize>,
    /// Whether its input is closed.
    pub is_closed: bool,
    /// When it answered last, or was asked something after a pause.
    heard: Instant,
    /// Bytes of lines that were no answers, since the last that was one; and what the last of them was.
    pub strayed: usize,
    pub stray: Option<String>,
    /// What has come of the line that is not complete.
    line: Vec<u8>,
}

/// What a row number that a program has printed stands for.
pub(super) enum Lookup {
    /// The row of the batch that has no answer yet.
    Asked(usize),
    Answered,
    Unknown,
}

impl Session {
    pub(super) fn new(process: Process) -> Self {
        Self {
            process,
            credit: IN_TRANSIT,
            sent: 0,
            asked: BTreeMap::new(),
            is_closed: false,
            heard: Instant::now(),
            strayed: 0,
            stray: None,
            line: Vec::new(),
        }
    }

    /// Whether it can be asked more rows before it answers.
    pub(super) fn has_room(&self) -> bool {
        self.asked.len() < MAX_ASKED
    }

    /// A row is asked; its number.
    pub(super) fn ask(&mut self, row: usize) -> u64 {
        let number = FIRST_NUMBER + self.sent % NUMBERS;
        if self.asked.is_empty() {
            // The time in which it was not asked anything is not its own.
            self.heard = Instant::now();
        }
        self.asked.insert(number, row);
        self.sent += 1;
        number
    }

    /// Finds the row of that number, which is answered from now on.
    pub(super) fn find(&mut self, number: u64) -> Lookup {
        match self.asked.remove(&number) {
            Some(row) => Lookup::Asked(row),
            None if (FIRST_NUMBER..FIRST_NUMBER + self.sent.min(NUMBERS)).contains(&number) => Lookup::Answered,
            None => Lookup::Unknown,
        }
    }

    /// The process gets no more rows, and ends when it has answered those that it has.
    pub(super) fn close(&mut self) {
        self.is_closed = true;
        self.process.close_input();
    }

    pub(super) fn silent_for(&self) -> Duration {
        self.heard.elapsed()
    }

    /// An answer has come; how long it took, the start of the process included.
    pub(super) fn note_answer(&mut self) -> Duration {
        let took = self.silent_for();
        self.heard = Instant::now();
        self.strayed = 0;
        took
    }

    /// A line of `length` bytes is no answer.
    pub(super) fn note_stray(&mut self, words: String, length: usize) {
        self.strayed += length.max(1);
        self.stray = Some(words);
    }

    /// The lines that `bytes` complete.
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

    /// Bytes of the line that is not complete.
    pub(super) fn unfinished(&self) -> usize {
        self.line.len()
    }
}
