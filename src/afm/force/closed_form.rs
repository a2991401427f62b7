//! Small twist, no inertia: the normal force stays that of the preload, and the tip is a linear
//! spring.

use super::slip::{Error, Slip};
use super::substrate::Substrate;
use super::swing::Swing;
use super::{Cost, Critical, Options};
use crate::afm::friction::{LuGre, LuGreForm};
use crate::afm::probe::Probe;
use crate::afm::{Failure, Fidelity, Flag, FrictionLaw, Scene};

/// F_Z = F_Z0, F_Y* by the law of friction, s = F_Y*/k_lat, theta = F_Y* H/K_theta.
#[inline]
pub(super) fn critical_force(scene: &Scene, options: &Options) -> Result<Critical, Failure> {
    let probe = Probe::new(scene, options.torsion);
    let substrate = Substrate::new(scene, options, (&probe, LuGreForm::Fast));
    let hold = substrate.hold(probe.preload_force)?;
    let lateral_force = hold.capacity;
    let slip = Slip {
        normal_force: probe.preload_force,
        lateral_force,
        travel: lateral_force / probe.apex,
        twist: lateral_force * scene.height / probe.torsional,
        contact: hold.contact,
    };
    let mut error = twisting(&substrate, &probe, &slip) + Swing::new(scene, &probe).left_out(&slip, &substrate);
    let mut fast = false;
    if options.friction == FrictionLaw::LuGre {
        let law = LuGre::of(scene);
        fast = !law.is_slow(scene.velocity);
        // The ramp peaks between Fss(V) and the strength at rest.
        let load = probe.preload_force + substrate.adhesive_load;
        error.lateral += (law.stribeck(load, 0.0) - law.stribeck(load, scene.velocity)).abs();
    }
    let mut critical = slip.critical(&substrate, Fidelity::ClosedForm);
    critical.flags = critical.flags.with(Flag::FastLuGreForm, fast);
    Ok(Critical { error_estimate: error.of(&slip), cost: Cost { evaluations: hold.evaluations }, ..critical })
}

/// What the twist takes from the normal force, K_z H (1 - cos theta), which the closed form leaves out, and from the
/// friction with it; the twist itself is larger by the moment of the normal force.
#[inline]
fn twisting(substrate: &Substrate, probe: &Probe, slip: &Slip) -> Error {
    let height = substrate.scene.height;
    let softened = probe.torsional - slip.normal_force * height;
    if softened <= 0.0 {
        return Error { normal: f64::INFINITY, lateral: 0.0 };
    }
    let twist = slip.lateral_force * height / softened;
    // A twentieth more, for the terms of higher order.
    let normal = 1.05 * 0.5 * probe.normal * height * twist * twist;
    if normal >= slip.normal_force - substrate.least_normal_force() {
        // It lifts the tip until nothing holds the particle down.
        return Error { normal: f64::INFINITY, lateral: 0.0 };
    }
    Error { normal, lateral: normal * substrate.slope(slip.lateral_force, slip.normal_force) }
}
