//! A worker that keeps one process alive and asks it row by row, several rows ahead of the answers.

use std::time::{Duration, Instant};

use super::process::{Ending, Event, IN_TRANSIT, Process};
use super::program::status_in_words;
use super::protocol::{Answer, Protocol, parse_answer};
use super::row::RowWriter;
use super::words::{masked, seconds};
use super::{CommandModel, State, not_a_value};
use crate::model::{Batch, RowFailure, Worker};

/// Bytes of rows that are written at once.
const TEXT: usize = 1 << 15;
/// Bytes that a line may have.
const LONGEST_LINE: usize = 1 << 20;
/// How long it may take until an interruption is seen.
const ATTENTION: Duration = Duration::from_millis(100);
/// How long is listened for more than one line after the first row of all, and after each row of a program that has
/// printed too much before.
const FIRST_ROW: Duration = Duration::from_millis(50);
const EACH_ROW: Duration = Duration::from_millis(5);

pub(super) struct KeptWorker<'a> {
    model: &'a CommandModel,
    protocol: Protocol,
    writer: RowWriter,
    talk: Option<Talk>,
}

/// A process and what is under way between it and us.
struct Talk {
    process: Process,
    /// Texts that may be handed over before one is written.
    credit: usize,
    /// What has come of the line that is not complete.
    line: Vec<u8>,
    has_header: bool,
    /// Its output is closed.
    closed: bool,
    /// When it answered last, or was asked first.
    heard: Instant,
}

/// The rows of a batch on their way.
struct Piece<'a> {
    inputs: &'a [&'a [f64]],
    rows: usize,
    /// A value for each output of the program and each answered row; NaN where the row failed.
    values: Vec<f64>,
    /// The number of those outputs.
    outputs: usize,
    failures: Vec<(usize, RowFailure)>,
    /// Rows that have their answer, and rows that have been sent: the first so many.
    answered: usize,
    sent: usize,
    /// The first row that the present process was sent.
    since: usize,
    /// How often the first row without an answer has been tried in vain.
    tries: u32,
    /// That row goes alone; with how many it went before.
    alone: Option<usize>,
    /// How far rows may be ahead of the answers, and answers since it was set.
    window: usize,
    in_window: usize,
    /// The program has printed too much: every row goes alone.
    careful: bool,
}

/// Why a process is of no further use.
enum Fault {
    Closed,
    Silent,
    Rubbish(String),
    LongLine,
    /// A line that nobody asked for.
    Surplus,
}

impl<'a> KeptWorker<'a> {
    pub(super) fn new(model: &'a CommandModel, protocol: Protocol) -> Self {
        Self { model, protocol, writer: RowWriter::new(protocol, &model.factors), talk: None }
    }

    fn answer(&mut self, piece: &mut Piece<'_>) -> Result<(), RowFailure> {
        self.leave_if_out_of_step();
        if let Some(talk) = &mut self.talk {
            talk.heard = Instant::now();
        }
        while piece.answered < piece.rows {
            if self.model.state.interrupted() {
                drop(self.talk.take().map(|talk| talk.process.end(false)));
                return Err(RowFailure::interrupted());
            }
            if self.talk.is_none() {
                self.talk = Some(self.start()?);
                (piece.sent, piece.since) = (piece.answered, piece.answered);
            }
            if let Err(fault) = self.step(piece) {
                self.blame(&fault, piece)?;
            }
        }
        Ok(())
    }

    fn start(&self) -> Result<Talk, RowFailure> {
        let program = &self.model.settings.program;
        let process = Process::start(program, &self.model.state.voice)
            .map_err(|error| RowFailure::new(&program.refusal(&error)))?;
        Ok(Talk {
            process,
            credit: IN_TRANSIT,
            line: Vec::new(),
            has_header: false,
            closed: false,
            heard: Instant::now(),
        })
    }

    /// Lines that came after the last row: what they belong to is unknown. A process that has ended since is let go.
    fn leave_if_out_of_step(&mut self) {
        let Some(talk) = &mut self.talk else { return };
        let surplus = loop {
            match talk.process.event(Duration::ZERO) {
                Some(Event::Output(_)) => break true,
                Some(Event::Sent) => talk.credit += 1,
                Some(Event::Closed) => break false,
                None if talk.line.is_empty() => return,
                None => break true,
            }
        };
        if surplus {
            self.warn();
        }
        drop(self.talk.take().map(|talk| talk.process.end(!surplus)));
    }

    fn warn(&self) {
        State::say_once(
            &self.model.state.warned,
            "warning: the program printed a line that was no answer to a row: the process is started anew, but answers \
             just before that line may belong to other rows; print to standard error what is no answer",
        );
    }

    /// Sends what may be sent, and takes what comes next.
    fn step(&mut self, piece: &mut Piece<'_>) -> Result<(), Fault> {
        let Some(talk) = &mut self.talk else { return Ok(()) };
        if talk.closed {
            return Err(Fault::Closed);
        }
        let state = &self.model.state;
        let is_first = !state.has_answered();
        let ahead = if is_first || piece.careful || piece.alone.is_some() { 1 } else { piece.window };
        let limit = piece.answered.saturating_add(ahead).min(piece.rows);
        while piece.sent < limit && talk.credit > 0 {
            let mut text = if talk.has_header { String::new() } else { self.writer.header() };
            while piece.sent < limit && text.len() < TEXT {
                self.writer.write(piece.inputs, piece.sent, &mut text);
                piece.sent += 1;
            }
            talk.has_header = true;
            talk.credit -= 1;
            talk.process.send(text);
        }
        let silent_for = talk.heard.elapsed();
        let left = self.model.settings.timeout.map(|timeout| timeout.saturating_sub(silent_for));
        let event = talk.process.event(left.map_or(ATTENTION, |left| left.min(ATTENTION)));
        match event {
            Some(Event::Output(bytes)) => {
                let (before, tries) = (piece.answered, piece.tries);
                let taken = talk.take(&bytes, piece, (self.protocol, &self.model.names));
                let is_alone = is_first || piece.careful;
                let taken = taken.and_then(|()| match piece.answered > before && is_alone {
                    true => talk.listen(if is_first { FIRST_ROW } else { EACH_ROW }),
                    false => Ok(()),
                });
                if matches!(taken, Err(Fault::Surplus)) {
                    // The row that was answered too often has not been answered.
                    piece.tries = if piece.answered - piece.since == 1 { tries } else { 0 };
                }
                taken?;
                if piece.answered > before {
                    talk.heard = Instant::now();
                    state.note_answer();
                    if is_alone {
                        piece.since = piece.answered;
                    }
                }
            }
            Some(Event::Sent) => talk.credit += 1,
            Some(Event::Closed) => return Err(Fault::Closed),
            None if left == Some(Duration::ZERO) => return Err(Fault::Silent),
            None if is_first && silent_for > self.model.silence => State::say_once(
                &state.hinted,
                "the program has been silent since its first row: does it flush its output, as print(..., flush=True) does?",
            ),
            None => (),
        }
        Ok(())
    }

    /// Ends the process and decides what becomes of the row that it is found out on.
    fn blame(&mut self, fault: &Fault, piece: &mut Piece<'_>) -> Result<(), RowFailure> {
        let Some(talk) = self.talk.take() else { return Ok(()) };
        let ending = talk.process.end(matches!(fault, Fault::Closed));
        if matches!(fault, Fault::Surplus) {
            let suspects = piece.answered - piece.since;
            if suspects != 1 {
                self.warn();
            }
            piece.careful |= self.model.state.has_answered();
            piece.take_back();
            piece.sent = piece.answered + usize::from(suspects == 1);
        }
        let ahead = piece.sent - piece.answered;
        if ahead == 0 {
            return Ok(());
        }
        piece.tries += 1;
        if ahead > 1 || piece.tries <= self.model.settings.retries {
            piece.alone = Some(ahead.max(piece.alone.unwrap_or(1)));
            return Ok(());
        }
        let reason = self.reason(fault, &ending);
        let failure = RowFailure::new(&reason);
        piece.fail(failure);
        self.model.state.note_barren(&reason)
    }

    fn reason(&self, fault: &Fault, ending: &Ending) -> String {
        match fault {
            Fault::Closed if ending.by_itself => {
                let last = masked(&ending.last_words);
                let last = if last.is_empty() { last } else { format!(": {last}") };
                format!("the program ended with {}{last}", status_in_words(ending.status))
            }
            Fault::Closed => "the program closed its standard output".to_owned(),
            Fault::Silent => {
                let timeout = self.model.settings.timeout.map_or_else(String::new, seconds);
                let hint = if self.model.state.has_answered() { "" } else { "; does the program flush its output?" };
                format!("no answer within {timeout}{hint}")
            }
            Fault::Rubbish(words) => format!("not an answer: {words}"),
            Fault::LongLine => "the program printed a line of more than 1 MiB".to_owned(),
            Fault::Surplus => "the program printed more than one line for a row".to_owned(),
        }
    }
}

impl Worker for KeptWorker<'_> {
    fn run(&mut self, inputs: &[&[f64]], batch: &mut Batch) {
        let settings = &self.model.settings;
        let mut piece = Piece::new(inputs, batch.rows(), settings.outputs.len());
        if let Err(reason) = self.answer(&mut piece) {
            batch.give_up(reason);
        }
        for (column, place) in settings.asked.iter().enumerate() {
            let unit = &settings.outputs[*place].unit;
            for (row, values) in piece.values.chunks(piece.outputs).enumerate() {
                batch.set(row, column, unit.to_si(values[*place]));
                let failed = || piece.failures.binary_search_by_key(&row, |(row, _)| *row).is_ok();
                if !values[*place].is_finite() && !failed() {
                    batch.fail(row, column, not_a_value(values[*place]));
                }
            }
        }
        for (row, failure) in &piece.failures {
            batch.fail_row(*row, failure);
        }
    }
}

impl Talk {
    /// Takes the answers in `bytes`.
    fn take(
        &mut self,
        bytes: &[u8],
        piece: &mut Piece<'_>,
        (protocol, names): (Protocol, &[String]),
    ) -> Result<(), Fault> {
        let mut lines = bytes.split_inclusive(|byte| *byte == b'\n');
        for line in &mut lines {
            let Some(end) = line.strip_suffix(b"\n") else {
                self.line.extend_from_slice(line);
                break;
            };
            if piece.answered == piece.sent {
                return Err(Fault::Surplus);
            }
            let answer = if self.line.is_empty() {
                parse_answer(protocol, names, end, &mut piece.values)
            } else {
                self.line.extend_from_slice(end);
                let answer = parse_answer(protocol, names, &self.line, &mut piece.values);
                self.line.clear();
                answer
            };
            match answer.map_err(Fault::Rubbish)? {
                Answer::Values => piece.next(),
                Answer::Failed(reason) => piece.fail(RowFailure::new(&reason)),
            }
        }
        if self.line.len() > LONGEST_LINE { Err(Fault::LongLine) } else { Ok(()) }
    }

    /// Hears whether there is more than the answer.
    fn listen(&mut self, longest: Duration) -> Result<(), Fault> {
        let end = Instant::now() + longest;
        while self.line.is_empty() {
            match self.process.event(end.saturating_duration_since(Instant::now())) {
                Some(Event::Sent) => self.credit += 1,
                // That is no fault of a row that has been answered.
                Some(Event::Closed) => {
                    self.closed = true;
                    return Ok(());
                }
                None => return Ok(()),
                Some(Event::Output(_)) => break,
            }
        }
        Err(Fault::Surplus)
    }
}

impl<'a> Piece<'a> {
    fn new(inputs: &'a [&'a [f64]], rows: usize, outputs: usize) -> Self {
        Self {
            inputs,
            rows,
            values: Vec::with_capacity(rows * outputs),
            outputs,
            failures: Vec::new(),
            answered: 0,
            sent: 0,
            since: 0,
            tries: 0,
            alone: None,
            window: usize::MAX,
            in_window: 0,
            careful: false,
        }
    }

    /// A row has its answer.
    fn next(&mut self) {
        self.answered += 1;
        self.tries = 0;
        if let Some(ahead) = self.alone.take().filter(|ahead| *ahead > 1) {
            // The row was innocent: one of those that went with it is not.
            (self.window, self.in_window) = (ahead / 2, 0);
        } else if self.window < usize::MAX {
            self.in_window += 1;
            if self.in_window >= self.window {
                (self.window, self.in_window) = (self.window.saturating_mul(2), 0);
            }
        }
    }

    /// The first row without an answer has none.
    fn fail(&mut self, failure: RowFailure) {
        self.failures.push((self.answered, failure));
        self.values.extend(std::iter::repeat_n(f64::NAN, self.outputs));
        self.alone = None;
        self.next();
    }

    /// Answers of the present process that may belong to other rows are forgotten.
    fn take_back(&mut self) {
        self.failures.retain(|(row, _)| *row < self.since);
        self.values.truncate(self.since * self.outputs);
        self.answered = self.since;
    }
}

#[cfg(test)]
mod tests;
