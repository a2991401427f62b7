//! Carpick, Ogletree & Salmeron 1999, "A general equation for fitting contact area and friction vs load measurements".

use super::{Contact, Pair, hertz, maugis_dugdale};
use crate::Failure;
use crate::cube_root::cube_root;

/// The coefficients of the closed form for one lambda.
struct Transition {
    /// From 0 (DMT) to 1 (JKR): alpha = (1 - exp(-lambda/0.924))/1.02, which ends at 0.980.
    alpha: f64,
    /// Radius without load in units of (pi w R^2/K)^(1/3).
    rest: f64,
    /// Pull-off force in units of pi w R.
    pull_off: f64,
}

impl Transition {
    #[inline]
    fn new(lambda: f64) -> Self {
        let log = libm::log(lambda);
        Self {
            alpha: -libm::expm1(-lambda / 0.924) / 1.02,
            rest: 1.54 + 0.279 * blend(2.28 * libm::exp(1.3 * log)),
            pull_off: 1.75 - 0.25 * blend(4.04 * libm::exp(1.4 * log)),
        }
    }
}

/// Returns (x - 1)/(x + 1), from -1 to 1.
fn blend(x: f64) -> f64 {
    1.0 - 2.0 / (x + 1.0)
}

/// Returns a = a0 [(alpha + sqrt(1 + F/F_ad))/(1 + alpha)]^(2/3), F_ad the [pull-off force](pull_off), a0 = (pi w
/// R^2/K)^(1/3) [1.54 + 0.279 (2.28 lambda^1.3 - 1)/(2.28 lambda^1.3 + 1)], lambda = [1.157 mu_T](Pair::transition): a
/// closed form close to Maugis-Dugdale.
///
/// The authors give no indentation; it is that of a Maugis-Dugdale contact of the same radius.
///
/// Valid for every Tabor parameter, within 2.5 % of the Maugis-Dugdale radius. The fit has three digits, which matter
/// at its ends: as lambda falls, a stays 0.09 % above DMT, and as it grows, within 0.8 % of JKR, for which alpha would
/// have to be 1. Without adhesion this is Hertz, to the last bit.
pub(super) fn contact(pair: &Pair, load: f64) -> Result<Contact, Failure> {
    if pair.adhesion == 0.0 {
        return hertz::contact(pair, load);
    }
    let Transition { alpha, rest, pull_off } = Transition::new(pair.transition());
    let margin = load + pair.unit_load() * pull_off;
    if margin < 0.0 {
        return Err(Failure::BeyondPullOff);
    }
    let compliance = pair.radius / pair.modulus;
    let root = alpha * (compliance * pair.unit_load()).sqrt() + (compliance * margin / pull_off).sqrt();
    // a^3, in a form without division by the adhesion.
    let cube = rest * rest * rest * (root * root) / ((1.0 + alpha) * (1.0 + alpha));
    let radius = cube_root(cube);
    Ok(Contact { radius, indentation: maugis_dugdale::indentation(pair, radius) })
}

/// Returns pi w R [7/4 - (1/4) (4.04 lambda^1.4 - 1)/(4.04 lambda^1.4 + 1)].
pub(super) fn pull_off(pair: &Pair) -> f64 {
    pair.unit_load() * Transition::new(pair.transition()).pull_off
}
