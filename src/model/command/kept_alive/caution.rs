//! How carefully the next process is asked.

/// What has been learnt from processes that ended early.
pub(super) struct Caution {
    /// How many rows the next process gets, whose answers are then confirmed. The row behind them is sent alone; the second number
    /// is with how many rows it was sent before.
    pub plan: Option<(usize, usize)>,
    /// If the next row is sent alone: with how many rows it was sent before.
    pub alone: Option<usize>,
    /// How often the row that goes alone has been tried in vain.
    pub tries: u32,
    /// How far rows may be ahead of the answers, and answers since it was set.
    pub window: usize,
    in_window: usize,
}

impl Default for Caution {
    fn default() -> Self {
        Self { plan: None, alone: None, tries: 0, window: usize::MAX, in_window: 0 }
    }
}

impl Caution {
    /// A row has its answer.
    pub(super) fn note_answer(&mut self) {
        if self.window < usize::MAX && self.alone.is_none() {
            self.in_window += 1;
            if self.in_window >= self.window {
                (self.window, self.in_window) = (self.window.saturating_mul(2), 0);
            }
        }
    }

    /// The row that went alone has its answer.
    pub(super) fn settle(&mut self) {
        self.tries = 0;
        if let Some(ahead) = self.alone.take().filter(|ahead| *ahead > 1) {
            // So the fault lies with one of the rows that were sent with it.
            (self.window, self.in_window) = (ahead / 2, 0);
        }
    }
}
