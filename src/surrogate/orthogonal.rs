//! Polynomials orthonormal under the distribution of a factor, in its values: a model that is smooth in the values need
//! not be smooth in the quantiles, and a factor with few levels needs few polynomials.

use crate::space::Distribution;

/// Panels of the quadrature, each half as wide as the one before it, towards either end.
const PANELS: i32 = 40;

/// Number of equal parts of each panel.
const PARTS: u32 = 12;

/// Nodes and weights of the Gauss-Legendre rule of five points on -1 to 1 (Abramowitz and Stegun 1964, table 25.4).
const RULE: [(f64, f64); 5] = [
    (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.906_179_845_938_664, 0.236_926_885_056_189_1),
];

/// Relative error of the standard deviation by quadrature that is more than rounding.
const MISSED: f64 = 1e-8;

/// Length of the new part of a polynomial below which it vanishes: there are as many degrees as levels.
const NOTHING: f64 = 1e-7;

/// Share of the square of a polynomial at the outermost node of a distribution without bounds, at a probability of
/// 1e-290, above which the square has no finite mean.
const DIVERGES: f64 = 1e-9;

/// Polynomials orthonormal under some weights, by the three-term recurrence b_(k+1) p_(k+1) = (x - a_k) p_k - b_k
/// p_(k-1), p_0 = 1, for values shifted and scaled to -1 to 1.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Recurrence {
    middle: f64,
    half: f64,
    /// (a_k, b_(k+1)) from k = 0.
    coefficients: Vec<(f64, f64)>,
}

impl Recurrence {
    /// Computes polynomials up to `degree`, or fewer for few values, under `nodes` (value, weight) of weights that sum
    /// to 1, between `low` and `high`, by the discretised procedure of Stieltjes (Gautschi 1982, SIAM J. Sci. Stat.
    /// Comput. 3, 289-317). `None` if the bounds are not finite and of positive distance.
    pub fn new(nodes: &[(f64, f64)], (low, high): (f64, f64), degree: usize) -> Option<Self> {
        let (middle, half) = (low + (high - low) / 2.0, (high - low) / 2.0);
        if !(half > 0.0 && half.is_finite() && middle.is_finite()) {
            return None;
        }
        let nodes: Vec<(f64, f64)> = nodes.iter().map(|(x, weight)| ((x - middle) / half, *weight)).collect();
        let (mut before, mut now, mut length) = (vec![0.0; nodes.len()], vec![1.0; nodes.len()], 0.0);
        let mut coefficients = Vec::with_capacity(degree);
        for _ in 0..degree {
            let a: f64 = nodes.iter().zip(&now).map(|((x, weight), p)| weight * (x * p * p)).sum();
            let rest = nodes.iter().zip(now.iter().zip(&before)).map(|((x, _), (p, q))| (x - a) * p - length * q);
            let rest: Vec<f64> = rest.collect();
            length = nodes.iter().zip(&rest).map(|((_, weight), p)| weight * (p * p)).sum::<f64>().sqrt();
            if !(length >= NOTHING && length.is_finite()) {
                break;
            }
            before = std::mem::replace(&mut now, rest.iter().map(|p| p / length).collect());
            coefficients.push((a, length));
        }
        Some(Self { middle, half, coefficients })
    }

    /// Returns the largest degree.
    pub fn degree(&self) -> usize {
        self.coefficients.len()
    }

    /// Returns the polynomials of degree 1, 2, ... and at most `degree` at the values `x`, a column for each.
    pub fn columns(&self, x: &[f64], degree: usize) -> Vec<Vec<f64>> {
        let x: Vec<f64> = x.iter().map(|x| (x - self.middle) / self.half).collect();
        recurred(&x, self.degree().min(degree), |k, x, p, q| {
            let (a, next_length) = self.coefficients[k as usize];
            let length = if k == 0.0 { 0.0 } else { self.coefficients[k as usize - 1].1 };
            ((x - a) * p - length * q) / next_length
        })
    }
}

/// The polynomials of a distribution.
#[derive(Debug, Clone, PartialEq)]
pub struct OrthogonalPolynomials {
    distribution: Distribution,
    recurrence: Recurrence,
}

impl OrthogonalPolynomials {
    /// Computes polynomials up to `degree`, or fewer for a distribution with few levels, and half the number of finite
    /// moments of one without bounds. `None` for a constant, or if unknown steps spoil the standard deviation by
    /// quadrature.
    pub fn new(distribution: &Distribution, degree: usize) -> Option<Self> {
        let levels = distribution.levels();
        let ends = levels.as_ref().and_then(|levels| Some((levels.first()?.0, levels.last()?.0)));
        let (low, high) = ends.unwrap_or_else(|| distribution.support());
        if (high - low).is_infinite() {
            return Self::without_bounds(distribution, degree);
        }
        if high <= low {
            return None;
        }
        let nodes = match (levels, distribution) {
            (Some(levels), _) => of_levels(distribution, &levels),
            (None, Distribution::Histogram(histogram)) => {
                let bins = histogram.bins().flat_map(|(low, high, _)| rule(low, high));
                bins.map(|(u, weight)| (distribution.quantile(u), weight)).collect()
            }
            _ => of_quantiles(distribution),
        };
        let (mean, sd) = (distribution.mean(), distribution.sd());
        let variance: f64 = nodes.iter().map(|(x, weight)| weight * (x - mean) * (x - mean)).sum();
        let recurrence = Recurrence::new(&nodes, (low, high), degree)?;
        let polynomials = Self { distribution: distribution.clone(), recurrence };
        let is_exact = (variance.sqrt() - sd).abs() <= MISSED * sd || polynomials.is_count();
        is_exact.then_some(polynomials)
    }

    /// Does the same for a continuous distribution without a bound.
    fn without_bounds(distribution: &Distribution, degree: usize) -> Option<Self> {
        let (mean, sd) = (distribution.mean(), distribution.sd());
        let nodes = distribution.quadrature();
        let mut recurrence = Recurrence::new(&nodes, (mean - sd, mean + sd), degree)?;
        let (first, last) = (nodes[0], nodes[nodes.len() - 1]);
        let columns = recurrence.columns(&[first.0, last.0], degree);
        let is_finite = |p: &Vec<f64>| first.1 * p[0] * p[0] < DIVERGES && last.1 * p[1] * p[1] < DIVERGES;
        recurrence.coefficients.truncate(columns.iter().take_while(|p| is_finite(p)).count());
        Some(Self { distribution: distribution.clone(), recurrence })
    }

    /// Returns the largest degree.
    pub fn degree(&self) -> usize {
        self.recurrence.degree()
    }

    /// Returns whether the distribution has no lower or no upper bound.
    pub fn is_unbounded(&self) -> bool {
        let (low, high) = self.distribution.support();
        (high - low).is_infinite() && !self.has_levels()
    }

    /// Returns whether the distribution has few values.
    pub fn has_levels(&self) -> bool {
        self.distribution.levels().is_some()
    }

    /// Returns how many of its values are expected at least once among `rows` rows; `None` if it is continuous.
    pub fn levels_among(&self, rows: f64) -> Option<usize> {
        let levels = of_levels(&self.distribution, &self.distribution.levels()?);
        Some(levels.iter().filter(|(_, probability)| probability * rows >= 1.0).count())
    }

    /// Returns the polynomials of degree 1, 2, ... and at most `degree` at the quantiles of `u`, a column for each.
    pub fn columns(&self, u: &[f64], degree: usize) -> Vec<Vec<f64>> {
        let mut x = vec![0.0; u.len()];
        self.distribution.fill(u, &mut x);
        self.recurrence.columns(&self.within_levels(x), degree)
    }

    /// Returns the same at the quantiles of 1 - `v`, to full precision if `v` is small.
    pub fn upper_columns(&self, v: &[f64]) -> Vec<Vec<f64>> {
        let x: Vec<f64> = v.iter().map(|v| self.distribution.upper_quantile(*v)).collect();
        self.recurrence.columns(&self.within_levels(x), self.degree())
    }

    /// Returns the values with the outermost level in place of rarer counts, at which polynomials are huge.
    fn within_levels(&self, mut x: Vec<f64>) -> Vec<f64> {
        if self.is_count() {
            let Recurrence { middle, half, .. } = &self.recurrence;
            x.iter_mut().for_each(|x| *x = x.clamp(middle - half, middle + half));
        }
        x
    }

    /// Returns whether it is of counts, of which the rarest are not among its levels.
    pub fn is_count(&self) -> bool {
        self.distribution.counts().is_some() && self.has_levels()
    }
}

/// Returns the values of a distribution with few levels and their probabilities: its quantile's steps, by bisection.
fn of_levels(distribution: &Distribution, levels: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut steps = vec![0.0];
    for pair in levels.windows(2) {
        let ((_, mut low), (value, mut high)) = (pair[0], pair[1]);
        for _ in 0..60 {
            let middle = (low + high) / 2.0;
            if distribution.quantile(middle) < value { low = middle } else { high = middle }
        }
        steps.push(high);
    }
    steps.push(1.0);
    levels.iter().zip(steps.windows(2)).map(|((value, _), pair)| (*value, pair[1] - pair[0])).collect()
}

/// Returns the values and weights at the nodes of a quadrature in the quantiles, which is finer towards the ends.
fn of_quantiles(distribution: &Distribution) -> Vec<(f64, f64)> {
    // The remainder at the ends counts as one node.
    let rest = 0.5f64.powi(PANELS + 1);
    let mut nodes = vec![(distribution.quantile(rest / 2.0), rest), (distribution.quantile(1.0 - rest / 2.0), rest)];
    for number in 1..=PANELS {
        for (u, weight) in rule(0.5f64.powi(number + 1), 0.5f64.powi(number)) {
            nodes.push((distribution.quantile(u), weight));
            nodes.push((distribution.quantile(1.0 - u), weight));
        }
    }
    nodes
}

/// Iterates over nodes and weights of the rule on each of some parts of `low` to `high`.
pub(super) fn rule(low: f64, high: f64) -> impl Iterator<Item = (f64, f64)> {
    let width = (high - low) / f64::from(PARTS);
    (0..PARTS).flat_map(move |part| {
        RULE.into_iter()
            .map(move |(node, weight)| (low + width * (f64::from(part) + (1.0 + node) / 2.0), weight * width / 2.0))
    })
}

/// Returns the polynomials p_1, p_2, ... at `x`, of which p_(n+1) is `next`(n, x, p_n, p_(n-1)); p_0 = 1, p_(-1) = 0.
pub(super) fn recurred(x: &[f64], degree: usize, next: impl Fn(f64, f64, f64, f64) -> f64) -> Vec<Vec<f64>> {
    let (mut before, mut now) = (vec![0.0; x.len()], vec![1.0; x.len()]);
    let mut columns = Vec::with_capacity(degree);
    for n in 0..degree {
        let following = now.iter().zip(&before).zip(x).map(|((p, q), x)| next(n as f64, *x, *p, *q)).collect();
        before = std::mem::replace(&mut now, following);
        columns.push(now.clone());
    }
    columns
}

#[cfg(test)]
#[path = "tests/orthogonal.rs"]
mod tests;
