//! Sweeps: one factor at a time over its range, every other at its nominal value, and the slopes at the nominal point.
//!
//! A look, not an analysis: it shows how the output goes with each factor where the others stand, and says nothing of
//! how they act together. A run that fails leaves a gap in its curve, with the reason.

mod local;
mod request;
mod rows;

#[cfg(test)]
mod tests;

pub use local::{LocalSensitivity, NoDerivative};
pub use request::{FactorValues, SweepError, SweepRequest};
#[doc(hidden)]
pub use request::{MAX_POINTS, TAIL, find, is_logarithmic};

use crate::model::{Model, RowFailure, RunContext};
use crate::run::Halt;
use crate::space::Space;
use rows::Bench;

/// Sweeps that have taken place.
#[derive(Debug, Clone, PartialEq)]
pub struct Sweeps {
    /// Every output at the nominal point, in its unit, or why it has none.
    pub nominal: Vec<Result<f64, RowFailure>>,
    /// One entry per factor asked for.
    pub sweeps: Vec<Sweep>,
    /// Model runs.
    pub runs: u64,
    /// For each validity flag of the model: runs that raised it.
    pub flags: Vec<u64>,
}

/// One factor moved over some values.
#[derive(Debug, Clone, PartialEq)]
pub struct Sweep {
    /// The number of the factor in its space.
    pub factor: usize,
    /// Its values, in its unit.
    pub values: Vec<f64>,
    /// Every output over the values, all other factors at their nominal values.
    pub nominal: Vec<CurveOutput>,
    /// The same for each value of the factor that the sweep is against.
    pub family: Vec<FamilyCurve>,
    /// For each output: how far it goes over the sweep at nominal values; `None` if every run failed.
    pub extents: Vec<Option<Extent>>,
    /// For each output: its slope at the nominal point.
    pub local: Vec<Result<LocalSensitivity, NoDerivative>>,
}

/// One curve of a family.
#[derive(Debug, Clone, PartialEq)]
pub struct FamilyCurve {
    /// The number of the factor that the sweep is against.
    pub factor: usize,
    /// Its value for this curve, in its unit.
    pub value: f64,
    /// Every output over the values of the sweep.
    pub outputs: Vec<CurveOutput>,
}

/// One output over the values of a sweep.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CurveOutput {
    /// Its values in its unit; `None` where the run failed.
    pub values: Vec<Option<f64>>,
    /// The places of the failed runs in `values`, with their reasons.
    pub failures: Vec<(usize, RowFailure)>,
}

/// How far an output goes over a sweep, in its unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extent {
    /// The least value.
    pub low: f64,
    /// The largest value.
    pub high: f64,
    /// The value at the first place of the sweep, if its run succeeded.
    pub first: Option<f64>,
    /// The value at the last place of the sweep, if its run succeeded.
    pub last: Option<f64>,
    /// 100 (high - low)/|nominal|: by so many percent of its nominal value the output moves; `None` where the nominal
    /// value is 0 or does not exist, or is in a unit such as `degC`, of which 1 % has no meaning.
    pub percent: Option<f64>,
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
/// assert_eq!(sweeps.sweeps[0].family.len(), 3);
/// // The stiffness goes with the third power of the thickness, and at these dimensions the force with it.
/// let elasticity = sweeps.sweeps[0].local[0].as_ref().map(|local| local.elasticity);
/// assert!(elasticity.is_ok_and(|e| e.is_some_and(|e| (1.0..3.0).contains(&e))));
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
    let nominal: Vec<Result<f64, RowFailure>> =
        bench.curve(0, &[first], None)?.into_iter().map(CurveOutput::single).collect();
    let sweeps = request.factors.iter().map(|asked| one(&mut bench, space, asked, &nominal, request));
    let sweeps = sweeps.collect::<Result<_, _>>()?;
    context.messages().finish();
    Ok(Sweeps { nominal, sweeps, runs: bench.runs, flags: bench.flags })
}

fn one(
    bench: &mut Bench<'_>,
    space: &Space,
    asked: &FactorValues,
    nominal: &[Result<f64, RowFailure>],
    request: &SweepRequest,
) -> Result<Sweep, Halt> {
    let FactorValues { factor, values } = asked.clone();
    let curves = bench.curve(factor, &values, None)?;
    let against = request.against.iter().filter(|against| against.factor != factor);
    let family = against.flat_map(|against| against.values.iter().map(|value| (against.factor, *value)));
    let family = family
        .map(|(other, value)| {
            let outputs = bench.curve(factor, &values, Some((other, value)))?;
            Ok(FamilyCurve { factor: other, value, outputs })
        })
        .collect::<Result<_, Halt>>()?;
    let offsets = bench.offsets();
    let extents = curves.iter().zip(nominal).zip(&offsets);
    // Of a temperature in degC there are no percent.
    let extents =
        extents.map(|((curve, nominal), offset)| Extent::of(curve, nominal.as_ref().ok().filter(|_| !offset)));
    Ok(Sweep {
        factor,
        extents: extents.collect(),
        family,
        local: local::local(bench, factor, &space.factors()[factor])?,
        nominal: curves,
        values,
    })
}

impl CurveOutput {
    /// The only value, or why it failed.
    fn single(self) -> Result<f64, RowFailure> {
        let reason = self.failures.into_iter().next().map_or_else(RowFailure::not_finite, |(_, reason)| reason);
        self.values.into_iter().next().flatten().ok_or(reason)
    }
}

impl Extent {
    fn of(curve: &CurveOutput, nominal: Option<&f64>) -> Option<Self> {
        let values = || curve.values.iter().copied().flatten();
        let (low, high) = (values().reduce(f64::min)?, values().reduce(f64::max)?);
        let percent = nominal.map(|nominal| 100.0 * ((high - low) / nominal.abs())).filter(|p| p.is_finite());
        let end = |value: Option<&Option<f64>>| value.copied().flatten();
        Some(Self { low, high, first: end(curve.values.first()), last: end(curve.values.last()), percent })
    }
}
