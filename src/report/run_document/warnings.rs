//! Warnings of several outputs, each said once with the outputs that it is of.

use crate::report::format::name;
use crate::report::leading::of_which;
use crate::report::listed;
use crate::report::result::OutputRecord;

/// Most stretches of outputs in a sentence.
const NAMES: usize = 6;

/// The words of a warning, and its outputs with the numbers between the words.
type Group<'a> = (Vec<&'a str>, Vec<(usize, Vec<&'a str>)>);

/// What several warnings say of several factors of the same outputs.
struct Same<'a> {
    /// The words without the name of the factor.
    words: Vec<&'a str>,
    /// The factors; none of what is said of no factor.
    subjects: Vec<&'a str>,
    /// Outputs with the numbers.
    all: Vec<(usize, Vec<&'a str>)>,
}

/// What is warned of, in the order of the first time. Warnings that differ in their numbers alone are one, with the range
/// of these; one of several outputs says which. Those that differ in the factor that they begin with are one, with the first
/// of these. Without capitals and full stops, as they are in the file.
pub(super) fn folded(outputs: &[OutputRecord]) -> Vec<String> {
    let said = outputs.iter().enumerate();
    let said = said.flat_map(|(place, output)| output.warnings.iter().map(move |warning| (place, warning)));
    let mut groups: Vec<Group<'_>> = Vec::new();
    for (place, warning) in said {
        let (words, numbers) = taken_apart(warning);
        match groups.iter_mut().find(|(known, _)| *known == words) {
            Some((_, all)) => all.push((place, numbers)),
            None => groups.push((words, vec![(place, numbers)])),
        }
    }
    let mut same: Vec<Same<'_>> = Vec::new();
    for (mut words, all) in groups {
        let subject = subject(words[0]);
        if let Some(subject) = subject {
            words[0] = &words[0][subject.len()..];
        }
        let outputs = || all.iter().map(|(place, _)| place);
        let known = subject.and_then(|_| {
            same.iter_mut().find(|known| {
                !known.subjects.is_empty()
                    && known.words == words
                    && outputs().all(|place| known.all.iter().any(|(other, _)| other == place))
                    && known.all.iter().all(|(other, _)| outputs().any(|place| place == other))
            })
        });
        match known {
            Some(known) => {
                known.subjects.extend(subject);
                known.all.extend(all);
            }
            None => same.push(Same { words, subjects: subject.into_iter().collect(), all }),
        }
    }
    let names = output_names(outputs);
    let told = same.into_iter().map(|Same { words, subjects, all }| {
        let mut text = match &subjects[..] {
            [] => String::new(),
            [only] => name(only),
            several => {
                let mut names: Vec<String> = several.iter().take(NAMES).map(|own| name(own)).collect();
                names.extend((several.len() > NAMES).then(|| format!("{} more", several.len() - NAMES)));
                format!("in {} cases ({})", several.len(), listed(&names))
            }
        };
        for (number, word) in words.iter().enumerate() {
            text.push_str(word);
            let values: Vec<&str> = all.iter().filter_map(|(_, numbers)| numbers.get(number).copied()).collect();
            text.push_str(&range(&values));
        }
        let mut places: Vec<usize> = all.iter().map(|(place, _)| *place).collect();
        places.sort_unstable();
        places.dedup();
        if outputs.len() == 1 { text } else { format!("{text} ({})", of_which(&names, &places)) }
    });
    told.collect()
}

/// The names of `outputs`, in order.
pub(super) fn output_names(outputs: &[OutputRecord]) -> Vec<&str> {
    outputs.iter().map(|output| output.name.as_str()).collect()
}

/// The name that a warning begins with, if it is of a factor: `x1` of `x1: too few samples`.
fn subject(text: &str) -> Option<&str> {
    let (name, _) = text.split_once(": ")?;
    (!name.is_empty() && !name.contains(char::is_whitespace)).then_some(name)
}

/// A text as what stands before and between its numbers, and these; digits in names are none.
fn taken_apart(text: &str) -> (Vec<&str>, Vec<&str>) {
    let (mut words, mut numbers) = (Vec::new(), Vec::new());
    let mut from = 0;
    let mut before = ' ';
    let mut at = 0;
    while let Some(c) = text[at..].chars().next() {
        let length = match c.is_ascii_digit() && !(before.is_alphanumeric() || matches!(before, '_' | '.' | '[' | '-'))
        {
            true => number(&text[at..]),
            false => 0,
        };
        if length > 0 {
            words.push(&text[from..at]);
            numbers.push(&text[at..at + length]);
            at += length;
            from = at;
            before = '0';
        } else {
            before = c;
            at += c.len_utf8();
        }
    }
    words.push(&text[from..]);
    (words, numbers)
}

/// How long the number is that `text` begins with; 0 if it goes on as a name.
fn number(text: &str) -> usize {
    let body = text.len() - text.trim_start_matches(|c: char| c.is_ascii_digit() || c == '.').len();
    let body = text[..body].trim_end_matches('.').len();
    let rest = &text[body..];
    let power = rest.strip_prefix('e').map_or(0, |power| {
        let digits = power.strip_prefix('-').unwrap_or(power);
        let count = digits.len() - digits.trim_start_matches(|c: char| c.is_ascii_digit()).len();
        if count == 0 { 0 } else { 1 + power.len() - digits.len() + count }
    });
    let end = body + power;
    let goes_on = text[end..].starts_with(|c: char| c.is_alphanumeric() || c == '_');
    if goes_on { 0 } else { end }
}

/// `12`, or `12 to 34`.
fn range(values: &[&str]) -> String {
    let read = |text: &&&str| text.parse::<f64>().unwrap_or(f64::NAN);
    let least = values.iter().min_by(|a, b| read(a).total_cmp(&read(b)));
    let most = values.iter().max_by(|a, b| read(a).total_cmp(&read(b)));
    match (least, most) {
        (Some(least), Some(most)) if least != most => format!("{least} to {most}"),
        (Some(one), _) => (*one).to_owned(),
        _ => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::result::ResultFile;
    use std::path::Path;

    fn outputs(warnings: &[&[&str]]) -> Vec<OutputRecord> {
        let text = "model = \"ishigami\"\n[design]\nbase_samples = 16";
        let study = crate::Study::parse(text, Path::new("i.toml"), &[]).unwrap();
        let output = ResultFile::new(&study, &study.run().unwrap()).outputs.remove(0);
        let own = |(place, warnings): (usize, &&[&str])| OutputRecord {
            name: format!("y[{place}]"),
            warnings: warnings.iter().map(|&text| text.to_owned()).collect(),
            ..output.clone()
        };
        warnings.iter().enumerate().map(own).collect()
    }

    #[test]
    fn warnings_that_differ_in_numbers_alone_are_one() {
        let few = |rows: u32, kurtosis: &str| {
            format!("as if on {rows} of the 512 of A and B (excess kurtosis {kurtosis}): few")
        };
        let said = [few(37, "11"), few(9, "1.5e2"), few(14, "33")];
        let all = outputs(&[&[&said[0]], &[], &[&said[1], "x1: noise"], &[&said[2]], &["x2: noise"]]);
        assert_eq!(
            folded(&all),
            [
                "as if on 9 to 37 of the 512 of A and B (excess kurtosis 11 to 1.5e2): few (3 outputs: y[0], y[2] and y[3])",
                "x1: noise (y[2])",
                "x2: noise (y[4])",
            ]
        );
        assert_eq!(folded(&outputs(&[&["few rows"]])), ["few rows"]);
        let lay = |factor: usize| format!("f{factor}: the interval of {}.5 lay above", factor * 10);
        let many: Vec<String> = (1..=9).map(lay).chain(["f3: noise".to_owned()]).collect();
        let many: Vec<&str> = many.iter().map(String::as_str).collect();
        assert_eq!(
            folded(&outputs(&[&many])),
            ["in 9 cases (f1, f2, f3, f4, f5, f6 and 3 more): the interval of 10.5 to 90.5 lay above", "f3: noise"]
        );
        assert_eq!(folded(&outputs(&[&["static_friction: noise"]])), ["static friction: noise"]);
        assert_eq!(folded(&outputs(&[&["few"], &["few"], &["few"]])), ["few (all 3 outputs)"]);
        assert_eq!(folded(&outputs(&[&["few"], &["few"], &["few"], &[]])), ["few (3 outputs: y[0] to y[2])"]);
    }

    #[test]
    fn texts_are_whole_again() {
        for text in ["", "7", "x1 is 3.5e-7, 2.", "infected[6] of 12 (x_2) 3rd 4e", "± 5 ☃ 6"] {
            let (words, numbers) = taken_apart(text);
            let again: String =
                words.iter().enumerate().map(|(k, word)| format!("{word}{}", numbers.get(k).unwrap_or(&""))).collect();
            assert_eq!(again, text);
        }
        assert_eq!(taken_apart("infected[6] of 12 (x_2) 3rd 4e").1, ["12"]);
        assert_eq!(taken_apart("x1 is 3.5e-7, 2.").1, ["3.5e-7", "2"]);
    }
}
