use apportion::model::{Model, RunContext};
use apportion_base::quantity::Unit;

use super::*;
use crate::{AfmModel, AfmOutput, Fidelity, Parameter};

#[test]
fn moments_end_with_the_duration() {
    let moments = AfmMoments::new(0.4, 4).unwrap();
    assert_eq!((moments.times(), moments.duration()), (&[0.1, 0.2, 0.30000000000000004, 0.4][..], 0.4));
    for (duration, points) in
        [(0.0, 4), (-1.0, 4), (f64::NAN, 4), (f64::INFINITY, 4), (1.0, 1), (1.0, 10_001), (1e-323, 50)]
    {
        assert!(AfmMoments::new(duration, points).is_err(), "{duration} {points}");
    }
    AfmHistory::ALL.iter().for_each(|history| assert!(Unit::parse(history.row().0).is_ok()));
}

/// Values come after the outputs; a bad row fails in all of them, once each, and does not affect the others.
#[test]
fn histories_are_listed_next_to_the_outputs() {
    let factors = ["velocity", "length"].map(|name| Parameter::from_name(name).unwrap());
    let moments = AfmMoments::new(0.4, 3).unwrap();
    let options = Options { fidelity: Fidelity::QuasiStatic, ..Options::default() };
    let model = AfmModel::new(Scene::default(), options, factors.to_vec(), vec![AfmOutput::CriticalForce])
        .with_histories(&AfmHistory::ALL, &moments);
    let names: Vec<&str> = model.outputs().iter().map(|output| &*output.name).collect();
    assert_eq!(
        (names.len(), names[0], names[1], names[12]),
        (13, "critical_force", "force_history[0]", "tip_contact_history[2]")
    );
    assert_eq!(model.series()[3].places(), 10..13);
    let mut batch = Batch::new(&model);
    batch.reset(3);
    model.worker(&RunContext::default()).run(&[&[100e-9, 100e-9, 0.0], &[225e-6, -1.0, 225e-6]], &mut batch);
    batch.settle();
    assert_eq!(batch.failures().len(), 13);
    assert!(batch.failures().iter().all(|(_, row, reason)| *row == 1 && reason.to_string().contains("length")));
    // At 0.4 s it has slipped, at rest it has not moved.
    let last = |history: usize, row: usize| batch.column(1 + 3 * history + 2)[row];
    assert!((last(0, 0) / batch.column(0)[0] - 1.0).abs() < 1e-6);
    assert_eq!((last(1, 2), last(2, 0).is_finite()), (0.0, true));
    assert!(last(3, 0) > last(3, 2));
}
