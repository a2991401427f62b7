//! The error of the indices of a surrogate, from the rows that its fits have not seen.
//!
//! For a surrogate g of f, e = f - g, and an effect u, the sum of those terms of an expansion that have some sets of
//! factors, V_u(f) = V_u(g) + 2 Cov(e, g_u) + V_u(e), with 0 <= V_u(e) <= V(e). The index is that of the surrogate of all
//! rows. Half the width of its interval is
//!
//! h_u = (1 + m/n) (1.8 (1 + 4 k q) sqrt(3/4 v_u + 1/4 mean of v) + (1/4 + 3/4 noise) V(e)/V),
//!
//! v_u the mean of two variances: that of the mean of 2 e (g_u - theta_u g) - theta_u e^2 over the held-out rows, and that
//! by the jackknife over the parts left out; n the number of rows, all of which determine the hyperparameters, m that of
//! those, three for each factor, and at least 24; k the concentration of the former on few rows, q that of the output by
//! its kurtosis; noise the share of V(e) that the prior takes for it. The numbers were fitted to 16 functions at 64 to
//! 512 rows. An interval by the posterior of the coefficients alone covers half of them.

use crate::surrogate::chaos::Chaos;

/// Factors of the interval.
const SPREAD: f64 = 1.8;
const CONCENTRATED: f64 = 4.0;
const OWN: f64 = 0.75;

/// The part of what is left that counts if none of it is noise.
const REMAINDER: f64 = 0.25;

/// Rows at which the hyperparameters make the parts that are left out look half as different as they are: at least, and
/// for each factor.
const HALF_AS_DIFFERENT: f64 = 24.0;
const OF_FACTOR: f64 = 3.0;

/// Kurtosis of an output from which few rows may carry it, and the distance to where they do.
const KURTOSIS: f64 = 4.0;

/// A surrogate and what it leaves of the rows that its fits have not seen.
pub(crate) struct HeldOut<'a> {
    left: &'a [f64],
    /// The sum of the terms of each set of factors at the rows.
    values: Vec<Vec<f64>>,
    sum: Vec<f64>,
    variance: f64,
    concentration: f64,
    /// What is left and may belong to any effect, as a share of the variance.
    remainder: f64,
    /// The share of the variance that no rows show.
    unseen: f64,
    /// The factor of all half widths by which hyperparameters that saw these rows make them too small.
    few: f64,
}

/// The error of an index.
#[derive(Debug, Clone)]
pub(crate) struct Spread {
    variance: f64,
    concentration: f64,
}

impl<'a> HeldOut<'a> {
    pub fn new(chaos: &'a Chaos) -> Self {
        let values = chaos.values_of_sets();
        let mut sum = vec![0.0; chaos.left.len()];
        values.iter().for_each(|of| sum.iter_mut().zip(of).for_each(|(sum, g)| *sum += g));
        let y = chaos.fitted_outputs();
        let [two, four] = [2, 4].map(|power| y.iter().map(|y| y.powi(power)).sum::<f64>() / y.len() as f64);
        let noise = (chaos.noise() / chaos.rest.max(f64::MIN_POSITIVE)).min(1.0);
        let variance = chaos.variances.all + chaos.rest;
        Self {
            left: &chaos.left,
            values,
            sum,
            variance,
            concentration: ((four / (two * two) - KURTOSIS) / KURTOSIS).clamp(0.0, 1.0),
            remainder: (REMAINDER + (1.0 - REMAINDER) * noise) * chaos.rest / variance,
            unseen: chaos.unseen(),
            few: 1.0 + HALF_AS_DIFFERENT.max(OF_FACTOR * chaos.basis().factors.len() as f64) / y.len() as f64,
        }
    }

    /// Computes the error of an `index` that is the sum of the terms of sets of factors with these weights, from 0 to 1; by the
    /// fits without each part it is one of `of_parts`.
    pub fn spread(&self, weights: &[f64], index: f64, of_parts: &[f64]) -> Spread {
        let mut own = vec![0.0; self.sum.len()];
        for (weight, values) in weights.iter().zip(&self.values) {
            if *weight != 0.0 {
                own.iter_mut().zip(values).for_each(|(own, g)| *own += weight * g);
            }
        }
        let rows = own.iter().zip(&self.sum).zip(self.left);
        let z: Vec<f64> = rows.map(|((own, g), e)| 2.0 * e * (own - index * g) - index * e * e).collect();
        let mean = apportion_base::sum::mean(&z);
        let (two, four) = z.iter().fold((0.0, 0.0), |(two, four), z| {
            let square = (z - mean) * (z - mean);
            (two + square, four + square * square)
        });
        let scale = self.variance * z.len() as f64;
        let centre = apportion_base::sum::mean(of_parts);
        let squares: f64 = of_parts.iter().map(|part| (part - centre) * (part - centre)).sum();
        let jackknife = squares * (of_parts.len() as f64 - 1.0) / of_parts.len() as f64;
        Spread {
            variance: (two / (scale * scale) + jackknife) / 2.0,
            concentration: if two > 0.0 { four / (two * two) } else { 0.0 },
        }
    }

    /// Returns half the widths of the intervals of indices of one kind.
    pub fn half_widths(&self, spreads: &[Spread]) -> Vec<f64> {
        let count = spreads.len().max(1) as f64;
        let variance = spreads.iter().map(|of| of.variance).sum::<f64>() / count;
        let concentration = spreads.iter().map(|of| of.concentration).sum::<f64>() / count;
        let widening = SPREAD * (1.0 + CONCENTRATED * concentration * self.concentration);
        let spread = |of: &Spread| widening * (OWN * of.variance + (1.0 - OWN) * variance).sqrt();
        spreads.iter().map(|of| self.few * (spread(of) + self.remainder) + self.unseen).collect()
    }
}
