//! Consistency checks of a result, on which charts rely.

use serde_json::Value;

use crate::result::{SeriesRecord, StudyResult};
use apportion_base::names::{LONGEST_NAME, LONGEST_STUDY_NAME};

/// A key, and the error there.
type Fault = (String, String);

fn require(holds: bool, key: String, problem: &str) -> Result<(), Fault> {
    if holds { Ok(()) } else { Err((key, problem.to_owned())) }
}

/// Checks conditions that the types of the keys do not express.
pub(super) fn check(result: &StudyResult) -> Result<(), Fault> {
    file_name("study", &result.study.name, LONGEST_STUDY_NAME)?;
    for (place, output) in result.outputs.iter().enumerate() {
        let (key, name) = (format!("outputs[{place}]"), &output.name);
        file_name(&key, name, LONGEST_NAME)?;
        let is_first = result.outputs[..place].iter().all(|other| other.name != *name);
        require(is_first, format!("{key}.name"), &format!("the output {name:?} is listed twice"))?;
        if let Some(indices) = &output.indices {
            of_factors(&key, result, indices.iter().map(|index| &index.name))?;
        }
    }
    result.series.iter().enumerate().try_for_each(|(place, of)| series(&format!("series[{place}]"), result, of))
}

/// Checks that the values of a series are outputs, and that each has a position.
fn series(key: &str, result: &StudyResult, series: &SeriesRecord) -> Result<(), Fault> {
    file_name(key, &series.name, LONGEST_NAME)?;
    let (first, positions) = (series.first_output, &series.positions);
    let are_outputs = first.checked_add(positions.len()).is_some_and(|end| end <= result.outputs.len());
    let rise = !positions.is_empty() && positions.windows(2).all(|pair| pair[0] < pair[1]);
    let problem = "expected rising numbers, one for each output from number `first_output` on";
    require(are_outputs && rise, format!("{key}.positions"), problem)?;
    series.indices.iter().try_for_each(|all| of_factors(key, result, all.iter().map(|index| &index.name)))
}

/// Checks that there is an index for each factor.
fn of_factors<'a>(key: &str, result: &StudyResult, names: impl Iterator<Item = &'a String>) -> Result<(), Fault> {
    let is_each = !result.factors.is_empty() && names.map(String::as_str).eq(result.indexed_names());
    let problem = "expected one entry for each of the factors, in their order, or null";
    require(is_each, format!("{key}.indices"), problem)
}

/// Checks a name used in file names (those of the study and its outputs): it must not lead to another folder.
fn file_name(key: &str, name: &str, max_length: usize) -> Result<(), Fault> {
    let leads_away = name.contains(|c: char| matches!(c, '/' | '\\' | ':') || c.is_control());
    let problem = format!("files are named after it, so it cannot be {name:?}: expected a short name without / \\ :");
    let names_file = !leads_away && !name.is_empty() && name.chars().count() <= max_length;
    require(names_file, format!("{key}.name"), &problem)
}

/// Largest count: up to this, sums of a few counts, and the counts as numbers, are exact.
const MAX_COUNT: u64 = 1 << 53;

/// Numbers that are not counts.
const NO_COUNTS: [&str; 2] = ["seed", "first_row"];

/// Checks that every whole number except seeds and row numbers is a valid count.
pub(super) fn counts(value: &Value, key: &str) -> Result<(), Fault> {
    match value {
        Value::Object(map) => map
            .iter()
            .filter(|(name, _)| !NO_COUNTS.contains(&name.as_str()))
            .try_for_each(|(name, value)| counts(value, &joined(key, name))),
        Value::Array(list) => {
            list.iter().enumerate().try_for_each(|(place, value)| counts(value, &format!("{key}[{place}]")))
        }
        Value::Number(number) => match number.as_u64() {
            Some(count) if count > MAX_COUNT => {
                Err((key.to_owned(), format!("expected a count up to 2^53, found {count}")))
            }
            _ => Ok(()),
        },
        _ => Ok(()),
    }
}

fn joined(key: &str, name: &str) -> String {
    if key.is_empty() { name.to_owned() } else { format!("{key}.{name}") }
}
