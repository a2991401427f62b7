//! A worker that keeps one process alive and sends it rows, several ahead of the replies.
//!
//! A row is pending or answered: its reply contains its number, so replies may come in any order. If a process ends
//! while rows are pending, one of them may be the cause. They are suspects, retried one at a time, and a row has failed
//! once a process that was started for it alone has ended.

mod session;

use std::sync::atomic::Ordering;
use std::time::Duration;

use apportion::model::{Batch, GiveUp, RowFailure, RunContext, Worker};
use apportion_base::text::seconds;
use session::{LONGEST, Lookup, MAX_PENDING, Rows, Session};

use super::process::{Event, Process};
use super::program::ended_in_words;
use super::protocol::{RowWriter, is_answer_without_number, parse_answer};
use super::{CommandModel, Protocol};

/// Number of bytes of rows that are written at once.
const TEXT: usize = 1 << 15;
/// Interval at which an interruption is checked.
const ATTENTION: Duration = Duration::from_millis(100);
/// Silence, and at least `TIMES` times the longest reply time so far, after which a process may have skipped a row: its
/// input is then closed, so it replies to what it has read and ends.
const QUIET: Duration = Duration::from_secs(2);
const TIMES: u32 = 5;
/// The same before the first reply of all.
const FIRST_START: Duration = Duration::from_secs(60);

/// How long a program without any reply may be silent before a hint is given.
const SILENCE: Duration = Duration::from_secs(10);

pub(super) struct KeptAliveWorker<'a> {
    model: &'a CommandModel,
    context: &'a RunContext<'a>,
    protocol: Protocol,
    writer: RowWriter,
    session: Option<Session>,
}

/// Why a process is ended.
enum Fault {
    /// For this reason; its pending rows may be retried.
    Process(String),
    GiveUp(GiveUp),
}

impl<'a> KeptAliveWorker<'a> {
    pub(super) fn new(model: &'a CommandModel, context: &'a RunContext<'a>, protocol: Protocol) -> Self {
        let writer = RowWriter::new(protocol, &model.factors);
        Self { model, context, protocol, writer, session: None }
    }

    /// Sends rows until each has a reply or has failed.
    fn answer(&mut self, rows: &mut Rows<'_>) -> Result<(), GiveUp> {
        while rows.open > 0 {
            if self.context.is_stopped() {
                drop(self.session.take().map(|mut session| session.process.end(false)));
                return Err(RowFailure::interrupted().into());
            }
            let mut session = match self.session.take() {
                Some(session) => session,
                None => {
                    let program = &self.model.settings.program;
                    let process = Process::start(program, self.context.messages());
                    Session::new(process.map_err(|error| RowFailure::new(&program.refusal(&error)))?)
                }
            };
            self.send(&mut session, rows);
            match self.step(&mut session, rows) {
                Ok(()) => self.session = Some(session),
                Err(Fault::GiveUp(give_up)) => return Err(give_up),
                Err(Fault::Process(reason)) => self.end(session, &reason, rows)?,
            }
        }
        Ok(())
    }

    /// Sends as many rows as allowed: one before the first reply of the program and while rows are suspected.
    fn send(&self, session: &mut Session, rows: &mut Rows<'_>) {
        let is_ahead = self.model.state.has_answered() && rows.suspects.is_empty();
        while session.credit > 0 && !session.is_closed {
            let mut text = String::new();
            while text.len() < TEXT
                && (is_ahead && session.pending.len() < MAX_PENDING || session.pending.is_empty())
                && let Some(row) = rows.next()
            {
                if session.sent == 0 {
                    text = self.writer.header();
                }
                self.writer.write(rows.inputs, row, session.ask(row), &mut text);
            }
            if text.is_empty() {
                return;
            }
            session.credit -= 1;
            session.process.send(text);
        }
    }

    /// Handles the next event.
    fn step(&self, session: &mut Session, rows: &mut Rows<'_>) -> Result<(), Fault> {
        let left = self.model.settings.timeout.map(|timeout| timeout.saturating_sub(session.silent_for()));
        match session.process.event(left.map_or(ATTENTION, |left| left.min(ATTENTION))) {
            Some(Event::Output(bytes)) => {
                for line in session.lines(&bytes) {
                    self.handle_line(session, &line, rows)?;
                }
                if session.line.len() > LONGEST {
                    return Err(too_long(session));
                }
            }
            Some(Event::Sent) => session.credit += 1,
            Some(Event::Closed) => return Err(Fault::Process(closed(session))),
            None if left == Some(Duration::ZERO) => {
                session.process.end(false);
                let timeout = self.model.settings.timeout.map_or_else(String::new, seconds);
                let hint = if self.model.state.has_answered() { "" } else { "; does the program flush its output?" };
                return Err(Fault::Process(format!("no answer within {timeout}{hint}")));
            }
            // A process outside its group may still hold its output open, but it has printed all.
            None if session.has_ended => return Err(Fault::Process(closed(session))),
            None => self.wait(session),
        }
        Ok(())
    }

    /// Handles a line that the process has printed.
    fn handle_line(&self, session: &mut Session, line: &[u8], rows: &mut Rows<'_>) -> Result<(), Fault> {
        let (model, protocol) = (self.model, self.protocol);
        let words = match parse_answer(protocol, &model.names, line) {
            Err(words) => words,
            Ok((number, answer)) => match session.find(number) {
                Lookup::Pending(row) => {
                    match answer {
                        Ok(values) => rows.answer(row, &values),
                        Err(reason) => rows.fail(row, &reason),
                    }
                    model.state.note_answer(session.note_answer());
                    return Ok(());
                }
                Lookup::Answered => {
                    return Err(Fault::GiveUp(
                        RowFailure::new(&format!(
                            "the program answered row {number} twice, so the right answer is unknown: print one line \
                             for each row"
                        ))
                        .into(),
                    ));
                }
                Lookup::Unknown => format!("{number}, which is not the number of a requested row"),
            },
        };
        if !model.state.has_answered() || is_answer_without_number(protocol, &model.names, line) {
            let change = match protocol {
                Protocol::Csv => r#"print(row["id"], y, sep=",", flush=True)"#,
                Protocol::JsonLines => r#"print(json.dumps({"id": row["id"], "y": y}), flush=True)"#,
            };
            let reason = format!(
                "the program printed a line without the number of its row: {words}. Each row begins with its number, `id`; begin each \
                 answer with the same number, in Python with `{change}` (other languages: docs/reference/worker-protocol.md). Print all other output \
                 on standard error"
            );
            return Err(Fault::GiveUp(GiveUp { reason: RowFailure::new(&reason), is_bad_input: true }));
        }
        model.state.strayed.get_or_init(|| {
            let warning = "warning: the program printed a line that is not an answer and is ignored";
            self.context.messages().send(&format!("{warning}: {words}"));
        });
        session.strayed += line.len().max(1);
        session.stray = Some(words);
        if session.strayed > LONGEST { Err(too_long(session)) } else { Ok(()) }
    }

    /// Handles a timeout without events.
    fn wait(&self, session: &mut Session) {
        let state = &self.model.state;
        session.has_ended = session.process.clear_away();
        let silent_for = session.silent_for();
        let quiet = match state.has_answered() {
            true => QUIET.max(TIMES * Duration::from_micros(state.slowest.load(Ordering::Relaxed))),
            false => FIRST_START,
        };
        if !state.has_answered() && silent_for > SILENCE {
            state.hinted.get_or_init(|| {
                self.context.messages().send(
                    "still waiting for the program's first answer: it may still be starting (imports), need long for \
                     its first row, or not flush its output, as print(..., flush=True) does",
                );
            });
        }
        if silent_for > quiet {
            session.close();
        }
    }

    /// Ends the process, and decides what happens to its pending rows.
    fn end(&self, session: Session, reason: &str, rows: &mut Rows<'_>) -> Result<(), GiveUp> {
        let is_alone = session.sent == 1;
        for row in session.pending.into_values() {
            if rows.suspect(row, is_alone) > self.model.settings.retries && is_alone {
                rows.fail(row, reason);
                let hint =
                    "each row begins with its number, `id`, and so does each answer: docs/reference/worker-protocol.md";
                self.model.state.note_failure(&format!("{reason}; {hint}"))?;
            }
        }
        Ok(())
    }
}

impl Worker for KeptAliveWorker<'_> {
    fn run(&mut self, inputs: &[&[f64]], batch: &mut Batch) {
        let mut rows = Rows::new(self.model, inputs, batch);
        let outcome = self.answer(&mut rows);
        rows.finish();
        if let Err(give_up) = outcome {
            batch.give_up(give_up);
        }
    }
}

/// Ends a process whose standard output is closed, and says why it is.
fn closed(session: &mut Session) -> String {
    let ending = session.process.end(true);
    match &session.stray {
        _ if !ending.by_itself => "the program closed its standard output".to_owned(),
        _ if !session.is_closed || !ending.status.is_some_and(|status| status.success()) => {
            ended_in_words(ending.status, &ending.last_words)
        }
        Some(words) => format!("not an answer: {words}"),
        None => "the program gave no answer to the row".to_owned(),
    }
}

fn too_long(session: &mut Session) -> Fault {
    session.process.end(false);
    Fault::Process("the program printed more than 1 MiB without an answer".to_owned())
}
