use super::*;
use crate::surrogate::family::{Family, polynomials};

#[test]
fn rows_that_misrepresent_a_factor_have_less_variance_than_the_expansion() {
    // The second factor stays within a twentieth of its range: its polynomial hardly varies.
    let u: Vec<f64> = (0..100).map(|i| (f64::from(i) + 0.5) / 100.0).collect();
    let narrow: Vec<f64> = u.iter().map(|u| 0.95 + 0.05 * u).collect();
    let columns = [&u, &narrow].map(|u| polynomials(&Family::Legendre, u, 1)).to_vec();
    let net = Net::of_rows(columns, vec![0.0; 100]);
    let expansion = Expansion { terms: [vec![], vec![(0, 1)], vec![(1, 1)]].into(), coefficients: vec![7.0, 1.0, 0.5] };
    let claims = claims(&net, &expansion, &[vec![0], vec![1]]);
    assert_eq!(claims.iter().map(|claim| claim.claimed).collect::<Vec<_>>(), [1.0, 0.25, 1.25]);
    assert!((claims[0].shown - 1.0).abs() < 1e-3 && (claims[1].shown * 400.0 - 0.25).abs() < 1e-3, "{claims:?}");
}
