//! The sweep file: JSON that other programs can rely on.
//!
//! Format `apportion-sweep`, version 1, described key by key in `docs/sweep-format.md`. Later versions of the program
//! only add keys. A number that does not exist is `null`.

use serde::{Deserialize, Serialize};

use super::super::format::short_with_unit;
use super::super::records::{StudySetup, study_setup, validity};
use super::super::result::ValidityRecord;
use crate::model::Model;
use crate::study::Study;
use crate::sweep::{CurveOutput, FactorValues, Sweep, Sweeps, is_logarithmic};

/// All sweeps of a study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SweepFile {
    /// Always `apportion-sweep`.
    pub format: String,
    /// Version of the format.
    pub version: u32,
    /// What was asked.
    pub study: StudySetup,
    /// How it was answered.
    pub provenance: SweepProvenance,
    /// Every output where all factors are nominal.
    pub nominal: Vec<NominalRecord>,
    /// One entry per factor swept.
    pub sweeps: Vec<FactorSweepRecord>,
    /// Rows on which the model's assumptions do not hold; the rows count all the same.
    pub validity: Vec<ValidityRecord>,
}

/// How the sweeps were made.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SweepProvenance {
    /// Version of the program.
    pub apportion_version: String,
    /// Runs of the model, those for the slopes among them.
    pub model_runs: u64,
}

/// An output at the nominal point.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NominalRecord {
    /// The output.
    pub output: String,
    /// Its unit.
    pub unit: String,
    /// Its value.
    pub value: Option<f64>,
    /// Why there is no value, where there is none.
    pub reason: Option<String>,
}

/// One factor moved over its values.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FactorSweepRecord {
    /// The factor.
    pub factor: String,
    /// Its unit.
    pub unit: String,
    /// Its nominal value in `unit`.
    pub nominal: f64,
    /// `linear` or `logarithmic`: how its axis is best divided.
    pub spacing: String,
    /// Its values in `unit`.
    pub values: Vec<f64>,
    /// Whether these were asked for, and are not those over its range.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub given: bool,
    /// What the values stand for, of a factor of categories.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub labels: Option<Vec<String>>,
    /// The outputs over the values: first with all other factors nominal, then the curves of the family, if any.
    pub curves: Vec<CurveRecord>,
    /// One entry per output: how far it goes over the first curve, and its slope at the nominal point.
    pub effects: Vec<SweepEffectRecord>,
}

/// One curve of each output.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CurveRecord {
    /// The other factor that is not nominal; `null` for the curve at nominal values.
    pub against: Option<AgainstRecord>,
    /// One entry per output.
    pub outputs: Vec<OutputCurveRecord>,
}

/// The factor that tells the curves of a family apart.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AgainstRecord {
    /// The factor.
    pub factor: String,
    /// Its value in `unit`.
    pub value: f64,
    /// What the value stands for, of a factor of categories.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub label: Option<String>,
    /// Its unit.
    pub unit: String,
}

/// One output over the values of a sweep.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OutputCurveRecord {
    /// The output.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Its values in `unit`; `null` where the run failed.
    pub values: Vec<Option<f64>>,
    /// The runs that failed.
    pub gaps: Vec<GapRecord>,
}

/// A run that failed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GapRecord {
    /// Its place in `values`, from 0.
    pub place: usize,
    /// Why it failed.
    pub reason: String,
}

/// How one output answers to one factor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SweepEffectRecord {
    /// The output.
    pub output: String,
    /// Its unit.
    pub unit: String,
    /// Its least value over the sweep.
    pub low: Option<f64>,
    /// Its largest value over the sweep.
    pub high: Option<f64>,
    /// Its value at the first place of the sweep.
    pub first: Option<f64>,
    /// Its value at the last place of the sweep.
    pub last: Option<f64>,
    /// 100 (high - low)/|nominal|.
    pub percent: Option<f64>,
    /// dy/dx at the nominal point, in `unit` per unit of the factor.
    pub derivative: Option<f64>,
    /// How far `derivative` may be off.
    pub derivative_error: Option<f64>,
    /// (x/y) dy/dx at the nominal point.
    pub elasticity: Option<f64>,
    /// How far `elasticity` may be off.
    pub elasticity_error: Option<f64>,
    /// Why there is no derivative, where there is none.
    pub reason: Option<String>,
}

impl FactorSweepRecord {
    /// The value at `place`, or what it stands for, with its unit.
    pub(super) fn value_in_words(&self, place: usize) -> String {
        match (&self.labels, self.values.get(place)) {
            (Some(labels), Some(_)) => labels[place].clone(),
            (None, Some(value)) => short_with_unit(*value, &self.unit),
            (_, None) => String::new(),
        }
    }
}

impl AgainstRecord {
    /// The value, or what it stands for, with its unit.
    pub(super) fn value_in_words(&self) -> String {
        self.label.clone().unwrap_or_else(|| short_with_unit(self.value, &self.unit))
    }
}

impl SweepEffectRecord {
    /// How far the output goes; below every width where it has no value.
    pub(super) fn width(&self) -> f64 {
        self.low.zip(self.high).map_or(f64::NEG_INFINITY, |(low, high)| high - low)
    }
}

/// The file of the sweeps of `study`, whose model is `model`.
pub fn build_sweep(study: &Study, model: &dyn Model, sweeps: &Sweeps) -> SweepFile {
    let nominal = model.outputs().iter().zip(&sweeps.nominal).map(|(output, value)| NominalRecord {
        output: output.name.to_string(),
        unit: output.unit.to_string(),
        value: value.as_ref().ok().copied(),
        reason: value.as_ref().err().map(ToString::to_string),
    });
    SweepFile {
        format: "apportion-sweep".to_owned(),
        version: 1,
        study: study_setup(study),
        provenance: SweepProvenance {
            apportion_version: env!("CARGO_PKG_VERSION").to_owned(),
            model_runs: sweeps.runs,
        },
        nominal: nominal.collect(),
        sweeps: sweeps.sweeps.iter().map(|sweep| factor_record(study, model, sweep)).collect(),
        validity: validity(model, &sweeps.flags, sweeps.runs),
    }
}

fn factor_record(study: &Study, model: &dyn Model, sweep: &Sweep) -> FactorSweepRecord {
    let factors = study.space.factors();
    let factor = &factors[sweep.factor];
    let outputs = |curves: &[CurveOutput]| -> Vec<OutputCurveRecord> {
        let record = |(output, curve): (&crate::model::Output, &CurveOutput)| OutputCurveRecord {
            name: output.name.to_string(),
            unit: output.unit.to_string(),
            values: curve.values.clone(),
            gaps: curve
                .failures
                .iter()
                .map(|(place, reason)| GapRecord { place: *place, reason: reason.to_string() })
                .collect(),
        };
        model.outputs().iter().zip(curves).map(record).collect()
    };
    let family = sweep.family.iter().map(|curve| CurveRecord {
        against: Some(AgainstRecord {
            factor: factors[curve.factor].name.clone(),
            value: curve.value,
            label: factors[curve.factor].distribution().label(curve.value).map(str::to_owned),
            unit: factors[curve.factor].unit().to_string(),
        }),
        outputs: outputs(&curve.outputs),
    });
    let at_nominal = CurveRecord { against: None, outputs: outputs(&sweep.nominal) };
    let spacing = if is_logarithmic(factor.distribution()) { "logarithmic" } else { "linear" };
    FactorSweepRecord {
        factor: factor.name.clone(),
        unit: factor.unit().to_string(),
        nominal: factor.nominal,
        spacing: spacing.to_owned(),
        given: is_given(study, sweep),
        values: sweep.values.clone(),
        labels: sweep.values.iter().map(|value| factor.distribution().label(*value).map(str::to_owned)).collect(),
        curves: std::iter::once(at_nominal).chain(family).collect(),
        effects: (0..model.outputs().len()).map(|number| effect(model, sweep, number)).collect(),
    }
}

/// Whether the values of a sweep are others than so many over the range of its factor.
fn is_given(study: &Study, sweep: &Sweep) -> bool {
    let over_range = FactorValues::over_range(&study.space, sweep.factor, sweep.values.len().max(2));
    over_range.map_or(true, |range| range.values != sweep.values)
}

fn effect(model: &dyn Model, sweep: &Sweep, number: usize) -> SweepEffectRecord {
    let output = &model.outputs()[number];
    let (extent, local) = (sweep.extents[number], &sweep.local[number]);
    let slope = local.as_ref().ok();
    SweepEffectRecord {
        output: output.name.to_string(),
        unit: output.unit.to_string(),
        low: extent.map(|extent| extent.low),
        high: extent.map(|extent| extent.high),
        first: extent.and_then(|extent| extent.first),
        last: extent.and_then(|extent| extent.last),
        percent: extent.and_then(|extent| extent.percent),
        derivative: slope.map(|slope| slope.derivative),
        derivative_error: slope.map(|slope| slope.derivative_error),
        elasticity: slope.and_then(|slope| slope.elasticity),
        elasticity_error: slope.and_then(|slope| slope.elasticity_error),
        reason: local.as_ref().err().map(ToString::to_string),
    }
}
