//! A long study that is interrupted, goes on where it stopped, and is made longer later.
//!
//!     cargo run --release --example interrupted

use std::error::Error;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Duration;

use apportion::{Distribution, Progress, RunError, Study, StudyResult, function_model};

/// A study of a function that takes its time and counts its calls.
fn study(base_samples: u64, calls: &Arc<AtomicU64>) -> Result<Study, Box<dyn Error>> {
    let calls = Arc::clone(calls);
    let slow = move |x: &[f64]| {
        calls.fetch_add(1, Ordering::Relaxed);
        std::thread::sleep(Duration::from_micros(5));
        x[0] + x[1] * x[2]
    };
    let study = Study::builder("slow", function_model("y", slow))
        .factor("a", Distribution::uniform(0.0, 1.0)?)
        .factor("b", Distribution::uniform(0.0, 2.0)?)
        .factor("c", Distribution::uniform(0.0, 3.0)?)
        .base_samples(base_samples)
        .build()?;
    Ok(study)
}

/// Runs what the journal at `path` lacks of `study`; ends early when `stop` is set, here or by a signal handler.
fn go_on(
    study: &Study,
    path: &Path,
    stop: &AtomicBool,
    on_progress: impl Fn(Progress) + Send + Sync,
) -> Result<StudyResult, RunError> {
    study.runner().threads(2).on_progress(on_progress).stop(stop).journal(path).run()
}

pub fn main() -> Result<(), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("slow.journal");
    let calls = Arc::new(AtomicU64::new(0));
    let made = || calls.swap(0, Ordering::Relaxed);
    let short = study(4096, &calls)?;

    // Somebody interrupts it after a third.
    let stop = AtomicBool::new(false);
    let interrupt = |progress: Progress| stop.store(progress.done >= progress.total / 3, Ordering::Relaxed);
    let interrupted = go_on(&short, &path, &stop, interrupt).err().ok_or("it was not interrupted")?;
    assert!(matches!(interrupted, RunError::Interrupted { .. }));
    let before = made();
    println!("{interrupted}; of {before} runs the sums are in the journal");

    // Another day, another process: only blocks of runs that are not in the sums are made.
    let never = AtomicBool::new(false);
    let result = go_on(&short, &path, &never, |_| ())?;
    let after = made();
    println!("gone on with: {after} runs more");
    assert!(after < short.design().rows() && before + after >= short.design().rows());

    // The same bits as without the interruption.
    assert_eq!(result.outputs[0].indices, short.run()?.outputs[0].indices);
    made();

    // Twice the base samples: the first half of the runs is on record.
    let long = study(8192, &calls)?;
    let longer = go_on(&long, &path, &never, |_| ())?;
    let more = made();
    println!("made twice as long: {more} runs more");
    assert_eq!(more, long.design().rows() - short.design().rows());
    assert_eq!(longer.outputs[0].runs_ok, long.design().rows());
    Ok(())
}
