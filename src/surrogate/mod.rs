//! Indices corrected by surrogates.
//!
//! A sparse polynomial chaos expansion is fitted to the runs of all nets but one, and corrects the indices of that one
//! ([`corrected`]): exact for the part of the output that the expansion explains, pick-freeze for the rest. No net is
//! corrected by an expansion that has seen it, so that a poor surrogate costs accuracy and no honesty.

pub mod basis;
pub mod beyond;
pub mod carried;
pub mod corrected;
pub mod fit;
pub mod gram;
pub mod knots;
pub mod low_fidelity;
pub mod net;
mod own;
mod together;

use basis::{Caps, Family, Term};
use beyond::Beyond;
use carried::Carried;
use corrected::Contributions;
use fit::{Expansion, Expansions, NetSums, Training, first_candidates, fit, fit_in_rounds, selection_rows};
use net::Net;
use rayon::prelude::*;
pub use together::surrogates_together;
use together::{good_points, of_neighbours};

use crate::design::{Design, Sampler};
use crate::estimate::PointOutputs;
use crate::space::Space;
use crate::uncertainty::{
    ChosenTerms, Influenced, Layout, PartInfluences, SurrogateEstimates, SurrogateTerm, in_parts,
};

/// Fewest nets: a surrogate of the others has its number of terms by leaving out one of them.
pub const MIN_NETS: usize = 3;

/// Fewest base points of a net.
const MIN_POINTS: usize = 4;

/// The same if each has plain rows, which teach more than those of a base point that share their columns.
const MIN_POINTS_WITH_PLAIN_ROWS: usize = 2;

/// Largest sum of degrees of Hermite polynomials in a term. Those of high degree are large where hardly any row is: few rows
/// decide their coefficients, and no row shows what they do beyond.
const SAFE_HERMITE_DEGREES: usize = 4;

/// The same where this leaves clearly less of the runs that the surrogates were not fitted to: of powers and exponentials.
const MAX_HERMITE_DEGREES: usize = 10;

/// What is clearly less.
const CLEARLY_LESS: f64 = 0.25;

/// Share of the variance that the surrogates leave, and rows that carry it, three over their kurtosis times their number, from
/// and below which corrected intervals must hold the plain ones too: what is missing from the runs is missing from a fit to them.
const RESIDUAL: f64 = 1e-3;
const MIN_EFFECTIVE_ROWS: f64 = 50.0;

/// Share of the variance by which a factor matters.
const MATTERS: f64 = 0.02;

/// Rows of all nets together that surrogates are fitted to, at most: more of them hardly change the coefficients of some hundred terms,
/// and what an expansion leaves is taken from all rows.
pub const MAX_FITTED_ROWS: u64 = 1 << 16;

/// Base points that are corrected at a time where there are more than the surrogates are fitted to.
const CHUNK: usize = 1 << 13;

/// Terms that are reported.
const TOLD_TERMS: usize = 12;

/// The polynomials of every factor of `space`.
pub fn families(space: &Space) -> Vec<Family> {
    space.factors().iter().map(|factor| Family::new(factor.distribution())).collect()
}

/// The indices of `layout` from the outputs of every run of `design`, corrected by surrogates, in the terms that a longer run has
/// `chosen` if there is one; `None` where there are too few nets or points, points that are no Sobol' nets, or an output without
/// variance.
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

/// Whether there are enough nets, and points that are nets.
fn takes_surrogates(design: &Design, replicates: usize) -> bool {
    design.settings().sampler != Sampler::LatinHypercube && replicates >= MIN_NETS
}

/// Fewest base points of a net of `design` that surrogates are fitted to.
pub fn fewest_points(design: &Design) -> usize {
    if design.plain_rows() > 0 { MIN_POINTS_WITH_PLAIN_ROWS } else { MIN_POINTS }
}

/// Polynomials that are tried.
#[derive(Debug, Clone, PartialEq)]
pub struct Trial {
    /// Those of every factor.
    pub families: Vec<Family>,
    /// Largest sum of degrees of Hermite polynomials in a term.
    pub hermite_degree: usize,
    /// How much of what the best trial before it leaves it may leave, to be taken in its place.
    pub ratio: f64,
}

/// What is tried for factors with the polynomials `families`, in this order.
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
    /// The `nets` of `design` corrected by `expansions` in polynomials of `families`.
    fn new(
        design: &Design,
        nets: Vec<Contributions>,
        expansions: Vec<Expansion>,
        families: &[Family],
        pairs: &[(usize, usize)],
    ) -> Self {
        let (rest, _) = residual_powers(&nets);
        let points = design.settings().base_samples;
        let beyond = Beyond::new(&expansions, families, points, rest, &sorted_swaps(design), pairs);
        Self { nets, expansions, beyond }
    }

    /// Mean square of what the surrogates leave.
    fn residual(&self) -> f64 {
        residual_powers(&self.nets).0
    }

    /// The same, and what no runs show.
    fn unknown(&self) -> f64 {
        self.residual() + self.beyond.variance
    }

    /// Whether a few rows carry what the surrogates leave, and it matters.
    fn is_heavy_tailed(&self) -> bool {
        let (two, four) = residual_powers(&self.nets);
        let rows: usize = self.nets.iter().map(|net| net.rows).sum();
        // Outputs have variance 1.
        two > RESIDUAL && 3.0 * rows as f64 * two * two < MIN_EFFECTIVE_ROWS * four
    }
}

/// The first base points of `design` of at most [`MAX_FITTED_ROWS`] rows in all: a power of two of them, or all.
fn fitted_design(design: &Design) -> Design {
    let most = MAX_FITTED_ROWS * design.points_per_replicate() / design.rows().max(1);
    if design.rows() <= MAX_FITTED_ROWS || most == 0 {
        return design.clone();
    }
    design.with_points(1 << most.ilog2()).unwrap_or_else(|_| design.clone())
}

/// What the base points up to number `points` contribute, some of them at a time.
fn in_chunks(points: usize, of: impl Fn(std::ops::Range<usize>) -> Contributions) -> Contributions {
    let mut all = of(0..points.min(CHUNK));
    for first in (CHUNK..points).step_by(CHUNK) {
        all.append(of(first..points.min(first + CHUNK)));
    }
    all
}

/// Mean square and mean fourth power of what surrogates leave of `nets`.
fn residual_powers(nets: &[Contributions]) -> (f64, f64) {
    let (two, four) = nets.iter().fold((0.0, 0.0), |sum, net| (sum.0 + net.residual.0, sum.1 + net.residual.1));
    (two / nets.len() as f64, four / nets.len() as f64)
}

/// For every net the expansion fitted to the others.
pub fn cross_fitted(nets: &[Net], caps: Caps<'_>) -> Vec<Expansion> {
    let training: Vec<Training<'_>> = nets.iter().map(Training::new).collect();
    fitted_to_others(nets, &training, caps).iter().map(|expansions| expansions.of_output(0)).collect()
}

/// For every net the expansions fitted to the `training` runs of the others.
fn fitted_to_others(nets: &[Net], training: &[Training<'_>], caps: Caps<'_>) -> Vec<Expansions> {
    let carried = Carried::new(nets, caps);
    let (candidates, rows) = first_round(nets, &carried);
    let sums: Vec<NetSums> = training.par_iter().map(|net| NetSums::new(net, &candidates, rows)).collect();
    let of_net = |k: usize| fit(&without(training, k), (&candidates, &without(&sums, k)), &carried);
    (0..nets.len()).into_par_iter().map(of_net).collect()
}

/// The same in some of the terms that a longer run has `chosen` for each net: one round of few candidates.
fn fitted_among(nets: &[Net], training: &[Training<'_>], caps: Caps<'_>, chosen: &[Vec<Term>]) -> Vec<Expansions> {
    let carried = Carried::new(nets, caps);
    let rows = selection_rows(nets.len() - 1);
    let of_net = |k: usize| {
        let (terms, others) = (carried.retain(chosen[k].clone()), without(training, k));
        let sums: Vec<NetSums> = others.iter().map(|net| NetSums::new(net, &terms, rows)).collect();
        fit_in_rounds(&others, (&terms, &sums.iter().collect::<Vec<_>>()), &carried, 1)
    };
    (0..nets.len()).into_par_iter().map(of_net).collect()
}

/// The candidates of the first round, and the rows of each net that choose among them.
fn first_round(nets: &[Net], carried: &Carried<'_>) -> (Vec<Term>, usize) {
    let training = nets.len() - 1;
    let rows = selection_rows(training);
    let all_rows = nets.iter().map(|net| rows.min(net.points() * net.runs())).sum::<usize>() * training / nets.len();
    (first_candidates(carried, all_rows), rows)
}

/// The expansion fitted to all nets but number `k`.
fn expansion_without(nets: &[Net], k: usize, caps: Caps<'_>) -> Expansion {
    let carried = Carried::new(nets, caps);
    let (candidates, rows) = first_round(nets, &carried);
    let others: Vec<Training<'_>> = without(nets, k).into_iter().map(Training::new).collect();
    let sums: Vec<NetSums> = others.iter().map(|net| NetSums::new(net, &candidates, rows)).collect();
    let (others, sums): (Vec<&Training<'_>>, Vec<&NetSums>) = (others.iter().collect(), sums.iter().collect());
    fit(&others, (&candidates, &sums), &carried).of_output(0)
}

/// The factors of every swap in rising order.
fn sorted_swaps(design: &Design) -> Vec<Vec<usize>> {
    let mut swaps: Vec<Vec<usize>> = design.swaps().to_vec();
    swaps.iter_mut().for_each(|swap| swap.sort_unstable());
    swaps
}

fn without<T>(list: &[T], left_out: usize) -> Vec<&T> {
    list.iter().enumerate().filter(|(place, _)| *place != left_out).map(|(_, item)| item).collect()
}

/// The outputs of every run, a column for each.
fn columns(kept: &PointOutputs, runs: usize) -> Vec<Vec<f64>> {
    let mut columns = vec![Vec::with_capacity(kept.points() as usize); runs];
    for block in kept.blocks(u64::MAX) {
        columns.iter_mut().zip(block).for_each(|(column, more)| column.extend_from_slice(more));
    }
    columns
}

/// Outputs of every replicate and run over their standard deviation, less their mean, and both, unless a scale is given.
type Scaled = (Vec<Vec<Vec<f64>>>, (f64, f64));

fn scaled(replicates: &[&PointOutputs], runs: usize, scale: Option<(f64, f64)>) -> Option<Scaled> {
    let mut outputs: Vec<Vec<Vec<f64>>> = replicates.iter().map(|kept| columns(kept, runs)).collect();
    let finite = || outputs.iter().flatten().flatten().copied().filter(|y| y.is_finite()).collect::<Vec<f64>>();
    let (mean, sd) = scale.map_or_else(|| mean_and_sd(&finite()), Some)?;
    outputs.iter_mut().flatten().flatten().for_each(|y| *y = (*y - mean) / sd);
    Some((outputs, (mean, sd)))
}

/// `None` if the values are all alike, or none.
fn mean_and_sd(values: &[f64]) -> Option<(f64, f64)> {
    let mean = crate::sum::mean(values);
    let size = values.iter().fold(0.0, |largest: f64, y| largest.max((y - mean).abs()));
    // In units of the largest deviation, so that nothing under- or overflows when squared.
    let square = |y: &f64| ((y - mean) / size).powi(2);
    let sd = size * (values.iter().map(square).sum::<f64>() / values.len() as f64).sqrt();
    (size > 0.0 && sd.is_finite() && mean.is_finite()).then_some((mean, sd))
}

/// The means over all points, and what each part does to them; those of `low`, the runs of a cheaper model, are added.
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
        Influenced { estimate: mean + of_low, parts, low, beyond }
    };
    let variance = gathered(&|net| &net.variance, beyond.variance);
    let index = |numerator: &Influenced| {
        let estimate = numerator.estimate / variance.estimate;
        let scale = 1.0 / variance.estimate;
        Influenced { estimate, ..Influenced::combined(&[(scale, numerator), (-estimate * scale, &variance)]) }
    };
    let first_order: Vec<Influenced> = (0..nets[0].first_order.len())
        .map(|swap| index(&gathered(&|net| &net.first_order[swap], beyond.first_order[swap])))
        .collect();
    let second_order: Vec<Influenced> =
        (0..nets[0].pairs.len()).map(|pair| index(&gathered(&|net| &net.pairs[pair], beyond.pairs[pair]))).collect();
    let forms: [Vec<Influenced>; 2] = [0, 1].map(|form| {
        (0..nets[0].total[form].len())
            .map(|swap| index(&gathered(&|net| &net.total[form][swap], beyond.total[swap])))
            .collect()
    });
    let weight = weight_of_second(&forms);
    let mixed = |(a, b): (&Influenced, &Influenced)| Influenced::combined(&[(1.0 - weight, a), (weight, b)]);
    let total = forms[0].iter().zip(&forms[1]).map(mixed).collect();
    let scaled = |of: Influenced, offset: f64, scale: f64| Influenced {
        estimate: offset + scale * of.estimate,
        ..Influenced::combined(&[(scale, &of)])
    };
    SurrogateEstimates {
        first_order,
        total,
        second_order,
        mean: scaled(gathered(&|net| &net.mean, beyond.mean), mean, sd),
        explained: 1.0 - corrected.residual() / variance.estimate,
        is_heavy_tailed: corrected.is_heavy_tailed(),
        chosen: None,
        misses_levels: false,
        growth: growth(nets),
        terms: told_terms(expansions, variance.estimate),
        term_count: expansions.iter().map(|e| e.terms.len() as f64).sum::<f64>() / expansions.len() as f64,
        variance: scaled(variance, 0.0, sd * sd),
        low: None,
    }
}

/// Of all factors, and of those that matter, the largest variance that surrogates claim over that which the rows of `nets` show.
fn growth(nets: &[Contributions]) -> f64 {
    let claims = |place: usize| {
        nets.iter().fold([0.0; 2], |sum, net| [sum[0] + net.claims[place][0], sum[1] + net.claims[place][1]])
    };
    let count = nets.iter().map(|net| net.claims.len()).min().unwrap_or(0);
    let all = count.checked_sub(1).map_or(0.0, |last| claims(last)[0]);
    let ratio = |[claimed, seen]: [f64; 2]| if claimed > MATTERS * all { claimed / seen } else { 0.0 };
    (0..count).map(|place| ratio(claims(place))).fold(0.0, f64::max)
}

/// The weight of the second form of the total indices with which the spread within the nets is least, over all swaps.
fn weight_of_second([first, second]: &[Vec<Influenced>; 2]) -> f64 {
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

/// The terms of all surrogates by their mean share of the variance.
pub fn told_terms(expansions: &[Expansion], variance: f64) -> Vec<SurrogateTerm> {
    let mut terms: Vec<(&Term, f64)> = Vec::new();
    for expansion in expansions {
        for (term, b) in expansion.terms.iter().zip(&expansion.coefficients).filter(|(term, _)| !term.is_empty()) {
            let share = b * b / variance / expansions.len() as f64;
            match terms.iter_mut().find(|(known, _)| *known == term) {
                Some((_, sum)) => *sum += share,
                None => terms.push((term, share)),
            }
        }
    }
    terms.sort_by(|a, b| b.1.total_cmp(&a.1).then_with(|| a.0.cmp(b.0)));
    terms.truncate(TOLD_TERMS);
    terms.into_iter().map(|(term, share)| SurrogateTerm { factors: term.clone(), share }).collect()
}
