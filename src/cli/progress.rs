//! Progress: a bar with rate and time left on a terminal, a plain line every few seconds elsewhere.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use apportion::report::grouped;
use apportion::run::Progress;
use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use unicode_width::{UnicodeWidthChar, UnicodeWidthStr};

/// Shows how far one run has come, on standard error.
pub struct Meter {
    label: String,
    /// Runs that have failed, for the bar, which is drawn by a thread of its own.
    failed: Arc<AtomicU64>,
    /// Runs that were on record when the run began.
    recalled: AtomicU64,
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
        let failed = Arc::new(AtomicU64::new(0));
        let display = if super::stderr_is_terminal() {
            // Drawn from the first progress on: lines that are written before would leave it behind.
            let bar = ProgressBar::with_draw_target(Some(total), ProgressDrawTarget::hidden());
            let style = ProgressStyle::with_template("{line}").unwrap_or_else(|_| ProgressStyle::default_bar());
            let (label, failures) = (label.to_owned(), Arc::clone(&failed));
            bar.set_style(style.with_key("line", move |state: &ProgressState, out: &mut dyn std::fmt::Write| {
                let shown = Shown {
                    done: state.pos(),
                    total: state.len().unwrap_or_default(),
                    per_second: state.per_sec(),
                    left: state.eta(),
                    failed: failures.load(Ordering::Relaxed),
                };
                // A bar that cannot be drawn has nobody to tell.
                let _ = out.write_str(&shown.line(&label, super::stderr_width().unwrap_or(USUAL_WIDTH)));
            }));
            Display::Bar(bar)
        } else {
            Display::Lines(Mutex::new(Instant::now()))
        };
        Self { label: label.to_owned(), failed, recalled: AtomicU64::new(0), display }
    }

    /// Takes note of progress; may be called from any thread.
    pub fn update(&self, progress: Progress) {
        self.recalled.store(progress.recalled, Ordering::Relaxed);
        match &self.display {
            Display::Bar(bar) => {
                if bar.is_hidden() {
                    bar.set_draw_target(ProgressDrawTarget::stderr());
                }
                // A run that grows learns its length as it goes.
                bar.set_length(progress.total);
                self.failed.store(progress.failed, Ordering::Relaxed);
                bar.set_position(progress.done);
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
        if let Display::Bar(bar) = &self.display {
            bar.finish_and_clear();
        }
        super::say(&format!("{}: {line}", self.label));
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

/// Columns of a terminal that does not say how wide it is.
const USUAL_WIDTH: usize = 80;

/// What one line says of a run that goes on.
struct Shown {
    done: u64,
    total: u64,
    per_second: f64,
    left: Duration,
    failed: u64,
}

impl Shown {
    /// The line in less than `width` columns, since a full one makes some terminals begin another: what matters least is
    /// left out, the bar first.
    fn line(&self, label: &str, width: usize) -> String {
        const BAR: usize = 32;
        const SHORTEST_BAR: usize = 8;
        let room = width.saturating_sub(1);
        let label = shortened(label, (room / 3).max(SHORTEST_BAR));
        let share = if self.total == 0 { 1.0 } else { (self.done as f64 / self.total as f64).min(1.0) };
        let failed = if self.failed > 0 { format!("  {} failed", self.failed) } else { String::new() };
        // In the order of reading, each with its rank.
        let parts = [
            (0, format!(" {:>3.0} %", (100.0 * share).floor())),
            (3, format!("  {} of {} runs", grouped(self.done), grouped(self.total))),
            (4, format!("  {}", rate(self.per_second))),
            (2, format!("  {:#} left", HumanDuration(self.left))),
            (1, failed),
        ];
        let mut ranks: Vec<usize> = (0..parts.len()).collect();
        ranks.sort_by_key(|part| parts[*part].0);
        let mut left = room.saturating_sub(label.width());
        let mut shown = [false; 5];
        for part in ranks {
            let needed = parts[part].1.width();
            if needed <= left {
                left -= needed;
                shown[part] = true;
            }
        }
        let bar = match left.saturating_sub(1).min(BAR) {
            short if short < SHORTEST_BAR => String::new(),
            length => {
                let full = (share * length as f64) as usize;
                format!(" {}{}", "\u{2588}".repeat(full), "\u{2591}".repeat(length - full))
            }
        };
        let parts = parts.into_iter().zip(shown).filter(|(_, shown)| *shown).map(|((_, text), _)| text);
        format!("{label}{bar}{}", parts.collect::<String>())
    }
}

/// `text`, or as much of its beginning as fits into `width` columns.
fn shortened(text: &str, width: usize) -> String {
    if text.width() <= width {
        return text.to_owned();
    }
    let mut left = width.saturating_sub(1);
    let fits = |c: &char| {
        let fits = c.width().unwrap_or(0) <= left;
        left = left.saturating_sub(c.width().unwrap_or(0));
        fits
    };
    format!("{}\u{2026}", text.chars().take_while(fits).collect::<String>())
}

/// A run that ends early leaves no bar behind.
impl Drop for Meter {
    fn drop(&mut self) {
        if let Display::Bar(bar) = &self.display {
            bar.finish_and_clear();
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

#[cfg(test)]
mod tests {
    use super::*;

    /// At 80 columns the line once took 81.
    #[test]
    fn a_line_is_narrower_than_the_terminal() {
        let left = Duration::from_secs(7265);
        let long = "a study whose name is longer than the line of any terminal that has it on its screen";
        for label in ["y", "nanoparticle", long, "\u{754c}\u{754c}\u{754c}\u{754c}\u{754c}"] {
            for (done, total, failed) in [(0, 0, 0), (0, 1024, 0), (1_234_567, 98_765_432, 123_456), (5, 3, 0)] {
                for width in 20..130 {
                    let shown = Shown { done, total, per_second: 123_456.7, left, failed };
                    let line = shown.line(label, width);
                    assert!(line.width() < width, "{} of {width}: {line}", line.width());
                }
            }
        }
        let shown = Shown { done: 512, total: 1024, per_second: 100.0, left: Duration::from_secs(5), failed: 3 };
        let bar = format!("{}{}", "\u{2588}".repeat(11), "\u{2591}".repeat(11));
        assert_eq!(shown.line("y", 80), format!("y {bar}  50 %  512 of 1024 runs  100 runs/s  5s left  3 failed"));
        assert_eq!(shown.line("y", 40), "y  50 %  100 runs/s  5s left  3 failed");
    }
}
