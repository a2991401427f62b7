//! Johnson, Kendall & Roberts 1971, "Surface energy and the contact of elastic solids".

use std::f64::consts::PI;

use super::{Contact, Pair};
use crate::Failure;
use crate::cube_root::cube_root;

/// Returns a^3 = (R/K) [F + 3 pi w R + sqrt(6 pi w R F + (3 pi w R)^2)], d = a^2/R - (2/3) sqrt(6 pi w a/K): the
/// surface forces act only inside the contact. Valid for soft, large, sticky bodies: Tabor parameter above 5.
///
/// Without adhesion this is Hertz, to the last bit.
#[inline]
pub(super) fn contact(pair: &Pair, load: f64) -> Result<Contact, Failure> {
    let pull = 3.0 * PI * pair.adhesion * pair.radius;
    // 2 F + 3 pi w R: zero at pull-off exactly, negative beyond.
    let margin = 2.0 * load + pull;
    if margin < 0.0 {
        return Err(Failure::BeyondPullOff);
    }
    let radius = radius(pair, load);
    Ok(Contact { radius, indentation: radius * radius / pair.radius - stretch(pair, radius) })
}

/// Returns the radius alone (m); NaN beyond pull-off.
#[inline(always)]
pub(super) fn radius(pair: &Pair, load: f64) -> f64 {
    let pull = 3.0 * PI * pair.adhesion * pair.radius;
    cube_root(pair.radius / pair.modulus * (load + pull + (pull * (2.0 * load + pull)).sqrt()))
}

/// Returns (2/3) sqrt(6 pi w a/K), by which adhesion reduces the indentation.
#[inline]
pub(super) fn stretch(pair: &Pair, radius: f64) -> f64 {
    2.0 / 3.0 * (6.0 * PI * pair.adhesion * radius / pair.modulus).sqrt()
}

/// Returns 1.5 pi w R.
#[inline(always)]
pub(super) fn pull_off(pair: &Pair) -> f64 {
    0.5 * (3.0 * PI * pair.adhesion * pair.radius)
}

#[cfg(test)]
#[path = "tests/jkr.rs"]
mod tests;
