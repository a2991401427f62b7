//! Measures of influence other than the share of the variance, from the same table.
//!
//! They use more of an output than its variance, or test less: whether an input has any influence at all. None of them
//! divides a whole among the inputs, and none separates interactions from the individual effect of an input.

mod density;
mod distances;
mod fourier;
mod hsic;

use std::collections::BTreeMap;

use density::OutputDistribution;
use distances::distances;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::column::{Column, NoVariance};
use super::order::{Order, Partition};
use super::{GivenIndices, PointSet, centred, shuffle};
use crate::uncertainty::{Estimate, Interval, NORMAL_QUANTILE};
use apportion_base::names::named;

named! {
/// A measure of the influence of an input on an output.
#[derive(PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Measure {
    /// First-order index from the spectrum of the output in the order of the input: EASI, Plischke (2010), Reliab. Eng.
    /// Syst. Saf. 95, 354-360, and RBD-FAST of given data, with the correction of Tissot and Prieur (2012). Estimates
    /// S_1.
    Fourier = "fourier",
    /// Borgonovo's (2007) delta: half of the mean distance between the distribution of the output and its distributions
    /// given the input. From shares of values and kernel densities in classes of the input (Plischke, Borgonovo and
    /// Smith 2013, Eur. J. Oper. Res. 226, 536-550), minus the expected noise.
    Delta = "delta",
    /// The median over ten classes of the input of the Kolmogorov-Smirnov distance: PAWN, Pianosi and Wagener (2018),
    /// Environ. Model. Softw. 108, 197-207.
    PawnMedian = "pawn_median",
    /// The largest of these distances.
    PawnMax = "pawn_max",
    /// The Hilbert-Schmidt independence criterion with Gaussian kernels, normalised (R2-HSIC): Gretton et al. (2005);
    /// Da Veiga (2015), J. Stat. Comput. Simul. 85, 1283-1305.
    #[serde(rename = "r2_hsic")]
    Hsic = "r2_hsic",
}
}

impl Measure {
    /// Returns the name in tables.
    pub fn heading(self) -> &'static str {
        match self {
            Self::Fourier => "S_1, Fourier",
            Self::Delta => "delta",
            Self::PawnMedian => "PAWN median",
            Self::PawnMax => "PAWN max",
            Self::Hsic => "R2-HSIC",
        }
    }
}

/// A measure of one input.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "MeasuredRecord"))]
#[non_exhaustive]
pub struct Measured {
    /// The measure, with its interval if there is one: for delta, of independent rows and those of a run.
    #[serde(flatten)]
    pub estimate: Estimate,
    /// The probability of a measure at least as large for an input without influence; `None` if rows are not
    /// independent draws (those of nets and Latin hypercubes are more even, and p-values would be far too large), or
    /// the input has one value. From [`InputMeasures::PERMUTATIONS`] permutations of the output; for the kernels from a gamma
    /// distribution (Gretton et al. 2008).
    pub p_value: Option<f64>,
}

/// The measures of one input.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "GivenMeasuresRecord"))]
#[non_exhaustive]
pub struct InputMeasures {
    /// The input.
    pub input: String,
    /// The requested ones that exist: kernels are undefined if input or output has one value in the rows that they use.
    pub measures: BTreeMap<Measure, Measured>,
}

impl InputMeasures {
    /// Maximum number of rows that R2-HSIC uses.
    pub const MAX_ROWS_OF_KERNELS: usize = hsic::MAX_ROWS;

    /// p-values below this indicate influence.
    pub const SIGNIFICANT: f64 = 0.05;

    /// Number of permutations for a p-value: its resolution is 0.005.
    pub const PERMUTATIONS: usize = 199;

    /// Returns one of them, if it exists.
    pub fn get(&self, measure: Measure) -> Option<Measured> {
        self.measures.get(&measure).copied()
    }

    /// Returns whether an input without influence may have this measure: its p-value exceeds [`InputMeasures::SIGNIFICANT`].
    pub fn may_be_chance(&self, measure: Measure) -> bool {
        self.get(measure)
            .and_then(|measured| measured.p_value)
            .is_some_and(|p_value| p_value > InputMeasures::SIGNIFICANT)
    }
}

/// Number of resamples for the interval of delta.
const RESAMPLES: usize = 100;

/// Relative width of the narrower kernels, which reveal what wider ones in half as many classes miss.
const NARROWER: f64 = 0.25;
/// Remaining error of the narrower kernels relative to the difference: errors are proportional to the width.
const LEFT: f64 = 1.0 / 3.0;
/// Error of that correction relative to the difference.
const ERROR_OF_CORRECTION: f64 = 2.0;
/// Relative difference, if it is no chance, above which no width of kernels shows how large delta is.
const MAX_DIFFERENCE: f64 = 0.5;

/// Number of permutations for narrower kernels: only their mean is needed.
const FINER_PERMUTATIONS: usize = 40;

/// Classes of PAWN.
const PAWN_CLASSES: usize = 10;

/// Number of measures by permutations: all but the kernels.
const PERMUTED: usize = 4;

/// Computes the measures of every output with respect to every input, for the columns that gave `indices`.
///
/// Costs O(N log N) for each input and permutation, and O(N^2) for the kernels, on at most [`InputMeasures::MAX_ROWS_OF_KERNELS`]
/// random rows. `seed` determines these rows, permutations, resamples, and the order of equal inputs in the spectrum.
pub fn measures(
    inputs: &[Column],
    outputs: &[Column],
    indices: &GivenIndices,
    seed: u64,
) -> Vec<Result<Vec<InputMeasures>, NoVariance>> {
    let is_random = indices.points == PointSet::Independent && indices.effective_rows.is_none();
    let outputs = outputs.iter().enumerate().map(|(number, output)| {
        let setting = Setting { seed, number: number as u64, has_p_values: is_random, has_intervals: is_random };
        Ok(Job::new(&output.values, &Measure::ALL, setting)?.measures(inputs))
    });
    outputs.collect()
}

/// Computes the measures `wanted` of one output with respect to every input, for rows that are draws from the
/// distributions of the inputs: with the intervals of delta, which were measured to be valid for nets and Latin
/// hypercubes too (docs/background/coverage-measures.md), and with p-values if they are `independent` draws.
pub(crate) fn measures_of_rows(
    inputs: &[Column],
    output: &[f64],
    wanted: &[Measure],
    seed: u64,
    number: u64,
    independent: bool,
) -> Result<Vec<InputMeasures>, NoVariance> {
    let setting = Setting { seed, number, has_p_values: independent, has_intervals: true };
    Ok(Job::new(output, wanted, setting)?.measures(inputs))
}

/// The random numbers of an output, and what its rows allow.
#[derive(Clone, Copy)]
struct Setting {
    seed: u64,
    /// The number of the output.
    number: u64,
    has_p_values: bool,
    /// Whether delta has intervals.
    has_intervals: bool,
}

/// One output.
struct Job<'a> {
    wanted: &'a [Measure],
    /// Minus the mean: for the measures that are parts of a variance.
    z: Vec<f64>,
    /// Of the values themselves: subtracting the mean first would make all others equal next to a huge value.
    order: Order,
    distribution: OutputDistribution,
    setting: Setting,
}

/// One input.
struct RankedInput<'a> {
    number: u64,
    column: &'a Column,
    order: Order,
    classes: Classes,
}

/// Classes of the rows by one input.
struct Classes {
    /// Classes for delta.
    delta: Partition,
    /// Twice as many.
    finer_delta: Partition,
    /// Classes for PAWN.
    pawn: Partition,
}

impl Classes {
    fn new(order: &Order, rows: usize, has_atoms: bool) -> Self {
        let count = classes_for(rows);
        // Shares of values need fewer rows than densities, and miss more of the effect inside a class.
        let of_delta = if has_atoms { 2 * count } else { count };
        let (delta, finer_delta) = (order.classes(of_delta), order.classes(2 * of_delta));
        Self { delta, finer_delta, pawn: order.classes(PAWN_CLASSES) }
    }

    /// Returns the classes with the rows in another order.
    fn permuted(&self, rows: &[usize]) -> Self {
        let [delta, finer_delta, pawn] = [&self.delta, &self.finer_delta, &self.pawn].map(|classes| Partition {
            labels: rows.iter().map(|&row| classes.labels[row]).collect(),
            count: classes.count,
        });
        Self { delta, finer_delta, pawn }
    }
}

/// The measures of inputs without influence.
#[derive(Default)]
struct Chance {
    /// The measures in each permutation.
    measures: Vec<[f64; PERMUTED]>,
    /// The mean of delta by narrower kernels in twice as many classes.
    finer_delta: f64,
}

/// Returns the number of classes for delta (Plischke, Borgonovo and Smith 2013, as in SALib): at most 48.
fn classes_for(rows: usize) -> usize {
    let rows = rows as f64;
    let power = 2.0 / (7.0 + libm::tanh((1500.0 - rows) / 500.0));
    (libm::pow(rows, power).ceil() as usize).min(48)
}

impl<'a> Job<'a> {
    fn new(values: &[f64], wanted: &'a [Measure], setting: Setting) -> Result<Self, NoVariance> {
        let (z, order, distribution) = (centred(values)?, Order::from_values(values), OutputDistribution::new(values));
        Ok(Self { wanted, z, order, distribution, setting })
    }

    fn wants(&self, measure: Measure) -> bool {
        self.wanted.contains(&measure)
    }

    fn has_intervals(&self) -> bool {
        self.setting.has_intervals && self.wants(Measure::Delta)
    }

    fn random(&self, stream: u64) -> ChaCha8Rng {
        let mut random = ChaCha8Rng::seed_from_u64(self.setting.seed);
        random.set_stream(self.setting.number << 32 | stream);
        random
    }

    fn measures(&self, inputs: &[Column]) -> Vec<InputMeasures> {
        let has_atoms = self.distribution.has_atoms();
        let inputs = inputs.iter().enumerate().map(|(number, column)| {
            let order = Order::from_values(&column.values);
            let classes = Classes::new(&order, self.z.len(), has_atoms);
            RankedInput { number: number as u64, column, order, classes }
        });
        let inputs: Vec<RankedInput<'_>> = inputs.collect();
        // The distribution by chance depends only on the ties of an input. An interval needs it too.
        let mut chance: BTreeMap<&[usize], Chance> = BTreeMap::new();
        if self.setting.has_p_values || self.has_intervals() {
            for input in &inputs {
                chance.entry(input.order.starts()).or_insert_with(|| self.by_chance(&input.order, &input.classes));
            }
        }
        let kernels = if self.wants(Measure::Hsic) { hsic::Outputs::new(&self.z, self.setting.seed) } else { None };
        let measures = inputs.par_iter().map(|input| {
            let mut values = [Measured { estimate: Estimate::alone(0.0), p_value: None }; Measure::ALL.len()];
            if input.order.groups() > 1 {
                values = self.measures_of(input, chance.get(input.order.starts()), kernels.as_ref());
            }
            let values = Measure::ALL.into_iter().zip(values);
            let existing = values.filter(|(measure, of)| self.wants(*measure) && of.estimate.estimate.is_finite());
            InputMeasures { input: input.column.name.clone(), measures: existing.collect() }
        });
        measures.collect()
    }

    /// Computes all measures of an input that varies; those that do not exist are not finite.
    fn measures_of(
        &self,
        input: &RankedInput<'_>,
        chance: Option<&Chance>,
        kernels: Option<&hsic::Outputs>,
    ) -> [Measured; Measure::ALL.len()] {
        let mut values = [Measured { estimate: Estimate::alone(f64::NAN), p_value: None }; Measure::ALL.len()];
        let plain = self.plain(&input.order, &input.classes, input.order.rows());
        let permutations = chance.map_or(&[][..], |chance| &chance.measures);
        for (place, (measured, plain)) in values.iter_mut().zip(plain).enumerate() {
            let larger = permutations.iter().filter(|by_chance| by_chance[place] >= plain).count();
            let p_value = (1 + larger) as f64 / (1 + permutations.len()) as f64;
            *measured =
                Measured { estimate: Estimate::alone(plain), p_value: (!permutations.is_empty()).then_some(p_value) };
        }
        if let Some(chance) = chance.filter(|_| self.has_intervals()) {
            let delta = &mut values[Measure::Delta as usize];
            delta.estimate = self.delta(&input.classes, delta.estimate.estimate, chance, input.number);
            if let (Some(interval), Some(InputMeasures::SIGNIFICANT..)) = (&mut delta.estimate.interval, delta.p_value)
            {
                // If it is not distinguished from chance, it may be 0.
                interval.low = 0.0;
            }
        }
        if let Some(measured) = kernels.and_then(|kernels| kernels.measure(&input.column.values)) {
            values[Measure::Hsic as usize] = measured;
        }
        if !self.setting.has_p_values {
            values.iter_mut().for_each(|measured| measured.p_value = None);
        }
        values
    }

    /// Computes all but the kernels, for the rows in the order of the input.
    fn plain(&self, order: &Order, classes: &Classes, rows: &[usize]) -> [f64; PERMUTED] {
        let mut slides = distances(&self.order, &classes.pawn);
        slides.sort_by(f64::total_cmp);
        let middle = slides.len() / 2;
        let median = if slides.len() % 2 == 1 { slides[middle] } else { (slides[middle - 1] + slides[middle]) / 2.0 };
        [
            fourier::first_order(&rows.iter().map(|&row| self.z[row]).collect::<Vec<f64>>(), order.starts()),
            if self.wants(Measure::Delta) { self.plain_delta(&classes.delta, 1.0) } else { f64::NAN },
            median,
            slides[slides.len() - 1],
        ]
    }

    fn plain_delta(&self, classes: &Partition, part: f64) -> f64 {
        self.distribution.delta(classes, &vec![1.0; self.z.len()], part)
    }

    /// Computes the measures of inputs with these ties and without influence.
    fn by_chance(&self, order: &Order, classes: &Classes) -> Chance {
        let numbers = (0..InputMeasures::PERMUTATIONS).into_par_iter();
        let permutations = numbers.map(|number| {
            let mut random = self.random(1 << 16 | number as u64);
            let mut rows: Vec<usize> = (0..self.z.len()).collect();
            shuffle(&mut rows, &mut random);
            let classes = classes.permuted(&rows);
            let has_finer = number < FINER_PERMUTATIONS && self.wants(Measure::Delta);
            let finer_delta = has_finer.then(|| self.plain_delta(&classes.finer_delta, NARROWER));
            (self.plain(order, &classes, &rows), finer_delta)
        });
        let (measures, finer_deltas): (Vec<[f64; PERMUTED]>, Vec<Option<f64>>) = permutations.unzip();
        let finer_delta = finer_deltas.into_iter().flatten().sum::<f64>() / FINER_PERMUTATIONS as f64;
        Chance { measures, finer_delta }
    }

    /// Corrects delta, where `plain` is the estimate with all of its noise. For an input without influence it is d_0,
    /// the mean over permutations; without it d is sqrt((d^2 - d_0^2)/(1 - d_0^2)), because a deterministic output
    /// has no noise. To this is added what narrower kernels in finer classes find and what they still miss. The interval is
    /// that of resamples of the rows; its upper end includes the error of the correction, or is 1.
    fn delta(&self, classes: &Classes, plain: f64, chance: &Chance, input: u64) -> Estimate {
        let noise = chance.measures.iter().map(|measures| measures[Measure::Delta as usize]).sum::<f64>();
        let noise = noise / chance.measures.len() as f64;
        let wide = without_noise(plain, noise);
        let around = self.half_width(&classes.delta, 1.0, input);
        let narrow = self.plain_delta(&classes.finer_delta, NARROWER);
        let around_narrow = self.half_width(&classes.finer_delta, NARROWER, input);
        let [missed, missed_at_most] =
            [narrow, narrow + around_narrow].map(|narrow| (without_noise(narrow, chance.finer_delta) - wide).max(0.0));
        let estimate = (wide + (1.0 + LEFT) * missed).min(1.0);
        let is_open = missed > (MAX_DIFFERENCE * wide).max(2.0 * around_narrow);
        let error = if is_open { 1.0 } else { libm::hypot(around_narrow, ERROR_OF_CORRECTION * missed) };
        // If an input has an effect, chance adds less than if none has. No delta is above 1.
        let high = (estimate + error).max(wide + (1.0 + LEFT) * missed_at_most).max(plain + around).min(1.0);
        Estimate { estimate, interval: Some(Interval { low: without_noise(plain - around, noise), high }) }
    }

    /// Returns the half width of the interval of delta in these classes, from resamples of the rows.
    fn half_width(&self, classes: &Partition, part: f64, input: u64) -> f64 {
        let numbers = (0..RESAMPLES).into_par_iter();
        let deltas = numbers.map(|number| {
            let mut random = self.random(1 << 24 | input << 8 | number as u64);
            let (rows, mut weights) = (self.z.len(), vec![0.0; self.z.len()]);
            (0..rows).for_each(|_| weights[random.random_range(0..rows as u64) as usize] += 1.0);
            self.distribution.delta(classes, &weights, part)
        });
        let deltas: Vec<f64> = deltas.collect();
        let (count, mean) = (RESAMPLES as f64, deltas.iter().sum::<f64>() / RESAMPLES as f64);
        let squares: f64 = deltas.iter().map(|delta| (delta - mean).powi(2)).sum();
        NORMAL_QUANTILE * (squares / (count - 1.0)).sqrt()
    }
}

/// Returns delta without the `noise` of an input without influence.
fn without_noise(delta: f64, noise: f64) -> f64 {
    let square = delta.clamp(0.0, 1.0).powi(2);
    ((square - noise * noise).max(0.0) / (1.0 - noise * noise).max(f64::MIN_POSITIVE)).sqrt()
}

#[cfg(test)]
mod tests;
