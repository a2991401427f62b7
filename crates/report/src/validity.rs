//! Sentences on whether the model is valid where it was run.

use apportion::result::{StudyResult, ValidityRecord};
use apportion::text::listed;

use super::document::{Mark, Part};
use super::format::{count, grouped, share_of_runs};

/// Says on how many runs which validity flags are raised; `None` if none is.
pub(super) fn sentence(validity: &[ValidityRecord]) -> Option<String> {
    let mut raised: Vec<&ValidityRecord> = validity.iter().filter(|flag| flag.runs > 0).collect();
    raised.sort_by(|a, b| b.share.total_cmp(&a.share));
    let flags = raised.iter().map(|flag| format!("{} on {}", flag.flag.replace('-', " "), share_of_runs(flag.share)));
    let flags: Vec<String> = flags.collect();
    (!flags.is_empty()).then(|| format!("The model leaves its range of validity: {} of the runs.", listed(&flags)))
}

/// Sets off what is said of a run: flags with the meaning of the most frequent one, and failures.
pub(super) fn callout(result: &StudyResult) -> Option<Part> {
    let failed = result.outputs.iter().map(|output| output.runs_failed).max().unwrap_or(0);
    let of_failures = of_failures(failed, result.provenance.model_runs);
    let flags = sentence(&result.validity).map(|sentence| {
        let most = result.validity.iter().max_by(|a, b| a.share.total_cmp(&b.share));
        format!("{sentence} {}", most.map_or("", |flag| &flag.description))
    });
    let texts: Vec<String> = flags.into_iter().chain(of_failures).collect();
    (!texts.is_empty()).then(|| Part::Notice { mark: Mark::Mixed, kind: "Model validity".to_owned(), texts })
}

/// Says how many runs failed and what that means; `None` if none or all failed.
pub(super) fn of_failures(failed: u64, all: u64) -> Option<String> {
    (failed > 0 && failed < all).then(|| {
        let (failed, share) = (grouped(failed), share_of_runs(failed as f64 / all as f64));
        let all = count(all, "run", "runs");
        format!(
            "{failed} of {all} ({share}) failed: the numbers describe the part of the factor space where runs succeed."
        )
    })
}
