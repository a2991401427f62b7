//! Other measures of influence than the share of the variance, from the same table.
//!
//! They look at more of an output than its variance, or ask for less: whether an input has any influence at all. None of them
//! divides a whole among the inputs, and none tells interactions from what an input does alone.

mod density;
mod distances;
mod fourier;
mod hsic;
mod twin;

use std::collections::BTreeMap;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

use super::column::{Column, NoVariance};
use super::order::Order;
use super::{GivenIndices, PointSet, centred};
use crate::space::normal_scores;
use crate::uncertainty::{Estimate, Interval, NORMAL_QUANTILE};
use density::Densities;
use distances::{Distance, distances};
pub use hsic::MOST_ROWS as MOST_ROWS_OF_KERNELS;
use twin::Twin;

/// A measure of the influence of an input on an output.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Measure {
    /// First-order index from the spectrum of the output in the order of the input: EASI, Plischke (2010), Reliab. Eng. Syst. Saf.
    /// 95, 354-360, and RBD-FAST of given data, with the correction of Tissot and Prieur (2012). An estimate of S_1.
    Fourier,
    /// Borgonovo's (2007) delta: half of the mean distance between the density of the output and its densities where the input
    /// is known. From kernel densities in classes of the input, less the bias by a bootstrap: Plischke, Borgonovo and Smith
    /// (2013), Eur. J. Oper. Res. 226, 536-550.
    Delta,
    /// The mean over classes of the input of the largest distance between the distribution functions of the output in the class
    /// and overall: Baucells and Borgonovo (2013), Manage. Sci. 59, 2536-2549.
    Kolmogorov,
    /// The same of the sum of the largest distances above and below, after Kuiper.
    Kuiper,
    /// The median over ten classes of the input of the distance of Kolmogorov and Smirnov: PAWN, Pianosi and Wagener (2018),
    /// Environ. Model. Softw. 108, 197-207.
    PawnMedian,
    /// The largest of them.
    PawnMax,
    /// The criterion of independence of Hilbert and Schmidt with Gaussian kernels, normalised (R2-HSIC): Gretton et al. (2005); Da
    /// Veiga (2015), J. Stat. Comput. Simul. 85, 1283-1305.
    Hsic,
}

impl Measure {
    /// All of them.
    pub const ALL: [Self; 7] =
        [Self::Fourier, Self::Delta, Self::Kolmogorov, Self::Kuiper, Self::PawnMedian, Self::PawnMax, Self::Hsic];

    /// The name in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fourier => "fourier",
            Self::Delta => "delta",
            Self::Kolmogorov => "kolmogorov",
            Self::Kuiper => "kuiper",
            Self::PawnMedian => "pawn_median",
            Self::PawnMax => "pawn_max",
            Self::Hsic => "r2_hsic",
        }
    }

    /// The name in tables.
    pub fn heading(self) -> &'static str {
        match self {
            Self::Fourier => "S_1, Fourier",
            Self::Delta => "delta",
            Self::Kolmogorov => "Kolmogorov",
            Self::Kuiper => "Kuiper",
            Self::PawnMedian => "PAWN median",
            Self::PawnMax => "PAWN max",
            Self::Hsic => "R2-HSIC",
        }
    }
}

/// A measure of one input.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Measured {
    /// The measure, with its interval where it has one: of delta, of independent rows and those of a run.
    pub estimate: Estimate,
    /// The probability of a measure so large, or larger, of an input without influence; `None` where rows are not independent draws
    /// (those of nets and Latin hypercubes are spread more evenly, and p-values would be far too large there), or the input has
    /// one value. By [`PERMUTATIONS`] permutations of the output, of the kernels by a gamma distribution (Gretton
    /// et al. 2008).
    pub p_value: Option<f64>,
}

/// The measures of one input, in the order of [`Measure::ALL`].
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct InputMeasures {
    /// The input.
    pub input: String,
    /// One entry per measure; NaN where it was not asked for, and of the kernels where the input or the output has one value in
    /// the rows that they look at.
    pub values: [Measured; 7],
}

impl InputMeasures {
    /// One of them.
    pub fn get(&self, measure: Measure) -> Measured {
        self.values[measure as usize]
    }
}

/// Permutations behind a p-value: it is known to 0.005 at best.
pub const PERMUTATIONS: usize = 199;

/// p-values below this are taken for influence.
const LEVEL: f64 = 0.05;

/// Resamples behind the bias and the interval of delta, and tables of its twin.
const RESAMPLES: usize = 100;

/// Of the kernels that show what wider ones in half as many classes do not: the part of their width.
const NARROWER: f64 = 0.5;
/// What they do not show either, in parts of the difference: as much again, where errors fall in proportion to the width.
const LEFT: f64 = 1.0;

/// Classes of PAWN.
const PAWN_CLASSES: usize = 10;

/// What is measured by permutations: all but the kernels.
const PERMUTED: usize = 6;

/// The measures of every output with respect to every input, of the columns that gave `indices`.
///
/// Costs O(N log N) for each input and permutation, and O(N^2) for the kernels, of at most [`MOST_ROWS_OF_KERNELS`] rows, a
/// random part of a larger table. `seed` is that of these rows, permutations, resamples, and the order of equal inputs in the
/// spectrum.
pub fn measures(
    inputs: &[Column],
    outputs: &[Column],
    indices: &GivenIndices,
    seed: u64,
) -> Vec<Result<Vec<InputMeasures>, NoVariance>> {
    let orders: Vec<Order> = inputs.iter().map(|input| Order::of(&input.values)).collect();
    let is_random = indices.points == PointSet::Independent;
    let of_output = |(number, output): (usize, &Column)| {
        let z = centred(&output.values)?;
        let job = Job::new(&z, &Measure::ALL, [seed, number as u64]);
        Ok(job.measures(inputs, &orders, Known { has_p_values: is_random, has_intervals: is_random }))
    };
    outputs.iter().enumerate().map(of_output).collect()
}

/// The measures `wanted` of one output with respect to every input, of rows that are known to be draws from the distributions of the
/// inputs: with the intervals of delta, which were measured to hold of nets and Latin hypercubes too (docs/coverage-measures.md), and
/// with p-values if they are `independent` draws. Measures that are not wanted are NaN.
pub(crate) fn measures_of_rows(
    inputs: &[Column],
    output: &[f64],
    wanted: &[Measure],
    seed: [u64; 2],
    independent: bool,
) -> Result<Vec<InputMeasures>, NoVariance> {
    let z = centred(output)?;
    let orders: Vec<Order> = inputs.iter().map(|input| Order::of(&input.values)).collect();
    let known = Known { has_p_values: independent, has_intervals: true };
    Ok(Job::new(&z, wanted, seed).measures(inputs, &orders, known))
}

/// What the rows say beside the measures themselves.
#[derive(Clone, Copy)]
struct Known {
    has_p_values: bool,
    /// Of delta.
    has_intervals: bool,
}

/// One output.
struct Job<'a> {
    wanted: &'a [Measure],
    z: &'a [f64],
    order: Order,
    /// Normal scores of the outputs: delta does not change when the output is bent, and its kernels need tails that are short.
    scores: Vec<f64>,
    densities: Densities,
    seed: [u64; 2],
}

/// Classes of the rows by one input.
struct Classes {
    /// The class of every row, and how many there are.
    fine: (Vec<usize>, usize),
    /// Twice as many.
    finer: (Vec<usize>, usize),
    /// Those of PAWN.
    coarse: (Vec<usize>, usize),
}

impl Classes {
    fn new(order: &Order, rows: usize) -> Self {
        let count = classes_for(rows);
        Self { fine: order.classes(count), finer: order.classes(2 * count), coarse: order.classes(PAWN_CLASSES) }
    }

    /// The classes with the rows in another order.
    fn permuted(&self, rows: &[usize]) -> Self {
        let permuted = |(labels, count): &(Vec<usize>, usize)| (rows.iter().map(|&row| labels[row]).collect(), *count);
        Self { fine: permuted(&self.fine), finer: permuted(&self.finer), coarse: permuted(&self.coarse) }
    }

    /// What the measures of an input without influence depend on.
    fn sizes(&self) -> [Vec<usize>; 2] {
        [&self.fine, &self.coarse].map(|(labels, count)| {
            let mut sizes = vec![0; *count];
            labels.iter().for_each(|&label| sizes[label] += 1);
            sizes
        })
    }
}

/// Classes for delta and the mean distances (Plischke, Borgonovo and Smith 2013, as in SALib): at most 48.
fn classes_for(rows: usize) -> usize {
    let rows = rows as f64;
    let power = 2.0 / (7.0 + libm::tanh((1500.0 - rows) / 500.0));
    (libm::pow(rows, power).ceil() as usize).min(48)
}

impl<'a> Job<'a> {
    fn new(z: &'a [f64], wanted: &'a [Measure], seed: [u64; 2]) -> Self {
        let order = Order::of(z);
        let scores = centred_scores(&order);
        Self { wanted, z, order, densities: Densities::new(&scores), scores, seed }
    }

    fn wants(&self, measure: Measure) -> bool {
        self.wanted.contains(&measure)
    }

    fn random(&self, stream: u64) -> ChaCha8Rng {
        let mut random = ChaCha8Rng::seed_from_u64(self.seed[0]);
        random.set_stream(self.seed[1] << 32 | stream);
        random
    }

    fn measures(&self, inputs: &[Column], orders: &[Order], known: Known) -> Vec<InputMeasures> {
        let classes: Vec<Classes> = orders.iter().map(|order| Classes::new(order, self.z.len())).collect();
        let mut chance: BTreeMap<[Vec<usize>; 2], Vec<[f64; PERMUTED]>> = BTreeMap::new();
        let has_interval = known.has_intervals && self.wants(Measure::Delta);
        // An interval asks what chance does too.
        if known.has_p_values || has_interval {
            for classes in &classes {
                chance.entry(classes.sizes()).or_insert_with(|| self.by_chance(classes));
            }
        }
        let outputs = if self.wants(Measure::Hsic) { hsic::Outputs::new(self.z, self.seed[0]) } else { None };
        let of_input = |number: usize| {
            let (classes, order) = (&classes[number], &orders[number]);
            let values = match order.groups() {
                0 | 1 => [Measured { estimate: Estimate { estimate: 0.0, interval: None }, p_value: None }; 7],
                _ => {
                    let rows = order.shuffled(self.seed[0], number as u64);
                    let chance = chance.get(&classes.sizes()).map_or(&[][..], Vec::as_slice);
                    let mut values = self.judged(self.plain(classes, &rows), chance);
                    if has_interval {
                        let delta = &mut values[Measure::Delta as usize];
                        delta.estimate = self.delta(classes, &order.centred_ranks(), number as u64);
                        if let (Some(interval), Some(LEVEL..)) = (&mut delta.estimate.interval, delta.p_value) {
                            // What is not told from chance may be nothing.
                            interval.low = interval.low.min(0.0);
                        }
                    }
                    let kernels = outputs.as_ref().and_then(|outputs| outputs.with(&inputs[number].values));
                    let (r2, p_value) = kernels.unwrap_or((f64::NAN, None));
                    let estimate = Estimate { estimate: r2, interval: None };
                    values[Measure::Hsic as usize] = Measured { estimate, p_value };
                    if !known.has_p_values {
                        values.iter_mut().for_each(|measured| measured.p_value = None);
                    }
                    values
                }
            };
            let unasked = Measured { estimate: Estimate { estimate: f64::NAN, interval: None }, p_value: None };
            let of_measure = |measure: Measure| if self.wants(measure) { values[measure as usize] } else { unasked };
            let values = Measure::ALL.map(of_measure);
            InputMeasures { input: inputs[number].name.clone(), values }
        };
        (0..inputs.len()).into_par_iter().map(of_input).collect()
    }

    /// All but the kernels, of the rows in the order of the input.
    fn plain(&self, classes: &Classes, rows: &[usize]) -> [f64; PERMUTED] {
        let weights = vec![1.0; self.z.len()];
        let fine = distances(&self.order, &classes.fine, &weights);
        let coarse = distances(&self.order, &classes.coarse, &weights);
        let mean = |of: fn(&Distance) -> f64| {
            let sum: f64 = fine.iter().map(|distance| distance.weight * of(distance)).sum();
            sum / self.z.len() as f64
        };
        let mut slides: Vec<f64> = coarse.iter().map(Distance::kolmogorov).collect();
        slides.sort_by(f64::total_cmp);
        let middle = slides.len() / 2;
        let median = if slides.len() % 2 == 1 { slides[middle] } else { (slides[middle - 1] + slides[middle]) / 2.0 };
        [
            fourier::first_order(rows.iter().map(|&row| self.z[row]).collect()),
            if self.wants(Measure::Delta) {
                self.densities.delta(&self.scores, &classes.fine, &weights, 1.0)
            } else {
                f64::NAN
            },
            mean(Distance::kolmogorov),
            mean(Distance::kuiper),
            median,
            slides[slides.len() - 1],
        ]
    }

    /// The measures of inputs with such classes and without influence.
    fn by_chance(&self, classes: &Classes) -> Vec<[f64; PERMUTED]> {
        let permutation = |number: usize| {
            let mut random = self.random(1 << 16 | number as u64);
            let mut rows: Vec<usize> = (0..self.z.len()).collect();
            for k in (1..rows.len()).rev() {
                rows.swap(k, random.random_range(0..=k as u64) as usize);
            }
            self.plain(&classes.permuted(&rows), &rows)
        };
        (0..PERMUTATIONS).into_par_iter().map(permutation).collect()
    }

    fn judged(&self, found: [f64; PERMUTED], chance: &[[f64; PERMUTED]]) -> [Measured; 7] {
        std::array::from_fn(|place| {
            let Some(&found) = found.get(place) else {
                return Measured { estimate: Estimate { estimate: 0.0, interval: None }, p_value: None };
            };
            let larger = chance.iter().filter(|by_chance| by_chance[place] >= found).count();
            let p_value = (!chance.is_empty()).then(|| (1 + larger) as f64 / (1 + chance.len()) as f64);
            Measured { estimate: Estimate { estimate: found, interval: None }, p_value }
        })
    }

    /// Delta less its bias by resamples of the rows (Plischke et al. 2013). Its interval is that of the resamples and that of
    /// tables of a [`Twin`], whose delta is known, together: it reaches from the lower end of both to the upper one, and as high as
    /// narrower kernels in finer classes say, and what they leave.
    fn delta(&self, classes: &Classes, ranks: &[f64], input: u64) -> Estimate {
        let (z, rows) = (&self.scores[..], self.z.len());
        let ones = vec![1.0; rows];
        let resampled = |classes: &(Vec<usize>, usize), part: f64| {
            let plain = self.densities.delta(z, classes, &ones, part);
            let resample = |number: usize| {
                let mut random = self.random(1 << 24 | input << 8 | number as u64);
                let mut weights = vec![0.0; rows];
                (0..rows).for_each(|_| weights[random.random_range(0..rows as u64) as usize] += 1.0);
                self.densities.delta(z, classes, &weights, part)
            };
            let (mean, half_width) = moments(&(0..RESAMPLES).into_par_iter().map(resample).collect::<Vec<f64>>());
            (plain, 2.0 * plain - mean, half_width)
        };
        let (plain, estimate, half_width) = resampled(&classes.fine, 1.0);
        let mut interval = Interval { low: estimate - half_width, high: estimate + half_width };
        let (_, finer, half_width) = resampled(&classes.finer, NARROWER);
        interval.high = interval.high.max(finer + LEFT * (finer - estimate) + half_width);
        if let Some(twin) = Twin::new(z, ranks, &classes.fine) {
            let of_table = |number: usize| {
                let outputs = twin.outputs(&mut self.random(1 << 26 | input << 8 | number as u64));
                Densities::new(&outputs).delta(&outputs, &classes.fine, &ones, 1.0)
            };
            let (mean, half_width) = moments(&(0..RESAMPLES).into_par_iter().map(of_table).collect::<Vec<f64>>());
            let unbiased = plain - (mean - twin.delta());
            interval.low = interval.low.min(unbiased - half_width);
            interval.high = interval.high.max(unbiased + half_width);
        }
        // No delta is above 1.
        interval.high = interval.high.min(1.0).max(estimate);
        Estimate { estimate, interval: Some(interval) }
    }
}

/// The quantile of the normal distribution at the middle of each row's place among all; equal rows share the middle of theirs.
fn centred_scores(order: &Order) -> Vec<f64> {
    let ranks = order.centred_ranks();
    let rows = ranks.len() as f64;
    normal_scores(&ranks.iter().map(|rank| rank / rows + 0.5).collect::<Vec<f64>>())
}

/// The mean of what resamples gave, and the half width of the interval of one of them.
fn moments(resampled: &[f64]) -> (f64, f64) {
    let count = resampled.len() as f64;
    let mean = resampled.iter().sum::<f64>() / count;
    let squares: f64 = resampled.iter().map(|delta| (delta - mean).powi(2)).sum();
    (mean, NORMAL_QUANTILE * (squares / (count - 1.0)).sqrt())
}

#[cfg(test)]
mod tests;
