//! Indices of a surrogate that is fitted to plain rows, each at a point of its own.

use super::held_out::HeldOut;
use super::judged::{Index, Judged, about, exactly};
use super::surrogate_use::SurrogateUse;
use crate::design::Design;
use crate::effect::{Effect, EffectQuantities, IndexPair, Layout, OfPair, Quantities};
use crate::estimate::PointOutputs;
use crate::surrogate::chaos::{Basis, Chaos, Factor, degree_at};
use crate::surrogate::combinations::{Rows, unseen_combinations};
use crate::surrogate::extrapolation::ExtrapolationError;
use crate::surrogate::outputs::{Scale, ScaledOutput};
use crate::surrogate::{Effects, Expansion, Family, Term, choices, leading_terms};
use crate::uncertainty::{Estimate, Interval, Judgement, NORMAL_QUANTILE, OutputMoments};
use rayon::prelude::*;

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
        let Basis { parts, .. } = chaos.basis();
        let parts = (0..z.len()).map(|row| parts.get(row).copied().unwrap_or(usize::MAX)).collect();
        let rows = [Rows { quantiles: values.iter().map(|values| &values[..]).collect(), outputs: z, parts }];
        let unseen = unseen_combinations(chaos.terms(), chaos.rest, families, &rows);
        let extrapolation = ExtrapolationError::new(&expansions, families, z.len() as u64, chaos.rest, effects)
            .with_rare_counts(chaos.terms(), 1.0, families, effects)
            .with_any(unseen);
        let [expansion] = expansions;
        Self { chaos, expansion, extrapolation }
    }

    /// Returns the share of the variance that is left plus the error that no rows show.
    pub fn unknown(&self) -> f64 {
        self.chaos.rest + self.extrapolation.variance
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
        let all = Judged::new(fit, &self.effects);
        let (first_order, total) = (all.first_order(), all.total());
        let interactions: Vec<Index> =
            total.iter().zip(&first_order).map(|(total, first)| total.clone().plus(-1.0, first)).collect();
        let sum = |kind: &[Index], is_of| {
            let members = positions(layout, is_of).into_iter().map(|at| kind[at].clone());
            members.reduce(|sum, of| sum.plus(1.0, &of)).map_or_else(|| exactly(0.0), |sum| all.judge(&[sum]).remove(0))
        };
        let [of_factors, of_groups] = [Effect::is_input, Effect::is_group]
            .map(|is_of| IndexPair { first_order: sum(&first_order, is_of), total: sum(&total, is_of) });
        let shapley =
            if layout.shapley { all.judge(&all.shapley(&positions(layout, Effect::is_input))) } else { Vec::new() };
        let [first_order, total, interactions] = [first_order, total, interactions].map(|kind| all.judge(&kind));
        let effects = layout.effects.iter().enumerate().map(|(at, &effect)| {
            let read = |kind: &[Judgement]| match unread.get(at) {
                Some(true) => kind.get(at).map(|_| exactly(0.0)),
                _ => kind.get(at).cloned(),
            };
            let [first_order, total, interaction] =
                [&first_order, &total, &interactions].map(|kind| read(kind).unwrap_or_else(|| exactly(0.0)));
            let whole = if effect.is_group() { &of_groups } else { &of_factors };
            EffectQuantities {
                effect,
                shares: IndexPair {
                    first_order: share(&first_order, &whole.first_order),
                    total: share(&total, &whole.total),
                },
                check_gap: Judgement { estimate: Estimate::alone(0.0), ..exactly(0.0) },
                interaction,
                others: Vec::new(),
                of_mean: None,
                shapley: read(&shapley),
                first_order,
                total,
            }
        });
        let pairs = self.effects.pairs.iter().zip(all.judge(&all.pairs()));
        Quantities {
            effects: effects.collect(),
            sums: of_factors.clone(),
            redrawn: Vec::new(),
            pairs: pairs.map(|(&factors, value)| OfPair { factors, value }).collect(),
            mean_share: None,
        }
    }
}

/// Returns the positions of the effects of a kind.
fn positions(layout: &Layout, is_of: fn(Effect) -> bool) -> Vec<usize> {
    (0..layout.effects.len()).filter(|at| is_of(layout.effects[*at])).collect()
}

/// Returns 100 part/all, whose errors may add.
fn share(part: &Judgement, all: &Judgement) -> Judgement {
    let [(part, of_part), (all, of_all)] =
        [part, all].map(|of| (of.estimate.estimate, of.error.error * NORMAL_QUANTILE));
    about(100.0 * part / all, 100.0 * (of_part + part / all * of_all) / all, Vec::new())
}
