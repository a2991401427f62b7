//! Verdicts change with the physics and with the studies.

use std::sync::LazyLock;

use apportion_afm::history::{History, history};
use apportion_afm::modes::{ModeConstants, Pushing};
use apportion_afm::{Critical, Failure, FrictionLaw, Options, Scene, critical_force};

use super::context::{ClaimContext, ForceOf, HistoryOf, Physics};
use super::*;
use crate::reproduce::studies::studies;

/// The nine studies at 4096 base points: enough to decide every order, and quick.
static NINE_STUDIES: LazyLock<Vec<Reproduced>> = LazyLock::new(|| {
    let studies = studies(&["design.base_samples=4096".to_owned()]).unwrap();
    let run = |(group, friction, study): (_, _, apportion::Study)| Reproduced {
        group,
        friction,
        result: study.run().unwrap(),
    };
    studies.into_iter().map(run).collect()
});

/// The verdicts on claims by this physics.
fn verdicts(physics: Physics<'_>, numbers: std::ops::RangeInclusive<usize>) -> Vec<(usize, &'static str)> {
    let context = ClaimContext::new(physics, Effort::Quick, &[]);
    answered(&context, &numbers).unwrap().iter().map(|claim| (claim.number, claim.verdict.word())).collect()
}

fn with_force(force: ForceOf<'_>) -> Physics<'_> {
    Physics { force, ..Physics::ours() }
}

/// Our force times a factor that depends on the scene.
fn times(factor: impl Fn(&Scene, &Options) -> f64) -> impl Fn(&Scene, &Options) -> Result<Critical, Failure> {
    move |scene, options| {
        let critical = critical_force(scene, options)?;
        Ok(Critical { critical_force: critical.critical_force * factor(scene, options), ..critical })
    }
}

#[test]
fn verdicts_change_if_the_force_depends_on_tip_height_or_grows_with_length() {
    let bent = times(|scene, _| scene.height / 12e-6 * (scene.length / 225e-6).powi(4));
    assert_eq!(
        verdicts(with_force(&bent), 8..=11),
        [(8, "not reproduced"), (9, "reproduced"), (10, "reproduced"), (11, "not reproduced")]
    );
}

#[test]
fn verdicts_change_if_the_force_depends_on_less_thickness_or_squared_width() {
    let bent = times(|scene, _| (1e-6 / scene.thickness).powi(4) * (scene.width / 48e-6).powi(2));
    let found = verdicts(with_force(&bent), 8..=11);
    assert_eq!((found[1], found[2]), ((9, "not reproduced"), (10, "not reproduced")));
}

#[test]
fn verdicts_change_if_the_force_depends_on_velocity_or_contact() {
    let bent = times(|scene, _| {
        let contact = (scene.equivalent_modulus / 60e9).powi(3) * (1.0 + scene.adhesion).powi(-9);
        (1.0 + scene.velocity / 800e-9) * contact * (scene.elastic_modulus / 169e9).powi(-4)
    });
    assert_eq!(
        verdicts(with_force(&bent), 12..=16),
        [
            (12, "not reproduced"),
            (13, "not reproduced"),
            (14, "not reproduced"),
            (15, "not reproduced"),
            (16, "not reproduced")
        ]
    );
}

#[test]
fn friction_models_in_each_other_s_place_change_the_seventh() {
    let factor = |_: &Scene, options: &Options| if options.friction == FrictionLaw::HurtadoKim { 100.0 } else { 1.0 };
    assert_eq!(verdicts(with_force(&times(factor)), 7..=7), [(7, "not reproduced")]);
    let factor = |_: &Scene, options: &Options| if options.friction == FrictionLaw::HurtadoKim { 0.01 } else { 1.0 };
    assert_eq!(verdicts(with_force(&times(factor)), 7..=7), [(7, "reproduced")]);
}

/// A particle that resists rolling slides first, and a force that depends on the contact angle changes the fourth verdict.
#[test]
fn a_particle_that_cannot_roll_slides_first() {
    let stuck = |scene| {
        let constants = ModeConstants { rolling_shift: 1.0, ..ModeConstants::default() };
        Pushing { constants, ..Pushing::new(scene) }
    };
    let tilted = times(|scene, _| 2.0 - scene.contact_angle);
    let physics = Physics { pushing: &stuck, ..with_force(&tilted) };
    assert_eq!(verdicts(physics, 4..=4), [(4, "reproduced")]);
    assert_eq!(verdicts(physics, 6..=6), [(6, "reproduced")]);
    for number in [4, 6] {
        assert_eq!(verdicts(Physics::ours(), number..=number), [(number, "not reproduced")]);
    }
}

/// The same history backwards.
#[test]
fn a_history_that_runs_the_other_way_changes_verdicts() {
    let backwards = |scene: &Scene, options: &Options, duration: f64| -> Result<History, Failure> {
        let History { mut samples, critical } = history(scene, options, duration)?;
        let slipping = samples.iter().filter(|sample| !sample.sticking).count();
        let sticking = samples.len() - slipping;
        samples[..sticking].reverse();
        let critical = Critical { critical_time: critical.critical_time.map(|time| 10.0 * time), ..critical };
        Ok(History { samples, critical })
    };
    let lazy = |scene: &Scene, options: &Options| -> Result<Critical, Failure> {
        let critical = critical_force(scene, options)?;
        let critical_time = critical.critical_time.map(|time| time / (1.0 + scene.static_friction).powi(9));
        Ok(Critical { critical_time, ..critical })
    };
    let physics = Physics { history: &backwards as HistoryOf<'_>, ..with_force(&lazy) };
    let expected = "not reproduced";
    assert_eq!(verdicts(physics, 1..=3), [(1, expected), (1, expected), (2, expected), (3, expected)]);
    assert_eq!(verdicts(physics, 5..=5), [(5, expected)]);
}

/// LG's percentages contradict each other only where the force is a product; a force that is not a product has another verdict.
#[test]
fn percentages_contradict_each_other_only_under_a_product() {
    let last_half = |physics: Physics<'_>| {
        let context = ClaimContext::new(physics, Effort::Quick, &NINE_STUDIES);
        let claims = answered(&context, &(19..=19)).unwrap();
        claims.iter().rfind(|claim| claim.number == 19).unwrap().verdict.clone()
    };
    assert!(matches!(last_half(Physics::ours()), Verdict::Contradicted { by } if by.contains("76 %")));
    let bent = times(|scene, _| 1.0 + scene.velocity / 800e-9 * scene.length / 200e-6);
    assert_eq!(last_half(with_force(&bent)), Verdict::NotReproduced);
}

/// The verdicts on shares follow the studies: with thickness and length exchanged the orders are not
/// the published ones, and without intervals nothing is decided.
#[test]
fn other_shares_give_other_verdicts() {
    let answers =
        |studies: &[Reproduced]| answered(&ClaimContext::new(Physics::ours(), Effort::Quick, studies), &(17..=20));
    let words = |studies: &[Reproduced]| -> Vec<(usize, &str)> {
        answers(studies).unwrap().iter().map(|claim| (claim.number, claim.verdict.word())).collect()
    };
    let mut swapped = NINE_STUDIES.clone();
    let mut unsure = NINE_STUDIES.clone();
    for (swapped, unsure) in swapped.iter_mut().zip(&mut unsure) {
        for index in swapped.result.outputs[0].indices.as_mut().unwrap() {
            index.name = match index.name.as_str() {
                "thickness" => "length".to_owned(),
                "length" => "thickness".to_owned(),
                other => other.to_owned(),
            };
        }
        for group in swapped.result.outputs[0].groups.iter_mut().flatten() {
            group.name = if group.name == "dimensional" { "environmental" } else { "dimensional" }.to_owned();
        }
        for index in unsure.result.outputs[0].indices.as_mut().unwrap() {
            index.effect.share_total_interval = None;
        }
    }
    let found = words(&swapped);
    assert_eq!(
        (found[0], found[5], found[7]),
        ((17, "not reproduced"), (19, "not reproduced"), (20, "not reproduced"))
    );
    let found = words(&unsure);
    let expected = "not reproduced";
    assert_eq!((found[0], found[3], found[5]), ((17, expected), (18, expected), (19, expected)));
    let missing = answers(&NINE_STUDIES[1..]);
    assert!(missing.is_err_and(|error| error.to_string().contains("the dimensional study under Coulomb friction")));
}
