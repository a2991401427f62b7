//! Nets corrected by surrogates of the others, and the estimates from all of them.

use super::contributions::Contributions;
use super::error::in_parts;
use super::estimates::SurrogateEstimates;
use super::influenced::EstimateWithInfluences;
use crate::design::Design;
use crate::effect::IndexPair;
use crate::surrogate::combinations::{Rows, unseen_combinations};
use crate::surrogate::extrapolation::ExtrapolationError;
use crate::surrogate::net::Net;
use crate::surrogate::outputs::{Scale, ScaledOutput};
use crate::surrogate::{Effects, Expansion, Family, leading_terms};
use crate::uncertainty::{PartInfluences, RULE_OF_THREE};

/// Residual share of the variance above which, and effective number of rows in it (three over their kurtosis times
/// their number) below which, corrected intervals must include the plain ones: a fit misses what the runs miss.
const RESIDUAL: f64 = 1e-3;
const MIN_EFFECTIVE_ROWS: f64 = 50.0;

/// Share of the variance above which a factor matters.
const MATTERS: f64 = 0.02;

/// Number of base points corrected at a time if there are more than the surrogates are fitted to.
const CHUNK: usize = 1 << 13;

/// Every net, corrected by a surrogate of the others.
pub(super) struct Corrected {
    nets: Vec<Contributions>,
    pub expansions: Vec<Expansion>,
    extrapolation: ExtrapolationError,
}

impl Corrected {
    /// Corrects the `nets` of `design` by `expansions` in polynomials of `families`.
    pub fn new(
        design: &Design,
        nets: Vec<Contributions>,
        expansions: Vec<Expansion>,
        families: &[Family],
        effects: &Effects,
    ) -> Self {
        let (rest, points) = (mean_square_residual(&nets), design.settings().base_samples);
        let extrapolation = ExtrapolationError::new(&expansions, families, points, rest, effects);
        // Those that have rows are corrected.
        let unseen = RULE_OF_THREE / points as f64;
        let first = expansions.first().into_iter().flat_map(Expansion::varying);
        let extrapolation = extrapolation.with_rare_counts(first, unseen, families, effects);
        Self { nets, expansions, extrapolation }
    }

    /// Adds the error of combinations of levels that none of the `rows`, with the `outputs` of every net, has.
    pub fn with_unseen_levels(self, rows: &[Net], outputs: &ScaledOutput, families: &[Family]) -> Self {
        let runs = rows.iter().enumerate().flat_map(|(k, net)| (0..net.runs()).map(move |run| (k, net, run)));
        let rows = runs.map(|(k, net, run)| Rows {
            quantiles: (0..families.len()).map(|factor| net.quantiles(run, factor)).collect(),
            outputs: &outputs.nets[k].runs[run],
            parts: vec![k; net.points()],
        });
        let rows: Vec<Rows> = rows.collect();
        let terms = self.expansions.iter().flat_map(Expansion::varying);
        let unseen = unseen_combinations(terms, self.residual(), families, &rows);
        Self { extrapolation: self.extrapolation.with_any(unseen), ..self }
    }

    /// Returns the mean square of the residuals.
    pub fn residual(&self) -> f64 {
        mean_square_residual(&self.nets)
    }

    /// Returns the same plus the error that no runs show.
    pub fn unknown(&self) -> f64 {
        self.residual() + self.extrapolation.variance
    }

    /// Returns whether a few rows dominate the residuals, and these matter.
    pub fn is_heavy_tailed(&self) -> bool {
        let two = self.residual();
        let four = self.nets.iter().map(|net| net.residual.1).sum::<f64>() / self.nets.len() as f64;
        let rows: usize = self.nets.iter().map(|net| net.rows).sum();
        // Outputs have variance 1.
        two > RESIDUAL && 3.0 * rows as f64 * two * two < MIN_EFFECTIVE_ROWS * four
    }
}

/// Returns the contributions of the base points below `points`, some of them at a time.
pub(super) fn in_chunks(points: usize, of: impl Fn(std::ops::Range<usize>) -> Contributions) -> Contributions {
    let mut all = of(0..points.min(CHUNK));
    for first in (CHUNK..points).step_by(CHUNK) {
        all.append(of(first..points.min(first + CHUNK)));
    }
    all
}

/// Returns the mean square of the residuals of `nets`.
fn mean_square_residual(nets: &[Contributions]) -> f64 {
    nets.iter().map(|net| net.residual.0).sum::<f64>() / nets.len() as f64
}

/// The contributions of every net, and of every net of a low-fidelity model.
struct AllContributions<'a> {
    nets: &'a [Contributions],
    low: &'a [Contributions],
}

impl AllContributions<'_> {
    /// Returns the mean over all points of a number with the contributions `column`, and its extrapolation error.
    fn mean(&self, extrapolation: f64, column: impl Fn(&Contributions) -> &Vec<f64>) -> EstimateWithInfluences {
        let (mean, parts) = mean_and_influences(self.nets.iter().map(|net| column(net).clone()).collect());
        let (of_low, low) = mean_and_influences(self.low.iter().map(|net| column(net).clone()).collect());
        EstimateWithInfluences { estimate: mean + of_low, parts, low, beyond: extrapolation }
    }

    /// Returns the indices with the contributions `columns`, which have the same error `of_any`.
    fn indices(
        &self,
        variance: &EstimateWithInfluences,
        extrapolation: &[f64],
        of_any: f64,
        columns: impl Fn(&Contributions) -> &[Vec<f64>],
    ) -> Vec<EstimateWithInfluences> {
        let errors = extrapolation.iter().enumerate();
        let indices = errors.map(|(k, &error)| self.mean(error, |net| &columns(net)[k]).over(variance));
        indices.map(|index| EstimateWithInfluences { beyond: index.beyond + of_any, ..index }).collect()
    }
}

/// Returns the mean of all `columns`, one for each net, and the influences of their parts.
fn mean_and_influences(columns: Vec<Vec<f64>>) -> (f64, PartInfluences) {
    let count: usize = columns.iter().map(Vec::len).sum();
    let mean = columns.iter().flatten().sum::<f64>() / count.max(1) as f64;
    let mut parts = in_parts(&columns);
    parts.iter_mut().flatten().for_each(|x| *x -= mean);
    (mean, parts)
}

/// Returns the means over all points with the influences of each part; adds those of `low`, a low-fidelity model.
pub(super) fn estimates(corrected: &Corrected, low: &[Contributions], Scale { mean, sd }: Scale) -> SurrogateEstimates {
    let Corrected { nets, expansions, extrapolation } = corrected;
    let all = AllContributions { nets, low };
    let variance = all.mean(extrapolation.variance, |net| &net.variance);
    let scaled_mean = all.mean(extrapolation.mean, |net| &net.mean);
    let of_any = extrapolation.of_any / variance.estimate.min(1.0);
    let [first, second] =
        [0, 1].map(|form| all.indices(&variance, &extrapolation.total, of_any, |net| &net.total[form]));
    let weight = weight_of_second(&first, &second);
    let total =
        first.iter().zip(&second).map(|(a, b)| EstimateWithInfluences::combined(&[(1.0 - weight, a), (weight, b)]));
    let first_order = all.indices(&variance, &extrapolation.first_order, of_any, |net| &net.first_order);
    let effects = first_order.into_iter().zip(total).map(|(first_order, total)| IndexPair { first_order, total });
    SurrogateEstimates {
        effects: effects.collect(),
        pairs: all.indices(&variance, &extrapolation.pairs, of_any, |net| &net.pairs),
        mean: EstimateWithInfluences::linear(mean + sd * scaled_mean.estimate, &[(sd, &scaled_mean)]),
        explained: 1.0 - corrected.residual() / variance.estimate,
        is_heavy_tailed: corrected.is_heavy_tailed(),
        fitted: None,
        misses_levels: false,
        growth: growth(nets),
        terms: leading_terms(expansions, variance.estimate),
        term_count: expansions.iter().map(|e| e.terms.len() as f64).sum::<f64>() / expansions.len() as f64,
        variance: EstimateWithInfluences::linear(sd * sd * variance.estimate, &[(sd * sd, &variance)]),
        low: None,
    }
}

/// Returns the largest ratio of the claimed variance to that over the rows, for all factors and those that matter.
fn growth(nets: &[Contributions]) -> f64 {
    let count = nets.iter().map(|net| net.claims.len()).min().unwrap_or(0);
    let mut sums = vec![[0.0; 2]; count];
    for net in nets {
        for (sum, claim) in sums.iter_mut().zip(&net.claims) {
            *sum = [sum[0] + claim.claimed, sum[1] + claim.shown];
        }
    }
    // The last one is that of all factors.
    let all = sums.last().map_or(0.0, |[claimed, _]| *claimed);
    let matters = sums.iter().filter(|[claimed, _]| *claimed > MATTERS * all);
    matters.map(|[claimed, shown]| claimed / shown).fold(0.0, f64::max)
}

/// Returns the weight of the second form of the total indices with the least spread within the nets, over all swaps.
fn weight_of_second(first: &[EstimateWithInfluences], second: &[EstimateWithInfluences]) -> f64 {
    let (mut covariance, mut variance) = (0.0, 0.0);
    for (a, b) in first.iter().zip(second) {
        for (a, b) in a.parts.iter().chain(&a.low).zip(b.parts.iter().chain(&b.low)) {
            let n = a.len() as f64;
            let (mean_a, mean_b) = (a.iter().sum::<f64>() / n, b.iter().sum::<f64>() / n);
            for (a, b) in a.iter().zip(b) {
                let difference = (b - mean_b) - (a - mean_a);
                covariance += difference * (a - mean_a);
                variance += difference * difference;
            }
        }
    }
    if variance > 0.0 { (-covariance / variance).clamp(0.0, 1.0) } else { 0.0 }
}
