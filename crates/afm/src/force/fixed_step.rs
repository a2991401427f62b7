//! The equations of motion as a simple script integrates them: fixed steps, no event.

use super::dynamic::surely_holds;
use super::motion::Motion;
use super::slip::{Error, Slip};
use super::statics::Statics;
use super::substrate::Substrate;
use super::{Critical, Options};
use crate::friction::LuGreForm;
use crate::ode::{Method, Problem, Rodas, State};
use crate::probe::Probe;
use crate::{Failure, Fidelity, Scene};

/// Returns the forces at the first step past the slip: F_Y is the tip's, beyond F_Y* by up to k_lat V step. It uses
/// steps of the stiff method, as explicit ones are unstable here. At rest there is no slip: the quasi-static limit.
pub(super) fn critical_force(scene: &Scene, options: &Options) -> Result<Critical, Failure> {
    let probe = Probe::new(scene, options.torsion);
    let substrate = Substrate::new(scene, options, &probe, LuGreForm::Ramp);
    let statics = Statics::new(scene, &probe)?;
    let (limit, mut evaluations) = statics.slip(&substrate)?;
    let (limit, of_creep, spent) = statics.timed(&limit, &substrate)?;
    evaluations += spent;
    let mut slip = limit;
    if scene.velocity > 0.0 && slip.travel > 0.0 && slip.lateral_force > 0.0 {
        let (located, spent) = march(&Motion::new(scene, &statics, &slip), &substrate, &slip)?;
        slip = located.held_back()?;
        evaluations += spent;
    }
    let mut error = Error { normal: 0.0, lateral: probe.apex * scene.velocity * options.step };
    // A step far longer than the time to the slip is affected by the inertia of the tip, and by its geometry.
    let missed = slip.beyond(&limit, error);
    if missed.lateral > 0.5 * error.lateral || missed.normal > 0.1 * limit.normal_force.abs() {
        error = error + missed;
    }
    let critical = slip.critical(&substrate, Fidelity::FixedStep);
    // The particle creeps as on the quasi-static rung, and the slip is detected at the end of a step.
    let of_step = options.step * scene.velocity / (slip.travel + slip.advance);
    let of_time = if options.accurate_time { (of_creep + of_step).min(1.0) } else { 0.0 };
    Ok(Critical { error_estimate: error.value(&slip).max(of_time), evaluations, ..critical })
}

fn march(motion: &Motion, substrate: &Substrate, limit: &Slip) -> Result<(Slip, u64), Failure> {
    let options = substrate.options;
    let h = options.step / motion.time;
    // The slip comes at 1, so at least this many steps are needed.
    if 1.0 > h * options.step_budget as f64 {
        return Err(Failure::StepBudget);
    }
    let mut y = [0.0, 1.0];
    let mut evaluations = 0;
    for i in 0..options.step_budget {
        let t = i as f64 * h;
        let attempt = Rodas::step(motion, &State { t, y, rate: motion.rate(t, &y) }, h);
        y = attempt.end;
        let travel = (i + 1) as f64 * h;
        let tip = motion.tip(travel, &y);
        evaluations += attempt.evaluations;
        if surely_holds(&tip, limit) {
            continue;
        }
        if !tip.lateral_force.is_finite() {
            // Too far past the slip for the tip to reach.
            return Err(Failure::StepTooSmall);
        }
        let hold = substrate.hold(tip.normal_force)?;
        evaluations += hold.evaluations;
        if tip.lateral_force >= hold.capacity {
            let slip = Slip {
                normal_force: tip.normal_force,
                lateral_force: tip.lateral_force,
                travel: travel * motion.length,
                twist: tip.twist,
                contact: hold.contact,
                ..*limit
            };
            return Ok((slip, evaluations));
        }
    }
    Err(Failure::StepBudget)
}
