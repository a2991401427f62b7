//! What the records of several commands share: the study, values of factors, validity flags.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::result::{ConstantRecord, CorrelationRecord, FactorRecord, ResultFile, StudyRecord, ValidityRecord};
use crate::model::Model;
use crate::space::Dependence;
use crate::study::Study;

/// The study as it was run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StudySetup {
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
    pub factors: Vec<FactorSetup>,
    /// Factors that depend on each other, which the files of screenings and sweeps do not tell.
    #[serde(skip)]
    pub dependences: Vec<CorrelationRecord>,
    /// Changes made on the command line, as given.
    pub overrides: Vec<String>,
    /// The study file, word for word.
    pub source: String,
    /// SHA-256 of the study file as it lies on disk, in hexadecimal.
    pub sha256: String,
}

/// A factor of the study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FactorSetup {
    /// Its name.
    pub name: String,
    /// The unit of its values.
    pub unit: String,
    /// Its distribution by name, with the parameters in `unit`.
    pub distribution: Value,
    /// Its nominal value in `unit`.
    pub nominal: f64,
    /// Its group, which the files of screenings and sweeps do not tell.
    #[serde(skip)]
    pub group: Option<String>,
}

pub fn study_setup(study: &Study) -> StudySetup {
    let constants = study.constants().into_iter().map(|(name, value, unit)| ConstantRecord { name, value, unit });
    let factor = |factor: &crate::space::Factor| FactorSetup {
        name: factor.name.clone(),
        unit: factor.unit().to_string(),
        // Serialisation fails on maps without text keys only, of which there is none.
        distribution: serde_json::to_value(factor.distribution()).unwrap_or(Value::Null),
        nominal: factor.nominal,
        group: factor.group.clone(),
    };
    StudySetup {
        name: study.name.clone(),
        title: study.title.clone(),
        model: study.subject.name().to_owned(),
        settings: study.settings().into_iter().map(|(key, value)| (key.to_owned(), value)).collect(),
        constants: constants.collect(),
        factors: study.space.factors().iter().map(factor).collect(),
        dependences: study.space.dependences().iter().map(dependence_record).collect(),
        overrides: study.overrides.clone(),
        source: study.source.clone(),
        sha256: study.sha256.clone(),
    }
}

/// A dependence as it was stated.
pub(super) fn dependence_record(dependence: &Dependence) -> CorrelationRecord {
    CorrelationRecord {
        factors: dependence.factors().to_vec(),
        correlation: dependence.correlation().to_vec(),
        measure: dependence.measure_in_force().name().to_owned(),
    }
}

impl StudySetup {
    /// The study of a result.
    pub(super) fn from_result(result: &ResultFile) -> Self {
        let factor = |factor: &FactorRecord| FactorSetup {
            name: factor.name.clone(),
            unit: factor.unit.clone(),
            distribution: factor.distribution.clone(),
            nominal: factor.nominal,
            group: factor.group.clone(),
        };
        let StudyRecord { name, title, model, settings, constants, dependences, overrides, source } =
            result.study.clone();
        let sha256 = result.provenance.study_sha256.clone();
        let factors = result.factors.iter().map(factor).collect();
        Self { name, title, model, settings, constants, factors, dependences, overrides, source, sha256 }
    }

    /// The headline of its charts.
    pub(crate) fn headline(&self) -> &str {
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

/// A value of a factor, in its unit: a number, or the label of a category.
pub(super) fn input_value(factor: &crate::space::Factor, value: f64) -> Value {
    factor.distribution().label(value).map_or_else(|| Value::from(value), Value::from)
}

/// JSON text of plain data, ending in a newline; a number that is not finite is null.
pub(crate) fn json(file: &impl Serialize) -> String {
    serde_json::to_string_pretty(file).expect("plain data") + "\n"
}
