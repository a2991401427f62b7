use super::*;
use crate::surrogate::chaos::degree_at;
use crate::surrogate::family::Family;
use std::f64::consts::PI;

/// Fits `f` of independent uniform factors at a Kronecker sequence, whose steps are powers of the root of x^(d + 1) = x + 1.
fn fitted(factors: usize, rows: usize, family: &Family, f: impl Fn(&[f64]) -> f64) -> Chaos {
    let mut root = 1.5f64;
    for _ in 0..60 {
        root = libm::pow(1.0 + root, 1.0 / (factors as f64 + 1.0));
    }
    let columns: Vec<Vec<f64>> = (0..factors)
        .map(|i| (0..rows).map(|row| (0.5 + row as f64 / root.powi(i as i32 + 1)).fract()).collect())
        .collect();
    let values: Vec<f64> =
        (0..rows).map(|row| f(&columns.iter().map(|column| column[row]).collect::<Vec<f64>>())).collect();
    let mean = apportion_base::sum::mean(&values);
    let sd = (values.iter().map(|y| (y - mean).powi(2)).sum::<f64>() / rows as f64).sqrt();
    let y: Vec<f64> = values.iter().map(|y| (y - mean) / sd).collect();
    Chaos::new(columns.iter().map(|u| Factor::new(family, u, degree_at(rows))).collect(), &y, Some(mean / sd))
}

/// Returns first-order and total indices.
fn indices(of: &Chaos) -> [Vec<f64>; 2] {
    let EffectVariances { first_order, total, all } = &of.variances;
    [first_order, total].map(|kind| kind.iter().map(|v| v / all).collect())
}

/// Returns the largest error of the indices.
fn error(of: &Chaos, first_order: &[f64], total: &[f64]) -> f64 {
    let [first, all] = indices(of);
    let pairs = first.iter().zip(first_order).chain(all.iter().zip(total));
    pairs.map(|(estimate, exact)| (estimate - exact).abs()).fold(0.0, f64::max)
}

fn ishigami(u: &[f64]) -> f64 {
    let x: Vec<f64> = u.iter().map(|u| PI * (2.0 * u - 1.0)).collect();
    libm::sin(x[0]) * (1.0 + 0.1 * x[2].powi(4)) + 7.0 * libm::sin(x[1]).powi(2)
}

#[test]
fn ishigami_is_exact_from_few_rows() {
    let [one, two, both] = [(1.0 + PI.powi(4) / 50.0).powi(2) / 2.0, 49.0 / 8.0, 0.08 * PI.powi(8) / 225.0];
    let all = one + two + both;
    for (rows, limit) in [(80, 1e-3), (160, 1e-7), (320, 1e-9)] {
        let of = fitted(3, rows, &Family::Legendre, ishigami);
        let error = error(&of, &[one / all, two / all, 0.0], &[(one + both) / all, two / all, both / all]);
        assert!(error < limit && error < of.half_width(), "{rows}: {error:e} {:e}", of.half_width());
    }
}

#[test]
fn an_exclusive_or_is_an_interaction() {
    let of = fitted(3, 64, &Family::Legendre, |u| f64::from(u8::from((u[0] > 0.5) != (u[1] > 0.5))));
    let error = error(&of, &[0.0, 0.0, 0.0], &[1.0, 1.0, 0.0]);
    assert!(error < 0.05 && error < of.half_width(), "{error}");
}

#[test]
fn a_step_is_one_function() {
    let variances = [0.99, 0.0675, 1.0 / 3.0, 0.0825];
    let all: f64 = variances.iter().sum();
    let first_order = [0.99 / all, 0.0675 / all, 1.0 / 3.0 / all];
    let total = [(0.99 + 0.0825) / all, (0.0675 + 0.0825) / all, 1.0 / 3.0 / all];
    let function = |u: &[f64]| f64::from(u8::from(u[0] > 0.55)) * 2.0 * (0.5 + u[1]) + 2.0 * u[2] - 1.0;
    for (rows, limit) in [(100, 5e-3), (650, 1e-3)] {
        let of = fitted(3, rows, &Family::Legendre, function);
        assert_eq!(of.basis().factors[0].knots().len(), 1);
        let error = error(&of, &first_order, &total);
        assert!(error < limit && error < of.unseen(), "{rows}: {error:e} {:e}", of.unseen());
    }
}

#[test]
fn a_product_is_one_term() {
    // 256^x1 (1/5 + x2^2)^3.
    let powers = |u: &[f64]| libm::pow(4.0, 4.0 * u[0]) * (0.2 + u[1] * u[1]).powi(3);
    let of = fitted(3, 64, &Family::Legendre, powers);
    let integral = |p: f64| (libm::exp(p * libm::log(4.0)) - 1.0) / (p * libm::log(4.0));
    let (m1, q1) = (integral(4.0), integral(8.0));
    let moment = |power: i32| {
        (0..=power)
            .map(|k| {
                let binomial = (0..k).fold(1.0, |b, j| b * f64::from(power - j) / f64::from(j + 1));
                binomial * 0.2f64.powi(power - k) / f64::from(2 * k + 1)
            })
            .sum::<f64>()
    };
    let (m2, q2) = (moment(3), moment(6));
    let (v1, v2) = ((q1 - m1 * m1) * m2 * m2, m1 * m1 * (q2 - m2 * m2));
    let both = (q1 - m1 * m1) * (q2 - m2 * m2);
    let all = v1 + v2 + both;
    let error = error(&of, &[v1 / all, v2 / all, 0.0], &[(v1 + both) / all, (v2 + both) / all, 0.0]);
    assert!(error < 1e-4 && error < of.half_width(), "{error:e} {:e}", of.half_width());
}

#[test]
fn rows_beyond_the_fitted_ones_correct_it() {
    // x1 + x2 + 12 (x1 - 1/2) (x2 - 1/2), and noise that rows beyond average out.
    let noise = |u: &[f64]| libm::sin(5000.0 * (u[0] + 3.0 * u[1]));
    let of = fitted(2, 6000, &Family::Legendre, |u| u[0] + u[1] + 12.0 * (u[0] - 0.5) * (u[1] - 0.5) + 0.3 * noise(u));
    let all = 1.0 / 6.0 + 1.0 + 0.045;
    let error = error(&of, &[1.0 / 12.0 / all; 2], &[(1.0 / 12.0 + 1.0 + 0.045) / all; 2]);
    assert!(error < 0.01 && error < of.half_width(), "{error} {}", of.half_width());
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    for rows in [90, 620] {
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                indices(&fitted(4, rows, &Family::Hermite, |u| libm::exp(u[0] * u[1]) + libm::fabs(u[2] - 0.3) * u[3]))
            })
        };
        assert_eq!(on(1), on(4));
    }
}
