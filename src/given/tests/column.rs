use super::*;

#[test]
fn extremes_come_to_order_one() {
    for scale in [1e-300, 1.0, 1e307] {
        let values = [-17.0 * scale, 3.0 * scale, 5.0 * scale];
        let centred = centred(&values).unwrap();
        assert!(centred.iter().sum::<f64>().abs() < 1e-15, "the sum of three numbers near 1");
        assert!((centred[1] - centred[2]).abs() / (centred[0] - centred[2]).abs() - 2.0 / 22.0 < 1e-15);
    }
    assert!(centred(&[f64::MAX, -f64::MAX, 0.0]).unwrap().iter().all(|v| v.abs() < 2.0));
    // The smallest positive numbers.
    assert!(centred(&[5e-324, 0.0]).is_ok());
}
