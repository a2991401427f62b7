//! Cases that take too long, or occur too rarely, to be tested through the program.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Duration;

use apportion::model::{Batch, GiveUp, Model, RowFailure, RunContext};
use apportion::quantity::Unit;
use apportion::space::{Distribution, Factor};

use crate::{CommandModel, CommandOutput, CommandSettings, Form, Program, Protocol};

/// A script for `sh` as a model of one factor and one output.
fn model(script: &str) -> CommandModel {
    let settings = CommandSettings {
        program: Program {
            arguments: ["sh", "-c", script].map(str::to_owned).to_vec(),
            directory: std::env::temp_dir(),
            environment: Vec::new(),
        },
        form: Form::KeptAlive(Protocol::Csv),
        outputs: vec![CommandOutput { name: "y".to_owned(), unit: Unit::dimensionless(), pick: None }],
        series: Vec::new(),
        asked: vec![0],
        workers: Some(1),
        timeout: None,
        retries: 1,
    };
    let law = Distribution::uniform(0.0, 9.0).unwrap();
    CommandModel::new(settings, vec![Factor::new("x", Unit::dimensionless(), law).unwrap()])
}

/// The outputs of the model for `x`; no row may fail.
#[track_caller]
fn answers(model: &CommandModel, x: &[f64]) -> Vec<f64> {
    let mut batch = Batch::new(model);
    batch.reset(x.len());
    model.worker(&RunContext::default()).run(&[x], &mut batch);
    batch.settle();
    assert_eq!((batch.given_up(), batch.failures()), (None, &[][..]));
    batch.column(0).to_vec()
}

const ECHO: &str = "while read -r x; do echo \"$x\"; done";

#[test]
fn a_program_silent_at_its_first_row_gets_a_hint_to_flush() {
    let slow = format!("read -r header; read -r x; sleep 0.6; echo \"$x\"; {ECHO}");
    for (silence, hinted) in [(Duration::from_millis(50), true), (super::super::SILENCE, false)] {
        let mut model = model(&slow);
        model.silence = silence;
        assert_eq!(answers(&model, &[1.5, 2.5]), [1.5, 2.5]);
        assert_eq!(model.state.hinted.load(Ordering::Relaxed), hinted);
    }
}

#[test]
fn a_program_that_has_answered_gets_no_hint_to_flush() {
    // Slow over every row of a process but its first.
    let slow = "read -r header; n=0; while read -r x; do test $n -eq 0 || sleep 0.2; n=1; echo \"$x\"; done";
    let mut model = model(slow);
    assert_eq!(answers(&model, &[1.0]), [1.0]);
    // A process with any start time, which is not the first.
    model.silence = Duration::ZERO;
    assert_eq!(answers(&model, &[1.0, 2.0, 3.0]), [1.0, 2.0, 3.0]);
    assert!(!model.state.hinted.load(Ordering::Relaxed));
}

#[test]
fn a_model_can_be_run_again_after_it_was_interrupted_and_messages_go_to_the_run() {
    let model = model("read -r header; echo started >&2; while read -r x; do sleep 0.1; echo \"$x\"; done");
    let (stop, messages) = (AtomicBool::new(false), Arc::new(Mutex::new(Vec::new())));
    let receiver = Arc::clone(&messages);
    let context = RunContext::new(Some(&stop), move |line| receiver.lock().unwrap().push(line.to_owned()));
    let mut batch = Batch::new(&model);
    batch.reset(100);
    thread::scope(|scope| {
        scope.spawn(|| {
            thread::sleep(Duration::from_millis(500));
            stop.store(true, Ordering::Relaxed);
        });
        model.worker(&context).run(&[&[1.0; 100]], &mut batch);
    });
    assert_eq!(batch.given_up(), Some(&GiveUp::from(RowFailure::interrupted())));
    assert!(messages.lock().unwrap().contains(&"the program: started".to_owned()));
    assert_eq!(answers(&model, &[1.5, 2.5]), [1.5, 2.5]);
}

/// Each process answers one row: all rows are answered, each by another process.
#[test]
fn a_program_that_closes_its_output_after_its_first_answer_is_started_for_every_row() {
    let once = "read -r header; read -r x; echo \"$x\"; exec 1>&-";
    let x = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
    assert_eq!(answers(&model(&format!("{once}; exit 0")), &x), x);
    // This process does not end, and must be stopped.
    assert_eq!(answers(&model(&format!("{once}; cat > /dev/null")), &x[..3]), x[..3]);
}
