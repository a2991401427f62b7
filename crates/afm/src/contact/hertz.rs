//! Hertz 1881: elastic contact without adhesion.

use super::{Contact, Pair};
use crate::Failure;
use crate::cube_root::cube_root;

/// Returns a^3 = R F/K, d = a^2/R. Adhesion is ignored.
///
/// Valid for a well below R, and if the load is far above every adhesive force.
#[inline]
pub(super) fn contact(pair: &Pair, load: f64) -> Result<Contact, Failure> {
    if load < 0.0 {
        return Err(Failure::BeyondPullOff);
    }
    let radius = radius(pair, load);
    Ok(Contact { radius, indentation: radius * radius / pair.radius })
}

/// Returns the radius alone (m), of a load >= 0.
#[inline]
pub(super) fn radius(pair: &Pair, load: f64) -> f64 {
    cube_root(pair.radius / pair.modulus * load)
}

#[cfg(test)]
#[path = "tests/hertz.rs"]
mod tests;
