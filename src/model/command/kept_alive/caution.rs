//! How carefully the next process is asked.

/// What has been learnt from processes that ended early.
pub(super) struct Caution {
    /// The next process gets so many rows, which are then confirmed, and the row behind them goes alone; with how many it
    /// went before.
    pub plan: Option<(usize, usize)>,
    /// The next row goes alone; with how many it went before.
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
            // The row was innocent: one of those that went with it is not.
            (self.window, self.in_window) = (ahead / 2, 0);
        }
    }
}
