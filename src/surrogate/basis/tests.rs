use super::*;
use crate::surrogate::family::polynomials;
use apportion_base::sum::product;

fn legendre(factors: usize) -> Vec<Family> {
    vec![Family::Legendre; factors]
}

#[test]
fn terms_come_by_their_norm() {
    let terms = first_terms(Caps::new(&legendre(3), 0), 12);
    let expected: [&[(usize, usize)]; 12] = [
        &[],
        &[(0, 1)],
        &[(1, 1)],
        &[(2, 1)],
        &[(0, 2)],
        &[(1, 2)],
        &[(2, 2)],
        &[(0, 1), (1, 1)],
        &[(0, 1), (2, 1)],
        &[(1, 1), (2, 1)],
        &[(0, 3)],
        &[(1, 3)],
    ];
    assert_eq!(terms, expected);
    // All degrees up to 14 of one factor, and no duplicate term.
    assert_eq!(first_terms(Caps::new(&[Family::Legendre], 0), 400).len(), 15);
    let many = first_terms(Caps::new(&legendre(8), 0), 300);
    assert_eq!(many.iter().collect::<std::collections::HashSet<_>>().len(), 300);
    assert_eq!(first_terms(Caps::new(&legendre(2000), 0), 260).len(), 260);
}

#[test]
fn polynomials_are_orthonormal() {
    // By the midpoint rule, which misses the tails of Hermite polynomials.
    let n = 20_000;
    let u: Vec<f64> = (0..n).map(|i| (f64::from(i) + 0.5) / f64::from(n)).collect();
    for (family, degree, tolerance) in [(Family::Legendre, 10, 1e-5), (Family::Hermite, 4, 1e-1)] {
        let columns = polynomials(&family, &u, degree);
        for (j, a) in columns.iter().enumerate() {
            assert!((a.iter().sum::<f64>() / f64::from(n)).abs() < tolerance, "{family:?} {j}");
            for (k, b) in columns.iter().enumerate() {
                let product = product(a, b) / f64::from(n);
                assert!((product - f64::from(u8::from(j == k))).abs() < tolerance, "{family:?} {j} {k} {product}");
            }
        }
    }
}

#[test]
fn neighbours_lead_on_from_what_matters() {
    let active = vec![vec![], vec![(0, 1)], vec![(1, 2)]];
    let caps = Caps { terms: 20, degree: 6, unbounded_degree: 0, families: &legendre(2) };
    let terms = neighbours(&active, &[3.0, 0.5, 2.0], caps);
    assert_eq!(terms[..3], [vec![], vec![(1, 2)], vec![(0, 1)]]);
    for expected in [vec![(1, 3)], vec![(1, 4)], vec![(0, 1), (1, 2)], vec![(0, 2)], vec![(0, 1), (1, 1)]] {
        assert!(terms.contains(&expected), "{expected:?}");
    }
    assert!(terms.iter().all(|term| term.iter().map(|t| t.1).sum::<usize>() <= 6));
}
