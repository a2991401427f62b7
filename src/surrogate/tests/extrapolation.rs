use super::*;
use crate::space::Distribution;
use crate::surrogate::stepped::{Knot, Stepped};
use apportion_base::special::{normal_below, normal_quantile};

fn extrapolation(family: Family, terms: Vec<Term>, coefficients: Vec<f64>, rest: f64) -> ExtrapolationError {
    let families = [family, Family::Legendre];
    let effects = Effects { swaps: vec![vec![0], vec![1]], pairs: vec![(0, 1)] };
    ExtrapolationError::new(&[Expansion { terms: terms.into(), coefficients }], &families, 100, rest, &effects)
}

#[test]
fn deviations_of_a_square_from_its_tangents_agree_with_integrals() {
    // p = (z^2 - 1)/sqrt 2 minus its tangent is (z - c)^2/sqrt 2, and this rises by sqrt 2 c (z - c); means in both
    // tails by parts, c at 1/100.
    let error = extrapolation(Family::Hermite, vec![vec![], vec![(0, 2)]], vec![5.0, 1.0], 1.0);
    let c = -normal_quantile(0.01);
    let density = libm::exp(-c * c / 2.0) / (2.0 * std::f64::consts::PI).sqrt();
    let exact = 2.0_f64.sqrt() * ((1.0 - c * c) * normal_below(-c) + c * density);
    // The midpoint rule errs by 3e-3.
    assert!((error.mean / exact - 1.0).abs() < 5e-3, "{} {exact}", error.mean);
    assert_eq!((error.variance, error.variance), (error.first_order[0], error.total[0]));
    assert_eq!([error.first_order[1], error.total[1], error.pairs[0]], [0.0; 3]);
    // If it fits well, the departure does not count.
    let fitted = extrapolation(Family::Hermite, vec![vec![(0, 2)]], vec![1.0], 1e-12);
    assert!(fitted.variance < error.variance * 3.2_f64.powi(2) * 1e-6);
}

#[test]
fn steps_may_lie_anywhere_within_their_width() {
    let of = |width: f64| {
        Family::Stepped(Box::new(Stepped::new(
            &Family::Legendre,
            6,
            vec![Knot { u: 0.3, is_kink: false }],
            vec![width],
        )))
    };
    // The residual does not matter.
    let error =
        [0.0, 0.01].map(|width| extrapolation(of(width), vec![vec![(0, 1)], vec![(0, 7)]], vec![0.3, 0.8], 1e-9));
    let at = |u: f64| {
        let columns = polynomials(&of(0.01), &[u], 6);
        (0.3 * columns[0][0] + 0.8 * columns[6][0]).powi(2)
    };
    let exact = 0.01 / 12.0f64.sqrt() * (at(0.3 + 1e-9) - at(0.3 - 1e-9)).abs();
    let rise = {
        let [below, above] = [-1e-9, 1e-9].map(|side| polynomials(&of(0.01), &[0.3 + side], 6));
        0.3 * (above[0][0] - below[0][0]) + 0.8 * (above[6][0] - below[6][0])
    };
    let open = 0.01 / 12.0f64.sqrt() * rise * rise;
    assert!((error[1].of_any / open - 1.0).abs() < 1e-9, "{} {open}", error[1].of_any);
    assert_eq!([error[0].variance, error[0].of_any], [0.0; 2]);
    assert!(exact > 1e-4 && (error[1].total[0] / exact - 1.0).abs() < 1e-9, "{} {exact}", error[1].total[0]);
    assert_eq!(error[1].total[1], 0.0);
}

#[test]
fn what_rows_do_not_show_of_a_line_is_its_variance_beyond_them() {
    let of = |law: Distribution, by: Option<Family>, rest: f64| {
        let family = Family::new(&law);
        let family = by.map_or(family.clone(), |by| family.replaced(by));
        extrapolation(family, vec![vec![(0, 1)]], vec![1.0], rest).variance
    };
    // E z^2 - c^2 beyond c = ln 100, z = x - 1, is (2 c + 2 - 2)/100; below it is nearly the same at all rows.
    let exponential = || Distribution::exponential(1.0, 0.0).unwrap();
    let exact = 2.0 * 100.0_f64.ln() / 100.0;
    assert!((of(exponential(), None, 1.0) / exact - 1.0).abs() < 1e-2);
    assert!((of(exponential(), None, 1e-4) / exact - 1e-2).abs() < 1e-4);
    assert_eq!(of(exponential(), None, 0.0), 0.0);
    // A line in the quantile departs from that in the values.
    assert!(of(exponential(), Some(Family::Legendre), 1.0) > 1e-3);
    // Most of the variance of a heavy tail.
    assert!(of(Distribution::pareto(2.1, 1.0).unwrap(), None, 1.0) > 0.4);
}

#[test]
fn bounded_polynomials_do_not_depart() {
    let of = |family, term: Term| extrapolation(family, vec![term], vec![1.0], 1.0).variance;
    assert_eq!(of(Family::Legendre, vec![(0, 9)]), 0.0);
    let [uniform, normal] = [
        Distribution::triangular(0.0, 0.4, 1.0).unwrap(),
        Distribution::truncated_normal(0.0, 1.0, -6.0, 6.0).unwrap(),
    ];
    let [bounded, long] = [&uniform, &normal].map(|law| of(Family::new(law), vec![(0, 8)]));
    assert!(bounded < 0.4 && long > 0.5, "{bounded} {long}");
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
    // The mean over the first factor is a coefficient of the second.
    assert!(error.first_order[0] == 0.0 && error.first_order[1] > 0.0);
    // Both tails have a half each, by symmetry of the odd polynomial, apart from the other terms.
    let alone = extrapolation(Family::Hermite, terms, vec![0.5, 0.0], 1.0);
    assert!(alone.variance < error.variance * (1.0 + 1e-9) && alone.first_order == [0.0; 2]);
}
