//! The probe in equilibrium, as in [`quasi_static`](super::quasi_static), and the slip of a particle that it pushes.

use std::f64::consts::FRAC_PI_2;

use super::presliding::Presliding;
use super::slip::Slip;
use super::substrate::{Hold, Substrate};
use crate::probe::Probe;
use crate::root::{self, Point};
use crate::{Failure, FrictionLaw, Scene};

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
            return Ok((*slip, substrate.viscous_rise(slip.normal_force, slip.lateral_force), 0));
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
