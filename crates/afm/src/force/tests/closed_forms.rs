//! Many scenes at once, compared with single scenes.

use proptest::prelude::*;

use super::properties::within_ranges;
use super::*;

const LAWS: [FrictionLaw; 6] = [
    FrictionLaw::Coulomb,
    FrictionLaw::HurtadoKim,
    FrictionLaw::LuGre,
    FrictionLaw::Dahl,
    FrictionLaw::Stribeck,
    FrictionLaw::Armstrong,
];

/// The papers' eight factors.
fn factors() -> Vec<&'static Parameter> {
    Parameter::ALL[..8].iter().collect()
}

/// Sets and solves `scenes`; returns whether the results are valid.
fn solve(forms: &mut ClosedForms, scenes: &[Scene]) -> bool {
    for parameter in factors() {
        let values: Vec<f64> = scenes.iter().map(parameter.get).collect();
        if !forms.set(parameter, &values) {
            return false;
        }
    }
    forms.solve();
    forms.are_ordinary(scenes.len())
}

proptest! {
    /// The same bits for any other columns of a scene.
    #[test]
    fn many_scenes_have_the_bits_of_each(
        scenes in prop::collection::vec(within_ranges(), 1..=AT_ONCE),
        options in prop::sample::select(closed_form_options(&LAWS)),
        accurate_time in any::<bool>(),
    ) {
        let options = Options { accurate_time, ..options };
        let mut forms = ClosedForms::new(&Scene::default(), &options, &factors()).unwrap();
        prop_assert!(solve(&mut forms, &scenes));
        let mut raised = vec![0; Flag::ALL.len()];
        for (i, scene) in scenes.iter().enumerate() {
            let one = critical_force(scene, &options).unwrap();
            let slips = forms.slips();
            prop_assert_eq!(slips.normal_force[i], one.normal_force);
            prop_assert_eq!(slips.lateral_force[i], one.lateral_force);
            prop_assert_eq!(slips.critical_force[i], one.critical_force);
            prop_assert_eq!(slips.twist[i], one.twist);
            prop_assert_eq!(slips.contact_radius[i], one.contact_radius);
            prop_assert_eq!(slips.error_estimate[i], one.error_estimate);
            if options.accurate_time {
                prop_assert_eq!(slips.travel[i], one.travel);
                prop_assert_eq!(forms.critical_time(i), one.critical_time);
            }
            prop_assert_eq!(forms.indentation(i), Ok(one.indentation));
            Flag::ALL.iter().zip(&mut raised).for_each(|(&flag, count)| *count += u64::from(one.flags.contains(flag)));
        }
        let mut counted = vec![0; Flag::ALL.len()];
        forms.count_flags(scenes.len(), |flag, count| counted[flag] += count);
        prop_assert_eq!(counted, raised);
    }

    /// Accepted scenes give finite results at every magnitude, with the bits of the same scene alone.
    #[test]
    fn extreme_scenes_are_left_to_the_scalar_code(exponents in prop::collection::vec(-300.0..300.0_f64, 8)) {
        let mut scene = Scene::default();
        for (parameter, exponent) in factors().into_iter().zip(exponents) {
            (parameter.set)(&mut scene, 10_f64.powf(exponent));
        }
        let mut forms = ClosedForms::new(&Scene::default(), &Options::default(), &factors()).unwrap();
        if solve(&mut forms, &[scene]) {
            let one = critical_force(&scene, &Options::default()).unwrap();
            prop_assert_eq!(forms.slips().critical_force[0], one.critical_force);
            prop_assert_eq!(forms.slips().error_estimate[0], one.error_estimate);
        }
    }
}

#[test]
fn values_outside_of_their_domain_are_left_to_the_other_way() {
    let mut forms = ClosedForms::new(&Scene::default(), &Options::default(), &factors()).unwrap();
    for (name, value) in [("length", 0.0), ("length", -1.0), ("velocity", -1e-9), ("adhesion", f64::NAN)] {
        let parameter = Parameter::from_name(name).unwrap();
        assert!(!forms.set(parameter, &[(parameter.get)(&Scene::default()), value]), "{name} {value}");
    }
}

#[test]
fn parameters_without_columns_are_computed_one_by_one() {
    let none = |scene: Scene, options: Options, name: &str| {
        ClosedForms::new(&scene, &options, &[Parameter::from_name(name).unwrap()]).is_none()
    };
    let options = Options::default();
    assert!(!none(Scene::default(), options, "length"));
    assert!(none(Scene::default(), options, "preload_angle"));
    assert!(none(Scene { width: 0.0, ..Scene::default() }, options, "length"));
    assert!(none(Scene::default(), Options { fidelity: Fidelity::QuasiStatic, ..options }, "length"));
    assert!(none(Scene::default(), by(FrictionLaw::LemaitreCarlson), "length"));
    assert!(none(Scene::default(), Options { tolerance: 0.0, ..options }, "length"));
}
