//! Kernel density with a bandwidth from the data.

use std::f64::consts::PI;

use super::{BandwidthRule, Density, Sample};
use crate::sum::product;

/// Intervals between the places at which the density is given.
const STEPS: usize = 256;
/// Cells in each of them, into which values are binned before any sum over kernels.
const STEP: usize = 4;
const CELLS: usize = STEPS * STEP;
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
    let x = (0..=STEPS).map(|k| low + (high - low) * k as f64 / STEPS as f64).collect();
    let factor = 1.0 / (sample.n() * bandwidth * (2.0 * PI).sqrt());
    let mut density = vec![0.0; STEPS + 1];
    cells.add_kernels(bandwidth, 0.0, 1, &mut density);
    for end in [ends.0, ends.1] {
        cells.add_kernels(bandwidth, 2.0 * (end - low) / cells.width, -1, &mut density);
    }
    density.iter_mut().for_each(|sum| *sum *= factor);
    Density { bandwidth, rule, x, density }
}

fn silverman(sample: &Sample<'_>) -> f64 {
    let spread = if sample.iqr > 0.0 { sample.sd.min(sample.iqr / 1.34) } else { sample.sd };
    0.9 * spread * libm::pow(sample.n(), -0.2)
}

/// Values counted in equal cells over the reach of the sample, each shared between the middles of the two cells next to
/// it.
struct Cells {
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
        Self { width, weights, count: values.len() }
    }

    /// Adds the sums of unnormalised kernels at the places `first`, `first` + `direction` [`STEP`] and so on, in cells.
    ///
    /// All places are as far from the cells next to them, so that one table of the kernel is enough.
    fn add_kernels(&self, bandwidth: f64, first: f64, direction: isize, sums: &mut [f64]) {
        // Mirrored in an end far beyond the cells.
        let farthest = 3 * CELLS as isize;
        if first.abs() > farthest as f64 {
            return;
        }
        let whole = first.floor() as isize;
        let apart = |cells: isize| (first - whole as f64 - cells as f64) * self.width / bandwidth;
        let reach = ((KERNEL_REACH * bandwidth / self.width).ceil() as isize + 1).min(2 * farthest);
        let kernel: Vec<f64> = (-reach..=reach).map(|cells| libm::exp(-0.5 * apart(cells) * apart(cells))).collect();
        for (k, sum) in sums.iter_mut().enumerate() {
            let middle = whole + direction * (STEP * k) as isize;
            let (from, to) = ((middle - reach).max(0), (middle + reach).min(CELLS as isize));
            if from <= to {
                let kernel = &kernel[(from - middle + reach) as usize..];
                *sum += product(&self.weights[from as usize..=to as usize], kernel);
            }
        }
    }

    /// Number of pairs of values by their distance in cells, from 0.
    fn pairs_by_lag(&self) -> Vec<f64> {
        let w = &self.weights;
        let mut pairs: Vec<f64> = (0..w.len()).map(|lag| product(w, &w[lag..])).collect();
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
    fn at(&self, pairs: &[f64], n: f64, cell: f64, h: f64) -> f64 {
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
    let sixth = -SIXTH.at(&pairs, n, cells.width, 1.23 * spread * libm::pow(n, -1.0 / 9.0));
    let pilot = libm::pow(2.394 / (n * sixth), 1.0 / 7.0);
    let fourth = FOURTH.at(&pairs, n, cells.width, pilot);
    let bandwidth = libm::pow(1.0 / (2.0 * PI.sqrt() * n * fourth), 0.2);
    (sixth > 0.0 && fourth > 0.0 && bandwidth.is_finite()).then_some(bandwidth)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn densities_are_the_sums_over_all_cells_and_their_images() {
        // Mirrors between the cells, at them, and far away; kernels from narrow to wide.
        let sorted: Vec<f64> = (0..60).map(|k| libm::sinh(f64::from(k) * 0.1) / 10.0).collect();
        let sample = Sample::of(&sorted, 5.0);
        let cells = Cells::of(&sample);
        for (first, direction) in [(0.0, 1), (0.0, -1), (-3.25, -1), (1024.6, -1), (2048.0, -1), (1e300, -1)] {
            for bandwidth in [1.0, 30.0, 5000.0].map(|cell| cell * cells.width) {
                let mut sums = vec![0.5; STEPS + 1];
                cells.add_kernels(bandwidth, first, direction, &mut sums);
                for (k, sum) in sums.into_iter().enumerate() {
                    let place = first + direction as f64 * (STEP * k) as f64;
                    let kernel = |cell: usize| {
                        let t = (place - cell as f64) * cells.width / bandwidth;
                        cells.weights[cell] * libm::exp(-0.5 * t * t)
                    };
                    let expected: f64 = 0.5 + (0..=CELLS).map(kernel).sum::<f64>();
                    // Kernels end where they are 1e-14.
                    assert!((sum - expected).abs() < 1e-11, "{first} {bandwidth} {k}: {sum} {expected}");
                }
            }
        }
    }

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
            let got = functional.at(&cells.pairs_by_lag(), n, cells.width, h);
            // Cells are 1/150 of the bandwidth wide.
            assert!((got / expected - 1.0).abs() < 1e-3, "{got} {expected}");
        }
    }
}
