//! Sweeps: one factor at a time over its range, every other at its nominal value, and the slopes at the nominal point.
//!
//! A look, not an analysis: it shows how the output goes with each factor where the others stand, and says nothing of
//! how they act together. A run that fails leaves a gap in its curve, with the reason.

mod local;
mod request;
mod rows;

#[cfg(test)]
mod tests;

pub use local::LocalSensitivity;
pub use request::{FactorValues, SweepError, SweepRequest};
#[doc(hidden)]
pub use request::{MAX_POINTS, TAIL, find, is_logarithmic};

use serde::{Deserialize, Serialize};

use crate::model::{Model, RowFailure, RunContext};
use crate::run::Halt;
use crate::space::Space;
use rows::Bench;

/// Sweeps that have taken place.
#[derive(Debug, Clone, PartialEq)]
pub struct Sweeps {
    /// Every output at the nominal point.
    pub nominal: Vec<NominalOutput>,
    /// One entry per factor asked for.
    pub sweeps: Vec<Sweep>,
    /// Model runs.
    pub runs: u64,
    /// For each validity flag of the model: runs that raised it.
    pub flags: Vec<u64>,
}

/// An output at the nominal point.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NominalOutput {
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
pub struct Sweep {
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
    pub curves: Vec<SweepCurve>,
    /// One entry per output: how far it goes over the first curve, and its slope at the nominal point.
    pub effects: Vec<SweepEffect>,
}

/// One curve of each output.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SweepCurve {
    /// The other factor that is not nominal; `null` for the curve at nominal values.
    pub against: Option<Against>,
    /// One entry per output.
    pub outputs: Vec<OutputCurve>,
}

/// The factor that tells the curves of a family apart.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Against {
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
pub struct OutputCurve {
    /// The output.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Its values in `unit`; `null` where the run failed.
    pub values: Vec<Option<f64>>,
    /// The runs that failed.
    pub gaps: Vec<Gap>,
}

/// A run that failed.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Gap {
    /// Its place in `values`, from 0.
    pub place: usize,
    /// Why it failed.
    pub reason: String,
}

/// How one output answers to one factor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SweepEffect {
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
    /// 100 (high - low)/|nominal|: by so many percent of its nominal value the output moves; `None` where the nominal
    /// value is 0 or does not exist, or is in a unit such as `degC`, of which 1 % has no meaning.
    pub percent: Option<f64>,
    /// Its slope at the nominal point.
    #[serde(flatten)]
    pub local: LocalSensitivity,
}

/// Sweeps factors of `space` through `model` as `request` asks. The result is the same on every run.
///
/// ```
/// use std::path::Path;
/// use apportion::sweep::{FactorValues, SweepRequest, sweep};
/// use apportion::Study;
///
/// let study = Study::parse(include_str!("../../studies/soft-cantilever.toml"), Path::new("s.toml"), &[])?;
/// let thickness = FactorValues::over_range(study.space(), 0, 11)?;
/// let sizes = FactorValues::parse("particle_radius=20,40,60 nm", study.space())?;
/// let request = SweepRequest { factors: vec![thickness], against: Some(sizes) };
/// let sweeps = sweep(study.space(), study.model().as_ref(), &request)?;
/// assert_eq!(sweeps.sweeps[0].curves.len(), 1 + 3);
/// // The stiffness goes with the third power of the thickness, and at these dimensions the force with it.
/// assert!(sweeps.sweeps[0].effects[0].local.elasticity.is_some_and(|e| (1.0..3.0).contains(&e)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`SweepError`] if a factor is asked for twice, or against itself alone, or the model gives up. Runs that fail are
/// part of the result.
///
/// # Panics
/// If a factor's number is not one of the space.
pub fn sweep(space: &Space, model: &dyn Model, request: &SweepRequest) -> Result<Sweeps, SweepError> {
    sweep_in(space, model, request, &RunContext::default())
}

/// The same as the run of `context`, which may end it.
///
/// # Errors
/// As for [`sweep`], and [`Halt::Interrupted`] if the run is to end.
///
/// # Panics
/// As for [`sweep`].
pub fn sweep_in(
    space: &Space,
    model: &dyn Model,
    request: &SweepRequest,
    context: &RunContext<'_>,
) -> Result<Sweeps, SweepError> {
    request.check(space)?;
    let mut bench = Bench::new(space, model, context);
    let first = space.factors().first().map_or(f64::NAN, |factor| factor.nominal);
    let nominal: Vec<NominalOutput> = bench.curve(0, &[first], None)?.into_iter().map(NominalOutput::new).collect();
    let sweeps = request.factors.iter().map(|asked| one(&mut bench, space, asked, &nominal, request));
    let sweeps = sweeps.collect::<Result<_, _>>()?;
    context.messages().finish();
    Ok(Sweeps { nominal, sweeps, runs: bench.runs, flags: bench.flags })
}

fn one(
    bench: &mut Bench<'_>,
    space: &Space,
    asked: &FactorValues,
    nominal: &[NominalOutput],
    request: &SweepRequest,
) -> Result<Sweep, Halt> {
    let FactorValues { factor: number, values } = asked.clone();
    let factor = &space.factors()[number];
    let mut curves = vec![SweepCurve { against: None, outputs: bench.curve(number, &values, None)? }];
    let against = request.against.iter().filter(|against| against.factor != number);
    for (other, value) in against.flat_map(|against| against.values.iter().map(|value| (against.factor, *value))) {
        let outputs = bench.curve(number, &values, Some((other, value)))?;
        let other = &space.factors()[other];
        let against = Against {
            factor: other.name.clone(),
            value,
            label: other.distribution().label(value).map(str::to_owned),
            unit: other.unit().to_string(),
        };
        curves.push(SweepCurve { against: Some(against), outputs });
    }
    // Of a temperature in degC there are no percent.
    let offsets = bench.offsets();
    let nominal = nominal.iter().zip(offsets).map(|(nominal, offset)| nominal.value.filter(|_| !offset));
    let local = local::local(bench, number, factor)?;
    let effects = curves[0].outputs.iter().zip(nominal).zip(local);
    let over_range = FactorValues::over_range(space, number, values.len().max(2));
    Ok(Sweep {
        factor: factor.name.clone(),
        unit: factor.unit().to_string(),
        nominal: factor.nominal,
        spacing: if is_logarithmic(factor.distribution()) { "logarithmic" } else { "linear" }.to_owned(),
        given: over_range.map_or(true, |range| range.values != values),
        labels: values.iter().map(|value| factor.distribution().label(*value).map(str::to_owned)).collect(),
        effects: effects.map(|((curve, nominal), local)| SweepEffect::new(curve, nominal, local)).collect(),
        curves,
        values,
    })
}

impl NominalOutput {
    /// That of a curve of one value.
    fn new(curve: OutputCurve) -> Self {
        let value = curve.values.into_iter().next().flatten();
        let failure = curve.gaps.into_iter().next().map(|gap| gap.reason);
        let reason = value.is_none().then(|| failure.unwrap_or_else(|| RowFailure::not_finite().to_string()));
        Self { output: curve.name, unit: curve.unit, value, reason }
    }
}

impl SweepEffect {
    fn new(curve: &OutputCurve, nominal: Option<f64>, local: LocalSensitivity) -> Self {
        let values = || curve.values.iter().copied().flatten();
        let (low, high) = (values().reduce(f64::min), values().reduce(f64::max));
        let width = low.zip(high).map(|(low, high)| high - low);
        let percent = width.zip(nominal).map(|(width, nominal)| 100.0 * (width / nominal.abs()));
        Self {
            output: curve.name.clone(),
            unit: curve.unit.clone(),
            low,
            high,
            first: curve.values.first().copied().flatten(),
            last: curve.values.last().copied().flatten(),
            percent: percent.filter(|percent| percent.is_finite()),
            local,
        }
    }
}
