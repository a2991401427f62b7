use super::*;
use crate::model::{Model, RunContext, Worker};
use crate::space::Distribution;
use crate::space::Factor;
use crate::sweep::Sweeps;
use apportion_base::quantity::Unit;

/// y = x0^3 / x1^2, and z = x2^2, which fails where x2 is above 0.8.
struct Powers {
    outputs: [Output; 2],
}

fn powers() -> Powers {
    let output = |name: &'static str, unit| Output {
        name: name.into(),
        unit: Unit::parse(unit).unwrap(),
        description: "".into(),
    };
    Powers { outputs: [output("y", "nN"), output("z", "1")] }
}

impl Model for Powers {
    fn outputs(&self) -> &[Output] {
        &self.outputs
    }

    fn worker<'a>(&'a self, _: &'a RunContext<'a>) -> Box<dyn Worker + 'a> {
        Box::new(Row)
    }
}

struct Row;

impl Worker for Row {
    fn run(&mut self, inputs: &[&[f64]], batch: &mut Batch) {
        let [length, stiffness, share] = inputs else { panic!("three factors") };
        for (row, ((x0, x1), x2)) in length.iter().zip(*stiffness).zip(*share).enumerate() {
            batch.set(row, 0, x0.powi(3) / x1.powi(2));
            if *x2 > 0.8 {
                batch.fail(row, 1, RowFailure::new("too far"));
            } else {
                batch.set(row, 1, x2 * x2);
            }
        }
    }
}

fn factor(name: &str, unit: &str, distribution: Distribution, nominal: f64) -> Factor {
    let mut factor = Factor::new(name, Unit::parse(unit).unwrap(), distribution).unwrap();
    factor.nominal = nominal;
    factor
}

fn space() -> Space {
    Space::new(vec![
        factor("length", "um", Distribution::uniform(100.0, 300.0).unwrap(), 200.0),
        factor("stiffness", "N/m", Distribution::log_uniform(0.1, 10.0).unwrap(), 2.0),
        factor("share", "1", Distribution::uniform(0.0, 1.0).unwrap(), 0.0),
    ])
}

fn sweep_of(space: &Space, factors: &[usize], points: usize) -> Sweeps {
    sweep(&TableRun::new(&powers(), &RunContext::default(), 0), space, factors, points).unwrap()
}

#[test]
fn curves_and_extents_are_exact() {
    let space = space();
    let swept = sweep_of(&space, &[0, 1, 2], 5);
    // (200e-6)^3/2^2 N = 2e-12 N = 2e-3 nN.
    let close = |a: f64, b: f64, tolerance: f64| (a - b).abs() <= tolerance * b.abs();
    assert!(close(swept.nominal[0].value.unwrap(), 2e-3, 1e-14));
    let length = &swept.sweeps[0];
    assert_eq!(length.values, [100.0, 150.0, 200.0, 250.0, 300.0]);
    let y = &length.outputs[0];
    assert_eq!((y.values[0], y.values[4]), (y.low, y.high));
    assert!(close(y.high.unwrap() / y.low.unwrap(), 27.0, 1e-14));
    assert!(close(y.percent.unwrap(), 100.0 * (1.5f64.powi(3) - 0.5f64.powi(3)), 1e-13));
    let stiffness = &swept.sweeps[1];
    let expected = [0.1, libm::pow(10f64, -0.5), 1.0, libm::pow(10f64, 0.5), 10.0];
    assert!(stiffness.values.iter().zip(expected).all(|(value, expected)| close(*value, expected, 1e-15)));
    assert_eq!(swept.runs, 1 + 15);
}

#[test]
fn failed_runs_are_gaps_with_reasons() {
    let space = space();
    let swept = sweep_of(&space, &[2], 11);
    let z = &swept.sweeps[0].outputs[1];
    assert_eq!(z.gaps, [9, 10].map(|place| Gap { place, reason: "too far".to_owned() }));
    assert_eq!((z.values[8].is_some(), z.values[9], z.values.len()), (true, None, 11));
    assert_eq!((z.low, z.values[10], z.percent), (Some(0.0), None, None));
    let mut far = space.factors().to_vec();
    far[2].nominal = 0.9;
    let swept = sweep_of(&Space::new(far), &[0], 3);
    assert_eq!((swept.nominal[1].value, swept.nominal[1].reason.as_deref()), (None, Some("too far")));
    assert_eq!(swept.sweeps[0].outputs[1].low, None);
}

#[test]
fn factors_are_found_by_name() {
    let space = space();
    let none: [&str; 0] = [];
    assert_eq!(find(&space, &none).unwrap(), [0, 1, 2]);
    assert_eq!(find(&space, &["share", " length"]).unwrap(), [2, 0]);
    assert!(matches!(find(&space, &["share", "share"]), Err(SweepError::Repeated(name)) if name == "share"));
    let error = find(&space, &["lenght"]).unwrap_err();
    let SweepError::UnknownFactor { name, nearest, factors } = error else { panic!("{error}") };
    assert_eq!((name.as_str(), nearest.as_deref(), factors.len()), ("lenght", Some("length"), 3));
}

#[test]
fn ranges_end_where_the_distribution_does() {
    let values = |distribution: Distribution, points| distribution.values_over_range(points).unwrap();
    let normal = values(Distribution::normal(0.0, 1.0).unwrap(), 3);
    // The quantile of 0.001 from tables.
    assert!((normal[0] + 3.0902).abs() < 1e-4 && normal[1].abs() < 1e-9 && (normal[2] - 3.0902).abs() < 1e-4);
    let weibull = values(Distribution::weibull(2.0, 1.0, 5.0).unwrap(), 2);
    assert!(weibull[0] == 5.0 && (5.0..9.0).contains(&weibull[1]));
    let log_normal = values(Distribution::log_normal(1.0, 0.5).unwrap(), 3);
    assert!(log_normal[0] > 0.0 && (log_normal[1].powi(2) / (log_normal[0] * log_normal[2]) - 1.0).abs() < 1e-12);
    assert_eq!(values(Distribution::discrete(&[3.0, 1.0, 3.0], None).unwrap(), 50), [1.0, 3.0]);
    assert_eq!(values(Distribution::constant(2.5).unwrap(), 50), [2.5]);
    for points in [0, 1, Sweeps::MAX_POINTS + 1] {
        let discrete = Distribution::discrete(&[3.0, 1.0], None).unwrap();
        assert!(matches!(discrete.values_over_range(points), Err(SweepError::Points(refused)) if refused == points));
    }
}
