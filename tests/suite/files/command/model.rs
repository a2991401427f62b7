//! Programs as models by themselves, without a study: the rows that they read, and cases that are rare in a run.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Duration;

use apportion::model::{Batch, GiveUp, Model, RowFailure, RunContext};
use apportion::space::{Distribution, Factor};
use apportion_base::quantity::Unit;
use apportion_files::{
    CommandModel, CommandOutput, CommandSettings, Form, InputTemplate, PerRun, Pick, PickMethod, Program, Protocol,
    Source,
};
use proptest::prelude::*;

use crate::common::{Folder, files};

/// A script for `sh` in `folder` as a model.
fn model_of(
    script: &str,
    folder: &Path,
    form: Form,
    outputs: Vec<CommandOutput>,
    factors: Vec<Factor>,
) -> CommandModel {
    let program = Program {
        arguments: ["sh", "-c", script].map(str::to_owned).to_vec(),
        directory: folder.to_owned(),
        environment: Vec::new(),
    };
    let requested = (0..outputs.len()).collect();
    let (series, workers, timeout, retries) = (Vec::new(), Some(1), None, 1);
    CommandModel::new(CommandSettings { program, form, outputs, series, requested, workers, timeout, retries }, factors)
}

fn output(name: &str, pick: Option<Pick>) -> CommandOutput {
    CommandOutput { name: name.to_owned(), unit: Unit::dimensionless(), pick }
}

/// One that is kept alive, of the factor `x`.
fn kept_alive(script: &str, protocol: Protocol, outputs: &[&str]) -> CommandModel {
    let law = Distribution::uniform(0.0, 9.0).unwrap();
    let factors = vec![Factor::new("x", Unit::dimensionless(), law).unwrap()];
    let outputs = outputs.iter().map(|name| output(name, None)).collect();
    model_of(script, &std::env::temp_dir(), Form::KeptAlive(protocol), outputs, factors)
}

fn model(script: &str) -> CommandModel {
    kept_alive(script, Protocol::Csv, &["y"])
}

/// The first output of the model for these inputs; no row may fail.
#[track_caller]
fn outputs(model: &CommandModel, inputs: &[&[f64]]) -> Vec<f64> {
    let mut batch = Batch::new(model);
    batch.reset(inputs[0].len());
    model.worker(&RunContext::default()).run(inputs, &mut batch);
    batch.settle();
    assert_eq!((batch.given_up(), batch.failures()), (None, &[][..]));
    batch.column(0).to_vec()
}

#[track_caller]
fn answers(model: &CommandModel, x: &[f64]) -> Vec<f64> {
    outputs(model, &[x])
}

/// A factor of every kind of text.
fn factors() -> Vec<Factor> {
    let labels = ["steel", "glass, thin"];
    let factor = |name: &str, unit: &str, law: Result<Distribution, _>| {
        Factor::new(name, Unit::parse(unit).unwrap(), law.unwrap()).unwrap()
    };
    vec![
        factor("length", "um", Distribution::uniform(1.0, 300.0)),
        factor("n", "", Distribution::integer(1.0, 5.0)),
        factor("made of", "", Distribution::categorical(&labels, None, None)),
        factor("wet", "", Distribution::boolean(0.5)),
    ]
}

const INPUTS: [&[f64]; 4] = [&[225e-6, 1e-13], &[3.0, 4.0], &[0.0, 1.0], &[1.0, 0.0]];

#[test]
fn rows_are_in_the_units_of_the_study_with_labels() {
    for (protocol, answer, expected) in [
        (
            Protocol::Csv,
            "read -r x; echo \"$x\" >> seen; while read -r x; do echo \"$x\" >> seen; echo \"${x%%,*},1\"; done",
            "id,length,n,made of,wet\n100000,225.0,3,steel,true\n100001,1e-7,4,\"glass, thin\",false\n",
        ),
        (
            Protocol::JsonLines,
            "while read -r x; do echo \"$x\" >> seen; echo \"${x%%,*},\\\"y\\\":1}\"; done",
            "{\"id\":100000,\"length\":225.0,\"n\":3,\"made of\":\"steel\",\"wet\":true}\n\
             {\"id\":100001,\"length\":1e-7,\"n\":4,\"made of\":\"glass, thin\",\"wet\":false}\n",
        ),
    ] {
        let folder = Folder::new();
        let form = Form::KeptAlive(protocol);
        let model = model_of(answer, &folder.path(""), form, vec![output("y", None)], factors());
        assert_eq!(outputs(&model, &INPUTS), [1.0, 1.0]);
        assert_eq!(std::fs::read_to_string(folder.path("seen")).unwrap(), expected);
    }
}

#[test]
fn a_template_has_texts_as_they_are_and_the_table_of_factors_has_quotes() {
    let folder = Folder::new();
    let number = |name: &str| factors().iter().position(|factor| factor.name == name);
    let form = PerRun {
        template_file: PathBuf::new(),
        template: InputTemplate::parse("{{length}} {{made of}} {{wet}} {{n}}", &number).unwrap(),
        input: "model.in".to_owned(),
        files: Vec::new(),
        keep: Some(folder.path("runs")),
    };
    let pick = Pick { source: Source::Stdout, method: PickMethod::Pointer(String::new()) };
    let model = model_of("echo 1", &folder.path(""), Form::PerRun(form), vec![output("y", Some(pick))], factors());
    assert_eq!(outputs(&model, &INPUTS.map(|values| &values[1..])), [1.0]);
    let run = folder.path("runs").join(files(&folder.path("runs")).first().unwrap());
    let read = |name: &str| std::fs::read_to_string(run.join(name)).unwrap();
    assert_eq!(read("model.in"), "1e-7 glass, thin false 4");
    assert_eq!(read("factors.csv"), "length,n,made of,wet\n1e-7,4,\"glass, thin\",false\n");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    /// A row is its own answer here.
    #[test]
    fn numbers_are_read_as_the_same(
        values in prop::collection::vec(prop::num::f64::NORMAL | prop::num::f64::SUBNORMAL, 1..200),
    ) {
        let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
        for (protocol, script) in [(Protocol::Csv, "read -r header; exec cat"), (Protocol::JsonLines, "exec cat")] {
            let model = kept_alive(script, protocol, &["x"]);
            prop_assert_eq!(bits(&answers(&model, &values)), bits(&values));
        }
    }
}

#[test]
fn answers_without_a_number_are_seen() {
    for (protocol, line, is_one) in [
        (Protocol::Csv, "1.5,2", true),
        (Protocol::Csv, "error: no root", true),
        (Protocol::Csv, "1.5", false),
        (Protocol::Csv, "Loading ...", false),
        (Protocol::Csv, "", false),
        (Protocol::JsonLines, r#"{"y1": 1, "y2": 2}"#, true),
        (Protocol::JsonLines, r#"{"step": 1}"#, false),
    ] {
        let (header, answer) = match protocol {
            Protocol::Csv => ("read -r header; ", "echo \"${x%%,*},1,2\""),
            Protocol::JsonLines => ("", "echo \"${x%%,*},\\\"y1\\\":1,\\\"y2\\\":2}\""),
        };
        let script = format!("{header}read -r x; {answer}; echo '{line}'; while read -r x; do {answer}; done");
        let model = kept_alive(&script, protocol, &["y1", "y2"]);
        let mut batch = Batch::new(&model);
        batch.reset(2);
        model.worker(&RunContext::default()).run(&[&[1.0, 2.0]], &mut batch);
        let is_refused = batch.given_up().is_some_and(|give_up| give_up.is_bad_input);
        assert_eq!((is_refused, batch.given_up().is_some()), (is_one, is_one), "{line}");
    }
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
