//! The question as recorded in results: the study, its factors, validity flags.

use crate::model::Flag;
use crate::result::{
    ConstantRecord, CorrelationRecord, FactorDistribution, FactorRecord, StudyRecord, StudySetup, ValidityRecord,
};
use crate::space::{Dependence, Distribution, Factor};
use crate::study::Study;

impl Study {
    /// Returns the study as it is recorded in results.
    pub fn setup(&self) -> StudySetup {
        StudySetup {
            study: study_record(self),
            factors: self.space.factors().iter().map(|factor| factor_record(self, factor)).collect(),
            sha256: self.source.sha256.clone(),
        }
    }
}

pub(super) fn study_record(study: &Study) -> StudyRecord {
    let constants = study.constants().into_iter().map(|(name, value, unit)| ConstantRecord { name, value, unit });
    StudyRecord {
        name: study.name.clone(),
        title: study.title.clone(),
        model: study.subject.name().to_owned(),
        settings: study.settings().into_iter().map(|(key, value)| (key.to_owned(), value)).collect(),
        constants: constants.collect(),
        dependences: study.space.dependences().iter().map(dependence_record).collect(),
        overrides: study.source.overrides.clone(),
        source: study.source.text.clone(),
    }
}

pub(super) fn factor_record(study: &Study, factor: &Factor) -> FactorRecord {
    FactorRecord {
        name: factor.name.clone(),
        description: study.subject.meaning(&factor.name),
        unit: factor.unit().to_string(),
        group: factor.group.clone(),
        distribution: factor_distribution(factor.distribution()),
        nominal: factor.nominal,
    }
}

fn factor_distribution(distribution: &Distribution) -> FactorDistribution {
    let parameters = distribution.parameters().into_iter();
    let json = parameters.map(|(name, value)| (name.to_owned(), serde_json::to_value(value).unwrap_or_default()));
    FactorDistribution { name: distribution.name().to_owned(), parameters: json.collect() }
}

/// Returns the record of a dependence.
fn dependence_record(dependence: &Dependence) -> CorrelationRecord {
    CorrelationRecord {
        factors: dependence.factors().to_vec(),
        correlation: dependence.correlation().to_vec(),
        measure: dependence.measure_in_force(),
    }
}

impl ValidityRecord {
    /// Returns the records of the validity flags with the number of the `runs` that have raised each.
    pub fn of_flags<'a>(raised: impl Iterator<Item = (&'a Flag, u64)>, runs: u64) -> Vec<Self> {
        let reported = raised.filter(|(flag, raised)| !flag.warns || *raised > 0);
        let records = reported.map(|(flag, raised)| Self {
            flag: flag.name.to_string(),
            description: flag.description.to_string(),
            runs: raised,
            share: raised as f64 / runs.max(1) as f64,
        });
        records.collect()
    }
}
