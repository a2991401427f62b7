//! Warnings of several outputs, each kind once.

use apportion::result::{OutputResult, Warning};

use crate::document::grouped_by_key;
use crate::leading::of_which;

/// Returns the warnings, a sentence for each kind in the order of first occurrence: the first warning of a kind, its
/// outputs if there are several in all, and the number of further ones of the kind in the file.
pub(super) fn grouped_warnings(outputs: &[OutputResult]) -> Vec<String> {
    let places = outputs.iter().enumerate();
    let warnings = places.flat_map(|(place, output)| output.warnings.iter().map(move |warning| (place, warning)));
    let groups = grouped_by_key(warnings.map(|(place, warning)| (warning.code(), (place, warning))));
    let names: Vec<&str> = outputs.iter().map(|output| output.name.as_str()).collect();
    let sentence = |(_, all): &(&str, Vec<(usize, &Warning)>)| {
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
