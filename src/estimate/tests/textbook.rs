//! Every estimator against its published formula, term by term, in naive code.

use super::*;

fn mean(f: impl Fn(usize) -> f64, n: usize) -> f64 {
    (0..n).map(f).sum::<f64>() / n as f64
}

fn variance(y: &[f64], divisor: f64) -> f64 {
    let m = mean(|i| y[i], y.len());
    y.iter().map(|y| (y - m).powi(2)).sum::<f64>() / divisor
}

/// Pearson's correlation.
fn r(x: &[f64], y: &[f64]) -> f64 {
    let n = x.len();
    let (mx, my) = (mean(|i| x[i], n), mean(|i| y[i], n));
    mean(|i| (x[i] - mx) * (y[i] - my), n) / (variance(x, n as f64) * variance(y, n as f64)).sqrt()
}

/// Mean f0 and variance V of A and B pooled.
fn pooled(s: &Sample) -> (f64, f64) {
    let both: Vec<f64> = s.a.iter().chain(&s.b).copied().collect();
    (mean(|i| both[i], both.len()), variance(&both, both.len() as f64))
}

/// Covariance over variance of a pair of columns, mean and variance from both pooled (Janon et al. 2014).
fn janon_monod(x: &[f64], y: &[f64]) -> f64 {
    let n = x.len();
    let m = mean(|i| (x[i] + y[i]) / 2.0, n);
    (mean(|i| x[i] * y[i], n) - m * m) / (mean(|i| (x[i].powi(2) + y[i].powi(2)) / 2.0, n) - m * m)
}

/// First-order and total index by formulas D3 of Glen and Isaacs on Pearson's correlations.
fn glen_isaacs(s: &Sample, j: usize) -> (f64, f64) {
    let (a, b, ab, ba) = (&s.a, &s.b, &s.ab[j], &s.ba[j]);
    let cd_j = (r(b, ab) + r(a, ba)) / 2.0;
    let cd_not_j = (r(a, ab) + r(b, ba)) / 2.0;
    let p = (r(a, b) + r(ab, ba)) / 2.0;
    let ca_j = (cd_j - p * cd_not_j) / (1.0 - p * p);
    let ca_not_j = (cd_not_j - p * cd_j) / (1.0 - p * p);
    (cd_j - p * ca_not_j / (1.0 - ca_j * ca_not_j), 1.0 - cd_not_j + p * ca_j / (1.0 - ca_j * ca_not_j))
}

fn azzini_denominator(s: &Sample, j: usize) -> f64 {
    mean(|i| (s.a[i] - s.b[i]).powi(2) + (s.ba[j][i] - s.ab[j][i]).powi(2), s.a.len())
}

/// Variance of all values of some columns.
fn variance_of(columns: &[&[f64]]) -> f64 {
    let all = columns.concat();
    variance(&all, all.len() as f64)
}

/// The solution of x = n/(x one + (1 - x) none), by bisection of x (x one + (1 - x) none) - n where there is one.
fn mixture(n: f64, none: f64, one: f64) -> f64 {
    let one = one.max(none / 2.0);
    if n <= 0.0 || n >= one {
        return n / if n <= 0.0 { none } else { one };
    }
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..80 {
        let x = (low + high) / 2.0;
        *if x * (x * one + (1.0 - x) * none) < n { &mut low } else { &mut high } = x;
    }
    (low + high) / 2.0
}

fn first_order(estimator: FirstOrder, s: &Sample, j: usize) -> f64 {
    let (n, a, b, ab, ba) = (s.a.len(), &s.a, &s.b, &s.ab[j], &s.ba[j]);
    let (f0, v) = pooled(s);
    match estimator {
        FirstOrder::Sobol1993 => {
            let m = mean(|i| b[i], n);
            (mean(|i| b[i] * ab[i], n) - m * m) / (mean(|i| b[i] * b[i], n) - m * m)
        }
        FirstOrder::HommaSaltelli1996 => (mean(|i| b[i] * ab[i], n) - f0 * f0) / v,
        FirstOrder::Saltelli2002 => {
            let product = (0..n).map(|i| b[i] * ab[i]).sum::<f64>() / (n as f64 - 1.0);
            (product - mean(|i| a[i] * b[i], n)) / variance(a, n as f64 - 1.0)
        }
        FirstOrder::Sobol2007 => mean(|i| b[i] * (ab[i] - a[i]), n) / v,
        FirstOrder::Saltelli2010 => mean(|i| (b[i] - f0) * (ab[i] - a[i]), n) / v,
        FirstOrder::SaltelliPooled => {
            let v3 = variance_of(&[a, b, ab]);
            let c = mean(|i| (a[i] - f0) * (b[i] - f0), n).max(-v3 / 2.0).min(v3 / 2.0);
            mixture(mean(|i| (b[i] - f0) * (ab[i] - a[i]), n), v3 - c, variance_of(&[b, ab]) - c)
        }
        FirstOrder::Jansen1999 => (v - mean(|i| (b[i] - ab[i]).powi(2), n) / 2.0) / v,
        FirstOrder::JanonMonod2014 => janon_monod(b, ab),
        FirstOrder::Martinez2011 => r(b, ab),
        FirstOrder::GlenIsaacs2012 => glen_isaacs(s, j).0,
        FirstOrder::Azzini2021 => 2.0 * mean(|i| (ba[i] - b[i]) * (a[i] - ab[i]), n) / azzini_denominator(s, j),
    }
}

fn total(estimator: Total, s: &Sample, j: usize) -> f64 {
    let (n, a, b, ab, ba) = (s.a.len(), &s.a, &s.b, &s.ab[j], &s.ba[j]);
    let (f0, v) = pooled(s);
    match estimator {
        Total::HommaSaltelli1996 => (v - mean(|i| a[i] * ab[i], n) + f0 * f0) / v,
        Total::Sobol2007 => mean(|i| a[i] * (a[i] - ab[i]), n) / v,
        Total::Jansen1999 => mean(|i| (a[i] - ab[i]).powi(2), n) / 2.0 / v,
        Total::JansenPooled => {
            mixture(mean(|i| (a[i] - ab[i]).powi(2), n) / 2.0, variance_of(&[a, b, ab]), variance_of(&[a, ab]))
        }
        Total::JanonMonod2014 => 1.0 - janon_monod(a, ab),
        Total::Martinez2011 => 1.0 - r(a, ab),
        Total::GlenIsaacs2012 => glen_isaacs(s, j).1,
        Total::Azzini2021 => mean(|i| (b[i] - ba[i]).powi(2) + (a[i] - ab[i]).powi(2), n) / azzini_denominator(s, j),
    }
}

fn textbook_second_order(s: &Sample) -> f64 {
    let product = |j: usize, k: usize| mean(|i| (s.ba[j][i] - s.b[i]) * (s.ab[k][i] - s.a[i]), s.a.len());
    (product(0, 1) + product(1, 0)) / 2.0 / pooled(s).1
}

/// What [`everything`] must be.
pub(super) fn textbook(s: &Sample) -> Vec<(String, f64)> {
    let mut all = Vec::new();
    for j in 0..2 {
        all.extend(FirstOrder::ALL.map(|estimator| (String::new(), first_order(estimator, s, j))));
        all.extend(Total::ALL.map(|estimator| (String::new(), total(estimator, s, j))));
    }
    all.push((String::new(), textbook_second_order(s)));
    all
}

#[test]
fn every_estimator_is_its_published_formula() {
    for (n, offset) in [(3, 0.0), (1000, 0.0), (1000, 3.0), (1000, -20.0)] {
        // The naive sums lose (offset/spread)^2 eps to their squares; the rest is rounding of a sum of 1000 terms.
        let sample = Sample::noise(n, offset);
        let tolerance = 1e-14 * (1.0 + offset * offset) * 10.0;
        assert_close(&everything(&sample.moments()), &textbook(&sample), tolerance);
    }
}

#[test]
fn rows_that_vary_together_still_have_indices() {
    // An event in one and the same base point of A, B and AB: their covariance is their variance.
    let mut event = vec![0.0; 16];
    event[5] = 1.0;
    let block = BlockOutputs { a: &event, b: &event, ab: &[&event], ..BlockOutputs::default() };
    let moments = Moments::of_block(block, &mut Workspace::default());
    assert_eq!(FirstOrder::SaltelliPooled.estimate(&moments, 0), 0.0);
    assert_eq!(Total::JansenPooled.estimate(&moments, 0), 0.0);
    // AB without the event: S = -V/(V3 - V3/2), with V = 1/16 - 1/256 and V3 = 1/24 - 1/576 of 2 rows in 48.
    let block = BlockOutputs { a: &event, b: &event, ab: &[&[0.0; 16]], ..BlockOutputs::default() };
    let moments = Moments::of_block(block, &mut Workspace::default());
    let (v, v3) = (1.0 / 16.0 - 1.0 / 256.0, 1.0 / 24.0 - 1.0 / 576.0);
    assert!((FirstOrder::SaltelliPooled.estimate(&moments, 0) + v / (v3 / 2.0)).abs() < 1e-14);
}

#[test]
fn the_only_influential_factor_has_indices_of_1_on_any_rows() {
    // AB is B: the numerators are variances of y_B and y_AB less the covariance, and of y_A and y_AB less it.
    let (a, b) = ([0.0, 1.0, 5.0, -2.0, 0.5, 0.25, 3.0, -1.0], [2.0, 0.0, 1.5, -3.0, 2.5, 0.75, -7.0, 1.0]);
    let block = BlockOutputs { a: &a, b: &b, ab: &[&b], ..BlockOutputs::default() };
    let moments = Moments::of_block(block, &mut Workspace::default());
    let gap = moments.base().mean() - moments.base().mean_b;
    let variance = moments.base().bb / 8.0;
    let c = moments.base().ab / 8.0 - gap * gap;
    // About f0, not about the mean of B, which differs.
    let expected = (variance + gap * gap - c) / (variance - c);
    assert!((FirstOrder::SaltelliPooled.estimate(&moments, 0) - expected).abs() < 1e-14);
}

#[test]
fn the_same_outputs_have_the_indices_of_salib() {
    // first_order and total_order of SALib.analyze.sobol, SALib 1.6.0, on the outputs less f0.
    let moments = Sample::noise(64, 0.0).moments();
    let frozen = [(0.17964247006708178, 0.78332982457211), (0.31537181665513453, 0.8070096799813959)];
    for (swap, (first_order, total)) in frozen.into_iter().enumerate() {
        // Rounding of sums of 64 terms.
        assert!((FirstOrder::Saltelli2010.estimate(&moments, swap) - first_order).abs() < 1e-14);
        assert!((Total::Jansen1999.estimate(&moments, swap) - total).abs() < 1e-14);
    }
}

#[test]
fn mean_and_variance_are_those_of_the_rows_a_and_b() {
    let sample = Sample::noise(777, 1.0);
    let (moments, (f0, v)) = (sample.moments(), pooled(&sample));
    // Rounding of sums of 1554 numbers of size 1.
    assert!((moments.mean() - f0).abs() < 1e-14 && (moments.variance() - v).abs() < 1e-14);
    assert_eq!((moments.count(), moments.fewest()), (777, 777));
}
