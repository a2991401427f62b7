//! A worker that keeps one process alive and asks it row by row, several rows ahead of the answers.
//!
//! Rows that have numbers are matched with their answers by them. Without numbers the answers of a process are certain at
//! one point only: when its input and then its output have ended, and there is one answer for each row. Until then they are
//! pending. A process is therefore ended, and another started, at intervals that are long beside its start; its answers are
//! forgotten if they are too many or too few, and every row is asked by a process of its own from then on.

mod blame;
mod caution;
mod hear;
mod numbers;
mod piece;
mod talk;

use std::process::ExitStatus;
use std::sync::PoisonError;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use super::process::{Ending, Event, PATIENCE, Process};
use super::row::RowWriter;
use super::{CommandModel, KeptAlive, SILENCE, State};
use crate::model::{Batch, RowFailure, RunContext, Standing, Worker};
use caution::Caution;
use numbers::number_of;
use piece::Piece;
use talk::Talk;

/// Bytes of rows that are written at once.
const TEXT: usize = 1 << 15;
/// How long it may take until an interruption is seen.
const ATTENTION: Duration = Duration::from_millis(100);
/// How many times its start a process without row numbers works before its answers are confirmed, and at least how long.
const STARTS: u32 = 20;
const AT_LEAST: Duration = Duration::from_secs(2);
/// Rows before the first confirmations of a model, while a start is short or little beside the work: a program that is
/// often wrong is found out where a line too many and a line too few cannot make up for each other.
const FIRST_ROWS: [usize; 3] = [8, 64, 512];
const SHORT_START: Duration = Duration::from_millis(100);
/// Rows that may be pending.
const MOST_PENDING: usize = 1 << 20;
/// A program that is silent for so long, and for so many times the longest time that it has taken before, is asked for its pending
/// answers by the end of its input.
const QUIET: Duration = Duration::from_millis(500);
const TIMES: u32 = 5;
/// The same for a program that has never answered, since it may take long to start.
const FIRST_START: Duration = Duration::from_secs(60);

pub(super) struct KeptAliveWorker<'a> {
    model: &'a CommandModel,
    context: &'a RunContext<'a>,
    form: KeptAlive,
    writer: RowWriter,
    talk: Option<Talk>,
    caution: Caution,
}

/// Why a process is of no further use.
#[derive(Debug)]
enum Fault {
    Closed,
    Silent,
    Rubbish(String),
    LongLine,
    /// A line that nobody asked for.
    Surplus,
    /// A row number that has been answered before.
    Twice(u64),
}

/// What has become of a batch.
struct Outcome {
    standing: Standing,
    given_up: Option<RowFailure>,
}

impl<'a> KeptAliveWorker<'a> {
    pub(super) fn new(model: &'a CommandModel, context: &'a RunContext<'a>, form: KeptAlive) -> Self {
        let writer = RowWriter::new(form.protocol, &model.factors).with_numbers(form.row_numbers);
        Self { model, context, form, writer, talk: None, caution: Caution::default() }
    }

    /// Sees to it that every row of the piece has an answer, which is certain if `closes`.
    fn answer(&mut self, piece: &mut Piece<'_>, closes: bool) -> Outcome {
        if let Some(talk) = &mut self.talk {
            piece.begin(talk.session.sent);
            talk.session.wake();
        }
        loop {
            if self.context.is_stopped() {
                return self.break_off(piece);
            }
            if let Some(standing) = self.arrived(piece, closes) {
                return Outcome { standing, given_up: None };
            }
            let step = match self.start_if_ended(piece) {
                Ok(()) => self.step(piece),
                Err(reason) => return Outcome { standing: Standing::Final, given_up: Some(reason) },
            };
            let Err(fault) = step else { continue };
            match self.blame(&fault, piece) {
                Ok(Standing::Revoked) => return Outcome { standing: Standing::Revoked, given_up: None },
                Ok(_) => (),
                Err(reason) => return Outcome { standing: Standing::Final, given_up: Some(reason) },
            }
        }
    }

    /// Whether all rows are answered, and how their answers stand; `None` if there is more to wait for.
    fn arrived(&mut self, piece: &Piece<'_>, closes: bool) -> Option<Standing> {
        if piece.open > 0 {
            return None;
        }
        let state = &self.model.state;
        let Some(talk) = self.talk.as_mut().filter(|_| !self.form.row_numbers) else { return Some(Standing::Final) };
        let session = &talk.session;
        if session.closed.is_some() {
            return None;
        }
        let is_full = session.answered >= session.most.min(MOST_PENDING);
        if closes || piece.is_parted || is_full || state.is_out_of_step() || is_due(talk, state) {
            talk.close();
            return None;
        }
        Some(Standing::Pending)
    }

    fn start_if_ended(&mut self, piece: &mut Piece<'_>) -> Result<(), RowFailure> {
        if self.talk.is_some() {
            return Ok(());
        }
        let program = &self.model.settings.program;
        let process = Process::start(program, self.context.messages())
            .map_err(|error| RowFailure::new(&program.refusal(&error)))?;
        let is_single = self.caution.alone.is_some() || self.asks_singly();
        let most = if is_single { 1 } else { self.caution.plan.map_or(usize::MAX, |(rows, _)| rows) };
        self.talk = Some(Talk::new(process, most));
        piece.begin(0);
        Ok(())
    }

    /// Whether every row is asked by a process of its own.
    fn asks_singly(&self) -> bool {
        !self.form.row_numbers && self.model.state.is_out_of_step()
    }

    /// Sends what may be sent, and takes what comes next.
    fn step(&mut self, piece: &mut Piece<'_>) -> Result<(), Fault> {
        self.send(piece);
        let state = &self.model.state;
        let Some(talk) = &mut self.talk else { return Ok(()) };
        let silent_for = talk.session.silent_for();
        let timeout = self.model.settings.timeout.filter(|_| talk.session.under_way() > 0);
        let left = timeout.map(|timeout| timeout.saturating_sub(silent_for));
        match talk.process.event(left.map_or(ATTENTION, |left| left.min(ATTENTION))) {
            Some(Event::Output(bytes)) => {
                let before = talk.session.answered;
                let heard = self.hear(&bytes, piece);
                if let Some(Talk { session, .. }) = self.talk.as_mut().filter(|talk| talk.session.answered > before) {
                    session.note_answers();
                    state.note_answer();
                }
                return heard;
            }
            Some(Event::Sent) => talk.credit += 1,
            Some(Event::Closed) => return self.closed(piece),
            None if left == Some(Duration::ZERO) => return Err(Fault::Silent),
            None => return self.silent(piece),
        }
        Ok(())
    }

    fn send(&mut self, piece: &mut Piece<'_>) {
        let Some(talk) = self.talk.as_mut().filter(|talk| talk.session.closed.is_none()) else { return };
        let session = &mut talk.session;
        let ahead = if self.model.state.has_answered() { self.caution.window } else { 1 };
        let may_send = |sent: usize, answered: usize| sent < session.most && sent - answered < ahead;
        let mut sent = session.sent;
        while talk.credit > 0 && may_send(sent, session.answered) && piece.has_next() {
            let mut text = if sent == 0 { self.writer.header() } else { String::new() };
            while text.len() < TEXT
                && may_send(sent, session.answered)
                && let Some(row) = piece.send_next()
            {
                self.writer.write(piece.inputs, row, number_of(sent), &mut text);
                sent += 1;
            }
            talk.credit -= 1;
            talk.process.send(text);
        }
        if session.under_way() == 0 && sent > session.sent {
            session.wake();
        }
        session.sent = sent;
        // A row that goes alone needs no process that waits for more. Others end before the end of their input only by
        // a fault of their own.
        if session.most == 1 && sent == 1 || session.answered == session.most {
            talk.close();
        }
    }

    /// Its output has ended.
    fn closed(&mut self, piece: &mut Piece<'_>) -> Result<(), Fault> {
        let Some(talk) = &mut self.talk else { return Ok(()) };
        let rest = std::mem::take(&mut talk.lines).rest().to_vec();
        if !rest.is_empty() && talk.session.under_way() == 0 {
            // A line that nobody asked for, unless it is no answer.
            self.hear(&[&rest[..], b"\n"].concat(), piece)?;
        }
        let Some(talk) = &mut self.talk else { return Ok(()) };
        let ending = talk.process.end(true);
        let is_whole = talk.session.under_way() == 0;
        let is_certain = self.form.row_numbers || talk.session.closed.is_some() && self.ended_well(&ending);
        if is_whole && is_certain {
            self.confirmed(piece);
            return Ok(());
        }
        if let Some(talk) = &mut self.talk {
            if talk.session.has_answered() {
                // That a row has no answer does not make its first answer later.
                self.model.state.note_startup(talk.session.startup());
            }
            talk.ending = Some(ending);
        }
        Err(Fault::Closed)
    }

    /// Whether a process did not die: one that died on its last row, and had printed a line too many, has as many answers as
    /// rows.
    fn ended_well(&self, ending: &Ending) -> bool {
        if !ending.by_itself || ending.status.is_some_and(|status| status.success()) {
            return true;
        }
        let mut usual = self.model.state.usual_end.lock().unwrap_or_else(PoisonError::into_inner);
        usual.get_or_insert_with(|| self.end_without_rows()).is_some_and(|usual| Some(usual) == ending.status)
    }

    /// How a process ends that gets no row at all.
    fn end_without_rows(&self) -> Option<ExitStatus> {
        let mut process = Process::start(&self.model.settings.program, self.context.messages()).ok()?;
        process.send(self.writer.header());
        process.close_input();
        let begin = Instant::now();
        while !matches!(process.event(ATTENTION), Some(Event::Closed)) {
            process.clear_away();
            if self.context.is_stopped() || begin.elapsed() > SILENCE {
                return None;
            }
        }
        let ending = process.end(true);
        ending.status.filter(|_| ending.by_itself)
    }

    /// The process has answered all its rows, neither more nor less, and is of no further use.
    fn confirmed(&mut self, piece: &mut Piece<'_>) {
        let Some(Talk { session, .. }) = self.talk.take() else { return };
        self.model.state.note_startup(session.startup());
        if self.form.row_numbers {
            return;
        }
        piece.confirm();
        if self.asks_singly() && session.most == 1 {
            piece.alone += 1;
        }
        self.model.state.confirmed.fetch_add(1, Ordering::Relaxed);
        if session.most == 1 {
            self.caution.settle();
        }
        if let Some((_, ahead)) = self.caution.plan.take_if(|(rows, _)| *rows == session.answered) {
            self.caution.alone = (ahead > 0).then_some(ahead);
        }
    }

    /// Nothing has come for a while.
    fn silent(&mut self, piece: &mut Piece<'_>) -> Result<(), Fault> {
        let state = &self.model.state;
        let Some(talk) = &mut self.talk else { return Ok(()) };
        talk.process.clear_away();
        let session = &talk.session;
        let quiet = if session.has_answered() {
            QUIET.max(TIMES * session.slowest())
        } else {
            // Only a process that has started before is known to be longer over it than usual.
            state.startup().map_or(FIRST_START, |startup| AT_LEAST.max(2 * TIMES * startup))
        };
        let silent_for = session.silent_for();
        if session.under_way() > 0 {
            if !state.has_answered() && silent_for > self.model.silence {
                State::send_once(
                    &state.hinted,
                    self.context.messages(),
                    "still waiting for the program's first answer: it may still be starting (imports), be long over its \
                     first row, or not flush what it prints, as print(..., flush=True) does",
                );
            }
            if silent_for > quiet {
                talk.close();
            }
        } else if session
            .closed
            .is_some_and(|closed| closed.elapsed().min(silent_for) > PATIENCE.max(TIMES * session.slowest_row()))
        {
            State::send_once(
                &state.stayed,
                self.context.messages(),
                "warning: the program does not end when its input has ended: whether it prints more is not waited for",
            );
            self.confirmed(piece);
        }
        Ok(())
    }

    /// Ends the work within a moment, with what is certain by then.
    fn break_off(&mut self, piece: &mut Piece<'_>) -> Outcome {
        let spans = !self.form.row_numbers && piece.base > 0;
        let mut standing = Standing::Final;
        let end = Instant::now() + if self.form.row_numbers { Duration::ZERO } else { PATIENCE };
        if let Some(talk) = &mut self.talk {
            talk.close();
        }
        while self.talk.is_some() {
            if Instant::now() >= end || self.step(piece).is_err() {
                drop(self.talk.take().map(|mut talk| talk.process.end(false)));
                if !self.form.row_numbers {
                    piece.rewind();
                    standing = if spans { Standing::Revoked } else { Standing::Final };
                }
            }
        }
        Outcome { standing, given_up: Some(RowFailure::interrupted()) }
    }

    fn new_piece<'b>(&self, inputs: &'b [&'b [f64]], rows: usize) -> Piece<'b> {
        Piece::new(inputs, rows, self.model.settings.outputs.len())
    }
}

/// Whether the process has worked long enough, beside its start, for its answers to be confirmed.
fn is_due(talk: &Talk, state: &State) -> bool {
    let work = talk.session.work();
    let startup =
        state.startup().unwrap_or_else(|| Duration::try_from_secs_f64(talk.session.startup()).unwrap_or_default());
    let confirmed = state.confirmed.load(Ordering::Relaxed) as usize;
    let is_early = FIRST_ROWS.get(confirmed).is_some_and(|rows| talk.session.answered >= *rows)
        && (startup < SHORT_START || work > TIMES * startup);
    is_early || work > AT_LEAST.max(STARTS * startup)
}

impl Worker for KeptAliveWorker<'_> {
    fn run(&mut self, inputs: &[&[f64]], batch: &mut Batch) {
        loop {
            let mut piece = self.new_piece(inputs, batch.rows());
            let outcome = self.answer(&mut piece, true);
            // Rows that were pending before are the caller's affair; these are asked again.
            if outcome.standing == Standing::Revoked && outcome.given_up.is_none() {
                continue;
            }
            piece.hand_over(self.model, batch);
            return outcome.given_up.map_or((), |reason| batch.give_up(reason));
        }
    }

    fn run_ahead(&mut self, inputs: &[&[f64]], batch: &mut Batch) -> Standing {
        let mut piece = self.new_piece(inputs, batch.rows());
        let outcome = self.answer(&mut piece, false);
        piece.hand_over(self.model, batch);
        if let Some(reason) = outcome.given_up {
            batch.give_up(reason);
        }
        outcome.standing
    }

    fn confirm(&mut self) -> Standing {
        let mut piece = self.new_piece(&[], 0);
        self.answer(&mut piece, true).standing
    }
}

#[cfg(test)]
mod tests;
