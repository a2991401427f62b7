//! Derivative-based measures, and the bounds on total indices that follow from them.

use std::f64::consts::PI;

use super::ScreenedFactor;
use super::points::TAIL;
use crate::space::Distribution;
use crate::sum::{centred_product, mean};
use crate::uncertainty::{Estimate, jackknife};

/// The measures of the derivatives by one factor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct DerivativeMeasures {
    /// nu: the mean square of the derivative (Sobol' and Kucherenko 2009, Math. Comput. Simul. 79, 3009-3017), in the square of
    /// the output's unit per unit of the factor.
    pub nu: Estimate,
    /// C nu/V, an upper bound of the total index, with the variance V of the output and the constant C of
    /// [`poincare_constant`]; `None` if there is no such constant, or no variance.
    pub total_bound: Option<Estimate>,
}

/// Returns the range of a factor in its unit, by which derivatives are multiplied so that they can be compared: that of
/// its values, or on an unbounded side to its quantile at 0.001 or 0.999.
pub fn range(distribution: &Distribution) -> f64 {
    let (low, high) = distribution.support();
    let end = |bound: f64, u: f64| if bound.is_finite() { bound } else { distribution.quantile(u) };
    end(high, 1.0 - TAIL) - end(low, TAIL)
}

/// Returns a constant C of the Poincare inequality Var g(X) <= C E g'(X)^2 of a distribution, in the square of its
/// unit: then the total index of a factor is at most C nu/V (Lamboni, Iooss, Popelin and Gamboa 2013, Math. Comput.
/// Simul. 87, 45-54, theorem 3.1). `None` for distributions without a known constant.
///
/// The constants of uniform, (b - a)^2/pi^2, normal, sd^2, and exponential distributions, 4 scale^2, are optimal.
/// Distributions on an interval with log-concave densities also have that of the uniform one (Payne and Weinberger
/// 1960, Arch. Ration. Mech. Anal. 5, 286-292), and a truncated normal distribution has that of the normal one (Bakry
/// and Emery 1985).
pub fn poincare_constant(distribution: &Distribution) -> Option<f64> {
    let of_interval = || {
        let (low, high) = distribution.support();
        ((high - low) / PI).powi(2)
    };
    match distribution {
        Distribution::Constant(_) => Some(0.0),
        Distribution::Uniform(_) | Distribution::Triangular(_) => Some(of_interval()),
        Distribution::Normal(_) => Some(distribution.sd().powi(2)),
        Distribution::Truncated(truncated) if matches!(truncated.law(), Distribution::Normal(_)) => {
            // That of the normal distribution before truncation.
            Some(truncated.law().sd().powi(2).min(of_interval())).filter(|constant| constant.is_finite())
        }
        Distribution::Exponential(_) => Some(4.0 * distribution.sd().powi(2)),
        _ => None,
    }
}

/// Returns the sum of the upper bounds of the total indices, by the intervals; `None` if a factor has no bound.
///
/// Total indices of independent factors sum to at least 1: a smaller sum shows that the derivatives at the base points
/// have missed a cause of the variation of the output, a step or a steep place between them.
pub(super) fn sum_of_bounds(factors: &[ScreenedFactor]) -> Option<f64> {
    let high = |factor: &ScreenedFactor| {
        let Estimate { estimate, interval } = factor.total_bound?;
        Some(interval.map_or(estimate, |interval| interval.high))
    };
    factors.iter().map(high).sum()
}

/// Computes the measures from `effects`, derivatives per `range` of the factor (NaN if missing), whose base points have
/// the outputs `base`, in `parts` independent parts of equal length. `None` for fewer than two effects, or overflow.
pub(super) fn derivative_measures(
    effects: &[f64],
    base: &[f64],
    parts: usize,
    range: f64,
    constant: Option<f64>,
) -> Option<DerivativeMeasures> {
    let part = effects.len() / parts.max(1);
    let quantities = |left_out: std::ops::Range<usize>| -> Option<Vec<f64>> {
        let kept = |values: &[f64]| -> Vec<f64> {
            let of_others = values[..left_out.start].iter().chain(&values[left_out.end..]);
            of_others.copied().filter(|value| value.is_finite()).collect()
        };
        let (effects, base) = (kept(effects), kept(base));
        // In units of the largest, so that squares neither underflow nor overflow.
        let size = effects.iter().fold(0.0, |largest: f64, effect| largest.max(effect.abs()));
        let unit = if size > 0.0 { size } else { 1.0 };
        let scaled: Vec<f64> = effects.iter().map(|effect| (effect / unit).powi(2)).collect();
        let square = mean(&scaled);
        let per_unit = if range > 0.0 { unit / range } else { 0.0 };
        let nu = square * per_unit * per_unit;
        let centre = mean(&base);
        let spread: Vec<f64> = base.iter().map(|y| (y - centre) / unit).collect();
        let variance = centred_product((&spread, 0.0), (&spread, 0.0)) / base.len() as f64;
        let bound = constant.map_or(f64::NAN, |constant| {
            let part_of_range = if range > 0.0 { constant / range / range } else { 0.0 };
            part_of_range * square / variance
        });
        (effects.len() >= 2 && nu.is_finite()).then(|| vec![nu, if variance > 0.0 { bound } else { f64::NAN }])
    };
    let whole = quantities(0..0)?;
    let without: Option<Vec<Vec<f64>>> = (0..parts).map(|p| quantities(p * part..(p + 1) * part)).collect();
    let estimates = jackknife(&whole, &without.unwrap_or_default());
    let &[nu, total_bound] = &estimates[..] else { return None };
    Some(DerivativeMeasures { nu, total_bound: Some(total_bound).filter(|bound| bound.estimate.is_finite()) })
}

#[cfg(test)]
mod tests;
