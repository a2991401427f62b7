//! Indices corrected by surrogates.
//!
//! A sparse polynomial chaos expansion is fitted to the runs of all nets but one, and corrects the indices of that one
//! ([`crate::correction`]): exact for the part of the output that the expansion explains, pick-freeze for the rest. No net is
//! corrected by an expansion fitted to it: a poor surrogate costs accuracy, but intervals stay valid.

pub mod basis;
pub mod beyond;
pub mod carried;
pub mod fit;
pub mod gram;
pub mod knots;
pub mod low_fidelity;
pub mod net;
mod own;
mod together;

use basis::{Caps, Family, Term, add_to};
use beyond::Beyond;
use carried::Carried;
use fit::{Expansion, Expansions, MAX_ROUNDS, NetSums, Training, first_candidates, fit, selection_rows, without};
use net::Net;
use rayon::prelude::*;
pub use together::surrogates_together;
use together::{good_points, of_neighbours};

use crate::correction::{
    ChosenTerms, Contributions, Effects, EstimateWithInfluences, SurrogateEstimates, SurrogateTerm, in_parts,
};
use crate::design::{Design, Sampler};
use crate::effect::{IndexPair, Layout};
use crate::estimate::PointOutputs;
use crate::space::Space;
use crate::uncertainty::PartInfluences;

/// Minimum number of nets: the number of terms of a surrogate of the others is chosen by leaving out one of them.
pub const MIN_NETS: usize = 3;

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
pub const MAX_FITTED_ROWS: u64 = 1 << 16;

/// Number of base points corrected at a time if there are more than the surrogates are fitted to.
const CHUNK: usize = 1 << 13;

/// Number of terms that are reported.
const MAX_LEADING_TERMS: usize = 12;

/// Returns the polynomials of every factor of `space`.
pub fn families(space: &Space) -> Vec<Family> {
    space.factors().iter().map(|factor| Family::new(factor.distribution())).collect()
}

/// Estimates the indices of `layout` from the outputs of every run of `design`, corrected by surrogates, in the terms
/// that a longer run has `chosen` if there is one; `None` if there are too few nets or points, the points are not
/// Sobol' nets, or an output has no variance.
pub fn surrogate_estimates(
    design: &Design,
    families: &[Family],
    layout: &Layout,
    replicates: &[&PointOutputs],
    chosen: Option<&ChosenTerms>,
) -> Option<SurrogateEstimates> {
    if !takes_surrogates(design, replicates.len()) {
        return None;
    }
    let scaled = scaled(replicates, design.runs().len(), None)?;
    of_neighbours(design, families, layout, &good_points(&scaled), &[&scaled], chosen).pop().flatten()
}

/// Returns whether there are enough nets, and the points are nets.
fn takes_surrogates(design: &Design, replicates: usize) -> bool {
    design.settings().sampler != Sampler::LatinHypercube && replicates >= MIN_NETS
}

/// Returns the minimum number of base points of a net of `design` to which surrogates are fitted.
pub fn fewest_points(design: &Design) -> usize {
    if design.plain_rows() > 0 { MIN_POINTS_WITH_PLAIN_ROWS } else { MIN_POINTS }
}

/// A set of polynomials to try.
#[derive(Debug, Clone, PartialEq)]
pub struct Trial {
    /// The polynomials of every factor.
    pub families: Vec<Family>,
    /// Maximum sum of degrees of Hermite polynomials in a term.
    pub hermite_degree: usize,
    /// Maximum ratio of its residual to that of the best previous trial for which it is preferred.
    pub ratio: f64,
}

/// Returns the trials for factors with the polynomials `families`, in order.
pub fn trials(families: &[Family]) -> Vec<Trial> {
    let trial = |families: &[Family], hermite_degree: usize, ratio: f64| Trial {
        families: families.to_vec(),
        hermite_degree,
        ratio,
    };
    let mut trials = vec![trial(families, SAFE_HERMITE_DEGREES, 1.0)];
    if families.contains(&Family::Hermite) {
        let of_quantiles = |family: &Family| if *family == Family::Hermite { Family::Legendre } else { family.clone() };
        let bounded: Vec<Family> = families.iter().map(of_quantiles).collect();
        trials.push(trial(&bounded, 0, 1.0));
        trials.push(trial(families, MAX_HERMITE_DEGREES, CLEARLY_LESS));
    }
    trials
}

/// Every net, corrected by a surrogate of the others.
struct Corrected {
    nets: Vec<Contributions>,
    expansions: Vec<Expansion>,
    beyond: Beyond,
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
        let (rest, _) = residual_powers(&nets);
        let beyond = Beyond::new(&expansions, families, design.settings().base_samples, rest, effects);
        Self { nets, expansions, beyond }
    }

    /// Returns the mean square of the residuals.
    fn residual(&self) -> f64 {
        residual_powers(&self.nets).0
    }

    /// Returns the same plus the error that no runs show.
    fn unknown(&self) -> f64 {
        self.residual() + self.beyond.variance
    }

    /// Returns whether a few rows dominate the residuals, and these matter.
    fn is_heavy_tailed(&self) -> bool {
        let (two, four) = residual_powers(&self.nets);
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

/// Returns the mean square and mean fourth power of the residuals of `nets`.
fn residual_powers(nets: &[Contributions]) -> (f64, f64) {
    let (two, four) = nets.iter().fold((0.0, 0.0), |sum, net| (sum.0 + net.residual.0, sum.1 + net.residual.1));
    (two / nets.len() as f64, four / nets.len() as f64)
}

/// Returns for every net the expansion fitted to the others.
pub fn cross_fitted(nets: &[Net], caps: Caps<'_>) -> Vec<Expansion> {
    let training: Vec<Training<'_>> = nets.iter().map(Training::new).collect();
    fitted_to_others(nets, &training, caps, None).iter().map(|expansions| expansions.of_output(0)).collect()
}

/// Returns for every net the expansions fitted to the `training` runs of the others; in one round of few candidates if
/// a longer run has `chosen` terms for each net.
fn fitted_to_others(
    nets: &[Net],
    training: &[Training<'_>],
    caps: Caps<'_>,
    chosen: Option<&[Vec<Term>]>,
) -> Vec<Expansions> {
    let carried = Carried::new(nets, caps);
    if let Some(chosen) = chosen {
        let of_net = |k: usize| fitted_without(training, k, &carried.retain(chosen[k].clone()), &carried, 1);
        return (0..nets.len()).into_par_iter().map(of_net).collect();
    }
    let (candidates, rows) = (first_round(nets, &carried), selection_rows(nets.len() - 1));
    let sums: Vec<NetSums> = training.par_iter().map(|net| NetSums::new(net, &candidates, rows)).collect();
    let of_net = |k: usize| fit(&without(training, k), (&candidates, &without(&sums, k)), &carried, MAX_ROUNDS);
    (0..nets.len()).into_par_iter().map(of_net).collect()
}

/// Returns the expansions fitted to all nets except number `k` in at most `max_rounds` rounds, from these `candidates`
/// on.
fn fitted_without(
    training: &[Training<'_>],
    k: usize,
    candidates: &[Term],
    carried: &Carried<'_>,
    max_rounds: usize,
) -> Expansions {
    let (others, rows) = (without(training, k), selection_rows(training.len() - 1));
    let sums: Vec<NetSums> = others.iter().map(|net| NetSums::new(net, candidates, rows)).collect();
    fit(&others, (candidates, &sums.iter().collect::<Vec<_>>()), carried, max_rounds)
}

/// Returns the expansion fitted to all nets except number `k`.
fn expansion_without(nets: &[Net], k: usize, caps: Caps<'_>) -> Expansion {
    let carried = Carried::new(nets, caps);
    let training: Vec<Training<'_>> = nets.iter().map(Training::new).collect();
    fitted_without(&training, k, &first_round(nets, &carried), &carried, MAX_ROUNDS).of_output(0)
}

/// Returns the candidates of the first round.
fn first_round(nets: &[Net], carried: &Carried<'_>) -> Vec<Term> {
    let training = nets.len() - 1;
    let rows = selection_rows(training);
    let all_rows = nets.iter().map(|net| rows.min(net.points() * net.runs())).sum::<usize>() * training / nets.len();
    first_candidates(carried, all_rows)
}

/// Returns the outputs of every run, a column for each.
fn columns(kept: &PointOutputs, runs: usize) -> Vec<Vec<f64>> {
    let mut columns = vec![Vec::with_capacity(kept.points() as usize); runs];
    for block in kept.blocks(u64::MAX) {
        columns.iter_mut().zip(block).for_each(|(column, more)| column.extend_from_slice(more));
    }
    columns
}

/// Outputs of every replicate and run, standardised, and their mean and standard deviation, or a given scale.
type Scaled = (Vec<Vec<Vec<f64>>>, (f64, f64));

fn scaled(replicates: &[&PointOutputs], runs: usize, scale: Option<(f64, f64)>) -> Option<Scaled> {
    let mut outputs: Vec<Vec<Vec<f64>>> = replicates.iter().map(|kept| columns(kept, runs)).collect();
    let finite = || outputs.iter().flatten().flatten().copied().filter(|y| y.is_finite()).collect::<Vec<f64>>();
    let (mean, sd) = scale.map_or_else(|| mean_and_sd(&finite()), Some)?;
    outputs.iter_mut().flatten().flatten().for_each(|y| *y = (*y - mean) / sd);
    Some((outputs, (mean, sd)))
}

/// Returns the mean and standard deviation; `None` if all values are equal, or there are none.
fn mean_and_sd(values: &[f64]) -> Option<(f64, f64)> {
    let mean = apportion_base::sum::mean(values);
    let size = values.iter().fold(0.0, |largest: f64, y| largest.max((y - mean).abs()));
    // In units of the largest deviation, so that squares neither underflow nor overflow.
    let square = |y: &f64| ((y - mean) / size).powi(2);
    let sd = size * (values.iter().map(square).sum::<f64>() / values.len() as f64).sqrt();
    (size > 0.0 && sd.is_finite() && mean.is_finite()).then_some((mean, sd))
}

/// Returns the means over all points with the influences of each part; adds those of `low`, a low-fidelity model.
fn estimates(corrected: &Corrected, low: &[Contributions], (mean, sd): (f64, f64)) -> SurrogateEstimates {
    let Corrected { nets, expansions, beyond } = corrected;
    let of_nets = |nets: &[Contributions], column: &dyn Fn(&Contributions) -> &Vec<f64>| {
        let columns: Vec<Vec<f64>> = nets.iter().map(|net| column(net).clone()).collect();
        let count: usize = columns.iter().map(Vec::len).sum();
        let mean = columns.iter().flatten().sum::<f64>() / count.max(1) as f64;
        let parts: PartInfluences =
            in_parts(&columns).into_iter().map(|net| net.into_iter().map(|x| x - mean).collect()).collect();
        (mean, parts)
    };
    let gathered = |column: &dyn Fn(&Contributions) -> &Vec<f64>, beyond: f64| {
        let ((mean, parts), (of_low, low)) = (of_nets(nets, column), of_nets(low, column));
        EstimateWithInfluences { estimate: mean + of_low, parts, low, beyond }
    };
    let variance = gathered(&|net| &net.variance, beyond.variance);
    let indices = |column: &dyn Fn(&Contributions) -> &Vec<Vec<f64>>, beyond: &[f64]| -> Vec<EstimateWithInfluences> {
        let index = |(k, &beyond): (usize, &f64)| gathered(&|net| &column(net)[k], beyond).over(&variance);
        beyond.iter().enumerate().map(index).collect()
    };
    let first_order = indices(&|net| &net.first_order, &beyond.first_order);
    let pairs = indices(&|net| &net.pairs, &beyond.pairs);
    let forms = [0, 1].map(|form| indices(&|net| &net.total[form], &beyond.total));
    let weight = weight_of_second(&forms);
    let mixed = |(a, b): (&EstimateWithInfluences, &EstimateWithInfluences)| {
        EstimateWithInfluences::combined(&[(1.0 - weight, a), (weight, b)])
    };
    let total = forms[0].iter().zip(&forms[1]).map(mixed);
    let effects = first_order.into_iter().zip(total).map(|(first_order, total)| IndexPair { first_order, total });
    let scaled = |of: EstimateWithInfluences, offset: f64, scale: f64| {
        EstimateWithInfluences::linear(offset + scale * of.estimate, &[(scale, &of)])
    };
    SurrogateEstimates {
        effects: effects.collect(),
        pairs,
        mean: scaled(gathered(&|net| &net.mean, beyond.mean), mean, sd),
        explained: 1.0 - corrected.residual() / variance.estimate,
        is_heavy_tailed: corrected.is_heavy_tailed(),
        chosen: None,
        misses_levels: false,
        growth: growth(nets),
        terms: leading_terms(expansions, variance.estimate),
        term_count: expansions.iter().map(|e| e.terms.len() as f64).sum::<f64>() / expansions.len() as f64,
        variance: scaled(variance, 0.0, sd * sd),
        low: None,
    }
}

/// Returns the largest ratio of the claimed variance to that over the rows, for all factors and those that matter.
fn growth(nets: &[Contributions]) -> f64 {
    let claims = |place: usize| {
        nets.iter().fold([0.0; 2], |sum, net| [sum[0] + net.claims[place].claimed, sum[1] + net.claims[place].shown])
    };
    let count = nets.iter().map(|net| net.claims.len()).min().unwrap_or(0);
    let all = count.checked_sub(1).map_or(0.0, |last| claims(last)[0]);
    let ratio = |[claimed, seen]: [f64; 2]| if claimed > MATTERS * all { claimed / seen } else { 0.0 };
    (0..count).map(|place| ratio(claims(place))).fold(0.0, f64::max)
}

/// Returns the weight of the second form of the total indices with the least spread within the nets, over all swaps.
fn weight_of_second([first, second]: &[Vec<EstimateWithInfluences>; 2]) -> f64 {
    let (mut covariance, mut variance) = (0.0, 0.0);
    for (a, b) in first.iter().zip(second) {
        for (a, b) in a.parts.iter().chain(&a.low).zip(b.parts.iter().chain(&b.low)) {
            let n = a.len() as f64;
            let mean = |list: &[f64]| list.iter().sum::<f64>() / n;
            let (mean_a, mean_b) = (mean(a), mean(b));
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
pub fn leading_terms(expansions: &[Expansion], variance: f64) -> Vec<SurrogateTerm> {
    let mut terms: Vec<(&Term, f64)> = Vec::new();
    for expansion in expansions {
        for (term, b) in expansion.terms.iter().zip(&expansion.coefficients).filter(|(term, _)| !term.is_empty()) {
            let share = b * b / variance / expansions.len() as f64;
            add_to(&mut terms, term, share);
        }
    }
    terms.sort_by(|a, b| b.1.total_cmp(&a.1).then_with(|| a.0.cmp(b.0)));
    terms.truncate(MAX_LEADING_TERMS);
    terms.into_iter().map(|(term, share)| SurrogateTerm { factors: term.clone(), share }).collect()
}
