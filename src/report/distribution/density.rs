//! Kernel density with a bandwidth from the data.

use std::f64::consts::PI;

use super::{BandwidthRule, Density, Sample};

/// Cells into which values are binned before any sum over kernels.
const CELLS: usize = 1000;
/// Intervals between the places at which the density is given.
const STEPS: usize = 256;
/// Fewest values for the plug-in rule.
const FEWEST: usize = 20;
/// Kernels are taken for zero this many bandwidths away.
const KERNEL_REACH: f64 = 8.0;

/// The density of a sample, in the scale of its values.
pub(super) fn of(sample: &Sample<'_>) -> Density {
    let cells = Cells::of(sample);
    let (bandwidth, rule) = match plug_in(sample, &cells) {
        Some(bandwidth) => (bandwidth, BandwidthRule::SheatherJones),
        None => (silverman(sample), BandwidthRule::Silverman),
    };
    // A kernel narrower than the cells would show the cells.
    let bandwidth = bandwidth.max(cells.width);
    let (low, high) = sample.reach;
    let ends = (sample.sorted[0], sample.sorted[sample.sorted.len() - 1]);
    let x: Vec<f64> = (0..=STEPS).map(|k| low + (high - low) * k as f64 / STEPS as f64).collect();
    let factor = 1.0 / (sample.n() * bandwidth * (2.0 * PI).sqrt());
    let density = x.iter().map(|&x| factor * cells.kernel_sum(x, bandwidth, ends)).collect();
    Density { bandwidth, rule, x, density }
}

fn silverman(sample: &Sample<'_>) -> f64 {
    let spread = if sample.iqr > 0.0 { sample.sd.min(sample.iqr / 1.34) } else { sample.sd };
    0.9 * spread * libm::pow(sample.n(), -0.2)
}

/// Values counted in equal cells over the reach of the sample, each shared between the middles of the two cells next to
/// it.
struct Cells {
    low: f64,
    width: f64,
    weights: Vec<f64>,
    count: usize,
}

impl Cells {
    fn of(sample: &Sample<'_>) -> Self {
        let (low, high) = sample.reach;
        let width = (high - low) / CELLS as f64;
        let mut weights = vec![0.0; CELLS + 1];
        let (values, ..) = sample.within();
        for &value in values {
            let place = ((value - low) / width).clamp(0.0, CELLS as f64);
            let cell = (place as usize).min(CELLS - 1);
            weights[cell] += 1.0 - (place - cell as f64);
            weights[cell + 1] += place - cell as f64;
        }
        Self { low, width, weights, count: values.len() }
    }

    /// Sum of unnormalised kernels at `x`, with those of the values mirrored in both `ends`.
    fn kernel_sum(&self, x: f64, bandwidth: f64, ends: (f64, f64)) -> f64 {
        [x, 2.0 * ends.0 - x, 2.0 * ends.1 - x].into_iter().map(|x| self.plain_kernel_sum(x, bandwidth)).sum()
    }

    fn plain_kernel_sum(&self, x: f64, bandwidth: f64) -> f64 {
        let place = |x: f64| ((x - self.low) / self.width).clamp(0.0, CELLS as f64);
        let from = place(x - KERNEL_REACH * bandwidth).floor() as usize;
        let to = place(x + KERNEL_REACH * bandwidth).ceil() as usize;
        let kernel = |k: usize| {
            let t = (x - self.low - k as f64 * self.width) / bandwidth;
            self.weights[k] * libm::exp(-0.5 * t * t)
        };
        (from..=to).map(kernel).sum()
    }

    /// Number of pairs of values by their distance in cells, from 0.
    fn pairs_by_lag(&self) -> Vec<f64> {
        let w = &self.weights;
        let at = |lag: usize| w.iter().zip(&w[lag..]).map(|(a, b)| a * b).sum::<f64>();
        let mut pairs: Vec<f64> = (0..w.len()).map(at).collect();
        pairs[0] = 0.5 * (pairs[0] - self.count as f64);
        pairs
    }
}

/// Estimate of the integral of the r-th derivative of the density times the density, by kernels of bandwidth `h`:
/// `hermite` is the r-th Hermite polynomial in the square of its argument (for even r), r its order.
struct Functional {
    order: i32,
    hermite: fn(f64) -> f64,
}

const FOURTH: Functional = Functional { order: 4, hermite: |s| s * s - 6.0 * s + 3.0 };
const SIXTH: Functional = Functional { order: 6, hermite: |s| s * s * s - 15.0 * s * s + 45.0 * s - 15.0 };

impl Functional {
    fn at(&self, pairs: &[f64], (n, cell, h): (f64, f64, f64)) -> f64 {
        let term = |lag: usize| {
            let s = (lag as f64 * cell / h).powi(2);
            libm::exp(-0.5 * s) * (self.hermite)(s)
        };
        let sum: f64 = pairs.iter().enumerate().map(|(lag, count)| count * term(lag)).sum();
        (2.0 * sum + n * term(0)) / (n * (n - 1.0) * h.powi(self.order + 1) * (2.0 * PI).sqrt())
    }
}

/// The direct plug-in bandwidth of two stages; `None` where it has no answer.
fn plug_in(sample: &Sample<'_>, cells: &Cells) -> Option<f64> {
    if cells.count < FEWEST || sample.iqr == 0.0 {
        return None;
    }
    let n = cells.count as f64;
    let spread = sample.sd.min(sample.iqr / 1.349);
    let pairs = cells.pairs_by_lag();
    let sixth = -SIXTH.at(&pairs, (n, cells.width, 1.23 * spread * libm::pow(n, -1.0 / 9.0)));
    let pilot = libm::pow(2.394 / (n * sixth), 1.0 / 7.0);
    let fourth = FOURTH.at(&pairs, (n, cells.width, pilot));
    let bandwidth = libm::pow(1.0 / (2.0 * PI.sqrt() * n * fourth), 0.2);
    (sixth > 0.0 && fourth > 0.0 && bandwidth.is_finite()).then_some(bandwidth)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_functionals_are_the_sums_over_all_pairs() {
        let sorted: Vec<f64> = (0..60).map(|k| libm::sinh(f64::from(k) * 0.1) / 10.0).collect();
        let sample = Sample::of(&sorted, 5.0);
        let cells = Cells::of(&sample);
        let (values, ..) = sample.within();
        let n = values.len() as f64;
        for functional in [FOURTH, SIXTH] {
            let h = 3.0;
            let term = |a: &f64, b: &f64| {
                let s = ((a - b) / h).powi(2);
                libm::exp(-0.5 * s) * (functional.hermite)(s)
            };
            let all: f64 = values.iter().map(|a| values.iter().map(|b| term(a, b)).sum::<f64>()).sum();
            let expected = all / (n * (n - 1.0) * h.powi(functional.order + 1) * (2.0 * PI).sqrt());
            let got = functional.at(&cells.pairs_by_lag(), (n, cells.width, h));
            // Cells are 1/150 of the bandwidth wide.
            assert!((got / expected - 1.0).abs() < 1e-3, "{got} {expected}");
        }
    }
}
