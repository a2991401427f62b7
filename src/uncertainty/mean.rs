//! Corrected indices of the mean of a stochastic model over its noise.
//!
//! The mean has the variance V(E[y|x]) = V (1 - ST_n), n the noise. Its closed first-order indices are S/(1 - ST_n),
//! since the noise adds nothing to the variance of E[y|x_s]; its total indices are (ST_sn - ST_n)/(1 - ST_n), since all
//! effects of the other factors without s and the noise have the variance V (1 - ST_sn).

use super::estimates::{Layout, Number, Quantity, SwapNoise};
use super::influence::Influenced;
use super::noise::{Noise, Replacement};
use super::{Estimate, Interval, StandardError};

/// Estimates for the mean of a stochastic model over its noise, E[y|x]. The first-order and total index of the noise
/// itself, which refer to the variance of a single run, are among those of the factors.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct NoiseIndices {
    /// The index of the factor that is the noise.
    pub factor: usize,
    /// V(E[y|x])/V(y) = 1 - ST of the noise: the share of the variance of a single run that is variance of the mean.
    pub mean_share: Estimate,
    /// The indices of the mean, in the order of the swaps: of factors, groups, subsets and the dummy; `None` for those
    /// that contain the noise.
    pub of_mean: Vec<Option<MeanEstimates>>,
}

/// The indices of a factor, group or subset of the mean over the noise.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct MeanEstimates {
    /// (Closed) first-order index: S/(1 - ST of the noise). `None` if the runs show no variance of the mean.
    pub first_order: Option<Estimate>,
    /// Total index; `None` without the joint index with the noise, from which it follows.
    pub total: Option<Estimate>,
}

/// The corrected indices: all of one kind, and that of the noise; `None` for a kind whose plain ones stay.
pub(super) struct Corrected<'a> {
    pub first_order: Option<(&'a [Influenced], Noise)>,
    pub total: Option<(&'a [Influenced], Noise)>,
}

/// Calls `put` with the replacements of the indices of the mean among the `plain` numbers of `layout`.
pub(super) fn corrected(
    layout: &Layout,
    corrected: &Corrected<'_>,
    plain: &[Estimate],
    errors: &[StandardError],
    put: &mut dyn FnMut(usize, Replacement),
) {
    let Some(noise) = &layout.noise else { return };
    let share_place = layout.place(Quantity::MeanShare);
    let of_noise = corrected.total.as_ref().map(|(list, of_kind)| (&list[noise.factor], of_kind.even()));
    let share = match &of_noise {
        None => plain[share_place],
        Some((of_noise, of_kind)) => {
            let share = Influenced::linear(1.0 - of_noise.estimate, &[(-1.0, *of_noise)]);
            let new = of_kind.replacement(&share);
            let estimate = new.0;
            put(share_place, new);
            estimate
        }
    };
    let exists = share.estimate > 0.0;
    for (swap, beside) in noise.swaps.iter().enumerate().filter(|(_, beside)| **beside != SwapNoise::Holds) {
        let [place, total_place] =
            [Quantity::MeanFirstOrder(swap), Quantity::MeanTotal(swap)].map(|name| layout.place(name));
        let nothing = || (Estimate::alone(f64::NAN), errors[place], Vec::new());
        // Errors of unknown correlation may be larger than those of the plain index, whose correlation is known.
        let width = |of: Estimate| of.interval.map_or(f64::INFINITY, Interval::width);
        let mut put_narrower = |index: Estimate| {
            if width(index) < width(plain[place]) {
                put(place, (index, errors[place], Vec::new()));
            }
        };
        match (&corrected.first_order, &of_noise) {
            (None, None) => (),
            _ if !exists => put(place, nothing()),
            (Some((first, _)), Some((of_noise, of_kind))) => {
                let of = &first[swap];
                let index = of.estimate / share.estimate;
                let terms = [(1.0 / share.estimate, of), (index / share.estimate, *of_noise)];
                put(place, of_kind.replacement(&Influenced::linear(index, &terms)));
            }
            (Some((first, of_kind)), None) => put_narrower(quotient(of_kind.estimate(&first[swap]), share)),
            (None, Some(_)) => {
                let first = plain[layout.place(Quantity::Swap(swap, Number::FirstOrder))];
                put_narrower(quotient(first, share));
            }
        }
        let (SwapNoise::With(joined), Some((of_noise, of_kind)), Some((total, _))) =
            (*beside, &of_noise, &corrected.total)
        else {
            continue;
        };
        if !exists {
            put(total_place, nothing());
            continue;
        }
        let index = (total[joined].estimate - of_noise.estimate) / share.estimate;
        let terms = [(1.0 / share.estimate, &total[joined]), ((index - 1.0) / share.estimate, *of_noise)];
        put(total_place, of_kind.replacement(&Influenced::linear(index, &terms)));
    }
}

/// Returns the quotient of two numbers of unknown joint distribution, whose errors are of independent kinds.
fn quotient(a: Estimate, b: Estimate) -> Estimate {
    let estimate = a.estimate / b.estimate;
    let interval = a.interval.zip(b.interval).map(|(of_a, of_b)| {
        let reach = |of_a: f64, of_b: f64| libm::hypot(of_a / b.estimate, estimate * of_b / b.estimate);
        Interval {
            low: estimate - reach(a.estimate - of_a.low, of_b.high - b.estimate),
            high: estimate + reach(of_a.high - a.estimate, b.estimate - of_b.low),
        }
    });
    Estimate { estimate, interval }
}

#[cfg(test)]
mod tests;
