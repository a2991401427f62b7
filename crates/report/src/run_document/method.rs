//! How a result was computed: the cost of the run, what it chose, and its provenance.

use apportion::result::{AccuracyRecord, StudyResult};
use apportion_base::text::capitalised;

use crate::document::{Mark, Part, Table};
use crate::format::{grouped, printed, significant};

/// Describes the cost of the run.
pub(super) fn cost(result: &StudyResult) -> Vec<Part> {
    let provenance = &result.provenance;
    let seconds = provenance.wall_seconds;
    let points = match provenance.plain {
        true => ("points", format!("one for each run, in {} replicates", provenance.replicates)),
        false => {
            ("base points", format!("{} in {} replicates", grouped(provenance.base_samples), provenance.replicates))
        }
    };
    let mut rows = vec![
        ("model runs", grouped(provenance.model_runs)),
        points,
        ("time", format!("{} s", printed(seconds))),
        ("threads", provenance.threads.to_string()),
    ];
    if seconds > 0.0 {
        let rate = (provenance.model_runs as f64 / seconds).round() as u64;
        rows.push(("runs per second", grouped(rate)));
    }
    let mut parts = vec![Part::OnPage(vec![Table::pairs("Cost of the run.", rows).into()])];
    if let Some(effort) = &result.effort {
        let rungs: Vec<String> = effort.rungs.iter().map(|r| format!("{} {}", r.rung, grouped(r.runs))).collect();
        let rows = [
            ("runs by fidelity", rungs.join(", ")),
            ("evaluations", grouped(effort.evaluations)),
            ("largest error estimate", format!("{:.1e} (relative)", effort.largest_error_estimate)),
        ];
        parts.push(Table::pairs("Fidelities used.", rows).into());
    }
    let low_fidelity: Vec<String> = result
        .low_fidelity
        .iter()
        .map(|low| {
            let (shared, additional) = (grouped(low.shared_runs), grouped(low.own_runs));
            format!("{} ({shared} at the rows of the model, {additional} at additional points)", low.name)
        })
        .collect();
    if !low_fidelity.is_empty() {
        parts.push(Part::Text(format!("Low-fidelity models: {}.", low_fidelity.join(", "))));
    }
    if let Some(spending) = &result.spending {
        parts.push(Part::Notice {
            mark: Mark::Plain,
            kind: "What the run chose".to_owned(),
            texts: chosen(result, spending),
        });
        parts.extend(lines_to_repeat(result).map(Part::Code));
    }
    if let Some(stopping) = &result.stopping {
        let (kind, mark) = match stopping.target_met {
            Some(true) => ("Target met", Mark::Good),
            Some(false) => ("Target not met", Mark::Mixed),
            None => ("Why the run ended", Mark::Plain),
        };
        parts.push(Part::Notice { mark, kind: kind.to_owned(), texts: vec![format!("{}.", stopping.reason)] });
    }
    parts
}

/// Describes what a run with a target accuracy chose, why, and what it saved.
fn chosen(result: &StudyResult, spending: &AccuracyRecord) -> Vec<String> {
    let mut texts: Vec<String> =
        spending.reasons.iter().map(|reason| format!("{}.", capitalised(&reason.to_string()))).collect();
    let (accuracy, runs) = (significant(spending.accuracy), grouped(spending.runs));
    texts.push(format!("An accuracy of {accuracy} took {runs} runs of the model, trials included."));
    texts.push(format!(
        "Not excluded: that the output behaves differently within less than {} % of the range of a factor, between all of its values \
         (95 %; `smallest_region`).",
        significant(100.0 * spending.excluded_region)
    ));
    if lines_to_repeat(result).is_some() {
        texts.push("These lines instead of `accuracy` repeat the same run exactly.".to_owned());
    }
    texts
}

pub(super) const CITATION: &str = "The same study file, seed and version give the same numbers, on any number of threads. Cite the result by these \
                        three, with the digest (SHA-256) for the study file; CITATION.cff in the sources of the program says how to \
                        cite the program.";

/// Describes how the result was computed, in addition to program and study.
pub(super) fn provenance(result: &StudyResult) -> Vec<(&'static str, String)> {
    let provenance = &result.provenance;
    let mut rows = vec![
        ("sampler", provenance.sampler.name().to_owned()),
        ("seed", provenance.seed.to_string()),
        ("base points", grouped(provenance.base_samples)),
        ("replicates", provenance.replicates.to_string()),
        ("first-order indices", provenance.first_order_estimator.clone()),
        ("total indices", provenance.total_estimator.clone()),
        ("intervals", provenance.interval().unwrap_or_else(|| "none: a single replicate".to_owned())),
    ];
    if !provenance.model_files.is_empty() {
        rows.push(("files of the model that a journal depends on", provenance.model_files.join(", ")));
    }
    rows
}

/// Returns the lines of a study that repeat a run with an accuracy, to the bit, in place of `accuracy`.
pub fn lines_to_repeat(result: &StudyResult) -> Option<String> {
    let (provenance, spending) = (&result.provenance, result.spending.as_ref()?);
    // Plain rows do not depend on times: the accuracy repeats them.
    if provenance.plain {
        return None;
    }
    let mut lines = format!("[design]\nbase_samples = {}\n", provenance.base_samples);
    lines.push_str(&format!("[analysis]\nsurrogate = \"{}\"\n", spending.surrogate.name()));
    if let [low] = &result.low_fidelity[..] {
        lines.push_str("[fidelity]\n");
        lines.push_str(&match spending.stated_low_fidelity {
            0 => format!("low = [\"{}\"]\n", low.name),
            1 => String::new(),
            _ => format!("# keep only `{}` in `low`\n", low.name),
        });
        lines.push_str(&format!("base_samples = {}\n", low.own_base_samples));
    }
    Some(lines)
}
