//! What a study has behind it: the runs in its journal.

use std::path::Path;

use apportion::report::two_digits;
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
    Ok(text)
}
