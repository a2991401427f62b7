use super::*;
use crate::model::{FunctionModel, RowFailure};

#[test]
fn mean_and_variance_are_those_of_the_repetitions() {
    let output = Output::new("y", Unit::parse("nN").unwrap(), "");
    let model = FunctionModel::new(vec![output], |x: &[f64], y: &mut [f64]| {
        if x[0] < 0.0 {
            return Err(RowFailure::new("below 0"));
        }
        y[0] = x[0] + x[1];
        Ok(())
    });
    let repeated = RepeatedModel::new(Arc::new(model), 1, 3);
    let units: Vec<String> = repeated.outputs().iter().map(|output| output.unit.to_string()).collect();
    assert_eq!(units, ["nN", "nN^2"]);
    let context = RunContext::default();
    let (mut worker, mut batch) = (repeated.worker(&context), Batch::new(&repeated));
    batch.reset(2);
    worker.run(&[&[5.0, -1.0], &[7.0, 7.0]], &mut batch);
    batch.settle();
    let seeds: Vec<f64> = (0..3).map(|number| seed_of_repetition(7.0, number)).collect();
    assert!(seeds[0] == 7.0 && seeds[1] != seeds[2] && seeds.iter().all(|seed| seed.fract() == 0.0));
    let mean = seeds.iter().sum::<f64>() / 3.0;
    let variance = seeds.iter().map(|seed| (seed - mean).powi(2)).sum::<f64>() / 2.0;
    assert!((batch.column(0)[0] - 5.0 - mean).abs() < 1e-6);
    assert!((batch.column(1)[0] / variance - 1.0).abs() < 1e-12);
    let reason = RowFailure::new("below 0");
    assert_eq!(batch.failures(), [(0, 1, reason.clone()), (1, 1, reason)]);
}

#[test]
fn squares_of_units_scale_as_squares() {
    let of = |text: &str| square(&Unit::label(text));
    assert_eq!(
        (of("um").to_string(), of("1").to_string(), of("degC").to_string()),
        ("um^2".into(), "1".into(), "K^2".into())
    );
    let compound = of("nN/m");
    assert!(same(compound.to_si(1.0), 1e-18), "{compound}");
    assert_eq!(of("cars per hour").to_string(), "(cars per hour)^2");
}
