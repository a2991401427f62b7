//! Warnings of several outputs, each kind once.

use crate::report::leading::of_which;
use crate::report::result::OutputRecord;

/// What is warned of, a sentence for each kind in the order of the first time: the first warning of a kind, its outputs if
/// there are several in all, and how many more of the kind the file has.
pub(super) fn grouped_warnings(outputs: &[OutputRecord]) -> Vec<String> {
    type Group<'a> = (&'a str, Vec<(usize, &'a String)>);
    let mut groups: Vec<Group<'_>> = Vec::new();
    for (place, output) in outputs.iter().enumerate() {
        for (number, text) in output.warnings.iter().enumerate() {
            // Files of versions before have no codes.
            let code = output.warning_codes.get(number).unwrap_or(text);
            match groups.iter_mut().find(|(known, _)| known == code) {
                Some((_, all)) => all.push((place, text)),
                None => groups.push((code, vec![(place, text)])),
            }
        }
    }
    let names: Vec<&str> = outputs.iter().map(|output| output.name.as_str()).collect();
    let sentence = |(_, all): &Group<'_>| {
        let mut text = all[0].1.clone();
        let mut places: Vec<usize> = all.iter().map(|(place, _)| *place).collect();
        places.dedup();
        if outputs.len() > 1 {
            text.push_str(&format!(" ({})", of_which(&names, &places)));
        }
        if all.len() > places.len() {
            text.push_str(&format!("; {} more like it in the JSON file", all.len() - places.len()));
        }
        text
    };
    groups.iter().map(sentence).collect()
}
