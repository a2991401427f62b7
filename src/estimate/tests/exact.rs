//! Indices that are exact: samples in which every value of every coordinate meets every other.

use super::*;

/// Three levels for each of two inputs in each of A and B: 3^4 base points, over which means are expectations.
fn factorial(f: impl Fn(f64, f64) -> f64) -> Sample {
    let level = |point: usize, coordinate: u32| (point / 3usize.pow(coordinate) % 3) as f64 - 1.0;
    // Coordinates 0, 1 are A; 2, 3 are B.
    let column = |x: u32, y: u32| (0..81).map(|point| f(level(point, x), level(point, y))).collect::<Vec<f64>>();
    Sample { a: column(0, 1), b: column(2, 3), ab: [column(2, 1), column(0, 3)], ba: [column(0, 3), column(2, 1)] }
}

/// Partial variances V_1, V_2 and V_12 of f over the nine points, by the definition of the decomposition.
fn partial_variances(f: impl Fn(f64, f64) -> f64) -> [f64; 3] {
    let levels = [-1.0, 0.0, 1.0];
    let mean = |g: &dyn Fn(f64, f64) -> f64| {
        levels.map(|x| levels.map(|y| g(x, y)).iter().sum::<f64>()).iter().sum::<f64>() / 9.0
    };
    let f0 = mean(&f);
    let of_x = |x: f64| levels.map(|y| f(x, y)).iter().sum::<f64>() / 3.0 - f0;
    let of_y = |y: f64| levels.map(|x| f(x, y)).iter().sum::<f64>() / 3.0 - f0;
    let v1 = mean(&|x, _| of_x(x).powi(2));
    let v2 = mean(&|_, y| of_y(y).powi(2));
    let v12 = mean(&|x, y| (f(x, y) - f0 - of_x(x) - of_y(y)).powi(2));
    [v1, v2, v12]
}

#[test]
fn every_estimator_is_exact_on_a_full_factorial() {
    // Of mean 0, since Saltelli's form of 2002 adds f0^2/n to be unbiased on independent points.
    let f = |x: f64, y: f64| 2.0 * x + 0.5 * y + 1.5 * x * y + x * x - 2.0 / 3.0;
    let moments = factorial(f).moments();
    let [v1, v2, v12] = partial_variances(f);
    let v = v1 + v2 + v12;
    for (swap, own) in [v1, v2].into_iter().enumerate() {
        for estimator in FirstOrder::ALL {
            let got = estimator.estimate(&moments, swap);
            // Rounding of sums of 81 terms.
            assert!((got - own / v).abs() < 1e-13, "{estimator:?}: {got} is not {}", own / v);
        }
        for estimator in Total::ALL {
            let got = estimator.estimate(&moments, swap);
            assert!((got - (own + v12) / v).abs() < 1e-13, "{estimator:?}: {got} is not {}", (own + v12) / v);
        }
    }
    let got = second_order(&moments, 0, 1);
    assert!((got - v12 / v).abs() < 1e-13, "{got} is not {}", v12 / v);
}

#[test]
fn the_only_influential_factor_has_index_one_and_others_zero() {
    let moments = factorial(|x, _| x).moments();
    for estimator in FirstOrder::ALL {
        assert!((estimator.estimate(&moments, 0) - 1.0).abs() < 1e-13, "{estimator:?}");
        assert!(estimator.estimate(&moments, 1).abs() < 1e-13, "{estimator:?}");
    }
    for estimator in Total::ALL {
        assert!((estimator.estimate(&moments, 0) - 1.0).abs() < 1e-13, "{estimator:?}");
        assert!(estimator.estimate(&moments, 1).abs() < 1e-13, "{estimator:?}");
    }
}

#[test]
fn an_inert_factor_has_exactly_no_effect_in_the_difference_forms_at_any_offset() {
    for offset in [0.0, 1e9, -1e15] {
        let mut sample = Sample::noise(300, offset);
        sample.ab[0] = sample.a.clone();
        sample.ba[0] = sample.b.clone();
        let moments = sample.moments();
        let exact =
            [FirstOrder::Sobol2007, FirstOrder::Saltelli2010, FirstOrder::SaltelliPooled, FirstOrder::Azzini2021];
        for estimator in exact {
            assert_eq!(estimator.estimate(&moments, 0).abs(), 0.0, "{estimator:?} at {offset}");
        }
        let exact = [
            Total::Sobol2007,
            Total::Jansen1999,
            Total::JansenPooled,
            Total::JanonMonod2014,
            Total::Martinez2011,
            Total::Azzini2021,
        ];
        for estimator in exact {
            assert_eq!(estimator.estimate(&moments, 0).abs(), 0.0, "{estimator:?} at {offset}");
        }
        // The corrections of Glen and Isaacs cancel up to the rounding of correlations.
        assert!(FirstOrder::GlenIsaacs2012.estimate(&moments, 0).abs() < 1e-14);
        assert!(Total::GlenIsaacs2012.estimate(&moments, 0).abs() < 1e-14);
        assert_eq!(second_order(&moments, 0, 1), 0.0);
        assert_eq!(second_order(&moments, 1, 0), 0.0);
    }
}

#[test]
fn pairs_that_are_not_counted_have_no_index() {
    let moments = Sample::noise(30, 0.0).moments();
    assert!(second_order(&moments, 0, 0).is_nan());
    assert!(second_order(&moments, 0, 7).is_nan());
    assert!(second_order(&Moments::empty(2), 0, 1).is_nan());
}

#[test]
fn aggregated_indices_are_means_weighted_by_variances() {
    let (f, g) = (|x: f64, y: f64| x + 0.5 * y, |x: f64, y: f64| 10.0 * y + 3.0 * x * y);
    let [f_moments, g_moments, constant] =
        [factorial(f).moments(), factorial(g).moments(), factorial(|_, _| 7.0).moments()];
    let (vf, vg) = (partial_variances(f), partial_variances(g));
    let listed = |moments: &Moments| {
        let indices = Indices::from_moments(moments)?;
        Ok((moments.variance(), [indices.first_order, indices.total].concat()))
    };
    let all = [listed(&f_moments), listed(&g_moments), listed(&constant)];
    // The first-order indices of both factors, then the total ones.
    let of = |scaling| aggregated(all.iter(), scaling).unwrap();
    let (sum_f, sum_g): (f64, f64) = (vf.iter().sum(), vg.iter().sum());
    let plain = of(Scaling::Plain);
    let exact = (vf[0] + vf[2] + vg[0] + vg[2]) / (sum_f + sum_g);
    assert!((plain[2] - exact).abs() < 1e-13);
    assert!((plain[1] - (vf[1] + vg[1]) / (sum_f + sum_g)).abs() < 1e-13);
    let standardised = of(Scaling::Standardised);
    assert!((standardised[1] - (vf[1] / sum_f + vg[1] / sum_g) / 2.0).abs() < 1e-13);
    assert_eq!(aggregated(all[2..].iter(), Scaling::Plain), Err(Undefined::ZeroVariance));
    let empty = [listed(&f_moments), listed(&Moments::empty(2))];
    assert_eq!(aggregated(empty.iter(), Scaling::Plain), Err(Undefined::NoRuns));
}
