//! The output over its most influential factors: some points for plots, and the means over slices of each factor.

use super::first_rows::FirstRows;
use crate::design::Design;
use crate::result::{ConditionalMeansRecord, Named, ScatterRecord};
use crate::space::{Distribution, Factor, Space};
use crate::uncertainty::EffectEstimates;
use apportion_base::quantity::Unit;
use apportion_base::sum::{centred_product, mean, rescaled};

/// Number of factors.
const FACTORS: usize = 6;
/// Maximum number of points kept for plots.
const POINTS: usize = 400;
/// Slices of equal probability of a continuous factor.
const SLICES: usize = 20;
/// Maximum number of values of a discrete factor that get a slice each.
const MAX_VALUES: usize = 50;
/// Maximum number of base points for the means, over all replicates.
const MAX_ROWS: u64 = 1 << 14;
/// Minimum number of them, for any number of columns of the design.
const MIN_ROWS: u64 = 1 << 10;
/// Numbers of the design that are computed again for the means, in addition to [`MIN_ROWS`] points.
const NUMBERS: u64 = 1 << 18;
/// Half width of a 95 % interval of a mean of many values, in standard errors.
const QUANTILE: f64 = 1.96;

/// Returns the rows for scatters: fewer for many factors, to limit the time.
pub(super) fn rows_of_scatter(design: &Design) -> FirstRows {
    FirstRows::new(design, (NUMBERS / design.columns().max(1) as u64).clamp(MIN_ROWS, MAX_ROWS))
}

/// Computes the scatter of an output in `unit`, of which every replicate has kept `samples`, for the factors with the
/// largest of `indices`; `rows` are the first of its design. `None` if a number exceeds double precision in its unit.
pub(super) fn scatter_record(
    rows: &FirstRows,
    space: &Space,
    (unit, samples): (&Unit, &[&Vec<f64>]),
    indices: &[Named<EffectEstimates>],
) -> Option<ScatterRecord> {
    let factors = space.factors();
    let inputs: Vec<usize> = (0..factors.len()).filter(|number| Some(*number) != space.noise()).collect();
    let chosen: Vec<usize> = largest(indices).into_iter().map(|place| inputs[place]).collect();
    let points = rows.first(POINTS, samples).into_iter().map(|(u, y)| {
        let x = chosen.iter().map(|&factor| factors[factor].distribution().quantile(u[factor]));
        x.chain([unit.from_si(y)]).collect::<Vec<_>>()
    });
    let all = rows.outputs(samples);
    let finite: Vec<f64> = all.iter().copied().filter(|y| y.is_finite()).collect();
    let (scaled, exponent) = rescaled(&finite);
    let mut conditional_means = Vec::with_capacity(chosen.len());
    for &factor in &chosen {
        let coordinates = rows.coordinates(factor).zip(&all).filter(|(_, y)| y.is_finite());
        let rows: Vec<(f64, f64)> = coordinates.map(|(u, _)| u).zip(scaled.iter().copied()).collect();
        conditional_means.push(means_over_slices(&factors[factor], unit, &rows, exponent));
    }
    let record = ScatterRecord {
        factors: chosen.iter().map(|&factor| factors[factor].name.clone()).collect(),
        points: points.collect(),
        conditional_means,
    };
    let numbers = record.points.iter().flatten();
    let means = record.conditional_means.iter();
    let means = means.flat_map(|m| m.mean.iter().chain(&m.low).chain(&m.high).flatten());
    numbers.chain(means).all(|number| number.is_finite()).then_some(record)
}

/// Returns the indices of the factors with the largest total indices, the largest first.
fn largest(indices: &[Named<EffectEstimates>]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..indices.len()).collect();
    order.sort_by(|&a, &b| indices[b].effect.total.estimate.total_cmp(&indices[a].effect.total.estimate));
    order.truncate(FACTORS);
    order
}

/// Returns the values of a discrete factor, if they are so few that each gets a slice.
fn values_of_slices(distribution: &Distribution) -> Option<Vec<f64>> {
    let values: Vec<f64> = match distribution {
        Distribution::Constant(_) => vec![distribution.median()],
        other => other.levels()?.into_iter().map(|(value, _)| value).collect(),
    };
    (1..=MAX_VALUES).contains(&values.len()).then_some(values)
}

/// Computes means over slices of equal probability, or over one for each value; `rows` are (coordinate, output times
/// 2^-exponent), for outputs with a value.
fn means_over_slices(factor: &Factor, unit: &Unit, rows: &[(f64, f64)], exponent: i32) -> ConditionalMeansRecord {
    let distribution = factor.distribution();
    let by_value = values_of_slices(distribution);
    let mut slices = vec![Vec::new(); by_value.as_ref().map_or(SLICES, Vec::len)];
    let last = slices.len() - 1;
    for &(u, y) in rows {
        let slice = match &by_value {
            Some(values) => {
                let value = distribution.quantile(u);
                values.partition_point(|v| *v < value)
            }
            None => (u * SLICES as f64) as usize,
        };
        slices[slice.min(last)].push(y);
    }
    let medians = (0..SLICES).map(|k| distribution.quantile((k as f64 + 0.5) / SLICES as f64));
    let x = by_value.unwrap_or_else(|| medians.collect());
    let mut record = ConditionalMeansRecord { factor: factor.name.clone(), x, ..ConditionalMeansRecord::default() };
    for values in &slices {
        let (n, mean) = (values.len() as f64, mean(values));
        let half = QUANTILE * (centred_product((values, mean), (values, mean)) / (n - 1.0) / n).sqrt();
        let [mean, low, high] = [mean, mean - half, mean + half].map(|y| unit.from_si(libm::scalbn(y, exponent)));
        record.mean.push((n > 0.0).then_some(mean));
        record.low.push((n > 1.0).then_some(low));
        record.high.push((n > 1.0).then_some(high));
    }
    record
}

#[cfg(test)]
#[path = "tests/scatter.rs"]
mod tests;
