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
mod tests {
    use super::*;

    const PAIR: Pair = Pair { radius: 50e-9, modulus: 60e9, adhesion: 0.2, separation: 0.2e-9 };

    /// Known exact points: a^3 = 2 pi w R^2/K without load, and a = 0 at pull-off.
    #[test]
    fn exact_points() {
        let at_rest = contact(&PAIR, 0.0).unwrap();
        let cube = 2.0 * PI * 0.2 * 50e-9_f64.powi(2) / 60e9;
        assert!((at_rest.radius / libm::cbrt(cube) - 1.0).abs() < 1e-15);
        assert!((at_rest.indentation / (libm::cbrt(cube).powi(2) / 50e-9) - 1.0).abs() < 1e-15);
        assert_eq!(contact(&PAIR, -pull_off(&PAIR)), Ok(Contact { radius: 0.0, indentation: 0.0 }));
        assert_eq!(contact(&PAIR, (-pull_off(&PAIR)).next_down()), Err(Failure::BeyondPullOff));
    }
}
