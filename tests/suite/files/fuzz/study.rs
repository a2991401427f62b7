//! Study files, with changes from the command line.

use std::path::Path;

use apportion::model::{Batch, RunContext};
use apportion::result::parse_result;
use apportion::study::Study;
use apportion_afm::AfmSubject;
use apportion_files::{StudyError, TemplateRequest, template};

/// The separator of the file and the changes, which have one line each.
const CHANGES: &str = "\n--set\n";

/// Runs up to which a study is run as a whole.
const RUNS: u64 = 128;

/// Drawing takes ten times as long as all the rest: only one text in this number, by its length, is drawn.
const DRAWN: usize = 16;

/// Steps of one run of the nanoparticle model: more would be too slow for a fuzzer.
const STEPS: u64 = 2000;

/// A study is refused with a place and a reason, or is valid: its model runs, a new study of the same
/// model can be written and read, and the result of a small one can be read back.
pub fn run(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    // A study can name a file of measured values; endless devices are not the subject of this test.
    if text.contains("/dev") || text.contains("/proc") || text.contains("\\u") || text.contains("\\U") {
        return;
    }
    let (text, changes) = text.split_once(CHANGES).unwrap_or((text, ""));
    let changes: Vec<String> = changes.lines().map(str::to_owned).collect();
    let mut study = match apportion_files::parse_study(text, Path::new("fuzz/study.toml"), &changes) {
        Ok(study) => study,
        Err(error) => return refused(&error),
    };
    if let Some(afm) = study.subject().downcast_ref::<AfmSubject>() {
        let budget = format!("afm.step_budget={}", afm.options.step_budget.min(STEPS));
        let changes = [changes, vec![budget]].concat();
        let Ok(patient) = apportion_files::parse_study(text, Path::new("fuzz/study.toml"), &changes) else { return };
        study = patient;
    }
    begun(&study);
    // A fuzzer must never start a program.
    if matches!(study.subject().name(), "command" | "external") {
        return;
    }
    answered(&study);
    if study.design().rows() <= RUNS && !study.target().grows() && study.analysis().resamples <= 1000 {
        ran(&study, text.len().is_multiple_of(DRAWN));
    }
}

fn refused(error: &StudyError) {
    let message = error.to_string();
    assert!(!message.is_empty());
    if let StudyError::Invalid(diagnostic) = error {
        let message = diagnostic.to_string();
        assert!(message.starts_with("fuzz/study.toml:"), "{message}");
    }
}

/// The first and the last rows of the design through the model.
fn answered(study: &Study) {
    let model = study.model();
    let factors = study.space().factors();
    let rows = [0, 1, study.design().rows() / 2, study.design().rows() - 1];
    let mut columns = vec![vec![0.0; rows.len()]; factors.len()];
    let mut u = vec![0.0; factors.len()];
    for (place, row) in rows.into_iter().enumerate() {
        study.design().point(row, &mut u);
        for ((column, factor), u) in columns.iter_mut().zip(factors).zip(&u) {
            assert!(*u > 0.0 && *u < 1.0, "{u}");
            factor.fill_si(&[*u], &mut column[place..=place]);
            assert!(column[place].is_finite(), "{}: {}", factor.name, column[place]);
        }
    }
    let mut batch = Batch::new(model.as_ref());
    batch.reset(rows.len());
    let inputs: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
    model.worker(&RunContext::default()).run(&inputs, &mut batch);
    batch.settle();
    for output in 0..model.outputs().len() {
        for (row, value) in batch.column(output).iter().enumerate() {
            let failed = || batch.failures().iter().any(|(o, r, _)| (*o, *r) == (output, row));
            assert!(value.is_finite() || failed(), "row {row} has neither value nor failure");
        }
    }
}

/// A study to begin with, of the same model, factors and outputs.
fn begun(study: &Study) {
    let Some(model) = apportion_files::ModelKind::from_name(study.subject().name()) else { return };
    let names = study.space().factors().iter().map(|factor| factor.name.clone());
    let outputs = study.model().outputs().iter().map(|output| output.name.to_string()).collect();
    let (title, factors) = (study.title().map(str::to_owned), names.take(8).collect());
    let request = TemplateRequest { model, title, factors, tables: Vec::new(), outputs };
    // Inputs that depend on the parameters of a function are not inputs of the default function.
    let Ok(text) = template(&request) else { return };
    let begun = apportion_files::parse_study(&text, Path::new("new.toml"), &[])
        .unwrap_or_else(|error| panic!("{error}\n{text}"));
    let names = |study: &Study| study.model().outputs().iter().map(|output| output.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&begun), names(study));
}

/// Runs, writes and reads back.
fn ran(study: &Study, draw: bool) {
    let Ok(analysis) = study.runner().threads(1).run() else { return };
    let result = analysis;
    let json = result.json();
    let read = parse_result(json.as_bytes()).unwrap_or_else(|error| panic!("the result is refused: {error}"));
    assert_eq!(read.json(), json);
    if draw {
        super::result::drawn(&result);
    }
}
