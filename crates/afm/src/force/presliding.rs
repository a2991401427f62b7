//! The creep of a particle on its bristles before it slips, and when the force is as good as at its peak.
//!
//! The force that bristles transmit only approaches its peak F*, so the slip is timed by a fixed share of it, [`REACHED`].
//! On the way the particle creeps by u, and the substrate travels by V t = s + u, s being the travel of the apex. With p the
//! force of the bristles alone, p* = F* - sigma2 V its peak and rho = 1 - p/p*,
//!
//!   dp = sigma0 rho^alpha du,  v = V/(1 + kappa rho^alpha),  F = p + (sigma1 rho + sigma2) v,  kappa = sigma0/k_lat,
//!
//! where alpha is 1 for LuGre friction, Dahl's exponent, and 0 for Armstrong's spring. v leaves out the rate at which the
//! dashpots give way, and the Stribeck curve between v and V; [`Presliding::error`] says what that may cost. Without
//! dashpots and at constant load u = z ln(1/rho) with z = p*/sigma0 for alpha = 1.

use super::slip::Slip;
use super::substrate::Substrate;
use crate::friction::{Drive, LuGre, ramp_travel};
use crate::probe::Probe;
use crate::{Failure, FrictionLaw};

/// Share of its peak at which the force counts as that of the slip.
pub(crate) const REACHED: f64 = 0.999;

/// The way of a particle before it slips.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Presliding {
    /// z = p*/sigma0 (m).
    length: f64,
    /// alpha.
    exponent: f64,
    /// kappa.
    stiffness: f64,
    /// sigma1 V/p* and sigma2 V/p*.
    damping: f64,
    viscosity: f64,
    /// What the twist takes from the load until the slip, relative to that of the slip.
    drop: f64,
    /// How much friction weakens between rest and V, relatively.
    weakening: f64,
}

impl Presliding {
    /// Before `slip` on a `probe` whose apex is as stiff as `spring` (N/m); `None` for laws that hold the particle still until then, and
    /// where nothing holds it at all.
    ///
    /// # Errors
    /// Those of the march of a Lemaitre-Carlson layer.
    pub fn new(substrate: &Substrate, slip: &Slip, probe: &Probe, spring: f64) -> Result<Option<Self>, Failure> {
        let &Substrate { scene, options, .. } = substrate;
        let (velocity, load) = (scene.velocity, slip.normal_force + substrate.adhesive_load);
        let none = Self {
            length: 0.0,
            exponent: 0.0,
            stiffness: 0.0,
            damping: 0.0,
            viscosity: 0.0,
            drop: 0.0,
            weakening: 0.0,
        };
        let (stiffness, way) = match options.friction {
            FrictionLaw::Coulomb | FrictionLaw::HurtadoKim | FrictionLaw::Stribeck => return Ok(None),
            FrictionLaw::LuGre => {
                let law = LuGre::with(scene, options.lugre, slip.contact.radius);
                let strength = slip.lateral_force - law.viscous_friction * velocity;
                let moving = law.stribeck(load, velocity);
                let way = Self {
                    exponent: 1.0,
                    damping: law.damping * velocity / strength,
                    viscosity: law.viscous_friction * velocity / strength,
                    weakening: (law.stribeck(load, 0.0) - moving).abs() / moving,
                    ..none
                };
                (law.stiffness, way)
            }
            FrictionLaw::Dahl => (scene.bristle_stiffness, Self { exponent: scene.dahl_exponent, ..none }),
            FrictionLaw::Armstrong => (scene.bristle_stiffness, none),
            // As a spring that is stretched as far as the layer is sheared.
            FrictionLaw::LemaitreCarlson => (substrate.layer_stiffness(slip)?, none),
        };
        let drop = (probe.preload_force - slip.normal_force) / load;
        let strength = slip.lateral_force / (1.0 + way.viscosity);
        let way = Self { length: strength / stiffness, stiffness: stiffness / spring, drop, ..way };
        Ok((strength > 0.0 && way.length.is_finite() && drop.is_finite()).then_some(way))
    }

    /// rho where the force lacks the share `missing` of its peak: the root of kappa rho^2 + b rho = c, alpha = 1 where there
    /// are dashpots.
    fn reserve(&self, missing: f64) -> f64 {
        if self.damping + self.viscosity == 0.0 {
            return missing;
        }
        let left = missing * (1.0 + self.viscosity);
        let b = 1.0 - self.damping - self.stiffness * (left - self.viscosity);
        let root = (b * b + 4.0 * self.stiffness * left).sqrt();
        let rho = if b > 0.0 { 2.0 * left / (b + root) } else { (root - b) / (2.0 * self.stiffness) };
        rho.min(1.0)
    }

    /// u (m) where the force lacks the share `missing` of its peak, to first order in the drop of the load.
    pub fn creep(&self, missing: f64) -> f64 {
        let rho = self.reserve(missing);
        // The integral of rho^(k - alpha) from rho to 1.
        let power = |k: f64| {
            let n = k + 1.0 - self.exponent;
            if n == 0.0 { -libm::log(rho) } else { -libm::expm1(n * libm::log(rho)) / n }
        };
        let whole = power(0.0);
        let dropped = if self.exponent == 0.0 || self.drop == 0.0 {
            0.0
        } else {
            self.exponent * self.drop * (2.0 * whole - 3.0 * power(1.0) + power(2.0))
        };
        // Not below zero, whatever the load drops by.
        if dropped > 0.0 { self.length * whole * (whole / (whole + dropped)) } else { self.length * (whole - dropped) }
    }

    /// V/(V - v) when the slip counts: how much longer the force takes to rise than on a spring whose end stands still.
    fn slowdown(&self) -> f64 {
        let slowdown = 1.0 + 1.0 / (self.stiffness * libm::pow(self.reserve(1.0 - REACHED), self.exponent));
        // Above 1 on bristles however stiff, by which they differ from a rigid contact.
        slowdown.max(1.0_f64.next_up())
    }

    /// `slip` with its time, on an apex of `spring` stiffness (N/m).
    pub fn timed(&self, slip: &Slip, spring: f64) -> Slip {
        let missing = 1.0 - REACHED;
        // Far outside any laboratory the slope at the slip drowns in rounding; the apex has no further to go than it went.
        let advance = self.creep(missing) - (missing * slip.lateral_force / spring).min(slip.travel);
        // Dahl's law with a large exponent takes longer than any number.
        Slip { advance: advance.min(f64::MAX), slowdown: self.slowdown(), ..*slip }
    }

    /// What the time of `slip` may be off by for the dashpots and the Stribeck curve, relatively.
    pub fn error(&self, slip: &Slip) -> f64 {
        let way = (slip.travel + slip.advance) / self.length;
        let dashpots = self.stiffness * (self.damping + self.viscosity);
        let curve = 2.0 * self.stiffness * self.weakening * libm::log(1.0 / (1.0 - REACHED));
        let load = 100.0 * self.drop * self.drop;
        if self.exponent == 1.0 { (dashpots * dashpots + curve + load) / way } else { load / way }
    }

    /// How much later the force of LuGre friction reaches the slip when dashpots and Stribeck curve are followed (m), by a
    /// ramp at the load and on the `spring` (N/m) of the slip; the relative error that is left in the time, and the
    /// evaluations.
    ///
    /// # Errors
    /// Those of the march.
    pub fn followed(&self, substrate: &Substrate, slip: &Slip, spring: f64) -> Result<(f64, f64, u64), Failure> {
        let law = LuGre::with(substrate.scene, substrate.options.lugre, slip.contact.radius);
        let drive = Drive { stiffness: spring, ..substrate.drive };
        let load = slip.normal_force + substrate.adhesive_load;
        let force = REACHED * slip.lateral_force;
        let (travel, evaluations) = ramp_travel(&law, load, &drive, force)?;
        let late = travel - force / spring - Self { drop: 0.0, ..*self }.creep(1.0 - REACHED);
        let slip = Slip { advance: slip.advance + late, ..*slip };
        let bent = self.drop + slip.twist * slip.twist;
        let missed = late.abs() * bent / (slip.travel + slip.advance);
        Ok((late, missed + drive.tolerance * slip.sensitivity(), evaluations))
    }
}
