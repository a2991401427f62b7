//! Indices of a surrogate that is fitted to plain rows, each at a point of its own.

use super::held_out::{HeldOut, Spread};
use super::surrogate_use::SurrogateUse;
use crate::design::Design;
use crate::effect::{Effect, EffectQuantities, IndexPair, Layout, OfPair, Quantities};
use crate::estimate::PointOutputs;
use crate::surrogate::chaos::{Chaos, Factor, degree_at};
use crate::surrogate::extrapolation::ExtrapolationError;
use crate::surrogate::outputs::{Scale, ScaledOutput};
use crate::surrogate::{Effects, Expansion, Family, Term, choices, leading_terms};
use crate::uncertainty::{Estimate, Interval, Judgement, NORMAL_QUANTILE, OutputMoments, StandardError};
use rayon::prelude::*;

/// Degrees of freedom of errors that are not those of a few nets.
const FREEDOM: f64 = 1e6;

/// A surrogate fitted to rows.
#[derive(Debug)]
pub(crate) struct PlainFit {
    pub chaos: Chaos,
    /// Its polynomials.
    pub expansion: Expansion,
    pub extrapolation: ExtrapolationError,
}

impl PlainFit {
    /// Fits `z`, of mean 0 and variance 1, at rows with these `values` of every factor, in polynomials of `families`. With
    /// an `offset` a product is tried too, if it makes outputs of one sign of `z`.
    pub fn new(families: &[Family], values: &[Vec<f64>], z: &[f64], offset: Option<f64>, effects: &Effects) -> Self {
        let degree = degree_at(z.len());
        let factors = families.par_iter().zip(values).map(|(family, values)| Factor::new(family, values, degree));
        let chaos = Chaos::new(factors.collect(), z, offset);
        // Steps have no tails.
        let factors = &chaos.basis().factors;
        let smooth = chaos.terms().filter(|(term, _)| term.iter().all(|(input, k)| *k <= factors[*input].degree()));
        let (terms, coefficients): (Vec<Term>, Vec<f64>) = smooth.map(|(term, c)| (term.clone(), c)).unzip();
        let expansions = [Expansion { terms: terms.into(), coefficients }];
        let extrapolation = ExtrapolationError::new(&expansions, families, z.len() as u64, chaos.rest, effects);
        let [expansion] = expansions;
        Self { chaos, expansion, extrapolation }
    }

    /// Returns the share of the variance that is left plus the error that no rows show.
    pub fn unknown(&self) -> f64 {
        self.chaos.rest + self.extrapolation.variance
    }

    /// Returns the error of an `index` by the tails of the factors, where that of its variance is `beyond`.
    pub fn beyond(&self, index: f64, beyond: f64) -> f64 {
        (beyond + index * self.extrapolation.variance) / (self.chaos.variances.all + self.chaos.rest)
    }

    /// Returns the use of the surrogate.
    pub fn surrogate_use(&self) -> SurrogateUse {
        SurrogateUse {
            explained: 1.0 - self.chaos.rest,
            term_count: self.chaos.terms().count() as f64,
            terms: leading_terms(std::slice::from_ref(&self.expansion), self.chaos.variances.all),
            is_heavy_tailed: false,
            corrects_first_order: true,
            corrects_total: true,
            gain_first_order: None,
            gain_total: None,
            is_doubted: false,
            refusal: None,
            low: None,
        }
    }
}

/// The rows A and B of a design without swaps.
pub(crate) struct PlainRows {
    choices: Vec<Vec<Family>>,
    /// For each factor the quantiles of all rows: those of every base point and matrix in turn, of all replicates.
    quantiles: Vec<Vec<f64>>,
    replicates: usize,
    effects: Effects,
}

impl PlainRows {
    /// Takes the rows of `design`, of factors with polynomials of `families`.
    pub fn new(design: &Design, families: &[Family], effects: Effects) -> Self {
        let (points, factors) = (design.points_per_replicate() as usize, design.factors());
        let nets = (0..design.settings().replicates).map(|replicate| design.first_points(replicate, points));
        let nets: Vec<Vec<Vec<f64>>> = nets.collect();
        let mut quantiles = vec![Vec::new(); factors];
        for (point, first) in (0..points).flat_map(|point| [(point, 0), (point, factors)]) {
            for (factor, column) in quantiles.iter_mut().enumerate() {
                column.extend(nets.iter().map(|net| net[first + factor][point]));
            }
        }
        Self { choices: choices(families), quantiles, replicates: nets.len(), effects }
    }

    /// Fits the outputs of every replicate at the rows where there are any; `None` if they do not vary.
    pub fn fit(&self, replicates: &[&PointOutputs]) -> Option<PlainFit> {
        let output = ScaledOutput::new(replicates, 2, None)?;
        let rows = (0..self.quantiles[0].len()).filter_map(|row| {
            let (place, net) = (row / self.replicates, row % self.replicates);
            let y = output.nets[net].runs[place % 2][place / 2];
            y.is_finite().then_some((row, y))
        });
        let (rows, z): (Vec<usize>, Vec<f64>) = rows.unzip();
        let values: Vec<Vec<f64>> =
            self.quantiles.iter().map(|column| rows.iter().map(|row| column[*row]).collect()).collect();
        let fits = self.choices.iter().map(|families| PlainFit::new(families, &values, &z, None, &self.effects));
        fits.min_by(|a, b| a.unknown().total_cmp(&b.unknown()))
    }

    /// Returns the mean and variance of the output of a fit to `replicates`.
    pub fn moments(
        &self,
        PlainFit { chaos, extrapolation, .. }: &PlainFit,
        replicates: &[&PointOutputs],
    ) -> Option<OutputMoments> {
        let Scale { mean, sd } = ScaledOutput::new(replicates, 2, None)?.scale;
        let rows = chaos.basis().rows as f64;
        let all = vec![1.0; chaos.sets().len()];
        let of_parts: Vec<f64> = chaos.variances_of_parts().map(|of| of.all).collect();
        let held_out = HeldOut::new(chaos);
        let half = held_out.half_widths(&[held_out.spread(&all, 0.0, &of_parts)])[0] + extrapolation.variance;
        let half_of_mean = NORMAL_QUANTILE * (chaos.rest / rows).sqrt() + extrapolation.mean;
        let about =
            |middle: f64, half: f64| Estimate { estimate: middle, interval: Interval::about(middle, half).finite() };
        Some(OutputMoments {
            mean: about(mean + sd * chaos.constant(), sd * half_of_mean),
            variance: about(sd * sd * (chaos.variances.all + chaos.rest * chaos.rest), sd * sd * half),
        })
    }

    /// Computes the quantities of `layout` by a fit. Those of the effects at `unread` positions are exactly 0.
    pub fn quantities(&self, fit: &PlainFit, layout: &Layout, unread: &[bool]) -> Quantities<Judgement> {
        let all = Judged::new(fit);
        let Effects { swaps, pairs } = &self.effects;
        let PlainFit { chaos, extrapolation, .. } = fit;
        let (rest, variance) = (chaos.rest, chaos.variances.all);
        let first: Vec<Vec<f64>> = swaps.iter().map(|swap| all.weights(|set| is_within(set, swap))).collect();
        let total: Vec<Vec<f64>> = swaps.iter().map(|swap| all.weights(|set| touches(set, swap))).collect();
        let (of_first, of_total) = (variance + rest, variance + rest * rest);
        let first_order = all.judged(&first, &extrapolation.first_order, of_first);
        let of_totals = all.judged(&total, &extrapolation.total, of_total);
        let differences: Vec<Vec<f64>> =
            first.iter().zip(&total).map(|(a, b)| a.iter().zip(b).map(|(a, b)| b - a).collect()).collect();
        let interactions = all.judged(&differences, &extrapolation.total, of_total);
        let players: Vec<&Vec<usize>> =
            layout.effects.iter().zip(swaps).filter(|(effect, _)| effect.is_input()).map(|(_, swap)| swap).collect();
        let shapley = layout.shapley.then(|| {
            let weights = players.iter().map(|player| {
                let shared = |set: &[usize]| players.iter().filter(|other| touches(set, other)).count().max(1) as f64;
                chaos.sets().iter().map(|set| f64::from(u8::from(touches(set, player))) / shared(set)).collect()
            });
            all.judged(&weights.collect::<Vec<_>>(), &extrapolation.total, variance)
        });
        let of_pairs: Vec<Vec<f64>> = pairs
            .iter()
            .map(|&(j, k)| {
                let both = |factor: &usize| swaps[j].contains(factor) || swaps[k].contains(factor);
                all.weights(|set| touches(set, &swaps[j]) && touches(set, &swaps[k]) && set.iter().all(both))
            })
            .collect();
        let of_pairs = all.judged(&of_pairs, &extrapolation.pairs, of_first);
        let sum_of = |kind: &[Vec<f64>], beyond: &[f64], whole: f64, is_of: fn(Effect) -> bool| {
            let mut sum = (vec![0.0; chaos.sets().len()], 0.0);
            for (at, weights) in kind.iter().enumerate().filter(|(at, _)| is_of(layout.effects[*at])) {
                sum.0.iter_mut().zip(weights).for_each(|(sum, weight)| *sum += weight);
                sum.1 += beyond[at];
            }
            all.judged(&[sum.0], &[sum.1], whole).remove(0)
        };
        let sums = |is_of| IndexPair {
            first_order: sum_of(&first, &extrapolation.first_order, of_first, is_of),
            total: sum_of(&total, &extrapolation.total, of_total, is_of),
        };
        let (of_factors, of_groups) = (sums(Effect::is_input), sums(Effect::is_group));
        let effects = layout.effects.iter().enumerate().map(|(at, &effect)| {
            let is_read = |of: &Judgement| if unread.get(at) == Some(&true) { exactly(0.0) } else { of.clone() };
            let (first_order, total) = (is_read(&first_order[at]), is_read(&of_totals[at]));
            let whole = if effect.is_group() { &of_groups } else { &of_factors };
            EffectQuantities {
                effect,
                shares: IndexPair {
                    first_order: share(&first_order, &whole.first_order),
                    total: share(&total, &whole.total),
                },
                check_gap: Judgement { estimate: Estimate::alone(0.0), ..exactly(0.0) },
                interaction: is_read(&interactions[at]),
                others: Vec::new(),
                of_mean: None,
                shapley: shapley.as_ref().and_then(|all| all.get(at)).map(is_read),
                first_order,
                total,
            }
        });
        Quantities {
            effects: effects.collect(),
            sums: of_factors.clone(),
            redrawn: Vec::new(),
            pairs: pairs.iter().zip(of_pairs).map(|(&factors, value)| OfPair { factors, value }).collect(),
            mean_share: None,
        }
    }
}

/// The variances of the sets of factors of a fit, and of the fits without each part of the rows.
struct Judged<'a> {
    fit: &'a PlainFit,
    held_out: HeldOut<'a>,
    variances: Vec<f64>,
    of_parts: Vec<Vec<f64>>,
}

impl<'a> Judged<'a> {
    fn new(fit: &'a PlainFit) -> Self {
        let (variances, of_parts) = fit.chaos.variances_of_sets();
        Self { fit, held_out: HeldOut::new(&fit.chaos), variances, of_parts }
    }

    /// Returns 1 for each of the sets that are in an effect, else 0.
    fn weights(&self, is_in: impl Fn(&[usize]) -> bool) -> Vec<f64> {
        self.fit.chaos.sets().iter().map(|set| f64::from(u8::from(is_in(set)))).collect()
    }

    /// Computes indices of one kind, sums of the variances of sets with these weights over `whole`; the errors of the
    /// sums by the tails are `beyond`.
    fn judged(&self, kind: &[Vec<f64>], beyond: &[f64], whole: f64) -> Vec<Judgement> {
        let sum = |weights: &[f64], variances: &[f64]| weights.iter().zip(variances).map(|(w, v)| w * v).sum::<f64>();
        let indices: Vec<f64> = kind.iter().map(|weights| sum(weights, &self.variances) / whole).collect();
        let shares = |weights: &[f64]| -> Vec<f64> {
            self.of_parts.iter().map(|of| sum(weights, of) / of.iter().sum::<f64>().max(f64::MIN_POSITIVE)).collect()
        };
        let of_parts: Vec<Vec<f64>> = kind.iter().map(|weights| shares(weights)).collect();
        let spreads = kind.iter().zip(&indices).zip(&of_parts);
        let spreads: Vec<Spread> =
            spreads.map(|((weights, index), parts)| self.held_out.spread(weights, *index, parts)).collect();
        let half_widths = self.held_out.half_widths(&spreads);
        let all = indices.into_iter().zip(of_parts).zip(half_widths).zip(beyond);
        all.map(|(((index, mut parts), half), beyond)| {
            let centre = apportion_base::sum::mean(&parts);
            parts.iter_mut().for_each(|part| *part = centre - *part);
            about(index, half + self.fit.beyond(index, *beyond), parts)
        })
        .collect()
    }
}

fn is_within(set: &[usize], effect: &[usize]) -> bool {
    set.iter().all(|factor| effect.contains(factor))
}

fn touches(set: &[usize], effect: &[usize]) -> bool {
    set.iter().any(|factor| effect.contains(factor))
}

fn about(estimate: f64, half: f64, parts: Vec<f64>) -> Judgement {
    let interval = Some(Interval::about(estimate, half));
    let error = StandardError { error: half / NORMAL_QUANTILE, freedom: FREEDOM };
    Judgement::new(Estimate { estimate, interval }, error, vec![parts])
}

fn exactly(estimate: f64) -> Judgement {
    about(estimate, 0.0, Vec::new())
}

/// Returns 100 part/all, whose errors may add.
fn share(part: &Judgement, all: &Judgement) -> Judgement {
    let [(part, of_part), (all, of_all)] =
        [part, all].map(|of| (of.estimate.estimate, of.error.error * NORMAL_QUANTILE));
    about(100.0 * part / all, 100.0 * (of_part + part / all * of_all) / all, Vec::new())
}
