//! The equations of motion, adaptively, with the slip as an event.
//!
//! The tip swings at some 1e6 to 1e8 rad/s, undamped, while the ramp takes 0.1 s and more. An explicit method would have
//! to follow every swing: some 1e7 steps. The stiff method ([`Rodas`], L-stable) steps over them: the swing that the
//! start excites, V k_lat/omega, is 1e-7 of F_Y at the nominal scene; where it lies below the tolerance the first
//! long step damps it, where above it is followed until the method's own damping has worn it down. Two things make this work. The
//! error of theta' is weighed by the swing it would cause, theta'/omega, else the start alone, where theta' is off by
//! k_lat/K_y of itself, would force steps of 1/omega for ever. And the event is located by steps, not by dense output.

use super::bristles::Bristles;
use super::motion::{Motion, Tip};
use super::quasi_static::Statics;
use super::slip::{Error, Slip};
use super::substrate::Substrate;
use super::{Cost, Critical, Options};
use crate::afm::friction::LuGreForm;
use crate::afm::ode::{Control, March, Outcome, Rodas};
use crate::afm::probe::Probe;
use crate::afm::{Failure, Fidelity, FrictionLaw, Scene};

/// Least local tolerance: below, rounding shows.
const FINEST: f64 = 1e-12;

/// The critical force. At rest, and where nothing holds the particle, there is no motion: the quasi-static limit.
pub(super) fn critical_force(scene: &Scene, options: &Options) -> Result<Critical, Failure> {
    let probe = Probe::new(scene, options.torsion);
    let substrate = Substrate::new(scene, options, (&probe, LuGreForm::Ramp));
    let statics = Statics::new(scene, &probe)?;
    let (limit, mut evaluations) = statics.slip(&substrate)?;
    let mut slip = limit;
    if scene.velocity > 0.0 && limit.travel > 0.0 && limit.lateral_force > 0.0 {
        let motion = Motion::new(scene, &statics, &limit);
        let (found, spent) = if options.friction == FrictionLaw::LuGre {
            Bristles::new(&motion, &substrate, limit.contact.radius).slip()?
        } else {
            stuck(&motion, &substrate, &limit)?
        };
        slip = found.held_back()?;
        evaluations += spent;
    }
    // The march aims at a tenth of the tolerance a step.
    let error = Error { normal: 0.0, lateral: options.tolerance * slip.lateral_force };
    let critical = slip.critical(&substrate, Fidelity::Dynamic);
    Ok(Critical { error_estimate: error.of(&slip), cost: Cost { evaluations }, ..critical })
}

/// Tolerance of a step.
pub(super) fn local_tolerance(options: &Options) -> f64 {
    (0.1 * options.tolerance).max(FINEST)
}

/// Whether friction holds the tip without a look at the law: its force is below that of the quasi-static slip, and F_Z,
/// which falls with the twist, still above. 1e-3 leaves room for what the swing does to F_Z.
pub(super) fn surely_holds(tip: &Tip, limit: &Slip) -> bool {
    tip.lateral_force < (1.0 - 1e-3) * limit.lateral_force
}

/// Marches the stuck tip until F_Y passes F_Y*(F_Z).
fn stuck(motion: &Motion, substrate: &Substrate, limit: &Slip) -> Result<(Slip, u64), Failure> {
    let control = Control {
        tolerance: local_tolerance(substrate.options),
        scale: [1.0, motion.frequency().max(1.0)],
        first_step: 1e-3,
        longest_step: 0.1,
        step_budget: substrate.options.step_budget,
    };
    let mut march = March::<Rodas, _, 2>::new(motion, (0.0, [0.0, 1.0]), control);
    let mut spent = 0;
    let outcome = march.until(10.0, |t, y| {
        let tip = motion.tip(t, y);
        if surely_holds(&tip, limit) {
            return Ok(tip.lateral_force - limit.lateral_force);
        }
        match substrate.hold(tip.normal_force) {
            Ok(hold) => {
                spent += hold.evaluations;
                Ok(tip.lateral_force - hold.capacity)
            }
            // A long step may pass the slip and the end of contact together.
            Err(Failure::BeyondPullOff) => Ok(tip.lateral_force),
            Err(failure) => Err(failure),
        }
    })?;
    // The quasi-static tip slips at 1.
    let Outcome::Event(end) = outcome else { return Err(Failure::StepBudget) };
    let tip = motion.tip(end.t, &end.y);
    let hold = substrate.hold(tip.normal_force)?;
    let slip = Slip {
        normal_force: tip.normal_force,
        lateral_force: hold.capacity,
        travel: end.t * motion.length,
        twist: tip.twist,
        contact: hold.contact,
    };
    Ok((slip, spent + march.evaluations()))
}
