//! Exact geometry, no inertia.
//!
//! The equations of motion of the tip (see [`Motion`]) without inertia: it is in equilibrium at every twist theta, with
//!
//!   F_Z = K_z z_P,  z_P = z_P0 - H (1 - cos theta),  F_Y cos theta = K_theta theta/H - F_Z sin theta,  F_Y = K_y y_P.
//!
//! The particle slips at the first theta with F_Y = F_Y*(F_Z), the friction force that the contact can hold.
//!
//! There is at most one such theta. With c = K_theta/H,
//!
//!   cos^2(theta) dF_Y/dtheta = c (cos theta + theta sin theta) - K_z (z_P0 - H) - K_z H cos^3 theta
//!
//! does not decrease on [0, pi/2], and is c - F_Z0 at theta = 0. So if c > F_Z0, F_Y is convex and rises without bound
//! towards pi/2, while F_Z and thus F_Y* decrease. Since F_Y >= (c - F_Z0) theta, F_Y*(F_Z0)/(c - F_Z0) is an upper bound
//! of the root, with a relative excess of order theta^2.

use super::motion::Motion;
use super::slip::{Error, Slip};
use super::statics::Statics;
use super::substrate::Substrate;
use super::swing::Swing;
use super::{Critical, Options};
use crate::friction::{LuGre, LuGreForm};
use crate::probe::Probe;
use crate::{Failure, Fidelity, FrictionLaw, Scene};

/// Computes the critical force, under LuGre friction from the peak of its ramp; if `swings`, with the effect of the swing
/// on the time of the slip where it matters. Also returns the error that is common to this rung and the dynamic one: on
/// bristles, neither follows a fast swing or the slip that it triggers, and both treat the bristles of laws other than
/// LuGre's in the same way.
pub(super) fn critical_force(scene: &Scene, options: &Options, swings: bool) -> Result<(Critical, f64), Failure> {
    let probe = Probe::new(scene, options.torsion);
    let substrate = Substrate::new(scene, options, &probe, LuGreForm::Ramp);
    let statics = Statics::new(scene, &probe)?;
    let (slip, mut evaluations) = statics.slip(&substrate)?;
    let of_forces = left_out(&slip, scene, &substrate, &probe).value(&slip);
    let (mut slip, of_creep, spent) = statics.timed(&slip, &substrate)?;
    evaluations += spent;
    let swing = Swing::new(scene, &probe);
    let mut of_swing = swing.of_time(&slip, &substrate);
    let moves = slip.slowdown == 1.0 && scene.velocity > 0.0 && slip.travel > 0.0;
    if swings && moves && of_swing > options.tolerance {
        let first = Motion::new(scene, &statics, &slip).first_slip(&slip, &substrate)?;
        if first.error < of_swing {
            (slip.advance, of_swing) = (first.advance, first.error);
        }
        evaluations += first.evaluations;
    }
    let of_time = if options.accurate_time { (of_creep + of_swing).min(1.0) } else { 0.0 };
    let shared = match options.friction {
        FrictionLaw::LuGre => {
            let mut error = swing.left_out(&slip, &substrate);
            if !swing.is_followed(slip.travel, scene.velocity) {
                error.lateral += overshoot(&slip, &substrate);
            }
            error.value(&slip).max(if options.accurate_time { of_swing } else { 0.0 })
        }
        _ if slip.slowdown > 1.0 => of_time,
        _ => 0.0,
    };
    let critical = slip.critical(&substrate, Fidelity::QuasiStatic);
    // NaN if nothing holds the particle, which `max` ignores.
    Ok((Critical { error_estimate: of_forces.max(of_time), evaluations, ..critical }, shared))
}

/// Returns the possible effect of inertia on the forces of the quasi-static `slip`.
pub(super) fn left_out(slip: &Slip, scene: &Scene, substrate: &Substrate, probe: &Probe) -> Error {
    let mut error = Swing::new(scene, probe).left_out(slip, substrate);
    error.lateral += slip.lateral_force * substrate.error();
    if substrate.options.friction == FrictionLaw::LuGre {
        // The overshoot at breakaway depends on the response time of the tip.
        error.lateral += overshoot(slip, substrate);
    }
    error
}

/// Returns the difference of the peak on LuGre bristles and the force of steady sliding (N). If friction weakens with
/// velocity, even a small swing of the tip may cause breakaway at any force between the two.
pub(super) fn overshoot(slip: &Slip, substrate: &Substrate) -> f64 {
    let law = LuGre::with(substrate.scene, substrate.options.lugre, slip.contact.radius);
    let steady = law.steady_force(slip.normal_force + substrate.adhesive_load, substrate.scene.velocity);
    (slip.lateral_force - steady).max(0.0)
}
