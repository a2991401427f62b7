//! Kernel densities of an output, and how far those of classes lie from that of all rows.

use std::f64::consts::TAU;

/// Points of the grid that densities are compared on.
const GRID: usize = 100;

/// The grid between the least and the largest output.
pub struct Densities {
    low: f64,
    step: f64,
}

impl Densities {
    pub fn new(z: &[f64]) -> Self {
        let (low, high) =
            z.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), z| (low.min(*z), high.max(*z)));
        Self { low, step: (high - low) / (GRID - 1) as f64 }
    }

    /// Half of the mean over the classes of the distance between the density of the outputs there and that of all (Plischke et al.
    /// 2013, eq. 26), by kernels of this part of Silverman's width. A row counts as often as its weight says. A class without spread is
    /// a point, as far as can be from any density.
    pub fn delta(&self, z: &[f64], (labels, count): &(Vec<usize>, usize), weights: &[f64], part: f64) -> f64 {
        let mut all = Spread::default();
        let mut classes = vec![Spread::default(); *count];
        for ((&label, z), &weight) in labels.iter().zip(z).zip(weights) {
            all.add(*z, weight);
            classes[label].add(*z, weight);
        }
        let width = |of: &Spread| part * of.width() / self.step;
        let (of_all, widths) = (width(&all), classes.iter().map(width).collect::<Vec<f64>>());
        let (mut density, mut densities) = ([0.0; GRID], vec![[0.0; GRID]; *count]);
        for ((&label, z), &weight) in labels.iter().zip(z).zip(weights) {
            if weight > 0.0 {
                let place = (z - self.low) / self.step;
                add_kernel(&mut density, place, of_all, weight);
                if widths[label] > 0.0 {
                    add_kernel(&mut densities[label], place, widths[label], weight);
                }
            }
        }
        let share = |(class, (own, width)): (&Spread, (&[f64; GRID], &f64))| {
            if class.weight == 0.0 {
                return 0.0;
            }
            if *width == 0.0 {
                return class.weight;
            }
            let gap = |k: usize| (density[k] / (all.weight * of_all) - own[k] / (class.weight * width)).abs();
            let gaps: f64 = (0..GRID).map(gap).sum::<f64>() - (gap(0) + gap(GRID - 1)) / 2.0;
            class.weight * gaps / (2.0 * TAU.sqrt())
        };
        classes.iter().zip(densities.iter().zip(&widths)).map(share).sum::<f64>() / all.weight
    }
}

/// Adds the kernel at `place` of that `width`, both in steps of the grid, times its weight and the root of 2 pi times its width.
pub(super) fn add_kernel<const POINTS: usize>(density: &mut [f64; POINTS], place: f64, width: f64, weight: f64) {
    let nearest = place.round().clamp(0.0, (POINTS - 1) as f64);
    let (centre, away, step) = (nearest as usize, (nearest - place) / width, 1.0 / width);
    let top = weight * libm::exp(-away * away / 2.0);
    // From point to point the kernel changes by a ratio that itself changes by this one.
    let ratio = libm::exp(-step * step);
    let first = |away: f64| libm::exp(-(2.0 * away + step) * step / 2.0);
    let (mut height, mut change) = (top, first(away));
    for point in &mut density[centre..] {
        *point += height;
        height *= change;
        change *= ratio;
    }
    (height, change) = (top * first(-away), first(-away) * ratio);
    for point in density[..centre].iter_mut().rev() {
        *point += height;
        height *= change;
        change *= ratio;
    }
}

/// Moments of the outputs of a class.
#[derive(Clone, Default)]
pub(super) struct Spread {
    weight: f64,
    mean: f64,
    squares: f64,
}

impl Spread {
    pub fn add(&mut self, z: f64, weight: f64) {
        if weight > 0.0 {
            self.weight += weight;
            let before = z - self.mean;
            self.mean += before * weight / self.weight;
            self.squares += weight * before * (z - self.mean);
        }
    }

    /// Silverman's (1986) width of kernels; 0 without spread.
    pub fn width(&self) -> f64 {
        if self.squares <= 0.0 || self.weight < 2.0 {
            return 0.0;
        }
        libm::pow(0.75 * self.weight, -0.2) * (self.squares / (self.weight - 1.0)).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kernels_are_those_of_the_exponential() {
        for (place, width) in [(0.0, 3.0), (17.4, 0.4), (98.9, 25.0), (50.5, 0.02)] {
            let mut density = [0.0; GRID];
            add_kernel(&mut density, place, width, 2.0);
            for (k, got) in density.iter().enumerate() {
                let expected = 2.0 * libm::exp(-((k as f64 - place) / width).powi(2) / 2.0);
                // The error of a ratio counts as often as there are steps.
                assert!((got - expected).abs() <= 1e-11 * expected.max(1e-30), "{place} {width} {k}: {got} {expected}");
            }
        }
    }

    #[test]
    fn classes_that_are_points_are_as_far_as_can_be() {
        let z: Vec<f64> = (0..40).map(|k| f64::from(k % 2)).collect();
        let labels: Vec<usize> = (0..40).map(|k| k % 2).collect();
        assert_eq!(Densities::new(&z).delta(&z, &(labels, 2), &[1.0; 40], 1.0), 1.0);
    }
}
