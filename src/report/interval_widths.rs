//! What doubling the runs would bring.

use super::format::printed_half_width;
use super::result::{OutputRecord, ResultFile, StageRecord};

/// Stages that the slope is read from, the last ones: earlier widths are poor guides to later ones.
const STAGES: usize = 4;

/// Powers of the number of runs with which an error can fall: that of independent points, and that of scrambled nets on
/// smooth functions (Owen 1997, Ann. Statist. 25, 1541-1562). Beyond them the trend is noise of the widths.
const POWERS: (f64, f64) = (-1.5, -0.5);

/// A fall of the error by more than this factor in the last doubling is a surrogate that begins to fit: no trend goes on like that.
const LEAP: f64 = 4.0;

/// Half widths below this are of the size of what is cut from what is printed.
const LEAST: f64 = 1e-6;

/// Half width from which an interval says nothing of a share of the variance: it may be as long as all of it.
pub const WIDE: f64 = 0.5;

/// The largest half width to be expected of twice the runs, from the slope of the last stages in double logarithmic
/// scales; `None` with fewer than three stages that have intervals, where the last stage is a leap, and where the width would be
/// below the digits that are printed.
pub fn width_after_doubling(stages: &[StageRecord]) -> Option<f64> {
    let points = with_width(stages);
    let points = &points[points.len().saturating_sub(STAGES)..];
    let [_, .., (x_before, before), (x_last, last)] = points else { return None };
    let fall_of_doubling = (before - last) / (x_last - x_before) * libm::log(2.0);
    if fall_of_doubling > libm::log(LEAP) {
        return None;
    }
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / points.len() as f64;
    let (x, y) = (mean(|point| point.0), mean(|point| point.1));
    let sum = |of: &dyn Fn(f64, f64) -> f64| points.iter().map(|point| of(point.0 - x, point.1 - y)).sum::<f64>();
    let slope = (sum(&|x, y| x * y) / sum(&|x, _| x * x)).clamp(POWERS.0, POWERS.1);
    let width = libm::exp(last + slope * libm::log(2.0));
    (slope.is_finite() && width >= LEAST).then_some(width)
}

/// Whether there are too few stages with intervals for a trend.
pub fn has_too_few_stages(stages: &[StageRecord]) -> bool {
    with_width(stages).len() < 3
}

/// The logarithms of the number of base points and of the largest half width, of the stages that have one.
fn with_width(stages: &[StageRecord]) -> Vec<(f64, f64)> {
    let with_width = stages.iter().filter_map(|stage| {
        let width = stage.largest_half_width.filter(|width| *width > 0.0)?;
        Some((libm::log(stage.base_samples as f64), libm::log(width)))
    });
    with_width.collect()
}

/// The largest half width of any first-order or total index of a result, at its end, those of several outputs together among
/// them; `None` without intervals.
pub fn widest_interval(result: &ResultFile) -> Option<f64> {
    let together = result.aggregate.iter().filter_map(|aggregate| aggregate.indices.as_ref());
    let together = together.chain(result.series.iter().filter_map(|series| series.indices.as_ref())).flatten();
    let together = together.flat_map(|index| [index.first_order, index.total]).filter_map(printed_half_width);
    let widest = result.outputs.iter().filter_map(widest_of).reduce(f64::max)?;
    Some(together.fold(widest, f64::max))
}

/// The same of an output. Not less than any half width that its table prints, which is that of the longer side, rounded.
pub fn widest_of(output: &OutputRecord) -> Option<f64> {
    let widest = output.convergence.last()?.largest_half_width?;
    let indices = output.indices.iter().flatten();
    let all = indices.flat_map(|index| [index.effect.first_order, index.effect.total]);
    Some(all.filter_map(printed_half_width).fold(widest, f64::max))
}

/// Which indices these half widths are of: not those of second order, nor those of the mean over the noise.
pub fn indices_measured(outputs: &[OutputRecord]) -> &'static str {
    let pairs = outputs.iter().any(|output| output.second_order.is_some());
    let noise = outputs.iter().any(|output| output.noise.is_some());
    match (pairs, noise) {
        (false, false) => "every index",
        (true, false) => "every first-order and total index",
        (false, true) => "every index of the values",
        (true, true) => "every first-order and total index of the values",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stages(widths: &[Option<f64>]) -> Vec<StageRecord> {
        let stage = |(place, width): (usize, &Option<f64>)| StageRecord {
            base_samples: 64 << place,
            model_runs: 640 << place,
            largest_half_width: *width,
            indices: Vec::new(),
        };
        widths.iter().enumerate().map(stage).collect()
    }

    #[test]
    fn the_trend_goes_on() {
        let found = width_after_doubling(&stages(&[Some(0.8), Some(0.4), Some(0.2), Some(0.1)])).unwrap();
        assert!((found - 0.05).abs() < 1e-12, "{found}");
    }

    #[test]
    fn no_faster_and_no_slower_than_errors_fall() {
        let flat = width_after_doubling(&stages(&[Some(0.1), Some(0.1), Some(0.1)])).unwrap();
        assert!((flat - 0.1 * 0.5_f64.sqrt()).abs() < 1e-12, "{flat}");
        let steep = width_after_doubling(&stages(&[Some(1.0), Some(0.3), Some(0.09)])).unwrap();
        assert!((steep - 0.09 * libm::pow(2.0, -1.5)).abs() < 1e-12, "{steep}");
    }

    #[test]
    fn no_trend_goes_on_from_a_leap_or_below_what_is_printed() {
        assert_eq!(width_after_doubling(&stages(&[Some(0.5), Some(0.4), Some(0.3), Some(0.01)])), None);
        assert_eq!(width_after_doubling(&stages(&[Some(4e-6), Some(2e-6), Some(1e-6)])), None);
        // Four times the base samples at once: a fall by 9 is one by 3 for each doubling.
        let mut rare = stages(&[Some(0.9), Some(0.3), Some(0.1), Some(0.03)]);
        rare.remove(2);
        assert!(width_after_doubling(&rare).is_some());
    }

    #[test]
    fn two_stages_are_no_trend() {
        assert_eq!(width_after_doubling(&stages(&[Some(0.2), Some(0.1)])), None);
        assert_eq!(width_after_doubling(&stages(&[None, Some(0.2), None, Some(0.1)])), None);
        assert_eq!(width_after_doubling(&stages(&[Some(0.0), Some(0.0), Some(0.0)])), None);
        assert_eq!(width_after_doubling(&[]), None);
        assert!(has_too_few_stages(&stages(&[Some(0.2), Some(0.1), None])) && has_too_few_stages(&[]));
        assert!(!has_too_few_stages(&stages(&[Some(0.2), Some(0.1), Some(1e-9)])));
    }
}
