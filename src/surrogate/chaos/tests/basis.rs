use super::*;

#[test]
fn inner_products_with_steps_are_integrals() {
    let mut factor = Factor::new(&Family::Legendre, &[0.1, 0.6], 3);
    factor.add_knot(Knot { u: 0.25, is_kink: false });
    factor.add_knot(Knot { u: 0.7, is_kink: false });
    let inner = Inner::new(&factor);
    // Of 1(u > t) with sqrt(3) (2 u - 1): sqrt(3) t (1 - t).
    for (index, t) in [(4, 0.25f64), (5, 0.7)] {
        assert!((inner.at(index, 1) - (3.0 * t * (1.0 - t)).sqrt()).abs() < 1e-12);
        assert!((inner.at(index, index) - 1.0).abs() < 1e-12);
    }
    assert!((inner.at(4, 5) - (0.25 * 0.3 / (0.75 * 0.7f64)).sqrt()).abs() < 1e-12);
    assert_eq!((inner.at(2, 2), inner.at(1, 3)), (1.0, 0.0));
}

#[test]
fn steps_of_a_column_have_mean_0_in_it() {
    let x = [-1.0, -1.0, 0.0, 0.5, 0.5, 0.5, 2.0, 1.5];
    let mut factor = Factor::new(&Family::of_column(&x), &x, 3);
    factor.add_knot(Knot { u: 0.3, is_kink: false });
    let step = factor.function(4);
    assert!(step.iter().sum::<f64>().abs() < 1e-12 && (step.iter().map(|s| s * s).sum::<f64>() - 8.0).abs() < 1e-12);
    let levels = Distribution::discrete(&[1.0, 2.0, 7.0], None).unwrap();
    assert!(factor.may_have_knots() && !Factor::new(&Family::new(&levels), &x, 3).may_have_knots());
}

#[test]
fn integrals_of_normal_factors_reach_far_out() {
    let (functions, weights) = integration(&Factor::new(&Family::Hermite, &[0.1, 0.6], 8));
    // E exp(z) z = sqrt(e).
    let sum: f64 = functions[0].iter().zip(&weights).map(|(z, w)| libm::exp(*z) * z * w).sum();
    assert!((sum - libm::exp(0.5)).abs() < 1e-9, "{sum}");
}
