//! What screenings and sweeps say of their study.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::chart::Chart;
use super::result::{ConstantRecord, ValidityRecord};
use crate::model::Model;
use crate::study::Study;

/// The study as it was asked.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AskedRecord {
    /// Name of the study.
    pub name: String,
    /// Title, if the study has one.
    pub title: Option<String>,
    /// Name of the model.
    pub model: String,
    /// The model's choices in force, such as `friction`.
    pub settings: Map<String, Value>,
    /// The model's inputs that are fixed in the study, with their units.
    pub constants: Vec<ConstantRecord>,
    /// The factors in the order of the study.
    pub factors: Vec<AskedFactor>,
    /// Changes made on the command line, as given.
    pub overrides: Vec<String>,
    /// The study file, word for word.
    pub source: String,
    /// SHA-256 of the study file as it lies on disk, in hexadecimal.
    pub sha256: String,
}

/// A factor of the study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AskedFactor {
    /// Its name.
    pub name: String,
    /// The unit of its values.
    pub unit: String,
    /// Its distribution by name, with the parameters in `unit`.
    pub distribution: Value,
    /// Its nominal value in `unit`.
    pub nominal: f64,
}

/// A chart that becomes files.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawing {
    /// What is added to the study's name for the names of its files.
    pub suffix: String,
    /// The chart.
    pub chart: Chart,
}

pub(super) fn asked(study: &Study) -> AskedRecord {
    let constants = study.constants().into_iter().map(|(name, value, unit)| ConstantRecord { name, value, unit });
    let factor = |factor: &crate::space::Factor| AskedFactor {
        name: factor.name.clone(),
        unit: factor.unit().to_string(),
        // Serialisation fails on maps without text keys only, of which there is none.
        distribution: serde_json::to_value(factor.distribution()).unwrap_or(Value::Null),
        nominal: factor.nominal,
    };
    AskedRecord {
        name: study.name.clone(),
        title: study.title.clone(),
        model: study.subject.name().to_owned(),
        settings: study.settings().into_iter().map(|(key, value)| (key.to_owned(), value)).collect(),
        constants: constants.collect(),
        factors: study.space.factors().iter().map(factor).collect(),
        overrides: study.overrides.clone(),
        source: study.source.clone(),
        sha256: study.sha256.clone(),
    }
}

impl AskedRecord {
    /// The headline of its charts.
    pub(super) fn headline(&self) -> &str {
        self.title.as_deref().unwrap_or(&self.name)
    }
}

/// The validity flags that `raised` runs of `runs` have raised.
pub(super) fn validity(model: &dyn Model, raised: &[u64], runs: u64) -> Vec<ValidityRecord> {
    let record = |(flag, runs_raised): (&crate::model::Flag, &u64)| ValidityRecord {
        flag: flag.name.to_string(),
        description: flag.description.to_string(),
        runs: *runs_raised,
        share: *runs_raised as f64 / runs.max(1) as f64,
    };
    let told = model.flags().iter().zip(raised).filter(|(flag, runs)| !flag.warns || **runs > 0);
    told.map(record).collect()
}

/// One line for each validity flag that was raised.
pub(super) fn validity_lines(validity: &[ValidityRecord]) -> String {
    let raised = validity.iter().filter(|flag| flag.runs > 0);
    raised
        .map(|flag| {
            let share = super::share_of_runs(flag.share);
            format!("validity: {} on {share} of the runs: {}\n", flag.flag, flag.description)
        })
        .collect()
}

/// A value of a factor, in its unit: a number, or the label of a category.
pub(super) fn input_value(factor: &crate::space::Factor, value: f64) -> Value {
    factor.distribution().label(value).map_or_else(|| Value::from(value), Value::from)
}

/// A name of the study as words.
pub(super) fn words(name: &str) -> String {
    name.replace('_', " ")
}

/// A name of the study as words after an article, which symbols go without.
pub(super) fn the(name: &str) -> String {
    if name.chars().count() <= 3 { name.to_owned() } else { format!("the {}", words(name)) }
}

/// With a capital at the beginning, but for symbols.
pub(super) fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    match letters.next() {
        Some(first) if text.chars().count() > 3 => first.to_uppercase().chain(letters).collect(),
        _ => text.to_owned(),
    }
}

/// A value with three significant digits and a true minus sign, for charts.
pub(super) fn printed(value: f64) -> String {
    short(format!("{value:.2e}").parse().unwrap_or(value)).replace('-', "\u{2212}")
}

/// A value with four significant digits.
pub(super) fn short(value: f64) -> String {
    let text = super::significant(format!("{value:.3e}").parse().unwrap_or(value));
    match text.split_once('e') {
        Some((digits, exponent)) if digits.contains('.') => {
            format!("{}e{exponent}", digits.trim_end_matches('0').trim_end_matches('.'))
        }
        _ => text,
    }
}

/// A value with four significant digits and its unit, if it has one.
pub(super) fn short_with_unit(value: f64, unit: &str) -> String {
    if matches!(unit, "" | "1") { short(value) } else { format!("{} {unit}", short(value)) }
}

/// A unit for an axis: none for pure numbers.
pub(super) fn axis_unit(unit: &str) -> String {
    if unit == "1" { String::new() } else { unit.to_owned() }
}

/// JSON text of plain data, ending in a newline; a number that is not finite is null.
pub(super) fn json(file: &impl Serialize) -> String {
    serde_json::to_string_pretty(file).expect("plain data") + "\n"
}

/// Lines of CSV.
pub(super) fn csv_text(rows: impl IntoIterator<Item = Vec<String>>) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.write_record(row.into_iter().map(super::tables::inert)).expect("rows of one length, into memory");
    }
    String::from_utf8(writer.into_inner().expect("into memory")).expect("text in, text out")
}

/// A number for CSV, with as many digits as it takes to read the same bits back; an empty cell for none.
pub(super) fn cell(value: Option<f64>) -> String {
    value.filter(|value| value.is_finite()).map_or_else(String::new, |value| value.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_well_and_cells_are_quoted() {
        assert_eq!(short(1234.567), "1235");
        assert_eq!(short_with_unit(-0.012_346, "nN"), "-0.01235 nN");
        assert_eq!(short(0.0), "0");
        assert_eq!((short(3.072e-5), short(-1e-12)), ("3.072e-5".to_owned(), "-1e-12".to_owned()));
        assert_eq!(short_with_unit(2.5, "1"), "2.5");
        assert_eq!(csv_text([vec!["a,b".to_owned(), cell(Some(0.1)), cell(None)]]), "\"a,b\",0.1,\n");
    }
}
