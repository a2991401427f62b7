//! The instant of slip, as every rung finds it, made into the common result.

use std::f64::consts::PI;
use std::ops::Add;

use super::substrate::Substrate;
use super::{Cost, Critical, Fidelity};
use crate::afm::contact::Contact;
use crate::afm::{Failure, Flag, Flags};

/// State at the slip.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slip {
    pub normal_force: f64,
    pub lateral_force: f64,
    /// Of the substrate, less what the particle crept on its bristles.
    pub travel: f64,
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

    #[inline]
    fn add(self, other: Self) -> Self {
        Self { normal: self.normal + other.normal, lateral: self.lateral + other.lateral }
    }
}

impl Error {
    /// The relative error of F_cr: |dF_cr| <= (F_Z |dF_Z| + F_Y |dF_Y|)/F_cr. At most 1, which claims nothing.
    #[inline]
    pub fn of(self, slip: &Slip) -> f64 {
        let squared = slip.normal_force * slip.normal_force + slip.lateral_force * slip.lateral_force;
        let shift = slip.normal_force.abs() * self.normal + slip.lateral_force * self.lateral;
        if shift > 0.0 { (ROUNDING + shift / squared).min(1.0) } else { ROUNDING }
    }
}

impl Slip {
    /// This slip, if friction held the tip back.
    ///
    /// # Errors
    /// [`Failure::StepTooSmall`] for a march that ended in rounding: far outside any laboratory one force may drown
    /// another.
    pub fn held_back(self) -> Result<Self, Failure> {
        if self.lateral_force < 0.0 || self.twist < 0.0 { Err(Failure::StepTooSmall) } else { Ok(self) }
    }

    /// A bound of |dF_Y*/dF_Z| here, see [`Substrate::slope`].
    pub fn slope(&self, substrate: &Substrate) -> f64 {
        substrate.slope(self.lateral_force, self.normal_force).abs()
    }

    /// The result of a rung, with error and cost left to fill in.
    #[inline]
    pub fn critical(&self, substrate: &Substrate, rung: Fidelity) -> Critical {
        let &Slip { normal_force, lateral_force, travel, twist, contact } = self;
        Critical {
            normal_force,
            lateral_force,
            critical_force: normal_force.hypot(lateral_force),
            force_angle: lateral_force.atan2(normal_force),
            travel,
            critical_time: critical_time(travel, substrate.scene.velocity),
            contact_radius: contact.radius,
            indentation: contact.indentation,
            twist,
            flags: self.flags(substrate),
            error_estimate: 0.0,
            cost: Cost::default(),
            rung,
        }
    }

    #[inline]
    fn flags(&self, substrate: &Substrate) -> Flags {
        let &Substrate { scene, options, pair, .. } = substrate;
        let radius = self.contact.radius;
        // Without adhesion every theory is Hertz, whatever the Tabor parameter.
        let unsuited = pair.adhesion > 0.0 && !options.contact.suits(pair.tabor());
        Flags::NONE
            .with(Flag::LargeContact, radius > 0.3 * pair.radius)
            .with(Flag::AboveHardness, self.normal_force > scene.hardness * (PI * radius * radius))
            .with(Flag::LargeTwist, self.twist > 0.1)
            .with(Flag::TaborOutOfRange, unsuited)
    }
}

/// s/V.
#[inline]
fn critical_time(travel: f64, velocity: f64) -> Result<f64, Failure> {
    if velocity == 0.0 {
        return Err(Failure::VelocityZero);
    }
    let time = travel / velocity;
    if time.is_finite() { Ok(time) } else { Err(Failure::NotFinite { quantity: "critical_time" }) }
}
