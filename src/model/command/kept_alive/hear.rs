//! What a line means that a process has printed.

use super::super::protocol::{Answer, parse_answer, parse_numbered_answer};
use super::super::{CommandModel, State};
use super::numbers::count_of;
use super::piece::Piece;
use super::talk::{LONGEST, Session, Talk};
use super::{Caution, Fault, KeptAliveWorker};
use crate::model::Messages;

impl KeptAliveWorker<'_> {
    /// Takes the answers in `bytes`.
    pub(super) fn hear(&mut self, bytes: &[u8], piece: &mut Piece<'_>) -> Result<(), Fault> {
        let Self { model, context, form, talk, caution, .. } = self;
        let messages = context.messages();
        let Some(Talk { lines, session, .. }) = talk else { return Ok(()) };
        let mut hearing = Hearing { model, messages, session, caution, piece, values: Vec::new() };
        lines.feed(bytes, |line| {
            hearing.values.clear();
            if form.row_numbers {
                let read = parse_numbered_answer(form.protocol, &model.names, line, &mut hearing.values);
                hearing.numbered(read)
            } else {
                let answer = parse_answer(form.protocol, &model.names, line, &mut hearing.values);
                hearing.in_order(answer, line)
            }
        })
    }
}

struct Hearing<'a, 'b> {
    model: &'a CommandModel,
    messages: &'a Messages,
    session: &'a mut Session,
    caution: &'a mut Caution,
    piece: &'a mut Piece<'b>,
    values: Vec<f64>,
}

impl Hearing<'_, '_> {
    /// The answer to the first row without one.
    fn in_order(&mut self, answer: Result<Answer, String>, line: &[u8]) -> Result<(), Fault> {
        let Some(row) = self.piece.open_row(self.session.answered) else {
            return match answer {
                // Words after the last answer are no answer. An empty line may be what is left of two that were
                // printed at once, one of them into the other.
                Err(words) if !line.trim_ascii().is_empty() => self.stray(words, line.len()),
                _ => Err(Fault::Surplus),
            };
        };
        self.take(row, answer.map_err(Fault::Rubbish)?);
        Ok(())
    }

    /// The answer to the row of that number.
    fn numbered(&mut self, read: Result<(u64, Result<Answer, String>), String>) -> Result<(), Fault> {
        let (number, answer) = match read {
            Ok(read) => read,
            Err(words) => return self.stray(words, 1),
        };
        let Some(count) = count_of(number, self.session.sent) else {
            return self.stray("the number of a row that was not asked".to_owned(), 1);
        };
        let row = self.piece.open_row(count).ok_or(Fault::Twice(number))?;
        let answer = answer.unwrap_or_else(|words| Answer::Failed(format!("not an answer: {words}")));
        self.take(row, answer);
        self.caution.settle();
        Ok(())
    }

    fn take(&mut self, row: usize, answer: Answer) {
        match answer {
            Answer::Values => self.piece.answer(row, &self.values),
            Answer::Failed(reason) => self.piece.fail(row, &reason),
        }
        self.session.answered += 1;
        self.caution.note_answer();
    }

    /// A line that is no answer and stands for none.
    fn stray(&mut self, words: String, length: usize) -> Result<(), Fault> {
        self.session.strayed += length.max(1);
        let is_flood = self.session.strayed > LONGEST;
        // A program that has never answered may not know how.
        let is_first = !self.model.state.has_answered() && self.session.answered == 0 && self.session.closed.is_none();
        if is_flood || is_first {
            return Err(Fault::Rubbish(words));
        }
        State::send_once(
            &self.model.state.strayed,
            self.messages,
            &format!("warning: the program printed a line that is no answer, which is left out: {words}"),
        );
        self.session.stray = Some(words);
        Ok(())
    }
}
