//! A plausible story for tests: the nominal scene with Coulomb friction, in closed form.

use std::f64::consts::PI;

use super::{CriticalInstant, SceneGeometry, SceneSample, SceneStory};
use apportion::report::chart::Colour;

const NORMAL_FORCE: f64 = 489.4e-9;
const VELOCITY: f64 = 100e-9;
/// Time of the slip (s).
const SLIP: f64 = 0.131;
/// Height of the tip (m).
const HEIGHT: f64 = 12e-6;
/// Torsional and lateral stiffness of the cantilever (N m/rad, N/m).
const TORSION: f64 = 4.731e-9;
const LATERAL: f64 = 410.5;

/// The lateral force grows in proportion to time until 0.131 s, then the tip holds the particle still.
pub(super) fn story() -> SceneStory {
    // Dense about the slip, as a story that is sampled where things change.
    let mut times: Vec<f64> = (0..=16).map(|i| f64::from(i) * SLIP / 16.0).collect();
    times.extend([SLIP - 1e-3, SLIP - 1e-4, SLIP + 1e-4, SLIP + 1e-3]);
    times.extend((1..=12).map(|i| SLIP + f64::from(i) * (0.4 - SLIP) / 12.0));
    times.sort_by(f64::total_cmp);
    let samples: Vec<SceneSample> = times.into_iter().map(sample).collect();
    let slip = sample(SLIP);
    let setting = [("friction", "coulomb"), ("fidelity", "closed-form"), ("V", "100 nm/s"), ("L", "225 µm")];
    SceneStory {
        title: "A gold particle pushed on silicon oxide".to_owned(),
        setting: setting.map(|(label, value)| (label.to_owned(), value.to_owned())).into(),
        geometry: SceneGeometry {
            particle_radius: 50e-9,
            tip_radius: 20e-9,
            height: HEIGHT,
            contact_angle: PI / 3.0,
            length: 225e-6,
            width: 48e-6,
            thickness: 1e-6,
        },
        critical: CriticalInstant {
            time: Some(SLIP),
            critical_force: slip.tip_force,
            lateral_force: slip.lateral_force,
            normal_force: slip.normal_force,
        },
        colour: Colour::Series(0),
        samples,
    }
}

fn sample(time: f64) -> SceneSample {
    let stiffness = 1.0 / (1.0 / LATERAL + HEIGHT * HEIGHT / TORSION);
    let held = time.min(SLIP);
    let lateral = stiffness * VELOCITY * held;
    let (tip_force, angle) = (libm::hypot(lateral, NORMAL_FORCE), libm::atan2(lateral, NORMAL_FORCE));
    let (substrate_radius, substrate_indentation) = jkr(50e-9, NORMAL_FORCE);
    let (tip_radius, tip_indentation) = jkr(50e-9 * 20e-9 / 70e-9, tip_force * libm::cos(angle - PI / 3.0));
    SceneSample {
        time,
        lateral_force: lateral,
        normal_force: NORMAL_FORCE,
        tip_force,
        force_angle: angle,
        twist: lateral * HEIGHT / TORSION,
        base_lateral: lateral / LATERAL,
        deflection: 2.749e-6,
        substrate_position: VELOCITY * time,
        particle_position: VELOCITY * held,
        relative_position: VELOCITY * (held - time),
        substrate_contact_radius: substrate_radius,
        substrate_indentation,
        tip_contact_radius: tip_radius,
        tip_indentation,
        slipping: time > SLIP,
        tip_slip: false,
        rolling: time > 0.01,
        spin: false,
    }
}

/// Contact radius and indentation after Johnson, Kendall and Roberts (1971) at K = 60 GPa, 0.2 J/m2.
fn jkr(radius: f64, load: f64) -> (f64, f64) {
    let (modulus, pull) = (60e9, 3.0 * PI * 0.2 * radius);
    let a = libm::cbrt(radius / modulus * (load + pull + (2.0 * pull * load + pull * pull).sqrt()));
    (a, a * a / radius - 2.0 / 3.0 * (6.0 * PI * 0.2 * a / modulus).sqrt())
}
