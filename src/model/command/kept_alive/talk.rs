//! A process that is kept alive, and what is under way between it and us.

use std::time::{Duration, Instant};

use super::super::process::{Ending, IN_TRANSIT, Process};
use super::Fault;

/// Bytes that a line may have, and that a process may print without an answer among them.
pub(super) const LONGEST: usize = 1 << 20;

pub(super) struct Talk {
    pub process: Process,
    pub lines: Lines,
    pub session: Session,
    /// Texts that may be handed over before one is written.
    pub credit: usize,
    /// How it ended, once it has.
    pub ending: Option<Ending>,
}

/// What a process has been asked and has answered.
pub(super) struct Session {
    pub sent: usize,
    pub answered: usize,
    /// Rows after which it gets no more.
    pub most: usize,
    /// Since when its input is closed.
    pub closed: Option<Instant>,
    started: Instant,
    first_answer: Option<Instant>,
    /// When it answered last, or was sent something after a pause.
    heard: Instant,
    /// The longest that it took to an answer, with its start and without.
    slowest: Duration,
    slowest_row: Duration,
    /// Bytes of lines that were no answers, since the last that was one; and what the last of them was.
    pub strayed: usize,
    pub stray: Option<String>,
}

/// The bytes that a process prints, line by line.
#[derive(Default)]
pub(super) struct Lines {
    /// What has come of the line that is not complete.
    rest: Vec<u8>,
}

impl Talk {
    pub(super) fn new(process: Process, most: usize) -> Self {
        let now = Instant::now();
        let session = Session {
            sent: 0,
            answered: 0,
            most,
            closed: None,
            started: now,
            first_answer: None,
            heard: now,
            slowest: Duration::ZERO,
            slowest_row: Duration::ZERO,
            strayed: 0,
            stray: None,
        };
        Self { process, lines: Lines::default(), session, credit: IN_TRANSIT, ending: None }
    }

    /// The process gets no more rows, and ends when it has answered those that it has.
    pub(super) fn close(&mut self) {
        if self.session.closed.is_none() {
            self.session.closed = Some(Instant::now());
            self.process.close_input();
        }
    }
}

impl Session {
    pub(super) fn under_way(&self) -> usize {
        self.sent - self.answered
    }

    /// Something is sent: there was nothing to be answered before.
    pub(super) fn wake(&mut self) {
        self.heard = Instant::now();
    }

    pub(super) fn silent_for(&self) -> Duration {
        self.heard.elapsed()
    }

    pub(super) fn note_answers(&mut self) {
        let now = Instant::now();
        let waited = now - self.heard;
        self.slowest = self.slowest.max(waited);
        if self.has_answered() {
            self.slowest_row = self.slowest_row.max(waited);
        }
        self.heard = now;
        self.first_answer.get_or_insert(now);
        self.strayed = 0;
    }

    pub(super) fn has_answered(&self) -> bool {
        self.first_answer.is_some()
    }

    /// The longest that it took to an answer, its start included.
    pub(super) fn slowest(&self) -> Duration {
        self.slowest
    }

    /// The longest that it took from one answer to another; to the first if there are no others.
    pub(super) fn slowest_row(&self) -> Duration {
        if self.answered > 1 { self.slowest_row } else { self.slowest }
    }

    /// How long it has been answering.
    pub(super) fn work(&self) -> Duration {
        self.first_answer.map_or(Duration::ZERO, |first| self.heard.saturating_duration_since(first))
    }

    /// The seconds to its first answer beyond what the others took on average, which is less than nothing if they took longer.
    pub(super) fn startup(&self) -> f64 {
        let Some(first) = self.first_answer else { return 0.0 };
        let others = self.answered.saturating_sub(1).max(1) as f64;
        (first - self.started).as_secs_f64() - self.work().as_secs_f64() / others
    }
}

impl Lines {
    /// Passes on the lines that are complete, until one of them is a fault.
    pub(super) fn feed(&mut self, bytes: &[u8], mut take: impl FnMut(&[u8]) -> Result<(), Fault>) -> Result<(), Fault> {
        for line in bytes.split_inclusive(|byte| *byte == b'\n') {
            let Some(end) = line.strip_suffix(b"\n") else {
                self.rest.extend_from_slice(line);
                break;
            };
            if self.rest.is_empty() {
                take(end)?;
            } else {
                self.rest.extend_from_slice(end);
                take(&std::mem::take(&mut self.rest))?;
            }
        }
        if self.rest.len() > LONGEST { Err(Fault::LongLine) } else { Ok(()) }
    }

    /// What came after the last line feed.
    pub(super) fn rest(&self) -> &[u8] {
        &self.rest
    }
}
