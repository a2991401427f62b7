//! The factors of a kernel copula one after another, each drawn given those before it.

use std::f64::consts::TAU;
use std::sync::LazyLock;

use nalgebra::DMatrix;

use super::CholeskyFactor;
use crate::special::{normal_below, normal_quantile};

/// A mixture of normal distributions of one covariance `width`^2 S around centres, its factors in some order.
///
/// With S = L L' the coordinates e = L^-1 z make every kernel a product of normal distributions of standard deviation `width`, so that
/// the distribution of the next e given those before it is a mixture as well, whose weights are what each kernel has at those.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Chain {
    width: f64,
    lower: CholeskyFactor,
    /// e of the centres, a list for each factor.
    centres: Vec<Vec<f64>>,
}

/// Kernels that have less than this part of the largest weight, as a logarithm, count for nothing: e^-42 = 6e-19.
const LEAST_LOG_WEIGHT: f64 = -42.0;

impl Chain {
    /// The mixture with these centres, a list of scores for each factor, taken in `order`. `correlation` is S, positive definite.
    pub fn new(width: f64, correlation: &DMatrix<f64>, centres: &[Vec<f64>], order: &[usize]) -> Self {
        let lower = CholeskyFactor::new(order.len(), |row, column| correlation[(order[row], order[column])]);
        let mut whitened: Vec<Vec<f64>> = Vec::with_capacity(order.len());
        for (row, &factor) in order.iter().enumerate() {
            let mut own = centres[factor].clone();
            let weights = lower.row(row);
            for (before, weight) in whitened.iter().zip(weights) {
                own.iter_mut().zip(before).for_each(|(own, before)| *own -= weight * before);
            }
            own.iter_mut().for_each(|own| *own /= weights[row]);
            whitened.push(own);
        }
        Self { width, lower, centres: whitened }
    }

    /// e of the scores of the first factors, in the order of the chain.
    pub fn whiten(&self, scores: &[f64]) -> Vec<f64> {
        self.lower.whiten(scores)
    }

    /// The score of the factor at `place` of a point with this e, which may end there.
    pub fn score(&self, place: usize, e: &[f64]) -> f64 {
        self.lower.score(place, e)
    }

    /// What the factors from place `given` on have beside those before them: normal scores that are independent of these and of each
    /// other.
    pub fn innovations(&self, e: &[f64], given: usize) -> Vec<f64> {
        let mut weights = self.weights(&e[..given]);
        let mut innovations = Vec::with_capacity(e.len() - given);
        for (e, centres) in e.iter().zip(&self.centres).skip(given) {
            innovations.push(weights.mixture(centres, self.width).normal_score(*e));
            weights.condition(centres, *e, self.width);
        }
        innovations
    }

    /// The point that begins with `given` and goes on with these innovations.
    pub fn point(&self, given: &[f64], innovations: &[f64]) -> Vec<f64> {
        let mut weights = self.weights(given);
        let mut e = given.to_vec();
        for (place, innovation) in (given.len()..).zip(innovations) {
            let centres = &self.centres[place];
            e.push(weights.mixture(centres, self.width).quantile(*innovation));
            if place + 1 < self.centres.len() {
                weights.condition(centres, e[place], self.width);
            }
        }
        e
    }

    fn weights(&self, given: &[f64]) -> Weights {
        let mut weights = Weights::new(self.centres[0].len());
        given.iter().zip(&self.centres).for_each(|(e, centres)| weights.condition(centres, *e, self.width));
        weights
    }
}

/// The kernels that count, with their weights.
struct Weights {
    kernels: Vec<usize>,
    logarithms: Vec<f64>,
    weights: Vec<f64>,
}

impl Weights {
    fn new(kernels: usize) -> Self {
        Self { kernels: (0..kernels).collect(), logarithms: vec![0.0; kernels], weights: vec![1.0; kernels] }
    }

    /// Given that the next coordinate is `e`.
    fn condition(&mut self, centres: &[f64], e: f64, width: f64) {
        let Self { kernels, logarithms, weights } = self;
        for (kernel, logarithm) in kernels.iter().zip(logarithms.iter_mut()) {
            *logarithm -= 0.5 * ((e - centres[*kernel]) / width).powi(2);
        }
        let largest = logarithms.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let mut counts = logarithms.iter().map(|logarithm| logarithm - largest > LEAST_LOG_WEIGHT);
        kernels.retain(|_| counts.next().unwrap_or(false));
        logarithms.retain(|logarithm| logarithm - largest > LEAST_LOG_WEIGHT);
        logarithms.iter_mut().for_each(|logarithm| *logarithm -= largest);
        weights.clear();
        weights.extend(logarithms.iter().map(|&logarithm| libm::exp(logarithm)));
    }

    fn mixture(&self, centres: &[f64], width: f64) -> Mixture<'_> {
        let centres = self.kernels.iter().map(|&kernel| centres[kernel]).collect();
        Mixture { centres, weights: &self.weights, width }
    }
}

/// A mixture of normal distributions of one width on a line.
pub(super) struct Mixture<'a> {
    pub centres: Vec<f64>,
    pub weights: &'a [f64],
    pub width: f64,
}

/// A normal distribution has less than 1e-22 beyond so many standard deviations, which is nothing beside 1; nor is there anything
/// beside 2^-64 beyond so many below.
const FARTHEST: f64 = 10.0;
const FARTHEST_BELOW: f64 = -14.0;

/// Values of [`kernel`] from [`FARTHEST_BELOW`] to [`FARTHEST`], so many for each unit.
static KERNEL: LazyLock<Vec<(f64, f64)>> = LazyLock::new(|| {
    let of_place = |k: usize| {
        let z = FARTHEST_BELOW + k as f64 / PER_UNIT;
        (normal_below(z), libm::exp(-0.5 * z * z) / TAU.sqrt())
    };
    (0..=((FARTHEST - FARTHEST_BELOW) * PER_UNIT) as usize).map(of_place).collect()
});
const PER_UNIT: f64 = 64.0;

/// The distribution function and the density of the standard normal distribution between [`FARTHEST_BELOW`] and [`FARTHEST`], to
/// relative errors of 1e-15 in the middle and 1e-10 in the tail, quicker than by an error function: by Taylor's series
/// around the nearest value of a table, whose terms are Hermite polynomials.
fn kernel(z: f64) -> (f64, f64) {
    let place = ((z - FARTHEST_BELOW) * PER_UNIT + 0.5) as usize;
    let (below, density) = KERNEL[place];
    let nearest = FARTHEST_BELOW + place as f64 / PER_UNIT;
    let away = z - nearest;
    let (mut last, mut hermite) = (1.0, nearest);
    // (-away)^k/k! of the term k of the density, from k = 1 on.
    let mut power = -away;
    let (mut of_density, mut of_below) = (1.0 + power * hermite, away * (1.0 + power * hermite / 2.0));
    for k in 1..TERMS {
        let order = f64::from(k);
        (last, hermite) = (hermite, nearest * hermite - order * last);
        power *= -away / (order + 1.0);
        of_density += power * hermite;
        of_below += away * power * hermite / (order + 2.0);
    }
    (below + density * of_below, density * of_density)
}
const TERMS: u32 = 6;

/// A step of Newton's shorter than this part of the width leaves an error of its square.
const LAST_STEP: f64 = 1e-7;

/// Beyond this score double precision knows no probabilities.
const LARGEST_SCORE: f64 = 37.0;

impl Mixture<'_> {
    /// Its distribution function at `x` and its density, both times the sum of the weights. `sign` -1 is that of the mixture seen in
    /// a mirror.
    fn below(&self, x: f64, sign: f64) -> (f64, f64) {
        let (mut below, mut density) = (0.0, 0.0);
        for (centre, weight) in self.centres.iter().zip(self.weights) {
            let z = (x - sign * centre) / self.width;
            if z > FARTHEST {
                below += weight;
            } else if z > FARTHEST_BELOW {
                let (of_kernel, density_of_kernel) = kernel(z);
                below += weight * of_kernel;
                density += weight * density_of_kernel;
            }
        }
        (below, density / self.width)
    }

    /// The normal score of its distribution function at `x`, precise in both tails.
    pub fn normal_score(&self, x: f64) -> f64 {
        let sum: f64 = self.weights.iter().sum();
        let below = self.below(x, 1.0).0;
        let score = if below <= 0.5 * sum {
            normal_quantile(below / sum)
        } else {
            -normal_quantile(self.below(-x, -1.0).0 / sum)
        };
        score.clamp(-LARGEST_SCORE, LARGEST_SCORE)
    }

    /// The derivative of the normal score at `x`, where that is `score`.
    pub fn slope(&self, x: f64, score: f64) -> f64 {
        let sum: f64 = self.weights.iter().sum();
        self.below(x, 1.0).1 / sum * TAU.sqrt() * libm::exp(0.5 * score * score)
    }

    /// Where its distribution function has this normal score.
    pub fn quantile(&self, score: f64) -> f64 {
        let sign = if score > 0.0 { -1.0 } else { 1.0 };
        let score = score * sign;
        let sum: f64 = self.weights.iter().sum();
        let target = normal_below(score) * sum;
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        let (mut mean, mut squares) = (0.0, 0.0);
        for (centre, weight) in self.centres.iter().zip(self.weights) {
            let centre = sign * centre;
            (low, high) = (low.min(centre), high.max(centre));
            mean += weight * centre;
            squares += weight * centre * centre;
        }
        mean /= sum;
        let sd = ((squares / sum - mean * mean).max(0.0) + self.width * self.width).sqrt();
        // All of its kernels lie between the first and the last one.
        (low, high) = (low + self.width * score, high + self.width * score);
        let mut x = (mean + sd * score).clamp(low, high);
        // Newton's steps for the logarithm, which is nearly straight in a tail, kept inside a bracket.
        for _ in 0..200 {
            let (below, density) = self.below(x, sign);
            if below < target {
                low = x;
            } else {
                high = x;
            }
            let step = below * libm::log(below / target) / density;
            let next = x - step;
            let is_inside = next > low && next < high;
            if is_inside && step.abs() < LAST_STEP * self.width {
                return sign * next;
            }
            x = if is_inside { next } else { 0.5 * (low + high) };
            if high - low <= 4.0 * f64::EPSILON * x.abs().max(self.width) {
                break;
            }
        }
        sign * x
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kernels_are_normal_distributions() {
        for k in 0..=4800 {
            let z = -13.99 + f64::from(k) * 0.004_997;
            let (below, density) = kernel(z);
            let exact = [normal_below(z), libm::exp(-0.5 * z * z) / TAU.sqrt()];
            let bound = 2e-15 * (0.3 * z * z).exp().min(1e5);
            assert!((below / exact[0] - 1.0).abs() < bound, "{z}: {below} {exact:?}");
            assert!((density / exact[1] - 1.0).abs() < 100.0 * bound, "{z}: {density} {exact:?}");
        }
    }

    #[test]
    fn quantiles_of_mixtures_are_inverse_in_both_tails() {
        let mixtures = [
            (vec![0.0], vec![1.0], 1.0),
            (vec![-3.0, 0.1, 2.5, 2.6], vec![1.0, 1e-9, 0.3, 0.1], 0.05),
            ((0..500).map(|k| normal_quantile((f64::from(k) + 0.5) / 500.0)).collect(), vec![1.0; 500], 0.3),
        ];
        for (centres, weights, width) in mixtures {
            let mixture = Mixture { centres, weights: &weights, width };
            for score in [-9.0, -8.0, -3.0, -0.8, 0.0, 1e-9, 0.5, 2.0, 7.0, 8.1] {
                let x = mixture.quantile(score);
                let again = mixture.normal_score(x);
                // Between two far kernels the score hardly moves with x.
                assert!((again - score).abs() < 2e-12 * (1.0 + score.abs()), "{score} {x} {again}");
            }
        }
    }

    #[test]
    fn one_wide_kernel_is_a_normal_distribution() {
        let correlation = DMatrix::from_row_slice(3, 3, &[1.0, 0.5, -0.2, 0.5, 1.0, 0.4, -0.2, 0.4, 1.0]);
        let chain = Chain::new(1.0, &correlation, &vec![vec![0.0; 40]; 3], &[2, 0, 1]);
        let scores = [0.7, -1.3, 2.0];
        let e = chain.whiten(&scores);
        let innovations = chain.innovations(&e, 1);
        assert!(innovations.iter().zip(&e[1..]).all(|(a, b)| (a - b).abs() < 1e-14), "{innovations:?} {e:?}");
        let point = chain.point(&e[..1], &innovations);
        for (place, score) in scores.iter().enumerate() {
            assert!((chain.score(place, &point) - score).abs() < 1e-14);
        }
        // The regression of the second on the first: -0.2.
        assert!((e[1] - (-1.3 + 0.2 * 0.7) / (1.0f64 - 0.04).sqrt()).abs() < 1e-15);
    }

    #[test]
    fn points_come_back_from_their_innovations() {
        let centres: Vec<Vec<f64>> =
            (0..3).map(|j| (0..60).map(|k| libm::sin(f64::from(k * (j + 3))) * 1.7).collect()).collect();
        let correlation = DMatrix::from_row_slice(3, 3, &[1.0, 0.1, -0.2, 0.1, 1.0, 0.0, -0.2, 0.0, 1.0]);
        let chain = Chain::new(0.2, &correlation, &centres, &[1, 2, 0]);
        for scores in [[0.3, 0.4, -1.1], [-1.9, 1.2, 0.0], [3.0, -3.0, 2.0]] {
            let e = chain.whiten(&scores);
            for given in 0..3 {
                let again = chain.point(&e[..given], &chain.innovations(&e, given));
                assert!(again.iter().zip(&e).all(|(a, b)| (a - b).abs() < 1e-9), "{given}: {again:?} {e:?}");
            }
        }
    }
}
