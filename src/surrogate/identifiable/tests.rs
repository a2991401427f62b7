use super::super::basis::first_terms;
use super::super::family::polynomials;
use super::*;
use crate::space::Distribution;

/// Returns a net of plain rows with these quantiles of every factor.
fn net(families: &[Family], rows: &[Vec<f64>]) -> Net {
    let columns = families.iter().zip(rows).map(|(family, u)| polynomials(family, u, 6)).collect();
    Net::of_rows(columns, vec![0.0; rows[0].len()])
}

fn boolean(p: f64) -> Family {
    Family::new(&Distribution::boolean(p).unwrap())
}

fn even(count: u32) -> Vec<f64> {
    (0..count).map(|i| (f64::from(i) + 0.5) / f64::from(count)).collect()
}

#[test]
fn a_level_without_rows_gives_no_polynomial() {
    let families = [boolean(0.001), boolean(0.5), Family::Legendre];
    let rows = [even(64), even(64), even(64)];
    let nets = [net(&families, &rows)];
    let identifiable =
        IdentifiableTerms::new(&nets, Caps { terms: 50, degree: 6, unbounded_degree: 0, families: &families });
    assert!(!identifiable.is_identifiable(&vec![(0, 1)]) && !identifiable.is_identifiable(&vec![(0, 1), (2, 1)]));
    assert!(identifiable.is_identifiable(&vec![(1, 1)]) && identifiable.is_identifiable(&vec![(2, 6)]));
}

#[test]
fn one_net_without_the_level_is_enough() {
    let families = [boolean(0.02)];
    let with = net(&families, &[even(100)]);
    let without = net(&families, &[even(100).into_iter().map(|u| 0.9 * u).collect()]);
    let caps = Caps { terms: 50, degree: 6, unbounded_degree: 0, families: &families };
    let nets = [with, without];
    assert!(IdentifiableTerms::new(&nets[..1], caps).is_identifiable(&vec![(0, 1)]));
    assert!(!IdentifiableTerms::new(&nets, caps).is_identifiable(&vec![(0, 1)]));
}

#[test]
fn two_rare_levels_that_never_meet_do_not_interact() {
    // Two rows in a hundred have either level, and none has both.
    let families = [boolean(0.02), boolean(0.02)];
    let turned: Vec<f64> = even(100).into_iter().map(|u| (u + 0.5) % 1.0).collect();
    let nets = [net(&families, &[even(100), turned])];
    let identifiable =
        IdentifiableTerms::new(&nets, Caps { terms: 50, degree: 6, unbounded_degree: 0, families: &families });
    assert!(identifiable.is_identifiable(&vec![(0, 1)]) && identifiable.is_identifiable(&vec![(1, 1)]));
    assert!(!identifiable.is_identifiable(&vec![(0, 1), (1, 1)]));
}

#[test]
fn all_terms_of_uniform_and_normal_factors_stay() {
    let families = [Family::Legendre, Family::Hermite];
    let nets = [net(&families, &[even(8), even(8)])];
    let caps = Caps { terms: 50, degree: 6, unbounded_degree: 4, families: &families };
    assert_eq!(IdentifiableTerms::new(&nets, caps).retain(first_terms(caps, 50)), first_terms(caps, 50));
}
