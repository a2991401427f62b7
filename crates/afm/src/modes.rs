//! Other motions of the particle under the tip than sliding on the substrate: slip at the tip, roll, spin.
//!
//! These are diagnostics that do not affect the critical force. Every mode is a [`Balance`] of a drive and a resistance
//! (Tafazzoli & Sitti 2004); a mode moves if the drive is larger. Sliding here is by Coulomb's law.
//!
//! At the nominal scene these criteria let the particle roll long before it slides: its contacts resist a moment of
//! 3e-16 N m, the tip drives 9e-15 N m when it slides. Only a force along the line through both contacts, psi = phi/2,
//! does not drive rolling.

use std::f64::consts::PI;

use apportion_base::names::named;
use apportion_base::quantity::Domain;

use super::contact::{Contact, Pair};
use super::{ContactTheory, Failure, Scene};

named! {
    /// A mode of motion of the particle.
    pub enum Mode {
        /// It slides on the substrate: F_Y > mu_s (F_Z + q F_ad) + tau A_s.
        Slide = "slide",
        /// The tip slips on it: |F_T sin(psi - phi)| > mu_t (F_T cos(psi - phi) + q F_ad,t) + tau A_t.
        TipSlip = "tip-slip",
        /// It rolls between tip and substrate: F_T |(R_p - d_s) sin psi + (R_p - d_t) sin(psi - phi)| > M_s + M_t, with
        /// M = 4 F_ad (a/a0)^(3/2) xi at either contact, a0 its radius without load (Dominik & Tielens 1997).
        Roll = "roll",
        /// It spins about the vertical, pushed off its centre: F_T sin psi x0 > (2 pi/3) tau a^3.
        Spin = "spin",
    }
}

/// Constants of the modes that the critical force does not need.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModeConstants {
    /// Coefficient of friction between tip and particle, mu_t, >= 0. By default 0.8, that of the particle on the
    /// substrate: our choice, as silicon and its oxide face the same gold.
    pub tip_friction: f64,
    /// Distance xi by which the pressure in a contact shifts before it rolls (m), >= 0. By default 0.5 nm, of atomic
    /// size (Dominik & Tielens 1997).
    pub rolling_shift: f64,
    /// Lateral offset x0 of the tip from the particle's centre (m), >= 0. By default 5 nm: our choice, a tenth of the
    /// nominal particle radius.
    pub offset: f64,
}

impl Default for ModeConstants {
    fn default() -> Self {
        Self { tip_friction: 0.8, rolling_shift: 0.5e-9, offset: 5e-9 }
    }
}

/// The force of the tip on the particle, in the plane of motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TipForce {
    /// Downward part F_Z (N).
    pub normal: f64,
    /// Part along the motion, F_Y (N).
    pub lateral: f64,
}

impl TipForce {
    /// Creates the force of size `size` (N) at the angle `angle` (rad) from the vertical, psi.
    pub fn polar(size: f64, angle: f64) -> Self {
        Self { normal: size * libm::cos(angle), lateral: size * libm::sin(angle) }
    }
}

/// The drive and the resistance of a mode: forces (N) for sliding and slipping, moments (N m) for the others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Balance {
    /// The size of the driving force or moment, >= 0.
    pub drive: f64,
    /// The largest force or moment that can resist, >= 0.
    pub resistance: f64,
}

impl Balance {
    /// Returns whether the drive exceeds the resistance.
    pub fn moves(&self) -> bool {
        self.drive > self.resistance
    }
}

/// When a mode begins, as F_Y rises from zero under a constant F_Z. Ordered from the earliest to the latest.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub enum Onset {
    /// It moves under the preload alone.
    AtOnce,
    /// At this F_Y (N).
    At(f64),
    /// At no F_Y.
    Never,
}

/// A particle under a tip.
#[derive(Clone, Copy, Debug)]
pub struct Pushing {
    /// The constants of the problem.
    pub scene: Scene,
    /// Theory of both contacts.
    pub theory: ContactTheory,
    /// Whether friction includes the pull-off force: q = 1, else 0.
    pub adhesion_in_load: bool,
    /// The constants of the modes.
    pub constants: ModeConstants,
}

impl Pushing {
    /// Creates the particle of `scene`, with JKR contacts, q = 0 and the default constants.
    pub fn new(scene: Scene) -> Self {
        Self { scene, theory: ContactTheory::Jkr, adhesion_in_load: false, constants: ModeConstants::default() }
    }

    /// Returns the balance of `mode` under the tip force `force`.
    ///
    /// # Errors
    /// [`Failure::OutOfDomain`] if a constant is not physical; [`Failure::BeyondPullOff`] if the force pulls the
    /// contact with substrate or tip apart; [`Failure::NotFinite`] on overflow.
    ///
    /// # Example
    /// ```
    /// use apportion_afm::Scene;
    /// use apportion_afm::modes::{Mode, Pushing, TipForce};
    ///
    /// let pushing = Pushing::new(Scene::default());
    /// let before = TipForce { normal: 489e-9, lateral: 390e-9 };
    /// let after = TipForce { normal: 489e-9, lateral: 405e-9 };
    /// assert!(!pushing.balance(Mode::Slide, before)?.moves());
    /// assert!(pushing.balance(Mode::Slide, after)?.moves());
    /// assert!(!pushing.balance(Mode::TipSlip, after)?.moves());
    /// # Ok::<(), apportion_afm::Failure>(())
    /// ```
    pub fn balance(&self, mode: Mode, force: TipForce) -> Result<Balance, Failure> {
        self.check()?;
        let Scene { particle_radius, contact_angle, shear_strength, .. } = self.scene;
        let (sin, cos) = libm::sincos(contact_angle);
        // F_T cos(psi - phi) and F_T sin(psi - phi): along the line from the tip to the particle, and across it.
        let along = force.normal * cos + force.lateral * sin;
        let across = force.lateral * cos - force.normal * sin;
        let balance = match mode {
            Mode::Slide => Balance {
                drive: force.lateral.abs(),
                resistance: self.friction(self.scene.static_friction, &self.substrate(force.normal)?),
            },
            Mode::TipSlip => Balance {
                drive: across.abs(),
                resistance: self.friction(self.constants.tip_friction, &self.tip(along)?),
            },
            Mode::Roll => {
                let (substrate, tip) = (self.substrate(force.normal)?, self.tip(along)?);
                let [at_substrate, at_tip] =
                    [&substrate, &tip].map(|loaded| particle_radius - loaded.contact.indentation);
                let shift = self.constants.rolling_shift;
                Balance {
                    drive: (at_substrate * force.lateral + at_tip * across).abs(),
                    resistance: substrate.rolling(self.theory, shift)? + tip.rolling(self.theory, shift)?,
                }
            }
            Mode::Spin => Balance {
                drive: force.lateral.abs() * self.constants.offset,
                resistance: 2.0 * PI / 3.0 * shear_strength * self.substrate(force.normal)?.contact.radius.powi(3),
            },
        };
        if balance.drive.is_finite() && balance.resistance.is_finite() {
            Ok(balance)
        } else {
            Err(Failure::NotFinite { quantity: mode.name() })
        }
    }

    /// Returns when `mode` begins, as F_Y rises from zero under the normal force `normal` (N).
    ///
    /// # Errors
    /// Those of [`balance`](Self::balance).
    pub fn onset(&self, mode: Mode, normal: f64) -> Result<Onset, Failure> {
        let moves = |lateral: f64| Ok(self.balance(mode, TipForce { normal, lateral })?.moves());
        if moves(0.0)? {
            return Ok(Onset::AtOnce);
        }
        Ok(first_true(moves)?.map_or(Onset::Never, Onset::At))
    }

    /// Returns the least tip force F_T (N) at the angle psi = `angle` (rad) that starts `mode`, as in the mode diagram;
    /// `None` if the resistance grows with the force as fast as the drive.
    ///
    /// For [`Mode::Slide`] this is F* = (tau A_s + mu_s q F_ad)/(sin psi - mu_s cos psi), in which A_s is the area
    /// under F* cos psi itself.
    ///
    /// # Errors
    /// [`Failure::OutOfDomain`] if `angle` is not from 0 to a right angle; those of [`balance`](Self::balance).
    pub fn critical_tip_force(&self, mode: Mode, angle: f64) -> Result<Option<f64>, Failure> {
        Failure::unless_in(Domain::AcuteAngle, "psi", angle)?;
        first_true(|size| Ok(self.balance(mode, TipForce::polar(size, angle))?.moves()))
    }

    fn substrate(&self, normal_force: f64) -> Result<Loaded, Failure> {
        Loaded::new(self.theory, Pair::substrate(&self.scene), normal_force)
    }

    fn tip(&self, force: f64) -> Result<Loaded, Failure> {
        Loaded::new(self.theory, Pair::tip(&self.scene), force)
    }

    /// Returns mu (N + q F_ad) + tau A.
    fn friction(&self, coefficient: f64, at: &Loaded) -> f64 {
        let adhesive = if self.adhesion_in_load { self.theory.pull_off(&at.pair) } else { 0.0 };
        coefficient * (at.load + adhesive) + self.scene.shear_strength * at.contact.area()
    }

    fn check(&self) -> Result<(), Failure> {
        let ModeConstants { tip_friction, rolling_shift, offset } = self.constants;
        Failure::unless_in(Domain::NonNegative, "tip_friction", tip_friction)?;
        Failure::unless_in(Domain::NonNegative, "rolling_shift", rolling_shift)?;
        Failure::unless_in(Domain::NonNegative, "offset", offset)?;
        self.scene.check()
    }
}

/// One of the two contacts under its load.
struct Loaded {
    pair: Pair,
    load: f64,
    contact: Contact,
}

impl Loaded {
    fn new(theory: ContactTheory, pair: Pair, load: f64) -> Result<Self, Failure> {
        Ok(Self { pair, load, contact: theory.contact(&pair, load)? })
    }

    /// Returns M = 4 F_ad (a/a0)^(3/2) xi (Dominik & Tielens 1997); its limit zero without adhesion.
    fn rolling(&self, theory: ContactTheory, shift: f64) -> Result<f64, Failure> {
        let pull_off = theory.pull_off(&self.pair);
        let at_rest = theory.contact(&self.pair, 0.0)?.radius;
        if pull_off == 0.0 || at_rest == 0.0 {
            return Ok(0.0);
        }
        Ok(4.0 * pull_off * libm::pow(self.contact.radius / at_rest, 1.5) * shift)
    }
}

/// Returns the force (N) at which a statement becomes true: 0 if it is at 1e-18 N, `None` if it is not up to 1e6 N.
///
/// Drives grow in proportion to the force, resistances like smaller powers of it, hence each statement turns true once.
fn first_true(statement: impl Fn(f64) -> Result<bool, Failure>) -> Result<Option<f64>, Failure> {
    let (mut low, mut high) = (0.0, 1e-18);
    if statement(high)? {
        return Ok(Some(0.0));
    }
    while !statement(high)? {
        if high > 1e6 {
            return Ok(None);
        }
        (low, high) = (high, 2.0 * high);
    }
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high || high - low <= f64::EPSILON * high {
            return Ok(Some(high));
        }
        if statement(middle)? {
            high = middle;
        } else {
            low = middle;
        }
    }
}

#[cfg(test)]
#[path = "tests/modes.rs"]
mod tests;
