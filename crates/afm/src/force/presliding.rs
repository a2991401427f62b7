//! The presliding displacement of a particle on bristles (its creep before it slips), and the time of the slip.
//!
//! On bristles the force only approaches its peak F*, so the slip is defined as the time at which it reaches a fixed
//! share of it, [`REACHED`]. By then the particle has crept by u, and the substrate has travelled by V t = s + u, where s
//! is the travel of the apex. With p = sigma0 z, the force of the bristles, p* = F* - sigma2 V, its peak, and rho = 1 -
//! p/p*,
//!
//!   dp = sigma0 rho^alpha du,  v = V/(1 + kappa rho^alpha),  F = p + (sigma1 rho + sigma2) v,  kappa = sigma0/k_lat,
//!
//! where v = du/dt. alpha is 1 for LuGre friction (Canudas de Wit et al. 1995, with Fss = p*), the exponent of Dahl's law
//! (Dahl 1968), and 0 for the linear spring of Armstrong-Helouvry, Dupont & Canudas de Wit 1994. v follows from the
//! balance dF/dt = k_lat (V - v) without the change of the viscous forces, and p* from Fss(V) instead of Fss(v);
//! [`Presliding::error`] bounds both errors. Without dashpots and at constant load, alpha = 1 gives
//! u = (p*/sigma0) ln(1/rho).

use super::slip::Slip;
use super::substrate::Substrate;
use crate::friction::{Drive, LuGre, ramp_travel};
use crate::probe::Probe;
use crate::{Failure, FrictionLaw};

/// Share of its peak at which the force counts as that of the slip.
pub(crate) const REACHED: f64 = 0.999;

/// The creep of a particle before it slips.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Presliding {
    /// p*/sigma0 (m), the deflection of the bristles at the peak.
    length: f64,
    /// alpha.
    exponent: f64,
    /// kappa.
    stiffness: f64,
    /// sigma1 V/p* and sigma2 V/p*.
    damping: f64,
    viscosity: f64,
    /// Decrease of the load by the twist until the slip, relative to the load at the slip.
    drop: f64,
    /// |Fss(0) - Fss(V)|/Fss(V).
    weakening: f64,
}

impl Presliding {
    /// Creates the creep before `slip` on a `probe` whose apex has the stiffness `spring` (N/m); `None` for laws without
    /// presliding displacement, and if no friction holds the particle.
    ///
    /// # Errors
    /// Those of the integration of a Lemaitre-Carlson layer.
    pub fn new(substrate: &Substrate, slip: &Slip, probe: &Probe, spring: f64) -> Result<Option<Self>, Failure> {
        let &Substrate { scene, options, .. } = substrate;
        let (velocity, load) = (scene.velocity, slip.normal_force + substrate.adhesive_load);
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
                    ..Self::default()
                };
                (law.stiffness, way)
            }
            FrictionLaw::Dahl => (scene.bristle_stiffness, Self { exponent: scene.dahl_exponent, ..Self::default() }),
            FrictionLaw::Armstrong => (scene.bristle_stiffness, Self::default()),
            // A linear spring with the shear stiffness of the layer.
            FrictionLaw::LemaitreCarlson => {
                let force = REACHED * slip.lateral_force;
                (substrate.layer_stiffness(slip.contact.radius, force)?, Self::default())
            }
        };
        let drop = (probe.preload_force - slip.normal_force) / load;
        let strength = slip.lateral_force / (1.0 + way.viscosity);
        let way = Self { length: strength / stiffness, stiffness: stiffness / spring, drop, ..way };
        Ok((strength > 0.0 && way.length.is_finite() && drop.is_finite()).then_some(way))
    }

    /// Returns rho where the force is below its peak by the share `missing`. With dashpots and alpha = 1 this is the
    /// positive root of kappa rho^2 + b rho = c, where c is the missing force over p*.
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

    /// Returns u (m) where the force is below its peak by the share `missing`, to first order in the decrease of the load.
    pub fn creep(&self, missing: f64) -> f64 {
        let rho = self.reserve(missing);
        // The integrals of rho^(k - alpha) from rho to 1.
        let [at_load, first, second] = [0.0, 1.0, 2.0].map(|k| {
            let n = k + 1.0 - self.exponent;
            if n == 0.0 { -libm::log(rho) } else { -libm::expm1(n * libm::log(rho)) / n }
        });
        let dropped = if self.exponent == 0.0 || self.drop == 0.0 {
            0.0
        } else {
            self.exponent * self.drop * (2.0 * at_load - 3.0 * first + second)
        };
        // Not below zero, for any decrease of the load.
        if dropped > 0.0 {
            self.length * at_load * (at_load / (at_load + dropped))
        } else {
            self.length * (at_load - dropped)
        }
    }

    /// Returns V/(V - v) at the slip: the factor by which the force rises more slowly than for a particle at rest on the
    /// substrate.
    fn slowdown(&self) -> f64 {
        let slowdown = 1.0 + 1.0 / (self.stiffness * libm::pow(self.reserve(1.0 - REACHED), self.exponent));
        // Above 1 even on very stiff bristles, unlike on a rigid contact.
        slowdown.max(1.0_f64.next_up())
    }

    /// Returns `slip` with its time, on an apex of `spring` stiffness (N/m).
    pub fn timed(&self, slip: &Slip, spring: f64) -> Slip {
        let missing = 1.0 - REACHED;
        // For extreme inputs the slope at the slip is lost in rounding; the rest is at most the travel so far.
        let advance = self.creep(missing) - (missing * slip.lateral_force / spring).min(slip.travel);
        // With a large exponent of Dahl's law the creep may overflow.
        Slip { advance: advance.min(f64::MAX), slowdown: self.slowdown(), ..*slip }
    }

    /// Returns the relative error of the time of `slip` due to the dashpots and the Stribeck curve.
    pub fn error(&self, slip: &Slip) -> f64 {
        let way = (slip.travel + slip.advance) / self.length;
        let dashpots = self.stiffness * (self.damping + self.viscosity);
        let curve = 2.0 * self.stiffness * self.weakening * libm::log(1.0 / (1.0 - REACHED));
        let load = 100.0 * self.drop * self.drop;
        if self.exponent == 1.0 { (dashpots * dashpots + curve + load) / way } else { load / way }
    }

    /// Returns the additional travel of the substrate (m) until the slip under LuGre friction with dashpots and Stribeck
    /// curve, from an integrated ramp at the load and on the `spring` (N/m) of the slip; the remaining relative error of
    /// the time; and the number of evaluations.
    ///
    /// # Errors
    /// Those of the integration.
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
