use super::*;
use crate::model::{Batch, Output, RunContext, Worker};
use crate::quantity::Unit;
use crate::space::{Distribution, Factor};

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

fn all(space: &Space, points: usize) -> Vec<FactorValues> {
    (0..space.factors().len()).map(|factor| FactorValues::over_range(space, factor, points).unwrap()).collect()
}

#[test]
fn curves_extents_and_slopes_are_exact() {
    let space = space();
    let swept = sweep(&space, &powers(), &SweepRequest { factors: all(&space, 5), against: None }).unwrap();
    // (200e-6)^3/2^2 N = 2e-12 N = 2e-3 nN.
    let close = |a: f64, b: f64, tolerance: f64| (a - b).abs() <= tolerance * b.abs();
    assert!(close(swept.nominal[0].value.unwrap(), 2e-3, 1e-14));
    let length = &swept.sweeps[0];
    assert_eq!(length.values, [100.0, 150.0, 200.0, 250.0, 300.0]);
    let effect = &length.effects[0];
    assert_eq!((effect.first, effect.last), (effect.low, effect.high));
    assert!(close(effect.high.unwrap() / effect.low.unwrap(), 27.0, 1e-14));
    assert!(close(effect.percent.unwrap(), 100.0 * (1.5f64.powi(3) - 0.5f64.powi(3)), 1e-13));
    let stiffness = &swept.sweeps[1];
    for (value, expected) in
        stiffness.values.iter().zip([0.1, libm::pow(10f64, -0.5), 1.0, libm::pow(10f64, 0.5), 10.0])
    {
        assert!(close(*value, expected, 1e-15));
    }
    // Extrapolated central differences are exact for cubics; for x^-2 they are off by some 5 (h/x)^4 = 5e-8.
    for (sweep, power, tolerance) in [(length, 3.0, 1e-12), (stiffness, -2.0, 1e-7)] {
        let local = &sweep.effects[0].local;
        assert!(close(local.elasticity.unwrap(), power, tolerance), "{local:?}");
        assert!((local.elasticity.unwrap() - power).abs() <= local.elasticity_error.unwrap());
        assert!(local.elasticity_error.unwrap() < 1e-3);
    }
    assert!(close(length.effects[0].local.derivative.unwrap(), 3.0 * 2e-3 / 200.0, 1e-12));
    // z = x^2 at 0, the end of the range: a one-sided difference, exact for a parabola.
    let share = &swept.sweeps[2].effects[1];
    assert!(share.local.derivative.unwrap().abs() < 1e-15 && share.local.elasticity.is_none());
    assert_eq!(swept.runs, 1 + 15 + 5 + 5 + 4);
}

#[test]
fn failed_runs_are_gaps_with_reasons() {
    let space = space();
    let swept = sweep(&space, &powers(), &SweepRequest { factors: all(&space, 11), against: None }).unwrap();
    let z = &swept.sweeps[2].curves[0].outputs[1];
    assert_eq!(z.gaps, [9, 10].map(|place| Gap { place, reason: "too far".to_owned() }));
    assert_eq!((z.values[8].is_some(), z.values[9], z.values.len()), (true, None, 11));
    let effect = &swept.sweeps[2].effects[1];
    assert_eq!((effect.first, effect.last, effect.percent), (Some(0.0), None, None));
    let mut far = space.factors().to_vec();
    far[2].nominal = 0.9;
    let far = Space::new(far);
    let swept = sweep(&far, &powers(), &SweepRequest { factors: all(&far, 3), against: None }).unwrap();
    assert_eq!((swept.nominal[1].value, swept.nominal[1].reason.as_deref()), (None, Some("too far")));
    let effect = &swept.sweeps[0].effects[1];
    let reason = "a run at or beside the nominal point failed: too far";
    assert_eq!((effect.low, effect.local.derivative, effect.local.reason.as_deref()), (None, None, Some(reason)));
}

#[test]
fn a_family_moves_one_more_factor() {
    let space = space();
    let against = Some(FactorValues::parse("stiffness=1,2 N/m", &space).unwrap());
    let swept = sweep(&space, &powers(), &SweepRequest { factors: all(&space, 3), against: against.clone() }).unwrap();
    let (nominal, family) = swept.sweeps[0].curves.split_first().unwrap();
    assert_eq!(family.iter().map(|curve| curve.against.as_ref().unwrap().value).collect::<Vec<_>>(), [1.0, 2.0]);
    // The second value is the nominal one.
    assert_eq!(family[1].outputs, nominal.outputs);
    let ratio = family[0].outputs[0].values[1].unwrap() / family[1].outputs[0].values[1].unwrap();
    assert!((ratio - 4.0).abs() < 1e-14);
    assert!(swept.sweeps[1].curves.len() == 1, "a factor is not swept against itself");
    let itself = SweepRequest { factors: all(&space, 3)[1..2].to_vec(), against };
    assert!(sweep(&space, &powers(), &itself).unwrap_err().to_string().contains("`stiffness` cannot be swept"));
    let twice = SweepRequest { factors: [all(&space, 3), all(&space, 3)].concat(), against: None };
    assert_eq!(sweep(&space, &powers(), &twice), Err(SweepError::Repeated { name: "length".to_owned() }));
}

#[test]
fn ranges_end_where_the_distribution_does() {
    let law = |distribution| Space::new(vec![factor("x", "1", distribution, 1.0)]);
    let values = |distribution, points| FactorValues::over_range(&law(distribution), 0, points).unwrap().values;
    let normal = values(Distribution::normal(0.0, 1.0).unwrap(), 3);
    // The quantile of 0.001 from tables.
    assert!((normal[0] + 3.0902).abs() < 1e-4 && normal[1].abs() < 1e-9 && (normal[2] - 3.0902).abs() < 1e-4);
    let weibull = values(Distribution::weibull(2.0, 1.0, 5.0).unwrap(), 2);
    assert!(weibull[0] == 5.0 && (5.0..9.0).contains(&weibull[1]));
    let log_normal = values(Distribution::log_normal(1.0, 0.5).unwrap(), 3);
    assert!(log_normal[0] > 0.0 && (log_normal[1].powi(2) / (log_normal[0] * log_normal[2]) - 1.0).abs() < 1e-12);
    assert_eq!(values(Distribution::discrete(&[3.0, 1.0, 3.0], None).unwrap(), 50), [1.0, 3.0]);
    assert_eq!(values(Distribution::constant(2.5).unwrap(), 50), [2.5]);
    let space = law(Distribution::discrete(&[3.0, 1.0], None).unwrap());
    for points in [0, 1, MAX_POINTS + 1] {
        assert_eq!(FactorValues::over_range(&space, 0, points), Err(SweepError::Points { points }));
    }
}

#[test]
fn values_are_read_with_their_units() {
    let space = space();
    let read = |text: &str| FactorValues::parse(text, &space).map(|values| (values.factor, values.values));
    assert_eq!(read("length = 100,200 um"), Ok((0, vec![100.0, 200.0])));
    assert_eq!(read("length=0.1 mm,200um"), Ok((0, vec![100.0, 200.0])));
    assert_eq!(read("share=0.5,50 %"), Ok((2, vec![0.005, 0.5])));
    assert_eq!(read("share=0.5,1"), Ok((2, vec![0.5, 1.0])));
    let refused = |text: &str| read(text).unwrap_err().to_string();
    assert_eq!(
        refused("lenght=1 um"),
        "the study has no factor `lenght` (did you mean `length`?): its factors are length, stiffness, share"
    );
    assert_eq!(refused("length"), "expected NAME=VALUES, as in \"length=100,300 um\"");
    assert_eq!(refused("length="), refused("length"));
    assert_eq!(refused("length=1,2"), "`1` needs a unit, as in \"length=100,300 um\": factor `length` is a length");
    assert!(refused("length=1 N").starts_with("`1 N` is a force, but factor `length` is a length"));
    assert!(refused("length=1 um,").contains("\"\""), "{}", refused("length=1 um,"));
}

proptest::proptest! {
    #[test]
    fn no_request_panics(text in proptest::prelude::any::<String>(), list in "(length|share)=[-+0-9.eum, ]{0,16}") {
        let space = space();
        let _ = (FactorValues::parse(&text, &space), FactorValues::parse(&list, &space));
    }
}
