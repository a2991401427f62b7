use statrs::distribution::{ContinuousCDF, Normal, StudentsT};
use statrs::function::erf::erfc_inv;

use super::*;

fn close(got: f64, expected: f64, tolerance: f64, what: &str) {
    assert!((got / expected - 1.0).abs() < tolerance || got == expected, "{what}: {got} against {expected}");
}

/// 2e-15: the sum of the stated errors of statrs and AS 241.
#[test]
fn the_normal_quantile_is_that_of_another_implementation_over_the_whole_range() {
    for exponent in 1..290 {
        for mantissa in [1.0, 2.3, 4.9] {
            let u = mantissa * 0.1_f64.powi(exponent);
            close(normal_quantile(u), -std::f64::consts::SQRT_2 * erfc_inv(2.0 * u), 2e-15, &format!("u = {u}"));
        }
    }
    for place in 1..400 {
        let u = f64::from(place) / 400.0;
        close(normal_quantile(u), Normal::standard().inverse_cdf(u), 4e-15, &format!("u = {u}"));
        assert!((normal_below(normal_quantile(u)) - u).abs() < 1e-15);
    }
    assert_eq!(normal_quantile(0.5), 0.0);
    // The derivative at the median is sqrt(2 pi).
    close(normal_quantile_near_median(1e-200) * 1e200, (2.0 * PI).sqrt(), 1e-15, "beside the median");
}

/// T has closed forms for 1 and 2 degrees of freedom: 1/2 - atan(t)/pi and (1 - t/sqrt(2 + t^2))/2.
#[test]
fn t_is_exact_where_it_has_a_closed_form_and_that_of_another_implementation_elsewhere() {
    for exponent in -60..120 {
        let t = 10f64.powf(f64::from(exponent) / 20.0);
        close(t_above(t, 1.0), libm::atan(1.0 / t) / PI, 1e-14, &format!("t = {t}"));
        let root = (2.0 + t * t).sqrt();
        close(t_above(t, 2.0), 1.0 / (root * (root + t)), 1e-14, &format!("t = {t}"));
        assert_eq!(t_above(-t, 3.3), 1.0 - t_above(t, 3.3));
    }
    for freedom in [0.1, 0.7, 3.0, 5.7, 39.0, 1e3, 1e6] {
        for t in [0.01, 0.5, 1.0, 2.0, 6.0] {
            let other = StudentsT::new(0.0, 1.0, freedom).unwrap().cdf(-t);
            // statrs subtracts logarithms of large gamma functions.
            close(t_above(t, freedom), other, 1e-12 * freedom.max(10.0), &format!("t = {t}, freedom {freedom}"));
        }
    }
    close(t_above(2.0, 1e12), normal_below(-2.0), 1e-10, "nearly normal");
    assert_eq!(t_above(2.0, f64::INFINITY), normal_below(-2.0));
}

#[test]
fn t_quantiles_invert_the_distribution_at_every_freedom() {
    for freedom in [0.05, 0.3, 1.0, 2.0, 2.5, 4.0, 17.0, 300.0, 1e4, 1e7, f64::INFINITY] {
        for outside in [1e-6, 0.05, 0.5] {
            let t = t_quantile_outside(outside, freedom);
            close(2.0 * t_above(t, freedom), outside, 1e-12, &format!("freedom {freedom}, t = {t}"));
        }
    }
    // tan(0.475 pi).
    close(t_quantile_outside(0.05, 1.0), libm::tan(0.475 * PI), 1e-13, "Cauchy");
    assert_eq!(t_quantile_outside(0.05, 1e-4), f64::INFINITY);
}
