use super::*;
use crate::FrictionLaw;

fn nominal() -> History {
    history(&Scene::default(), &Options::default(), 0.4).unwrap()
}

/// F_Y grows, F_Z hardly moves, F_T rises to F_cr and stays (their figures 8 and 9).
#[test]
fn forces_rise_to_the_critical_force_and_stay() {
    let History { samples, critical } = nominal();
    for pair in samples.windows(2) {
        assert!(pair[1].time >= pair[0].time && pair[1].lateral_force >= pair[0].lateral_force);
        assert!((pair[1].normal_force / 489.4e-9 - 1.0).abs() < 1e-3);
    }
    let slipping: Vec<_> = samples.iter().filter(|s| !s.sticking).collect();
    assert_eq!(slipping.len(), 2);
    // The force from the geometry against that from friction: they meet at the slip.
    assert!(slipping.iter().all(|s| (s.tip_force / critical.critical_force - 1.0).abs() < 1e-12));
    assert!((slipping[0].time / critical.critical_time.unwrap() - 1.0).abs() < 1e-12);
}

/// The printed run: slip at 0.209 s, then -V (t - t_cr), -19 nm at 0.4 s.
#[test]
fn the_particle_stays_behind_after_the_slip() {
    let scene = Scene { shear_modulus: Some(40.5e9), ..Scene::default() };
    let History { samples, .. } = history(&scene, &Options::default(), 0.4).unwrap();
    let end = samples[samples.len() - 1];
    assert!((end.time, end.sticking) == (0.4, false));
    assert!((end.relative + 19.1e-9).abs() < 0.1e-9, "{}", end.relative);
    assert!((end.particle - end.substrate - end.relative).abs() < 1e-20);
    assert!(samples.iter().filter(|s| s.sticking).all(|s| s.relative == 0.0 && s.particle == s.substrate));
}

/// The tip presses harder and harder while the normal force on the particle hardly decreases (their figure 13).
#[test]
fn the_tip_contact_grows_and_the_substrate_contact_shrinks() {
    let History { samples, .. } = nominal();
    for pair in samples.windows(2).filter(|pair| pair[1].sticking) {
        let [before, after] = [pair[0].tip_contact.unwrap(), pair[1].tip_contact.unwrap()];
        assert!(after.radius > before.radius && after.indentation > before.indentation);
        assert!(pair[1].substrate_contact.radius < pair[0].substrate_contact.radius);
    }
}

/// Linear between samples by the definition, tested at a third of the way, with no more samples than needed.
#[test]
fn samples_are_where_things_bend() {
    let scene = Scene { static_friction: 100.0, ..Scene::default() };
    let options = Options::default();
    let History { samples, critical } = history(&scene, &options, 1e3).unwrap();
    let stage = Stage::new(&scene, &options, &critical).unwrap();
    for pair in samples.windows(2).filter(|pair| pair[1].sticking) {
        let between = stage.sticking(pair[0].twist + (pair[1].twist - pair[0].twist) / 3.0).unwrap();
        let share = (between.time - pair[0].time) / (pair[1].time - pair[0].time);
        let line = pair[0].tip_force + share * (pair[1].tip_force - pair[0].tip_force);
        assert!((between.tip_force - line).abs() < 1.5 * STRAIGHT * pair[1].tip_force);
    }
    assert!(samples.len() < 200 && nominal().samples.len() < 100, "{} {}", samples.len(), nominal().samples.len());
}

#[test]
fn a_run_may_end_before_the_slip() {
    let History { samples, critical } = history(&Scene::default(), &Options::default(), 0.05).unwrap();
    let end = samples[samples.len() - 1];
    assert!(end.sticking && (end.time / 0.05 - 1.0).abs() < 1e-12 && critical.critical_time.unwrap() > 0.05);
}

#[test]
fn without_friction_the_particle_slips_at_once() {
    let smooth = Scene { static_friction: 0.0, shear_strength: 0.0, ..Scene::default() };
    let history = history(&smooth, &Options::default(), 0.4).unwrap();
    assert!((history.samples[history.samples.len() - 1].relative + 40e-9).abs() < 1e-20);
}

/// The same as the samples of a history, if it has samples at these times.
#[test]
fn times_are_those_of_the_history() {
    for friction in FrictionLaw::ALL {
        let options = Options { friction, ..Options::default() };
        let samples = history(&Scene::default(), &options, 0.4).unwrap().samples;
        let slip = samples.iter().position(|sample| !sample.sticking).unwrap();
        // The last that sticks is at the same time as the first that slips.
        let samples: Vec<Sample> = samples[..slip - 1].iter().chain(&samples[slip..]).copied().collect();
        let times: Vec<f64> = samples.iter().map(|sample| sample.time).collect();
        let mut taken = 0;
        let close = |a: f64, b: f64| (a - b).abs() <= 1e-9 * a.abs().max(b.abs());
        at_times(&Scene::default(), &options, &times, |place, sample| {
            let other = &samples[place];
            assert!(close(sample.tip_force, other.tip_force) && close(sample.particle, other.particle));
            assert!(close(sample.substrate_contact.radius, other.substrate_contact.radius));
            assert_eq!((sample.time, sample.sticking), (other.time, other.sticking));
            taken += 1;
        })
        .unwrap();
        assert_eq!(taken, times.len());
    }
}

#[test]
fn a_substrate_at_rest_moves_nothing() {
    let resting = Scene { velocity: 0.0, ..Scene::default() };
    let mut forces = Vec::new();
    at_times(&resting, &Options::default(), &[0.0, 1.0, 1e9], |_, sample| {
        assert!(sample.sticking && sample.particle == 0.0);
        forces.push(sample.tip_force);
    })
    .unwrap();
    assert!(forces.len() == 3 && forces[0] == forces[1] && forces[1] == forces[2] && forces[0] > 0.0);
}

#[test]
fn models_that_cannot_run_are_named() {
    let resting = Scene { velocity: 0.0, ..Scene::default() };
    assert_eq!(history(&resting, &Options::default(), 0.4), Err(Failure::VelocityZero));
    for duration in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let named = Failure::OutOfDomain { parameter: "duration", domain: Domain::Positive };
        assert_eq!(history(&Scene::default(), &Options::default(), duration), Err(named));
    }
}
