//! The equations of motion, adaptively, with the slip as an event.
//!
//! The tip swings at some 1e6 to 1e8 rad/s, undamped, while the ramp takes 0.1 s and more. Following every swing would
//! take some 1e7 steps. If the swing excited by the start is below the tolerance (at the nominal scene it is 1e-7 of
//! F_Y) the stiff method ([`Rodas`], L-stable) steps over it. The error of theta' is then weighted by the swing it
//! would cause, theta'/omega, otherwise the start alone, with a relative error of theta' of k_lat/K_y, would require
//! steps of 1/omega throughout; and the event is located by steps, not by interpolation. If the swing matters, a stuck
//! tip is [extrapolated](super::carried) to just before the slip and followed from there. On LuGre bristles, which
//! change it as they give way, the swing is left to the damping of the method, and counted as an error.

use std::f64::consts::TAU;

use super::bristles::Bristles;
use super::motion::{FINEST, Motion, Tip, local_tolerance};
use super::quasi_static;
use super::slip::{Error, Slip};
use super::statics::Statics;
use super::substrate::Substrate;
use super::swing::Swing;
use super::{Critical, Options};
use crate::friction::LuGreForm;
use crate::ode::{Control, DormandPrince, End, March, Outcome, Rodas};
use crate::probe::Probe;
use crate::{Failure, Fidelity, FrictionLaw, Scene};

/// Computes the critical force. At rest, and if nothing holds the particle, there is no motion: the quasi-static limit.
pub(super) fn critical_force(scene: &Scene, options: &Options) -> Result<Critical, Failure> {
    let probe = Probe::new(scene, options.torsion);
    let substrate = Substrate::new(scene, options, &probe, LuGreForm::Ramp);
    let statics = Statics::new(scene, &probe)?;
    let (limit, mut evaluations) = statics.slip(&substrate)?;
    let (limit, mut of_time, spent) = statics.timed(&limit, &substrate)?;
    evaluations += spent;
    let mut slip = limit;
    // A subnormal velocity has too few digits for an integration.
    if scene.velocity >= f64::MIN_POSITIVE && limit.travel > 0.0 && limit.lateral_force > 0.0 {
        let motion = Motion::new(scene, &statics, &limit);
        let (located, spent) = if options.friction == FrictionLaw::LuGre {
            Bristles::new(&motion, &substrate, &limit).slip()?
        } else {
            stuck(&motion, &substrate, &limit)?
        };
        slip = located.held_back()?;
        evaluations += spent;
    }
    // A difference that inertia does not explain is an error of the integration: far outside any laboratory it steps
    // over the slip, or F_Z falls by more than F_Y rises.
    let missed = slip.beyond(&limit, quasi_static::left_out(&limit, scene, &substrate, &probe));
    // The integration aims at a tenth of the tolerance per step, in F_Y.
    let mut error = Error { normal: missed.normal, lateral: options.tolerance * slip.lateral_force };
    if missed.normal.max(missed.lateral)
        > 10.0 * options.tolerance * libm::hypot(limit.normal_force, limit.lateral_force)
    {
        error.lateral += missed.lateral;
    }
    let swing = Swing::new(scene, &probe);
    if slip.slowdown > 1.0 && options.friction != FrictionLaw::LuGre {
        // The tip is stuck here, and does not swing as on bristles: its time is the quasi-static one.
        (slip.travel, slip.advance) = (limit.travel, limit.advance);
        of_time += swing.of_time(&slip, &substrate);
    } else if options.friction == FrictionLaw::LuGre {
        // On these bristles the time of this rung, in place of the quasi-static one.
        of_time = swing.of_time(&slip, &substrate) + options.tolerance * slip.sensitivity();
        error = error + swing.left_out(&slip, &substrate);
        if !swing.is_followed(limit.travel, scene.velocity) {
            error.lateral += quasi_static::overshoot(&slip, &substrate);
        }
    } else {
        of_time += error.lateral / slip.lateral_force;
    }
    let critical = slip.critical(&substrate, Fidelity::Dynamic);
    let of_time = if options.accurate_time { of_time.min(1.0) } else { 0.0 };
    // NaN if nothing holds the particle, which `max` ignores.
    Ok(Critical { error_estimate: error.value(&slip).max(of_time), evaluations, ..critical })
}

/// Returns whether friction certainly holds the tip, without evaluating the law: its force is below that of the
/// quasi-static slip, and F_Z, which falls with the twist, still above. 1e-3 is a margin for the swing of F_Z.
pub(super) fn surely_holds(tip: &Tip, limit: &Slip) -> bool {
    tip.lateral_force < (1.0 - 1e-3) * limit.lateral_force
}

/// Integrates the motion of the stuck tip until F_Y passes F_Y*(F_Z).
fn stuck(motion: &Motion, substrate: &Substrate, limit: &Slip) -> Result<(Slip, u64), Failure> {
    let lateral = motion.swing().lateral + motion.swing().normal(limit.twist) * limit.slope(substrate);
    let swing = lateral / motion.force;
    let (end, spent) = if swing <= SMALL * substrate.options.tolerance {
        damped(motion, substrate, limit)?
    } else {
        swinging(motion, substrate, limit, swing)?
    };
    let tip = motion.tip(end.t, &end.y);
    let hold = substrate.hold(tip.normal_force)?;
    let slip = Slip {
        normal_force: tip.normal_force,
        lateral_force: hold.capacity,
        travel: end.t * motion.length,
        twist: tip.twist,
        contact: hold.contact,
        ..*limit
    };
    Ok((slip, spent))
}

/// Share of the tolerance below which the swing need not be followed.
const SMALL: f64 = 0.2;

/// Uses the stiff method over a swing too small to matter.
fn damped(motion: &Motion, substrate: &Substrate, limit: &Slip) -> Result<(End<2>, u64), Failure> {
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
        excess(&tip, substrate, &mut spent)
    })?;
    // The quasi-static tip slips at 1.
    let Outcome::Event(end) = outcome else { return Err(Failure::StepBudget) };
    Ok((end, spent + march.evaluations()))
}

/// Uses the explicit method, which keeps the swing, over its last turns before the slip; over all of them if they
/// change meanwhile. `swing` is its amplitude in F_Y - F_Y*, in units of the slip.
fn swinging(motion: &Motion, substrate: &Substrate, limit: &Slip, swing: f64) -> Result<(End<2>, u64), Failure> {
    let tolerance = substrate.options.tolerance;
    let frequency = motion.frequency();
    // The force rises by more than 1 in a unit of time, so the crossing precedes the mean by at most the amplitude.
    let lead = 2.0 * swing + 2.0 * TAU / frequency;
    let kept = 10.0 * swing * motion.drift(limit.twist) / frequency < 0.05 * tolerance;
    let start =
        if kept && lead < 0.5 { motion.carried_to(1.0 - lead, limit.twist)? } else { End { t: 0.0, y: [0.0, 1.0] } };
    let budget = substrate.options.step_budget;
    if (1.0 - start.t) * frequency / RESOLVED > budget as f64 {
        return Err(Failure::StepBudget);
    }
    let control = Control {
        // The force is stationary once per turn, where an error of it appears in the time as its cube root.
        tolerance: (1e-3 * tolerance * (tolerance / swing).powi(2).min(1.0)).max(0.1 * FINEST),
        scale: [1.0, frequency.max(1.0)],
        first_step: 0.1 * RESOLVED / frequency,
        longest_step: RESOLVED / frequency,
        step_budget: budget,
    };
    let mut march = March::<DormandPrince, _, 2>::new(motion, (start.t, start.y), control);
    let slope = limit.slope(substrate);
    let mut spent = 0;
    let outcome = march.until(10.0, |t, y| {
        let tip = motion.tip(t, y);
        // Twice, since the slope grows as the load falls.
        let weakest = limit.lateral_force - 2.0 * slope * (limit.normal_force - tip.normal_force).max(0.0);
        if tip.lateral_force < (1.0 - 1e-9) * weakest {
            return Ok(tip.lateral_force - limit.lateral_force.max(weakest));
        }
        excess(&tip, substrate, &mut spent)
    })?;
    let Outcome::Event(end) = outcome else { return Err(Failure::StepBudget) };
    Ok((end, spent + march.evaluations()))
}

/// Longest step that follows a swing (rad): it cannot miss a crossing.
const RESOLVED: f64 = 0.2;

/// Returns F_Y - F_Y*(F_Z) (N).
fn excess(tip: &Tip, substrate: &Substrate, spent: &mut u64) -> Result<f64, Failure> {
    match substrate.hold(tip.normal_force) {
        Ok(hold) => {
            *spent += hold.evaluations;
            Ok(tip.lateral_force - hold.capacity)
        }
        // A long step may pass the slip and the end of contact together.
        Err(Failure::BeyondPullOff) => Ok(tip.lateral_force),
        Err(failure) => Err(failure),
    }
}
