use super::*;

#[test]
fn the_change_by_a_suitable_theory_is_a_finite_number_or_left_out() {
    let description = |scene: &Scene, contact| {
        let options = Options { contact, ..Options::default() };
        let model = AfmModel::new(*scene, options, Vec::new(), vec![AfmOutput::CriticalForce]).with_nominal(scene);
        model.flags.iter().find(|flag| flag.name == "tabor-out-of-range").unwrap().description.to_string()
    };
    let usual = Scene::default();
    assert!(description(&usual, ContactTheory::Hertz).contains(" %."));
    assert!(!description(&usual, ContactTheory::Auto).contains('%'));
    let invalid = Scene { particle_radius: -1.0, ..usual };
    assert!(!description(&invalid, ContactTheory::Hertz).contains('%'));
}

#[test]
fn every_edge_unit_is_known_and_of_the_right_kind() {
    for parameter in Parameter::ALL {
        let si = Unit::parse(parameter.unit).unwrap();
        assert!(edge_unit(parameter).compatible(&si), "{}", parameter.name);
    }
}

/// One bad row among many fails with its reason, and does not change the others in any bit.
#[test]
fn rows_do_not_depend_on_the_other_rows_of_a_batch() {
    let outputs = AfmOutput::ALL.to_vec();
    let factors = ["length", "velocity"].map(|name| Parameter::from_name(name).unwrap());
    let model = AfmModel::new(Scene::default(), Options::default(), factors.to_vec(), outputs);
    let run = |length: &[f64], velocity: &[f64]| {
        let mut batch = Batch::new(&model);
        batch.reset(length.len());
        model.worker(&RunContext::default()).run(&[length, velocity], &mut batch);
        batch.settle();
        batch
    };
    let lengths: Vec<f64> = (0..150).map(|i| 200e-6 + 1e-6 * f64::from(i)).collect();
    let velocities: Vec<f64> = (0..150).map(|i| 1e-9 * f64::from(i)).collect();
    let mut broken = lengths.clone();
    broken[100] = -1.0;
    let (whole, other) = (run(&lengths, &velocities), run(&broken, &velocities));
    for output in 0..AfmOutput::ALL.len() {
        for row in 0..150 {
            let alone = run(&lengths[row..=row], &velocities[row..=row]);
            let same = |batch: &Batch| batch.column(output)[row].to_bits() == alone.column(output)[0].to_bits();
            assert!(same(&whole) && (row == 100 || same(&other)), "{output} {row}");
        }
    }
    assert_eq!(whole.failures().len(), 1, "the time at rest");
    assert_eq!(other.failures().len(), 1 + AfmOutput::ALL.len());
    assert_eq!((whole.flags()[3], other.flags()[3]), (150, 149));
}

#[test]
fn a_substrate_at_rest_fails_only_the_time() {
    let outputs = vec![AfmOutput::CriticalForce, AfmOutput::CriticalTime];
    let velocity = Parameter::from_name("velocity").unwrap();
    let model = AfmModel::new(Scene::default(), Options::default(), vec![velocity], outputs);
    let mut batch = Batch::new(&model);
    batch.reset(2);
    model.worker(&RunContext::default()).run(&[&[100e-9, 0.0]], &mut batch);
    batch.settle();
    assert_eq!(batch.column(0)[0], batch.column(0)[1]);
    assert!(batch.column(1)[0] > 0.0);
    assert_eq!(batch.failures(), [(1, 1, RowFailure::new(&Failure::VelocityZero.to_string()))]);
}
