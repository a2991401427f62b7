//! What a study has behind it and before it: its journal, its last result, and what twice the runs would bring.

use std::path::Path;

use apportion::report::{ResultFile, read_result, two_digits, widest_interval, width_after_doubling};
use apportion::study::Study;

use super::Failure;
use super::record::{filled, journal_path, keeps_journal, read, rows_on_record};

/// The lines of `check` about the folder of the results.
pub fn outlook(study: &Study, folder: &Path) -> Result<String, Failure> {
    let mut text = disk(study, folder)?;
    let path = journal_path(folder, &study.name, None);
    if path.exists() {
        text.push_str(&match read(study, &path) {
            Ok(contents) => {
                let rows = rows_on_record(study, &filled(study, &contents));
                format!("on record: {rows} of {} runs, which a run does not repeat\n", study.design.rows())
            }
            Err(Failure::Input(error) | Failure::Run(error)) => format!("on record: nothing of use: {error}\n"),
        });
    }
    if let Ok(result) = read_result(&folder.join(format!("{}.json", study.name))) {
        text.push_str(&last_result(&result));
    }
    Ok(text)
}

fn disk(study: &Study, folder: &Path) -> Result<String, Failure> {
    let megabytes = study.design.rows() as f64 * study.model().outputs().len() as f64 * 8e-6;
    let path = journal_path(folder, &study.name, None);
    Ok(if keeps_journal(study)? {
        format!(
            "disk: about {} MB for the journal {}, and as much memory for its outputs\n",
            two_digits(megabytes.max(0.01)),
            path.display()
        )
    } else {
        format!(
            "disk: no journal: it would take {} MB, and the runs are quick enough to be evaluated again\n",
            two_digits(megabytes)
        )
    })
}

fn last_result(result: &ResultFile) -> String {
    let base_samples = result.provenance.base_samples;
    let Some(width) = widest_interval(result) else {
        return format!("last result: {base_samples} base samples, without intervals\n");
    };
    let known =
        format!("last result: {base_samples} base samples; every index is known to {} or better", figure(width));
    let doubled = result.outputs.iter().filter_map(|output| width_after_doubling(&output.convergence));
    match doubled.reduce(f64::max) {
        Some(expected) => format!(
            "{known}\n  twice as many (run --double: {} more runs) can be expected to bring {}\n",
            result.provenance.model_runs,
            figure(expected)
        ),
        None => format!("{known}\n  too few stages to say what twice as many would bring\n"),
    }
}

fn figure(half_width: f64) -> String {
    format!("\u{b1}{}", two_digits(half_width))
}
