//! What becomes of rows on which a process was found out.

use std::process::ExitStatus;
use std::sync::atomic::Ordering;

use super::super::process::Ending;
use super::super::program::status_in_words;
use super::piece::Piece;
use super::talk::{Session, Talk};
use super::{Fault, KeptAliveWorker};
use crate::model::shorten::{masked, seconds};
use crate::model::{RowFailure, Standing};

/// What helps against answers whose rows are unknown.
const ADVICE: &str = "print one line for each row and everything else to standard error, and let answers name their rows \
                      (row_numbers = true; see docs/worker-protocol.md)";

impl KeptAliveWorker<'_> {
    /// Ends the process and decides what becomes of its rows: whether those of earlier batches still stand.
    ///
    /// # Errors
    /// Why the program is given up.
    pub(super) fn blame(&mut self, fault: &Fault, piece: &mut Piece<'_>) -> Result<Standing, RowFailure> {
        let Some(Talk { mut process, session, ending, .. }) = self.talk.take() else { return Ok(Standing::Pending) };
        let ending = ending.unwrap_or_else(|| process.end(matches!(fault, Fault::Closed)));
        if let Fault::Twice(number) = fault {
            return Err(RowFailure::new(&format!(
                "the program answered the row with the number {number} twice: which of the answers is right is unknown; \
                 print one line for each row"
            )));
        }
        let reason = self.reason(fault, &ending, &session);
        if self.form.row_numbers {
            return self.suspect(piece, &session, &reason).map(|()| Standing::Pending);
        }
        let standing = if piece.base > 0 { Standing::Revoked } else { Standing::Pending };
        piece.rewind();
        let is_surplus = match fault {
            Fault::Surplus => true,
            // Nobody asked for these either.
            Fault::Rubbish(_) | Fault::LongLine => session.under_way() == 0,
            _ => false,
        };
        let is_end = matches!(fault, Fault::Closed) && session.closed.is_some();
        let slip = match session.under_way() {
            _ if is_surplus => Some("it printed more answers than it had rows"),
            0 if is_end => Some("it died after as many answers as it had rows"),
            1.. if is_end && is_success(ending.status) => Some("it printed fewer answers than it had rows"),
            _ => None,
        };
        if let Some(how) = slip.filter(|_| session.most > 1) {
            self.fall_out_of_step(&session, how);
        } else if session.most > 1 && session.answered > 0 {
            // Whether these answers were in step is unknown. All but the last are asked for again: if one of the lines was
            // too many, and the process ended on its own on the last row, there would be as many answers as rows once more.
            let (rows, ahead) = (session.answered - 1, session.under_way() + 1);
            match rows {
                0 => self.caution.alone = Some(ahead),
                _ => self.caution.plan = Some((rows, ahead)),
            }
        } else if is_surplus {
            self.caution.tries += 1;
            if self.caution.tries > self.model.settings.retries {
                return Err(RowFailure::new(&format!(
                    "the program printed more than one line for a row, asked by a process of its own: which of them is \
                     the answer is unknown; {ADVICE}"
                )));
            }
        } else {
            self.suspect(piece, &session, &reason)?;
        }
        Ok(standing)
    }

    /// The first row under way without an answer is tried alone, or fails if it has been.
    fn suspect(&mut self, piece: &mut Piece<'_>, session: &Session, reason: &str) -> Result<(), RowFailure> {
        // Its only answer may be no answer, if it died.
        let ahead = if session.most == 1 { 1 } else { session.under_way() };
        let Some(row) = piece.first_open().filter(|_| ahead > 0) else { return Ok(()) };
        self.caution.tries += 1;
        if ahead > 1 || self.caution.tries <= self.model.settings.retries {
            self.caution.alone = Some(ahead.max(self.caution.alone.unwrap_or(1)));
            return Ok(());
        }
        piece.fail(row, reason);
        piece.confirm();
        piece.alone += usize::from(self.asks_singly());
        (self.caution.alone, self.caution.tries) = (None, 0);
        self.model.state.note_barren(reason)
    }

    fn fall_out_of_step(&mut self, session: &Session, how: &str) {
        (self.caution.plan, self.caution.alone, self.caution.tries) = (None, None, 0);
        if self.model.state.out_of_step.swap(true, Ordering::Relaxed) {
            return;
        }
        let rows = if session.sent == 1 { "the row".to_owned() } else { format!("the {} rows", session.sent) };
        self.context.messages().send(&format!(
            "warning: the program is out of step: {how}; {rows} since it was last known to be in \
             step are asked again, and all that follow, each by a process of its own; {ADVICE}"
        ));
    }

    fn reason(&self, fault: &Fault, ending: &Ending, session: &Session) -> String {
        match fault {
            Fault::Closed if ending.by_itself && session.closed.is_some() && is_success(ending.status) => {
                match &session.stray {
                    Some(words) => format!("not an answer: {words}"),
                    None => "the program gave no answer to the row".to_owned(),
                }
            }
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
            Fault::Surplus | Fault::Twice(_) => "the program printed more than one line for a row".to_owned(),
        }
    }
}

fn is_success(status: Option<ExitStatus>) -> bool {
    status.is_some_and(|status| status.success())
}
