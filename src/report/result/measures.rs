//! Other measures of influence than Sobol' indices, in the files of runs and of given data.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{EstimateRecord, estimate_record};
use crate::given::{InputMeasures, Measure};

/// Probability below which an input is taken to have an influence.
pub(in crate::report) const SIGNIFICANT: f64 = 0.05;

/// Other measures than Sobol' indices.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[doc(hidden)]
pub struct MeasuresRecord {
    /// The first rows A and B that they were taken from.
    pub rows: u64,
    /// One entry per factor.
    pub factors: Vec<GivenMeasuresRecord>,
}

/// The measures of one input.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct GivenMeasuresRecord {
    /// The input.
    pub input: String,
    /// By the names of [`Measure`].
    pub measures: BTreeMap<String, MeasuredRecord>,
}

/// A measure of one input.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MeasuredRecord {
    /// The measure, with the bounds of its interval where it has one.
    #[serde(flatten)]
    pub estimate: EstimateRecord,
    /// Probability of so large a measure of an input without influence; `null` where it is not known.
    pub p_value: Option<f64>,
}

impl GivenMeasuresRecord {
    /// Those of `wanted` measures that are known.
    pub(in crate::report) fn of(of: &InputMeasures, wanted: &[Measure]) -> Self {
        let measured = |measure: &Measure| {
            let found = of.get(*measure);
            let record = MeasuredRecord { estimate: estimate_record(found.estimate), p_value: found.p_value };
            (measure.name().to_owned(), record)
        };
        let known = wanted.iter().filter(|measure| of.get(**measure).estimate.estimate.is_finite());
        Self { input: of.input.clone(), measures: known.map(measured).collect() }
    }

    /// That measure, where it is known.
    pub(in crate::report) fn get(&self, measure: Measure) -> Option<MeasuredRecord> {
        self.measures.get(measure.name()).copied()
    }

    /// Whether the measure cannot be told from that of an input without influence.
    pub(in crate::report) fn may_be_chance(&self, measure: Measure) -> bool {
        self.get(measure).and_then(|found| found.p_value).is_some_and(|p_value| p_value > SIGNIFICANT)
    }
}
