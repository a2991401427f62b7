//! The context of a run: stop requests to its workers, and messages from them.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// The context of a run for its workers: whether it is to stop, and where their messages go.
///
/// ```
/// use std::sync::atomic::{AtomicBool, Ordering};
/// use apportion::RunContext;
///
/// let stop = AtomicBool::new(false);
/// let context = RunContext::new(Some(&stop), |line| eprintln!("{line}"));
/// stop.store(true, Ordering::Relaxed);
/// assert!(context.is_stopped());
/// ```
#[derive(Debug, Default)]
pub struct RunContext<'a> {
    stop: Option<&'a AtomicBool>,
    ended: AtomicBool,
    messages: Messages,
}

impl<'a> RunContext<'a> {
    /// Creates the context of a run that stops when `stop` is set, and passes every message of its workers, a line, to
    /// `on_message`. (The default is a run without a stop that discards messages.)
    pub fn new(stop: Option<&'a AtomicBool>, on_message: impl Fn(&str) + Send + Sync + 'static) -> Self {
        let messages = Messages { receiver: Some(Arc::new(on_message)), lines: Arc::default() };
        Self { stop, ended: AtomicBool::new(false), messages }
    }

    /// Returns whether workers are to stop their current work soon: they then [give up](super::Batch::give_up) with
    /// [`RowFailure::interrupted`](super::RowFailure::interrupted). A model whose rows take negligible time need not
    /// check.
    pub fn is_stopped(&self) -> bool {
        self.ended.load(Ordering::Relaxed) || self.is_interrupted()
    }

    /// Returns the receiver of messages.
    pub fn messages(&self) -> &Messages {
        &self.messages
    }

    /// Returns whether the caller wants the run to stop.
    pub(crate) fn is_interrupted(&self) -> bool {
        self.stop.is_some_and(|stop| stop.load(Ordering::Relaxed))
    }

    /// Asks the workers to stop, for a reason within the run.
    pub fn end(&self) {
        self.ended.store(true, Ordering::Relaxed);
    }
}

/// Maximum number of lines from programs' standard error that are passed on; the others are counted.
const MAX_LINES: u64 = 20;

type Receiver = Arc<dyn Fn(&str) + Send + Sync>;

/// Messages of the workers of one run, in order. Clones go to the same receiver.
#[derive(Clone, Default)]
pub struct Messages {
    receiver: Option<Receiver>,
    /// Number of lines of programs so far.
    lines: Arc<AtomicU64>,
}

impl std::fmt::Debug for Messages {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Messages").field("lines", &self.lines).finish_non_exhaustive()
    }
}

impl Messages {
    /// Sends a line.
    pub fn send(&self, line: &str) {
        if let Some(receiver) = &self.receiver {
            receiver(line);
        }
    }

    /// Sends a line that a program has printed, up to the maximum number of lines.
    pub fn send_printed(&self, line: &str) {
        if self.lines.fetch_add(1, Ordering::Relaxed) < MAX_LINES {
            self.send(line);
        }
    }

    /// Reports how many lines of programs were not sent; to be called at the end of a run.
    pub fn finish(&self) {
        let left_out = self.lines.swap(0, Ordering::Relaxed).saturating_sub(MAX_LINES);
        if left_out > 0 {
            let lines = if left_out == 1 { "line" } else { "lines" };
            self.send(&format!("the program: {left_out} more {lines} on standard error left out"));
        }
    }
}
