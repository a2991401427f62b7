//! A long study that is interrupted, goes on where it stopped, and is made longer later: no run is ever made twice.
//!
//!     cargo run --release --example interrupted

use std::error::Error;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Duration;

use apportion::model::function_model;
use apportion::run::journal::{Journal, differences};
use apportion::run::{Piece, Progress, RunError, Store};
use apportion::space::Distribution;
use apportion::study::Study;
use apportion::{Analysis, Running, analyse, analyse_with};
use serde_json::json;

/// A study of a function that takes its time and counts its calls.
fn study(base_samples: u64, calls: &Arc<AtomicU64>) -> Result<Study, Box<dyn Error>> {
    let calls = Arc::clone(calls);
    let slow = move |x: &[f64]| {
        calls.fetch_add(1, Ordering::Relaxed);
        std::thread::sleep(Duration::from_micros(50));
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

/// What is on record of `study` in the journal at `path`, and the journal to go on with.
fn record(study: &Study, path: &Path) -> Result<(Store, Journal), Box<dyn Error>> {
    let store = Store::new(&study.design, study.model().as_ref());
    let header = json!({ "study": study.name, "identity": study.identity() });
    if !path.exists() {
        return Ok((store, Journal::create(path, &header)?));
    }
    let (journal, contents) = Journal::resume(path)?;
    // Runs with other factors or another seed are of no use here. (What the function computes is for you to know.)
    if let Some(difference) = differences(&contents.header, &header).first() {
        return Err(format!("the journal is of another study: {difference}").into());
    }
    for piece in &contents.pieces {
        store.insert(piece);
    }
    Ok((store, journal))
}

/// Runs what the journal at `path` lacks of `study`; ends early when `stop` is set, here or by a signal handler.
fn go_on(
    study: &Study,
    path: &Path,
    stop: &AtomicBool,
    on_progress: &(dyn Fn(Progress) + Sync),
) -> Result<Analysis, Box<dyn Error>> {
    let (store, journal) = record(study, path)?;
    let keep = |piece: &Piece| journal.append(piece);
    let running = Running { store: Some(&store), keep: Some(&keep), stop: Some(stop), on_progress, ..Running::on(2) };
    let outcome = analyse_with(study, running);
    journal.sync()?;
    Ok(outcome?)
}

pub fn main() -> Result<(), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("slow.journal");
    let calls = Arc::new(AtomicU64::new(0));
    let made = || calls.swap(0, Ordering::Relaxed);
    let short = study(1024, &calls)?;

    // Somebody interrupts it after a quarter.
    let stop = AtomicBool::new(false);
    let interrupt = |progress: Progress| stop.store(progress.done >= progress.total / 4, Ordering::Relaxed);
    let interrupted = go_on(&short, &path, &stop, &interrupt).err().ok_or("it was not interrupted")?;
    assert!(matches!(interrupted.downcast_ref(), Some(RunError::Interrupted { .. })));
    let before = made();
    println!("{interrupted}; {before} runs are in the journal");

    // Another day, another process: only the runs that are missing are made.
    let never = AtomicBool::new(false);
    let result = go_on(&short, &path, &never, &|_| ())?;
    let after = made();
    println!("gone on with: {after} runs more");
    assert_eq!(before + after, short.design.rows());

    // The same bits as without the interruption.
    assert_eq!(result.outputs[0].indices, analyse(&short, 0, &|_| ())?.outputs[0].indices);
    made();

    // Twice the base samples: the first half of the runs is on record.
    let long = study(2048, &calls)?;
    let longer = go_on(&long, &path, &never, &|_| ())?;
    let more = made();
    println!("made twice as long: {more} runs more");
    assert_eq!(more, long.design.rows() - short.design.rows());
    assert_eq!(longer.outputs[0].runs_ok, long.design.rows());
    Ok(())
}
