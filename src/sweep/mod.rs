//! Sweeps: one factor at a time over its range, every other at its nominal value.
//!
//! A view, not an analysis: it shows how the output depends on each factor with the others fixed, but no interactions.
//! A failed run leaves a gap in its curve, with the reason.

mod range;
#[cfg(test)]
mod tests;
use range::is_logarithmic;
use serde::{Deserialize, Serialize};
use serde_json::json;
use thiserror::Error;

use crate::model::{Batch, Output, RowFailure};
use crate::run::{RunError, TableRun};
use crate::runner::Runner;
use crate::space::Space;
use apportion_base::names::{did_you_mean, nearest};

/// The results of sweeps.
#[derive(Debug, Clone, PartialEq)]
pub struct Sweeps {
    /// Every output at the nominal point.
    pub nominal: Vec<NominalOutput>,
    /// One entry per requested factor.
    pub sweeps: Vec<Sweep>,
    /// Number of model runs.
    pub runs: u64,
    /// For each validity flag of the model: runs that raised it.
    pub flags: Vec<u64>,
}

impl Sweeps {
    /// Maximum number of values of one factor.
    pub const MAX_POINTS: usize = 100_000;
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
    /// Why there is no value, if there is none.
    pub reason: Option<String>,
}

/// The sweep of one factor over its range.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Sweep {
    /// The factor.
    pub factor: String,
    /// Its unit.
    pub unit: String,
    /// Its nominal value in `unit`.
    pub nominal: f64,
    /// The recommended scale of its axis: `linear` or `logarithmic`.
    pub spacing: String,
    /// Its values in `unit`.
    pub values: Vec<f64>,
    /// The labels of the values, for a factor of categories.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub labels: Option<Vec<String>>,
    /// The outputs over the values.
    pub outputs: Vec<SweptOutput>,
}

/// One output over the values of a sweep.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SweptOutput {
    /// The output.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Its values in `unit`; `null` where the run failed.
    pub values: Vec<Option<f64>>,
    /// The runs that failed.
    pub gaps: Vec<Gap>,
    /// Its smallest value.
    pub low: Option<f64>,
    /// Its largest value.
    pub high: Option<f64>,
    /// 100 (high - low)/|nominal|: the range of the output in percent of its nominal value; `None` if the nominal value
    /// is 0 or does not exist, or is in a unit such as `degC`, of which 1 % has no meaning.
    pub percent: Option<f64>,
}

/// A run that failed.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Gap {
    /// Its place in `values`, from 0.
    pub place: usize,
    /// Why it failed.
    pub reason: String,
}

/// Why a sweep failed.
#[derive(Debug, Error)]
pub enum SweepError {
    /// The run failed.
    #[error("{0}")]
    Run(#[from] RunError),
    /// The factor is unknown.
    #[error("the study has no factor `{name}`{}; its factors are {}", did_you_mean(nearest), factors.join(", "))]
    UnknownFactor {
        /// The name given.
        name: String,
        /// The nearest factor.
        nearest: Option<String>,
        /// All factors of the study.
        factors: Vec<String>,
    },
    /// A factor was requested twice.
    #[error("factor `{0}` is listed twice")]
    Repeated(String),
    /// Too few or too many points.
    #[error("{0} points: a sweep needs from 2 to {max}", max = Sweeps::MAX_POINTS)]
    Points(usize),
}

/// Returns the indices of the factors with these names; of all factors if none is named.
///
/// # Errors
/// [`SweepError`]: an unknown name, or a duplicate one.
pub fn find(space: &Space, names: &[impl AsRef<str>]) -> Result<Vec<usize>, SweepError> {
    let factors: Vec<&str> = space.factors().iter().map(|factor| factor.name.as_str()).collect();
    let mut numbers = Vec::new();
    for name in names.iter().map(|name| name.as_ref().trim()) {
        let number = factors.iter().position(|factor| *factor == name).ok_or_else(|| SweepError::UnknownFactor {
            name: name.to_owned(),
            nearest: nearest(name, factors.iter().copied()),
            factors: factors.iter().map(|factor| (*factor).to_owned()).collect(),
        })?;
        if numbers.contains(&number) {
            return Err(SweepError::Repeated(name.to_owned()));
        }
        numbers.push(number);
    }
    Ok(if names.is_empty() { (0..factors.len()).collect() } else { numbers })
}

impl Runner<'_> {
    /// Moves each of `factors`, by index, over its range at `points` points, every other factor at its nominal value.
    ///
    /// # Errors
    /// [`SweepError`] for a number of points that is out of range, if the model gives up, the run is to stop, or the
    /// journal cannot be used or written.
    ///
    /// # Example
    /// ```
    /// use apportion::{Distribution, Study, function_model};
    ///
    /// let study = Study::builder("product", function_model("y", |x| x[0] * x[1]))
    ///     .factor("a", Distribution::uniform(1.0, 2.0)?)
    ///     .factor("b", Distribution::uniform(1.0, 5.0)?)
    ///     .build()?;
    /// let swept = study.runner().sweep(&[1], 3)?;
    /// assert_eq!(swept.sweeps[0].outputs[0].values, [Some(1.5), Some(4.5), Some(7.5)]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn sweep(self, factors: &[usize], points: usize) -> Result<Sweeps, SweepError> {
        let space = self.study.space();
        let mut runs = 1;
        for &number in factors {
            runs += space.factors()[number].distribution().values_over_range(points)?.len() as u64;
        }
        let identity = json!({ "factors": factors, "points": points });
        self.run_table(identity, Some(runs), |run| sweep(run, space, factors, points))
    }
}

fn sweep(run: &TableRun<'_>, space: &Space, factors: &[usize], points: usize) -> Result<Sweeps, SweepError> {
    let model = run.model();
    let flags = vec![0; model.flags().len()];
    let mut evaluator = Evaluator { space, outputs: model.outputs(), run, batch: Batch::new(model), flags };
    let first = space.factors().first().map_or(f64::NAN, |factor| factor.nominal);
    let nominal: Vec<NominalOutput> = evaluator.curve(0, &[first])?.into_iter().map(NominalOutput::new).collect();
    let mut sweeps = Vec::with_capacity(factors.len());
    for &number in factors {
        sweeps.push(evaluator.sweep(number, points, &nominal)?);
    }
    let runs = 1 + sweeps.iter().map(|sweep| sweep.values.len() as u64).sum::<u64>();
    Ok(Sweeps { nominal, sweeps, runs, flags: evaluator.flags })
}

impl NominalOutput {
    /// Creates it from a curve of one value.
    fn new(curve: SweptOutput) -> Self {
        let value = curve.values.into_iter().next().flatten();
        let failure = curve.gaps.into_iter().next().map(|gap| gap.reason);
        let reason = value.is_none().then(|| failure.unwrap_or_else(|| RowFailure::not_finite().to_string()));
        Self { output: curve.name, unit: curve.unit, value, reason }
    }
}

impl SweptOutput {
    fn new(output: &Output) -> Self {
        let (name, unit) = (output.name.to_string(), output.unit.to_string());
        Self { name, unit, values: Vec::new(), gaps: Vec::new(), low: None, high: None, percent: None }
    }
}

/// A model with its factors at their nominal values.
struct Evaluator<'a, 'r> {
    space: &'a Space,
    outputs: &'a [Output],
    run: &'a TableRun<'r>,
    batch: Batch,
    /// For each validity flag, the number of runs so far that raised it.
    flags: Vec<u64>,
}

impl Evaluator<'_, '_> {
    /// Moves one factor, by index, over its range.
    fn sweep(&mut self, number: usize, points: usize, nominal: &[NominalOutput]) -> Result<Sweep, SweepError> {
        let factor = &self.space.factors()[number];
        let distribution = factor.distribution();
        let values = distribution.values_over_range(points)?;
        let mut outputs = self.curve(number, &values)?;
        for ((swept, nominal), output) in outputs.iter_mut().zip(nominal).zip(self.outputs) {
            let width = swept.high.zip(swept.low).map(|(high, low)| high - low).filter(|_| !output.unit.has_offset());
            let percent = nominal.value.zip(width).map(|(value, width)| 100.0 * (width / value.abs()));
            swept.percent = percent.filter(|percent| percent.is_finite());
        }
        Ok(Sweep {
            factor: factor.name.clone(),
            unit: factor.unit().to_string(),
            nominal: factor.nominal,
            spacing: if is_logarithmic(distribution) { "logarithmic" } else { "linear" }.to_owned(),
            labels: values.iter().map(|value| distribution.label(*value).map(str::to_owned)).collect(),
            values,
            outputs,
        })
    }

    /// Returns every output for each of `values` of one factor, in its unit.
    fn curve(&mut self, factor: usize, values: &[f64]) -> Result<Vec<SweptOutput>, RunError> {
        let factors = self.space.factors();
        let mut swept: Vec<SweptOutput> = self.outputs.iter().map(SweptOutput::new).collect();
        let max_rows = self.run.rows_at_once();
        for (block, values) in values.chunks(max_rows).enumerate() {
            let nominal = factors.iter().map(|factor| factor.unit().to_si(factor.nominal));
            let mut columns: Vec<Vec<f64>> = nominal.map(|value| vec![value; values.len()]).collect();
            columns[factor] = values.iter().map(|value| factors[factor].unit().to_si(*value)).collect();
            let inputs: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
            self.batch.reset(values.len());
            self.run.run(&inputs, &mut self.batch)?;
            for (sum, raised) in self.flags.iter_mut().zip(self.batch.flags()) {
                *sum += raised;
            }
            for (number, (output, swept)) in self.outputs.iter().zip(&mut swept).enumerate() {
                let column = self.batch.column(number).iter();
                swept.values.extend(column.map(|value| value.is_finite().then(|| output.unit.from_si(*value))));
            }
            for (output, row, reason) in self.batch.failures() {
                swept[*output].gaps.push(Gap { place: block * max_rows + row, reason: reason.to_string() });
            }
        }
        for swept in &mut swept {
            let values = swept.values.iter().copied().flatten();
            (swept.low, swept.high) = (values.clone().reduce(f64::min), values.reduce(f64::max));
        }
        Ok(swept)
    }
}
