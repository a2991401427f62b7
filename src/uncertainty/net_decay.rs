//! Standard errors of estimates from a few scrambled nets.
//!
//! Few long nets are accurate, but their spread says little about their error: two of them leave one degree of freedom,
//! and a t-interval from it is six times too wide. But every net shows how its error falls as it grows, because its
//! points are nested: halves, quarters, ... 64ths of a Sobol' net are nets of their own (Owen 1997). With sigma_l^2 the
//! variance of an estimate from 2^l points, the mean square of half the difference between neighbouring parts of 2^l
//! points is D_l = sigma_l^2 - sigma_(l+1)^2: many degrees of freedom at small l, one per net at the last. If D_l falls
//! by a factor rho per level, the variance of the whole net of 2^m points is
//!
//! sigma_m^2 = sum_(l >= m) D_l = D_(m-1) rho/(1 - rho).
//!
//! The rate rho depends on the function and the sampler more than on one index: it is fitted to all indices of an
//! output together. This extrapolation is a *prior*, because the error of a net can be smaller or larger than the
//! trend. The spread of the nets corrects it twice: on average over the indices (a common factor, as far as that is
//! known), and index by index, as in the moderated t-statistic of Smyth (2004, Stat. Appl. Genet. Mol. Biol. 3, article
//! 3): the variance is the mean of prior and spread, weighted by their degrees of freedom, and the interval is
//! Student's t with the sum of both. The reliability of the trend was measured over fifteen functions; four nets are
//! the minimum for which the intervals had a coverage of 92 to 98 % nearly everywhere: in 121 of 126 cells of eighteen
//! functions at seven sizes, seven of them functions not examined before (`benches/coverage.rs`, `docs/background/coverage.md`).

use super::special::{freedom_of_log_variance, log_bias, log_variance};
use super::standard_error::{ErrorKind, PartInfluences, StandardError};

/// Maximum number of levels of nested parts to which the trend is fitted.
const LEVELS: usize = 6;

/// Fastest and slowest allowed decay of D_l per level: eightfold is the rate of the variance of smooth functions (Owen
/// 1997: N^-3), with some margin; twofold is that of random points, the slowest for scrambled nets.
const FASTEST: f64 = 0.05;
const SLOWEST: f64 = 0.5;

/// Variance of the logarithm of sigma_m^2 about the trend, from index to index of one output. Measured 0.6 to 1.1: at
/// some numbers of points, some pairs of Sobol' dimensions fit badly, and an index stalls while the net grows fourfold.
const SCATTER_OF_INDICES: f64 = 1.0;

/// The same of the average over the indices of an output, from function to function. Measured 0.2 to 0.8.
const SCATTER_OF_OUTPUTS: f64 = 0.5;

/// Scatter of a level in addition to its sampling error, in degrees of freedom: prevents the many small parts from
/// outweighing the few large ones, which matter for the trend.
const DAMPING: f64 = 4.0;

/// Number of indices of one output that count as one independent one, because they come from the same points.
const DEPENDENCE: f64 = 2.0;

/// Computes standard errors of quantities estimated from all nets together. The pooled quantities (the indices)
/// determine the common rate and factor; the others only use them.
///
/// All quantities have the same nets and parts. A quantity that no part influences has error 0. One with an influence
/// that is not finite determines nothing; `IntervalMethod::errors` replaces its error.
pub(super) fn net_errors(quantities: &[PartInfluences], kinds: &[ErrorKind]) -> Vec<StandardError> {
    let Some(first) = quantities.first() else { return Vec::new() };
    let shape = Shape::new(first);
    let levels: Vec<Option<Levels>> = quantities.iter().map(|q| Levels::new(q, &shape)).collect();
    let pooled = levels.iter().zip(kinds).filter(|(_, kind)| kind.is_pooled);
    let pool: Vec<&Levels> = pooled.filter_map(|(levels, _)| levels.as_ref()).collect();
    // If no quantity is to be pooled, all are.
    let pool = if pool.is_empty() { levels.iter().flatten().collect() } else { pool };
    let trend = Trend::fit(&pool, &shape);
    levels.iter().map(|level| level.as_ref().map_or(shape.nothing(), |level| trend.error(level, &shape))).collect()
}

/// The common shape of all quantities of an output.
struct Shape {
    nets: usize,
    /// Parts of each net, counting an incomplete last one.
    parts: usize,
    /// Levels of nested parts below the whole: log2 of the largest power of two of parts.
    depth: usize,
}

impl Shape {
    fn new(quantity: &PartInfluences) -> Self {
        let parts = quantity.first().map_or(0, Vec::len);
        Self { nets: quantity.len(), parts, depth: parts.checked_ilog2().unwrap_or(0) as usize }
    }

    /// Returns the degrees of freedom of the differences `below` levels under the top one.
    fn freedom(&self, below: usize) -> f64 {
        self.nets as f64 * (1u64 << below) as f64
    }

    /// Returns the degrees of freedom of the spread between the nets.
    fn direct_freedom(&self) -> f64 {
        self.nets as f64 - 1.0
    }

    fn nothing(&self) -> StandardError {
        StandardError { error: 0.0, freedom: self.direct_freedom().max(1.0) }
    }
}

/// The statistics of the parts for one quantity.
struct Levels {
    /// Weighted mean of ln D over the levels, where the sampling bias of each logarithm has been subtracted.
    height: f64,
    /// Slope of ln D per level, towards larger parts.
    slope: f64,
    /// Variance between the means of the nets.
    spread: f64,
}

impl Levels {
    /// Computes the statistics; `None` if no part has any influence, or one of them is unknown.
    fn new(quantity: &PartInfluences, shape: &Shape) -> Option<Self> {
        let size = quantity.iter().flatten().fold(0.0, |largest: f64, x| largest.max(x.abs()));
        if size == 0.0 || quantity.iter().flatten().any(|x| !x.is_finite()) {
            return None;
        }
        // In units of the largest influence, so that squares neither underflow nor overflow.
        let means: Vec<f64> =
            quantity.iter().map(|net| net.iter().map(|x| x / size).sum::<f64>() / net.len() as f64).collect();
        let centre = means.iter().sum::<f64>() / means.len() as f64;
        let spread = means.iter().map(|mean| (mean - centre).powi(2)).sum::<f64>() / shape.direct_freedom().max(1.0);
        let logs = decay(quantity, shape, size);
        let (height, slope) = line(&logs, shape);
        let scale = 2.0 * libm::log(size);
        Some(Self { height: height + scale, slope, spread: spread * size * size })
    }
}

/// Returns ln D of the levels of nested parts, the top one (halves) first, free of the bias of the logarithm.
fn decay(quantity: &PartInfluences, shape: &Shape, size: f64) -> Vec<f64> {
    // Of all nets in a row: each has a power of two of them, so that no pair has parts of two nets.
    let nets = quantity.iter().flat_map(|net| &net[..1 << shape.depth]);
    let mut parts: Vec<f64> = nets.map(|x| x / size).collect();
    let mut logs = Vec::new();
    for _ in 0..shape.depth {
        let pairs = parts.len() / 2;
        let mut sum = 0.0;
        for pair in 0..pairs {
            let (left, right) = (parts[2 * pair], parts[2 * pair + 1]);
            sum += (left - right).powi(2) / 4.0;
            parts[pair] = (left + right) / 2.0;
        }
        parts.truncate(pairs);
        // A level without any difference counts as one of rounding.
        logs.push(libm::log((sum / pairs as f64).max(f64::EPSILON * f64::EPSILON)));
    }
    logs.reverse();
    logs.truncate(LEVELS);
    logs.iter().enumerate().map(|(below, log)| log - log_bias(shape.freedom(below))).collect()
}

/// Returns the weights of the levels in the fit, top first, and their weighted mean place (0 top, -1 below, ...).
fn weights(shape: &Shape, levels: usize) -> (Vec<f64>, f64) {
    let weights: Vec<f64> = (0..levels).map(|below| shape.freedom(below) / (shape.freedom(below) + DAMPING)).collect();
    let sum: f64 = weights.iter().sum();
    let mean = weights.iter().enumerate().map(|(below, w)| -(below as f64) * w).sum::<f64>() / sum;
    (weights, mean)
}

/// Returns the weighted mean of `logs` and the slope of the line through them.
fn line(logs: &[f64], shape: &Shape) -> (f64, f64) {
    if logs.is_empty() {
        return (f64::NEG_INFINITY, libm::log(SLOWEST));
    }
    let (weights, centre) = weights(shape, logs.len());
    let sum: f64 = weights.iter().sum();
    let height = logs.iter().zip(&weights).map(|(log, w)| log * w).sum::<f64>() / sum;
    let (mut square, mut product) = (0.0, 0.0);
    for (below, (log, w)) in logs.iter().zip(&weights).enumerate() {
        let place = -(below as f64) - centre;
        square += w * place.powi(2);
        product += w * log * place;
    }
    // At least three levels are needed for a slope; fewer are taken to fall like random points.
    (height, if logs.len() < 3 { libm::log(SLOWEST) } else { product / square })
}

/// The trend of an output's indices.
struct Trend {
    /// ln of the variance of a whole net over exp(height), by extrapolation and common correction.
    rise: f64,
    /// Degrees of freedom of this prior.
    freedom: f64,
}

impl Trend {
    fn fit(pool: &[&Levels], shape: &Shape) -> Self {
        if pool.is_empty() || shape.depth == 0 {
            return Self { rise: f64::NEG_INFINITY, freedom: 0.0 };
        }
        let count = pool.len() as f64;
        let slope = pool.iter().map(|levels| levels.slope).sum::<f64>() / count;
        let rho = libm::exp(slope).clamp(FASTEST, SLOWEST);
        let (_, centre) = weights(shape, shape.depth.min(LEVELS));
        let rise = -centre * libm::log(rho) + libm::log(rho / (1.0 - rho)) + libm::log(incomplete(shape, rho));
        let direct = shape.direct_freedom();
        if direct <= 0.0 {
            return Self { rise, freedom: freedom_of_log_variance(SCATTER_OF_INDICES + SCATTER_OF_OUTPUTS) };
        }
        let gaps = pool
            .iter()
            .filter(|levels| levels.spread > 0.0)
            .map(|levels| libm::log(levels.spread) - log_bias(direct) - levels.height - rise);
        let gaps: Vec<f64> = gaps.collect();
        let independent = (gaps.len() as f64 / DEPENDENCE).max(0.5);
        let noise = (log_variance(direct) + SCATTER_OF_INDICES) / independent;
        let trust = if gaps.is_empty() { 0.0 } else { SCATTER_OF_OUTPUTS / (SCATTER_OF_OUTPUTS + noise) };
        let gap = gaps.iter().sum::<f64>() / gaps.len().max(1) as f64;
        let left = SCATTER_OF_OUTPUTS * (1.0 - trust);
        Self { rise: rise + trust * gap, freedom: freedom_of_log_variance(SCATTER_OF_INDICES + left) }
    }

    /// Returns the standard error of the mean over the nets.
    fn error(&self, levels: &Levels, shape: &Shape) -> StandardError {
        let direct = shape.direct_freedom();
        let prior =
            if self.freedom > 0.0 { libm::exp(levels.height + self.rise + log_bias(self.freedom)) } else { 0.0 };
        let freedom = self.freedom + direct;
        if freedom <= 0.0 {
            return StandardError { error: f64::NAN, freedom: 0.0 };
        }
        let variance = (self.freedom * prior + direct * levels.spread) / freedom;
        StandardError { error: (variance / shape.nets as f64).sqrt(), freedom }
    }
}

/// Returns the variance of a net of `shape.parts` parts over that of its largest nested net of 2^depth parts: a number
/// of points that is no power of two is a chain of shrinking nets, each with the error of its own size.
fn incomplete(shape: &Shape, rho: f64) -> f64 {
    let parts = shape.parts as f64;
    (0..=shape.depth)
        .filter(|level| shape.parts >> level & 1 == 1)
        .map(|level| ((1u64 << level) as f64 / parts).powi(2) * rho.powi(-((shape.depth - level) as i32)))
        .sum()
}

#[cfg(test)]
#[path = "tests/net_decay.rs"]
mod tests;
