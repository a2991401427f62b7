//! Derjaguin, Muller & Toporov 1975, in the form of Maugis 1992.

use std::f64::consts::PI;

use super::{Contact, Pair, hertz};
use crate::Failure;

/// Returns a^3 = (R/K) (F + 2 pi w R), d = a^2/R: a Hertz contact with the surface forces added to the load, without a
/// change of shape. Valid for stiff, small, weakly adhesive bodies: Tabor parameter below 0.1.
///
/// Without adhesion this is Hertz, to the last bit.
#[inline]
pub(super) fn contact(pair: &Pair, load: f64) -> Result<Contact, Failure> {
    let margin = load + pull_off(pair);
    if margin < 0.0 {
        return Err(Failure::BeyondPullOff);
    }
    let radius = hertz::radius(pair, margin);
    Ok(Contact { radius, indentation: radius * radius / pair.radius })
}

/// Returns 2 pi w R, at which the contact has shrunk to a point.
#[inline]
pub(super) fn pull_off(pair: &Pair) -> f64 {
    2.0 * PI * pair.adhesion * pair.radius
}

#[cfg(test)]
#[path = "tests/dmt.rs"]
mod tests;
