//! The swing of the tip when the substrate starts: at once at V, while the probe is at rest.
//!
//! About its apex, which is fixed to the particle, the tip is an undamped oscillator, I_T omega^2 = K_theta + K_y H^2.
//! The start gives it theta' = V/H while the equilibrium turns only at V k_lat H/K_theta, so it swings by (V - V k_lat
//! H^2/K_theta)/(H omega) permanently. Rungs without inertia neglect this, and take their error from these amplitudes.

use super::slip::{Error, Slip};
use super::substrate::Substrate;
use crate::probe::Probe;
use crate::{FrictionLaw, Scene};

/// The swing at small twist: its frequency and amplitudes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Swing {
    /// omega (rad/s).
    pub frequency: f64,
    /// Of the spring of the cantilever, K_y y_P: V k_lat/omega (N). It acts on a particle on bristles.
    pub spring: f64,
    /// Of F_Y, to which the mass of the tip contributes (N).
    pub lateral: f64,
    /// Of F_Z, for each radian of twist (N).
    normal_per_twist: f64,
    /// Centrifugal force at twice the mean rate of turning, the maximum (N).
    centrifugal: f64,
}

/// Returns I_T = I_c + m H^2/4 (kg m2).
#[inline(always)]
pub(super) fn inertia_about_apex(scene: &Scene) -> f64 {
    scene.effective_tip_inertia() + 0.25 * scene.effective_tip_mass() * scene.height * scene.height
}

/// Maximum swing that is followed on bristles, from start to slip (rad): thousands of steps, not millions.
const MAX_TURNS: f64 = 1e3;

impl Swing {
    #[inline(always)]
    pub fn new(scene: &Scene, probe: &Probe) -> Self {
        let height = scene.height;
        let mass = scene.effective_tip_mass();
        let inertia = inertia_about_apex(scene);
        let stiffness = probe.torsional + probe.lateral * height * height;
        let frequency = (stiffness / inertia).sqrt();
        let turning = scene.velocity / height;
        // K_theta/(K_theta + K_y H^2) of the rate at which the tip would turn on a rigid cantilever.
        let angle = turning * (probe.torsional / stiffness) / frequency;
        let spring = probe.lateral * height * angle;
        let of_mass = 0.5 * mass * height * frequency * frequency * angle;
        Self {
            frequency,
            spring,
            lateral: (of_mass - spring).abs(),
            normal_per_twist: of_mass + probe.normal * height * angle,
            centrifugal: 2.0 * mass * height * turning * turning,
        }
    }

    /// Returns the amplitude of F_Z at a twist (N).
    #[inline(always)]
    pub fn normal(&self, twist: f64) -> f64 {
        self.centrifugal + twist * self.normal_per_twist
    }

    /// Returns whether the dynamic rung follows it on bristles, for a slip after the travel (m) at the velocity (m/s).
    pub fn is_followed(&self, travel: f64, velocity: f64) -> bool {
        self.frequency * (travel / velocity) < MAX_TURNS
    }

    /// Returns the relative error of the critical time without the swing, which makes the slip earlier; at most 1.
    pub fn of_time(&self, slip: &Slip, substrate: &Substrate) -> f64 {
        // Bristles are affected only by the spring.
        let lateral = if slip.slowdown > 1.0 { self.spring } else { self.lateral };
        let amplitude = lateral + self.normal(slip.twist) * slip.slope(substrate);
        let earliest = slip.lateral_force - amplitude * slip.slowdown;
        if earliest > 0.0 { (amplitude / earliest * slip.sensitivity()).min(1.0) } else { 1.0 }
    }

    /// Returns the error of neglecting the swing: F_Z swings, and friction with it. The lateral force at the slip is
    /// that of friction for a particle that sticks until then; on bristles it is the maximum of a force that swings
    /// with the spring.
    #[inline(always)]
    pub fn left_out(&self, slip: &Slip, substrate: &Substrate) -> Error {
        let normal = self.normal(slip.twist);
        let spring = if substrate.options.friction == FrictionLaw::LuGre { self.spring } else { 0.0 };
        Error { normal, lateral: spring + normal * slip.slope(substrate) }
    }
}
