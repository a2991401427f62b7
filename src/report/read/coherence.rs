//! Whether the parts of a result fit together: what draws a result relies on it.

use serde_json::Value;

use crate::names::{LONGEST_NAME, LONGEST_STUDY_NAME, LONGEST_TITLE};
use crate::report::distribution::OutputDistribution;
use crate::report::result::{AggregateIndexRecord, OutputRecord, ResultFile, ScatterRecord, SeriesRecord};

/// A key, and what is wrong there.
type Fault = (String, String);

/// What the types of the keys do not say.
pub(super) fn check(result: &ResultFile) -> Result<(), Fault> {
    file_name("study.name", &result.study.name, LONGEST_STUDY_NAME)?;
    let title = result.study.title.as_deref().unwrap_or_default();
    short_enough("study.title", title, LONGEST_TITLE)?;
    for (place, factor) in result.factors.iter().enumerate() {
        short_enough(&format!("factors[{place}].name"), &factor.name, LONGEST_NAME)?;
        short_enough(&format!("factors[{place}].group"), factor.group.as_deref().unwrap_or_default(), LONGEST_NAME)?;
    }
    for (place, output) in result.outputs.iter().enumerate() {
        let key = format!("outputs[{place}]");
        file_name(&format!("{key}.name"), &output.name, LONGEST_NAME)?;
        if result.outputs[..place].iter().any(|other| other.name == output.name) {
            return Err((format!("{key}.name"), format!("the output {:?} is there twice", output.name)));
        }
        indices(&key, result, output)?;
        if let Some(distribution) = &output.distribution {
            of_distribution(&format!("{key}.distribution"), &distribution.sample)?;
        }
        if let Some(scatter) = &output.scatter {
            of_scatter(&format!("{key}.scatter"), scatter)?;
        }
    }
    result.series.iter().enumerate().try_for_each(|(place, of)| series(&format!("series[{place}]"), result, of))
}

/// A series has values that are outputs, and a loading for each.
fn series(key: &str, result: &ResultFile, series: &SeriesRecord) -> Result<(), Fault> {
    file_name(&format!("{key}.name"), &series.name, LONGEST_NAME)?;
    short_enough(&format!("{key}.axis"), &series.axis, LONGEST_NAME)?;
    short_enough(&format!("{key}.axis_unit"), &series.axis_unit, LONGEST_NAME)?;
    let end = series.first_output.checked_add(series.positions.len()).filter(|end| *end <= result.outputs.len());
    let rise = series.positions.windows(2).all(|pair| pair[0] < pair[1]);
    if end.is_none() || series.positions.is_empty() || !rise {
        let problem = "expected rising numbers, one for each output from number `first_output` on";
        return Err((format!("{key}.positions"), problem.to_owned()));
    }
    let factors = |of: &[AggregateIndexRecord]| {
        of.iter().map(|index| &index.factor).eq(result.factors.iter().map(|factor| &factor.name))
    };
    if !series.indices.as_ref().is_none_or(|indices| factors(indices)) {
        let problem = "expected one entry for each of the factors, in their order, or null";
        return Err((format!("{key}.indices"), problem.to_owned()));
    }
    Ok(())
}

/// Files are named after the study and its outputs: a name must not lead to another folder.
fn file_name(key: &str, name: &str, most: usize) -> Result<(), Fault> {
    short_enough(key, name, most)?;
    let leads_away = |c: char| matches!(c, '/' | '\\' | ':') || c.is_control();
    if name.is_empty() || name.contains(leads_away) {
        let problem = format!("files are named after it, so it cannot be {name:?}: expected a name without / \\ :");
        return Err((key.to_owned(), problem));
    }
    Ok(())
}

/// What is drawn has an end.
fn short_enough(key: &str, text: &str, most: usize) -> Result<(), Fault> {
    let length = text.chars().count();
    if length <= most {
        Ok(())
    } else {
        Err((key.to_owned(), format!("expected at most {most} characters, found {length}")))
    }
}

/// Largest count: up to here sums of a few counts, and the counts as numbers, are exact.
const MOST: u64 = 1 << 53;

/// Numbers that are no counts.
const NO_COUNTS: [&str; 2] = ["seed", "first_row"];

/// Every whole number is a count that can be reckoned with, but for seeds and row numbers.
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
            Some(count) if count > MOST => Err((key.to_owned(), format!("expected a count up to 2^53, found {count}"))),
            _ => Ok(()),
        },
        _ => Ok(()),
    }
}

fn joined(key: &str, name: &str) -> String {
    if key.is_empty() { name.to_owned() } else { format!("{key}.{name}") }
}

/// There is an index for each factor, or none at all.
fn indices(key: &str, result: &ResultFile, output: &OutputRecord) -> Result<(), Fault> {
    let Some(indices) = &output.indices else { return Ok(()) };
    let names = || indices.iter().map(|index| &index.factor);
    if indices.is_empty() || !names().eq(result.factors.iter().map(|factor| &factor.name)) {
        let problem = "expected one entry for each of the factors, in their order, or null";
        return Err((format!("{key}.indices"), problem.to_owned()));
    }
    Ok(())
}

fn of_distribution(key: &str, sample: &OutputDistribution) -> Result<(), Fault> {
    if let Some(histogram) = &sample.histogram {
        let problem = || (format!("{key}.histogram"), "expected rising edges, one more than counts".to_owned());
        let rising = histogram.edges.windows(2).all(|ends| ends[0] < ends[1]);
        if histogram.counts.is_empty() || histogram.edges.len() != histogram.counts.len() + 1 || !rising {
            return Err(problem());
        }
    }
    match &sample.density {
        Some(density) => same(&format!("{key}.density"), &[density.x.len(), density.density.len()]),
        None => Ok(()),
    }
}

fn of_scatter(key: &str, scatter: &ScatterRecord) -> Result<(), Fault> {
    if scatter.points.iter().any(|point| point.len() != scatter.factors.len() + 1) {
        let problem = "expected the values of `factors`, then the output, in each point";
        return Err((format!("{key}.points"), problem.to_owned()));
    }
    for (place, means) in scatter.conditional_means.iter().enumerate() {
        let lengths = [means.x.len(), means.mean.len(), means.low.len(), means.high.len()];
        same(&format!("{key}.conditional_means[{place}]"), &lengths)?;
    }
    Ok(())
}

fn same(key: &str, lengths: &[usize]) -> Result<(), Fault> {
    if lengths.windows(2).all(|pair| pair[0] == pair[1]) {
        return Ok(());
    }
    let lengths: Vec<String> = lengths.iter().map(usize::to_string).collect();
    Err((key.to_owned(), format!("expected lists of one length, found {}", lengths.join(", "))))
}
