//! Progress: a bar with rate and time left on a terminal, a plain line every few seconds elsewhere.

use std::io::IsTerminal;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use apportion::run::Progress;
use apportion_report::grouped;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Shows how far one run has come, on standard error.
pub struct Meter {
    label: String,
    /// Runs that were on record when the run began.
    recalled: AtomicU64,
    /// On a terminal.
    bar: Option<ProgressBar>,
    /// When the last line was written elsewhere.
    last_line: Mutex<Instant>,
}

/// Time between plain lines.
const LINE_INTERVAL: Duration = Duration::from_secs(5);

impl Meter {
    /// A meter for a run of `total` model runs, named `label`.
    pub fn new(label: &str, total: u64) -> Self {
        let bar = std::io::stderr().is_terminal().then(|| {
            // Drawn from the first progress on: earlier messages would leave a copy of it behind.
            let bar = ProgressBar::with_draw_target(Some(total), ProgressDrawTarget::hidden());
            let template = "{prefix} {wide_bar} {percent:>3} %  {human_pos} of {human_len} runs  {eta} left{msg}";
            bar.set_style(ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar()));
            bar.set_prefix(label.to_owned());
            bar
        });
        Self { label: label.to_owned(), recalled: AtomicU64::new(0), bar, last_line: Mutex::new(Instant::now()) }
    }

    /// Takes note of progress; may be called from any thread.
    pub fn update(&self, progress: Progress) {
        self.recalled.store(progress.recalled, Ordering::Relaxed);
        if let Some(bar) = &self.bar {
            if bar.is_hidden() {
                bar.set_draw_target(ProgressDrawTarget::stderr());
            }
            // The length of a growing run changes during it.
            bar.set_length(progress.total);
            if progress.failed > 0 {
                bar.set_message(format!("  {} failed", progress.failed));
            }
            bar.set_position(progress.done);
        } else if let Ok(mut last) = self.last_line.try_lock()
            // Another thread with the lock is about to write the line: this one need not wait.
            && last.elapsed() >= LINE_INTERVAL
        {
            *last = Instant::now();
            super::say(&self.line(progress));
        }
    }

    /// Ends the display with one line that stays, about those of `runs` that were not on record.
    pub fn finish(&self, runs: u64, seconds: f64) {
        let runs = runs.saturating_sub(self.recalled.load(Ordering::Relaxed));
        let rate = rate(runs as f64 / seconds);
        self.end(&format!("{} model runs in {seconds:.2} s ({rate})", grouped(runs)));
    }

    /// The same about the `runs` of a result, which may be those of earlier `trials` in part, and about these.
    pub fn finish_after(&self, trials: u64, runs: u64, seconds: f64) {
        let before = if trials > 0 { format!(", after {} in trials", grouped(trials)) } else { String::new() };
        self.end(&format!("{} model runs in {seconds:.2} s{before}", grouped(runs)));
    }

    fn end(&self, line: &str) {
        self.bar.iter().for_each(ProgressBar::finish_and_clear);
        super::say(&format!("{}: {line}", self.label));
    }

    fn line(&self, progress: Progress) -> String {
        let Progress { done, recalled, total, failed, elapsed } = progress;
        let seconds = elapsed.as_secs_f64();
        let per_second = (done - recalled) as f64 / seconds;
        // The first few runs include the start-up time, so they say nothing of the others.
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
        self.bar.iter().for_each(ProgressBar::finish_and_clear);
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
