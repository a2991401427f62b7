//! Parts shared by sections of one output and of many, and warnings of several outputs, each kind once.

use std::mem::{Discriminant, discriminant};

use apportion::result::{OutputResult, StudyResult, Warning};
use apportion::uncertainty::{Estimate, Interval};

use crate::document::{Part, grouped_by_key};
use crate::leading::of_which;
use crate::study_sections::{failures, inputs};

/// Says why runs of an output failed.
pub(super) fn failed_runs(output: &OutputResult) -> Option<Part> {
    let failed = output.failures.iter();
    failures(failed.map(|f| (&*f.reason, format!("row {}: {}", f.first_row, inputs(&f.first_inputs)), f.runs)))
}

/// Defines the columns of the tables of indices, and the intervals.
pub(super) fn definitions(result: &StudyResult) -> [Part; 2] {
    let threshold = result.provenance.threshold;
    let indices = match result.study.dependences.is_empty() {
        true => format!(
            "S_1: share of the variance explained by the factor alone. S_T: share explained by the factor and all its \
             interactions. P(largest): probability that the total index of the factor is the largest. P(S_T > {threshold}): \
             probability that it exceeds {threshold}."
        ),
        false => {
            "Factors depend on each other. S_1: share of the variance explained by the factor, including what it shares with \
             others. S_T: share that remains if all other factors are known (Kucherenko, Tarantola and Annoni 2012). The other \
             two are S_1 of the part that is independent of the others, and S_T including what it shares with them (Mara, \
             Tarantola and Annoni 2015)."
                .to_owned()
        }
    };
    let intervals = match result.provenance.interval() {
        Some(words) => Part::Details {
            summary: "How the intervals are computed".to_owned(),
            parts: vec![Part::Text(format!("Intervals (±): {words}."))],
        },
        None => Part::Text("There are no intervals: one replicate gives no estimate of its error.".to_owned()),
    };
    [Part::OnPage(vec![Part::Text(indices)]), intervals]
}

/// Returns 1 minus a part, with the interval that follows from its own.
pub(super) fn complement(part: Estimate) -> Estimate {
    let interval = part.interval.map(|Interval { low, high }| Interval { low: 1.0 - high, high: 1.0 - low });
    Estimate { estimate: 1.0 - part.estimate, interval }
}

/// Returns the warnings, a sentence for each kind in the order of first occurrence: the first warning of a kind, its
/// outputs if there are several in all, and the number of further ones of the kind in the file.
pub(super) fn grouped_warnings(outputs: &[OutputResult]) -> Vec<String> {
    let places = outputs.iter().enumerate();
    let warnings = places.flat_map(|(place, output)| output.warnings.iter().map(move |warning| (place, warning)));
    let groups = grouped_by_key(warnings.map(|(place, warning)| (discriminant(warning), (place, warning))));
    let names: Vec<&str> = outputs.iter().map(|output| output.name.as_str()).collect();
    let sentence = |(_, all): &(Discriminant<Warning>, Vec<(usize, &Warning)>)| {
        let mut text = all[0].1.to_string();
        let mut places: Vec<usize> = all.iter().map(|(place, _)| *place).collect();
        places.dedup();
        if outputs.len() > 1 {
            text.push_str(&format!(" ({})", of_which(&names, &places)));
        }
        if all.len() > places.len() {
            text.push_str(&format!("; {} similar warnings in the JSON file", all.len() - places.len()));
        }
        text
    };
    groups.iter().map(sentence).collect()
}
