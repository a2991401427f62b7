//! Progress: a bar with rate and time left on a terminal, a plain line every few seconds elsewhere.

use std::sync::Mutex;
use std::time::{Duration, Instant};

use apportion::run::Progress;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};

/// Shows how far one run has come, on standard error.
pub struct Meter {
    label: String,
    display: Display,
}

enum Display {
    Bar(ProgressBar),
    Lines(Mutex<Instant>),
}

/// Time between plain lines.
const LINE_INTERVAL: Duration = Duration::from_secs(5);

impl Meter {
    /// A meter for a run of `total` model runs, named `label`.
    pub fn new(label: &str, total: u64) -> Self {
        let display = if super::stderr_is_terminal() {
            // Drawn from the first progress on: lines that are written before would leave it behind.
            let bar = ProgressBar::with_draw_target(Some(total), ProgressDrawTarget::hidden());
            let template = "{prefix} {bar:32} {percent:>3} %  {human_pos} of {human_len} runs  {rate}  {eta} left{msg}";
            let style = ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
            bar.set_style(style.with_key("rate", |state: &ProgressState, out: &mut dyn std::fmt::Write| {
                // A bar that cannot be drawn has nobody to tell.
                let _ = out.write_str(&rate(state.per_sec()));
            }));
            bar.set_prefix(label.to_owned());
            Display::Bar(bar)
        } else {
            Display::Lines(Mutex::new(Instant::now()))
        };
        Self { label: label.to_owned(), display }
    }

    /// Takes note of progress; may be called from any thread.
    pub fn update(&self, progress: Progress) {
        match &self.display {
            Display::Bar(bar) => {
                if bar.is_hidden() {
                    bar.set_draw_target(ProgressDrawTarget::stderr());
                }
                // A run that grows learns its length as it goes.
                bar.set_length(progress.total);
                bar.set_position(progress.done);
                if progress.failed > 0 {
                    bar.set_message(format!("  {} failed", progress.failed));
                }
            }
            Display::Lines(last) => {
                // Another thread at the lock is about to write the line: this one need not wait.
                let Ok(mut last) = last.try_lock() else { return };
                if last.elapsed() >= LINE_INTERVAL {
                    *last = Instant::now();
                    super::say(&self.line(progress));
                }
            }
        }
    }

    /// Ends the display with one line that stays.
    pub fn finish(&self, runs: u64, seconds: f64) {
        if let Display::Bar(bar) = &self.display {
            bar.finish_and_clear();
        }
        let rate = rate(runs as f64 / seconds);
        super::say(&format!("{}: {runs} model runs in {seconds:.2} s ({rate})", self.label));
    }

    fn line(&self, progress: Progress) -> String {
        let Progress { done, recalled, total, failed, elapsed } = progress;
        let seconds = elapsed.as_secs_f64();
        let per_second = (done - recalled) as f64 / seconds;
        // The first few runs include what it takes to start, and say nothing of the others.
        let left = match done - recalled {
            runs if runs >= 20 || runs * 100 >= total => {
                format!(", {:.0} s left", total.saturating_sub(done) as f64 / per_second)
            }
            _ => String::new(),
        };
        let failed = if failed > 0 { format!(", {failed} failed") } else { String::new() };
        let percent = 100.0 * done as f64 / total as f64;
        format!("{}: {percent:.0} %, {done} of {total} runs, {}{left}{failed}", self.label, rate(per_second))
    }
}

/// A run that ends early leaves no bar behind.
impl Drop for Meter {
    fn drop(&mut self) {
        if let Display::Bar(bar) = &self.display {
            bar.finish_and_clear();
        }
    }
}

/// Shows how far something has come that is not counted in runs, on standard error.
pub struct PartMeter {
    label: String,
    display: Display,
}

impl PartMeter {
    /// A meter named `label`.
    pub fn new(label: &str) -> Self {
        let display = if super::stderr_is_terminal() {
            let bar = ProgressBar::new(1000);
            let style = ProgressStyle::with_template("{prefix} {bar:32} {percent:>3} %  {msg}");
            bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
            bar.set_prefix(label.to_owned());
            Display::Bar(bar)
        } else {
            Display::Lines(Mutex::new(Instant::now()))
        };
        Self { label: label.to_owned(), display }
    }

    /// Takes note that `share` of all, 0 to 1, is done, and that `doing` comes next.
    pub fn update(&self, doing: &str, share: f64) {
        match &self.display {
            Display::Bar(bar) => {
                bar.set_position((1000.0 * share) as u64);
                bar.set_message(doing.to_owned());
                if share >= 1.0 {
                    bar.finish_and_clear();
                }
            }
            Display::Lines(last) => {
                let Ok(mut last) = last.try_lock() else { return };
                if last.elapsed() >= LINE_INTERVAL {
                    *last = Instant::now();
                    super::say(&format!("{}: {:.0} %, {doing}", self.label, 100.0 * share));
                }
            }
        }
    }
}

/// Runs per second, readable.
fn rate(per_second: f64) -> String {
    match per_second {
        r if !r.is_finite() => "-".to_owned(),
        r if r >= 1e6 => format!("{:.1} million runs/s", r / 1e6),
        r if r >= 1e4 => format!("{:.0} thousand runs/s", r / 1e3),
        r => format!("{r:.0} runs/s"),
    }
}
