//! Indices of a surrogate of plain rows, sums of the variances of its sets of factors, and their errors.

use apportion_base::sum::{add_scaled, mean, product};

use super::held_out::{HeldOut, Spread};
use super::plain::PlainFit;
use crate::surrogate::extrapolation::ExtrapolationError;
use crate::surrogate::{Effects, is_interaction, touches, within};
use crate::uncertainty::{Estimate, Interval, Judgement, NORMAL_QUANTILE, StandardError};

/// Degrees of freedom of errors that are not those of a few nets.
const FREEDOM: f64 = 1e6;

/// An index: a share of the variance.
#[derive(Clone)]
pub(crate) struct Index {
    /// The part of the variance of each set of factors that is in it.
    weights: Vec<f64>,
    /// Its part of the variance of the output.
    pub variance: f64,
    /// The same as a share, by the fits without each part of the rows.
    pub of_parts: Vec<f64>,
    /// The variance of the output.
    whole: f64,
    /// The error of its part of the variance by the tails of the factors.
    beyond: f64,
}

impl Index {
    /// Returns the sum of this index and a multiple of another one.
    pub fn plus(mut self, factor: f64, other: &Self) -> Self {
        add_scaled(&mut self.weights, factor, &other.weights);
        add_scaled(&mut self.of_parts, factor, &other.of_parts);
        self.variance += factor * other.variance;
        self.beyond += factor.max(0.0) * other.beyond;
        self
    }
}

/// The variances of the sets of factors of a fit, and of the fits without each part of the rows.
pub(crate) struct Judged<'a> {
    fit: &'a PlainFit,
    effects: &'a Effects,
    held_out: HeldOut<'a>,
    variances: Vec<f64>,
    of_parts: Vec<Vec<f64>>,
}

impl<'a> Judged<'a> {
    pub fn new(fit: &'a PlainFit, effects: &'a Effects) -> Self {
        let (variances, of_parts) = fit.chaos.variances_of_sets();
        Self { fit, effects, held_out: HeldOut::new(&fit.chaos), variances, of_parts }
    }

    /// Returns the first-order index of each swap.
    pub fn first_order(&self) -> Vec<Index> {
        let all = self.effects.swaps.iter().zip(&self.fit.extrapolation.first_order);
        all.map(|(swap, beyond)| self.index(|set| share_if(within(set, swap)), self.whole(), *beyond)).collect()
    }

    /// Returns the total index of each swap. What the surrogate leaves is rather an interaction than a part of one factor
    /// alone, and the more it is, the rather noise.
    pub fn total(&self) -> Vec<Index> {
        let rest = self.fit.chaos.rest;
        let whole = self.fit.chaos.variances.all + rest * rest;
        let all = self.effects.swaps.iter().zip(&self.fit.extrapolation.total);
        all.map(|(swap, beyond)| self.index(|set| share_if(touches(set, swap)), whole, *beyond)).collect()
    }

    /// Returns the second-order index of each pair of swaps.
    pub fn pairs(&self) -> Vec<Index> {
        let Effects { swaps, pairs } = self.effects;
        let all = pairs.iter().zip(&self.fit.extrapolation.pairs);
        all.map(|(&(j, k), beyond)| {
            self.index(|set| share_if(is_interaction(set, &swaps[j], &swaps[k])), self.whole(), *beyond)
        })
        .collect()
    }

    /// Returns the Shapley effects of the swaps at some positions, which have all factors.
    pub fn shapley(&self, players: &[usize]) -> Vec<Index> {
        let swaps = &self.effects.swaps;
        let all = players.iter().map(|player| {
            let part = |set: &[usize]| {
                let sharers = players.iter().filter(|other| touches(set, &swaps[**other])).count().max(1);
                share_if(touches(set, &swaps[*player])) / sharers as f64
            };
            self.index(part, self.fit.chaos.variances.all, self.fit.extrapolation.total[*player])
        });
        all.collect()
    }

    fn whole(&self) -> f64 {
        self.fit.chaos.variances.all + self.fit.chaos.rest
    }

    fn index(&self, part: impl Fn(&[usize]) -> f64, whole: f64, beyond: f64) -> Index {
        let weights: Vec<f64> = self.fit.chaos.sets().iter().map(|set| part(set)).collect();
        let share = |of: &Vec<f64>| product(&weights, of) / of.iter().sum::<f64>().max(f64::MIN_POSITIVE);
        let of_parts = self.of_parts.iter().map(share).collect();
        Index { variance: product(&weights, &self.variances), of_parts, weights, whole, beyond }
    }

    /// Computes indices of one kind.
    pub fn judge(&self, kind: &[Index]) -> Vec<Judgement> {
        let spread = |of: &Index| self.held_out.spread(&of.weights, of.variance / of.whole, &of.of_parts);
        let half_widths = self.held_out.half_widths(&kind.iter().map(spread).collect::<Vec<Spread>>());
        let all = kind.iter().zip(half_widths).map(|(of, half)| {
            let value = of.variance / of.whole;
            let ExtrapolationError { variance, of_any, .. } = self.fit.extrapolation;
            // Where no row is, the surrogate may claim any variance.
            let tails = (of.beyond + value * variance) / self.whole() + of_any / self.whole().min(1.0);
            let centre = mean(&of.of_parts);
            about(value, half + tails, of.of_parts.iter().map(|share| centre - share).collect())
        });
        all.collect()
    }
}

fn share_if(is_in: bool) -> f64 {
    f64::from(u8::from(is_in))
}

pub(super) fn about(estimate: f64, half: f64, parts: Vec<f64>) -> Judgement {
    let interval = Some(Interval::about(estimate, half));
    let error = StandardError { error: half / NORMAL_QUANTILE, freedom: FREEDOM };
    Judgement::new(Estimate { estimate, interval }, error, vec![parts])
}

pub(super) fn exactly(estimate: f64) -> Judgement {
    about(estimate, 0.0, Vec::new())
}
