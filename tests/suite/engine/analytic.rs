//! Indices against exact answers. Seeds are fixed; the tolerances are those stated by the project.

use apportion::model::KnownAnswer;
use apportion::result::StudyResult;

use crate::common::{analysed, gap, indices, numbers};

/// Exact first-order and total indices of a function with its default parameters.
fn exact(name: &str) -> (Vec<f64>, Vec<f64>) {
    let indices = KnownAnswer::from_name(name).unwrap().default_function().exact().indices.unwrap();
    (indices.first_order, indices.total)
}

/// Mean of x^k and variance over mean squared of x^k for x uniform on (a, b), from the integral of x^k.
fn relative_variance_of_power(a: f64, b: f64, k: i32) -> f64 {
    let moment = |k: i32| (b.powi(k + 1) - a.powi(k + 1)) / (f64::from(k + 1) * (b - a));
    moment(2 * k) / moment(k).powi(2) - 1.0
}

/// Exact first-order and total indices of F_cr = c E w t^3 L^-2 over the papers' box, in the order of the general
/// study; the factors without effect have 0.
fn product_form() -> (Vec<f64>, Vec<f64>) {
    let v = [
        relative_variance_of_power(200.0, 700.0, -2),
        relative_variance_of_power(5.0, 80.0, 1),
        relative_variance_of_power(0.25, 2.5, 3),
        0.0,
        0.0,
        relative_variance_of_power(120.0, 200.0, 1),
        0.0,
        0.0,
    ];
    let all: f64 = v.iter().map(|v| 1.0 + v).product();
    let first = v.iter().map(|v| v / (all - 1.0)).collect();
    let total = v.iter().map(|v| v * all / (1.0 + v) / (all - 1.0)).collect();
    (first, total)
}

const WITHOUT_SHEAR: &str = "afm.shear_strength=0 MPa";

#[test]
fn the_closed_forms_of_the_reference() {
    assert!((relative_variance_of_power(0.25, 2.5, 3) - 1.05755).abs() < 5e-6);
    assert!((relative_variance_of_power(200.0, 700.0, -2) - 0.595238).abs() < 5e-7);
    assert!((relative_variance_of_power(5.0, 80.0, 1) - 0.259516).abs() < 5e-7);
    assert!((relative_variance_of_power(120.0, 200.0, 1) - 0.0208333).abs() < 5e-8);
}

#[test]
fn the_product_form_in_one_replicate_is_within_2e_3() {
    let result = analysed("coulomb-general", &[WITHOUT_SHEAR, "design.base_samples=65536", "design.replicates=1"]);
    let (first, total) = numbers(&result.outputs[0]);
    let exact = product_form();
    let error = gap(&first, &exact.0).max(gap(&total, &exact.1));
    assert!(error < 2e-3, "{error}");
    // Inert factors are exactly inert.
    for inert in ["height", "velocity", "equivalent_modulus", "adhesion"] {
        let index = indices(&result).iter().find(|index| index.name == inert).unwrap();
        assert_eq!((index.effect.first_order.estimate, index.effect.total.estimate), (0.0, 0.0), "{inert}");
    }
}

#[test]
fn the_product_form_in_four_nets_and_in_sixteen_replicates_is_within_2e_2_and_its_intervals_hold() {
    let many = ["design.base_samples=65536", "design.replicates=16", "analysis.intervals=replicates"];
    for design in [&[WITHOUT_SHEAR][..], &[&[WITHOUT_SHEAR][..], &many].concat()] {
        product_form_holds(&analysed("coulomb-general", design));
    }
}

fn product_form_holds(result: &StudyResult) {
    let (first, total) = numbers(&result.outputs[0]);
    let exact = product_form();
    let error = gap(&first, &exact.0).max(gap(&total, &exact.1));
    assert!(error < 2e-2, "{error}");
    // Eight intervals of active factors at 95 %: more than two misses have a probability below 1 %.
    let effects = indices(result).iter().map(|index| index.effect);
    let missed = effects
        .zip(exact.0.iter().zip(&exact.1))
        .flat_map(|(effect, (first, total))| [(effect.first_order, first), (effect.total, total)])
        .filter(|(estimate, exact)| !(estimate.interval.unwrap().low..=estimate.interval.unwrap().high).contains(exact))
        .count();
    assert!(missed <= 2, "{missed} of the intervals miss");
}

#[test]
fn intervals_hold_about_as_often_as_they_say() {
    // 60 seeds x 6 indices of Ishigami's function. Measured over 400 seeds of 4096 base samples: 93 to 97 %. A coverage of 95 %
    // leaves fewer than 88 % here with a probability below 1e-4; intervals that are too wide hold always, so 100 % fails too.
    let exact = exact("ishigami");
    let (mut held, mut all) = (0, 0);
    for seed in 0..60 {
        // Plain: a surrogate knows this function to the last digits, and its intervals hold always.
        let plain = ["design.base_samples=1024", "analysis.surrogate=\"off\"", &format!("design.seed={seed}")];
        let result = analysed("ishigami", &plain);
        for (index, (first, total)) in indices(&result).iter().zip(exact.0.iter().zip(&exact.1)) {
            for (estimate, exact) in [(index.effect.first_order, first), (index.effect.total, total)] {
                held += usize::from((estimate.interval.unwrap().low..=estimate.interval.unwrap().high).contains(exact));
                all += 1;
            }
        }
    }
    let coverage = held as f64 / f64::from(all);
    assert!((0.88..0.995).contains(&coverage), "{coverage}");
}

#[test]
fn groups_of_the_product_form_are_products_too() {
    // With X the dimensional and Y the environmental product, V_X = prod(1 + V_j) - 1 and the indices follow as for
    // two factors.
    let result = analysed("coulomb-general", &[WITHOUT_SHEAR]);
    let (x, y) = (
        (1.0 + relative_variance_of_power(200.0, 700.0, -2))
            * (1.0 + relative_variance_of_power(5.0, 80.0, 1))
            * (1.0 + relative_variance_of_power(0.25, 2.5, 3))
            - 1.0,
        relative_variance_of_power(120.0, 200.0, 1),
    );
    let all = (1.0 + x) * (1.0 + y) - 1.0;
    let exact = [("dimensional", x / all, x * (1.0 + y) / all), ("environmental", y / all, y * (1.0 + x) / all)];
    let groups = result.outputs[0].groups.as_deref().unwrap();
    for (group, (name, first, total)) in groups.iter().zip(exact) {
        assert_eq!(group.name, name);
        assert!((group.effect.first_order.estimate - first).abs() < 5e-3);
        assert!((group.effect.total.estimate - total).abs() < 5e-3);
    }
}

#[test]
fn ishigami_and_sobol_g_are_within_1e_3_and_3e_3() {
    for name in ["ishigami", "sobol-g"] {
        let exact = exact(name);
        for (replicates, tolerance) in [(1, 1e-3), (4, 3e-3)] {
            let overrides = [&format!("design.replicates={replicates}")[..], "design.base_samples=65536"];
            let (first, total) = numbers(&analysed(name, &overrides).outputs[0]);
            let error = gap(&first, &exact.0).max(gap(&total, &exact.1));
            assert!(error < tolerance, "{name}, {replicates} replicates: {error}");
        }
    }
}

#[test]
fn every_sampler_finds_the_same_indices() {
    // The error of random points is of order N^-1/2: about 5e-3 for 2^16 base samples; five of these are allowed.
    let exact = exact("ishigami");
    for sampler in ["random", "latin-hypercube"] {
        let result = analysed("ishigami", &[&format!("design.sampler={sampler}")]);
        let (first, total) = numbers(&result.outputs[0]);
        assert!(gap(&first, &exact.0).max(gap(&total, &exact.1)) < 0.025, "{sampler}");
        assert_eq!(result.provenance.sampler.name(), sampler);
    }
}

#[test]
fn the_critical_time_at_velocity_zero_is_null_with_a_counted_reason() {
    let result = analysed(
        "coulomb-dimensional",
        &["afm.velocity=0 nm/s", "outputs=['critical_force', 'critical_time']", "design.base_samples=256"],
    );
    let [force, time] = &result.outputs[..] else { panic!("two outputs") };
    assert_eq!(force.runs_failed, 0);
    assert!(force.indices.is_some());
    assert_eq!((time.runs_failed, time.runs_ok), (256 * 6, 0));
    assert_eq!((time.mean, &time.indices), (None, &None));
    assert!(time.reason.is_some() && time.failures.len() == 1);
}

#[test]
fn height_and_velocity_do_not_act_on_the_closed_form() {
    // H never enters the critical force, V only through LuGre: exact zeros, far within the stated 1e-12.
    for friction in ["coulomb", "hk", "lugre"] {
        let result = analysed("coulomb-general", &[&format!("afm.friction={friction}"), "design.base_samples=1024"]);
        let inert: &[&str] = if friction == "lugre" { &["height"] } else { &["height", "velocity"] };
        for &name in inert {
            let index = indices(&result).iter().find(|index| index.name == name).unwrap();
            assert!(index.effect.first_order.estimate.abs() < 1e-12);
            assert!(index.effect.total.estimate.abs() < 1e-12);
        }
    }
}
