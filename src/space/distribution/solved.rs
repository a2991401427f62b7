//! Distributions specified by a mean and a standard deviation, or by two quantiles.
//!
//! x = location + scale z, with z of the standard distribution, which has at most one shape. Every statement is linear
//! in location and scale: a location + b scale = value. Two statements determine both; a third one determines the
//! shape, at which the determinant of the three lines vanishes.

use super::entry::{Arguments, Shape};
use super::error::{finite, no_such_distribution, order, positive};
use super::{Distribution, DistributionError, Parameter};

/// A statement: coefficients of location and scale, and the value.
type Line = [f64; 3];

/// Returns the distribution with the given mean and standard deviation, or quantiles: the narrowest if there are
/// several. A family that `begins` at a location does so at `location`, by default 0.
pub(super) fn solved(given: &Arguments<'_>, begins: bool) -> Result<Distribution, DistributionError> {
    check(given)?;
    let distribution = match given.entry.shape {
        Shape::None => at(f64::NAN, given, begins),
        Shape::Given(key) => at(given.number(key)?, given, begins),
        Shape::Mode => {
            let shapes = evenly(0.0, 1.0, 401);
            first_zero(shapes, |shape| determinant(shape, given, begins), |shape| at(shape, given, begins))
        }
        Shape::Between(narrow, wide, count) => {
            let logs = evenly(libm::log(narrow), libm::log(wide), count);
            first_zero(logs, |log| determinant(libm::exp(log), given, begins), |log| at(libm::exp(log), given, begins))
        }
    };
    distribution.ok_or_else(|| {
        let words: Vec<String> = given.values.iter().filter_map(in_words).collect();
        let key = given.values.first().map_or("", |(key, _)| *key);
        no_such_distribution(given.entry.name, &words.join(" and "), key)
    })
}

/// Returns the distribution of this shape, if it is as stated: to 1e-9 standard deviations, plus rounding of values.
fn at(shape: f64, given: &Arguments<'_>, begins: bool) -> Option<Distribution> {
    let (lines, origin) = lines(shape, given, begins)?;
    let (location, scale) = located(&lines)?;
    let place = if begins { given.number_or("location", 0.0) } else { origin + location };
    let distribution = (given.entry.make)(given, [place, scale, shape]).ok()?;
    let tolerance = 1e-9 * distribution.sd() + 1e-13 * origin.abs();
    let mut lines = lines.into_iter();
    let are_met =
        lines.all(|[a, b, value]| (a * location + b * scale - value).abs() <= tolerance + 1e-13 * value.abs());
    are_met.then_some(distribution)
}

/// Returns the statements as lines for one shape, and the offset subtracted from values to keep digits.
fn lines(shape: f64, given: &Arguments<'_>, begins: bool) -> Option<(Vec<Line>, f64)> {
    let standard = (given.entry.make)(&Arguments { values: &[], ..*given }, [0.0, 1.0, shape]).ok()?;
    let mut lines = Vec::with_capacity(3);
    if begins || given.entry.of_ratios {
        lines.push([1.0, 0.0, given.number_or("location", 0.0)]);
    }
    if matches!(given.entry.shape, Shape::Mode) {
        lines.push([1.0, shape, given.number_if("mode")?]);
    }
    lines.extend(stated(given, &standard).map(|(of_location, of_scale, value)| [of_location, of_scale, value]));
    let origin = lines.iter().find(|line| line[0] == 1.0).map_or(0.0, |line| line[2]);
    lines.iter_mut().for_each(|line| line[2] -= line[0] * origin);
    Some((lines, origin))
}

/// Returns zero if three statements agree; NaN if the standard distribution does not exist.
fn determinant(shape: f64, given: &Arguments<'_>, begins: bool) -> f64 {
    let Some((lines, _)) = lines(shape, given, begins) else { return f64::NAN };
    let [a, b, c] = lines[..] else { return f64::NAN };
    a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0])
}

/// Iterates over the given mean, standard deviation and quantiles: whether each moves with the location, its value for
/// `distribution`, and its given value.
fn stated(given: &Arguments<'_>, distribution: &Distribution) -> impl Iterator<Item = (f64, f64, f64)> {
    let mean = given.number_if("mean").map(|value| (1.0, distribution.mean(), value));
    let sd = given.number_if("sd").map(|value| (0.0, distribution.sd(), value));
    let quantiles = given.quantiles().map(|(_, probability, value)| (1.0, distribution.quantile(probability), value));
    mean.into_iter().chain(sd).chain(quantiles)
}

/// Refuses invalid numbers, and quantiles out of order.
fn check(given: &Arguments<'_>) -> Result<(), DistributionError> {
    for (key, value) in given.values {
        let Parameter::Number(value) = value else { continue };
        finite(key, *value)?;
        if given.entry.of_ratios || matches!(*key, "sd" | "df") {
            positive(key, *value)?;
        }
    }
    let quantiles: Vec<_> = given.quantiles().collect();
    match quantiles[..] {
        [(lower, _, low), (upper, _, high)] if low >= high => Err(order(lower, low, upper, high)),
        _ => Ok(()),
    }
}

fn in_words((key, value): &(&'static str, Parameter)) -> Option<String> {
    if let Parameter::Number(value) = value { Some(format!("{key} = {value}")) } else { None }
}

/// Computes location and scale from the two lines that determine them best.
fn located(lines: &[Line]) -> Option<(f64, f64)> {
    let pairs = (0..lines.len()).flat_map(|i| (i + 1..lines.len()).map(move |j| (i, j)));
    let (_, i, j) = pairs
        .map(|(i, j)| ((lines[i][0] * lines[j][1] - lines[i][1] * lines[j][0]).abs(), i, j))
        // The coefficients are of order 1: lines at a smaller angle count as one.
        .filter(|(size, ..)| *size > 1e-12)
        .max_by(|a, b| a.0.total_cmp(&b.0))?;
    let ([a, b, v], [c, d, w]) = (lines[i], lines[j]);
    let size = a * d - b * c;
    let (location, scale) = ((v * d - b * w) / size, (a * w - v * c) / size);
    (scale > 0.0 && scale.is_finite()).then_some((location, scale))
}

/// Returns the first zero of `function` along `grid`, to the last digits of its argument: between two neighbours of
/// different sign, or at one of them. NaN where the function does not exist. Zeros that `accept` refuses (steps, poles)
/// are skipped.
fn first_zero<T>(
    grid: impl Iterator<Item = f64>,
    function: impl Fn(f64) -> f64,
    accept: impl Fn(f64) -> Option<T>,
) -> Option<T> {
    let mut before: Option<(f64, f64)> = None;
    for x in grid {
        let y = function(x);
        if y == 0.0
            && let Some(accepted) = accept(x)
        {
            return Some(accepted);
        }
        if let Some((from, start)) = before
            && start * y < 0.0
            && let Some(accepted) = accept(bisected((from, start), x, &function))
        {
            return Some(accepted);
        }
        before = y.is_finite().then_some((x, y));
    }
    None
}

/// Returns the zero between `low` (with its value) and `high`, where the function has the other sign.
fn bisected((mut low, start): (f64, f64), mut high: f64, function: &impl Fn(f64) -> f64) -> f64 {
    loop {
        let middle = low + (high - low) / 2.0;
        if middle == low || middle == high {
            return middle;
        }
        let y = function(middle);
        if y == 0.0 || y.is_nan() {
            return middle;
        }
        if y.signum() == start.signum() { low = middle } else { high = middle }
    }
}

/// Iterates over `count` numbers from `from` to `to`, both included, at equal distances.
fn evenly(from: f64, to: f64, count: u32) -> impl Iterator<Item = f64> {
    let last = f64::from(count - 1);
    (0..count).map(f64::from).map(move |k| if k == last { to } else { from + (to - from) * (k / last) })
}
