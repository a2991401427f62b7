//! Probabilities that follow from the errors: that a factor is first, and that it matters.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{ChiSquared, Distribution, StandardNormal};

use super::judgement::Judgement;
use super::standard_error::{PartInfluences, StandardError};
use super::{Estimate, NORMAL_QUANTILE, t_quantile};
use apportion_base::special::t_above;

/// Distance from the lead, in standard errors of both together, beyond which a quantity is not drawn: t of one degree
/// of freedom exceeds it once in 60 draws, of three once in 30000.
const OUT_OF_REACH: f64 = 40.0;

/// Estimates for each of `ranked` the probability that its true value is the largest of all, as far as the errors are
/// known: the share of draws from their joint distribution (Student's t, correlated as the influences of the parts are)
/// in which it is the largest. `seed` makes the `draws` repeatable. The probabilities sum to 1; with fewer than two
/// parts, unknown errors, or no draws, there are none.
pub(crate) fn probability_first(ranked: &[&Judgement], seed: u64, draws: usize) -> Option<Vec<f64>> {
    let lead = *ranked.iter().max_by(|a, b| a.estimate.estimate.total_cmp(&b.estimate.estimate))?;
    if draws == 0 || ranked.iter().any(|of| !of.error.error.is_finite() || of.error.freedom <= 0.0) {
        return None;
    }
    let rivals: Vec<usize> = (0..ranked.len()).filter(|&k| may_lead(ranked[k], lead)).collect();
    let mut wins = vec![0.0; ranked.len()];
    if let [only] = rivals[..] {
        wins[only] = 1.0;
        return Some(wins);
    }
    let directions = coordinates(rivals.iter().map(|&k| direction(&ranked[k].parts)).collect());
    let chi_squared = ChiSquared::new(lead.error.freedom).ok()?;
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut normals = vec![0.0; directions.iter().map(Vec::len).max().unwrap_or(0)];
    let mut values = vec![0.0; rivals.len()];
    for _ in 0..draws {
        normals.fill_with(|| StandardNormal.sample(&mut rng));
        let widening = (lead.error.freedom / chi_squared.sample(&mut rng)).sqrt();
        for ((value, direction), &k) in values.iter_mut().zip(&directions).zip(&rivals) {
            let z: f64 = direction.iter().zip(&normals).map(|(weight, z)| weight * z).sum();
            *value = ranked[k].estimate.estimate + ranked[k].error.error * widening * z;
        }
        let best = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        // Equal values share the draw.
        let share = 1.0 / values.iter().filter(|value| **value == best).count() as f64;
        for (&k, value) in rivals.iter().zip(&values) {
            wins[k] += if *value == best { share } else { 0.0 };
        }
    }
    Some(wins.into_iter().map(|wins| wins / draws as f64).collect())
}

/// Returns whether the true value of `of` may be larger than that of `lead`, the largest estimate.
fn may_lead(of: &Judgement, lead: &Judgement) -> bool {
    let reach = libm::hypot(of.error.error, lead.error.error) * OUT_OF_REACH;
    // A factor that provably has no effect is not first if any factor has one.
    let does_nothing = of.estimate.estimate == 0.0 && of.error.error == 0.0 && lead.estimate.estimate > 0.0;
    std::ptr::eq(of, lead) || (lead.estimate.estimate - of.estimate.estimate <= reach && !does_nothing)
}

/// Returns the influences of all parts, scaled to unit length; all zero for a quantity without any.
fn direction(parts: &PartInfluences) -> Vec<f64> {
    let size = parts.iter().flatten().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    let length = parts.iter().flatten().map(|x| (x / size).powi(2)).sum::<f64>().sqrt() * size;
    parts.iter().flatten().map(|x| if size > 0.0 { x / length } else { 0.0 }).collect()
}

/// Returns the same directions in a basis of minimal dimension: each in terms of those before it and a new one (Gram
/// and Schmidt), so that no more normal numbers have to be drawn than there are directions.
fn coordinates(directions: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    /// A remainder of this length is rounding.
    const SPANNED: f64 = 1e-12;
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let mut all = Vec::with_capacity(directions.len());
    for mut rest in directions {
        let mut coordinates = Vec::with_capacity(basis.len() + 1);
        for axis in &basis {
            let along: f64 = rest.iter().zip(axis).map(|(x, axis)| x * axis).sum();
            rest.iter_mut().zip(axis).for_each(|(x, axis)| *x -= along * axis);
            coordinates.push(along);
        }
        let length = rest.iter().map(|x| x * x).sum::<f64>().sqrt();
        if length > SPANNED {
            basis.push(rest.into_iter().map(|x| x / length).collect());
            coordinates.push(length);
        } else if coordinates.iter().all(|along| *along == 0.0) {
            // The error of a quantity that no part moves is independent of the others.
            basis.push(rest);
            coordinates.push(1.0);
        }
        all.push(coordinates);
    }
    all
}

/// Returns the probability that the true value is above `threshold`, by Student's t about the estimate; `None` if the
/// error is unknown. If the interval reaches further towards the threshold than the error alone implies, so does the t
/// distribution: a threshold at an end of the interval has 2.5 % beyond it.
pub fn probability_above(estimate: Estimate, error: StandardError, threshold: f64) -> Option<f64> {
    let Estimate { estimate, interval } = estimate;
    let reach = interval.map_or(0.0, |i| if threshold < estimate { estimate - i.low } else { i.high - estimate });
    if error.error == 0.0 && reach <= 0.0 {
        return Some(f64::from(u8::from(estimate > threshold)));
    }
    let freedom = if error.freedom > 0.0 { error.freedom } else { f64::INFINITY };
    let of_interval = reach / t_quantile(freedom).unwrap_or(NORMAL_QUANTILE);
    let is_known = (error.freedom > 0.0 || of_interval > 0.0) && error.error.is_finite();
    // An interval from the error itself differs from it by rounding.
    let scale = if of_interval > error.error * (1.0 + 1e-9) { of_interval } else { error.error };
    is_known.then(|| t_above((threshold - estimate) / scale, freedom))
}

#[cfg(test)]
#[path = "tests/ranks.rs"]
mod tests;
