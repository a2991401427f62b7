//! What a study has behind it: its journal and its last result.

use std::path::Path;

use apportion::report::{ResultFile, indices_measured, read_result, two_digits, widest_interval};
use apportion::study::Study;

use super::Failure;
use super::run::journal_path;

/// The lines of `check` about the folder of the results.
pub fn past_runs(study: &Study, folder: &Path) -> Result<String, Failure> {
    let path = journal_path(folder, study.name(), None);
    let runner = study.runner().journal(&path);
    let megabytes = study.design().rows() as f64 * study.model().outputs().len() as f64 * 8e-6;
    let (size, path_text) = (two_digits(megabytes.max(0.01)), path.display());
    let when = if study.model().is_slow() { "" } else { ", if the run takes longer than 10 s" };
    let mut text = format!("disk: about {size} MB for the journal {path_text}{when}\n");
    if path.exists() {
        text.push_str(&match runner.recorded_runs() {
            Ok(rows) => {
                let total = study.design().rows();
                format!("on record: {} of {total} runs, which a run does not repeat\n", rows.min(total))
            }
            Err(error) => format!("on record: nothing of use: {error}\n"),
        });
    }
    if let Ok(result) = read_result(&folder.join(format!("{}.json", study.name()))) {
        text.push_str(&last_result(&result));
    }
    Ok(text)
}

fn last_result(result: &ResultFile) -> String {
    let base_samples = result.provenance.base_samples;
    let Some(width) = widest_interval(result) else {
        return format!("last result: {base_samples} base samples, without intervals\n");
    };
    let which = indices_measured(&result.outputs);
    format!("last result: {base_samples} base samples; {which} is known to \u{b1}{} or better\n", two_digits(width))
}
