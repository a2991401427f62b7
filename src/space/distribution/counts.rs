//! Distributions of counts: Poisson, binomial, negative binomial and geometric.

use std::iter::successors;
use std::sync::Arc;

use super::prelude::*;

/// Means outside are refused: the table of probabilities would be too long, or only 0 would ever occur.
const MEANS: (f64, f64) = (1e-300, 1e6);

/// The same for probabilities of success where the number of trials is given, and where it is counted.
const PROBABILITIES: (f64, f64) = (1e-12, 1.0 - 1e-12);
const PROBABILITIES_OF_WAITING: (f64, f64) = (1e-3, 1.0 - 1e-12);

/// A distribution of counts.
#[derive(Clone, Debug, PartialEq)]
pub struct Counts {
    parameters: Vec<(&'static str, f64)>,
    /// Mean and standard deviation.
    moments: (f64, f64),
    support: (f64, f64),
    table: Arc<Table>,
}

/// The probabilities of all numbers that are not negligible.
#[derive(Debug, PartialEq)]
struct Table {
    first: f64,
    /// P(X <= k) of each.
    below: Vec<f64>,
    /// P(X > k) of each.
    above: Vec<f64>,
    /// The index of the median.
    middle: usize,
}

impl Distribution {
    /// Returns the Poisson distribution with mean `mean`: 0, 1, 2 and so on.
    ///
    /// # Formula
    ///
    /// ```text
    /// P(X = k) = mean^k exp(-mean) / k!,   quantile(u) = the smallest k with P(X <= k) > u
    /// sd = sqrt(mean)
    /// ```
    ///
    /// # Errors
    ///
    /// If `mean` is outside [1e-300, 1e6]. Above, a normal distribution of this mean with its square root as the
    /// standard deviation differs by less than a thousandth of that.
    ///
    /// ```
    /// use apportion::Distribution;
    ///
    /// let events = Distribution::poisson(2.0)?;
    /// // P(X = 0) = 0.1353..., P(X <= 1) = 0.4060...
    /// assert_eq!((events.quantile(0.1), events.quantile(0.2), events.quantile(0.5)), (0.0, 1.0, 2.0));
    /// # Ok::<(), apportion::DistributionError>(())
    /// ```
    pub fn poisson(mean: f64) -> Result<Self, DistributionError> {
        within("mean", finite("mean", mean)?, MEANS)?;
        let table = Table::new(mean.floor(), 0.0, |k| (mean, k));
        let (moments, support) = ((mean, mean.sqrt()), (0.0, f64::INFINITY));
        Self::Poisson(Counts { parameters: vec![("mean", mean)], moments, support, table }).finite()
    }

    /// Returns the binomial distribution of the number of successes in `n` trials, each with probability `p`.
    ///
    /// # Formula
    ///
    /// ```text
    /// P(X = k) = n! / (k! (n - k)!) p^k (1 - p)^(n - k),   mean = n p,   sd = sqrt(n p (1 - p))
    /// ```
    ///
    /// # Errors
    ///
    /// If `n` is not a whole number from 1 to 1e6, or `p` is outside [1e-12, 1 - 1e-12].
    pub fn binomial(n: f64, p: f64) -> Result<Self, DistributionError> {
        number("n", n, n.fract() == 0.0 && (1.0..=1e6).contains(&n), "be a whole number from 1 to 1e6")?;
        let q = 1.0 - within("p", p, PROBABILITIES)?;
        let table = Table::new(((n + 1.0) * p).floor().min(n), 0.0, |k| ((n - k + 1.0) * p, k * q));
        let (moments, support) = ((n * p, (n * p * q).sqrt()), (0.0, n));
        Self::Binomial(Counts { parameters: vec![("n", n), ("p", p)], moments, support, table }).finite()
    }

    /// Returns the negative binomial distribution of the number of failures before `n` successes, each trial with
    /// probability `p` of success; `n` need not be whole. It is that of `scipy.stats.nbinom`: counts with more scatter
    /// than those of a Poisson distribution, with a dispersion `n` at a mean m for p = n / (n + m).
    ///
    /// # Formula
    ///
    /// ```text
    /// P(X = k) = Gamma(k + n) / (k! Gamma(n)) p^n (1 - p)^k,   mean = n (1 - p) / p,   sd = sqrt(n (1 - p)) / p
    /// ```
    ///
    /// # Errors
    ///
    /// If `n` is not above 0, `p` is outside [1e-3, 1 - 1e-12], or the mean is outside [1e-300, 1e6].
    pub fn negative_binomial(n: f64, p: f64) -> Result<Self, DistributionError> {
        positive("n", n)?;
        let q = 1.0 - within("p", p, PROBABILITIES_OF_WAITING)?;
        let (mean, sd) = (n * q / p, (n * q).sqrt() / p);
        if !(MEANS.0..=MEANS.1).contains(&mean) {
            return Err(refused(
                "n",
                format!("the mean n (1 - p) / p is {mean:?}, but must lie between 1e-300 and 1e6"),
            ));
        }
        let table = Table::new(((n - 1.0) * q / p).floor().max(0.0), 0.0, |k| ((k + n - 1.0) * q, k));
        let support = (0.0, f64::INFINITY);
        Self::NegativeBinomial(Counts { parameters: vec![("n", n), ("p", p)], moments: (mean, sd), support, table })
            .finite()
    }

    /// Returns the geometric distribution of the number of trials up to the first success, that one included, each with
    /// probability `p`: 1, 2, 3 and so on, as that of `scipy.stats.geom`.
    ///
    /// # Formula
    ///
    /// ```text
    /// P(X = k) = p (1 - p)^(k - 1),   mean = 1 / p,   sd = sqrt(1 - p) / p
    /// ```
    ///
    /// # Errors
    ///
    /// If `p` is outside [1e-3, 1 - 1e-12].
    pub fn geometric(p: f64) -> Result<Self, DistributionError> {
        let q = 1.0 - within("p", p, PROBABILITIES_OF_WAITING)?;
        let (moments, support) = ((1.0 / p, q.sqrt() / p), (1.0, f64::INFINITY));
        let table = Table::new(1.0, 1.0, |_| (q, 1.0));
        Self::Geometric(Counts { parameters: vec![("p", p)], moments, support, table }).finite()
    }
}

impl Counts {
    /// Maximum number of levels that are treated separately when a distribution is drawn or screened.
    const MAX_LEVELS: usize = 1024;
    /// Levels that together are rarer than this on either side are not among them.
    const RARE: f64 = 1e-3;

    /// Returns the numbers that occur, except the rare ones, each with a `u` at which it is the quantile; `None` if
    /// there are more than 1024.
    pub fn levels(&self) -> Option<Vec<(f64, f64)>> {
        let (rare, table) = (Self::RARE, &self.table);
        let (first, last) = (table.place(rare, 1.0 - rare), table.place(1.0 - rare, rare));
        if last - first >= Self::MAX_LEVELS {
            return None;
        }
        let mut levels = Vec::with_capacity(last - first + 1);
        for place in first..=last {
            let low = if place == 0 { 0.0 } else { table.below[place - 1] };
            levels.push((table.first + place as f64, low + (table.below[place] - low) / 2.0));
        }
        Some(levels)
    }
}

impl Table {
    /// Creates it from the most probable number, the smallest one, and P(k) / P(k - 1) as a numerator and a denominator.
    fn new(mode: f64, smallest: f64, ratio_at: impl Fn(f64) -> (f64, f64)) -> Arc<Self> {
        const MIN_RATIO: f64 = 1e-300;
        // Up and down from the most probable number, whose own probability follows from the sum.
        let down = successors(Some((1.0, mode)), |&(ratio, k)| {
            let (of, over) = ratio_at(k);
            (k > smallest).then_some((ratio * (over / of), k - 1.0))
        });
        let up = successors(Some((1.0, mode)), |&(ratio, k)| {
            let (of, over) = ratio_at(k + 1.0);
            Some((ratio * (of / over), k + 1.0))
        });
        let mut falling: Vec<(f64, f64)> = down.take_while(|(ratio, _)| *ratio >= MIN_RATIO).collect();
        let first = falling[falling.len() - 1].1;
        falling.reverse();
        let rising = up.skip(1).take_while(|(ratio, _)| *ratio >= MIN_RATIO);
        let probabilities: Vec<f64> = falling.into_iter().chain(rising).map(|(ratio, _)| ratio).collect();
        // From the small ones on either side.
        let below = running_sums(probabilities.iter());
        let from: Vec<f64> = running_sums(probabilities.iter().rev()).into_iter().rev().collect();
        let total = below[below.len() - 1];
        let middle = below.partition_point(|sum| *sum < 0.5 * total);
        let above = from.iter().skip(1).chain([&0.0]).map(|sum| sum / total).collect();
        let below = below.iter().map(|sum| sum / total).collect();
        Arc::new(Self { first, below, above, middle })
    }

    /// Returns the index of the quantile at `u`, `v` being 1 - u.
    fn place(&self, u: f64, v: f64) -> usize {
        let place = if u < v {
            self.below.partition_point(|below| *below <= u).min(self.middle)
        } else {
            self.above.partition_point(|above| *above >= v).max(self.middle)
        };
        place.min(self.below.len() - 1)
    }
}

/// Returns the sum of the first probability, of the first two, and so on.
fn running_sums<'a>(probabilities: impl Iterator<Item = &'a f64>) -> Vec<f64> {
    let mut sum = 0.0;
    probabilities
        .map(|probability| {
            sum += probability;
            sum
        })
        .collect()
}

pub(super) const POISSON: &[Entry] = &[Entry {
    name: "poisson",
    summary: "Numbers of random events.",
    key_sets: &[keys(&["mean"])],
    build: |given| Distribution::poisson(given.number("mean")?),
    ..PLAIN
}];

pub(super) const BINOMIAL: &[Entry] = &[Entry {
    name: "binomial",
    summary: "Numbers of successes in `n` trials of probability `p`.",
    key_sets: &[keys(&["n", "p"])],
    build: |given| Distribution::binomial(given.number("n")?, given.number("p")?),
    ..PLAIN
}];

pub(super) const NEGATIVE_BINOMIAL: &[Entry] = &[Entry {
    name: "negative-binomial",
    summary: "Numbers of failures before `n` successes of probability `p`.",
    key_sets: &[keys(&["n", "p"])],
    build: |given| Distribution::negative_binomial(given.number("n")?, given.number("p")?),
    ..PLAIN
}];

pub(super) const GEOMETRIC: &[Entry] = &[Entry {
    name: "geometric",
    summary: "Numbers of trials up to the first success, of probability `p`.",
    key_sets: &[keys(&["p"])],
    build: |given| Distribution::geometric(given.number("p")?),
    ..PLAIN
}];

impl Family for Counts {
    fn at(&self, u: f64, v: f64) -> f64 {
        if u <= 0.0 || v <= 0.0 {
            return if u <= 0.0 { self.support.0 } else { self.support.1 };
        }
        self.table.first + self.table.place(u, v) as f64
    }

    fn tails(&self, x: f64) -> (f64, f64) {
        let Table { first, below, above, .. } = &*self.table;
        let count = (x.floor() - first + 1.0).clamp(0.0, below.len() as f64) as usize;
        count.checked_sub(1).map_or((0.0, 1.0), |place| (below[place], above[place]))
    }

    fn moments(&self) -> (f64, f64) {
        self.moments
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        self.parameters.iter().map(|(name, value)| (*name, (*value).into())).collect()
    }
}
