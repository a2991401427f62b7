//! Indices corrected by surrogates.
//!
//! A sparse polynomial chaos expansion is fitted to the runs of all nets but one, and corrects the indices of that one
//! ([`crate::correction`]): exact for the part of the output that the expansion explains, pick-freeze for the rest. No net is
//! corrected by an expansion fitted to it: a poor surrogate costs accuracy, but intervals stay valid.

pub(crate) mod basis;
pub(crate) mod extrapolation;
pub(crate) mod fit;
pub(crate) mod gram;
mod identifiable;
mod knots;
pub(crate) mod low_fidelity;
mod many_outputs;
pub(crate) mod net;
mod orthogonal;
mod outputs;

pub use basis::{Caps, Family};
use basis::{Term, add_to, first_terms};
use extrapolation::ExtrapolationError;
pub use fit::Expansion;
use fit::{MAX_ROUNDS, NetSums, Training, fit, selection_rows, without};
use identifiable::IdentifiableTerms;
use many_outputs::fit_outputs;
pub(crate) use many_outputs::surrogates_together;
pub use net::Net;
use outputs::{Scale, ScaledOutput};
use rayon::prelude::*;

use crate::correction::{
    ChosenTerms, Contributions, Effects, EstimateWithInfluences, SurrogateEstimates, SurrogateTerm, in_parts,
};
use crate::design::{Design, Sampler};
use crate::effect::{IndexPair, Layout};
use crate::estimate::PointOutputs;
use crate::space::Space;
use crate::uncertainty::PartInfluences;

/// Minimum number of nets: the number of terms of a surrogate of the others is chosen by leaving out one of them.
pub(crate) const MIN_NETS: usize = 3;

/// Minimum number of base points of a net.
const MIN_POINTS: usize = 4;

/// The same if each has plain rows, which are more informative than rows of a base point that share their columns.
const MIN_POINTS_WITH_PLAIN_ROWS: usize = 2;

/// Maximum sum of degrees of Hermite polynomials in a term. Those of high degree are large where there are hardly any
/// rows: few rows determine their coefficients, and no row shows their behaviour beyond.
const SAFE_HERMITE_DEGREES: usize = 4;

/// The same if this reduces the residuals of the other runs clearly, as for powers and exponentials.
const MAX_HERMITE_DEGREES: usize = 10;

/// The ratio that counts as clearly less.
const CLEARLY_LESS: f64 = 0.25;

/// Residual share of the variance above which, and effective number of rows in it (three over their kurtosis times
/// their number) below which, corrected intervals must include the plain ones: a fit misses what the runs miss.
const RESIDUAL: f64 = 1e-3;
const MIN_EFFECTIVE_ROWS: f64 = 50.0;

/// Share of the variance above which a factor matters.
const MATTERS: f64 = 0.02;

/// Maximum number of rows of all nets together to which surrogates are fitted: more hardly change the coefficients of
/// about a hundred terms, and the residuals of an expansion are computed from all rows.
pub(crate) const MAX_FITTED_ROWS: u64 = 1 << 16;

/// Number of base points corrected at a time if there are more than the surrogates are fitted to.
const CHUNK: usize = 1 << 13;

/// Number of terms that are reported.
const MAX_LEADING_TERMS: usize = 12;

/// Returns the polynomials of every factor of `space`.
pub(crate) fn families(space: &Space) -> Vec<Family> {
    space.factors().iter().map(|factor| Family::new(factor.distribution())).collect()
}

/// Estimates the indices of `layout` from the outputs of every run of `design`, corrected by surrogates, in the terms
/// that a longer run has `chosen` if there is one; `None` if there are too few nets or points, the points are not
/// Sobol' nets, or an output has no variance.
pub(crate) fn surrogate_estimates(
    design: &Design,
    families: &[Family],
    layout: &Layout,
    replicates: &[&PointOutputs],
    chosen: Option<&ChosenTerms>,
) -> Option<SurrogateEstimates> {
    if !takes_surrogates(design, replicates.len()) {
        return None;
    }
    let output = ScaledOutput::new(replicates, design.runs().len(), None)?;
    fit_outputs(design, families, layout, &output.complete_points(), &[&output], chosen).pop().flatten()
}

/// Returns whether there are enough nets, and the points are nets.
fn takes_surrogates(design: &Design, replicates: usize) -> bool {
    design.settings().sampler != Sampler::LatinHypercube && replicates >= MIN_NETS
}

/// Returns the minimum number of base points of a net of `design` to which surrogates are fitted.
pub(crate) fn fewest_points(design: &Design) -> usize {
    if design.plain_rows() > 0 { MIN_POINTS_WITH_PLAIN_ROWS } else { MIN_POINTS }
}

/// A set of polynomials to try.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Trial {
    /// The polynomials of every factor.
    pub families: Vec<Family>,
    /// Maximum sum of degrees of Hermite polynomials in a term.
    pub hermite_degree: usize,
    /// Maximum ratio of its residual to that of the best previous trial for which it is preferred.
    pub ratio: f64,
}

/// Returns the trials for factors with the polynomials `families`, in order.
pub(crate) fn trials(families: &[Family]) -> Vec<Trial> {
    let safe = Trial { families: families.to_vec(), hermite_degree: SAFE_HERMITE_DEGREES, ratio: 1.0 };
    if !families.contains(&Family::Hermite) {
        return vec![safe];
    }
    let mut bounded = Trial { hermite_degree: 0, ..safe.clone() };
    for family in bounded.families.iter_mut().filter(|family| **family == Family::Hermite) {
        *family = Family::Legendre;
    }
    let steep = Trial { hermite_degree: MAX_HERMITE_DEGREES, ratio: CLEARLY_LESS, ..safe.clone() };
    vec![safe, bounded, steep]
}

/// Every net, corrected by a surrogate of the others.
struct Corrected {
    nets: Vec<Contributions>,
    expansions: Vec<Expansion>,
    extrapolation: ExtrapolationError,
}

impl Corrected {
    /// Corrects the `nets` of `design` by `expansions` in polynomials of `families`.
    fn new(
        design: &Design,
        nets: Vec<Contributions>,
        expansions: Vec<Expansion>,
        families: &[Family],
        effects: &Effects,
    ) -> Self {
        let (rest, points) = (mean_square_residual(&nets), design.settings().base_samples);
        let extrapolation = ExtrapolationError::new(&expansions, families, points, rest, effects);
        Self { nets, expansions, extrapolation }
    }

    /// Returns the mean square of the residuals.
    fn residual(&self) -> f64 {
        mean_square_residual(&self.nets)
    }

    /// Returns the same plus the error that no runs show.
    fn unknown(&self) -> f64 {
        self.residual() + self.extrapolation.variance
    }

    /// Returns whether a few rows dominate the residuals, and these matter.
    fn is_heavy_tailed(&self) -> bool {
        let two = self.residual();
        let four = self.nets.iter().map(|net| net.residual.1).sum::<f64>() / self.nets.len() as f64;
        let rows: usize = self.nets.iter().map(|net| net.rows).sum();
        // Outputs have variance 1.
        two > RESIDUAL && 3.0 * rows as f64 * two * two < MIN_EFFECTIVE_ROWS * four
    }
}

/// Returns the first base points of `design` with at most [`MAX_FITTED_ROWS`] rows: a power of two, or all.
fn fitted_design(design: &Design) -> Design {
    let most = MAX_FITTED_ROWS * design.points_per_replicate() / design.rows().max(1);
    if design.rows() <= MAX_FITTED_ROWS || most == 0 {
        return design.clone();
    }
    design.with_points(1 << most.ilog2()).unwrap_or_else(|_| design.clone())
}

/// Returns the contributions of the base points below `points`, some of them at a time.
fn in_chunks(points: usize, of: impl Fn(std::ops::Range<usize>) -> Contributions) -> Contributions {
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

/// Returns for every net the expansion fitted to the others.
pub fn cross_fitted(nets: &[Net], caps: Caps<'_>) -> Vec<Expansion> {
    let training: Vec<Training<'_>> = nets.iter().map(Training::new).collect();
    fitted_to_others(nets, &training, caps, None).into_iter().flatten().collect()
}

/// Returns for every net the expansions of all outputs fitted to the `training` runs of the others; in one round of few
/// candidates if a longer run has `chosen` terms for each net.
fn fitted_to_others(
    nets: &[Net],
    training: &[Training<'_>],
    caps: Caps<'_>,
    chosen: Option<&[Vec<Term>]>,
) -> Vec<Vec<Expansion>> {
    let identifiable = IdentifiableTerms::new(nets, caps);
    if let Some(chosen) = chosen {
        let fits = chosen.par_iter().enumerate();
        let fits =
            fits.map(|(k, terms)| fitted_without(training, k, &identifiable.retain(terms.clone()), &identifiable, 1));
        return fits.collect();
    }
    let (candidates, rows) = (first_round(nets, &identifiable), selection_rows(nets.len() - 1));
    let sums: Vec<NetSums> = training.par_iter().map(|net| NetSums::new(net, &candidates, rows)).collect();
    let fits = (0..nets.len()).into_par_iter();
    let fits = fits.map(|k| fit(&without(training, k), &candidates, &without(&sums, k), &identifiable, MAX_ROUNDS));
    fits.collect()
}

/// Returns the expansions fitted to all nets except number `k` in at most `max_rounds` rounds, from these `candidates`
/// on.
fn fitted_without(
    training: &[Training<'_>],
    k: usize,
    candidates: &[Term],
    identifiable: &IdentifiableTerms<'_>,
    max_rounds: usize,
) -> Vec<Expansion> {
    let (others, rows) = (without(training, k), selection_rows(training.len() - 1));
    let sums: Vec<NetSums> = others.iter().map(|net| NetSums::new(net, candidates, rows)).collect();
    fit(&others, candidates, &sums.iter().collect::<Vec<_>>(), identifiable, max_rounds)
}

/// Returns the expansion fitted to all nets except number `k`.
fn expansion_without(nets: &[Net], k: usize, caps: Caps<'_>) -> Expansion {
    let identifiable = IdentifiableTerms::new(nets, caps);
    let training: Vec<Training<'_>> = nets.iter().map(Training::new).collect();
    fitted_without(&training, k, &first_round(nets, &identifiable), &identifiable, MAX_ROUNDS).swap_remove(0)
}

/// Returns the candidates of the first round.
fn first_round(nets: &[Net], identifiable: &IdentifiableTerms<'_>) -> Vec<Term> {
    let training = nets.len() - 1;
    let rows = selection_rows(training);
    let all_rows = nets.iter().map(|net| rows.min(net.points() * net.runs())).sum::<usize>() * training / nets.len();
    let caps = identifiable.caps;
    identifiable.retain(first_terms(caps, caps.terms.min(20.max(2 * all_rows))))
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

    /// Returns the indices with the contributions `columns`.
    fn indices(
        &self,
        variance: &EstimateWithInfluences,
        extrapolation: &[f64],
        columns: impl Fn(&Contributions) -> &[Vec<f64>],
    ) -> Vec<EstimateWithInfluences> {
        let errors = extrapolation.iter().enumerate();
        errors.map(|(k, &error)| self.mean(error, |net| &columns(net)[k]).over(variance)).collect()
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
fn estimates(corrected: &Corrected, low: &[Contributions], Scale { mean, sd }: Scale) -> SurrogateEstimates {
    let Corrected { nets, expansions, extrapolation } = corrected;
    let all = AllContributions { nets, low };
    let variance = all.mean(extrapolation.variance, |net| &net.variance);
    let scaled_mean = all.mean(extrapolation.mean, |net| &net.mean);
    let [first, second] = [0, 1].map(|form| all.indices(&variance, &extrapolation.total, |net| &net.total[form]));
    let weight = weight_of_second(&first, &second);
    let total =
        first.iter().zip(&second).map(|(a, b)| EstimateWithInfluences::combined(&[(1.0 - weight, a), (weight, b)]));
    let first_order = all.indices(&variance, &extrapolation.first_order, |net| &net.first_order);
    let effects = first_order.into_iter().zip(total).map(|(first_order, total)| IndexPair { first_order, total });
    SurrogateEstimates {
        effects: effects.collect(),
        pairs: all.indices(&variance, &extrapolation.pairs, |net| &net.pairs),
        mean: EstimateWithInfluences::linear(mean + sd * scaled_mean.estimate, &[(sd, &scaled_mean)]),
        explained: 1.0 - corrected.residual() / variance.estimate,
        is_heavy_tailed: corrected.is_heavy_tailed(),
        chosen: None,
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

/// Returns the terms of all surrogates by their mean share of the variance.
pub(crate) fn leading_terms(expansions: &[Expansion], variance: f64) -> Vec<SurrogateTerm> {
    let mut terms: Vec<(&Term, f64)> = Vec::new();
    for expansion in expansions {
        for (term, b) in expansion.varying() {
            let share = b * b / variance / expansions.len() as f64;
            add_to(&mut terms, term, share);
        }
    }
    terms.sort_by(|a, b| b.1.total_cmp(&a.1).then_with(|| a.0.cmp(b.0)));
    terms.truncate(MAX_LEADING_TERMS);
    terms.into_iter().map(|(term, share)| SurrogateTerm { factors: term.clone(), share }).collect()
}
