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

use std::f64::consts::FRAC_PI_2;

use super::motion::Motion;
use super::presliding::Presliding;
use super::slip::{Error, Slip};
use super::substrate::{Hold, Substrate};
use super::swing::Swing;
use super::{Critical, Options};
use crate::friction::{LuGre, LuGreForm};
use crate::probe::Probe;
use crate::root::{self, Point};
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

/// The probe in equilibrium.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Statics<'a> {
    pub scene: &'a Scene,
    pub probe: Probe,
    /// Tip height H (m).
    height: f64,
    /// K_theta/H (N).
    pub(super) restoring: f64,
}

impl<'a> Statics<'a> {
    /// # Errors
    /// [`Failure::ProbeTips`] if the preload alone makes the twist unstable, F_Z0 H >= K_theta.
    pub fn new(scene: &'a Scene, probe: &Probe) -> Result<Self, Failure> {
        let restoring = probe.torsional / scene.height;
        if restoring <= probe.preload_force {
            return Err(Failure::ProbeTips);
        }
        Ok(Self { scene, probe: *probe, height: scene.height, restoring })
    }

    /// Returns F_Z (N) at the twist `theta`; 1 - cos theta is computed as 2 sin^2(theta/2), without cancellation.
    pub fn normal_force(&self, theta: f64) -> f64 {
        let half = libm::sin(0.5 * theta);
        self.probe.normal * (self.probe.preload_deflection - 2.0 * self.height * half * half)
    }

    /// Returns F_Y cos theta (N) at the twist `theta`, the moment of the tip over H.
    pub fn lateral_moment(&self, theta: f64) -> f64 {
        self.restoring * theta - self.normal_force(theta) * libm::sin(theta)
    }

    /// Returns its derivative by the twist (N).
    pub fn lateral_moment_slope(&self, theta: f64) -> f64 {
        let (sin, cos) = libm::sincos(theta);
        self.restoring - self.normal_force(theta) * cos + self.probe.normal * self.height * sin * sin
    }

    /// Returns F_Y (N) at the twist `theta`, below a right angle.
    pub fn lateral_force(&self, theta: f64) -> f64 {
        self.lateral_moment(theta) / libm::cos(theta)
    }

    /// Returns its derivative by the twist (N).
    pub fn lateral_force_slope(&self, theta: f64) -> f64 {
        (self.lateral_moment_slope(theta) + self.lateral_force(theta) * libm::sin(theta)) / libm::cos(theta)
    }

    /// Returns the travel of the apex (m): s = H sin theta + F_Y/K_y.
    pub fn travel(&self, theta: f64, lateral_force: f64) -> f64 {
        self.height * libm::sin(theta) + lateral_force / self.probe.lateral
    }

    /// Returns the stiffness of the apex dF_Y/ds (N/m) at the twist `theta`.
    pub(crate) fn spring(&self, theta: f64) -> f64 {
        let rise = self.lateral_force_slope(theta);
        rise / (self.height * libm::cos(theta) + rise / self.probe.lateral)
    }

    /// Returns `slip` with its time; the relative error of the time without the swing, and the number of evaluations.
    ///
    /// # Errors
    /// Those of [`Presliding::new`].
    pub(super) fn timed(&self, slip: &Slip, substrate: &Substrate) -> Result<(Slip, f64, u64), Failure> {
        let spring = self.spring(slip.twist);
        let Some(presliding) = Presliding::new(substrate, slip, &self.probe, spring)? else {
            return Ok((*slip, substrate.viscous_rise(slip), 0));
        };
        let timed = presliding.timed(slip, spring);
        let error = presliding.error(&timed);
        let options = substrate.options;
        let matters = options.accurate_time && error > 0.1 * options.tolerance && self.scene.velocity > 0.0;
        if matters && options.friction == FrictionLaw::LuGre {
            // If the integration fails, the estimate is kept.
            if let Ok((late, left, evaluations)) = presliding.followed(substrate, &timed, spring) {
                return Ok((Slip { advance: timed.advance + late, ..timed }, left, evaluations));
            }
        }
        Ok((timed, error, 0))
    }

    /// Returns the twist at which F_Z has fallen to `least`, or pi/2.
    fn last_twist(&self, least: f64) -> f64 {
        let drop = (self.probe.preload_force - least) / self.probe.normal / self.height;
        if drop < 1.0 { 2.0 * libm::asin((0.5 * drop).sqrt()) } else { FRAC_PI_2 }
    }

    /// Returns the slip, and the number of evaluations of friction.
    ///
    /// # Errors
    /// [`Failure::BeyondPullOff`] if the twist lifts the tip until neither its force nor the adhesion holds the particle
    /// down, before the particle slips; those of the law of friction.
    pub(super) fn slip(&self, substrate: &Substrate) -> Result<(Slip, u64), Failure> {
        let mut evaluations = 0;
        let least = -substrate.support;
        let rounding = 16.0 * f64::EPSILON * self.probe.preload_force;
        let mut hold = |theta: f64| -> Result<(Hold, f64), Failure> {
            let force = self.normal_force(theta);
            // At the last twist, rounding may give a force below the smallest one.
            let force = if force < least && force > least - rounding { least } else { force };
            let hold = substrate.hold(force)?;
            evaluations += hold.evaluations;
            Ok((hold, force))
        };
        // F_Y cos theta - F_Y* cos theta: with the sign of F_Y - F_Y*, and finite up to pi/2.
        let mut residual = |theta: f64| -> Result<f64, Failure> {
            Ok(self.lateral_moment(theta) - hold(theta)?.0.capacity * libm::cos(theta))
        };
        let at_rest = residual(0.0)?;
        let last = self.last_twist(least);
        let slope = self.restoring - self.probe.preload_force;
        let mut high = Point { x: (-at_rest / slope).min(last), y: 0.0 };
        high.y = residual(high.x)?;
        let theta = if at_rest >= 0.0 {
            // No force to overcome.
            0.0
        } else if high.y == 0.0 {
            high.x
        } else if high.y < 0.0 {
            // Within rounding of the bound, if the bound is that of the root or pi/2.
            if high.x == last && last < FRAC_PI_2 {
                return Err(Failure::BeyondPullOff);
            }
            high.x
        } else {
            // The bound is slightly too large: twice the step of Newton's method usually passes the root.
            let guess = high.x - 2.0 * high.y / slope;
            let mut low = Point { x: 0.0, y: at_rest };
            if guess > 0.0 {
                let tried = Point { x: guess, y: residual(guess)? };
                if tried.y < 0.0 { low = tried } else { high = tried }
            }
            root::between(low, high, residual)?
        };
        let (hold, normal_force) = hold(theta)?;
        // F_Y and F_Y* agree at the root within their conditioning: that of the geometry is poor near a right angle, that
        // of friction if its coefficient is so large that one rounding error of the twist changes it.
        let of_geometry = self.lateral_force(theta);
        let agree = (hold.capacity - of_geometry).abs() < 1e-6 * of_geometry;
        let lateral_force = if agree || libm::cos(theta) < 1e-6 { hold.capacity } else { of_geometry };
        let travel = self.travel(theta, lateral_force);
        let contact = hold.contact;
        let slip = Slip { normal_force, lateral_force, travel, twist: theta, contact, advance: 0.0, slowdown: 1.0 };
        Ok((slip, evaluations))
    }
}
