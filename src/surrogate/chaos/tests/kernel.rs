use super::*;

fn kernel() -> Kernel {
    // Two functions of each of three factors at eleven rows.
    let functions = (0..3).map(|i| {
        let rows: Vec<Vec<f64>> = (0..2)
            .map(|k| (0..11).map(|r| libm::sin(f64::from(1 + r + 3 * i) * (1.3 + f64::from(k)))).collect())
            .collect();
        Panels::from_rows(11, rows.iter().map(Vec::as_slice))
    });
    Kernel { functions: functions.collect(), rows: 11 }
}

fn variances() -> Variances {
    Variances {
        functions: vec![vec![0.3, 0.1], vec![0.5, 0.2], vec![0.05, 0.4]],
        orders: vec![0.9, 0.4, 0.7],
        noise: 0.02,
    }
}

#[test]
fn the_covariance_is_the_sum_over_all_terms() {
    let (kernel, variances) = (kernel(), variances());
    let all = kernel.covariance(&variances);
    let value = |i: usize, k: usize, row: usize| kernel.functions[i].panel(row / LANES)[k][row % LANES];
    let part = |i: usize, a: usize, b: usize| -> f64 {
        (0..2).map(|k| variances.functions[i][k] * value(i, k, a) * value(i, k, b)).sum()
    };
    for (a, b) in [(0, 0), (3, 10), (9, 1)] {
        let [x, y, z] = [0, 1, 2].map(|i| part(i, a, b));
        let sum = 0.25 + 0.9 * (x + y + z) + 0.4 * (x * y + x * z + y * z) + 0.7 * x * y * z;
        assert!((all.at(a, b) - sum - if a == b { 0.02 } else { 0.0 }).abs() < 1e-14);
    }
}

#[test]
fn derivatives_are_those_of_the_likelihood() {
    let kernel = kernel();
    let outputs = [1.0, 2.5].map(|w| (0..11).map(|r| libm::cos(w * f64::from(r))).collect::<Vec<f64>>());
    let likelihood = |variances: &Variances| kernel.likelihood(variances, outputs.iter().map(Vec::as_slice)).unwrap();
    let value = |variances: &Variances| likelihood(variances).value;
    let derivatives = likelihood(&variances()).derivatives(&kernel, &variances());
    let check = |change: &dyn Fn(&mut Variances, f64), exact: f64| {
        let [mut up, mut down] = [variances(), variances()];
        change(&mut up, 1e-6);
        change(&mut down, -1e-6);
        let difference = (value(&up) - value(&down)) / 2e-6;
        assert!((difference - exact).abs() < 1e-5 * (1.0 + exact.abs()), "{difference} {exact}");
    };
    for i in 0..3 {
        (0..2).for_each(|k| check(&|v, by| v.functions[i][k] += by, derivatives.functions[i][k]));
        check(&|v, by| v.orders[i] += by, derivatives.orders[i]);
    }
    check(&|v, by| v.noise += by, derivatives.noise);
}
