//! The state at the slip, which every rung computes, and its conversion to the common result.

use std::f64::consts::PI;
use std::ops::{Add, RangeInclusive};

use super::substrate::Substrate;
use super::{Critical, Fidelity, Options};
use crate::contact::{Contact, Pair};
use crate::{Failure, Flag, Flags, Scene};

/// State at the slip.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slip {
    pub normal_force: f64,
    pub lateral_force: f64,
    /// Travel of the apex (m).
    pub travel: f64,
    /// Additional travel of the substrate at the time of the slip (m): the creep of the particle on its bristles, minus
    /// the travel of the apex that is left at that time.
    pub advance: f64,
    /// V/(V - v): the factor by which the force rises more slowly at the slip than for a particle at rest on the
    /// substrate; 1 without bristles.
    pub slowdown: f64,
    pub twist: f64,
    pub contact: Contact,
}

/// Estimated errors of the two forces (N), >= 0.
#[derive(Clone, Copy, Debug)]
pub(super) struct Error {
    pub normal: f64,
    pub lateral: f64,
}

/// A few dozen roundings: no rung is more accurate.
const ROUNDING: f64 = 1e-14;

impl Add for Error {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { normal: self.normal + other.normal, lateral: self.lateral + other.lateral }
    }
}

impl Error {
    /// Returns the relative error of F_cr = hypot(F_Y, F_Z): |dF_cr| <= (F_Z |dF_Z| + F_Y |dF_Y|)/F_cr. At most 1, which
    /// means that no accuracy is stated.
    #[inline(always)]
    pub fn value(self, slip: &Slip) -> f64 {
        if slip.squared().is_normal() { self.of_ordinary(slip) } else { self.of_extreme(slip) }
    }

    /// Returns the same if no square underflows or overflows, without branches.
    #[inline(always)]
    pub fn of_ordinary(self, slip: &Slip) -> f64 {
        let shift = slip.normal_force.abs() * self.normal + slip.lateral_force * self.lateral;
        // For errors far larger than the forces: dF_cr <= hypot(dF_Z, dF_Y).
        let second = self.normal * self.normal + self.lateral * self.lateral;
        let shift = if second > shift { shift + second } else { shift };
        let relative = (ROUNDING + shift / slip.squared()).min(1.0);
        // An error of NaN counts as 1.
        if shift > 0.0 || shift.is_nan() { relative } else { ROUNDING }
    }

    /// Returns the same if squares over- or underflow. An error of NaN counts as 1.
    #[cold]
    fn of_extreme(self, slip: &Slip) -> f64 {
        let size = libm::hypot(slip.normal_force, slip.lateral_force);
        if size == 0.0 && self.normal == 0.0 && self.lateral == 0.0 {
            return ROUNDING;
        }
        let [normal, lateral] = [(slip.normal_force, self.normal), (slip.lateral_force, self.lateral)]
            .map(|(force, error)| if error == 0.0 { 0.0 } else { force.abs() / size * (error / size) });
        let relative = normal + lateral;
        if relative.is_nan() { 1.0 } else { (ROUNDING + relative).min(1.0) }
    }
}

/// Returns the size of a difference beyond what is `allowed`; an allowance of NaN allows nothing.
fn excess(difference: f64, allowed: f64) -> f64 {
    if difference.abs() <= allowed { 0.0 } else { difference.abs() - allowed.max(0.0) }
}

impl Slip {
    /// Returns the distance of this slip from `other`, beyond what is `allowed`.
    pub(super) fn beyond(&self, other: &Self, allowed: Error) -> Error {
        Error {
            normal: excess(self.normal_force - other.normal_force, allowed.normal),
            lateral: excess(self.lateral_force - other.lateral_force, allowed.lateral),
        }
    }

    /// Returns this slip, if F_Y and the twist have the direction of the friction force.
    ///
    /// # Errors
    /// [`Failure::StepTooSmall`] for an integration that ended in rounding errors: for extreme inputs one force may be
    /// negligible compared with another.
    pub fn held_back(self) -> Result<Self, Failure> {
        if self.lateral_force < 0.0 || self.twist < 0.0 { Err(Failure::StepTooSmall) } else { Ok(self) }
    }

    /// Returns the relative change of the critical time per relative change of the force.
    pub fn sensitivity(&self) -> f64 {
        self.slowdown * self.travel / (self.travel + self.advance)
    }

    /// Returns F_cr^2 (N^2).
    #[inline(always)]
    pub fn squared(&self) -> f64 {
        self.normal_force * self.normal_force + self.lateral_force * self.lateral_force
    }

    /// Returns a bound of |dF_Y*/dF_Z| here, see [`Substrate::slope`].
    #[inline(always)]
    pub fn slope(&self, substrate: &Substrate) -> f64 {
        substrate.slope(self.lateral_force, self.normal_force).abs()
    }

    /// Creates the result of a rung, without error and number of evaluations.
    #[inline]
    pub fn critical(&self, substrate: &Substrate, rung: Fidelity) -> Critical {
        let &Slip { normal_force, lateral_force, twist, contact, .. } = self;
        let travel = self.travel + self.advance;
        Critical {
            normal_force,
            lateral_force,
            critical_force: magnitude(self.squared(), normal_force, lateral_force),
            travel,
            critical_time: critical_time(travel, substrate.scene.velocity),
            contact_radius: contact.radius,
            indentation: contact.indentation,
            twist,
            flags: self.flags(substrate.scene, substrate.options),
            error_estimate: 0.0,
            evaluations: 0,
            rung,
        }
    }

    #[inline(always)]
    pub fn flags(&self, scene: &Scene, options: &Options) -> Flags {
        let pair = Pair::substrate(scene);
        let radius = self.contact.radius;
        Flags::NONE
            .with(Flag::LargeContact, radius > 0.3 * pair.radius)
            .with(Flag::AboveHardness, self.normal_force > scene.hardness * (PI * radius * radius))
            .with(Flag::LargeTwist, self.twist > 0.1)
            .with(Flag::TaborOutOfRange, !options.contact.suits_pair(&pair))
    }
}

impl Critical {
    /// Returns the state at the slip, without its time.
    pub(crate) fn slip(&self) -> Slip {
        let contact = Contact { radius: self.contact_radius, indentation: self.indentation };
        let &Self { normal_force, lateral_force, travel, twist, .. } = self;
        Slip { normal_force, lateral_force, travel, twist, contact, advance: 0.0, slowdown: 1.0 }
    }
}

/// Squares whose roots are not affected by overflow or underflow.
pub(super) const ORDINARY_SQUARES: RangeInclusive<f64> = 1e-200..=1e200;

/// Returns F_cr from its square, or from its parts (F_Z, F_Y) if the square overflowed or underflowed.
#[inline]
fn magnitude(squared: f64, normal_force: f64, lateral_force: f64) -> f64 {
    if ORDINARY_SQUARES.contains(&squared) { squared.sqrt() } else { libm::hypot(normal_force, lateral_force) }
}

/// Returns s/V.
#[inline]
pub(super) fn critical_time(travel: f64, velocity: f64) -> Result<f64, Failure> {
    if velocity == 0.0 {
        return Err(Failure::VelocityZero);
    }
    let time = travel / velocity;
    if time.is_finite() { Ok(time) } else { Err(Failure::NotFinite { quantity: "critical_time" }) }
}
