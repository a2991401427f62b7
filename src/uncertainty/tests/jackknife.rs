use super::*;

#[test]
fn for_a_mean_it_is_the_classical_t_interval() {
    let x = [1.0, 4.0, 2.0, 7.0, 6.0];
    let sum: f64 = x.iter().sum();
    let without: Vec<Vec<f64>> = x.iter().map(|xi| vec![(sum - xi) / 4.0]).collect();
    let got = jackknife(&[4.0], &without)[0].interval.unwrap();
    let sd = (x.iter().map(|x| (x - 4.0f64).powi(2)).sum::<f64>() / 4.0).sqrt();
    let half_width = t_quantile(4.0).unwrap() * sd / 5f64.sqrt();
    assert!((got.high - 4.0 - half_width).abs() < 1e-14);
    assert!((4.0 - got.low - half_width).abs() < 1e-14);
}

#[test]
fn one_replicate_has_no_interval() {
    assert_eq!(jackknife(&[0.5], &[vec![f64::NAN]])[0], Estimate::alone(0.5));
}
