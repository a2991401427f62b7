//! SALib's estimators, with a bootstrap over base points.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

use super::layout::SalibLayout;
use crate::given::{NoVariance, centred};
use crate::sum::sum_by;
use crate::uncertainty::{Estimate, Interval, quantile};

/// First-order and total index.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SalibIndex {
    /// S1: Saltelli et al. (2010), table 2 (b).
    pub first_order: Estimate,
    /// ST: Jansen (1999), table 2 (f) of Saltelli et al. (2010).
    pub total: Estimate,
}

/// Second-order index of two inputs or groups.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairIndex {
    /// Their numbers, the smaller one first.
    pub pair: (usize, usize),
    /// S2: Saltelli (2002), the closed index less both first-order indices.
    pub second_order: Estimate,
}

/// The indices of an output.
#[derive(Debug, Clone, PartialEq)]
pub struct SalibIndices {
    /// One for each input or group.
    pub indices: Vec<SalibIndex>,
    /// One for each pair; none without second order.
    pub pairs: Vec<PairIndex>,
}

/// Outputs by the rows of their base points, one vector for each.
struct Rows {
    a: Vec<f64>,
    b: Vec<f64>,
    ab: Vec<Vec<f64>>,
    ba: Vec<Vec<f64>>,
}

/// Indices of the output `y`, one value per row in `layout`, of `d` inputs or groups, as SALib's `analyze.sobol` has them:
/// outputs are centred by the mean of all rows, the variance is that of A and B together.
///
/// Intervals are percentiles (2.5 % and 97.5 %) of `resamples` resamples of the base points, with random streams of
/// `seed`; none with fewer than 2 resamples. They hold for random points; for Sobol' points they are too wide.
///
/// ```
/// use apportion::salib::{SalibLayout, salib_indices};
///
/// // y = x1 + 2 x2 at two base points: rows A, AB_1, AB_2, B of each.
/// let y = [0.1 + 0.4, 0.9 + 0.4, 0.1 + 1.2, 0.9 + 1.2, 0.7 + 1.6, 0.3 + 1.6, 0.7 + 0.2, 0.3 + 0.2];
/// let indices = salib_indices(&y, 2, SalibLayout::FirstOrder, 0, 0)?;
/// assert_eq!(indices.indices.len(), 2);
/// # Ok::<(), apportion::given::NoVariance>(())
/// ```
///
/// # Errors
/// [`NoVariance`] if the output does not vary.
pub fn salib_indices(
    y: &[f64],
    d: usize,
    layout: SalibLayout,
    resamples: usize,
    seed: u64,
) -> Result<SalibIndices, NoVariance> {
    let y = centred(y)?;
    let step = layout.rows_per_point(d);
    let row = |row: usize| -> Vec<f64> { y.iter().copied().skip(row).step_by(step).collect() };
    let ba = if layout == SalibLayout::SecondOrder { (0..d).map(|j| row(1 + d + j)).collect() } else { Vec::new() };
    let rows = Rows { a: row(0), b: row(step - 1), ab: (0..d).map(|j| row(1 + j)).collect(), ba };
    let n = rows.a.len();
    let all: Vec<usize> = (0..n).collect();
    let estimates = rows.indices(&all);
    if estimates.iter().any(|estimate| !estimate.is_finite()) {
        return Err(NoVariance::Constant);
    }
    let random = ChaCha8Rng::seed_from_u64(seed);
    let resampled: Vec<Vec<f64>> = (0..resamples)
        .into_par_iter()
        .map(|number| {
            let mut stream = random.clone();
            stream.set_stream(number as u64);
            let draw = |_| ((u128::from(stream.next_u64()) * n as u128) >> u64::BITS) as usize;
            rows.indices(&(0..n).map(draw).collect::<Vec<_>>())
        })
        .collect();
    let with_interval = |number: usize| {
        // A resample whose outputs do not vary says nothing.
        let mut values: Vec<f64> = resampled.iter().map(|r| r[number]).filter(|value| value.is_finite()).collect();
        values.sort_unstable_by(f64::total_cmp);
        let bounds = || Interval { low: quantile(&values, 0.025), high: quantile(&values, 0.975) };
        Estimate { estimate: estimates[number], interval: (values.len() > 1).then(bounds) }
    };
    let indices = (0..d).map(|j| SalibIndex { first_order: with_interval(j), total: with_interval(d + j) }).collect();
    let pairs = pairs(if rows.ba.is_empty() { 0 } else { d }).enumerate();
    let pairs = pairs.map(|(place, pair)| PairIndex { pair, second_order: with_interval(2 * d + place) }).collect();
    Ok(SalibIndices { indices, pairs })
}

/// All pairs of `d`, in SALib's order.
fn pairs(d: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..d).flat_map(move |j| (j + 1..d).map(move |k| (j, k)))
}

/// Mean of `of` over the base points `drawn`.
fn mean(drawn: &[usize], of: impl Fn(usize) -> f64) -> f64 {
    sum_by(drawn.len(), |i| of(drawn[i])) / drawn.len() as f64
}

impl Rows {
    /// First-order indices, total indices, then second-order indices, from the base points `drawn`; not finite if the
    /// outputs of A and B do not vary there.
    fn indices(&self, drawn: &[usize]) -> Vec<f64> {
        let (a, b) = (&self.a, &self.b);
        let middle = mean(drawn, |i| (a[i] + b[i]) / 2.0);
        let variance = mean(drawn, |i| ((a[i] - middle).powi(2) + (b[i] - middle).powi(2)) / 2.0);
        let first: Vec<f64> = self.ab.iter().map(|ab| mean(drawn, |i| b[i] * (ab[i] - a[i])) / variance).collect();
        let total = self.ab.iter().map(|ab| mean(drawn, |i| (a[i] - ab[i]).powi(2)) / 2.0 / variance);
        let second = pairs(self.ba.len()).map(|(j, k)| {
            let (ba, ab) = (&self.ba[j], &self.ab[k]);
            mean(drawn, |i| ba[i] * ab[i] - a[i] * b[i]) / variance - first[j] - first[k]
        });
        let (total, second): (Vec<f64>, Vec<f64>) = (total.collect(), second.collect());
        [first, total, second].concat()
    }
}
