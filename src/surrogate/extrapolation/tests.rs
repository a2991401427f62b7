use super::*;
use crate::space::Distribution;
use crate::surrogate::Knot;
use crate::surrogate::family::Knotted;
use apportion_base::special::{normal_below, normal_quantile};

fn extrapolation(family: Family, terms: Vec<Term>, coefficients: Vec<f64>, rest: f64) -> ExtrapolationError {
    let families = [family, Family::Legendre];
    let effects = Effects { swaps: vec![vec![0], vec![1]], pairs: vec![(0, 1)] };
    ExtrapolationError::new(&[Expansion { terms, coefficients }], &families, 100, rest, &effects)
}

#[test]
fn deviations_of_a_square_from_its_tangents_agree_with_integrals() {
    // p = (z^2 - 1)/sqrt 2 minus its tangent is (z - c)^2/sqrt 2; mean in both tails by parts, c at 1/100.
    let error = extrapolation(Family::Hermite, vec![vec![], vec![(0, 2)]], vec![5.0, 1.0], 1.0);
    let c = -normal_quantile(0.01);
    let density = libm::exp(-c * c / 2.0) / (2.0 * std::f64::consts::PI).sqrt();
    let exact = 2.0_f64.sqrt() * ((1.0 + c * c) * normal_below(-c) - c * density);
    assert!((error.mean / exact - 1.0).abs() < 2e-3, "{} {exact}", error.mean);
    assert_eq!((error.variance, error.variance), (error.first_order[0], error.total[0]));
    assert_eq!([error.first_order[1], error.total[1], error.pairs[0]], [0.0; 3]);
    // If it fits well, the departure does not count.
    let fitted = extrapolation(Family::Hermite, vec![vec![(0, 2)]], vec![1.0], 1e-12);
    assert!((fitted.variance / (error.variance * 3.2_f64.powi(2) * 1e-6) - 1.0).abs() < 1e-9);
}

#[test]
fn steps_may_lie_anywhere_within_their_width() {
    let of = |width: f64| {
        let knots = [Knot { u: 0.3, width, is_step: true }];
        Family::Knotted(Box::new(Knotted::new(&Family::Legendre, &knots, 6)))
    };
    // The residual does not matter.
    let error =
        [0.0, 0.01].map(|width| extrapolation(of(width), vec![vec![(0, 1)], vec![(0, 2)]], vec![0.3, 0.8], 1e-9));
    let at = |u: f64| {
        let columns = polynomials(&of(0.01), &[u], 6);
        (0.3 * columns[0][0] + 0.8 * columns[1][0]).powi(2)
    };
    let exact = 0.01 / 12.0f64.sqrt() * (at(0.3 + 1e-9) - at(0.3 - 1e-9)).abs();
    assert_eq!(error[0].variance, 0.0);
    assert!(exact > 1e-4 && (error[1].total[0] / exact - 1.0).abs() < 1e-9, "{} {exact}", error[1].total[0]);
    assert_eq!(error[1].total[1], 0.0);
}

#[test]
fn lines_and_bounded_polynomials_do_not_depart() {
    let of = |family, term: Term| extrapolation(family, vec![term], vec![1.0], 1.0).variance;
    assert_eq!(of(Family::Hermite, vec![(0, 1)]), 0.0);
    assert_eq!(of(Family::Legendre, vec![(0, 9)]), 0.0);
    let [uniform, normal] = [
        Distribution::triangular(0.0, 0.4, 1.0).unwrap(),
        Distribution::truncated_normal(0.0, 1.0, -6.0, 6.0).unwrap(),
    ];
    let [bounded, long] = [&uniform, &normal].map(|law| of(Family::new(law), vec![(0, 8)]));
    assert!(bounded < 0.3 && long > 0.5, "{bounded} {long}");
    // Most of a polynomial of high degree lies outside the runs.
    let high = of(Family::Hermite, vec![(0, 10)]);
    assert!((0.5..1.0).contains(&high), "{high}");
}

#[test]
fn products_belong_to_all_their_factors() {
    let terms = vec![vec![(0, 3), (1, 2)], vec![(1, 2)]];
    let error = extrapolation(Family::Hermite, terms.clone(), vec![0.5, 0.2], 1.0);
    assert!(error.variance > 0.0 && error.mean == 0.0);
    let of_pair = [error.total[0], error.total[1], error.pairs[0]];
    assert_eq!(of_pair, [error.variance; 3]);
    assert_eq!(error.first_order, [0.0; 2]);
    // Both tails have a half each, by symmetry of the odd polynomial, apart from the other terms.
    let alone = extrapolation(Family::Hermite, terms, vec![0.5, 0.0], 1.0);
    assert!(alone.variance < error.variance);
}
