//! Errors of means over the points: their rates, and that those of replicates and seeds are independent.

use super::*;

/// Errors of the mean of `function` over 2^m points of `dimensions` coordinates, one for each of `replicates`.
fn errors(
    function: &dyn Fn(&[f64]) -> f64,
    exact: f64,
    dimensions: usize,
    m: usize,
    replicates: std::ops::Range<u64>,
) -> Vec<f64> {
    let mean = |replicate| {
        let columns = points(&SobolSequence::scrambled(dimensions, 5, replicate), 0, 1 << m);
        let mut x = vec![0.0; dimensions];
        let sum: f64 = (0..1 << m)
            .map(|i| {
                x.iter_mut().zip(&columns).for_each(|(x, column)| *x = column[i]);
                function(&x)
            })
            .sum();
        sum / (1u64 << m) as f64 - exact
    };
    replicates.map(mean).collect()
}

fn rms(errors: &[f64]) -> f64 {
    (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt()
}

#[test]
fn in_one_dimension_the_error_is_that_of_stratified_points() {
    // The mean of x over one random point in each of N cells has the variance 1 / (12 N^3); 256 squares of errors estimate
    // it to 9 %, five times of which are allowed.
    for m in [1, 4, 8, 12, 16] {
        let e = errors(&|x| x[0], 0.5, 1, m, 0..256);
        let expected = 1.0 / (12.0 * 2f64.powi(3 * m as i32));
        let ratio = rms(&e).powi(2) / expected;
        assert!((ratio - 1.0).abs() < 0.45, "m = {m}: {ratio}");
    }
}

/// A function with the exact mean, its number of inputs, and the slope of log error over log N that is allowed.
type Rate = (&'static str, fn(&[f64]) -> f64, f64, usize, f64);

#[test]
fn means_converge_at_the_rates_of_scrambled_nets() {
    // Owen (1997): the standard error of a smooth function falls like N^-3/2 (log N)^((d-1)/2), which between 2^6 and 2^12
    // points is a slope of -3/2 + (d-1)/12; kinks along axes change nothing. Kinks across slanted planes cost more, but
    // leave N^-1; jumps across them cost most and still beat the N^-1/2 of random points. 128 replicates tell a slope to
    // 0.02, four times of which are allowed.
    let rates: [Rate; 6] = [
        ("product of three", |x| x.iter().map(|x| 0.5 + x).product(), 1.0, 3, -1.333),
        ("exponential of two", |x| libm::exp(x[0] + x[1]), (std::f64::consts::E - 1.0).powi(2), 2, -1.417),
        ("kinks along axes", |x| x.iter().map(|x| (x - 1.0 / 3.0).abs()).product(), (5f64 / 18.0).powi(2), 2, -1.417),
        ("minimum of two", |x| x[0].min(x[1]), 1.0 / 3.0, 2, -1.08),
        ("minimum of three", |x| x[0].min(x[1]).min(x[2]), 0.25, 3, -1.08),
        ("half plane", |x| f64::from(u8::from(x[0] + x[1] < 1.0)), 0.5, 2, -0.66),
    ];
    for (name, function, exact, dimensions, slope) in rates {
        let [coarse, fine] = [6, 12].map(|m| errors(&function, exact, dimensions, m, 0..128));
        let found = libm::log2(rms(&fine) / rms(&coarse)) / 6.0;
        assert!(found < slope + 0.08, "{name}: a slope of {found}");
        // No bias: the mean of 128 errors within four of its standard errors.
        for e in [coarse, fine] {
            let mean = e.iter().sum::<f64>() / 128.0;
            assert!(mean.abs() < 4.0 * rms(&e) / 128f64.sqrt(), "{name}: a bias of {mean}");
        }
    }
}

#[test]
fn variances_converge_like_means() {
    // The mean of squares of a smooth function, minus the square of its mean: still N^-3/2 with its logarithms.
    let f: fn(&[f64]) -> f64 = |x| x.iter().map(|x| 0.5 + x).product();
    let exact = (13f64 / 12.0).powi(3);
    let [coarse, fine] = [6, 12].map(|m| {
        let squares = errors(&|x| f(x).powi(2), exact, 3, m, 0..128);
        let means = errors(&f, 1.0, 3, m, 0..128);
        let variances: Vec<f64> = squares.iter().zip(&means).map(|(s, m)| s - 2.0 * m - m * m).collect();
        rms(&variances)
    });
    let slope = libm::log2(fine / coarse) / 6.0;
    assert!(slope < -1.25, "a slope of {slope}");
}

#[test]
fn replicates_and_seeds_are_independent() {
    // Correlations of 512 errors with those of later replicates: a standard error of 0.044 each, four of which are allowed.
    let f: &dyn Fn(&[f64]) -> f64 = &|x| libm::exp(x[0] + 2.0 * x[1] * x[2]);
    let e = errors(f, 0.0, 3, 6, 0..512);
    let mean = e.iter().sum::<f64>() / 512.0;
    let e: Vec<f64> = e.iter().map(|e| e - mean).collect();
    for lag in [1, 2, 3, 16, 256] {
        let r = e.iter().zip(&e[lag..]).map(|(a, b)| a * b).sum::<f64>() / (512 - lag) as f64 / rms(&e).powi(2);
        assert!(r.abs() < 0.18, "lag {lag}: {r}");
    }
    // The first points of all replicates and seeds are independent random numbers.
    let mut firsts: Vec<f64> = Vec::new();
    for seed in 0..64 {
        for replicate in 0..64 {
            firsts.push(points(&SobolSequence::scrambled(2, seed, replicate), 0, 1)[1][0]);
        }
    }
    for lag in [1, 64] {
        let r = correlation(&firsts[..4096 - lag], &firsts[lag..]);
        assert!(r.abs() < 4.0 / 64.0, "lag {lag}: {r}");
    }
    firsts.sort_by(f64::total_cmp);
    firsts.dedup();
    assert!(firsts.len() > 4090);
}
