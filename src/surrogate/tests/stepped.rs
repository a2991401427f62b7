use super::*;

#[test]
fn steps_hinges_and_polynomials_are_orthonormal_and_span_them() {
    let knots = [(0.3, false), (0.8, true)].map(|(u, is_kink)| Knot { u, is_kink });
    let stepped = Stepped::new(&Family::Legendre, 5, knots.into(), vec![0.0; 2]);
    let n = 100_000;
    let u: Vec<f64> = (0..n).map(|k| (f64::from(k) + 0.5) / f64::from(n)).collect();
    let columns = polynomials(&Family::Stepped(Box::new(stepped.clone())), &u, 5);
    assert_eq!(columns.len(), 7);
    for (i, a) in columns.iter().enumerate() {
        for (j, b) in columns.iter().enumerate() {
            let product = a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>() / f64::from(n);
            assert!((product - f64::from(u8::from(i == j))).abs() < 1e-6, "{i} {j} {product}");
        }
    }
    let is_sum = |index: usize, exact: &[f64]| {
        let mut sum = vec![0.0; u.len()];
        stepped.parts(index).iter().for_each(|(k, part)| add_scaled(&mut sum, *part, &columns[k - 1]));
        sum.iter().zip(exact).all(|(a, b)| (a - b).abs() < 1e-8)
    };
    for (k, exact) in polynomials(&Family::Legendre, &u, 5).iter().enumerate() {
        assert!(is_sum(k + 1, exact), "{k}");
    }
    for (knot, index) in knots.into_iter().zip([6, 7]) {
        let (exact, over) = (knot.standard(&u), knot.standard_over(&u, &u));
        assert!(is_sum(index, &exact), "{index}");
        assert!(over.iter().zip(&exact).all(|(a, b)| (a - b).abs() < 1e-8));
    }
}
